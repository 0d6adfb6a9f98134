#include "mesh/shapes/make_kinds.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
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
constexpr WyeShape kWye;
constexpr CrossShape kCross;
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
constexpr std::array kWyeTable{
    MakeParameter{"pipe-radius", kLength, kWye.pipe_radius_mm, "radius of the three pipes"},
    MakeParameter{"blend-radius", kLength, kWye.blend_radius_mm,
                  "radius of the ball that rounds the joints"},
    MakeParameter{"stem-length", kLength, kWye.stem_length_mm,
                  "from where the axes meet to the stem's end"},
    MakeParameter{"arm-length", kLength, kWye.arm_length_mm,
                  "from where the axes meet to each arm's end"},
    MakeParameter{"angle", kAngle, kWye.angle_rad, "between the arms"},
};
constexpr std::array kCrossTable{
    MakeParameter{"pipe-radius", kLength, kCross.pipe_radius_mm, "radius of both pipes"},
    MakeParameter{"blend-radius", kLength, kCross.blend_radius_mm,
                  "radius of the ball that rounds the joints"},
    MakeParameter{"run-length", kLength, kCross.run_length_mm,
                  "whole length of the pipe along the spindle"},
    MakeParameter{"branch-length", kLength, kCross.branch_length_mm,
                  "from the run's axis to each branch's end"},
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

// What a kind is made by; values are those of its parameters, in their order.
struct KindRow {
    MakeKind kind;
    TriangleSoup (*make)(std::span<const double> values, const MakeOptions& options);
    ShapeFoot (*foot)(std::span<const double> values, const Eigen::Vector3d& point_mm);
};

// Parameters stand in the order of the shape's members.
template <class Shape, std::size_t n>
Shape shape_of(std::span<const double> values) {
    return [&]<std::size_t... i>(std::index_sequence<i...>) {
        return Shape{values[i]...};
    }
    (std::make_index_sequence<n>());
}

template <auto make_shape, auto foot_of, class Shape, std::size_t n>
constexpr KindRow row(const Shape& /*defaults*/, std::string_view name, std::string_view meaning,
                      const std::array<MakeParameter, n>& parameters) {
    return {{name, meaning, parameters},
            [](std::span<const double> values, const MakeOptions& options) {
                return make_shape(shape_of<Shape, n>(values), options);
            },
            [](std::span<const double> values, const Eigen::Vector3d& point_mm) {
                const auto shape = shape_of<Shape, n>(values);
                shape.validate();
                return foot_of(shape, point_mm);
            }};
}

constexpr std::array kKinds{
    row<make_cylinder, cylinder_foot>(kCylinder, "cylinder", "straight pipe", kCylinderTable),
    row<make_cone, cone_foot>(kCone, "cone", "frustum of a cone", kConeTable),
    row<make_vessel, vessel_foot>(kVessel, "vessel", "cylinder with ellipsoidal domes",
                                  kVesselTable),
    row<make_isotensoid, isotensoid_foot>(kIsotensoid, "isotensoid",
                                          "cylinder with isotensoid domes", kIsotensoidTable),
    row<make_elbow, elbow_foot>(kElbow, "elbow", "pipe bend with straight legs", kElbowTable),
    row<make_tee, tee_foot>(
        kTee, "tee", "pipe with a branch, square or leaning, and a rolling-ball blend", kTeeTable),
    row<make_wye, wye_foot>(kWye, "wye", "stem and two arms of equal pipes, blended as the tee",
                            kWyeTable),
    row<make_cross, cross_foot>(kCross, "cross", "two equal pipes that cross, blended as the tee",
                                kCrossTable),
    row<make_combination, combination_foot>(kCombination, "combination",
                                            "cylinder, cone, cylinder and dome in a row",
                                            kCombinationTable),
    row<make_elbow, elbow_foot>(kFrame, "frame", "slender tube along line, arc, line", kFrameTable),
    row<make_torus, torus_foot>(kTorus, "torus", "ring, closed or an arc of it", kTorusTable),
    row<make_ellipsoid, ellipsoid_foot>(kEllipsoid, "ellipsoid", "closed ellipsoid of revolution",
                                        kEllipsoidTable),
};

const KindRow& row_named(std::string_view name) {
    const auto found = std::find_if(kKinds.begin(), kKinds.end(),
                                    [&](const KindRow& row) { return row.kind.name == name; });
    if (found != kKinds.end()) {
        return *found;
    }
    std::string known;
    for (const KindRow& each : kKinds) {
        known.append(known.empty() ? "" : ", ").append(each.kind.name);
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

}  // namespace

double MakeParameter::shown(double value) const {
    return unit == MakeUnit::Angle ? deg_from_rad(value) : value;
}

double MakeParameter::value_of_shown(double number) const {
    return unit == MakeUnit::Angle ? rad_from_deg(number) : number;
}

std::string_view MakeParameter::shown_unit() const {
    switch (unit) {
        case MakeUnit::Angle:
            return "deg";
        case MakeUnit::Ratio:
            return "";
        case MakeUnit::Length:
            break;
    }
    return "mm";
}

std::span<const MakeKind> make_kinds() {
    static const std::array kOnly = [] {
        std::array<MakeKind, kKinds.size()> kinds;
        std::transform(kKinds.begin(), kKinds.end(), kinds.begin(),
                       [](const KindRow& row) { return row.kind; });
        return kinds;
    }();
    return kOnly;
}

TriangleSoup make_mandrel(std::string_view kind, const MakeValues& values,
                          const MakeOptions& options) {
    const KindRow& found = row_named(kind);
    return found.make(ordered(found.kind, values), options);
}

ShapeFoot mandrel_foot(std::string_view kind, const MakeValues& values,
                       const Eigen::Vector3d& point_mm) {
    const KindRow& found = row_named(kind);
    return found.foot(ordered(found.kind, values), point_mm);
}

}  // namespace meshwind
