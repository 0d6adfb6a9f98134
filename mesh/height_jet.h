/// Local smooth surface at a vertex: height over a plane as a polynomial of degree four.
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

namespace meshwind {

inline constexpr std::size_t kJetTerms = 14;  ///< x, y, x2, xy, y2, x3, x2y, xy2, y3, x4, ... y4

inline constexpr std::size_t kJetX2 = 2;
inline constexpr std::size_t kJetX3 = 5;
inline constexpr std::size_t kJetX4 = 9;

/// Height over a plane through a vertex as a polynomial of the place in that plane.
struct HeightJet {
    Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();  ///< columns: x, y, and up
    std::array<double, kJetTerms> coefficient{};          ///< in mm^(1 - degree of the term)
};

/// The polynomial and its derivatives at a place in the plane.
struct JetHeight {
    double value, by_x, by_y, by_xx, by_xy, by_yy;
};
[[nodiscard]] JetHeight height_at(const HeightJet& jet, double x, double y);

}  // namespace meshwind
