/// Tolerances used by more than one folder, each with its unit and reason.
#pragma once

namespace meshwind {

/// Barycentric slack (no unit): a point this far outside a face still belongs to it. Far above the
/// rounding of a walk step (about 1e-15), far below any length that matters (1e-10 of an edge).
inline constexpr double kBaryEps = 1e-10;

}  // namespace meshwind
