/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats that move along polynomials. */
#include "config.h"

#include "media/dynamic/motion.h"

#include <math.h>
#include <stdlib.h>

adcgs_status adcgs_motion_take(adcgs_motion *m, adcgs_splats *base, int orders, int flags, const char *path, adcgs_error *error)
{
    const size_t rows = base->n;
    const size_t arrays = 2 + 3 * (size_t)orders + (flags & ADCGS_MOTION_TURNS ? 4 : 0) + (flags & ADCGS_MOTION_WINDOWS ? 2 : 0);
    float *at = calloc(arrays * rows + !rows, sizeof *m->block);
    *m = (adcgs_motion){.base = *base, .block = at};
    *base = (adcgs_splats){0};
    if (!at) {
        adcgs_motion_free(m);
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %zu splats", path, rows);
    }
    m->centre = at, at += rows;
    m->sigma = at, at += rows;
    for (int j = 0; j < orders; j++)
        for (int a = 0; a < 3; a++, at += rows)
            m->motion[j][a] = at;
    for (int a = 0; a < 4 && flags & ADCGS_MOTION_TURNS; a++, at += rows)
        m->turn[a] = at;
    if (flags & ADCGS_MOTION_WINDOWS)
        m->begin = at, m->end = at + rows;
    for (size_t i = 0; i < rows; i++) {
        m->sigma[i] = INFINITY;
        if (m->begin)
            m->begin[i] = -INFINITY, m->end[i] = INFINITY;
    }
    return ADCGS_OK;
}

adcgs_status adcgs_motion_alloc(adcgs_motion *m, uint64_t n, int orders, int flags, const char *path, adcgs_error *error)
{
    adcgs_splats base;
    *m = (adcgs_motion){0};
    ADCGS_TRY(adcgs_splats_alloc(&base, n, path, error));
    return adcgs_motion_take(m, &base, orders, flags, path, error);
}

void adcgs_motion_free(adcgs_motion *m)
{
    adcgs_splats_free(&m->base);
    free(m->block);
    *m = (adcgs_motion){0};
}

void adcgs_motion_stretch(adcgs_motion *m, double seconds)
{
    for (uint32_t i = 0; i < m->base.n; i++) {
        m->centre[i] = (float)((double)m->centre[i] * seconds);
        m->sigma[i] = (float)((double)m->sigma[i] * seconds);
        for (int j = 0; j < ADCGS_MOTION_ORDERS; j++)
            for (int a = 0; a < 3 && m->motion[j][a]; a++)
                m->motion[j][a][i] = (float)((double)m->motion[j][a][i] / pow(seconds, j + 1));
        for (int a = 0; a < 4 && m->turn[a]; a++)
            m->turn[a][i] = (float)((double)m->turn[a][i] / seconds);
        if (m->begin) {
            m->begin[i] = (float)((double)m->begin[i] * seconds);
            m->end[i] = (float)((double)m->end[i] * seconds);
        }
    }
}

/* ---- Checks ---- */

static int all_finite(float *const *arrays, int n, uint32_t i)
{
    for (int a = 0; a < n; a++)
        if (arrays[a] && !isfinite(arrays[a][i]))
            return 0;
    return 1;
}

/** The property of a row that is not usable; NULL if all are. */
static const char *fault_of(const adcgs_motion *m, uint32_t i)
{
    const adcgs_splats *const b = &m->base;
    if (!all_finite(b->mean, 3, i))
        return "a position that is not finite";
    for (int a = 0; a < 3; a++)
        if (!(b->scale[a][i] > 0.0f) || !isfinite(b->scale[a][i]))
            return "a scale that is not finite and positive";
    double square = 0.0;
    for (int a = 0; a < 4; a++)
        square += (double)b->rotation[a][i] * (double)b->rotation[a][i];
    if (!(square > 0.0) || !isfinite(square))
        return "a rotation of length 0, or one that is not finite";
    if (!(b->opacity[i] >= 0.0f && b->opacity[i] <= 1.0f) || !all_finite(b->colour, 3, i))
        return "an opacity or a colour that is not finite";
    if (!isfinite(m->centre[i]) || !(m->sigma[i] > 0.0f))
        return "a time that is not finite, or a duration that is not positive";
    for (int j = 0; j < ADCGS_MOTION_ORDERS; j++)
        if (!all_finite(m->motion[j], 3, i))
            return "a motion that is not finite";
    if (!all_finite(m->turn, 4, i))
        return "a turn that is not finite";
    return m->begin && (isnan(m->begin[i]) || isnan(m->end[i])) ? "a window that is not a number" : NULL;
}

adcgs_status adcgs_motion_check(const adcgs_motion *m, const char *path, adcgs_error *error)
{
    for (uint32_t i = 0; i < m->base.n; i++) {
        const char *const fault = fault_of(m, i);
        if (fault)
            return adcgs_fail(error, ADCGS_ERR_DATA, "%s: splat %u has %s", path, i, fault);
    }
    const size_t values =
        m->base.harmonics ? (size_t)m->base.n * 3 * (size_t)((m->base.degree + 1) * (m->base.degree + 1) - 1) : 0;
    for (size_t i = 0; i < values; i++)
        if (!isfinite(m->base.harmonics[i]))
            return adcgs_fail(error, ADCGS_ERR_DATA, "%s: splat %zu has a harmonic that is not finite", path,
                              i / (values / m->base.n));
    return ADCGS_OK;
}

/* ---- Evaluation ---- */

static double share_at(const adcgs_motion *m, uint32_t i, double t)
{
    if (m->begin && !(t >= (double)m->begin[i] && t < (double)m->end[i]))
        return 0.0;
    const double u = (t - (double)m->centre[i]) / (double)m->sigma[i], share = exp(-0.5 * u * u);
    return share < (double)m->cutoff ? 0.0 : share;
}

/** \return false if the position leaves binary32 */
static int move(adcgs_splats *out, const adcgs_motion *m, uint32_t i, double dt)
{
    int finite = 1;
    for (int a = 0; a < 3; a++) {
        double sum = 0.0;
        for (int j = ADCGS_MOTION_ORDERS - 1; j >= 0; j--)
            sum = dt * (sum + (m->motion[j][a] ? (double)m->motion[j][a][i] : 0.0));
        out->mean[a][i] = (float)((double)m->base.mean[a][i] + sum);
        finite &= isfinite(out->mean[a][i]);
    }
    return finite;
}

/** A turn that cancels the rotation leaves that of the centre. */
static void rotate(adcgs_splats *out, const adcgs_motion *m, uint32_t i, double dt)
{
    double q[4], length = 0.0;
    for (int pass = m->turn[0] ? 0 : 1; pass < 2; pass++) {
        double square = 0.0;
        for (int a = 0; a < 4; a++) {
            q[a] = (double)m->base.rotation[a][i] + (pass ? 0.0 : (double)m->turn[a][i] * dt);
            square += q[a] * q[a];
        }
        length = sqrt(square);
        if (length > 0.0 && isfinite(length))
            break;
    }
    for (int a = 0; a < 4; a++)
        out->rotation[a][i] = (float)(q[a] / length);
}

adcgs_status adcgs_motion_at(const adcgs_motion *m, double seconds, adcgs_splats *out, const char *path, adcgs_error *error)
{
    ADCGS_TRY(adcgs_splats_copy(out, &m->base, path, error));
    for (uint32_t i = 0; i < out->n; i++) {
        const double dt = seconds - (double)m->centre[i];
        out->opacity[i] = (float)((double)m->base.opacity[i] * share_at(m, i, seconds));
        rotate(out, m, i, dt);
        if (move(out, m, i, dt))
            continue;
        out->opacity[i] = 0.0f;
        for (int a = 0; a < 3; a++)
            out->mean[a][i] = m->base.mean[a][i];
    }
    return ADCGS_OK;
}
