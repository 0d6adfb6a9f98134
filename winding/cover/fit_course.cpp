#include "winding/cover/fit_course.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Dense>

#include "core/margins.h"
#include "geodesic/jacobi_field.h"

namespace meshwind {
namespace {

constexpr int kParts = CourseFields::ColsAtCompileTime;
using Shares = Eigen::Matrix<double, kParts, 1>;  // of the modes, or parts of a move

// Steps of the search: the first, in bands of root mean square displacement; by how much one grows
// after a success and shrinks after a failure; how many are tried.
constexpr double kFirstStep = 0.15;
constexpr double kGrow = 1.4;
constexpr double kShrink = 0.4;
constexpr int kSteps = 14;

// Displacements of which one is this much a sum of the others add nothing to them.
constexpr double kMinEigenvalue = 1e-6;

// The edge of a band is taken for a slope of this width, in bands: samples are as far apart.
constexpr double kEdgeBands = 0.1;

// No place of a course moves by more pitches of the pins than so many.
constexpr double kMaxPitches = 2.0;

// A part of a move that displaces hardly any place counts as one that displaces them by so much.
constexpr double kMinSize = 1e-9;

// Directions at a course's ends are told by stations this far apart, at least.
constexpr double kSlope_mm = 1.0;

}  // namespace

// From the seed both ways, as in jacobi_field_mm() but with a source: j = y e^G,
// y'' = -(1 + lambda^2) K y + kn e^-G as far as it is steered otherwise, G the integral of lambda
// tau ds. Concave places are not steered.
CourseFields displacements(const Surface& surface, const SurfacePath& path,
                           const Candidate& candidate, std::size_t seed) {
    using Row = Eigen::Array<double, 1, kParts>;
    std::vector<CurvatureAlong> curvature(path.size());
    for (std::size_t i = 0; i < path.size(); ++i) {
        curvature[i] = curvature_along(surface, path[i]);
    }
    CourseFields fields(static_cast<Eigen::Index>(path.size()), kParts);
    for (const int side : {1, -1}) {
        const double steering = candidate.slip_ratio + (side < 0 ? candidate.more_behind : 0.0);
        const auto ratio = [&](std::size_t i) { return path[i].kn_per_mm > 0.0 ? steering : 0.0; };
        const auto twist = [&](std::size_t i) { return ratio(i) * curvature[i].torsion_per_mm; };
        double growth = 0.0;
        Row y(1.0, 0.0, 0.0, 0.0);
        Row slope(-twist(seed), 1.0, 0.0, 0.0);  // so that the first is not turned
        const auto pull = [&](std::size_t i) {
            Row rate = -(1.0 + ratio(i) * ratio(i)) * curvature[i].gaussian_per_mm2 * y;
            rate(side > 0 ? 2 : 3) += std::max(0.0, path[i].kn_per_mm) * std::exp(-growth);
            return rate;
        };
        const std::size_t last = side > 0 ? path.size() - 1 : 0;
        fields.row(static_cast<Eigen::Index>(seed)) = y.matrix();
        for (std::size_t i = seed; i != last;) {
            const std::size_t next = side > 0 ? i + 1 : i - 1;
            const double ds = path[next].s_mm - path[i].s_mm;
            slope += 0.5 * ds * pull(i);
            y += ds * slope;
            growth += 0.5 * ds * (twist(i) + twist(next));
            slope += 0.5 * ds * pull(next);
            fields.row(static_cast<Eigen::Index>(next)) = std::exp(growth) * y.matrix();
            i = next;
        }
    }
    return fields;
}

namespace {

// Displacements at right angles to each other, of 1 mm root mean square, and the moves they are of.
struct Modes {
    using Square = Eigen::Matrix<double, kParts, kParts>;
    CourseFields at_station;
    Square parts;   // of a move, per share of each mode
    Square shares;  // of the modes, per part of a move
};

Modes modes_of(const CourseFields& fields) {
    using Square = Modes::Square;
    const Square gram = fields.transpose() * fields / static_cast<double>(fields.rows());
    const Shares scale =
        gram.diagonal().unaryExpr([](double v) { return v > 0.0 ? 1.0 / std::sqrt(v) : 0.0; });
    const Eigen::SelfAdjointEigenSolver<Square> solver(scale.asDiagonal() * gram *
                                                       scale.asDiagonal());
    const Shares sizes = solver.eigenvalues().unaryExpr(
        [](double v) { return v > kMinEigenvalue ? 1.0 / std::sqrt(v) : 0.0; });
    const Square parts = scale.asDiagonal() * solver.eigenvectors() * sizes.asDiagonal();
    const Shares unscale = scale.unaryExpr([](double v) { return v > 0.0 ? 1.0 / v : 0.0; });
    const Shares unsize = sizes.unaryExpr([](double v) { return v > 0.0 ? 1.0 / v : 0.0; });
    const Square shares =
        unsize.asDiagonal() * solver.eigenvectors().transpose() * unscale.asDiagonal();
    return {fields * parts, parts, shares};
}

// What covering the samples of a strip saves, as the band is displaced.
class Strips {
public:
    Strips(const Strip& strip, std::span<const float> saving, const CourseFields& modes,
           double band_mm)
        : half_band_(static_cast<float>(0.5 * band_mm)),
          slope_(static_cast<float>(1.0 / (kEdgeBands * band_mm))),
          blocks_((strip.sample.size() + kLanes - 1) / kLanes) {
        for (std::size_t i = 0; i < strip.sample.size(); ++i) {
            Block& block = blocks_[i / kLanes];
            const auto lane = static_cast<Eigen::Index>(i % kLanes);
            block.left_mm(lane) = strip.left_mm[i];
            block.saving(lane) = saving[i];
            for (std::size_t k = 0; k < kParts; ++k) {
                block.mode[k](lane) =
                    static_cast<float>(modes(strip.station[i], static_cast<Eigen::Index>(k)));
            }
        }
    }

    // \param uphill the gradient with respect to the shares
    double saved(const Shares& by, Shares& uphill) const {
        const Eigen::Vector4f share = by.cast<float>();
        Lanes sum = Lanes::Zero();
        std::array<Lanes, kParts> gradient;
        gradient.fill(Lanes::Zero());
        for (const Block& block : blocks_) {
            const Lanes off = block.left_mm - share(0) * block.mode[0] - share(1) * block.mode[1] -
                              share(2) * block.mode[2] - share(3) * block.mode[3];
            const Lanes inside = (half_band_ - off.abs()) * slope_ + 0.5F;
            const Lanes covered = inside.max(0.0F).min(1.0F);
            sum += covered * block.saving;
            // 1 on the slopes of the edge, with the sign of the side; 0 elsewhere.
            const Lanes on_edge = (covered * (1.0F - covered) * kSteep).min(1.0F);
            const Lanes side = (off * kSteep).max(-1.0F).min(1.0F);
            const Lanes rate = on_edge * side * slope_ * block.saving;
            for (std::size_t k = 0; k < kParts; ++k) {
                gradient[k] += rate * block.mode[k];
            }
        }
        for (std::size_t k = 0; k < kParts; ++k) {
            uphill(static_cast<Eigen::Index>(k)) = static_cast<double>(gradient[k].sum());
        }
        return static_cast<double>(sum.sum());
    }

private:
    static constexpr std::size_t kLanes = 8;
    using Lanes = Eigen::Array<float, kLanes, 1>;

    // Makes a step of a slope.
    static constexpr float kSteep = 1e6F;

    struct Block {
        Lanes left_mm = Lanes::Zero();
        Lanes saving = Lanes::Zero();  // 0 where there is no sample
        std::array<Lanes, kParts> mode = {Lanes::Zero(), Lanes::Zero(), Lanes::Zero(),
                                          Lanes::Zero()};
    };

    float half_band_;
    float slope_;
    std::vector<Block> blocks_;
};

// What a course's end is off the nearest pins, and by how much it comes nearer per part of a move.
struct OffPins {
    double off_mm;
    Eigen::Matrix<double, 1, kParts> nearer;
};

OffPins off_pins(const CourseRules& rules, const RimCrossing& end, const SurfacePath& path,
                 const CourseFields& fields, bool last) {
    const Rim& rim = rules.mandrel.rims[static_cast<std::size_t>(end.rim)];
    const std::size_t station = last ? path.size() - 1 : 0;
    std::size_t beside = station;
    while (std::abs(path[beside].s_mm - path[station].s_mm) < kSlope_mm &&
           beside != (last ? 0 : path.size() - 1)) {
        beside = last ? beside - 1 : beside + 1;
    }
    const auto row = [&](std::size_t i) { return fields.row(static_cast<Eigen::Index>(i)); };
    const Eigen::Matrix<double, 1, kParts> left = row(station);
    const Eigen::Matrix<double, 1, kParts> turned =
        (left - row(beside)) / (path[station].s_mm - path[beside].s_mm);
    const double side = last ? 1.0 : -1.0;
    return {off_pins_mm(rim, end, rules.turns),
            -end.sense * side / std::cos(end.angle_rad) * left +
                end.sense * off_pins_mm_per_rad(rim, end, rules.turns) * turned};
}

// Displacements that leave both ends at their pins, and the moves they are of.
Modes modes_at_pins(const CourseRules& rules, const PlacedCourse& course,
                    const CourseFields& fields) {
    Eigen::Matrix<double, 2, kParts> nearer;
    nearer << off_pins(rules, course.member.end[0], course.path, fields, false).nearer,
        off_pins(rules, course.member.end[1], course.path, fields, true).nearer;
    // Parts of a move are compared by how far they displace the course.
    const Shares size = fields.colwise().norm().cwiseMax(kMinSize).transpose();
    const Eigen::Matrix<double, 2, kParts> rates = nearer * size.cwiseInverse().asDiagonal();
    const Modes::Square keeping = Modes::Square::Identity() -
                                  rates.transpose() * (rates * rates.transpose()).inverse() * rates;
    const Modes::Square kept = size.cwiseInverse().asDiagonal() * keeping * size.asDiagonal();
    Modes modes = modes_of(fields * kept);
    modes.parts = kept * modes.parts;
    return modes;
}

}  // namespace

Fit fit_course(const CourseRules& rules, const PlacedCourse& course, const Strip& strip,
               std::span<const float> saving) {
    const double band_mm = rules.tow.width_mm;
    const Candidate& from = course.member.candidate;
    const CourseFields fields =
        displacements(rules.mandrel.surface, course.path, from, seed_station(course));
    const Modes modes =
        rules.turns.pins.empty() ? modes_of(fields) : modes_at_pins(rules, course, fields);
    const Strips strips(strip, saving, modes.at_station, band_mm);
    // The nearest that is allowed: steered no harder than it may be.
    const double most_steering = rules.tow.friction.share(margin::kCoverSteering);
    const auto allowed = [&](const Shares& by) -> Shares {
        Shares move = modes.parts * by;
        const Shares asked = move;
        const double behind = from.slip_ratio + from.more_behind;
        move(2) =
            std::clamp(move(2), -most_steering - from.slip_ratio, most_steering - from.slip_ratio);
        move(3) = std::clamp(move(3), -most_steering - behind, most_steering - behind);
        return by + modes.shares * (move - asked);
    };
    Shares by = Shares::Zero();
    Shares uphill = Shares::Zero();
    double most = strips.saved(by, uphill);
    double step = kFirstStep * band_mm;
    for (int i = 0; i < kSteps && uphill.norm() > 0.0; ++i) {
        const Shares to = allowed(by + step * uphill.normalized());
        Shares there = Shares::Zero();
        if ((modes.at_station * to).cwiseAbs().maxCoeff() <= kFitBands * band_mm) {
            const double saved = strips.saved(to, there);
            if (saved > most) {
                most = saved;
                by = to;
                uphill = there;
                step *= kGrow;
                continue;
            }
        }
        step *= kShrink;
    }
    const Shares move = modes.parts * by;
    return {{move(0), move(1), move(2), move(3)}, most};
}

bool ends_at_pins(const CourseRules& rules, const LibraryCourse& member, double within_mm) {
    return std::all_of(member.end.begin(), member.end.end(), [&](const RimCrossing& end) {
        return std::abs(off_pins_mm(rules.mandrel.rims[static_cast<std::size_t>(end.rim)], end,
                                    rules.turns)) <= within_mm;
    });
}

std::optional<CourseMove> move_to_pins(const CourseRules& rules, const PlacedCourse& course) {
    const LibraryCourse& member = course.member;
    const CourseFields fields =
        displacements(rules.mandrel.surface, course.path, member.candidate, seed_station(course));
    const OffPins first = off_pins(rules, member.end[0], course.path, fields, false);
    const OffPins last = off_pins(rules, member.end[1], course.path, fields, true);
    Eigen::Matrix2d nearer;
    nearer << first.nearer.head<2>(), last.nearer.head<2>();
    const Eigen::Vector2d move = nearer.inverse() * Eigen::Vector2d(first.off_mm, last.off_mm);
    const double most_mm = kMaxPitches * rules.turns.pins.front().shape.pitch_mm;
    if (!move.allFinite() || (fields.leftCols<2>() * move).cwiseAbs().maxCoeff() > most_mm) {
        return std::nullopt;
    }
    return CourseMove{move.x(), move.y()};
}

}  // namespace meshwind
