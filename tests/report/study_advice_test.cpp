#include "study/study_advice.h"

#include <gtest/gtest.h>

#include "report/picture/log_plot.h"
#include "report/report_study.h"
#include "report/study_files.h"
#include "tests/support/tells.h"

namespace meshwind {
namespace {

MeshSizeLine line(const std::string& mandrel, TangentRule rule, double coarse, double fine) {
    MeshSizeLine made{mandrel, "walk", 0.0, Quantity::SpindleAngle, rule, {}};
    made.points.push_back({10.0, 10.0, 100, coarse, coarse, {}});
    made.points.push_back({5.0, 5.0, 400, fine, fine, {}});
    return made;
}

// Errors of C at 10 and at 5 mm edges by the chord, and at the finest by any other rule.
struct Cylinder {
    const char* name;
    double chord_coarse, chord_fine, other_fine;
};

StudyOutcome outcome_of(const std::vector<Cylinder>& cylinders) {
    StudyOutcome outcome;
    for (const Cylinder& c : cylinders) {
        outcome.references.emplace_back(c.name, "made up");
        outcome.study.lines.push_back(
            line(c.name, TangentRule::Chord, c.chord_coarse, c.chord_fine));
        for (const TangentRule rule :
             {TangentRule::Central, TangentRule::Parabola, TangentRule::Traced}) {
            outcome.study.lines.push_back(line(c.name, rule, 4.0 * c.other_fine, c.other_fine));
        }
    }
    return outcome;
}

bool holds(const StudyOutcome& outcome, const std::string& word) {
    for (const Advice& advice : judged_advice(outcome)) {
        if (advice.claim.find(word) != std::string::npos) {
            return advice.holds;
        }
    }
    throw std::out_of_range(word);
}

TEST(StudyAdvice, FollowsTheNumbers) {
    const StudyOutcome one =
        outcome_of({{"cylinder-20", 0.2, 0.1, 0.01}, {"cylinder-70", 0.1, 0.05, 0.01}});
    EXPECT_TRUE(holds(one, "grows"));
    EXPECT_TRUE(holds(one, "small radius"));
    EXPECT_FALSE(holds(one, "chord"));
    const StudyOutcome other =
        outcome_of({{"cylinder-20", 0.05, 0.1, 0.3}, {"cylinder-70", 0.3, 0.2, 0.3}});
    EXPECT_FALSE(holds(other, "grows"));
    EXPECT_FALSE(holds(other, "small radius"));
    EXPECT_TRUE(holds(other, "chord"));
}

// By the law alone: data/reference/seed004.json, same_C_error and irregular_spacing.
TEST(StudyAdvice, LawDecidesWhatNeedsNoMesh) {
    const StudyOutcome outcome = outcome_of({{"cylinder-20", 0.2, 0.1, 0.01}});
    EXPECT_FALSE(holds(outcome, "R = 450"));
    EXPECT_TRUE(holds(outcome, "uniform"));
    for (const Advice& advice : judged_advice(outcome)) {
        if (advice.claim.find("R = 450") != std::string::npos) {
            EXPECT_TRUE(test::tells(advice.because, "0.0349 mm") &&
                        test::tells(advice.because, "R = 70.0"))
                << advice.because;
        }
    }
}

TEST(StudyCsv, QuotesNamesWithCommas) {
    MeshSizeStudy study;
    study.lines.push_back(line("a,\"b\".stl", TangentRule::Chord, 0.2, 0.1));
    EXPECT_NE(study_csv(study).find("\n\"a,\"\"b\"\".stl\",walk,0,spindle-angle,deg,chord,10,"),
              std::string::npos);
}

TEST(StudyPage, HasPlotAndTablesAndNoTagsOfNames) {
    StudyOutcome outcome = outcome_of({{"<b>.stl", 2.0, 1.0, 0.1}});
    outcome.study.edges_mm = {10.0, 5.0};
    const std::string page = study_page(outcome);
    EXPECT_NE(page.find("<svg"), std::string::npos);
    EXPECT_NE(page.find("&lt;b&gt;.stl"), std::string::npos);
    EXPECT_EQ(page.find("<b>"), std::string::npos);
    EXPECT_NE(page.find("57.29578"), std::string::npos);  // 1 rad
}

TEST(LogPlot, TakesZerosAndSingleValues) {
    const LogPlot plot{
        .title = "a < b & c",
        .x_label = "x",
        .columns = {"one", "none"},
        .rows = {"row"},
        .panels = {{{{0, false}, {{1.0, 10.0}, {2.0, 0.0}}}}, {{{0, false}, {{1.0, 0.0}}}}},
        .keys = {{{{0, false}, "key"}}}};
    const std::string svg = log_plot_svg(plot);
    EXPECT_NE(svg.find("a &lt; b &amp; c"), std::string::npos);
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(svg.find("inf"), std::string::npos);
    // One point above zero.
    EXPECT_EQ(svg.find("<circle", svg.find("<circle") + 1), std::string::npos);
}

}  // namespace
}  // namespace meshwind
