/* Single shooting: a state and its derivatives by the torques that led to it. */

#ifndef TCS_SHOOTING_H
#define TCS_SHOOTING_H

#include "box_qp.h"

enum { SHOT_MAX = 7 };

typedef struct {
    double x[SHOT_MAX];
    double by_torque[SHOT_MAX][BOX_QP_MAX];
} shot;

/* Start from x (nx,). */
void shot_start(shot *state, int nx, const double *x);

/* From here on the k-th torque acts. */
void shot_torque(shot *state, int nx, int k);

/* Go on to `after` (nx,), whose derivatives by x and the k-th torque are `jacobian` (nx, nx + 1),
   column by column, or null where nobody asks for them. */
void shot_advance(shot *state, int nx, int k, const double *after, const double *jacobian);

#endif
