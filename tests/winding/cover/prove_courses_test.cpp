// What is in reach is what members that hold pass, found by proving as few of them as it takes.
#include "winding/cover/prove_courses.h"

#include <algorithm>
#include <atomic>
#include <numeric>

#include <gtest/gtest.h>

namespace meshwind {
namespace {

constexpr std::size_t kSamples = 30;
constexpr std::int32_t kHard = 29;  // the sample that only members with `hard` pass

LibraryCourse member(std::vector<std::int32_t> footprint) {
    LibraryCourse member;
    member.windable_forward = true;
    member.windable_backward = true;
    member.footprint = std::move(footprint);
    return member;
}

// All samples but the hard one, which `hard` more members pass beside the first.
std::vector<LibraryCourse> members(std::size_t easy, std::size_t hard) {
    std::vector<std::int32_t> all(kSamples - 1);
    std::iota(all.begin(), all.end(), 0);
    std::vector<LibraryCourse> members(easy, member(all));
    members.resize(easy + hard, member({0, kHard}));
    return members;
}

bool passes(const LibraryCourse& member, std::int32_t sample) {
    return std::find(member.footprint.begin(), member.footprint.end(), sample) !=
           member.footprint.end();
}

TEST(ReachProver, TriesAnotherUntilOneHolds) {
    std::vector<LibraryCourse> library = members(100, 100);
    std::atomic<int> proofs = 0;
    ReachProver prover(kSamples, [&](PlacedCourse& course) {
        ++proofs;
        return passes(course.member, kHard) ? CourseFault::FreeLength : CourseFault::None;
    });
    const std::vector<char> reached = prover.prove(library);
    EXPECT_EQ(std::count(reached.begin(), reached.end(), 1), kSamples - 1);
    EXPECT_EQ(reached[kHard], 0);
    EXPECT_EQ(prover.refused().size(), 40U) << "of a hundred that pass the place";
    EXPECT_EQ(proofs, 2 * (1 + 40)) << "both ways";
    for (const auto& [i, rejection] : prover.refused()) {
        EXPECT_TRUE(passes(library[static_cast<std::size_t>(i)], kHard));
        EXPECT_EQ(rejection, CourseFault::FreeLength);
    }
}

TEST(ReachProver, ProvesAllWhereFewPass) {
    std::vector<LibraryCourse> library = members(100, 20);
    ReachProver prover(kSamples, [](PlacedCourse& course) {
        return passes(course.member, kHard) && course.backward ? CourseFault::HeadHit
                                                               : CourseFault::None;
    });
    EXPECT_EQ(prover.prove(library)[kHard], 1);
    EXPECT_TRUE(prover.refused().empty());
    for (const LibraryCourse& one : library) {
        EXPECT_TRUE(one.windable_forward);
        if (passes(one, kHard)) {
            EXPECT_FALSE(one.windable_backward);
        }
    }
}

// Followed accurately a course lies a little beside its sketch.
TEST(ReachProver, CountsWhatIsFoundUnderTheCourse) {
    std::vector<LibraryCourse> library = members(1, 1);
    ReachProver prover(kSamples, [](PlacedCourse& course) {
        if (passes(course.member, kHard)) {
            course.member.footprint = {0};
        }
        return CourseFault::None;
    });
    EXPECT_EQ(prover.prove(library)[kHard], 0);
    EXPECT_FALSE(passes(library[1], kHard));
}

TEST(ReachProver, KnowsWhatItHasProven) {
    std::vector<LibraryCourse> library = members(10, 10);
    std::atomic<int> proofs = 0;
    ReachProver prover(kSamples, [&](PlacedCourse&) {
        ++proofs;
        return CourseFault::None;
    });
    EXPECT_EQ(prover.prove(library)[kHard], 1);
    const int first = proofs;
    EXPECT_EQ(prover.prove(library)[kHard], 1);
    EXPECT_EQ(proofs, first);
    for (LibraryCourse& one : library) {
        one.windable_backward = false;
        one.windable_forward = !passes(one, kHard);
    }
    const std::vector<char> reached = prover.prove(library);
    EXPECT_EQ(reached[kHard], 0) << "off the ways of the fibres";
    EXPECT_EQ(reached[0], 1);
    EXPECT_EQ(proofs, first);
    library.push_back(member({kHard}));
    EXPECT_EQ(prover.prove(library)[kHard], 1);
    EXPECT_EQ(proofs, first + 2);
}

}  // namespace
}  // namespace meshwind
