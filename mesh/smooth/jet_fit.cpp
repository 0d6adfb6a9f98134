#include "mesh/smooth/jet_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <Eigen/QR>

#include "core/index.h"

namespace meshwind {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t kMaxNeighbours =
    64;  // three rings of a regular mesh hold 36; more adds nothing

// Share of a column (no unit) that must be left when the columns before it are taken out: below it,
// its coefficient would be amplified a hundredfold and is not determined.
constexpr double kDetermined = 1e-2;

// Below this share a column is badly determined, as at the end of a wall, to one side of which
// there is nothing: what a polynomial of its degree misses by comes out tenfold or more. Such a
// degree is kept where it makes the slope so many times better than the degree below it, by
// standard errors.
constexpr double kWellDetermined = 1e-1;
constexpr double kClearlyBetter = 2.0;

// Neighbours beyond the unknowns: an exactly determined fit would follow noise.
constexpr std::size_t kSpareNeighbours = 2;

// Cosine between guess and fitted normal (45 deg): a fit further off has gone astray.
constexpr double kMinNormalAgreement = 0.7;

// Spread across against spread along (no unit) below which neighbours lie on a line.
constexpr double kMinSpread = 1e-6;

// Neighbours up to this many times as far as the nearest tell which way facets are short.
constexpr double kNear = 1.5;

// Terms up to each degree.
constexpr std::array<std::size_t, kMaxJetDegree + 1> kTermsTo = {0, 2, 5, 9, kJetTerms};

// Powers of x and y in each term.
struct Power {
    int x;
    int y;
};
constexpr std::array<Power, kJetTerms> kPower = {{{1, 0},
                                                  {0, 1},
                                                  {2, 0},
                                                  {1, 1},
                                                  {0, 2},
                                                  {3, 0},
                                                  {2, 1},
                                                  {1, 2},
                                                  {0, 3},
                                                  {4, 0},
                                                  {3, 1},
                                                  {2, 2},
                                                  {1, 3},
                                                  {0, 4}}};

using Column =
    Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, static_cast<int>(kMaxNeighbours), 1>;

// The columns of a least-squares problem made orthogonal in a fixed order, low degrees first, so
// that of terms that cannot be told apart the lower one stays.
class OrderedFit {
public:
    explicit OrderedFit(const Column& heights) : rest_(heights) {}

    // Takes the next column; false, and it is left out, where it is not determined. A zero column
    // and one that is not a number are not.
    bool add(Column column) {
        const double size = column.norm();
        Row row{};
        for (std::size_t k = 0; k < count_; ++k) {
            row.share[k] = direction_[k].dot(column);
            column -= row.share[k] * direction_[k];
        }
        const double left = column.norm();
        if (!(left > kDetermined * size)) {
            return false;
        }
        row.share[count_] = left;
        direction_[count_] = column / left;
        row.height = direction_[count_].dot(rest_);
        rest_ -= row.height * direction_[count_];
        row.well_determined =
            left > kWellDetermined * size && (count_ == 0 || row_[count_ - 1].well_determined);
        row.misfit = rest_.squaredNorm();
        row_[count_++] = row;
        return true;
    }

    // Whether the first `count` columns are, one and all.
    [[nodiscard]] bool well_determined(std::size_t count) const {
        return row_[count - 1].well_determined;
    }

    // Standard error of the first two coefficients in a fit with the first `count` columns, as its
    // misfit tells it. \pre there are more neighbours than columns
    [[nodiscard]] std::array<double, 2> errors(std::size_t count) const {
        const auto spare = static_cast<double>(rest_.size()) - static_cast<double>(count);
        std::array<double, 2> error{};
        for (std::size_t wanted = 0; wanted < error.size(); ++wanted) {
            std::array<double, kJetTerms> inverse{};  // row of the inverse of the shares
            double sum = 0.0;
            for (std::size_t k = wanted; k < count; ++k) {
                double value = k == wanted ? 1.0 : 0.0;
                for (std::size_t j = wanted; j < k; ++j) {
                    value -= row_[k].share[j] * inverse[j];
                }
                inverse[k] = value / row_[k].share[k];
                sum += inverse[k] * inverse[k];
            }
            error[wanted] = std::sqrt(sum * row_[count - 1].misfit / spare);
        }
        return error;
    }

    // Coefficients of the first `count` columns that were taken.
    [[nodiscard]] std::array<double, kJetTerms> solve(std::size_t count) const {
        std::array<double, kJetTerms> c{};
        for (std::size_t k = count; k-- > 0;) {
            double value = row_[k].height;
            for (std::size_t j = k + 1; j < count; ++j) {
                value -= row_[j].share[k] * c[j];
            }
            c[k] = value / row_[k].share[k];
        }
        return c;
    }

    [[nodiscard]] std::size_t count() const { return count_; }

private:
    struct Row {
        std::array<double, kJetTerms> share{};  // of the directions in this column
        double height = 0.0;                    // of the heights along this direction
        double misfit = 0.0;                    // squares of the heights that are left
        bool well_determined = false;           // this column and those before it
    };
    Column rest_;
    std::array<Column, kJetTerms> direction_;
    std::array<Row, kJetTerms> row_{};
    std::size_t count_ = 0;
};

// Neighbours in the plane, each axis scaled to 1; rows weighted by the inverse square of the scaled
// distance, so that the near ones count where the polynomial does not fit.
struct Scaled {
    Column x, y, height, weight;
    double x_mm = 0.0;
    double y_mm = 0.0;

    [[nodiscard]] Column column(const Power& power) const {
        Column c = weight;
        for (int i = 0; i < power.x; ++i) {
            c.array() *= x.array();
        }
        for (int i = 0; i < power.y; ++i) {
            c.array() *= y.array();
        }
        return c;
    }

    [[nodiscard]] double unit(const Power& power) const {
        return std::pow(x_mm, power.x) * std::pow(y_mm, power.y);
    }
};

// Unit direction in the plane along which the nearest neighbours lie: across long facets, so that
// the frame's other axis is the one they are ruled along.
Vector3d across(const Vector3d& centre, const Vector3d& normal,
                std::span<const Vector3d> neighbours) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vector3d& p : neighbours) {
        nearest = std::min(nearest, (p - centre).squaredNorm());
    }
    const Vector3d a = normal.unitOrthogonal();
    const Vector3d b = normal.cross(a);
    double twice_cos = 0.0;
    double twice_sin = 0.0;
    for (const Vector3d& p : neighbours) {
        if ((p - centre).squaredNorm() <= kNear * kNear * nearest) {
            const double u = a.dot(p - centre);
            const double v = b.dot(p - centre);
            twice_cos += u * u - v * v;
            twice_sin += 2.0 * u * v;
        }
    }
    const double angle = 0.5 * std::atan2(twice_sin, twice_cos);
    return std::cos(angle) * a + std::sin(angle) * b;
}

Scaled scale(const Vector3d& centre, const Matrix3d& frame, std::span<const Vector3d> neighbours) {
    const auto count = static_cast<Eigen::Index>(neighbours.size());
    Scaled s{Column(count), Column(count), Column(count), Column(count)};
    for (Eigen::Index i = 0; i < count; ++i) {
        const Vector3d d = frame.transpose() * (neighbours[static_cast<std::size_t>(i)] - centre);
        s.x[i] = d.x();
        s.y[i] = d.y();
        s.height[i] = d.z();
    }
    s.x_mm = s.x.cwiseAbs().maxCoeff();
    s.y_mm = s.y.cwiseAbs().maxCoeff();
    s.x /= s.x_mm;
    s.y /= s.y_mm;
    s.weight = (s.x.cwiseAbs2() + s.y.cwiseAbs2()).cwiseInverse();
    return s;
}

// Normal and curvature of the height at the vertex itself.
void differentiate(Jet& jet) {
    const auto& c = jet.height.coefficient;
    const Vector3d x = jet.height.frame.col(0);
    const Vector3d y = jet.height.frame.col(1);
    const double stretch = std::sqrt(1.0 + c[0] * c[0] + c[1] * c[1]);
    jet.normal = (jet.height.frame.col(2) - c[0] * x - c[1] * y) / stretch;
    const Matrix3d hessian = 2.0 * c[2] * x * x.transpose() + 2.0 * c[4] * y * y.transpose() +
                             c[3] * (x * y.transpose() + y * x.transpose());
    const Matrix3d tangential = Matrix3d::Identity() - jet.normal * jet.normal.transpose();
    jet.shape_operator_per_mm = tangential * hessian * tangential / -stretch;
}

}  // namespace

// By Horner in x inside Horner in y.
std::optional<Jet> fit_jet(const Vector3d& centre, const Vector3d& normal_guess,
                           std::span<const Vector3d> neighbours, int max_degree) {
    neighbours = neighbours.first(std::min(neighbours.size(), kMaxNeighbours));
    if (neighbours.size() <= kSpareNeighbours) {
        return std::nullopt;
    }
    Jet jet;
    const Vector3d x = across(centre, normal_guess, neighbours);
    jet.height.frame << x, normal_guess.cross(x), normal_guess;
    const Scaled s = scale(centre, jet.height.frame, neighbours);
    if (!(std::min(s.x_mm, s.y_mm) > kMinSpread * std::max(s.x_mm, s.y_mm))) {
        return std::nullopt;
    }
    OrderedFit fit(s.height.cwiseProduct(s.weight));
    std::array<std::size_t, kJetTerms> taken{};
    std::size_t tried = 0;
    int degree = 0;  // up to which every term was taken
    for (int d = 1; d <= max_degree; ++d) {
        for (; tried < kTermsTo[at(d)] && fit.count() + kSpareNeighbours < neighbours.size();
             ++tried) {
            if (fit.add(s.column(kPower[tried]))) {
                taken[fit.count() - 1] = tried;
            }
        }
        if (fit.count() == kTermsTo[at(d)]) {
            degree = d;
        }
    }
    const auto slope_error = [&](int d) {
        const std::array<double, 2> error = fit.errors(kTermsTo[at(d)]);
        return std::hypot(error[0] / s.x_mm, error[1] / s.y_mm);
    };
    while (degree > 2 && !fit.well_determined(kTermsTo[at(degree)]) &&
           kClearlyBetter * slope_error(degree) > slope_error(degree - 1)) {
        --degree;
    }
    // The plane and some curvature at least.
    if (degree < 1 || tried < kTermsTo[2] || fit.count() == kTermsTo[1]) {
        return std::nullopt;
    }
    const std::size_t count = degree > 1 ? kTermsTo[at(degree)] : fit.count();
    const std::array<double, kJetTerms> c = fit.solve(count);
    for (std::size_t k = 0; k < count; ++k) {
        jet.height.coefficient[taken[k]] = c[k] / s.unit(kPower[taken[k]]);
    }
    jet.terms = degree == 4   ? JetTerms::Quartic
                : degree == 3 ? JetTerms::Cubic
                : degree == 2 ? JetTerms::Quadratic
                              : JetTerms::Reduced;
    differentiate(jet);
    if (!(jet.normal.dot(normal_guess) >= kMinNormalAgreement)) {
        return std::nullopt;
    }
    return jet;
}

Jet jet_from_normals(const Vector3d& centre, const Vector3d& normal,
                     std::span<const Vector3d> neighbours, std::span<const Vector3d> normals) {
    Jet jet;
    const Vector3d x = normal.unitOrthogonal();
    const Vector3d y = normal.cross(x);
    jet.height.frame << x, y, normal;
    // Each neighbour asks for S d = dn; solved for the three entries of the symmetric 2 x 2 matrix.
    Matrix3d lhs = Matrix3d::Zero();
    Vector3d rhs = Vector3d::Zero();
    for (std::size_t i = 0; i < neighbours.size(); ++i) {
        const Vector3d d = neighbours[i] - centre;
        const Vector3d dn = normals[i] - normal;
        Eigen::Matrix<double, 2, 3> rows;
        rows << d.dot(x), d.dot(y), 0.0, 0.0, d.dot(x), d.dot(y);
        const double weight = 1.0 / d.squaredNorm();
        lhs += weight * rows.transpose() * rows;
        rhs += weight * rows.transpose() * Eigen::Vector2d(dn.dot(x), dn.dot(y));
    }
    Eigen::ColPivHouseholderQR<Matrix3d> qr(lhs);
    qr.setThreshold(kDetermined * kDetermined);
    const Vector3d s = qr.solve(rhs);
    jet.height.coefficient[2] = -0.5 * s[0];
    jet.height.coefficient[3] = -s[1];
    jet.height.coefficient[4] = -0.5 * s[2];
    jet.terms = JetTerms::Averaged;
    differentiate(jet);
    return jet;
}

}  // namespace meshwind
