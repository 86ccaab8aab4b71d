/* What every law does around its optimisation, as in tcs_hil/control/screening.py and
   integrator.py. */

#ifndef TCS_WHEEL_STATE_H
#define TCS_WHEEL_STATE_H

typedef struct {
    double slip_speed_mps, wheel_speed_radps, slip_ratio, vehicle_speed_mps;
} wheel_state;

/* `value` within [0, ceiling]. */
double clamp(double value, double ceiling);

/* A law's answer: the torques for the coming period and the one after (NaN: not planned) go
   where Python reads them, the rest is returned as one number. */
typedef struct {
    double torque_nm, next_nm;
} proposal;

/* enum solve_status in the lowest two bits, iterations above. */
int outcome(int status, int iterations);

/* True: there is nothing to optimise, and the proposal is made with this outcome. */
int settled(const wheel_state *wheel, double torque_ref_nm, proposal *answer, int *its_outcome);

/* The first torque of a plan (n,) within [0, torque_ref_nm], and what comes next. */
void propose(proposal *answer, const double *plan, int n, double torque_ref_nm);

/* The driver's request: what a law answers that cannot decide. */
void leave(proposal *answer, double torque_ref_nm);

/* e_int of the published laws, in seconds of unit slip. */
typedef struct {
    double slip_reference, period_s, value_s;
} slip_error_integral;

void integral_advance(slip_error_integral *integral, double slip_ratio, double torque_nm,
                      double torque_ref_nm);

#endif
