/* The core of the default nonlinear MPC: its prediction model, and the plan from a state on. */

#ifndef TCS_DRIVELINE_H
#define TCS_DRIVELINE_H

#include "driveline_model.h"
#include "sqp.h"

enum { DRIVELINE_NX = 7 };

typedef struct {
    double x[DRIVELINE_NX]; /* the state that is rolled forward and planned from; SI units */
    double plan[BOX_QP_MAX];
    double disturbance_n, disturbance_mps2; /* on the tyre's force, on the body */
    double torque_ref_nm, last_torque_nm;
    double urgency;         /* factor on the residuals of slip and integral */
    double period_s;
    double slip_gain, integral_gain, reduction_gain; /* Nm per unit slip, per second, per Nm */
    double parameters[DRIVELINE_PARAMETERS];         /* of the model */
    double constants[DRIVELINE_CONSTANTS];           /* folded from them */
    int blocks[BOX_QP_MAX];                          /* periods each torque is held for */
    sqp solver;
} driveline;

/* Set up with period, gains, parameters and blocks filled in. */
void driveline_setup(driveline *law, int block_count, int max_iterations, double leftover_nm);

/* Forget the last plan. */
void driveline_reset(driveline *law);

/* Carry x through torques (count,), the first for a part of a period, the others for one each. */
void driveline_roll_forward(driveline *law, const double *torques_nm, int count,
                            double first_periods, double disturbance_n,
                            double disturbance_mps2);

/* Write the best torques from x on into `plan`; see `outcome`. */
int driveline_plan(driveline *law, double last_torque_nm, double torque_ref_nm,
                   double disturbance_n, double disturbance_mps2, double urgency);

#endif
