/// Samples and lookup tables of the annealing, and the courses on them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/index.h"
#include "core/random.h"
#include "winding/cover/grow_library.h"
#include "winding/cover/library.h"
#include "winding/cover/rim_joints.h"
#include "winding/cover/select_courses.h"
#include "winding/cover/symmetry.h"
#include "winding/laminate/families.h"
#include "winding/laminate/samples.h"
#include "winding/plan/course.h"

namespace meshwind {

/// Samples and tables on which courses are weighed. The samples are others than those that coverage
/// is measured on, so that courses are not made even just for the places that are measured.
struct AnnealGround {
    /// \param weighed the samples \param measured those of the members' footprints
    AnnealGround(const CourseRules& rules, CoverageSamples weighed, const CoverageSamples& measured,
                 std::span<const LibraryCourse> library);

    CoverageSamples samples;
    FootprintFinder footprints;
    FootprintFinder strips;                          ///< of the width that a fit needs
    std::vector<std::vector<std::int32_t>> passing;  ///< per sample: members of the library
    Ways ways;                                       ///< of the library
    MirrorImages images;
};

/// Layers over the target, below 0 where they are short of it.
class GroundLayers {
public:
    /// No layers yet. \param samples their number
    GroundLayers(std::size_t samples, const SelectOptions& select);

    [[nodiscard]] std::int32_t over(std::int32_t sample) const { return over_[at(sample)]; }

    /// Lays a footprint, or takes it away: -1 times.
    void lay(std::span<const std::int32_t> footprint, int times);

    /// A random sample, preferably one short of layers.
    [[nodiscard]] std::size_t needy_place(Draws& draws) const;

private:
    std::vector<std::int32_t> over_;  // per sample
};

/// Cost of the layers at a sample: the square of their distance from the even cover, and more where
/// they are short of the target.
class LayerCosts {
public:
    /// \param beyond_layers that an even cover has over the target
    /// \param bare for each layer short of the target
    LayerCosts(double beyond_layers, double bare);

    /// \param over the target
    [[nodiscard]] double of(std::int32_t over) const {
        return cost_[at(std::clamp(over, -kMaxOff, kMaxOff) + kMaxOff)];
    }

private:
    // Distance from the target, in layers, from which on more make no difference.
    static constexpr std::int32_t kMaxOff = 64;

    std::array<double, 2 * kMaxOff + 1> cost_{};  // by layers over the target, from -kMaxOff
};

/// Scratch for one thread.
struct AnnealScratch {
    AnnealScratch(FootprintFinder::Scratch path, std::vector<std::int32_t> zeros)
        : footprint(std::move(path)), shift(std::move(zeros)) {}

    FootprintFinder::Scratch footprint;
    std::vector<std::int32_t> shift;  ///< of layers, while a change is weighed; else 0
};

/// Pool of scratch, one for each concurrent task; all are alike while they are idle. Thread-safe.
class AnnealScratchPool {
public:
    explicit AnnealScratchPool(const AnnealGround& ground) : ground_(ground) {}

    [[nodiscard]] std::unique_ptr<AnnealScratch> take();
    void put_back(std::unique_ptr<AnnealScratch> scratch);

private:
    const AnnealGround& ground_;
    std::mutex mutex_;
    std::vector<std::unique_ptr<AnnealScratch>> idle_;
};

/// A course to put in, one to take out, or both.
struct CourseExchange {
    std::optional<std::size_t> out{};
    std::optional<PlacedCourse> in{};
    std::optional<CourseShape> shape{};  ///< of `in`
    std::vector<char> beside{};          ///< neighbours of `in`, per course
};

/// The current courses, with their layers, joints and neighbours. Const functions are thread-safe.
class AnnealedCourses {
public:
    /// \param courses changed in place; footprints become those of the ground
    AnnealedCourses(const CourseRules& rules, const AnnealGround& ground,
                    const SelectOptions& select, AnnealScratch& scratch,
                    std::vector<PlacedCourse>& courses);

    [[nodiscard]] bool empty() const { return courses_.empty(); }
    [[nodiscard]] const PlacedCourse& operator[](std::size_t course) const {
        return courses_[course];
    }
    /// The number of any course. \pre not empty
    [[nodiscard]] std::size_t any(Draws& draws) const { return draws.below(courses_.size()); }

    [[nodiscard]] const GroundLayers& layers() const { return layers_; }
    [[nodiscard]] const RimJoints& joints() const { return joints_; }

    /// Increase in courses without a family (families.h). Finds the neighbours of `in`.
    [[nodiscard]] int more_alone(CourseExchange& exchange) const;

    /// \pre more_alone() was asked of these courses
    void take(CourseExchange& exchange);

private:
    void lay(const PlacedCourse& course, int times);
    [[nodiscard]] CourseShape shape_of(const PlacedCourse& course) const {
        return CourseShape(course.path, band_mm_);
    }

    std::vector<PlacedCourse>& courses_;
    double band_mm_;
    GroundLayers layers_;
    RimJoints joints_;
    Neighbourhood neighbours_;
    int alone_ = 0;  // courses without a family
};

/// A way between nodes, with the node at which it arrives.
struct ArrivingWay {
    const Way* way = nullptr;
    std::size_t arrival = 0;
};

/// Ways with windable courses that lead from a node where too many courses arrive to one where too
/// many depart, or to another part of the plan.
[[nodiscard]] std::vector<ArrivingWay> ways_that_join(const Ways& ways, const RimJoints& joints);

}  // namespace meshwind
