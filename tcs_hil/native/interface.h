/* What Python sees of the native step, for cffi; the compiler checks it against src/.
   "...;" stands for what Python has no business with. */

static const unsigned sources_checksum; /* of what this was compiled from: see sources.py */

enum solve_status { SOLVE_OK, SOLVE_MAX_ITERATIONS, SOLVE_FAILED, SOLVE_BAD_INPUT };

typedef struct {
    int iterations;
    double x[...];
    ...;
} box_qp;

int box_qp_setup(box_qp *qp, int n, const double *hessian);
void box_qp_reset(box_qp *qp);
int box_qp_solve(box_qp *qp, const double *g, const double *lower, const double *upper);

typedef struct {
    double torque_nm, next_nm;
} proposal;

typedef struct {
    double slip_reference, period_s;
    ...;
} slip_error_integral;

enum dictionary { MONOMIALS, THIN_PLATE, GAUSSIAN };

typedef struct {
    int dictionary, order, centre_count;
    double s_mean_mps, s_std_mps, omega_mean_radps, omega_std_radps;
    double wheel_radius_m, slip_epsilon_m2ps2;
    double centres[...][2];
    ...;
} lifting;

typedef struct {
    proposal *answer;
    slip_error_integral integral;
    lifting map;
    double torque_mean_nm, torque_std_nm, reduction_pull;
    ...;
} kmpc;

int kmpc_setup(kmpc *law, int horizon, const double *hessian, const double *gradient_map);
void kmpc_reset(kmpc *law);
int kmpc_step(kmpc *law, double slip_speed_mps, double wheel_speed_radps, double slip_ratio,
              double vehicle_speed_mps, double torque_ref_nm);

typedef struct {
    proposal *answer;
    slip_error_integral integral;
    int substeps;
    double slip_gain, integral_gain;
    double parameters[...];
    ...;
} nmpc;

void nmpc_setup(nmpc *law, int horizon, int max_iterations, double leftover_nm);
void nmpc_reset(nmpc *law);
int nmpc_step(nmpc *law, double slip_speed_mps, double wheel_speed_radps, double slip_ratio,
              double vehicle_speed_mps, double torque_ref_nm);

typedef struct {
    double x[...], plan[...];
    double period_s, slip_gain, integral_gain, reduction_gain;
    double parameters[...];
    int blocks[...];
    ...;
} driveline;

void driveline_setup(driveline *law, int block_count, int max_iterations, double leftover_nm);
void driveline_reset(driveline *law);
void driveline_roll_forward(driveline *law, const double *torques_nm, int count,
                            double first_periods, double disturbance_n,
                            double disturbance_mps2);
int driveline_plan(driveline *law, double last_torque_nm, double torque_ref_nm,
                   double disturbance_n, double disturbance_mps2, double urgency);

typedef struct {
    double centre_mps;
    ...;
} band;

typedef struct {
    double wheel_radius_m, slip_epsilon_m2ps2, tyre_b, tyre_c;
} belief;

typedef struct {
    int band_count;
    band *bands;
    belief car;
    double unit_nm, reduction_pull, change_pull;
    double x[...], plan[...];
    ...;
} bank;

int band_setup(band *self, int n, const double *a, const double *b, const double *hessian,
               const double *gradient_map);
void bank_reset(bank *law);
double bank_observe(bank *law, double vehicle_speed_mps, double slip_speed_mps,
                    double wheel_speed_radps, double motor_speed_radps, double motor_torque_nm,
                    double integral_s, double disturbance_radps);
void bank_roll_forward(bank *law, const double *torques_nm, int count, double first_periods);
int bank_plan(bank *law, double last_torque_nm, double torque_ref_nm);
