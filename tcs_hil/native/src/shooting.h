/* Single shooting: a state and its derivatives by the torques that led to it, carried through
   Runge-Kutta steps together. */

#ifndef TCS_SHOOTING_H
#define TCS_SHOOTING_H

#include "box_qp.h"

enum { SHOT_MAX = 7, COLUMNS_MAX = SHOT_MAX + BOX_QP_MAX };

typedef double by_variables[COLUMNS_MAX]; /* the derivatives of one quantity */

/* What a step is made with besides the state and the model's parameters. */
enum input { STEP_S, TORQUE_NM, DISTURBANCE_N, DISTURBANCE_MPS2, INPUTS };

/* State (nx,) after one Runge-Kutta step; all four models are written by
   scripts/generate_native.py. */
typedef void model_flow(const double *restrict x, const double *restrict inputs,
                        const double *restrict parameters, const double *restrict constants,
                        double *restrict after);

/* And the nonzero derivatives of `after` by [x, torque], column by column. */
typedef void model_step(const double *restrict x, const double *restrict inputs,
                        const double *restrict parameters, const double *restrict constants,
                        double *restrict after, double *restrict slopes);

/* slope (nx, count) = its product with those derivatives; the torque has the last column. */
typedef void model_chain(const double *slopes, int count, by_variables *slope);

typedef struct {
    int nx;
    model_flow *flow;
    model_step *step;
    model_chain *chain;
} dynamics;

typedef struct {
    const dynamics *model;
    const double *parameters, *constants; /* of the model */
    int derives;                          /* are the derivatives wanted? */
    int columns;                          /* of the variables so far */
    double inputs[INPUTS];
    double x[SHOT_MAX];
    by_variables slope[SHOT_MAX]; /* (nx, columns) */
} shot;

/* Start from x (nx,), with no variable and no disturbance. */
void shot_start(shot *state, const dynamics *model, const double *parameters,
                const double *constants, const double *x, int derives);

/* The first nx variables are the state that it starts from. */
void shot_from_state(shot *state);

/* The next variable is the torque that acts from here on. */
void shot_torque(shot *state, double torque_nm);

/* Go on by one Runge-Kutta step. */
void shot_step(shot *state, double step_s);

#endif
