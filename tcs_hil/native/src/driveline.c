#include "driveline.h"

#include <math.h>
#include <string.h>

#include "least_squares.h"
#include "wheel_state.h"

void driveline_setup(driveline *law, int block_count, int max_iterations, double leftover_nm) {
    driveline_fold(law->parameters, law->constants);
    sqp_setup(&law->solver, block_count, max_iterations, leftover_nm);
}

void driveline_reset(driveline *law) { sqp_reset(&law->solver); }

static const dynamics MODEL = {DRIVELINE_NX, driveline_flow, driveline_step, driveline_chain};

static void depart(const driveline *law, double disturbance_n, double disturbance_mps2,
                   int derives, shot *state) {
    shot_start(state, &MODEL, law->parameters, law->constants, law->x, derives);
    state->inputs[DISTURBANCE_N] = disturbance_n;
    state->inputs[DISTURBANCE_MPS2] = disturbance_mps2;
}

void driveline_roll_forward(driveline *law, const double *torques_nm, int count,
                            double first_periods, double disturbance_n,
                            double disturbance_mps2) {
    shot state;
    depart(law, disturbance_n, disturbance_mps2, 0, &state);
    for (int k = 0; k < count; k++) {
        shot_torque(&state, torques_nm[k]);
        shot_step(&state, law->period_s * (k == 0 ? first_periods : 1.0));
    }
    memcpy(law->x, state.x, sizeof law->x);
}

/* The slip error at the end of a block and its integral. */
static void add_errors(const driveline *law, double urgency, const shot *state,
                       gauss_newton *model) {
    double kappa, by_state[2], row[BOX_QP_MAX];
    const double slip = urgency * law->slip_gain, integral = urgency * law->integral_gain;
    const double *s = state->slope[0], *omega = state->slope[1];
    const int last = state->columns - 1;
    driveline_slip(state->x, law->parameters, &kappa, by_state);
    for (int j = 0; j <= last; j++)
        row[j] = -slip * (by_state[0] * s[j] + by_state[1] * omega[j]);
    add_residual(model, slip * (law->parameters[0] - kappa), row, 0, last);
    if (integral == 0.0) return;
    for (int j = 0; j <= last; j++) row[j] = integral * state->slope[2][j];
    add_residual(model, integral * state->x[2], row, 0, last);
}

/* The reduction of torque in a block and the change to it. */
static void add_torques(const driveline *law, double held, const double *plan, int k,
                        gauss_newton *model) {
    double row[BOX_QP_MAX];
    const int before = k > 0 ? k - 1 : 0;
    row[k] = -held * law->reduction_gain;
    add_residual(model, held * law->reduction_gain * (law->torque_ref_nm - plan[k]), row, k, k);
    row[before] = -1.0;
    row[k] = 1.0;
    add_residual(model, plan[k] - (k > 0 ? plan[k - 1] : law->last_torque_nm), row, before, k);
}

static double linearise(void *problem, int n, const double *plan, double *gradient,
                        double *hessian) {
    const driveline *law = problem;
    gauss_newton model = {0, n, 0.0, gradient, hessian};
    shot state;
    depart(law, law->disturbance_n, law->disturbance_mps2, gradient != 0, &state);
    clear(&model);
    for (int k = 0; k < n; k++) {
        const double held = sqrt(law->blocks[k]);
        shot_torque(&state, plan[k]);
        shot_step(&state, law->blocks[k] * law->period_s);
        add_errors(law, held * law->urgency, &state, &model);
        add_torques(law, held, plan, k, &model);
    }
    mirror(&model);
    return model.cost;
}

/* The guess for the next period: the plan shifted by the one that passes. */
static void shift(double *plan, int n) { memmove(plan, plan + 1, (size_t)(n - 1) * sizeof *plan); }

int driveline_plan(driveline *law, double last_torque_nm, double torque_ref_nm,
                   double disturbance_n, double disturbance_mps2, double urgency) {
    sqp *solver = &law->solver;
    const int n = solver->qp.n;
    law->torque_ref_nm = torque_ref_nm;
    law->last_torque_nm = last_torque_nm;
    law->disturbance_n = disturbance_n;
    law->disturbance_mps2 = disturbance_mps2;
    law->urgency = urgency;
    for (int k = 0; k < n; k++) solver->plan[k] = clamp(solver->plan[k], torque_ref_nm);
    const int status = sqp_minimise(solver, linearise, law, torque_ref_nm);
    memcpy(law->plan, solver->plan, sizeof law->plan);
    shift(solver->plan, n);
    return outcome(status, solver->iterations);
}
