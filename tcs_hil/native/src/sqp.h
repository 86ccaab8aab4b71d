/* Gauss-Newton SQP over a box, as in tcs_hil/control/sqp.py: exact box QPs and a line search. */

#ifndef TCS_SQP_H
#define TCS_SQP_H

#include "box_qp.h"

typedef struct {
    int max_iterations;
    double leftover_nm;          /* what the last step may leave, as steps have shrunk */
    double shrinkage;            /* a step over the one before it, when there last were two */
    int iterations;
    double plan[BOX_QP_MAX];     /* the guess before, the result after; Nm */
    double point[BOX_QP_MAX];    /* the plan of the last model */
    double gradient[BOX_QP_MAX]; /* there */
    box_qp qp;                   /* over the step from there; its Hessian is the model's */
} sqp;

/* Cost of a plan (N,), a sum of squares; writes gradient (N,) and Hessian (N, N) of its
   Gauss-Newton model, unless they are null. */
typedef double least_squares(void *problem, int n, const double *plan, double *gradient,
                             double *hessian);

/* Start cold with n torques. */
void sqp_setup(sqp *solver, int n, int max_iterations, double leftover_nm);

/* Forget the last plan and its model. */
void sqp_reset(sqp *solver);

/* Take the minimum of the last model, within 0 <= plan <= ceiling_nm, for the plan; zero if it has
   none. */
void sqp_expect(sqp *solver, double ceiling_nm);

/* Minimise over 0 <= plan <= ceiling_nm from the feasible plan in `solver`. */
int sqp_minimise(sqp *solver, least_squares *model, void *problem, double ceiling_nm);

#endif
