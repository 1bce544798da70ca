/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-dec --play: from the command line to the player. */
#include "config.h"

#include "apps/dec/dec_play.h"

#include <stdlib.h>

#ifdef HAVE_ENCODER

#include "media/kind.h"
#include "media/operand.h"
#include "net/http.h"
#include "play/play.h"
#include "stream/salvage.h"
#include "system/interrupt.h"

#include <adcgs/decoder.h>

/* Bytes, which the player keeps to open the stream with other layers; chosen by hand, not measured. */
#define STREAM_BYTES_MAX ((uint64_t)1 << 32)

/** Collects the stream's properties for the player. The caller frees the cameras. */
static adcgs_status collect_properties(const adcgs_dec_play *how, adcgs_decoder *decoder, adcgs_play_settings *settings,
                                       adcgs_filmed_camera **cameras, adcgs_error *error)
{
    adcgs_info *const info = &settings->info;
    adcgs_camera_path_request request = how->request;
    adcgs_camera_path frames;
    ADCGS_TRY(adcgs_get_info(decoder, info, sizeof *info, error));
    ADCGS_TRY(adcgs_camera_path_check_times(info, &request, error));
    ADCGS_TRY(adcgs_filmed_cameras_get(cameras, decoder, info, error));
    /* The first view is the camera of a single frame; the window keeps its shape, so the view is not stretched to a size. */
    request.has_times = 1;
    request.begin = request.end = info->time_start;
    request.size[0] = request.size[1] = 0;
    ADCGS_TRY(adcgs_camera_path_make(&frames, decoder, &request, error));
    settings->home = frames.frame[0].camera;
    adcgs_camera_path_free(&frames);
    settings->cameras = *cameras;
    return adcgs_filmed_view_init(settings->filmed, info, *cameras, &settings->home, error);
}

static void set_times(const adcgs_camera_path_request *request, adcgs_play_settings *settings)
{
    const int is_span = request->has_times && request->begin < request->end;
    settings->is_span = is_span;
    settings->begin = is_span ? request->begin : settings->info.time_start;
    settings->end = is_span ? request->end : settings->info.time_end;
    settings->paused = request->has_times && !is_span;
    settings->start = settings->paused ? request->begin : settings->begin;
}

/** Decodes the available bytes until the first view is known: to the cameras, or to the first segment that can be rendered. */
static adcgs_status decode_parts(adcgs_decoder *decoder, adcgs_feed *feed, adcgs_error *error)
{
    uint8_t piece[4096];
    uint64_t taken = 0;
    for (int ended = 0; !ended && !adcgs_interrupted();) {
        const size_t n = adcgs_feed_copy(feed, taken, piece, sizeof piece);
        size_t used = 0;
        adcgs_arrival arrived;
        if (n == 0)
            adcgs_feed_wait(feed);
        if (n == 0 && adcgs_feed_bytes(feed, &ended) > taken)
            ended = 0;
        ADCGS_TRY(adcgs_push(decoder, piece, n, &used, &arrived, error));
        if (arrived >= ADCGS_ARRIVED_CAMERAS)
            return ADCGS_OK;
        taken += used;
    }
    return adcgs_push_end(decoder, error);
}

static adcgs_status decode_front(adcgs_decoder *decoder, adcgs_feed *feed, adcgs_error *error)
{
    const adcgs_status status = decode_parts(decoder, feed, error);
    ADCGS_TRY(adcgs_feed_status(feed, error));
    if (status != ADCGS_OK)
        adcgs_error_locate(error, adcgs_feed_name(feed));
    return status;
}

/** Opens a decoder that knows the parts before the first segment. */
static adcgs_status open_front(adcgs_decoder **decoder, const adcgs_play_source *from, const adcgs_config *config,
                               adcgs_error *error)
{
    adcgs_config all = *config;
    all.layers = 0;
    if (from->feed) {
        ADCGS_TRY(adcgs_open_push(decoder, &all, error));
        return decode_front(*decoder, from->feed, error);
    }
    const adcgs_status status = adcgs_open_memory(decoder, from->data, from->bytes, &all, error);
    if (status != ADCGS_OK)
        adcgs_error_locate(error, from->path);
    return status;
}

/** Plays settings->source. */
static adcgs_status play(const adcgs_dec_play *how, adcgs_play_settings *settings, int *failed, adcgs_error *error)
{
    adcgs_decoder *decoder = NULL;
    adcgs_filmed_camera *cameras = NULL;
    adcgs_filmed_view filmed = {.following = 0};
    settings->filmed = &filmed;
    adcgs_status status = open_front(&decoder, &settings->source, &settings->config, error);
    if (status == ADCGS_OK && !adcgs_interrupted())
        status = collect_properties(how, decoder, settings, &cameras, error);
    adcgs_close(&decoder); /* the player opens the stream on its own thread */
    set_times(&how->request, settings);
    if (status == ADCGS_OK && !adcgs_interrupted())
        status = adcgs_play_run(settings, failed, error);
    adcgs_filmed_view_clear(&filmed);
    free(cameras);
    return status;
}

static adcgs_status play_file(const adcgs_dec_play *how, adcgs_play_settings *settings, int *failed, adcgs_error *error)
{
    uint8_t *data;
    ADCGS_TRY(adcgs_is_url(how->input)
                  ? adcgs_http_load(&data, &settings->source.bytes, how->input, adcgs_salvage_bytes, adcgs_interrupted, error)
                  : adcgs_operand_load(&data, &settings->source.bytes, NULL, how->input, STREAM_BYTES_MAX, error));
    settings->source.data = data;
    const adcgs_status status = play(how, settings, failed, error);
    free(data);
    return status;
}

/** Plays from the first bytes, or, if a pipe's first bytes are missing, from the next key. */
static adcgs_status play_coming(const adcgs_dec_play *how, adcgs_play_settings *settings, int *failed, adcgs_error *error)
{
    settings->config.tune_in = !adcgs_is_url(how->input);
    ADCGS_TRY(adcgs_feed_open(&settings->source.feed, how->input, adcgs_interrupted, error));
    const adcgs_status status = play(how, settings, failed, error);
    adcgs_feed_free(&settings->source.feed);
    return status;
}

adcgs_status adcgs_dec_play_run(const adcgs_dec_play *how, int *failed, adcgs_error *error)
{
    adcgs_play_settings settings = {.cli = how->cli,
                                    .source.path = strcmp(how->input, "-") ? how->input : "stream",
                                    .config = how->config,
                                    .script = how->script,
                                    .interrupted = adcgs_interrupted};
    ADCGS_TRY(adcgs_kind_check(how->input, ADCGS_WANT_STREAM, error));
    memcpy(settings.size, how->request.size, sizeof settings.size);
    /* A damaged stream at a URL is read several times, so it is loaded first. */
    const int comes = adcgs_pipe_is(how->input) || (adcgs_is_url(how->input) && !how->config.conceal);
    return comes ? play_coming(how, &settings, failed, error) : play_file(how, &settings, failed, error);
}

#else

adcgs_status adcgs_dec_play_run(const adcgs_dec_play *how, int *failed, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%.160s: this build has no player", how->input);
}

#endif
