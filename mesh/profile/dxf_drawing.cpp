#include "mesh/profile/dxf_drawing.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "core/error.h"
#include "core/units.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;

// They are put in order by trying each with each.
constexpr std::size_t kMaxPieces = 10'000;

// An arc between two points whose bulge is the tangent of a quarter of its angle.
DrawnPiece bulged(const Vector2d& from, const Vector2d& to, double bulge) {
    if (bulge == 0.0) {
        return {from, to};
    }
    const Vector2d half = 0.5 * (to - from);
    const double off = (1.0 - bulge * bulge) / (2.0 * bulge);
    return {from, to, from + half + off * Vector2d(-half.y(), half.x()), 4.0 * std::atan(bulge)};
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

// The pairs of an entity up to the next code 0: first of each code, and vertices as they come.
struct Entity {
    std::map<int, double> number;
    std::vector<Vector2d> corner;
    std::vector<double> bulge;
};

// \return whether there is more
bool read_pairs(DxfText& text, Entity& entity) {
    bool more = text.next();
    for (; more && text.code() != 0; more = text.next()) {
        const int code = text.code();
        if (code == 10) {
            entity.corner.emplace_back(text.number(), 0.0);
            entity.bulge.push_back(0.0);
        } else if (code == 20 && !entity.corner.empty()) {
            entity.corner.back().y() = text.number();
        } else if (code == 42 && !entity.bulge.empty()) {
            entity.bulge.back() = text.number();
        }
        if ((code >= 10 && code < 60) || code == 67 || code == 70) {
            entity.number.emplace(code, text.number());
        }
        if (entity.corner.size() > kMaxPieces) {
            text.refuse("profile.points", "has more than 10,000 corners; give fewer");
        }
    }
    return more;
}

bool closed(double flags) {
    return std::fmod(flags, 2.0) == 1.0;
}

// Adds a piece, but no line of length 0.
void add(const DrawnPiece& piece, const DxfText& text, std::vector<DrawnPiece>& pieces) {
    if (piece.from == piece.to && piece.is_line()) {
        return;
    }
    if (pieces.size() == kMaxPieces) {
        text.refuse("profile.points", "has more than 10,000 pieces; give fewer");
    }
    pieces.push_back(piece);
}

void add_corners(const Entity& entity, bool is_closed, const DxfText& text,
                 std::vector<DrawnPiece>& pieces) {
    const std::size_t count = entity.corner.size();
    for (std::size_t i = 0; i + (is_closed ? 0 : 1) < count; ++i) {
        add(bulged(entity.corner[i], entity.corner[(i + 1) % count], entity.bulge[i]), text,
            pieces);
    }
}

DrawnPiece arc_of(const DxfText& text, const Vector2d& centre, double radius, double from_deg,
                  double to_deg) {
    if (!(radius > 0.0)) {
        text.refuse("profile.drawing", "ends an ARC without a radius; save it again");
    }
    double sweep = std::fmod(to_deg - from_deg, 360.0);
    sweep += sweep <= 0.0 ? 360.0 : 0.0;
    const auto on_arc = [&](double angle_deg) {
        const double angle = rad_from_deg(angle_deg);
        return Vector2d(centre + radius * Vector2d(std::cos(angle), std::sin(angle)));
    };
    return {on_arc(from_deg), on_arc(from_deg + sweep), centre, rad_from_deg(sweep)};
}

// VERTEX after VERTEX, to SEQEND.
// \return whether there is more
bool read_polyline(DxfText& text, const Entity& head, bool more, std::vector<DrawnPiece>& pieces) {
    Entity all;
    while (more && text.value() == "VERTEX") {
        Entity corner;
        more = read_pairs(text, corner);
        if (corner.corner.size() != 1) {
            text.refuse("profile.drawing", "ends a VERTEX without its place; save it again");
        }
        all.corner.push_back(corner.corner.front());
        all.bulge.push_back(corner.bulge.front());
    }
    add_corners(all, head.number.contains(70) && closed(head.number.at(70)), text, pieces);
    return more;
}

// \return whether there is more
bool read_entity(DxfText& text, const std::string& kind, std::vector<DrawnPiece>& pieces) {
    static const std::set<std::string> kNoOutline = {"TEXT",        "MTEXT", "POINT",  "DIMENSION",
                                                     "LEADER",      "HATCH", "ATTDEF", "VIEWPORT",
                                                     "MULTILEADER", "SEQEND"};
    Entity read;
    const bool more = read_pairs(text, read);
    if (read.number.contains(67) && read.number.at(67) == 1.0) {
        return more;  // of a sheet, not of the part
    }
    const auto number = [&](int code) {
        const auto found = read.number.find(code);
        if (found == read.number.end()) {
            text.refuse("profile.drawing", "ends a " + kind + " without its group " +
                                               std::to_string(code) + "; save it again");
        }
        return found->second;
    };
    if (kind == "LINE") {
        add({{number(10), number(20)}, {number(11), number(21)}}, text, pieces);
    } else if (kind == "ARC") {
        add(arc_of(text, {number(10), number(20)}, number(40), number(50), number(51)), text,
            pieces);
    } else if (kind == "LWPOLYLINE") {
        add_corners(read, read.number.contains(70) && closed(number(70)), text, pieces);
    } else if (kind == "POLYLINE") {
        return read_polyline(text, read, more, pieces);
    } else if (!kNoOutline.contains(kind)) {
        text.refuse("profile.drawing", "is behind a " + kind +
                                           ", which is not read; explode it to lines, arcs "
                                           "and polylines");
    }
    return more;
}

// Of the header. \return whether there is more
bool read_variable(DxfText& text, double& unit_mm) {
    const bool units = text.value() == "$INSUNITS";
    if (!text.next()) {
        return false;
    }
    if (units && text.code() == 70) {
        static const std::map<double, double> kUnits = {
            {1, 25.4}, {4, 1.0}, {5, 10.0}, {6, 1000.0}, {13, 1e-3}};
        const auto known = kUnits.find(text.number());
        unit_mm = known != kUnits.end() ? known->second : 0.0;
    }
    return true;
}

// How far a drawing is read.
struct ReadDrawing {
    DxfDrawing drawing;
    bool in_section = false;
    bool seen_entities = false;
    std::string section;
};

// What begins with a code 0. \return whether there is more
bool begin(DxfText& text, ReadDrawing& read) {
    const std::string kind(text.value());
    if (kind == "SECTION") {
        read.in_section = true;
        read.section.clear();
        return text.next();
    }
    if (kind == "ENDSEC" || kind == "EOF") {
        read.in_section = false;
        read.section.clear();
        return text.next();
    }
    if (read.section != "ENTITIES") {
        return text.next();
    }
    read.seen_entities = true;
    return read_entity(text, kind, read.drawing.pieces);
}

}  // namespace

Vector2d DrawnPiece::at(double share) const {
    if (is_line()) {
        return from + share * (to - from);
    }
    const double turned = share * sweep_rad;
    const Vector2d arm = from - centre;
    return centre + Vector2d(std::cos(turned) * arm.x() - std::sin(turned) * arm.y(),
                             std::sin(turned) * arm.x() + std::cos(turned) * arm.y());
}

Vector2d DrawnPiece::tangent(double share) const {
    if (is_line()) {
        return (to - from).normalized();
    }
    const Vector2d arm = at(share) - centre;
    return (sweep_rad > 0.0 ? 1.0 : -1.0) * Vector2d(-arm.y(), arm.x()).normalized();
}

DxfDrawing read_dxf(std::string_view text, const std::string& file) {
    DxfText pairs(text, file);
    ReadDrawing read;
    bool more = pairs.next();
    while (more) {
        if (pairs.code() == 2 && read.in_section && read.section.empty()) {
            read.section = pairs.value();
            more = pairs.next();
        } else if (pairs.code() == 0) {
            more = begin(pairs, read);
        } else if (pairs.code() == 9 && read.section == "HEADER") {
            more = read_variable(pairs, read.drawing.unit_mm);
        } else {
            more = pairs.next();
        }
    }
    if (!read.seen_entities) {
        pairs.refuse("profile.drawing", "has no section ENTITIES; save the drawing as ASCII DXF");
    }
    return std::move(read.drawing);
}

}  // namespace meshwind
