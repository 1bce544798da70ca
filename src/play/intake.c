/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Decodes the bytes of a feed. */
#include "config.h"

#include "play/intake.h"

#include <adcgs/decoder.h>

#include <math.h>

#define MOMENT 0.05 /* seconds of decoding between two images; chosen by hand, not measured */

void adcgs_intake_init(adcgs_intake *in, adcgs_feed *feed, const adcgs_config *config)
{
    *in = (adcgs_intake){.feed = feed, .config = *config};
}

void adcgs_intake_clear(adcgs_intake *in)
{
    adcgs_close(&in->decoder);
}

static adcgs_status open_layers(adcgs_intake *in, int layers, adcgs_error *error)
{
    adcgs_decoder *decoder;
    in->config.layers = layers;
    ADCGS_TRY(adcgs_open_push(&decoder, &in->config, error));
    adcgs_close(&in->decoder);
    in->decoder = decoder;
    in->layers = layers;
    in->come = (adcgs_come){.fault.status = ADCGS_OK};
    in->at = in->n = 0;
    return ADCGS_OK;
}

/** Ends decoding: no more bytes will arrive. */
static adcgs_status end(adcgs_intake *in)
{
    in->come.over = 1;
    const adcgs_status status = adcgs_push_end(in->decoder, &in->come.fault);
    if (status == ADCGS_OK)
        return adcgs_feed_status(in->feed, &in->come.fault);
    adcgs_error_locate(&in->come.fault, adcgs_feed_name(in->feed));
    return status;
}

/** Decodes to the end of a part at most, and at most limit bytes of the feed. *some: there was something to do. */
static adcgs_status step(adcgs_intake *in, uint64_t limit, int *some, adcgs_arrival *arrived)
{
    size_t used = 0;
    int ended = 0;
    *arrived = ADCGS_ARRIVED_NOTHING;
    if (in->n == 0) {
        adcgs_feed_bytes(in->feed, &ended); /* first: bytes that arrive in between are available the next time */
        in->at = 0;
        in->n = adcgs_feed_copy(in->feed, in->come.bytes, in->piece,
                                (size_t)ADCGS_MIN((uint64_t)sizeof in->piece, limit - in->come.bytes));
    }
    *some = in->n > 0 || ended;
    if (in->n == 0)
        return ended ? end(in) : ADCGS_OK;
    const adcgs_status status = adcgs_push(in->decoder, in->piece + in->at, in->n, &used, arrived, &in->come.fault);
    in->at += used;
    in->n -= used;
    in->come.bytes += used;
    if (status != ADCGS_OK)
        adcgs_error_locate(&in->come.fault, adcgs_feed_name(in->feed));
    return status == ADCGS_OK && *arrived == ADCGS_ARRIVED_END ? end(in) : status;
}

static void update_info(adcgs_intake *in)
{
    adcgs_info *const info = &in->come.info;
    if (adcgs_get_info(in->decoder, info, sizeof *info, NULL) == ADCGS_OK)
        in->come.drawable = info->time_available > -INFINITY;
}

/** Decodes one more part. \return nonzero if the rendered result differs */
static int go_on(adcgs_intake *in, uint64_t limit, int *some)
{
    adcgs_arrival arrived;
    const adcgs_status status = step(in, limit, some, &arrived);
    in->come.fault.status = status;
    in->come.over |= status != ADCGS_OK;
    if (arrived == ADCGS_ARRIVED_SEGMENT && !in->come.drawable)
        update_info(in);
    return arrived >= ADCGS_ARRIVED_SEGMENT || in->come.over;
}

/** Opens the stream with other layers, and decodes as far as before. */
static adcgs_status begin_anew(adcgs_intake *in, int layers, adcgs_error *error)
{
    const adcgs_come before = in->come;
    ADCGS_TRY(open_layers(in, layers, error));
    for (int some = 1; some && !in->come.over && (in->come.bytes < before.bytes || before.over);)
        go_on(in, before.over ? UINT64_MAX : before.bytes, &some);
    update_info(in);
    return ADCGS_OK;
}

adcgs_status adcgs_intake_take(adcgs_intake *in, int layers, int more, int *changed, adcgs_error *error)
{
    *changed = !in->decoder || in->layers != layers;
    if (*changed)
        ADCGS_TRY(begin_anew(in, layers, error));
    const double begin = adcgs_seconds();
    const int was_drawable = in->come.drawable;
    for (int some = more; some && !in->come.over && adcgs_seconds() - begin < MOMENT;) {
        *changed |= go_on(in, UINT64_MAX, &some);
        if (in->come.drawable && !was_drawable)
            break; /* shows the first image at once */
    }
    update_info(in);
    return ADCGS_OK;
}
