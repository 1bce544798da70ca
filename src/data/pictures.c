/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Pictures kept in memory and in a file. */
#include "config.h"

#include "data/pictures.h"

#include "data/clips.h"
#include "data/paths.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <unistd.h>

#define FULL 65535.0f

typedef struct picture {
    adcgs_camera camera;
    void *values;  /**< NULL: in the file */
    uint64_t at;   /**< in the file */
    int wide;      /**< binary32, else 16 bits */
    uint8_t *hidden; /**< [height * width] pixels that are not known, which values hold as 0; NULL: all are */
} picture;

struct adcgs_pictures {
    const adcgs_scene *scene;
    adcgs_pictures_config config;
    uint32_t n;
    picture *list;
    int file;          /**< -1: none yet */
    char *folder;      /**< of the file */
    pthread_mutex_t lock; /**< for what follows, while loading */
    uint64_t held, spooled;
};

/* ---- Values ---- */

static size_t values_of(const picture *p)
{
    return 3 * (size_t)p->camera.width * (size_t)p->camera.height;
}

static size_t bytes_of(const picture *p)
{
    return values_of(p) * (p->wide ? sizeof(float) : sizeof(uint16_t));
}

static int is_wide(const float *rgb, size_t n)
{
    int wide = 0;
    for (size_t i = 0; i < n; i++)
        wide |= !(rgb[i] >= 0.0f && rgb[i] <= 1.0f);
    return wide;
}

/** In place: sixteen bits are never ahead of the thirty-two they come from. */
static void narrow(float *rgb, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        const uint16_t value = (uint16_t)(rgb[i] * FULL + 0.5f);
        memcpy((char *)rgb + i * sizeof value, &value, sizeof value);
    }
}

static void widen(float *rgb, const uint16_t *values, size_t n)
{
    for (size_t i = 0; i < n; i++)
        rgb[i] = (float)values[i] / FULL;
}

/** Note which pixels are not known, and give them a value that can be kept. */
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

/* ---- The file ---- */

static adcgs_status open_file(adcgs_pictures *p, adcgs_error *error)
{
    char *name = adcgs_path("%s/adcgs-XXXXXX", p->folder);
    if (!name)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for pictures");
    p->file = mkstemp(name);
    const int problem = errno;
    if (p->file >= 0)
        unlink(name);
    free(name);
    return p->file >= 0 ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot keep pictures there: %s", p->folder,
                                                strerror(problem));
}

static adcgs_status write_values(adcgs_pictures *p, const void *values, size_t bytes, uint64_t at, adcgs_error *error)
{
    for (size_t done = 0; done < bytes;) {
        const ssize_t n = pwrite(p->file, (const char *)values + done, bytes - done, (off_t)(at + done));
        if (n <= 0 && errno != EINTR)
            return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot keep pictures there: %s; more memory or another TMPDIR may help",
                              p->folder, strerror(errno));
        done += n > 0 ? (size_t)n : 0;
    }
    return ADCGS_OK;
}

static adcgs_status read_values(const adcgs_pictures *p, void *values, size_t bytes, uint64_t at, adcgs_error *error)
{
    for (size_t done = 0; done < bytes;) {
        const ssize_t n = pread(p->file, (char *)values + done, bytes - done, (off_t)(at + done));
        if (n == 0 || (n < 0 && errno != EINTR))
            return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot read back a picture: %s", p->folder,
                              n ? strerror(errno) : "the file ends early");
        done += n > 0 ? (size_t)n : 0;
    }
    return ADCGS_OK;
}

/* ---- Loading ---- */

/** Where a picture of so many bytes goes: *at is its place in the file, or it is left in memory. */
static adcgs_status find_place(adcgs_pictures *p, size_t bytes, int *in_memory, uint64_t *at, adcgs_error *error)
{
    adcgs_status status = ADCGS_OK;
    pthread_mutex_lock(&p->lock);
    *in_memory = p->held + bytes <= p->config.memory;
    if (!*in_memory && p->file < 0)
        status = open_file(p, error);
    *at = p->spooled;
    *(*in_memory ? &p->held : &p->spooled) += bytes;
    pthread_mutex_unlock(&p->lock);
    return status;
}

static adcgs_status keep(adcgs_pictures *p, picture *to, float *rgb, adcgs_error *error)
{
    int in_memory;
    adcgs_status status = hide(to, rgb, error);
    if (status != ADCGS_OK) {
        free(rgb);
        return status;
    }
    to->wide = is_wide(rgb, values_of(to));
    if (!to->wide)
        narrow(rgb, values_of(to));
    status = find_place(p, bytes_of(to), &in_memory, &to->at, error);
    if (status == ADCGS_OK && in_memory) {
        void *const fitted = realloc(rgb, bytes_of(to));
        to->values = fitted ? fitted : rgb;
        return ADCGS_OK;
    }
    if (status == ADCGS_OK)
        status = write_values(p, rgb, bytes_of(to), to->at, error);
    free(rgb);
    return status;
}

typedef struct load_job {
    adcgs_pictures *pictures;
    adcgs_view_runs runs;
    adcgs_error *errors; /**< of each view */
    uint32_t done;       /**< under the lock */
    int stop;            /**< likewise */
} load_job;

static adcgs_status load(adcgs_pictures *p, uint32_t view, adcgs_error *error)
{
    float *rgb;
    ADCGS_TRY(adcgs_scene_load(p->scene, &p->scene->views[p->config.split][view], p->config.divide, &rgb, &p->list[view].camera,
                               error));
    if (p->config.glances)
        adcgs_glance_take(&p->config.glances[view], rgb, p->list[view].camera.width, p->list[view].camera.height);
    return keep(p, &p->list[view], rgb, error);
}

/** Count a picture, or one that failed. \return whether to go on. */
static int tell(load_job *job, adcgs_status status)
{
    adcgs_pictures *p = job->pictures;
    pthread_mutex_lock(&p->lock);
    job->done += status == ADCGS_OK;
    if (status == ADCGS_OK && !job->stop && p->config.progress)
        job->stop = p->config.progress(p->config.user, job->done, p->n);
    const int on = status == ADCGS_OK && !job->stop;
    pthread_mutex_unlock(&p->lock);
    return on;
}

/** One thread reads a video from its beginning to its end or its first fault, or one picture. */
static void load_run(void *arg, int run, int thread)
{
    load_job *job = arg;
    int on = 1;
    for (uint32_t i = job->runs.begin[run]; on && i < job->runs.begin[run + 1]; i++) {
        adcgs_error *error = &job->errors[job->runs.order[i]];
        error->status = load(job->pictures, job->runs.order[i], error);
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
    return job->stop ? adcgs_fail(error, ADCGS_ERR_IO, "interrupted while pictures were loaded") : ADCGS_OK;
}

static adcgs_status load_all(adcgs_pictures *p, adcgs_pool *pool, adcgs_error *error)
{
    load_job job = {.pictures = p, .errors = calloc(ADCGS_MAX(p->n, 1), sizeof *job.errors)};
    adcgs_status status = job.errors ? adcgs_view_runs_make(&job.runs, p->scene->views[p->config.split], p->n, error)
                                     : adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for pictures");
    if (status == ADCGS_OK) {
        adcgs_pool_run(pool, load_run, &job, (int)job.runs.n);
        status = first_error(&job, error);
    }
    adcgs_view_runs_clear(&job.runs);
    free(job.errors);
    return status;
}

uint64_t adcgs_pictures_usual_memory(void)
{
    const long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGESIZE);
    return pages > 0 && size > 0 ? (uint64_t)pages * (uint64_t)size / 2 : (uint64_t)1 << 30;
}

adcgs_status adcgs_pictures_load(adcgs_pictures **out, const adcgs_scene *scene, const adcgs_pictures_config *config,
                                 adcgs_pool *pool, adcgs_error *error)
{
    adcgs_pictures *p = calloc(1, sizeof *p);
    *out = NULL;
    if (!p)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for pictures");
    p->scene = scene;
    p->config = *config;
    p->config.memory = config->memory ? config->memory : adcgs_pictures_usual_memory();
    p->n = scene->n_views[config->split];
    p->file = -1;
    pthread_mutex_init(&p->lock, NULL);
    p->list = calloc(ADCGS_MAX(p->n, 1), sizeof *p->list);
    const char *const chosen = getenv("TMPDIR");
    p->folder = strdup(chosen && *chosen ? chosen : "/var/tmp");
    const adcgs_status status = p->list && p->folder
                                    ? load_all(p, pool, error)
                                    : adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for %u pictures", p->n);
    if (status != ADCGS_OK)
        adcgs_pictures_free(&p);
    *out = p;
    return status;
}

void adcgs_pictures_free(adcgs_pictures **pictures)
{
    adcgs_pictures *p = *pictures;
    if (!p)
        return;
    for (uint32_t i = 0; p->list && i < p->n; i++) {
        free(p->list[i].values);
        free(p->list[i].hidden);
    }
    if (p->file >= 0)
        close(p->file);
    pthread_mutex_destroy(&p->lock);
    free(p->folder);
    free(p->list);
    free(p);
    *pictures = NULL;
}

/* ---- Use ---- */

const adcgs_camera *adcgs_pictures_camera(const adcgs_pictures *pictures, uint32_t view)
{
    return &pictures->list[view].camera;
}

/** As they are kept. */
static adcgs_status get_values(const adcgs_pictures *pictures, const picture *p, float *rgb, adcgs_error *error)
{
    const size_t n = values_of(p);
    if (p->values && p->wide)
        memcpy(rgb, p->values, bytes_of(p));
    else if (p->values)
        widen(rgb, p->values, n);
    else if (p->wide)
        return read_values(pictures, rgb, bytes_of(p), p->at, error);
    else {
        uint16_t *values = malloc(bytes_of(p));
        const adcgs_status status = values ? read_values(pictures, values, bytes_of(p), p->at, error)
                                           : adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for a picture");
        if (status == ADCGS_OK)
            widen(rgb, values, n);
        free(values);
        return status;
    }
    return ADCGS_OK;
}

adcgs_status adcgs_pictures_get(const adcgs_pictures *pictures, uint32_t view, float *rgb, adcgs_error *error)
{
    const picture *p = &pictures->list[view];
    ADCGS_TRY(get_values(pictures, p, rgb, error));
    show_hidden(p, rgb);
    return ADCGS_OK;
}

const uint8_t *adcgs_pictures_hidden(const adcgs_pictures *pictures, uint32_t view)
{
    return pictures->list[view].hidden;
}

adcgs_status adcgs_pictures_put(adcgs_pictures *pictures, uint32_t view, const float *rgb, adcgs_error *error)
{
    picture *p = &pictures->list[view];
    float *copy = malloc(values_of(p) * sizeof *copy);
    if (!copy)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for a picture");
    memcpy(copy, rgb, values_of(p) * sizeof *copy);
    if (p->values)
        pictures->held -= bytes_of(p);
    free(p->values);
    p->values = NULL;
    return keep(pictures, p, copy, error);
}

void adcgs_pictures_expect(const adcgs_pictures *pictures, uint32_t view)
{
    const picture *p = &pictures->list[view];
    if (!p->values)
        posix_fadvise(pictures->file, (off_t)p->at, (off_t)bytes_of(p), POSIX_FADV_WILLNEED);
}

void adcgs_pictures_size(const adcgs_pictures *pictures, uint64_t *memory, uint64_t *file)
{
    *memory = pictures->held;
    *file = pictures->spooled;
}
