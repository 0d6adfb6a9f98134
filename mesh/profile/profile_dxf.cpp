#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/error.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "mesh/profile/dxf_drawing.h"
#include "mesh/profile/profile_file.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;

// Ends this share of the drawing's size apart are one point: what CAD programs leave between
// pieces that were drawn to meet.
constexpr double kSamePlaceShare = 1e-5;

// So near to the axis, as a share of the largest coordinate, is on it.
constexpr double kOnAxisShare = 1e-9;

// Pieces that meet at more make a crease.
constexpr double kCrease_rad = 0.5 * kPi / 180.0;

// Nodes of an arc: the spline through them is off by 2e-8 of the radius
// (mesh/revolution/meridian.h).
constexpr double kNode_rad = 2.5 * kPi / 180.0;
constexpr int kFewestSteps = 4;

double slope_of(const Vector2d& tangent) {
    return std::atan2(tangent.y(), tangent.x());
}

// The pieces of an outline; ends this near to each other are one point.
struct OutlinePieces {
    std::vector<DrawnPiece> pieces;
    double same_place_mm = 0.0;

    [[nodiscard]] bool same(const Vector2d& a, const Vector2d& b) const {
        return (a - b).norm() <= same_place_mm;
    }
};

// The pieces that do not lie on the axis, turned above it.
OutlinePieces off_axis(std::vector<DrawnPiece> drawn, const std::string& file) {
    Eigen::AlignedBox2d box;
    for (const DrawnPiece& piece : drawn) {
        box.extend(piece.from);
        box.extend(piece.to);
    }
    OutlinePieces outline;
    const double same = box.isEmpty() ? 0.0 : kSamePlaceShare * box.sizes().norm();
    outline.same_place_mm = same;
    if (!box.isEmpty() && box.max().y() <= same) {  // drawn below the axis
        for (DrawnPiece& piece : drawn) {
            for (Vector2d* p : {&piece.from, &piece.to, &piece.centre}) {
                p->y() = -p->y();
            }
            piece.sweep_rad = -piece.sweep_rad;
        }
    }
    for (const DrawnPiece& piece : drawn) {
        if (!(piece.is_line() && std::abs(piece.from.y()) <= same &&
              std::abs(piece.to.y()) <= same)) {
            outline.pieces.push_back(piece);
        }
    }
    if (outline.pieces.empty()) {
        throw InputError("profile.points", file,
                         "has no line or arc off the axis; draw the outline with the spindle "
                         "axis as y = 0");
    }
    return outline;
}

[[noreturn]] void refuse_chain(const std::string& file, const Vector2d& place,
                               const std::string& words) {
    throw InputError("profile.chain", file,
                     words + "x = " + fixed(place.x(), 4) + ", y = " + fixed(place.y(), 4) +
                         "; draw the outside as one line from end to end, and nothing else");
}

// How many ends of pieces meet there.
std::ptrdiff_t meeting(const OutlinePieces& outline, const Vector2d& place) {
    std::ptrdiff_t count = 0;
    for (const DrawnPiece& piece : outline.pieces) {
        count +=
            (outline.same(piece.from, place) ? 1 : 0) + (outline.same(piece.to, place) ? 1 : 0);
    }
    return count;
}

// The lower end of the outline.
Vector2d beginning(const OutlinePieces& outline, const std::string& file) {
    std::vector<Vector2d> ends;
    for (const DrawnPiece& piece : outline.pieces) {
        for (const Vector2d& p : {piece.from, piece.to}) {
            const auto count = meeting(outline, p);
            if (count > 2) {
                refuse_chain(file, p, std::to_string(count) + " ends of pieces meet at ");
            }
            if (count == 1) {
                ends.push_back(p);
            }
        }
    }
    if (ends.empty()) {
        refuse_chain(file, outline.pieces.front().from, "the outline is closed: it comes back to ");
    }
    if (ends.size() > 2) {
        refuse_chain(file, ends[1],
                     std::to_string(ends.size()) + " ends of pieces meet no other, one at ");
    }
    return ends[0].x() <= ends[1].x() ? ends[0] : ends[1];
}

// Pieces one behind the other, from the lower end to the upper one.
std::vector<DrawnPiece> in_order(const OutlinePieces& outline, const std::string& file) {
    Vector2d place = beginning(outline, file);
    std::vector<DrawnPiece> ordered;
    std::vector<DrawnPiece> left = outline.pieces;
    while (!left.empty()) {
        const auto next = std::find_if(left.begin(), left.end(), [&](const DrawnPiece& piece) {
            return outline.same(piece.from, place) || outline.same(piece.to, place);
        });
        if (next == left.end()) {  // a closed line beside the outline
            refuse_chain(file, left.front().from, "another line goes through ");
        }
        ordered.push_back(outline.same(next->from, place) ? *next : next->reversed());
        place = ordered.back().to;
        left.erase(next);
    }
    return ordered;
}

// Largest coordinate of the ends.
double largest_coordinate(const std::vector<DrawnPiece>& chain) {
    double size = 0.0;
    for (const DrawnPiece& piece : chain) {
        size = std::max({size, piece.from.cwiseAbs().maxCoeff(), piece.to.cwiseAbs().maxCoeff()});
    }
    return size;
}

// Nodes while they are made, of a chain whose largest coordinate is `size`.
class NodeList {
public:
    NodeList(double size, const std::string& file) : size_(size), file_(file) {}

    MeridianNode& add(const Vector2d& drawn) {
        MeridianNode& node = nodes_.emplace_back();
        node.radius_mm = drawn.y();
        node.z_mm = drawn.x();
        // Of an end that was drawn on the axis, rounding may have left a little.
        if (std::abs(drawn.y()) <= kOnAxisShare * size_) {
            node.radius_mm = 0.0;
        } else if (drawn.y() < 0.0) {
            throw InputError("profile.radius", file_,
                             "goes below the axis, y = 0, at x = " + fixed(drawn.x(), 4) +
                                 "; draw one half of the outline");
        }
        return node;
    }

    std::vector<MeridianNode> take() && { return std::move(nodes_); }

private:
    double size_;
    const std::string& file_;
    std::vector<MeridianNode> nodes_;
};

// The node that a piece begins at. \param before the piece before it; none: it is the first
void add_beginning(const DrawnPiece& piece, const DrawnPiece* before, NodeList& nodes) {
    MeridianNode& first = nodes.add(piece.from);
    first.straight = piece.is_line();
    if (before != nullptr) {
        const Vector2d a = before->tangent(1.0);
        const Vector2d b = piece.tangent(0.0);
        first.crease = std::abs(std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b))) > kCrease_rad;
        first.joint = !first.crease;
        first.slope_before_rad = first.crease ? std::optional(slope_of(a)) : std::nullopt;
    }
    if (!piece.is_line() && (first.crease || first.radius_mm > 0.0)) {
        first.slope_rad = slope_of(piece.tangent(0.0));
    }
}

// The nodes within an arc.
void add_inside(const DrawnPiece& piece, NodeList& nodes) {
    const int steps =
        piece.is_line()
            ? 1
            : std::max(kFewestSteps,
                       static_cast<int>(std::ceil(std::abs(piece.sweep_rad) / kNode_rad)));
    for (int k = 1; k < steps; ++k) {
        nodes.add(piece.at(static_cast<double>(k) / steps));
    }
}

std::vector<MeridianNode> nodes_of(const std::vector<DrawnPiece>& chain, const std::string& file) {
    if (chain.back().to.x() == chain.front().from.x()) {
        throw InputError("profile.ends", file,
                         "begins and ends at the same place along the axis; draw an outline "
                         "from one end to the other");
    }
    NodeList nodes(largest_coordinate(chain), file);
    for (std::size_t i = 0; i < chain.size(); ++i) {
        add_beginning(chain[i], i > 0 ? &chain[i - 1] : nullptr, nodes);
        add_inside(chain[i], nodes);
    }
    MeridianNode& last = nodes.add(chain.back().to);
    if (!chain.back().is_line() && last.radius_mm > 0.0) {
        last.slope_rad = slope_of(chain.back().tangent(1.0));
    }
    return std::move(nodes).take();
}

}  // namespace

ProfileFile read_profile_dxf(std::string_view text, const std::string& file) {
    DxfDrawing drawing = read_dxf(text, file);
    const OutlinePieces outline = off_axis(std::move(drawing.pieces), file);
    const std::vector<DrawnPiece> chain = in_order(outline, file);
    return {nodes_of(chain, file), drawing.unit_mm};
}

}  // namespace meshwind
