/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Reads params.npz of Dynamic 3D Gaussians (Luiten et al., 2024): positions, colours and rotations of each frame, scales and
 * opacities of all. A splat is the same one in all frames. The file states no rate; between frames, the latest frame is shown.
 */
#include "config.h"

#include "media/arrays/npy.h"
#include "media/arrays/npz.h"
#include "media/arrays/zip_read.h"
#include "media/dynamic/activate.h"
#include "media/dynamic/dynamic_readers.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define NAME_BYTES 256 /* bytes of a name in messages; chosen by hand, not measured */

enum { MEANS, COLOURS, ROTATIONS, MOVING, SCALES = MOVING, OPACITIES, ARRAYS }; /* of the file; definition: indices of arrays[] */

static const struct {
    const char *name;
    uint32_t columns;
} arrays[ARRAYS] = {{"means3D", 3}, {"rgb_colors", 3}, {"unnorm_rotations", 4}, {"log_scales", 3}, {"logit_opacities", 1}};

typedef struct state {
    uint8_t *data[MOVING];
    adcgs_npy tables[MOVING]; /**< [frames * n] */
    adcgs_splats base;        /**< with the scales and opacities */
} state;

/** The first bytes of an archive have the names of its first arrays. */
static int is_d3dg(const uint8_t *data, size_t bytes)
{
    for (int i = MEANS; i < MOVING && adcgs_zip_is(data, bytes); i++) {
        const size_t n = strlen(arrays[i].name);
        for (size_t at = 0; at + n + 4 <= bytes; at++)
            if (data[at] == (uint8_t)*arrays[i].name && !memcmp(data + at, arrays[i].name, n) &&
                !memcmp(data + at + n, ".npy", 4))
                return 1;
    }
    return 0;
}

/** A number as binary32, which may not be finite. */
static float number(const adcgs_npy *table, size_t row, uint32_t column)
{
    return (float)adcgs_npy_value(table, row, column);
}

/** An array's NPY file, from malloc(), and its name for messages. */
static adcgs_status unpack(const adcgs_dynamic *m, int array, uint8_t **data, size_t *bytes, char name[NAME_BYTES],
                           adcgs_error *error)
{
    snprintf(name, NAME_BYTES, "%.200s: %s", m->path, arrays[array].name);
    return adcgs_npz_parse(data, bytes, m->data, m->bytes, m->path, arrays[array].name, error);
}

/* ---- Constant arrays ---- */

/** Scales or opacities before activation, into the splats. */
static adcgs_status take_constants(adcgs_dynamic *m, int array, float *const *to, adcgs_error *error)
{
    const state *const s = m->state;
    adcgs_npy table;
    char name[NAME_BYTES];
    uint8_t *data;
    size_t bytes;
    ADCGS_TRY(unpack(m, array, &data, &bytes, name, error));
    adcgs_status status = adcgs_npy_open(&table, data, bytes, arrays[array].columns, "splats", name, error);
    if (status == ADCGS_OK && table.rows != s->base.n)
        status = adcgs_fail(error, ADCGS_ERR_DATA, "%s: %llu splats, expected %u, as in means3D", name,
                            (unsigned long long)table.rows, s->base.n);
    for (uint32_t i = 0; i < s->base.n && status == ADCGS_OK; i++)
        for (uint32_t a = 0; a < arrays[array].columns; a++) {
            to[a][i] = number(&table, i, a);
            if (isnan(to[a][i]))
                status = adcgs_fail(error, ADCGS_ERR_DATA, "%s: splat %u is not a number", name, i);
        }
    free(data);
    return status;
}

static adcgs_status read_constants(adcgs_dynamic *m, adcgs_error *error)
{
    state *const s = m->state;
    ADCGS_TRY(take_constants(m, SCALES, s->base.scale, error));
    ADCGS_TRY(take_constants(m, OPACITIES, &s->base.opacity, error));
    adcgs_splats_activate(&s->base);
    for (uint32_t i = 0; i < s->base.n; i++)
        for (int a = 0; a < 3; a++)
            if (!isfinite(s->base.scale[a][i]))
                return adcgs_fail(error, ADCGS_ERR_DATA, "%s: log_scales of splat %u is too large for a scale", m->path, i);
    return ADCGS_OK;
}

/* ---- Arrays of all frames ---- */

static adcgs_status open_frames(adcgs_dynamic *m, int array, uint64_t *frames, adcgs_error *error)
{
    state *const s = m->state;
    char name[NAME_BYTES];
    size_t bytes;
    ADCGS_TRY(unpack(m, array, &s->data[array], &bytes, name, error));
    return adcgs_npy_open_frames(&s->tables[array], frames, s->data[array], bytes, arrays[array].columns, name, error);
}

/** All numbers are finite, and rotations have a length. */
static adcgs_status check_frames(const adcgs_dynamic *m, adcgs_error *error)
{
    const state *const s = m->state;
    for (int array = MEANS; array < MOVING; array++)
        for (size_t row = 0; row < s->tables[array].rows; row++) {
            double square = 0.0;
            for (uint32_t a = 0; a < arrays[array].columns; a++) {
                const double value = (double)number(&s->tables[array], row, a);
                square += value * value;
            }
            if (!isfinite(square) || (array == ROTATIONS && !(square > 0.0)))
                return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %s of splat %zu in frame %zu is not finite%s", m->path,
                                  arrays[array].name, row % m->n, row / m->n, array == ROTATIONS ? ", or zero" : "");
        }
    return ADCGS_OK;
}

static adcgs_status open_d3dg(adcgs_dynamic *m, adcgs_error *error)
{
    state *const s = m->state = calloc(1, sizeof *s);
    uint64_t frames[MOVING];
    if (!s)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", m->path);
    for (int array = MEANS; array < MOVING; array++) {
        ADCGS_TRY(open_frames(m, array, &frames[array], error));
        if (frames[array] != *frames || s->tables[array].rows != s->tables->rows)
            return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %s has %llu frames and %llu rows, expected %llu and %llu", m->path,
                              arrays[array].name, (unsigned long long)frames[array], (unsigned long long)s->tables[array].rows,
                              (unsigned long long)*frames, (unsigned long long)s->tables->rows);
    }
    if (!s->tables->rows || *frames > ADCGS_DYNAMIC_FRAMES_MAX)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %llu frames with %llu rows, expected 1 to %d frames with splats", m->path,
                          (unsigned long long)*frames, (unsigned long long)s->tables->rows, ADCGS_DYNAMIC_FRAMES_MAX);
    ADCGS_TRY(adcgs_splats_alloc(&s->base, s->tables->rows / *frames, m->path, error));
    adcgs_dynamic_set_clock(m, (adcgs_fps){0, 0}, 0);
    m->frames = (uint32_t)*frames; /* also if the options state a number, which is for formats with a time from 0 to 1 */
    m->n = s->base.n;
    m->has_identity = 1;
    ADCGS_TRY(read_constants(m, error));
    return check_frames(m, error);
}

static adcgs_status state_at(const adcgs_dynamic *m, double seconds, adcgs_splats *out, adcgs_error *error)
{
    const state *const s = m->state;
    const size_t first = (size_t)adcgs_dynamic_frame(m, seconds) * m->n;
    ADCGS_TRY(adcgs_splats_copy(out, &s->base, m->path, error));
    for (uint32_t i = 0; i < out->n; i++) {
        double q[4], square = 0.0;
        for (uint32_t a = 0; a < 4; a++) {
            q[a] = (double)number(&s->tables[ROTATIONS], first + i, a);
            square += q[a] * q[a];
        }
        for (int a = 0; a < 4; a++)
            out->rotation[a][i] = (float)(q[a] / sqrt(square));
        for (uint32_t a = 0; a < 3; a++) {
            out->mean[a][i] = number(&s->tables[MEANS], first + i, a);
            out->colour[a][i] = number(&s->tables[COLOURS], first + i, a);
        }
    }
    return ADCGS_OK;
}

static void close_d3dg(adcgs_dynamic *m)
{
    state *const s = m->state;
    for (int array = MEANS; s && array < MOVING; array++)
        free(s->data[array]);
    if (s)
        adcgs_splats_free(&s->base);
    free(s);
    m->state = NULL;
}

const adcgs_dynamic_reader adcgs_dynamic_d3dg = {"Dynamic 3D Gaussians' params.npz", is_d3dg, 0, open_d3dg, state_at, close_d3dg};
