#include "pipeline/resume/dry_run.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/text/text_number.h"
#include "core/version.h"
#include "machines/kinematics.h"
#include "pipeline/code_digest.h"
#include "postproc/motion/joint_path.h"
#include "postproc/nc/made_from.h"

namespace meshwind {
namespace {

// An axis nearer to the spindle's direction would take the head beside the part, into what holds
// it.
constexpr double kAcross = 0.7;

// The start is moved by the clearance at least, since that is what it is for, and then by so many
// times more: on a tee the head reaches in beside a branch that must pass in front of it.
constexpr double kFarther = 1.25;
// Farther than any machine reaches, for axes without ends.
constexpr double kFarthest_mm = 1e4;

// The one that draws the head back most directly comes first.
std::vector<std::size_t> axes_across(const Machine& machine, std::span<const double> start) {
    const std::vector<PlacedAxis> axes = placed_axes(machine, start);
    const Eigen::Vector3d back = base_from_eye(machine, start).linear() * -machine.eye.exit;
    std::vector<std::size_t> across;
    for (std::size_t a = machine.mandrel_chain.size(); a < axes.size(); ++a) {
        if (axes[a].type == AxisType::Linear && std::abs(axes[a].direction.z()) < kAcross) {
            across.push_back(a);
        }
    }
    std::ranges::stable_sort(across, std::greater<>(),
                             [&](std::size_t a) { return std::abs(axes[a].direction.dot(back)); });
    return across;
}

bool keeps_clear(const Setup& setup, const JointPath& joints, double clearance_mm) {
    JointPath step;
    step.axis_count = joints.axis_count;
    for (std::size_t i = 1; i < joints.joints.size() / joints.axis_count; ++i) {
        const auto from =
            joints.joints.begin() + static_cast<std::ptrdiff_t>((i - 1) * joints.axis_count);
        step.joints.assign(from, from + static_cast<std::ptrdiff_t>(2 * joints.axis_count));
        if (head_strikes(setup.machine, setup.envelope, *setup.obstacles, step, clearance_mm)) {
            return false;
        }
    }
    return true;
}

// The program with one axis elsewhere by so much; nothing where it would pass an end of its travel.
std::optional<BlockList> moved(const Machine& machine, const BlockList& program, std::size_t axis,
                               std::int64_t by_nano) {
    BlockList list = program;
    const Axis& travel = machine.axis(axis);
    for (std::size_t i = axis; i < list.nano.size(); i += list.axes.size()) {
        list.nano[i] += by_nano;
        const double value_mm = static_cast<double>(list.nano[i]) / kNanoPerUnit;
        if (value_mm < travel.min || value_mm > travel.max) {
            return std::nullopt;
        }
    }
    return list;
}

struct Moved {
    BlockList list;
    std::size_t axis = 0;
    double by_mm = 0.0;
};

Moved move_out(const Setup& setup, const BlockList& program, const std::string& file,
               double clearance_mm) {
    const Machine& machine = setup.machine;
    const std::vector<std::size_t> axes = axes_across(machine, joints_at(program, 0));
    if (axes.empty()) {
        throw InputError("dry_run.no_axis", machine.name,
                         "has no linear axis across the spindle that could take the head away; run "
                         "the program without the mandrel");
    }
    bool within_travel = true;
    for (double move_mm = clearance_mm; within_travel && move_mm < kFarthest_mm;
         move_mm *= kFarther) {
        within_travel = false;
        for (const std::size_t axis : axes) {
            const std::int64_t step_nano = machine.axis(axis).resolution_nano;
            const auto steps = static_cast<std::int64_t>(
                std::ceil(move_mm * kNanoPerUnit / static_cast<double>(step_nano)));
            for (const std::int64_t by_nano : {steps * step_nano, -steps * step_nano}) {
                auto list = moved(machine, program, axis, by_nano);
                within_travel = within_travel || list.has_value();
                if (list && keeps_clear(setup, joint_path(*list), clearance_mm)) {
                    return {std::move(*list), axis, static_cast<double>(by_nano) / kNanoPerUnit};
                }
            }
        }
    }
    std::string letters;
    for (const std::size_t axis : axes) {
        letters += letters.empty() ? "" : ", ";
        letters += machine.axis(axis).letter;
    }
    throw InputError("dry_run.no_room", file,
                     "within the travel of " + letters + " the head does not stay " +
                         fixed(clearance_mm, 1) +
                         " mm off the part; give a smaller --clearance, or run the program without "
                         "the mandrel");
}

}  // namespace

DryRun dry_run(Setup setup, const VerifyInputs& inputs, double clearance_mm) {
    const std::string& file = inputs.program.name;
    const BlockList program = read_program(setup, inputs);
    const Moved out = move_out(setup, program, file, clearance_mm);
    DryRun run;
    run.axis = setup.machine.axis(out.axis).letter;
    run.moved_mm = out.by_mm;
    ProgramHeader header;
    header.version = kVersion;
    header.mandrel = setup.mandrel.file;
    header.in_the_air = true;
    const auto made = made_from(inputs.program.text);
    header.machine_file = made ? made->machine_file : std::string();
    header.notes.push_back("in the air, without fibre: " + std::string(1, run.axis) + " starts " +
                           fixed(run.moved_mm, 3) + " mm from where it does in " +
                           std::filesystem::path(file).filename().string() +
                           ", and the head stays " + fixed(clearance_mm, 1) + " mm off the part");
    FoldedProgram folded = setup.dialect->fold(setup.dialect->prepare(out.list));
    run.text = write_with_digest(*setup.dialect, setup.machine, folded.list, folded.layout, header);
    run.blocks = setup.dialect->read(run.text, "the dry run of " + file, setup.machine);
    return run;
}

}  // namespace meshwind
