#include "winding/cover/uncovered.h"

#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace meshwind {
namespace {

// One face, seven samples of 2 mm2: 0 is covered; 1 and 2 are passed by rejected members only; 3 by
// a rejected and a usable one; 4 and 5 by none; 6 by three, of which the one that was tried does
// not hold.
TEST(UncoveredWall, NamesWhatBecameOfMostCourses) {
    Surface surface;
    surface.region = {7};
    CoverageSamples samples;
    samples.at.assign(7, {0, Eigen::Vector3d::Constant(1.0 / 3.0)});
    samples.area_mm2 = 2.0;
    Library library;
    library.members.resize(7);
    library.members[0].footprint = {0, 1, 2};
    library.members[1].footprint = {1};
    library.members[2].footprint = {1, 2, 3};
    library.members[3].footprint = {0, 3};
    for (std::size_t i = 4; i < 7; ++i) {
        library.members[i].footprint = {6};
    }
    library.reached = {1, 1, 1, 1, 0, 0, 0};
    library.closest_miss = {CandidateFault::None,    CandidateFault::None,     CandidateFault::None,
                            CandidateFault::Slips,   CandidateFault::Bridging, CandidateFault::None,
                            CandidateFault::Bridging};
    const std::vector<CourseFault> rejection{
        CourseFault::HeadHit,    CourseFault::Slip, CourseFault::HeadHit, CourseFault::None,
        CourseFault::FreeLength, CourseFault::None, CourseFault::None};
    const std::vector<std::int32_t> layers{1, 0, 0, 0, 0, 0, 0};
    std::map<std::string, double> bare;
    for (const Uncovered& u : uncovered_wall(surface, samples, library, rejection, layers)) {
        EXPECT_EQ(u.region, 7);
        bare[u.reason] += u.area_mm2;
    }
    const std::map<std::string, double> expected{
        {"the head would come too near (so with 2 courses that would cover it)", 4.0},
        {"a course for it would lay more fibre over covered wall than it gains", 2.0},
        {name_of(CourseFault::FreeLength) + std::string(" (so with 1 course that would cover it)"),
         2.0},
        {name_of(CandidateFault::Bridging), 2.0},
        {"no candidate was tried here", 2.0}};
    EXPECT_EQ(bare, expected);
}

TEST(RejectionNames, AreDistinctWords) {
    std::set<std::string> names;
    for (std::size_t r = 0; r < kRejections; ++r) {
        names.insert(name_of(static_cast<CourseFault>(r)));
    }
    EXPECT_EQ(names.size(), kRejections);
    EXPECT_EQ(names.count(""), 0U);
}

}  // namespace
}  // namespace meshwind
