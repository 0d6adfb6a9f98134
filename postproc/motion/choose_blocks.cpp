#include "postproc/motion/choose_blocks.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "core/interrupt.h"
#include "core/parallel.h"
#include "postproc/eye/fibre_curve.h"
#include "postproc/motion/block_check.h"

namespace meshwind {
namespace {

// A block is about as long as the one before: the search starts with this share of it.
constexpr std::size_t kFirstStride = 8;
// Rounds in which steps are cut; what is left over of a step is cut in the next one.
constexpr int kRefineRounds = 4;
constexpr std::size_t kChunk = 256;
// Where a piece begins, its first landing point is the last one before up to joints of some 0.001
// mm, and its eye up to their angle.
constexpr double kRepeated_mm = 0.02;
constexpr double kRepeatedEye_mm = 1.0;
// And no more than this angle at the free length, 1 mm at 200 mm: over an edge a fibre swings.
constexpr double kRepeatedSwing_rad = 0.005;

struct FoundBlock {
    std::size_t last = 0;
    BlockDeviation worst;
};

// The longest block from `first`, no further than `limit`; the search starts at `guess` steps.
FoundBlock longest_block(const BlockCheck& check, std::size_t first, std::size_t limit,
                         std::size_t guess, double offset_mm) {
    FoundBlock good;
    std::size_t bad = limit + 1;
    const auto keeps = [&](std::size_t last) {
        const BlockDeviation worst = check.measure(first, last, offset_mm, true);
        if (!check.within(worst, offset_mm)) {
            bad = last;
            return false;
        }
        good = {last, worst};
        return true;
    };
    good.last = first + 1;
    // Strides that double, up from the guess or down from it, then bisection.
    std::size_t stride = std::max<std::size_t>(guess / kFirstStride, 1);
    const std::size_t start = std::min(first + std::max<std::size_t>(guess, 2), limit);
    if (start > good.last && keeps(start)) {
        while (good.last < limit && keeps(std::min(good.last + stride, limit))) {
            stride *= 2;
        }
    } else {
        while (bad > good.last + 1 &&
               !keeps(std::max(good.last + 1, bad - std::min(stride, bad)))) {
            stride *= 2;
        }
    }
    while (bad - good.last > 1) {
        keeps(good.last + (bad - good.last) / 2);
    }
    if (good.last == first + 1) {
        good.worst = check.measure(first, good.last, offset_mm, false);
    }
    return good;
}

// Points that must be block ends: the first one, and the last one of every piece.
std::vector<std::size_t> fixed_ends(const BlockTask& task) {
    const EyePath& path = task.path;
    std::vector<std::size_t> ends;
    for (std::size_t i = 0; i < path.size(); ++i) {
        const bool stops = i + 1 == path.size() || path[i].piece != path[i + 1].piece;
        if (i == 0 || stops) {
            ends.push_back(i);
        }
    }
    return ends;
}

// The furthest point at which a block from `first` may end on the way to `end`.
std::size_t furthest(const EyePath& path, std::size_t first, std::size_t end, double most_mm) {
    const double left_mm = path[end].s_mm - path[first].s_mm;
    if (left_mm <= most_mm) {
        return end;
    }
    const double even_mm = left_mm / std::ceil(left_mm / most_mm);
    const auto beyond = std::partition_point(
        path.begin() + static_cast<std::ptrdiff_t>(first) + 1,
        path.begin() + static_cast<std::ptrdiff_t>(end), [&](const EyePoint& point) {
            return point.s_mm - path[first].s_mm <= even_mm + kFreeLengthRounding_mm;
        });
    return std::max(static_cast<std::size_t>(beyond - path.begin()) - 1, first + 1);
}

void add_block(BlockChoice& choice, const FoundBlock& block, bool within) {
    choice.ends.push_back(block.last);
    choice.fibre_mm.push_back(block.worst.fibre_mm);
    const auto raise = [](double& worst, double value) { worst = std::max(worst, value); };
    raise(choice.worst_sideways_mm, block.worst.sideways_mm);
    raise(choice.worst_angle_rad, block.worst.angle_rad);
    raise(choice.worst_pull_mm, block.worst.pull_mm);
    raise(choice.worst_eye_mm, block.worst.eye_mm);
    raise(choice.worst_twist_rad, block.worst.twist_rad);
    raise(choice.worst_turn_per_mm, block.worst.turn_per_mm);
    choice.beyond += within ? 0 : 1;
}

// Without the first points of pieces that repeat the last of the piece before: steps of no length
// say nothing but rounding.
EyePath without_repeats(const EyePath& path) {
    EyePath kept;
    kept.reserve(path.size());
    for (const EyePoint& point : path) {
        const double same_eye_mm =
            std::min(kRepeatedEye_mm, kRepeatedSwing_rad * point.free_length_mm);
        const bool repeats = !kept.empty() && kept.back().piece != point.piece &&
                             (point.landing_mm - kept.back().landing_mm).norm() < kRepeated_mm &&
                             (point.eye_mm - kept.back().eye_mm).norm() < same_eye_mm;
        if (!repeats) {
            kept.push_back(point);
        }
    }
    return kept;
}

// From the last point of a piece to one that is not the next piece's first: that was left out.
bool over_joint(const EyePoint& from, const EyePoint& to) {
    return from.piece != to.piece && to.point > 0;
}

EyePoint point_between(const EyePoint& from, const EyePoint& to, double share) {
    const FibreFrame at = fibre_between(from, to, share);
    EyePoint point = from;
    if (over_joint(from, to)) {
        point.piece = to.piece;
        point.point = 0;
    }
    point.s_mm += share * (to.s_mm - from.s_mm);
    point.landing_mm = at.landing_mm;
    point.tangent = at.tangent;
    point.binormal = at.binormal;
    point.eye_mm = at.eye_mm();
    point.free_length_mm = at.free_length_mm;
    point.turn_rad += share * (to.turn_rad - from.turn_rad);
    point.azimuth_rad += share * (to.azimuth_rad - from.azimuth_rad);
    return point;
}

// Per step whether it is to be cut where it is not fine enough; those between pieces are not.
std::vector<char> open_steps(const EyePath& path) {
    std::vector<char> open(path.size(), 0);
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
        open[i] = path[i].piece == path[i + 1].piece || over_joint(path[i], path[i + 1]) ? 1 : 0;
    }
    return open;
}

// Per step into how many it is cut.
// \param open per step: not yet known to be fine enough
std::vector<int> parts_of(const BlockCheck& check, const std::vector<char>& open) {
    std::vector<int> parts(open.size(), 1);
    parallel_for(open.size(), kChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            parts[i] = open[i] != 0 ? check.parts(i) : 1;
        }
    });
    return parts;
}

}  // namespace

BlockChoice choose_blocks(const Machine& machine, const BlockTask& task,
                          const BlockTolerance& tolerance) {
    BlockChoice choice;
    const std::vector<std::size_t> fixed = fixed_ends(task);
    if (fixed.empty()) {
        return choice;
    }
    const BlockCheck check(machine, task, tolerance);
    choice.ends.push_back(fixed.front());
    choice.fibre_mm.push_back(0.0);
    double offset_mm = 0.0;
    std::size_t length = 1;
    for (std::size_t i = 1; i < fixed.size(); ++i) {
        while (choice.ends.back() < fixed[i]) {
            const std::size_t first = choice.ends.back();
            const std::size_t limit = furthest(task.path, first, fixed[i], tolerance.most_mm);
            check_interrupt();
            const FoundBlock block = longest_block(check, first, limit, length, offset_mm);
            add_block(choice, block, check.within(block.worst, offset_mm));
            offset_mm = block.worst.offset_mm;
            length = block.last - first;
        }
    }
    return choice;
}

EyePath refine_path(const Machine& machine, const EyePath& path, RedundancyPolicy policy,
                    const BlockTolerance& tolerance) {
    EyePath fine = without_repeats(path);
    std::vector<char> open = open_steps(fine);
    for (int round = 0; round < kRefineRounds; ++round) {
        const JointPath joints = solve_joints(machine, fine, policy);
        const BlockTask task{.path = fine, .joints = joints};
        const std::vector<int> parts = parts_of(BlockCheck(machine, task, tolerance), open);
        const auto points =
            static_cast<std::size_t>(std::accumulate(parts.begin(), parts.end(), std::int64_t{0}));
        if (points == fine.size()) {
            break;
        }
        EyePath finer;
        finer.reserve(points);
        std::vector<char> still_open;
        for (std::size_t i = 0; i < fine.size(); ++i) {
            finer.push_back(fine[i]);
            for (int k = 1; k < parts[i]; ++k) {
                finer.push_back(
                    point_between(fine[i], fine[i + 1], static_cast<double>(k) / parts[i]));
            }
            still_open.resize(finer.size(), parts[i] > 1 ? 1 : 0);
        }
        fine = std::move(finer);
        open = std::move(still_open);
    }
    return fine;
}

EyePath points_at(const EyePath& path, std::span<const std::size_t> ends) {
    EyePath chosen;
    chosen.reserve(ends.size());
    for (const std::size_t end : ends) {
        chosen.push_back(path[end]);
    }
    return chosen;
}

JointPath points_at(const JointPath& joints, std::span<const std::size_t> ends) {
    JointPath chosen;
    chosen.axis_count = joints.axis_count;
    chosen.joints.reserve(ends.size() * joints.axis_count);
    for (const std::size_t end : ends) {
        chosen.joints.insert(chosen.joints.end(), joints.row(end).begin(), joints.row(end).end());
    }
    return chosen;
}

}  // namespace meshwind
