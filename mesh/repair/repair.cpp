#include "mesh/repair/repair.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <span>
#include <tuple>

#include <Eigen/Geometry>

#include "core/error.h"
#include "core/index.h"
#include "core/interrupt.h"
#include "core/text/text_number.h"
#include "mesh/edge_table.h"
#include "mesh/repair/degenerate_faces.h"
#include "mesh/repair/self_intersections.h"
#include "mesh/visibility.h"

namespace meshwind {
namespace {

using Faces = std::vector<std::array<std::int32_t, 3>>;

int drop_repeated_indices(Faces& faces) {
    return static_cast<int>(std::erase_if(faces, [](const std::array<std::int32_t, 3>& f) {
        return f[0] == f[1] || f[1] == f[2] || f[2] == f[0];
    }));
}

// Keeps the first of the faces with the same three vertices, whatever their turn.
int drop_duplicates(Faces& faces) {
    std::vector<std::array<std::int32_t, 4>> keys(faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f) {
        std::array<std::int32_t, 3> sorted = faces[f];
        std::sort(sorted.begin(), sorted.end());
        keys[f] = {sorted[0], sorted[1], sorted[2], static_cast<std::int32_t>(f)};
    }
    std::sort(keys.begin(), keys.end());
    std::vector<char> dropped(faces.size(), 0);
    for (std::size_t i = 1; i < keys.size(); ++i) {
        if (std::equal(keys[i].begin(), keys[i].begin() + 3, keys[i - 1].begin())) {
            dropped[at(keys[i][3])] = 1;
        }
    }
    Faces kept;
    kept.reserve(faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f) {
        if (dropped[f] == 0) {
            kept.push_back(faces[f]);
        }
    }
    const auto count = static_cast<int>(faces.size() - kept.size());
    faces = std::move(kept);
    return count;
}

// Two faces joined across an edge.
struct Joint {
    EdgeUse a;
    EdgeUse b;
};

double angle_around(const TriangleSoup& soup, const EdgeUse& use) {
    const Eigen::Vector3d& origin = soup.points_mm[at(use.low)];
    const Eigen::Vector3d along = (soup.points_mm[at(use.high)] - origin).normalized();
    const Eigen::Vector3d side = along.unitOrthogonal();
    const std::int32_t third = soup.faces[at(use.face)][static_cast<std::size_t>(use.edge + 2) % 3];
    const Eigen::Vector3d out = soup.points_mm[at(third)] - origin;
    return std::atan2(out.dot(along.cross(side)), out.dot(side));
}

// At an edge where touching solids meet, the material of each lies between an ascending and the
// next descending face; any other arrangement is left cut.
void join_around(const TriangleSoup& soup, std::span<const EdgeUse> uses,
                 std::vector<Joint>& joints) {
    std::vector<std::pair<double, EdgeUse>> ring;
    for (const EdgeUse& use : uses) {
        ring.emplace_back(angle_around(soup, use), use);
    }
    std::stable_sort(ring.begin(), ring.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    const std::size_t n = ring.size();
    for (std::size_t i = 0; i < n; ++i) {
        if (n % 2 == 1 || ring[i].second.ascending == ring[(i + 1) % n].second.ascending) {
            return;
        }
    }
    // Seen along the edge from high to low, an ascending face has its normal on the side of larger
    // angles, so its material lies toward smaller ones.
    for (std::size_t i = 0; i < n; ++i) {
        if (ring[i].second.ascending == 1) {
            joints.push_back({ring[(i + n - 1) % n].second, ring[i].second});
        }
    }
}

std::vector<Joint> joints_of(const TriangleSoup& soup) {
    const std::vector<EdgeUse> uses = edge_uses(soup.faces);
    std::vector<Joint> joints;
    joints.reserve(uses.size() / 2);
    for (std::size_t first = 0, last = 0; first < uses.size(); first = last) {
        while (last < uses.size() && uses[last].low == uses[first].low &&
               uses[last].high == uses[first].high) {
            ++last;
        }
        if (last - first == 2) {
            joints.push_back({uses[first], uses[first + 1]});
        } else if (last - first > 2) {
            join_around(soup, std::span(uses).subspan(first, last - first), joints);
        }
    }
    return joints;
}

// Neighbour and whether it must be turned over to agree, per face and edge.
struct Links {
    std::vector<std::array<std::int32_t, 3>> face;
    std::vector<std::array<std::int8_t, 3>> opposed;

    Links(std::size_t faces, const std::vector<Joint>& joints)
        : face(faces, {-1, -1, -1}), opposed(faces, {0, 0, 0}) {
        for (const auto& [a, b] : joints) {
            const auto same = static_cast<std::int8_t>(a.ascending == b.ascending);
            face[at(a.face)][static_cast<std::size_t>(a.edge)] = b.face;
            face[at(b.face)][static_cast<std::size_t>(b.edge)] = a.face;
            opposed[at(a.face)][static_cast<std::size_t>(a.edge)] = same;
            opposed[at(b.face)][static_cast<std::size_t>(b.edge)] = same;
        }
    }
};

struct Components {
    std::vector<std::int32_t> of_face;
    std::vector<std::vector<std::int32_t>> faces;
};

[[noreturn]] void throw_not_orientable(const TriangleSoup& soup, std::int32_t face,
                                       const std::string& name) {
    const Eigen::Vector3d& p = soup.points_mm[at(soup.faces[at(face)][0])];
    throw InputError("mesh.not_orientable", name,
                     "the surface near (" + fixed(p.x(), 3) + ", " + fixed(p.y(), 3) + ", " +
                         fixed(p.z(), 3) +
                         ") has only one side, like a Moebius band; cut it there or mend the part");
}

// Walks each component, deciding per face whether it turns over; the majority keeps its turn.
Components orient(TriangleSoup& soup, const Links& links, const std::string& name,
                  std::vector<std::int8_t>& turned) {
    Components result;
    result.of_face.assign(soup.faces.size(), -1);
    for (std::size_t seed = 0; seed < soup.faces.size(); ++seed) {
        if (result.of_face[seed] >= 0) {
            continue;
        }
        const auto id = static_cast<std::int32_t>(result.faces.size());
        std::vector<std::int32_t> stack{static_cast<std::int32_t>(seed)};
        std::size_t flips = 0;
        result.of_face[seed] = id;
        for (std::size_t next = 0; next < stack.size(); ++next) {
            const std::size_t f = at(stack[next]);
            flips += turned[f] != 0 ? 1 : 0;
            for (std::size_t e = 0; e < 3; ++e) {
                const std::int32_t g = links.face[f][e];
                if (g < 0) {
                    continue;
                }
                const auto wanted = static_cast<std::int8_t>(turned[f] ^ links.opposed[f][e]);
                if (result.of_face[at(g)] < 0) {
                    result.of_face[at(g)] = id;
                    turned[at(g)] = wanted;
                    stack.push_back(g);
                } else if (turned[at(g)] != wanted) {
                    throw_not_orientable(soup, g, name);
                }
            }
        }
        if (2 * flips > stack.size()) {
            for (const std::int32_t f : stack) {
                turned[at(f)] ^= 1;
            }
        }
        result.faces.push_back(std::move(stack));
    }
    for (std::size_t f = 0; f < soup.faces.size(); ++f) {
        if (turned[f] != 0) {
            std::swap(soup.faces[f][1], soup.faces[f][2]);
        }
    }
    return result;
}

// One vertex per fan: corners stay together only where faces are joined.
int split_fans(TriangleSoup& soup, const std::vector<Joint>& joints) {
    std::vector<std::int32_t> parent(3 * soup.faces.size());
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](std::int32_t c) {
        while (parent[at(c)] != c) {
            parent[at(c)] = parent[at(parent[at(c)])];
            c = parent[at(c)];
        }
        return c;
    };
    const auto corner_at = [&](std::int32_t face, std::int32_t vertex) {
        const auto& f = soup.faces[at(face)];
        return 3 * face + (f[0] == vertex ? 0 : f[1] == vertex ? 1 : 2);
    };
    for (const auto& [a, b] : joints) {
        for (const std::int32_t v : {a.low, a.high}) {
            const std::int32_t one = root(corner_at(a.face, v));
            const std::int32_t two = root(corner_at(b.face, v));
            parent[at(std::max(one, two))] = std::min(one, two);
        }
    }
    std::vector<std::int32_t> copy_of_root(parent.size(), -1);
    std::vector<char> taken(soup.points_mm.size(), 0);
    int splits = 0;
    for (std::int32_t c = 0; c < static_cast<std::int32_t>(parent.size()); ++c) {
        std::int32_t& v = soup.faces[at(c / 3)][at(c % 3)];
        std::int32_t& copy = copy_of_root[at(root(c))];
        if (copy < 0) {
            copy = v;
            if (taken[at(v)] != 0) {
                copy = static_cast<std::int32_t>(soup.points_mm.size());
                soup.points_mm.push_back(Eigen::Vector3d(soup.points_mm[at(v)]));
                ++splits;
            } else {
                taken[at(v)] = 1;
            }
        }
        v = copy;
    }
    return splits;
}

// Two sheets may touch along an edge whose ends they share: then two pairs of faces still use the
// same two vertices. Each pair gets a middle point of its own. Returns false when there was none to
// part.
bool part_doubled_edges(TriangleSoup& soup, const std::vector<Joint>& joints) {
    std::vector<std::array<std::int32_t, 3>> partner(soup.faces.size(), {-1, -1, -1});
    for (const auto& [a, b] : joints) {
        partner[at(a.face)][at(a.edge)] = b.face;
        partner[at(b.face)][at(b.edge)] = a.face;
    }
    const std::vector<EdgeUse> uses = edge_uses(soup.faces);
    std::vector<char> touched(soup.faces.size(), 0);
    bool found = false;
    for (std::size_t first = 0, last = 0; first < uses.size(); first = last) {
        while (last < uses.size() && uses[last].low == uses[first].low &&
               uses[last].high == uses[first].high) {
            ++last;
        }
        const std::span<const EdgeUse> group = std::span(uses).subspan(first, last - first);
        // A face split a moment ago has to wait for the next round.
        if (group.size() < 3 || std::any_of(group.begin(), group.end(), [&](const EdgeUse& use) {
                return touched[at(use.face)] != 0;
            })) {
            continue;
        }
        found = true;
        const Eigen::Vector3d middle =
            0.5 * (soup.points_mm[at(group[0].low)] + soup.points_mm[at(group[0].high)]);
        std::map<std::int32_t, std::int32_t> middle_of_pair;
        for (const EdgeUse& use : group) {
            const std::int32_t other = partner[at(use.face)][at(use.edge)];
            const auto [entry, is_new] =
                middle_of_pair.try_emplace(other < 0 ? use.face : std::min(use.face, other),
                                           static_cast<std::int32_t>(soup.points_mm.size()));
            if (is_new) {
                soup.points_mm.push_back(middle);
            }
            std::array<std::int32_t, 3> rest = soup.faces[at(use.face)];
            rest[at(use.edge)] = entry->second;
            soup.faces[at(use.face)][at((use.edge + 1) % 3)] = entry->second;
            soup.faces.push_back(rest);
            touched[at(use.face)] = 1;
        }
    }
    return found;
}

Eigen::Vector3d area_normal(const TriangleSoup& soup, std::int32_t f) {
    const auto& [a, b, c] = soup.faces[at(f)];
    const Eigen::Vector3d& origin = soup.points_mm[at(a)];
    return 0.5 * (soup.points_mm[at(b)] - origin).cross(soup.points_mm[at(c)] - origin);
}

double signed_volume(const TriangleSoup& soup, const std::vector<std::int32_t>& faces) {
    const Eigen::Vector3d origin = soup.points_mm[at(soup.faces[at(faces[0])][0])];
    double volume = 0.0;
    for (const std::int32_t f : faces) {
        volume += area_normal(soup, f).dot(soup.points_mm[at(soup.faces[at(f)][0])] - origin) / 3.0;
    }
    return volume;
}

// Positive when the fronts of the faces see more of the outside than their backs.
double front_view(const TriangleSoup& soup, const std::vector<std::int32_t>& faces,
                  const Visibility& visibility) {
    constexpr std::size_t kLooks = 256;  // faces asked per component, enough to tell the sides
    const std::size_t step = std::max<std::size_t>(1, faces.size() / kLooks);
    double view = 0.0;
    for (std::size_t i = 0; i < faces.size(); i += step) {
        const Eigen::Vector3d area = area_normal(soup, faces[i]);
        const double size = area.norm();
        if (size > 0.0) {
            const auto& [a, b, c] = soup.faces[at(faces[i])];
            const Eigen::Vector3d middle =
                (soup.points_mm[at(a)] + soup.points_mm[at(b)] + soup.points_mm[at(c)]) / 3.0;
            view += size * (visibility.escape_fraction(middle, area / size) -
                            visibility.escape_fraction(middle, -area / size));
        }
    }
    return view;
}

void turn_outward(TriangleSoup& soup, const Components& components, const Links& links,
                  std::vector<std::int8_t>& turned) {
    std::unique_ptr<Visibility> visibility;
    for (const std::vector<std::int32_t>& faces : components.faces) {
        const bool closed = std::all_of(faces.begin(), faces.end(), [&](std::int32_t f) {
            return *std::min_element(links.face[at(f)].begin(), links.face[at(f)].end()) >= 0;
        });
        if (!closed && !visibility) {
            visibility = std::make_unique<Visibility>(soup);
        }
        if ((closed ? signed_volume(soup, faces) : front_view(soup, faces, *visibility)) < 0.0) {
            for (const std::int32_t f : faces) {
                std::swap(soup.faces[at(f)][1], soup.faces[at(f)][2]);
                turned[at(f)] ^= 1;
            }
        }
    }
}

void require_faces(const TriangleSoup& soup, const std::string& name) {
    if (soup.faces.empty()) {
        throw InputError("mesh.no_triangles_left", name,
                         "all triangles are without area, export the part's surface again");
    }
}

void drop_unused_points(TriangleSoup& soup) {
    std::vector<std::int32_t> renumbered(soup.points_mm.size(), -1);
    std::vector<Eigen::Vector3d> points;
    for (auto& face : soup.faces) {
        for (std::int32_t& v : face) {
            if (renumbered[at(v)] < 0) {
                renumbered[at(v)] = static_cast<std::int32_t>(points.size());
                points.push_back(soup.points_mm[at(v)]);
            }
            v = renumbered[at(v)];
        }
    }
    soup.points_mm = std::move(points);
}

}  // namespace

int split_vertex_fans(TriangleSoup& soup) {
    return split_fans(soup, joints_of(soup));
}

void repair(TriangleSoup& soup, const std::string& name, RepairReport& report) {
    report.degenerate_faces_removed += drop_repeated_indices(soup.faces);
    report.duplicate_faces_removed += drop_duplicates(soup.faces);
    require_faces(soup, name);
    const double diagonal = diagonal_mm(soup);
    check_interrupt();
    std::vector<Joint> joints = joints_of(soup);
    check_interrupt();
    std::vector<std::int8_t> turned(soup.faces.size(), 0);
    Components components = orient(soup, Links(soup.faces.size(), joints), name, turned);
    report.non_manifold_vertices_split += split_fans(soup, joints);
    for (bool parted = false; part_doubled_edges(soup, parted ? joints_of(soup) : joints);) {
        parted = true;
        check_interrupt();
    }
    if (turned.size() < soup.faces.size()) {
        joints = joints_of(soup);
        turned.resize(soup.faces.size(), 0);
        std::vector<std::int8_t> unturned(soup.faces.size(), 0);
        components = orient(soup, Links(soup.faces.size(), joints), name, unturned);
    }
    check_interrupt();
    const Links links(soup.faces.size(), joints);
    turn_outward(soup, components, links, turned);
    report.faces_flipped += static_cast<int>(std::count(turned.begin(), turned.end(), 1));
    report.components = static_cast<int>(components.faces.size());
    check_interrupt();
    report.degenerate_faces_removed +=
        remove_degenerate_faces(soup, kDegenerateHeightShare * diagonal);
    require_faces(soup, name);
    drop_unused_points(soup);
    check_interrupt();
    report.crossings.clear();
    for (const std::int32_t f : self_intersecting_faces(soup)) {
        const auto& [a, b, c] = soup.faces[static_cast<std::size_t>(f)];
        report.crossings.emplace_back((soup.points_mm[static_cast<std::size_t>(a)] +
                                       soup.points_mm[static_cast<std::size_t>(b)] +
                                       soup.points_mm[static_cast<std::size_t>(c)]) /
                                      3.0);
    }
    report.self_intersecting_faces = static_cast<int>(report.crossings.size());
}

}  // namespace meshwind
