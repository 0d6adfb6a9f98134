/// meshwind verify: winds a program again from its text alone.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "cli/setup.h"
#include "postproc/block.h"
#include "postproc/plan_tables.h"
#include "postproc/verify.h"
#include "winding/plan.h"

namespace meshwind {

struct VerifyRequest {
    std::filesystem::path program;
    SetupRequest setup;
    std::filesystem::path plan;  ///< folder with path.csv and motion.csv; empty: nothing to compare
    std::filesystem::path out;   ///< folder for verify.json and laid.csv; empty: none is written
    std::optional<Eigen::Vector3d> tie_on_mm;  ///< mandrel frame; overrides the program's own
    std::function<void(const std::string& step, double share)> progress;
};

struct VerifyOutcome {
    std::string program;  ///< file name
    Setup setup;
    BlockList blocks;
    Verification verification;  ///< its first wrong block is that of "program" where this fails
    Coverage coverage;          ///< by the laid fibre
    std::vector<Check> checks;  ///< those of the text (TextChecks), then the verification's
    double reading_s = 0.0;     ///< all input
    double verifying_s = 0.0;   ///< winding again and the checks

    [[nodiscard]] bool passed() const;
};

/// The tables of a plan that belong to a program; empty where there is none.
struct VerifyPlan {
    PlannedFibre fibre;
    std::vector<PlannedMotion> motion;
};

/// Checks for which nothing is wound.
struct TextChecks {
    std::vector<Check> checks;  ///< "program" where there is a plan, "code" where the head has a
                                ///< digest (code_digest.h)
    std::optional<std::size_t> first_wrong{};  ///< where "program" fails
};

/// \param file name used in messages
/// \param program what was read of the text
[[nodiscard]] TextChecks check_text(const Setup& setup, std::string_view text,
                                    const std::string& file, const BlockList& program,
                                    const VerifyPlan& plan);

/// Reads everything, winds the program again (postproc/verify.h) and writes the output folder,
/// where one is named. With a plan the first check is "program": block by block its positions and
/// times are those of motion.csv, and the eye is where the plan's machine had it.
/// \throws InputError, IoError for input that cannot be used; nothing is written then
[[nodiscard]] VerifyOutcome run_verify(const VerifyRequest& request);

}  // namespace meshwind
