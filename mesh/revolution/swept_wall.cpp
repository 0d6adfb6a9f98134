#include "mesh/revolution/swept_wall.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "core/units.h"
#include "mesh/even/even_mesh.h"

namespace meshwind {
namespace {

// Rows of triangles over a stretch that is curved, vertices of the narrowest ring.
constexpr double kRows = 3.0;
constexpr double kFewest = 8.0;

// Edges about the axis are no shorter than this share of the part's size.
constexpr double kShortest = 1e-3;

// Places per piece of the meridian at which edges are wanted.
constexpr int kPlaces = 16;

// A ring narrower than this share of the part's size is a pole.
constexpr double kPole = 1e-9;

struct Place {
    double arc_mm = 0.0;
    double along_mm = 0.0;  // length of edges along the meridian,
    double about_mm = 0.0;  // and about the axis
    double steps = 0.0;     // of edges along the meridian, from its start to here
};

// Arc lengths of ends, creases and joints.
std::vector<double> bounds_of(const Meridian& meridian) {
    const std::span pieces = meridian.pieces();
    const std::span creases = meridian.creases_mm();
    std::vector<double> bounds;
    for (std::size_t i = 0; i <= pieces.size(); ++i) {
        const double arc = meridian.nodes_mm()[i];
        if (i == 0 || i == pieces.size() || pieces[i].straight || pieces[i - 1].straight ||
            std::find(creases.begin(), creases.end(), arc) != creases.end()) {
            bounds.push_back(arc);
        }
    }
    return bounds;
}

// Edges that the surface wants between two nodes.
void append_places(const Meridian& meridian, std::size_t piece, double stretch_mm, double size_mm,
                   std::vector<Place>& places) {
    const EvenMeshOptions options = even_options(size_mm);
    const bool straight = meridian.pieces()[piece].straight;
    const double from = meridian.nodes_mm()[piece];
    const double length = meridian.nodes_mm()[piece + 1] - from;
    for (int k = 0; k <= kPlaces; ++k) {
        // At a node the curvature may be that of the other piece: a little within.
        constexpr double kWithin = 1e-6;
        const double share = std::clamp(static_cast<double>(k) / kPlaces, kWithin, 1.0 - kWithin);
        const MeridianPlace at = meridian.at(from + share * length);
        const double about =
            std::abs(std::cos(at.slope_rad)) / std::max(at.radius_mm, options.least_mm);
        const double along = straight ? 0.0 : std::abs(at.curvature_per_mm);
        const double flattest = 1.0 / size_mm;  // a disc bends neither way
        const double bend = std::max({about, along, flattest});
        const double least =
            std::max(std::min(options.least_mm, options.most_turn / bend), kShortest * size_mm);
        const double edge = std::clamp(options.turn_rad / bend, least, options.longest_mm);
        places.push_back(
            {from + share * length, straight ? edge : std::min(edge, stretch_mm / kRows), edge});
    }
}

void grow_slowly(std::vector<Place>& places, double grading) {
    const auto bound = [&](Place& place, const Place& beside) {
        const double more = grading * std::abs(place.arc_mm - beside.arc_mm);
        place.along_mm = std::min(place.along_mm, beside.along_mm + more);
        place.about_mm = std::min(place.about_mm, beside.about_mm + more);
    };
    for (std::size_t i = 1; i < places.size(); ++i) {
        bound(places[i], places[i - 1]);
    }
    for (std::size_t i = places.size() - 1; i > 0; --i) {
        bound(places[i - 1], places[i]);
    }
}

// Edges between two places, along which their length grows steadily.
double steps_between(const Place& a, const Place& b) {
    const double way = b.arc_mm - a.arc_mm;
    const double growth = std::log(b.along_mm / a.along_mm);
    return std::abs(growth) > 1e-9 ? way * growth / (b.along_mm - a.along_mm) : way / a.along_mm;
}

// Where so many steps are done.
Place place_at(const std::vector<Place>& places, double steps) {
    const auto above =
        std::lower_bound(places.begin() + 1, places.end() - 1, steps,
                         [](const Place& place, double value) { return place.steps < value; });
    const Place& b = *above;
    const Place& a = *(above - 1);
    const double whole = b.steps - a.steps;
    const double share = whole > 0.0 ? std::clamp((steps - a.steps) / whole, 0.0, 1.0) : 0.0;
    const double along = a.along_mm * std::pow(b.along_mm / a.along_mm, share);
    const double grown = b.along_mm - a.along_mm;
    const double part = std::abs(grown) > 1e-9 * a.along_mm ? (along - a.along_mm) / grown : share;
    return {a.arc_mm + part * (b.arc_mm - a.arc_mm), along,
            a.about_mm + part * (b.about_mm - a.about_mm), steps};
}

// Rings from the first end to the second; none where they would be too many.
std::vector<Place> rings_of(const Meridian& meridian, double size_mm) {
    const std::vector<double> bounds = bounds_of(meridian);
    std::vector<Place> places;
    std::size_t stretch = 0;
    for (std::size_t i = 0; i < meridian.pieces().size(); ++i) {
        // Nodes may coincide to rounding.
        while (stretch + 2 < bounds.size() && bounds[stretch + 1] <= meridian.nodes_mm()[i]) {
            ++stretch;
        }
        append_places(meridian, i, bounds[stretch + 1] - bounds[stretch], size_mm, places);
    }
    grow_slowly(places, even_options(size_mm).grading);
    for (std::size_t i = 1; i < places.size(); ++i) {
        places[i].steps = places[i - 1].steps + steps_between(places[i - 1], places[i]);
    }
    const auto steps_to = [&](double arc) {
        const auto at =
            std::lower_bound(places.begin(), places.end() - 1, arc,
                             [](const Place& place, double value) { return place.arc_mm < value; });
        return at->steps;
    };
    std::vector<Place> rings;
    if (!(places.back().steps * kFewest <= kMaxEvenTriangles)) {
        return rings;
    }
    for (std::size_t b = 0; b + 1 < bounds.size(); ++b) {
        const double from = steps_to(bounds[b]);
        const double steps = std::max(steps_to(bounds[b + 1]) - from, 0.0);
        const double count = std::max(1.0, std::ceil(steps));
        for (double k = 0.0; k < count; k += 1.0) {
            rings.push_back(place_at(places, from + k / count * steps));
        }
        rings[rings.size() - static_cast<std::size_t>(count)].arc_mm = bounds[b];
    }
    rings.push_back(places.back());
    rings.back().arc_mm = bounds.back();
    return rings;
}

// Vertices of a ring in the mesh.
struct Ring {
    std::int32_t first = 0;
    std::int32_t count = 0;  // 1: a pole
    double turn_rad = 0.0;   // at which the first one lies

    [[nodiscard]] std::int32_t vertex(std::int32_t i) const { return first + i % count; }
    [[nodiscard]] double angle_rad(std::int32_t i) const {
        return turn_rad + 2.0 * kPi * i / count;
    }
};

class Sweeper {
public:
    Sweeper(const Meridian& meridian, double size_mm) : meridian_(meridian), size_mm_(size_mm) {}

    LabelledMesh run() {
        const std::span creases = meridian_.creases_mm();
        std::optional<Ring> before;
        std::size_t crossed = 0;
        bool on_crease = false;
        for (const Place& place : rings_of(meridian_, size_mm_)) {
            const Ring ring = add_ring(place);
            const bool crease = crossed < creases.size() && place.arc_mm >= creases[crossed];
            if (before) {
                stitch(*before, ring, on_crease, crease, static_cast<std::int32_t>(crossed));
            }
            crossed += crease ? 1 : 0;
            on_crease = crease;
            before = ring;
            if (static_cast<double>(mesh_.soup.faces.size()) > kMaxEvenTriangles) {
                return {};
            }
        }
        return std::move(mesh_);
    }

private:
    Ring add_ring(const Place& place) {
        const MeridianPlace at = meridian_.at(place.arc_mm);
        Ring ring;
        ring.first = static_cast<std::int32_t>(mesh_.soup.points_mm.size());
        const bool pole = !(at.radius_mm > kPole * size_mm_);
        ring.count = pole ? 1
                          : static_cast<std::int32_t>(std::max(
                                kFewest, std::ceil(2.0 * kPi * at.radius_mm / place.about_mm)));
        // Between the vertices of the ring before.
        ring.turn_rad = ++rings_ % 2 == 0 ? kPi / ring.count : 0.0;
        for (std::int32_t i = 0; i < ring.count; ++i) {
            const double phi = ring.angle_rad(i);
            const double radius = pole ? 0.0 : at.radius_mm;
            mesh_.soup.points_mm.emplace_back(radius * std::cos(phi), radius * std::sin(phi),
                                              at.z_mm);
        }
        return ring;
    }

    // The next triangle is the one that ends at the smaller angle.
    void stitch(const Ring& a, const Ring& b, bool crease_a, bool crease_b, std::int32_t section) {
        std::int32_t i = 0;
        std::int32_t j = 0;
        const std::int32_t all_a = a.count > 1 ? a.count : 0;
        const std::int32_t all_b = b.count > 1 ? b.count : 0;
        while (i < all_a || j < all_b) {
            if (j == all_b || (i < all_a && a.angle_rad(i + 1) < b.angle_rad(j + 1))) {
                add({a.vertex(i), a.vertex(i + 1), b.vertex(j)}, {crease_a, false, false}, section);
                ++i;
            } else {
                add({a.vertex(i), b.vertex(j + 1), b.vertex(j)}, {false, crease_b, false}, section);
                ++j;
            }
        }
    }

    void add(const std::array<std::int32_t, 3>& face, const std::array<bool, 3>& crease,
             std::int32_t section) {
        mesh_.soup.faces.push_back(face);
        mesh_.region.push_back(section);
        mesh_.feature.push_back({static_cast<std::uint8_t>(crease[0]),
                                 static_cast<std::uint8_t>(crease[1]),
                                 static_cast<std::uint8_t>(crease[2])});
    }

    const Meridian& meridian_;
    double size_mm_;
    LabelledMesh mesh_;
    int rings_ = 0;
};

}  // namespace

LabelledMesh swept_wall(const Meridian& meridian, double size_mm) {
    return Sweeper(meridian, size_mm).run();
}

}  // namespace meshwind
