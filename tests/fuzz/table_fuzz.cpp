// A table: '0' landing points, '1' a frame's axis, '2' a path, '3' a motion.
#include <string>

#include "machines/machine_json.h"
#include "postproc/ringhead/frame_axis.h"
#include "postproc/tables/landing_csv.h"
#include "postproc/tables/plan_tables.h"
#include "tests/fuzz/harness.h"

namespace meshwind::fuzz {
namespace {

void read_axis(std::string_view text) {
    constexpr int kPlaces = 20;
    const FrameAxis axis = read_axis_csv(text, "axis.csv");
    for (int i = 0; i <= kPlaces; ++i) {
        const AxisFrame frame = axis.at(axis.length_mm() * i / kPlaces);
        if (!frame.point_mm.allFinite() || !frame.tangent.allFinite()) {
            found("an axis with a place that is not finite");
        }
    }
}

}  // namespace

void run(std::span<const std::uint8_t> bytes) {
    static const Machine kMachine = read_machine(MESHWIND_SOURCE_DIR "/machines/six_axis.json");
    if (bytes.empty()) {
        return;
    }
    const std::string_view text = text_of(bytes.subspan(1));
    switch (bytes[0] % 4) {
        case 0:
            (void)read_landing_csv(text, "points.csv");
            break;
        case 1:
            read_axis(text);
            break;
        case 2:
            (void)read_path_csv(text, "path.csv");
            break;
        default:
            (void)read_motion_csv(text, "motion.csv", kMachine);
    }
}

}  // namespace meshwind::fuzz
