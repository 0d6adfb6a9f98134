/// Turns pieces of a plan into a program, and winds that program again.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "core/run_context.h"
#include "pipeline/setup.h"
#include "postproc/eye/eye_path.h"
#include "postproc/motion/block.h"
#include "postproc/motion/choose_blocks.h"
#include "postproc/motion/joint_path.h"
#include "postproc/motion/time_law.h"
#include "postproc/nc/repeats.h"
#include "postproc/verify/verify.h"
#include "winding/plan/plan.h"

namespace meshwind {

/// Program and checks of a run of pieces.
struct PieceProgram {
    EyePathResult eyes;           ///< at the stations
    std::size_t path_points = 0;  ///< points that blocks were chosen from
    BlockChoice choice;
    BlockList blocks;         ///< blocks that the program runs, one by one
    BlockList exact;          ///< the ends of these as planned, rounded only to 1e-9 mm or deg
    ProgramLayout layout;     ///< how they are written
    bool optimal = false;     ///< no other known free lengths and turns save 1 % of the time
    double duration_s = 0.0;  ///< of the blocks, starting from rest and stopping, corner_s of it
    double corner_s = 0.0;    ///< added by the controller at corners to the program's durations
    double least_s = 0.0;     ///< duration with the fibre at its full speed all along
    std::vector<BindingLimit> binding;
    BlockList read;             ///< the blocks as they were wound again
    Verification verification;  ///< of these
    /// Pieces that the machine cannot wind, or that the blocks do not lay as planned, each with the
    /// first reason.
    std::map<std::size_t, CourseFault> refused;
};

struct PieceProgramOptions {
    /// Make a program even of pieces that the machine cannot wind.
    bool ignore_limits = false;
    /// All: seconds where no near free length is clear.
    LengthSearch lengths = LengthSearch::Near;
    /// Free lengths and turns of the mandrel for the least time.
    bool optimal = false;
    /// Spindle angle before, if the fibre continues from there: an endless spindle is turned on
    /// from the nearest whole turn.
    std::optional<double> spindle_rad{};
    /// Writes the blocks to text and reads them back. Empty: they are wound as they are.
    std::function<BlockList(const PieceProgram&)> round_trip;
    RunContext context{};
    std::function<void(const char* stage)> stage_done;  ///< "post", "verify"
};

/// Pieces, in a stretch of the plan, that the machine cannot wind, each with the first reason: no
/// free length, beyond an axis' travel, or hitting something. Where consecutive pieces all lead
/// beyond one axis' travel, the worst one is named. Empty: all can be wound. Thread-safe.
[[nodiscard]] std::map<std::size_t, CourseFault> refused_by_machine(const Setup& setup,
                                                                    std::span<const Piece> pieces);

/// Eye, axes, blocks and time law of the pieces. Then the blocks are wound again and, where too
/// coarse, made finer, a few times. Without blocks where the machine cannot wind the pieces, unless
/// `ignore_limits`. Thread-safe. \pre there are pieces, all of one fibre
[[nodiscard]] PieceProgram program_of(const Setup& setup, std::span<const Piece> pieces,
                                      const PieceProgramOptions& options = {});

}  // namespace meshwind
