#include "winding/cover/anneal_ground.h"

#include <utility>

#include "core/index.h"
#include "core/parallel.h"
#include "mesh/nearest.h"
#include "winding/cover/fit_course.h"

namespace meshwind {
namespace {

constexpr std::size_t kSampleChunk = 256;

// The image of a wall that is this near to it makes courses that are near enough: they are judged
// like all others.
constexpr double kSymmetryBands = 0.1;

// Places tried for one that is short of layers.
constexpr int kPlacesTried = 24;

}  // namespace

AnnealGround::AnnealGround(const CourseRules& rules, CoverageSamples weighed,
                           const CoverageSamples& measured, std::span<const LibraryCourse> library)
    : samples(std::move(weighed)),
      footprints(rules.mandrel.surface, samples, rules.tow.width_mm),
      strips(rules.mandrel.surface, samples, kStripBands * rules.tow.width_mm),
      passing(samples.size()),
      ways(ways_between_nodes(library)),
      images(rules.mandrel, samples, kSymmetryBands * rules.tow.width_mm) {
    const NearestPoints index(samples.position_mm);
    std::vector<std::int32_t> beside(measured.size(), -1);
    parallel_for(measured.size(), kSampleChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            beside[i] = index.nearest(measured.position_mm[i]);
        }
    });
    for (std::size_t i = 0; i < library.size(); ++i) {
        for (const std::int32_t sample : library[i].footprint) {
            auto& here = passing[at(beside[at(sample)])];
            if (here.empty() || here.back() != static_cast<std::int32_t>(i)) {
                here.push_back(static_cast<std::int32_t>(i));
            }
        }
    }
}

GroundLayers::GroundLayers(std::size_t samples, const SelectOptions& select) {
    over_.reserve(samples);
    for (std::size_t i = 0; i < samples; ++i) {
        over_.push_back(-select.target(static_cast<std::int32_t>(i)));
    }
}

void GroundLayers::lay(std::span<const std::int32_t> footprint, int times) {
    for (const std::int32_t sample : footprint) {
        over_[at(sample)] += times;
    }
}

std::size_t GroundLayers::needy_place(Draws& draws) const {
    std::size_t best = draws.below(over_.size());
    for (int i = 0; i < kPlacesTried && over_[best] >= 0; ++i) {
        const std::size_t place = draws.below(over_.size());
        best = over_[place] < over_[best] ? place : best;
    }
    return best;
}

LayerCosts::LayerCosts(double beyond_layers, double bare) {
    for (std::size_t i = 0; i < cost_.size(); ++i) {
        const std::int32_t over = static_cast<std::int32_t>(i) - kMaxOff;
        const double off = over - beyond_layers;
        cost_[i] = off * off + bare * std::max(0, -over);
    }
}

std::unique_ptr<AnnealScratch> AnnealScratchPool::take() {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) {
        return std::make_unique<AnnealScratch>(
            ground_.footprints.make_scratch(),
            std::vector<std::int32_t>(ground_.samples.size(), 0));
    }
    std::unique_ptr<AnnealScratch> scratch = std::move(idle_.back());
    idle_.pop_back();
    return scratch;
}

void AnnealScratchPool::put_back(std::unique_ptr<AnnealScratch> scratch) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(scratch));
}

AnnealedCourses::AnnealedCourses(const CourseRules& rules, const AnnealGround& ground,
                                 const SelectOptions& select, AnnealScratch& scratch,
                                 std::vector<PlacedCourse>& courses)
    : courses_(courses),
      band_mm_(rules.tow.width_mm),
      layers_(ground.samples.size(), select),
      joints_(2 * rules.mandrel.rims.size()) {
    for (PlacedCourse& course : courses) {
        course.member.footprint = ground.footprints.footprint(course.path, scratch.footprint);
        lay(course, 1);
        CourseShape shape = shape_of(course);
        const std::vector<char> row = neighbours_.beside(shape);
        neighbours_.add(std::move(shape), row);
    }
    alone_ = neighbours_.without_family();
}

int AnnealedCourses::more_alone(CourseExchange& exchange) const {
    if (exchange.in) {
        if (!exchange.shape) {
            exchange.shape = shape_of(*exchange.in);
        }
        exchange.beside = neighbours_.beside(*exchange.shape);
    }
    return neighbours_.without_family(exchange.out, exchange.in ? &exchange.beside : nullptr) -
           alone_;
}

void AnnealedCourses::take(CourseExchange& exchange) {
    const std::optional<std::size_t> out = exchange.out;
    if (out) {
        lay(courses_[*out], -1);
    }
    if (exchange.in) {
        lay(*exchange.in, 1);
    }
    if (exchange.in && out) {
        courses_[*out] = std::move(*exchange.in);
        neighbours_.replace(*out, std::move(*exchange.shape), exchange.beside);
    } else if (exchange.in) {
        courses_.push_back(std::move(*exchange.in));
        neighbours_.add(std::move(*exchange.shape), exchange.beside);
    } else {
        courses_.erase(courses_.begin() + static_cast<std::ptrdiff_t>(*out));
        neighbours_.remove(*out);
    }
    alone_ = neighbours_.without_family();
}

void AnnealedCourses::lay(const PlacedCourse& course, int times) {
    layers_.lay(course.member.footprint, times);
    joints_.add(course.member, course.backward, times);
}

std::vector<ArrivingWay> ways_that_join(const Ways& ways, const RimJoints& joints) {
    const std::vector<std::size_t> part = joints.part_of();
    std::vector<ArrivingWay> joining;
    for (const auto& [nodes, way] : ways) {
        const auto& [from, to] = nodes;
        const bool evens = joints.excess(from) > 0 && joints.excess(to) < 0;
        const bool joins =
            part[from] != part[to] && joints.has_courses(from) && joints.has_courses(to);
        if ((evens || joins) && !way.windable.empty()) {
            joining.push_back({&way, to});
        }
    }
    return joining;
}

}  // namespace meshwind
