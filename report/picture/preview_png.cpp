#include "report/picture/preview_png.h"

#include <png.h>

#include "core/error.h"

namespace meshwind {

std::string png_bytes(const PreviewImage& image) {
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    header.width = static_cast<png_uint_32>(image.size.width_px);
    header.height = static_cast<png_uint_32>(image.size.height_px);
    header.format = PNG_FORMAT_RGBA;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
    std::string bytes(size, '\0');
    if (png_image_write_to_memory(&header, bytes.data(), &size, 0, image.rgba.data(), 0, nullptr) ==
        0) {
        throw NumericalError("preview.packing", "",
                             std::string("the picture cannot be packed: ") + header.message);
    }
    bytes.resize(size);
    return bytes;
}

}  // namespace meshwind
