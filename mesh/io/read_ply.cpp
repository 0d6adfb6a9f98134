#include <algorithm>
#include <array>
#include <limits>
#include <memory>

#include "core/error.h"
#include "mesh/io/mesh_readers.h"
#include "mesh/io/ply_values.h"

namespace meshwind {
namespace {

class PlyReader {
public:
    PlyReader(std::string_view bytes, const std::string& file)
        : file_(file),
          header_(read_ply_header(bytes, file)),
          values_(ply_values(bytes, file, header_)) {}

    PolygonSoup read() {
        check_elements();
        for (const PlyElement& element : header_.elements) {
            const bool strips = element.name == "tristrips";
            for (std::size_t row = 0; row < element.rows; ++row) {
                values_->begin_row();
                if (element.name == "vertex") {
                    read_point(element);
                } else if (strips || element.name == "face") {
                    read_faces(element, strips);
                } else {
                    pass_row(element);
                }
                values_->end_row();
            }
        }
        return std::move(soup_);
    }

private:
    static constexpr std::array<std::string_view, 3> kCoordinates = {"x", "y", "z"};

    static bool names_corners(const PlyProperty& property) {
        return property.list &&
               (property.name == "vertex_indices" || property.name == "vertex_index");
    }

    void check_elements() {
        for (const PlyElement& element : header_.elements) {
            if (element.name == "vertex") {
                points_ = element.rows;
                check_coordinates(element);
                soup_.points.reserve(points_);
            } else if (element.name == "face" || element.name == "tristrips") {
                check_corners(element);
            }
        }
    }

    void check_coordinates(const PlyElement& element) const {
        for (const std::string_view name : kCoordinates) {
            const auto fits = [&](const PlyProperty& p) { return p.name == name && !p.list; };
            if (std::count_if(element.properties.begin(), element.properties.end(), fits) != 1) {
                refuse_header("its vertices have no single property " + std::string(name));
            }
        }
        if (points_ > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
            refuse_header("has more than 2^31 vertices");
        }
    }

    void check_corners(const PlyElement& element) const {
        if (std::count_if(element.properties.begin(), element.properties.end(), names_corners) !=
            1) {
            refuse_header("its element '" + element.name + "' has no single list vertex_indices");
        }
    }

    [[noreturn]] void refuse_header(const std::string& message) const {
        throw InputError("mesh.not_a_mesh", file_, message + "; export the part again");
    }

    void read_point(const PlyElement& element) {
        Eigen::Vector3d point = Eigen::Vector3d::Zero();
        for (const PlyProperty& property : element.properties) {
            const auto* const name =
                std::find(kCoordinates.begin(), kCoordinates.end(), property.name);
            if (name == kCoordinates.end() || property.list) {
                pass(property);
            } else {
                point[name - kCoordinates.begin()] = values_->number(property.type);
            }
        }
        soup_.points.push_back(point);
    }

    void read_faces(const PlyElement& element, bool strips) {
        for (const PlyProperty& property : element.properties) {
            if (!names_corners(property)) {
                pass(property);
            } else if (strips) {
                read_strip(property);
            } else {
                read_polygon(property);
            }
        }
    }

    void read_polygon(const PlyProperty& property) {
        const std::int64_t count = length_of(property);
        if (count > static_cast<std::int64_t>(kMostCorners)) {
            values_->refuse("mesh.large_polygon", large_polygon_words());
        }
        for (std::int64_t i = 0; i < count; ++i) {
            soup_.corners.push_back(checked(values_->integer(property.type)));
        }
        soup_.ends.push_back(soup_.corners.size());
    }

    // Each index makes a triangle with the two before it, every other one turned over; -1 begins a
    // new strip.
    void read_strip(const PlyProperty& property) {
        std::array<std::int32_t, 2> last{};
        std::int64_t in_strip = 0;
        for (std::int64_t left = length_of(property); left > 0; --left) {
            const std::int64_t index = values_->integer(property.type);
            if (index == -1) {
                in_strip = 0;
                continue;
            }
            const std::int32_t corner = checked(index);
            if (in_strip >= 2) {
                const bool over = in_strip % 2 == 1;
                for (const std::int32_t v : {last[over ? 1 : 0], last[over ? 0 : 1], corner}) {
                    soup_.corners.push_back(v);
                }
                soup_.ends.push_back(soup_.corners.size());
            }
            last = {last[1], corner};
            ++in_strip;
        }
    }

    std::int64_t length_of(const PlyProperty& list) {
        const std::int64_t count = values_->integer(list.count_type);
        if (count < 0) {
            values_->refuse("mesh.bad_line", "a list has the length " + std::to_string(count) +
                                                 "; export the part again");
        }
        return count;
    }

    std::int32_t checked(std::int64_t index) const {
        if (index < 0 || index >= static_cast<std::int64_t>(points_)) {
            values_->refuse("mesh.bad_index", bad_index_words(index, 0, points_));
        }
        return static_cast<std::int32_t>(index);
    }

    void pass(const PlyProperty& property) {
        for (std::int64_t left = property.list ? length_of(property) : 1; left > 0; --left) {
            (void)values_->number(property.type);
        }
    }

    void pass_row(const PlyElement& element) {
        for (const PlyProperty& property : element.properties) {
            pass(property);
        }
    }

    std::string file_;
    PlyHeader header_;
    std::unique_ptr<PlyValues> values_;
    std::size_t points_ = 0;
    PolygonSoup soup_;
};

}  // namespace

PolygonSoup read_ply(std::string_view bytes, const std::string& file) {
    return PlyReader(bytes, file).read();
}

}  // namespace meshwind
