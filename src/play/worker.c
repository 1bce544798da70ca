/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The thread that renders. */
#include "config.h"

#include "play/worker.h"

#include "camera/pivot.h"
#include "media/image/image.h"

#include <adcgs/decoder.h>
#include <adcgs/frame.h>

#include <pthread.h>
#include <stdlib.h>

typedef enum stage {
    IDLE, /* a job may be posted */
    BUSY, /* the thread has a job */
    DONE, /* the result may be taken */
    LEAVE
} stage;

struct adcgs_worker {
    adcgs_play_source source;
    adcgs_config config;
    void (*wake)(void *arg);
    void *arg;

    pthread_t thread;
    int running;
    pthread_mutex_t lock; /**< protects stage; the members below belong to the thread while it is BUSY, else to the caller */
    pthread_cond_t changed;
    stage stage;

    adcgs_intake intake;    /**< of the feed, if there is one */
    adcgs_decoder *decoder; /**< otherwise */
    int layers;             /**< with which the decoder was opened */
    float *values;
    uint8_t *rgb;
    size_t room; /**< samples in both */
    adcgs_play_result result;
};

/** Opens the stream for a number of layers; after a failure, the open stream stays. */
static adcgs_status open_layers(adcgs_worker *w, int layers, adcgs_error *error)
{
    adcgs_decoder *decoder;
    if (w->decoder && w->layers == layers)
        return ADCGS_OK;
    w->config.layers = layers;
    const adcgs_status status = adcgs_open_memory(&decoder, w->source.data, w->source.bytes, &w->config, error);
    if (status != ADCGS_OK) {
        adcgs_error_locate(error, w->source.path);
        return status;
    }
    adcgs_close(&w->decoder);
    w->decoder = decoder;
    w->layers = layers;
    return ADCGS_OK;
}

static adcgs_status reserve(adcgs_worker *w, size_t samples, adcgs_error *error)
{
    if (samples <= w->room)
        return ADCGS_OK;
    free(w->values);
    free(w->rgb);
    w->room = 0;
    w->values = malloc(samples * sizeof *w->values);
    w->rgb = malloc(samples);
    if (!w->values || !w->rgb)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for an image of %zu samples", samples);
    w->room = samples;
    return ADCGS_OK;
}

static adcgs_status draw(adcgs_worker *w, adcgs_decoder *decoder)
{
    adcgs_play_result *const r = &w->result;
    const adcgs_camera *const camera = &r->job.camera;
    const size_t samples = 3 * (size_t)camera->width * (size_t)camera->height;
    adcgs_primitives splats;
    ADCGS_TRY(adcgs_set_tiers(decoder, r->job.tiers, &r->error));
    ADCGS_TRY(reserve(w, samples, &r->error));
    adcgs_frame frame = {.width = camera->width, .height = camera->height, .rgb = w->values};
    const double start = adcgs_seconds();
    ADCGS_TRY(adcgs_render(decoder, camera, r->job.time, &frame, &r->error));
    adcgs_frame_to_u8(&frame, w->rgb);
    r->seconds = adcgs_seconds() - start;
    ADCGS_TRY(adcgs_get_primitives(decoder, r->job.time, &splats, &r->error)); /* available without computation */
    for (uint32_t i = 0; i < splats.n; i++)
        r->splats += splats.opacity[i] > 0;
    r->rgb = w->rgb;
    if (r->job.pivot) /* without an answer the old pivot remains */
        r->has_pivot =
            adcgs_pivot_find(r->pivot, decoder, camera, r->job.time, r->job.pivot_at[0], r->job.pivot_at[1], NULL) == ADCGS_OK;
    if (r->job.sink)
        ADCGS_TRY(adcgs_sink_write(r->job.sink, &frame, r->job.number, &r->error));
    const adcgs_image image = {.width = frame.width, .height = frame.height, .channels = 3, .data = frame.rgb};
    const adcgs_image_options options = {.half = 1, .camera = camera, .time = r->job.time};
    return *r->job.path ? adcgs_image_write_as(&image, &options, r->job.path, &r->error) : ADCGS_OK;
}

/**
 * Decodes some of the received bytes, and renders if the result has changed. An image for a file shows the same decoded part as
 * the window.
 */
static adcgs_status draw_coming(adcgs_worker *w)
{
    adcgs_play_result *const r = &w->result;
    int changed;
    const adcgs_status status = adcgs_intake_take(&w->intake, r->job.layers, !*r->job.path, &changed, &r->error);
    r->come = w->intake.come;
    if (status != ADCGS_OK || !r->come.drawable || (r->job.again && !changed))
        return status;
    return draw(w, w->intake.decoder);
}

static adcgs_status do_job(adcgs_worker *w)
{
    if (w->source.feed)
        return draw_coming(w);
    ADCGS_TRY(open_layers(w, w->result.job.layers, &w->result.error));
    return draw(w, w->decoder);
}

static void set_stage(adcgs_worker *w, stage next)
{
    pthread_mutex_lock(&w->lock);
    if (w->stage != LEAVE)
        w->stage = next;
    pthread_cond_broadcast(&w->changed);
    pthread_mutex_unlock(&w->lock);
}

static stage wait_for_job(adcgs_worker *w)
{
    pthread_mutex_lock(&w->lock);
    while (w->stage != BUSY && w->stage != LEAVE)
        pthread_cond_wait(&w->changed, &w->lock);
    const stage now = w->stage;
    pthread_mutex_unlock(&w->lock);
    return now;
}

static void *work(void *arg)
{
    adcgs_worker *const w = arg;
    while (wait_for_job(w) == BUSY) {
        w->result.status = do_job(w);
        set_stage(w, DONE);
        w->wake(w->arg);
    }
    return NULL;
}

adcgs_status adcgs_worker_create(adcgs_worker **out, const adcgs_play_source *source, const adcgs_config *config,
                                 void (*wake)(void *arg), void *arg, adcgs_error *error)
{
    adcgs_worker *w = *out = calloc(1, sizeof *w);
    if (!w)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for the player");
    w->source = *source;
    w->config = *config;
    adcgs_intake_init(&w->intake, source->feed, config);
    w->wake = wake;
    w->arg = arg;
    pthread_mutex_init(&w->lock, NULL);
    pthread_cond_init(&w->changed, NULL);
    w->running = !pthread_create(&w->thread, NULL, work, w);
    if (w->running)
        return ADCGS_OK;
    adcgs_worker_free(out);
    return adcgs_fail(error, ADCGS_ERR_MEMORY, "cannot start a thread for the player");
}

void adcgs_worker_free(adcgs_worker **worker)
{
    adcgs_worker *w = *worker;
    *worker = NULL;
    if (!w)
        return;
    set_stage(w, LEAVE);
    if (w->running)
        pthread_join(w->thread, NULL);
    adcgs_close(&w->decoder);
    adcgs_intake_clear(&w->intake);
    pthread_cond_destroy(&w->changed);
    pthread_mutex_destroy(&w->lock);
    free(w->values);
    free(w->rgb);
    free(w);
}

static int is_at(adcgs_worker *w, stage wanted)
{
    pthread_mutex_lock(&w->lock);
    const int is = w->stage == wanted;
    pthread_mutex_unlock(&w->lock);
    return is;
}

int adcgs_worker_post(adcgs_worker *w, const adcgs_play_job *job)
{
    if (!is_at(w, IDLE))
        return 0;
    w->result = (adcgs_play_result){.job = *job};
    set_stage(w, BUSY);
    return 1;
}

const adcgs_play_result *adcgs_worker_result(adcgs_worker *w)
{
    return is_at(w, DONE) ? &w->result : NULL;
}

void adcgs_worker_release(adcgs_worker *w)
{
    set_stage(w, IDLE);
}
