#include "engine/image/jpeg_coefficients.hpp"

#include <jerror.h>
#include <unistd.h>

#include <algorithm>
#include <new>

namespace helio {

CoefficientFile::CoefficientFile() : file_(std::tmpfile()) {}

CoefficientFile::~CoefficientFile() {
    if (file_ != nullptr) std::fclose(file_);
}

void CoefficientFile::install(jpeg_decompress_struct& decoder) {
    decoder.client_data = this;
    decoder.mem->request_virt_barray = request;
    decoder.mem->access_virt_barray = access;
}

jvirt_barray_ptr CoefficientFile::request(j_common_ptr decoder, int, boolean, JDIMENSION blocks,
                                          JDIMENSION rows, JDIMENSION together) {
    auto& self = *static_cast<CoefficientFile*>(decoder->client_data);
    Array* made = nullptr;
    try {
        Array& array = self.arrays_.emplace_back();
        array.offset = self.size_;
        array.blocks = blocks;
        array.window.resize(std::size_t(blocks) * together * DCTSIZE2);
        array.rows.resize(together);
        self.size_ += std::uint64_t(blocks) * rows * sizeof(JBLOCK);
        made = &array;
    } catch (const std::bad_alloc&) {
    }
    if (made == nullptr) ERREXIT1(decoder, JERR_OUT_OF_MEMORY, 0);
    return reinterpret_cast<jvirt_barray_ptr>(made);
}

JBLOCKARRAY CoefficientFile::access(j_common_ptr decoder, jvirt_barray_ptr which, JDIMENSION first,
                                    JDIMENSION count, boolean writable) {
    auto& self = *static_cast<CoefficientFile*>(decoder->client_data);
    Array& array = *reinterpret_cast<Array*>(which);
    if (count > array.rows.size()) ERREXIT(decoder, JERR_BAD_VIRTUAL_ACCESS);
    if (array.first != first || array.count != count) {
        if (!self.move(array, first, count)) ERREXIT(decoder, JERR_TFILE_WRITE);
    }
    array.isChanged = array.isChanged || writable != FALSE;
    return array.rows.data();
}

bool CoefficientFile::move(Array& array, JDIMENSION first, JDIMENSION count) {
    const int file = ::fileno(file_);
    const std::size_t row = array.blocks * sizeof(JBLOCK);
    auto* const bytes = reinterpret_cast<char*>(array.window.data());
    const auto place = [&](JDIMENSION at) { return ::off_t(array.offset + std::uint64_t(at) * row); };
    for (std::size_t done = 0; array.isChanged && done < array.count * row;) {
        const ::ssize_t written =
            ::pwrite(file, bytes + done, array.count * row - done, place(array.first) + ::off_t(done));
        if (written <= 0) return false;
        done += std::size_t(written);
    }
    for (std::size_t done = 0; done < count * row;) {
        const ::ssize_t got = ::pread(file, bytes + done, count * row - done, place(first) + ::off_t(done));
        if (got < 0) return false;
        if (got == 0) {  // nothing was written there yet
            std::fill(bytes + done, bytes + count * row, '\0');
            break;
        }
        done += std::size_t(got);
    }
    for (JDIMENSION i = 0; i < count; ++i)
        array.rows[i] = reinterpret_cast<JBLOCKROW>(&array.window[std::size_t(i) * array.blocks * DCTSIZE2]);
    array.first = first;
    array.count = count;
    array.isChanged = false;
    return true;
}

}  // namespace helio
