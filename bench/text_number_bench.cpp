// Numbers as text, against printf: a program of a million blocks holds six million of them.
#include <cstddef>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "core/text/text_number.h"

namespace {

constexpr std::size_t kCount = 6000;  // a thousand blocks of six axes
constexpr int kDecimals = 3;          // what controllers take

/// Axis increments of up to half a metre or a turn, fixed seed.
std::vector<double> increments() {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> distribution(-500.0, 500.0);
    std::vector<double> values(kCount);
    for (double& value : values) {
        value = distribution(random);
    }
    return values;
}

void append_fixed(benchmark::State& state) {
    const std::vector<double> values = increments();
    std::string text;
    for (auto _ : state) {
        text.clear();
        for (const double value : values) {
            meshwind::append_fixed(text, value, kDecimals);
        }
        benchmark::DoNotOptimize(text.data());
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kCount));
}
BENCHMARK(append_fixed);

void append_shortest(benchmark::State& state) {
    const std::vector<double> values = increments();
    std::string text;
    for (auto _ : state) {
        text.clear();
        for (const double value : values) {
            meshwind::append_shortest(text, value);
        }
        benchmark::DoNotOptimize(text.data());
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kCount));
}
BENCHMARK(append_shortest);

void printf_fixed(benchmark::State& state) {
    const std::vector<double> values = increments();
    char digits[64];
    std::string text;
    for (auto _ : state) {
        text.clear();
        for (const double value : values) {
            std::snprintf(digits, sizeof digits, "%.*f", kDecimals, value);
            text += digits;
        }
        benchmark::DoNotOptimize(text.data());
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kCount));
}
BENCHMARK(printf_fixed);

}  // namespace
