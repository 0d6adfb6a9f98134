#include "report/cases/case_table.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/files/write_file.h"
#include "report/cases/case_results.h"

namespace meshwind {
namespace {

namespace fs = std::filesystem;

std::string code_of(const std::string& text) {
    try {
        (void)read_cases(text, "cases.csv");
    } catch (const InputError& error) {
        return error.code();
    }
    return {};
}

TEST(CaseTable, OtherColumnsAreKeysOfTheJob) {
    const std::vector<Case> cases = read_cases(
        "id, mandrel, tow.width, machine, layers.0.angle, job\n"
        "a, tee.stl, 8, , 45, \n"
        "\n"
        "b-2, pipe.step, , gantry.json, , job.json\n",
        "cases.csv");
    ASSERT_EQ(cases.size(), 2U);
    EXPECT_EQ(cases[0].id, "a");
    EXPECT_EQ(cases[0].mandrel, "tee.stl");
    EXPECT_EQ(cases[0].machine, "six_axis.json");
    EXPECT_EQ(cases[0].settings, (std::vector<std::string>{"tow.width=8", "layers.0.angle=45"}));
    EXPECT_EQ(cases[1].machine, "gantry.json");
    EXPECT_EQ(cases[1].job, "job.json");
    EXPECT_TRUE(cases[1].settings.empty());
    EXPECT_EQ(cases[1].line, 4);
}

TEST(CaseTable, BrokenTables) {
    EXPECT_EQ(code_of(""), "case.column");
    EXPECT_EQ(code_of("id,part\na,tee.stl\n"), "case.column");
    EXPECT_EQ(code_of("id,mandrel\n"), "case.none");
    EXPECT_EQ(code_of("id,mandrel\na\n"), "case.cell");
    EXPECT_EQ(code_of("id,mandrel\na,\n"), "case.cell");
    EXPECT_EQ(code_of("id,mandrel\na,x.stl\na,y.stl\n"), "case.id");
    for (const char* id : {"", "..", "-a", "a/b", "a b"}) {
        EXPECT_EQ(code_of("id,mandrel\n" + std::string(id) + ",x.stl\n"), "case.id") << id;
    }
}

class MergedCasesOf : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::path(testing::TempDir()) / "cases";
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    fs::path folder_;
    std::vector<Case> cases_ =
        read_cases("id,mandrel,tow.width\na,x.stl,8\nb,x.stl,6\nc,x.stl,4\n", "cases.csv");
};

TEST_F(MergedCasesOf, NameWhatFailedAndWhatIsMissing) {
    write_case_end(folder_, cases_[0], {.exit_code = 0});
    fs::create_directories(folder_ / "a");
    write_file(folder_ / "a/report.json",
               R"({"plan": {"courses": 7, "coverage": {"fraction": 0.5}}, "checks": {}})");
    write_case_end(folder_, cases_[1],
                   {.exit_code = 2, .code = "mesh.no_wall", .words = "x.stl: no, \"none\""});
    const MergedCases merged = merge_cases(folder_, cases_);
    EXPECT_EQ(merged.passed, 1);
    EXPECT_EQ(merged.failed, std::vector<std::size_t>{2});
    EXPECT_EQ(merged.missing, std::vector<std::size_t>{3});
    EXPECT_EQ(merged.csv,
              "id,outcome,words,mandrel,machine,job,settings,courses,fibre_mm,fibre_factor,"
              "turn_share,covered,reachable,mean_layers,cv,blocks,duration_s,laydown_mm\n"
              "a,ok,,x.stl,six_axis.json,,tow.width=8,7,,,,0.5,,,,,,\n"
              "b,error,\"x.stl: no, \"\"none\"\"\",x.stl,six_axis.json,,tow.width=6,,,,,,,,,,,\n"
              "c,missing,,x.stl,six_axis.json,,tow.width=4,,,,,,,,,,,\n");
    EXPECT_EQ(numbers_text({2, 3}), "2,3");
}

TEST_F(MergedCasesOf, AreMissingWhereTheirInputsHaveChanged) {
    for (const Case& of : cases_) {
        write_case_end(folder_, of, {.exit_code = 0});
    }
    EXPECT_TRUE(merge_cases(folder_, cases_).missing.empty());
    cases_[1].settings = {"tow.width=7"};
    EXPECT_EQ(merge_cases(folder_, cases_).missing, std::vector<std::size_t>{2});
    forget_case_end(folder_, cases_[2]);
    EXPECT_EQ(merge_cases(folder_, cases_).missing, (std::vector<std::size_t>{2, 3}));
}

TEST_F(MergedCasesOf, NameTheChecksThatFailed) {
    write_case_end(folder_, cases_[0], {.exit_code = 1});
    fs::create_directories(folder_ / "a");
    write_file(
        folder_ / "a/report.json",
        R"({"checks": {"slip": {"ok": false}, "limits": {"ok": true}, "bridging": {"ok": false}}})");
    EXPECT_NE(merge_cases(folder_, cases_).csv.find("a,check failed,bridging slip,"),
              std::string::npos);
}

}  // namespace
}  // namespace meshwind
