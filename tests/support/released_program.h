/// A program of the main job with the plan that it came from, and what `verify --plan` says of it
/// when it was changed.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "pipeline/code_digest.h"
#include "pipeline/setup.h"
#include "pipeline/verify_text.h"
#include "pipeline/wind.h"
#include "postproc/nc/nc_reader.h"
#include "postproc/tables/motion_csv.h"
#include "postproc/tables/path_csv.h"

namespace meshwind::test {

using Lines = std::vector<std::string>;

inline unsigned from_environment(const char* name, unsigned value) {
    const char* const text = std::getenv(name);
    return text != nullptr ? static_cast<unsigned>(std::strtoul(text, nullptr, 10)) : value;
}

inline std::string text_of(const Lines& lines) {
    std::string text;
    for (const std::string& line : lines) {
        text += line + '\n';
    }
    return text;
}

struct ReleasedProgram {
    Setup setup;
    VerifyPlan plan;
    std::string file;
    std::string text;  ///< as it was written
    Lines lines;       ///< without the digest of its code
};

/// Winds the first layer; expects that every check holds.
inline ReleasedProgram released_program(const Mandrel& mandrel, const Machine& machine,
                                        const Job& job) {
    const Run run = wind(mandrel, machine, job);
    EXPECT_TRUE(run.planned());
    for (const Check& check : run.checks) {
        EXPECT_TRUE(check.ok) << check.name << ": " << check.words;
    }
    const WoundLayer& layer = run.layers.front();
    const FibreProgram& program = layer.programs.front();
    ReleasedProgram released;
    released.setup = make_setup(mandrel, machine, job);
    released.file = program.file;
    released.text = program.text;
    released.plan.fibre =
        read_path_csv(path_csv(layer.plan.pieces, program.made.eyes.path), "path.csv");
    released.plan.motion =
        read_motion_csv(motion_csv(machine, program.made.blocks), "motion.csv", machine);
    std::size_t digests = 0;
    for (const std::string_view line : lines_of_text(program.text)) {
        if (line.find(kCodeDigest) == std::string_view::npos) {
            released.lines.emplace_back(line);
        } else {
            ++digests;
        }
    }
    EXPECT_GT(digests, 0U);
    return released;
}

struct Answer {
    bool seen = false;
    std::string by{};       ///< the check, or the error's code
    std::int32_t line = 0;  ///< that it names; 0: none
};

inline Answer answer_of(const ReleasedProgram& program, const std::string& text) {
    const Setup& setup = program.setup;
    try {
        const BlockList list = setup.dialect->read(text, program.file, setup.machine);
        const TextChecks texts = check_text(setup, text, program.file, list, program.plan);
        for (const Check& check : texts.checks) {
            if (!check.ok) {
                return {true, check.name, list.blocks[texts.first_wrong.value_or(0)].line};
            }
        }
        const Verification wound = verify_program(setup, list, program.plan.fibre);
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

/// Whether the digest in its head sees that the program was changed to this, without a plan.
inline bool digest_sees(const ReleasedProgram& program, const std::string& text) {
    const Dialect& dialect = *program.setup.dialect;
    try {
        const BlockList written = dialect.read(program.text, program.file, program.setup.machine);
        return code_digest(dialect, text, program.file) != written.head->code_digest;
    } catch (const InputError&) {
        return true;
    }
}

}  // namespace meshwind::test
