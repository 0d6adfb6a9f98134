#include "pipeline/block_time.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/margins.h"
#include "core/units.h"

namespace meshwind {
namespace {

// Whether a pin takes hold of the fibre turns on tenths of a mm at the pin (kMinPinRoom_mm), and
// what the eye is off it is off there by less: by its share of the free length.
constexpr double kMaxInPinTurns_mm = 0.4;

// Turns of less than this per mm (radius 100 m) are none.
constexpr double kStraight_per_mm = 1e-5;

// Where a controller spends more than this share of the time on corners, finer blocks are tried. On
// a pipe of the hobby winder they save 12 %; yet finer ones save nothing more.
constexpr double kMaxCorners = 0.02;
constexpr double kFinerForCorners = 0.25;

// Finer blocks are taken where they take less than this share of the time.
constexpr double kWorthFiner = 0.99;

// More time is given in steps of this, so that circuits that repeat stay the same.
constexpr double kLongerStep = 1e-3;

// How much the blocks may turn the fibre on top of the plan without using up the friction, per
// point; where the plan lifts the fibre off, as they like.
std::vector<double> turn_room_per_mm(const Setup& setup, std::span<const Piece> pieces,
                                     const EyePath& path) {
    std::vector<double> room;
    for (const EyePoint& point : path) {
        const Piece& piece = pieces[static_cast<std::size_t>(point.piece)];
        const auto i = static_cast<std::size_t>(point.point);
        const double spare = setup.friction.share(margin::kLaidFriction) - piece.slip[i];
        room.push_back(piece.string.gap_mm[i] > 0.0
                           ? std::numeric_limits<double>::infinity()
                           : std::max(spare * piece.path[i].kn_per_mm, kStraight_per_mm));
    }
    return room;
}

// Timed blocks, and what the controller's language makes of them.
struct PreparedBlocks {
    TimedBlocks timed;
    BlockList list;
};

PreparedBlocks prepared_blocks(const Setup& setup, const BlockTask& task, const BlockChoice& choice,
                               std::span<const double> longer) {
    const TimeLawOptions time{.fibre_speed_mm_s = planned_speed_mm_s(setup),
                              .corner_mm = setup.dialect->corner_tolerance_mm(setup.machine),
                              .tick_s = setup.dialect->tick_s()};
    const std::vector<double> fibre_mm = counted_fibre_mm(choice, longer);
    const auto timed_for = [&](const Machine& machine) {
        return make_blocks(machine, points_at(task.path, choice.ends),
                           points_at(task.joints, choice.ends), fibre_mm, time);
    };
    PreparedBlocks blocks{timed_for(setup.machine), {}};
    blocks.list = setup.dialect->prepare(blocks.timed.list);
    if (blocks.list.axes != blocks.timed.list.axes) {
        // Other steps are other positions, so the time law is asked again.
        blocks.timed = timed_for(with_steps(setup.machine, blocks.list.axes));
        blocks.list = setup.dialect->prepare(blocks.timed.list);
    }
    return blocks;
}

// What moves no axis by a step ends no block of the program.
BlockList exact_blocks(const BlockTask& task, std::span<const std::size_t> ends,
                       const std::vector<BlockAxis>& axes) {
    BlockList list;
    list.axes = axes;
    for (const std::size_t point : ends) {
        list.blocks.push_back({1.0, task.path[point].piece, task.path[point].point, 0});
        const std::span<const double> joints = task.joints.row(point);
        for (std::size_t a = 0; a < joints.size(); ++a) {
            const double value =
                list.axes[a].type == AxisType::Rotary ? deg_from_rad(joints[a]) : joints[a];
            list.nano.push_back(std::llround(value * static_cast<double>(kNanoPerUnit)));
        }
    }
    return list;
}

ProgramBlocks blocks_within(const Setup& setup, const BlockTask& task,
                            std::span<const double> longer, const BlockTolerance& tolerance) {
    ProgramBlocks found;
    found.choice = choose_blocks(setup.machine, task, tolerance);
    PreparedBlocks prepared = prepared_blocks(setup, task, found.choice, longer);
    found.duration_s = prepared.timed.time.duration_s;
    found.binding = std::move(prepared.timed.time.binding);
    renumber(found.binding, prepared.timed.list, prepared.list);
    FoldedProgram folded = setup.dialect->fold(std::move(prepared.list));
    found.list = std::move(folded.list);
    found.layout = std::move(folded.layout);
    found.corner_s = setup.dialect->run_time_s(setup.machine, found.list) - found.list.duration_s();
    found.duration_s += found.corner_s;
    found.exact = exact_blocks(task, found.choice.ends, found.list.axes);
    return found;
}

}  // namespace

BlockTolerance block_tolerance(const Job& job, double most_mm, double finer) {
    const double share = margin::kBlocksOfDeviation * finer;
    BlockTolerance tolerance;
    tolerance.sideways_mm = share * job.tolerance.laydown_mm;
    tolerance.angle_rad = share * rad_from_deg(job.tolerance.laydown_angle_deg);
    tolerance.eye_mm = margin::kMaxBetweenBlocks_mm;
    tolerance.most_mm = most_mm;
    return tolerance;
}

double planned_speed_mm_s(const Setup& setup) {
    return std::min(setup.job.speed.fibre_m_min * 1000.0 / 60.0,
                    margin::kPaidOutSpeed * setup.machine.fibre.max_speed_mm_s);
}

std::vector<double> room_of_clearance_mm(const Setup& setup, std::span<const Piece> pieces,
                                         const EyePath& path, std::vector<double> clearance_mm) {
    std::vector<double> room_mm = std::move(clearance_mm);
    for (double& room : room_mm) {
        room = std::clamp(margin::kBlocksOfRoom * (room - setup.rule.clearance_mm),
                          margin::kMinBetweenBlocks_mm, margin::kMaxBetweenBlocks_mm);
    }
    for (std::size_t i = 0; i < room_mm.size(); ++i) {
        if (!pieces[static_cast<std::size_t>(path[i].piece)].free_start.empty()) {
            room_mm[i] = std::min(room_mm[i], kMaxInPinTurns_mm);
        }
    }
    return room_mm;
}

ProgramBlocks program_blocks(const Setup& setup, std::span<const Piece> pieces,
                             const AxisPath& axes, std::span<const double> room_mm,
                             const BlockBounds& bounds) {
    const std::vector<double> turn_room = turn_room_per_mm(setup, pieces, axes.path);
    const BlockTask task{.path = axes.path,
                         .joints = axes.joints,
                         .room_mm = room_mm,
                         .turn_room_per_mm = turn_room,
                         .share = bounds.share};
    ProgramBlocks whole =
        blocks_within(setup, task, bounds.longer, block_tolerance(setup.job, bounds.most_mm));
    if (setup.dialect->has_junction_deviation() &&
        whole.corner_s > kMaxCorners * whole.duration_s) {
        ProgramBlocks finer =
            blocks_within(setup, task, bounds.longer,
                          block_tolerance(setup.job, bounds.most_mm, kFinerForCorners));
        if (!(finer.duration_s > kWorthFiner * whole.duration_s)) {
            return finer;
        }
    }
    return whole;
}

void lengthen(std::span<const FastBlock> fast, const std::vector<Block>& blocks,
              const EyePath& path, std::vector<double>& longer) {
    const auto key = [](const auto& at) { return std::pair(at.piece, at.point); };
    std::size_t point = 0;
    for (const FastBlock& one : fast) {
        const double factor = 1.0 + kLongerStep * std::ceil((one.ratio - 1.0) / kLongerStep);
        const auto from = key(blocks[one.block > 0 ? one.block - 1 : 0]);
        const auto to = key(blocks[one.block]);
        while (point < path.size() && key(path[point]) <= from) {
            ++point;
        }
        for (; point < path.size() && key(path[point]) <= to; ++point) {
            longer[point] *= factor;
        }
    }
}

bool tighten(std::span<const std::size_t> coarse, const std::vector<Block>& blocks,
             const EyePath& path, std::vector<double>& share) {
    const auto key = [](const auto& at) { return std::pair(at.piece, at.point); };
    bool any = false;
    std::size_t point = 0;
    for (const std::size_t block : coarse) {
        const auto from = key(blocks[block > 0 ? block - 1 : 0]);
        const auto to = key(blocks[block]);
        while (point < path.size() && key(path[point]) < from) {
            ++point;
        }
        for (; point < path.size() && key(path[point]) <= to; ++point) {
            share[point] *= margin::kTighterBlocks;
            any = true;
        }
    }
    return any;
}

std::vector<double> counted_fibre_mm(const BlockChoice& choice, std::span<const double> longer) {
    std::vector<double> counted = choice.fibre_mm;
    for (std::size_t i = 1; i < choice.ends.size(); ++i) {
        const auto first = longer.begin() + static_cast<std::ptrdiff_t>(choice.ends[i - 1]) + 1;
        const auto last = longer.begin() + static_cast<std::ptrdiff_t>(choice.ends[i]) + 1;
        counted[i] *= *std::max_element(first, last);
    }
    return counted;
}

void renumber(std::vector<BindingLimit>& binding, const BlockList& steps, const BlockList& blocks) {
    std::vector<std::size_t> block_of;
    std::size_t block = 0;
    for (std::size_t i = 0; i < steps.blocks.size(); ++i, ++block) {
        while (!std::ranges::equal(blocks.row(block), steps.row(i))) {
            ++block;
        }
        block_of.push_back(block);
    }
    for (BindingLimit& limit : binding) {
        for (BindingStretch& stretch : limit.stretches) {
            stretch.first = block_of[stretch.first - 1] + 1;
            stretch.last = block_of[stretch.last];
        }
    }
}

}  // namespace meshwind
