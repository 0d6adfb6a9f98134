#include "report/report_checks.h"

#include <sstream>
#include <vector>

#include <gtest/gtest.h>

#include "postproc/verify/check_kinds.h"

namespace meshwind {
namespace {

using nlohmann::json;

constexpr CheckKind kWeight{
    "weight",
    "Weight",
    "the part is light",
    {at_most("worst_g", "limit_g", "of fibre"), at_least("least_g", "limit_least_g", "At least"),
     at_most("spills", 0.0, "Spills"), told("resin_g", "Resin")}};

TEST(CheckKinds, AreToldByNameWithKeysAndLimits) {
    Check second(kWeight);
    second.name += "-layer-2-3";
    const json kinds = check_kinds_report({Check(kWeight), second, Check(check_kind::kCode)});
    EXPECT_EQ(kinds, json::parse(R"({
        "weight": {"title": "Weight", "measures": [
            {"key": "worst_g", "label": "of fibre", "limit": "limit_g"},
            {"key": "least_g", "label": "At least", "limit": "limit_least_g", "least": true},
            {"key": "spills", "label": "Spills", "limit": 0.0},
            {"key": "resin_g", "label": "Resin"}]},
        "code": {"title": "Code", "measures": []}})"));
}

TEST(CheckKinds, GiveTheSummaryItsMeaning) {
    Check check(kWeight, false, "too heavy", {{"worst_g", 7.5}});
    check.name += "-2";
    std::ostringstream out;
    print_checks(out, {check});
    EXPECT_EQ(out.str(),
              "  FAILED  weight-2: the part is light;  worst_g 7.5\n          too heavy\n");
    EXPECT_EQ(checks_report({check}),
              json::parse(R"({"weight-2": {"ok": false, "words": "too heavy", "worst_g": 7.5}})"));
}

}  // namespace
}  // namespace meshwind
