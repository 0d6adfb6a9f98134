#include "postproc/tables/fibre_lines.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string_view>
#include <utility>

#include "core/text/text_number.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr int kLengthDecimals = 4;  // as in path.csv

double distance_mm(const Vector3d& point, const Vector3d& from, const Vector3d& to) {
    const Vector3d step = to - from;
    const double squared = step.squaredNorm();
    const double share =
        squared > 0.0 ? std::clamp((point - from).dot(step) / squared, 0.0, 1.0) : 0.0;
    return (point - from - share * step).norm();
}

std::vector<Vector3d> thinned(const SurfacePath& path, double chord_mm) {
    std::vector<char> kept(path.size(), 0);
    kept.front() = kept.back() = 1;
    std::vector<std::pair<std::size_t, std::size_t>> open{{0, path.size() - 1}};
    while (!open.empty()) {
        const auto [first, last] = open.back();
        open.pop_back();
        double farthest_mm = chord_mm;
        std::size_t farthest = first;
        for (std::size_t i = first + 1; i < last; ++i) {
            const double off_mm =
                distance_mm(path[i].position_mm, path[first].position_mm, path[last].position_mm);
            if (off_mm > farthest_mm) {
                farthest_mm = off_mm;
                farthest = i;
            }
        }
        if (farthest != first) {
            kept[farthest] = 1;
            open.emplace_back(first, farthest);
            open.emplace_back(farthest, last);
        }
    }
    std::vector<Vector3d> points;
    for (std::size_t i = 0; i < path.size(); ++i) {
        if (kept[i] != 0) {
            points.push_back(path[i].position_mm);
        }
    }
    return points;
}

void append_point(std::string& text, const Vector3d& point, char between) {
    for (int k = 0; k < 3; ++k) {
        if (k > 0) {
            text += between;
        }
        append_fixed(text, point[k], kLengthDecimals);
    }
}

// Instances of a STEP file, numbered as they come.
class StepData {
public:
    // \return the number of the instance
    int add(const std::string& entity) {
        text_ += '#' + std::to_string(next_) + '=' + entity + ";\n";
        return next_++;
    }

    [[nodiscard]] static std::string of(int instance) { return '#' + std::to_string(instance); }

    [[nodiscard]] static std::string list(std::span<const int> instances) {
        std::string text = "(";
        for (const int instance : instances) {
            text += (text.size() > 1 ? "," : "") + of(instance);
        }
        return text + ')';
    }

    [[nodiscard]] const std::string& text() const { return text_; }

private:
    std::string text_;
    int next_ = 1;
};

// The code point that UTF-8 text begins with, which is taken away; of what is no UTF-8 the byte.
std::uint32_t take_code_point(std::string_view& text) {
    const auto byte = [&](std::size_t i) -> std::uint32_t {
        return static_cast<unsigned char>(text[i]);
    };
    const std::size_t follow = byte(0) >= 0xF0U   ? 3
                               : byte(0) >= 0xE0U ? 2
                               : byte(0) >= 0xC0U ? 1
                                                  : 0;
    std::uint32_t code = byte(0);
    if (follow > 0 && follow < text.size()) {
        std::uint32_t longer = byte(0) & (0x3FU >> follow);
        std::size_t n = 1;
        for (; n <= follow && (byte(n) & 0xC0U) == 0x80U; ++n) {
            longer = (longer << 6U) | (byte(n) & 0x3FU);
        }
        if (n > follow) {
            text.remove_prefix(follow);
            code = longer;
        }
    }
    text.remove_prefix(1);
    return code;
}

// In quotes; within them a quote is doubled, and so is a backslash. Other characters than plain
// ASCII are written by their code points, "\X2\00E4\X0\" (ISO 10303-21, 6.4.3.3).
std::string step_text(std::string_view raw) {
    std::string text = "'";
    while (!raw.empty()) {
        const std::uint32_t code = take_code_point(raw);
        if (code >= ' ' && code <= '~') {
            text.append(code == '\'' || code == '\\' ? 2 : 1, static_cast<char>(code));
            continue;
        }
        std::array<char, 9> digits{};
        (void)std::snprintf(digits.data(), digits.size(), code > 0xFFFFU ? "%08X" : "%04X", code);
        text += code > 0xFFFFU ? "\\X4\\" : "\\X2\\";
        text += digits.data();
        text += "\\X0\\";
    }
    return text + '\'';
}

// One line, without what a reader of OBJ takes for more than a name.
std::string obj_name(std::string name) {
    for (char& c : name) {
        c = c <= ' ' || c > '~' || c == '#' || c == '\\' ? '_' : c;
    }
    return name;
}

int add_context(StepData& data) {
    const std::string mm =
        StepData::of(data.add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))"));
    const std::string rad =
        StepData::of(data.add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))"));
    const std::string sr =
        StepData::of(data.add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())"));
    const std::string accuracy = StepData::of(
        data.add("UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(" + fixed(kFibreChord_mm, 4) + ")," +
                 mm + ",'distance_accuracy_value','polyline against stations')"));
    return data.add("(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((" +
                    accuracy + "))GLOBAL_UNIT_ASSIGNED_CONTEXT((" + mm + "," + rad + "," + sr +
                    "))REPRESENTATION_CONTEXT('','3D'))");
}

int add_frame(StepData& data) {
    const std::string origin = StepData::of(data.add("CARTESIAN_POINT('',(0.,0.,0.))"));
    const std::string z = StepData::of(data.add("DIRECTION('',(0.,0.,1.))"));
    const std::string x = StepData::of(data.add("DIRECTION('',(1.,0.,0.))"));
    return data.add("AXIS2_PLACEMENT3D('mandrel'," + origin + "," + z + "," + x + ")");
}

int add_line(StepData& data, const FibreLine& line) {
    std::vector<int> points;
    for (const Vector3d& point : line.points_mm) {
        std::string entity = "CARTESIAN_POINT('',(";
        append_point(entity, point, ',');
        points.push_back(data.add(entity + "))"));
    }
    const std::string name = step_text(line.name);
    const int polyline = data.add("POLYLINE(" + name + "," + StepData::list(points) + ")");
    return data.add("GEOMETRIC_CURVE_SET(" + name + ",(" + StepData::of(polyline) + "))");
}

// Says of which product the wireframe is the shape.
void add_product(StepData& data, const std::string& product, int wireframe) {
    const std::string name = step_text(product);
    const std::string application = StepData::of(
        data.add("APPLICATION_CONTEXT('core data for automotive mechanical design processes')"));
    data.add("APPLICATION_PROTOCOL_DEFINITION('international standard','automotive_design',2000," +
             application + ")");
    const std::string context =
        StepData::of(data.add("PRODUCT_CONTEXT(''," + application + ",'mechanical')"));
    const std::string part =
        StepData::of(data.add("PRODUCT(" + name + "," + name + ",'',(" + context + "))"));
    data.add("PRODUCT_RELATED_PRODUCT_CATEGORY('part',$,(" + part + "))");
    const std::string formation =
        StepData::of(data.add("PRODUCT_DEFINITION_FORMATION('',''," + part + ")"));
    const std::string stage = StepData::of(
        data.add("PRODUCT_DEFINITION_CONTEXT('part definition'," + application + ",'design')"));
    const std::string definition =
        StepData::of(data.add("PRODUCT_DEFINITION('design',''," + formation + "," + stage + ")"));
    const std::string shape =
        StepData::of(data.add("PRODUCT_DEFINITION_SHAPE('',''," + definition + ")"));
    data.add("SHAPE_DEFINITION_REPRESENTATION(" + shape + "," + StepData::of(wireframe) + ")");
}

}  // namespace

std::vector<FibreLine> fibre_lines(std::span<const Piece> fibre, double chord_mm) {
    std::vector<FibreLine> lines;
    for (std::size_t i = 0; i < fibre.size(); ++i) {
        const Piece& piece = fibre[i];
        if (piece.path.size() < 2 || !(piece.path.back().s_mm > piece.path.front().s_mm)) {
            continue;
        }
        const char* kind = piece.kind == PieceKind::Course ? "course_" : "transition_";
        lines.push_back({kind + std::to_string(i), thinned(piece.path, chord_mm)});
    }
    return lines;
}

std::string fibre_obj(std::span<const FibreLine> lines) {
    std::string text = "# Fibre by meshwind, mandrel frame, mm\n";
    std::size_t next = 1;
    for (const FibreLine& line : lines) {
        text += "o " + obj_name(line.name) + '\n';
        for (const Vector3d& point : line.points_mm) {
            text += "v ";
            append_point(text, point, ' ');
            text += '\n';
        }
        text += 'l';
        for (std::size_t i = 0; i < line.points_mm.size(); ++i) {
            text += ' ' + std::to_string(next++);
        }
        text += '\n';
    }
    return text;
}

std::string fibre_step(std::span<const FibreLine> lines, const std::string& product,
                       const std::string& version) {
    StepData data;
    const int context = add_context(data);
    std::vector<int> items{add_frame(data)};
    for (const FibreLine& line : lines) {
        items.push_back(add_line(data, line));
    }
    const int wireframe =
        data.add("GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION(" + step_text(product) +
                 "," + StepData::list(items) + "," + StepData::of(context) + ")");
    add_product(data, product, wireframe);
    return "ISO-10303-21;\nHEADER;\n"
           "FILE_DESCRIPTION(('fibre as polylines, mandrel frame'),'2;1');\n"
           "FILE_NAME(" +
           step_text(product) + ",'1970-01-01T00:00:00',(''),(''),'meshwind " + version +
           "','meshwind','');\n"
           "FILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }'));\n"
           "ENDSEC;\nDATA;\n" +
           data.text() + "ENDSEC;\nEND-ISO-10303-21;\n";
}

}  // namespace meshwind
