/* Single shooting: a state and its derivatives by the torques that led to it, carried through
   Runge-Kutta steps together. */

#ifndef TCS_SHOOTING_H
#define TCS_SHOOTING_H

#include "box_qp.h"

enum { SHOT_MAX = 7, SLOPES_MAX = SHOT_MAX * (SHOT_MAX + 1) };

typedef double by_torques[BOX_QP_MAX]; /* the derivatives of one quantity */

/* One stage of a step: what its slope d adds to the sum over the stages, and to the state before
   for the next stage; all (nx, count). */
typedef struct {
    double weight, reach;
    const by_torques *before, *at, *sum;
    const double *torque;     /* 1 for the one that acts, 0 for the others */
    by_torques *next, *total; /* before + reach d, sum + weight d */
} stage;

/* With d = A at + B torque; `slopes` are the nonzero elements of (A, B), column by column.
   Written for each model by scripts/generate_native.py. */
typedef void slope_chain(const double *slopes, int count, const stage *of);
slope_chain wheel_chain, driveline_chain;

/* A model x' = f(x, u). */
typedef struct {
    int nx;
    /* Write f (nx,) and, unless null, `slopes`. */
    void (*rate)(const void *law, const double *x, double torque_nm, double *rate, double *slopes);
    slope_chain *chain;
} dynamics;

typedef struct {
    const dynamics *model;
    const void *law;       /* whose parameters `rate` takes */
    int derives;           /* are the derivatives wanted? */
    double x[SHOT_MAX];
    by_torques *by_torque; /* (nx, N), the one of the next two that is up to date */
    by_torques memory[2][SHOT_MAX], next[SHOT_MAX], torque;
} shot;

/* Start from x (nx,). */
void shot_start(shot *state, const dynamics *model, const void *law, int derives, const double *x);

/* Derive by the state it starts from too, in the first nx columns. */
void shot_from_state(shot *state);

/* From here on the k-th torque acts; each in its turn. */
void shot_torque(shot *state, int k);

/* Go on by one Runge-Kutta step under the k-th torque. */
void shot_step(shot *state, double torque_nm, int k, double step_s);

#endif
