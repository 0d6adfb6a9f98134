#include "mesh/revolution/revolution.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/text/text_number.h"
#include "mesh/revolution/meridian_fit.h"

namespace meshwind {
namespace {

// Simpson's rule over the pieces: exact for straight ones.
double mean_radius(const Meridian& meridian, std::size_t first, std::size_t last) {
    double sum = 0.0;
    double length = 0.0;
    for (std::size_t i = first; i < last; ++i) {
        const MeridianPiece& piece = meridian.pieces()[i];
        sum += piece.length_mm * (piece.from_mm.x() + 4.0 * piece.middle_mm.x() + piece.to_mm.x()) /
               6.0;
        length += piece.length_mm;
    }
    return sum / length;
}

std::vector<MeridianPart> parts_of(const Meridian& meridian) {
    const auto pieces = meridian.pieces();
    const auto arcs = meridian.nodes_mm();
    const auto creases = meridian.creases_mm();
    std::vector<MeridianPart> parts;
    for (std::size_t first = 0; first < pieces.size();) {
        std::size_t last = first + 1;
        while (last < pieces.size() && pieces[last].straight == pieces[first].straight &&
               !std::binary_search(creases.begin(), creases.end(), arcs[last])) {
            ++last;
        }
        MeridianPart part;
        part.from_mm = arcs[first];
        part.to_mm = arcs[last];
        part.radius_mm = mean_radius(meridian, first, last);
        if (pieces[first].straight) {
            const Eigen::Vector2d way = pieces[last - 1].to_mm - pieces[first].from_mm;
            part.kind = way.x() == 0.0 ? MeridianPartKind::Cylinder : MeridianPartKind::Cone;
            part.slope_rad = std::atan2(way.x(), way.y());
        }
        parts.push_back(part);
        first = last;
    }
    return parts;
}

}  // namespace

std::string_view name_of(MeridianPartKind kind) {
    switch (kind) {
        case MeridianPartKind::Cylinder:
            return "cylinder";
        case MeridianPartKind::Cone:
            return "cone";
        case MeridianPartKind::Dome:
            break;
    }
    return "dome";
}

RevolutionFinding find_revolution(const Surface& surface, std::span<const Rim> rims) {
    const ProfilePoints profile = profile_points(surface, rims);
    if (!profile.why_not.empty()) {
        return {std::nullopt, profile.why_not};
    }
    std::optional<Meridian> meridian;
    // Nodes that make no curve, such as one on the axis half way, are the mandrel's fault.
    try {
        meridian.emplace(fit_meridian(profile));
    } catch (const InputError&) {
        return {std::nullopt, "its vertices do not make one meridian"};
    }
    double residual = 0.0;
    double largest = 0.0;
    for (const ProfilePoint& p : profile.points) {
        residual = std::max(residual, meridian->foot(p.at_mm.x(), p.at_mm.y()).distance_mm);
        largest = std::max(largest, p.at_mm.x());
    }
    const double limit = std::min(kRevolutionResidualMm, kRevolutionResidualShare * largest);
    if (!(residual <= limit)) {
        return {std::nullopt, "its vertices are up to " + fixed(residual, 3) +
                                  " mm off a surface of revolution about the spindle, more than " +
                                  fixed(limit, 3) + " mm"};
    }
    std::vector<MeridianPart> parts = parts_of(*meridian);
    return {BodyOfRevolution{std::move(*meridian), residual, profile.end, std::move(parts)}, {}};
}

RevolutionFinding find_revolution(const Mandrel& mandrel) {
    return find_revolution(mandrel.surface, mandrel.rims);
}

}  // namespace meshwind
