#pragma once
/** @file Where libjpeg keeps the coefficients of a picture whose scans refine it. */
// clang-format off
#include <cstddef>
#include <cstdio>
#include <jpeglib.h>  // which includes neither
// clang-format on

#include <cstdint>
#include <list>
#include <vector>

namespace helio {

/** libjpeg's arrays of blocks in a file without a name, a few rows of them at a time in memory: a picture can
 * so be checked that would not fit. Must outlast the decompressor that it is installed in. */
class CoefficientFile {
public:
    CoefficientFile();
    ~CoefficientFile();
    CoefficientFile(const CoefficientFile&) = delete;
    CoefficientFile& operator=(const CoefficientFile&) = delete;

    /** Whether there is room for a file. */
    bool isOpen() const { return file_ != nullptr; }
    /** Between jpeg_create_decompress() and jpeg_start_decompress(). Takes client_data. */
    void install(jpeg_decompress_struct& decoder);

private:
    struct Array {
        std::uint64_t offset = 0;  ///< in the file
        JDIMENSION blocks = 0;     ///< in a row
        JDIMENSION first = 0, count = 0;
        bool isChanged = false;
        std::vector<JCOEF> window;
        std::vector<JBLOCKROW> rows;
    };

    static jvirt_barray_ptr request(j_common_ptr decoder, int pool, boolean zeroed, JDIMENSION blocks,
                                    JDIMENSION rows, JDIMENSION together);
    static JBLOCKARRAY access(j_common_ptr decoder, jvirt_barray_ptr array, JDIMENSION first,
                              JDIMENSION count, boolean writable);
    /** False where the file cannot be read or written. */
    bool move(Array& array, JDIMENSION first, JDIMENSION count);

    std::FILE* file_;
    std::uint64_t size_ = 0;
    std::list<Array> arrays_;
};

}  // namespace helio
