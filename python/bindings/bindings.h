/// The classes of the Python module, as python/meshwind/__init__.pyi declares them.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <pybind11/pybind11.h>

#include "pipeline/trace_table.h"
#include "pipeline/wind.h"
#include "report/layup.h"

namespace meshwind {

/// A run with its lay-up, made on demand. The lay-up refers to the run: both stay in their place.
struct OwnedRun {
    explicit OwnedRun(Run wound) : run(std::move(wound)) {}
    OwnedRun(const OwnedRun&) = delete;
    OwnedRun& operator=(const OwnedRun&) = delete;

    Run run;
    std::optional<Layup> layup;
};

/// Part of a run, which lives while the part is held.
struct LayerOfRun {
    std::shared_ptr<OwnedRun> owner;
    std::size_t layer = 0;

    [[nodiscard]] const WoundLayer& get() const { return owner->run.layers[layer]; }
};

struct FibreOfRun {
    LayerOfRun of;
    std::size_t fibre = 0;
    std::size_t first_piece = 0;  ///< of the plan's

    [[nodiscard]] const FibreProgram& get() const { return of.get().programs[fibre]; }
};

struct PieceOfRun {
    LayerOfRun of;
    std::size_t piece = 0;   ///< of the plan's
    std::size_t course = 0;  ///< of the fibre's, as path.csv counts them

    [[nodiscard]] const Piece& get() const { return of.get().plan.pieces[piece]; }
};

struct LayupOfRun {
    std::shared_ptr<OwnedRun> owner;

    [[nodiscard]] const Layup& get() const { return *owner->layup; }
};

void bind_mandrel(pybind11::module_& module);
void bind_run(pybind11::module_& module);

}  // namespace meshwind
