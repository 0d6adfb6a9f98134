#include "cli/make_command.h"

#include <iostream>

#include "core/error.h"
#include "core/files/write_file.h"
#include "core/text/text_number.h"
#include "mesh/io/export.h"

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
                value->second = parameter.value_of_shown(value->second);
            }
        }
    }
    return values;
}

}  // namespace

std::string help_of(const MakeParameter& parameter) {
    std::string text(parameter.meaning);
    const std::string unit(parameter.shown_unit());
    text += (unit.empty() ? "" : ", ") + unit + " [";
    append_shortest(text, parameter.shown(parameter.value_default));
    return text + "]";
}

std::string run_make(const MakeRequest& request) {
    (void)mesh_format_of(request.output);
    const TriangleSoup soup = make_mandrel(request.kind, values_of(request), request.options);
    write_file(request.output, mesh_file_bytes(soup, mesh_format_of(request.output)));
    return request.output.string() + ": " + std::to_string(soup.points_mm.size()) + " points, " +
           std::to_string(soup.faces.size()) + " triangles, " + fixed(area_mm2(soup), 1) + " mm^2";
}

int run_make_command(MakeRequest& request, const Common& common) {
    if (request.output.empty()) {
        throw InputError("cli.output", "make", "name the mesh file to write with -o FILE");
    }
    request.options.seed = common.seed;
    const std::string line = run_make(request);
    if (!common.quiet) {
        std::cout << line << '\n';
    }
    return kDone;
}

}  // namespace meshwind
