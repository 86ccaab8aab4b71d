/* Quadratic programs over a box, solved exactly.

   Minimise x'Hx/2 + g'x over lower <= x <= upper, H (n, n) symmetric and positive definite,
   by a primal active set.  The free variables of the last solution, and the Cholesky factor
   that belongs to them, are where the next solve starts. */

#ifndef TCS_BOX_QP_H
#define TCS_BOX_QP_H

enum { BOX_QP_MAX = 40 };

enum solve_status { SOLVE_OK, SOLVE_MAX_ITERATIONS, SOLVE_FAILED, SOLVE_BAD_INPUT };

typedef struct {
    int n;
    int free_count;
    int iterations;
    int free[BOX_QP_MAX];      /* the free variables, in the order of the factor's rows */
    int at_upper[BOX_QP_MAX];  /* which bound a fixed variable is at */
    int is_free[BOX_QP_MAX];
    double x[BOX_QP_MAX];
    double slope[BOX_QP_MAX];              /* Hx + g */
    double step[BOX_QP_MAX];               /* of the free variables, in the factor's order */
    double inverse_pivot[BOX_QP_MAX];      /* 1 / L_kk */
    double factor[BOX_QP_MAX * BOX_QP_MAX];  /* L, row by row with stride n: H_free = L L' */
    double hessian[BOX_QP_MAX * BOX_QP_MAX]; /* (n, n), row by row */
} box_qp;

/* Take H (n, n), row by row, and start cold.  SOLVE_FAILED: n is out of range or H is not
   positive definite. */
int box_qp_setup(box_qp *qp, int n, const double *hessian);

/* Another H, written into qp->hessian, with the free variables kept.  SOLVE_FAILED as above. */
int box_qp_refactor(box_qp *qp);

/* Forget the last solution. */
void box_qp_reset(box_qp *qp);

/* Solve for g (n,) and finite bounds (n,), which may be equal; the solution is left in qp->x.
   SOLVE_FAILED: something is not finite. */
int box_qp_solve(box_qp *qp, const double *g, const double *lower, const double *upper);

#endif
