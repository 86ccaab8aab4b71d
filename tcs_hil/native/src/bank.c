#include "bank.h"

#include <string.h>

#include "wheel_state.h"

int band_setup(band *self, int nx, int n, const double *a, const double *b, const double *hessian,
               const double *gradient_map) {
    if (nx > BANK_NX_MAX || box_qp_setup(&self->qp, n, hessian) != SOLVE_OK) return SOLVE_FAILED;
    memcpy(self->a, a, (size_t)(nx * nx) * sizeof *a);
    memcpy(self->b, b, (size_t)nx * sizeof *b);
    memcpy(self->gradient_map, gradient_map, (size_t)(n * nx) * sizeof *gradient_map);
    return SOLVE_OK;
}

static void mix(double *mean, int n, double weight, const double *first, double other_weight,
                const double *second) {
    for (int i = 0; i < n; i++) mean[i] = weight * first[i] + other_weight * second[i];
}

void bank_settle(bank *law, band *first, double weight, band *second, double other_weight) {
    const int nx = law->nx;
    law->band_count = other_weight > 0.0 ? 2 : 1;
    law->bands[0] = first;
    law->bands[1] = second;
    law->weights[0] = weight;
    law->weights[1] = other_weight;
    mix(law->a, nx * nx, weight, first->a, other_weight, second->a);
    mix(law->b, nx, weight, first->b, other_weight, second->b);
}

static double inner(int n, const double *a, const double *b) {
    double sum = 0.0;
    for (int i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}

void bank_advance(bank *law, double torque_nm, double periods) {
    const int nx = law->nx;
    double after[BANK_NX_MAX];
    for (int i = 0; i < nx; i++)
        after[i] = inner(nx, law->a + i * nx, law->x) + law->b[i] * torque_nm;
    for (int i = 0; i < nx; i++) law->x[i] += periods * (after[i] - law->x[i]);
}

static int solve(const bank *law, band *self, double last_torque_nm, double torque_ref_nm) {
    const int n = self->qp.n, nx = law->nx;
    double g[BOX_QP_MAX], lower[BOX_QP_MAX], upper[BOX_QP_MAX];
    for (int i = 0; i < n; i++) {
        g[i] = inner(nx, self->gradient_map + i * nx, law->x) - law->reduction_pull * torque_ref_nm;
        lower[i] = 0.0;
        upper[i] = torque_ref_nm / law->unit_nm;
    }
    g[0] -= law->change_pull * last_torque_nm;
    return box_qp_solve(&self->qp, g, lower, upper);
}

int bank_plan(bank *law, double last_torque_nm, double torque_ref_nm) {
    int status = SOLVE_OK, iterations = 0;
    memset(law->plan, 0, sizeof law->plan);
    for (int k = 0; k < law->band_count; k++) {
        band *self = law->bands[k];
        const int its_status = solve(law, self, last_torque_nm, torque_ref_nm);
        const double scale = law->weights[k] * law->unit_nm;
        for (int i = 0; i < self->qp.n; i++) law->plan[i] += scale * self->qp.x[i];
        status = its_status > status ? its_status : status;
        iterations += self->qp.iterations;
    }
    return outcome(status, iterations);
}
