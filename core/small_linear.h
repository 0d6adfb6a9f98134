/// Decompositions of Eigen that cost 5 to 10 s in each source file that instantiates them: compiled
/// once, here.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace meshwind {

/// Eigenvalues of a symmetric matrix, rising, and their unit vectors in the columns.
template <int n>
struct PrincipalAxes {
    Eigen::Matrix<double, n, 1> values;
    Eigen::Matrix<double, n, n> vectors;
};

/// Only the lower triangle is read. The same as Eigen's SelfAdjointEigenSolver, to the last digit.
[[nodiscard]] PrincipalAxes<2> principal_axes(const Eigen::Matrix2d& symmetric);
[[nodiscard]] PrincipalAxes<3> principal_axes(const Eigen::Matrix3d& symmetric);

/// min(rows, columns) values, falling. \pre the matrix is not empty
[[nodiscard]] Eigen::VectorXd singular_values(const Eigen::MatrixXd& matrix);

/// Shortest rotation from the direction of `from` to that of `to`; for opposite ones any half turn.
[[nodiscard]] Eigen::Quaterniond shortest_turn(const Eigen::Vector3d& from,
                                               const Eigen::Vector3d& to);

}  // namespace meshwind
