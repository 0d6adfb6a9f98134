#include "cli/carry_axis.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "core/error.h"
#include "core/text_number.h"
#include "mesh/mandrel.h"
#include "mesh/tube.h"

namespace meshwind {

bool is_mesh_file(const std::filesystem::path& file) {
    constexpr std::array kEndings = {".stl", ".obj", ".ply", ".off"};
    std::string ending = file.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

MeshAxis read_mesh_axis(const std::filesystem::path& file, const MeshAxisOptions& options) {
    MandrelOptions reading;
    reading.unit_mm = options.unit_mm;
    const Mandrel mandrel = load_mandrel(file, reading);
    const TubeFinding finding = find_tube(mandrel);
    if (!finding.tube) {
        throw InputError("carry.no_tube", file.string(),
                         "is no tube: " + finding.why_not +
                             "; give the mesh of a frame, or a table of its axis");
    }
    MeshAxis found{axis_of_tube(*finding.tube, options.axis), finding.tube->residual_mm,
                   Eigen::Isometry3d::Identity()};
    const double limit_mm = std::min(kTubeResidualMm, kTubeResidualShare * found.tube.radius_mm);
    if (found.tube.radius_spread_mm > limit_mm) {
        throw InputError("carry.no_tube", file.string(),
                         "is a tube whose radius varies by " +
                             fixed(found.tube.radius_spread_mm, 3) + " mm; " + fixed(limit_mm, 3) +
                             " mm are allowed");
    }
    const Eigen::Affine3d to_file = mandrel.file_to_mandrel.inverse();
    found.frame_in_file.linear() =
        mandrel.unit_mm * to_file.linear() * found.tube.in_mandrel.linear();
    found.frame_in_file.translation() =
        mandrel.unit_mm * (to_file * found.tube.in_mandrel.translation());
    return found;
}

}  // namespace meshwind
