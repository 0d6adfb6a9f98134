#include "postproc/dialect.h"

#include <array>
#include <utility>

#include "core/error.h"
#include "postproc/linuxcnc.h"

namespace meshwind {
namespace {

using Maker = std::unique_ptr<Dialect> (*)();

template <class Kind>
std::unique_ptr<Dialect> make() {
    return std::make_unique<Kind>();
}

// One line per dialect.
constexpr std::array<std::pair<std::string_view, Maker>, 1> kDialects = {{
    {"linuxcnc", make<LinuxCnc>},
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
