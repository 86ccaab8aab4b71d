/* The Koopman MPC as published, a whole step at a time: lift, gradient, box QP, integral. */

#ifndef TCS_KMPC_H
#define TCS_KMPC_H

#include "box_qp.h"
#include "lifting.h"
#include "wheel_state.h"

typedef struct {
    proposal *answer; /* where it is written */
    slip_error_integral integral;
    lifting map;
    double torque_mean_nm, torque_std_nm;
    double reduction_pull;                                    /* 2 w_u */
    double gradient_map[BOX_QP_MAX * (LIFTED_MAX + 2)];       /* (N, nz + 2), row by row */
    box_qp qp;                                                /* over the scaled torques */
} kmpc;

/* Set up with `map`, `integral`, scaling and `reduction_pull` filled in.  SOLVE_FAILED: N or H
   (N, N) does not do. */
int kmpc_setup(kmpc *law, int horizon, const double *hessian, const double *gradient_map);

/* Forget the integral and the last plan. */
void kmpc_reset(kmpc *law);

/* Decide for the coming period: see `proposal` and `outcome`. */
int kmpc_step(kmpc *law, double slip_speed_mps, double wheel_speed_radps, double slip_ratio,
              double vehicle_speed_mps, double torque_ref_nm);

#endif
