/// What `verify --plan` says of a changed program.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <string>

#include "core/error.h"
#include "pipeline/setup.h"
#include "pipeline/verify_text.h"

namespace meshwind::test {

struct Answer {
    bool seen = false;
    std::string by{};       ///< the check, or the error's code
    std::int32_t line = 0;  ///< that it names; 0: none
};

inline Answer answer_of(const Setup& setup, const VerifyPlan& plan, const std::string& file,
                        const std::string& text) {
    try {
        const BlockList list = setup.dialect->read(text, file, setup.machine);
        const TextChecks texts = check_text(setup, text, file, list, plan);
        for (const Check& check : texts.checks) {
            if (!check.ok) {
                return {true, check.name, list.blocks[texts.first_wrong.value_or(0)].line};
            }
        }
        const Verification wound = verify_program(setup, list, plan.fibre);
        for (const Check& check : wound.checks) {
            if (!check.ok) {
                return {true, check.name, list.blocks[wound.first_wrong_block.value_or(0)].line};
            }
        }
    } catch (const InputError& error) {
        const std::string place = error.place();
        const std::size_t colon = place.rfind(':');
        return {true, error.code(),
                colon == std::string::npos ? 0 : std::atoi(place.c_str() + colon + 1)};
    }
    return {};
}

}  // namespace meshwind::test
