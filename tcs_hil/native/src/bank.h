/* The core of the default Koopman MPC: one or two predictors of a bank, mixed by weight. */

#ifndef TCS_BANK_H
#define TCS_BANK_H

#include "box_qp.h"

enum { BANK_NX_MAX = 16 };

/* One predictor x+ = A x + B u, and the quadratic program over it. */
typedef struct {
    double a[BANK_NX_MAX * BANK_NX_MAX]; /* (nx, nx), row by row */
    double b[BANK_NX_MAX];
    double gradient_map[BOX_QP_MAX * BANK_NX_MAX]; /* (N, nx), row by row */
    box_qp qp;
} band;

/* The band in charge, and the other one where two are; weights add up to 1. */
typedef struct {
    int nx;
    int band_count;
    band *bands[2];
    double weights[2];
    double a[BANK_NX_MAX * BANK_NX_MAX], b[BANK_NX_MAX]; /* mixed */
    double x[BANK_NX_MAX];   /* the state that the functions below start from */
    double plan[BOX_QP_MAX]; /* Nm */
    double unit_nm;          /* of the torques in the quadratic programs */
    double reduction_pull, change_pull;
} bank;

/* SOLVE_FAILED: sizes are out of range, or H (N, N) is not positive definite. */
int band_setup(band *self, int nx, int n, const double *a, const double *b, const double *hessian,
               const double *gradient_map);

/* From now on these bands predict and plan; a second one without weight is left out. */
void bank_settle(bank *law, band *first, double weight, band *second, double other_weight);

/* Replace x by the state after `periods` in (0, 1] periods of a torque. */
void bank_advance(bank *law, double torque_nm, double periods);

/* Write the best torques from x on into `plan`; see `outcome`. */
int bank_plan(bank *law, double last_torque_nm, double torque_ref_nm);

#endif
