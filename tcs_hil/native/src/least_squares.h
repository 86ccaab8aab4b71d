/* A sum of squared residuals and its Gauss-Newton model, gathered one residual at a time. */

#ifndef TCS_LEAST_SQUARES_H
#define TCS_LEAST_SQUARES_H

/* Of n variables, the first of which may be given: then the gradient by them stays undefined, and
   so do their rows of the Hessian. */
typedef struct {
    int given, n;
    double cost;
    double *gradient; /* (n,); null: the cost alone */
    double *hessian;  /* (n, n); the lower triangle until `mirror` */
} gauss_newton;

/* Start from nothing. */
void clear(gauss_newton *model);

/* Add a residual whose derivatives by the variables `first` to `last` are in `row` (n,); by the
   others 0. */
void add_residual(gauss_newton *model, double residual, const double *row, int first, int last);

/* Fill the upper triangle in. */
void mirror(gauss_newton *model);

#endif
