#include "pipeline/resume/resume.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "core/error.h"
#include "core/text/text_number.h"
#include "core/version.h"
#include "mesh/smooth/patch.h"
#include "pipeline/code_digest.h"
#include "postproc/motion/axis_loads.h"
#include "postproc/motion/joint_path.h"
#include "postproc/verify/verify_head.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr double kMmPerM = 1000.0;

// A block at the start becomes slower by such a factor at a time. What is behind the first blocks,
// or does not settle, is the program's own.
constexpr double kMinSlowing = 1.01;
constexpr double kMaxSlowing = 2.0;
constexpr double kSettled = 1.0 + 5e-4;  // half of what the check "limits" leaves to rounding
constexpr std::size_t kMaxStartBlocks = 200;
constexpr int kMaxSlowings = 2000;

constexpr std::int64_t kTurn_nano = 360 * kNanoPerUnit;

std::string blocks_words(const LaidProgram& program) {
    return program.file + " has blocks 1 to " + std::to_string(program.blocks.moves());
}

// Stations of the laid fibre up to the end of a block.
std::size_t laid_until(const LaidPath& laid, std::size_t block) {
    const auto behind = std::ranges::upper_bound(laid.at, block, {}, &LaidAt::block);
    return static_cast<std::size_t>(behind - laid.at.begin());
}

// The sample at the end of a block. \pre there is one
std::size_t sample_after(const LaidPath& laid, std::size_t block) {
    const auto next = std::upper_bound(laid.block.begin(), laid.block.end(), block);
    return static_cast<std::size_t>(next - laid.block.begin()) - 1;
}

// Whether the fibre lies on the wall at the end of a block, so that it can be tied on there.
bool lies_on_wall(const LaidProgram& program, std::size_t block) {
    const LaidPath& laid = program.laid;
    const Vector3d& landing_mm = laid.samples[sample_after(laid, block)].landing_mm;
    const std::size_t count = laid_until(laid, block);
    if (count == 0 || laid.at[count - 1].lifted || laid.at[count - 1].held) {
        return false;
    }
    const LaydownSurface& wall = *program.setup.wall;
    const SurfacePoint foot = wall.nearest(landing_mm);
    const Patch patch(wall.surface(), foot.face);
    const Vector3d on_wall_mm = patch.at({foot.bary[1], foot.bary[2]}).position_mm;
    return (landing_mm - on_wall_mm).norm() <= 0.5 * kTieOnOff_mm;
}

void check_block(const LaidProgram& program, std::size_t block) {
    if (block == 0 || block >= program.blocks.moves()) {
        throw InputError("resume.block", "",
                         blocks_words(program) + "; name the last that was run, before the last");
    }
    const LaidPath& laid = program.laid;
    if (!laid.failure.empty() && laid.failed_block <= block) {
        throw InputError("resume.not_followed", program.file,
                         "the fibre cannot be followed beyond " +
                             block_words(program.blocks, laid.failed_block) + ": " + laid.failure);
    }
    if (lies_on_wall(program, block)) {
        return;
    }
    std::size_t before = block;
    while (before > 0 && !lies_on_wall(program, before)) {
        --before;
    }
    throw InputError("resume.in_the_air", program.file,
                     "at the end of " + block_words(program.blocks, block) +
                         " the fibre lies on a pin or hangs over a hollow; " +
                         (before > 0 ? "take it back to the end of block " + std::to_string(before)
                                     : "begin anew"));
}

// The blocks behind one, from where it ends.
BlockList rest_of(const Machine& machine, const BlockList& whole, std::size_t block) {
    BlockList rest;
    rest.axes = whole.axes;
    rest.blocks.assign(whole.blocks.begin() + static_cast<std::ptrdiff_t>(block),
                       whole.blocks.end());
    rest.blocks.front() = {.piece = whole.blocks[block].piece};
    const std::size_t axes = whole.axes.size();
    rest.nano.assign(whole.nano.begin() + static_cast<std::ptrdiff_t>(block * axes),
                     whole.nano.end());
    for (std::size_t a = 0; a < axes; ++a) {
        const Axis& axis = machine.axis(a);
        if (axis.type != AxisType::Rotary || std::isfinite(axis.min) || std::isfinite(axis.max) ||
            kTurn_nano % whole.axes[a].resolution_nano != 0) {
            continue;
        }
        const std::int64_t turns = std::llround(static_cast<double>(rest.nano[a]) / kTurn_nano);
        for (std::size_t i = a; i < rest.nano.size(); i += axes) {
            rest.nano[i] -= turns * kTurn_nano;
        }
    }
    return rest;
}

// Slows the first blocks down until the machine gets from rest to their speeds.
void slow_start(const Machine& machine, double corner_mm, BlockList& rest) {
    const JointPath joints = joint_path(rest);
    std::vector<double> step_s;
    for (const Block& block : rest.blocks) {
        step_s.push_back(block.duration_s);
    }
    const auto slow_down = [&](std::size_t step, double by) {
        step_s[step] *= std::clamp(by, kMinSlowing, kMaxSlowing);
    };
    for (int i = 0; i < kMaxSlowings; ++i) {
        const AxisLoads loads = axis_loads(machine, joints, step_s);
        const CornerCut& cut = loads.eye.mm > loads.linear.mm ? loads.eye : loads.linear;
        const bool is_corner = loads.acceleration.ratio <= kSettled;
        const std::size_t step = is_corner ? cut.step : loads.acceleration.step;
        if ((is_corner && cut.mm <= kSettled * corner_mm) || step > kMaxStartBlocks) {
            break;
        }
        if (is_corner) {  // the cut goes by the square of the speeds on both sides
            slow_down(step, std::sqrt(cut.mm / corner_mm));
            slow_down(step + 1, std::sqrt(cut.mm / corner_mm));
        } else {
            slow_down(step, loads.acceleration.ratio);
        }
    }
    for (std::size_t b = 0; b < step_s.size(); ++b) {
        rest.blocks[b].duration_s = step_s[b];
    }
}

// What the whole program lays from a station on.
PlannedFibre fibre_from(const LaidPath& laid, std::size_t first) {
    PlannedFibre fibre;
    for (std::size_t i = first; i < laid.path.size(); ++i) {
        const PathPoint& p = laid.path[i];
        fibre.push_back({.point = static_cast<std::int32_t>(i),
                         .position_mm = p.position_mm,
                         .normal = p.normal,
                         .tangent = p.tangent,
                         .lifted = laid.at[i].lifted,
                         .held = laid.at[i].held});
    }
    return fibre;
}

}  // namespace

bool ResumedProgram::passed() const {
    return std::ranges::all_of(verification.checks, &Check::ok);
}

LaidProgram lay_program(Setup setup, const VerifyInputs& inputs, const RunContext& context) {
    LaidProgram program;
    program.setup = std::move(setup);
    program.file = inputs.program.name;
    program.made_from = made_from(inputs.program.text);
    program.blocks = read_program(program.setup, inputs);
    program.laid = lay_down(
        *program.setup.wall, program.setup.machine, program.blocks, tie_on_of(program.blocks),
        {.progress = [&](double share) { context.report_progress("verify", share); }});
    return program;
}

std::size_t block_of_line(const LaidProgram& program, std::int32_t line) {
    std::vector<std::size_t> found;
    for (std::size_t b = 1; b < program.blocks.blocks.size(); ++b) {
        if (program.blocks.blocks[b].line == line) {
            found.push_back(b);
        }
    }
    if (found.size() != 1) {
        const std::string where = "line " + std::to_string(line) + " of " + program.file;
        throw InputError("resume.line", "",
                         found.empty() ? where + " moves nothing; name the line of a block"
                                       : where + " is run " + std::to_string(found.size()) +
                                             " times, first as block " +
                                             std::to_string(found.front()) + ", last as block " +
                                             std::to_string(found.back()) + "; name the block");
    }
    return found.front();
}

ResumedProgram resume(const LaidProgram& program, std::size_t block, const RunContext& context) {
    check_block(program, block);
    const Setup& setup = program.setup;
    const Dialect& dialect = *setup.dialect;
    ResumedProgram rest;
    rest.block = block;
    rest.line = program.blocks.blocks[block].line;
    const std::size_t sample = sample_after(program.laid, block);
    rest.laid_mm = program.laid.samples[sample].s_mm;
    ProgramHeader header;
    header.version = kVersion;
    header.mandrel = setup.mandrel.file;
    if (program.made_from) {
        header.machine_file = program.made_from->machine_file;
        header.job = program.made_from->job;
        header.mandrel_digest = program.made_from->mandrel == header.mandrel
                                    ? program.made_from->mandrel_digest
                                    : std::string();
    }
    header.job_digest = program.blocks.head && !program.blocks.head->job_digest.empty()
                            ? program.blocks.head->job_digest
                            : job_digest(setup.job);
    header.fibre_length_mm = program.laid.path.back().s_mm - rest.laid_mm;
    header.tie_on_mm = program.laid.samples[sample].landing_mm;
    header.pins = program.blocks.pins;
    header.notes.push_back("goes on behind block " + std::to_string(block) + ", line " +
                           std::to_string(rest.line) + ", of " +
                           std::filesystem::path(program.file).filename().string() + ": " +
                           fixed(rest.laid_mm / kMmPerM, 3) + " m of fibre lie already");
    BlockList left = rest_of(setup.machine, program.blocks, block);
    slow_start(setup.machine, dialect.corner_tolerance_mm(setup.machine), left);
    FoldedProgram folded = dialect.fold(dialect.prepare(std::move(left)));
    rest.text = write_with_digest(dialect, setup.machine, folded.list, folded.layout, header);
    rest.blocks = dialect.read(rest.text, "the rest of " + program.file, setup.machine);
    // From a station before the end of the block, so that the first of the rest lie between two.
    const std::size_t first = laid_until(program.laid, block) - 1;
    rest.verification =
        verify_program(setup, rest.blocks, fibre_from(program.laid, first),
                       [&](double share) { context.report_progress("verify", share); });
    return rest;
}

}  // namespace meshwind
