/// Damped least squares with bounds, for inverses that have no closed form.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace meshwind {

/// Residuals at `x` and, by rows, their derivatives: row i, column j is d residual_i / d x_j.
/// Both are passed in with their right sizes.
using ResidualFunction = std::function<void(
    const std::vector<double>& x, std::vector<double>& residuals, std::vector<double>& jacobian)>;

struct LeastSquaresProblem {
    ResidualFunction evaluate;
    std::size_t residuals = 0;
    std::vector<double> min;       ///< one per unknown; infinite: no bound
    std::vector<double> max;       ///< one per unknown
    std::vector<double> max_step;  ///< > 0: largest change of each unknown in one iteration
};

struct LeastSquaresResult {
    std::vector<double> x;
    double norm = 0.0;  ///< of the residuals at x
    int iterations = 0;
};

/// Levenberg-Marquardt from `start` with the bounds kept by holding unknowns that would leave them.
/// Ends at a norm of `goal`, where no step helps any more, or after `most_iterations`.
/// \param start within the bounds, or it is moved there
[[nodiscard]] LeastSquaresResult damped_least_squares(const LeastSquaresProblem& problem,
                                                      std::vector<double> start, double goal,
                                                      int most_iterations);

}  // namespace meshwind
