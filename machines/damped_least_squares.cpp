#include "machines/damped_least_squares.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace meshwind {
namespace {

// Share of the largest diagonal entry of J^T J that is added to all; it grows where a step fails
// and shrinks where one helps, and starts lower where little is left to do. At the least one, steps
// are those of Newton's method but for a direction in which the residuals hardly change.
constexpr double kFirstDamping = 1e-3;
constexpr double kMinDamping = 1e-14;
constexpr double kMaxDamping = 1e6;
constexpr double kHarder = 10.0;
constexpr double kSofter = 0.05;
// A step shorter than this share of the unknowns' size is rounding.
constexpr double kSmallestStep = 1e-16;

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

class Search {
public:
    Search(const LeastSquaresProblem& problem, std::vector<double> start)
        : problem_(problem),
          x_(std::move(start)),
          residuals_(problem.residuals),
          jacobian_(problem.residuals * x_.size()),
          tried_residuals_(problem.residuals),
          tried_jacobian_(jacobian_.size()) {
        for (std::size_t j = 0; j < x_.size(); ++j) {
            x_[j] = std::clamp(x_[j], problem_.min[j], problem_.max[j]);
        }
        norm_ = evaluate(x_, residuals_, jacobian_);
    }

    LeastSquaresResult run(double goal, int most_iterations) {
        int iteration = 0;
        double damping = std::clamp(norm_, kMinDamping, kFirstDamping);
        while (norm_ > goal && iteration < most_iterations && damping < kMaxDamping) {
            ++iteration;
            const std::vector<double> step = step_with(damping);
            std::vector<double> tried = x_;
            double moved = 0.0;
            for (std::size_t j = 0; j < x_.size(); ++j) {
                tried[j] = std::clamp(x_[j] + step[j], problem_.min[j], problem_.max[j]);
                moved = std::max(moved, std::abs(tried[j] - x_[j]) / (1.0 + std::abs(x_[j])));
            }
            if (moved < kSmallestStep) {
                break;
            }
            const double norm = evaluate(tried, tried_residuals_, tried_jacobian_);
            if (norm < norm_) {
                x_ = tried;
                norm_ = norm;
                residuals_.swap(tried_residuals_);
                jacobian_.swap(tried_jacobian_);
                damping = std::max(kSofter * damping, kMinDamping);
            } else {
                damping *= kHarder;
            }
        }
        return {x_, norm_, iteration};
    }

private:
    double evaluate(const std::vector<double>& x, std::vector<double>& residuals,
                    std::vector<double>& jacobian) const {
        problem_.evaluate(x, residuals, jacobian);
        double squares = 0.0;
        for (const double r : residuals) {
            squares += r * r;
        }
        return std::sqrt(squares);
    }

    // Unknowns at a bound beyond which the step leads are held and the others solved again.
    [[nodiscard]] std::vector<double> step_with(double damping) const {
        const auto n = static_cast<Eigen::Index>(x_.size());
        const Eigen::Map<const Matrix> all(jacobian_.data(),
                                           static_cast<Eigen::Index>(problem_.residuals), n);
        const Eigen::Map<const Eigen::VectorXd> r(residuals_.data(),
                                                  static_cast<Eigen::Index>(problem_.residuals));
        Matrix free = all;
        std::vector<double> step(x_.size(), 0.0);
        for (bool held = true; held;) {
            held = false;
            Eigen::MatrixXd normal = free.transpose() * free;
            const double scale = std::max(normal.diagonal().maxCoeff(), 1e-300);
            normal.diagonal().array() += damping * scale;
            const Eigen::VectorXd solved = normal.ldlt().solve(-(free.transpose() * r));
            for (Eigen::Index j = 0; j < n; ++j) {
                const auto i = static_cast<std::size_t>(j);
                step[i] = solved[j];
                const bool out = (x_[i] <= problem_.min[i] && step[i] < 0.0) ||
                                 (x_[i] >= problem_.max[i] && step[i] > 0.0);
                if (out) {
                    step[i] = 0.0;
                    free.col(j).setZero();
                    held = true;
                }
            }
        }
        double share = 1.0;
        for (std::size_t j = 0; j < step.size(); ++j) {
            if (std::abs(step[j]) > problem_.max_step[j]) {
                share = std::min(share, problem_.max_step[j] / std::abs(step[j]));
            }
        }
        for (double& s : step) {
            s *= share;
        }
        return step;
    }

    const LeastSquaresProblem& problem_;
    std::vector<double> x_;
    std::vector<double> residuals_;
    std::vector<double> jacobian_;
    std::vector<double> tried_residuals_;
    std::vector<double> tried_jacobian_;
    double norm_ = 0.0;
};

}  // namespace

LeastSquaresResult damped_least_squares(const LeastSquaresProblem& problem,
                                        std::vector<double> start, double goal,
                                        int most_iterations) {
    return Search(problem, std::move(start)).run(goal, most_iterations);
}

}  // namespace meshwind
