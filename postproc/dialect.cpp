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

std::unique_ptr<Dialect> make_dialect(std::string_view name) {
    std::string known;
    for (const auto& [word, maker] : kDialects) {
        if (word == name) {
            return maker();
        }
        known += (known.empty() ? "" : ", ") + std::string(word);
    }
    throw InputError("dialect.unknown", "",
                     "dialect \"" + std::string(name) + "\" is not known; choose one of " + known);
}

}  // namespace meshwind
