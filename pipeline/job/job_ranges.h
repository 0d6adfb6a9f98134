/// Allowed ranges of the job's numbers. Their limits lie far beyond anything that is wound; within
/// them sums and ratios of these numbers stay finite, and a slip of the unit is reported as such.
/// data/schema/job.schema.json is made from them.
#pragma once

#include <cstdint>
#include <limits>

#include "core/text/strict_json.h"

namespace meshwind {

/// mm; from a single filament to a sheet as wide as a ship's hull.
inline constexpr JsonRange kBandRange = {.min = 0.005, .max = 10'000.0};
inline constexpr JsonRange kThicknessRange = {.min = 1e-4, .max = 1'000.0};  ///< mm

/// Without unit: 0 is glass, rubber on rubber is 1.
inline constexpr JsonRange kFrictionRange = {.min = 0.0, .max = 100.0};

inline constexpr JsonRange kGapRange = {.min = 0.0, .max = 1'000.0};          ///< mm
inline constexpr JsonRange kTwistRange = {.min = 0.0, .max = 1'000.0};        ///< turns/m
inline constexpr JsonRange kDensityRange = {.min = 1e-3, .max = 100.0};       ///< g/cm3
inline constexpr JsonRange kPriceRange = {.min = 0.0, .max = 1e6};            ///< per kg
inline constexpr JsonRange kCutRange = {.min = 0.0, .max = 10'000.0};         ///< mm
inline constexpr JsonRange kExtensionRange = {.min = 0.0, .max = 100'000.0};  ///< mm
inline constexpr JsonRange kLayersRange = {.min = 1e-3, .max = 10'000.0};     ///< of a layer

/// mm, of pins, free fibres and the eye's distance.
inline constexpr JsonRange kLengthRange = {.min = 1e-3, .max = 100'000.0};

/// mm, of a place along a course or of a plane, which may lie on either side.
inline constexpr JsonRange kAlongRange = {.min = 0.0, .max = 1e9};
inline constexpr JsonRange kPlaneRange = {.min = -100'000.0, .max = 100'000.0};

inline constexpr JsonRange kDeviationRange = {.min = 1e-6, .max = 1'000.0};  ///< mm or deg
inline constexpr JsonRange kShareRange = {.min = 0.0, .max = 1.0};
inline constexpr JsonRange kClearanceRange = {.min = 0.0, .max = 10'000.0};  ///< mm
inline constexpr JsonRange kSpeedRange = {.min = 1e-3, .max = 10'000.0};     ///< m/min

// More circuits than patterns are searched for (winding/revolution/pattern.cpp), more series and
// plies than anybody winds.
inline constexpr std::int64_t kMaxCircuits = 10'000;
inline constexpr std::int64_t kMaxSeries = 1'000;
inline constexpr std::int64_t kMaxPlies = 1'000;

// Ids of regions and numbers of courses.
inline constexpr std::int64_t kMaxId = std::numeric_limits<std::int32_t>::max();

// More pins than on any ring.
inline constexpr std::int64_t kMaxPins = 10'000;

// Dwells of a turn and less end at every place there is.
inline constexpr double kMaxDwell_deg = 3600.0;

// Bands that overlap by more are a layer more.
inline constexpr double kMaxOverlap = 1.0;

}  // namespace meshwind
