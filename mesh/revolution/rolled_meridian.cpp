#include "mesh/revolution/rolled_meridian.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "core/units.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;

// Shares of the ball's radius: how far the ball may dip into the body and still touches it, and how
// far the ball that stops rolling at one place may be from the one that goes on at the other.
constexpr double kTouch = 1e-7;
constexpr double kSameBall = 1e-3;

// Places of the ball that are looked at: so many a radius of its way, and a piece, at least.
constexpr double kPlacesPerRadius = 16.0;
constexpr double kPlacesPerPiece = 8.0;
constexpr int kHalvings = 60;

// Nodes of an arc are so far apart: places are then within 1e-6 of the radius (meridian.h).
constexpr double kArcStep_rad = 0.1;
constexpr double kFewestSteps = 4.0;

// A curvature that differs by more than this share from one side of a node to the other jumps.
constexpr double kJumpShare = 1e-4;

constexpr int kChords = 200;  // of a volume: within 1e-5 of itself

Vector2d point_of(const MeridianPlace& place) {
    return {place.radius_mm, place.z_mm};
}

// Away from the body.
Vector2d normal_of(double slope_rad) {
    return {std::cos(slope_rad), -std::sin(slope_rad)};
}

double slope_of(const Vector2d& tangent) {
    return std::atan2(tangent.x(), tangent.y());
}

// By how much the slope grows, -pi to pi.
double turn_rad(double from_rad, double to_rad) {
    return std::remainder(to_rad - from_rad, 2.0 * kPi);
}

// Solid between two places and the axis, < 0 where z falls.
double slice_mm3(const Vector2d& a, const Vector2d& b) {
    return kPi / 3.0 * (a.x() * a.x() + a.x() * b.x() + b.x() * b.x()) * (b.y() - a.y());
}

// Where the ball touches: along a piece the place changes and the slope with it, on an edge the
// slope alone.
struct Contact {
    double arc_mm = 0.0;
    double slope_rad = 0.0;
    bool on_edge = false;
};

// A piece of the meridian, or a convex edge of it, round which the ball turns.
struct Stretch {
    Contact from, to;
    int places = 1;
};

class Roller {
public:
    Roller(const Meridian& meridian, double radius_mm)
        : meridian_(meridian), radius_mm_(radius_mm) {}

    RolledMeridian run() {
        list_stretches();
        RolledMeridian rolled;
        rolled.why_not = find_hollows();
        if (!hollows_.empty() && rolled.why_not.empty()) {
            for (const Hollow& hollow : hollows_) {
                add_figures(hollow, rolled);
            }
            rolled.meridian.emplace(filled_up());
        }
        return rolled;
    }

private:
    // Between its ends the ball touches nothing.
    struct Hollow {
        Contact from, to;
        Vector2d ball_mm;

        [[nodiscard]] double turn() const {
            const double turn = turn_rad(from.slope_rad, to.slope_rad);
            return turn < 0.0 ? turn + 2.0 * kPi : turn;
        }
    };

    [[nodiscard]] double slope_before(std::size_t node) const {
        return slope_of(meridian_.pieces()[node - 1].tangent1);
    }
    [[nodiscard]] double slope_behind(std::size_t node) const {
        return slope_of(meridian_.pieces()[node].tangent0);
    }

    [[nodiscard]] bool is_crease(double arc_mm) const {
        const std::span creases = meridian_.creases_mm();
        return std::binary_search(creases.begin(), creases.end(), arc_mm);
    }

    void list_stretches() {
        const std::span arcs = meridian_.nodes_mm();
        for (std::size_t i = 0; i + 1 < arcs.size(); ++i) {
            if (i > 0 && is_crease(arcs[i]) && turn_rad(slope_before(i), slope_behind(i)) < 0.0) {
                add_stretch({arcs[i], slope_before(i), true}, {arcs[i], slope_behind(i), true},
                            -turn_rad(slope_before(i), slope_behind(i)) * radius_mm_);
            }
            add_stretch({arcs[i], slope_behind(i)}, {arcs[i + 1], slope_before(i + 1)},
                        arcs[i + 1] - arcs[i]);
        }
    }

    void add_stretch(const Contact& from, const Contact& to, double way_mm) {
        const double places =
            std::max(kPlacesPerPiece, std::ceil(kPlacesPerRadius * way_mm / radius_mm_));
        stretches_.push_back({from, to, static_cast<int>(places)});
    }

    [[nodiscard]] Contact contact(const Stretch& stretch, double share) const {
        if (share <= 0.0 || share >= 1.0) {
            return share <= 0.0 ? stretch.from : stretch.to;
        }
        if (stretch.from.on_edge) {
            const double turn = turn_rad(stretch.from.slope_rad, stretch.to.slope_rad);
            return {stretch.from.arc_mm, stretch.from.slope_rad + share * turn, true};
        }
        const double arc = stretch.from.arc_mm + share * (stretch.to.arc_mm - stretch.from.arc_mm);
        return {arc, meridian_.at(arc).slope_rad};
    }

    [[nodiscard]] Vector2d ball_at(const Contact& contact) const {
        return point_of(meridian_.at(contact.arc_mm)) + radius_mm_ * normal_of(contact.slope_rad);
    }

    [[nodiscard]] bool touches(const Contact& contact) const {
        const Vector2d ball = ball_at(contact);
        return meridian_.foot(std::abs(ball.x()), ball.y()).distance_mm >=
               (1.0 - kTouch) * radius_mm_;
    }

    // The last place where the ball touches between one where it does and one where it does not.
    [[nodiscard]] Contact last_touch(const Stretch& stretch, double good, double bad) const {
        for (int i = 0; i < kHalvings; ++i) {
            const double middle = 0.5 * (good + bad);
            (touches(contact(stretch, middle)) ? good : bad) = middle;
        }
        return contact(stretch, good);
    }

    // In words why one cannot be filled up.
    std::string find_hollows() {
        Contact before = stretches_.front().from;
        if (!touches(before)) {
            return "the ball would leave the part by its lower end";
        }
        std::optional<Contact> hollow_from;
        for (const Stretch& stretch : stretches_) {
            for (int k = 0; k <= stretch.places; ++k) {
                const double share = static_cast<double>(k) / stretch.places;
                const double last = static_cast<double>(k - 1) / stretch.places;
                const Contact here = contact(stretch, share);
                const bool touching = touches(here);
                if (!touching && !hollow_from) {
                    hollow_from = k > 0 ? last_touch(stretch, last, share) : before;
                } else if (touching && hollow_from) {
                    const Contact to = k > 0 ? last_touch(stretch, share, last) : here;
                    const Vector2d left = ball_at(*hollow_from);
                    const Vector2d met = ball_at(to);
                    if ((met - left).norm() > kSameBall * radius_mm_) {
                        return "the ball cannot get into a hollow that it touches";
                    }
                    hollows_.push_back({*hollow_from, to, 0.5 * (left + met)});
                    hollow_from.reset();
                }
                before = here;
            }
        }
        return hollow_from ? "the ball would leave the part by its upper end" : std::string();
    }

    [[nodiscard]] Vector2d on_ball(const Hollow& hollow, double slope_rad) const {
        return hollow.ball_mm - radius_mm_ * normal_of(slope_rad);
    }

    void add_figures(const Hollow& hollow, RolledMeridian& rolled) const {
        const double first = hollow.from.slope_rad;
        const double turn = hollow.turn();
        rolled.area_mm2 +=
            2.0 * kPi * radius_mm_ *
            (hollow.ball_mm.x() * turn - radius_mm_ * (std::sin(first + turn) - std::sin(first)));
        const auto solid_mm3 = [](const auto& at) {
            double sum = 0.0;
            for (int i = 0; i < kChords; ++i) {
                sum += slice_mm3(at(static_cast<double>(i) / kChords),
                                 at(static_cast<double>(i + 1) / kChords));
            }
            return sum;
        };
        const double way_mm = hollow.to.arc_mm - hollow.from.arc_mm;
        rolled.volume_mm3 +=
            solid_mm3([&](double share) { return on_ball(hollow, first + share * turn); }) -
            solid_mm3([&](double share) {
                return point_of(meridian_.at(hollow.from.arc_mm + share * way_mm));
            });
    }

    // Of the body, with all that it says of itself.
    [[nodiscard]] MeridianNode node(std::size_t i) const {
        const std::span pieces = meridian_.pieces();
        const double arc = meridian_.nodes_mm()[i];
        const bool first = i == 0;
        const bool last = i == pieces.size();
        const Vector2d place = last ? pieces.back().to_mm : pieces[i].from_mm;
        MeridianNode node{place.x(), place.y()};
        node.straight = !last && pieces[i].straight;
        if (first || last) {
            node.slope_rad = first ? slope_behind(i) : slope_before(i);
        } else if (is_crease(arc)) {
            node.crease = true;
            node.slope_rad = slope_behind(i);
            node.slope_before_rad = slope_before(i);
        } else if (!pieces[i].straight && !pieces[i - 1].straight) {
            const double beside =
                kJumpShare * std::min(pieces[i].length_mm, pieces[i - 1].length_mm);
            const double before = meridian_.at(arc - beside).curvature_per_mm;
            const double behind = meridian_.at(arc + beside).curvature_per_mm;
            const double bend = std::max({std::abs(before), std::abs(behind), 1.0 / radius_mm_});
            if (std::abs(behind - before) > 10.0 * kJumpShare * bend) {
                node.joint = true;
                node.slope_rad = slope_behind(i);
            }
        }
        return node;
    }

    // Where the ball stops rolling, or goes on.
    [[nodiscard]] MeridianNode contact_node(const Hollow& hollow, bool first) const {
        const Contact& contact = first ? hollow.from : hollow.to;
        const Vector2d place = point_of(meridian_.at(contact.arc_mm));
        MeridianNode node{place.x(), place.y()};
        node.slope_rad = contact.slope_rad;
        const auto arcs = meridian_.nodes_mm();
        if (contact.on_edge) {
            const auto at = static_cast<std::size_t>(
                std::lower_bound(arcs.begin(), arcs.end(), contact.arc_mm) - arcs.begin());
            const double body_rad = first ? slope_before(at) : slope_behind(at);
            node.crease = std::abs(turn_rad(contact.slope_rad, body_rad)) > kTouch;
            node.slope_before_rad = first ? body_rad : contact.slope_rad;
            node.slope_rad = first ? contact.slope_rad : body_rad;
            node.straight = !first && meridian_.pieces()[at].straight;
        }
        if (!contact.on_edge && !first) {
            const auto above =
                std::upper_bound(arcs.begin() + 1, arcs.end() - 1, contact.arc_mm) - arcs.begin();
            node.straight = meridian_.pieces()[static_cast<std::size_t>(above) - 1].straight;
        }
        node.joint = !node.crease;
        return node;
    }

    // On an edge on which the ball has rested before one hollow ends and the next begins.
    void append_from(const MeridianNode& from, std::vector<MeridianNode>& nodes) const {
        const double off = nodes.empty() ? radius_mm_
                                         : std::hypot(from.radius_mm - nodes.back().radius_mm,
                                                      from.z_mm - nodes.back().z_mm);
        if (off > kTouch * radius_mm_) {
            nodes.push_back(from);
            return;
        }
        MeridianNode& edge = nodes.back();
        edge.slope_rad = from.slope_rad;
        edge.crease = std::abs(turn_rad(*edge.slope_before_rad, *from.slope_rad)) > kTouch;
        edge.joint = !edge.crease;
        edge.straight = false;
    }

    [[nodiscard]] Meridian filled_up() const {
        std::vector<MeridianNode> nodes;
        const std::span arcs = meridian_.nodes_mm();
        // A node beside a contact would make a piece of no length.
        const double beside_mm = kTouch * radius_mm_;
        std::size_t next = 0;
        for (const Hollow& hollow : hollows_) {
            for (; arcs[next] < hollow.from.arc_mm - beside_mm; ++next) {
                nodes.push_back(node(next));
            }
            append_from(contact_node(hollow, true), nodes);
            const double steps = std::max(kFewestSteps, std::ceil(hollow.turn() / kArcStep_rad));
            for (double k = 1.0; k < steps; k += 1.0) {
                const Vector2d place =
                    on_ball(hollow, hollow.from.slope_rad + k / steps * hollow.turn());
                nodes.push_back({place.x(), place.y()});
            }
            nodes.push_back(contact_node(hollow, false));
            while (next < arcs.size() && arcs[next] <= hollow.to.arc_mm + beside_mm) {
                ++next;
            }
        }
        for (; next < arcs.size(); ++next) {
            nodes.push_back(node(next));
        }
        return Meridian(std::move(nodes));
    }

    const Meridian& meridian_;
    double radius_mm_;
    std::vector<Stretch> stretches_;
    std::vector<Hollow> hollows_;
};

}  // namespace

RolledMeridian rolled_meridian(const Meridian& meridian, double radius_mm) {
    return Roller(meridian, radius_mm).run();
}

}  // namespace meshwind
