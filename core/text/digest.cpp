#include "core/text/digest.h"

#include <array>
#include <cstdint>

#include <nettle/sha2.h>

namespace meshwind {

std::string sha256_hex(std::string_view bytes) {
    sha256_ctx context;
    sha256_init(&context);
    sha256_update(&context, bytes.size(), reinterpret_cast<const std::uint8_t*>(bytes.data()));
    std::array<std::uint8_t, SHA256_DIGEST_SIZE> digest;
    sha256_digest(&context, digest.size(), digest.data());

    constexpr std::string_view kHexDigits = "0123456789abcdef";
    std::string text;
    text.reserve(2 * digest.size());
    for (const unsigned byte : digest) {
        text += kHexDigits[byte >> 4U];
        text += kHexDigits[byte & 15U];
    }
    return text;
}

std::string short_digest(std::string_view bytes) {
    constexpr std::size_t kDigits = 32;
    return "sha256/128 " + sha256_hex(bytes).substr(0, kDigits);
}

}  // namespace meshwind
