/// Random numbers that are the same on every machine and for any order of threads.
#pragma once

#include <cstdint>

namespace meshwind {

/// A stateless mix of (seed, index): well-spread 64 bits. Source: steele_2014_splittable
/// (SplitMix64).
[[nodiscard]] constexpr std::uint64_t random_bits(std::uint64_t seed, std::uint64_t index) {
    std::uint64_t z = seed * 0xD1342543DE82EF95ULL + (index + 1) * 0x9E3779B97F4A7C15ULL;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31U);
}

/// Uniform in [0, 1).
[[nodiscard]] constexpr double random_unit(std::uint64_t seed, std::uint64_t index) {
    return static_cast<double>(random_bits(seed, index) >> 11U) * 0x1.0p-53;
}

/// Streams of random numbers of one seed, so that one draw never depends on another.
enum class Stream : std::uint64_t {
    Sampling = 1,
    Seeds = 2,
    Angles = 3,
    Steerings = 4,
    Ground = 5,
    Annealing = 6,
    Otherwise = 7,
    Wishes = 8
};

/// The seed of a stream.
inline std::uint64_t seed_of(Stream stream, std::uint64_t seed) {
    return seed * 16 + static_cast<std::uint64_t>(stream);
}

}  // namespace meshwind
