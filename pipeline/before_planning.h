/// Feasibility checks of a job before planning.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "machines/machine.h"
#include "mesh/mandrel.h"
#include "pipeline/job/job.h"
#include "postproc/collision/collision.h"

namespace meshwind {

struct PlannedTask {
    const Machine& machine;
    const HeadEnvelope& envelope;
    const Mandrel& mandrel;
    const Job& job;
    std::filesystem::path machine_file;  ///< for messages
    std::filesystem::path job_file;      ///< empty: none
};

/// Refuses within a fraction of a second jobs that no plan can wind: a wall in pieces, an end that
/// is no circle, a part beyond the travel of the axes or in the way of a body of the machine, a tow
/// that is no band on it, an extension on which fibre cannot turn round. All rules are necessary
/// conditions: a refused job could not be wound, and one near the limit is planned
/// (before_planning_test.cpp, before_planning_test.py).
///
/// Why a fibre stays within reach: the free fibre leaves along the tangent, so where the landing
/// point moves up the spindle, or outward from it, the eye is further up, or further out. A landing
/// point therefore never gets higher or further out than the eye can; and each friction turn runs
/// around its rim once as a hoop, with the eye at the hoop's height, at least the shortest free
/// fibre away, and the head as far from the extension as the clearance asks.
/// \throws InputError mesh.pieces, mesh.end_not_round, mesh.rim_not_round, plan.travel, plan.body,
/// plan.tow_width, plan.no_turn, plan.free_length, plan.amount
void require_can_be_wound(const PlannedTask& task);

/// Remarks, one line each: those of the mandrel, and inputs that may be meant otherwise but can be
/// wound.
[[nodiscard]] std::vector<std::string> remarks_before_planning(const PlannedTask& task);

}  // namespace meshwind
