// What a program's head says of its making comes back from the text of every dialect.
#include "postproc/nc/made_from.h"

#include <random>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "postproc/nc/nc_dialects.h"
#include "postproc/robot/dialects.h"
#include "tests/support/block_lists.h"
#include "tests/support/dialect_lists.h"

namespace meshwind {
namespace {

using nlohmann::json;

std::string program_of(const std::string& dialect, const ProgramHeader& header) {
    const Machine machine = test::machine_for(dialect);
    return make_dialect(dialect)->write(machine, test::small_program(machine), header);
}

ProgramHeader header_of(std::string job) {
    return {.version = "1.2.3",
            .mandrel = "tee 2.stl",
            .mandrel_digest = "sha256/128 " + std::string(32, 'a'),
            .machine_file = "six_axis.json",
            .job = std::move(job),
            .run = MainJobRun{"tee 2.stl", 18446744073709551615U, 0.25},
            .code_digest = "sha256/128 " + std::string(32, 'c')};
}

// A job of many keys; strings have what JSON escapes and what controllers do not take in comments.
json random_job(std::mt19937& random) {
    constexpr std::string_view kLetters = "ab (\"\\){}[]:;,%!?~#/\n\t$ /:=";
    json job = json::object();
    const std::size_t keys = random() % 40;
    for (std::size_t i = 0; i < keys; ++i) {
        std::string text;
        const std::size_t length = random() % 60;
        for (std::size_t k = 0; k < length; ++k) {
            text += kLetters[random() % kLetters.size()];
        }
        json& value = job["key " + std::to_string(i)];
        value = {{"text", text}, {"number", static_cast<double>(random()) * 1e-7}};
        value["list"] = {i, true, nullptr, text};
    }
    return job;
}

TEST(MadeFrom, ComesBackFromEveryDialect) {
    std::mt19937 random(1);
    for (const std::string& dialect : dialect_names()) {
        SCOPED_TRACE(dialect);
        for (int i = 0; i < 30; ++i) {
            const json job = random_job(random);
            const ProgramHeader header = header_of(job.dump(i % 2 == 0 ? 2 : -1));
            const std::string text = program_of(dialect, header);
            const auto found = made_from(text);
            ASSERT_TRUE(found);
            EXPECT_EQ(found->version, header.version);
            EXPECT_EQ(found->mandrel, header.mandrel);
            EXPECT_EQ(found->mandrel_digest, header.mandrel_digest);
            EXPECT_EQ(found->machine_file, header.machine_file);
            EXPECT_EQ(found->code_digest, header.code_digest);
            EXPECT_EQ(found->run, header.run);
            EXPECT_EQ(json::parse(found->job), job);
            // Blocks and their digest do not depend on it.
            const Machine machine = test::machine_for(dialect);
            const auto made = make_dialect(dialect);
            EXPECT_EQ(made->code_of(text, "p"),
                      made->code_of(program_of(dialect, {.version = "1.2.3"}), "p"));
            EXPECT_NO_THROW((void)made->read(text, "p", machine));
        }
    }
}

TEST(MadeFrom, WhatIsNotToldIsEmpty) {
    for (const std::string& dialect : dialect_names()) {
        const auto found = made_from(program_of(dialect, {.version = "1.2.3"}));
        ASSERT_TRUE(found) << dialect;
        EXPECT_EQ(found->mandrel + found->machine_file + found->job + found->code_digest, "");
        EXPECT_FALSE(found->run);
    }
}

TEST(MadeFrom, WhatIsNotByMeshwindSaysNothing) {
    EXPECT_FALSE(made_from(""));
    EXPECT_FALSE(made_from("(job: {})\nG91 G93\nG1 X1 F1\n"));
    for (const std::string run : {"run: seed , effort 1, mandrel a", "run: seed 1", "run: seed -1",
                                  "run: seed 1, effort 0, mandrel a", "run: seed 1, effort 1"}) {
        const auto found = made_from("(meshwind 1)\n(" + run + ")\n");
        ASSERT_TRUE(found);
        EXPECT_FALSE(found->run) << run;
    }
}

}  // namespace
}  // namespace meshwind
