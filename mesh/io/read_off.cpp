#include <limits>

#include "core/error.h"
#include "mesh/io/mesh_readers.h"
#include "mesh/io/mesh_text.h"

namespace meshwind {
namespace {

// Shortest rows: "0 0 0\n" of a point, "0\n" of a face.
constexpr std::size_t kPointBytes = 6;
constexpr std::size_t kFaceBytes = 2;

// OFF with what may stand before it for texture, colours and normals of the points.
bool is_keyword(std::string_view word) {
    for (const std::string_view prefix : {"ST", "C", "N"}) {
        if (word.substr(0, prefix.size()) == prefix) {
            word.remove_prefix(prefix.size());
        }
    }
    return word == "OFF";
}

class OffReader {
public:
    OffReader(std::string_view bytes, const std::string& file)
        : text_(bytes, file, {.comment = '#'}), bytes_(bytes.size()) {}

    PolygonSoup read() {
        read_counts();
        soup_.points.reserve(points_);
        soup_.ends.reserve(faces_);
        soup_.corners.reserve(3 * faces_);
        for (std::size_t i = 0; i < points_; ++i) {
            next_row("points", i, points_);
            Eigen::Vector3d& point = soup_.points.emplace_back();
            for (double& x : point) {
                x = text_.number("the coordinates of a point");
            }
        }
        for (std::size_t i = 0; i < faces_; ++i) {
            next_row("faces", i, faces_);
            read_face();
        }
        return std::move(soup_);
    }

private:
    void read_counts() {
        if (!text_.next_line() || !is_keyword(text_.word())) {
            text_.refuse("mesh.not_a_mesh",
                         "does not begin with OFF, COFF, NOFF or STOFF; export the part again");
        }
        std::string_view word = text_.word_of_text();
        if (word == "BINARY") {
            text_.refuse("mesh.not_a_mesh",
                         "is a binary OFF file, only text is read; export it as text or as PLY");
        }
        std::int64_t points = 0;
        if (!parse_integer(word, points)) {
            text_.refuse("mesh.not_a_mesh", "has " + shown(word) +
                                                " in place of the number of "
                                                "points; export the part again");
        }
        const std::int64_t faces = text_.integer("the number of faces");
        const auto most = static_cast<std::int64_t>(bytes_);
        if (points < 0 || faces < 0 || points > most / std::int64_t{kPointBytes} + 1 ||
            faces > most / std::int64_t{kFaceBytes} + 1 ||
            points > std::numeric_limits<std::int32_t>::max()) {
            text_.refuse("mesh.truncated", "announces " + std::to_string(points) + " points and " +
                                               std::to_string(faces) +
                                               " faces, which the file is too short for; export "
                                               "or copy the file again");
        }
        points_ = static_cast<std::size_t>(points);
        faces_ = static_cast<std::size_t>(faces);
    }

    void next_row(const char* what, std::size_t done, std::size_t announced) {
        if (!text_.next_line()) {
            text_.refuse("mesh.truncated", "ends after " + std::to_string(done) + " of " +
                                               std::to_string(announced) + " " + what +
                                               "; export or copy the file again");
        }
    }

    // Behind the corners there may be a colour.
    void read_face() {
        const std::int64_t count = text_.integer("the number of a polygon's corners");
        if (count < 0 || count > static_cast<std::int64_t>(kMaxCorners)) {
            text_.refuse("mesh.large_polygon", large_polygon_words());
        }
        for (std::int64_t i = 0; i < count; ++i) {
            const std::int64_t index = text_.integer("a corner of a polygon");
            if (index < 0 || index >= static_cast<std::int64_t>(points_)) {
                text_.refuse("mesh.bad_index", bad_index_words(index, 0, points_));
            }
            soup_.corners.push_back(static_cast<std::int32_t>(index));
        }
        soup_.ends.push_back(soup_.corners.size());
    }

    MeshText text_;
    std::size_t bytes_;
    std::size_t points_ = 0;
    std::size_t faces_ = 0;
    PolygonSoup soup_;
};

}  // namespace

PolygonSoup read_off(std::string_view bytes, const std::string& file) {
    return OffReader(bytes, file).read();
}

}  // namespace meshwind
