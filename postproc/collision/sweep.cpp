#include "postproc/collision/sweep.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>

#include "machines/kinematics.h"

namespace meshwind {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// Pieces and steps larger than this are divided without a search where the table, which is good to
// some mm, says that it would not settle them.
constexpr double kMinUndecided_mm = 1.0;
constexpr double kGuess_mm = 2.0;

using Joints = std::vector<double>;

Joints between(std::span<const double> a, std::span<const double> b, double share) {
    Joints q(a.size());
    for (std::size_t i = 0; i < q.size(); ++i) {
        q[i] = a[i] + share * (b[i] - a[i]);
    }
    return q;
}

// Sine and versine of a rotary axis.
struct AxisTurn {
    double sine = 0.0;
    double versine = 0.0;
};

// The axes between a part's link and the frame in which it is swept, in the order in which they
// carry a point of the part there, and how far they move it.
class Way {
public:
    // To the frame of the link `to`, or of the mandrel.
    Way(const MachineStep& step, char link, std::optional<char> to) : step_(step) {
        const Machine& machine = step.machine;
        const std::size_t eye = machine.mandrel_chain.size();
        const std::size_t carrier = joints_of(machine, link);
        for (std::size_t j = carrier; j > eye; --j) {
            axes_.push_back({j - 1, 1.0});
        }
        const std::size_t on_mandrel = carrier > eye ? 0 : carrier;
        const std::size_t goal = to ? joints_of(machine, *to) : eye;
        for (std::size_t j = on_mandrel; j > goal; --j) {
            axes_.push_back({j - 1, 1.0});
        }
        for (std::size_t j = on_mandrel; j < goal; ++j) {
            axes_.push_back({j, -1.0});
        }
    }

    // Upper bound of how far a ball around `point_mm` (machine frame at zero) moves while the
    // joints go from `q` by half_share of the step: isometries do not change distances, so each
    // axis counts with the ball's distance from it as those before have placed the ball. Linear
    // axes in a row add up as vectors.
    [[nodiscard]] double motion_mm(const Joints& q, double half_share, const Vector3d& point_mm,
                                   double ball_mm) const {
        return motion_mm(q, turns_of(q), half_share, point_mm, ball_mm);
    }

    // Per axis on the way.
    [[nodiscard]] std::vector<AxisTurn> turns_of(const Joints& q) const {
        std::vector<AxisTurn> turns(axes_.size());
        for (std::size_t i = 0; i < turns.size(); ++i) {
            const auto& [joint, sign] = axes_[i];
            if (step_.machine.axis(joint).type == AxisType::Rotary) {
                turns[i] = {std::sin(sign * q[joint]), 1.0 - std::cos(sign * q[joint])};
            }
        }
        return turns;
    }

    // The same where the turns at `q` are known.
    [[nodiscard]] double motion_mm(const Joints& q, std::span<const AxisTurn> turns,
                                   double half_share, Vector3d point_mm, double ball_mm) const {
        double moved = 0.0;
        Vector3d slide = Vector3d::Zero();
        for (std::size_t i = 0; i < axes_.size(); ++i) {
            const auto& [joint, sign] = axes_[i];
            const Axis& axis = step_.machine.axis(joint);
            const double change = half_share * (step_.to[joint] - step_.from[joint]);
            if (axis.type == AxisType::Linear) {
                slide += sign * change * axis.direction;
                point_mm += sign * q[joint] * axis.direction;
                continue;
            }
            moved += slide.norm();
            slide.setZero();
            const Vector3d arm = point_mm - axis.point_mm;
            const Vector3d across = axis.direction.cross(arm);
            moved += std::abs(change) * (across.norm() + ball_mm);
            point_mm += turns[i].sine * across + turns[i].versine * axis.direction.cross(across);
        }
        return moved + slide.norm();
    }

private:
    struct SignedAxis {
        std::size_t joint;
        double sign;
    };

    // One more than the joint that carries the link; 0 for the base.
    static std::size_t joints_of(const Machine& machine, char link) {
        return link == kBaseLink ? 0 : *machine.joint_of(link) + 1;
    }

    const MachineStep& step_;
    std::vector<SignedAxis> axes_;
};

// Sweep of a link's pieces over one step, in the mandrel frame.
struct LinkSweep {
    const MachineStep& step;
    const SweptObstacles& mandrel;
    char link;
    const Way& way;
};

// The middle of a share of the step.
struct Middle {
    double low;
    double high;
    Joints q;
    std::vector<AxisTurn> turns;
    Isometry3d pose;
};

Middle middle_of(const LinkSweep& sweep, double low, double high) {
    const MachineStep& step = sweep.step;
    Middle at{low, high, between(step.from, step.to, 0.5 * (low + high)), {}, {}};
    at.turns = sweep.way.turns_of(at.q);
    at.pose = base_from_mandrel(step.machine, at.q).inverse() *
              base_from_part(step.machine, at.q, sweep.link);
    return at;
}

// True where a search would hardly settle a large piece: by what is tabulated the distance is
// between what is needed and what would do. Its parts are looked at at once, which finds the same.
bool is_undecided(const RayQuery& obstacles, const Vector3d& centre, double need, double search,
                  double size) {
    if (size < kMinUndecided_mm || !obstacles.has_table()) {
        return false;
    }
    const double guess = obstacles.distance_estimate_mm(centre);
    return guess > need && guess + kGuess_mm < search;
}

bool is_clear_at(const LinkSweep& sweep, const Chunk& chunk, const Middle& at) {
    const RayQuery& obstacles = sweep.mandrel.obstacles;
    const double reach = chunk.reach_mm();
    const double move = sweep.way.motion_mm(at.q, at.turns, 0.5 * (at.high - at.low),
                                            chunk.centre(), reach + chunk.radius_mm);
    const double need = chunk.radius_mm + sweep.mandrel.need_mm;
    const double search = reach + need + move;
    const Vector3d centre = at.pose * chunk.centre();
    if (obstacles.is_beyond(centre, search)) {
        return true;
    }
    if (!is_undecided(obstacles, centre, need, search, std::max(move, reach))) {
        const double distance = obstacles.closest(centre, search).distance_mm;
        if (distance >= search) {
            return true;
        }
        if (distance < need || std::max(move, reach) < kSweepResolution_mm) {
            return false;
        }
    }
    if (move > reach) {
        const double middle = 0.5 * (at.low + at.high);
        return is_clear_at(sweep, chunk, middle_of(sweep, at.low, middle)) &&
               is_clear_at(sweep, chunk, middle_of(sweep, middle, at.high));
    }
    const auto halves = chunk.halves();
    return is_clear_at(sweep, halves[0], at) && is_clear_at(sweep, halves[1], at);
}

// Pose of a link in the frame of the body's link.
Isometry3d body_from(const MachineStep& step, const LinkedChunk& body, const Joints& q, char link) {
    return base_from_part(step.machine, q, body.link).inverse() *
           base_from_part(step.machine, q, link);
}

// A share of a step.
struct StepShare {
    double low = 0.0;
    double high = 1.0;
};

// In the frame of the body's link. `piece` at a joint position; `motion` bounds how far any of its
// points gets from there within half a share of the step.
template <typename Piece, typename Motion>
bool is_clear_within(const MachineStep& step, const Chunk& body, const Piece& piece,
                     const Motion& motion, double need_mm, StepShare share) {
    const double middle = 0.5 * (share.low + share.high);
    const Joints q = between(step.from, step.to, middle);
    const Chunk at = piece(q, middle);
    const double move = motion(q, middle, 0.5 * (share.high - share.low));
    const double search = need_mm + move;
    const double balls = (at.centre() - body.centre()).norm() - at.reach_mm() - body.reach_mm() -
                         at.radius_mm - body.radius_mm;
    if (balls >= search) {
        return true;
    }
    const double distance = chunk_distance_mm(at, body);
    if (distance >= search) {
        return true;
    }
    if (distance < need_mm || move < kSweepResolution_mm) {
        return false;
    }
    return is_clear_within(step, body, piece, motion, need_mm, {share.low, middle}) &&
           is_clear_within(step, body, piece, motion, need_mm, {middle, share.high});
}

}  // namespace

std::vector<LinkedChunk> chunks_of(const std::vector<HeadEnvelope::Part>& parts) {
    std::vector<LinkedChunk> chunks;
    for (const HeadEnvelope::Part& part : parts) {
        if (part.triangles.faces.empty()) {
            chunks.push_back({part.link, chunk_of(part.capsule)});
        }
        for (const Chunk& chunk : chunks_of(part.triangles)) {
            chunks.push_back({part.link, chunk});
        }
    }
    return chunks;
}

Isometry3d base_from_part(const Machine& machine, std::span<const double> q, char link) {
    return link == kBaseLink ? Isometry3d::Identity() : base_from_link(machine, q, link);
}

bool is_clear(const MachineStep& step, const SweptObstacles& mandrel, const LinkedChunk& part) {
    const Way way(step, part.link, std::nullopt);
    const LinkSweep sweep{step, mandrel, part.link, way};
    return is_clear_at(sweep, part.chunk, middle_of(sweep, 0.0, 1.0));
}

double most_motion_mm(const MachineStep& step, const LinkedChunk& part) {
    const Way way(step, part.link, std::nullopt);
    return way.motion_mm(Joints(step.to.begin(), step.to.end()), 1.0, part.chunk.centre(),
                         part.chunk.reach_mm() + part.chunk.radius_mm);
}

bool is_clear_of_body(const MachineStep& step, const LinkedChunk& body, const LinkedChunk& part,
                      double need_mm) {
    const Way way(step, part.link, body.link);
    const auto piece = [&](const Joints& q, double /*share*/) {
        return part.chunk.moved(body_from(step, body, q, part.link));
    };
    const auto motion = [&](const Joints& q, double /*share*/, double half) {
        return way.motion_mm(q, half, part.chunk.centre(),
                             part.chunk.reach_mm() + part.chunk.radius_mm);
    };
    return is_clear_within(step, body.chunk, piece, motion, need_mm, {});
}

bool is_fibre_clear_of_body(const MachineStep& step, const LinkedChunk& body, const EyePoint& a,
                            const EyePoint& b) {
    const Machine& machine = step.machine;
    const char last = machine.mandrel_chain.back().letter;
    const Way of_landing(step, last, body.link);
    const char eye_link = machine.eye_chain.empty() ? kBaseLink : machine.eye_chain.back().letter;
    const Way of_eye(step, eye_link, body.link);
    const auto landing_at_zero = [&](const Joints& q, double share) {
        const Vector3d landing = a.landing_mm + share * (b.landing_mm - a.landing_mm);
        return base_from_part(machine, q, last).inverse() *
               (base_from_mandrel(machine, q) * landing);
    };
    const auto fibre = [&](const Joints& q, double share) {
        Chunk chunk;
        chunk.corner[0] = body_from(step, body, q, last) * landing_at_zero(q, share);
        chunk.corner[1] = body_from(step, body, q, eye_link) * machine.eye.position_mm;
        chunk.corner[2] = chunk.corner[1];
        return chunk;
    };
    const auto motion = [&](const Joints& q, double share, double half) {
        const double landing = of_landing.motion_mm(q, half, landing_at_zero(q, share), 0.0) +
                               half * (b.landing_mm - a.landing_mm).norm();
        return std::max(landing, of_eye.motion_mm(q, half, machine.eye.position_mm, 0.0));
    };
    return is_clear_within(step, body.chunk, fibre, motion, 0.0, {});
}

}  // namespace meshwind
