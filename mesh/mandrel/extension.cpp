#include "mesh/mandrel/extension.h"
#include "mesh/smooth/freeze.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "core/units.h"
#include "mesh/edge_table.h"
#include "mesh/smooth/jet_fit.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using Index = std::int32_t;

// Vertices around an extension: h = R / 15, where patches are within 1e-5 mm of a cylinder of R =
// 100 mm.
constexpr int kMinAround = 96;

std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
}

// A rim's circle as coordinates.
struct Circle {
    Vector3d centre_mm, axis, x, y;
    double radius_mm;

    explicit Circle(const Rim& rim)
        : centre_mm(rim.centre_mm),
          axis(rim.axis),
          x(rim.axis.unitOrthogonal()),
          y(rim.axis.cross(x)),
          radius_mm(rim.radius_mm) {}

    [[nodiscard]] Vector3d point(double azimuth, double height) const {
        return centre_mm + height * axis +
               radius_mm * (std::cos(azimuth) * x + std::sin(azimuth) * y);
    }
    [[nodiscard]] double azimuth(const Vector3d& p) const {
        return std::atan2((p - centre_mm).dot(y), (p - centre_mm).dot(x));
    }
    [[nodiscard]] double height(const Vector3d& p) const { return (p - centre_mm).dot(axis); }

    // Of the cylinder through a point: z = sqrt(R^2 - x^2) - R, to the fourth order.
    [[nodiscard]] Jet jet(const Vector3d& p) const {
        const Vector3d out = p - centre_mm - height(p) * axis;
        const double radius = out.norm();
        Jet jet;
        jet.normal = out / radius;
        const Vector3d around = axis.cross(jet.normal);
        jet.height.frame << around, axis, jet.normal;
        jet.height.coefficient[kJetX2] = -0.5 / radius;
        jet.height.coefficient[kJetX4] = -0.125 / (radius * radius * radius);
        jet.shape_operator_per_mm = around * around.transpose() / radius;
        return jet;
    }
};

// The rim's vertices once around, azimuth rising.
struct Loop {
    std::vector<Index> vertex;
    std::vector<double> azimuth;  // unwrapped, one entry more than vertices
    double top_mm;
};

Loop rising_loop(const Circle& circle, const Rim& rim, const Surface& wall) {
    Loop loop{rim.vertices, {}, 0.0};
    const auto unwrap = [&] {
        loop.azimuth.clear();
        double azimuth = circle.azimuth(wall.position_mm[at(loop.vertex.front())]);
        for (std::size_t i = 0; i <= loop.vertex.size(); ++i) {
            const Vector3d& p = wall.position_mm[at(loop.vertex[i % loop.vertex.size()])];
            azimuth += std::remainder(circle.azimuth(p) - azimuth, 2.0 * kPi);
            loop.azimuth.push_back(azimuth);
        }
    };
    unwrap();
    if (loop.azimuth.back() < loop.azimuth.front()) {
        std::reverse(loop.vertex.begin(), loop.vertex.end());
        unwrap();
    }
    for (const Index v : loop.vertex) {
        loop.top_mm = std::max(loop.top_mm, circle.height(wall.position_mm[at(v)]));
    }
    return loop;
}

// Grows the wall's triangles by extensions.
class Extender {
public:
    explicit Extender(const Surface& wall)
        : wall_(wall),
          soup_{wall.position_mm, wall.face},
          feature_(wall.feature),
          region_(wall.region),
          rim_(wall.rim) {}

    void add(const Rim& rim, double length_mm) {
        const Circle circle(rim);
        const Loop loop = rising_loop(circle, rim, wall_);
        circle_.push_back(circle);
        const int around = std::max(kMinAround, static_cast<int>(loop.vertex.size()));
        const double edge = 2.0 * kPi * circle.radius_mm / around;
        const int rows = std::max(3, static_cast<int>(std::ceil(length_mm / edge)));
        const auto first = static_cast<Index>(soup_.points_mm.size());
        for (int r = 1; r <= rows; ++r) {
            const double height = loop.top_mm + length_mm * r / rows;
            for (int i = 0; i < around; ++i) {
                soup_.points_mm.push_back(
                    circle.point(loop.azimuth[0] + 2.0 * kPi * i / around, height));
            }
        }
        join(loop, first, around);
        const auto vertex = [&](int row, int i) { return first + row * around + i % around; };
        for (int r = 0; r + 1 < rows; ++r) {
            for (int i = 0; i < around; ++i) {
                add_face({vertex(r, i), vertex(r, i + 1), vertex(r + 1, i)});
                add_face({vertex(r, i + 1), vertex(r + 1, i + 1), vertex(r + 1, i)});
                if (r + 2 == rows) {
                    rim_.back()[1] = rim.id;
                }
            }
        }
    }

    [[nodiscard]] Surface frozen() {
        const auto neighbours = face_neighbours(soup_.faces);
        for (std::size_t f = 0; f < soup_.faces.size(); ++f) {
            for (std::size_t e = 0; e < 3; ++e) {
                if (rim_[f][e] >= 0 && neighbours[f][e] != kNoFace) {
                    mark_crease(f, e, neighbours[f][e]);
                }
            }
        }
        Surface surface =
            freeze_surface(soup_, {.feature = feature_, .region = region_, .rim = rim_});
        keep_exact(surface);
        for (std::size_t f = wall_.face.size(); f < surface.face.size(); ++f) {
            const Circle& circle = circle_[circle_of_[f - wall_.face.size()]];
            for (std::size_t c = 0; c < 3; ++c) {
                set_jet(surface, at(surface.corner[f][c]),
                        circle.jet(surface.position_mm[at(surface.face[f][c])]));
            }
        }
        return surface;
    }

private:
    void keep_exact(Surface& surface) const {
        surface.cylinder = wall_.cylinder;
        surface.cylinder_of = wall_.cylinder_of;
        if (!wall_.cylinder_of.empty()) {
            surface.cylinder_of.resize(surface.face.size(), -1);
        }
        for (std::size_t f = 0; f < wall_.face.size(); ++f) {
            for (std::size_t c = 0; c < 3; ++c) {
                const std::size_t known = at(wall_.corner[f][c]);
                if (wall_.exact[known] != 0) {
                    surface.exact[at(surface.corner[f][c])] = 1;
                    set_jet(surface, at(surface.corner[f][c]),
                            {wall_.jet[known], wall_.normal[known],
                             wall_.shape_operator_per_mm[known]});
                }
            }
        }
    }

    void add_face(const std::array<Index, 3>& face) {
        soup_.faces.push_back(face);
        circle_of_.push_back(circle_.size() - 1);
        feature_.push_back({0, 0, 0});
        region_.push_back(kExtensionRegion);
        rim_.push_back({-1, -1, -1});
    }

    // Triangles between the rim's vertices and the first row, by azimuth.
    void join(const Loop& loop, Index first, int around) {
        const auto below = static_cast<Index>(loop.vertex.size());
        Index i = 0;
        Index j = 0;
        while (i < below || j < around) {
            const Index low = loop.vertex[at(i % below)];
            const Index up = first + j % around;
            const double next_up = loop.azimuth[0] + 2.0 * kPi * (j + 1) / around;
            if (i < below && (j == around || loop.azimuth[at(i + 1)] <= next_up)) {
                add_face({low, loop.vertex[at((i + 1) % below)], up});
                ++i;
            } else {
                add_face({low, first + (j + 1) % around, up});
                ++j;
            }
        }
    }

    // What was a rim edge lies inside now.
    void mark_crease(std::size_t face, std::size_t edge, Index other) {
        rim_[face][edge] = -1;
        feature_[face][edge] = 1;
        const auto& there = soup_.faces[at(other)];
        const Index start = soup_.faces[face][(edge + 1) % 3];
        const auto across =
            static_cast<std::size_t>(std::find(there.begin(), there.end(), start) - there.begin());
        feature_[at(other)][across] = 1;
    }

    const Surface& wall_;
    TriangleSoup soup_;
    std::vector<std::array<std::uint8_t, 3>> feature_;
    std::vector<Index> region_;
    std::vector<std::array<Index, 3>> rim_;
    std::vector<Circle> circle_;          // per extension
    std::vector<std::size_t> circle_of_;  // per face of an extension
};

}  // namespace

TriangleSoup extension_of(const Rim& rim, double length_mm, int segments) {
    const Eigen::Vector3d u = rim.axis.unitOrthogonal();
    const Eigen::Vector3d v = rim.axis.cross(u);
    TriangleSoup soup;
    for (int i = 0; i < segments; ++i) {
        const double angle = 2.0 * kPi * i / segments;
        const Eigen::Vector3d near =
            rim.centre_mm + rim.radius_mm * (std::cos(angle) * u + std::sin(angle) * v);
        soup.points_mm.push_back(near);
        soup.points_mm.push_back(near + length_mm * rim.axis);
    }
    const std::int32_t middle = 2 * segments;
    soup.points_mm.push_back(rim.centre_mm + length_mm * rim.axis);
    for (std::int32_t i = 0; i < segments; ++i) {
        const std::int32_t a = 2 * i;
        const std::int32_t b = 2 * ((i + 1) % segments);
        soup.faces.push_back({a, b, a + 1});
        soup.faces.push_back({b, b + 1, a + 1});
        soup.faces.push_back({a + 1, b + 1, middle});
    }
    return soup;
}

Surface extended_surface(const Mandrel& mandrel, double length_mm) {
    if (!(length_mm > 0.0) || mandrel.rims.empty()) {
        return mandrel.surface;
    }
    Extender extender(mandrel.surface);
    for (const Rim& rim : mandrel.rims) {
        extender.add(rim, length_mm);
    }
    return extender.frozen();
}

}  // namespace meshwind
