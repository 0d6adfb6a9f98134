#include "mesh/tube/tube_chain.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "core/parallel.h"
#include "core/units.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

// Curvature is read over chords of this share of the radius.
constexpr double kChordShare = 0.3;

// Readings for each arc of the line at most. Along an arc curvature is constant, so more tell
// nothing; a tube that begins with a point would ask for millions.
constexpr double kMaxPerArc = 100.0;

// A stretch that bends with a radius above 50 tube radii is taken for straight first; and a jump of
// the curvature by less is none.
constexpr double kMinCurvature = 0.02;  // times the tube's radius
constexpr double kMinJump = 0.3;        // of the curvature beside it
constexpr double kMinBow = 1e-3;        // of the tube's radius, of a bend over its chord

// Vertices that the chain is fitted to, evenly picked: it has a dozen unknowns.
constexpr std::size_t kFitVertices = 3000;

constexpr int kRounds = 40;
constexpr double kFirstDamping = 1e-6;
constexpr double kMaxDamping = 1e6;

// Differences for derivatives: lengths in mm, angles in rad, curvature times the radius.
constexpr double kLengthStep_mm = 1e-4;
constexpr double kAngleStep_rad = 1e-6;

// The fit rests where a step moves nothing by more (mm, and rad on a radius of 1 mm).
constexpr double kAtRest = 1e-11;

struct Stretch {
    double length_mm;
    Vector2d curvature_per_mm;  // zero: straight
};

struct Readings {
    std::vector<double> arc_mm;
    std::vector<Vector2d> curvature_per_mm;  // in the line's frame
    std::size_t chord = 1;                   // readings
};

Readings curvature_along(const CentreLine& line, double radius_mm) {
    Readings readings;
    const double step = 0.5 * kChordShare * radius_mm;
    const auto count =
        static_cast<std::size_t>(std::clamp(std::ceil(line.length_mm() / step), 4.0,
                                            kMaxPerArc * static_cast<double>(line.arcs().size())));
    readings.chord = 2;
    const double spacing = line.length_mm() / static_cast<double>(count);
    const double chord = 2.0 * spacing;
    for (std::size_t i = 0; i <= count; ++i) {
        const double arc = spacing * static_cast<double>(i);
        const double middle = std::clamp(arc, chord, std::max(chord, line.length_mm() - chord));
        const CentrePlace place = line.at(middle);
        const Vector3d bow = (line.at(middle + chord).position_mm - 2.0 * place.position_mm +
                              line.at(middle - chord).position_mm) /
                             (chord * chord);
        readings.arc_mm.push_back(arc);
        readings.curvature_per_mm.emplace_back(bow.dot(place.reference), bow.dot(place.across()));
    }
    return readings;
}

// Readings at which the curvature jumps, with both ends of the line.
std::vector<std::size_t> jumps_of(const Readings& readings, double radius_mm) {
    const std::size_t count = readings.arc_mm.size();
    const auto before = [&](std::size_t i) {
        return readings.curvature_per_mm[i - std::min(i, readings.chord)];
    };
    const auto after = [&](std::size_t i) {
        return readings.curvature_per_mm[std::min(i + readings.chord, count - 1)];
    };
    std::vector<double> jump(count);
    for (std::size_t i = 0; i < count; ++i) {
        jump[i] = (after(i) - before(i)).norm();
    }
    std::vector<std::size_t> cuts{0};
    for (std::size_t i = 1; i + 1 < count; ++i) {
        // A jump is seen from two chords before it to two after it.
        const std::size_t low = i - std::min(i, 2 * readings.chord);
        const std::size_t high = std::min(i + 2 * readings.chord, count - 1);
        const auto highest = std::max_element(jump.begin() + static_cast<std::ptrdiff_t>(low),
                                              jump.begin() + static_cast<std::ptrdiff_t>(high) + 1);
        const double beside = std::max(before(i).norm(), after(i).norm());
        if (highest - jump.begin() == static_cast<std::ptrdiff_t>(i) &&
            jump[i] > std::max(kMinCurvature / radius_mm, kMinJump * beside)) {
            cuts.push_back(i);
        }
    }
    cuts.push_back(count - 1);
    return cuts;
}

std::vector<Stretch> stretches_of(const Readings& readings, double radius_mm) {
    const std::vector<std::size_t> cuts = jumps_of(readings, radius_mm);
    std::vector<Stretch> stretches;
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
        const double length = readings.arc_mm[cuts[i + 1]] - readings.arc_mm[cuts[i]];
        const Vector2d curvature = readings.curvature_per_mm[(cuts[i] + cuts[i + 1]) / 2];
        const bool straight = curvature.norm() * radius_mm < kMinCurvature;
        stretches.push_back({length, straight ? Vector2d::Zero() : curvature});
        if (stretches.size() > 1) {
            Stretch& before = stretches[stretches.size() - 2];
            const double most =
                std::max(before.curvature_per_mm.norm(), stretches.back().curvature_per_mm.norm());
            if ((before.curvature_per_mm - stretches.back().curvature_per_mm).norm() <=
                kMinJump * most) {
                before.length_mm += length;
                stretches.pop_back();
            }
        }
    }
    return stretches;
}

// The chain by its unknowns: where it starts beside a given place and leans there, what the radius
// is more than that of the tube, lengths of all stretches but the last, curvature of the arcs.
class Chain {
public:
    Chain(const CentrePlace& start, std::vector<Stretch> stretches, const Tube& tube,
          bool one_radius)
        : start_(start), stretches_(std::move(stretches)), tube_(tube), one_radius_(one_radius) {
        for (const Stretch& stretch : stretches_) {
            bends_ += stretch.curvature_per_mm.isZero() ? 0 : 1;
        }
        if (one_radius_) {
            for (const TubeRadius& node : tube_.radius) {
                base_mm_ += node.radius_mm / static_cast<double>(tube_.radius.size());
            }
        }
    }

    [[nodiscard]] Eigen::Index unknowns() const {
        return 4 + static_cast<Eigen::Index>(stretches_.size() + 2 * bends_);
    }

    [[nodiscard]] VectorXd first() const {
        VectorXd x = VectorXd::Zero(unknowns());
        Eigen::Index next = 5;
        for (std::size_t i = 0; i + 1 < stretches_.size(); ++i) {
            x[next++] = stretches_[i].length_mm;
        }
        for (const Stretch& stretch : stretches_) {
            if (!stretch.curvature_per_mm.isZero()) {
                x.segment<2>(next) = scale_mm() * stretch.curvature_per_mm;
                next += 2;
            }
        }
        return x;
    }

    [[nodiscard]] double step_of(Eigen::Index i) const {
        const bool length =
            i < 2 || (i >= 4 && i < 4 + static_cast<Eigen::Index>(stretches_.size()));
        return length ? kLengthStep_mm : kAngleStep_rad;
    }

    [[nodiscard]] CentreLine line(const VectorXd& x) const {
        CentrePlace start = start_;
        start.position_mm += x[0] * start_.reference + x[1] * start_.across();
        start.tangent =
            (start_.tangent + x[2] * start_.reference + x[3] * start_.across()).normalized();
        start.reference =
            (start_.reference - start_.reference.dot(start.tangent) * start.tangent).normalized();
        std::vector<CentreArc> arcs;
        Eigen::Index length = 5;
        Eigen::Index bend = 4 + static_cast<Eigen::Index>(stretches_.size());
        for (std::size_t i = 0; i < stretches_.size(); ++i) {
            CentreArc arc;
            // The last goes on beyond the rim, so that vertices there are not taken for those of a
            // straight end.
            arc.length_mm = i + 1 < stretches_.size() ? std::max(0.0, x[length++])
                                                      : stretches_.back().length_mm + scale_mm();
            if (!stretches_[i].curvature_per_mm.isZero()) {
                arc.curvature_per_mm = x.segment<2>(bend) / scale_mm();
                bend += 2;
            }
            arcs.push_back(arc);
        }
        return {start, std::move(arcs)};
    }

    [[nodiscard]] double radius_mm(const VectorXd& x, double arc_mm) const {
        return x[4] + (one_radius_ ? base_mm_ : tube_.radius_at(arc_mm));
    }

    [[nodiscard]] VectorXd off(const VectorXd& x, std::span<const Vector3d> points) const {
        const CentreLine chain = line(x);
        VectorXd off(static_cast<Eigen::Index>(points.size()));
        for (std::size_t i = 0; i < points.size(); ++i) {
            const CentrePlace foot = chain.foot(points[i]);
            off[static_cast<Eigen::Index>(i)] =
                (points[i] - foot.position_mm).norm() - radius_mm(x, foot.arc_mm);
        }
        return off;
    }

private:
    // Curvatures are unknowns without unit.
    [[nodiscard]] double scale_mm() const { return tube_.radius.front().radius_mm; }

    CentrePlace start_;
    std::vector<Stretch> stretches_;
    const Tube& tube_;
    bool one_radius_;
    std::size_t bends_ = 0;
    double base_mm_ = 0.0;
};

VectorXd fitted(const Chain& chain, std::span<const Vector3d> points) {
    VectorXd x = chain.first();
    VectorXd off = chain.off(x, points);
    double damping = kFirstDamping;
    for (int round = 0; round < kRounds && damping < kMaxDamping; ++round) {
        Eigen::MatrixXd slope(off.size(), x.size());
        parallel_for(static_cast<std::size_t>(x.size()), 1,
                     [&](std::size_t begin, std::size_t end) {
                         for (std::size_t i = begin; i < end; ++i) {
                             const auto k = static_cast<Eigen::Index>(i);
                             VectorXd more = x;
                             VectorXd less = x;
                             more[k] += chain.step_of(k);
                             less[k] -= chain.step_of(k);
                             slope.col(k) = (chain.off(more, points) - chain.off(less, points)) /
                                            (2.0 * chain.step_of(k));
                         }
                     });
        Eigen::MatrixXd normal = slope.transpose() * slope;
        normal.diagonal() *= 1.0 + damping;
        const VectorXd step = -normal.ldlt().solve(slope.transpose() * off);
        const VectorXd tried = x + step;
        const VectorXd tried_off = chain.off(tried, points);
        if (tried_off.squaredNorm() < off.squaredNorm()) {
            x = tried;
            off = tried_off;
            damping *= 0.1;
        } else {
            damping = std::max(kFirstDamping, 10.0 * damping);
        }
        if (!(step.cwiseAbs().maxCoeff() > kAtRest)) {
            break;
        }
    }
    return x;
}

// Short legs whose curvature was read across the joint: a bow that the wall does not show is none.
// Returns whether there was one.
bool straighten(const CentreLine& line, double radius_mm, std::vector<Stretch>& stretches) {
    bool any = false;
    for (std::size_t i = 0; i < stretches.size(); ++i) {
        const CentreArc& arc = line.arcs()[i];
        const double bow_mm = arc.curvature_per_mm.norm() * arc.length_mm * arc.length_mm / 8.0;
        if (!stretches[i].curvature_per_mm.isZero() && bow_mm <= kMinBow * radius_mm) {
            stretches[i].curvature_per_mm.setZero();
            any = true;
        }
    }
    return any;
}

bool nearly_one_radius(const Tube& tube) {
    const auto [least, most] = std::minmax_element(
        tube.radius.begin(), tube.radius.end(),
        [](const TubeRadius& a, const TubeRadius& b) { return a.radius_mm < b.radius_mm; });
    return most->radius_mm - least->radius_mm <= kTubeResidualShare * most->radius_mm;
}

// From rim to rim, with the reference away from the centre of the first bend.
std::optional<CentreLine> trimmed(const CentreLine& line, std::span<const Rim> rims) {
    CentrePlace start = line.foot(rims[0].centre_mm);
    const double begin = start.arc_mm;
    const double end = line.foot(rims[1].centre_mm).arc_mm;
    std::vector<CentreArc> arcs;
    for (std::size_t i = 0; i < line.arcs().size(); ++i) {
        const bool last = i + 1 == line.arcs().size();
        const double from = i == 0 ? begin : std::max(begin, line.nodes()[i].arc_mm);
        const double to = last ? end : std::min(end, line.nodes()[i + 1].arc_mm);
        if (!(to > from)) {
            return std::nullopt;
        }
        arcs.push_back({to - from, line.arcs()[i].curvature_per_mm});
    }
    const auto bend = std::find_if(arcs.begin(), arcs.end(), [](const CentreArc& arc) {
        return !arc.curvature_per_mm.isZero();
    });
    if (bend != arcs.end()) {
        const Vector2d x = -bend->curvature_per_mm.normalized();
        const Vector3d across = start.across();
        start.reference = x.x() * start.reference + x.y() * across;
        for (CentreArc& arc : arcs) {
            const Vector2d k = arc.curvature_per_mm;
            arc.curvature_per_mm = {k.dot(x), x.x() * k.y() - x.y() * k.x()};
        }
    }
    return CentreLine(start, std::move(arcs));
}

std::vector<TubePart> parts_of(const CentreLine& line) {
    std::vector<TubePart> parts;
    for (std::size_t i = 0; i < line.arcs().size(); ++i) {
        TubePart part;
        part.from_mm = line.nodes()[i].arc_mm;
        part.to_mm = line.nodes()[i + 1].arc_mm;
        const double curvature = line.arcs()[i].curvature_per_mm.norm();
        if (curvature > 0.0) {
            part.kind = TubePartKind::Bend;
            part.bend_radius_mm = 1.0 / curvature;
            part.angle_rad = curvature * (part.to_mm - part.from_mm);
        }
        parts.push_back(part);
    }
    return parts;
}

}  // namespace

std::optional<Tube> chain_tube(std::span<const Rim> rims, const Surface& surface,
                               const Tube& tube) {
    const double radius_mm = tube.radius.front().radius_mm;
    std::vector<Stretch> stretches = stretches_of(curvature_along(tube.line, radius_mm), radius_mm);
    const bool one_radius = nearly_one_radius(tube);
    std::vector<Vector3d> points;
    const std::size_t every = 1 + surface.position_mm.size() / kFitVertices;
    for (std::size_t v = 0; v < surface.position_mm.size(); v += every) {
        points.push_back(surface.position_mm[v]);
    }
    std::optional<Chain> chain;
    chain.emplace(tube.line.nodes().front(), stretches, tube, one_radius);
    VectorXd x = fitted(*chain, points);
    if (x.allFinite() && straighten(chain->line(x), radius_mm, stretches)) {
        chain.emplace(tube.line.nodes().front(), stretches, tube, one_radius);
        x = fitted(*chain, points);
    }
    if (!x.allFinite()) {
        return std::nullopt;
    }
    const CentreLine whole = chain->line(x);
    std::optional<CentreLine> line = trimmed(whole, rims);
    if (!line) {
        return std::nullopt;
    }
    std::vector<TubeRadius> radius;
    const double begin = whole.foot(rims[0].centre_mm).arc_mm;
    for (const TubeRadius& node : tube.radius) {
        radius.push_back({node.arc_mm - begin, chain->radius_mm(x, node.arc_mm)});
    }
    if (one_radius) {
        radius.resize(1);
    }
    std::vector<TubePart> parts = parts_of(*line);
    return Tube{std::move(*line), std::move(radius), std::move(parts), {}, {}, 0.0};
}

}  // namespace meshwind
