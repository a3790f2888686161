#include "engine/image/jpeg.hpp"

#include "engine/image/jpeg_coefficients.hpp"
#include "engine/image/texel_reader.hpp"

#include <jerror.h>

#include <array>
#include <csetjmp>
#include <optional>

namespace helio {
namespace {

/** libjpeg leaves by longjmp: what it is called from has nothing to destroy. */
class JpegFile {
public:
    JpegFile() {
        decoder_.err = jpeg_std_error(&errors_.base);
        errors_.base.error_exit = [](j_common_ptr decoder) {
            auto& errors = *reinterpret_cast<Errors*>(decoder->err);
            decoder->err->format_message(decoder, errors.message.data());
            std::longjmp(errors.leave, 1);
        };
        errors_.base.emit_message = [](j_common_ptr decoder, int level) {
            auto& errors = *reinterpret_cast<Errors*>(decoder->err);
            const int code = decoder->err->msg_code;
            if (level >= 0 || errors.isDamaged || code == JWRN_JFIF_MAJOR || code == JWRN_ADOBE_XFORM) return;
            (code == JWRN_EXTRANEOUS_DATA ? errors.isOdd : errors.isDamaged) = true;
            decoder->err->format_message(decoder, errors.message.data());
        };
        jpeg_create_decompress(&decoder_);
        progress_.progress_monitor = [](j_common_ptr decoder) {
            if (reinterpret_cast<j_decompress_ptr>(decoder)->input_scan_number > mostScans)
                ERREXIT(decoder, JERR_CANT_SUSPEND);
        };
        decoder_.progress = &progress_;
    }
    ~JpegFile() { jpeg_destroy_decompress(&decoder_); }
    JpegFile(const JpegFile&) = delete;
    JpegFile& operator=(const JpegFile&) = delete;

    jpeg_decompress_struct& decoder() { return decoder_; }

    /** Up to the pixels. Each of these is false with a fault. */
    bool open(std::span<const std::byte> file) {
        if (setjmp(errors_.leave) != 0) return false;
        jpeg_mem_src(&decoder_, reinterpret_cast<const unsigned char*>(file.data()), file.size());
        jpeg_read_header(&decoder_, TRUE);
        return true;
    }
    bool start() {
        if (setjmp(errors_.leave) != 0) return false;
        jpeg_start_decompress(&decoder_);
        return !errors_.isDamaged;
    }
    bool readRows(std::uint32_t rows, std::uint8_t* to) {
        if (setjmp(errors_.leave) != 0) return false;
        const std::size_t row = std::size_t(decoder_.output_width) * std::size_t(decoder_.output_components);
        for (std::uint32_t y = 0; y < rows; ++y) {
            JSAMPROW place = to + y * row;
            jpeg_read_scanlines(&decoder_, &place, 1);
        }
        return !errors_.isDamaged;
    }
    bool finish() {
        if (setjmp(errors_.leave) != 0) return false;
        jpeg_finish_decompress(&decoder_);
        return !errors_.isDamaged;
    }

    std::string remark() const {
        return errors_.isOdd ? std::string("has bytes that belong to nothing; it may be damaged")
                             : std::string();
    }
    std::string fault() const {
        if (decoder_.input_scan_number > mostScans)
            return "has more than " + std::to_string(mostScans) + " scans";
        return std::string("is damaged or cut off: ") + errors_.message.data();
    }

private:
    /** A scan may be a few bytes and takes as long as any; encoders write some ten. */
    static constexpr int mostScans = 100;

    struct Errors {
        jpeg_error_mgr base;  // first: libjpeg has a pointer to it
        std::jmp_buf leave;
        std::array<char, JMSG_LENGTH_MAX> message{};
        bool isDamaged = false, isOdd = false;
    };

    Errors errors_{};
    jpeg_progress_mgr progress_{};
    jpeg_decompress_struct decoder_{};
};

/** Photoshop stores inks inverted, and no one else writes four of them. */
void fromInks(const std::uint8_t* inks, std::size_t texels, std::uint8_t* rgb) {
    for (std::size_t i = 0; i < texels; ++i) {
        for (std::size_t c = 0; c < 3; ++c)
            rgb[i * 3 + c] = std::uint8_t((unsigned(inks[i * 4 + c]) * inks[i * 4 + 3] + 127) / 255);
    }
}

}  // namespace

std::string decodeJpeg(std::span<const std::byte> file, std::uint64_t maximumTexels, ImageBudget& budget,
                       DecodedImage& image) {
    std::optional<CoefficientFile> coefficients;
    JpegFile jpeg;
    jpeg_decompress_struct& decoder = jpeg.decoder();
    if (!jpeg.open(file)) return jpeg.fault();
    if (std::uint64_t(decoder.image_width) * decoder.image_height > maximumTexels) {
        return "is too large: " + std::to_string(decoder.image_width) + " x " +
               std::to_string(decoder.image_height);
    }
    if (budget.isTrial() && jpeg_has_multiple_scans(&decoder) != FALSE) {
        coefficients.emplace();
        if (!coefficients->isOpen())
            return "is too large to be checked without room in the folder for temporary files";
        coefficients->install(decoder);
        return jpeg.start() ? std::string() : jpeg.fault();  // all scans; pixels have no faults
    }
    if (!jpeg.start()) return jpeg.fault();
    const bool areInks = decoder.output_components == 4;
    TexelReader<std::uint8_t> reader(decoder.output_width, decoder.output_height,
                                     areInks ? 3u : std::size_t(decoder.output_components), file.size(),
                                     budget);
    std::vector<std::uint8_t> inks;
    const auto readRows = [&](std::uint32_t, std::uint32_t rows, std::uint8_t* values) -> std::string {
        const std::size_t texels = std::size_t(decoder.output_width) * rows;
        inks.resize(areInks ? texels * 4 : 0);
        if (!jpeg.readRows(rows, areInks ? inks.data() : values)) return jpeg.fault();
        if (areInks) fromInks(inks.data(), texels, values);
        return {};
    };
    if (std::string fault = reader.read(0, readRows, image); !fault.empty()) return fault;
    if (!jpeg.finish()) return jpeg.fault();
    image.remark = jpeg.remark();
    return {};
}

}  // namespace helio
