#include "mesh/even/enclosed_places.h"

#include <algorithm>
#include <array>
#include <set>
#include <span>
#include <utility>

#include "core/index.h"
#include "mesh/edge_table.h"

namespace meshwind {
namespace {

// The wall's faces split into parts that hang together, each marked or not.
struct Places {
    std::vector<std::int32_t> place;  // per face of the wall
    std::vector<char> marked;         // per place
    std::vector<char> at_end;         // per place: the wall ends there
    std::vector<double> area_mm2;     // per place
    std::vector<std::set<std::int32_t>> beside;
};

Places places_of(const TriangleSoup& wall, std::span<const std::array<std::int32_t, 3>> neighbours,
                 const std::vector<char>& marked) {
    Places places;
    places.place.assign(marked.size(), -1);
    std::vector<std::size_t> stack;
    for (std::size_t seed = 0; seed < marked.size(); ++seed) {
        if (places.place[seed] >= 0) {
            continue;
        }
        const auto id = static_cast<std::int32_t>(places.marked.size());
        places.marked.push_back(marked[seed]);
        places.at_end.push_back(0);
        places.area_mm2.push_back(0.0);
        places.beside.emplace_back();
        places.place[seed] = id;
        stack.assign(1, seed);
        while (!stack.empty()) {
            const std::size_t f = stack.back();
            stack.pop_back();
            places.area_mm2.back() += area_mm2(wall.points_mm, wall.faces[f]);
            for (const std::int32_t g : neighbours[f]) {
                if (g < 0) {
                    places.at_end.back() = 1;
                } else if (marked[at(g)] == marked[seed] && places.place[at(g)] < 0) {
                    places.place[at(g)] = id;
                    stack.push_back(at(g));
                }
            }
        }
    }
    for (std::size_t f = 0; f < marked.size(); ++f) {
        for (const std::int32_t g : neighbours[f]) {
            if (g >= 0 && places.place[at(g)] != places.place[f]) {
                places.beside[at(places.place[f])].insert(places.place[at(g)]);
            }
        }
    }
    return places;
}

// The place with all that it cuts off from the wall's largest part; nothing where that, or the
// place itself, reaches an end or takes too much of the wall.
std::set<std::int32_t> enclosed_by(const Places& places, std::int32_t place, double most_mm2) {
    std::vector<char> reached(places.marked.size(), 0);
    reached[at(place)] = 1;
    std::vector<std::vector<std::int32_t>> parts;
    std::size_t largest = 0;
    double largest_mm2 = 0.0;
    for (const std::int32_t seed : places.beside[at(place)]) {
        if (reached[at(seed)] != 0) {
            continue;
        }
        reached[at(seed)] = 1;
        std::vector<std::int32_t> part{seed};
        double area = 0.0;
        for (std::size_t i = 0; i < part.size(); ++i) {
            area += places.area_mm2[at(part[i])];
            for (const std::int32_t other : places.beside[at(part[i])]) {
                if (reached[at(other)] == 0) {
                    reached[at(other)] = 1;
                    part.push_back(other);
                }
            }
        }
        if (area > largest_mm2) {
            largest_mm2 = area;
            largest = parts.size();
        }
        parts.push_back(std::move(part));
    }
    std::set<std::int32_t> detail{place};
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (i != largest) {
            detail.insert(parts[i].begin(), parts[i].end());
        }
    }
    double area = 0.0;
    for (const std::int32_t id : detail) {
        area += places.area_mm2[at(id)];
        if (places.at_end[at(id)] != 0) {
            return {};
        }
    }
    return area <= most_mm2 ? detail : std::set<std::int32_t>{};
}

}  // namespace

std::vector<std::vector<std::int32_t>> enclosed_places(const TriangleSoup& wall,
                                                       const std::vector<char>& marked,
                                                       double most_share, std::size_t most_parts) {
    const Places places = places_of(wall, face_neighbours(wall.faces), marked);
    if (places.marked.size() > most_parts) {
        return {};
    }
    std::vector<std::vector<std::int32_t>> faces(places.marked.size());
    for (std::size_t f = 0; f < places.place.size(); ++f) {
        faces[at(places.place[f])].push_back(static_cast<std::int32_t>(f));
    }
    const double most_mm2 = most_share * area_mm2(wall);
    std::vector<std::vector<std::int32_t>> found;
    for (std::size_t id = 0; id < places.marked.size(); ++id) {
        if (places.marked[id] == 0 || places.at_end[id] != 0 || places.area_mm2[id] > most_mm2) {
            continue;
        }
        std::vector<std::int32_t> all;
        for (const std::int32_t one :
             enclosed_by(places, static_cast<std::int32_t>(id), most_mm2)) {
            all.insert(all.end(), faces[at(one)].begin(), faces[at(one)].end());
        }
        if (!all.empty()) {
            std::sort(all.begin(), all.end());
            found.push_back(std::move(all));
        }
    }
    return found;
}

}  // namespace meshwind
