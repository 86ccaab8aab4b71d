#include "sqp.h"

#include <math.h>
#include <string.h>

/* See tcs_hil/control/sqp.py. */
static const double STEP_TOLERANCE_NM = 1.5e-3;
static const double LEAST_SHRINKAGE = 5e-4;
static const double ARMIJO = 1e-4;
enum { HALVINGS = 16 };

void sqp_setup(sqp *solver, int n, int max_iterations, double leftover_nm) {
    memset(solver, 0, sizeof *solver);
    solver->qp.n = n;
    solver->max_iterations = max_iterations;
    solver->leftover_nm = leftover_nm;
    sqp_reset(solver);
}

void sqp_reset(sqp *solver) {
    const int n = solver->qp.n;
    solver->shrinkage = 1.0;
    memset(solver->plan, 0, sizeof solver->plan);
    memset(solver->point, 0, sizeof solver->point);
    memset(solver->gradient, 0, sizeof solver->gradient);
    memset(solver->qp.hessian, 0, sizeof solver->qp.hessian);
    for (int i = 0; i < n; i++) solver->qp.hessian[i * n + i] = 1.0;
    box_qp_reset(&solver->qp);
}

/* Minimise the model within the box; the step is left in qp.x. */
static int box_step(sqp *solver, double ceiling_nm) {
    double lower[BOX_QP_MAX], upper[BOX_QP_MAX];
    for (int i = 0; i < solver->qp.n; i++) {
        lower[i] = -solver->point[i];
        upper[i] = ceiling_nm - solver->point[i];
    }
    return box_qp_solve(&solver->qp, solver->gradient, lower, upper);
}

void sqp_expect(sqp *solver, double ceiling_nm) {
    const int status = box_step(solver, ceiling_nm);
    for (int i = 0; i < solver->qp.n; i++)
        solver->plan[i] = status == SOLVE_OK ? solver->point[i] + solver->qp.x[i] : 0.0;
}

static double model_at_plan(sqp *solver, least_squares *model, void *problem) {
    memcpy(solver->point, solver->plan, sizeof solver->point);
    return model(problem, solver->qp.n, solver->plan, solver->gradient, solver->qp.hessian);
}

static double longest(int n, const double *step) {
    double size = 0.0;
    for (int i = 0; i < n; i++) size = fmax(size, fabs(step[i]));
    return size;
}

static double inner(int n, const double *a, const double *b) {
    double sum = 0.0;
    for (int i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}

/* Go along the step until the cost falls enough (Armijo); the model follows the plan, unless it
   was the last step. */
static double search(sqp *solver, least_squares *model, void *problem, double cost) {
    const int n = solver->qp.n, is_last = solver->iterations == solver->max_iterations;
    const double slope = ARMIJO * inner(n, solver->gradient, solver->qp.x);
    double start[BOX_QP_MAX], trial_cost = cost, length = 1.0;
    memcpy(start, solver->plan, sizeof start);
    for (int k = 0; k < HALVINGS; k++, length *= 0.5) {
        for (int i = 0; i < n; i++) solver->plan[i] = start[i] + length * solver->qp.x[i];
        trial_cost = is_last ? model(problem, n, solver->plan, 0, 0)
                             : model_at_plan(solver, model, problem);
        if (trial_cost <= cost + length * slope) break;
    }
    return trial_cost;
}

static int solve_model(sqp *solver, double ceiling_nm) {
    if (box_qp_refactor(&solver->qp) != SOLVE_OK) return SOLVE_FAILED;
    return box_step(solver, ceiling_nm);
}

/* Is a step of this length the last one? */
static int suffices(sqp *solver, double length, double before) {
    if (solver->iterations > 1) solver->shrinkage = fmax(length / before, LEAST_SHRINKAGE);
    return length <= STEP_TOLERANCE_NM || length * solver->shrinkage <= solver->leftover_nm;
}

int sqp_minimise(sqp *solver, least_squares *model, void *problem, double ceiling_nm) {
    const int n = solver->qp.n;
    double cost = model_at_plan(solver, model, problem), length = 0.0;
    for (solver->iterations = 1; solver->iterations <= solver->max_iterations;
         solver->iterations++) {
        if (!isfinite(cost) || solve_model(solver, ceiling_nm) != SOLVE_OK) return SOLVE_FAILED;
        const double before = length;
        length = longest(n, solver->qp.x);
        if (suffices(solver, length, before)) {
            for (int i = 0; i < n; i++) solver->plan[i] += solver->qp.x[i];
            return SOLVE_OK;
        }
        cost = search(solver, model, problem, cost);
    }
    solver->iterations = solver->max_iterations;
    return SOLVE_MAX_ITERATIONS;
}
