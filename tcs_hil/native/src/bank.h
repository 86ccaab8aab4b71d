/* The core of the default Koopman MPC: one or two predictors of a bank, mixed by weight. */

#ifndef TCS_BANK_H
#define TCS_BANK_H

#include "box_qp.h"
#include "observables.h"

/* State x = [z, e_int, d], as in tcs_hil/control/bank_problem.py. */
enum { BANK_INTEGRAL = BANK_NZ, BANK_DISTURBANCE, BANK_NX };

/* One predictor x+ = A x + B u, and the quadratic program over it. */
typedef struct {
    double centre_mps;
    double a[BANK_NX * BANK_NX]; /* row by row */
    double b[BANK_NX];
    double gradient_map[BOX_QP_MAX * BANK_NX]; /* (N, BANK_NX), row by row */
    box_qp qp;
} band;

/* The bands by rising speed; those in charge, the second of them perhaps without weight. */
typedef struct {
    int band_count;
    band *bands;
    belief car;
    double unit_nm; /* of the torques in the quadratic programs */
    double reduction_pull, change_pull;
    int has_before;
    sample before;
    band *first, *second;
    double weight, other_weight; /* add up to 1 */
    double a[BANK_NX * BANK_NX], b[BANK_NX];    /* mixed */
    double x[BANK_NX];                /* the state that is rolled forward and planned from */
    double plan[BOX_QP_MAX];     /* Nm */
} bank;

/* SOLVE_FAILED: N is out of range, or H (N, N) is not positive definite. */
int band_setup(band *self, int n, const double *a, const double *b, const double *hessian,
               const double *gradient_map);

/* Forget the last sample and the last plans. */
void bank_reset(bank *law);

/* Set x to what is seen now, with the bands around this speed in charge.  Returns the wheel
   speed one period later, in rad/s, without torque or disturbance. */
double bank_observe(bank *law, double vehicle_speed_mps, double slip_speed_mps,
                    double wheel_speed_radps, double motor_speed_radps, double motor_torque_nm,
                    double integral_s, double disturbance_radps);

/* Carry x through torques (count,), the first for a part of a period, the others for one each. */
void bank_roll_forward(bank *law, const double *torques_nm, int count, double first_periods);

/* Write the best torques from x on into `plan`; see `outcome`. */
int bank_plan(bank *law, double last_torque_nm, double torque_ref_nm);

#endif
