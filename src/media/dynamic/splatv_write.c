/* SPDX-License-Identifier: BSD-2-Clause */
/**
 * \file Writes .splatv (media/dynamic/splatv.c reads it): time runs from 0 to 1, and frame i is at i / frames, in a file without
 * motion at i / (frames - 1).
 */
#include "config.h"

#include "media/dynamic/splat_paths.h"
#include "media/splats/half.h"
#include "system/atomic.h"

#include <math.h>
#include <stdlib.h>

/* Origin, unless a line states one: definition (splaTV). */
#define MAGIC 0x674bu    /* first word of a file */
#define SPLAT 64         /* bytes of a splat */
#define WIDTH 4096       /* texels of a row of the texture */
#define ROW (WIDTH / 4)  /* splats of a row of the texture */
#define HALF_MAX 65504.0 /* largest finite binary16; IEEE 754 */
#define HALF_TINY 6.2e-5 /* normal binary16 are above it; IEEE 754, 2^-14 */
#define CAMERA_BYTES 512 /* of the JSON text of a camera, at most; arithmetic: 14 numbers of up to 24 bytes, keys */

/** Places of values in a splat, in bytes; definition (splaTV). */
enum { ROTATION = 12, SCALE = 20, COLOUR = 28, MOTION = 32, TURN = 52, CENTRE = 60, SIGMA = 62 };

static uint8_t byte_of(float v)
{
    return (uint8_t)(255.0 * fmin(fmax((double)v, 0.0), 1.0) + 0.5);
}

/** unit: frames from time 0 to 1. */
static void put_splat(uint8_t *to, const adcgs_piece *p, double unit)
{
    for (int a = 0; a < 3; a++) {
        adcgs_store_le32(to + 4 * a, adcgs_float_bits(p->mean[a]));
        adcgs_store_half(to + SCALE + 2 * a, fmin(fmax((double)p->scale[a], HALF_TINY), HALF_MAX));
        to[COLOUR + a] = byte_of(p->colour[a]);
    }
    to[COLOUR + 3] = byte_of(p->opacity);
    for (int a = 0; a < 4; a++) {
        adcgs_store_half(to + ROTATION + 2 * a, (double)p->rotation[a]);
        adcgs_store_half(to + TURN + 2 * a, (double)p->turn[a] * unit);
    }
    for (int j = 0; j < ADCGS_PIECE_ORDERS; j++)
        for (int a = 0; a < 3; a++)
            adcgs_store_half(to + MOTION + 2 * (3 * j + a), (double)p->motion[j][a] * pow(unit, j + 1));
    adcgs_store_half(to + CENTRE, (double)p->centre / unit);
    /* exp(-(dt/s)^2), without the half of a Gaussian */
    adcgs_store_half(to + SIGMA, p->sigma < ADCGS_PIECE_FOREVER ? fmin(sqrt(2.0) * (double)p->sigma / unit, HALF_MAX) : HALF_MAX);
}

static int moves(const uint8_t *splat)
{
    for (int i = MOTION; i < CENTRE; i++)
        if (splat[i] && splat[i] != 0x80)
            return 1;
    return 0;
}

/** The JSON text; *bytes: its length. The caller frees it. */
static char *make_text(const adcgs_pieces *p, const adcgs_camera *c, int n, size_t rows, size_t *bytes)
{
    const size_t size = 256 + (size_t)n * CAMERA_BYTES;
    char *const text = malloc(size);
    size_t at = 0;
    if (!text)
        return NULL;
    at += (size_t)snprintf(text, size, "[{\"type\":\"splat\",\"size\":%zu,\"texwidth\":%d,\"texheight\":%zu,\"cameras\":[",
                           rows * ROW * SPLAT, WIDTH, rows);
    for (int i = 0; i < n; i++, c++) {
        const double *const m = c->cam_to_world;
        at += (size_t)snprintf(text + at, size - at,
                               "%s{\"id\":%d,\"img_name\":\"%05d\",\"width\":%d,\"height\":%d,\"position\":[%.9g,%.9g,%.9g],"
                               "\"rotation\":[[%.9g,%.9g,%.9g],[%.9g,%.9g,%.9g],[%.9g,%.9g,%.9g]],\"fx\":%.9g,\"fy\":%.9g}",
                               i ? "," : "", i, i, c->width, c->height, m[3] - p->offset[0], m[7] - p->offset[1],
                               m[11] - p->offset[2], m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10], c->fx, c->fy);
    }
    *bytes = at + (size_t)snprintf(text + at, size - at, "]}]");
    return text;
}

static void put_all(uint8_t *block, const adcgs_pieces *p, double unit)
{
    for (uint32_t i = 0; i < p->n; i++)
        put_splat(block + (size_t)SPLAT * i, &p->piece[i], unit);
}

static int any_moves(const uint8_t *block, uint32_t n)
{
    uint32_t i = 0;
    while (i < n && !moves(block + (size_t)SPLAT * i))
        i++;
    return i < n;
}

static adcgs_status save(const char *text, size_t length, const uint8_t *block, size_t bytes, const char *path,
                         adcgs_error *error)
{
    adcgs_atomic atomic;
    uint8_t header[8];
    ADCGS_TRY(adcgs_atomic_open(&atomic, path, error));
    adcgs_store_le32(header, MAGIC);
    adcgs_store_le32(header + 4, (uint32_t)length);
    fwrite(header, sizeof header, 1, atomic.file);
    fwrite(text, 1, length, atomic.file);
    fwrite(block, 1, bytes, atomic.file);
    return adcgs_atomic_commit(&atomic, error);
}

adcgs_status adcgs_splatv_write(const adcgs_pieces *pieces, const adcgs_camera *cameras, int n, const char *path,
                                adcgs_error *error)
{
    const size_t rows = ((size_t)pieces->n + ROW - 1) / ROW, bytes = rows * ROW * SPLAT;
    size_t length = 0;
    uint8_t *const block = calloc(1, bytes + 1);
    char *const text = make_text(pieces, cameras, n, rows, &length);
    adcgs_status status;
    if (block && text) {
        put_all(block, pieces, pieces->clip);
        if (!any_moves(block, pieces->n)) /* a file without motion has another clock */
            put_all(block, pieces, ADCGS_MAX(pieces->clip - 1.0, 1.0));
        status = save(text, length, block, bytes, path, error);
    } else
        status = adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %u splats", path, pieces->n);
    free(block);
    free(text);
    return status;
}
