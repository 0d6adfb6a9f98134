/// Exports the lay-up and the fibre of a run for other programs: layup.vtu, layup.json, fibre.obj,
/// fibre.step (docs/files.md, "Lay-up").
#pragma once

#include <string>
#include <vector>

#include "pipeline/wind.h"
#include "report/layup.h"

namespace meshwind {

/// A file of the output folder, in memory.
struct MadeFile {
    std::string name;
    std::string bytes;
};

/// The lay-up on the bare mandrel's triangles and the polylines of every fibre. \param layup of the
/// result's layers \pre run.planned()
[[nodiscard]] std::vector<MadeFile> layup_files(const Run& run, const Layup& layup);

}  // namespace meshwind
