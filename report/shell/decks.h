/// Writes input decks of finite element programs for a wound wall: shells with the plies, thickness
/// and fibre direction of each element, loads and supports, ready to be run
/// (docs/how-to/strength.md).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "report/shell/shell_model.h"

namespace meshwind {

/// CalculiX 2.20: S6, an *ORIENTATION for each element and ply whose name is `ply_name()`.
/// *DISTRIBUTION, its Abaqus counterpart, takes memory there with the square of the elements. All
/// elements have the same number of plies, as that program needs: films of matrix fill up.
/// \pre quadratic elements
[[nodiscard]] std::string calculix_deck(const ShellModel& model);

/// Abaqus: S3, axis 1 by a *DISTRIBUTION, plies by their angles to it.
[[nodiscard]] std::string abaqus_deck(const ShellModel& model);

/// Nastran, SOL 101: CTRIA3 and a PCOMP for each, plies by their angles to the side from the first
/// grid point to the second, on the outer side of the grid points (Z0 = 0).
[[nodiscard]] std::string nastran_deck(const ShellModel& model);

/// "O12_3" of element 12's ply 3, both from 1.
[[nodiscard]] std::string ply_name(std::size_t element, std::size_t ply);

/// A format that the command line knows.
struct DeckFormat {
    std::string_view name;  ///< "calculix"
    std::string_view ending;
    ElementOrder order;
    std::string (*write)(const ShellModel&);
};

[[nodiscard]] const std::vector<DeckFormat>& deck_formats();

/// The sheet under a triangle's plies.
struct ShellSheet {
    bool liner = false;         ///< else of matrix
    double thickness_mm = 0.0;  ///< 0: nothing
};

/// The liner; without one, on a bare triangle, as much matrix as a tow is thick.
[[nodiscard]] ShellSheet sheet_under(const ShellModel& model, const ShellTriangle& triangle);

}  // namespace meshwind
