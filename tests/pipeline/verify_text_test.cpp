// A program wound again from its text, in memory: as written, altered, and without its plan.
#include "pipeline/verify_text.h"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/code_digest.h"
#include "pipeline/piece_program.h"
#include "pipeline/plan_layer.h"
#include "postproc/tables/motion_csv.h"
#include "postproc/tables/path_csv.h"
#include "tests/support/any_machine.h"
#include "tests/support/small_pipe.h"

namespace meshwind {
namespace {

// A program of the pipe's helical layer, with the tables of its plan.
struct Written {
    meshwind::Setup setup;
    Plan plan;
    PieceProgram made;
    VerifyInputs inputs;
};

const Written& written() {
    static const Written all = [] {
        Job job = test::pipe_job();
        job.redundancy = RedundancyRule::CentralAngle;
        Written w;
        w.setup = make_setup(test::small_pipe(), test::shipped("six_axis"), job);
        w.plan = plan_layer(w.setup, job.layers.front(), test::AnyMachine()).plan;
        w.made = program_of(w.setup, w.plan.pieces);
        ProgramHeader header;
        header.tie_on_mm = w.made.eyes.path.front().landing_mm;
        header.job_digest = job_digest(w.setup.job);
        w.inputs.program = {"out/program.ngc",
                            write_with_digest(*w.setup.dialect, w.setup.machine, w.made.blocks,
                                              w.made.layout, header)};
        w.inputs.path = {"out/path.csv", path_csv(w.plan.pieces, w.made.eyes.path)};
        w.inputs.motion = {"out/motion.csv", motion_csv(w.setup.machine, w.made.blocks)};
        return w;
    }();
    return all;
}

VerifyOutcome verified(const VerifyInputs& inputs) {
    return verify_text(setup_for(written().setup, written().setup.mandrel, 0), inputs);
}

std::optional<bool> passed(const VerifyOutcome& outcome, const std::string& name) {
    for (const Check& check : outcome.checks) {
        if (check.name == name) {
            return check.ok;
        }
    }
    return std::nullopt;
}

// The text with the number behind the letter, of the n-th line that has both G1 and it, made
// greater by one in its third digit behind the point.
std::string with_one_step_more(std::string text, char letter, int n) {
    std::size_t at = 0;
    for (int found = 0; found < n;) {
        at = text.find("G1", at) + 2;
        const std::size_t end = text.find('\n', at);
        const std::size_t word = text.find(letter, at);
        if (word < end) {
            const std::size_t point = text.find('.', word);
            const std::size_t digit = text.find_first_not_of("0123456789", point + 1) - 1;
            if (++found == n) {
                text[digit] = text[digit] == '9' ? '8' : static_cast<char>(text[digit] + 1);
            }
        }
    }
    return text;
}

TEST(VerifyText, TheProgramAsWrittenPassesAndIsThePlan) {
    const Written& w = written();
    ASSERT_EQ(w.plan.failure, "");
    ASSERT_TRUE(w.made.refused.empty());
    const VerifyOutcome outcome = verified(w.inputs);
    EXPECT_TRUE(outcome.passed());
    EXPECT_EQ(outcome.program, "program.ngc");
    EXPECT_EQ(passed(outcome, "program"), true);
    EXPECT_EQ(passed(outcome, "code"), true);
    EXPECT_EQ(outcome.blocks.nano, w.made.blocks.nano);
    EXPECT_EQ(outcome.verification.first_wrong_block, std::nullopt);
    // F has six digits.
    EXPECT_NEAR(outcome.verification.duration_s, w.made.verification.duration_s,
                1e-5 * w.made.verification.duration_s);
    // The place of the tie-on has three decimals, and the laid fibre forgets where it began.
    EXPECT_NEAR(outcome.verification.fibre_length_mm, w.made.verification.fibre_length_mm, 0.01);
    // Bands of the laid fibre run on over the rims, as those of the plan do.
    EXPECT_NEAR(outcome.coverage.fraction, w.plan.coverage.fraction, 0.01);
    EXPECT_NEAR(outcome.coverage.mean_layers, w.plan.coverage.mean_layers,
                0.02 * w.plan.coverage.mean_layers);
}

TEST(VerifyText, WithoutAPlanNothingIsCompared) {
    VerifyInputs inputs = written().inputs;
    inputs.path.reset();
    inputs.motion.reset();
    const VerifyOutcome outcome = verified(inputs);
    EXPECT_TRUE(outcome.passed());
    EXPECT_EQ(passed(outcome, "program"), std::nullopt);
    EXPECT_EQ(passed(outcome, "code"), true);
    EXPECT_FALSE(outcome.verification.deviation.has_value());
    // One half of a plan is none.
    inputs.path = written().inputs.path;
    EXPECT_EQ(passed(verified(inputs), "program"), std::nullopt);
}

TEST(VerifyText, AnotherJobThanTheHeadsIsNoted) {
    EXPECT_FALSE(verified(written().inputs).other_job);
    meshwind::Setup setup = setup_for(written().setup, written().setup.mandrel, 0);
    setup.job.mandrel.extension_mm += 1.0;
    EXPECT_TRUE(verify_text(std::move(setup), written().inputs).other_job);
    VerifyInputs foreign = written().inputs;
    std::string& text = foreign.program.text;
    const std::size_t at = text.find("(job digest");
    text.erase(at, text.find('\n', at) + 1 - at);
    EXPECT_FALSE(verified(foreign).other_job);
}

TEST(VerifyText, OneStepOfOneBlockIsSeenAndNamed) {
    const Written& w = written();
    VerifyInputs inputs = w.inputs;
    inputs.program.text = with_one_step_more(inputs.program.text, 'X', 40);
    ASSERT_NE(inputs.program.text, w.inputs.program.text);
    const BlockList read =
        w.setup.dialect->read(inputs.program.text, inputs.program.name, w.setup.machine);
    ASSERT_EQ(read.blocks.size(), w.made.blocks.blocks.size());
    const auto differs =
        std::mismatch(read.nano.begin(), read.nano.end(), w.made.blocks.nano.begin());
    const auto block =
        static_cast<std::size_t>(differs.first - read.nano.begin()) / read.axes.size();
    const TextChecks found = check_text(
        w.setup, inputs.program.text, inputs.program.name, read,
        {.fibre = read_path_csv(inputs.path->text, inputs.path->name),
         .motion = read_motion_csv(inputs.motion->text, inputs.motion->name, w.setup.machine)});
    ASSERT_EQ(found.checks.size(), 2U);
    EXPECT_EQ(found.checks[0].name, "program");
    EXPECT_FALSE(found.checks[0].ok);
    EXPECT_EQ(found.checks[0].numbers.at("blocks"), static_cast<double>(read.moves()));
    EXPECT_EQ(found.checks[1].name, "code");
    EXPECT_FALSE(found.checks[1].ok);
    EXPECT_EQ(found.first_wrong, block);
    // And by the whole of it, whatever the fibre does.
    const VerifyOutcome outcome = verified(inputs);
    EXPECT_FALSE(outcome.passed());
    EXPECT_EQ(passed(outcome, "program"), false);
    EXPECT_EQ(outcome.verification.first_wrong_block, block);
}

TEST(VerifyText, TheTieOnOfTheCallerIsTakenForTheProgramsOwn) {
    VerifyInputs inputs = written().inputs;
    const Eigen::Vector3d own_mm = written().made.eyes.path.front().landing_mm;
    inputs.tie_on_mm = own_mm;
    EXPECT_TRUE(verified(inputs).passed());
    // 3 mm along the pipe is on the wall still, but not where the plan begins.
    inputs.tie_on_mm = own_mm + 3.0 * Eigen::Vector3d::UnitZ();
    EXPECT_EQ(passed(verified(inputs), "tie_on"), false);
    inputs.tie_on_mm = 10.0 * own_mm;
    EXPECT_EQ(test::refusal_of([&] { (void)verified(inputs); }).code, "verify.tie_on");
}

TEST(VerifyText, TextsThatCannotBeReadAreRefusedWithTheirLine) {
    VerifyInputs inputs = written().inputs;
    std::string& text = inputs.program.text;
    text.insert(text.find("G1"), "G17.5\n");
    const auto line =
        1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(text.find("G17.5")),
                       '\n');
    const test::Refused refused = test::refusal_of([&] { (void)verified(inputs); });
    EXPECT_EQ(refused.code.substr(0, 3), "nc.");
    EXPECT_EQ(refused.place, "out/program.ngc:" + std::to_string(line));
    VerifyInputs tables = written().inputs;
    tables.path->text = "course,kind\n1,course\n";
    EXPECT_EQ(test::refusal_of([&] { (void)verified(tables); }).code, "plan.column");
}

TEST(VerifyText, PinsStandWhereTheHeadSays) {
    VerifyInputs inputs = written().inputs;
    const auto setup_of = [](TurnKind turn) {
        meshwind::Setup setup = setup_for(written().setup, written().setup.mandrel, 0);
        setup.job.mandrel.turn = turn;
        return setup;
    };
    const auto code_of = [&](TurnKind turn) {
        return test::refusal_of([&] { (void)verify_text(setup_of(turn), inputs); }).code;
    };
    EXPECT_EQ(code_of(TurnKind::Pins), "nc.pins");  // none
    std::string& text = inputs.program.text;
    text.insert(text.find("(tie on"), "(pins at rim 7: N36 D2.0 H2.5 S0.69 Z8.0 A0.0)\n");
    EXPECT_EQ(code_of(TurnKind::Friction), "nc.pins");  // no such rim
    text.replace(text.find("rim 7"), 5, "rim 1");
    const VerifyOutcome outcome = verify_text(setup_of(TurnKind::Friction), inputs);
    EXPECT_EQ(outcome.setup.wall->pins().size(), 36U);
}

}  // namespace
}  // namespace meshwind
