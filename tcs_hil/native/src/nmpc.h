/* The nonlinear MPC as published, a whole step at a time: single shooting, SQP, integral. */

#ifndef TCS_NMPC_H
#define TCS_NMPC_H

#include "sqp.h"
#include "wheel_model.h"
#include "wheel_state.h"

/* What is given: [T_ref, x_0], x = [s, omega, e_int]. */
enum { WHEEL_NX = 3, TORQUE_REF = 0, STATE, GIVEN = STATE + WHEEL_NX };

typedef struct {
    proposal *answer; /* where it is written */
    slip_error_integral integral;
    int substeps;                          /* Runge-Kutta steps in a period */
    double slip_gain, integral_gain;       /* Nm per unit slip and per second: the residuals' */
    double parameters[WHEEL_PARAMETERS];   /* of the model */
    double constants[WHEEL_CONSTANTS];     /* folded from them */
    double given[GIVEN];
    double drift[BOX_QP_MAX][GIVEN];       /* (N, 4), the gradient's derivatives by them */
    sqp solver;
} nmpc;

/* Set up with integral, substeps, gains and parameters filled in. */
void nmpc_setup(nmpc *law, int horizon, int max_iterations, double leftover_nm);

/* Forget the integral and the last model. */
void nmpc_reset(nmpc *law);

/* Decide for the coming period: see `proposal` and `outcome`. */
int nmpc_step(nmpc *law, double slip_speed_mps, double wheel_speed_radps, double slip_ratio,
              double vehicle_speed_mps, double torque_ref_nm);

#endif
