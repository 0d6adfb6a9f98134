#include "postproc/nc/dialect.h"

#include <numeric>

#include "core/error.h"

namespace meshwind {

double Dialect::run_time_s(const Machine& machine, const BlockList& list) const {
    const std::vector<double> times_s = run_times_s(machine, list);
    return std::accumulate(times_s.begin(), times_s.end(), 0.0);
}

void Dialect::check(const Machine& machine) const {
    if (machine.controller.junction_deviation_mm && !has_junction_deviation()) {
        throw InputError(
            "dialect.junction_deviation", machine.name,
            "\"junction_deviation\" is a setting of grbl; remove it, " + name() + " has none");
    }
    BlockList list;
    for (std::size_t a = 0; a < machine.axis_count(); ++a) {
        const Axis& axis = machine.axis(a);
        list.axes.push_back({axis.letter, axis.type, axis.resolution_nano});
    }
    list.blocks = {{}, {.duration_s = 1.0}};
    list.nano.assign(2 * list.axes.size(), 0);
    for (std::size_t a = 0; a < list.axes.size(); ++a) {
        list.nano[list.axes.size() + a] = list.axes[a].resolution_nano;
    }
    // A name that no controller takes for a command: it may stand in comments alone.
    const ProgramHeader header{.version = "version", .mandrel = "part.stl"};
    (void)write(machine, list, header);
}

}  // namespace meshwind
