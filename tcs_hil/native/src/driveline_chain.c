/* Written by scripts/generate_native.py from the sparsity of the model's derivatives. */

#include "shooting.h"

void driveline_chain(const double *a, int count, const stage *of) {
    const double weight = of->weight, reach = of->reach;
    const by_torques *before = of->before, *at = of->at, *sum = of->sum;
    const double *torque = of->torque;
    by_torques *next = of->next, *total = of->total;
#pragma GCC ivdep /* at may be next, and sum total, but no column another */
    for (int j = 0; j < count; j++) {
        const double s0 = at[0][j];
        const double s1 = at[1][j];
        const double s3 = at[3][j];
        const double s4 = at[4][j];
        const double s5 = at[5][j];
        const double s6 = at[6][j];
        const double s7 = torque[j];
        const double d0 = a[2] * s1 + a[10] * s4 + a[14] * s5 + a[17] * s6;
        const double d1 = a[3] * s1 + a[11] * s4 + a[15] * s5 + a[18] * s6;
        const double d2 = a[0] * s0 + a[4] * s1;
        const double d3 = a[8] * s3 + a[20] * s7;
        const double d4 = a[5] * s1 + a[9] * s3 + a[12] * s4 + a[16] * s5;
        const double d5 = a[6] * s1 + a[13] * s4;
        const double d6 = a[1] * s0 + a[7] * s1 + a[19] * s6;
        total[0][j] = sum[0][j] + weight * d0;
        next[0][j] = before[0][j] + reach * d0;
        total[1][j] = sum[1][j] + weight * d1;
        next[1][j] = before[1][j] + reach * d1;
        total[2][j] = sum[2][j] + weight * d2;
        next[2][j] = before[2][j] + reach * d2;
        total[3][j] = sum[3][j] + weight * d3;
        next[3][j] = before[3][j] + reach * d3;
        total[4][j] = sum[4][j] + weight * d4;
        next[4][j] = before[4][j] + reach * d4;
        total[5][j] = sum[5][j] + weight * d5;
        next[5][j] = before[5][j] + reach * d5;
        total[6][j] = sum[6][j] + weight * d6;
        next[6][j] = before[6][j] + reach * d6;
    }
}
