#include "mesh/tube/tube.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "core/parallel.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "mesh/tube/tube_chain.h"
#include "mesh/tube/tube_sections.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Sections are so far apart, or by an edge where that is longer.
constexpr double kSpacingShare = 0.15;  // of the radius

// Of the limit of the residual: a chain of lines and arcs that is nearer to the vertices than this
// is what was meant, however near a free line comes. Where a line goes over into an arc, an even
// mesh of coarse facets is off by 0.001 of the radius, which a free line follows.
constexpr double kMeantShare = 0.25;

// Or one that is not this much worse than the free line.
constexpr double kNotWorse = 1.5;

// A free line that is off by so many limits has sections that are no circles, as in the steep dome
// of a vessel; its bends are noise, by the hundred, and no chain is looked for among them.
constexpr double kNoTube = 20.0;

std::string has_two_ends(const Mandrel& mandrel) {
    const Surface& surface = mandrel.surface;
    if (mandrel.rims.size() != 2) {
        return "it has " + std::to_string(mandrel.rims.size()) +
               (mandrel.rims.size() == 1 ? " rim" : " rims") + ", a tube has two";
    }
    std::int64_t inner = 0;  // half edges
    std::int64_t outer = 0;
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        for (std::size_t e = 0; e < 3; ++e) {
            if (surface.neighbour[f][e] != kNoFace) {
                ++inner;
                continue;
            }
            ++outer;
            if (surface.rim[f][e] < 0) {
                return "its wall has a hole";
            }
        }
    }
    // Euler's V - E + F is 0 for a band; a handle takes 2 of it, a further closed piece adds 2.
    const std::int64_t euler = static_cast<std::int64_t>(surface.position_mm.size()) -
                               (inner / 2 + outer) + static_cast<std::int64_t>(surface.face.size());
    return euler == 0 ? "" : "its wall has handles or consists of several pieces";
}

// Largest distance of a vertex from the tube, and whether all are at the line at all.
double residual_of(const Tube& tube, const Surface& surface) {
    std::vector<double> off(surface.position_mm.size());
    parallel_for(off.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            const CentrePlace foot = tube.line.foot(surface.position_mm[v]);
            off[v] = std::abs((surface.position_mm[v] - foot.position_mm).norm() -
                              tube.radius_at(foot.arc_mm));
        }
    });
    return *std::max_element(off.begin(), off.end());
}

// What can be said of a line that is not made of lines and arcs.
TubePart curve_part(const CentreLine& line) {
    TubePart part;
    part.kind = TubePartKind::Curve;
    part.to_mm = line.length_mm();
    for (const CentreArc& arc : line.arcs()) {
        part.angle_rad += arc.length_mm * arc.curvature_per_mm.norm();
    }
    part.bend_radius_mm = part.to_mm / part.angle_rad;
    return part;
}

Tube free_tube(const Mandrel& mandrel, const std::vector<TubeSection>& sections) {
    std::vector<Vector3d> centres;
    centres.reserve(sections.size());
    for (const TubeSection& section : sections) {
        centres.push_back(section.centre_mm);
    }
    CentreLine line = line_through(centres);
    std::vector<TubeRadius> radius;
    for (std::size_t i = 0; i < sections.size(); ++i) {
        radius.push_back({line.nodes()[2 * i].arc_mm, sections[i].radius_mm});
    }
    Tube tube{std::move(line), std::move(radius), {}, {}, {}, 0.0};
    tube.parts = {curve_part(tube.line)};
    tube.residual_mm = residual_of(tube, mandrel.surface);
    return tube;
}

void set_ends(const Mandrel& mandrel, Tube& tube) {
    tube.rim = {mandrel.rims[0].id, mandrel.rims[1].id};
    for (std::size_t end = 0; end < 2; ++end) {
        const Vector3d outward = end == 0 ? Vector3d(-tube.line.nodes().front().tangent)
                                          : tube.line.nodes().back().tangent;
        tube.lean_rad[end] = std::atan2(outward.cross(mandrel.rims[end].axis).norm(),
                                        outward.dot(mandrel.rims[end].axis));
    }
}

}  // namespace

std::string_view name_of(TubePartKind kind) {
    switch (kind) {
        case TubePartKind::Straight:
            return "straight";
        case TubePartKind::Bend:
            return "bend";
        case TubePartKind::Curve:
            break;
    }
    return "curve";
}

double Tube::radius_at(double arc_mm) const {
    if (radius.size() == 1 || arc_mm <= radius.front().arc_mm) {
        return radius.front().radius_mm;
    }
    const auto after =
        std::lower_bound(radius.begin(), radius.end(), arc_mm,
                         [](const TubeRadius& node, double arc) { return node.arc_mm < arc; });
    if (after == radius.end()) {
        return radius.back().radius_mm;
    }
    const TubeRadius& a = *(after - 1);
    const double share = (arc_mm - a.arc_mm) / (after->arc_mm - a.arc_mm);
    return a.radius_mm + share * (after->radius_mm - a.radius_mm);
}

TubeFinding find_tube(const Mandrel& mandrel) {
    if (std::string why_not = has_two_ends(mandrel); !why_not.empty()) {
        return {std::nullopt, std::move(why_not)};
    }
    const double rim_mm = std::max(mandrel.rims[0].radius_mm, mandrel.rims[1].radius_mm);
    const double limit_mm = std::min(kTubeResidualMm, kTubeResidualShare * rim_mm);
    const std::vector<TubeSection> sections =
        tube_sections(mandrel, std::max(kSpacingShare * rim_mm, mandrel.surface.mean_edge_mm));
    if (sections.empty()) {
        return {std::nullopt, "there is no line from rim to rim about which it is round"};
    }
    Tube tube = free_tube(mandrel, sections);
    if (std::optional<Tube> chain = tube.residual_mm <= kNoTube * limit_mm
                                        ? chain_tube(mandrel.rims, mandrel.surface, tube)
                                        : std::nullopt) {
        chain->residual_mm = residual_of(*chain, mandrel.surface);
        const double most_mm = std::max(kMeantShare * limit_mm, kNotWorse * tube.residual_mm);
        if (chain->residual_mm <= most_mm) {
            tube = std::move(*chain);
        }
    }
    if (!(tube.residual_mm <= limit_mm)) {
        return {std::nullopt, "its vertices are up to " + fixed(tube.residual_mm, 3) +
                                  " mm off the tube that comes nearest, more than " +
                                  fixed(limit_mm, 3) + " mm"};
    }
    set_ends(mandrel, tube);
    return {std::move(tube), {}};
}

}  // namespace meshwind
