#include "postproc/collision/collision.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <utility>
#include <variant>

#include <Eigen/Geometry>

#include "core/error.h"
#include "core/interrupt.h"
#include "core/parallel.h"
#include "machines/kinematics.h"
#include "postproc/collision/chunk.h"

namespace meshwind {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr std::size_t kStepChunk = 64;

// What a sweep may take for a hit that is none.
constexpr double kSweepSlack_mm = 2.0 * kSweepResolution_mm;

// Pieces and steps larger than this are divided without a search where the table, which is good to
// some mm, says that it would not settle them.
constexpr double kLeastUndecided_mm = 1.0;
constexpr double kGuess_mm = 2.0;

struct LinkedChunk {
    char link = '?';
    Chunk chunk;
};

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

using Joints = std::vector<double>;

Joints between(std::span<const double> a, std::span<const double> b, double share) {
    Joints q(a.size());
    for (std::size_t i = 0; i < q.size(); ++i) {
        q[i] = a[i] + share * (b[i] - a[i]);
    }
    return q;
}

// Pose of a link of either chain, or of the base.
Isometry3d base_from_part(const Machine& machine, std::span<const double> q, char link) {
    return link == kBaseLink ? Isometry3d::Identity() : base_from_link(machine, q, link);
}

// The axes between a part's link and the frame in which it is swept, in the order in which they
// carry a point of the part there, and how far they move it.
class Way {
public:
    // To the frame of the link `to`, or of the mandrel.
    Way(const Machine& machine, char link, std::optional<char> to) : machine_(machine) {
        const std::size_t eye = machine.mandrel_chain.size();
        const std::size_t carrier = joints_of(machine, link);
        for (std::size_t j = carrier; j > eye; --j) {
            steps_.push_back({j - 1, 1.0});
        }
        const std::size_t on_mandrel = carrier > eye ? 0 : carrier;
        const std::size_t goal = to ? joints_of(machine, *to) : eye;
        for (std::size_t j = on_mandrel; j > goal; --j) {
            steps_.push_back({j - 1, 1.0});
        }
        for (std::size_t j = on_mandrel; j < goal; ++j) {
            steps_.push_back({j, -1.0});
        }
    }

    // Upper bound of how far a ball around `point_mm` (machine frame at zero) moves while the
    // joints go from `q` by half_share of the step: isometries do not change distances, so each
    // axis counts with the ball's distance from it as those before have placed the ball. Linear
    // axes in a row add up as vectors.
    [[nodiscard]] double motion_mm(const Joints& q, std::span<const double> from,
                                   std::span<const double> to, double half_share,
                                   const Vector3d& point_mm, double ball_mm) const {
        return motion_mm(q, turns_of(q), from, to, half_share, point_mm, ball_mm);
    }

    // Sine and versine of a rotary axis.
    struct Turn {
        double sine = 0.0;
        double versine = 0.0;
    };

    // Per axis on the way.
    [[nodiscard]] std::vector<Turn> turns_of(const Joints& q) const {
        std::vector<Turn> turns(steps_.size());
        for (std::size_t i = 0; i < turns.size(); ++i) {
            const auto& [joint, sign] = steps_[i];
            if (machine_.axis(joint).type == AxisType::Rotary) {
                turns[i] = {std::sin(sign * q[joint]), 1.0 - std::cos(sign * q[joint])};
            }
        }
        return turns;
    }

    // The same where the turns at `q` are known.
    [[nodiscard]] double motion_mm(const Joints& q, std::span<const Turn> turns,
                                   std::span<const double> from, std::span<const double> to,
                                   double half_share, Vector3d point_mm, double ball_mm) const {
        double moved = 0.0;
        Vector3d slide = Vector3d::Zero();
        for (std::size_t i = 0; i < steps_.size(); ++i) {
            const auto& [joint, sign] = steps_[i];
            const Axis& axis = machine_.axis(joint);
            const double change = half_share * (to[joint] - from[joint]);
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
    struct Step {
        std::size_t joint;
        double sign;
    };

    // One more than the joint that carries the link; 0 for the base.
    static std::size_t joints_of(const Machine& machine, char link) {
        return link == kBaseLink ? 0 : *machine.joint_of(link) + 1;
    }

    const Machine& machine_;
    std::vector<Step> steps_;
};

// The sweep of a piece over one step, in the mandrel frame.
class StepSweep {
public:
    StepSweep(const Machine& machine, const RayQuery& obstacles, double need_mm,
              std::span<const double> from, std::span<const double> to)
        : machine_(machine), obstacles_(obstacles), need_mm_(need_mm), from_(from), to_(to) {}

    [[nodiscard]] bool clear(const LinkedChunk& part) const {
        const Way way(machine_, part.link, std::nullopt);
        return clear_within(part, way, part.chunk, 0.0, 1.0);
    }

    // How far a piece moves at most.
    [[nodiscard]] double motion_mm(const LinkedChunk& part) const {
        const Way way(machine_, part.link, std::nullopt);
        return way.motion_mm(Joints(to_.begin(), to_.end()), from_, to_, 1.0, part.chunk.centre(),
                             part.chunk.reach_mm() + part.chunk.radius_mm);
    }

    // The same for a piece that is known to be so far off at the step's end and to move so little,
    // up to the resolution: mostly without a search.
    [[nodiscard]] bool clear(const LinkedChunk& part, double end_clearance_mm,
                             double motion_mm) const {
        return motion_mm < end_clearance_mm - need_mm_ - kSweepSlack_mm || clear(part);
    }

private:
    // The middle of a share of the step.
    struct Middle {
        double low;
        double high;
        Joints q;
        std::vector<Way::Turn> turns;
        Isometry3d pose;
    };

    [[nodiscard]] bool clear_within(const LinkedChunk& part, const Way& way, const Chunk& chunk,
                                    double low, double high) const {
        Middle at{low, high, between(from_, to_, 0.5 * (low + high)), {}, {}};
        at.turns = way.turns_of(at.q);
        at.pose =
            base_from_mandrel(machine_, at.q).inverse() * base_from_part(machine_, at.q, part.link);
        return clear_at(part, way, chunk, at);
    }

    [[nodiscard]] bool clear_at(const LinkedChunk& part, const Way& way, const Chunk& chunk,
                                const Middle& at) const {
        const double reach = chunk.reach_mm();
        const double move = way.motion_mm(at.q, at.turns, from_, to_, 0.5 * (at.high - at.low),
                                          chunk.centre(), reach + chunk.radius_mm);
        const double need = chunk.radius_mm + need_mm_;
        const double search = reach + need + move;
        const Vector3d centre = at.pose * chunk.centre();
        if (obstacles_.is_beyond(centre, search)) {
            return true;
        }
        if (!is_undecided(centre, need, search, std::max(move, reach))) {
            const double distance = obstacles_.closest(centre, search).distance_mm;
            if (distance >= search) {
                return true;
            }
            if (distance < need || std::max(move, reach) < kSweepResolution_mm) {
                return false;
            }
        }
        if (move > reach) {
            const double middle = 0.5 * (at.low + at.high);
            return clear_within(part, way, chunk, at.low, middle) &&
                   clear_within(part, way, chunk, middle, at.high);
        }
        const auto halves = chunk.halves();
        return clear_at(part, way, halves[0], at) && clear_at(part, way, halves[1], at);
    }

    // True where a search would hardly settle a large piece: by what is tabulated the distance is
    // between what is needed and what would do. Its parts are looked at at once, which finds the
    // same.
    [[nodiscard]] bool is_undecided(const Vector3d& centre, double need, double search,
                                    double size) const {
        if (size < kLeastUndecided_mm || !obstacles_.has_table()) {
            return false;
        }
        const double guess = obstacles_.distance_estimate_mm(centre);
        return guess > need && guess + kGuess_mm < search;
    }

    const Machine& machine_;
    const RayQuery& obstacles_;
    double need_mm_;
    std::span<const double> from_;
    std::span<const double> to_;
};

// Head and free fibre against one body over one step, in the frame of the body's link.
class BodySweep {
public:
    BodySweep(const Machine& machine, const LinkedChunk& body, std::span<const double> from,
              std::span<const double> to)
        : machine_(machine), body_(body), from_(from), to_(to) {}

    [[nodiscard]] bool clear(const LinkedChunk& part, double need_mm) const {
        const Way way(machine_, part.link, body_.link);
        return clear([&](const Joints& q,
                         double /*share*/) { return part.chunk.moved(body_from(q, part.link)); },
                     [&](const Joints& q, double /*share*/, double half) {
                         return way.motion_mm(q, from_, to_, half, part.chunk.centre(),
                                              part.chunk.reach_mm() + part.chunk.radius_mm);
                     },
                     need_mm, 0.0, 1.0);
    }

    // The straight fibre from the landing point, which the mandrel carries, to the eye.
    [[nodiscard]] bool clear_of_fibre(const EyePoint& a, const EyePoint& b) const {
        const char last = machine_.mandrel_chain.back().letter;
        const Way of_landing(machine_, last, body_.link);
        const char eye_link =
            machine_.eye_chain.empty() ? kBaseLink : machine_.eye_chain.back().letter;
        const Way of_eye(machine_, eye_link, body_.link);
        const auto landing_at_zero = [&](const Joints& q, double share) {
            const Vector3d landing = a.landing_mm + share * (b.landing_mm - a.landing_mm);
            return base_from_part(machine_, q, last).inverse() *
                   (base_from_mandrel(machine_, q) * landing);
        };
        const auto fibre = [&](const Joints& q, double share) {
            Chunk chunk;
            chunk.corner[0] = body_from(q, last) * landing_at_zero(q, share);
            chunk.corner[1] = body_from(q, eye_link) * machine_.eye.position_mm;
            chunk.corner[2] = chunk.corner[1];
            return chunk;
        };
        const auto motion = [&](const Joints& q, double share, double half) {
            const double landing =
                of_landing.motion_mm(q, from_, to_, half, landing_at_zero(q, share), 0.0) +
                half * (b.landing_mm - a.landing_mm).norm();
            return std::max(landing,
                            of_eye.motion_mm(q, from_, to_, half, machine_.eye.position_mm, 0.0));
        };
        return clear(fibre, motion, 0.0, 0.0, 1.0);
    }

private:
    [[nodiscard]] Isometry3d body_from(const Joints& q, char link) const {
        return base_from_part(machine_, q, body_.link).inverse() *
               base_from_part(machine_, q, link);
    }

    // `piece` at a joint position, in the body's frame; `motion` bounds how far any of its points
    // gets from there within half a share of the step.
    template <typename Piece, typename Motion>
    [[nodiscard]] bool clear(const Piece& piece, const Motion& motion, double need_mm, double low,
                             double high) const {
        const double middle = 0.5 * (low + high);
        const Joints q = between(from_, to_, middle);
        const Chunk at = piece(q, middle);
        const double move = motion(q, middle, 0.5 * (high - low));
        const double search = need_mm + move;
        const double balls = (at.centre() - body_.chunk.centre()).norm() - at.reach_mm() -
                             body_.chunk.reach_mm() - at.radius_mm - body_.chunk.radius_mm;
        if (balls >= search) {
            return true;
        }
        const double distance = chunk_distance_mm(at, body_.chunk);
        if (distance >= search) {
            return true;
        }
        if (distance < need_mm || move < kSweepResolution_mm) {
            return false;
        }
        return clear(piece, motion, need_mm, low, middle) &&
               clear(piece, motion, need_mm, middle, high);
    }

    const Machine& machine_;
    const LinkedChunk& body_;
    std::span<const double> from_;
    std::span<const double> to_;
};

// Least distance of a piece at one joint position, if below `best`.
double least_distance(const RayQuery& obstacles, const Isometry3d& pose, const Chunk& chunk,
                      double best) {
    const double reach = chunk.reach_mm();
    const double search = best + reach + chunk.radius_mm;
    if (obstacles.is_beyond(pose * chunk.centre(), search)) {
        return best;
    }
    const double distance = obstacles.closest(pose * chunk.centre(), search).distance_mm;
    if (distance >= search) {
        return best;
    }
    best = std::min(best, distance - chunk.radius_mm);
    if (reach < kSweepResolution_mm) {
        return best;
    }
    // The nearer half first: it may rule the other one out.
    auto halves = chunk.halves();
    if (obstacles.distance_at_least_mm(pose * halves[1].centre()) <
        obstacles.distance_at_least_mm(pose * halves[0].centre())) {
        std::swap(halves[0], halves[1]);
    }
    for (const Chunk& half : halves) {
        best = least_distance(obstacles, pose, half, best);
    }
    return best;
}

bool fibre_blocked(const RayQuery& obstacles, const EyePoint& a, const EyePoint& b,
                   const CollisionRule& rule) {
    const int rays =
        1 + static_cast<int>((b.eye_mm - a.eye_mm).norm() / std::max(rule.fibre_step_mm, 1e-3));
    for (int k = 1; k <= rays; ++k) {
        const double share = static_cast<double>(k) / rays;
        const Vector3d landing = a.landing_mm + share * (b.landing_mm - a.landing_mm);
        const Vector3d eye = a.eye_mm + share * (b.eye_mm - a.eye_mm);
        const Vector3d tangent = (eye - landing).normalized();
        const Vector3d binormal = (a.binormal + share * (b.binormal - a.binormal)).normalized();
        const Vector3d normal = tangent.cross(binormal);
        const Vector3d start =
            landing + rule.free_fibre.stand_off_mm * normal + rule.free_fibre.start_mm * tangent;
        if (obstacles.occluded(start, eye)) {
            return true;
        }
    }
    return false;
}

HeadEnvelope::Part part_of(char link, const std::variant<Capsule, EnvelopeMesh>& shape) {
    HeadEnvelope::Part part;
    part.link = link;
    if (const auto* capsule = std::get_if<Capsule>(&shape)) {
        part.capsule = *capsule;
    } else {
        const EnvelopeMesh& mesh = std::get<EnvelopeMesh>(shape);
        if (mesh.triangles.faces.empty()) {
            throw InputError("machine.mesh_not_read", mesh.file,
                             "its triangles are not in the machine; read the machine by "
                             "load_machine()");
        }
        part.triangles = mesh.triangles;
    }
    return part;
}

bool turns_with_mandrel(const Machine& machine, const MachineBody& body) {
    return body.link && *body.link == machine.mandrel_chain.back().letter;
}

// What one step and its end point touch.
struct StepFinding {
    bool fibre = false;
    bool head = false;
    bool body = false;
    double clearance_mm = 0.0;
};

class StepCheck {
public:
    StepCheck(const Machine& machine, const HeadEnvelope& envelope, const RayQuery& obstacles,
              const CollisionRule& rule)
        : machine_(machine),
          obstacles_(obstacles),
          rule_(rule),
          parts_(chunks_of(envelope.parts)),
          bodies_(chunks_of(envelope.bodies)) {}

    // `least_mm`: what is known to be the least clearance so far.
    [[nodiscard]] StepFinding find(const EyePath& path, const JointPath& joints, std::size_t i,
                                   double least_mm) const {
        const std::size_t before = i > 0 ? i - 1 : i;
        const std::span<const double> from = joints.row(before);
        const std::span<const double> to = joints.row(i);
        StepFinding found;
        found.clearance_mm = rule_.told_mm;
        found.fibre = fibre_blocked(obstacles_, path[before], path[i], rule_);
        const StepSweep sweep(machine_, obstacles_, rule_.clearance_mm, from, to);
        const Isometry3d mandrel = base_from_mandrel(machine_, to).inverse();
        for (const LinkedChunk& part : parts_) {
            if (rule_.told_mm > rule_.clearance_mm) {
                const Isometry3d pose = mandrel * base_from_link(machine_, to, part.link);
                const double move = sweep.motion_mm(part);
                double told = found.clearance_mm;
                if (rule_.least_only) {  // what may be the least, or tells that the step is clear
                    const double enough = rule_.clearance_mm + move + 2.0 * kSweepSlack_mm;
                    told = std::min(told, std::max(least_mm + kSweepSlack_mm, enough));
                }
                const double at_end = least_distance(obstacles_, pose, part.chunk, told);
                found.clearance_mm = at_end < told ? at_end : found.clearance_mm;
                found.head = found.head || !sweep.clear(part, at_end, move);
            } else {
                found.head = found.head || !sweep.clear(part);
            }
        }
        for (const LinkedChunk& body : bodies_) {
            look_at(body, path[before], path[i], from, to, found);
        }
        return found;
    }

private:
    void look_at(const LinkedChunk& body, const EyePoint& a, const EyePoint& b,
                 std::span<const double> from, std::span<const double> to,
                 StepFinding& found) const {
        const BodySweep sweep(machine_, body, from, to);
        found.fibre = found.fibre || !sweep.clear_of_fibre(a, b);
        found.body = found.body || !StepSweep(machine_, obstacles_, 0.0, from, to).clear(body);
        const Isometry3d body_from_base = base_from_part(machine_, to, body.link).inverse();
        for (const LinkedChunk& part : parts_) {
            found.head = found.head || !sweep.clear(part, rule_.clearance_mm);
            const Chunk at =
                part.chunk.moved(body_from_base * base_from_link(machine_, to, part.link));
            found.clearance_mm = std::min(found.clearance_mm, chunk_distance_mm(at, body.chunk));
        }
    }

    const Machine& machine_;
    const RayQuery& obstacles_;
    const CollisionRule& rule_;
    std::vector<LinkedChunk> parts_;
    std::vector<LinkedChunk> bodies_;
};

}  // namespace

HeadEnvelope head_envelope(const Machine& machine) {
    HeadEnvelope envelope;
    for (const EnvelopePart& part : machine.eye.envelope) {
        envelope.parts.push_back(part_of(part.link, part.shape));
    }
    for (const MachineBody& body : machine.bodies) {
        if (!turns_with_mandrel(machine, body)) {
            envelope.bodies.push_back(part_of(body.link.value_or(kBaseLink), body.shape));
        }
    }
    return envelope;
}

std::vector<TriangleSoup> bodies_on_mandrel(const Machine& machine) {
    const std::vector<double> zero(machine.axis_count(), 0.0);
    const Isometry3d mandrel = base_from_mandrel(machine, zero).inverse();
    std::vector<TriangleSoup> soups;
    for (const MachineBody& body : machine.bodies) {
        if (!turns_with_mandrel(machine, body)) {
            continue;
        }
        HeadEnvelope::Part part = part_of(*body.link, body.shape);
        if (part.triangles.faces.empty()) {
            part.triangles = capsule_mesh(part.capsule, kBodyMesh_mm);
        }
        for (Vector3d& point : part.triangles.points_mm) {
            point = mandrel * point;
        }
        soups.push_back(std::move(part.triangles));
    }
    return soups;
}

CollisionReport check_collisions(const Machine& machine, const HeadEnvelope& envelope,
                                 const RayQuery& obstacles, const EyePath& path,
                                 const JointPath& joints, const CollisionRule& rule) {
    const StepCheck check(machine, envelope, obstacles, rule);
    std::vector<StepFinding> found(path.size());
    std::atomic<double> least_mm = rule.told_mm;
    parallel_for(path.size(), kStepChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            double least = least_mm;
            found[i] = check.find(path, joints, i, least);
            while (found[i].clearance_mm < least &&
                   !least_mm.compare_exchange_weak(least, found[i].clearance_mm)) {
            }
        }
    });
    CollisionReport report;
    report.min_clearance_mm = rule.told_mm;
    for (std::size_t i = 0; i < path.size(); ++i) {
        if (found[i].fibre) {
            report.fibre_hits.push_back(i);
        }
        if (found[i].head) {
            report.head_hits.push_back(i);
        }
        if (found[i].body) {
            report.body_hits.push_back(i);
        }
        report.clearance_mm.push_back(found[i].clearance_mm);
        if (found[i].clearance_mm < report.min_clearance_mm) {
            report.min_clearance_mm = found[i].clearance_mm;
            report.min_clearance_point = i;
        }
    }
    return report;
}

bool head_strikes(const Machine& machine, const HeadEnvelope& envelope, const RayQuery& obstacles,
                  const JointPath& step, double clearance_mm) {
    const std::span<const double> from = step.row(0);
    const std::span<const double> to = step.row(1);
    const Capsule eye{machine.eye.position_mm, machine.eye.position_mm, 0.0};
    const char eye_link = machine.eye_chain.empty() ? kBaseLink : machine.eye_chain.back().letter;
    const std::vector<LinkedChunk> parts = chunks_of(envelope.parts);
    const auto strikes = [&](double need_mm, const LinkedChunk& part) {
        return !StepSweep(machine, obstacles, need_mm, from, to).clear(part);
    };
    bool any = strikes(0.0, {eye_link, chunk_of(eye)});
    for (const LinkedChunk& part : parts) {
        check_interrupt();
        any = any || strikes(clearance_mm, part);
    }
    for (const LinkedChunk& body : chunks_of(envelope.bodies)) {
        check_interrupt();
        any = any || strikes(0.0, body);
        const BodySweep sweep(machine, body, from, to);
        for (const LinkedChunk& part : parts) {
            any = any || !sweep.clear(part, clearance_mm);
        }
    }
    return any;
}

}  // namespace meshwind
