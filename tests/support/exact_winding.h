/// Programs that lay exactly known curves, and how far what is laid is from them.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "machines/machine_json.h"
#include "postproc/motion/block.h"
#include "postproc/motion/joint_path.h"
#include "postproc/motion/time_law.h"
#include "postproc/verify/deviation.h"
#include "postproc/verify/laydown.h"
#include "tests/support/hourglass.h"
#include "tests/support/reference.h"

namespace meshwind::test {

inline Machine true_machine() {
    return read_machine(std::string(MESHWIND_SOURCE_DIR) + "/machines/six_axis.json");
}

/// The machine with steps of 1e-9 mm and deg: rounding of blocks is below what is measured.
inline Machine fine_machine() {
    Machine machine = true_machine();
    for (auto* chain : {&machine.mandrel_chain, &machine.eye_chain}) {
        for (Axis& axis : *chain) {
            axis.resolution_nano = 1;
        }
    }
    return machine;
}

/// The cylinder around z, as ExactTorus.
struct ExactCylinder {
    double radius_mm = 50.0;

    [[nodiscard]] Eigen::Vector3d normal(const Eigen::Vector3d& p) const {
        return Eigen::Vector3d(p.x(), p.y(), 0.0).normalized();
    }
    [[nodiscard]] Eigen::Matrix3d shape_operator_per_mm(const Eigen::Vector3d& p) const {
        const Eigen::Vector3d around = Eigen::Vector3d::UnitZ().cross(normal(p));
        return 1.0 / radius_mm * around * around.transpose();
    }
};

/// Stations of a curve at equal distances, with the surface's normals.
struct ExactCurve {
    double step_mm = 1.0;
    std::vector<CurveState> states;
    std::vector<Eigen::Vector3d> normals;

    void add(const CurveState& state, const Eigen::Vector3d& normal) {
        states.push_back(state);
        normals.push_back(normal);
    }

    /// Every n-th station.
    [[nodiscard]] ExactCurve coarser(std::size_t n) const {
        ExactCurve curve{step_mm * static_cast<double>(n), {}, {}};
        for (std::size_t i = 0; i < states.size(); i += n) {
            curve.add(states[i], normals[i]);
        }
        return curve;
    }

    /// Distance of a point from the curve, which it is beside at about `s_mm`.
    [[nodiscard]] double distance_mm(const Eigen::Vector3d& point_mm, double s_mm) const {
        auto i = static_cast<std::size_t>(std::max(0.0, s_mm / step_mm));
        i = std::min(i, states.size() - 2);
        const auto along = [&](std::size_t k) {
            return (point_mm - states[k].position_mm).dot(states[k].tangent);
        };
        while (i > 0 && along(i) < 0.0) {
            --i;
        }
        while (i + 2 < states.size() && along(i + 1) > 0.0) {
            ++i;
        }
        const CubicPlace place = beside(states[i].position_mm, states[i].tangent,
                                        states[i + 1].position_mm, states[i + 1].tangent, point_mm);
        const Eigen::Vector3d off = point_mm - place.position_mm;
        return (off - place.tangent * place.tangent.dot(off)).norm();
    }
};

template <class Shape>
ExactCurve exact_curve(const Shape& shape, const CurveState& start, double slip_ratio,
                       double step_mm, double length_mm) {
    ExactCurve curve{step_mm, {}, {}};
    CurveState state = start;
    const int steps = static_cast<int>(std::lround(length_mm / step_mm));
    for (int i = 0; i <= steps; ++i) {
        curve.add(state, shape.normal(state.position_mm));
        state = follow(shape, state, step_mm, slip_ratio);
    }
    return curve;
}

/// Up a meridian of the hourglass, with the straight fibre between the shoulders.
inline ExactCurve meridian(const Hourglass& shape, double step_mm) {
    ExactCurve curve{step_mm, {}, {}};
    // The fibre at height z, in the direction that it has where it leaves the wall.
    const auto add = [&](double z, double wall_z) {
        const Eigen::Vector3d p(shape.point(wall_z).x(), 0.0, wall_z);
        const Eigen::Vector3d n = shape.normal(p);
        curve.add({{p.x(), 0.0, z}, n.cross(Eigen::Vector3d::UnitY())}, n);
    };
    const double turn = step_mm / shape.shoulder_mm;
    const int steps = static_cast<int>(rad_from_deg(30.0) / turn);
    const auto rise_mm = [&](int i) { return shape.shoulder_mm * std::sin(i * turn); };
    for (int i = -steps; i <= 0; ++i) {
        add(-shape.height_mm + rise_mm(i), -shape.height_mm + rise_mm(i));
    }
    const int over = static_cast<int>(2.0 * shape.height_mm / step_mm);
    for (int i = 1; i < over; ++i) {
        add(-shape.height_mm + i * step_mm, -shape.height_mm);
    }
    for (int i = 0; i <= steps; ++i) {
        add(shape.height_mm + rise_mm(i), shape.height_mm + rise_mm(i));
    }
    return curve;
}

/// The stations as a plan.
inline PlannedFibre planned_fibre(const ExactCurve& curve) {
    PlannedFibre fibre;
    for (std::size_t i = 0; i < curve.states.size(); ++i) {
        fibre.push_back({0, static_cast<std::int32_t>(i), curve.states[i].position_mm,
                         curve.normals[i], curve.states[i].tangent, false});
    }
    return fibre;
}

/// The eye a free length ahead of every station.
inline EyePath eye_path(const ExactCurve& curve, double free_mm) {
    EyePath path;
    for (std::size_t i = 0; i < curve.states.size(); ++i) {
        EyePoint point;
        point.point = static_cast<std::int32_t>(i);
        point.s_mm = curve.step_mm * static_cast<double>(i);
        point.landing_mm = curve.states[i].position_mm;
        point.tangent = curve.states[i].tangent;
        point.binormal = curve.normals[i].cross(point.tangent);
        point.free_length_mm = free_mm;
        point.eye_mm = point.landing_mm + free_mm * point.tangent;
        path.push_back(point);
    }
    return path;
}

inline BlockList program(const Machine& machine, const EyePath& path, RedundancyPolicy policy) {
    const JointPath joints = solve_joints(machine, path, policy);
    return make_blocks(machine, path, joints, fibre_moved_mm(path)).list;
}

/// Largest distance of laid stations from the curve.
inline double farthest_mm(const LaidPath& laid, const ExactCurve& curve) {
    double farthest = 0.0;
    for (const PathPoint& station : laid.path) {
        farthest = std::max(farthest, curve.distance_mm(station.position_mm, station.s_mm));
    }
    return farthest;
}

}  // namespace meshwind::test
