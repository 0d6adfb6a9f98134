#include "postproc/ringhead/carried_path.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <tuple>

#include "machines/arm_inverse.h"
#include "postproc/collision/chunk.h"
#include "postproc/ringhead/ring_head.h"

namespace meshwind {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// Starts: of an arm those that its closed form gives, else where the search from zero leads.
std::vector<std::vector<double>> starts(const Machine& machine, const Isometry3d& pose) {
    const std::vector<double> zero(machine.axis_count(), 0.0);
    std::vector<std::vector<double>> found = {zero};
    if (const auto arm = ArmInverse::recognise(machine)) {
        for (const ArmInverse::Joints& joints : arm->solve(pose, zero)) {
            std::vector<double>& start = found.emplace_back(zero);
            std::copy(joints.begin(), joints.end(), start.begin());
        }
        const auto step = [](const std::vector<double>& q) {
            double largest = 0.0;
            for (const double value : q) {
                largest = std::max(largest, std::abs(value));
            }
            return largest;
        };
        std::stable_sort(found.begin(), found.end(),
                         [&](const auto& a, const auto& b) { return step(a) < step(b); });
    }
    return found;
}

CarriedJoints follow(const Machine& machine, const PoseInverse& inverse,
                     const std::vector<CarriedSample>& samples, const Isometry3d& tool,
                     std::vector<double> joints) {
    const Isometry3d mandrel_from_flange = tool.inverse();
    CarriedJoints result;
    result.path.axis_count = machine.axis_count();
    result.path.joints.reserve(samples.size() * machine.axis_count());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const PoseState state =
            inverse.solve(samples[i].pose * mandrel_from_flange, joints, joints);
        result.path.joints.insert(result.path.joints.end(), joints.begin(), joints.end());
        if (state.residual_mm > result.residual_mm || state.residual_rad > result.residual_rad) {
            result.residual_at = i;
        }
        result.residual_mm = std::max(result.residual_mm, state.residual_mm);
        result.residual_rad = std::max(result.residual_rad, state.residual_rad);
        if (i > 0 && state.flip) {
            result.first_flip = result.flips == 0 ? i : result.first_flip;
            ++result.flips;
        }
        if (state.singular < result.singular) {
            result.singular = state.singular;
            result.nearest = state.nearest;
            result.singular_at = i;
        }
    }
    find_travel_violations(machine, result.path);
    return result;
}

bool lacks_less(const CarriedJoints& a, const CarriedJoints& b) {
    const auto rank = [](const CarriedJoints& j) {
        return std::make_tuple(j.reached() ? 0.0 : j.residual_mm + j.residual_rad, j.flips,
                               j.path.violations.size());
    };
    return rank(a) < rank(b);
}

// The rows at the ends of the moves.
JointPath ends_of_moves(const std::vector<CarriedSample>& samples, const CarriedJoints& joints) {
    JointPath ends;
    ends.axis_count = joints.path.axis_count;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (i + 1 == samples.size() || samples[i + 1].move != samples[i].move) {
            const auto row = joints.path.row(i);
            ends.joints.insert(ends.joints.end(), row.begin(), row.end());
        }
    }
    return ends;
}

// Share of its move that leads to a sample.
double piece_of(const std::vector<CarriedSample>& samples, std::size_t i) {
    return samples[i].share - (samples[i - 1].move == samples[i].move ? samples[i - 1].share : 0.0);
}

// How far the axis can be from the chords of its stations: an arc's sagitta, twice for a curve
// whose turn is not even.
double most_sag_mm(const FrameAxis& axis) {
    double sag_mm = 0.0;
    for (std::size_t i = 1; i < axis.stations().size(); ++i) {
        const AxisStation& from = axis.stations()[i - 1];
        const AxisStation& to = axis.stations()[i];
        const Vector3d chord = (to.point_mm - from.point_mm).normalized();
        const double turn = std::max(std::acos(std::clamp(chord.dot(from.tangent), -1.0, 1.0)),
                                     std::acos(std::clamp(chord.dot(to.tangent), -1.0, 1.0)));
        sag_mm = std::max(sag_mm, 0.5 * turn * (to.point_mm - from.point_mm).norm());
    }
    return sag_mm;
}

// The most that a point within `farthest_mm` of the frame's origin moves in half of the longer step
// beside a sample.
double half_step_mm(const std::vector<CarriedSample>& samples, std::size_t i, double farthest_mm) {
    double moved_mm = 0.0;
    for (const std::size_t next : {i, i + 1}) {
        if (next > 0 && next < samples.size()) {
            const Isometry3d& from = samples[next - 1].pose;
            const Isometry3d& to = samples[next].pose;
            moved_mm = std::max(moved_mm, 0.5 * ((to.translation() - from.translation()).norm() +
                                                 turn_between(from, to) * farthest_mm));
        }
    }
    return moved_mm;
}

}  // namespace

std::vector<CarriedSample> sample_moves(const std::vector<double>& s_mm,
                                        const std::vector<Isometry3d>& poses) {
    assert(s_mm.size() == poses.size() && !poses.empty());
    std::vector<CarriedSample> samples = {{0, 1.0, s_mm.front(), poses.front()}};
    for (std::size_t i = 1; i < poses.size(); ++i) {
        const double way_mm = (poses[i].translation() - poses[i - 1].translation()).norm();
        const double turn_rad = turn_between(poses[i - 1], poses[i]);
        const int pieces = std::max(1, static_cast<int>(std::ceil(std::max(
                                           way_mm / kSampleWay_mm, turn_rad / kSampleTurn_rad))));
        for (int k = 1; k <= pieces; ++k) {
            const double share = static_cast<double>(k) / pieces;
            samples.push_back({i, share, s_mm[i - 1] + share * (s_mm[i] - s_mm[i - 1]),
                               lin_between(poses[i - 1], poses[i], share)});
        }
    }
    return samples;
}

CarriedJoints follow_samples(const Machine& machine, const std::vector<CarriedSample>& samples,
                             const Isometry3d& tool) {
    const PoseInverse inverse(machine);
    CarriedJoints best;
    bool first = true;
    for (std::vector<double>& start : starts(machine, samples.front().pose * tool.inverse())) {
        CarriedJoints found = follow(machine, inverse, samples, tool, std::move(start));
        if (first || lacks_less(found, best)) {
            best = std::move(found);
            first = false;
        }
        if (best.holds()) {
            break;
        }
    }
    return best;
}

TimedPath time_moves(const Machine& machine, const std::vector<CarriedSample>& samples,
                     const CarriedJoints& joints, double speed_mm_s) {
    const JointPath ends = ends_of_moves(samples, joints);
    // The time law knows a move by its ends; what its pieces ask for counts as passage.
    std::vector<double> least_s(ends.size(), 0.0);
    for (std::size_t i = 1; i < samples.size(); ++i) {
        const double piece = piece_of(samples, i);
        double& least = least_s[samples[i].move];
        least = std::max(least, (samples[i].s_mm - samples[i - 1].s_mm) / (piece * speed_mm_s));
        for (std::size_t a = 0; a < machine.axis_count(); ++a) {
            const double step = std::abs(joints.path.row(i)[a] - joints.path.row(i - 1)[a]);
            least = std::max(least, step / (piece * machine.axis(a).velocity));
        }
    }
    std::vector<double> passage_mm;
    passage_mm.reserve(least_s.size());
    for (const double least : least_s) {
        passage_mm.push_back(least * speed_mm_s);
    }
    return time_path(machine, passage_mm, ends, {.fibre_speed_mm_s = speed_mm_s});
}

AxisLoads move_loads(const Machine& machine, const std::vector<CarriedSample>& samples,
                     const CarriedJoints& joints, const std::vector<double>& duration_s) {
    std::vector<double> piece_s(samples.size(), 0.0);
    for (std::size_t i = 1; i < samples.size(); ++i) {
        piece_s[i] = piece_of(samples, i) * duration_s[samples[i].move];
    }
    AxisLoads loads;
    loads.velocity = axis_loads(machine, joints.path, piece_s).velocity;
    loads.velocity.step = samples[loads.velocity.step].move;
    loads.acceleration =
        axis_loads(machine, ends_of_moves(samples, joints), duration_s).acceleration;
    return loads;
}

std::optional<FrameClearance> frame_clearance(const Machine& machine, const FrameAxis& axis,
                                              const std::vector<CarriedSample>& samples,
                                              double tube_radius_mm) {
    double farthest_mm = 0.0;
    for (const AxisStation& station : axis.stations()) {
        farthest_mm = std::max(farthest_mm, station.point_mm.norm());
    }
    const double sag_mm = most_sag_mm(axis);
    std::optional<FrameClearance> worst;
    std::vector<Vector3d> points(axis.stations().size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double moved_mm = half_step_mm(samples, i, farthest_mm);
        for (std::size_t k = 0; k < points.size(); ++k) {
            points[k] = samples[i].pose * axis.stations()[k].point_mm;
        }
        for (std::size_t body = 0; body < machine.bodies.size(); ++body) {
            const Capsule* capsule = std::get_if<Capsule>(&machine.bodies[body].shape);
            if (capsule == nullptr || machine.bodies[body].link) {
                continue;
            }
            for (std::size_t k = 1; k < points.size(); ++k) {
                const double clear_mm = segment_distance_mm(points[k - 1], points[k],
                                                            capsule->from_mm, capsule->to_mm) -
                                        capsule->radius_mm - tube_radius_mm - moved_mm - sag_mm;
                if (!worst || clear_mm < worst->least_mm) {
                    worst = {clear_mm, i, body};
                }
            }
        }
    }
    return worst;
}

}  // namespace meshwind
