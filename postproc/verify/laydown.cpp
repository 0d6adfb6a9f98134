#include "postproc/verify/laydown.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include <Eigen/Geometry>
#include <boost/math/tools/toms748_solve.hpp>

#include "core/error.h"
#include "core/index.h"
#include "core/interrupt.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "geodesic/bridge.h"
#include "geodesic/field_walk.h"
#include "machines/kinematics.h"
#include "mesh/nearest.h"
#include "postproc/verify/pin_contact.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// The eye over the tangent plane by no more than this does not lift the fibre: rounding of
// positions of some metres.
constexpr double kLift_mm = 1e-6;

// Steps of the laid path are no longer than this share of the free length: the direction to the eye
// changes on that scale.
constexpr double kStepShare = 0.05;

// Curvature of the wall (radius 10 m) below which it counts as hollow; along 40 mm such a hollow is
// 0.02 mm deep.
constexpr double kHollow_per_mm = 1e-4;

// Shallower creases count as flat, as those of rims do (hollow_rim.h).
constexpr double kLeastValley_rad = 1e-3;

// Looking ahead over a hollow goes no further than this share of the free length.
constexpr double kAheadShare = 0.9;
// Bridges within one sample; more means a wall of spikes.
constexpr int kMaxBridges = 50;

// Fibre about a pin is recorded so often.
constexpr double kPinStation_mm = 0.25;

// Where along its curve the eye is in line with a place about a pin: to the last digits.
constexpr int kPinRootBits = 50;
constexpr std::uintmax_t kPinRootSteps = 60;

// A free fibre shorter than this has no direction.
constexpr double kLeastFree_mm = 1e-3;

// Stations closer than this to the one before are not recorded.
constexpr double kStation_mm = 1e-6;
constexpr double kSameNormal = 1.0 - 1e-9;

// Progress is told after so many blocks; whether an end is asked for is looked at after so many
// samples of one: milliseconds.
constexpr std::size_t kBlocksPerReport = 256;
constexpr int kSamplesPerLook = 256;

// The eye between two samples: the cubic through four exact positions.
class EyeCurve {
public:
    explicit EyeCurve(const std::array<Vector3d, 4>& e)
        : start_(e[0]),
          end_(e[3]),
          linear_(0.5 * (-11.0 * e[0] + 18.0 * e[1] - 9.0 * e[2] + 2.0 * e[3])),
          square_(4.5 * (2.0 * e[0] - 5.0 * e[1] + 4.0 * e[2] - e[3])),
          cube_(4.5 * (-e[0] + 3.0 * e[1] - 3.0 * e[2] + e[3])) {}

    [[nodiscard]] const Vector3d& end() const { return end_; }
    [[nodiscard]] Vector3d position(double share) const {
        return start_ + share * (linear_ + share * (square_ + share * cube_));
    }

    // Where the eye is in the tangent plane of a place that it ends under.
    [[nodiscard]] Vector3d in_plane(const Vector3d& place, const Vector3d& normal) const {
        const double c0 = normal.dot(start_ - place);
        const double c1 = normal.dot(linear_);
        const double c2 = normal.dot(square_);
        const double c3 = normal.dot(cube_);
        const double last = c0 + c1 + c2 + c3;
        if (c0 <= 0.0 || last >= 0.0) {
            return c0 <= 0.0 ? start_ : end_;
        }
        double low = 0.0;
        double high = 1.0;
        double share = c0 / (c0 - last);
        for (int i = 0; i < kRootSteps; ++i) {
            const double value = c0 + share * (c1 + share * (c2 + share * c3));
            (value > 0.0 ? low : high) = share;
            const double slope = c1 + share * (2.0 * c2 + share * 3.0 * c3);
            const double next = share - value / slope;
            const double kept = next > low && next < high ? next : 0.5 * (low + high);
            if (std::abs(kept - share) < kRootShare) {
                break;
            }
            share = kept;
        }
        return position(share);
    }

private:
    static constexpr int kRootSteps = 60;  // as many halvings reach the last digit
    static constexpr double kRootShare = 1e-13;

    Vector3d start_, end_, linear_, square_, cube_;
};

// Whether the wall bends up at an edge: seen across it, the normal beyond leans back.
bool is_valley(const Surface& surface, std::size_t face, std::size_t edge) {
    const std::int32_t other = surface.neighbour[face][edge];
    if (other == kNoFace) {
        return false;
    }
    const std::int32_t start = surface.face[face][edge];
    const Vector3d along = surface.position_mm[at(surface.face[face][(edge + 1) % 3])] -
                           surface.position_mm[at(start)];
    const auto& there = surface.face[at(other)];
    const auto corner =
        static_cast<std::size_t>(std::find(there.begin(), there.end(), start) - there.begin());
    const Vector3d& here = surface.normal[at(surface.corner[face][edge])];
    const Vector3d& beyond = surface.normal[at(surface.corner[at(other)][corner])];
    return beyond.dot(along.cross(here).normalized()) < -kLeastValley_rad;
}

// Per face: whether a hollow of the wall, along any direction, is within reach.
std::vector<char> hollow_faces(const Surface& surface, double reach_mm) {
    std::vector<Vector3d> hollow;
    const auto centre = [&](const std::array<std::int32_t, 3>& v) {
        return Vector3d((surface.position_mm[at(v[0])] + surface.position_mm[at(v[1])] +
                         surface.position_mm[at(v[2])]) /
                        3.0);
    };
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        bool found = false;
        for (std::size_t i = 0; i < 3 && !found; ++i) {
            const Eigen::Matrix3d& s = surface.shape_operator_per_mm[at(surface.corner[f][i])];
            // Of the two principal curvatures the smaller: mean and Gaussian curvature give it.
            const double mean = 0.5 * s.trace();
            const double square = 0.5 * (s * s).trace();
            const double least = mean - std::sqrt(std::max(0.0, square - mean * mean));
            const bool valley = surface.feature[f][i] != 0 && is_valley(surface, f, i);
            found = least < -kHollow_per_mm || valley;
        }
        if (found) {
            hollow.push_back(centre(surface.face[f]));
        }
    }
    std::vector<char> near(surface.face.size(), 0);
    if (hollow.empty()) {
        return near;
    }
    const NearestPoints points(hollow);
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        const Vector3d c = centre(surface.face[f]);
        const auto nearest = at(points.nearest(c));
        near[f] = (hollow[nearest] - c).norm() < reach_mm ? 1 : 0;
    }
    return near;
}

RayQuery facets_of(const Surface& surface) {
    const std::array<TriangleSoup, 1> soup{{{surface.position_mm, surface.face}}};
    return RayQuery(soup);
}

class Layer {
public:
    Layer(const LaydownWall& wall, const Machine& machine, const BlockList& list,
          const Vector3d& tie_on_mm, const LaydownOptions& options)
        : wall_(wall),
          machine_(machine),
          list_(list),
          options_(options),
          walker_(wall.surface(), wall.nearest(tie_on_mm)),
          pins_(wall.pins()) {
        walker_.move_under(tie_on_mm);  // the patch's point instead of the facet's
    }

    LaidPath lay() {
        check_extent();
        laid_.joints.axis_count = list_.axes.size();
        std::vector<double> from = joints_at(list_, 0);
        eye_mm_ = eye_at(from);
        record(walker_.station(eye_mm_ - walker_.position_mm()), 0.0, false);
        record_sample(from);
        for (block_ = 1; block_ < list_.blocks.size(); ++block_) {
            check_interrupt();
            if (options_.progress && block_ % kBlocksPerReport == 0) {
                options_.progress(static_cast<double>(block_) /
                                  static_cast<double>(list_.blocks.size()));
            }
            const std::vector<double> to = joints_at(list_, block_);
            if (!move(from, to)) {
                laid_.failed_block = block_;
                break;
            }
            from = to;
        }
        return std::move(laid_);
    }

private:
    [[nodiscard]] Vector3d eye_at(const std::vector<double>& joints) const {
        return mandrel_from_eye(machine_, joints).translation();
    }

    // Whole programs that cannot be held are refused before they are begun.
    void check_extent() const {
        double samples = 0.0;
        std::vector<double> from = joints_at(list_, 0);
        for (std::size_t block = 1; block < list_.blocks.size(); ++block) {
            const std::vector<double> to = joints_at(list_, block);
            samples += samples_of(from, to, eye_at(from));
            if (samples > kMostSamples) {
                throw InputError(
                    "verify.too_long", "",
                    "up to " + block_words(list_, block) +
                        " the axes go further than can be wound again, " +
                        fixed(kMostSamples * options_.sample_mm / 1e6, 0) +
                        " km of the eye's way or " +
                        fixed(kMostSamples * options_.sample_rad / (2.0 * kPi), 0) +
                        " turns; split the program, or mend a block that goes too far");
            }
            from = to;
        }
    }

    [[nodiscard]] double samples_of(const std::vector<double>& from, const std::vector<double>& to,
                                    const Vector3d& eye_mm) const {
        double turned = 0.0;
        double linear_squared = 0.0;
        double spindle = 0.0;
        for (std::size_t j = 0; j < from.size(); ++j) {
            const double change = std::abs(to[j] - from[j]);
            if (machine_.axis(j).type == AxisType::Linear) {
                linear_squared += change * change;
            } else {
                turned += change;
                spindle += j < machine_.mandrel_chain.size() ? change : 0.0;
            }
        }
        const double way = std::sqrt(linear_squared) + spindle * eye_mm.head<2>().norm();
        return 1.0 + std::floor(std::max(way / options_.sample_mm, turned / options_.sample_rad));
    }

    // One block; false where the fibre cannot be followed.
    bool move(const std::vector<double>& from, const std::vector<double>& to) {
        const auto samples = static_cast<int>(samples_of(from, to, eye_mm_));
        std::vector<double> joints(from.size());
        const auto joints_of = [&](double share) {
            for (std::size_t j = 0; j < joints.size(); ++j) {
                joints[j] = from[j] + share * (to[j] - from[j]);
            }
            return joints;
        };
        for (int k = 0; k < samples; ++k) {
            if (k % kSamplesPerLook == kSamplesPerLook - 1) {
                check_interrupt();
            }
            std::array<Vector3d, 4> nodes{eye_mm_};
            for (std::size_t i = 1; i < 4; ++i) {
                nodes[i] = eye_at(joints_of((k + static_cast<double>(i) / 3.0) / samples));
            }
            eye_mm_ = nodes[3];
            if (!follow(EyeCurve(nodes))) {
                return false;
            }
            const double share = static_cast<double>(k + 1) / samples;
            time_s_ += list_.blocks[block_].duration_s / samples;
            record_sample(joints_of(share));
        }
        return true;
    }

    [[nodiscard]] double slack(const PathPoint& station, const Vector3d& eye) const {
        return station.normal.dot(pins_.pull(station.position_mm, eye));
    }

    // Takes up what the eye has lifted off.
    void peel(const Vector3d& eye) {
        if (walker_.normal().dot(pins_.pull(walker_.position_mm(), eye)) <= kLift_mm) {
            return;
        }
        furthest_mm_ = std::max(furthest_mm_, laid_.path.back().s_mm);
        std::optional<PathPoint> taken_up;
        while (laid_.path.size() > 1 &&
               (laid_.at.back().lifted || slack(laid_.path.back(), eye) > 0.0)) {
            const std::size_t last = laid_.path.size() - 1;
            const bool in_air = laid_.at[last].lifted || laid_.at[last - 1].lifted;
            furthest_mm_ -= in_air ? laid_.path[last].s_mm - laid_.path[last - 1].s_mm : 0.0;
            taken_up = in_air ? std::nullopt : std::optional(laid_.path.back());
            laid_.path.pop_back();
            laid_.at.pop_back();
        }
        walker_.move_to(laid_.path.back().at);
        if (taken_up) {
            lay_again(*taken_up, eye);
        }
        const double peeled = furthest_mm_ - laid_.path.back().s_mm;
        if (peeled > laid_.peeled_mm) {
            laid_.peeled_mm = peeled;
            laid_.peeled_block = block_;
        }
    }

    // From the last station that holds the fibre to where it lifts off before the next one, as it
    // was laid: along the cubic between the two.
    void lay_again(const PathPoint& next, const Vector3d& eye) {
        const PathPoint last = laid_.path.back();
        const double between_mm = next.s_mm - last.s_mm;
        if (between_mm < kStation_mm) {
            return;  // the two sides of a feature edge
        }
        const auto tangent = [&](const Vector3d& x) {
            return beside(last.position_mm, last.tangent, next.position_mm, next.tangent, x)
                .tangent;
        };
        const FieldWalk walk = walker_.walk(
            [&](const Vector3d& x, const Vector3d& n) {
                const Vector3d pull = pins_.pull(x, eye);
                return Aim{tangent(x), n.dot(pull), 0.0, pull.norm()};
            },
            between_mm, between_mm);
        record(walker_.station(tangent(walker_.position_mm())), last.s_mm + walk.length_mm, false);
    }

    // The landing point follows the eye to the end of its curve.
    bool follow(const EyeCurve& curve) {
        const Vector3d& eye = curve.end();
        if (const std::string words = pins_.update(walker_.position_mm(), eye); !words.empty()) {
            return fail(words);
        }
        peel(eye);
        if (pins_.holds()) {
            return follow_pin(curve);
        }
        const AimField field = [&curve, &eye](const Vector3d& x, const Vector3d& n) {
            return Aim{curve.in_plane(x, n) - x, n.dot(eye - x), 0.0, (eye - x).norm()};
        };
        for (int bridges = 0; bridges < kMaxBridges; ++bridges) {
            const double free = (eye - walker_.position_mm()).norm();
            if (free < kLeastFree_mm) {
                return fail("the eye touches the mandrel");
            }
            const double begun = laid_.path.back().s_mm;
            const FieldWalk walk = walker_.walk(
                field, free, std::max(kStepShare * free, kLeastFree_mm),
                [&](const PathPoint& station) { record(station, begun + station.s_mm, false); });
            if (walk.length_mm > kStation_mm) {
                record(walker_.station(eye - walker_.position_mm()), begun + walk.length_mm, false);
            }
            switch (walk.stop) {
                case FieldStop::Rim:
                    return fail("the fibre runs over the end of the extension of rim " +
                                std::to_string(walk.rim));
                case FieldStop::Folded:
                    return fail("the mesh is too coarse here: a curved patch turns over");
                case FieldStop::Length:
                    return fail("the eye dips into the mandrel");
                case FieldStop::Arrived:
                    if (!wall_.hollow_near(walker_.face()) || !cross_hollow(eye)) {
                        return true;
                    }
                    break;
                case FieldStop::Stalled:
                    if (!cross_hollow(eye)) {
                        return true;
                    }
                    break;
            }
        }
        return fail("the fibre bridges again and again at one place");
    }

    // The same where a pin holds the fibre.
    bool follow_pin(const EyeCurve& curve) {
        const AimField field = [&](const Vector3d& x, const Vector3d& n) {
            const Vector3d pull = pins_.pull(x, curve.end());
            return Aim{pull_in_plane(curve, x, n), n.dot(pull), 0.0, pull.norm()};
        };
        const double free = (curve.end() - walker_.position_mm()).norm();
        for (double gone = 0.0; gone < free;) {
            const double begun = laid_.path.back().s_mm;
            const FieldWalk walk = walker_.walk(
                field, kPinStation_mm, std::min(pins_.step_mm(), kPinStation_mm),
                [&](const PathPoint& station) { record(station, begun + station.s_mm, false); });
            if (walk.length_mm > kStation_mm) {
                record(walker_.station(pins_.pull(walker_.position_mm(), curve.end())),
                       begun + walk.length_mm, false);
            }
            if (walk.stop == FieldStop::Arrived || walk.stop == FieldStop::Stalled) {
                return true;
            }
            if (walk.stop != FieldStop::Length) {
                break;
            }
            gone += walk.length_mm;
        }
        return fail("the fibre about a pin runs off the wall");
    }

    // The fibre's direction when it is in the tangent plane of a place that it ends under.
    [[nodiscard]] Vector3d pull_in_plane(const EyeCurve& curve, const Vector3d& place,
                                         const Vector3d& normal) const {
        const auto over = [&](double share) {
            return normal.dot(pins_.pull(place, curve.position(share)));
        };
        const double begin = over(0.0);
        const double end = over(1.0);
        if (end >= 0.0 || begin <= 0.0) {
            return pins_.pull(place, curve.position(end >= 0.0 ? 1.0 : 0.0));
        }
        std::uintmax_t most = kPinRootSteps;
        const double high = boost::math::tools::toms748_solve(
                                over, 0.0, 1.0, begin, end,
                                boost::math::tools::eps_tolerance<double>(kPinRootBits), most)
                                .second;
        return pins_.pull(place, curve.position(high));
    }

    // Over a hollow, to where the straight fibre meets the wall again; false where it does not.
    bool cross_hollow(const Vector3d& eye) {
        const Vector3d free = eye - walker_.position_mm();
        const double length = free.norm();
        const std::optional<Bridge> bridge =
            bridge_ahead(wall_.surface(), walker_, free / length,
                         std::min(wall_.bridge_reach_mm(), kAheadShare * length), wall_.lifted());
        if (!bridge) {
            return false;
        }
        const double begun = laid_.path.back().s_mm;
        for (std::size_t i = 0; i < bridge->under.size(); ++i) {
            const bool lifted = i + 1 < bridge->under.size();
            record(bridge->under[i], begun + bridge->under[i].s_mm, lifted);
            laid_.at.back().gap_mm = lifted ? bridge->gap_mm[i] : 0.0;
        }
        furthest_mm_ = std::max(furthest_mm_, begun) + laid_.path.back().s_mm - begun;
        walker_ = bridge->far;
        return true;
    }

    bool fail(const std::string& words) {
        laid_.failure = words;
        return false;
    }

    void record(const PathPoint& station, double s_mm, bool lifted) {
        const bool same_place = !laid_.path.empty() && s_mm - laid_.path.back().s_mm < kStation_mm;
        if (same_place && station.normal.dot(laid_.path.back().normal) > kSameNormal) {
            return;
        }
        // The other side of a feature edge is at the same length, or it is not known for one.
        const double at_mm = same_place ? laid_.path.back().s_mm : s_mm;
        laid_.path.push_back(station);
        laid_.path.back().s_mm = at_mm;
        laid_.at.push_back({block_, lifted, 0.0, pins_.at_pin(station.position_mm)});
    }

    void record_sample(const std::vector<double>& joints) {
        EyePoint sample;
        sample.piece = list_.blocks[block_].piece;
        sample.point = -1;
        sample.s_mm = laid_.path.back().s_mm;
        sample.landing_mm = walker_.position_mm();
        sample.eye_mm = eye_mm_;
        if (const auto bent = pins_.string(sample.landing_mm, eye_mm_)) {
            sample.landing_mm = bent->out_mm;
            sample.s_mm += bent->to_out_mm;
        }
        const Vector3d free = eye_mm_ - sample.landing_mm;
        sample.free_length_mm = free.norm();
        sample.tangent = free / sample.free_length_mm;
        sample.binormal = walker_.normal().cross(sample.tangent).normalized();
        laid_.samples.push_back(sample);
        laid_.joints.joints.insert(laid_.joints.joints.end(), joints.begin(), joints.end());
        laid_.time_s.push_back(time_s_);
        laid_.block.push_back(block_);
    }

    const LaydownWall& wall_;
    const Machine& machine_;
    const BlockList& list_;
    LaydownOptions options_;
    FieldWalker walker_;
    PinContact pins_;
    Vector3d eye_mm_ = Vector3d::Zero();
    std::size_t block_ = 0;
    double time_s_ = 0.0;
    double furthest_mm_ = 0.0;  // laid so far, with what is in the air now
    LaidPath laid_;
};

}  // namespace

LaydownWall::LaydownWall(Surface surface, double bridge_reach_mm, std::vector<Pin> pins)
    : surface_(std::move(surface)),
      bridge_reach_mm_(bridge_reach_mm),
      pins_(std::move(pins)),
      hollow_(hollow_faces(surface_, bridge_reach_mm)),
      facets_(facets_of(surface_)) {
    if (std::find(hollow_.begin(), hollow_.end(), 1) != hollow_.end()) {
        lifted_.emplace(surface_);
    }
}

SurfacePoint LaydownWall::nearest(const Vector3d& place) const {
    const double reach = std::max(1.0, 2.0 * surface_.mean_edge_mm);
    const ClosestPoint closest = facets_.closest(place, reach);
    if (closest.part < 0) {
        throw InputError("verify.tie_on", "",
                         "the tie-on point (" + fixed(place.x(), 3) + ", " + fixed(place.y(), 3) +
                             ", " + fixed(place.z(), 3) + ") is more than " + fixed(reach, 1) +
                             " mm off the mandrel; is it the mandrel of this program?");
    }
    return {closest.face, closest.bary};
}

LaidPath lay_down(const LaydownWall& wall, const Machine& machine, const BlockList& list,
                  const Vector3d& tie_on_mm, const LaydownOptions& options) {
    return Layer(wall, machine, list, tie_on_mm, options).lay();
}

}  // namespace meshwind
