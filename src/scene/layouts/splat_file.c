/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats as a scene: the cameras around them. */
#include "config.h"

#include "scene/layouts/splat_file.h"

#include "scene/layouts/splat_aims.h"
#include "scene/splat_views.h"
#include "system/sort_values.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define OPACITY_LEAST (1.0f / 255.0f)  /* fainter splats are not rendered; definition of the bitstream */
#define POINT_OPACITY 0.1f             /* least opacity of a splat that becomes a point */
#define INSIDE 0.95                    /* share of the splats within the radius */
#define SHELLS 2                       /* distances of cameras */
#define RADIUS_MIN 1e-9                /* world units */
#define RADIUS_MAX 1e9                 /* world units */
#define GOLDEN_RATIO 0.618033988749895 /* (sqrt(5) - 1) / 2; geometry */
#define ASIDE 0.18                     /* of the distance: from a selected direction to a view, half the spacing of directions */
/* Steps of the three coordinates aside; geometry: powers of a root of x^4 = x + 1 (Roberts' sequence). */
static const double steps[3] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};

/* Origin: chosen by hand, not measured. */
#define REGION_TIMES 5       /* times from whose splats the region follows */
#define REGION_SPLATS 200000 /* splats that it follows from, at most */
#define DYNAMIC_VIEWS 640    /* training views of splats over time, of all frames together */
#define FRAME_VIEWS_MIN 4    /* training views of a frame, at least */
#define FRAME_VIEWS_MAX 32   /* the same, at most */
#define FIXED_TIMES 8        /* times of a fixed camera for validation or testing */

/* Cameras for training, validation and testing of static splats; chosen by hand, not measured. */
static const uint32_t n_views[ADCGS_SPLITS] = {100, 10, 20};
/* Fixed cameras for validation and testing of splats over time; chosen by hand, not measured. */
static const uint32_t n_fixed[ADCGS_SPLITS] = {0, 2, 6};

/* ---- Region of the splats ---- */

/** Centres and sizes of visible splats, of one time or of several. */
typedef struct sample {
    size_t n;
    double (*x)[3], *size, *values;
} sample;

static adcgs_status sample_alloc(sample *m, size_t most, const char *path, adcgs_error *error)
{
    m->n = 0;
    m->x = malloc((most + 1) * sizeof *m->x);
    m->size = malloc((most + 1) * sizeof *m->size);
    m->values = malloc((most + 1) * sizeof *m->values);
    return m->x && m->size && m->values ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
}

static void sample_clear(sample *m)
{
    free(m->x);
    free(m->size);
    free(m->values);
}

/** Adds every step'th splat that is visible, in world coordinates less the offset. */
static void sample_add(sample *m, const adcgs_splats *s, uint32_t step)
{
    for (uint32_t i = 0; i < s->n; i += step) {
        if (!(s->opacity[i] >= OPACITY_LEAST))
            continue;
        m->size[m->n] = 0.0;
        for (int a = 0; a < 3; a++) {
            m->x[m->n][a] = (double)s->mean[a][i];
            m->size[m->n] = fmax(m->size[m->n], (double)s->scale[a][i]);
        }
        m->n++;
    }
}

/** Keeps the finer half of the splats. */
static void keep_fine(sample *m)
{
    size_t n = 0;
    memcpy(m->values, m->size, m->n * sizeof *m->values);
    adcgs_sort(m->values, m->n);
    const double most = m->values[m->n / 2];
    for (size_t i = 0; i < m->n; i++)
        if (m->size[i] <= most) {
            memmove(m->x[n], m->x[i], sizeof m->x[i]);
            m->size[n++] = m->size[i];
        }
    m->n = n;
}

/** Uses medians, so that a few distant splats do not matter. */
static adcgs_status find_region(adcgs_splat_scene *s, sample *m, const char *path, adcgs_error *error)
{
    if (!m->n)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: no splat is visible: none has an opacity of at least 1/255", path);
    for (int a = 0; a < 3; a++) {
        for (size_t i = 0; i < m->n; i++)
            m->values[i] = m->x[i][a];
        adcgs_sort(m->values, m->n);
        s->centre[a] = m->values[m->n / 2];
    }
    for (size_t i = 0; i < m->n; i++) {
        double square = 0.0;
        for (int a = 0; a < 3; a++)
            square += pow(m->x[i][a] - s->centre[a], 2);
        m->values[i] = sqrt(square) + m->size[i];
    }
    adcgs_sort(m->values, m->n);
    s->radius = m->values[(size_t)(INSIDE * (double)(m->n - 1))];
    if (!(s->radius >= RADIUS_MIN && s->radius <= RADIUS_MAX))
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: the splats lie within %g units, expected 1e-9 to 1e9", path, s->radius);
    for (int a = 0; a < 3; a++) /* in world coordinates */
        s->centre[a] += s->splats.offset[a];
    return ADCGS_OK;
}

/**
 * Finds the region, and where to look at it from. The region of an object is that of all its splats. Otherwise it is that of the
 * fine ones, which are where the scene was filmed.
 */
static adcgs_status find_aims(adcgs_splat_aims *aims, adcgs_splat_scene *s, sample *m, const adcgs_splats *splats,
                              const char *path, adcgs_error *error)
{
    int is_object;
    ADCGS_TRY(find_region(s, m, path, error));
    ADCGS_TRY(adcgs_splat_aims_find(aims, &is_object, s, splats, path, error));
    if (is_object) {
        aims->n = 0;
        return ADCGS_OK;
    }
    keep_fine(m);
    ADCGS_TRY(find_region(s, m, path, error));
    return adcgs_splat_aims_find(aims, &is_object, s, splats, path, error);
}

/* ---- Cameras ---- */

/** A number of 0 to 1 for each index; by the golden ratio, evenly spread over successive indices. */
static double turn_of(uint32_t index, double step)
{
    const double x = step * (index + 1.0);
    return x - floor(x);
}

/**
 * Direction and distance of view `index` among `of`: from all around, or near one of the selected directions. Splits differ.
 */
static void choose(double out[3], double *distance, const adcgs_splat_aims *aims, const adcgs_splat_scene *s, int split,
                   uint32_t index, uint32_t of)
{
    static const double shells[SHELLS] = {1.0, 0.7};
    *distance = shells[index % SHELLS] * adcgs_splat_aims_distance(s);
    if (!aims->n) {
        adcgs_splat_aims_spread(out, index, of, 2.0 * split);
        return;
    }
    const uint32_t seed = 7 * index + (uint32_t)split;
    const double *const near = aims->out[(uint32_t)(turn_of(seed, GOLDEN_RATIO) * aims->n) % aims->n];
    double length = 0.0;
    for (int a = 0; a < 3; a++) {
        out[a] = near[a] + ASIDE * (2.0 * turn_of(seed, steps[a]) - 1.0);
        length += out[a] * out[a];
    }
    for (int a = 0; a < 3; a++)
        out[a] /= sqrt(length);
}

/** A view in direction `index` of a spiral of `of` directions, at a distance that alternates. time: 0 to 1. */
static adcgs_status add_view(adcgs_scene *scene, const adcgs_splat_aims *aims, int split, uint32_t index, uint32_t of,
                             double time, const char *path, adcgs_error *error)
{
    const uint32_t n = scene->n_views[split];
    adcgs_scene_view *const view = &scene->views[split][n];
    double out[3], distance;
    choose(out, &distance, aims, scene->splats, split, index, of);
    adcgs_splat_aims_camera(&view->camera, scene->splats, out, distance, ADCGS_SPLAT_SCENE_SIZE);
    snprintf(view->camera.name, sizeof view->camera.name, "%s_%03u", adcgs_split_name((adcgs_split)split), n);
    view->time = time;
    view->source_time = time * scene->duration;
    view->path = strdup(path);
    if (!view->path)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    scene->n_views[split]++;
    return ADCGS_OK;
}

static adcgs_status alloc_views(adcgs_scene *scene, int split, uint32_t n, const char *path, adcgs_error *error)
{
    scene->views[split] = calloc(n, sizeof *scene->views[split]);
    return scene->views[split] ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
}

static adcgs_status add_static_views(adcgs_scene *scene, const adcgs_splat_aims *aims, const char *path, adcgs_error *error)
{
    for (int split = 0; split < ADCGS_SPLITS; split++) {
        ADCGS_TRY(alloc_views(scene, split, n_views[split], path, error));
        for (uint32_t i = 0; i < n_views[split]; i++)
            ADCGS_TRY(add_view(scene, aims, split, i, n_views[split], 0.0, path, error));
    }
    return ADCGS_OK;
}

/** Training views of all frames: those of a frame are spread over all directions, and differ from frame to frame. */
static adcgs_status add_training_views(adcgs_scene *scene, const adcgs_splat_aims *aims, uint32_t frames, const char *path,
                                       adcgs_error *error)
{
    const uint32_t each = ADCGS_MIN(ADCGS_MAX(DYNAMIC_VIEWS / frames, FRAME_VIEWS_MIN), FRAME_VIEWS_MAX), all = each * frames;
    ADCGS_TRY(alloc_views(scene, ADCGS_SPLIT_TRAIN, all, path, error));
    for (uint32_t f = 0; f < frames; f++)
        for (uint32_t k = 0; k < each; k++)
            ADCGS_TRY(add_view(scene, aims, ADCGS_SPLIT_TRAIN, k * frames + f, all, f / (frames - 1.0), path, error));
    return ADCGS_OK;
}

/**
 * Fixed cameras at some frames, so that the pixels that change with time are known. Continuous splats are seen halfway between
 * frames.
 */
static adcgs_status add_fixed_views(adcgs_scene *scene, const adcgs_splat_aims *aims, int split, uint32_t frames,
                                    const char *path, adcgs_error *error)
{
    const uint32_t times = ADCGS_MIN(frames, FIXED_TIMES);
    const int between = scene->splats->dynamic->is_continuous;
    ADCGS_TRY(alloc_views(scene, split, n_fixed[split] * times, path, error));
    for (uint32_t c = 0; c < n_fixed[split]; c++)
        for (uint32_t k = 0; k < times; k++) {
            const double frame = times > 1 ? floor((double)k * (frames - 1) / (times - 1) + 0.5) : 0.0;
            const double aside = !between ? 0.0 : frame < frames - 1.0 ? 0.5 : -0.5;
            ADCGS_TRY(add_view(scene, aims, split, c, n_fixed[split], (frame + aside) / (frames - 1.0), path, error));
        }
    return ADCGS_OK;
}

/* ---- The scene ---- */

static uint8_t to_byte(float value)
{
    return (uint8_t)(fminf(fmaxf(value, 0.0f), 1.0f) * 255.0f + 0.5f);
}

/** Call it before normalise(), while points are in world units. */
static adcgs_status take_points(adcgs_points *out, const adcgs_splats *s, const char *path, adcgs_error *error)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < s->n; i++)
        n += s->opacity[i] >= POINT_OPACITY;
    ADCGS_TRY(adcgs_points_alloc(out, n, path, error));
    out->coloured = 1;
    n = 0;
    for (uint32_t i = 0; i < s->n; i++) {
        if (s->opacity[i] < POINT_OPACITY)
            continue;
        for (int a = 0; a < 3; a++) {
            out->position[n][a] = s->offset[a] + (double)s->mean[a][i];
            out->colour[n][a] = to_byte(s->colour[a][i]);
        }
        n++;
    }
    return ADCGS_OK;
}

/** Splats that do not change with time: the file's, or the only frame of splats over time. */
static adcgs_status read_static(adcgs_scene *scene, int want_points, const char *path, adcgs_error *error)
{
    adcgs_splat_scene *const s = scene->splats;
    adcgs_splat_aims aims;
    sample m;
    adcgs_status status = sample_alloc(&m, s->splats.n, path, error);
    if (status == ADCGS_OK) {
        sample_add(&m, &s->splats, 1);
        status = find_aims(&aims, s, &m, &s->splats, path, error);
    }
    sample_clear(&m);
    ADCGS_TRY(status);
    s->gives_points = want_points;
    if (want_points)
        ADCGS_TRY(take_points(&scene->points, &s->splats, path, error));
    adcgs_splat_scene_normalise(s, &s->splats);
    return add_static_views(scene, &aims, path, error);
}

/** Finds the region that splats over time occupy at some times, and where to look at it from in the middle one. */
static adcgs_status survey(adcgs_splat_aims *aims, adcgs_splat_scene *s, sample *m, const char *path, adcgs_error *error)
{
    adcgs_splats middle = {0};
    adcgs_status status = ADCGS_OK;
    for (int i = 0; i < REGION_TIMES && status == ADCGS_OK; i++) {
        adcgs_splats state;
        status = adcgs_dynamic_at(s->dynamic, adcgs_dynamic_duration(s->dynamic) * i / (REGION_TIMES - 1.0), &state, error);
        if (status != ADCGS_OK)
            break;
        sample_add(m, &state, (uint32_t)((uint64_t)state.n * REGION_TIMES / REGION_SPLATS) + 1);
        if (i == REGION_TIMES / 2)
            middle = state;
        else
            adcgs_splats_free(&state);
    }
    if (status == ADCGS_OK)
        status = find_aims(aims, s, m, &middle, path, error);
    adcgs_splats_free(&middle);
    return status;
}

static adcgs_status read_dynamic(adcgs_scene *scene, const char *path, adcgs_error *error)
{
    adcgs_splat_scene *const s = scene->splats;
    const uint32_t frames = s->dynamic->frames;
    adcgs_splat_aims aims;
    sample m;
    adcgs_status status = sample_alloc(&m, REGION_SPLATS + REGION_TIMES, path, error);
    if (status == ADCGS_OK)
        status = survey(&aims, s, &m, path, error);
    sample_clear(&m);
    ADCGS_TRY(status);
    adcgs_splat_scene_normalise(s, &s->splats);
    scene->duration = adcgs_dynamic_duration(s->dynamic);
    scene->rate = s->dynamic->rate;
    if (*s->dynamic->remark)
        adcgs_scene_remark(scene, "%s", s->dynamic->remark);
    ADCGS_TRY(add_training_views(scene, &aims, frames, path, error));
    ADCGS_TRY(add_fixed_views(scene, &aims, ADCGS_SPLIT_VAL, frames, path, error));
    return add_fixed_views(scene, &aims, ADCGS_SPLIT_TEST, frames, path, error);
}

adcgs_status adcgs_splat_scene_read(adcgs_scene *scene, int want_points, const adcgs_dynamic_options *options, const char *path,
                                    adcgs_error *error)
{
    adcgs_splat_scene *const s = scene->splats = adcgs_splat_scene_create();
    if (!s)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    if (adcgs_dynamic_is(path)) {
        ADCGS_TRY(adcgs_dynamic_open(&s->dynamic, path, options, error));
        ADCGS_TRY(adcgs_dynamic_at(s->dynamic, 0.0, &s->splats, error));
    } else
        ADCGS_TRY(adcgs_splats_read(&s->splats, path, error));
    const int moves = s->dynamic && s->dynamic->frames > 1;
    ADCGS_TRY(moves ? read_dynamic(scene, path, error) : read_static(scene, want_points, path, error));
    if (!moves)
        adcgs_dynamic_free(&s->dynamic);
    scene->axes = s->splats.axes;
    return ADCGS_OK;
}
