#include "mesh/segment/flat_ends.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "core/angle_gap.h"
#include "core/index.h"
#include "core/units.h"
#include "mesh/rim.h"
#include "mesh/segment/feature_edges.h"
#include "mesh/segment/rims.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Faces of one plane: vertices this near to it, as a share of the part's diagonal, and normals this
// near to each other. Facets of a lip lean more, or leave the plane by less than matters.
constexpr double kPlaneShare = 2e-4;
const double kPlaneCosine = std::cos(rad_from_deg(3.0));

// Share of the part's area that an end face has at least: that of a pipe of 300 radii length with a
// wall of a tenth of its radius.
constexpr double kLeastAreaShare = 1e-4;

// An outline is round when so much of its length is so near to its circle, as a share of the
// radius, and it encloses so much of its area. Tabs may break the rest of it. Twelve facets stand
// off their circle by 3.4 %. Strips of a bend lie on circles too, but go around none.
constexpr double kRoundLength = 0.6;
constexpr double kRoundShare = 0.04;
constexpr double kRoundArea = 0.8;

// Tabs are no higher than this share of the end's radius, and stand on one side of its axis: what
// goes around it is a leg.
constexpr double kTabHeight = 0.5;

// The wall begins within so many radii behind the end and outside it (a lip of a quarter of the
// wall's radius), and leans to the axis by less than this sine.
constexpr double kWallBehind = 0.35;
constexpr double kWallOutside = 1.35;
constexpr double kWallLean = 0.5;

// An end face without sharp edges is at least so many times as wide as the wall begins behind it,
// else it is a facet of something round: of a torus of twelve facets around it is twice as wide.
constexpr double kWidthOfLip = 2.5;
constexpr double kSharpLength = 0.5;  // of an outline with sharp edges

// Seen from the axis, wall and tabs are all around when no wider gap is between them.
constexpr double kWidestGap_rad = 2.1;

struct Patch {
    std::vector<std::int32_t> faces;
    Vector3d normal = Vector3d::Zero();
    double height_mm = 0.0;  // of the plane, along the normal
};

// A face and one of its edges.
using HalfEdge = std::pair<std::int32_t, std::size_t>;

class FlatEnds {
public:
    FlatEnds(const TriangleSoup& soup, const std::vector<std::array<std::int32_t, 3>>& neighbours,
             const std::vector<Vector3d>& normals, const std::vector<double>& face_area)
        : soup_(soup),
          neighbours_(neighbours),
          normals_(normals),
          face_area_(face_area),
          tolerance_mm_(kPlaneShare * diagonal_mm(soup)),
          end_(soup.faces.size(), -1),
          mark_(soup.faces.size(), 0) {}

    std::vector<std::int32_t> find() {
        const double least =
            kLeastAreaShare * std::accumulate(face_area_.begin(), face_area_.end(), 0.0);
        std::vector<std::int32_t> order(soup_.faces.size());
        std::iota(order.begin(), order.end(), 0);
        std::stable_sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
            return face_area_[at(a)] > face_area_[at(b)];
        });
        std::vector<char> taken(soup_.faces.size(), 0);
        std::int32_t count = 0;
        for (const std::int32_t seed : order) {
            if (taken[at(seed)] != 0) {
                continue;
            }
            const Patch patch = grow(seed, taken);
            double area = 0.0;
            for (const std::int32_t f : patch.faces) {
                area += face_area_[at(f)];
            }
            if (area < least) {
                continue;
            }
            if (const auto faces = end_of(patch)) {
                for (const std::int32_t f : *faces) {
                    end_[at(f)] = count;
                }
                ++count;
            }
        }
        return end_;
    }

private:
    [[nodiscard]] const Vector3d& corner(std::int32_t f, std::size_t i) const {
        return soup_.points_mm[at(soup_.faces[at(f)][i % 3])];
    }
    [[nodiscard]] Vector3d centre(std::int32_t f) const {
        return (corner(f, 0) + corner(f, 1) + corner(f, 2)) / 3.0;
    }

    // A triangle so narrow tells nothing by its normal.
    [[nodiscard]] bool is_narrow(std::int32_t f) const {
        double longest = 0.0;
        for (std::size_t e = 0; e < 3; ++e) {
            longest = std::max(longest, (corner(f, e + 1) - corner(f, e)).norm());
        }
        return 2.0 * face_area_[at(f)] <= tolerance_mm_ * longest;
    }

    // Faces in the plane of the seed that hang together with it.
    Patch grow(std::int32_t seed, std::vector<char>& taken) const {
        const Vector3d& normal = normals_[at(seed)];
        const double height = normal.dot(centre(seed));
        Patch patch;
        patch.faces.push_back(seed);
        taken[at(seed)] = 1;
        double area = 0.0;
        double moment = 0.0;
        for (std::size_t i = 0; i < patch.faces.size(); ++i) {
            const std::int32_t f = patch.faces[i];
            patch.normal += face_area_[at(f)] * normals_[at(f)];
            area += face_area_[at(f)];
            for (const std::int32_t g : neighbours_[at(f)]) {
                if (g < 0 || taken[at(g)] != 0 ||
                    (normals_[at(g)].dot(normal) < kPlaneCosine && !is_narrow(g))) {
                    continue;
                }
                bool inside = true;
                for (std::size_t c = 0; c < 3; ++c) {
                    inside = inside && std::abs(normal.dot(corner(g, c)) - height) <= tolerance_mm_;
                }
                if (inside) {
                    taken[at(g)] = 1;
                    patch.faces.push_back(g);
                }
            }
        }
        patch.normal.normalize();
        for (const std::int32_t f : patch.faces) {
            moment += face_area_[at(f)] * patch.normal.dot(centre(f));
        }
        patch.height_mm = area > 0.0 ? moment / area : height;
        return patch;
    }

    // Least and largest height of a face's corners over the patch.
    [[nodiscard]] std::pair<double, double> heights(const Patch& patch, std::int32_t f) const {
        std::pair<double, double> range{std::numeric_limits<double>::infinity(),
                                        -std::numeric_limits<double>::infinity()};
        for (std::size_t i = 0; i < 3; ++i) {
            const double height = patch.normal.dot(corner(f, i)) - patch.height_mm;
            range.first = std::min(range.first, height);
            range.second = std::max(range.second, height);
        }
        return range;
    }
    [[nodiscard]] bool stands_before(const Patch& patch, std::int32_t f) const {
        const auto [low, high] = heights(patch, f);
        return high > 2.0 * tolerance_mm_ && low >= -2.0 * tolerance_mm_;
    }

    // Boundary loops of the marked faces, each turning left about them. Empty where the part is
    // open there.
    [[nodiscard]] std::vector<std::vector<HalfEdge>> loops_of(
        const std::vector<std::int32_t>& faces, int mark) const {
        const auto inside = [&](std::int32_t f) { return mark_[at(f)] == mark; };
        std::vector<HalfEdge> border;
        for (const std::int32_t f : faces) {
            for (std::size_t e = 0; e < 3; ++e) {
                const std::int32_t g = neighbours_[at(f)][e];
                if (g < 0) {
                    return {};
                }
                if (!inside(g)) {
                    border.emplace_back(f, e);
                }
            }
        }
        std::sort(border.begin(), border.end());
        std::vector<char> used(border.size(), 0);
        std::vector<std::vector<HalfEdge>> loops;
        for (std::size_t i = 0; i < border.size(); ++i) {
            if (used[i] != 0) {
                continue;
            }
            std::vector<HalfEdge> loop;
            HalfEdge edge = border[i];
            for (std::size_t place = i; used[place] == 0;) {
                used[place] = 1;
                loop.push_back(edge);
                edge = next_on_border(edge, inside);
                place = static_cast<std::size_t>(
                    std::lower_bound(border.begin(), border.end(), edge) - border.begin());
            }
            loops.push_back(std::move(loop));
        }
        return loops;
    }

    // Turns about the edge's end through the faces inside.
    template <typename Inside>
    [[nodiscard]] HalfEdge next_on_border(HalfEdge edge, const Inside& inside) const {
        auto [f, e] = edge;
        e = (e + 1) % 3;
        for (std::int32_t g = neighbours_[at(f)][e]; inside(g); g = neighbours_[at(f)][e]) {
            const std::int32_t turned = soup_.faces[at(f)][e];
            const auto& corners = soup_.faces[at(g)];
            e = static_cast<std::size_t>(std::find(corners.begin(), corners.end(), turned) -
                                         corners.begin());
            f = g;
        }
        return {f, e};
    }

    // The loop that encloses the largest area, and that area. Loops turn left about the normal.
    [[nodiscard]] std::pair<std::vector<HalfEdge>, double> outline_of(
        const std::vector<std::vector<HalfEdge>>& loops, const Vector3d& normal) const {
        std::pair<std::vector<HalfEdge>, double> outline;
        for (const auto& loop : loops) {
            const Vector3d origin = corner(loop.front().first, loop.front().second);
            double area = 0.0;
            for (const auto& [f, e] : loop) {
                area += 0.5 * normal.dot((corner(f, e) - origin).cross(corner(f, e + 1) - origin));
            }
            if (area > outline.second) {
                outline = {loop, area};
            }
        }
        return outline;
    }

    [[nodiscard]] double angle_about(const Rim& circle, const Vector3d& p) const {
        const Vector3d u = circle.axis.unitOrthogonal();
        const Vector3d v = circle.axis.cross(u);
        const Vector3d arm = p - circle.centre_mm;
        return std::atan2(v.dot(arm), u.dot(arm));
    }

    [[nodiscard]] bool lies_in(const Patch& patch, std::int32_t f) const {
        const auto [low, high] = heights(patch, f);
        return low >= -2.0 * tolerance_mm_ && high <= 2.0 * tolerance_mm_ &&
               (normals_[at(f)].dot(patch.normal) >= kPlaneCosine || is_narrow(f));
    }

    // Half the diagonal of the patch's box: no less than the radius of a disc, of most of a ring.
    [[nodiscard]] double reach_mm(const Patch& patch) const {
        Eigen::AlignedBox3d box;
        for (const std::int32_t f : patch.faces) {
            for (std::size_t i = 0; i < 3; ++i) {
                box.extend(corner(f, i));
            }
        }
        return 0.5 * box.diagonal().norm();
    }

    using Tab = std::vector<std::int32_t>;

    // What stands before the patch beside its border, in pieces that hang together; the patch grows
    // by what lies in its plane behind them. None where a piece is higher or farther off than tabs
    // are: it may be the rest of the part.
    [[nodiscard]] std::optional<std::vector<Tab>> tabs_on(Patch& patch) {
        std::vector<Tab> tabs;
        const int seen = next_mark_++;
        const Vector3d middle = centre(patch.faces.front());
        const double reach = reach_mm(patch);
        for (const std::int32_t f : patch.faces) {
            mark_[at(f)] = seen;
        }
        for (std::size_t i = 0; i < patch.faces.size(); ++i) {
            const std::array<std::int32_t, 3> around = neighbours_[at(patch.faces[i])];
            for (const std::int32_t seed : around) {
                if (seed < 0 || mark_[at(seed)] == seen) {
                    continue;
                }
                if (lies_in(patch, seed)) {
                    mark_[at(seed)] = seen;
                    patch.faces.push_back(seed);
                } else if (stands_before(patch, seed)) {
                    mark_[at(seed)] = seen;
                    Tab tab{seed};
                    if (!spread(tab, patch, seen, middle, reach)) {
                        return std::nullopt;
                    }
                    tabs.push_back(std::move(tab));
                }
            }
        }
        return tabs;
    }

    // False where the tab is too large to be one.
    bool spread(Tab& tab, Patch& patch, int seen, const Vector3d& middle, double reach) {
        for (std::size_t i = 0; i < tab.size(); ++i) {
            if (heights(patch, tab[i]).second > kTabHeight * reach ||
                (centre(tab[i]) - middle).norm() > 3.0 * reach) {
                return false;
            }
            for (const std::int32_t g : neighbours_[at(tab[i])]) {
                if (g < 0 || mark_[at(g)] == seen) {
                    continue;
                }
                if (lies_in(patch, g)) {
                    mark_[at(g)] = seen;
                    patch.faces.push_back(g);
                } else if (stands_before(patch, g)) {
                    mark_[at(g)] = seen;
                    tab.push_back(g);
                }
            }
        }
        return true;
    }

    // The faces of an end, if the patch is one.
    [[nodiscard]] std::optional<std::vector<std::int32_t>> end_of(Patch patch) {
        const auto tabs = tabs_on(patch);
        if (!tabs) {
            return std::nullopt;
        }
        std::vector<std::int32_t> faces = patch.faces;
        for (const Tab& tab : *tabs) {
            faces.insert(faces.end(), tab.begin(), tab.end());
        }
        const auto [outline, enclosed_mm2] = marked_outline(faces, patch.normal);
        if (outline.empty()) {
            return std::nullopt;
        }
        const Rim circle = circle_of(outline, patch);
        const bool are_tabs = std::all_of(
            tabs->begin(), tabs->end(), [&](const Tab& tab) { return is_tab(tab, patch, circle); });
        const bool is_end =
            are_tabs && is_round(outline, circle) &&
            enclosed_mm2 >= kRoundArea * kPi * circle.radius_mm * circle.radius_mm &&
            has_wall(outline, circle,
                     is_sharp(outline) ? std::numeric_limits<double>::infinity() : width_mm(faces));
        return is_end ? std::optional(std::move(faces)) : std::nullopt;
    }

    [[nodiscard]] bool is_tab(const Tab& tab, const Patch& patch, const Rim& circle) const {
        std::vector<double> angles;
        double highest = 0.0;
        for (const std::int32_t f : tab) {
            highest = std::max(highest, heights(patch, f).second);
            for (std::size_t i = 0; i < 3; ++i) {
                angles.push_back(angle_about(circle, corner(f, i)));
            }
        }
        return highest <= kTabHeight * circle.radius_mm &&
               widest_gap_rad(std::move(angles)) > kWidestGap_rad;
    }

    std::pair<std::vector<HalfEdge>, double> marked_outline(const std::vector<std::int32_t>& faces,
                                                            const Vector3d& normal) {
        const int mark = next_mark_++;
        for (const std::int32_t f : faces) {
            mark_[at(f)] = mark;
        }
        return outline_of(loops_of(faces, mark), normal);
    }

    [[nodiscard]] Rim circle_of(const std::vector<HalfEdge>& outline, const Patch& patch) const {
        std::vector<std::int32_t> vertices;
        vertices.reserve(outline.size());
        for (const auto& [f, e] : outline) {
            vertices.push_back(soup_.faces[at(f)][e]);
        }
        Rim circle = rim_through(soup_, std::move(vertices));
        circle.axis *= circle.axis.dot(patch.normal) < 0.0 ? -1.0 : 1.0;
        return circle;
    }

    [[nodiscard]] bool is_round(const std::vector<HalfEdge>& outline, const Rim& circle) const {
        const double limit = kRoundShare * circle.radius_mm;
        double all = 0.0;
        double round = 0.0;
        for (const auto& [f, e] : outline) {
            const Vector3d& from = corner(f, e);
            const Vector3d& to = corner(f, e + 1);
            const double length = (to - from).norm();
            const bool on_circle = std::max({off_circle_mm(circle, from), off_circle_mm(circle, to),
                                             off_circle_mm(circle, 0.5 * (from + to))}) <= limit;
            all += length;
            round += on_circle ? length : 0.0;
        }
        return round >= kRoundLength * all;
    }

    [[nodiscard]] bool is_sharp(const std::vector<HalfEdge>& outline) const {
        double all = 0.0;
        double sharp = 0.0;
        for (const auto& [f, e] : outline) {
            const double length = (corner(f, e + 1) - corner(f, e)).norm();
            const double turn = normals_[at(f)].dot(normals_[at(neighbours_[at(f)][e])]);
            all += length;
            sharp += turn <= std::cos(kFeatureAngleRad) ? length : 0.0;
        }
        return sharp >= kSharpLength * all;
    }

    // Whether the surface goes back from the outline and is a leg's wall soon, all around.
    [[nodiscard]] bool has_wall(const std::vector<HalfEdge>& outline, const Rim& circle,
                                double width_mm) {
        const int inside = next_mark_ - 1;  // the end's faces have the last mark
        const int seen = next_mark_++;
        const double radius = circle.radius_mm;
        std::vector<std::int32_t> stack;
        const auto reach = [&](std::int32_t f) {
            if (f < 0 || mark_[at(f)] == inside || mark_[at(f)] == seen) {
                return;
            }
            for (std::size_t i = 0; i < 3; ++i) {
                const Vector3d arm = corner(f, i) - circle.centre_mm;
                const double along = circle.axis.dot(arm);
                const double out = (arm - along * circle.axis).norm();
                // One corner near the end is enough: a wall may be one row of long facets.
                if (along >= -kWallBehind * radius && out <= kWallOutside * radius &&
                    along <= kTabHeight * radius) {
                    mark_[at(f)] = seen;
                    stack.push_back(f);
                    return;
                }
            }
        };
        for (const auto& [f, e] : outline) {
            reach(neighbours_[at(f)][e]);
        }
        std::vector<double> angles;
        double begins_mm = radius;  // behind the end
        while (!stack.empty()) {
            const std::int32_t f = stack.back();
            stack.pop_back();
            const Vector3d& normal = normals_[at(f)];
            const Vector3d outward = centre(f) - circle.centre_mm;
            const double lean = normal.dot(circle.axis);
            if (std::abs(lean) < kWallLean && (normal - lean * circle.axis).dot(outward) > 0.0) {
                angles.push_back(angle_about(circle, circle.centre_mm + normal));
                for (std::size_t i = 0; i < 3; ++i) {
                    begins_mm =
                        std::min(begins_mm, circle.axis.dot(circle.centre_mm - corner(f, i)));
                }
            }
            for (const std::int32_t g : neighbours_[at(f)]) {
                reach(g);
            }
        }
        return !angles.empty() && widest_gap_rad(std::move(angles)) < kWidestGap_rad &&
               width_mm >= kWidthOfLip * begins_mm;
    }

    // Of a disc its radius, of a ring what is between its two circles. \pre faces are marked
    [[nodiscard]] double width_mm(const std::vector<std::int32_t>& faces) const {
        double area = 0.0;
        double border = 0.0;
        for (const std::int32_t f : faces) {
            area += face_area_[at(f)];
            for (std::size_t e = 0; e < 3; ++e) {
                const bool beside = mark_[at(neighbours_[at(f)][e])] != mark_[at(f)];
                border += beside ? (corner(f, e + 1) - corner(f, e)).norm() : 0.0;
            }
        }
        return border > 0.0 ? 2.0 * area / border : 0.0;
    }

    const TriangleSoup& soup_;
    const std::vector<std::array<std::int32_t, 3>>& neighbours_;
    const std::vector<Vector3d>& normals_;
    const std::vector<double>& face_area_;
    double tolerance_mm_;
    std::vector<std::int32_t> end_;
    std::vector<int> mark_;
    int next_mark_ = 1;
};

}  // namespace

std::vector<std::int32_t> flat_ends(const TriangleSoup& soup,
                                    const std::vector<std::array<std::int32_t, 3>>& neighbours,
                                    const std::vector<Eigen::Vector3d>& normals,
                                    const std::vector<double>& face_area) {
    return FlatEnds(soup, neighbours, normals, face_area).find();
}

}  // namespace meshwind
