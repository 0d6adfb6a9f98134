#include "winding/laminate/measure_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/parallel.h"
#include "mesh/nearest.h"
#include "mesh/triangle_soup.h"
#include "winding/laminate/course_character.h"
#include "winding/laminate/coverage.h"
#include "winding/laminate/families.h"
#include "winding/laminate/footprint.h"
#include "winding/laminate/wound_angle.h"

namespace meshwind {
namespace {

// Samples per tow width. With 2.5 what is covered on samples that were planned on is 0.7 % more
// than what is covered on others, with 4 it is 0.25 %.
constexpr double kSamplesPerTow = 4.0;

// On a wall so large that this would take more samples, they lie further apart.
constexpr double kMaxSamples = 6e5;

constexpr std::size_t kChunk = 256;

Coverage coverage_where(const PlanZones::Zone& counts, const CoverageSamples& samples,
                        std::span<const std::int32_t> layers) {
    if (!counts) {
        return measure_coverage(layers);
    }
    std::vector<std::int32_t> asked_for;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (counts(samples.position_mm[i])) {
            asked_for.push_back(layers[i]);
        }
    }
    const auto share = [&](std::size_t n) {
        return static_cast<double>(n) / static_cast<double>(samples.size());
    };
    Coverage coverage = asked_for.empty() ? Coverage{} : measure_coverage(asked_for);
    coverage.fraction *= share(asked_for.size());
    coverage.reachable = share(asked_for.size());
    return coverage;
}

// The layers where they are regular, each taken over a tow width about it: narrower overlaps and
// gaps flow out. Coefficient of variation of what they are over what is meant, least and most.
void measure_regular(const PlanZones& zones, const CoverageSamples& samples,
                     std::span<const std::int32_t> layers, double tow_width_mm,
                     Coverage& coverage) {
    const NearestPoints points(samples.position_mm);
    std::vector<double> meant(samples.size(), 1.0);  // each is asked for many times
    if (zones.meant) {
        parallel_for(samples.size(), kChunk, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                meant[i] = zones.meant(samples.position_mm[i]);
            }
        });
    }
    std::vector<double> mean(samples.size(), -1.0);
    std::vector<double> share(samples.size(), -1.0);  // of what is meant
    parallel_for(samples.size(), kChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (!zones.regular(samples.position_mm[i])) {
                continue;
            }
            double sum = 0.0;
            double meant_sum = 0.0;
            const std::vector<std::int32_t> near =
                points.within(samples.position_mm[i], tow_width_mm);
            for (const std::int32_t n : near) {
                const auto k = static_cast<std::size_t>(n);
                sum += layers[k];
                meant_sum += meant[k];
            }
            mean[i] = sum / static_cast<double>(near.size());
            share[i] = sum / meant_sum;
        }
    });
    double n = 0.0;
    double sum = 0.0;
    double squares = 0.0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < mean.size(); ++i) {
        if (mean[i] >= 0.0) {
            n += 1.0;
            sum += share[i];
            squares += share[i] * share[i];
            least = std::min(least, mean[i]);
        }
    }
    if (sum > 0.0) {
        coverage.regular_cv = std::sqrt(std::max(0.0, squares * n - sum * sum)) / sum;
        coverage.thinnest_layers = least;
        coverage.thickest_layers = *std::max_element(mean.begin(), mean.end());
    } else {
        coverage.regular_cv = 0.0;
    }
}

}  // namespace

CoverageSamples plan_samples(const Surface& surface, double tow_width_mm, std::uint64_t seed,
                             Stream stream) {
    const double area = area_mm2({surface.position_mm, surface.face});
    const double spacing_mm =
        std::max(tow_width_mm / kSamplesPerTow, std::sqrt(area / kMaxSamples));
    return sample_surface(surface, spacing_mm, seed_of(stream, seed));
}

SurfacePath course_with_ends(std::span<const Piece> pieces, std::size_t i, double tow_width_mm) {
    SurfacePath path = pieces[i].path;
    const auto over_rim = [&](std::size_t k) {
        return k < pieces.size() && pieces[k].kind == PieceKind::Transition &&
               pieces[k].path.front().at.face == kNoFace;
    };
    if (over_rim(i + 1) && !pieces[i + 1].starts_fibre) {
        const double end_mm = path.back().s_mm;
        const SurfacePoint end = path.back().at;
        for (PathPoint point : pieces[i + 1].path) {
            if (point.s_mm > 0.0 && point.s_mm <= tow_width_mm) {
                point.at = end;
                point.s_mm += end_mm;
                path.push_back(point);
            }
        }
    }
    if (i > 0 && over_rim(i - 1) && !pieces[i].starts_fibre) {
        const SurfacePath& turn = pieces[i - 1].path;
        const double start_mm = turn.back().s_mm;
        SurfacePath before;
        for (PathPoint point : turn) {
            if (point.s_mm < start_mm && point.s_mm >= start_mm - tow_width_mm) {
                point.at = path.front().at;
                point.s_mm -= start_mm;
                before.push_back(point);
            }
        }
        path.insert(path.begin(), before.begin(), before.end());
    }
    return path;
}

std::vector<std::int32_t> layers_of_courses(const Surface& wall, const CoverageSamples& samples,
                                            std::span<const Piece> pieces, double tow_width_mm) {
    const FootprintFinder footprints(wall, samples, tow_width_mm);
    std::vector<std::vector<std::int32_t>> footprint(pieces.size());
    parallel_for(pieces.size(), 1, [&](std::size_t begin, std::size_t end) {
        FootprintFinder::Scratch scratch = footprints.make_scratch();
        for (std::size_t i = begin; i < end; ++i) {
            if (pieces[i].kind == PieceKind::Course) {
                footprint[i] =
                    footprints.footprint(course_with_ends(pieces, i, tow_width_mm), scratch);
            }
        }
    });
    std::vector<std::int32_t> layers(samples.size(), 0);
    for (const std::vector<std::int32_t>& course : footprint) {
        for (const std::int32_t sample : course) {
            ++layers[static_cast<std::size_t>(sample)];
        }
    }
    return layers;
}

Coverage coverage_of_fibre(const Surface& surface, const Surface& wall, double tow_width_mm,
                           std::uint64_t seed, const SurfacePath& fibre) {
    const CoverageSamples samples = plan_samples(surface, tow_width_mm, seed);
    const FootprintFinder footprints(wall, samples, tow_width_mm);
    FootprintFinder::Scratch scratch = footprints.make_scratch();
    std::vector<std::int32_t> layers(samples.size(), 0);
    for (const std::int32_t sample : footprints.footprint(fibre, scratch)) {
        ++layers[static_cast<std::size_t>(sample)];
    }
    return measure_coverage(layers);
}

void describe_courses(const Surface& wall, double tow_width_mm, std::optional<double> wish_rad,
                      Plan& plan) {
    std::vector<const SurfacePath*> courses;
    for (const Piece& piece : plan.pieces) {
        if (piece.kind == PieceKind::Course) {
            courses.push_back(&piece.path);
        }
    }
    plan.angle = wound_angles(wall, courses, wish_rad);
    plan.places = places_of(wall, courses);
    plan.family = families_of(courses, tow_width_mm);
}

void measure_plan(const Surface& surface, const Surface& wall, double tow_width_mm,
                  std::uint64_t seed, const PlanZones& zones, Plan& plan) {
    const CoverageSamples samples = plan_samples(surface, tow_width_mm, seed);
    const std::vector<std::int32_t> layers =
        layers_of_courses(wall, samples, plan.pieces, tow_width_mm);
    plan.coverage = coverage_where(zones.asked_for, samples, layers);
    if (zones.regular) {
        measure_regular(zones, samples, layers, tow_width_mm, plan.coverage);
    }
    plan.face_layers = layers_per_face(surface, samples, layers);
    describe_courses(wall, tow_width_mm, std::nullopt, plan);
}

}  // namespace meshwind
