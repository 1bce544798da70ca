/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The curves of earlier sweeps that a sweep is compared with, from their sweep.json files. Each sweep contributes the first of
 * the codec's own curves. Points are taken from that file alone: the streams need not exist any more.
 */
#include "config.h"

#include "apps/sweep/sweep.h"

#include "scene/camera_json.h"
#include "system/text.h"

#include <math.h>
#include <stdlib.h>
#include <sys/stat.h>

/* Origin: chosen by hand, not measured. Figures beyond are mistakes. */
#define BYTES_MAX 1e15 /* bytes of a stream */
#define DB_MAX 1000.0  /* dB of a PSNR, of either sign */
#define ANY_MAX 1e12   /* of figures that are only shown */

/* ---- Points ---- */

/** Reads a number of the place's object. The value stays if there is none, or null, which marks an unknown value. */
static adcgs_status read_number(const adcgs_json_place *at, const char *field, double min, double max, double *value)
{
    int found;
    if (json_is_null(adcgs_json_find(at, field)))
        return ADCGS_OK;
    return adcgs_json_number(at, field, min, max, value, &found);
}

/** Reads a figure that every point must have, over `seeds` seeds. */
static adcgs_status read_spread(const adcgs_json_place *point, const char *field, double min, double max, int seeds,
                                adcgs_spread *s)
{
    adcgs_json_place at = *point;
    at.root = at.frame = json_object_get(point->frame, field);
    at.list = field;
    *s = (adcgs_spread){seeds, (double)NAN, (double)NAN, (double)NAN};
    if (!json_is_object(at.frame))
        return adcgs_json_bad(point, ADCGS_ERR_DATA, field, "expected an object with mean, min and max");
    ADCGS_TRY(read_number(&at, "mean", min, max, &s->mean));
    ADCGS_TRY(read_number(&at, "min", min, max, &s->min));
    ADCGS_TRY(read_number(&at, "max", min, max, &s->max));
    if (!(s->min <= s->max) || isnan(s->mean))
        return adcgs_json_bad(point, ADCGS_ERR_DATA, field, "expected mean, min and max, min not above max");
    return ADCGS_OK;
}

static adcgs_status read_point(const adcgs_json_place *at, adcgs_sweep_row *row)
{
    double seeds = 0, moving = (double)NAN, ssim = (double)NAN, seconds = (double)NAN, speed = (double)NAN,
           objective = (double)NAN;
    *row = (adcgs_sweep_row){.lambda = -1, .is_stream = 1, .networks = (double)NAN};
    const struct {
        const char *field;
        double min, max, *to;
    } fields[] = {{"seeds", 1, ADCGS_SWEEP_LIST, &seeds},     {"lambda", 0, ANY_MAX, &row->lambda},
                  {"dynamic_psnr", -DB_MAX, DB_MAX, &moving}, {"ssim", -1, 1, &ssim},
                  {"network_share", 0, 1, &row->networks},    {"cpu_seconds", 0, ANY_MAX, &seconds},
                  {"frames_per_second", 0, ANY_MAX, &speed},  {"objective", 0, ANY_MAX, &objective}};
    for (size_t i = 0; i < ADCGS_COUNTOF(fields); i++)
        ADCGS_TRY(read_number(at, fields[i].field, fields[i].min, fields[i].max, fields[i].to));
    if (seeds < 1)
        return adcgs_json_bad(at, ADCGS_ERR_DATA, "seeds", "expected a number");
    row->moving = adcgs_spread_one(moving);
    row->ssim = adcgs_spread_one(ssim);
    row->seconds = adcgs_spread_one(seconds);
    row->speed = adcgs_spread_one(speed);
    row->objective = adcgs_spread_one(objective);
    ADCGS_TRY(read_spread(at, "bytes", 1, BYTES_MAX, (int)seeds, &row->bytes));
    return read_spread(at, "psnr", -DB_MAX, DB_MAX, (int)seeds, &row->psnr);
}

/** points: of the curve, NULL if the file has no curve. */
static adcgs_status read_points(const char *path, const json_t *points, adcgs_sweep_curve *curve, adcgs_error *error)
{
    const size_t n = json_array_size(points);
    if (!n || n > ADCGS_SWEEP_LIST)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: no curve of the codec itself with 1 to %d points", path, ADCGS_SWEEP_LIST);
    for (size_t i = 0; i < n; i++) {
        json_t *const point = json_array_get(points, i);
        const adcgs_json_place at = {path, point, point, i, "points", error};
        if (!json_is_object(point))
            return adcgs_fail(error, ADCGS_ERR_DATA, "%s: points[%zu]: expected an object", path, i);
        ADCGS_TRY(read_point(&at, &curve->point[i]));
        curve->point[i].name = curve->name;
    }
    curve->n = (int)n;
    return ADCGS_OK;
}

/** The points of the first curve that is not a yardstick. */
static const json_t *find_points(const json_t *root)
{
    const json_t *const curves = json_object_get(root, "curves");
    for (size_t i = 0; i < json_array_size(curves); i++)
        if (json_is_false(json_object_get(json_array_get(curves, i), "yardstick")))
            return json_object_get(json_array_get(curves, i), "points");
    return NULL;
}

/* ---- Names ---- */

/** Finds the last component of path[0..end), without trailing slashes. Returns its start; its length is 0 if there is none. */
static size_t part_before(const char *path, size_t end, size_t *length)
{
    while (end && path[end - 1] == '/')
        end--;
    size_t start = end;
    while (start && path[start - 1] != '/')
        start--;
    *length = end - start;
    return start;
}

int adcgs_sweep_has_curve(const adcgs_sweep_plan *plan, const char *name)
{
    for (int i = 0; i < plan->n_curves; i++)
        if (!strcmp(plan->curve[i].name, name))
            return 1;
    return 0;
}

void adcgs_sweep_write_name(char *name, size_t size, const char *text, size_t length)
{
    snprintf(name, size, "%.*s", (int)length, text);
    for (; *name; name++)
        if (*name < ' ' || *name > '~' || strchr("'\"`\\", *name))
            *name = '_';
}

/**
 * Names a curve after the folder. For curves/robot and before/robot, it uses the first component from the end that differs
 * ("before"). If another curve has that name, it uses the whole path.
 */
static adcgs_status name_curve(char *name, size_t size, const adcgs_sweep_plan *plan, const char *folder, const char *own,
                               adcgs_error *error)
{
    size_t at = strlen(folder), own_at = strlen(own), length, own_length;
    do {
        at = part_before(folder, at, &length);
        own_at = part_before(own, own_at, &own_length);
    } while (length && length == own_length && !memcmp(folder + at, own + own_at, length));
    if (!length)
        at = part_before(folder, strlen(folder), &length);
    adcgs_sweep_write_name(name, size, folder + at, length);
    if (adcgs_sweep_has_curve(plan, name))
        adcgs_sweep_write_name(name, size, folder, strlen(folder));
    if (adcgs_sweep_has_curve(plan, name))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--against %s: another curve has this name", name);
    return ADCGS_OK;
}

/* ---- Files ---- */

/** The same scene may lie elsewhere now, but has the same name. */
static adcgs_status check_scene(const adcgs_sweep *sweep, const char *path, const json_t *root, adcgs_error *error)
{
    const char *const scene = json_string_value(json_object_get(root, "scene"));
    size_t n, own_n;
    if (!scene)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: expected the scene's name, which sweeps store", path);
    char *const own = adcgs_text_utf8(sweep->scene); /* in the form that was stored */
    if (!own)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    const size_t at = part_before(scene, strlen(scene), &n), own_at = part_before(own, strlen(own), &own_n);
    adcgs_status status = ADCGS_OK;
    if (n != own_n || memcmp(scene + at, own + own_at, n) != 0)
        status = adcgs_fail(error, ADCGS_ERR_DATA, "%s: a sweep of the scene %.*s, not of %.*s", path, (int)n, scene + at,
                            (int)own_n, own + own_at);
    free(own);
    return status;
}

static adcgs_status take_curve(adcgs_sweep_plan *plan, const adcgs_sweep *sweep, const char *folder, const char *path,
                               const json_t *root, adcgs_error *error)
{
    char name[sizeof plan->curve->name], note[sizeof plan->curve->note];
    ADCGS_TRY(check_scene(sweep, path, root, error));
    ADCGS_TRY(name_curve(name, sizeof name, plan, folder, sweep->directory, error));
    snprintf(note, sizeof note, "an earlier sweep of the scene, in %.*s", (int)sizeof note - 40, folder); /* as much as fits */
    adcgs_sweep_curve *const curve = adcgs_sweep_add_curve(plan, name, note, ADCGS_FIGURE_BYTES, 0);
    curve->earlier = 1;
    return read_points(path, find_points(root), curve, error);
}

/** A sweep replaces its own sweep.json, so the next comparison would be with itself. */
static int is_own(const adcgs_sweep *sweep, const char *folder)
{
    struct stat a, b;
    return stat(sweep->directory, &a) == 0 && stat(folder, &b) == 0 && a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

static adcgs_status add_earlier(adcgs_sweep_plan *plan, const adcgs_sweep *sweep, const char *folder, adcgs_error *error)
{
    char path[ADCGS_SWEEP_PATH];
    json_t *root;
    if (is_own(sweep, folder))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--against %s: is the output folder of this sweep", folder);
    if (snprintf(path, sizeof path, "%s/sweep.json", folder) >= (int)sizeof path)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--against: a path of over %zu bytes", sizeof path - 1);
    ADCGS_TRY(adcgs_json_load(&root, path, error));
    const adcgs_status status = take_curve(plan, sweep, folder, path, root, error);
    json_decref(root);
    return status;
}

adcgs_status adcgs_sweep_add_against(adcgs_sweep_plan *plan, const adcgs_sweep *sweep, adcgs_error *error)
{
    const char *at = sweep->against;
    for (int n = 1; at; n++) {
        char folder[ADCGS_SWEEP_PATH];
        const size_t length = strcspn(at, ",");
        if (!length || length >= sizeof folder || n > ADCGS_SWEEP_AGAINST)
            return adcgs_fail(error, ADCGS_ERR_USAGE, "--against: expected 1 to %d folders, with commas between",
                              ADCGS_SWEEP_AGAINST);
        memcpy(folder, at, length);
        folder[length] = '\0';
        ADCGS_TRY(add_earlier(plan, sweep, folder, error));
        at = at[length] ? at + length + 1 : NULL;
    }
    return ADCGS_OK;
}
