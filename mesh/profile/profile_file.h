/// Reads outlines of bodies of revolution: a table of points, or a drawing of lines and arcs.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/revolution/meridian.h"
#include "mesh/triangle_soup.h"

namespace meshwind {

/// The meridian from its lower end to its upper one, in units of the file; the spindle axis of the
/// file is Z of the nodes.
struct ProfileFile {
    std::vector<MeridianNode> nodes;
    double stated_unit_mm = 0.0;  ///< 0: the file states none
};

/// Whether a file is read as a profile: .csv or .dxf.
[[nodiscard]] bool is_profile(const std::filesystem::path& file);

/// Points in order, columns `x` (along the axis) and `r`, or `x_mm` and `r_mm`, which state the
/// unit. They lie on one smooth curve, except where
///  - the outline turns by more than 30 degrees at a point, or column `crease` is 1: a crease;
///  - a chord is more than three times as long as those beside it, or goes on in the direction of
///    one of them to rounding, or column `line` is 1: a straight line to the next point. A curve
///    that starts beside it goes on in its direction, unless its first chord contradicts that.
/// A point on the axis at either end is a smooth pole, or the tip of a cone.
/// \param file name for the errors
/// \throws InputError profile.column, profile.number, profile.points (fewer than two, more than
/// 100,000), profile.radius, profile.same_point, profile.ends; each with its line
[[nodiscard]] ProfileFile read_profile_csv(std::string_view text, const std::string& file);

/// A DXF drawing as text (R12 and later) with X along the axis and Y the radius: LINE, ARC,
/// POLYLINE and LWPOLYLINE with their bulges, in any order, connected from one end to the other.
/// Lines on the axis, texts, points and dimensions are passed over. Where two pieces meet at more
/// than half a degree there is a crease. $INSUNITS states the unit.
/// \throws InputError profile.drawing (not a DXF, binary, cut off, an entity of another kind),
/// profile.chain (pieces that are not connected, or in a closed line) with the place,
/// profile.radius, profile.points, profile.ends
[[nodiscard]] ProfileFile read_profile_dxf(std::string_view text, const std::string& file);

/// Reads a file by its ending. \throws as above; IoError mesh.missing_file, mesh.unreadable
[[nodiscard]] ProfileFile read_profile(const std::filesystem::path& file);

/// The surface that the profile sweeps, outside in front, in rings of triangles whose vertices lie
/// on it to rounding (mesh/revolution/swept_wall.h). \param file name for the errors
/// \throws InputError profile.smooth where no smooth curve goes through the points;
/// profile.points where it would take too many triangles
[[nodiscard]] TriangleSoup swept_profile(const ProfileFile& profile, const std::string& file);

}  // namespace meshwind
