/* Written by scripts/generate_native.py from the sparsity of the model's derivatives. */

#include "shooting.h"

void wheel_chain(const double *a, int count, const stage *of) {
    const double weight = of->weight, reach = of->reach;
    const by_torques *before = of->before, *at = of->at, *sum = of->sum;
    const double *torque = of->torque;
    by_torques *next = of->next, *total = of->total;
#pragma GCC ivdep /* at may be next, and sum total, but no column another */
    for (int j = 0; j < count; j++) {
        const double s0 = at[0][j];
        const double s1 = at[1][j];
        const double s3 = torque[j];
        const double d0 = a[0] * s0 + a[3] * s1 + a[6] * s3;
        const double d1 = a[1] * s0 + a[4] * s1 + a[7] * s3;
        const double d2 = a[2] * s0 + a[5] * s1;
        total[0][j] = sum[0][j] + weight * d0;
        next[0][j] = before[0][j] + reach * d0;
        total[1][j] = sum[1][j] + weight * d1;
        next[1][j] = before[1][j] + reach * d1;
        total[2][j] = sum[2][j] + weight * d2;
        next[2][j] = before[2][j] + reach * d2;
    }
}
