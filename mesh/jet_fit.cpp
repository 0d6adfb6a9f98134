#include "mesh/jet_fit.h"

#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/QR>

namespace meshwind {
namespace {

constexpr int kMaxNeighbours = 64;  // three rings of a regular mesh hold 36; more adds nothing
constexpr int kMaxCoefficients = 9;

// Smallest pivot ratio of the QR (no unit) that still counts as determined: below it, coefficients
// are amplified more than a hundredfold and a lower degree is the better answer.
constexpr double kRankThreshold = 1e-2;

// Neighbours beyond the unknowns: an exactly determined fit would follow noise.
constexpr int kSpareNeighbours = 2;

// Cosine between guess and fitted normal (45 deg): a fit further off has gone astray.
constexpr double kMinNormalAgreement = 0.7;

struct Frame {
    Eigen::Vector3d x, y, z;
};

Frame frame_about(const Eigen::Vector3d& normal) {
    const Eigen::Vector3d x = normal.unitOrthogonal();
    return {x, normal.cross(x), normal};
}

using Design = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor,
                             kMaxNeighbours, kMaxCoefficients>;
using Heights = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxNeighbours, 1>;

}  // namespace

std::optional<Jet> fit_jet(const Eigen::Vector3d& centre, const Eigen::Vector3d& normal_guess,
                           std::span<const Eigen::Vector3d> neighbours, int degree) {
    const int unknowns = degree == 3 ? 9 : 5;
    const int count = std::min(static_cast<int>(neighbours.size()), kMaxNeighbours);
    if (count < unknowns + kSpareNeighbours) {
        return std::nullopt;
    }
    const Frame frame = frame_about(normal_guess);
    double radius = 0.0;
    for (int i = 0; i < count; ++i) {
        radius = std::max(radius, (neighbours[static_cast<std::size_t>(i)] - centre).norm());
    }
    Design design(count, unknowns);
    Heights heights(count);
    for (int i = 0; i < count; ++i) {
        const Eigen::Vector3d d = (neighbours[static_cast<std::size_t>(i)] - centre) / radius;
        const double x = d.dot(frame.x);
        const double y = d.dot(frame.y);
        heights[i] = d.dot(frame.z);
        design(i, 0) = x;
        design(i, 1) = y;
        design(i, 2) = x * x;
        design(i, 3) = x * y;
        design(i, 4) = y * y;
        if (degree == 3) {
            design(i, 5) = x * x * x;
            design(i, 6) = x * x * y;
            design(i, 7) = x * y * y;
            design(i, 8) = y * y * y;
        }
    }
    Eigen::ColPivHouseholderQR<Design> qr(design);
    qr.setThreshold(kRankThreshold);
    if (qr.rank() < unknowns) {
        return std::nullopt;
    }
    const Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxCoefficients, 1> c =
        qr.solve(heights);
    Jet jet;
    const double stretch = std::sqrt(1.0 + c[0] * c[0] + c[1] * c[1]);
    jet.normal = (frame.z - c[0] * frame.x - c[1] * frame.y) / stretch;
    if (!(jet.normal.dot(normal_guess) >= kMinNormalAgreement)) {
        return std::nullopt;
    }
    const Eigen::Matrix3d hessian =
        2.0 * c[2] * frame.x * frame.x.transpose() + 2.0 * c[4] * frame.y * frame.y.transpose() +
        c[3] * (frame.x * frame.y.transpose() + frame.y * frame.x.transpose());
    const Eigen::Matrix3d tangential =
        Eigen::Matrix3d::Identity() - jet.normal * jet.normal.transpose();
    jet.shape_operator_per_mm = tangential * hessian * tangential * (-1.0 / (stretch * radius));
    return jet;
}

Eigen::Matrix3d shape_operator_from_normals(const Eigen::Vector3d& centre,
                                            const Eigen::Vector3d& normal,
                                            std::span<const Eigen::Vector3d> neighbours,
                                            std::span<const Eigen::Vector3d> normals) {
    // Each neighbour asks for S d = dn; solved for the three entries of the symmetric 2 x 2 matrix.
    const Frame frame = frame_about(normal);
    Eigen::Matrix3d lhs = Eigen::Matrix3d::Zero();
    Eigen::Vector3d rhs = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < neighbours.size(); ++i) {
        const Eigen::Vector3d d = neighbours[i] - centre;
        const Eigen::Vector3d dn = normals[i] - normal;
        Eigen::Matrix<double, 2, 3> rows;
        rows << d.dot(frame.x), d.dot(frame.y), 0.0, 0.0, d.dot(frame.x), d.dot(frame.y);
        const Eigen::Vector2d change(dn.dot(frame.x), dn.dot(frame.y));
        const double weight = 1.0 / d.squaredNorm();
        lhs += weight * rows.transpose() * rows;
        rhs += weight * rows.transpose() * change;
    }
    Eigen::ColPivHouseholderQR<Eigen::Matrix3d> qr(lhs);
    qr.setThreshold(kRankThreshold * kRankThreshold);
    const Eigen::Vector3d s = qr.solve(rhs);
    return s[0] * frame.x * frame.x.transpose() + s[2] * frame.y * frame.y.transpose() +
           s[1] * (frame.x * frame.y.transpose() + frame.y * frame.x.transpose());
}

}  // namespace meshwind
