/// Builds the winding surface from triangles: adjacency, smooth normals, curvature.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "mesh/surface.h"
#include "mesh/triangle_soup.h"

namespace meshwind {

struct Jet;

/// Input of `freeze_surface` beside the triangles; all spans are per face and as long as
/// `soup.faces`.
struct FreezeInput {
    std::span<const std::array<std::uint8_t, 3>> feature;  ///< 1 = feature edge
    std::span<const std::int32_t> region;
    std::span<const std::array<std::int32_t, 3>> rim;  ///< rim id per edge, -1 elsewhere
};

/// Flat arrays from an oriented manifold soup in the mandrel frame. Normals and shape operators
/// come from a local least-squares height fit, of degree four where the neighbourhood allows; never
/// across a feature edge. \pre soup is manifold, oriented, without degenerate faces (see repair.h)
/// Accuracy: tests/mesh/smooth/surface_test.cpp (normals fourth order, curvature third in edge
/// length).
[[nodiscard]] Surface freeze_surface(const TriangleSoup& soup, const FreezeInput& input);

/// Replaces the fit about a corner index by the known surface. \param jet passes through the
/// corner's vertex
void set_jet(Surface& surface, std::size_t corner, const Jet& jet);

}  // namespace meshwind
