/// Mandrels, rims and hand-made courses for the tests of winding/ and postproc/.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "core/random.h"
#include "core/units.h"
#include "mesh/mandrel/extension.h"
#include "mesh/mandrel/load_mandrel.h"
#include "mesh/ray_query.h"
#include "mesh/shapes/make_kinds.h"
#include "tests/support/shapes.h"
#include "winding/plan/course.h"

namespace meshwind::test {

/// Numbers that depend on the seed alone.
class Draw {
public:
    explicit Draw(std::uint64_t seed) : seed_(seed) {}

    [[nodiscard]] double between(double low, double high) {
        return low + (high - low) * random_unit(seed_, index_++);
    }
    [[nodiscard]] std::int32_t below(std::int32_t count) {
        return static_cast<std::int32_t>(random_bits(seed_, index_++) %
                                         static_cast<std::uint64_t>(count));
    }
    [[nodiscard]] bool coin(double share = 0.5) { return between(0.0, 1.0) < share; }

private:
    std::uint64_t seed_;
    std::uint64_t index_ = 0;
};

inline Mandrel made(std::string_view kind, const MakeValues& values, double edge_mm) {
    return build_mandrel(make_mandrel(kind, values, {.edge_mm = edge_mm}), std::string(kind),
                         {.unit_mm = 1.0});
}

inline Mandrel made_cylinder(double radius_mm, double length_mm, double edge_mm) {
    return made("cylinder", {{"radius", radius_mm}, {"length", length_mm}}, edge_mm);
}

inline Mandrel small_tee(double edge_mm) {
    return made("tee",
                {{"run-radius", 30.0},
                 {"branch-radius", 22.0},
                 {"blend-radius", 12.0},
                 {"run-length", 180.0},
                 {"branch-length", 110.0}},
                edge_mm);
}

/// The mandrel with closed extensions on its rims: what a free fibre may not hit. Clearances are
/// tabulated up to `table_mm`, as plans use them.
inline RayQuery obstacles_of(const Mandrel& mandrel, double extension_mm, double table_mm = 0.0) {
    std::vector<TriangleSoup> parts{mandrel.whole};
    for (const Rim& rim : mandrel.rims) {
        parts.push_back(extension_of(rim, extension_mm));
    }
    return RayQuery(parts, table_mm);
}

inline double wall_area_mm2(const Surface& surface) {
    return area_mm2({surface.position_mm, surface.face});
}

/// Rims that stand apart, for libraries without a surface.
inline std::vector<Rim> plain_rims(std::int32_t count) {
    std::vector<Rim> rims(static_cast<std::size_t>(count));
    for (std::int32_t i = 0; i < count; ++i) {
        Rim& rim = rims[static_cast<std::size_t>(i)];
        rim.id = i;
        rim.centre_mm = Eigen::Vector3d(0.0, 0.0, 100.0 * i);
        rim.axis = i % 2 == 0 ? Eigen::Vector3d(-Eigen::Vector3d::UnitZ())
                              : Eigen::Vector3d(Eigen::Vector3d::UnitZ());
        rim.radius_mm = 30.0;
    }
    return rims;
}

/// A course that crosses two rims anywhere, windable at least one way; covers a few samples.
inline LibraryCourse random_member(Draw& draw, std::int32_t rims, std::int32_t samples) {
    LibraryCourse member;
    for (RimCrossing& end : member.end) {
        end.rim = draw.below(rims);
        end.azimuth_rad = draw.between(-kPi, kPi);
        end.angle_rad = draw.between(rad_from_deg(50.0), rad_from_deg(80.0));
        end.sense = draw.coin() ? 1 : -1;
    }
    member.windable_forward = draw.coin(0.7);
    member.windable_backward = !member.windable_forward || draw.coin(0.7);
    member.length_mm = draw.between(100.0, 500.0);
    const std::int32_t first = draw.below(samples);
    for (std::int32_t i = first; i < std::min(samples, first + 5); ++i) {
        member.footprint.push_back(i);
    }
    return member;
}

}  // namespace meshwind::test
