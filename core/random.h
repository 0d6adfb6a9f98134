/// Random numbers that are the same on every machine and for any order of threads.
#pragma once

#include <cstddef>
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

/// Sequence of random numbers of a seed, from index `first` on.
class Draws {
public:
    Draws(std::uint64_t seed, std::uint64_t first) : seed_(seed), index_(first) {}

    double unit() { return random_unit(seed_, index_++); }
    /// -1 or 1.
    double either() { return unit() < 0.5 ? -1.0 : 1.0; }
    std::size_t below(std::size_t count) {
        return static_cast<std::size_t>(random_bits(seed_, index_++) % count);
    }
    /// Irwin and Hall's sum of twelve: mean 0, variance 1.
    double normal() {
        double sum = -6.0;
        for (int i = 0; i < 12; ++i) {
            sum += unit();
        }
        return sum;
    }

private:
    std::uint64_t seed_;
    std::uint64_t index_;
};

/// Streams of random numbers of one seed, so that one draw never depends on another.
enum class Stream : std::uint64_t {
    Sampling = 1,
    Seeds = 2,
    Angles = 3,
    Steerings = 4,
    Ground = 5,
    Annealing = 6,
    Otherwise = 7,
    Wishes = 8,
    Judging = 9
};

/// The seed of a stream.
inline std::uint64_t seed_of(Stream stream, std::uint64_t seed) {
    return seed * 16 + static_cast<std::uint64_t>(stream);
}

}  // namespace meshwind
