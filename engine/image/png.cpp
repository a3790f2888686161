#include "engine/image/png.hpp"

#include "engine/image/texel_reader.hpp"

#include <png.h>

#include <bit>
#include <cstdio>
#include <cstring>

namespace helio {
namespace {

/** libpng leaves by longjmp: what it is called from has nothing to destroy. */
class PngFile {
public:
    explicit PngFile(std::span<const std::byte> file)
        : file_(file), png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, this, onError, onWarning)) {
        if (png_ != nullptr) info_ = png_create_info_struct(png_);
    }
    ~PngFile() { png_destroy_read_struct(&png_, &info_, nullptr); }
    PngFile(const PngFile&) = delete;
    PngFile& operator=(const PngFile&) = delete;

    /** Up to the pixels; of an interlaced one `byPasses`, or to be put together. False with a fault. */
    bool open(bool byPasses) {
        if (info_ == nullptr) return false;
        if (setjmp(png_jmpbuf(png_)) != 0) return false;
        png_set_read_fn(png_, this, read);
        png_read_info(png_, info_);
        png_set_expand(png_);  // palettes, transparent colours, fewer than 8 bits
        if (std::endian::native == std::endian::little) png_set_swap(png_);
        if (!byPasses) passes_ = png_set_interlace_handling(png_);
        png_read_update_info(png_, info_);
        return true;
    }
    std::uint32_t width() const { return png_get_image_width(png_, info_); }
    std::uint32_t height() const { return png_get_image_height(png_, info_); }
    std::size_t channels() const { return png_get_channels(png_, info_); }
    bool has16Bits() const { return png_get_bit_depth(png_, info_) == 16; }
    std::size_t rowBytes() const { return png_get_rowbytes(png_, info_); }
    bool isInterlaced() const { return passes_ > 1; }

    /** The next rows; all of them where it is interlaced. False with a fault. */
    bool readRows(std::uint32_t rows, std::byte* to) {
        if (setjmp(png_jmpbuf(png_)) != 0) return false;
        for (int pass = 0; pass < passes_; ++pass) {
            for (std::uint32_t y = 0; y < rows; ++y)
                png_read_row(png_, reinterpret_cast<png_bytep>(to + y * rowBytes()), nullptr);
        }
        return true;
    }

    /** All rows of an interlaced image's passes, one after the other into room for the widest. False with a
     * fault. */
    bool checkPasses(std::byte* row) {
        if (setjmp(png_jmpbuf(png_)) != 0) return false;
        for (int pass = 0; pass < PNG_INTERLACE_ADAM7_PASSES; ++pass) {
            const std::uint32_t rows = PNG_PASS_COLS(width(), pass) > 0 ? PNG_PASS_ROWS(height(), pass) : 0;
            for (std::uint32_t y = 0; y < rows; ++y)
                png_read_row(png_, reinterpret_cast<png_bytep>(row), nullptr);
        }
        return true;
    }
    bool hasPasses() const { return png_get_interlace_type(png_, info_) != PNG_INTERLACE_NONE; }

    std::string fault() const { return std::string("cannot be decoded: ") + fault_.data(); }

private:
    static PngFile& self(png_structp png) { return *static_cast<PngFile*>(png_get_error_ptr(png)); }
    [[noreturn]] static void onError(png_structp png, png_const_charp message) {
        std::array<char, 80>& fault = self(png).fault_;
        std::snprintf(fault.data(), fault.size(), "%s", message);
        png_longjmp(png, 1);
    }
    static void onWarning(png_structp, png_const_charp) {}
    static void read(png_structp png, png_bytep to, std::size_t size) {
        auto& file = static_cast<PngFile*>(png_get_io_ptr(png))->file_;
        if (size > file.size()) png_error(png, "the file ends");
        std::memcpy(to, file.data(), size);
        file = file.subspan(size);
    }

    std::span<const std::byte> file_;
    png_structp png_;
    png_infop info_ = nullptr;
    int passes_ = 1;
    std::array<char, 80> fault_{"libpng does not start"};
};

template <class T>
std::string readTexels(PngFile& png, std::uint64_t encoded, ImageBudget& budget, DecodedImage& image) {
    TexelReader<T> reader(png.width(), png.height(), png.channels(), encoded, budget);
    std::vector<std::byte> whole;  // an interlaced one: the caller's budget has room for it
    if (png.isInterlaced()) {
        whole.resize(png.rowBytes() * png.height());
        if (!png.readRows(png.height(), whole.data())) return png.fault();
    }
    return reader.read(
        0,
        [&](std::uint32_t y, std::uint32_t rows, T* values) -> std::string {
            if (!whole.empty()) {
                std::memcpy(values, &whole[y * png.rowBytes()], rows * png.rowBytes());
                return {};
            }
            return png.readRows(rows, reinterpret_cast<std::byte*>(values)) ? std::string() : png.fault();
        },
        image);
}

}  // namespace

std::string decodePng(std::span<const std::byte> file, std::uint64_t maximumTexels, ImageBudget& budget,
                      DecodedImage& image) {
    PngFile png(file);
    if (!png.open(budget.isTrial())) return png.fault();
    if (std::uint64_t(png.width()) * png.height() > maximumTexels)
        return "is too large: " + std::to_string(png.width()) + " x " + std::to_string(png.height());
    if (budget.isTrial() && png.hasPasses()) {
        std::vector<std::byte> row(png.rowBytes());
        return png.checkPasses(row.data()) ? std::string() : png.fault();
    }
    return png.has16Bits() ? readTexels<std::uint16_t>(png, file.size(), budget, image)
                           : readTexels<std::uint8_t>(png, file.size(), budget, image);
}

}  // namespace helio
