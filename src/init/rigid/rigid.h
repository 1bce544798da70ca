/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Rigid motions, and the least-squares motion between pairs of points (Horn 1987, Closed-form solution of absolute orientation
 * using unit quaternions, JOSA A 4).
 */
#ifndef ADCGS_INIT_RIGID_RIGID_H
#define ADCGS_INIT_RIGID_RIGID_H

/** x maps to r x + t; r: rows. */
typedef struct adcgs_rigid {
    double r[9], t[3];
} adcgs_rigid;

/** Weighted sums over pairs. Zero-initialise before use. */
typedef struct adcgs_rigid_sums {
    double weight, from[3], to[3], product[9];
} adcgs_rigid_sums;

static inline void adcgs_rigid_turn(const adcgs_rigid *m, const double x[3], double out[3])
{
    for (int a = 0; a < 3; a++)
        out[a] = m->r[3 * a] * x[0] + m->r[3 * a + 1] * x[1] + m->r[3 * a + 2] * x[2];
}

static inline void adcgs_rigid_apply(const adcgs_rigid *m, const double x[3], double out[3])
{
    for (int a = 0; a < 3; a++)
        out[a] = m->r[3 * a] * x[0] + m->r[3 * a + 1] * x[1] + m->r[3 * a + 2] * x[2] + m->t[a];
}

extern const adcgs_rigid adcgs_rigid_none; /**< the identity */

/** Composition: first, then second. out may be either. */
void adcgs_rigid_then(const adcgs_rigid *first, const adcgs_rigid *second, adcgs_rigid *out);
void adcgs_rigid_inverse(const adcgs_rigid *m, adcgs_rigid *out);

/** Rotation about a centre, given as axis times angle, followed by a translation. */
void adcgs_rigid_about(const double turn[3], const double centre[3], const double shift[3], adcgs_rigid *out);

void adcgs_rigid_add(adcgs_rigid_sums *sums, const double from[3], const double to[3], double weight);
/** The least-squares motion; the identity without any pair. */
void adcgs_rigid_fit(const adcgs_rigid_sums *sums, adcgs_rigid *out);

/** Eigenvectors of a symmetric matrix of n <= 4 rows by Jacobi rotations: columns of v; a becomes diagonal. */
void adcgs_symmetric_eigen(double *a, double *v, int n);

/**
 * Solves a x = b with six unknowns and positive definite a, by Cholesky factorisation. Returns 0 if a is not positive definite.
 */
int adcgs_solve_six(double a[36], double b[6]);

#endif
