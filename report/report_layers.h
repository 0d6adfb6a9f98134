/// Figures of several layers in one report, of each and of all together.
#pragma once

#include <optional>
#include <ostream>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "pipeline/wind.h"
#include "winding/plan/figures.h"

namespace meshwind {

/// One row of the table of layers.
struct LayerFigures {
    double angle_rad = 0.0;          ///< of a pattern at the widest place, else the courses' mean
    double mean_thickness_mm = 0.0;  ///< over the wall
    double most_thickness_mm = 0.0;
    double fibre_m = 0.0;
    double mass_g = 0.0;   ///< of the laid tow
    double scrap_m = 0.0;  ///< fibre in turns, which is cut off
    double time_s = 0.0;
    std::optional<double> price{};  ///< of the tow, where the job gives a price per kilogram
};

/// \pre the layer has a plan
[[nodiscard]] LayerFigures figures_of(const WoundLayer& layer);

/// Sums over all layers, and their price. The angle is left at 0; the thickness of several layers
/// is that of the sum per vertex.
[[nodiscard]] LayerFigures figures_of_all(const Run& run);

/// Lower bound of the fibre needed, turns included: of the layers and walls that have a bound. 0
/// where one has none.
[[nodiscard]] double least_fibre_m(const Run& run);

[[nodiscard]] FibreUse use_of_fibre(const WoundLayer& layer);

/// "friction", ...
[[nodiscard]] const char* name_of(RelaxedRule::Rule rule);

/// "leading" or "lagging".
[[nodiscard]] const char* word_of(BandOrder order);

/// Adds "cost": fibre, mass, scrap and time of all that is wound, and the lower bound of the fibre.
void add_cost_report(nlohmann::json& report, const Run& run);

/// Adds "plan", "program" and "laminate" of all layers together, and for each of "layers" its
/// figures.
void add_laminate_report(nlohmann::json& report, const Run& run);

/// Lower bound of the fibre, and the share by which more is laid. \param factors as FibreUse has
/// them
[[nodiscard]] nlohmann::json bound_report(double least_factor, double factor);

/// Adds "walls": the job's layers that are walls, as laid.
void add_walls_report(nlohmann::json& report, const Run& run);

/// Prints for each wall its thickness, its fibre and the lower bound of that.
void print_walls(std::ostream& out, const Run& run);

/// Prints a line for each layer and one for all.
void print_laminate(std::ostream& out, const Run& run);

}  // namespace meshwind
