#include "postproc/block.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/error.h"
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

int decimals_of(std::int64_t resolution_nano) {
    int decimals = 9;
    while (decimals > 0 && resolution_nano % 10 == 0) {
        resolution_nano /= 10;
        --decimals;
    }
    return decimals;
}

BlockList make_blocks(const Machine& machine, const EyePath& path, const JointPath& joints,
                      const TimedPath& timed) {
    assert(path.size() == joints.size() && path.size() == timed.step_s.size());
    const std::size_t axes = machine.axis_count();
    BlockList list;
    for (std::size_t a = 0; a < axes; ++a) {
        const Axis& axis = machine.axis(a);
        list.axes.push_back({axis.letter, axis.type, axis.resolution_nano});
    }
    list.blocks.reserve(path.size());
    list.nano.reserve(path.size() * axes);
    std::vector<std::int64_t> row(axes);
    double waiting_s = 0.0;
    for (std::size_t i = 0; i < path.size(); ++i) {
        for (std::size_t a = 0; a < axes; ++a) {
            row[a] = rounded_nano(joints.row(i)[a], machine.axis(a), i);
        }
        waiting_s += timed.step_s[i];
        const bool moves =
            i == 0 || !std::equal(row.begin(), row.end(), list.row(list.blocks.size() - 1).begin());
        if (moves) {
            list.blocks.push_back(
                {.duration_s = waiting_s, .piece = path[i].piece, .point = path[i].point});
            list.nano.insert(list.nano.end(), row.begin(), row.end());
            waiting_s = 0.0;
        }
    }
    if (list.blocks.size() > 1) {
        list.blocks.back().duration_s += waiting_s;
    }
    return list;
}

}  // namespace meshwind
