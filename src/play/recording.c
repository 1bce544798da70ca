/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Recordings. */
#include "config.h"

#include "play/recording.h"

#include "play/files.h"

#define MANY_FRAMES 2 /* frames: their number is unknown; more than an image holds, by definition */

double adcgs_recording_now(const adcgs_recording *r)
{
    return r->sink ? r->base + (double)r->frames * r->step : adcgs_seconds() - r->behind;
}

int adcgs_recording_due(const adcgs_recording *r)
{
    return adcgs_seconds() >= r->due;
}

static adcgs_status open_sink(adcgs_recording *r, adcgs_error *error)
{
    const adcgs_sink_config config = {.target = r->path,
                                      .frame_rate = 1.0 / r->step,
                                      .width = r->width,
                                      .height = r->height,
                                      .frames = MANY_FRAMES};
    return adcgs_sink_open(&r->sink, &config, error);
}

static adcgs_status open_named(adcgs_recording *r, const char *stream, adcgs_error *error)
{
    static const char *const extensions[] = {"mp4", "y4m"};
    adcgs_status status = ADCGS_ERR_UNSUPPORTED;
    for (size_t i = 0; i < ADCGS_COUNTOF(extensions) && status == ADCGS_ERR_UNSUPPORTED; i++)
        status = adcgs_play_free_name(r->path, stream, extensions[i])
                     ? open_sink(r, error)
                     : adcgs_fail(error, ADCGS_ERR_IO, "no unused file name is left for a video");
    return status;
}

adcgs_status adcgs_recording_begin(adcgs_recording *r, const char *stream, int width, int height, double frame_rate)
{
    const double now = adcgs_recording_now(r);
    r->width = width;
    r->height = height;
    r->step = 1.0 / frame_rate;
    r->frames = 0;
    r->base = now;
    r->due = 0.0;
    r->status = *r->path ? open_sink(r, &r->error) : open_named(r, stream, &r->error);
    if (r->status != ADCGS_OK)
        *r->path = 0;
    return r->status;
}

void adcgs_recording_posted(adcgs_recording *r)
{
    r->due = ADCGS_MAX(r->due + r->step, adcgs_seconds());
}

/** Continues the time from its present value. */
static void leave(adcgs_recording *r)
{
    r->behind = adcgs_seconds() - adcgs_recording_now(r);
}

adcgs_status adcgs_recording_end(adcgs_recording *r)
{
    if (!r->sink)
        return ADCGS_OK;
    leave(r);
    r->status = adcgs_sink_close(&r->sink, &r->error);
    return r->status;
}

void adcgs_recording_fail(adcgs_recording *r, const adcgs_error *error)
{
    leave(r);
    adcgs_sink_abort(&r->sink);
    *r->path = 0;
    r->status = error->status;
    r->error = *error;
}
