#include "pipeline/piece_program.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/margins.h"
#include "core/units.h"
#include "pipeline/block_time.h"
#include "postproc/collision/clear_motion.h"
#include "postproc/eye/repeated_path.h"
#include "postproc/motion/mend_motion.h"

namespace meshwind {
namespace {

// Where the simulation finds blocks too coarse they get less of the tolerance, so many times.
constexpr int kTighterRounds = 4;

// After so many rounds the same pieces still found wrong are taken for beyond mending; where a
// motion is at hand that lays them, at once.
constexpr int kRoundsInVain = 1;

// Where the head comes too near between stations its piece gets more clearance at them, so many
// times.
constexpr int kMoreClearanceRounds = 2;

// A better motion is chosen so many times at most.
constexpr int kMotionRounds = 12;

// And so many times after a program has been wound again, as long as each leaves fewer pieces wrong
// than the one before.
constexpr int kMendedPrograms = 3;

// The first motion is kept where it takes hardly longer: its blocks are fewer, and repeat where the
// fibre does.
constexpr double kWorthwhile = 0.99;

// Of what a program takes until its blocks are made: a first motion, and the choice of a better
// one.
constexpr double kFirstMotionShare = 0.3;
constexpr double kChosenShare = 0.7;

// A motion of least time uses the axes to the full, so its blocks follow it at least that closely.
constexpr double kMaxFastBlock_mm = 2.0 * kKnot_mm;

using RefusedPieces = std::map<std::size_t, CourseFault>;

// Pieces to be wound, and how; nothing of it changes.
struct ProgramTask {
    const Setup& setup;
    std::span<const Piece> pieces;
    const PieceProgramOptions& options;
    CollisionRule rule;  // clearances are told as far as blocks can use them
};

// What blocks are chosen for.
struct Motion {
    RedundancyPolicy policy = RedundancyPolicy::CentralAngle;
    AxisPath axes;                // of a long fibre they are forgotten, and made again
    std::vector<double> room_mm;  // per point: how far the eye may be off
};

// What the machine does for the pieces, point by point.
struct FirstMotion {
    EyePathResult eyes;  // at the stations
    RedundancyPolicy policy = RedundancyPolicy::CentralAngle;
    AxisPath axes;
    RefusedPieces refused;             // what of it the machine cannot do
    std::vector<double> clearance_mm;  // of the head, per point of the axes' path
};

// Motions of least time, and what they have come to.
struct LeastTime {
    std::optional<Improvement> at_hand;         // the program is made of its motion
    std::optional<Improvement> aside;           // of many stations: its motion is hardly faster
    bool was_put_off = false;                   // it has been aside
    std::optional<PieceProgram> hardly_faster;  // than the first motion
    double first_s = std::numeric_limits<double>::infinity();  // duration of the first motion
    std::size_t wrong_pieces = std::numeric_limits<std::size_t>::max();  // of the program before
};

void tell(const PieceProgramOptions& options, const char* step, double share) {
    options.context.report_progress(step, share);
}

void tell_done(const PieceProgramOptions& options, const char* stage) {
    if (options.stage_done) {
        options.stage_done(stage);
    }
}

void refuse(const EyePoint& point, CourseFault reason, RefusedPieces& refused) {
    refused.emplace(static_cast<std::size_t>(point.piece), reason);
}

// Where the spindle turns without end the motion goes on from where it stands.
void go_on_from_spindle(const ProgramTask& task, JointPath& joints) {
    const Axis& spindle = task.setup.machine.mandrel_chain.back();
    const std::size_t axis = task.setup.machine.mandrel_chain.size() - 1;
    const std::optional<double>& spindle_rad = task.options.spindle_rad;
    if (!spindle_rad || std::isfinite(spindle.min) || std::isfinite(spindle.max)) {
        return;
    }
    const double turns = std::round((*spindle_rad - joints.row(0)[axis]) / (2.0 * kPi));
    for (std::size_t i = axis; i < joints.joints.size(); i += joints.axis_count) {
        joints.joints[i] += 2.0 * kPi * turns;
    }
}

AxisPath axes_through(const ProgramTask& task, const EyePath& stations, RedundancyPolicy policy) {
    const Machine& machine = task.setup.machine;
    AxisPath axes;
    axes.path = refine_path(machine, stations, policy, block_tolerance(task.setup.job));
    axes.joints = solve_joints(machine, axes.path, policy);
    go_on_from_spindle(task, axes.joints);
    return axes;
}

// What a motion of least time starts from is the central angle.
RedundancyPolicy first_policy(RedundancyRule rule) {
    switch (rule) {
        case RedundancyRule::Hold:
            return RedundancyPolicy::Hold;
        case RedundancyRule::Oscillate:
            return RedundancyPolicy::Oscillate;
        default:
            return RedundancyPolicy::CentralAngle;
    }
}

void refuse_beyond_travel(const AxisPath& axes, RefusedPieces& refused) {
    for (const LimitViolation& violation : axes.joints.violations) {
        refuse(axes.path[violation.point], CourseFault::AxisTravel, refused);
    }
    for (const JointNote& note : axes.joints.notes) {
        if (note.kind == JointNoteKind::EyeOutOfReach) {
            refuse(axes.path[note.first], CourseFault::AxisTravel, refused);
        }
    }
}

void refuse_hits(const CollisionReport& report, const EyePath& path, RefusedPieces& refused) {
    for (const std::size_t point : report.fibre_hits) {
        refuse(path[point], CourseFault::FibreHit, refused);
    }
    for (const auto* const hits : {&report.head_hits, &report.body_hits}) {
        for (const std::size_t point : *hits) {
            refuse(path[point], CourseFault::HeadHit, refused);
        }
    }
}

CollisionReport collisions_of(const ProgramTask& task, const AxisPath& axes) {
    const Setup& setup = task.setup;
    return check_collisions(setup.machine, setup.envelope, *setup.obstacles, axes.path, axes.joints,
                            task.rule);
}

// By free lengths and axes alone; what it hits is yet to be checked.
FirstMotion motion_with(const ProgramTask& task, std::span<const double> more_clearance_mm) {
    const Setup& setup = task.setup;
    FirstMotion motion;
    motion.eyes = eye_path(task.pieces, setup.job.eye, *setup.obstacles, setup.rule.free_fibre,
                           more_clearance_mm, task.options.lengths);
    motion.policy = first_policy(setup.job.redundancy);
    motion.axes = axes_through(task, motion.eyes.path, motion.policy);
    for (const std::size_t point : motion.eyes.blocked) {
        refuse(motion.eyes.path[point], CourseFault::FreeLength, motion.refused);
    }
    refuse_beyond_travel(motion.axes, motion.refused);
    return motion;
}

// The clearance is measured if the free lengths and the axes allow the motion, or in spite of them.
FirstMotion first_motion(const ProgramTask& task, bool ignore_limits) {
    std::vector<double> more_mm(task.pieces.size(), 0.0);
    for (int round = 0;; ++round) {
        FirstMotion motion = motion_with(task, more_mm);
        if (!motion.refused.empty() && !ignore_limits) {
            return motion;
        }
        const std::size_t refused = motion.refused.size();
        CollisionReport report = collisions_of(task, motion.axes);
        refuse_hits(report, motion.axes.path, motion.refused);
        const bool only_head = refused == 0 && report.fibre_hits.empty() &&
                               report.body_hits.empty() && !report.head_hits.empty();
        const bool by_rule = task.setup.job.eye.rule != EyeRule::Adaptive;
        if (!only_head || by_rule || round == kMoreClearanceRounds) {
            motion.clearance_mm = std::move(report.clearance_mm);
            return motion;
        }
        for (const auto& [piece, reason] : motion.refused) {
            more_mm[piece] += margin::kMended_mm;
        }
    }
}

// The motion for the program, which has its stations and what of it is refused.
Motion begin_program(const ProgramTask& task, FirstMotion first, PieceProgram& program) {
    program.eyes = std::move(first.eyes);
    program.refused = std::move(first.refused);
    program.path_points = first.axes.path.size();
    Motion motion{first.policy, std::move(first.axes), {}};
    motion.room_mm = room_of_clearance_mm(task.setup, task.pieces, motion.axes.path,
                                          std::move(first.clearance_mm));
    return motion;
}

MotionCheck motion_check(const Setup& setup) {
    return {setup.machine, setup.envelope, *setup.obstacles, setup.rule,
            block_tolerance(setup.job)};
}

// Puts the improver's motion to the program. Returns stations of the improver's path at which it
// is not clear; empty: it is.
std::vector<std::size_t> take_motion(const ProgramTask& task, const Improvement& improvement,
                                     Motion& motion, PieceProgram& program) {
    program.eyes.path = improved(improvement, std::move(program.eyes.path));
    program.refused.clear();
    motion.axes = AxisPath();
    motion.policy = RedundancyPolicy::Chosen;
    motion.axes = axes_through(task, program.eyes.path, motion.policy);
    program.path_points = motion.axes.path.size();
    CollisionReport report = collisions_of(task, motion.axes);
    std::vector<std::size_t> hits =
        of_improver(improvement, hit_stations(motion.axes, report, program.eyes.path));
    if (hits.empty()) {
        program.eyes.blocked.clear();
        measure_lengths(program.eyes);
        motion.room_mm = room_of_clearance_mm(task.setup, task.pieces, motion.axes.path,
                                              std::move(report.clearance_mm));
    }
    return hits;
}

// Takes over the improver's motion and mends it until it is clear; false where that fails.
bool make_clear(const ProgramTask& task, Improvement& improvement, Motion& motion,
                PieceProgram& program) {
    for (int round = 0; round < kMotionRounds; ++round) {
        std::vector<std::size_t> hits =
            hits_of_change(motion_check(task.setup), improvement.improver);
        if (hits.empty()) {
            hits = take_motion(task, improvement, motion, program);
            if (hits.empty()) {
                return true;
            }
        }
        if (!improvement.improver.mend(hits)) {
            return false;
        }
    }
    return false;
}

BlockBounds whole_tolerance(const Motion& motion, double most_mm) {
    const std::size_t points = motion.axes.path.size();
    return {std::vector<double>(points, 1.0), std::vector<double>(points, 1.0), most_mm};
}

// Blocks for the motion become those of the program.
void put_blocks(const ProgramTask& task, const Motion& motion, const BlockBounds& bounds,
                PieceProgram& program) {
    ProgramBlocks made =
        program_blocks(task.setup, task.pieces, motion.axes, motion.room_mm, bounds);
    program.choice = std::move(made.choice);
    program.blocks = std::move(made.list);
    program.exact = std::move(made.exact);
    program.exact.tie_on_mm = program.eyes.path.front().landing_mm;
    program.layout = std::move(made.layout);
    program.binding = std::move(made.binding);
    program.duration_s = made.duration_s;
    program.corner_s = made.corner_s;
    program.least_s = motion.axes.path.back().s_mm / planned_speed_mm_s(task.setup);
}

BlockList as_run(const PieceProgram& program) {
    BlockList list = program.blocks;
    list.tie_on_mm = program.eyes.path.front().landing_mm;
    return list;
}

RefusedPieces pieces_laid_wrong(const PieceProgram& program) {
    RefusedPieces wrong;
    for (const std::size_t block : program.verification.wrong_blocks) {
        wrong.emplace(static_cast<std::size_t>(program.blocks.blocks[block].piece),
                      CourseFault::Laydown);
    }
    return wrong;
}

// Winds the blocks again, finer where they are too coarse, until that has not helped for more
// than some rounds. Returns the pieces that they do not lay as planned.
RefusedPieces wind_again(const ProgramTask& task, int rounds_in_vain, BlockBounds& bounds,
                         Motion& motion, PieceProgram& program) {
    const PieceProgramOptions& options = task.options;
    RefusedPieces wrong;
    for (int round = 0;; ++round) {
        tell(options, "verify", static_cast<double>(round) / kTighterRounds);
        const bool many = motion.axes.path.size() > kManyStations;
        if (many) {
            motion.axes = AxisPath();  // as much memory as the plan; it can be had again
        }
        program.read = options.round_trip ? options.round_trip(program) : as_run(program);
        program.verification = verify_program(task.setup, program.read, planned_fibre(task.pieces));
        RefusedPieces now = pieces_laid_wrong(program);
        const bool in_vain = round > rounds_in_vain && now == wrong;
        wrong = std::move(now);
        const std::vector<FastBlock>& fast = program.verification.fast_blocks;
        const std::vector<std::size_t>& coarse = program.verification.coarse_blocks;
        if (many && !(fast.empty() && coarse.empty())) {
            motion.axes = axes_through(task, program.eyes.path, motion.policy);
        }
        const std::vector<Block>& blocks = program.blocks.blocks;
        lengthen(fast, blocks, motion.axes.path, bounds.longer);
        if (round == kTighterRounds || in_vain ||
            !(tighten(coarse, blocks, motion.axes.path, bounds.share) || !fast.empty())) {
            return wrong;
        }
        put_blocks(task, motion, bounds, program);
    }
}

std::vector<std::size_t> wrong_stations(const PieceProgram& program) {
    std::vector<std::size_t> found;
    for (const std::size_t block : program.verification.wrong_blocks) {
        const Block& at = program.blocks.blocks[block];
        found.push_back(station_of(at.piece, at.point, program.eyes.path));
    }
    return found;
}

// A motion of least time in place of the first one, where one is asked for and clear.
LeastTime least_time(const ProgramTask& task, Motion& motion, PieceProgram& program) {
    LeastTime least;
    // Where a strict rule has no eye, no motion makes it one.
    const bool broken_rule =
        task.setup.job.eye.rule != EyeRule::Adaptive && !program.eyes.blocked.empty();
    if (!task.options.optimal || broken_rule) {
        return least;
    }
    if (program.refused.empty()) {
        put_blocks(task, motion, whole_tolerance(motion, std::numeric_limits<double>::infinity()),
                   program);
        least.first_s = program.duration_s;
    }
    tell(task.options, "post", kFirstMotionShare);
    least.at_hand.emplace(improvement_of(motion_check(task.setup), planned_speed_mm_s(task.setup),
                                         task.setup.job.eye.rule, program.eyes));
    least.at_hand->improver.choose();
    tell(task.options, "post", kChosenShare);
    if (!make_clear(task, *least.at_hand, motion, program)) {
        least.at_hand.reset();
    }
    return least;
}

// Whether the program of a motion of least time takes hardly less than that of the first one.
bool saves_hardly(const LeastTime& least, const PieceProgram& program) {
    return least.at_hand && program.duration_s > kWorthwhile * least.first_s;
}

// Of many stations what is hardly faster is put off before it is wound again: true where it is.
bool put_off(const PieceProgram& program, LeastTime& least) {
    if (!saves_hardly(least, program) || !least.at_hand->repeated || least.was_put_off) {
        return false;
    }
    least.aside.emplace(std::move(*least.at_hand));
    least.at_hand.reset();
    least.was_put_off = true;
    return true;
}

// What was put off is taken after all; where it cannot be made clear nothing is at hand, and the
// program is to be begun anew with the first motion. Returns false where nothing was put off.
bool take_put_off(const ProgramTask& task, LeastTime& least, Motion& motion,
                  PieceProgram& program) {
    if (least.at_hand || !least.aside) {
        return false;
    }
    least.at_hand.emplace(std::move(*least.aside));
    least.aside.reset();
    if (!make_clear(task, *least.at_hand, motion, program)) {
        least.at_hand.reset();
    }
    return true;
}

// Puts the first motion back about what the program lays wrong: all of it, where that does not
// help any more.
void mend_program(const ProgramTask& task, std::size_t wrong_pieces, int mendings, LeastTime& least,
                  Motion& motion, PieceProgram& program) {
    Improvement& improvement = *least.at_hand;
    const bool mended =
        mendings < kMendedPrograms && wrong_pieces < least.wrong_pieces &&
        improvement.improver.give_up(of_improver(improvement, wrong_stations(program))) &&
        make_clear(task, improvement, motion, program);
    least.wrong_pieces = wrong_pieces;
    if (!mended) {
        least.at_hand.reset();
    }
}

// The program of the last motion that is left, and what of it is laid wrong.
PieceProgram conclude(RefusedPieces wrong, LeastTime least, PieceProgram program) {
    const bool optimal = least.at_hand || least.hardly_faster;
    if (least.hardly_faster && !wrong.empty()) {
        program = std::move(*least.hardly_faster);
        wrong.clear();
    }
    program.refused.merge(wrong);
    program.optimal = optimal;
    return program;
}

// Makes the blocks of motions, and winds them again, until one lays the pieces as planned or none
// is left; the first motion is the last.
PieceProgram wound_program(const ProgramTask& task, LeastTime least, Motion motion,
                           PieceProgram program) {
    const PieceProgramOptions& options = task.options;
    RefusedPieces wrong;
    for (int mendings = 0;; ++mendings) {
        if (options.optimal && !least.at_hand) {
            program.eyes = EyePathResult();  // of a long fibre both are as large as the plan
            motion = Motion();
            motion = begin_program(task, first_motion(task, options.ignore_limits), program);
        }
        if (!program.refused.empty() && !options.ignore_limits) {
            return program;
        }
        BlockBounds bounds = whole_tolerance(
            motion, least.at_hand ? kMaxFastBlock_mm : std::numeric_limits<double>::infinity());
        put_blocks(task, motion, bounds, program);
        tell(options, "post", 1.0);
        tell_done(options, "post");
        if (put_off(program, least)) {
            continue;
        }
        wrong = wind_again(task, least.at_hand ? 0 : kRoundsInVain, bounds, motion, program);
        tell_done(options, "verify");
        if (wrong.empty() && saves_hardly(least, program)) {
            least.hardly_faster = std::exchange(program, {});
            least.at_hand.reset();
            continue;
        }
        if (!wrong.empty() && take_put_off(task, least, motion, program)) {
            continue;
        }
        if (wrong.empty() || !least.at_hand) {
            break;
        }
        mend_program(task, wrong.size(), mendings, least, motion, program);
    }
    return conclude(std::move(wrong), std::move(least), std::move(program));
}

}  // namespace

std::map<std::size_t, CourseFault> refused_by_machine(const Setup& setup,
                                                      std::span<const Piece> pieces) {
    const PieceProgramOptions options;
    CollisionRule rule = setup.rule;
    rule.report_within_mm = rule.clearance_mm;
    const ProgramTask task{setup, pieces, options, rule};
    return first_motion(task, false).refused;
}

PieceProgram program_of(const Setup& setup, std::span<const Piece> pieces,
                        const PieceProgramOptions& options) {
    tell(options, "post", 0.0);
    CollisionRule rule = setup.rule;
    rule.report_within_mm =
        rule.clearance_mm + margin::kMaxBetweenBlocks_mm / margin::kBlocksOfRoom;
    const ProgramTask task{setup, pieces, options, rule};
    PieceProgram program;
    Motion motion =
        begin_program(task, first_motion(task, options.ignore_limits || options.optimal), program);
    LeastTime least = least_time(task, motion, program);
    return wound_program(task, std::move(least), std::move(motion), std::move(program));
}

}  // namespace meshwind
