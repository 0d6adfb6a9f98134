/// The kinds of `meshwind make` as a table: names, parameters, and meshes by name.
#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "mesh/shapes/analytic.h"
#include "mesh/shapes/make.h"

namespace meshwind {

/// Lengths are mm and angles rad here; a command line shows angles in degrees. Ratios have no unit.
enum class MakeUnit { Length, Angle, Ratio };

struct MakeParameter {
    std::string_view name;  ///< as on the command line, without dashes: "run-radius"
    MakeUnit unit = MakeUnit::Length;
    double value_default = 0.0;  ///< mm, rad or no unit
    std::string_view meaning;    ///< one line without a full stop

    /// The number a user gives, mm or degrees, from a value in mm or rad, and back.
    [[nodiscard]] double shown(double value) const;
    [[nodiscard]] double value_of_shown(double number) const;
    /// "mm", "deg" or "".
    [[nodiscard]] std::string_view shown_unit() const;
};

struct MakeKind {
    std::string_view name;
    std::string_view meaning;
    std::span<const MakeParameter> parameters;
};

/// Values by parameter name, mm, rad or without unit; missing ones take their default.
using MakeValues = std::map<std::string, double, std::less<>>;

/// cylinder, cone, vessel, isotensoid, elbow, tee, wye, cross, combination, frame, torus,
/// ellipsoid.
[[nodiscard]] std::span<const MakeKind> make_kinds();

/// \throws InputError make.unknown_kind, make.unknown_parameter; what the kind's make function
/// throws
[[nodiscard]] TriangleSoup make_mandrel(std::string_view kind, const MakeValues& values = {},
                                        const MakeOptions& options = {});

/// Nearest point of the kind's ideal outer surface, see mesh/shapes/analytic.h.
/// \throws InputError make.unknown_kind, make.unknown_parameter; what the shape's validate throws
[[nodiscard]] ShapeFoot mandrel_foot(std::string_view kind, const MakeValues& values,
                                     const Eigen::Vector3d& point_mm);

}  // namespace meshwind
