#include "sqp.h"

#include <math.h>
#include <string.h>

/* A step this small is taken and ends the iteration. */
static const double STEP_TOLERANCE_NM = 1e-3;
static const double ARMIJO = 1e-4;
enum { HALVINGS = 16 };

void sqp_setup(sqp *solver, int n, int max_iterations) {
    memset(solver, 0, sizeof *solver);
    solver->qp.n = n;
    solver->max_iterations = max_iterations;
    sqp_reset(solver);
}

void sqp_reset(sqp *solver) {
    const int n = solver->qp.n;
    memset(solver->plan, 0, sizeof solver->plan);
    memset(solver->qp.hessian, 0, sizeof solver->qp.hessian);
    for (int i = 0; i < n; i++) solver->qp.hessian[i * n + i] = 1.0;
    box_qp_reset(&solver->qp);
}

/* Minimise the model within the box; the step is left in qp.x. */
static int box_step(sqp *solver, double ceiling_nm) {
    double lower[BOX_QP_MAX], upper[BOX_QP_MAX];
    for (int i = 0; i < solver->qp.n; i++) {
        lower[i] = -solver->plan[i];
        upper[i] = ceiling_nm - solver->plan[i];
    }
    if (box_qp_refactor(&solver->qp) != SOLVE_OK) return SOLVE_FAILED;
    return box_qp_solve(&solver->qp, solver->gradient, lower, upper);
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
static double search(sqp *solver, least_squares *model, const void *problem, double cost) {
    const int n = solver->qp.n, is_last = solver->iterations == solver->max_iterations;
    const double slope = ARMIJO * inner(n, solver->gradient, solver->qp.x);
    double *gradient = is_last ? 0 : solver->gradient, *hessian = is_last ? 0 : solver->qp.hessian;
    double start[BOX_QP_MAX], trial_cost = cost, length = 1.0;
    memcpy(start, solver->plan, sizeof start);
    for (int k = 0; k < HALVINGS; k++, length *= 0.5) {
        for (int i = 0; i < n; i++) solver->plan[i] = start[i] + length * solver->qp.x[i];
        trial_cost = model(problem, n, solver->plan, gradient, hessian);
        if (trial_cost <= cost + length * slope) break;
    }
    return trial_cost;
}

int sqp_minimise(sqp *solver, least_squares *model, const void *problem, double ceiling_nm) {
    const int n = solver->qp.n;
    double *hessian = solver->qp.hessian;
    double cost = model(problem, n, solver->plan, solver->gradient, hessian);
    for (solver->iterations = 1; solver->iterations <= solver->max_iterations;
         solver->iterations++) {
        if (!isfinite(cost) || box_step(solver, ceiling_nm) != SOLVE_OK) return SOLVE_FAILED;
        if (longest(n, solver->qp.x) <= STEP_TOLERANCE_NM) {
            for (int i = 0; i < n; i++) solver->plan[i] += solver->qp.x[i];
            return SOLVE_OK;
        }
        cost = search(solver, model, problem, cost);
    }
    solver->iterations = solver->max_iterations;
    return SOLVE_MAX_ITERATIONS;
}
