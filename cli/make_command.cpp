#include "cli/make_command.h"

#include "cli/output_files.h"
#include "core/text_number.h"
#include "core/units.h"
#include "mesh/export.h"

namespace meshwind {
namespace {

// Values in mm and rad; names that the kind does not know stay as they are and are refused by
// make_mandrel.
MakeValues values_of(const MakeRequest& request) {
    MakeValues values = request.shown_values;
    for (const MakeKind& kind : make_kinds()) {
        if (kind.name != request.kind) {
            continue;
        }
        for (const MakeParameter& parameter : kind.parameters) {
            const auto value = values.find(parameter.name);
            if (value != values.end()) {
                value->second = value_of_shown(parameter, value->second);
            }
        }
    }
    return values;
}

}  // namespace

double shown_value(const MakeParameter& parameter, double value) {
    return parameter.unit == MakeUnit::Angle ? deg_from_rad(value) : value;
}

double value_of_shown(const MakeParameter& parameter, double shown) {
    return parameter.unit == MakeUnit::Angle ? rad_from_deg(shown) : shown;
}

std::string shown_unit(const MakeParameter& parameter) {
    switch (parameter.unit) {
        case MakeUnit::Angle:
            return "deg";
        case MakeUnit::Ratio:
            return "";
        default:
            return "mm";
    }
}

std::string help_of(const MakeParameter& parameter) {
    std::string text(parameter.meaning);
    const std::string unit = shown_unit(parameter);
    text += (unit.empty() ? "" : ", ") + unit + " [";
    append_shortest(text, shown_value(parameter, parameter.value_default));
    return text + "]";
}

std::string run_make(const MakeRequest& request) {
    (void)mesh_format_of(request.output);
    const TriangleSoup soup = make_mandrel(request.kind, values_of(request), request.options);
    write_file(request.output, mesh_file_bytes(soup, mesh_format_of(request.output)));
    return request.output.string() + ": " + std::to_string(soup.points_mm.size()) + " points, " +
           std::to_string(soup.faces.size()) + " triangles, " + fixed(area_mm2(soup), 1) + " mm^2";
}

}  // namespace meshwind
