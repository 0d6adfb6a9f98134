#include "postproc/ringhead/carry_axis.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/error.h"
#include "core/text/digest.h"
#include "core/text/lower_case.h"
#include "core/text/text_file.h"
#include "core/text/text_number.h"
#include "mesh/mandrel/load_mandrel.h"
#include "mesh/tube/tube.h"

namespace meshwind {
namespace {

bool is_mesh_file(const std::filesystem::path& file) {
    constexpr std::array kEndings = {".stl", ".obj", ".ply", ".off"};
    const std::string ending = lower_case(file.extension().string());
    return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

CarryAxis axis_of_mesh(const std::filesystem::path& file, const MeshAxisOptions& options) {
    MandrelOptions reading;
    reading.unit_mm = options.unit_mm;
    const Mandrel mandrel = load_mandrel(file, reading);
    const TubeFinding finding = find_tube(mandrel);
    if (!finding.tube) {
        throw InputError("carry.no_tube", file.string(),
                         "is no tube: " + finding.why_not +
                             "; give the mesh of a frame, or a table of its axis");
    }
    TubeAxis tube = axis_of_tube(*finding.tube, options.axis);
    const double limit_mm = std::min(kTubeResidualMm, kTubeResidualShare * tube.radius_mm);
    if (tube.radius_spread_mm > limit_mm) {
        throw InputError("carry.no_tube", file.string(),
                         "is a tube whose radius varies by " + fixed(tube.radius_spread_mm, 3) +
                             " mm; " + fixed(limit_mm, 3) + " mm are allowed");
    }
    const Eigen::Affine3d to_file = mandrel.file_to_mandrel.inverse();
    Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
    frame.linear() = mandrel.unit_mm * to_file.linear() * tube.in_mandrel.linear();
    frame.translation() = mandrel.unit_mm * (to_file * tube.in_mandrel.translation());
    return {.axis = std::move(tube.axis),
            .radius_mm = tube.radius_mm,
            .residual_mm = finding.tube->residual_mm,
            .frame_in_file = frame};
}

}  // namespace

CarryAxis read_carry_axis(const std::filesystem::path& file, const MeshAxisOptions& options) {
    const std::string text = read_text_file(file);
    CarryAxis found = is_mesh_file(file)
                          ? axis_of_mesh(file, options)
                          : CarryAxis{.axis = FrameAxis(read_axis_csv(text, file.string()))};
    found.file = file.filename().string();
    found.digest = sha256_hex(text);
    return found;
}

}  // namespace meshwind
