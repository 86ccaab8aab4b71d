/* Written by scripts/generate_native.py; what it computes was written by CasADi. */

#ifndef TCS_WHEEL_MODEL_H
#define TCS_WHEEL_MODEL_H

#include "shooting.h"

enum { WHEEL_PARAMETERS = 11, WHEEL_CONSTANTS = 4 };

void wheel_fold(const double *restrict parameters,
                double *restrict constants);
void wheel_flow(const double *restrict x,
                const double *restrict inputs,
                const double *restrict parameters,
                const double *restrict constants,
                double *restrict after);
void wheel_step(const double *restrict x,
                const double *restrict inputs,
                const double *restrict parameters,
                const double *restrict constants,
                double *restrict after,
                double *restrict slopes);
void wheel_slip(const double *restrict x,
                const double *restrict parameters,
                double *restrict kappa,
                double *restrict by_state);
model_chain wheel_chain;

#endif
