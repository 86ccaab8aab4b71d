#include "lifting.h"

#include <math.h>

/* Keeps the logarithm finite at a centre, where the thin plate is 0 anyway. */
static const double NEARLY_ZERO = 1e-12;

/* Each degree is s times the one before, and omega times its last: no power is ever taken. */
static double *append_monomials(double *end, double s, double omega, int order) {
    double low[] = {s, omega};
    const double *below = low;
    for (int degree = 2; degree <= order; degree++) {
        double *first = end;
        for (int k = 0; k < degree; k++) *end++ = s * below[k];
        *end++ = omega * below[degree - 1];
        below = first;
    }
    return end;
}

static double thin_plate(double squared) { return 0.5 * squared * log(squared + NEARLY_ZERO); }

static double gaussian(double squared) { return exp(-0.5 * squared); }

static double *append_radial(double *end, const lifting *map, double s, double omega) {
    for (int k = 0; k < map->centre_count; k++) {
        const double x = s - map->centres[k][0], y = omega - map->centres[k][1];
        const double squared = x * x + y * y;
        *end++ = map->dictionary == THIN_PLATE ? thin_plate(squared) : gaussian(squared);
    }
    return end;
}

int lift(const lifting *map, double s_mps, double omega_radps, double *z) {
    const double s = (s_mps - map->s_mean_mps) / map->s_std_mps;
    const double omega = (omega_radps - map->omega_mean_radps) / map->omega_std_radps;
    const double rim_mps = omega_radps * map->wheel_radius_m;
    double *end = z;
    *end++ = s;
    *end++ = omega;
    *end++ = s_mps * rim_mps / (rim_mps * rim_mps + map->slip_epsilon_m2ps2);
    end = map->dictionary == MONOMIALS ? append_monomials(end, s, omega, map->order)
                                       : append_radial(end, map, s, omega);
    *end++ = 1.0;
    return (int)(end - z);
}
