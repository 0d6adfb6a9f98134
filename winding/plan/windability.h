/// The planners' interface to the machine: whether pieces and plans can be wound.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "winding/plan/course_fault.h"
#include "winding/plan/piece.h"
#include "winding/plan/plan.h"

namespace meshwind {

/// A whole plan, wound on trial. The machine's side derives from it and keeps its results there, so
/// that an accepted plan need not be wound once more.
struct TrialWinding {
    TrialWinding() = default;
    TrialWinding(const TrialWinding&) = delete;
    TrialWinding& operator=(const TrialWinding&) = delete;
    virtual ~TrialWinding() = default;

    std::vector<std::size_t> refused;  ///< pieces that the programs do not lay as planned
    std::string why;                   ///< in words: the commonest reason; empty where none is
};

/// Pieces are in the order and direction in which they would be wound. Answers are pure.
class Windability {
public:
    Windability() = default;
    Windability(const Windability&) = delete;
    Windability& operator=(const Windability&) = delete;
    virtual ~Windability() = default;

    /// Whether eye and axes can follow a stretch of fibre: None, or the first reason why not.
    /// Thread-safe.
    [[nodiscard]] virtual CourseFault follow(std::span<const Piece> pieces) const = 0;

    /// Whether a program of the pieces alone, wound again, lays them as planned. Thread-safe; takes
    /// some hundred times as long as follow().
    [[nodiscard]] virtual CourseFault wind_alone(std::span<const Piece> pieces) const = 0;

    /// The same for the first circuits of a pattern, with every free length tried as by wind_all():
    /// seconds.
    [[nodiscard]] virtual CourseFault wind_circuits(std::span<const Piece> pieces) const = 0;

    /// Winds all of a plan, each piece in its place. Seconds.
    [[nodiscard]] virtual std::unique_ptr<TrialWinding> wind_all(const Plan& plan) const = 0;
};

struct TriedPlan {
    Plan plan;
    std::unique_ptr<TrialWinding> trial;  ///< of this plan; null where it was not wound, or refused
};

}  // namespace meshwind
