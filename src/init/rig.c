/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Cameras, frames, reduced images and backgrounds; for a single moving camera, its images. */
#include "init/rig.h"

#include "scene/group_views.h"
#include "system/sort_values.h"

#include <math.h>
#include <stdlib.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
enum {
    PIXELS_LEAST = 4096, /* pixels: minimum size of an image for matching */
    PIXELS_MOST = 28000  /* pixels: maximum size of a reduced image */
};
/* Levels of 255: maximum difference of a pixel from its background; as ADCGS_STEREO_MOVED. */
#define BACKGROUND_MAX_LEVELS 18
#define BACKGROUND_SHARE_MIN 0.55 /* minimum share of the frames in which a pixel must show its background */
#define NEAREST 0.2               /* scene units: default minimum depth, from depths observed in such units */
#define FARTHEST 8.0              /* scene units: default maximum depth, likewise */
#define NEAR_SLACK 0.9            /* minimum depth / near bound of the data set */
#define NEAR_LEAST 0.05           /* scene units: minimum of it */
#define DEEP 4                    /* minimum ratio of the maximum depth to the minimum depth */

/** Camera and time of the scene's views. */
typedef struct index {
    const adcgs_scene_view *views;
    uint32_t n, n_cameras, n_times;
    uint32_t *of, *order;
    double *times;  /* [n_times] ascending */
    uint32_t *film; /* [n] the views in order of time, if one moving camera took them; otherwise NULL */
} index;

static void index_clear(index *x)
{
    adcgs_free(NULL, x->of);
    adcgs_free(NULL, x->order);
    adcgs_free(NULL, x->times);
    adcgs_free(NULL, x->film);
}

/* ---- Single moving camera ---- */

/* Chosen by hand, not measured. */
enum {
    MONOCULAR_FRAMES_MIN = 8, /* minimum number of images */
    ALIKE_OF_4 = 3            /* of four images: minimum number with the viewing direction of the previous one */
};
#define ALIKE 0.966 /* minimum cosine between such directions */

typedef struct timed {
    double time;
    uint32_t view;
} timed;

static int earlier(const void *a, const void *b)
{
    const timed *x = a, *y = b;
    return x->time != y->time ? (x->time > y->time) - (x->time < y->time) : (x->view > y->view) - (x->view < y->view);
}

/** True if most views look in the direction of the previous view. */
static int goes_on(const index *x, const timed *all)
{
    uint32_t alike = 0;
    for (uint32_t i = 1; i < x->n; i++) {
        const double *a = x->views[all[i - 1].view].camera.cam_to_world, *b = x->views[all[i].view].camera.cam_to_world;
        alike += a[2] * b[2] + a[6] * b[6] + a[10] * b[10] >= ALIKE;
    }
    return 4 * alike >= ALIKE_OF_4 * (x->n - 1);
}

static adcgs_status find_film(index *x, adcgs_error *error)
{
    if (x->n < MONOCULAR_FRAMES_MIN || x->n_cameras <= x->n / 2 || x->n_times < x->n)
        return ADCGS_OK;
    timed *all = adcgs_alloc(NULL, x->n, sizeof *all, error);
    if (!all)
        return adcgs_alloc_status(error);
    for (uint32_t i = 0; i < x->n; i++)
        all[i] = (timed){x->views[i].time, i};
    qsort(all, x->n, sizeof *all, earlier);
    adcgs_status status = ADCGS_OK;
    if (goes_on(x, all)) {
        x->film = adcgs_alloc(NULL, x->n, sizeof *x->film, error);
        status = x->film ? ADCGS_OK : adcgs_alloc_status(error);
    }
    for (uint32_t i = 0; x->film && i < x->n; i++)
        x->film[i] = all[i].view;
    adcgs_free(NULL, all);
    return status;
}

static adcgs_status index_init(index *x, const adcgs_scene *scene, adcgs_error *error)
{
    *x = (index){.views = scene->views[ADCGS_SPLIT_TRAIN], .n = scene->n_views[ADCGS_SPLIT_TRAIN]};
    x->of = adcgs_alloc(NULL, x->n, sizeof *x->of, error);
    x->order = adcgs_alloc(NULL, x->n, sizeof *x->order, error);
    x->times = adcgs_alloc(NULL, x->n, sizeof *x->times, error);
    if (!x->of || !x->order || !x->times)
        return adcgs_alloc_status(error);
    ADCGS_TRY(adcgs_group_views(x->views, x->n, x->of, x->order, &x->n_cameras, error));
    for (uint32_t i = 0; i < x->n; i++)
        x->times[i] = x->views[i].time;
    adcgs_sort(x->times, x->n);
    for (uint32_t i = 0; i < x->n; i++)
        if (!i || x->times[i] > x->times[x->n_times - 1])
            x->times[x->n_times++] = x->times[i];
    return find_film(x, error);
}

adcgs_status adcgs_stereo_applies(const adcgs_scene *scene, int *applies, adcgs_error *error)
{
    index x;
    const adcgs_status status = index_init(&x, scene, error);
    const int stay = x.n_times < 2 || x.n_cameras <= x.n / 2; /* or a static scene, whose cameras have one image each */
    const int large = x.n && (double)x.views[0].camera.width * x.views[0].camera.height >= PIXELS_LEAST;
    *applies = status == ADCGS_OK && large && (x.film || (x.n_cameras >= 3 && stay && x.n >= 2 * x.n_times));
    index_clear(&x);
    return status;
}

/* ---- Cameras ---- */

static void set_view(adcgs_stereo_view *v, const adcgs_camera *c, const adcgs_stereo_options *o)
{
    for (int a = 0; a < 3; a++) {
        v->centre[a] = (c->cam_to_world[4 * a + 3] - o->origin[a]) / o->scale;
        for (int b = 0; b < 3; b++)
            v->rotation[3 * b + a] = c->cam_to_world[4 * a + b];
    }
    v->fx = c->fx;
    v->fy = c->fy;
    v->cx = c->cx;
    v->cy = c->cy;
    v->w = c->width;
    v->h = c->height;
}

static uint8_t *to_bytes(const float *rgb, size_t plane, adcgs_error *error)
{
    uint8_t *bytes = adcgs_alloc(NULL, 4 * plane, 1, error);
    for (size_t i = 0; bytes && i < plane; i++) {
        const int known = !isnan(rgb[i]);
        for (size_t c = 0; known && c < 3; c++)
            bytes[4 * i + c] = (uint8_t)(fminf(fmaxf(rgb[c * plane + i], 0), 1) * 255 + 0.5f);
        bytes[4 * i + 3] = known ? 255 : 0;
    }
    return bytes;
}

static adcgs_status load_frame(const adcgs_scene *scene, const adcgs_scene_view *view, const adcgs_stereo_options *o,
                               adcgs_stereo_camera *camera, int frame, adcgs_error *error)
{
    float *rgb;
    adcgs_camera small;
    const double pixels = (double)view->camera.width * view->camera.height;
    const int divide = ADCGS_MAX((int)ceil(sqrt(pixels / PIXELS_MOST)), 1);
    ADCGS_TRY(adcgs_scene_image(scene, view, divide, &rgb, &small, error));
    set_view(&camera->view, &small, o);
    camera->frame[frame] = to_bytes(rgb, (size_t)small.width * (size_t)small.height, error);
    free(rgb);
    return camera->frame[frame] ? ADCGS_OK : adcgs_alloc_status(error);
}

void adcgs_stereo_rig_get_frame(const adcgs_stereo_camera *camera, int frame, float *pixels)
{
    const size_t n = 4 * (size_t)camera->view.w * (size_t)camera->view.h;
    for (size_t i = 0; i < n; i++)
        pixels[i] = camera->frame[frame][i] * (1.0f / 255);
}

/** Binomial filter over 5 pixels of a line of n pixels, `step` apart. Unknown pixels have no weight. */
static void soften_line(uint8_t *line, int n, size_t step, uint8_t *copy)
{
    /* Binomial coefficients; arithmetic. */
    static const int weight[5] = {1, 4, 6, 4, 1};
    for (int i = 0; i < n; i++)
        memcpy(copy + 4 * i, line + (size_t)i * step, 4);
    for (int i = 0; i < n; i++) {
        int sum[3] = {0, 0, 0}, all = 0;
        for (int k = ADCGS_MAX(i - 2, 0); k <= ADCGS_MIN(i + 2, n - 1); k++) {
            const int w = copy[4 * k + 3] ? weight[k - i + 2] : 0;
            all += w;
            for (int c = 0; c < 3; c++)
                sum[c] += w * copy[4 * k + c];
        }
        for (int c = 0; c < 3 && all; c++)
            line[(size_t)i * step + (size_t)c] = (uint8_t)((sum[c] + all / 2) / all);
    }
}

adcgs_status adcgs_stereo_rig_smooth(adcgs_stereo_rig *rig, adcgs_error *error)
{
    for (int c = 0; c < rig->n_cameras; c++) {
        const int w = rig->camera[c].view.w, h = rig->camera[c].view.h;
        uint8_t *copy = adcgs_alloc(NULL, 4 * (size_t)ADCGS_MAX(w, h), 1, error);
        if (!copy)
            return adcgs_alloc_status(error);
        for (int m = 0; m < rig->n_frames; m++) {
            uint8_t *shown = rig->camera[c].frame[m];
            for (int y = 0; shown && y < h; y++)
                soften_line(shown + 4 * (size_t)y * (size_t)w, w, 4, copy);
            for (int x = 0; shown && x < w; x++)
                soften_line(shown + 4 * (size_t)x, h, 4 * (size_t)w, copy);
        }
        adcgs_free(NULL, copy);
    }
    return ADCGS_OK;
}

/* ---- Background ---- */

static uint8_t middle_of(uint8_t *values, int n)
{
    for (int i = 1; i < n; i++)
        for (int j = i; j > 0 && values[j] < values[j - 1]; j--) {
            const uint8_t swap = values[j];
            values[j] = values[j - 1];
            values[j - 1] = swap;
        }
    return values[n / 2];
}

/** Sets the background to the median of the pixel over the frames, and marks the pixel if too few frames are close to it. */
static void set_usual(adcgs_stereo_camera *c, size_t pixel)
{
    uint8_t values[ADCGS_MATCHING_FRAMES_MAX], background[4];
    int n = 0, near = 0;
    for (size_t k = 0; k < 4; k++) {
        n = 0;
        for (int m = 0; m < ADCGS_MATCHING_FRAMES_MAX; m++)
            if (c->frame[m])
                values[n++] = c->frame[m][4 * pixel + k];
        background[k] = middle_of(values, n);
        c->background[4 * pixel + k] = background[k] * (1.0f / 255);
    }
    for (int m = 0; m < ADCGS_MATCHING_FRAMES_MAX; m++) {
        int off = 0;
        for (size_t k = 0; c->frame[m] && k < 4; k++)
            off = ADCGS_MAX(off, abs(c->frame[m][4 * pixel + k] - background[k]));
        near += c->frame[m] && off <= BACKGROUND_MAX_LEVELS;
    }
    c->unstable[pixel] = near < BACKGROUND_SHARE_MIN * n;
}

static adcgs_status find_usual(adcgs_stereo_camera *c, adcgs_error *error)
{
    const size_t plane = (size_t)c->view.w * (size_t)c->view.h;
    c->background = adcgs_alloc(NULL, 4 * plane, sizeof *c->background, error);
    c->unstable = adcgs_alloc(NULL, plane, 1, error);
    if (!c->background || !c->unstable)
        return adcgs_alloc_status(error);
    for (size_t i = 0; i < plane; i++)
        set_usual(c, i);
    c->view.pixels = c->background;
    return ADCGS_OK;
}

/* ---- Depths ---- */

/** Sets the depth range from the data set's near bound, or to the range of scene units. */
static void set_depths(adcgs_stereo_rig *rig, const adcgs_scene *scene, const adcgs_stereo_options *o)
{
    rig->nearest = scene->near_bound > 0 ? fmax(NEAR_SLACK * scene->near_bound / o->scale, NEAR_LEAST) : NEAREST;
    rig->farthest = fmax(FARTHEST, DEEP * rig->nearest);
}

static float time_of(const adcgs_scene *scene, double time)
{
    return scene->duration > 0 ? (float)fmin(fmax(time / scene->duration, 0), 1) : 0;
}

/** Loads the images of one camera at the rig's frames. views: of that camera, ascending in time. */
static adcgs_status load_camera(const adcgs_stereo_rig *rig, adcgs_stereo_camera *camera, const adcgs_scene *scene,
                                const index *x, const uint32_t *views, uint32_t n, const adcgs_stereo_options *o,
                                adcgs_error *error)
{
    int m = 0, loaded = 0;
    for (uint32_t i = 0; i < n; i++) {
        const adcgs_scene_view *view = &x->views[views[i]];
        const float t = time_of(scene, view->time);
        while (m < rig->n_frames && rig->frame_time[m] < t)
            m++;
        if (m == rig->n_frames || rig->frame_time[m] > t || camera->frame[m])
            continue;
        ADCGS_TRY(load_frame(scene, view, o, camera, m, error));
        loaded++;
    }
    return loaded ? find_usual(camera, error) : ADCGS_OK;
}

static adcgs_status load_cameras(adcgs_stereo_rig *rig, const adcgs_scene *scene, const index *x, const adcgs_stereo_options *o,
                                 adcgs_error *error)
{
    uint32_t begin = 0, end;
    for (int c = 0; c < rig->n_cameras; c++, begin = end) {
        const uint32_t wanted = (uint32_t)((uint64_t)c * x->n_cameras / (uint64_t)rig->n_cameras);
        while (x->of[x->order[begin]] != wanted)
            begin++;
        for (end = begin; end < x->n && x->of[x->order[end]] == wanted; end++)
            ;
        rig->camera[c].first = x->order[begin];
        ADCGS_TRY(load_camera(rig, &rig->camera[c], scene, x, x->order + begin, end - begin, o, error));
    }
    return ADCGS_OK;
}

static uint32_t frames_of(const adcgs_stereo_options *o)
{
    return o->frames ? o->frames : ADCGS_MATCHING_FRAMES_MAX;
}

/** Loads evenly spaced images of a moving camera as one image each of static cameras. */
static adcgs_status load_film(adcgs_stereo_rig *rig, const adcgs_scene *scene, const index *x, const adcgs_stereo_options *o,
                              adcgs_error *error)
{
    rig->n_cameras = rig->n_frames =
        (int)ADCGS_MIN(ADCGS_MIN(x->n, ADCGS_STEREO_CAMERAS), ADCGS_MAX(frames_of(o), MONOCULAR_FRAMES_MIN));
    rig->monocular = 1;
    for (int c = 0; c < rig->n_cameras; c++) {
        const uint32_t view = x->film[(uint64_t)c * (x->n - 1) / (uint64_t)(rig->n_cameras - 1)];
        rig->frame_time[c] = time_of(scene, x->views[view].time);
        rig->camera[c].first = view;
        ADCGS_TRY(load_frame(scene, &x->views[view], o, &rig->camera[c], c, error));
        ADCGS_TRY(find_usual(&rig->camera[c], error));
    }
    return ADCGS_OK;
}

adcgs_status adcgs_stereo_rig_init(adcgs_stereo_rig *rig, const adcgs_scene *scene, const adcgs_stereo_options *options,
                                   adcgs_error *error)
{
    index x;
    adcgs_status status = index_init(&x, scene, error);
    set_depths(rig, scene, options);
    if (status == ADCGS_OK && x.film) {
        status = load_film(rig, scene, &x, options, error);
    } else if (status == ADCGS_OK) {
        rig->n_cameras = (int)ADCGS_MIN(x.n_cameras, ADCGS_STEREO_CAMERAS);
        rig->n_frames = (int)ADCGS_MIN(x.n_times, frames_of(options));
        for (int m = 0; m < rig->n_frames; m++) {
            const uint64_t last = (uint64_t)ADCGS_MAX(rig->n_frames - 1, 1);
            rig->frame_time[m] = time_of(scene, x.times[(uint64_t)m * (x.n_times - 1) / last]);
        }
        status = load_cameras(rig, scene, &x, options, error);
    }
    index_clear(&x);
    return status;
}

void adcgs_stereo_rig_clear(adcgs_stereo_rig *rig)
{
    for (int c = 0; c < rig->n_cameras; c++) {
        adcgs_free(NULL, rig->camera[c].background);
        adcgs_free(NULL, rig->camera[c].unstable);
        for (int m = 0; m < ADCGS_MATCHING_FRAMES_MAX; m++)
            adcgs_free(NULL, rig->camera[c].frame[m]);
    }
    memset(rig, 0, sizeof *rig);
}
