/* From one wheel's state to the lifted state, as in tcs_hil/model/lifting.py and radial.py. */

#ifndef TCS_LIFTING_H
#define TCS_LIFTING_H

enum { LIFTED_MAX = 46, CENTRES_MAX = 42 }; /* of order 8 */

enum dictionary { MONOMIALS, THIN_PLATE, GAUSSIAN };

typedef struct {
    int dictionary;
    int order;        /* of the monomials */
    int centre_count; /* of the radial dictionaries */
    double s_mean_mps, s_std_mps, omega_mean_radps, omega_std_radps;
    double wheel_radius_m, slip_epsilon_m2ps2;
    double centres[CENTRES_MAX][2]; /* scaled s and omega */
} lifting;

/* Write the lifted state [s, omega, kappa, ..., 1]; returns its length. */
int lift(const lifting *map, double s_mps, double omega_radps, double *z);

#endif
