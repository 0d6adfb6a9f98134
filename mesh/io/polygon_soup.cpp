#include "mesh/io/polygon_soup.h"

#include <array>
#include <span>
#include <utility>

#include <Eigen/Geometry>

#include "core/interrupt.h"

namespace meshwind {
namespace {

constexpr std::size_t kPolygonsPerCheck = 256;

double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
    return (b.x() - a.x()) * (c.y() - b.y()) - (b.y() - a.y()) * (c.x() - b.x());
}

// What is left of a polygon that turns left while ears are cut off it.
class Ring {
public:
    explicit Ring(std::vector<Eigen::Vector2d> points)
        : at_(std::move(points)), next_(at_.size()), previous_(at_.size()), ear_(at_.size()) {
        for (std::size_t i = 0; i < at_.size(); ++i) {
            next_[i] = (i + 1) % at_.size();
            previous_[i] = (i + at_.size() - 1) % at_.size();
        }
        for (std::size_t i = 0; i < at_.size(); ++i) {
            ear_[i] = static_cast<char>(is_ear(i));
        }
    }

    // Cuts a corner off, an ear where there is one; the two beside it may have become ears.
    // \pre at least three corners are left
    std::array<std::size_t, 3> cut() {
        std::size_t tip = here_;
        do {
            tip = next_[tip];
        } while (ear_[tip] == 0 && tip != here_);
        const std::array<std::size_t, 3> triangle{previous_[tip], tip, next_[tip]};
        next_[triangle[0]] = triangle[2];
        previous_[triangle[2]] = triangle[0];
        here_ = triangle[0];
        for (const std::size_t beside : {triangle[0], triangle[2]}) {
            ear_[beside] = static_cast<char>(is_ear(beside));
        }
        return triangle;
    }

private:
    // Turns left, and no corner that does not turn left lies in its triangle or on the rim of it.
    [[nodiscard]] bool is_ear(std::size_t tip) const {
        const std::size_t first = previous_[tip];
        const std::size_t last = next_[tip];
        if (!(turn(at_[first], at_[tip], at_[last]) > 0.0)) {
            return false;
        }
        for (std::size_t i = next_[last]; i != first; i = next_[i]) {
            const bool at_corner =
                at_[i] == at_[first] || at_[i] == at_[tip] || at_[i] == at_[last];
            if (!at_corner && !(turn(at_[previous_[i]], at_[i], at_[next_[i]]) > 0.0) &&
                turn(at_[first], at_[tip], at_[i]) >= 0.0 &&
                turn(at_[tip], at_[last], at_[i]) >= 0.0 &&
                turn(at_[last], at_[first], at_[i]) >= 0.0) {
                return false;
            }
        }
        return true;
    }

    std::vector<Eigen::Vector2d> at_;
    std::vector<std::size_t> next_;
    std::vector<std::size_t> previous_;
    std::vector<char> ear_;
    std::size_t here_ = 0;
};

// In the plane of the polygon's mean normal (Newell), from where it turns left.
std::vector<Eigen::Vector2d> flattened(const std::vector<Eigen::Vector3d>& points,
                                       std::span<const std::int32_t> corners) {
    const auto point = [&](std::size_t i) {
        return points[static_cast<std::size_t>(corners[i % corners.size()])];
    };
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < corners.size(); ++i) {
        normal += (point(i) - point(0)).cross(point(i + 1) - point(0));
    }
    Eigen::Index across = 0;
    normal.cwiseAbs().maxCoeff(&across);
    const Eigen::Index u = (across + 1) % 3;
    const Eigen::Index v = (across + 2) % 3;
    const bool below = normal[across] < 0.0;
    std::vector<Eigen::Vector2d> flat;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Eigen::Vector3d p = point(i) - point(0);
        flat.emplace_back(below ? p[v] : p[u], below ? p[u] : p[v]);
    }
    return flat;
}

void split(const std::vector<Eigen::Vector3d>& points, std::span<const std::int32_t> corners,
           std::vector<std::array<std::int32_t, 3>>& faces) {
    if (corners.size() < 3) {
        return;
    }
    if (corners.size() == 3) {
        faces.push_back({corners[0], corners[1], corners[2]});
        return;
    }
    Ring ring(flattened(points, corners));
    for (std::size_t left = corners.size(); left > 2; --left) {
        const auto [a, b, c] = ring.cut();
        faces.push_back({corners[a], corners[b], corners[c]});
    }
}

}  // namespace

std::string large_polygon_words() {
    // Not in one expression: GCC 12 sees a copy of too many bytes in that, and is wrong.
    std::string words = "a polygon has more than ";
    words += std::to_string(kMaxCorners);
    return words + " corners, which is not read; export the part as triangles";
}

std::string bad_index_words(std::int64_t index, std::int64_t first, std::size_t point_count) {
    const auto last = static_cast<std::int64_t>(point_count) + first - 1;
    return "a polygon names point " + std::to_string(index) +
           (point_count == 0
                ? ", the file has none"
                : ", the file has " + std::to_string(first) + " to " + std::to_string(last)) +
           "; export the part again";
}

TriangleSoup triangles_of(PolygonSoup&& polygons) {
    TriangleSoup soup;
    soup.points_mm = std::move(polygons.points);
    soup.faces.reserve(polygons.ends.size());
    std::size_t begin = 0;
    for (std::size_t i = 0; i < polygons.ends.size(); ++i) {
        if (i % kPolygonsPerCheck == 0) {
            check_interrupt();
        }
        const std::size_t end = polygons.ends[i];
        split(soup.points_mm, std::span(polygons.corners).subspan(begin, end - begin), soup.faces);
        begin = end;
    }
    return soup;
}

}  // namespace meshwind
