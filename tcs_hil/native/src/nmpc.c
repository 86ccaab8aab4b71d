#include "nmpc.h"

#include <string.h>

#include "least_squares.h"

void nmpc_setup(nmpc *law, int horizon, int max_iterations, double leftover_nm) {
    wheel_fold(law->parameters, law->constants);
    sqp_setup(&law->solver, horizon, max_iterations, leftover_nm);
    nmpc_reset(law);
}

static void forget_model(nmpc *law) {
    memset(law->drift, 0, sizeof law->drift);
    sqp_reset(&law->solver);
}

void nmpc_reset(nmpc *law) {
    law->integral.value_s = 0.0;
    forget_model(law);
}

static const dynamics MODEL = {WHEEL_NX, wheel_flow, wheel_step, wheel_chain};

static void advance(shot *state, const nmpc *law, double torque_nm) {
    shot_torque(state, torque_nm);
    for (int i = 0; i < law->substeps; i++)
        shot_step(state, law->integral.period_s / law->substeps);
}

/* The residuals of one period: slip error, integral and torque reduction, all in Nm. */
static void add_period(const nmpc *law, double torque_nm, const shot *state, gauss_newton *model) {
    double kappa, by_state[2], row[GIVEN + BOX_QP_MAX] = {0};
    double *by_columns = row + STATE;
    const int last = STATE + state->columns - 1;
    wheel_slip(state->x, law->parameters, &kappa, by_state);
    for (int j = 0; j < state->columns; j++)
        by_columns[j] = -law->slip_gain * (by_state[0] * state->slope[0][j] +
                                           by_state[1] * state->slope[1][j]);
    add_residual(model, law->slip_gain * (law->integral.slip_reference - kappa), row, 0, last);
    for (int j = 0; j < state->columns; j++)
        by_columns[j] = law->integral_gain * state->slope[2][j];
    add_residual(model, law->integral_gain * state->x[2], row, 0, last);
    memset(row, 0, sizeof row);
    row[TORQUE_REF] = 1.0;
    row[last] = -1.0;
    add_residual(model, law->given[TORQUE_REF] - torque_nm, row, 0, last);
}

/* The part of the model (4 + N) that belongs to the plan, and how what is given moves it. */
static void hand_out(nmpc *law, const gauss_newton *whole, double *gradient, double *hessian) {
    const int n = whole->n - GIVEN;
    for (int i = 0; i < n; i++) {
        const double *line = whole->hessian + (GIVEN + i) * whole->n;
        gradient[i] = whole->gradient[GIVEN + i];
        memcpy(law->drift[i], line, sizeof law->drift[i]);
        for (int j = 0; j <= i; j++) hessian[i * n + j] = hessian[j * n + i] = line[GIVEN + j];
    }
}

static double linearise(void *problem, int n, const double *plan, double *gradient,
                        double *hessian) {
    nmpc *law = problem;
    double slope[GIVEN + BOX_QP_MAX], curvature[(GIVEN + BOX_QP_MAX) * (GIVEN + BOX_QP_MAX)];
    gauss_newton model = {GIVEN, GIVEN + n, 0.0, gradient ? slope : 0, curvature};
    shot state;
    shot_start(&state, &MODEL, law->parameters, law->constants, law->given + STATE, gradient != 0);
    shot_from_state(&state);
    clear(&model);
    for (int k = 0; k < n; k++) {
        advance(&state, law, plan[k]);
        add_period(law, plan[k], &state, &model);
    }
    if (gradient) hand_out(law, &model, gradient, hessian);
    return model.cost;
}

/* The model follows what is given, to first order: see tcs_hil/control/least_squares.py. */
static void start_from(nmpc *law, const double *given) {
    for (int i = 0; i < law->solver.qp.n; i++)
        for (int j = 0; j < GIVEN; j++)
            law->solver.gradient[i] += law->drift[i][j] * (given[j] - law->given[j]);
    memcpy(law->given, given, sizeof law->given);
}

static int optimise(nmpc *law, const wheel_state *wheel, double torque_ref_nm) {
    const double given[GIVEN] = {torque_ref_nm, wheel->slip_speed_mps, wheel->wheel_speed_radps,
                                 law->integral.value_s};
    start_from(law, given);
    sqp_expect(&law->solver, torque_ref_nm);
    return sqp_minimise(&law->solver, linearise, law, torque_ref_nm);
}

static void answer(nmpc *law, int status, double torque_ref_nm) {
    if (status == SOLVE_FAILED) {
        forget_model(law); /* what failed is no warm start */
        leave(law->answer, torque_ref_nm);
        return;
    }
    propose(law->answer, law->solver.plan, law->solver.qp.n, torque_ref_nm);
}

int nmpc_step(nmpc *law, double slip_speed_mps, double wheel_speed_radps, double slip_ratio,
              double vehicle_speed_mps, double torque_ref_nm) {
    const wheel_state wheel = {slip_speed_mps, wheel_speed_radps, slip_ratio, vehicle_speed_mps};
    int result;
    if (settled(&wheel, torque_ref_nm, law->answer, &result)) return result;
    const int status = optimise(law, &wheel, torque_ref_nm);
    answer(law, status, torque_ref_nm);
    integral_advance(&law->integral, slip_ratio, law->answer->torque_nm, torque_ref_nm);
    return outcome(status, law->solver.iterations);
}
