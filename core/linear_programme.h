/// Linear programmes by column generation: columns are added as they are found to pay.
#pragma once

#include <memory>
#include <span>
#include <vector>

namespace meshwind {

/// An entry of a column.
struct RowEntry {
    int row = 0;
    double value = 0.0;
};

/// Minimises the cost of columns x >= 0 with `least <= A x <= most` in each row. Solved by GLPK's
/// primal simplex method; the breach of bounds by its answer is computed here.
class LinearProgramme {
public:
    struct Row {
        double least = 0.0;
        double most = 0.0;
    };

    /// \param rows n >= 1; infinities where a side is open
    explicit LinearProgramme(std::span<const Row> rows);
    ~LinearProgramme();
    LinearProgramme(const LinearProgramme&) = delete;
    LinearProgramme& operator=(const LinearProgramme&) = delete;
    LinearProgramme(LinearProgramme&&) = delete;
    LinearProgramme& operator=(LinearProgramme&&) = delete;

    /// \param most upper bound of the column, may be infinite \param entries each row at most once
    /// \return its number, in the order in which they are added
    int add_column(double cost, double most, std::span<const RowEntry> entries);

    /// The column is 0 from now on.
    void close(int column);

    struct Solution {
        bool optimal = false;
        /// x keeps all bounds; feasible but not optimal: the method was given up.
        bool feasible = false;
        double cost = 0.0;
        std::vector<double> x;      ///< per column
        std::vector<double> price;  ///< per row, dual value: cost of one more of its bound
        /// Largest breach of a row or column by x, computed from the columns as they were given.
        double worst_breach = 0.0;
    };
    /// Starts from nothing at the first call, then from where the last call ended. Where the method
    /// cycles it goes on with rows that may lack up to 1e-4 of their bounds.
    /// \param most_steps steps after which it is taken to cycle
    [[nodiscard]] Solution solve(int most_steps = kMaxSteps);

private:
    // Some hundred columns with eight hundred rows take two thousand.
    static constexpr int kMaxSteps = 4'000;

    struct Model;
    static void tell_apart(Model& model);
    std::unique_ptr<Model> model_;
};

}  // namespace meshwind
