#include "truth.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <sstream>

#include <gp_Vec.hxx>

namespace cad_part {
namespace {

std::string text(double value) {
    std::array<char, 40> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value + 0.0);
    return {digits.data(), end.ptr};
}

std::string text(const std::optional<double>& value) {
    return value ? text(*value) : "null";
}

// Builds an object key by key; values are JSON already.
class Object {
public:
    explicit Object(const char* between) : between_(between) {}

    Object& add(const char* key, const std::string& value) {
        out_ << (first_ ? "" : between_) << '"' << key << "\": " << value;
        first_ = false;
        return *this;
    }
    Object& add(const char* key, bool value) {
        return add(key, std::string(value ? "true" : "false"));
    }
    Object& add(const char* key, const gp_XYZ& v) {
        std::ostringstream list;
        list << '[' << text(v.X()) << ", " << text(v.Y()) << ", " << text(v.Z()) << ']';
        return add(key, list.str());
    }
    Object& add_word(const char* key, const std::string& word) {
        std::ostringstream quoted;
        quoted << '"' << word << '"';
        return add(key, quoted.str());
    }
    Object& add_words(const char* key, const std::vector<std::string>& words) {
        std::ostringstream list;
        list << '[';
        for (std::size_t i = 0; i < words.size(); ++i) {
            list << (i == 0 ? "\"" : ", \"") << words[i] << '"';
        }
        list << ']';
        return add(key, list.str());
    }

    [[nodiscard]] std::string json() const {
        std::ostringstream whole;
        whole << '{' << out_.str() << '}';
        return whole.str();
    }

private:
    const char* between_;
    std::ostringstream out_;
    bool first_ = true;
};

std::string leg_json(const Leg& leg, const ExportOptions& options) {
    const gp_Vec direction(leg.frame.Direction());
    const gp_Pnt end = leg.frame.Location().Translated(direction * leg.length_mm);
    const double unit = options.unit_mm;
    return Object(", ")
        .add("centre", end.Transformed(options.motion).XYZ() / unit)
        .add("axis", direction.Transformed(options.motion).XYZ())
        .add("radius", text(leg.end_radius_mm() / unit))
        .add("length", text(leg.length_mm / unit))
        .add("free_length", text((leg.length_mm - leg.free_from_mm) / unit))
        .add("socket", leg.socket.has_value())
        .add("step", leg.step.has_value())
        .add("tabs", leg.tabs)
        .json();
}

std::string legs_json(const Part& part, const ExportOptions& options) {
    std::ostringstream list;
    for (const Leg& leg : part.legs) {
        list << (&leg == part.legs.data() ? "[\n  " : ",\n  ") << leg_json(leg, options);
    }
    list << ']';
    return list.str();
}

std::string axis_json(const Part& part, const ExportOptions& options) {
    if (!part.axis) {
        return "null";
    }
    const gp_Ax1 moved = part.axis->Transformed(options.motion);
    return Object(", ")
        .add("origin", moved.Location().XYZ() / options.unit_mm)
        .add("direction", moved.Direction().XYZ())
        .json();
}

std::string export_json(const ExportOptions& options, std::size_t triangles) {
    return Object(", ")
        .add("linear", text(options.linear_mm))
        .add("relative", options.relative)
        .add("angular_rad", text(options.angular_rad))
        .add("seams", options.seams)
        .add("inverted", options.inverted)
        .add("moved", options.moved)
        .add("triangles", std::to_string(triangles))
        .json();
}

}  // namespace

std::string truth_json(std::uint64_t seed, const std::string& file, const Part& part,
                       const ExportOptions& options, std::size_t triangles) {
    double least_mm = part.legs.front().radius_mm;
    for (const Leg& leg : part.legs) {
        least_mm = std::min({least_mm, leg.radius_mm, leg.end_radius_mm()});
    }
    Object truth(",\n ");
    truth.add("seed", std::to_string(seed)).add_word("file", file).add_word("kind", part.kind);
    truth.add_words("details", part.details);
    if (part.cause.empty()) {
        truth.add("cause", std::string("null"));
    } else {
        truth.add_word("cause", part.cause);
    }
    if (part.legs.size() > 2 || part.ball_mm) {
        truth.add_word("crotch", part.fillet_mm ? "filleted" : "sharp");
    } else {
        truth.add("crotch", std::string("null"));
    }
    truth.add("fillet_mm", text(part.fillet_mm)).add("wall_mm", text(part.wall_mm));
    truth.add_word("unit", std::string(options.unit)).add("unit_mm", text(options.unit_mm));
    truth.add_words("options", options.unit == "mm" ? std::vector<std::string>{}
                                                    : std::vector<std::string>{
                                                          "--units", std::string(options.unit)});
    truth.add("export", export_json(options, triangles));
    truth.add("smallest_diameter_mm", text(2.0 * least_mm));
    truth.add("axis", axis_json(part, options)).add("legs", legs_json(part, options));
    std::ostringstream file_text;
    file_text << truth.json() << '\n';
    return file_text.str();
}

}  // namespace cad_part
