#include "bank.h"

#include <math.h>
#include <string.h>

#include "wheel_state.h"

int band_setup(band *self, int n, const double *a, const double *b, const double *hessian,
               const double *gradient_map) {
    if (box_qp_setup(&self->qp, n, hessian) != SOLVE_OK) return SOLVE_FAILED;
    memcpy(self->a, a, sizeof self->a);
    memcpy(self->b, b, sizeof self->b);
    memcpy(self->gradient_map, gradient_map, (size_t)(n * BANK_NX) * sizeof *gradient_map);
    return SOLVE_OK;
}

void bank_reset(bank *law) {
    law->has_before = 0;
    for (int k = 0; k < law->band_count; k++) box_qp_reset(&law->bands[k].qp);
}

static void mix(double *mean, int n, double weight, const double *first, double other_weight,
                const double *second) {
    for (int i = 0; i < n; i++) mean[i] = weight * first[i] + other_weight * second[i];
}

static void put_in_charge(bank *law, band *first, band *second, double other_weight) {
    law->first = first;
    law->second = second;
    law->weight = 1.0 - other_weight;
    law->other_weight = other_weight;
    mix(law->a, BANK_NX * BANK_NX, law->weight, first->a, other_weight, second->a);
    mix(law->b, BANK_NX, law->weight, first->b, other_weight, second->b);
}

/* As KoopmanBank.shares in tcs_hil/model/bank.py. */
static void settle(bank *law, double speed_mps) {
    band *above = law->bands, *end = above + law->band_count;
    while (above < end && above->centre_mps < speed_mps) above++;
    band *below = above == law->bands ? above : above - 1;
    const double way = above == below || above == end
                           ? 0.0
                           : log(speed_mps / below->centre_mps) /
                                 log(above->centre_mps / below->centre_mps);
    put_in_charge(law, below, above == end ? below : above, way);
}

static double inner(int n, const double *a, const double *b) {
    double sum = 0.0;
    for (int i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}

double bank_observe(bank *law, double vehicle_speed_mps, double slip_speed_mps,
                    double wheel_speed_radps, double motor_speed_radps, double motor_torque_nm,
                    double integral_s, double disturbance_radps) {
    const sample now = {slip_speed_mps, wheel_speed_radps, motor_speed_radps, motor_torque_nm};
    lift_samples(&law->car, &now, law->has_before ? &law->before : &now, law->x);
    law->x[BANK_INTEGRAL] = integral_s;
    law->x[BANK_DISTURBANCE] = disturbance_radps;
    law->before = now;
    law->has_before = 1;
    settle(law, vehicle_speed_mps);
    return inner(BANK_NZ, law->a + BANK_WHEEL_SPEED * BANK_NX, law->x);
}

static void advance(bank *law, double torque_nm, double periods) {
    double after[BANK_NX];
    for (int i = 0; i < BANK_NX; i++)
        after[i] = inner(BANK_NX, law->a + i * BANK_NX, law->x) + law->b[i] * torque_nm;
    for (int i = 0; i < BANK_NX; i++) law->x[i] += periods * (after[i] - law->x[i]);
}

void bank_roll_forward(bank *law, const double *torques_nm, int count, double first_periods) {
    for (int k = 0; k < count; k++) advance(law, torques_nm[k], k == 0 ? first_periods : 1.0);
}

static int solve(const bank *law, band *self, double last_torque_nm, double torque_ref_nm) {
    const int n = self->qp.n;
    double g[BOX_QP_MAX], lower[BOX_QP_MAX], upper[BOX_QP_MAX];
    for (int i = 0; i < n; i++) {
        g[i] = inner(BANK_NX, self->gradient_map + i * BANK_NX, law->x) -
               law->reduction_pull * torque_ref_nm;
        lower[i] = 0.0;
        upper[i] = torque_ref_nm / law->unit_nm;
    }
    g[0] -= law->change_pull * last_torque_nm;
    return box_qp_solve(&self->qp, g, lower, upper);
}

int bank_plan(bank *law, double last_torque_nm, double torque_ref_nm) {
    band *in_charge[] = {law->first, law->second};
    const double weights[] = {law->weight, law->other_weight};
    int status = SOLVE_OK, iterations = 0;
    memset(law->plan, 0, sizeof law->plan);
    for (int k = 0; k < 2; k++) {
        band *self = in_charge[k];
        if (weights[k] == 0.0) continue;
        const int its_status = solve(law, self, last_torque_nm, torque_ref_nm);
        const double scale = weights[k] * law->unit_nm;
        for (int i = 0; i < self->qp.n; i++) law->plan[i] += scale * self->qp.x[i];
        status = its_status > status ? its_status : status;
        iterations += self->qp.iterations;
    }
    return outcome(status, iterations);
}
