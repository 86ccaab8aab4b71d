#include "shooting.h"

#include <string.h>

void shot_start(shot *state, int nx, const double *x) {
    memcpy(state->x, x, (size_t)nx * sizeof *x);
}

void shot_torque(shot *state, int nx, int k) {
    for (int row = 0; row < nx; row++) state->by_torque[row][k] = 0.0;
}

static void chain(shot *state, int nx, int k, const double *jacobian) {
    double product[SHOT_MAX][BOX_QP_MAX];
    const double *by_torque = jacobian + nx * nx;
    for (int row = 0; row < nx; row++) {
        double *sum = product[row];
        for (int j = 0; j <= k; j++) sum[j] = 0.0;
        for (int column = 0; column < nx; column++) {
            const double factor = jacobian[column * nx + row];
            const double *before = state->by_torque[column];
            for (int j = 0; j <= k; j++) sum[j] += factor * before[j];
        }
        sum[k] += by_torque[row];
    }
    for (int row = 0; row < nx; row++)
        memcpy(state->by_torque[row], product[row], (size_t)(k + 1) * sizeof **product);
}

void shot_advance(shot *state, int nx, int k, const double *after, const double *jacobian) {
    if (jacobian) chain(state, nx, k, jacobian);
    memcpy(state->x, after, (size_t)nx * sizeof *after);
}
