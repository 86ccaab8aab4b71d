#include "least_squares.h"

#include <string.h>

void clear(gauss_newton *model) {
    const size_t n = (size_t)model->n;
    model->cost = 0.0;
    if (!model->gradient) return;
    memset(model->gradient, 0, n * sizeof *model->gradient);
    memset(model->hessian, 0, n * n * sizeof *model->hessian);
}

void add_residual(gauss_newton *model, double residual, const double *row, int first, int last) {
    model->cost += residual * residual;
    if (!model->gradient) return;
    for (int i = first > model->given ? first : model->given; i <= last; i++) {
        double *restrict line = model->hessian + i * model->n;
        const double twice = 2.0 * row[i];
        model->gradient[i] += twice * residual;
        for (int j = first; j <= i; j++) line[j] += twice * row[j];
    }
}

void mirror(gauss_newton *model) {
    if (!model->gradient) return;
    for (int i = 0; i < model->n; i++)
        for (int j = i + 1; j < model->n; j++)
            model->hessian[i * model->n + j] = model->hessian[j * model->n + i];
}
