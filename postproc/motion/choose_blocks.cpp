#include "postproc/motion/choose_blocks.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <numeric>

#include <Eigen/Geometry>

#include "core/interrupt.h"
#include "core/parallel.h"
#include "machines/kinematics.h"
#include "postproc/eye/fibre_curve.h"

namespace meshwind {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// Samples of a block per dense step: at the points and between them, where a parabola is highest.
constexpr std::size_t kSamplesPerStep = 2;
// Secant steps for the landing point: n . (E - P) is nearly straight over a step.
constexpr int kSecants = 2;
// Joint values and frames are good to this; free lengths planned at a limit are not beyond it.
constexpr double kLengthRounding_mm = 1e-6;
// A block is about as long as the one before: the search starts with this share of it.
constexpr std::size_t kFirstStride = 8;
// A step is cut by the square root of its excess, and what is left over in the next round. Beyond
// so many parts the deviation of the whole step says little about that of a part.
constexpr int kRefineRounds = 4;
constexpr double kMostParts = 8.0;
constexpr std::size_t kChunk = 256;
// Where a piece begins, its first landing point is the last one before up to joints of some 0.001
// mm, and its eye up to their angle.
constexpr double kRepeated_mm = 0.02;
constexpr double kRepeatedEye_mm = 1.0;
// And no more than this angle at the free length, 1 mm at 200 mm: over an edge a fibre swings.
constexpr double kRepeatedSwing_rad = 0.005;

// A block, or the part of it up to where it left the tolerance.
struct Deviation {
    double offset_mm = 0.0;  // y, signed, at the end
    double tilt_rad = 0.0;   // dy/ds, signed, where the fibre was laid last
    double turn_per_mm = 0.0;
    double turn_share = 0.0;  // of the room it has
    double sideways_mm = 0.0;
    double angle_rad = 0.0;
    double pull_mm = 0.0;
    double eye_mm = 0.0;
    double eye_share = 0.0;  // of the room it has
    double twist_rad = 0.0;
    double share = 1.0;      // of the tolerance, the least on the way
    double length_mm = 0.0;  // free length beyond the machine's limits
    double fibre_mm = 0.0;
};

// A place on the dense path; the last point has no share.
struct Place {
    std::size_t step = 0;  // between points `step` and `step + 1`
    double share = 0.0;
};

// Where the fibre touches down.
struct Landing {
    Place place;
    FibreFrame at;
};

double angle_between_lines(const Vector3d& a, const Vector3d& b) {
    return std::atan2(a.cross(b).norm(), std::abs(a.dot(b)));
}

class BlockCheck {
public:
    BlockCheck(const Machine& machine, const BlockTask& task, const BlockTolerance& tolerance)
        : machine_(machine), task_(task), path_(task.path), tolerance_(tolerance) {
        assert(path_.size() == task.joints.size());
        assert(task.room_mm.empty() || task.room_mm.size() == path_.size());
        twist_rad_.resize(path_.size());
        normal_.resize(path_.size());
        parallel_for(path_.size(), kChunk, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const Isometry3d pose = mandrel_from_eye(machine_, task_.joints.row(i));
                twist_rad_[i] =
                    angle_between_lines(pose.linear() * machine_.eye.roller, path_[i].binormal);
                normal_[i] = path_[i].tangent.cross(path_[i].binormal);
            }
        });
    }

    // The block from point to point when the fibre arrives `offset_mm` beside the plan; only up to
    // where it leaves the tolerance when `stop` is set.
    [[nodiscard]] Deviation measure(std::size_t first, std::size_t last, double offset_mm,
                                    bool stop) const {
        const auto samples = static_cast<double>(kSamplesPerStep * (last - first));
        Deviation worst;
        worst.offset_mm = offset_mm;
        worst.tilt_rad = -offset_mm / path_[first].free_length_mm;
        Landing landing{{first, 0.0}, fibre_at(path_[first])};
        Place nearest{first, 0.0};
        Payout before = payout(nearest, last);
        std::vector<double> q(task_.joints.axis_count);
        for (double k = 1.0; k <= samples; k += 1.0) {
            const double lambda = k / samples;
            for (std::size_t a = 0; a < q.size(); ++a) {
                q[a] = (1.0 - lambda) * task_.joints.row(first)[a] +
                       lambda * task_.joints.row(last)[a];
            }
            const Isometry3d pose = mandrel_from_eye(machine_, q);
            if (path_[nearest.step].held) {
                // Laid about a pin, wherever the eye is beside the plan.
                landing = {nearest, frame(nearest, last)};
                worst.offset_mm = 0.0;
                worst.tilt_rad = 0.0;
            } else {
                lay(pose.translation(), last, landing, worst);
            }
            compare(pose, last, nearest, worst);
            if (!task_.share.empty()) {
                worst.share = std::min(worst.share, task_.share[nearest.step]);
            }
            const Payout now = payout(nearest, last);
            worst.fibre_mm =
                std::max({worst.fibre_mm, samples * std::abs(now.laid_mm - before.laid_mm),
                          samples * std::abs(now.drawn_mm - before.drawn_mm)});
            before = now;
            if (stop && !within(worst, offset_mm)) {
                break;
            }
        }
        return worst;
    }

    // Fibre that arrives beyond the tolerance may not get further off.
    [[nodiscard]] bool within(const Deviation& block, double offset_mm) const {
        const double sideways = block.share * tolerance_.sideways_mm;
        return block.sideways_mm <= std::max(sideways, std::abs(offset_mm)) &&
               block.angle_rad <= block.share * tolerance_.angle_rad &&
               block.eye_share <= block.share && block.turn_share <= block.share &&
               block.twist_rad <= tolerance_.twist_rad && block.length_mm <= kLengthRounding_mm;
    }

    // Into how many parts a single step must be cut.
    [[nodiscard]] int parts(std::size_t step) const {
        const double move = (path_[step + 1].eye_mm - path_[step].eye_mm).norm();
        if (move < kFinestStep_mm) {
            return 1;
        }
        const Deviation one = measure(step, step + 1, 0.0, false);
        const double excess =
            std::max({one.pull_mm / tolerance_.sideways_mm, one.angle_rad / tolerance_.angle_rad,
                      one.eye_share, one.twist_rad / tolerance_.twist_rad});
        const double wish = std::min(std::ceil(std::sqrt(excess)), kMostParts);
        return std::max(1, static_cast<int>(std::min(wish, std::ceil(move / kFinestStep_mm))));
    }

private:
    // Fibre laid since the start of the program, and drawn through the eye.
    struct Payout {
        double laid_mm = 0.0;
        double drawn_mm = 0.0;
    };

    [[nodiscard]] FibreFrame frame(const Place& place, std::size_t last) const {
        return place.step == last || place.share == 0.0
                   ? fibre_at(path_[place.step])
                   : fibre_between(path_[place.step], path_[place.step + 1], place.share);
    }

    [[nodiscard]] Payout payout(const Place& place, std::size_t last) const {
        const EyePoint& from = path_[place.step];
        const EyePoint& to = path_[place.step == last ? last : place.step + 1];
        const double laid = from.s_mm + place.share * (to.s_mm - from.s_mm);
        return {laid, laid + from.free_length_mm +
                          place.share * (to.free_length_mm - from.free_length_mm)};
    }

    // Height of the eye over the tangent plane at a place: below zero once the fibre has been laid
    // beyond that place.
    [[nodiscard]] static double height(const FibreFrame& at, const Vector3d& eye_mm) {
        return at.normal.dot(eye_mm - at.landing_mm);
    }
    [[nodiscard]] double height(std::size_t point, const Vector3d& eye_mm) const {
        return normal_[point].dot(eye_mm - path_[point].landing_mm);
    }

    // Moves on to the landing point under the eye; stays where the eye is above the tangent plane.
    void advance(const Vector3d& eye_mm, std::size_t last, Landing& landing) const {
        Place& place = landing.place;
        while (place.step < last && height(place.step + 1, eye_mm) <= 0.0) {
            place = {place.step + 1, 0.0};
            landing.at = fibre_at(path_[place.step]);
        }
        double low = height(landing.at, eye_mm);
        if (place.step == last || low >= 0.0) {
            return;
        }
        double left = place.share;
        double right = 1.0;
        double high = height(place.step + 1, eye_mm);
        for (int i = 0; i < kSecants; ++i) {
            place.share = left + (right - left) * low / (low - high);
            landing.at = fibre_between(path_[place.step], path_[place.step + 1], place.share);
            const double middle = height(landing.at, eye_mm);
            (middle < 0.0 ? left : right) = place.share;
            (middle < 0.0 ? low : high) = middle;
        }
    }

    // Lays the fibre up to the landing point under the eye.
    void lay(const Vector3d& eye_mm, std::size_t last, Landing& landing, Deviation& worst) const {
        const double before_mm = payout(landing.place, last).laid_mm;
        advance(eye_mm, last, landing);
        const FibreFrame& at = landing.at;
        const double laid_mm = payout(landing.place, last).laid_mm - before_mm;
        const Vector3d free = eye_mm - at.landing_mm;
        const double pull = at.binormal.dot(free);
        const double length = at.tangent.dot(free);
        if (laid_mm > 0.0) {
            const double tilt = (pull - worst.offset_mm) / length;
            worst.angle_rad = std::max(worst.angle_rad, std::abs(tilt));
            const double turn = std::abs(tilt - worst.tilt_rad) / std::max(laid_mm, kTurnLength_mm);
            worst.tilt_rad = tilt;
            worst.turn_per_mm = std::max(worst.turn_per_mm, turn);
            if (!task_.turn_room_per_mm.empty()) {
                worst.turn_share =
                    std::max(worst.turn_share, turn / task_.turn_room_per_mm[landing.place.step]);
            }
            worst.offset_mm = pull + (worst.offset_mm - pull) * std::exp(-laid_mm / length);
        } else if (height(at, eye_mm) > 0.0 && std::abs(pull) > std::abs(worst.offset_mm)) {
            worst.offset_mm = pull;  // lifted off and laid again, perhaps over a long flat
        }
        worst.pull_mm = std::max(worst.pull_mm, std::abs(pull));
        worst.sideways_mm = std::max(worst.sideways_mm, std::abs(worst.offset_mm));
    }

    struct OnStep {
        double share = 0.0;
        double squared_mm2 = 0.0;  // distance
    };

    // The place on a step of the planned eye, taken as straight, that is nearest to the eye.
    [[nodiscard]] OnStep nearest_on(std::size_t step, const Vector3d& eye_mm) const {
        const Vector3d& from = path_[step].eye_mm;
        const Vector3d along = path_[step + 1].eye_mm - from;
        const double squared = along.squaredNorm();
        const double share =
            squared > 0.0 ? std::clamp(along.dot(eye_mm - from) / squared, 0.0, 1.0) : 0.0;
        return {share, (eye_mm - from - share * along).squaredNorm()};
    }

    // Moves on while the next step is not further away: also over steps that lead back a little, as
    // at the joint of two pieces.
    void approach(const Vector3d& eye_mm, std::size_t last, Place& nearest) const {
        if (nearest.step == last) {
            return;
        }
        OnStep here = nearest_on(nearest.step, eye_mm);
        while (nearest.step + 1 < last) {
            const OnStep next = nearest_on(nearest.step + 1, eye_mm);
            if (next.squared_mm2 > here.squared_mm2) {
                break;
            }
            here = next;
            nearest = {nearest.step + 1, 0.0};
        }
        nearest.share = std::max(nearest.share, here.share);
        if (nearest.share >= 1.0) {
            nearest = {nearest.step + 1, 0.0};
        }
    }

    // Compares the eye with what is planned at the nearest place.
    void compare(const Isometry3d& pose, std::size_t last, Place& nearest, Deviation& worst) const {
        const Vector3d eye_mm = pose.translation();
        approach(eye_mm, last, nearest);
        const bool end = nearest.step == last;
        const FibreFrame at = frame(nearest, last);
        const std::size_t to = end ? last : nearest.step + 1;
        // Across the step alone: the place along it is that of the straight step.
        const Vector3d along = (path_[to].eye_mm - path_[nearest.step].eye_mm).normalized();
        const Vector3d off = eye_mm - at.eye_mm();
        const double eye = (off - off.dot(along) * along).norm();
        worst.eye_mm = std::max(worst.eye_mm, eye);
        double room = tolerance_.eye_mm;
        if (!task_.room_mm.empty()) {
            room = std::min({room, task_.room_mm[nearest.step], task_.room_mm[to]});
        }
        worst.eye_share = std::max(worst.eye_share, eye / room);
        const double length = (eye_mm - at.landing_mm).norm();
        worst.length_mm = std::max({worst.length_mm, length - machine_.fibre.max_free_length_mm,
                                    machine_.fibre.min_free_length_mm - length});
        const double twist = angle_between_lines(pose.linear() * machine_.eye.roller, at.binormal) -
                             std::max(twist_rad_[nearest.step], twist_rad_[to]);
        worst.twist_rad = std::max(worst.twist_rad, twist);
    }

    const Machine& machine_;
    const BlockTask& task_;
    const EyePath& path_;
    const BlockTolerance& tolerance_;
    std::vector<double> twist_rad_;
    std::vector<Vector3d> normal_;
};

struct FoundBlock {
    std::size_t last = 0;
    Deviation worst;
};

// The longest block from `first`, no further than `limit`; the search starts at `guess` steps.
FoundBlock longest_block(const BlockCheck& check, std::size_t first, std::size_t limit,
                         std::size_t guess, double offset_mm) {
    FoundBlock good;
    std::size_t bad = limit + 1;
    const auto keeps = [&](std::size_t last) {
        const Deviation worst = check.measure(first, last, offset_mm, true);
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
            return point.s_mm - path[first].s_mm <= even_mm + kLengthRounding_mm;
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
    std::vector<char> open(fine.size(), 0);  // per step: not yet known to be fine enough
    for (std::size_t i = 0; i + 1 < fine.size(); ++i) {
        open[i] = fine[i].piece == fine[i + 1].piece || over_joint(fine[i], fine[i + 1]) ? 1 : 0;
    }
    for (int round = 0; round < kRefineRounds; ++round) {
        const JointPath joints = solve_joints(machine, fine, policy);
        const BlockTask task{.path = fine, .joints = joints};
        const BlockCheck check(machine, task, tolerance);
        std::vector<int> parts(fine.size(), 1);
        parallel_for(fine.size(), kChunk, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                parts[i] = open[i] != 0 ? check.parts(i) : 1;
            }
        });
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
