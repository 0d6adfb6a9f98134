#include "report/picture/preview.h"

#include <charconv>
#include <filesystem>

#include "core/error.h"
#include "core/files/write_file.h"
#include "report/picture/preview_png.h"
#include "report/picture/preview_render.h"
#include "report/picture/preview_scene.h"

namespace meshwind {
namespace {

namespace fs = std::filesystem;

// Smaller shows nothing; larger takes gigabytes.
constexpr int kLeast_px = 16;
constexpr int kMost_px = 16384;

PreviewSize size_of(const std::string& text) {
    PreviewSize size;
    const char* end = text.data() + text.size();
    const auto [by, width_error] = std::from_chars(text.data(), end, size.width_px);
    const bool has_by = width_error == std::errc() && by != end && *by == 'x';
    const auto [rest, height_error] = std::from_chars(has_by ? by + 1 : end, end, size.height_px);
    const auto fits = [](int pixels) { return pixels >= kLeast_px && pixels <= kMost_px; };
    if (!has_by || height_error != std::errc() || rest != end || !fits(size.width_px) ||
        !fits(size.height_px)) {
        throw InputError("cli.png_size", "--png-size",
                         "'" + text + "' is no size; write WIDTHxHEIGHT in pixels, each " +
                             std::to_string(kLeast_px) + " to " + std::to_string(kMost_px));
    }
    return size;
}

}  // namespace

void check_preview(const PreviewOptions& options) {
    if (options.file.empty()) {
        return;
    }
    (void)size_of(options.size);
    std::error_code ignored;
    const fs::path folder = fs::path(options.file).parent_path();
    if (fs::is_directory(options.file, ignored) ||
        (!folder.empty() && !fs::is_directory(folder, ignored))) {
        throw IoError("output.unwritable", options.file,
                      "the picture cannot be written there; name a file in a folder that exists");
    }
}

void write_preview(const PreviewOptions& options, std::span<const WoundLayer> layers) {
    if (options.file.empty() || layers.empty() || layers.front().plan.pieces.empty()) {
        return;
    }
    const PreviewSize size = size_of(options.size);
    const PreviewScene scene = preview_scene(layers, preview_colour(options.colour));
    write_file(options.file, png_bytes(render(scene, view_of(scene, size))));
}

}  // namespace meshwind
