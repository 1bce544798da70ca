/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats as a scene: the images of its cameras. */
#include "config.h"

#include "scene/splat_views.h"

#include "base/cpu_detect.h"
#include "media/splats/harmonics.h"
#include "render/project.h"
#include "render/render.h"

#include <math.h>
#include <stdlib.h>

/* Largest opacity of a primitive; literature (3D Gaussian splatting), as in the specification. */
#define OPACITY_MAX 0.99f

adcgs_splat_scene *adcgs_splat_scene_create(void)
{
    adcgs_splat_scene *const s = calloc(1, sizeof *s);
    if (!s)
        return NULL;
    s->radius = 1.0;
    for (int i = 0; i < ADCGS_SPLAT_STATES; i++)
        s->state[i].time = -1.0;
    pthread_mutex_init(&s->lock, NULL);
    pthread_cond_init(&s->unused, NULL);
    return s;
}

void adcgs_splat_scene_free(adcgs_splat_scene **scene)
{
    adcgs_splat_scene *const s = *scene;
    if (s) {
        adcgs_splats_free(&s->splats);
        for (int i = 0; i < ADCGS_SPLAT_STATES; i++)
            adcgs_splats_free(&s->state[i].splats);
        adcgs_dynamic_free(&s->dynamic);
        pthread_mutex_destroy(&s->lock);
        pthread_cond_destroy(&s->unused);
    }
    free(s);
    *scene = NULL;
}

void adcgs_splat_scene_normalise(const adcgs_splat_scene *s, adcgs_splats *splats)
{
    for (uint32_t i = 0; i < splats->n; i++) {
        if (!splats->antialiased) /* else the limit applies in each view */
            splats->opacity[i] = fminf(splats->opacity[i], OPACITY_MAX);
        for (int a = 0; a < 3; a++) {
            const double centre = s->centre[a] - splats->offset[a];
            splats->mean[a][i] = (float)(((double)splats->mean[a][i] - centre) / s->radius);
            splats->scale[a][i] = (float)((double)splats->scale[a][i] / s->radius);
            if (!splats->degree)
                splats->colour[a][i] = fmaxf(splats->colour[a][i], 0.0f);
        }
    }
}

/* ---- States ---- */

/** The state of a time, or the unused one whose last use is longest ago; NULL: all are in use at other times. */
static adcgs_splat_state *choose_state(adcgs_splat_scene *s, double time)
{
    adcgs_splat_state *oldest = NULL;
    for (int i = 0; i < ADCGS_SPLAT_STATES; i++) {
        adcgs_splat_state *const state = &s->state[i];
        if (state->time >= time && state->time <= time)
            return state;
        if (!state->users && (!oldest || state->used < oldest->used))
            oldest = state;
    }
    return oldest;
}

/** Borrows the state of a time until give_back(). It is read under the lock: others wait, which keeps memory low. */
static adcgs_status borrow(adcgs_splat_state **out, adcgs_splat_scene *s, double time, adcgs_error *error)
{
    adcgs_status status = ADCGS_OK;
    adcgs_splat_state *state;
    pthread_mutex_lock(&s->lock);
    while (!(state = choose_state(s, time)))
        pthread_cond_wait(&s->unused, &s->lock);
    if (!(state->time >= time && state->time <= time)) {
        adcgs_splats_free(&state->splats);
        state->time = -1.0;
        status = adcgs_dynamic_at(s->dynamic, time, &state->splats, error);
        if (status == ADCGS_OK) {
            adcgs_splat_scene_normalise(s, &state->splats);
            state->time = time;
        }
    }
    if (status == ADCGS_OK) {
        state->users++;
        state->used = ++s->uses;
    }
    pthread_mutex_unlock(&s->lock);
    *out = state;
    return status;
}

static void give_back(adcgs_splat_scene *s, adcgs_splat_state *state)
{
    pthread_mutex_lock(&s->lock);
    state->users--;
    pthread_cond_broadcast(&s->unused);
    pthread_mutex_unlock(&s->lock);
}

/* ---- Rendering ---- */

/** Computes colours for a camera's viewing directions: [3][slots]. */
static void evaluate_colours(float *colours, size_t slots, const adcgs_splat_scene *s, const adcgs_splats *splats,
                             const adcgs_camera *camera)
{
    const size_t n = (size_t)(splats->degree + 1) * (size_t)(splats->degree + 1) - 1;
    for (uint32_t i = 0; i < splats->n; i++) {
        const float *rest = splats->harmonics + i * 3 * n;
        double d[3], harmonics[ADCGS_HARMONICS_MAX];
        for (int a = 0; a < 3; a++)
            d[a] = (double)splats->mean[a][i] - (camera->cam_to_world[4 * a + 3] - s->centre[a]) / s->radius;
        const double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        for (int a = 0; a < 3; a++)
            d[a] = length > 0.0 ? d[a] / length : 0.0;
        adcgs_harmonics(harmonics, d, splats->degree);
        for (size_t c = 0; c < 3; c++) {
            double value = (double)splats->colour[c][i];
            for (size_t k = 0; k < n; k++)
                value += harmonics[k] * (double)rest[c * n + k];
            colours[c * slots + i] = (float)fmax(value, 0.0);
        }
    }
}

/**
 * The share of a splat's opacity that remains when the screen filter spreads it: sqrt(det S / det(S + filter I)) of its
 * covariance S in the image (Yu et al., Mip-Splatting, 2024), with S from the renderer's projection.
 */
static double share_left(const adcgs_splats *s, uint32_t i, const adcgs_view *view, double filter)
{
    adcgs_projection g;
    adcgs_project_centre(&g, view, s->mean[0][i], s->mean[1][i], s->mean[2][i]);
    adcgs_quaternion_matrix(g.rot, s->rotation[0][i], s->rotation[1][i], s->rotation[2][i], s->rotation[3][i]);
    adcgs_project_shape(&g, view, (float)filter, s->scale[0][i], s->scale[1][i], s->scale[2][i]);
    double det = 0.0, trace = 0.0;
    for (int j = 0; j < 3; j++) { /* S = f f^T: its determinant is the squared length of the cross product of the rows of f */
        const int k = (j + 1) % 3;
        const double cross = (double)g.f[0][j] * (double)g.f[1][k] - (double)g.f[0][k] * (double)g.f[1][j];
        det += cross * cross;
        trace += (double)g.f[0][j] * (double)g.f[0][j] + (double)g.f[1][j] * (double)g.f[1][j];
    }
    const double spread = det + filter * trace + filter * filter;
    return isfinite(spread) ? sqrt(det / spread) : 1.0; /* behind the camera, not rendered */
}

/** Computes opacities for a camera: [slots], zero behind the last splat. */
static void fade(float *opacities, const adcgs_splats *s, const adcgs_view *view)
{
    for (uint32_t i = 0; i < s->n; i++)
        opacities[i] = fminf((float)((double)s->opacity[i] * share_left(s, i, view, (double)ADCGS_SCREEN_FILTER)), OPACITY_MAX);
}

/** Arrays that depend on the camera; NULL if they do not. */
typedef struct workspace {
    size_t slots;
    float *colours, *opacities; /**< [3][slots], [slots] */
} workspace;

static adcgs_status workspace_make(workspace *w, const adcgs_splats *s, const char *path, adcgs_error *error)
{
    w->slots = ((size_t)s->n + 63) / 64 * 64;
    w->colours = s->degree ? aligned_alloc(64, 3 * w->slots * sizeof *w->colours) : NULL;
    w->opacities = s->antialiased ? aligned_alloc(64, w->slots * sizeof *w->opacities) : NULL;
    if ((s->degree && !w->colours) || (s->antialiased && !w->opacities))
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for a view", path);
    if (w->colours)
        memset(w->colours, 0, 3 * w->slots * sizeof *w->colours);
    if (w->opacities)
        memset(w->opacities, 0, w->slots * sizeof *w->opacities);
    return ADCGS_OK;
}

static adcgs_status draw(float *rgb, const adcgs_splat_scene *s, const adcgs_splats *splats, const float background[3],
                         const adcgs_camera *camera, const workspace *w, adcgs_error *error)
{
    adcgs_cpu_level cpu;
    adcgs_raster *raster = NULL;
    adcgs_primitives primitives;
    adcgs_view view;
    adcgs_splats_primitives(splats, &primitives);
    ADCGS_TRY(adcgs_cpu_resolve(ADCGS_CPU_AUTO, &cpu, error)); /* the image does not depend on it */
    ADCGS_TRY(adcgs_view_init(&view, camera, s->centre, s->radius, error));
    if (w->colours)
        evaluate_colours(w->colours, w->slots, s, splats, camera);
    for (size_t c = 0; c < 3 && w->colours; c++)
        primitives.colour[c] = w->colours + c * w->slots;
    if (w->opacities) {
        fade(w->opacities, splats, &view);
        primitives.opacity = w->opacities;
    }
    ADCGS_TRY(adcgs_raster_create(&raster, cpu, NULL, NULL, error));
    const adcgs_status status = adcgs_raster_forward(raster, &primitives, &view, background, ADCGS_SCREEN_FILTER, rgb, 0, error);
    adcgs_raster_free(&raster);
    return status;
}

static adcgs_status render(const adcgs_splat_scene *scene, const adcgs_splats *splats, const float background[3],
                           const adcgs_camera *camera, adcgs_image *out, const char *path, adcgs_error *error)
{
    const size_t plane = (size_t)camera->width * (size_t)camera->height;
    float *planar = malloc(3 * plane * sizeof *planar);
    workspace w = {0};
    adcgs_status status = planar ? workspace_make(&w, splats, path, error)
                                 : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for a view", path);
    if (status == ADCGS_OK)
        status = adcgs_image_alloc(out, camera->width, camera->height, 3, path, error);
    if (status == ADCGS_OK) {
        status = draw(planar, scene, splats, background, camera, &w, error);
        for (size_t i = 0; i < 3 * plane && status == ADCGS_OK; i++)
            out->data[i] = fminf(fmaxf(planar[i % 3 * plane + i / 3], 0.0f), 1.0f);
        if (status != ADCGS_OK) {
            adcgs_error_locate(error, path);
            adcgs_image_free(out);
        }
    }
    free(planar);
    free(w.colours);
    free(w.opacities);
    return status;
}

adcgs_status adcgs_splat_scene_render(adcgs_splat_scene *scene, const float background[3], const adcgs_camera *camera,
                                      double time, adcgs_image *out, const char *path, adcgs_error *error)
{
    adcgs_splat_state *state;
    if (!scene->dynamic)
        return render(scene, &scene->splats, background, camera, out, path, error);
    ADCGS_TRY(borrow(&state, scene, time, error));
    const adcgs_status status = render(scene, &state->splats, background, camera, out, path, error);
    give_back(scene, state);
    return status;
}
