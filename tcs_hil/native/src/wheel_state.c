#include "wheel_state.h"

#include <math.h>

#include "box_qp.h"

static const double BEYOND_ANY_WHEEL = 1e6;
static const double REDUCTION_THRESHOLD_NM = 1.0;

/* NaN and infinity fail it, and what passes cannot overflow. */
static int is_plausible(double value) {
    return -BEYOND_ANY_WHEEL < value && value < BEYOND_ANY_WHEEL;
}

static int is_known(const wheel_state *wheel) {
    return is_plausible(wheel->slip_speed_mps) && is_plausible(wheel->wheel_speed_radps) &&
           is_plausible(wheel->slip_ratio) && is_plausible(wheel->vehicle_speed_mps);
}

int outcome(int status, int iterations) { return status | iterations << 2; }

int settled(const wheel_state *wheel, double torque_ref_nm, proposal *answer, int *its_outcome) {
    const int known = is_known(wheel);
    if (torque_ref_nm > 0.0 && torque_ref_nm < INFINITY && known) return 0;
    leave(answer, isfinite(torque_ref_nm) ? torque_ref_nm : INFINITY); /* infinity: no limit */
    *its_outcome = outcome(torque_ref_nm == 0.0 && known ? SOLVE_OK : SOLVE_BAD_INPUT, 0);
    return 1;
}

double clamp(double value, double ceiling) {
    return value < 0.0 ? 0.0 : value > ceiling ? ceiling : value;
}

void propose(proposal *answer, const double *plan, int n, double torque_ref_nm) {
    answer->torque_nm = clamp(plan[0], torque_ref_nm);
    answer->next_nm = plan[n > 1]; /* a horizon of one means the same torque again */
}

void leave(proposal *answer, double torque_ref_nm) {
    answer->torque_nm = torque_ref_nm;
    answer->next_nm = NAN;
}

void integral_advance(slip_error_integral *integral, double slip_ratio, double torque_nm,
                      double torque_ref_nm) {
    if (torque_ref_nm > 0.0 && fabs(torque_ref_nm - torque_nm) > REDUCTION_THRESHOLD_NM)
        integral->value_s += integral->period_s * (integral->slip_reference - slip_ratio);
}
