#include "mesh/make_kinds.h"

#include <algorithm>
#include <array>
#include <vector>

#include "core/error.h"
#include "core/units.h"

namespace meshwind {
namespace {

constexpr CylinderShape kCylinder;
constexpr ConeShape kCone;
constexpr VesselShape kVessel;
constexpr IsotensoidShape kIsotensoid;
constexpr ElbowShape kElbow;
// The frame is an elbow with long legs, as bicycle and window frames have.
constexpr ElbowShape kFrame{20.0, 60.0, 0.5 * kPi, 300.0, 300.0};
constexpr TeeShape kTee;
constexpr CombinationShape kCombination;
constexpr TorusShape kTorus;
constexpr EllipsoidShape kEllipsoid;

constexpr MakeUnit kLength = MakeUnit::Length;
constexpr MakeUnit kAngle = MakeUnit::Angle;
constexpr MakeUnit kRatio = MakeUnit::Ratio;

constexpr std::array kCylinderTable{
    MakeParameter{"radius", kLength, kCylinder.radius_mm, "radius"},
    MakeParameter{"length", kLength, kCylinder.length_mm, "length along the spindle"},
};
constexpr std::array kConeTable{
    MakeParameter{"radius1", kLength, kCone.radius1_mm, "radius at the lower end"},
    MakeParameter{"radius2", kLength, kCone.radius2_mm, "radius at the upper end"},
    MakeParameter{"length", kLength, kCone.length_mm, "length along the spindle"},
};
constexpr std::array kVesselTable{
    MakeParameter{"radius", kLength, kVessel.radius_mm, "radius of the cylinder"},
    MakeParameter{"cylinder-length", kLength, kVessel.cylinder_length_mm, "length without domes"},
    MakeParameter{"dome-height", kLength, kVessel.dome_height_mm,
                  "height of the half ellipsoid at each end"},
    MakeParameter{"opening-radius", kLength, kVessel.opening_radius_mm,
                  "radius of the polar openings, 0 for none"},
    MakeParameter{"upper-opening-radius", kLength, kVessel.upper_opening_radius_mm,
                  "radius of the upper one where it differs, -1: as the lower"},
};
constexpr std::array kIsotensoidTable{
    MakeParameter{"radius", kLength, kIsotensoid.radius_mm, "radius of the cylinder"},
    MakeParameter{"cylinder-length", kLength, kIsotensoid.cylinder_length_mm,
                  "length without domes"},
    MakeParameter{"opening-radius", kLength, kIsotensoid.opening_radius_mm,
                  "radius of the polar openings"},
    MakeParameter{"ke", kRatio, kIsotensoid.stiffness_ratio,
                  "E2 (1 + nu12) / (E1 (1 + nu21)) of the ply, 0 for fibres alone"},
    MakeParameter{"design-radius", kLength, kIsotensoid.design_radius_mm,
                  "Clairaut radius of the geodesics the domes are made for, 0 for the opening's"},
};
constexpr std::array<MakeParameter, 5> pipe_table(const ElbowShape& shape) {
    return {MakeParameter{"pipe-radius", kLength, shape.pipe_radius_mm, "radius of the pipe"},
            MakeParameter{"bend-radius", kLength, shape.bend_radius_mm,
                          "radius of the centre line's arc"},
            MakeParameter{"angle", kAngle, shape.angle_rad, "angle of the bend"},
            MakeParameter{"leg1", kLength, shape.leg1_mm, "straight length before the bend"},
            MakeParameter{"leg2", kLength, shape.leg2_mm, "straight length after the bend"}};
}
constexpr std::array kElbowTable = pipe_table(kElbow);
constexpr std::array kFrameTable = pipe_table(kFrame);
constexpr std::array kTeeTable{
    MakeParameter{"run-radius", kLength, kTee.run_radius_mm, "radius of the straight pipe"},
    MakeParameter{"branch-radius", kLength, kTee.branch_radius_mm,
                  "radius of the branch, at most the run's"},
    MakeParameter{"blend-radius", kLength, kTee.blend_radius_mm,
                  "radius of the ball that rounds the joint"},
    MakeParameter{"run-length", kLength, kTee.run_length_mm, "whole length of the straight pipe"},
    MakeParameter{"branch-length", kLength, kTee.branch_length_mm,
                  "from the run's axis to the branch's end"},
    MakeParameter{"lean", kAngle, kTee.lean_rad,
                  "how far the branch leans, from square towards one end of the run"},
};
constexpr std::array kCombinationTable{
    MakeParameter{"radius1", kLength, kCombination.radius1_mm, "radius of the first cylinder"},
    MakeParameter{"length1", kLength, kCombination.length1_mm, "length of the first cylinder"},
    MakeParameter{"cone-length", kLength, kCombination.cone_length_mm, "length of the cone"},
    MakeParameter{"radius2", kLength, kCombination.radius2_mm, "radius of the second cylinder"},
    MakeParameter{"length2", kLength, kCombination.length2_mm, "length of the second cylinder"},
    MakeParameter{"dome-height", kLength, kCombination.dome_height_mm,
                  "height of the half ellipsoid"},
    MakeParameter{"opening-radius", kLength, kCombination.opening_radius_mm,
                  "radius of the dome's opening, 0 for none"},
};
constexpr std::array kTorusTable{
    MakeParameter{"ring-radius", kLength, kTorus.ring_radius_mm, "radius of the centre line"},
    MakeParameter{"tube-radius", kLength, kTorus.tube_radius_mm, "radius of the tube"},
    MakeParameter{"angle", kAngle, kTorus.angle_rad, "angle of the ring, a full turn is closed"},
};
constexpr std::array kEllipsoidTable{
    MakeParameter{"equator-radius", kLength, kEllipsoid.equator_radius_mm, "radius at the equator"},
    MakeParameter{"pole-radius", kLength, kEllipsoid.pole_radius_mm,
                  "half the length along the spindle"},
};

constexpr std::array kKinds{
    MakeKind{"cylinder", "straight pipe", kCylinderTable},
    MakeKind{"cone", "frustum of a cone", kConeTable},
    MakeKind{"vessel", "cylinder with ellipsoidal domes", kVesselTable},
    MakeKind{"isotensoid", "cylinder with isotensoid domes", kIsotensoidTable},
    MakeKind{"elbow", "pipe bend with straight legs", kElbowTable},
    MakeKind{"tee", "pipe with a branch, square or leaning, and a rolling-ball blend", kTeeTable},
    MakeKind{"combination", "cylinder, cone, cylinder and dome in a row", kCombinationTable},
    MakeKind{"frame", "slender tube along line, arc, line", kFrameTable},
    MakeKind{"torus", "ring, closed or an arc of it", kTorusTable},
    MakeKind{"ellipsoid", "closed ellipsoid of revolution", kEllipsoidTable},
};

const MakeKind& kind_named(std::string_view name) {
    const auto kind = std::find_if(kKinds.begin(), kKinds.end(),
                                   [&](const MakeKind& k) { return k.name == name; });
    if (kind != kKinds.end()) {
        return *kind;
    }
    std::string known;
    for (const MakeKind& each : kKinds) {
        known.append(known.empty() ? "" : ", ").append(each.name);
    }
    throw InputError("make.unknown_kind", std::string(name), "is no kind; take one of " + known);
}

// The kind's values in the order of its table, which is the order of the shape's members.
std::vector<double> ordered(const MakeKind& kind, const MakeValues& values) {
    std::vector<double> in_order;
    std::string known;
    for (const MakeParameter& parameter : kind.parameters) {
        const auto value = values.find(parameter.name);
        in_order.push_back(value == values.end() ? parameter.value_default : value->second);
        known.append(known.empty() ? "" : ", ").append(parameter.name);
    }
    for (const auto& value : values) {
        const std::string& name = value.first;
        const bool found =
            std::any_of(kind.parameters.begin(), kind.parameters.end(),
                        [&](const MakeParameter& parameter) { return parameter.name == name; });
        if (!found) {
            throw InputError("make.unknown_parameter", name,
                             "is no parameter of " + std::string(kind.name) + "; it has " + known);
        }
    }
    return in_order;
}

// Calls `use` with the kind's typed shape.
template <class Use>
auto with_shape(std::string_view name, const MakeValues& values, const Use& use) {
    const MakeKind& kind = kind_named(name);
    const std::vector<double> v = ordered(kind, values);
    if (kind.name == "cylinder") {
        return use(CylinderShape{v[0], v[1]});
    }
    if (kind.name == "cone") {
        return use(ConeShape{v[0], v[1], v[2]});
    }
    if (kind.name == "vessel") {
        return use(VesselShape{v[0], v[1], v[2], v[3], v[4]});
    }
    if (kind.name == "isotensoid") {
        return use(IsotensoidShape{v[0], v[1], v[2], v[3], v[4]});
    }
    if (kind.name == "tee") {
        return use(TeeShape{v[0], v[1], v[2], v[3], v[4], v[5]});
    }
    if (kind.name == "combination") {
        return use(CombinationShape{v[0], v[1], v[2], v[3], v[4], v[5], v[6]});
    }
    if (kind.name == "torus") {
        return use(TorusShape{v[0], v[1], v[2]});
    }
    if (kind.name == "ellipsoid") {
        return use(EllipsoidShape{v[0], v[1]});
    }
    return use(ElbowShape{v[0], v[1], v[2], v[3], v[4]});  // elbow and frame
}

struct Make {
    const MakeOptions& options;

    TriangleSoup operator()(const CylinderShape& s) const { return make_cylinder(s, options); }
    TriangleSoup operator()(const ConeShape& s) const { return make_cone(s, options); }
    TriangleSoup operator()(const VesselShape& s) const { return make_vessel(s, options); }
    TriangleSoup operator()(const IsotensoidShape& s) const { return make_isotensoid(s, options); }
    TriangleSoup operator()(const ElbowShape& s) const { return make_elbow(s, options); }
    TriangleSoup operator()(const TeeShape& s) const { return make_tee(s, options); }
    TriangleSoup operator()(const CombinationShape& s) const {
        return make_combination(s, options);
    }
    TriangleSoup operator()(const TorusShape& s) const { return make_torus(s, options); }
    TriangleSoup operator()(const EllipsoidShape& s) const { return make_ellipsoid(s, options); }
};

struct Foot {
    const Eigen::Vector3d& p;

    ShapeFoot of(const CylinderShape& s) const { return cylinder_foot(s, p); }
    ShapeFoot of(const ConeShape& s) const { return cone_foot(s, p); }
    ShapeFoot of(const VesselShape& s) const { return vessel_foot(s, p); }
    ShapeFoot of(const IsotensoidShape& s) const { return isotensoid_foot(s, p); }
    ShapeFoot of(const ElbowShape& s) const { return elbow_foot(s, p); }
    ShapeFoot of(const TeeShape& s) const { return tee_foot(s, p); }
    ShapeFoot of(const CombinationShape& s) const { return combination_foot(s, p); }
    ShapeFoot of(const TorusShape& s) const { return torus_foot(s, p); }
    ShapeFoot of(const EllipsoidShape& s) const { return ellipsoid_foot(s, p); }

    template <class Shape>
    ShapeFoot operator()(const Shape& shape) const {
        shape.validate();
        return of(shape);
    }
};

}  // namespace

std::span<const MakeKind> make_kinds() {
    return kKinds;
}

TriangleSoup make_mandrel(std::string_view kind, const MakeValues& values,
                          const MakeOptions& options) {
    return with_shape(kind, values, Make{options});
}

ShapeFoot mandrel_foot(std::string_view kind, const MakeValues& values,
                       const Eigen::Vector3d& point_mm) {
    return with_shape(kind, values, Foot{point_mm});
}

}  // namespace meshwind
