/// The machine that winds a layer: windability checks for planners, and the programs of a plan.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/run_context.h"
#include "pipeline/piece_program.h"
#include "pipeline/setup.h"
#include "postproc/nc/dialect.h"
#include "winding/plan/windability.h"

namespace meshwind {

/// The program that winds one fibre of a layer.
struct FibreProgram {
    PieceProgram made;
    std::string text;
    std::string file;  ///< name, e.g. "program.ngc"
};

/// The programs of a whole plan, one for each fibre.
struct LayerPrograms : TrialWinding {
    std::vector<FibreProgram> programs;
};

struct LayerMachineOptions {
    std::string suffix;  ///< in names of files: "", "-layer-2"
    /// Content of every program's head: version, mandrel, digests.
    ProgramHeader header;
    /// Program of the layer before: its fibre is continued where a plan does so. Null for the
    /// first.
    const FibreProgram* before = nullptr;
    RunContext context{};
    std::function<void(const char* stage)> stage_done;  ///< "plan", "post", "verify"
};

class LayerMachine : public Windability {
public:
    /// \param setup, options are kept
    LayerMachine(const Setup& setup, const LayerMachineOptions& options)
        : setup_(setup), options_(options) {}

    [[nodiscard]] CourseFault follow(std::span<const Piece> pieces) const override;
    [[nodiscard]] CourseFault wind_alone(std::span<const Piece> pieces) const override;
    [[nodiscard]] CourseFault wind_circuits(std::span<const Piece> pieces) const override;
    [[nodiscard]] std::unique_ptr<TrialWinding> wind_all(const Plan& plan) const override;

    /// Programs of a plan, and back: each is read from its text and wound again.
    /// \param ignore_limits make programs even of pieces that cannot be wound
    [[nodiscard]] std::unique_ptr<LayerPrograms> programs_of(const Plan& plan,
                                                             bool ignore_limits) const;

    /// \param notes lines for its head
    [[nodiscard]] std::string text_of(const PieceProgram& made, bool continues_fibre,
                                      const std::vector<std::string>& notes = {}) const;

private:
    void wind_fibre(std::span<const Piece> pieces, bool continues_fibre, bool ignore_limits,
                    FibreProgram& program) const;
    void done(const char* stage) const;

    const Setup& setup_;
    const LayerMachineOptions& options_;
};

}  // namespace meshwind
