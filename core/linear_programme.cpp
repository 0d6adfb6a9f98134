#include "core/linear_programme.h"

#include <algorithm>
#include <cmath>

#include <glpk.h>

#include "core/random.h"

namespace meshwind {

struct LinearProgramme::Model {
    glp_prob* glp = glp_create_prob();
    std::vector<Row> rows;
    // Columns as given, one behind the other.
    std::vector<double> cost;
    std::vector<double> most;
    std::vector<std::size_t> begin{0};
    std::vector<int> row;
    std::vector<double> value;
};

namespace {

// The simplex method goes round in a circle now and then, where many bases are one corner. Then
// rows may lack so much, of their bound.
constexpr double kMaxLack = 1e-4;

// GLPK counts rows and columns from 1.
int kind_of(double least, double most) {
    if (std::isinf(least) && std::isinf(most)) {
        return GLP_FR;
    }
    if (std::isinf(most)) {
        return GLP_LO;
    }
    if (std::isinf(least)) {
        return GLP_UP;
    }
    return least == most ? GLP_FX : GLP_DB;
}

}  // namespace

// Lets each row lack a little, each by another share: what were many bases at one corner are
// corners of their own then.
void LinearProgramme::tell_apart(Model& model) {
    for (std::size_t i = 0; i < model.rows.size(); ++i) {
        const Row& row = model.rows[i];
        const double share = 0.5 * (1.0 + random_unit(0, i));
        if (row.least < row.most && std::isfinite(row.least)) {
            const double least = row.least - kMaxLack * share * std::max(1.0, std::abs(row.least));
            glp_set_row_bnds(model.glp, static_cast<int>(i) + 1, kind_of(least, row.most), least,
                             row.most);
        }
    }
}

LinearProgramme::LinearProgramme(std::span<const Row> rows) : model_(std::make_unique<Model>()) {
    model_->rows.assign(rows.begin(), rows.end());
    glp_term_out(GLP_OFF);
    glp_add_rows(model_->glp, static_cast<int>(rows.size()));
    for (std::size_t i = 0; i < rows.size(); ++i) {
        glp_set_row_bnds(model_->glp, static_cast<int>(i) + 1, kind_of(rows[i].least, rows[i].most),
                         rows[i].least, rows[i].most);
    }
}

LinearProgramme::~LinearProgramme() {
    glp_delete_prob(model_->glp);
}

int LinearProgramme::add_column(double cost, double most, std::span<const RowEntry> entries) {
    Model& model = *model_;
    const int column = glp_add_cols(model.glp, 1);
    std::vector<int> index{0};
    std::vector<double> value{0.0};
    for (const RowEntry& entry : entries) {
        index.push_back(entry.row + 1);
        value.push_back(entry.value);
        model.row.push_back(entry.row);
        model.value.push_back(entry.value);
    }
    glp_set_obj_coef(model.glp, column, cost);
    glp_set_col_bnds(model.glp, column, kind_of(0.0, most), 0.0, most);
    glp_set_mat_col(model.glp, column, static_cast<int>(entries.size()), index.data(),
                    value.data());
    glp_set_col_stat(model.glp, column, GLP_NL);
    model.cost.push_back(cost);
    model.most.push_back(most);
    model.begin.push_back(model.row.size());
    return column - 1;
}

void LinearProgramme::close(int column) {
    glp_set_col_bnds(model_->glp, column + 1, GLP_FX, 0.0, 0.0);
    model_->most[static_cast<std::size_t>(column)] = 0.0;
}

LinearProgramme::Solution LinearProgramme::solve(int most_steps) {
    Model& model = *model_;
    glp_smcp options;
    glp_init_smcp(&options);
    options.msg_lev = GLP_MSG_OFF;
    options.meth = GLP_PRIMAL;
    options.it_lim = most_steps;
    if (glp_simplex(model.glp, &options) == GLP_EITLIM) {
        tell_apart(model);
        glp_simplex(model.glp, &options);
    }
    Solution solution;
    const int status = glp_get_status(model.glp);
    solution.optimal = status == GLP_OPT;
    solution.feasible = solution.optimal || status == GLP_FEAS;
    std::vector<double> sum(model.rows.size(), 0.0);
    for (std::size_t i = 0; i < model.cost.size(); ++i) {
        const double x = glp_get_col_prim(model.glp, static_cast<int>(i) + 1);
        solution.x.push_back(x);
        solution.cost += model.cost[i] * x;
        solution.worst_breach = std::max({solution.worst_breach, -x, x - model.most[i]});
        for (std::size_t k = model.begin[i]; k < model.begin[i + 1]; ++k) {
            sum[static_cast<std::size_t>(model.row[k])] += model.value[k] * x;
        }
    }
    for (std::size_t r = 0; r < sum.size(); ++r) {
        solution.price.push_back(glp_get_row_dual(model.glp, static_cast<int>(r) + 1));
        solution.worst_breach = std::max(
            {solution.worst_breach, model.rows[r].least - sum[r], sum[r] - model.rows[r].most});
    }
    return solution;
}

}  // namespace meshwind
