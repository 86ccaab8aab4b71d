#include "shooting.h"

#include <string.h>

enum { STAGES = 4 };
static const double WEIGHT[STAGES] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
static const double REACH[STAGES] = {0.5, 0.5, 1.0, 0.0};

void shot_start(shot *state, const dynamics *model, const void *law, int derives, const double *x) {
    state->model = model;
    state->law = law;
    state->derives = derives;
    state->by_torque = state->memory[0];
    memcpy(state->x, x, (size_t)model->nx * sizeof *x);
}

void shot_from_state(shot *state) {
    for (int row = 0; row < state->model->nx; row++)
        for (int j = 0; j < state->model->nx; j++) state->by_torque[row][j] = row == j;
}

void shot_torque(shot *state, int k) {
    for (int row = 0; row < state->model->nx; row++) state->by_torque[row][k] = 0.0;
    for (int j = 0; j <= k; j++) state->torque[j] = j == k;
}

void shot_step(shot *state, double torque_nm, int k, double step_s) {
    const dynamics *model = state->model;
    const by_torques *before = state->by_torque;
    by_torques *total = before == state->memory[0] ? state->memory[1] : state->memory[0];
    double x[SHOT_MAX], end[SHOT_MAX], rate[SHOT_MAX], slopes[SLOPES_MAX];
    memcpy(x, state->x, sizeof x);
    memcpy(end, state->x, sizeof end);
    for (int i = 0; i < STAGES; i++) {
        const double weight = step_s * WEIGHT[i], reach = step_s * REACH[i];
        const by_torques *at = i == 0 ? before : state->next, *sum = i == 0 ? before : total;
        const stage now = {weight, reach, before, at, sum, state->torque, state->next, total};
        model->rate(state->law, x, torque_nm, rate, state->derives ? slopes : 0);
        for (int row = 0; row < model->nx; row++) {
            x[row] = state->x[row] + reach * rate[row];
            end[row] += weight * rate[row];
        }
        if (state->derives) model->chain(slopes, k + 1, &now);
    }
    memcpy(state->x, end, sizeof end);
    if (state->derives) state->by_torque = total;
}
