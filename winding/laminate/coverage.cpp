#include "winding/laminate/coverage.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"

namespace meshwind {
namespace {

int first_percentile(std::span<const std::int32_t> layers, std::span<const char> reached) {
    std::vector<std::int32_t> counted;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        if (reached.empty() || reached[i] != 0) {
            counted.push_back(layers[i]);
        }
    }
    if (counted.empty()) {
        return 0;
    }
    const auto rank = counted.begin() + static_cast<std::ptrdiff_t>(counted.size() / 100);
    std::nth_element(counted.begin(), rank, counted.end());
    return *rank;
}

}  // namespace

Coverage measure_coverage(std::span<const std::int32_t> layers, std::span<const char> reached) {
    Coverage coverage;
    coverage.p1_layers = first_percentile(layers, reached);
    double sum = 0.0;
    double squares = 0.0;
    double covered = 0.0;
    for (const std::int32_t count : layers) {
        sum += count;
        squares += static_cast<double>(count) * count;
        covered += count > 0 ? 1.0 : 0.0;
        coverage.max_layers = std::max(coverage.max_layers, static_cast<int>(count));
    }
    const auto n = static_cast<double>(layers.size());
    coverage.fraction = covered / n;
    coverage.mean_layers = sum / n;
    const double variance = squares / n - coverage.mean_layers * coverage.mean_layers;
    coverage.cv = sum > 0.0 ? std::sqrt(std::max(0.0, variance)) / coverage.mean_layers : 0.0;
    return coverage;
}

FibreUse fibre_use(const Plan& plan, double tow_width_mm, double wall_mm2, double layers) {
    if (plan.fibre_length_mm <= 0.0) {
        return {};
    }
    double turns_mm = 0.0;
    for (const Piece& piece : plan.pieces) {
        if (piece.kind == PieceKind::Transition && !piece.path.empty()) {
            turns_mm += piece.path.back().s_mm - piece.path.front().s_mm;
        }
    }
    return {plan.fibre_length_mm * tow_width_mm / (wall_mm2 * layers),
            turns_mm / plan.fibre_length_mm};
}

std::vector<double> layers_per_face(const Surface& surface, const CoverageSamples& samples,
                                    std::span<const std::int32_t> layers) {
    const SampledFaces faces = sampled_faces(surface, samples);
    std::vector<double> on_face(surface.face.size(), 0.0);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        on_face[at(samples.at[i].face)] += layers[i];
    }
    std::vector<double> mean(surface.face.size(), 0.0);
    for (std::size_t f = 0; f < mean.size(); ++f) {
        double weight = 0.0;
        for (const std::int32_t face : faces.speaks[f]) {
            if (face != kNoFace) {
                mean[f] += on_face[at(face)] / faces.samples[at(face)];
                weight += 1.0;
            }
        }
        mean[f] /= std::max(1.0, weight);
    }
    return mean;
}

}  // namespace meshwind
