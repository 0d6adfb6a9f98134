/// What every harness has: one input from bytes. Errors of core/error.h are its good end, but for
/// NumericalError: anything else is a find.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/error.h"

namespace meshwind::fuzz {

/// Runs one input. \throws what is a find
void run(std::span<const std::uint8_t> bytes);

/// The bytes as a file's content.
[[nodiscard]] inline std::string_view text_of(std::span<const std::uint8_t> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Ends the process with these words: what was found is no crash by itself.
[[noreturn]] void found(std::string_view words);

}  // namespace meshwind::fuzz
