/* A sum of squared residuals and its Gauss-Newton model, gathered one residual at a time. */

#ifndef TCS_LEAST_SQUARES_H
#define TCS_LEAST_SQUARES_H

typedef struct {
    int n;
    double cost;
    double *gradient; /* (N,); null: the cost alone */
    double *hessian;  /* (N, N); the lower triangle until `mirror` */
} gauss_newton;

/* Start from nothing. */
void clear(gauss_newton *model);

/* Add a residual whose derivatives by the torques `first` to `last` are in `row` (N,); by the
   others 0. */
void add_residual(gauss_newton *model, double residual, const double *row, int first, int last);

/* Fill the upper triangle in. */
void mirror(gauss_newton *model);

#endif
