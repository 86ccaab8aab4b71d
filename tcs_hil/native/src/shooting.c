#include "shooting.h"

#include <string.h>

void shot_start(shot *state, const dynamics *model, const double *parameters,
                const double *constants, const double *x, int derives) {
    state->model = model;
    state->parameters = parameters;
    state->constants = constants;
    state->derives = derives;
    state->columns = 0;
    state->inputs[DISTURBANCE_N] = state->inputs[DISTURBANCE_MPS2] = 0.0;
    memcpy(state->x, x, (size_t)model->nx * sizeof *x);
}

void shot_from_state(shot *state) {
    state->columns = state->model->nx;
    for (int row = 0; row < state->model->nx; row++)
        for (int j = 0; j < state->columns; j++) state->slope[row][j] = row == j;
}

void shot_torque(shot *state, double torque_nm) {
    for (int row = 0; row < state->model->nx; row++) state->slope[row][state->columns] = 0.0;
    state->columns++;
    state->inputs[TORQUE_NM] = torque_nm;
}

void shot_step(shot *state, double step_s) {
    const dynamics *model = state->model;
    double after[SHOT_MAX], slopes[SHOT_MAX * (SHOT_MAX + 1)];
    state->inputs[STEP_S] = step_s;
    if (state->derives) {
        model->step(state->x, state->inputs, state->parameters, state->constants, after, slopes);
        model->chain(slopes, state->columns, state->slope);
    } else {
        model->flow(state->x, state->inputs, state->parameters, state->constants, after);
    }
    memcpy(state->x, after, sizeof after);
}
