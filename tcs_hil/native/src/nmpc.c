#include "nmpc.h"

#include <string.h>

#include "least_squares.h"
#include "shooting.h"
#include "wheel_model.h"

void nmpc_setup(nmpc *law, int horizon, int max_iterations, double step_tolerance_nm) {
    const double *arguments[] = {law->parameters};
    double *results[] = {law->constants};
    wheel_fold(arguments, results, 0, 0, 0);
    sqp_setup(&law->solver, horizon, max_iterations, step_tolerance_nm);
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

static void rate(const void *problem, const double *x, double torque_nm, double *its_rate,
                 double *slopes) {
    const nmpc *law = problem;
    const double *arguments[] = {x, &torque_nm, law->parameters, law->constants};
    double *results[] = {its_rate, slopes};
    wheel_rate(arguments, results, 0, 0, 0);
}

static const dynamics MODEL = {WHEEL_NX, rate, wheel_chain};

/* Residuals are derived by [x_0, T_ref, plan]: the plan's columns come last. */
enum { COLUMNS_MAX = GIVEN + BOX_QP_MAX };

/* A state along the plan; the columns are those of the torques so far. */
typedef struct {
    double x[WHEEL_NX];
    double slope[WHEEL_NX][COLUMNS_MAX];
    int columns;
} waypoint;

static void leave_start(waypoint *at, const nmpc *law) {
    at->columns = GIVEN;
    for (int row = 0; row < WHEEL_NX; row++) {
        at->x[row] = law->given[row];
        for (int j = 0; j < GIVEN; j++) at->slope[row][j] = row == j;
    }
}

/* Chain the derivatives (3, 4) of one period, by its first state and its torque. */
static void chain(waypoint *at, const by_torques *period) {
    for (int j = 0; j < at->columns; j++) {
        const double before[WHEEL_NX] = {at->slope[0][j], at->slope[1][j], at->slope[2][j]};
        for (int row = 0; row < WHEEL_NX; row++)
            at->slope[row][j] = period[row][0] * before[0] + period[row][1] * before[1] +
                                period[row][2] * before[2];
    }
    for (int row = 0; row < WHEEL_NX; row++) at->slope[row][at->columns] = period[row][WHEEL_NX];
    at->columns++;
}

static void advance(waypoint *at, const nmpc *law, double torque_nm, int derives) {
    const double step_s = law->integral.period_s / law->substeps;
    shot state;
    shot_start(&state, &MODEL, law, derives, at->x);
    shot_from_state(&state);
    shot_torque(&state, WHEEL_NX);
    for (int i = 0; i < law->substeps; i++) shot_step(&state, torque_nm, WHEEL_NX, step_s);
    memcpy(at->x, state.x, sizeof at->x);
    if (derives) chain(at, state.by_torque);
}

/* The residuals of one period: slip error, integral and torque reduction, all in Nm. */
static void add_period(const nmpc *law, double torque_nm, const waypoint *at, gauss_newton *model) {
    double kappa, by_state[2], row[COLUMNS_MAX];
    const double *arguments[] = {at->x, law->parameters};
    double *results[] = {&kappa, by_state};
    const int last = at->columns - 1;
    wheel_slip(arguments, results, 0, 0, 0);
    for (int j = 0; j <= last; j++)
        row[j] = -law->slip_gain * (by_state[0] * at->slope[0][j] + by_state[1] * at->slope[1][j]);
    add_residual(model, law->slip_gain * (law->integral.slip_reference - kappa), row, 0, last);
    for (int j = 0; j <= last; j++) row[j] = law->integral_gain * at->slope[2][j];
    add_residual(model, law->integral_gain * at->x[2], row, 0, last);
    memset(row, 0, sizeof row);
    row[GIVEN - 1] = 1.0;
    row[last] = -1.0;
    add_residual(model, law->given[GIVEN - 1] - torque_nm, row, GIVEN - 1, last);
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
    double slope[COLUMNS_MAX], curvature[COLUMNS_MAX * COLUMNS_MAX];
    gauss_newton model = {GIVEN + n, 0.0, gradient ? slope : 0, curvature};
    waypoint at;
    leave_start(&at, law);
    clear(&model);
    for (int k = 0; k < n; k++) {
        advance(&at, law, plan[k], gradient != 0);
        add_period(law, plan[k], &at, &model);
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
    const double given[GIVEN] = {wheel->slip_speed_mps, wheel->wheel_speed_radps,
                                 law->integral.value_s, torque_ref_nm};
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
