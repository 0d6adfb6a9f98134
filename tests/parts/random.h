/// Random draws that are the same with every compiler.
#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <random>

namespace cad_part {

/// The standard fixes the engine, not its distributions: those are made here.
class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}

    /// In [low, high).
    double uniform(double low, double high) {
        return low + (high - low) * static_cast<double>(engine_() >> 11U) * 0x1p-53;
    }

    /// Even on a logarithmic scale. \pre 0 < low <= high
    double logarithmic(double low, double high) {
        return std::exp(uniform(std::log(low), std::log(high)));
    }

    /// In low ... high, both included.
    int whole(int low, int high) {
        const auto count = static_cast<std::uint64_t>(high - low + 1);
        return low + static_cast<int>(engine_() % count);
    }

    bool chance(double probability) { return uniform(0.0, 1.0) < probability; }

    template <typename Value>
    Value pick(std::initializer_list<Value> values) {
        return values.begin()[whole(0, static_cast<int>(values.size()) - 1)];
    }

private:
    std::mt19937_64 engine_;
};

}  // namespace cad_part
