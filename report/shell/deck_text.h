/// Text common to the decks of several programs.
#pragma once

#include <array>
#include <span>
#include <string>

#include "report/shell/decks.h"

namespace meshwind {

inline constexpr double kTonnes_per_mm3 = 1e-9;  // of a density of 1 g/cm3

/// Title of a deck: version, material, size.
[[nodiscard]] std::string deck_title(const ShellModel& model);

/// Appends a value to 13 digits, in 20 columns at most.
void append_value(std::string& text, double value);

/// Appends values separated by commas.
void append_values(std::string& text, std::span<const double> values);

// Keywords that CalculiX took over from Abaqus.
void append_keyword_mesh(std::string& text, const ShellModel& model, const char* type,
                         std::size_t nodes);
void append_keyword_isotropic(std::string& text, const char* name, const Isotropic& material);
void append_keyword_loads(std::string& text, const ShellModel& model);
void append_keyword_supports(std::string& text, const ShellModel& model);

}  // namespace meshwind
