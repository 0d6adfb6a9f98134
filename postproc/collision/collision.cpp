#include "postproc/collision/collision.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>
#include <variant>

#include <Eigen/Geometry>

#include "core/error.h"
#include "core/interrupt.h"
#include "core/parallel.h"
#include "machines/kinematics.h"
#include "postproc/collision/chunk.h"
#include "postproc/collision/sweep.h"

namespace meshwind {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr std::size_t kStepChunk = 64;

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

// A machine beside a mandrel, with what is swept of it.
struct CollisionTask {
    const Machine& machine;
    const RayQuery& obstacles;
    const CollisionRule& rule;
    std::vector<LinkedChunk> parts;   // of the head
    std::vector<LinkedChunk> bodies;  // that do not turn with the mandrel
};

// Head, end point of the step included, against the mandrel.
// \param least_mm what is known to be the least clearance so far
void sweep_head(const CollisionTask& task, const MachineStep& step, double least_mm,
                StepFinding& found) {
    const CollisionRule& rule = task.rule;
    const SweptObstacles mandrel{task.obstacles, rule.clearance_mm};
    const Isometry3d mandrel_from_base = base_from_mandrel(step.machine, step.to).inverse();
    for (const LinkedChunk& part : task.parts) {
        if (!(rule.report_within_mm > rule.clearance_mm)) {
            found.head = found.head || !is_clear(step, mandrel, part);
            continue;
        }
        const Isometry3d pose =
            mandrel_from_base * base_from_link(step.machine, step.to, part.link);
        const double move = most_motion_mm(step, part);
        double told = found.clearance_mm;
        if (rule.least_only) {  // what may be the least, or tells that the step is clear
            const double enough = rule.clearance_mm + move + 2.0 * kSweepSlack_mm;
            told = std::min(told, std::max(least_mm + kSweepSlack_mm, enough));
        }
        const double at_end = least_distance(task.obstacles, pose, part.chunk, told);
        found.clearance_mm = at_end < told ? at_end : found.clearance_mm;
        // Mostly clear without a search: so far off at the step's end, it moves so little.
        const bool far_off = move < at_end - rule.clearance_mm - kSweepSlack_mm;
        found.head = found.head || !(far_off || is_clear(step, mandrel, part));
    }
}

// A body against fibre, mandrel and head.
void sweep_body(const CollisionTask& task, const LinkedChunk& body, const MachineStep& step,
                StepFinding& found) {
    const Isometry3d body_from_base = base_from_part(step.machine, step.to, body.link).inverse();
    for (const LinkedChunk& part : task.parts) {
        found.head = found.head || !is_clear_of_body(step, body, part, task.rule.clearance_mm);
        const Chunk at =
            part.chunk.moved(body_from_base * base_from_link(step.machine, step.to, part.link));
        found.clearance_mm = std::min(found.clearance_mm, chunk_distance_mm(at, body.chunk));
    }
}

// The step that ends at eye point i. \param least_mm what is known to be the least clearance so far
StepFinding find_in_step(const CollisionTask& task, const EyePath& path, const JointPath& joints,
                         std::size_t i, double least_mm) {
    const std::size_t before = i > 0 ? i - 1 : i;
    const MachineStep step{task.machine, joints.row(before), joints.row(i)};
    StepFinding found;
    found.clearance_mm = task.rule.report_within_mm;
    found.fibre = fibre_blocked(task.obstacles, path[before], path[i], task.rule);
    sweep_head(task, step, least_mm, found);
    for (const LinkedChunk& body : task.bodies) {
        found.fibre = found.fibre || !is_fibre_clear_of_body(step, body, path[before], path[i]);
        found.body = found.body || !is_clear(step, {task.obstacles, 0.0}, body);
        sweep_body(task, body, step, found);
    }
    return found;
}

CollisionReport collision_report(const std::vector<StepFinding>& found, double report_within_mm) {
    CollisionReport report;
    report.min_clearance_mm = report_within_mm;
    for (std::size_t i = 0; i < found.size(); ++i) {
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
    const CollisionTask task{machine, obstacles, rule, chunks_of(envelope.parts),
                             chunks_of(envelope.bodies)};
    std::vector<StepFinding> found(path.size());
    std::atomic<double> least_mm = rule.report_within_mm;
    parallel_for(path.size(), kStepChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            double least = least_mm;
            found[i] = find_in_step(task, path, joints, i, least);
            while (found[i].clearance_mm < least &&
                   !least_mm.compare_exchange_weak(least, found[i].clearance_mm)) {
            }
        }
    });
    return collision_report(found, rule.report_within_mm);
}

bool head_strikes(const Machine& machine, const HeadEnvelope& envelope, const RayQuery& obstacles,
                  const JointPath& step, double clearance_mm) {
    const MachineStep machine_step{machine, step.row(0), step.row(1)};
    const Capsule eye{machine.eye.position_mm, machine.eye.position_mm, 0.0};
    const char eye_link = machine.eye_chain.empty() ? kBaseLink : machine.eye_chain.back().letter;
    const std::vector<LinkedChunk> parts = chunks_of(envelope.parts);
    const auto strikes = [&](double need_mm, const LinkedChunk& part) {
        return !is_clear(machine_step, {obstacles, need_mm}, part);
    };
    bool any = strikes(0.0, {eye_link, chunk_of(eye)});
    for (const LinkedChunk& part : parts) {
        check_interrupt();
        any = any || strikes(clearance_mm, part);
    }
    for (const LinkedChunk& body : chunks_of(envelope.bodies)) {
        check_interrupt();
        any = any || strikes(0.0, body);
        for (const LinkedChunk& part : parts) {
            any = any || !is_clear_of_body(machine_step, body, part, clearance_mm);
        }
    }
    return any;
}

}  // namespace meshwind
