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
#include "mesh/segment/face_outline.h"
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
constexpr double kMinAreaShare = 1e-4;

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

// A triangle so narrow tells nothing by its normal.
bool is_narrow(const MeasuredFaces& part, std::int32_t f) {
    double longest = 0.0;
    for (std::size_t e = 0; e < 3; ++e) {
        longest = std::max(longest, (part.corner(f, e + 1) - part.corner(f, e)).norm());
    }
    return 2.0 * part.area_mm2[at(f)] <= part.tolerance_mm * longest;
}

// Faces in the plane of the seed that hang together with it.
Patch grow(const MeasuredFaces& part, std::int32_t seed, std::vector<char>& taken) {
    const Vector3d& normal = part.normals[at(seed)];
    const double height = normal.dot(part.centre(seed));
    Patch patch;
    patch.faces.push_back(seed);
    taken[at(seed)] = 1;
    double area = 0.0;
    double moment = 0.0;
    for (std::size_t i = 0; i < patch.faces.size(); ++i) {
        const std::int32_t f = patch.faces[i];
        patch.normal += part.area_mm2[at(f)] * part.normals[at(f)];
        area += part.area_mm2[at(f)];
        for (const std::int32_t g : part.neighbours[at(f)]) {
            if (g < 0 || taken[at(g)] != 0 ||
                (part.normals[at(g)].dot(normal) < kPlaneCosine && !is_narrow(part, g))) {
                continue;
            }
            bool inside = true;
            for (std::size_t c = 0; c < 3; ++c) {
                inside =
                    inside && std::abs(normal.dot(part.corner(g, c)) - height) <= part.tolerance_mm;
            }
            if (inside) {
                taken[at(g)] = 1;
                patch.faces.push_back(g);
            }
        }
    }
    patch.normal.normalize();
    for (const std::int32_t f : patch.faces) {
        moment += part.area_mm2[at(f)] * patch.normal.dot(part.centre(f));
    }
    patch.height_mm = area > 0.0 ? moment / area : height;
    return patch;
}

// A disc that no tab of a patch reaches far out of.
struct Disc {
    Vector3d centre_mm;
    double radius_mm = 0.0;
};

using Tab = std::vector<std::int32_t>;

// Least and largest height of a face's corners over the patch.
std::pair<double, double> heights(const MeasuredFaces& part, const Patch& patch, std::int32_t f) {
    std::pair<double, double> range{std::numeric_limits<double>::infinity(),
                                    -std::numeric_limits<double>::infinity()};
    for (std::size_t i = 0; i < 3; ++i) {
        const double height = patch.normal.dot(part.corner(f, i)) - patch.height_mm;
        range.first = std::min(range.first, height);
        range.second = std::max(range.second, height);
    }
    return range;
}

bool stands_before(const MeasuredFaces& part, const Patch& patch, std::int32_t f) {
    const auto [low, high] = heights(part, patch, f);
    return high > 2.0 * part.tolerance_mm && low >= -2.0 * part.tolerance_mm;
}

bool lies_in(const MeasuredFaces& part, const Patch& patch, std::int32_t f) {
    const auto [low, high] = heights(part, patch, f);
    return low >= -2.0 * part.tolerance_mm && high <= 2.0 * part.tolerance_mm &&
           (part.normals[at(f)].dot(patch.normal) >= kPlaneCosine || is_narrow(part, f));
}

// Half the diagonal of the patch's box: no less than the radius of a disc, of most of a ring.
double reach_mm(const MeasuredFaces& part, const Patch& patch) {
    Eigen::AlignedBox3d box;
    for (const std::int32_t f : patch.faces) {
        for (std::size_t i = 0; i < 3; ++i) {
            box.extend(part.corner(f, i));
        }
    }
    return 0.5 * box.diagonal().norm();
}

// False where the tab is too large to be one.
bool spread(const MeasuredFaces& part, const Disc& disc, Tab& tab, Patch& patch, FaceMarks& marks,
            int seen) {
    for (std::size_t i = 0; i < tab.size(); ++i) {
        if (heights(part, patch, tab[i]).second > kTabHeight * disc.radius_mm ||
            (part.centre(tab[i]) - disc.centre_mm).norm() > 3.0 * disc.radius_mm) {
            return false;
        }
        for (const std::int32_t g : part.neighbours[at(tab[i])]) {
            if (g < 0 || marks.of_face[at(g)] == seen) {
                continue;
            }
            if (lies_in(part, patch, g)) {
                marks.of_face[at(g)] = seen;
                patch.faces.push_back(g);
            } else if (stands_before(part, patch, g)) {
                marks.of_face[at(g)] = seen;
                tab.push_back(g);
            }
        }
    }
    return true;
}

// What stands before the patch beside its border, in pieces that hang together; the patch grows
// by what lies in its plane behind them. None where a piece is higher or farther off than tabs
// are: it may be the rest of the part.
std::optional<std::vector<Tab>> tabs_on(const MeasuredFaces& part, Patch& patch, FaceMarks& marks) {
    std::vector<Tab> tabs;
    const int seen = marks.fresh();
    const Disc disc{part.centre(patch.faces.front()), reach_mm(part, patch)};
    for (const std::int32_t f : patch.faces) {
        marks.of_face[at(f)] = seen;
    }
    for (std::size_t i = 0; i < patch.faces.size(); ++i) {
        const std::array<std::int32_t, 3> around = part.neighbours[at(patch.faces[i])];
        for (const std::int32_t seed : around) {
            if (seed < 0 || marks.of_face[at(seed)] == seen) {
                continue;
            }
            if (lies_in(part, patch, seed)) {
                marks.of_face[at(seed)] = seen;
                patch.faces.push_back(seed);
            } else if (stands_before(part, patch, seed)) {
                marks.of_face[at(seed)] = seen;
                Tab tab{seed};
                if (!spread(part, disc, tab, patch, marks, seen)) {
                    return std::nullopt;
                }
                tabs.push_back(std::move(tab));
            }
        }
    }
    return tabs;
}

double angle_about(const Rim& circle, const Vector3d& p) {
    const Vector3d u = circle.axis.unitOrthogonal();
    const Vector3d v = circle.axis.cross(u);
    const Vector3d arm = p - circle.centre_mm;
    return std::atan2(v.dot(arm), u.dot(arm));
}

bool is_tab(const MeasuredFaces& part, const Tab& tab, const Patch& patch, const Rim& circle) {
    std::vector<double> angles;
    double highest = 0.0;
    for (const std::int32_t f : tab) {
        highest = std::max(highest, heights(part, patch, f).second);
        for (std::size_t i = 0; i < 3; ++i) {
            angles.push_back(angle_about(circle, part.corner(f, i)));
        }
    }
    return highest <= kTabHeight * circle.radius_mm &&
           widest_gap_rad(std::move(angles)) > kWidestGap_rad;
}

Rim circle_of(const MeasuredFaces& part, const FaceOutline& outline, const Patch& patch) {
    std::vector<std::int32_t> vertices;
    vertices.reserve(outline.edges.size());
    for (const auto& [f, e] : outline.edges) {
        vertices.push_back(part.soup.faces[at(f)][e]);
    }
    Rim circle = rim_through(part.soup, std::move(vertices));
    circle.axis *= circle.axis.dot(patch.normal) < 0.0 ? -1.0 : 1.0;
    return circle;
}

bool is_round(const MeasuredFaces& part, const FaceOutline& outline, const Rim& circle) {
    const double limit = kRoundShare * circle.radius_mm;
    double all = 0.0;
    double round = 0.0;
    for (const auto& [f, e] : outline.edges) {
        const Vector3d& from = part.corner(f, e);
        const Vector3d& to = part.corner(f, e + 1);
        const double length = (to - from).norm();
        const bool on_circle = std::max({off_circle_mm(circle, from), off_circle_mm(circle, to),
                                         off_circle_mm(circle, 0.5 * (from + to))}) <= limit;
        all += length;
        round += on_circle ? length : 0.0;
    }
    return round >= kRoundLength * all;
}

bool is_sharp(const MeasuredFaces& part, const FaceOutline& outline) {
    double all = 0.0;
    double sharp = 0.0;
    for (const auto& [f, e] : outline.edges) {
        const double length = (part.corner(f, e + 1) - part.corner(f, e)).norm();
        const double turn = part.normals[at(f)].dot(part.normals[at(part.neighbours[at(f)][e])]);
        all += length;
        sharp += turn <= std::cos(kFeatureAngleRad) ? length : 0.0;
    }
    return sharp >= kSharpLength * all;
}

// Of a disc its radius, of a ring what is between its two circles. \pre faces are marked
double width_mm(const MeasuredFaces& part, const std::vector<std::int32_t>& faces,
                const FaceMarks& marks) {
    double area = 0.0;
    double border = 0.0;
    for (const std::int32_t f : faces) {
        area += part.area_mm2[at(f)];
        for (std::size_t e = 0; e < 3; ++e) {
            const bool beside =
                marks.of_face[at(part.neighbours[at(f)][e])] != marks.of_face[at(f)];
            border += beside ? (part.corner(f, e + 1) - part.corner(f, e)).norm() : 0.0;
        }
    }
    return border > 0.0 ? 2.0 * area / border : 0.0;
}

// Whether the surface goes back from the outline and is a leg's wall soon, all around.
bool has_wall(const MeasuredFaces& part, const FaceOutline& outline, const Rim& circle,
              double face_width_mm, FaceMarks& marks) {
    const int inside = marks.last;  // the end's faces have the last mark
    const int seen = marks.fresh();
    const double radius = circle.radius_mm;
    std::vector<std::int32_t> stack;
    const auto reach = [&](std::int32_t f) {
        if (f < 0 || marks.of_face[at(f)] == inside || marks.of_face[at(f)] == seen) {
            return;
        }
        for (std::size_t i = 0; i < 3; ++i) {
            const Vector3d arm = part.corner(f, i) - circle.centre_mm;
            const double along = circle.axis.dot(arm);
            const double out = (arm - along * circle.axis).norm();
            // One corner near the end is enough: a wall may be one row of long facets.
            if (along >= -kWallBehind * radius && out <= kWallOutside * radius &&
                along <= kTabHeight * radius) {
                marks.of_face[at(f)] = seen;
                stack.push_back(f);
                return;
            }
        }
    };
    for (const auto& [f, e] : outline.edges) {
        reach(part.neighbours[at(f)][e]);
    }
    std::vector<double> angles;
    double begins_mm = radius;  // behind the end
    while (!stack.empty()) {
        const std::int32_t f = stack.back();
        stack.pop_back();
        const Vector3d& normal = part.normals[at(f)];
        const Vector3d outward = part.centre(f) - circle.centre_mm;
        const double lean = normal.dot(circle.axis);
        if (std::abs(lean) < kWallLean && (normal - lean * circle.axis).dot(outward) > 0.0) {
            angles.push_back(angle_about(circle, circle.centre_mm + normal));
            for (std::size_t i = 0; i < 3; ++i) {
                begins_mm =
                    std::min(begins_mm, circle.axis.dot(circle.centre_mm - part.corner(f, i)));
            }
        }
        for (const std::int32_t g : part.neighbours[at(f)]) {
            reach(g);
        }
    }
    return !angles.empty() && widest_gap_rad(std::move(angles)) < kWidestGap_rad &&
           face_width_mm >= kWidthOfLip * begins_mm;
}

// The faces of an end, if the patch is one.
std::optional<std::vector<std::int32_t>> end_of(const MeasuredFaces& part, Patch patch,
                                                FaceMarks& marks) {
    const auto tabs = tabs_on(part, patch, marks);
    if (!tabs) {
        return std::nullopt;
    }
    std::vector<std::int32_t> faces = patch.faces;
    for (const Tab& tab : *tabs) {
        faces.insert(faces.end(), tab.begin(), tab.end());
    }
    const FaceOutline outline = marked_outline(part, faces, patch.normal, marks);
    if (outline.edges.empty()) {
        return std::nullopt;
    }
    const Rim circle = circle_of(part, outline, patch);
    const bool are_tabs = std::all_of(tabs->begin(), tabs->end(), [&](const Tab& tab) {
        return is_tab(part, tab, patch, circle);
    });
    const bool is_end =
        are_tabs && is_round(part, outline, circle) &&
        outline.enclosed_mm2 >= kRoundArea * kPi * circle.radius_mm * circle.radius_mm &&
        has_wall(part, outline, circle,
                 is_sharp(part, outline) ? std::numeric_limits<double>::infinity()
                                         : width_mm(part, faces, marks),
                 marks);
    return is_end ? std::optional(std::move(faces)) : std::nullopt;
}

// Faces from the largest down.
std::vector<std::int32_t> by_area(const std::vector<double>& area_mm2) {
    std::vector<std::int32_t> order(area_mm2.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
        return area_mm2[at(a)] > area_mm2[at(b)];
    });
    return order;
}

double patch_area_mm2(const MeasuredFaces& part, const Patch& patch) {
    double area = 0.0;
    for (const std::int32_t f : patch.faces) {
        area += part.area_mm2[at(f)];
    }
    return area;
}

}  // namespace

std::vector<std::int32_t> flat_ends(const TriangleSoup& soup,
                                    const std::vector<std::array<std::int32_t, 3>>& neighbours,
                                    const std::vector<Eigen::Vector3d>& normals,
                                    const std::vector<double>& face_area) {
    const MeasuredFaces part{soup, neighbours, normals, face_area, kPlaneShare * diagonal_mm(soup)};
    const double least = kMinAreaShare * std::accumulate(face_area.begin(), face_area.end(), 0.0);
    FaceMarks marks{std::vector<int>(soup.faces.size(), 0)};
    std::vector<std::int32_t> end(soup.faces.size(), -1);
    std::vector<char> taken(soup.faces.size(), 0);
    std::int32_t count = 0;
    for (const std::int32_t seed : by_area(face_area)) {
        if (taken[at(seed)] != 0) {
            continue;
        }
        Patch patch = grow(part, seed, taken);
        if (patch_area_mm2(part, patch) < least) {
            continue;
        }
        if (const auto faces = end_of(part, std::move(patch), marks)) {
            for (const std::int32_t f : *faces) {
                end[at(f)] = count;
            }
            ++count;
        }
    }
    return end;
}

}  // namespace meshwind
