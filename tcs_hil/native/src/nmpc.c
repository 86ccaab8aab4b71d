#include "nmpc.h"

#include <string.h>

#include "least_squares.h"
#include "shooting.h"
#include "wheel_model.h"

void nmpc_setup(nmpc *law, int horizon, int max_iterations) {
    const double *arguments[] = {law->parameters};
    double *results[] = {law->constants};
    wheel_fold(arguments, results, 0, 0, 0);
    sqp_setup(&law->solver, horizon, max_iterations);
    nmpc_reset(law);
}

static void forget_plans(nmpc *law) {
    memset(law->before, 0, sizeof law->before);
    sqp_reset(&law->solver);
}

void nmpc_reset(nmpc *law) {
    law->integral.value_s = 0.0;
    forget_plans(law);
}

static void rate(const void *problem, const double *x, double torque_nm, double *its_rate,
                 double *slopes) {
    const nmpc *law = problem;
    const double *arguments[] = {x, &torque_nm, law->parameters, law->constants};
    double *results[] = {its_rate, slopes};
    wheel_rate(arguments, results, 0, 0, 0);
}

static const dynamics MODEL = {WHEEL_NX, rate, wheel_chain};

/* The residuals of one period: slip error, integral and torque reduction, all in Nm. */
static void add_period(const nmpc *law, double torque_nm, int k, const shot *state,
                       gauss_newton *model) {
    double kappa, by_state[2], row[BOX_QP_MAX];
    const double *arguments[] = {state->x, law->parameters};
    double *results[] = {&kappa, by_state};
    const double *s = state->by_torque[0], *omega = state->by_torque[1];
    wheel_slip(arguments, results, 0, 0, 0);
    for (int j = 0; j <= k; j++)
        row[j] = -law->slip_gain * (by_state[0] * s[j] + by_state[1] * omega[j]);
    add_residual(model, law->slip_gain * (law->integral.slip_reference - kappa), row, 0, k);
    for (int j = 0; j <= k; j++) row[j] = law->integral_gain * state->by_torque[2][j];
    add_residual(model, law->integral_gain * state->x[2], row, 0, k);
    row[k] = -1.0;
    add_residual(model, law->torque_ref_nm - torque_nm, row, k, k);
}

static double linearise(const void *problem, int n, const double *plan, double *gradient,
                        double *hessian) {
    const nmpc *law = problem;
    const double step_s = law->integral.period_s / law->substeps;
    gauss_newton model = {n, 0.0, gradient, hessian};
    shot state;
    shot_start(&state, &MODEL, law, gradient != 0, law->start);
    clear(&model);
    for (int k = 0; k < n; k++) {
        shot_torque(&state, k);
        for (int i = 0; i < law->substeps; i++) shot_step(&state, plan[k], k, step_s);
        add_period(law, plan[k], k, &state, &model);
    }
    mirror(&model);
    return model.cost;
}

/* The plan is expected to go on changing as it did: see tcs_hil/control/nmpc.py. */
static void guess(nmpc *law, double ceiling_nm) {
    double *plan = law->solver.plan;
    for (int k = 0; k < law->solver.qp.n; k++) {
        const double last = plan[k];
        plan[k] = clamp(2.0 * last - law->before[k], ceiling_nm);
        law->before[k] = last;
    }
}

static int optimise(nmpc *law, const wheel_state *wheel, double torque_ref_nm) {
    sqp *solver = &law->solver;
    law->start[0] = wheel->slip_speed_mps;
    law->start[1] = wheel->wheel_speed_radps;
    law->start[2] = law->integral.value_s;
    law->torque_ref_nm = torque_ref_nm;
    guess(law, torque_ref_nm);
    return sqp_minimise(solver, linearise, law, torque_ref_nm);
}

static void answer(nmpc *law, int status, double torque_ref_nm) {
    if (status == SOLVE_FAILED) {
        forget_plans(law); /* what failed is no warm start */
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
