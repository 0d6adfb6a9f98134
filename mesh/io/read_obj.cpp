#include <algorithm>
#include <array>
#include <limits>

#include "core/error.h"
#include "mesh/io/mesh_readers.h"
#include "mesh/io/mesh_text.h"

namespace meshwind {
namespace {

// Every other keyword of the format. A word that is none of them is damage: where a `v` was hit,
// all points behind it would be miscounted.
constexpr std::array<std::string_view, 44> kPassedOver = {
    "bevel", "bmat",   "bsp",    "bzp",        "c_interp", "call",     "cdc",  "cdp",  "con",
    "csh",   "cstype", "ctech",  "curv",       "curv2",    "d_interp", "deg",  "end",  "g",
    "hole",  "l",      "lod",    "maplib",     "mg",       "mtllib",   "o",    "p",    "parm",
    "res",   "s",      "scrv",   "shadow_obj", "sp",       "stech",    "step", "surf", "trace_obj",
    "trim",  "usemap", "usemtl", "vc",         "vn",       "vp",       "vt",   "xf"};

class ObjReader {
public:
    ObjReader(std::string_view bytes, const std::string& file)
        : text_(bytes, file, {.comment = '#', .joined = true}) {}

    PolygonSoup read() {
        while (text_.next_line()) {
            const std::string_view keyword = text_.word();
            if (keyword == "v") {
                read_point();
            } else if (keyword == "f" || keyword == "fo") {
                read_face();
            } else if (std::find(kPassedOver.begin(), kPassedOver.end(), keyword) ==
                       kPassedOver.end()) {
                text_.refuse("mesh.bad_line", shown(keyword) +
                                                  " is no keyword of OBJ files; "
                                                  "delete the line or export the part again");
            }
        }
        check_indices();
        return std::move(soup_);
    }

private:
    void read_point() {
        Eigen::Vector3d point;
        for (double& x : point) {
            x = text_.number("the coordinates of a point");
        }
        soup_.points.push_back(point);
    }

    // "7", "7/1", "7//3", "7/1/3"; -1 is the point before this line.
    void read_face() {
        const std::size_t begin = soup_.corners.size();
        for (std::string_view word = text_.word(); !word.empty(); word = text_.word()) {
            soup_.corners.push_back(corner_of(word));
            if (soup_.corners.size() - begin > kMaxCorners) {
                text_.refuse("mesh.large_polygon", large_polygon_words());
            }
        }
        soup_.ends.push_back(soup_.corners.size());
        line_of_.push_back(text_.line());
    }

    std::int32_t corner_of(std::string_view word) {
        const auto count = static_cast<std::int64_t>(soup_.points.size());
        std::int64_t index = 0;
        if (!parse_integer(word.substr(0, word.find('/')), index)) {
            text_.refuse("mesh.bad_line", shown(word) +
                                              " is no corner of a polygon, such as 7 or "
                                              "7/1/3; export the part again");
        }
        if (index == 0 || index < -count || index > std::numeric_limits<std::int32_t>::max()) {
            text_.refuse("mesh.bad_index", bad_index_words(index, 1, soup_.points.size()));
        }
        return static_cast<std::int32_t>(index < 0 ? count + index : index - 1);
    }

    // A polygon may stand before its points, so these are counted only now.
    void check_indices() const {
        std::size_t polygon = 0;
        for (std::size_t i = 0; i < soup_.corners.size(); ++i) {
            while (soup_.ends[polygon] <= i) {
                ++polygon;
            }
            if (static_cast<std::size_t>(soup_.corners[i]) >= soup_.points.size()) {
                throw InputError(
                    "mesh.bad_index", text_.place(line_of_[polygon]),
                    bad_index_words(soup_.corners[i] + std::int64_t{1}, 1, soup_.points.size()));
            }
        }
    }

    MeshText text_;
    PolygonSoup soup_;
    std::vector<std::int64_t> line_of_;  // per polygon
};

}  // namespace

PolygonSoup read_obj(std::string_view bytes, const std::string& file) {
    return ObjReader(bytes, file).read();
}

}  // namespace meshwind
