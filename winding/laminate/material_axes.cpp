#include "winding/laminate/material_axes.h"

#include <cmath>
#include <optional>

#include <Eigen/Geometry>

#include "core/index.h"
#include "core/units.h"
#include "geodesic/trace.h"
#include "mesh/revolution/revolution.h"
#include "mesh/tube/tube.h"
#include "winding/laminate/wound_angle.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Sine between an axis and a triangle's normal below which its projection is noise of the mesh.
constexpr double kStandsOn = 0.01;

// Within so much of a rim's axis (2 deg) the axial direction is that axis: what differs is noise of
// the wall's curvature.
const double kSameAxis = std::cos(rad_from_deg(2.0));

// Neighbours whose axes differ by less (30 deg) belong to one pipe: edges of a bend turn less, a
// branch leaves its run at more.
const double kOnePipe = std::cos(rad_from_deg(30.0));

// A sum of axes that is nearer to square than this (cosine) says nothing about the sense.
constexpr double kSquare = 0.05;

std::optional<Vector3d> projected(const Vector3d& axis, const Vector3d& normal) {
    const Vector3d flat = axis - normal * normal.dot(axis);
    const double length = flat.norm();
    return length > kStandsOn ? std::optional<Vector3d>(flat / length) : std::nullopt;
}

Vector3d spindle_on(const Vector3d& normal) {
    const auto along = projected(Vector3d::UnitZ(), normal);
    return along ? *along : *projected(Vector3d::UnitX(), normal);
}

class AxisFinder {
public:
    explicit AxisFinder(const Mandrel& mandrel)
        : mandrel_(mandrel), surface_(mandrel.surface), axis_(surface_.face.size()) {}

    std::vector<Vector3d> run() {
        if (find_revolution(mandrel_).body) {
            for (std::size_t f = 0; f < axis_.size(); ++f) {
                axis_[f] = spindle_on(normal(f));
            }
            return std::move(axis_);
        }
        if (const TubeFinding found = find_tube(mandrel_); found.tube) {
            along_line(found.tube->line);
        } else {
            along_pipes();
        }
        give_sense();
        for (std::size_t f = 0; f < axis_.size(); ++f) {
            if (!piped_[f]) {
                axis_[f] = spindle_on(normal(f));
            }
        }
        return std::move(axis_);
    }

private:
    [[nodiscard]] Vector3d corner(std::size_t f, std::size_t k) const {
        return surface_.position_mm[at(surface_.face[f][k])];
    }

    [[nodiscard]] Vector3d normal(std::size_t f) const {
        return (corner(f, 1) - corner(f, 0)).cross(corner(f, 2) - corner(f, 0)).normalized();
    }

    void along_line(const CentreLine& line) {
        piped_.assign(axis_.size(), 0);
        for (std::size_t f = 0; f < axis_.size(); ++f) {
            const Vector3d centre = (corner(f, 0) + corner(f, 1) + corner(f, 2)) / 3.0;
            take(f, projected(line.foot(centre).tangent, normal(f)));
        }
    }

    void along_pipes() {
        piped_.assign(axis_.size(), 0);
        std::vector<Vector3d> known{Vector3d::UnitZ()};
        for (const Rim& rim : mandrel_.rims) {
            known.push_back(rim.axis);
        }
        for (std::size_t f = 0; f < axis_.size(); ++f) {
            const SurfacePoint centre{static_cast<std::int32_t>(f)};
            const auto angle = axial_direction_rad(surface_, centre);
            if (!angle) {
                continue;
            }
            const Vector3d smooth = smooth_normal(surface_, centre);
            Vector3d axial = Eigen::AngleAxisd(*angle, smooth) * smooth.unitOrthogonal();
            for (const Vector3d& candidate : known) {
                if (std::abs(candidate.dot(axial)) > kSameAxis) {
                    axial = candidate;
                    break;
                }
            }
            take(f, projected(axial, normal(f)));
        }
    }

    void take(std::size_t f, const std::optional<Vector3d>& axis) {
        if (axis) {
            axis_[f] = *axis;
            piped_[f] = 1;
        }
    }

    // Each pipe's axes one way.
    void give_sense() {
        std::vector<char> done(axis_.size(), 0);
        for (std::size_t first = 0; first < axis_.size(); ++first) {
            if (piped_[first] == 0 || done[first] != 0) {
                continue;
            }
            done[first] = 1;
            std::vector<std::size_t> pipe{first};
            Vector3d sum = Vector3d::Zero();
            double area = 0.0;
            for (std::size_t i = 0; i < pipe.size(); ++i) {
                const std::size_t f = pipe[i];
                const double mm2 =
                    (corner(f, 1) - corner(f, 0)).cross(corner(f, 2) - corner(f, 0)).norm();
                sum += mm2 * axis_[f];
                area += mm2;
                for (const std::int32_t next : surface_.neighbour[f]) {
                    if (next == kNoFace || piped_[at(next)] == 0 || done[at(next)] != 0) {
                        continue;
                    }
                    const double together = axis_[at(next)].dot(axis_[f]);
                    if (std::abs(together) > kOnePipe) {
                        axis_[at(next)] *= together < 0.0 ? -1.0 : 1.0;
                        done[at(next)] = 1;
                        pipe.push_back(at(next));
                    }
                }
            }
            if (points_back(sum / area)) {
                for (const std::size_t f : pipe) {
                    axis_[f] = -axis_[f];
                }
            }
        }
    }

    static bool points_back(const Vector3d& mean) {
        for (const int k : {2, 0, 1}) {
            if (std::abs(mean[k]) > kSquare) {
                return mean[k] < 0.0;
            }
        }
        return false;
    }

    const Mandrel& mandrel_;
    const Surface& surface_;
    std::vector<Vector3d> axis_;
    std::vector<char> piped_;  // has an axis of its own
};

}  // namespace

std::vector<Vector3d> material_axes(const Mandrel& mandrel) {
    return AxisFinder(mandrel).run();
}

double ply_angle_rad(const Vector3d& axis, const Vector3d& normal, const Vector3d& along) {
    const double angle = std::atan2(along.dot(normal.cross(axis)), along.dot(axis));
    if (angle > 0.5 * kPi) {
        return angle - kPi;
    }
    return angle <= -0.5 * kPi ? angle + kPi : angle;
}

}  // namespace meshwind
