#include "postproc/verify/laydown.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/interrupt.h"
#include "core/roots.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "geodesic/bridge.h"
#include "geodesic/field_walk.h"
#include "machines/kinematics.h"
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

// Looking ahead over a hollow goes no further than this share of the free length.
constexpr double kAheadShare = 0.9;
// Bridges within one sample; more means a wall of spikes.
constexpr int kMaxBridges = 50;

// Fibre about a pin is recorded so often.
constexpr double kPinStation_mm = 0.25;

// Where along its curve the eye is in line with a place about a pin: to the last digits.
constexpr ZeroSearch kPinRoot{.bits = 50, .most_evaluations = 60};

// A free fibre shorter than this has no direction.
constexpr double kMinFree_mm = 1e-3;

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

// Where the free fibre begins: a place on the patches, and the pins that may hold the fibre.
struct Landing {
    FieldWalker walker;
    PinContact pins;

    [[nodiscard]] const Vector3d& position_mm() const { return walker.position_mm(); }
};

// The fibre that is laid, and the motion up to now.
struct LaidFibre {
    LaidPath laid;
    std::size_t block = 0;     // that lays it now
    double furthest_mm = 0.0;  // laid so far, with what is in the air now

    [[nodiscard]] double end_mm() const { return laid.path.back().s_mm; }
};

Vector3d eye_at(const Machine& machine, const std::vector<double>& joints) {
    return mandrel_from_eye(machine, joints).translation();
}

// Samples of a move of the axes.
double samples_of(const Machine& machine, const std::vector<double>& from,
                  const std::vector<double>& to, const Vector3d& eye_mm,
                  const LaydownOptions& options) {
    double turned = 0.0;
    double linear_squared = 0.0;
    double spindle = 0.0;
    for (std::size_t j = 0; j < from.size(); ++j) {
        const double change = std::abs(to[j] - from[j]);
        if (machine.axis(j).type == AxisType::Linear) {
            linear_squared += change * change;
        } else {
            turned += change;
            spindle += j < machine.mandrel_chain.size() ? change : 0.0;
        }
    }
    const double way = std::sqrt(linear_squared) + spindle * eye_mm.head<2>().norm();
    return 1.0 + std::floor(std::max(way / options.sample_mm, turned / options.sample_rad));
}

// Whole programs that cannot be held are refused before they are begun.
void check_extent(const Machine& machine, const BlockList& list, const LaydownOptions& options) {
    double samples = 0.0;
    std::vector<double> from = joints_at(list, 0);
    for (std::size_t block = 1; block < list.blocks.size(); ++block) {
        const std::vector<double> to = joints_at(list, block);
        samples += samples_of(machine, from, to, eye_at(machine, from), options);
        if (samples > kMaxSamples) {
            throw InputError("verify.too_long", "",
                             "up to " + block_words(list, block) +
                                 " the axes go further than can be wound again, " +
                                 fixed(kMaxSamples * options.sample_mm / 1e6, 0) +
                                 " km of the eye's way or " +
                                 fixed(kMaxSamples * options.sample_rad / (2.0 * kPi), 0) +
                                 " turns; split the program, or mend a block that goes too far");
        }
        from = to;
    }
}

Landing tied_on(const LaydownSurface& wall, const Vector3d& tie_on_mm) {
    Landing landing{FieldWalker(wall.surface(), wall.nearest(tie_on_mm)), PinContact(wall.pins())};
    landing.walker.move_under(tie_on_mm);  // the patch's point instead of the facet's
    return landing;
}

void record(const PinContact& pins, const PathPoint& station, double s_mm, bool lifted,
            LaidFibre& fibre) {
    SurfacePath& path = fibre.laid.path;
    const bool same_place = !path.empty() && s_mm - path.back().s_mm < kStation_mm;
    if (same_place && station.normal.dot(path.back().normal) > kSameNormal) {
        return;
    }
    // The other side of a feature edge is at the same length, or it is not known for one.
    const double at_mm = same_place ? path.back().s_mm : s_mm;
    path.push_back(station);
    path.back().s_mm = at_mm;
    fibre.laid.at.push_back({fibre.block, lifted, 0.0, pins.at_pin(station.position_mm)});
}

// The free fibre between its landing point and the eye.
EyePoint free_fibre(const Landing& landing, double laid_mm, const Vector3d& eye_mm) {
    EyePoint sample;
    sample.point = -1;
    sample.s_mm = laid_mm;
    sample.landing_mm = landing.position_mm();
    sample.eye_mm = eye_mm;
    if (const auto bent = landing.pins.string(sample.landing_mm, eye_mm)) {
        sample.landing_mm = bent->out_mm;
        sample.s_mm += bent->to_out_mm;
    }
    const Vector3d free = eye_mm - sample.landing_mm;
    sample.free_length_mm = free.norm();
    sample.tangent = free / sample.free_length_mm;
    sample.binormal = landing.walker.normal().cross(sample.tangent).normalized();
    return sample;
}

void record_sample(EyePoint sample, const Block& block, const std::vector<double>& joints,
                   double time_s, LaidFibre& fibre) {
    LaidPath& laid = fibre.laid;
    sample.piece = block.piece;
    laid.samples.push_back(sample);
    laid.joints.joints.insert(laid.joints.joints.end(), joints.begin(), joints.end());
    laid.time_s.push_back(time_s);
    laid.block.push_back(fibre.block);
}

// The fibre at its tie-on, before the axes move.
LaidFibre begin_fibre(const Landing& landing, const Machine& machine, const BlockList& list) {
    LaidFibre fibre;
    fibre.laid.joints.axis_count = list.axes.size();
    const std::vector<double> joints = joints_at(list, 0);
    const Vector3d eye_mm = eye_at(machine, joints);
    record(landing.pins, landing.walker.station(eye_mm - landing.position_mm()), 0.0, false, fibre);
    record_sample(free_fibre(landing, fibre.end_mm(), eye_mm), list.blocks[0], joints, 0.0, fibre);
    return fibre;
}

// From the last station that holds the fibre to where it lifts off before the next one, as it
// was laid: along the cubic between the two.
void lay_again(const PathPoint& next, const Vector3d& eye, Landing& landing, LaidFibre& fibre) {
    const PathPoint last = fibre.laid.path.back();
    const double between_mm = next.s_mm - last.s_mm;
    if (between_mm < kStation_mm) {
        return;  // the two sides of a feature edge
    }
    const auto tangent = [&](const Vector3d& x) {
        return beside(last.position_mm, last.tangent, next.position_mm, next.tangent, x).tangent;
    };
    const FieldWalk walk = landing.walker.walk(
        [&](const Vector3d& x, const Vector3d& n) {
            const Vector3d pull = landing.pins.pull(x, eye);
            return Aim{tangent(x), n.dot(pull), 0.0, pull.norm()};
        },
        between_mm, between_mm);
    record(landing.pins, landing.walker.station(tangent(landing.position_mm())),
           last.s_mm + walk.length_mm, false, fibre);
}

// Takes up what the eye has lifted off.
void peel(const Vector3d& eye, Landing& landing, LaidFibre& fibre) {
    const auto height_mm = [&](const Vector3d& place, const Vector3d& normal) {
        return normal.dot(landing.pins.pull(place, eye));
    };
    if (height_mm(landing.position_mm(), landing.walker.normal()) <= kLift_mm) {
        return;
    }
    LaidPath& laid = fibre.laid;
    fibre.furthest_mm = std::max(fibre.furthest_mm, fibre.end_mm());
    std::optional<PathPoint> taken_up;
    while (laid.path.size() > 1 &&
           (laid.at.back().lifted ||
            height_mm(laid.path.back().position_mm, laid.path.back().normal) > 0.0)) {
        const std::size_t last = laid.path.size() - 1;
        const bool in_air = laid.at[last].lifted || laid.at[last - 1].lifted;
        fibre.furthest_mm -= in_air ? laid.path[last].s_mm - laid.path[last - 1].s_mm : 0.0;
        taken_up = in_air ? std::nullopt : std::optional(laid.path.back());
        laid.path.pop_back();
        laid.at.pop_back();
    }
    landing.walker.move_to(laid.path.back().at);
    if (taken_up) {
        lay_again(*taken_up, eye, landing, fibre);
    }
    const double peeled = fibre.furthest_mm - fibre.end_mm();
    if (peeled > laid.peeled_mm) {
        laid.peeled_mm = peeled;
        laid.peeled_block = fibre.block;
    }
}

// The fibre's direction when it is in the tangent plane of a place that it ends under.
Vector3d pull_in_plane(const PinContact& pins, const EyeCurve& curve, const Vector3d& place,
                       const Vector3d& normal) {
    const auto over = [&](double share) {
        return normal.dot(pins.pull(place, curve.position(share)));
    };
    const double begin = over(0.0);
    const double end = over(1.0);
    if (end >= 0.0 || begin <= 0.0) {
        return pins.pull(place, curve.position(end >= 0.0 ? 1.0 : 0.0));
    }
    const ZeroBracket zero = zero_between({0.0, 1.0, begin, end}, over, kPinRoot);
    return pins.pull(place, curve.position(zero.high));
}

// The landing point follows the eye to the end of its curve where a pin holds the fibre.
// \return empty, or in words why the fibre cannot be followed
std::string follow_pin(const EyeCurve& curve, Landing& landing, LaidFibre& fibre) {
    const PinContact& pins = landing.pins;
    const AimField field = [&](const Vector3d& x, const Vector3d& n) {
        const Vector3d pull = pins.pull(x, curve.end());
        return Aim{pull_in_plane(pins, curve, x, n), n.dot(pull), 0.0, pull.norm()};
    };
    const double free = (curve.end() - landing.position_mm()).norm();
    for (double gone = 0.0; gone < free;) {
        const double begun = fibre.end_mm();
        const FieldWalk walk =
            landing.walker.walk(field, kPinStation_mm, std::min(pins.step_mm(), kPinStation_mm),
                                [&](const PathPoint& station) {
                                    record(pins, station, begun + station.s_mm, false, fibre);
                                });
        if (walk.length_mm > kStation_mm) {
            const Vector3d pull = pins.pull(landing.position_mm(), curve.end());
            record(pins, landing.walker.station(pull), begun + walk.length_mm, false, fibre);
        }
        if (walk.stop == FieldStop::Arrived || walk.stop == FieldStop::Stalled) {
            return {};
        }
        if (walk.stop != FieldStop::Length) {
            break;
        }
        gone += walk.length_mm;
    }
    return "the fibre about a pin runs off the wall";
}

// Over a hollow, to where the straight fibre meets the wall again; false where it does not.
bool cross_hollow(const LaydownSurface& wall, const Vector3d& eye, Landing& landing,
                  LaidFibre& fibre) {
    const Vector3d free = eye - landing.position_mm();
    const double length = free.norm();
    const std::optional<Bridge> bridge =
        bridge_ahead(wall.surface(), landing.walker, free / length,
                     std::min(wall.bridge_reach_mm(), kAheadShare * length), wall.lifted());
    if (!bridge) {
        return false;
    }
    const double begun = fibre.end_mm();
    for (std::size_t i = 0; i < bridge->under.size(); ++i) {
        const bool lifted = i + 1 < bridge->under.size();
        record(landing.pins, bridge->under[i], begun + bridge->under[i].s_mm, lifted, fibre);
        fibre.laid.at.back().gap_mm = lifted ? bridge->gap_mm[i] : 0.0;
    }
    fibre.furthest_mm = std::max(fibre.furthest_mm, begun) + fibre.end_mm() - begun;
    landing.walker = bridge->far;
    return true;
}

// Why a walk that stopped cannot be followed on; empty where it can.
std::string stop_words(const FieldWalk& walk) {
    switch (walk.stop) {
        case FieldStop::Rim:
            return "the fibre runs over the end of the extension of rim " +
                   std::to_string(walk.rim);
        case FieldStop::Folded:
            return "the mesh is too coarse here: a curved patch turns over";
        case FieldStop::Length:
            return "the eye dips into the mandrel";
        case FieldStop::Arrived:
        case FieldStop::Stalled:
            break;
    }
    return {};
}

// The landing point follows the eye to the end of its curve where no pin holds the fibre.
// \return empty, or in words why the fibre cannot be followed
std::string follow_straight(const LaydownSurface& wall, const EyeCurve& curve, Landing& landing,
                            LaidFibre& fibre) {
    const Vector3d& eye = curve.end();
    const AimField field = [&curve, &eye](const Vector3d& x, const Vector3d& n) {
        return Aim{curve.in_plane(x, n) - x, n.dot(eye - x), 0.0, (eye - x).norm()};
    };
    for (int bridges = 0; bridges < kMaxBridges; ++bridges) {
        const double free = (eye - landing.position_mm()).norm();
        if (free < kMinFree_mm) {
            return "the eye touches the mandrel";
        }
        const double begun = fibre.end_mm();
        const FieldWalk walk = landing.walker.walk(
            field, free, std::max(kStepShare * free, kMinFree_mm), [&](const PathPoint& station) {
                record(landing.pins, station, begun + station.s_mm, false, fibre);
            });
        if (walk.length_mm > kStation_mm) {
            record(landing.pins, landing.walker.station(eye - landing.position_mm()),
                   begun + walk.length_mm, false, fibre);
        }
        if (std::string words = stop_words(walk); !words.empty()) {
            return words;
        }
        const bool bridges_on =
            (walk.stop == FieldStop::Stalled || wall.hollow_near(landing.walker.face())) &&
            cross_hollow(wall, eye, landing, fibre);
        if (!bridges_on) {
            return {};
        }
    }
    return "the fibre bridges again and again at one place";
}

// The landing point follows the eye to the end of its curve.
// \return empty, or in words why the fibre cannot be followed
std::string follow(const LaydownSurface& wall, const EyeCurve& curve, Landing& landing,
                   LaidFibre& fibre) {
    std::string words = landing.pins.update(landing.position_mm(), curve.end());
    if (!words.empty()) {
        return words;
    }
    peel(curve.end(), landing, fibre);
    return landing.pins.holds() ? follow_pin(curve, landing, fibre)
                                : follow_straight(wall, curve, landing, fibre);
}

// The motion of one block.
struct AxisMove {
    const std::vector<double>& from;
    const std::vector<double>& to;
    int samples = 1;

    void at(double share, std::vector<double>& joints) const {
        joints.resize(from.size());
        for (std::size_t j = 0; j < joints.size(); ++j) {
            joints[j] = from[j] + share * (to[j] - from[j]);
        }
    }
};

// Lays the fibre of one block.
// \return empty, or in words why the fibre cannot be followed
std::string lay_block(const LaydownSurface& wall, const Machine& machine, const Block& block,
                      const AxisMove& move, Landing& landing, LaidFibre& fibre) {
    std::vector<double> joints;
    double time_s = fibre.laid.time_s.back();
    Vector3d eye_mm = fibre.laid.samples.back().eye_mm;
    for (int k = 0; k < move.samples; ++k) {
        if (k % kSamplesPerLook == kSamplesPerLook - 1) {
            check_interrupt();
        }
        std::array<Vector3d, 4> nodes{eye_mm};
        for (std::size_t i = 1; i < 4; ++i) {
            move.at((k + static_cast<double>(i) / 3.0) / move.samples, joints);
            nodes[i] = eye_at(machine, joints);
        }
        eye_mm = nodes[3];
        if (std::string words = follow(wall, EyeCurve(nodes), landing, fibre); !words.empty()) {
            return words;
        }
        time_s += block.duration_s / move.samples;
        move.at(static_cast<double>(k + 1) / move.samples, joints);
        record_sample(free_fibre(landing, fibre.end_mm(), eye_mm), block, joints, time_s, fibre);
    }
    return {};
}

}  // namespace

LaidPath lay_down(const LaydownSurface& wall, const Machine& machine, const BlockList& list,
                  const Vector3d& tie_on_mm, const LaydownOptions& options) {
    Landing landing = tied_on(wall, tie_on_mm);
    check_extent(machine, list, options);
    LaidFibre fibre = begin_fibre(landing, machine, list);
    std::vector<double> from = joints_at(list, 0);
    for (std::size_t block = 1; block < list.blocks.size(); ++block) {
        check_interrupt();
        if (options.progress && block % kBlocksPerReport == 0) {
            options.progress(static_cast<double>(block) / static_cast<double>(list.blocks.size()));
        }
        const std::vector<double> to = joints_at(list, block);
        const Vector3d& eye_mm = fibre.laid.samples.back().eye_mm;
        const AxisMove move{from, to,
                            static_cast<int>(samples_of(machine, from, to, eye_mm, options))};
        fibre.block = block;
        fibre.laid.failure = lay_block(wall, machine, list.blocks[block], move, landing, fibre);
        if (!fibre.laid.failure.empty()) {
            fibre.laid.failed_block = block;
            break;
        }
        from = to;
    }
    return std::move(fibre.laid);
}

}  // namespace meshwind
