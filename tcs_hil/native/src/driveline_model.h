/* Written by scripts/generate_native.py; what it computes was written by CasADi. */

#ifndef TCS_DRIVELINE_MODEL_H
#define TCS_DRIVELINE_MODEL_H

#include "shooting.h"

enum { DRIVELINE_PARAMETERS = 18, DRIVELINE_CONSTANTS = 13 };

void driveline_fold(const double *restrict parameters,
                    double *restrict constants);
void driveline_flow(const double *restrict x,
                    const double *restrict inputs,
                    const double *restrict parameters,
                    const double *restrict constants,
                    double *restrict after);
void driveline_step(const double *restrict x,
                    const double *restrict inputs,
                    const double *restrict parameters,
                    const double *restrict constants,
                    double *restrict after,
                    double *restrict slopes);
void driveline_slip(const double *restrict x,
                    const double *restrict parameters,
                    double *restrict kappa,
                    double *restrict by_state);
model_chain driveline_chain;

#endif
