#include "mesh/mandrel/thicken.h"
#include "mesh/mandrel/load_mandrel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/text/text_number.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Normals of the sides of a vertex that point apart by more than this cosine (84 degrees from their
// mean) have no common way out.
constexpr double kMinCosine = 0.1;

// Of a face, before and after: more turned is folded.
constexpr double kFolded = 0.0;

using Key = std::array<double, 3>;

Key key_of(const Vector3d& p) {
    return {p.x(), p.y(), p.z()};
}

[[noreturn]] void folds(const Mandrel& mandrel, const Vector3d& at, double thickness_mm) {
    throw InputError("thicken.folds", mandrel.file,
                     "near (" + fixed(at.x(), 1) + ", " + fixed(at.y(), 1) + ", " +
                         fixed(at.z(), 1) + ") the layers are " + fixed(thickness_mm, 2) +
                         " mm thick and the wall is too hollow for that; wind fewer layers or give "
                         "the part a larger blend there");
}

// Per vertex: the direction in which the wall goes, as long as one mm of thickness moves it.
std::vector<Vector3d> ways_out(const Mandrel& mandrel) {
    const Surface& surface = mandrel.surface;
    std::vector<Vector3d> sum(surface.position_mm.size(), Vector3d::Zero());
    std::vector<std::map<std::int32_t, Vector3d>> sides(surface.position_mm.size());
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        for (std::size_t c = 0; c < 3; ++c) {
            const std::int32_t corner = surface.corner[f][c];
            const auto vertex = static_cast<std::size_t>(surface.face[f][c]);
            sides[vertex].emplace(corner, surface.normal[static_cast<std::size_t>(corner)]);
        }
    }
    for (std::size_t v = 0; v < sides.size(); ++v) {
        for (const auto& [corner, normal] : sides[v]) {
            sum[v] += normal;
        }
        if (sides[v].empty()) {
            continue;
        }
        const Vector3d mean = sum[v].normalized();
        double cosine = 1.0;
        for (const auto& [corner, normal] : sides[v]) {
            cosine = std::min(cosine, mean.dot(normal));
        }
        sum[v] = mean / std::max(cosine, kMinCosine);
    }
    return sum;
}

void check_faces(const Mandrel& mandrel, const std::vector<Vector3d>& moved,
                 std::span<const double> thickness_mm) {
    const Surface& surface = mandrel.surface;
    const auto normal = [](const Vector3d& a, const Vector3d& b, const Vector3d& c) {
        return Vector3d((b - a).cross(c - a));
    };
    for (const std::array<std::int32_t, 3>& face : surface.face) {
        const auto i = static_cast<std::size_t>(face[0]);
        const auto j = static_cast<std::size_t>(face[1]);
        const auto k = static_cast<std::size_t>(face[2]);
        const Vector3d before =
            normal(surface.position_mm[i], surface.position_mm[j], surface.position_mm[k]);
        if (!(before.dot(normal(moved[i], moved[j], moved[k])) > kFolded)) {
            folds(mandrel, surface.position_mm[i],
                  std::max({thickness_mm[i], thickness_mm[j], thickness_mm[k]}));
        }
    }
}

}  // namespace

Mandrel thicken(const Mandrel& mandrel, std::span<const double> thickness_mm) {
    const Surface& surface = mandrel.surface;
    const std::vector<Vector3d> way = ways_out(mandrel);
    std::vector<Vector3d> moved = surface.position_mm;
    std::map<Key, Vector3d> moved_from;
    for (std::size_t v = 0; v < moved.size(); ++v) {
        moved[v] += thickness_mm[v] * way[v];
        moved_from.emplace(key_of(surface.position_mm[v]), moved[v]);
    }
    check_faces(mandrel, moved, thickness_mm);

    TriangleSoup grown = mandrel.whole;
    for (Vector3d& p : grown.points_mm) {
        const auto found = moved_from.find(key_of(p));
        p = found != moved_from.end() ? found->second : p;
    }
    MandrelOptions options;
    options.unit_mm = 1.0;
    options.axis = {Vector3d::Zero(), Vector3d::UnitZ()};
    Mandrel next = build_mandrel(grown, mandrel.file, options);
    if (next.repairs.self_intersecting_faces > mandrel.repairs.self_intersecting_faces) {
        const auto thickest = std::max_element(thickness_mm.begin(), thickness_mm.end());
        folds(mandrel,
              surface.position_mm[static_cast<std::size_t>(thickest - thickness_mm.begin())],
              *thickest);
    }
    if (next.surface.face != surface.face || next.rims.size() != mandrel.rims.size()) {
        throw InputError("thicken.changed", mandrel.file,
                         "with the layers on it its winding surface has other triangles or rims "
                         "than before; mend the mesh or wind fewer layers");
    }
    next.file_to_mandrel = next.file_to_mandrel * mandrel.file_to_mandrel;
    next.unit_mm = mandrel.unit_mm;
    next.unit_rule = mandrel.unit_rule;
    next.axis = mandrel.axis;
    return next;
}

}  // namespace meshwind
