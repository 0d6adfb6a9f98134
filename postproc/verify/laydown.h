/// Simulates the winding of a program: where the fibre is laid when the axes move by the blocks.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "geodesic/bridge.h"
#include "geodesic/surface_path.h"
#include "machines/machine.h"
#include "mesh/ray_query.h"
#include "mesh/surface.h"
#include "postproc/eye/eye_path.h"
#include "postproc/motion/block.h"
#include "postproc/motion/joint_path.h"
#include "winding/turn/pin.h"

namespace meshwind {

struct LaydownOptions {
    /// The eye moves no further and the rotary axes turn no further between two samples.
    double sample_mm = 10.0;
    double sample_rad = 0.1;
    std::function<void(double share)> progress{};  ///< told of the blocks now and then
};

/// Most samples of a program: 100 km of fibre at 10 mm, five times the need of a vessel of 3 m; a
/// sample takes 400 bytes.
inline constexpr double kMaxSamples = 1e7;

/// The surface on which fibre is laid: a wall with its search structures. Built once for any number
/// of programs and threads.
class LaydownSurface {
public:
    /// \param surface the wall with its extensions (mesh/mandrel/extension.h)
    /// \param bridge_reach_mm over hollows the fibre's next contact is searched this far ahead of
    /// the landing point; contact further on counts as a collision of the free fibre
    /// \param pins that stand on it
    explicit LaydownSurface(Surface surface, double bridge_reach_mm = kBridgeReach_mm,
                            std::vector<Pin> pins = {});

    [[nodiscard]] const Surface& surface() const { return surface_; }
    [[nodiscard]] double bridge_reach_mm() const { return bridge_reach_mm_; }
    [[nodiscard]] const std::vector<Pin>& pins() const { return pins_; }

    /// Whether the wall is hollow, along any direction, within reach of a face.
    [[nodiscard]] bool hollow_near(std::int32_t face) const {
        return hollow_[static_cast<std::size_t>(face)] != 0;
    }

    /// Null where the wall is hollow nowhere.
    [[nodiscard]] const LiftedWall* lifted() const { return lifted_ ? &*lifted_ : nullptr; }

    /// The nearest place of the wall.
    /// \throws InputError verify.tie_on where it is more than two edges off, and 1 mm
    [[nodiscard]] SurfacePoint nearest(const Eigen::Vector3d& place_mm) const;

private:
    Surface surface_;
    double bridge_reach_mm_;
    std::vector<Pin> pins_;
    std::vector<char> hollow_;  // per face
    RayQuery facets_;
    std::optional<LiftedWall> lifted_;
};

/// Circumstances in which a station was laid.
struct LaidAt {
    std::size_t block = 0;
    bool lifted = false;  ///< on the wall under a bridge; the fibre is in the air there
    double gap_mm = 0.0;  ///< height of the fibre over the wall, where lifted
    bool held = false;    ///< at the flank of a pin, which sets the fibre's course
};

/// The fibre that a program lays. Mandrel frame.
struct LaidPath {
    SurfacePath path;            ///< stations on the patches, s_mm from the tie-on, kg left at zero
    std::vector<LaidAt> at;      ///< per station
    EyePath samples;             ///< free fibre and eye along the motion; `point` is -1
    JointPath joints;            ///< the axes at the samples
    std::vector<double> time_s;  ///< at the samples, from the start of the program
    std::vector<std::size_t> block;  ///< of each sample
    /// Longest stretch that was laid on the wall and lifted off again: the largest fall of the
    /// laid length behind its maximum, bridges apart.
    double peeled_mm = 0.0;
    std::size_t peeled_block = 0;
    std::string failure;  ///< empty, or in words why the fibre cannot be followed on
    std::size_t failed_block = 0;
};

/// Lays the fibre that is tied on at `tie_on_mm` while the axes go from block to block, each axis
/// linearly. The fibre runs straight from its landing point P to the eye E; it does not slip. As E
/// sinks under the tangent plane at P, the landing point moves on towards E until n . (E - P) = 0;
/// as E rises over it the fibre peels off. Between samples E is a cubic through four exact
/// positions, and the place X decides how far E has come: n(X) . (E(theta) - X) = 0, so the laid
/// path is the integral curve of the directions E(theta(X)) - X, solved on the curved patches with
/// fourth order. Over a hollow the straight fibre is followed over the wall: where it meets the
/// wall again the landing point goes there and leaves a bridge behind.
/// A pin that the free fibre is swept against holds it (pin_contact.h): the fibre then leaves P for
/// the pin's flank instead of the eye, n . (E - P) becomes the same of that direction, and P moves
/// about the pin's foot as the fibre sinks to the wall there. Samples then begin on the flank, with
/// the fibre up to there counted as laid.
/// \param tie_on_mm within an edge of the wall
/// A cancellation point at each block, and a few times a second within one.
/// \throws InputError verify.tie_on where it is not; verify.too_long for more than kMaxSamples,
/// before anything is laid
/// Accuracy: tests/postproc/verify/laydown_test.cpp.
[[nodiscard]] LaidPath lay_down(const LaydownSurface& wall, const Machine& machine,
                                const BlockList& list, const Eigen::Vector3d& tie_on_mm,
                                const LaydownOptions& options = {});

}  // namespace meshwind
