/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Transforming splats. A one-sided Jacobi method (Hestenes, 1958) finds the
 * axes of transformed ellipsoids.
 */
#include "config.h"

#include "media/splats/splats_move.h"

#include "geometry/quaternion_matrix.h"
#include "media/splats/harmonics.h"

#include <math.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define POLAR_STEPS 60         /* iterations of Newton's method, which converges quadratically */
#define EVEN 1e-6              /* relative deviation from a uniform scale that still counts as one */
#define SWEEPS 30              /* of Jacobi's method, at most */
#define SMALLEST 1.8048514e-35 /* e^-80: lower bound of scales, which flat splats get */
#define LARGEST 5.5406223e34   /* e^80: upper bound of scales */

typedef struct m3 {
    double m[3][3];
} m3;

static m3 multiply(const m3 *a, const m3 *b)
{
    m3 out = {{{0}}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++)
                out.m[i][j] += a->m[i][k] * b->m[k][j];
    return out;
}

/** The matrix of cofactors: the inverse's transpose times the determinant. \return the determinant */
static double cofactors(const m3 *a, m3 *out)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const int r = (i + 1) % 3, s = (i + 2) % 3, u = (j + 1) % 3, v = (j + 2) % 3;
            out->m[i][j] = a->m[r][u] * a->m[s][v] - a->m[r][v] * a->m[s][u];
        }
    return a->m[0][0] * out->m[0][0] + a->m[0][1] * out->m[0][1] + a->m[0][2] * out->m[0][2];
}

/** The nearest rotation or reflection; 0 if the matrix is singular. */
static int polar(const m3 *a, m3 *q)
{
    *q = *a;
    for (int step = 0; step < POLAR_STEPS; step++) {
        m3 other;
        const double det = cofactors(q, &other);
        if (!(fabs(det) > 1e-100) || !isfinite(det))
            return 0;
        for (int i = 0; i < 9; i++)
            q->m[i / 3][i % 3] = 0.5 * (q->m[i / 3][i % 3] + other.m[i / 3][i % 3] / det);
    }
    return 1;
}

/** w x y z of a rotation. */
static void quaternion_of(const m3 *r, double q[4])
{
    double m[9];
    for (int i = 0; i < 9; i++)
        m[i] = r->m[i / 3][i % 3];
    adcgs_quaternion_of(m, q);
}

static m3 rotation_of(const double q[4])
{
    double m[9];
    m3 r;
    adcgs_quaternion_matrix(q, m);
    memcpy(r.m, m, sizeof r.m);
    return r;
}

static double dot_columns(const m3 *b, int i, int j)
{
    return b->m[0][i] * b->m[0][j] + b->m[1][i] * b->m[1][j] + b->m[2][i] * b->m[2][j];
}

/** Rotate columns until they are orthogonal, which leaves B B^T unchanged: they become the axes of the ellipsoid. */
static void find_axes(m3 *b)
{
    for (int sweep = 0, turned = 1; sweep < SWEEPS && turned; sweep++) {
        turned = 0;
        for (int i = 0; i < 2; i++)
            for (int j = i + 1; j < 3; j++) {
                const double a = dot_columns(b, i, i), c = dot_columns(b, j, j), off = dot_columns(b, i, j);
                if (fabs(off) <= 1e-15 * sqrt(a * c))
                    continue;
                const double angle = 0.5 * atan2(2.0 * off, a - c), cosine = cos(angle), sine = sin(angle);
                for (int k = 0; k < 3; k++) {
                    const double x = b->m[k][i], y = b->m[k][j];
                    b->m[k][i] = cosine * x + sine * y;
                    b->m[k][j] = cosine * y - sine * x;
                }
                turned = 1;
            }
    }
}

/** A rotation whose first two columns are the longest axes, and the lengths of all axes. */
static void frame_of(const m3 *b, m3 *out, double lengths[3])
{
    int order[3] = {0, 1, 2};
    for (int i = 0; i < 2; i++)
        for (int j = i + 1; j < 3; j++)
            if (dot_columns(b, order[j], order[j]) > dot_columns(b, order[i], order[i])) {
                const int keep = order[i];
                order[i] = order[j];
                order[j] = keep;
            }
    for (int i = 0; i < 3; i++)
        lengths[i] = sqrt(dot_columns(b, order[i], order[i]));
    for (int c = 0; c < 2; c++)
        for (int i = 0; i < 3; i++)
            out->m[i][c] = lengths[c] > 0.0 ? b->m[i][order[c]] / lengths[c] : i == c;
    for (int i = 0; i < 3; i++) { /* the shortest axis completes a right-handed frame */
        const int u = (i + 1) % 3, v = (i + 2) % 3;
        out->m[i][2] = out->m[u][0] * out->m[v][1] - out->m[v][0] * out->m[u][1];
    }
}

/* ---- Harmonics ---- */

#define PER_MAX 7 /* maximum number of coefficients per degree; arithmetic, 2 * 3 + 1 */

/** Solve A x = b for n columns of b at once, both with n rows; A must be regular. */
static void solve(int n, double a[PER_MAX][PER_MAX], double b[PER_MAX][PER_MAX])
{
    for (int c = 0; c < n; c++) {
        int pivot = c;
        for (int r = c + 1; r < n; r++)
            pivot = fabs(a[r][c]) > fabs(a[pivot][c]) ? r : pivot;
        for (int k = 0; k < n; k++) {
            const double x = a[c][k], y = b[c][k];
            a[c][k] = a[pivot][k], a[pivot][k] = x;
            b[c][k] = b[pivot][k], b[pivot][k] = y;
        }
        for (int r = 0; r < n; r++) {
            const double times = r == c ? 0.0 : a[r][c] / a[c][c];
            for (int k = 0; k < n; k++) {
                a[r][k] -= times * a[c][k];
                b[r][k] -= times * b[c][k];
            }
        }
    }
    for (int r = 0; r < n; r++)
        for (int k = 0; k < n; k++)
            b[r][k] /= a[r][r];
}

/**
 * The matrix that rotates a degree's coefficients by q. In a direction d the new coefficients give the same value as the old ones
 * in q^T d. It is solved from as many directions as there are coefficients.
 */
static void turn_of(int degree, const m3 *q, double out[PER_MAX][PER_MAX])
{
    const int n = 2 * degree + 1, first = degree * degree - 1;
    double a[PER_MAX][PER_MAX];
    for (int i = 0; i < n; i++) {
        double values[ADCGS_HARMONICS_MAX], before[3];
        const double z = 0.95 - 1.7 * (i + 0.5) / n, r = sqrt(1.0 - z * z), turn = 2.399963 * i;
        const double d[3] = {r * cos(turn), r * sin(turn), z};
        for (int j = 0; j < 3; j++)
            before[j] = q->m[0][j] * d[0] + q->m[1][j] * d[1] + q->m[2][j] * d[2];
        adcgs_harmonics(values, d, degree);
        memcpy(a[i], values + first, (size_t)n * sizeof *values);
        adcgs_harmonics(values, before, degree);
        memcpy(out[i], values + first, (size_t)n * sizeof *values);
    }
    solve(n, a, out);
}

static void move_harmonics(adcgs_splats *s, const m3 *q)
{
    const int per = (s->degree + 1) * (s->degree + 1) - 1;
    for (int degree = 1; degree <= s->degree; degree++) {
        const int n = 2 * degree + 1, first = degree * degree - 1;
        double turn[PER_MAX][PER_MAX];
        turn_of(degree, q, turn);
        for (size_t i = 0; i < 3 * (size_t)s->n; i++) {
            float *const at = s->harmonics + i * (size_t)per + first;
            double moved[PER_MAX] = {0};
            for (int r = 0; r < n; r++)
                for (int c = 0; c < n; c++)
                    moved[r] += turn[r][c] * (double)at[c];
            for (int r = 0; r < n; r++)
                at[r] = (float)moved[r];
        }
    }
}

/* ---- Splats ---- */

/**
 * A transform: its matrix and linear part, the nearest rotation, and the uniform scale, or 0 if the linear part is not a rotation
 * and uniform scale.
 */
typedef struct motion {
    const double *matrix;
    m3 linear, rotation;
    double q[4], size;
} motion;

static int make_motion(motion *m, const double matrix[12])
{
    m3 turned, transposed;
    m->matrix = matrix;
    for (int i = 0; i < 9; i++)
        m->linear.m[i / 3][i % 3] = matrix[4 * (i / 3) + i % 3];
    if (!polar(&m->linear, &m->rotation))
        return 0;
    for (int i = 0; i < 9; i++)
        transposed.m[i % 3][i / 3] = m->rotation.m[i / 3][i % 3];
    turned = multiply(&transposed, &m->linear);
    m3 unused;
    m->size = (turned.m[0][0] + turned.m[1][1] + turned.m[2][2]) / 3.0;
    const double limit = EVEN * m->size;
    for (int i = 0; i < 9; i++)
        if (fabs(turned.m[i / 3][i % 3] - (i % 4 ? 0.0 : m->size)) > limit || cofactors(&m->rotation, &unused) < 0.0) {
            m->size = 0.0;
            return 1;
        }
    quaternion_of(&m->rotation, m->q);
    return 1;
}

static void rotate(const double a[4], const double b[4], double out[4])
{
    out[0] = a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3];
    for (int i = 1; i < 4; i++) {
        const int u = i % 3 + 1, v = (i + 1) % 3 + 1;
        out[i] = a[0] * b[i] + a[i] * b[0] + a[u] * b[v] - a[v] * b[u];
    }
}

/** \return true if all results are within range */
static int move_one(adcgs_splats *s, uint32_t i, const motion *m)
{
    double q[4], moved[4], sizes[3], place[3];
    int good = 1;
    for (int a = 0; a < 4; a++)
        q[a] = s->rotation[a][i];
    for (int a = 0; a < 3; a++) {
        const double *const row = m->matrix + 4 * a;
        place[a] = row[0] * s->mean[0][i] + row[1] * s->mean[1][i] + row[2] * s->mean[2][i] + row[3];
        sizes[a] = m->size * s->scale[a][i];
    }
    if (m->size > 0.0)
        rotate(m->q, q, moved);
    else {
        const m3 own = rotation_of(q);
        m3 b = multiply(&m->linear, &own), axes;
        for (int k = 0; k < 9; k++)
            b.m[k / 3][k % 3] *= s->scale[k % 3][i];
        find_axes(&b);
        frame_of(&b, &axes, sizes);
        quaternion_of(&axes, moved);
    }
    const double length = sqrt(moved[0] * moved[0] + moved[1] * moved[1] + moved[2] * moved[2] + moved[3] * moved[3]);
    for (int a = 0; a < 3; a++) {
        s->mean[a][i] = (float)place[a];
        s->scale[a][i] = (float)fmax(sizes[a], SMALLEST);
        good &= isfinite(s->mean[a][i]) && sizes[a] <= LARGEST;
    }
    for (int a = 0; a < 4; a++)
        s->rotation[a][i] = (float)(moved[a] / length);
    return good && length > 0.0;
}

adcgs_status adcgs_splats_move(adcgs_splats *splats, const double matrix[12], const char *path, adcgs_error *error)
{
    motion m;
    if (!make_motion(&m, matrix))
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: a singular matrix, which flattens the splats", path);
    for (uint32_t i = 0; i < splats->n; i++)
        if (!move_one(splats, i, &m))
            return adcgs_fail(error, ADCGS_ERR_DATA, "%s: splat %u is moved beyond the range of binary32", path, i);
    move_harmonics(splats, &m.rotation);
    return ADCGS_OK;
}
