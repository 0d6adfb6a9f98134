#include "postproc/dialect.h"

#include <array>
#include <utility>

#include "core/error.h"
#include "postproc/linuxcnc.h"
#include "postproc/pulses.h"

namespace meshwind {
namespace {

using Maker = std::unique_ptr<Dialect> (*)();

template <class Kind>
std::unique_ptr<Dialect> make() {
    return std::make_unique<Kind>();
}

// One line per dialect.
constexpr std::array<std::pair<std::string_view, Maker>, 6> kDialects = {{
    {"linuxcnc", make<LinuxCnc>},
    {"fanuc", make<Fanuc>},
    {"siemens", make<Siemens>},
    {"grbl", make<Grbl>},
    {"marlin", make<Marlin>},
    {"pulses", make<Pulses>},
}};

}  // namespace

void Dialect::check(const Machine& machine) const {
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

std::vector<std::string> dialect_names() {
    std::vector<std::string> names;
    names.reserve(std::size(kDialects));
    for (const auto& [word, maker] : kDialects) {
        names.emplace_back(word);
    }
    return names;
}

std::unique_ptr<Dialect> make_dialect(std::string_view name) {
    std::string known;
    for (const auto& [word, maker] : kDialects) {
        if (word == name) {
            return maker();
        }
        known += (known.empty() ? "" : ", ") + std::string(word);
    }
    throw InputError("dialect.unknown", "",
                     "dialect \"" + std::string(name) + "\" is not known; choose one of " + known +
                         " (KRL is written by meshwind carry)");
}

}  // namespace meshwind
