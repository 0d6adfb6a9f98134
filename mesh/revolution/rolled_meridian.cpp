#include "mesh/revolution/rolled_meridian.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "core/roots.h"
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

// A curvature that differs by more than the first share from one side of a node to the other, seen
// by the second share of the pieces beside it, jumps: along a spline it changes far less there.
constexpr double kJumpShare = 1e-3;
constexpr double kBesideShare = 1e-4;

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

// Between its ends the ball touches nothing.
struct Hollow {
    Contact from, to;
    Vector2d ball_mm;

    [[nodiscard]] double turn() const {
        const double turn = turn_rad(from.slope_rad, to.slope_rad);
        return turn < 0.0 ? turn + 2.0 * kPi : turn;
    }
};

// The ball, and the body that it rolls over.
struct Rolling {
    const Meridian& meridian;
    double radius_mm = 0.0;

    [[nodiscard]] double slope_before(std::size_t node) const {
        return slope_of(meridian.pieces()[node - 1].tangent1);
    }
    [[nodiscard]] double slope_behind(std::size_t node) const {
        return slope_of(meridian.pieces()[node].tangent0);
    }

    [[nodiscard]] bool is_crease(double arc_mm) const {
        const std::span creases = meridian.creases_mm();
        return std::binary_search(creases.begin(), creases.end(), arc_mm);
    }

    [[nodiscard]] Vector2d ball_at(const Contact& contact) const {
        return point_of(meridian.at(contact.arc_mm)) + radius_mm * normal_of(contact.slope_rad);
    }

    [[nodiscard]] bool touches(const Contact& contact) const {
        const Vector2d ball = ball_at(contact);
        return meridian.foot(std::abs(ball.x()), ball.y()).distance_mm >=
               (1.0 - kTouch) * radius_mm;
    }

    [[nodiscard]] Vector2d on_ball(const Hollow& hollow, double slope_rad) const {
        return hollow.ball_mm - radius_mm * normal_of(slope_rad);
    }
};

std::vector<Stretch> stretches_of(const Rolling& rolling) {
    std::vector<Stretch> stretches;
    const auto add = [&](const Contact& from, const Contact& to, double way_mm) {
        const double places =
            std::max(kPlacesPerPiece, std::ceil(kPlacesPerRadius * way_mm / rolling.radius_mm));
        stretches.push_back({from, to, static_cast<int>(places)});
    };
    const std::span arcs = rolling.meridian.nodes_mm();
    for (std::size_t i = 0; i + 1 < arcs.size(); ++i) {
        if (i > 0 && rolling.is_crease(arcs[i])) {
            const Contact before{arcs[i], rolling.slope_before(i), true};
            const Contact behind{arcs[i], rolling.slope_behind(i), true};
            const double turn = turn_rad(before.slope_rad, behind.slope_rad);
            if (turn < 0.0) {  // convex
                add(before, behind, -turn * rolling.radius_mm);
            }
        }
        add({arcs[i], rolling.slope_behind(i)}, {arcs[i + 1], rolling.slope_before(i + 1)},
            arcs[i + 1] - arcs[i]);
    }
    return stretches;
}

Contact contact_in(const Meridian& meridian, const Stretch& stretch, double share) {
    if (share <= 0.0 || share >= 1.0) {
        return share <= 0.0 ? stretch.from : stretch.to;
    }
    if (stretch.from.on_edge) {
        const double turn = turn_rad(stretch.from.slope_rad, stretch.to.slope_rad);
        return {stretch.from.arc_mm, stretch.from.slope_rad + share * turn, true};
    }
    const double arc = stretch.from.arc_mm + share * (stretch.to.arc_mm - stretch.from.arc_mm);
    return {arc, meridian.at(arc).slope_rad};
}

// The last place where the ball touches between one where it does and one where it does not.
Contact last_touch(const Rolling& rolling, const Stretch& stretch, const Changeover& touching) {
    const auto touches = [&](double share) {
        return rolling.touches(contact_in(rolling.meridian, stretch, share));
    };
    return contact_in(rolling.meridian, stretch, halve(touching, kHalvings, touches).holds);
}

struct Hollows {
    std::vector<Hollow> found;
    std::string why_not;  // in words, where one cannot be filled up
};

Hollows hollows_of(const Rolling& rolling) {
    const std::vector<Stretch> stretches = stretches_of(rolling);
    Contact before = stretches.front().from;
    if (!rolling.touches(before)) {
        return {{}, "the ball would leave the part by its lower end"};
    }
    Hollows hollows;
    std::optional<Contact> from;  // of the hollow that the ball is over
    for (const Stretch& stretch : stretches) {
        for (int k = 0; k <= stretch.places; ++k) {
            const double share = static_cast<double>(k) / stretch.places;
            const double last = static_cast<double>(k - 1) / stretch.places;
            const Contact here = contact_in(rolling.meridian, stretch, share);
            const bool touching = rolling.touches(here);
            if (!touching && !from) {
                from =
                    k > 0 ? last_touch(rolling, stretch, {.holds = last, .fails = share}) : before;
            } else if (touching && from) {
                const Contact to =
                    k > 0 ? last_touch(rolling, stretch, {.holds = share, .fails = last}) : here;
                const Vector2d left = rolling.ball_at(*from);
                const Vector2d met = rolling.ball_at(to);
                if ((met - left).norm() > kSameBall * rolling.radius_mm) {
                    return {{}, "the ball cannot get into a hollow that it touches"};
                }
                hollows.found.push_back({*from, to, 0.5 * (left + met)});
                from.reset();
            }
            before = here;
        }
    }
    if (from) {
        return {{}, "the ball would leave the part by its upper end"};
    }
    return hollows;
}

// Between the axis and a line, of which the places are asked for by share.
template <class At>
double solid_mm3(const At& at) {
    double sum = 0.0;
    for (int i = 0; i < kChords; ++i) {
        sum += slice_mm3(at(static_cast<double>(i) / kChords),
                         at(static_cast<double>(i + 1) / kChords));
    }
    return sum;
}

double filled_area_mm2(const Rolling& rolling, const Hollow& hollow) {
    const double first = hollow.from.slope_rad;
    const double turn = hollow.turn();
    return 2.0 * kPi * rolling.radius_mm *
           (hollow.ball_mm.x() * turn -
            rolling.radius_mm * (std::sin(first + turn) - std::sin(first)));
}

double filled_volume_mm3(const Rolling& rolling, const Hollow& hollow) {
    const double way_mm = hollow.to.arc_mm - hollow.from.arc_mm;
    return solid_mm3([&](double share) {
               return rolling.on_ball(hollow, hollow.from.slope_rad + share * hollow.turn());
           }) -
           solid_mm3([&](double share) {
               return point_of(rolling.meridian.at(hollow.from.arc_mm + share * way_mm));
           });
}

// Whether the curvature jumps between the two curved pieces at a node.
bool bend_jumps(const Rolling& rolling, std::size_t node) {
    const std::span pieces = rolling.meridian.pieces();
    const double arc = rolling.meridian.nodes_mm()[node];
    const double beside_mm =
        kBesideShare * std::min(pieces[node].length_mm, pieces[node - 1].length_mm);
    const double before = rolling.meridian.at(arc - beside_mm).curvature_per_mm;
    const double behind = rolling.meridian.at(arc + beside_mm).curvature_per_mm;
    const double bend = std::max({std::abs(before), std::abs(behind), 1.0 / rolling.radius_mm});
    return std::abs(behind - before) > kJumpShare * bend;
}

// Of the body, with all that it says of itself.
MeridianNode body_node(const Rolling& rolling, std::size_t i) {
    const std::span pieces = rolling.meridian.pieces();
    const bool first = i == 0;
    const bool last = i == pieces.size();
    const Vector2d place = last ? pieces.back().to_mm : pieces[i].from_mm;
    MeridianNode node{place.x(), place.y()};
    node.straight = !last && pieces[i].straight;
    if (first || last) {
        node.slope_rad = first ? rolling.slope_behind(i) : rolling.slope_before(i);
    } else if (rolling.is_crease(rolling.meridian.nodes_mm()[i])) {
        node.crease = true;
        node.slope_rad = rolling.slope_behind(i);
        node.slope_before_rad = rolling.slope_before(i);
    } else if (!pieces[i].straight && !pieces[i - 1].straight && bend_jumps(rolling, i)) {
        node.joint = true;
        node.slope_rad = rolling.slope_behind(i);
    }
    return node;
}

// Where the ball stops rolling, or goes on.
MeridianNode contact_node(const Rolling& rolling, const Contact& contact, bool stops) {
    const Vector2d place = point_of(rolling.meridian.at(contact.arc_mm));
    MeridianNode node{place.x(), place.y()};
    node.slope_rad = contact.slope_rad;
    const std::span arcs = rolling.meridian.nodes_mm();
    const std::span pieces = rolling.meridian.pieces();
    if (contact.on_edge) {
        const auto at = static_cast<std::size_t>(
            std::lower_bound(arcs.begin(), arcs.end(), contact.arc_mm) - arcs.begin());
        const double body_rad = stops ? rolling.slope_before(at) : rolling.slope_behind(at);
        node.crease = std::abs(turn_rad(contact.slope_rad, body_rad)) > kTouch;
        node.slope_before_rad = stops ? body_rad : contact.slope_rad;
        node.slope_rad = stops ? contact.slope_rad : body_rad;
        node.straight = !stops && pieces[at].straight;
    } else if (!stops) {
        const auto above =
            std::upper_bound(arcs.begin() + 1, arcs.end() - 1, contact.arc_mm) - arcs.begin();
        node.straight = pieces[static_cast<std::size_t>(above) - 1].straight;
    }
    node.joint = !node.crease;
    return node;
}

// One node with the last where both are on an edge, on which the ball rests between two hollows.
void append_stop(const MeridianNode& stop, double same_mm, std::vector<MeridianNode>& nodes) {
    const bool same = !nodes.empty() && std::hypot(stop.radius_mm - nodes.back().radius_mm,
                                                   stop.z_mm - nodes.back().z_mm) <= same_mm;
    if (!same) {
        nodes.push_back(stop);
        return;
    }
    MeridianNode& edge = nodes.back();
    edge.slope_rad = stop.slope_rad;
    edge.crease = std::abs(turn_rad(*edge.slope_before_rad, *stop.slope_rad)) > kTouch;
    edge.joint = !edge.crease;
    edge.straight = false;
}

Meridian filled_up(const Rolling& rolling, std::span<const Hollow> hollows) {
    std::vector<MeridianNode> nodes;
    const std::span arcs = rolling.meridian.nodes_mm();
    // A node beside a contact would make a piece of no length.
    const double beside_mm = kTouch * rolling.radius_mm;
    std::size_t next = 0;
    for (const Hollow& hollow : hollows) {
        for (; arcs[next] < hollow.from.arc_mm - beside_mm; ++next) {
            nodes.push_back(body_node(rolling, next));
        }
        append_stop(contact_node(rolling, hollow.from, true), beside_mm, nodes);
        const double steps = std::max(kFewestSteps, std::ceil(hollow.turn() / kArcStep_rad));
        for (double k = 1.0; k < steps; k += 1.0) {
            const Vector2d place =
                rolling.on_ball(hollow, hollow.from.slope_rad + k / steps * hollow.turn());
            nodes.push_back({place.x(), place.y()});
        }
        nodes.push_back(contact_node(rolling, hollow.to, false));
        while (next < arcs.size() && arcs[next] <= hollow.to.arc_mm + beside_mm) {
            ++next;
        }
    }
    for (; next < arcs.size(); ++next) {
        nodes.push_back(body_node(rolling, next));
    }
    return Meridian(std::move(nodes));
}

}  // namespace

RolledMeridian rolled_meridian(const Meridian& meridian, double radius_mm) {
    const Rolling rolling{meridian, radius_mm};
    Hollows hollows = hollows_of(rolling);
    RolledMeridian rolled;
    rolled.why_not = std::move(hollows.why_not);
    for (const Hollow& hollow : hollows.found) {
        rolled.area_mm2 += filled_area_mm2(rolling, hollow);
        rolled.volume_mm3 += filled_volume_mm3(rolling, hollow);
    }
    if (!hollows.found.empty()) {
        rolled.meridian.emplace(filled_up(rolling, hollows.found));
    }
    return rolled;
}

}  // namespace meshwind
