/// The objects "checks" and "verification" of report.json and verify.json.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "postproc/motion/block.h"
#include "postproc/verify/check.h"
#include "postproc/verify/verify.h"

namespace meshwind {

/// By name: ok, the numbers of the check, and words where it failed.
[[nodiscard]] nlohmann::json checks_report(const std::vector<Check>& checks);

/// Their kinds by name, for the page: title, and measures with key, label, limit (the key of a
/// number, or a number; none: no limit) and least (the limit is a lower one).
[[nodiscard]] nlohmann::json check_kinds_report(const std::vector<Check>& checks);

/// The laid fibre and its time, and the first wrong block where there is one.
[[nodiscard]] nlohmann::json verification_report(const Verification& verification,
                                                 const BlockList& program);

/// A line for each check, a second one with the words of a failed one.
void print_checks(std::ostream& out, const std::vector<Check>& checks);

/// A line for each that failed, and how many passed.
void print_failed_checks(std::ostream& out, const std::vector<Check>& checks);

/// Indented by one, with a line break at the end. Bytes of names that are no UTF-8 become U+FFFD,
/// since JSON cannot hold them otherwise.
[[nodiscard]] std::string json_text(const nlohmann::json& json);

/// Numbers of a report: finer than any tolerance, free of rounding noise in the last digits.
[[nodiscard]] double report_number(double value);

/// Three of them.
[[nodiscard]] nlohmann::json report_vector(const Eigen::Vector3d& vector);

}  // namespace meshwind
