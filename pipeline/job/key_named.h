/// Finds keys of the job file by their short names.
#pragma once

#include <string>
#include <string_view>

namespace meshwind {

/// The full key that a word names, as `--set` takes it: tow.friction for friction and tow-friction,
/// layers.0.angle for angle; empty where the job has none of that name.
/// \param word with or without leading dashes; dashes within it stand for underscores
[[nodiscard]] std::string job_key_named(std::string_view word);

}  // namespace meshwind
