/* The lifted state of the Koopman bank, as in tcs_hil/model/observables.py. */

#ifndef TCS_OBSERVABLES_H
#define TCS_OBSERVABLES_H

enum { BANK_NZ = 10, BANK_WHEEL_SPEED = 1 /* where it is */ };

/* What the bus says of one wheel at one instant; the motor is seen from the wheel. */
typedef struct {
    double slip_speed_mps, wheel_speed_radps, motor_speed_radps, motor_torque_nm;
} sample;

/* What is believed of the car. */
typedef struct {
    double wheel_radius_m, slip_epsilon_m2ps2, tyre_b, tyre_c;
} belief;

/* Write the lifted state (BANK_NZ,) of two samples one period apart. */
void lift_samples(const belief *car, const sample *now, const sample *before, double *z);

#endif
