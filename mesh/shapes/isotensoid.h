/// Isotensoid domes: under pressure a fibre wound along geodesics is strained alike everywhere.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace meshwind {

/// Design values of such a dome.
struct IsotensoidDesign {
    double equator_radius_mm = 75.0;
    /// Clairaut radius of the geodesics it is made for, at which they turn; below the equator's.
    double design_radius_mm = 15.0;
    /// k_e = E2 (1 + nu12) / (E1 (1 + nu21)), 0 to below 1; 0: the fibres carry all (netting).
    double stiffness_ratio = 0.0;
    /// Axial force on the end besides the pressure on the whole cross section, as a share of that.
    /// 0: the opening is capped and no other force pulls at it.
    double axial_share = 0.0;

    /// \throws InputError make.not_positive, make.negative, make.stiffness_ratio,
    /// make.design_radius
    void validate() const;
};

/// Meridian of the dome by a parameter t: 0 at the equator, pi / 2 where the profile turns back,
/// the least radius of an opening. Negative t: the same dome upside down.
///
/// With u = (Y / Y_eq)^2, g = design radius / Y_eq, q = (k_e - 1) g^2 the profile is
///     (dZ/dY)^2 = u (u + r)^2 / G,   G = ((q + u) / (q + 1))^(k_e + 1) (1 + r)^2 - u (u + r)^2,
/// eq. (7) of chen_2023_gas_cylinders with lengths in the units of the design radius, where the
/// print has none. G has simple zeros at the equator and where the profile turns back, u_min; with
/// u = u_min + (1 - u_min) cos^2 t nothing is singular, and no digits are lost at either end.
/// Accuracy: 1e-12 of the equator's radius; tests/mesh/shapes/isotensoid_test.cpp.
class IsotensoidDome {
public:
    /// \throws InputError what the design's validate throws
    explicit IsotensoidDome(const IsotensoidDesign& design);

    [[nodiscard]] const IsotensoidDesign& design() const { return design_; }
    /// Y_min, where the profile turns back.
    [[nodiscard]] double least_radius_mm() const;
    /// \pre least_radius_mm() <= radius_mm <= the equator's
    [[nodiscard]] double parameter_at(double radius_mm) const;
    [[nodiscard]] double radius_mm(double t) const;
    /// Above the equator; odd in t. \pre |t| <= pi / 2
    [[nodiscard]] double height_mm(double t) const;
    /// Derivative of radius and height by t; its length is the rate of the meridian's length.
    [[nodiscard]] Eigen::Vector2d rate_mm(double t) const;
    /// Length of the meridian from the equator to t >= 0.
    [[nodiscard]] double meridian_mm(double t) const;

    /// Principal curvatures, > 0 convex: along the meridian and along the parallel.
    struct Curvatures {
        double meridian_per_mm = 0.0;
        double parallel_per_mm = 0.0;
    };
    [[nodiscard]] Curvatures curvatures(double t) const;

private:
    // A stretch of t with Chebyshev's coefficients of the height there.
    struct Panel {
        double low, high;
        std::vector<double> height;
    };

    [[nodiscard]] double square(double t) const;  // u
    [[nodiscard]] double height_rate(double t) const;
    void find_least();
    void add_panels(double low, double high, int depth);

    IsotensoidDesign design_;
    double q_ = 0.0;
    double least_square_ = 0.0;  // u_min
    double least_above_ = 0.0;   // u_min + q
    std::vector<Panel> panels_;
};

}  // namespace meshwind
