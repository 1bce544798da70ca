/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Rigid motions and their algebra. */
#include "init/rigid/rigid.h"

#include "geometry/rotation.h"

#include <math.h>
#include <string.h>

enum { SWEEPS = 12 }; /* sweeps of the Jacobi method; chosen by hand, not measured: it converges quadratically */

const adcgs_rigid adcgs_rigid_none = {.r = {1, 0, 0, 0, 1, 0, 0, 0, 1}};

void adcgs_rigid_then(const adcgs_rigid *first, const adcgs_rigid *second, adcgs_rigid *out)
{
    adcgs_rigid m;
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            m.r[3 * a + b] =
                second->r[3 * a] * first->r[b] + second->r[3 * a + 1] * first->r[3 + b] + second->r[3 * a + 2] * first->r[6 + b];
    adcgs_rigid_apply(second, first->t, m.t);
    *out = m;
}

void adcgs_rigid_inverse(const adcgs_rigid *m, adcgs_rigid *out)
{
    adcgs_rigid i;
    for (int a = 0; a < 3; a++) {
        for (int b = 0; b < 3; b++)
            i.r[3 * a + b] = m->r[3 * b + a];
        i.t[a] = -(m->r[a] * m->t[0] + m->r[3 + a] * m->t[1] + m->r[6 + a] * m->t[2]);
    }
    *out = i;
}

/** Sets the rotation from a quaternion. */
static void set_rotation(adcgs_rigid *m, const double q[4])
{
    double pose[12] = {0};
    adcgs_rotation_to_pose(q, pose);
    for (int a = 0; a < 3; a++)
        memcpy(m->r + 3 * a, pose + 4 * a, 3 * sizeof *pose);
}

/** Sets the translation such that `from` maps to `to` after the rotation. */
static void set_shift(adcgs_rigid *m, const double from[3], const double to[3])
{
    double there[3];
    adcgs_rigid_turn(m, from, there);
    for (int a = 0; a < 3; a++)
        m->t[a] = to[a] - there[a];
}

void adcgs_rigid_about(const double turn[3], const double centre[3], const double shift[3], adcgs_rigid *out)
{
    double q[4];
    adcgs_rotation_exp(turn, 0.5, q); /* the function takes half the angle */
    set_rotation(out, q);
    set_shift(out, centre, (const double[]){centre[0] + shift[0], centre[1] + shift[1], centre[2] + shift[2]});
}

void adcgs_symmetric_eigen(double *a, double *v, int n)
{
    for (int i = 0; i < n * n; i++)
        v[i] = i % (n + 1) == 0;
    for (int sweep = 0; sweep < SWEEPS; sweep++)
        for (int p = 0; p < n - 1; p++)
            for (int q = p + 1; q < n; q++) {
                const double off = a[p * n + q];
                if (fabs(off) < 1e-300)
                    continue;
                const double theta = (a[q * n + q] - a[p * n + p]) / (2 * off);
                const double t = (theta >= 0 ? 1 : -1) / (fabs(theta) + sqrt(theta * theta + 1));
                const double c = 1 / sqrt(t * t + 1), s = t * c;
                for (int k = 0; k < n; k++) {
                    const double x = a[k * n + p], y = a[k * n + q];
                    a[k * n + p] = c * x - s * y;
                    a[k * n + q] = s * x + c * y;
                }
                for (int k = 0; k < n; k++) {
                    const double x = a[p * n + k], y = a[q * n + k];
                    a[p * n + k] = c * x - s * y;
                    a[q * n + k] = s * x + c * y;
                }
                for (int k = 0; k < n; k++) {
                    const double x = v[k * n + p], y = v[k * n + q];
                    v[k * n + p] = c * x - s * y;
                    v[k * n + q] = s * x + c * y;
                }
            }
}

void adcgs_rigid_add(adcgs_rigid_sums *sums, const double from[3], const double to[3], double weight)
{
    sums->weight += weight;
    for (int a = 0; a < 3; a++) {
        sums->from[a] += weight * from[a];
        sums->to[a] += weight * to[a];
        for (int b = 0; b < 3; b++)
            sums->product[3 * a + b] += weight * from[a] * to[b];
    }
}

void adcgs_rigid_fit(const adcgs_rigid_sums *sums, adcgs_rigid *out)
{
    double from[3], to[3], s[9], v[16], q[4];
    *out = adcgs_rigid_none;
    if (!(sums->weight > 0))
        return;
    for (int a = 0; a < 3; a++) {
        from[a] = sums->from[a] / sums->weight;
        to[a] = sums->to[a] / sums->weight;
    }
    for (int i = 0; i < 9; i++)
        s[i] = sums->product[i] - sums->weight * from[i / 3] * to[i % 3];
    double n[16] = {s[0] + s[4] + s[8], s[5] - s[7], s[6] - s[2], s[1] - s[3],       s[5] - s[7],        s[0] - s[4] - s[8],
                    s[1] + s[3],        s[6] + s[2], s[6] - s[2], s[1] + s[3],       s[4] - s[0] - s[8], s[5] + s[7],
                    s[1] - s[3],        s[6] + s[2], s[5] + s[7], s[8] - s[0] - s[4]};
    adcgs_symmetric_eigen(n, v, 4);
    int best = 0;
    for (int i = 1; i < 4; i++)
        if (n[5 * i] > n[5 * best])
            best = i;
    for (int i = 0; i < 4; i++)
        q[i] = v[4 * i + best];
    set_rotation(out, q);
    set_shift(out, from, to);
}

int adcgs_solve_six(double a[36], double b[6])
{
    for (int i = 0; i < 6; i++)
        for (int j = 0; j <= i; j++) {
            double sum = a[6 * i + j];
            for (int k = 0; k < j; k++)
                sum -= a[6 * i + k] * a[6 * j + k];
            if (i == j && !(sum > 1e-300))
                return 0;
            a[6 * i + j] = i == j ? sqrt(sum) : sum / a[6 * j + j];
        }
    for (int i = 0; i < 6; i++) {
        for (int k = 0; k < i; k++)
            b[i] -= a[6 * i + k] * b[k];
        b[i] /= a[6 * i + i];
    }
    for (int i = 5; i >= 0; i--) {
        for (int k = i + 1; k < 6; k++)
            b[i] -= a[6 * k + i] * b[k];
        b[i] /= a[6 * i + i];
    }
    return 1;
}
