// A pattern turns over rims by whatever it is given.
#include "winding/revolution/rim_turns.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/units.h"
#include "mesh/revolution/revolution.h"
#include "tests/support/fixtures.h"
#include "winding/revolution/pattern_plan.h"

namespace meshwind {
namespace {

constexpr Tow kTow{.width_mm = 6.0, .thickness_mm = 0.25, .friction = 0.2};
constexpr double kExtension_mm = 150.0;
constexpr double kLeast_rad = 1.0;

// "closes within 0.01 deg"
constexpr double kClosure_rad = rad_from_deg(0.01);

// By friction, around a ring that stands on the extension: no turn dwells less than kLeast_rad.
class RingTurns final : public RimTurns {
public:
    RingTurns(const Tow& tow, double extension_mm) : inner_(friction_turns(tow, extension_mm)) {}

    std::string add(const RimEnd& end) override {
        ++ends_;
        return inner_->add(end);
    }
    double shortest_rad(std::size_t end) const override { return inner_->shortest_rad(end); }
    double least_dwell_rad() const override { return kLeast_rad; }
    FoundPattern find(const PatternConstraints& wish, const Find& find) override {
        PatternConstraints longer = wish;
        longer.least_dwell_rad = std::max(wish.least_dwell_rad, kLeast_rad);
        return find(longer);
    }
    std::string place(const Pattern& pattern, std::int64_t series) override {
        EXPECT_EQ(ends_, 2);
        EXPECT_EQ(series, 1);
        return pattern.circuits > 0 ? "" : "no circuits";
    }
    LaidTurn turn(std::size_t end, const RimCrossing& from, const RimCrossing& to) override {
        LaidTurn laid = inner_->turn(end, from, to);
        if (std::none_of(rings_.begin(), rings_.end(),
                         [&](const PinRing& ring) { return ring.rim == laid.rim; })) {
            rings_.push_back({.rim = laid.rim, .count = 1});
        }
        return laid;
    }
    std::vector<PinRing> pins() const override { return rings_; }

private:
    std::unique_ptr<RimTurns> inner_;
    int ends_ = 0;
    std::vector<PinRing> rings_;
};

Plan planned_on_a_pipe(RimTurnsMaker turns) {
    const Mandrel pipe = test::made_cylinder(40.0, 120.0, 5.0);
    const RevolutionFinding found = find_revolution(pipe);
    EXPECT_TRUE(found.body.has_value()) << found.why_not;
    PatternOptions options{.angle_rad = rad_from_deg(50.0), .tow = kTow};
    options.turn.extension_mm = kExtension_mm;
    options.turns = std::move(turns);
    return plan_pattern(pipe, *found.body, options);
}

TEST(RimTurns, AnotherKindClosesItsPattern) {
    const Plan plan = planned_on_a_pipe([](const Tow& tow, double extension_mm) {
        EXPECT_EQ(tow.width_mm, kTow.width_mm);
        EXPECT_EQ(extension_mm, kExtension_mm);
        return std::make_unique<RingTurns>(tow, extension_mm);
    });
    ASSERT_EQ(plan.failure, "");
    ASSERT_NE(plan.pattern(), nullptr);
    EXPECT_LT(plan.pattern()->closure_rad, kClosure_rad);
    // Dwell of the pattern is that of both ends.
    EXPECT_GE(plan.pattern()->pattern.dwell_rad, 2.0 * kLeast_rad);
    EXPECT_EQ(plan.pins.size(), 2U);
}

TEST(RimTurns, FrictionSaysWhatATurnTakes) {
    EXPECT_EQ(planned_on_a_pipe(friction_turns).failure, "");
    Rim rim;
    rim.radius_mm = 40.0;
    const RimEnd steep{.end = 1, .rim = rim, .crossing = {.angle_rad = rad_from_deg(10.0)}};
    EXPECT_TRUE(friction_turns(kTow, kExtension_mm)->add(steep).starts_with("over the upper rim"));
    const RimEnd flat{.end = 0, .rim = rim, .crossing = {.angle_rad = rad_from_deg(60.0)}};
    EXPECT_EQ(friction_turns(kTow, kExtension_mm)->add(flat), "");
}

TEST(RimTurns, WithoutAnyOnlyWhatTurnsByItselfIsWound) {
    const Plan plan = planned_on_a_pipe([](const Tow&, double) { return no_rim_turns(); });
    EXPECT_NE(plan.failure.find("turns about no pole"), std::string::npos) << plan.failure;
    EXPECT_EQ(no_rim_turns()->why_no_ends(1.0), "");
}

}  // namespace
}  // namespace meshwind
