/// Collision check: free fibre and machine head against the mandrel, at the blocks and between.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "machines/machine.h"
#include "mesh/ray_query.h"
#include "postproc/eye/eye_path.h"
#include "postproc/motion/joint_path.h"

namespace meshwind {

/// Envelope parts in the form that is swept: capsules, and meshes as triangles (machine frame at
/// zero).
struct HeadEnvelope {
    struct Part {
        char link = '?';
        Capsule capsule;  ///< where `triangles` is empty
        TriangleSoup triangles;
    };
    std::vector<Part> parts;
    /// Bodies that do not turn with the mandrel: on the base (link kBaseLink) and on axes of the
    /// mandrel chain before its last one. Those on the last one belong to the obstacles.
    std::vector<Part> bodies;
};

/// Link of bodies that stand on the base.
inline constexpr char kBaseLink = ' ';

/// Capsules among the obstacles are meshes that stick out by at most this.
inline constexpr double kBodyMesh_mm = 0.1;

/// \throws InputError machine.mesh_not_read for a mesh without its triangles
[[nodiscard]] HeadEnvelope head_envelope(const Machine& machine);

/// Bodies that turn with the mandrel, as obstacles in its frame: closed meshes, capsules grown by
/// at most kBodyMesh_mm.
[[nodiscard]] std::vector<TriangleSoup> bodies_on_mandrel(const Machine& machine);

/// Clearances are reported up to this.
inline constexpr double kClearanceCap_mm = 100.0;

struct CollisionRule {
    double clearance_mm = 5.0;   ///< kept between the head and anything
    FreeFibreRule free_fibre;    ///< its stand-off and start apply to the ray
    double fibre_step_mm = 2.0;  ///< the eye moves no further than this between two fibre rays
    /// Clearances of the head beyond this are not told apart; where it is `clearance_mm`, none is
    /// measured.
    double report_within_mm = kClearanceCap_mm;
    bool least_only = false;  ///< only the least clearance of all is reported: much is not measured
};

/// Collisions of a motion. A step leads from eye point i - 1 to eye point i.
struct CollisionReport {
    std::vector<std::size_t> fibre_hits;  ///< steps in which the free fibre meets the mandrel
    std::vector<std::size_t>
        head_hits;  ///< steps in which the head comes nearer than the clearance
    std::vector<std::size_t>
        body_hits;  ///< steps in which a body touches a part that turns with the mandrel
    std::vector<double>
        clearance_mm;               ///< of the head at each eye point, up to report_within_mm; with
                                    ///< least_only report_within_mm where it was not measured
    double min_clearance_mm = 0.0;  ///< least of them
    std::size_t min_clearance_point = 0;
};

/// Checks every eye point and every step with linear joint interpolation in between.
/// The head: pieces of the envelope are split, and the step halved, until a ball around each piece,
/// grown by all that it can move in its share of the step, is clear of the mandrel or a centre is
/// within the clearance: nothing slips through between points (conservative to
/// kSweepResolution_mm). The free fibre: rays from landing point to eye, so close that the eye
/// moves by at most `fibre_step_mm` between two.
/// Head and free fibre are checked against bodies of the envelope in the same way: each pair's
/// exact distance in the middle of a share of the step, less all that both can move in it, or the
/// share is halved. The head keeps the clearance; the free fibre must not touch a body, and neither
/// must parts that turn with the mandrel.
[[nodiscard]] CollisionReport check_collisions(const Machine& machine, const HeadEnvelope& envelope,
                                               const RayQuery& obstacles, const EyePath& path,
                                               const JointPath& joints, const CollisionRule& rule);

/// Whether in one step of a motion without fibre the head comes within the clearance of anything,
/// the eye meets it, or a body touches a part that turns with the mandrel; swept in the same way.
/// \pre step has two points
[[nodiscard]] bool head_strikes(const Machine& machine, const HeadEnvelope& envelope,
                                const RayQuery& obstacles, const JointPath& step,
                                double clearance_mm);

/// Pieces and steps smaller than this are not split further and count as a hit.
inline constexpr double kSweepResolution_mm = 0.03;

}  // namespace meshwind
