#include "driveline.h"

#include <math.h>
#include <string.h>

#include "driveline_model.h"
#include "least_squares.h"
#include "shooting.h"
#include "wheel_state.h"

void driveline_setup(driveline *law, int block_count, int max_iterations) {
    sqp_setup(&law->solver, block_count, max_iterations);
}

void driveline_reset(driveline *law) { sqp_reset(&law->solver); }

/* The jacobian may be null: it costs most of it. */
static void step(const driveline *law, const double *x, double torque_nm, double duration_s,
                 double *after, double *jacobian) {
    const double motion[] = {duration_s, law->disturbance_n};
    const double *arguments[] = {x, &torque_nm, motion, law->parameters};
    double *results[] = {after, jacobian};
    if (jacobian)
        driveline_step(arguments, results, 0, 0, 0);
    else
        driveline_flow(arguments, results, 0, 0, 0);
}

void driveline_roll_forward(driveline *law, const double *torques_nm, int count,
                            double first_periods, double disturbance_n) {
    double after[DRIVELINE_NX];
    law->disturbance_n = disturbance_n;
    for (int k = 0; k < count; k++) {
        const double periods = k == 0 ? first_periods : 1.0;
        step(law, law->x, torques_nm[k], periods * law->period_s, after, 0);
        memcpy(law->x, after, sizeof after);
    }
}

/* The residuals of one block: slip error, integral, torque reduction and change of torque. */
static void add_block(const driveline *law, const double *plan, int k, const shot *state,
                      gauss_newton *model) {
    double kappa, by_state[2], row[BOX_QP_MAX];
    const double *arguments[] = {state->x, law->parameters}, reference = law->parameters[0];
    double *results[] = {&kappa, by_state};
    const double *s = state->by_torque[0], *omega = state->by_torque[1];
    const double held = sqrt(law->blocks[k]), tracking = held * law->urgency;
    const double slip = tracking * law->slip_gain, integral = tracking * law->integral_gain;
    driveline_slip(arguments, results, 0, 0, 0);
    for (int j = 0; j <= k; j++) row[j] = -slip * (by_state[0] * s[j] + by_state[1] * omega[j]);
    add_residual(model, slip * (reference - kappa), row, 0, k);
    for (int j = 0; j <= k; j++) row[j] = integral * state->by_torque[2][j];
    add_residual(model, integral * state->x[2], row, 0, k);
    row[k] = -held * law->reduction_gain;
    add_residual(model, held * law->reduction_gain * (law->torque_ref_nm - plan[k]), row, k, k);
    const int before = k > 0 ? k - 1 : 0;
    row[before] = -1.0;
    row[k] = 1.0;
    add_residual(model, plan[k] - (k > 0 ? plan[k - 1] : law->last_torque_nm), row, before, k);
}

static double linearise(const void *problem, int n, const double *plan, double *gradient,
                        double *hessian) {
    const driveline *law = problem;
    double after[DRIVELINE_NX], derivatives[DRIVELINE_NX * (DRIVELINE_NX + 1)];
    double *jacobian = gradient ? derivatives : 0;
    gauss_newton model = {n, 0.0, gradient, hessian};
    shot state;
    shot_start(&state, DRIVELINE_NX, law->x);
    clear(&model);
    for (int k = 0; k < n; k++) {
        shot_torque(&state, DRIVELINE_NX, k);
        step(law, state.x, plan[k], law->blocks[k] * law->period_s, after, jacobian);
        shot_advance(&state, DRIVELINE_NX, k, after, jacobian);
        add_block(law, plan, k, &state, &model);
    }
    mirror(&model);
    return model.cost;
}

/* The guess for the next period: the plan shifted by the one that passes. */
static void shift(double *plan, int n) { memmove(plan, plan + 1, (size_t)(n - 1) * sizeof *plan); }

int driveline_plan(driveline *law, double last_torque_nm, double torque_ref_nm,
                   double disturbance_n, double urgency) {
    sqp *solver = &law->solver;
    const int n = solver->qp.n;
    law->torque_ref_nm = torque_ref_nm;
    law->last_torque_nm = last_torque_nm;
    law->disturbance_n = disturbance_n;
    law->urgency = urgency;
    for (int k = 0; k < n; k++) solver->plan[k] = clamp(solver->plan[k], torque_ref_nm);
    const int status = sqp_minimise(solver, linearise, law, torque_ref_nm);
    memcpy(law->plan, solver->plan, sizeof law->plan);
    shift(solver->plan, n);
    return outcome(status, solver->iterations);
}
