#include "postproc/motion/block_check.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/parallel.h"
#include "machines/kinematics.h"

namespace meshwind {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// Samples of a block per dense step: at the points and between them, where a parabola is highest.
constexpr std::size_t kSamplesPerStep = 2;
// Secant steps for the landing point: n . (E - P) is nearly straight over a step.
constexpr int kSecants = 2;
// A step is cut by the square root of its excess, and what is left over in the next round. Beyond
// so many parts the deviation of the whole step says little about that of a part.
constexpr double kMaxParts = 8.0;
constexpr std::size_t kChunk = 256;

double angle_between_lines(const Vector3d& a, const Vector3d& b) {
    return std::atan2(a.cross(b).norm(), std::abs(a.dot(b)));
}

// Fibre laid since the start of the program, and drawn through the eye.
struct Payout {
    double laid_mm = 0.0;
    double drawn_mm = 0.0;
};

// \param last point of the block
Payout payout(const EyePath& path, const DensePlace& place, std::size_t last) {
    const EyePoint& from = path[place.step];
    const EyePoint& to = path[place.step == last ? last : place.step + 1];
    const double laid = from.s_mm + place.share * (to.s_mm - from.s_mm);
    return {laid,
            laid + from.free_length_mm + place.share * (to.free_length_mm - from.free_length_mm)};
}

FibreFrame frame(const EyePath& path, const DensePlace& place, std::size_t last) {
    return place.step == last || place.share == 0.0
               ? fibre_at(path[place.step])
               : fibre_between(path[place.step], path[place.step + 1], place.share);
}

// Height of the eye over the tangent plane at a place: below zero once the fibre has been laid
// beyond that place.
double height_over(const FibreFrame& at, const Vector3d& eye_mm) {
    return at.normal.dot(eye_mm - at.landing_mm);
}

struct OnStep {
    double share = 0.0;
    double squared_mm2 = 0.0;  // distance
};

// The place on a step of the planned eye, taken as straight, that is nearest to the eye.
OnStep nearest_on(const EyePath& path, std::size_t step, const Vector3d& eye_mm) {
    const Vector3d& from = path[step].eye_mm;
    const Vector3d along = path[step + 1].eye_mm - from;
    const double squared = along.squaredNorm();
    const double share =
        squared > 0.0 ? std::clamp(along.dot(eye_mm - from) / squared, 0.0, 1.0) : 0.0;
    return {share, (eye_mm - from - share * along).squaredNorm()};
}

// Moves on while the next step is not further away: also over steps that lead back a little, as
// at the joint of two pieces.
void approach(const EyePath& path, const Vector3d& eye_mm, std::size_t last, DensePlace& nearest) {
    if (nearest.step == last) {
        return;
    }
    OnStep here = nearest_on(path, nearest.step, eye_mm);
    while (nearest.step + 1 < last) {
        const OnStep next = nearest_on(path, nearest.step + 1, eye_mm);
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

}  // namespace

BlockCheck::BlockCheck(const Machine& machine, const BlockTask& task,
                       const BlockTolerance& tolerance)
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

BlockDeviation BlockCheck::measure(std::size_t first, std::size_t last, double offset_mm,
                                   bool stop) const {
    const auto samples = static_cast<double>(kSamplesPerStep * (last - first));
    BlockDeviation worst;
    worst.offset_mm = offset_mm;
    worst.tilt_rad = -offset_mm / path_[first].free_length_mm;
    DenseLanding landing{{first, 0.0}, fibre_at(path_[first])};
    DensePlace nearest{first, 0.0};
    Payout before = payout(path_, nearest, last);
    std::vector<double> q(task_.joints.axis_count);
    for (double k = 1.0; k <= samples; k += 1.0) {
        const double lambda = k / samples;
        for (std::size_t a = 0; a < q.size(); ++a) {
            q[a] = (1.0 - lambda) * task_.joints.row(first)[a] + lambda * task_.joints.row(last)[a];
        }
        const Isometry3d pose = mandrel_from_eye(machine_, q);
        if (path_[nearest.step].held) {
            // Laid about a pin, wherever the eye is beside the plan.
            landing = {nearest, frame(path_, nearest, last)};
            worst.offset_mm = 0.0;
            worst.tilt_rad = 0.0;
        } else {
            lay(pose.translation(), last, landing, worst);
        }
        approach(path_, pose.translation(), last, nearest);
        compare(pose, last, nearest, worst);
        if (!task_.share.empty()) {
            worst.share = std::min(worst.share, task_.share[nearest.step]);
        }
        const Payout now = payout(path_, nearest, last);
        worst.fibre_mm = std::max({worst.fibre_mm, samples * std::abs(now.laid_mm - before.laid_mm),
                                   samples * std::abs(now.drawn_mm - before.drawn_mm)});
        before = now;
        if (stop && !within(worst, offset_mm)) {
            break;
        }
    }
    return worst;
}

bool BlockCheck::within(const BlockDeviation& block, double offset_mm) const {
    const double sideways = block.share * tolerance_.sideways_mm;
    return block.sideways_mm <= std::max(sideways, std::abs(offset_mm)) &&
           block.angle_rad <= block.share * tolerance_.angle_rad &&
           block.eye_share <= block.share && block.turn_share <= block.share &&
           block.twist_rad <= tolerance_.twist_rad && block.length_mm <= kFreeLengthRounding_mm;
}

int BlockCheck::parts(std::size_t step) const {
    const double move = (path_[step + 1].eye_mm - path_[step].eye_mm).norm();
    if (move < kFinestStep_mm) {
        return 1;
    }
    const BlockDeviation one = measure(step, step + 1, 0.0, false);
    const double excess =
        std::max({one.pull_mm / tolerance_.sideways_mm, one.angle_rad / tolerance_.angle_rad,
                  one.eye_share, one.twist_rad / tolerance_.twist_rad});
    const double wish = std::min(std::ceil(std::sqrt(excess)), kMaxParts);
    return std::max(1, static_cast<int>(std::min(wish, std::ceil(move / kFinestStep_mm))));
}

double BlockCheck::height(std::size_t point, const Vector3d& eye_mm) const {
    return normal_[point].dot(eye_mm - path_[point].landing_mm);
}

// Moves on to the landing point under the eye; stays where the eye is above the tangent plane.
void BlockCheck::advance(const Vector3d& eye_mm, std::size_t last, DenseLanding& landing) const {
    DensePlace& place = landing.place;
    while (place.step < last && height(place.step + 1, eye_mm) <= 0.0) {
        place = {place.step + 1, 0.0};
        landing.at = fibre_at(path_[place.step]);
    }
    double low = height_over(landing.at, eye_mm);
    if (place.step == last || low >= 0.0) {
        return;
    }
    double left = place.share;
    double right = 1.0;
    double high = height(place.step + 1, eye_mm);
    for (int i = 0; i < kSecants; ++i) {
        place.share = left + (right - left) * low / (low - high);
        landing.at = fibre_between(path_[place.step], path_[place.step + 1], place.share);
        const double middle = height_over(landing.at, eye_mm);
        (middle < 0.0 ? left : right) = place.share;
        (middle < 0.0 ? low : high) = middle;
    }
}

// Lays the fibre up to the landing point under the eye.
void BlockCheck::lay(const Vector3d& eye_mm, std::size_t last, DenseLanding& landing,
                     BlockDeviation& worst) const {
    const double before_mm = payout(path_, landing.place, last).laid_mm;
    advance(eye_mm, last, landing);
    const FibreFrame& at = landing.at;
    const double laid_mm = payout(path_, landing.place, last).laid_mm - before_mm;
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
    } else if (height_over(at, eye_mm) > 0.0 && std::abs(pull) > std::abs(worst.offset_mm)) {
        worst.offset_mm = pull;  // lifted off and laid again, perhaps over a long flat
    }
    worst.pull_mm = std::max(worst.pull_mm, std::abs(pull));
    worst.sideways_mm = std::max(worst.sideways_mm, std::abs(worst.offset_mm));
}

// Compares the eye with what is planned at the nearest place.
void BlockCheck::compare(const Isometry3d& pose, std::size_t last, const DensePlace& nearest,
                         BlockDeviation& worst) const {
    const Vector3d eye_mm = pose.translation();
    const bool end = nearest.step == last;
    const FibreFrame at = frame(path_, nearest, last);
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

}  // namespace meshwind
