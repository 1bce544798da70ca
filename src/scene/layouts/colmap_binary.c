/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Binary files of a sparse model: little-endian numbers without gaps, after a count of elements. No count is trusted before the
 * file's size is known to be sufficient.
 */
#include "config.h"

#include "scene/layouts/colmap_model.h"

/* Bytes of records, by definition of COLMAP ("Output Format" of its documentation, reconstruction_io of its source). */
#define CAMERA_BYTES 24  /* id, kind, width, height; then its parameters */
#define IMAGE_BYTES 64   /* id, rotation, translation, camera; then its name */
#define FEATURE_BYTES 24 /* of an image: x, y, point */
#define POINT_BYTES 51   /* id, position, colour, error, length of the track */
#define TRACK_BYTES 8    /* image, feature */

typedef struct cursor {
    const uint8_t *at, *end;
} cursor;

static size_t left(const cursor *c)
{
    return (size_t)(c->end - c->at);
}

static uint64_t take64(cursor *c)
{
    c->at += 8;
    return adcgs_load_le64(c->at - 8);
}

static uint32_t take32(cursor *c)
{
    c->at += 4;
    return adcgs_load_le32(c->at - 4);
}

static void take_numbers(cursor *c, double *values, int n)
{
    for (int i = 0; i < n; i++)
        values[i] = adcgs_bits_double(take64(c));
}

static adcgs_status ends_early(const adcgs_colmap *model)
{
    return adcgs_colmap_bad(model, ADCGS_ERR_DATA, "the file ends early");
}

/** Reads the count at the beginning; each element takes at least `least` bytes. */
static adcgs_status begin(adcgs_colmap *model, cursor *c, const uint8_t *data, size_t bytes, size_t least, uint64_t *n)
{
    *c = (cursor){data, data + bytes};
    if (bytes < 8)
        return adcgs_fail(model->error, ADCGS_ERR_DATA, "%s: %zu bytes, too few for a COLMAP file", model->path, bytes);
    *n = take64(c);
    if (*n > left(c) / least)
        return adcgs_fail(model->error, ADCGS_ERR_DATA, "%s: counts %llu %ss, but %zu bytes hold at most %zu", model->path,
                          (unsigned long long)*n, model->unit, bytes, left(c) / least);
    return ADCGS_OK;
}

static adcgs_status finish(const adcgs_colmap *model, const cursor *c)
{
    if (left(c))
        return adcgs_fail(model->error, ADCGS_ERR_DATA, "%s: %zu bytes after the last %s", model->path, left(c), model->unit);
    return ADCGS_OK;
}

adcgs_status adcgs_colmap_binary_cameras(adcgs_colmap *model, uint8_t *data, size_t bytes)
{
    cursor c;
    uint64_t n;
    model->unit = "camera";
    ADCGS_TRY(begin(model, &c, data, bytes, CAMERA_BYTES, &n));
    for (model->index = 0; model->index < n; model->index++) {
        double params[ADCGS_COLMAP_PARAMS_MAX];
        int n_params;
        if (left(&c) < CAMERA_BYTES)
            return ends_early(model);
        const uint32_t id = take32(&c), number = take32(&c);
        const uint64_t width = take64(&c), height = take64(&c);
        const int kind = adcgs_colmap_kind(NULL, number);
        if (kind < 0)
            return adcgs_colmap_bad(model, ADCGS_ERR_UNSUPPORTED, "unknown camera model %u", number);
        ADCGS_TRY(adcgs_colmap_params(model, kind, &n_params));
        if (left(&c) < 8 * (size_t)n_params)
            return ends_early(model);
        take_numbers(&c, params, n_params);
        ADCGS_TRY(adcgs_colmap_add_camera(model, id, kind, width, height, params));
    }
    return finish(model, &c);
}

adcgs_status adcgs_colmap_binary_images(adcgs_colmap *model, uint8_t *data, size_t bytes)
{
    cursor c;
    uint64_t n;
    model->unit = "image";
    ADCGS_TRY(begin(model, &c, data, bytes, IMAGE_BYTES + 9, &n));
    for (model->index = 0; model->index < n; model->index++) {
        double q[4], t[3];
        if (left(&c) < IMAGE_BYTES)
            return ends_early(model);
        const uint32_t id = take32(&c);
        take_numbers(&c, q, 4);
        take_numbers(&c, t, 3);
        const uint32_t camera = take32(&c);
        const char *name = (const char *)c.at;
        const uint8_t *zero = memchr(c.at, 0, left(&c));
        if (!zero || c.end - zero < 9)
            return ends_early(model);
        c.at = zero + 1;
        const uint64_t features = take64(&c);
        if (features > left(&c) / FEATURE_BYTES)
            return ends_early(model);
        c.at += features * FEATURE_BYTES;
        ADCGS_TRY(adcgs_colmap_add_image(model, id, q, t, camera, name));
    }
    return finish(model, &c);
}

adcgs_status adcgs_colmap_binary_points(adcgs_colmap *model, uint8_t *data, size_t bytes)
{
    cursor c;
    uint64_t n;
    model->unit = "point";
    ADCGS_TRY(begin(model, &c, data, bytes, POINT_BYTES, &n));
    ADCGS_TRY(adcgs_points_alloc(&model->points, n, model->path, model->error));
    model->points.n = 0;
    model->points.coloured = 1;
    for (model->index = 0; model->index < n; model->index++) {
        adcgs_colmap_track track = {.seen = 0};
        double position[3];
        if (left(&c) < POINT_BYTES)
            return ends_early(model);
        take64(&c); /* the point's id, which is not needed */
        take_numbers(&c, position, 3);
        const uint64_t colour[3] = {c.at[0], c.at[1], c.at[2]};
        c.at += 3;
        take_numbers(&c, &track.deviation, 1);
        track.seen = take64(&c);
        if (track.seen > left(&c) / TRACK_BYTES)
            return ends_early(model);
        for (uint64_t i = 0; i < track.seen; i++) {
            adcgs_colmap_add_seen(model, position, take32(&c), &track);
            c.at += 4;
        }
        ADCGS_TRY(adcgs_colmap_add_point(model, position, colour, &track));
    }
    return finish(model, &c);
}
