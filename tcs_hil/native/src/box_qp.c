#include "box_qp.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Every step of the method lowers the cost, so it ends by itself; rounding alone could keep it
   going, and what it then has is the solution up to rounding. */
enum { ITERATIONS_PER_VARIABLE = 10, FEWEST_ITERATIONS = 20 };

/* Append variable i to the free ones: one more row of the factor.  False: H is not positive
   definite, or not finite. */
static int factor_append(box_qp *qp, int i) {
    const int n = qp->n, k = qp->free_count;
    double *row = qp->factor + k * n, pivot = qp->hessian[i * n + i];
    for (int r = 0; r < k; r++) {
        const double *other = qp->factor + r * n;
        double sum = qp->hessian[i * n + qp->free[r]];
        for (int c = 0; c < r; c++) sum -= row[c] * other[c];
        row[r] = sum * qp->inverse_pivot[r];
        pivot -= row[r] * row[r];
    }
    if (!(pivot > 0.0 && pivot <= DBL_MAX)) return 0;
    row[k] = sqrt(pivot);
    qp->inverse_pivot[k] = 1.0 / row[k];
    qp->free[k] = i;
    qp->is_free[i] = 1;
    qp->free_count++;
    return 1;
}

/* Fix the k-th free variable.  The rows below it are made anew instead of being rotated: as
   quick for so few, and no rounding gathers over hours of warm starts. */
static void factor_remove(box_qp *qp, int k) {
    const int behind = qp->free_count - k - 1;
    int later[BOX_QP_MAX];
    memcpy(later, qp->free + k + 1, (size_t)behind * sizeof *later);
    qp->is_free[qp->free[k]] = 0;
    qp->free_count = k;
    /* Cannot fail: what is left of a positive definite matrix is one. */
    for (int r = 0; r < behind; r++) factor_append(qp, later[r]);
}

int box_qp_refactor(box_qp *qp) {
    const int count = qp->free_count;
    int variables[BOX_QP_MAX];
    memcpy(variables, qp->free, (size_t)count * sizeof *variables);
    qp->free_count = 0;
    for (int k = 0; k < count; k++)
        if (!factor_append(qp, variables[k])) return SOLVE_FAILED;
    return SOLVE_OK;
}

void box_qp_reset(box_qp *qp) {
    memset(qp->x, 0, sizeof qp->x);
    for (int i = 0; i < qp->n; i++) qp->free[i] = i;
    qp->free_count = qp->n;
    box_qp_refactor(qp);
}

int box_qp_setup(box_qp *qp, int n, const double *hessian) {
    if (n < 1 || n > BOX_QP_MAX) return SOLVE_FAILED;
    qp->n = n;
    memcpy(qp->hessian, hessian, (size_t)(n * n) * sizeof *hessian);
    box_qp_reset(qp);
    return qp->free_count == n ? SOLVE_OK : SOLVE_FAILED;
}

/* slope = Hx + g.  Returns the size of what was added up: its rounding is in proportion. */
static double slope_at_x(box_qp *qp, const double *g) {
    const int n = qp->n;
    double product[BOX_QP_MAX] = {0}, size = 0.0;
    for (int j = 0; j < n; j++) { /* by columns, which are rows: no sum waits for the one before */
        const double *column = qp->hessian + j * n, factor = qp->x[j];
        for (int i = 0; i < n; i++) product[i] += column[i] * factor;
    }
    for (int i = 0; i < n; i++) {
        qp->slope[i] = product[i] + g[i];
        size += fabs(product[i]) + fabs(g[i]);
    }
    return size;
}

/* The step of the free variables to the minimum over them: L L' step = -slope. */
static void newton_step(box_qp *qp) {
    const int n = qp->n, m = qp->free_count;
    double *step = qp->step;
    for (int r = 0; r < m; r++) {
        const double *row = qp->factor + r * n;
        double sum = -qp->slope[qp->free[r]];
        for (int c = 0; c < r; c++) sum -= row[c] * step[c];
        step[r] = sum * qp->inverse_pivot[r];
    }
    for (int r = m - 1; r >= 0; r--) {
        const double *row = qp->factor + r * n;
        step[r] *= qp->inverse_pivot[r];
        for (int c = 0; c < r; c++) step[c] -= row[c] * step[r];
    }
}

static double within(double value, double lower, double upper) {
    return value < lower ? lower : value > upper ? upper : value;
}

/* Go along the step until the first bound, and fix what met it.  True: nothing was in the way. */
static int move(box_qp *qp, const double *lower, const double *upper) {
    double length = 1.0;
    int blocking = -1;
    for (int k = 0; k < qp->free_count; k++) {
        const int i = qp->free[k];
        const double bound = qp->step[k] > 0.0 ? upper[i] : lower[i], room = bound - qp->x[i];
        if (fabs(room) < length * fabs(qp->step[k])) {
            length = room / qp->step[k];
            blocking = k;
        }
    }
    for (int k = 0; k < qp->free_count; k++) {
        const int i = qp->free[k]; /* rounding may carry it over the bound it just does not meet */
        qp->x[i] = within(qp->x[i] + length * qp->step[k], lower[i], upper[i]);
    }
    if (blocking < 0) return 1;
    const int i = qp->free[blocking];
    qp->at_upper[i] = qp->step[blocking] > 0.0;
    qp->x[i] = qp->at_upper[i] ? upper[i] : lower[i];
    factor_remove(qp, blocking);
    return 0;
}

/* The fixed variable whose bound costs most, or -1 at the solution. */
static int dearest_bound(const box_qp *qp, double tolerance, const double *lower,
                         const double *upper) {
    int dearest = -1;
    for (int i = 0; i < qp->n; i++) {
        const double price = qp->at_upper[i] ? qp->slope[i] : -qp->slope[i];
        if (qp->is_free[i] || !(lower[i] < upper[i]) || !(price > tolerance)) continue;
        tolerance = price;
        dearest = i;
    }
    return dearest;
}

/* The last solution moved into the box, fixed variables to their bounds.  False: not finite. */
static int start(box_qp *qp, const double *g, const double *lower, const double *upper) {
    double sum = 0.0;
    for (int i = 0; i < qp->n; i++) {
        sum += fabs(g[i]) + fabs(lower[i]) + fabs(upper[i]);
        if (qp->is_free[i])
            qp->x[i] = within(qp->x[i], lower[i], upper[i]);
        else
            qp->x[i] = qp->at_upper[i] ? upper[i] : lower[i];
    }
    return sum <= DBL_MAX;
}

int box_qp_solve(box_qp *qp, const double *g, const double *lower, const double *upper) {
    const int limit = FEWEST_ITERATIONS + ITERATIONS_PER_VARIABLE * qp->n;
    qp->iterations = 0;
    if (!start(qp, g, lower, upper)) return SOLVE_FAILED;
    const double size = slope_at_x(qp, g);
    while (++qp->iterations <= limit) {
        newton_step(qp);
        const int minimal = move(qp, lower, upper);
        const double tolerance = DBL_EPSILON * (size + slope_at_x(qp, g));
        if (!(tolerance <= DBL_MAX)) return SOLVE_FAILED;
        if (!minimal) continue;
        const int i = dearest_bound(qp, tolerance, lower, upper);
        if (i < 0) return SOLVE_OK;
        if (!factor_append(qp, i)) return SOLVE_FAILED;
    }
    return SOLVE_MAX_ITERATIONS;
}
