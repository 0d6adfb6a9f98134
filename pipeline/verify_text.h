/// Verifies a program by winding it again from its text alone. No file is read or written.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/run_context.h"
#include "pipeline/setup.h"
#include "postproc/motion/block.h"
#include "postproc/tables/plan_tables.h"
#include "postproc/verify/verify.h"
#include "winding/plan/plan.h"

namespace meshwind {

/// A text with the name that messages give it.
struct NamedText {
    std::string name;
    std::string text;
};

struct VerifyInputs {
    NamedText program;
    /// The plan's tables for this program; none: nothing to compare.
    std::optional<NamedText> path{};
    std::optional<NamedText> motion{};
    std::optional<Eigen::Vector3d> tie_on_mm{};  ///< mandrel frame; overrides the program's own
};

struct VerifyOutcome {
    std::string program;  ///< file name
    Setup setup;
    BlockList blocks;
    Verification verification;  ///< its first wrong block is that of "program" where this fails
    Coverage coverage;          ///< by the laid fibre
    bool other_job = false;     ///< the program's head names another job than the setup's
    std::vector<Check> checks;  ///< those of the text (TextChecks), then the verification's
    double verifying_s = 0.0;   ///< winding again and the checks

    [[nodiscard]] bool passed() const;
};

/// The tables of a plan that belong to a program; empty where there is none.
struct VerifyPlan {
    PlannedFibre fibre;
    std::vector<PlannedMotion> motion;
};

/// Reads a program, and prepares the setup for it: pins named in its head stand on the mandrel, and
/// friction is that of the layer in its name (run_names.h). \throws InputError as a dialect's
/// reader; nc.pins where pins are not those of the mandrel or the job
[[nodiscard]] BlockList read_program(Setup& setup, const VerifyInputs& inputs);

/// Checks of the text, without winding.
struct TextChecks {
    std::vector<Check> checks;  ///< "program" where there is a plan, "code" where the head has a
                                ///< digest (code_digest.h)
    std::optional<std::size_t> first_wrong{};  ///< where "program" fails
};

/// \param file name used in messages
/// \param program as read from the text
[[nodiscard]] TextChecks check_text(const Setup& setup, std::string_view text,
                                    const std::string& file, const BlockList& program,
                                    const VerifyPlan& plan);

/// Winds the program again (postproc/verify/verify.h). With a plan the first check is "program":
/// block by block its positions and times are those of motion.csv, and the eye is where the plan's
/// machine has it. \throws InputError for input that cannot be used
[[nodiscard]] VerifyOutcome verify_text(Setup setup, const VerifyInputs& inputs,
                                        const RunContext& context = {});

}  // namespace meshwind
