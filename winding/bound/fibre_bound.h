/// Lower bound of the fibre for a wall wound with courses of a library, by linear programming.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "winding/plan/course.h"

namespace meshwind {

/// Input of a bound. References must outlive its finder.
struct BoundTask {
    std::span<const LibraryCourse> members;  ///< the library
    std::span<const char> allowed;           ///< per member
    std::span<const std::int32_t> asked;     ///< per sample: layers
    std::span<const char> reached;           ///< per sample; those not reached ask for nothing
    /// Per sample. Where there are many, samples near each other share a row; empty: some of them
    /// stand for all.
    std::span<const Eigen::Vector3d> position_mm{};
    std::size_t nodes = 0;  ///< 2 for each rim
    /// Share of the samples that may have less than they ask for.
    double most_below = 0.0;
    /// Extra cost of fibre off the wanted winding angle, as a share of it; above 0 the bound is one
    /// of costs, not of fibre.
    double off_angle_cost = 0.0;
};

struct FibreBound {
    /// Lower bound of the fibre of any plan from the library's courses, but for those struck off,
    /// turns included, mm. It is that of a dual solution whose feasibility is computed here, so it
    /// holds however well that was solved.
    double least_mm = 0.0;
    double solved_mm = 0.0;  ///< the least found, by fractional courses; 0 where none was
    double turns_mm = 0.0;   ///< of that, fibre in turns
    /// Number of times that each member is laid there, forward and backward; per member.
    std::vector<double> forward;
    std::vector<double> backward;
};

/// Solves a linear program of fractional courses by column generation: the samples of a cell get
/// their layers on average, but for `most_below` of all layers, and as much fibre arrives at a node
/// as leaves it. Columns are added while some pay. A bound for fractions and cells is one for plans
/// as well.
class FibreBoundFinder {
public:
    explicit FibreBoundFinder(const BoundTask& task);
    ~FibreBoundFinder();
    FibreBoundFinder(const FibreBoundFinder&) = delete;
    FibreBoundFinder& operator=(const FibreBoundFinder&) = delete;
    FibreBoundFinder(FibreBoundFinder&&) = delete;
    FibreBoundFinder& operator=(FibreBoundFinder&&) = delete;

    /// Solves from where the last call ended.
    [[nodiscard]] FibreBound find();

    /// Excludes a member that does not hold.
    void strike_off(std::int32_t member);

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// The same, once.
[[nodiscard]] FibreBound bound_fibre(const BoundTask& task);

/// Rounds a share of those fractions to whole courses: like courses are taken beside each other,
/// one more each time that their sum passes a half, so that they share their roundings.
/// \param members the library
[[nodiscard]] std::vector<DirectedCourse> whole_courses(const FibreBound& bound,
                                                        std::span<const LibraryCourse> members,
                                                        double share);

}  // namespace meshwind
