/// A check of a report: its kind and its result.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <Eigen/Core>

namespace meshwind {

/// A number of a check, shown beside its limit where it has one. Texts are literals.
struct CheckMeasure {
    std::string_view key;                 ///< of Check::numbers; its ending is the unit
    std::string_view label;               ///< empty: the title is enough
    std::string_view limit_key{};         ///< the number that is the limit; empty: none
    std::optional<double> fixed_limit{};  ///< the limit, where it is always the same
    bool least = false;                   ///< the limit is a lower one
};

/// A number without a limit.
constexpr CheckMeasure told(std::string_view key, std::string_view label) {
    return {.key = key, .label = label};
}
constexpr CheckMeasure at_most(std::string_view key, std::string_view limit_key,
                               std::string_view label) {
    return {.key = key, .label = label, .limit_key = limit_key};
}
constexpr CheckMeasure at_most(std::string_view key, double limit, std::string_view label) {
    return {.key = key, .label = label, .fixed_limit = limit};
}
constexpr CheckMeasure at_least(std::string_view key, std::string_view limit_key,
                                std::string_view label) {
    return {.key = key, .label = label, .limit_key = limit_key, .least = true};
}

/// Kind of a check: common to all checks of one name; check_kinds.h lists them.
struct CheckKind {
    std::string_view name;     ///< key in report.json
    std::string_view title;    ///< on the page; the first label stands behind it
    std::string_view meaning;  ///< for somebody who winds, in the summary
    /// Filled from the front, the others are empty. Measures that a check lacks are not shown;
    /// where it has none of them, all its numbers are.
    std::array<CheckMeasure, 5> measures{};
};

/// Place of a check's result: of the failure, or else of its worst value.
struct CheckPlace {
    Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();  ///< on the mandrel, its frame
    std::optional<std::size_t> block{};                     ///< of the program
    std::size_t fibre = 0;                                  ///< which program, from 0
    std::size_t layer = 0;                                  ///< from 0
};

/// One check of a report. The words are empty where it passed.
struct Check {
    /// \param of must outlive the check: a row of check_kinds.h
    explicit Check(const CheckKind& of, bool passed = true, std::string failure = {},
                   std::map<std::string, double> found = {})
        : kind(&of),
          name(of.name),
          ok(passed),
          words(std::move(failure)),
          numbers(std::move(found)) {}

    const CheckKind* kind;  ///< never null
    std::string name;       ///< key in report.json: the kind's, with layer and fibre behind it
    bool ok;
    std::string words;  ///< where it failed: one line with the place, the number and the limit
    std::map<std::string, double> numbers;  ///< further keys of the check, e.g. "worst", "limit"
    std::optional<CheckPlace> place{};
};

}  // namespace meshwind
