#include "observables.h"

#include <math.h>

void lift_samples(const belief *car, const sample *now, const sample *before, double *z) {
    const double rim_mps = now->wheel_speed_radps * car->wheel_radius_m;
    const double kappa =
        now->slip_speed_mps * rim_mps / (rim_mps * rim_mps + car->slip_epsilon_m2ps2);
    *z++ = now->slip_speed_mps;
    *z++ = now->wheel_speed_radps;
    *z++ = kappa;
    *z++ = sin(car->tyre_c * atan(car->tyre_b * kappa));
    *z++ = now->motor_speed_radps - now->wheel_speed_radps;
    *z++ = before->motor_speed_radps - before->wheel_speed_radps;
    *z++ = now->motor_speed_radps - before->motor_speed_radps;
    *z++ = now->motor_torque_nm;
    *z++ = before->motor_torque_nm;
    *z++ = 1.0;
}
