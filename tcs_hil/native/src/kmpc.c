#include "kmpc.h"

#include <string.h>

int kmpc_setup(kmpc *law, int horizon, const double *hessian, const double *gradient_map) {
    double z[LIFTED_MAX];
    if (box_qp_setup(&law->qp, horizon, hessian) != SOLVE_OK) return SOLVE_FAILED;
    const int width = lift(&law->map, 0.0, 0.0, z) + 2;
    memcpy(law->gradient_map, gradient_map, (size_t)(horizon * width) * sizeof *gradient_map);
    return SOLVE_OK;
}

void kmpc_reset(kmpc *law) {
    law->integral.value_s = 0.0;
    box_qp_reset(&law->qp);
}

/* Gradient of the cost at zero torque: its map times xi = [z, e_int, kappa_ref]. */
static void gradient(const kmpc *law, const wheel_state *wheel, double torque_ref, double *g) {
    double xi[LIFTED_MAX + 2];
    int width = lift(&law->map, wheel->slip_speed_mps, wheel->wheel_speed_radps, xi);
    xi[width++] = law->integral.value_s;
    xi[width++] = law->integral.slip_reference;
    for (int i = 0; i < law->qp.n; i++) {
        const double *row = law->gradient_map + i * width;
        double sum = 0.0;
        for (int j = 0; j < width; j++) sum += row[j] * xi[j];
        g[i] = sum - law->reduction_pull * torque_ref;
    }
}

static double scaled(const kmpc *law, double torque_nm) {
    return (torque_nm - law->torque_mean_nm) / law->torque_std_nm;
}

/* Best scaled torques, left in law->qp.x. */
static int optimise(kmpc *law, const wheel_state *wheel, double torque_ref_nm) {
    double g[BOX_QP_MAX], lower[BOX_QP_MAX], upper[BOX_QP_MAX];
    const double zero_torque = scaled(law, 0.0), torque_ref = scaled(law, torque_ref_nm);
    gradient(law, wheel, torque_ref, g);
    for (int i = 0; i < law->qp.n; i++) {
        lower[i] = zero_torque;
        upper[i] = torque_ref;
    }
    return box_qp_solve(&law->qp, g, lower, upper);
}

static void answer(kmpc *law, int status, double torque_ref_nm) {
    if (status == SOLVE_FAILED) {
        box_qp_reset(&law->qp); /* what failed is no warm start */
        leave(law->answer, torque_ref_nm);
        return;
    }
    double plan_nm[BOX_QP_MAX];
    for (int i = 0; i < law->qp.n; i++)
        plan_nm[i] = law->qp.x[i] * law->torque_std_nm + law->torque_mean_nm;
    propose(law->answer, plan_nm, law->qp.n, torque_ref_nm);
}

int kmpc_step(kmpc *law, double slip_speed_mps, double wheel_speed_radps, double slip_ratio,
              double vehicle_speed_mps, double torque_ref_nm) {
    const wheel_state wheel = {slip_speed_mps, wheel_speed_radps, slip_ratio, vehicle_speed_mps};
    int result;
    if (settled(&wheel, torque_ref_nm, law->answer, &result)) return result;
    const int status = optimise(law, &wheel, torque_ref_nm);
    answer(law, status, torque_ref_nm);
    integral_advance(&law->integral, slip_ratio, law->answer->torque_nm, torque_ref_nm);
    return outcome(status, law->qp.iterations);
}
