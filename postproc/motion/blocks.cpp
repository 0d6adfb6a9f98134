#include "postproc/motion/block.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/error.h"
#include "core/text/text_number.h"
#include "core/units.h"

namespace meshwind {
namespace {

// int64 holds 9.22e18 nano units; differences of two positions must fit as well.
constexpr double kFarthest = 4e9;

std::int64_t rounded_nano(double value, const Axis& axis, std::size_t point) {
    const double output = axis.type == AxisType::Rotary ? deg_from_rad(value) : value;
    if (!(std::abs(output) < kFarthest)) {
        throw InputError("block.too_far", std::string("axis ") + axis.letter,
                         "position at point " + std::to_string(point) +
                             " is beyond 4e9 mm or deg; split the program");
    }
    const double steps =
        output * (static_cast<double>(kNanoPerUnit) / static_cast<double>(axis.resolution_nano));
    return std::llround(steps) * axis.resolution_nano;
}

}  // namespace

double BlockList::duration_s() const {
    double sum = 0.0;
    for (const Block& block : blocks) {
        sum += block.duration_s;
    }
    return sum;
}

std::vector<double> joints_at(const BlockList& list, std::size_t block) {
    std::vector<double> joints(list.axes.size());
    for (std::size_t a = 0; a < joints.size(); ++a) {
        const double value = list.value(block, a);
        joints[a] = list.axes[a].type == AxisType::Rotary ? rad_from_deg(value) : value;
    }
    return joints;
}

JointPath joint_path(const BlockList& list) {
    JointPath joints;
    joints.axis_count = list.axes.size();
    joints.joints.reserve(list.nano.size());
    for (std::size_t b = 0; b < list.blocks.size(); ++b) {
        const std::vector<double> row = joints_at(list, b);
        joints.joints.insert(joints.joints.end(), row.begin(), row.end());
    }
    return joints;
}

std::string block_words(const BlockList& list, std::size_t block) {
    const std::int32_t line = list.blocks[block].line;
    return "block " + std::to_string(block) +
           (line > 0 ? " (line " + std::to_string(line) + ")" : std::string());
}

std::string beyond_one_block(const BlockAxis& axis, std::int64_t from_nano, std::int64_t to_nano) {
    const bool rotary = axis.type == AxisType::Rotary;
    const double most = rotary ? kMaxBlock_deg : kMaxBlock_mm;
    const double way = (static_cast<double>(to_nano) - static_cast<double>(from_nano)) /
                       static_cast<double>(kNanoPerUnit);
    if (std::abs(way) <= most) {
        return "";
    }
    const std::string unit = rotary ? " deg" : " mm";
    return std::string("axis ") + axis.letter + " goes " + fixed(way, 3) + unit +
           " in one block, more than " + fixed(most, 0) + unit +
           "; is a point missing? Else split the block";
}

int decimals_of(std::int64_t resolution_nano) {
    int decimals = 9;
    while (decimals > 0 && resolution_nano % 10 == 0) {
        resolution_nano /= 10;
        --decimals;
    }
    return decimals;
}

Machine with_steps(Machine machine, std::span<const BlockAxis> steps) {
    assert(steps.size() == machine.axis_count());
    const std::size_t turning = machine.mandrel_chain.size();
    for (std::size_t a = 0; a < steps.size(); ++a) {
        Axis& axis = a < turning ? machine.mandrel_chain[a] : machine.eye_chain[a - turning];
        axis.resolution_nano = steps[a].resolution_nano;
    }
    return machine;
}

TimedBlocks make_blocks(const Machine& machine, const EyePath& path, const JointPath& joints,
                        std::span<const double> fibre_mm, const TimeLawOptions& options) {
    assert(path.size() == joints.size() && path.size() == fibre_mm.size());
    const std::size_t axes = machine.axis_count();
    BlockList list;
    for (std::size_t a = 0; a < axes; ++a) {
        const Axis& axis = machine.axis(a);
        list.axes.push_back({axis.letter, axis.type, axis.resolution_nano});
    }
    list.blocks.reserve(path.size());
    list.nano.reserve(path.size() * axes);
    std::vector<double> fibre;  // of the blocks
    std::vector<std::int64_t> row(axes);
    double merged_mm = 0.0;
    for (std::size_t i = 0; i < path.size(); ++i) {
        for (std::size_t a = 0; a < axes; ++a) {
            row[a] = rounded_nano(joints.row(i)[a], machine.axis(a), i);
        }
        merged_mm += fibre_mm[i];
        const bool moves =
            i == 0 || !std::equal(row.begin(), row.end(), list.row(list.blocks.size() - 1).begin());
        if (moves) {
            list.blocks.push_back({.piece = path[i].piece, .point = path[i].point});
            list.nano.insert(list.nano.end(), row.begin(), row.end());
            fibre.push_back(merged_mm);
            merged_mm = 0.0;
        }
    }
    if (!fibre.empty()) {
        fibre.back() += merged_mm;
    }
    TimedPath time = time_path(machine, fibre, joint_path(list), options);
    for (std::size_t b = 0; b < list.blocks.size(); ++b) {
        list.blocks[b].duration_s = time.step_s[b];
    }
    return {std::move(list), std::move(time)};
}

}  // namespace meshwind
