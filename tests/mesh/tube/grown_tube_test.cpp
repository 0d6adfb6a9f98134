#include "mesh/tube/grown_tube.h"
#include "mesh/mandrel/load_mandrel.h"

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/units.h"
#include "mesh/mandrel/thicken.h"
#include "mesh/shapes/make_kinds.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr double kRadius_mm = 40.0;
constexpr double kMean_mm = 0.9;
constexpr double kSwing_mm = 0.4;  // thicker by so much inside the bend, thinner outside

class GrownTube : public testing::Test {
protected:
    void SetUp() override {
        const ElbowShape shape{kRadius_mm, 120.0, rad_from_deg(90.0), 150.0, 150.0};
        bare_ = build_mandrel(make_elbow(shape, {.edge_mm = 6.0, .irregular = true}), "part",
                              {.unit_mm = 1.0});
        const TubeFinding found = find_tube(bare_);
        ASSERT_TRUE(found.tube) << found.why_not;
        tube_ = found.tube;
        std::vector<double> thickness_mm;
        for (const Vector3d& position : bare_.surface.position_mm) {
            const CentrePlace foot = tube_->line.foot(position);
            const double outside = (position - foot.position_mm).dot(foot.reference) / kRadius_mm;
            const TubePart& bend = tube_->parts[1];
            const double at = (foot.arc_mm - bend.from_mm) / (bend.to_mm - bend.from_mm);
            const double share = at > 0.0 && at < 1.0 ? std::pow(std::sin(kPi * at), 2.0) : 0.0;
            thickness_mm.push_back(kMean_mm - kSwing_mm * outside * share);
        }
        grown_ = thicken(bare_, thickness_mm);
    }

    Mandrel bare_;
    std::optional<Tube> tube_;
    Mandrel grown_;
};

// Normals of these edges are off by up to 0.01 rad: vertices by that much of the thickness.
constexpr double kNormals_mm = 0.01 * (kMean_mm + kSwing_mm);

TEST_F(GrownTube, KeepsTheBareLine) {
    // By itself the wall is no elbow any more: its sections' centres lie further in.
    const TubeFinding alone = find_tube(grown_);
    EXPECT_TRUE(!alone.tube || alone.tube->parts.size() != 3U);
    const TubeFinding found = grown_tube(*tube_, grown_, kMean_mm + kSwing_mm);
    ASSERT_TRUE(found.tube) << found.why_not;
    const Tube& tube = *found.tube;
    EXPECT_EQ(tube.line.length_mm(), tube_->line.length_mm());
    ASSERT_EQ(tube.parts.size(), 3U);
    EXPECT_EQ(tube.parts[1].bend_radius_mm, tube_->parts[1].bend_radius_mm);
    ASSERT_EQ(tube.radius.size(), 1U);
    // There are fewer vertices inside, so that the mean is below that of the thickness.
    EXPECT_NEAR(tube.radius_at(0.0), kRadius_mm + kMean_mm, 0.25 * kSwing_mm);
    EXPECT_NEAR(tube.residual_mm, kSwing_mm + std::abs(tube.radius_at(0.0) - kRadius_mm - kMean_mm),
                kNormals_mm);
    for (std::size_t end = 0; end < 2; ++end) {
        const Rim& rim = grown_.rims[static_cast<std::size_t>(tube.rim[end])];
        const double along = end == 0 ? 0.0 : tube.line.length_mm();
        EXPECT_LT((tube.line.at(along).position_mm - rim.centre_mm).norm(), 0.05);
        EXPECT_LT(tube.lean_rad[end], rad_from_deg(0.1));
    }
}

TEST_F(GrownTube, RefusesWhatIsNotUnderLayers) {
    const auto has = [](const std::string& text, const char* words) {
        return text.find(words) != std::string::npos;
    };
    // 0.2 mm, the limit of a tube of that radius, are let pass.
    EXPECT_PRED2(has, grown_tube(*tube_, grown_, kMean_mm + kSwing_mm - 0.3).why_not,
                 "mm off the line of a tube of 40.000 mm");
    Tube larger = *tube_;
    larger.radius = {{0.0, kRadius_mm + 1.0}};
    EXPECT_PRED2(has, grown_tube(larger, grown_, 5.0).why_not, "mm off the line of a tube");
    larger.radius.push_back({100.0, kRadius_mm});
    EXPECT_PRED2(has, grown_tube(larger, grown_, 5.0).why_not, "varies");
}

}  // namespace
}  // namespace meshwind
