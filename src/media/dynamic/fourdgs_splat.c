/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats of a .4dgs file: steps times bins. Those of the motion and of the centre in time differ from splat to splat. */
#include "config.h"

#include "media/dynamic/fourdgs_splat.h"

#include "media/splats/offset.h"

#include <math.h>
#include <stdlib.h>

/* Origin, unless a line states one: definition (.4dgs, sections 6.3 and 6.5). */
#define SPAN_MIN 0.02               /* seconds: shortest visible half of a lifetime that a velocity's step considers */
#define SPAN_MAX 2.0                /* seconds: longest one */
#define SPAN_UNIT 0.5               /* seconds: lifetime of a step of 1 */
#define SPAN_FINEST -4              /* power of two of the shortest lifetime */
#define SPAN_COARSEST 2             /* power of two of the longest one */
#define CENTRE_SHARE 0.05           /* of sigma: largest step of a centre */
#define CENTRE_FINEST -10           /* power of two of the smallest step of a centre, in the file's steps */
#define HARMONIC_MIN -4.0           /* coefficient of the byte 0 */
#define HARMONIC_STEP (8.0 / 255.0) /* coefficient of 1 in a byte */
#define NEVER_FADES 1               /* flag of a splat */
#define EDGE 5e-7                   /* seconds: a window opens and ends this much earlier; chosen by hand, not measured */

adcgs_status adcgs_fourdgs_motion(adcgs_motion *m, const adcgs_fourdgs *f, uint64_t n, adcgs_error *error)
{
    const double extent = 0.5 * fmax(f->box[3] - f->box[0], fmax(f->box[4] - f->box[1], f->box[5] - f->box[2]));
    ADCGS_TRY(adcgs_motion_alloc(m, n, 1, ADCGS_MOTION_WINDOWS, f->path, error));
    m->cutoff = (float)f->cutoff;
    if (isfinite(extent) && extent > 0.0)
        adcgs_offset_of(m->base.offset, f->origin, extent);
    if (!f->degree)
        return ADCGS_OK;
    m->base.degree = f->degree;
    m->base.harmonics = calloc(n * 3 * adcgs_fourdgs_coefficients(f->degree) + !n, sizeof *m->base.harmonics);
    return m->base.harmonics
               ? ADCGS_OK
               : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %llu splats", f->path, (unsigned long long)n);
}

/**
 * Windows in binary32 are rounded down: a splat must be visible in the frame that begins with its window. Equal times stay equal,
 * so that windows neither overlap nor leave gaps.
 */
static float edge_of(double seconds)
{
    const float edge = (float)(seconds - EDGE);
    return (double)edge > seconds - EDGE ? nextafterf(edge, -INFINITY) : edge;
}

static void set_time(adcgs_motion *m, uint32_t i, const adcgs_fourdgs *f, const int32_t *row, const adcgs_fourdgs_window *w)
{
    const int is_constant = row[ADCGS_FOURDGS_ROW_FLAGS] & NEVER_FADES;
    const double sigma = exp(row[ADCGS_FOURDGS_ROW_SIGMA] * f->step_sigma);
    const double visible = is_constant ? w->end - w->begin : sqrt(-2.0 * log(f->cutoff)) * sigma;
    const double span = fmin(fmax(visible, SPAN_MIN), SPAN_MAX);
    const double slow = fmin(fmax(ceil(log2(span / SPAN_UNIT)), SPAN_FINEST), SPAN_COARSEST);
    const double target = is_constant ? f->step_time : fmin(f->step_time, CENTRE_SHARE * sigma);
    const double fine = fmin(fmax(floor(log2(target / f->step_time)), CENTRE_FINEST), 0.0);
    for (int a = 0; a < 3; a++)
        m->motion[0][a][i] = (float)(row[ADCGS_FOURDGS_ROW_MOTION + a] * f->step_motion * exp2(-slow));
    m->centre[i] = (float)(row[ADCGS_FOURDGS_ROW_CENTRE] * f->step_time * exp2(fine));
    m->sigma[i] = is_constant ? INFINITY : (float)sigma;
}

/** The omitted component is not negative. \return false for an index that no component has */
static int set_rotation(adcgs_splats *s, uint32_t i, const adcgs_fourdgs *f, const int32_t *row)
{
    const int omitted = row[ADCGS_FOURDGS_ROW_OMITTED];
    double q[4], square = 0.0;
    if (omitted < 0 || omitted > 3)
        return 0;
    for (int a = 0, k = 0; a < 4; a++)
        if (a != omitted) {
            q[a] = row[ADCGS_FOURDGS_ROW_ROTATION + k++] * f->step_rotation;
            square += q[a] * q[a];
        }
    q[omitted] = sqrt(fmax(0.0, 1.0 - square));
    const double length = sqrt(square + q[omitted] * q[omitted]); /* at least 1, except for rounding */
    for (int a = 0; a < 4; a++)
        s->rotation[(a + 1) % 4][i] = (float)(q[a] / length); /* from x y z w */
    return 1;
}

/** \return false if a value is not finite, or a scale not positive */
static int set_shape(adcgs_splats *s, uint32_t i, const adcgs_fourdgs *f, const int32_t *row)
{
    const int32_t *const colour = row + ADCGS_FOURDGS_ROW_COLOUR;
    int good = 1;
    for (int a = 0; a < 3; a++) {
        const double bin =
            a == 1 ? (double)colour[0] : (double)colour[0] + colour[a ? 2 : 1]; /* green; red and blue less green */
        s->mean[a][i] = (float)(f->origin[a] - s->offset[a] + row[ADCGS_FOURDGS_ROW_POSITION + a] * f->step_position);
        s->scale[a][i] = (float)exp(row[ADCGS_FOURDGS_ROW_SCALE + a] * f->step_scale);
        s->colour[a][i] = (float)fmin(fmax(bin * f->step_colour, 0.0), 1.0); /* the largest bin is above 1 */
        good &= isfinite(s->mean[a][i]) && isnormal(s->scale[a][i]);
    }
    s->opacity[i] = (float)fmin(fmax(row[ADCGS_FOURDGS_ROW_OPACITY] * f->step_opacity, 0.0), 1.0);
    return good;
}

static void set_harmonics(adcgs_splats *s, uint32_t i, const uint8_t *bytes)
{
    const size_t n = 3 * adcgs_fourdgs_coefficients(s->degree);
    for (size_t k = 0; k < n; k++)
        s->harmonics[(size_t)i * n + k] = (float)(HARMONIC_MIN + bytes[k] * HARMONIC_STEP);
}

adcgs_status adcgs_fourdgs_set(adcgs_motion *m, uint32_t i, const adcgs_fourdgs *f, const int32_t row[ADCGS_FOURDGS_ROW],
                               const uint8_t *harmonics, const adcgs_fourdgs_window *chunk, adcgs_error *error)
{
    static const adcgs_fourdgs_window none = {0.0, 0.0}; /* a file without windows has one that is empty */
    const int32_t window = row[ADCGS_FOURDGS_ROW_WINDOW];
    const uint32_t n = f->n_windows ? f->n_windows : 1;
    if (window < 0 || (uint32_t)window >= n)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: splat %u is in window %d of %u", f->path, i, window, n);
    const adcgs_fourdgs_window *const w = f->n_windows ? &f->windows[window] : &none;
    if (!set_rotation(&m->base, i, f, row))
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: splat %u omits component %d of its rotation, expected 0 to 3",
                          f->path, i, row[ADCGS_FOURDGS_ROW_OMITTED]);
    set_time(m, i, f, row, w);
    if (!set_shape(&m->base, i, f, row) || !(m->sigma[i] > 0.0f) || !isfinite(m->centre[i]) || !isfinite(m->motion[0][0][i]) ||
        !isfinite(m->motion[0][1][i]) || !isfinite(m->motion[0][2][i]))
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: splat %u has a value beyond the range of numbers", f->path, i);
    m->begin[i] = edge_of(fmax(w->begin, chunk->begin));
    m->end[i] = edge_of(fmin(w->end, chunk->end));
    if (m->base.degree)
        set_harmonics(&m->base, i, harmonics);
    return ADCGS_OK;
}
