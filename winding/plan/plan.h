/// A winding plan: courses and the turns that join them, in order, with their coverage.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "winding/plan/details.h"
#include "winding/plan/figures.h"
#include "winding/plan/piece.h"
#include "winding/plan/turns.h"

namespace meshwind {

struct Plan {
    Planner planner = Planner::None;
    std::vector<Piece> pieces;
    int courses = 0;
    int fibres = 0;  ///< continuous fibres, one after the other
    /// Share of the wall that courses of one fibre reach, of two, ... as long as another one adds
    /// to it.
    std::vector<double> reach_of_fibres;
    double fibre_length_mm = 0.0;
    double worst_slip = 0.0;
    double worst_bridge_mm = 0.0;
    double worst_joint_mm =
        0.0;  ///< largest step between the end of a piece and the start of the next
    Coverage coverage;
    std::vector<Uncovered> uncovered;
    std::vector<char> reached;   ///< per place of a stage's ask (stage_ask.h): 1 or 0; or empty
    std::vector<char> joinable;  ///< of those, the ones that the plan's fibres can join; or empty
    std::vector<double> face_layers;   ///< per face of the surface: mean layers
    std::vector<RelaxedRule> what_if;  ///< where wall is out of reach, the most useful first
    std::vector<TurnsAtRim> turns;     ///< per rim
    std::vector<PinRing> pins{};       ///< that the turns need, at most one ring per rim
    std::vector<std::int32_t> family;  ///< per course in winding order (families.h)
    WoundAngles angle;                 ///< of the courses
    /// Of a stage of a wall: lower bound of the fibre for the rest of the wall (winding/bound/).
    std::optional<double> least_fibre_mm;
    Places places;  ///< of junctions and hoops in the winding order
    PlanDetails details;
    PlanEffort effort;
    bool continues_fibre = false;  ///< begins where the fibre of the layer before ends
    std::string cut_reason;        ///< in words why it does not, where there is a layer before
    std::string failure;           ///< empty, or in words why nothing can be wound

    /// Null where the plan is of another kind.
    [[nodiscard]] const LaidPattern* pattern() const { return std::get_if<LaidPattern>(&details); }
    [[nodiscard]] const LaidElbow* elbow() const { return std::get_if<LaidElbow>(&details); }
};

/// The commonest rejection.
[[nodiscard]] CourseFault commonest_rejection(const PlanEffort& effort);

/// In words, "123 of 456 candidates: reaches no rim" and "12 of 34: the head would come too near".
[[nodiscard]] std::string refused_most(const PlanEffort& effort);
[[nodiscard]] std::string rejected_most(const PlanEffort& effort);

}  // namespace meshwind
