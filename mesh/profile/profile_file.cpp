#include "mesh/profile/profile_file.h"

#include <cmath>

#include "core/error.h"
#include "core/text/text_number.h"
#include "mesh/io/import.h"
#include "mesh/revolution/swept_wall.h"

namespace meshwind {
namespace {

// A curve is at most so many times as long as its chord from one point to the next: an arc of 150
// degrees is 1.4 times.
constexpr double kMaxSwing = 1.5;

}  // namespace

bool is_profile(const std::filesystem::path& file) {
    const std::string ending = lower_ending(file);
    return ending == ".csv" || ending == ".dxf";
}

ProfileFile read_profile(const std::filesystem::path& file) {
    const std::string text = read_part_file(file);
    return lower_ending(file) == ".dxf" ? read_profile_dxf(text, file.string())
                                        : read_profile_csv(text, file.string());
}

TriangleSoup swept_profile(const ProfileFile& profile, const std::string& file) {
    const Meridian meridian(profile.nodes);
    for (const MeridianPiece& piece : meridian.pieces()) {
        if (!(piece.length_mm <= kMaxSwing * (piece.to_mm - piece.from_mm).norm())) {
            throw InputError(
                "profile.smooth", file,
                "goes through no smooth curve from x = " + fixed(piece.from_mm.y(), 4) +
                    ", r = " + fixed(piece.from_mm.x(), 4) +
                    " to x = " + fixed(piece.to_mm.y(), 4) + ", r = " + fixed(piece.to_mm.x(), 4) +
                    "; mend the points, give more of them, or say in columns line and "
                    "crease where it is none");
        }
    }
    const double radius = meridian.at(meridian.widest_mm()).radius_mm;
    const double height = std::abs(profile.nodes.back().z_mm - profile.nodes.front().z_mm);
    LabelledMesh wall = swept_wall(meridian, std::hypot(2.0 * radius, 2.0 * radius, height));
    if (wall.soup.faces.empty()) {
        throw InputError("profile.points", file,
                         "is so slender or so finely curved that its surface would take more "
                         "than 200,000 triangles; leave small fillets out");
    }
    return std::move(wall.soup);
}

}  // namespace meshwind
