#include "core/small_linear.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

namespace meshwind {
namespace {

template <int n>
PrincipalAxes<n> solved(const Eigen::Matrix<double, n, n>& symmetric) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, n, n>> solver(symmetric);
    return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace

PrincipalAxes<2> principal_axes(const Eigen::Matrix2d& symmetric) {
    return solved<2>(symmetric);
}

PrincipalAxes<3> principal_axes(const Eigen::Matrix3d& symmetric) {
    return solved<3>(symmetric);
}

Eigen::VectorXd singular_values(const Eigen::MatrixXd& matrix) {
    return Eigen::JacobiSVD<Eigen::MatrixXd>(matrix).singularValues();
}

Eigen::Quaterniond shortest_turn(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    return Eigen::Quaterniond::FromTwoVectors(from, to);
}

}  // namespace meshwind
