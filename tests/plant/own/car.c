/* The paper's quarter car as an FMI co-simulation unit, version 2 or, with -DFMI3, 3. */

#include <math.h>
#include <stdlib.h>
#ifdef FMI3
#include "fmi3Functions.h"
#define REAL fmi3Float64
#define REFERENCE fmi3ValueReference
#define INSTANCE fmi3Instance
#define STATUS fmi3Status
#define DONE fmi3OK
#define STRANGE fmi3Error
#else
#include "fmi2Functions.h"
#define REAL fmi2Real
#define REFERENCE fmi2ValueReference
#define INSTANCE fmi2Component
#define STATUS fmi2Status
#define DONE fmi2OK
#define STRANGE fmi2Error
#endif

enum { TORQUE_L, TORQUE_R, MU_L, MU_R, SPEED, FL, FR, RL, RR, START_SPEED, MASS, VARIABLES };

#define RADIUS 0.318
#define STEP 1e-4

static double slip(double rim, double speed) {
    return (rim - speed) * rim / (rim * rim + 0.1);
}

static double force(double omega, double speed, double mu, double mass) {
    double kappa = slip(omega * RADIUS, speed);
    return mu * mass * 9.81 / 4.0 * 1.2005 * sin(1.4010 * atan(17.1571 * kappa));
}

static void begin(double *v) {
    v[SPEED] = v[START_SPEED];
    v[FL] = v[FR] = v[RL] = v[RR] = v[START_SPEED] / RADIUS;
}

static void drive(double *v, double duration) {
    int steps = (int)ceil(duration / STEP - 1e-9);
    double h = duration / steps;
    for (int i = 0; i < steps; i++) {
        double left = force(v[FL], v[SPEED], v[MU_L], v[MASS]);
        double right = force(v[FR], v[SPEED], v[MU_R], v[MASS]);
        v[FL] += h * (3.0 * v[TORQUE_L] - left * RADIUS) / 1.22;
        v[FR] += h * (3.0 * v[TORQUE_R] - right * RADIUS) / 1.22;
        v[SPEED] += h * 2.0 / v[MASS] * (left + right);
    }
    v[RL] = v[RR] = v[SPEED] / RADIUS;
}

static void *make(void) {
    double *v = calloc(VARIABLES, sizeof *v);
    if (v) v[MASS] = 1400.0;
    return v;
}

static STATUS get(INSTANCE c, const REFERENCE r[], size_t n, REAL values[]) {
    for (size_t i = 0; i < n; i++) {
        if (r[i] >= VARIABLES) return STRANGE;
        values[i] = ((double *)c)[r[i]];
    }
    return DONE;
}

static STATUS set(INSTANCE c, const REFERENCE r[], size_t n, const REAL values[]) {
    for (size_t i = 0; i < n; i++) {
        if (r[i] >= VARIABLES) return STRANGE;
        ((double *)c)[r[i]] = values[i];
    }
    return DONE;
}

#ifdef FMI3
fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String path,
    fmi3Boolean visible, fmi3Boolean logging, fmi3Boolean events, fmi3Boolean early,
    const fmi3ValueReference needed[], size_t n, fmi3InstanceEnvironment environment,
    fmi3LogMessageCallback log, fmi3IntermediateUpdateCallback update) { return make(); }
void fmi3FreeInstance(fmi3Instance c) { free(c); }
fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean tolerant, fmi3Float64 tolerance,
    fmi3Float64 start, fmi3Boolean stops, fmi3Float64 stop) { return fmi3OK; }
fmi3Status fmi3ExitInitializationMode(fmi3Instance c) { begin(c); return fmi3OK; }
fmi3Status fmi3Terminate(fmi3Instance c) { return fmi3OK; }
fmi3Status fmi3GetFloat64(fmi3Instance c, const fmi3ValueReference r[], size_t n,
    fmi3Float64 values[], size_t m) { return get(c, r, n, values); }
fmi3Status fmi3SetFloat64(fmi3Instance c, const fmi3ValueReference r[], size_t n,
    const fmi3Float64 values[], size_t m) { return set(c, r, n, values); }
fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 time, fmi3Float64 duration, fmi3Boolean fresh,
    fmi3Boolean *event, fmi3Boolean *terminate, fmi3Boolean *early, fmi3Float64 *reached) {
    *event = *terminate = *early = fmi3False;
    *reached = time + duration;
    drive(c, duration);
    return fmi3OK;
}
#else
fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String token, fmi2String path,
    const fmi2CallbackFunctions *callbacks, fmi2Boolean visible, fmi2Boolean logging) {
    return make();
}
void fmi2FreeInstance(fmi2Component c) { free(c); }
fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean tolerant, fmi2Real tolerance,
    fmi2Real start, fmi2Boolean stops, fmi2Real stop) { return fmi2OK; }
fmi2Status fmi2EnterInitializationMode(fmi2Component c) { return fmi2OK; }
fmi2Status fmi2ExitInitializationMode(fmi2Component c) { begin(c); return fmi2OK; }
fmi2Status fmi2Terminate(fmi2Component c) { return fmi2OK; }
fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference r[], size_t n, fmi2Real values[]) {
    return get(c, r, n, values);
}
fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference r[], size_t n,
    const fmi2Real values[]) { return set(c, r, n, values); }
fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real duration, fmi2Boolean fresh) {
    drive(c, duration);
    return fmi2OK;
}
#endif
