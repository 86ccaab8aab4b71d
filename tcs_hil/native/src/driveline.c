#include "driveline.h"

#include <math.h>
#include <string.h>

#include "driveline_model.h"
#include "least_squares.h"
#include "shooting.h"
#include "wheel_state.h"

void driveline_setup(driveline *law, int block_count, int max_iterations,
                     double step_tolerance_nm) {
    const double *arguments[] = {law->parameters};
    double *results[] = {law->constants};
    driveline_fold(arguments, results, 0, 0, 0);
    sqp_setup(&law->solver, block_count, max_iterations, step_tolerance_nm);
}

void driveline_reset(driveline *law) { sqp_reset(&law->solver); }

static void rate(const void *problem, const double *x, double torque_nm, double *its_rate,
                 double *slopes) {
    const driveline *law = problem;
    const double *arguments[] = {x, &torque_nm, &law->disturbance_n, law->parameters,
                                 law->constants};
    double *results[] = {its_rate, slopes};
    driveline_rate(arguments, results, 0, 0, 0);
}

static const dynamics MODEL = {DRIVELINE_NX, rate, driveline_chain};

void driveline_roll_forward(driveline *law, const double *torques_nm, int count,
                            double first_periods, double disturbance_n) {
    shot state;
    law->disturbance_n = disturbance_n;
    shot_start(&state, &MODEL, law, 0, law->x);
    for (int k = 0; k < count; k++)
        shot_step(&state, torques_nm[k], k, law->period_s * (k == 0 ? first_periods : 1.0));
    memcpy(law->x, state.x, sizeof law->x);
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

static double linearise(void *problem, int n, const double *plan, double *gradient,
                        double *hessian) {
    const driveline *law = problem;
    gauss_newton model = {n, 0.0, gradient, hessian};
    shot state;
    shot_start(&state, &MODEL, law, gradient != 0, law->x);
    clear(&model);
    for (int k = 0; k < n; k++) {
        shot_torque(&state, k);
        shot_step(&state, plan[k], k, law->blocks[k] * law->period_s);
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
