#include "postproc/robot/dialects.h"

#include <array>

#include "core/error.h"
#include "postproc/nc/nc_dialects.h"
#include "postproc/nc/pulses.h"
#include "postproc/robot/krl_program.h"
#include "postproc/robot/rapid.h"
#include "postproc/robot/tp_program.h"

namespace meshwind {
namespace {

template <typename Language>
std::unique_ptr<Dialect> make() {
    return std::make_unique<Language>();
}

// Languages that are no flavour of G-code.
constexpr std::array kOthers = {make<Pulses>, make<Rapid>, make<Krl>, make<Tp>};

}  // namespace

std::vector<std::string> dialect_names() {
    std::vector<std::string> names;
    for (const NcFlavour* flavour : nc_flavours()) {
        names.emplace_back(flavour->dialect);
    }
    for (const auto& make_other : kOthers) {
        names.push_back(make_other()->name());
    }
    return names;
}

std::unique_ptr<Dialect> make_dialect(std::string_view name) {
    for (const NcFlavour* flavour : nc_flavours()) {
        if (flavour->dialect == name) {
            return std::make_unique<NcDialect>(*flavour);
        }
    }
    for (const auto& make_other : kOthers) {
        if (std::unique_ptr<Dialect> other = make_other(); other->name() == name) {
            return other;
        }
    }
    std::string known;
    for (const std::string& word : dialect_names()) {
        known += (known.empty() ? "" : ", ") + word;
    }
    throw InputError("dialect.unknown", "",
                     "dialect \"" + std::string(name) + "\" is not known; choose one of " + known);
}

}  // namespace meshwind
