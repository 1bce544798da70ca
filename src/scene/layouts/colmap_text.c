/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Text files of a sparse model: one line per element, two for an image; lines that begin with # are comments. */
#include "config.h"

#include "scene/layouts/colmap_model.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>

/* Bytes of a list of points that are examined; no line of an image is as long; chosen by hand, not measured. */
#define LIST_CHECKED 4096

typedef struct cursor {
    char *at;   /**< in the current line, which ends with a zero byte */
    char *next; /**< the line after it */
    char *end;
    int is_held; /**< the line is still to be read as an entry */
} cursor;

static void begin(adcgs_colmap *model, cursor *c, uint8_t *data, size_t bytes)
{
    model->unit = "line";
    model->index = 0;
    *c = (cursor){.next = (char *)data, .end = (char *)data + bytes};
}

/** Moves to the next line of any content; returns 0 at the end. Accepts line ends of Unix, Windows and old Macs. */
static int next_line(adcgs_colmap *model, cursor *c)
{
    if (c->next >= c->end)
        return 0;
    c->at = c->next;
    char *feed = memchr(c->at, '\n', (size_t)(c->end - c->at)), *stop = feed ? feed : c->end;
    size_t n = (size_t)(stop - c->at);
    while (n && c->at[n - 1] == '\r')
        n--;
    char *inner = memchr(c->at, '\r', n);
    stop = inner ? inner : stop;
    c->next = stop + 1;
    while (stop > c->at && (stop[-1] == '\r' || stop[-1] == ' ' || stop[-1] == '\t'))
        stop--;
    *stop = 0;
    model->index++;
    return 1;
}

static void skip_blanks(cursor *c)
{
    while (*c->at == ' ' || *c->at == '\t')
        c->at++;
}

/** Moves to the next line that is neither empty nor a comment. */
static int next_entry(adcgs_colmap *model, cursor *c)
{
    if (c->is_held) {
        c->is_held = 0;
        return 1;
    }
    while (next_line(model, c)) {
        skip_blanks(c);
        if (*c->at && *c->at != '#')
            return 1;
    }
    return 0;
}

/** True at the end of a field. */
static int ends(const char *at)
{
    return !*at || *at == ' ' || *at == '\t';
}

static adcgs_status take_integer(const adcgs_colmap *model, cursor *c, const char *what, uint64_t max, uint64_t *value)
{
    char *end;
    skip_blanks(c);
    errno = 0;
    *value = strtoull(c->at, &end, 10);
    if (*c->at < '0' || *c->at > '9' || errno || !ends(end) || *value > max)
        return adcgs_colmap_bad(model, ADCGS_ERR_DATA, "%s: expected a whole number from 0 to %llu", what,
                                (unsigned long long)max);
    c->at = end;
    return ADCGS_OK;
}

static adcgs_status take_numbers(const adcgs_colmap *model, cursor *c, const char *what, double *values, int n)
{
    for (int i = 0; i < n; i++) {
        char *end;
        skip_blanks(c);
        values[i] = strtod(c->at, &end);
        if (!*c->at || end == c->at || !ends(end))
            return adcgs_colmap_bad(model, ADCGS_ERR_DATA, "%s: expected %d numbers", what, n);
        c->at = end;
    }
    return ADCGS_OK;
}

static adcgs_status expect_end(const adcgs_colmap *model, cursor *c)
{
    skip_blanks(c);
    return *c->at ? adcgs_colmap_bad(model, ADCGS_ERR_DATA, "unexpected \"%.32s\" at the end", c->at) : ADCGS_OK;
}

adcgs_status adcgs_colmap_text_cameras(adcgs_colmap *model, uint8_t *data, size_t bytes)
{
    cursor c;
    begin(model, &c, data, bytes);
    while (next_entry(model, &c)) {
        double params[ADCGS_COLMAP_PARAMS_MAX];
        uint64_t id, width, height;
        int n;
        ADCGS_TRY(take_integer(model, &c, "CAMERA_ID", UINT32_MAX, &id));
        skip_blanks(&c);
        char *name = c.at;
        while (!ends(c.at))
            c.at++;
        if (*c.at)
            *c.at++ = 0;
        const int kind = adcgs_colmap_kind(name, 0);
        if (kind < 0)
            return adcgs_colmap_bad(model, ADCGS_ERR_UNSUPPORTED, "unknown camera model \"%.32s\"", name);
        ADCGS_TRY(adcgs_colmap_params(model, kind, &n));
        ADCGS_TRY(take_integer(model, &c, "WIDTH", UINT32_MAX, &width));
        ADCGS_TRY(take_integer(model, &c, "HEIGHT", UINT32_MAX, &height));
        ADCGS_TRY(take_numbers(model, &c, "PARAMS", params, n));
        ADCGS_TRY(expect_end(model, &c));
        ADCGS_TRY(adcgs_colmap_add_camera(model, (uint32_t)id, kind, width, height, params));
    }
    return ADCGS_OK;
}

/** True for a line of numbers only, three for each point. An empty line is an empty list. */
static int is_list(const char *at)
{
    uint64_t n = 0;
    if (strlen(at) > LIST_CHECKED)
        return 1;
    for (;; n++) {
        char *end;
        at += strspn(at, " \t");
        if (!*at)
            return n % 3 == 0;
        const double value = strtod(at, &end);
        if (end == at || !ends(end) || (n % 3 == 2 && value != floor(value)))
            return 0;
        at = end;
    }
}

/** True for the line of an image: its number, a pose, the number of a camera, a name. */
static int is_image(const char *at)
{
    for (int i = 0; i < 9; i++) {
        char *end;
        at += strspn(at, " \t");
        const double value = strtod(at, &end);
        if (end == at || !ends(end) || ((i == 0 || i == 8) && value != floor(value)))
            return 0;
        at = end;
    }
    return at[strspn(at, " \t")] != 0;
}

/**
 * Skips the second line of an image: its points. Some programs omit it. Then the line is the next image, which must not be
 * skipped. Comments and empty lines belong to neither.
 */
static adcgs_status skip_points(adcgs_colmap *model, cursor *c)
{
    do
        if (!next_line(model, c))
            return ADCGS_OK;
    while (c->at[strspn(c->at, " \t")] == '#');
    if (is_list(c->at))
        return ADCGS_OK;
    skip_blanks(c);
    c->is_held = is_image(c->at);
    return c->is_held ? ADCGS_OK
                      : adcgs_colmap_bad(model, ADCGS_ERR_DATA,
                                         "neither the points of the image before, X, Y, POINT3D_ID for "
                                         "each, nor the next image");
}

adcgs_status adcgs_colmap_text_images(adcgs_colmap *model, uint8_t *data, size_t bytes)
{
    cursor c;
    begin(model, &c, data, bytes);
    while (next_entry(model, &c)) {
        double q[4], t[3];
        uint64_t id, camera;
        ADCGS_TRY(take_integer(model, &c, "IMAGE_ID", UINT32_MAX, &id));
        ADCGS_TRY(take_numbers(model, &c, "QW, QX, QY, QZ", q, 4));
        ADCGS_TRY(take_numbers(model, &c, "TX, TY, TZ", t, 3));
        ADCGS_TRY(take_integer(model, &c, "CAMERA_ID", UINT32_MAX, &camera));
        skip_blanks(&c); /* the name is the rest, including blanks */
        ADCGS_TRY(adcgs_colmap_add_image(model, (uint32_t)id, q, t, (uint32_t)camera, c.at));
        ADCGS_TRY(skip_points(model, &c));
    }
    return ADCGS_OK;
}

/** Counts the images of a track, and the training images among them. */
static adcgs_status take_track(const adcgs_colmap *model, cursor *c, const double position[3], adcgs_colmap_track *track)
{
    for (skip_blanks(c); *c->at; skip_blanks(c)) {
        uint64_t image, feature;
        ADCGS_TRY(take_integer(model, c, "TRACK", UINT32_MAX, &image));
        ADCGS_TRY(take_integer(model, c, "TRACK", UINT32_MAX, &feature));
        track->seen++;
        adcgs_colmap_add_seen(model, position, (uint32_t)image, track);
    }
    return ADCGS_OK;
}

adcgs_status adcgs_colmap_text_points(adcgs_colmap *model, uint8_t *data, size_t bytes)
{
    cursor c;
    uint64_t lines = 1;
    for (size_t i = 0; i < bytes; i++)
        lines += data[i] == '\n' || data[i] == '\r';
    ADCGS_TRY(adcgs_points_alloc(&model->points, lines, model->path, model->error));
    model->points.n = 0;
    model->points.coloured = 1;
    begin(model, &c, data, bytes);
    while (next_entry(model, &c)) {
        adcgs_colmap_track track = {.seen = 0};
        double position[3];
        uint64_t id, colour[3];
        ADCGS_TRY(take_integer(model, &c, "POINT3D_ID", UINT64_MAX, &id));
        ADCGS_TRY(take_numbers(model, &c, "X, Y, Z", position, 3));
        for (int a = 0; a < 3; a++)
            ADCGS_TRY(take_integer(model, &c, "R, G, B", 255, &colour[a]));
        ADCGS_TRY(take_numbers(model, &c, "ERROR", &track.deviation, 1));
        ADCGS_TRY(take_track(model, &c, position, &track));
        ADCGS_TRY(adcgs_colmap_add_point(model, position, colour, &track));
    }
    return ADCGS_OK;
}
