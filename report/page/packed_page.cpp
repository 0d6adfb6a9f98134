#include "report/page/packed_page.h"

#include <nettle/base64.h>
#include <zlib.h>
#include <stdexcept>

namespace meshwind {
namespace {

constexpr std::string_view kDataMark = "<!--MESHWIND-DATA-->";

// zlib: a gzip head and tail about the stream.
constexpr int kGzipWindow = 15 + 16;
constexpr int kMemoryLevel = 8;

std::string gzip(std::string_view bytes) {
    z_stream stream{};
    if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kGzipWindow, kMemoryLevel,
                     Z_DEFAULT_STRATEGY) != Z_OK) {
        throw std::runtime_error("zlib cannot be started");
    }
    std::string packed(deflateBound(&stream, bytes.size()), '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    const int ended = deflate(&stream, Z_FINISH);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    if (ended != Z_STREAM_END) {
        throw std::runtime_error("zlib stopped before the end");
    }
    return packed;
}

std::string base64(std::string_view bytes) {
    std::string text(BASE64_ENCODE_RAW_LENGTH(bytes.size()), '\0');
    base64_encode_raw(text.data(), bytes.size(),
                      reinterpret_cast<const std::uint8_t*>(bytes.data()));
    return text;
}

}  // namespace

std::string packed_page(std::string_view page, std::string_view data) {
    const std::size_t mark = page.find(kDataMark);
    if (mark == std::string_view::npos) {
        throw std::logic_error("the page has no place for data");
    }
    std::string text;
    text += page.substr(0, mark);
    text += "<script id=\"meshwind-data\" type=\"application/octet-stream\">";
    text += base64(gzip(data));
    text += "</script>";
    text += page.substr(mark + kDataMark.size());
    return text;
}

}  // namespace meshwind
