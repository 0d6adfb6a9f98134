/// A machine for tests of planners: it winds everything but what a test lets it refuse.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "winding/plan/windability.h"

namespace meshwind::test {

struct AnyMachine : Windability {
    std::function<CourseFault(std::span<const Piece>)> follow_rule{};
    std::function<CourseFault(std::span<const Piece>)> alone_rule{};
    std::function<std::vector<std::size_t>(std::span<const Piece>)> refused_rule{};

    [[nodiscard]] CourseFault follow(std::span<const Piece> pieces) const override {
        return follow_rule ? follow_rule(pieces) : CourseFault::None;
    }
    [[nodiscard]] CourseFault wind_alone(std::span<const Piece> pieces) const override {
        return alone_rule ? alone_rule(pieces) : CourseFault::None;
    }
    [[nodiscard]] CourseFault wind_circuits(std::span<const Piece> pieces) const override {
        return wind_alone(pieces);
    }
    [[nodiscard]] std::unique_ptr<TrialWinding> wind_all(const Plan& plan) const override {
        auto trial = std::make_unique<TrialWinding>();
        if (refused_rule) {
            trial->refused = refused_rule(plan.pieces);
        }
        return trial;
    }
};

}  // namespace meshwind::test
