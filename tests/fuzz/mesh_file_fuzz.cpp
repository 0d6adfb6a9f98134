// A mesh file: '0' STL, '1' OBJ, and on as kMeshReaders has them, then its bytes.
#include <string>

#include "mesh/io/import.h"
#include "mesh/io/mesh_readers.h"
#include "tests/fuzz/harness.h"

namespace meshwind::fuzz {

void run(std::span<const std::uint8_t> bytes) {
    if (bytes.empty()) {
        return;
    }
    const auto format = static_cast<std::uint8_t>(bytes[0] - '0') % kMeshReaders.size();
    const TriangleSoup soup =
        parse_triangles(text_of(bytes.subspan(1)), "a" + std::string(kMeshReaders[format].ending));
    for (const auto& face : soup.faces) {
        for (const std::int32_t v : face) {
            if (v < 0 || static_cast<std::size_t>(v) >= soup.points_mm.size()) {
                found("a triangle names a point that is not there");
            }
        }
    }
}

}  // namespace meshwind::fuzz
