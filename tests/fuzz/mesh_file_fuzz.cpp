// A mesh file: '0' STL, '1' OBJ, '2' PLY, '3' OFF, then its bytes.
#include <array>

#include "mesh/import.h"
#include "tests/fuzz/harness.h"

namespace meshwind::fuzz {

void run(std::span<const std::uint8_t> bytes) {
    static constexpr std::array<const char*, 4> kNames = {"a.stl", "a.obj", "a.ply", "a.off"};
    if (bytes.empty()) {
        return;
    }
    const TriangleSoup soup =
        parse_triangles(text_of(bytes.subspan(1)), kNames[bytes[0] % kNames.size()]);
    for (const auto& face : soup.faces) {
        for (const std::int32_t v : face) {
            if (v < 0 || static_cast<std::size_t>(v) >= soup.points_mm.size()) {
                found("a triangle names a point that is not there");
            }
        }
    }
}

}  // namespace meshwind::fuzz
