#include "postproc/robot/dialects.h"

#include "core/error.h"
#include "postproc/nc/nc_dialects.h"
#include "postproc/nc/pulses.h"
#include "postproc/robot/krl_program.h"
#include "postproc/robot/rapid.h"

namespace meshwind {

std::vector<std::string> dialect_names() {
    std::vector<std::string> names;
    for (const NcFlavour* flavour : nc_flavours()) {
        names.emplace_back(flavour->dialect);
    }
    names.push_back(Pulses().name());
    names.push_back(Rapid().name());
    names.push_back(Krl().name());
    return names;
}

std::unique_ptr<Dialect> make_dialect(std::string_view name) {
    for (const NcFlavour* flavour : nc_flavours()) {
        if (flavour->dialect == name) {
            return std::make_unique<NcDialect>(*flavour);
        }
    }
    if (name == Pulses().name()) {
        return std::make_unique<Pulses>();
    }
    if (name == Rapid().name()) {
        return std::make_unique<Rapid>();
    }
    if (name == Krl().name()) {
        return std::make_unique<Krl>();
    }
    std::string known;
    for (const std::string& word : dialect_names()) {
        known += (known.empty() ? "" : ", ") + word;
    }
    throw InputError("dialect.unknown", "",
                     "dialect \"" + std::string(name) + "\" is not known; choose one of " + known);
}

}  // namespace meshwind
