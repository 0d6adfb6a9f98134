/// Knots of a path, at which turn and free length are chosen, and the axes there. For
/// optimal_motion.h alone.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "machines/kinematics.h"
#include "postproc/motion/optimal_motion.h"

namespace meshwind {

/// Choice at a knot.
struct KnotChoice {
    double turn_rad = 0.0;   ///< of the mandrel about +Z
    double length_mm = 0.0;  ///< free length
};

/// A knot: a place of the path.
struct Knot {
    std::size_t station = 0;
    double ahead_mm = 0.0;    ///< fibre to the next place, > 0
    double longest_mm = 0.0;  ///< longest free fibre that meets nothing
    bool kept = false;        ///< the given motion is kept
    KnotChoice given;         ///< of that motion
};

/// The knots of a stretch of a task's path.
class MotionKnots {
public:
    /// \param first, last stations; both are places
    MotionKnots(const OptimalMotionTask& task, std::size_t first, std::size_t last);

    [[nodiscard]] std::size_t size() const { return knots_.size(); }
    [[nodiscard]] const Knot& operator[](std::size_t i) const { return knots_[i]; }
    [[nodiscard]] std::size_t axis_count() const { return task_.machine.axis_count(); }
    [[nodiscard]] const Axis& axis(std::size_t joint) const { return task_.machine.axis(joint); }
    [[nodiscard]] const OptimalMotionTask& task() const { return task_; }

    [[nodiscard]] const EyePoint& point(std::size_t knot) const {
        return task_.path[knots_[knot].station];
    }
    [[nodiscard]] double least_mm(std::size_t knot) const;

    /// Time from a knot to the next at the fibre's full speed.
    [[nodiscard]] double step_s(std::size_t knot) const {
        return knots_[knot].ahead_mm / task_.fibre_speed_mm_s;
    }

    [[nodiscard]] Eigen::Vector3d eye_mm(std::size_t knot, double length_mm) const {
        return point(knot).landing_mm + length_mm * point(knot).tangent;
    }

    /// The turn that brings the eye to y = 0, x > 0 of the machine, within half a turn of
    /// `near_rad`.
    [[nodiscard]] double central_rad(std::size_t knot, double length_mm, double near_rad) const;

    /// Start for the axes of the first place: all zero, or with an arm as in the given motion.
    [[nodiscard]] std::span<const double> start() const { return given_joints(0); }

    [[nodiscard]] bool moves_eye(std::size_t joint) const {
        return inverse_->has_branches() || joint < task_.machine.mandrel_chain.size() ||
               axis(joint).type == AxisType::Linear;
    }

    /// Axes at a place, near to others.
    void joints(std::size_t knot, const KnotChoice& choice, std::span<const double> previous,
                std::span<double> joints) const;

    /// Whether fibre, head and arm are clear at a knot by the rules, and the axes within their
    /// travel.
    [[nodiscard]] bool clear(std::size_t knot, const KnotChoice& choice) const;

    /// The same at the stations between a knot and the next, where both choices pass evenly into
    /// one another.
    [[nodiscard]] bool clear_between(std::size_t knot, const KnotChoice& from,
                                     const KnotChoice& to) const;

private:
    void find_joints();
    [[nodiscard]] std::span<const double> given_joints(std::size_t knot) const {
        return {joints_.data() + (inverse_->has_branches() ? knot : 0) * axis_count(),
                axis_count()};
    }
    [[nodiscard]] bool in_reach(std::size_t knot, const KnotChoice& choice) const;
    [[nodiscard]] bool head_clear(std::size_t station, const KnotChoice& choice) const;

    const OptimalMotionTask& task_;
    std::unique_ptr<EyeInverse> inverse_;
    std::vector<double> joints_;  // of an arm at each place in the given motion; else zero, once
    std::vector<Knot> knots_;
};

/// Choices of least time for all knots, by dynamic programming on a grid.
[[nodiscard]] std::vector<KnotChoice> choose_on_grid(const MotionKnots& knots);

/// Choices of less time near those given.
[[nodiscard]] std::vector<KnotChoice> smooth_motion(const MotionKnots& knots,
                                                    std::vector<KnotChoice> choices);

}  // namespace meshwind
