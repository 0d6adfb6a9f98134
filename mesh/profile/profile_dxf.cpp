#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/error.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "mesh/profile/profile_file.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;

// They are put in order by trying each with each.
constexpr std::size_t kMostPieces = 10'000;

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

// A line, or an arc about a centre by an angle, > 0 counter-clockwise. x along the axis, y the
// radius, as drawn.
struct Piece {
    Vector2d from;
    Vector2d to;
    Vector2d centre = Vector2d::Zero();
    double sweep_rad = 0.0;  // 0: a line

    [[nodiscard]] bool is_line() const { return sweep_rad == 0.0; }

    [[nodiscard]] Vector2d at(double share) const {
        if (is_line()) {
            return from + share * (to - from);
        }
        const double turned = share * sweep_rad;
        const Vector2d arm = from - centre;
        return centre + Vector2d(std::cos(turned) * arm.x() - std::sin(turned) * arm.y(),
                                 std::sin(turned) * arm.x() + std::cos(turned) * arm.y());
    }

    // Unit, towards `to`.
    [[nodiscard]] Vector2d tangent(double share) const {
        if (is_line()) {
            return (to - from).normalized();
        }
        const Vector2d arm = at(share) - centre;
        return (sweep_rad > 0.0 ? 1.0 : -1.0) * Vector2d(-arm.y(), arm.x()).normalized();
    }

    [[nodiscard]] Piece reversed() const { return {to, from, centre, -sweep_rad}; }
};

// An arc between two points whose bulge is the tangent of a quarter of its angle.
Piece bulged(const Vector2d& from, const Vector2d& to, double bulge) {
    if (bulge == 0.0) {
        return {from, to};
    }
    const Vector2d half = 0.5 * (to - from);
    const double off = (1.0 - bulge * bulge) / (2.0 * bulge);
    return {from, to, from + half + off * Vector2d(-half.y(), half.x()), 4.0 * std::atan(bulge)};
}

double slope_of(const Vector2d& tangent) {
    return std::atan2(tangent.y(), tangent.x());
}

// Pairs of a code and a value, a line each.
class DxfText {
public:
    DxfText(std::string_view text, std::string file) : rest_(text), file_(std::move(file)) {
        if (text.substr(0, 18) == "AutoCAD Binary DXF") {
            refuse("profile.drawing", "is a binary DXF, only text is read; save it as ASCII DXF");
        }
    }

    bool next() {
        std::string_view code;
        while (code.empty()) {  // values may be empty, codes are not: blank lines behind the end
            if (rest_.empty()) {
                return false;
            }
            code = line();
        }
        const auto number = number_of(code);
        if (!number || *number != std::floor(*number) || std::abs(*number) > 9999.0) {
            refuse("profile.drawing", "has no group code of a DXF; save the drawing as ASCII DXF");
        }
        if (rest_.empty()) {
            refuse("profile.drawing", "ends behind a group code; save the drawing again");
        }
        code_ = static_cast<int>(*number);
        value_ = line();
        return true;
    }

    [[nodiscard]] int code() const { return code_; }
    [[nodiscard]] std::string_view value() const { return value_; }

    [[nodiscard]] double number() const {
        const auto number = number_of(value_);
        if (!number) {
            refuse("profile.drawing", "has no number where there must be one; save it again");
        }
        return *number;
    }

    [[noreturn]] void refuse(const char* code, const std::string& words) const {
        throw InputError(code, file_ + ":" + std::to_string(line_), words);
    }

private:
    std::string_view line() {
        const std::size_t end = std::min(rest_.find('\n'), rest_.size());
        std::string_view text = rest_.substr(0, end);
        rest_.remove_prefix(std::min(end + 1, rest_.size()));
        ++line_;
        constexpr std::string_view kBlanks = " \t\r";
        const std::size_t first = text.find_first_not_of(kBlanks);
        return first == std::string_view::npos
                   ? std::string_view()
                   : text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
    }

    // Finite.
    static std::optional<double> number_of(std::string_view text) {
        double value = 0.0;
        const char* const end = text.data() + text.size();
        const auto [rest, error] = std::from_chars(text.data(), end, value);
        return error == std::errc() && rest == end && std::isfinite(value) ? std::optional(value)
                                                                           : std::nullopt;
    }

    std::string_view rest_;
    std::string file_;
    int line_ = 0;
    int code_ = 0;
    std::string_view value_;
};

class DxfReader {
public:
    DxfReader(std::string_view text, const std::string& file) : text_(text, file) {}

    std::vector<Piece> read() {
        bool more = text_.next();
        while (more) {
            if (text_.code() == 2 && in_section_ && section_.empty()) {
                section_ = text_.value();
                more = text_.next();
            } else if (text_.code() == 0) {
                more = begin();
            } else if (text_.code() == 9 && section_ == "HEADER") {
                more = read_variable();
            } else {
                more = text_.next();
            }
        }
        if (!seen_entities_) {
            text_.refuse("profile.drawing",
                         "has no section ENTITIES; save the drawing as ASCII DXF");
        }
        return std::move(pieces_);
    }

    [[nodiscard]] double unit_mm() const { return unit_mm_; }

private:
    // What begins with a code 0. \return whether there is more
    bool begin() {
        const std::string kind(text_.value());
        if (kind == "SECTION") {
            in_section_ = true;
            section_.clear();
            return text_.next();
        }
        if (kind == "ENDSEC" || kind == "EOF") {
            in_section_ = false;
            section_.clear();
            return text_.next();
        }
        if (section_ != "ENTITIES") {
            return text_.next();
        }
        seen_entities_ = true;
        return entity(kind);
    }

    bool read_variable() {
        const bool units = text_.value() == "$INSUNITS";
        if (!text_.next()) {
            return false;
        }
        if (units && text_.code() == 70) {
            static const std::map<double, double> kUnits = {
                {1, 25.4}, {4, 1.0}, {5, 10.0}, {6, 1000.0}, {13, 1e-3}};
            const auto known = kUnits.find(text_.number());
            unit_mm_ = known != kUnits.end() ? known->second : 0.0;
        }
        return true;
    }

    // The pairs of an entity up to the next code 0: first of each code, and vertices as they come.
    struct Entity {
        std::map<int, double> number;
        std::vector<Vector2d> corner;
        std::vector<double> bulge;
    };

    bool pairs(Entity& entity) {
        bool more = text_.next();
        for (; more && text_.code() != 0; more = text_.next()) {
            const int code = text_.code();
            if (code == 10) {
                entity.corner.emplace_back(text_.number(), 0.0);
                entity.bulge.push_back(0.0);
            } else if (code == 20 && !entity.corner.empty()) {
                entity.corner.back().y() = text_.number();
            } else if (code == 42 && !entity.bulge.empty()) {
                entity.bulge.back() = text_.number();
            }
            if ((code >= 10 && code < 60) || code == 67 || code == 70) {
                entity.number.emplace(code, text_.number());
            }
            if (entity.corner.size() > kMostPieces) {
                text_.refuse("profile.points", "has more than 10,000 corners; give fewer");
            }
        }
        return more;
    }

    bool entity(const std::string& kind) {
        static const std::set<std::string> kNoOutline = {
            "TEXT",  "MTEXT",  "POINT",    "DIMENSION",   "LEADER",
            "HATCH", "ATTDEF", "VIEWPORT", "MULTILEADER", "SEQEND"};
        Entity read;
        const bool more = pairs(read);
        if (read.number.contains(67) && read.number.at(67) == 1.0) {
            return more;  // of a sheet, not of the part
        }
        const auto number = [&](int code) {
            const auto found = read.number.find(code);
            if (found == read.number.end()) {
                text_.refuse("profile.drawing", "ends a " + kind + " without its group " +
                                                    std::to_string(code) + "; save it again");
            }
            return found->second;
        };
        if (kind == "LINE") {
            add({{number(10), number(20)}, {number(11), number(21)}});
        } else if (kind == "ARC") {
            add_arc({number(10), number(20)}, number(40), number(50), number(51));
        } else if (kind == "LWPOLYLINE") {
            add_corners(read, read.number.contains(70) && closed(number(70)));
        } else if (kind == "POLYLINE") {
            return polyline(read, more);
        } else if (!kNoOutline.contains(kind)) {
            text_.refuse("profile.drawing", "is behind a " + kind +
                                                ", which is not read; explode it to lines, arcs "
                                                "and polylines");
        }
        return more;
    }

    static bool closed(double flags) { return std::fmod(flags, 2.0) == 1.0; }

    // VERTEX after VERTEX, to SEQEND.
    bool polyline(const Entity& head, bool more) {
        Entity all;
        while (more && text_.value() == "VERTEX") {
            Entity corner;
            more = pairs(corner);
            if (corner.corner.size() != 1) {
                text_.refuse("profile.drawing", "ends a VERTEX without its place; save it again");
            }
            all.corner.push_back(corner.corner.front());
            all.bulge.push_back(corner.bulge.front());
        }
        add_corners(all, head.number.contains(70) && closed(head.number.at(70)));
        return more;
    }

    void add_corners(const Entity& entity, bool is_closed) {
        const std::size_t count = entity.corner.size();
        for (std::size_t i = 0; i + (is_closed ? 0 : 1) < count; ++i) {
            add(bulged(entity.corner[i], entity.corner[(i + 1) % count], entity.bulge[i]));
        }
    }

    void add_arc(const Vector2d& centre, double radius, double from_deg, double to_deg) {
        if (!(radius > 0.0)) {
            text_.refuse("profile.drawing", "ends an ARC without a radius; save it again");
        }
        double sweep = std::fmod(to_deg - from_deg, 360.0);
        sweep += sweep <= 0.0 ? 360.0 : 0.0;
        const auto on_arc = [&](double angle_deg) {
            const double angle = rad_from_deg(angle_deg);
            return Vector2d(centre + radius * Vector2d(std::cos(angle), std::sin(angle)));
        };
        add({on_arc(from_deg), on_arc(from_deg + sweep), centre, rad_from_deg(sweep)});
    }

    void add(const Piece& piece) {
        if (piece.from == piece.to && piece.is_line()) {
            return;
        }
        if (pieces_.size() == kMostPieces) {
            text_.refuse("profile.points", "has more than 10,000 pieces; give fewer");
        }
        pieces_.push_back(piece);
    }

    DxfText text_;
    bool in_section_ = false;
    bool seen_entities_ = false;
    std::string section_;
    double unit_mm_ = 0.0;
    std::vector<Piece> pieces_;
};

// Puts pieces one behind the other, from the lower end to the upper one.
class Chain {
public:
    Chain(std::vector<Piece> pieces, std::string file) : file_(std::move(file)) {
        Eigen::AlignedBox2d box;
        for (const Piece& piece : pieces) {
            box.extend(piece.from);
            box.extend(piece.to);
        }
        same_ = box.isEmpty() ? 0.0 : kSamePlaceShare * box.sizes().norm();
        if (!box.isEmpty() && box.max().y() <= same_) {  // drawn below the axis
            for (Piece& piece : pieces) {
                for (Vector2d* p : {&piece.from, &piece.to, &piece.centre}) {
                    p->y() = -p->y();
                }
                piece.sweep_rad = -piece.sweep_rad;
            }
        }
        for (const Piece& piece : pieces) {
            if (!(piece.is_line() && std::abs(piece.from.y()) <= same_ &&
                  std::abs(piece.to.y()) <= same_)) {
                pieces_.push_back(piece);
            }
        }
        if (pieces_.empty()) {
            throw InputError("profile.points", file_,
                             "has no line or arc off the axis; draw the outline with the spindle "
                             "axis as y = 0");
        }
    }

    std::vector<Piece> in_order() {
        std::vector<Vector2d> ends;
        for (const Piece& piece : pieces_) {
            for (const Vector2d& p : {piece.from, piece.to}) {
                const auto count = meeting(p);
                if (count > 2) {
                    refuse(p, std::to_string(count) + " ends of pieces meet at ");
                }
                if (count == 1) {
                    ends.push_back(p);
                }
            }
        }
        if (ends.empty()) {
            refuse(pieces_.front().from, "the outline is closed: it comes back to ");
        }
        if (ends.size() > 2) {
            refuse(ends[1], std::to_string(ends.size()) + " ends of pieces meet no other, one at ");
        }
        return follow(ends[0].x() <= ends[1].x() ? ends[0] : ends[1]);
    }

private:
    [[nodiscard]] bool same(const Vector2d& a, const Vector2d& b) const {
        return (a - b).norm() <= same_;
    }

    [[nodiscard]] std::ptrdiff_t meeting(const Vector2d& place) const {
        std::ptrdiff_t count = 0;
        for (const Piece& piece : pieces_) {
            count += (same(piece.from, place) ? 1 : 0) + (same(piece.to, place) ? 1 : 0);
        }
        return count;
    }

    [[noreturn]] void refuse(const Vector2d& place, const std::string& words) const {
        throw InputError("profile.chain", file_,
                         words + "x = " + fixed(place.x(), 4) + ", y = " + fixed(place.y(), 4) +
                             "; draw the outside as one line from end to end, and nothing else");
    }

    std::vector<Piece> follow(Vector2d place) {
        std::vector<Piece> ordered;
        std::vector<Piece> left = pieces_;
        while (!left.empty()) {
            const auto next = std::find_if(left.begin(), left.end(), [&](const Piece& piece) {
                return same(piece.from, place) || same(piece.to, place);
            });
            if (next == left.end()) {  // a closed line beside the outline
                refuse(left.front().from, "another line goes through ");
            }
            ordered.push_back(same(next->from, place) ? *next : next->reversed());
            place = ordered.back().to;
            left.erase(next);
        }
        return ordered;
    }

    std::string file_;
    std::vector<Piece> pieces_;
    double same_ = 0.0;
};

class Nodes {
public:
    Nodes(std::vector<Piece> chain, std::string file, double unit_mm) : file_(std::move(file)) {
        profile_.stated_unit_mm = unit_mm;
        if (chain.back().to.x() == chain.front().from.x()) {
            throw InputError("profile.ends", file_,
                             "begins and ends at the same place along the axis; draw an outline "
                             "from one end to the other");
        }
        for (const Piece& piece : chain) {
            size_ =
                std::max({size_, piece.from.cwiseAbs().maxCoeff(), piece.to.cwiseAbs().maxCoeff()});
        }
        for (std::size_t i = 0; i < chain.size(); ++i) {
            add(chain[i], i > 0 ? &chain[i - 1] : nullptr);
        }
        add(chain.back().to);
        MeridianNode& last = profile_.nodes.back();
        if (!chain.back().is_line() && last.radius_mm > 0.0) {
            last.slope_rad = slope_of(chain.back().tangent(1.0));
        }
    }

    ProfileFile take() && { return std::move(profile_); }

private:
    void add(const Piece& piece, const Piece* before) {
        MeridianNode& first = add(piece.from);
        first.straight = piece.is_line();
        if (before != nullptr) {
            const Vector2d a = before->tangent(1.0);
            const Vector2d b = piece.tangent(0.0);
            first.crease =
                std::abs(std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b))) > kCrease_rad;
            first.joint = !first.crease;
            first.slope_before_rad = first.crease ? std::optional(slope_of(a)) : std::nullopt;
        }
        if (!piece.is_line() && (first.crease || first.radius_mm > 0.0)) {
            first.slope_rad = slope_of(piece.tangent(0.0));
        }
        const int steps =
            piece.is_line()
                ? 1
                : std::max(kFewestSteps,
                           static_cast<int>(std::ceil(std::abs(piece.sweep_rad) / kNode_rad)));
        for (int k = 1; k < steps; ++k) {
            add(piece.at(static_cast<double>(k) / steps));
        }
    }

    MeridianNode& add(const Vector2d& drawn) {
        MeridianNode& node = profile_.nodes.emplace_back();
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

    std::string file_;
    double size_ = 0.0;
    ProfileFile profile_;
};

}  // namespace

ProfileFile read_profile_dxf(std::string_view text, const std::string& file) {
    DxfReader reader(text, file);
    std::vector<Piece> pieces = reader.read();
    return Nodes(Chain(std::move(pieces), file).in_order(), file, reader.unit_mm()).take();
}

}  // namespace meshwind
