/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Images kept in memory and in a file. */
#include "config.h"

#include "scene/image_store.h"

#include "scene/clips.h"
#include "scene/image_cache.h"
#include "scene/image_values.h"
#include "scene/spool.h"

#include <errno.h>
#include <fcntl.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <math.h>
#include <pthread.h>
#include <stdlib.h>

typedef enum place { IN_MEMORY, IN_FILE, NOWHERE } place; /* NOWHERE: decoded again for each use */

typedef struct picture {
    adcgs_camera camera;
    void *values;                     /**< if in memory */
    const adcgs_packed_image *shared; /**< instead of values: an image of the scene, with the same values; or NULL */
    uint64_t at;                      /**< offset, if in the file */
    place place;
    uint8_t bytes;   /**< size of a value: 1, 2, or 4 for binary32 */
    uint8_t *hidden; /**< [height * width] pixels that are unknown; values holds 0 for them; NULL: none */
} picture;

struct adcgs_image_store {
    const adcgs_scene *scene;
    adcgs_image_store_config config;
    uint32_t n;
    picture *list;
    pthread_mutex_t lock; /**< protects the members below, while loading */
    adcgs_spool spool;
    uint64_t held;
    uint32_t nowhere; /**< images that are decoded again */
};

/* ---- Values ---- */

static size_t values_of(const picture *p)
{
    return 3 * (size_t)p->camera.width * (size_t)p->camera.height;
}

static size_t bytes_of(const picture *p)
{
    return values_of(p) * p->bytes;
}

/** Records the unknown pixels and replaces them by 0, which can be stored. */
static adcgs_status hide(picture *p, float *rgb, adcgs_error *error)
{
    const size_t plane = values_of(p) / 3;
    free(p->hidden);
    p->hidden = NULL;
    for (size_t i = 0; i < plane; i++) {
        if (!isnan(rgb[i]))
            continue;
        if (!p->hidden && !(p->hidden = calloc(plane, 1)))
            return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for a mask");
        p->hidden[i] = 1;
        for (size_t c = 0; c < 3; c++)
            rgb[c * plane + i] = 0.0f;
    }
    return ADCGS_OK;
}

static void show_hidden(const picture *p, float *rgb)
{
    const size_t plane = values_of(p) / 3;
    for (size_t i = 0; p->hidden && i < plane; i++)
        for (size_t c = 0; p->hidden[i] && c < 3; c++)
            rgb[c * plane + i] = (float)NAN;
}

/* ---- Loading ---- */

/** Counts bytes of memory among those of the scene's images, which give way. */
static void charge(const adcgs_image_store *p, int64_t bytes)
{
    if (p->scene->images)
        adcgs_image_cache_charge(p->scene->images, bytes);
}

/** Decides where an image is kept. */
static void find_place(adcgs_image_store *p, picture *to, int can_decode)
{
    const size_t bytes = bytes_of(to);
    pthread_mutex_lock(&p->lock);
    to->place = p->held + bytes <= p->config.memory           ? IN_MEMORY
                : adcgs_spool_take(&p->spool, bytes, &to->at) ? IN_FILE
                : can_decode                                  ? NOWHERE
                                                              : IN_MEMORY;
    p->held += to->place == IN_MEMORY ? bytes : 0;
    p->nowhere += to->place == NOWHERE;
    pthread_mutex_unlock(&p->lock);
}

/** Other processes took the room, or the disk fails: the file does not grow any further. */
static void give_up_file(adcgs_image_store *p, picture *to, int problem)
{
    pthread_mutex_lock(&p->lock);
    to->place = NOWHERE;
    p->nowhere++;
    p->spool.problem = problem;
    pthread_mutex_unlock(&p->lock);
}

/** can_decode: the image comes from the scene, and can be decoded from its files again. */
static adcgs_status keep(adcgs_image_store *p, picture *to, float *rgb, int can_decode, adcgs_error *error)
{
    const adcgs_status status = hide(to, rgb, error);
    if (status != ADCGS_OK) {
        free(rgb);
        return status;
    }
    to->bytes = adcgs_values_narrow(rgb, values_of(to));
    find_place(p, to, can_decode);
    const int problem = to->place == IN_FILE ? adcgs_spool_write(&p->spool, rgb, bytes_of(to), to->at) : 0;
    if (problem && can_decode)
        give_up_file(p, to, problem);
    else if (problem)
        to->place = IN_MEMORY;
    if (to->place == IN_MEMORY) {
        charge(p, (int64_t)bytes_of(to));
        void *const fitted = realloc(rgb, bytes_of(to));
        to->values = fitted ? fitted : rgb;
    } else
        free(rgb);
    return ADCGS_OK;
}

typedef struct load_job {
    adcgs_image_store *pictures;
    adcgs_view_runs runs;
    adcgs_error *errors; /**< one for each view */
    uint32_t done;       /**< protected by the lock */
    int stop;            /**< likewise */
} load_job;

/** Shares an image with the scene, if it has the same values and room. *shared: it does. */
static adcgs_status share(adcgs_image_store *p, uint32_t view, int *shared, adcgs_error *error)
{
    const adcgs_scene_view *const v = &p->scene->views[p->config.split][view];
    picture *to = &p->list[view];
    const adcgs_packed_image *image;
    *shared = 0;
    ADCGS_TRY(adcgs_scene_borrow(p->scene, v, p->config.divide, &image, error));
    if (!image)
        return ADCGS_OK;
    to->camera = v->camera;
    to->bytes = (uint8_t)image->bytes;
    pthread_mutex_lock(&p->lock);
    *shared = p->held + bytes_of(to) <= p->config.memory;
    p->held += *shared ? bytes_of(to) : 0;
    pthread_mutex_unlock(&p->lock);
    to->place = IN_MEMORY;
    to->shared = *shared ? image : NULL;
    if (!*shared)
        adcgs_scene_give_back(p->scene, image);
    return ADCGS_OK;
}

/** Frees the memory of an image. */
static void let_go(adcgs_image_store *p, picture *of)
{
    if (of->values)
        charge(p, -(int64_t)bytes_of(of));
    if (of->shared)
        adcgs_scene_give_back(p->scene, of->shared);
    free(of->values);
    of->values = NULL;
    of->shared = NULL;
}

static adcgs_status load_view(adcgs_image_store *p, uint32_t view, adcgs_error *error)
{
    float *rgb;
    int shared;
    ADCGS_TRY(share(p, view, &shared, error));
    if (shared && !p->config.thumbnails)
        return ADCGS_OK;
    ADCGS_TRY(adcgs_scene_image(p->scene, &p->scene->views[p->config.split][view], p->config.divide, &rgb, &p->list[view].camera,
                                error));
    if (p->config.thumbnails)
        adcgs_thumbnail_compute(&p->config.thumbnails[view], rgb, p->list[view].camera.width, p->list[view].camera.height);
    if (!shared)
        return keep(p, &p->list[view], rgb, 1, error);
    free(rgb);
    return ADCGS_OK;
}

/** Counts an image as loaded, or as failed. \return true to continue */
static int tell(load_job *job, adcgs_status status)
{
    adcgs_image_store *p = job->pictures;
    pthread_mutex_lock(&p->lock);
    job->done += status == ADCGS_OK;
    if (status == ADCGS_OK && !job->stop && p->config.progress)
        job->stop = p->config.progress(p->config.user, job->done, p->n);
    const int on = status == ADCGS_OK && !job->stop;
    pthread_mutex_unlock(&p->lock);
    return on;
}

/** One thread reads a video to its end or its first error, or a single image. */
static void load_run(void *arg, int run, int thread)
{
    load_job *job = arg;
    int on = 1;
    for (uint32_t i = job->runs.begin[run]; on && i < job->runs.begin[run + 1]; i++) {
        adcgs_error *error = &job->errors[job->runs.order[i]];
        error->status = load_view(job->pictures, job->runs.order[i], error);
        on = tell(job, error->status);
    }
}

static adcgs_status first_error(const load_job *job, adcgs_error *error)
{
    for (uint32_t i = 0; i < job->pictures->n; i++)
        if (job->errors[i].status != ADCGS_OK) {
            if (error)
                *error = job->errors[i];
            return job->errors[i].status;
        }
    return job->stop ? adcgs_fail(error, ADCGS_ERR_IO, "interrupted while images were loaded") : ADCGS_OK;
}

static adcgs_status load_all(adcgs_image_store *p, adcgs_pool *pool, adcgs_error *error)
{
    load_job job = {.pictures = p, .errors = calloc(ADCGS_MAX(p->n, 1), sizeof *job.errors)};
    adcgs_status status = job.errors ? adcgs_view_runs_make(&job.runs, p->scene->views[p->config.split], p->n, error)
                                     : adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for images");
    if (status == ADCGS_OK) {
        adcgs_pool_run(pool, load_run, &job, (int)job.runs.n);
        status = first_error(&job, error);
    }
    adcgs_view_runs_clear(&job.runs);
    free(job.errors);
    return status;
}

adcgs_status adcgs_image_store_load(adcgs_image_store **out, const adcgs_scene *scene, const adcgs_image_store_config *config,
                                    adcgs_pool *pool, adcgs_error *error)
{
    adcgs_image_store *p = calloc(1, sizeof *p);
    *out = NULL;
    if (!p)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for images");
    p->scene = scene;
    p->config = *config;
    p->config.memory = config->memory ? config->memory : adcgs_image_store_default_memory();
    p->n = scene->n_views[config->split];
    pthread_mutex_init(&p->lock, NULL);
    p->list = calloc(ADCGS_MAX(p->n, 1), sizeof *p->list);
    adcgs_status status = adcgs_spool_init(&p->spool, error);
    if (status == ADCGS_OK)
        status = p->list ? load_all(p, pool, error) : adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for %u images", p->n);
    if (status != ADCGS_OK)
        adcgs_image_store_free(&p);
    *out = p;
    return status;
}

void adcgs_image_store_free(adcgs_image_store **pictures)
{
    adcgs_image_store *p = *pictures;
    if (!p)
        return;
    for (uint32_t i = 0; p->list && i < p->n; i++) {
        let_go(p, &p->list[i]);
        free(p->list[i].hidden);
    }
    adcgs_spool_clear(&p->spool);
    pthread_mutex_destroy(&p->lock);
    free(p->list);
    free(p);
    *pictures = NULL;
#ifdef __GLIBC__
    malloc_trim(0); /* images of another size do not fit into the gaps */
#endif
}

/* ---- Use ---- */

const adcgs_camera *adcgs_image_store_camera(const adcgs_image_store *pictures, uint32_t view)
{
    return &pictures->list[view].camera;
}

/** Decodes an image from the scene's files, to the same values as stored ones. */
static adcgs_status decode_again(const adcgs_image_store *pictures, uint32_t view, float *rgb, adcgs_error *error)
{
    const picture *p = &pictures->list[view];
    const adcgs_scene_view *v = &pictures->scene->views[pictures->config.split][view];
    float *values;
    ADCGS_TRY(adcgs_scene_image(pictures->scene, v, pictures->config.divide, &values, NULL, error));
    for (size_t i = 0; i < values_of(p); i++) {
        const float x = isnan(values[i]) ? 0.0f : values[i];
        rgb[i] = p->bytes == sizeof *rgb ? x : adcgs_value_round(x);
    }
    free(values);
    return ADCGS_OK;
}

/** \return 0, or errno if nothing was read */
static int read_file(const adcgs_image_store *pictures, const picture *p, float *rgb)
{
    void *const values = malloc(bytes_of(p));
    const int problem = values ? adcgs_spool_read(&pictures->spool, values, bytes_of(p), p->at) : ENOMEM;
    if (!problem)
        adcgs_values_widen(rgb, 1, values, p->bytes, values_of(p));
    free(values);
    return problem;
}

adcgs_status adcgs_image_store_get(const adcgs_image_store *pictures, uint32_t view, float *rgb, adcgs_error *error)
{
    const picture *p = &pictures->list[view];
    if (p->shared)
        adcgs_packed_image_planes(p->shared, rgb);
    else if (p->place == IN_MEMORY)
        adcgs_values_widen(rgb, 1, p->values, p->bytes, values_of(p));
    else if (p->place == NOWHERE || read_file(pictures, p, rgb))
        ADCGS_TRY(decode_again(pictures, view, rgb, error));
    show_hidden(p, rgb);
    return ADCGS_OK;
}

const uint8_t *adcgs_image_store_mask(const adcgs_image_store *pictures, uint32_t view)
{
    return pictures->list[view].hidden;
}

adcgs_status adcgs_image_store_put(adcgs_image_store *pictures, uint32_t view, const float *rgb, adcgs_error *error)
{
    picture *p = &pictures->list[view];
    float *copy = malloc(values_of(p) * sizeof *copy);
    if (!copy)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for an image");
    memcpy(copy, rgb, values_of(p) * sizeof *copy);
    if (p->place == IN_MEMORY)
        pictures->held -= bytes_of(p);
    pictures->nowhere -= p->place == NOWHERE;
    let_go(pictures, p);
    return keep(pictures, p, copy, 0, error);
}

void adcgs_image_store_prefetch(const adcgs_image_store *pictures, uint32_t view)
{
    const picture *p = &pictures->list[view];
    if (p->place == IN_FILE)
        posix_fadvise(pictures->spool.file, (off_t)p->at, (off_t)bytes_of(p), POSIX_FADV_WILLNEED);
}

void adcgs_image_store_size(const adcgs_image_store *pictures, uint64_t *memory, uint64_t *file)
{
    *memory = pictures->held;
    *file = pictures->spool.used;
}

uint32_t adcgs_image_store_decoded_again(const adcgs_image_store *pictures, const char **why)
{
    *why = strerror(pictures->spool.problem ? pictures->spool.problem : ENOSPC);
    return pictures->nowhere;
}
