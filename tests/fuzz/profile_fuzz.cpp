// A profile: '0' a table, else a drawing, then its text.
#include <string>

#include "mesh/profile/profile_file.h"
#include "tests/fuzz/harness.h"

namespace meshwind::fuzz {

void run(std::span<const std::uint8_t> bytes) {
    if (bytes.empty()) {
        return;
    }
    const std::string text(text_of(bytes.subspan(1)));
    const ProfileFile profile =
        bytes[0] == '0' ? read_profile_csv(text, "a.csv") : read_profile_dxf(text, "a.dxf");
    const TriangleSoup soup = swept_profile(profile, "a");
    for (const Eigen::Vector3d& p : soup.points_mm) {
        if (!p.allFinite()) {
            found("a vertex that is no number");
        }
    }
    for (const auto& face : soup.faces) {
        for (const std::int32_t v : face) {
            if (v < 0 || static_cast<std::size_t>(v) >= soup.points_mm.size()) {
                found("a triangle names a point that is not there");
            }
        }
    }
}

}  // namespace meshwind::fuzz
