#include "winding/coverage.h"

#include <algorithm>
#include <cmath>

namespace meshwind {
namespace {

std::size_t at(std::int32_t i) {
    return static_cast<std::size_t>(i);
}

}  // namespace

Coverage measure_coverage(std::span<const std::int32_t> layers) {
    Coverage coverage;
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

std::vector<double> layers_per_face(const Surface& surface, const CoverageSamples& samples,
                                    std::span<const std::int32_t> layers) {
    std::vector<double> count(surface.face.size(), 0.0);
    std::vector<double> mean(surface.face.size(), 0.0);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const std::size_t face = at(samples.at[i].face);
        count[face] += 1.0;
        mean[face] += layers[i];
    }
    for (std::size_t f = 0; f < count.size(); ++f) {
        mean[f] /= std::max(1.0, count[f]);
    }
    for (std::size_t f = 0; f < count.size(); ++f) {
        double sum = 0.0;
        double weight = 0.0;
        for (const std::int32_t g : surface.neighbour[f]) {
            if (g != kNoFace && count[at(g)] > 0.0) {
                sum += mean[at(g)];
                weight += 1.0;
            }
        }
        if (count[f] == 0.0 && weight > 0.0) {
            mean[f] = sum / weight;
        }
    }
    return mean;
}

std::vector<double> angle_per_face(const Surface& surface, std::span<const Piece> pieces) {
    std::vector<double> length(surface.face.size(), 0.0);
    std::vector<double> angle(surface.face.size(), 0.0);
    for (const Piece& piece : pieces) {
        for (std::size_t i = 0; piece.kind == PieceKind::Course && i + 1 < piece.path.size(); ++i) {
            const std::size_t face = at(piece.path[i + 1].at.face);
            const double ds = piece.path[i + 1].s_mm - piece.path[i].s_mm;
            length[face] += ds;
            angle[face] += ds * std::acos(std::min(1.0, std::abs(piece.path[i].tangent.z())));
        }
    }
    for (std::size_t f = 0; f < length.size(); ++f) {
        angle[f] = length[f] > 0.0 ? angle[f] / length[f] : 0.0;
    }
    return angle;
}

}  // namespace meshwind
