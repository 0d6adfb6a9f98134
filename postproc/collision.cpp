#include "postproc/collision.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "core/parallel.h"
#include "machines/kinematics.h"

namespace meshwind {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr std::size_t kStepChunk = 64;

// A convex piece of the envelope: a segment (two corners) or a triangle, thickened by a radius.
struct Chunk {
    std::array<Vector3d, 3> corner;
    int corners = 2;
    double radius_mm = 0.0;

    [[nodiscard]] Vector3d centre() const {
        return corners == 2 ? Vector3d(0.5 * (corner[0] + corner[1]))
                            : Vector3d((corner[0] + corner[1] + corner[2]) / 3.0);
    }
    [[nodiscard]] double reach() const {
        const Vector3d c = centre();
        double reach = 0.0;
        for (int i = 0; i < corners; ++i) {
            reach = std::max(reach, (corner[static_cast<std::size_t>(i)] - c).norm());
        }
        return reach;
    }
    // Cut across its longest side.
    [[nodiscard]] std::array<Chunk, 2> halves() const {
        std::size_t from = 0;
        double longest = -1.0;
        for (std::size_t i = 0; i < (corners == 2 ? 1U : 3U); ++i) {
            const double length = (corner[(i + 1) % 3] - corner[i]).norm();
            if (length > longest) {
                longest = length;
                from = i;
            }
        }
        const std::size_t to = (from + 1) % 3;
        const Vector3d middle = 0.5 * (corner[from] + corner[to]);
        std::array<Chunk, 2> both{*this, *this};
        both[0].corner[to] = middle;
        both[1].corner[from] = middle;
        return both;
    }
};

struct LinkedChunk {
    char link = '?';
    Chunk chunk;
};

std::vector<LinkedChunk> chunks_of(const HeadEnvelope& envelope) {
    std::vector<LinkedChunk> chunks;
    for (const HeadEnvelope::Part& part : envelope.parts) {
        if (part.triangles.faces.empty()) {
            const Capsule& c = part.capsule;
            chunks.push_back({part.link, {{c.from_mm, c.to_mm, c.to_mm}, 2, c.radius_mm}});
        }
        for (const auto& f : part.triangles.faces) {
            const auto at = [&](std::size_t i) {
                return part.triangles.points_mm[static_cast<std::size_t>(f[i])];
            };
            chunks.push_back({part.link, {{at(0), at(1), at(2)}, 3, 0.0}});
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

// The head's sweep over one step, in the mandrel frame.
class StepSweep {
public:
    StepSweep(const Machine& machine, const RayQuery& obstacles, double need_mm,
              std::span<const double> from, std::span<const double> to)
        : machine_(machine), obstacles_(obstacles), need_mm_(need_mm), from_(from), to_(to) {}

    [[nodiscard]] bool clear(const LinkedChunk& part) const {
        return clear(part.link, part.chunk, 0.0, 1.0);
    }

private:
    [[nodiscard]] Isometry3d mandrel_from_link(const Joints& q, char link) const {
        return base_from_mandrel(machine_, q).inverse() * base_from_link(machine_, q, link);
    }

    // Upper bound of how far a piece moves against the mandrel while the joints go from the middle
    // of [low, high] to an end: linear axes add up, rotary ones count with the piece's distance.
    [[nodiscard]] double motion(const Chunk& chunk, const Isometry3d& pose, double share) const {
        const Vector3d centre = pose * chunk.centre();
        const double from_spindle =
            std::hypot(centre.x(), centre.y()) + chunk.reach() + chunk.radius_mm;
        double linear_squared = 0.0;
        double turned = 0.0;
        for (std::size_t j = 0; j < from_.size(); ++j) {
            const double change = 0.5 * share * std::abs(to_[j] - from_[j]);
            const Axis& axis = machine_.axis(j);
            if (axis.type == AxisType::Linear) {
                linear_squared += change * change;
            } else if (j < machine_.mandrel_chain.size()) {
                turned += change * from_spindle;
            } else {
                const double arm = (chunk.centre() - axis.point_mm).cross(axis.direction).norm() +
                                   chunk.centre().norm();
                turned += change * (arm + chunk.reach() + chunk.radius_mm);
            }
        }
        return std::sqrt(linear_squared) + turned;
    }

    [[nodiscard]] bool clear(char link, const Chunk& chunk, double low, double high) const {
        const Joints q = between(from_, to_, 0.5 * (low + high));
        const Isometry3d pose = mandrel_from_link(q, link);
        const double move = motion(chunk, pose, high - low);
        const double reach = chunk.reach();
        const double need = chunk.radius_mm + need_mm_;
        const double search = reach + need + move;
        const Vector3d centre = pose * chunk.centre();
        if (obstacles_.distance_at_least_mm(centre) >= search) {
            return true;
        }
        const double distance = obstacles_.closest(centre, search).distance_mm;
        if (distance >= search) {
            return true;
        }
        if (distance < need || std::max(move, reach) < kSweepResolution_mm) {
            return false;
        }
        if (move > reach) {
            const double middle = 0.5 * (low + high);
            return clear(link, chunk, low, middle) && clear(link, chunk, middle, high);
        }
        const auto halves = chunk.halves();
        return clear(link, halves[0], low, high) && clear(link, halves[1], low, high);
    }

    const Machine& machine_;
    const RayQuery& obstacles_;
    double need_mm_;
    std::span<const double> from_;
    std::span<const double> to_;
};

// Least distance of a piece at one joint position, if below `best`.
double least_distance(const RayQuery& obstacles, const Isometry3d& pose, const Chunk& chunk,
                      double best) {
    const double reach = chunk.reach();
    const double search = best + reach + chunk.radius_mm;
    if (obstacles.distance_at_least_mm(pose * chunk.centre()) >= search) {
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
    for (const Chunk& half : chunk.halves()) {
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

}  // namespace

HeadEnvelope head_envelope(const Machine& machine,
                           TriangleSoup (*load_mesh)(const std::string& file)) {
    HeadEnvelope envelope;
    for (const EnvelopePart& part : machine.eye.envelope) {
        HeadEnvelope::Part piece;
        piece.link = part.link;
        if (const auto* capsule = std::get_if<Capsule>(&part.shape)) {
            piece.capsule = *capsule;
        } else {
            piece.triangles = load_mesh(std::get<EnvelopeMesh>(part.shape).file);
        }
        envelope.parts.push_back(std::move(piece));
    }
    return envelope;
}

CollisionReport check_collisions(const Machine& machine, const HeadEnvelope& envelope,
                                 const RayQuery& obstacles, const EyePath& path,
                                 const JointPath& joints, const CollisionRule& rule) {
    const std::vector<LinkedChunk> chunks = chunks_of(envelope);
    std::vector<char> fibre(path.size(), 0);
    std::vector<char> head(path.size(), 0);
    std::vector<double> clearance(path.size(), rule.told_mm);
    parallel_for(path.size(), kStepChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t before = i > 0 ? i - 1 : i;
            fibre[i] = fibre_blocked(obstacles, path[before], path[i], rule) ? 1 : 0;
            const StepSweep sweep(machine, obstacles, rule.clearance_mm, joints.row(before),
                                  joints.row(i));
            const Isometry3d mandrel = base_from_mandrel(machine, joints.row(i)).inverse();
            for (const LinkedChunk& part : chunks) {
                head[i] = static_cast<char>(head[i] != 0 || !sweep.clear(part));
                const Isometry3d pose = mandrel * base_from_link(machine, joints.row(i), part.link);
                clearance[i] = least_distance(obstacles, pose, part.chunk, clearance[i]);
            }
        }
    });
    CollisionReport report;
    report.min_clearance_mm = rule.told_mm;
    for (std::size_t i = 0; i < path.size(); ++i) {
        if (fibre[i] != 0) {
            report.fibre_hits.push_back(i);
        }
        if (head[i] != 0) {
            report.head_hits.push_back(i);
        }
        if (clearance[i] < report.min_clearance_mm) {
            report.min_clearance_mm = clearance[i];
            report.min_clearance_point = i;
        }
    }
    report.clearance_mm = std::move(clearance);
    return report;
}

}  // namespace meshwind
