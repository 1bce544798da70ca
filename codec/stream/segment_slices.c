/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Reading the slices of a segment: their table, their checksums, and decoding them on all threads. */
#include "base/digest.h"
#include "model/model_priv.h"
#include "stream/segment_priv.h"

/** A sub-stream of a FEAx payload. */
typedef struct slice {
    size_t offset; /**< in the payload */
    uint32_t bytes, crc;
    adcgs_range_dec range;
    adcgs_status status;
} slice;

/** State shared by the threads that decode a chunk. */
typedef struct slice_job {
    adcgs_segment *s;
    slice *slices;
    const uint8_t *payload;
    uint32_t first;
    int layer;
    uint8_t *room; /**< one part for each thread: tasks allocate nothing */
    size_t room_each;
} slice_job;

static void decode_slice(void *arg, int index, int thread)
{
    const slice_job *job = arg;
    slice *one = &job->slices[index];
    uint32_t begin, end;
    adcgs_slice_span(job->s, job->first + (uint32_t)index, &begin, &end);
    adcgs_range_dec_init(&one->range, job->payload + one->offset, one->bytes);
    one->status = adcgs_latents_decode(job->s->latents, &job->s->model, job->layer, begin, end, &one->range,
                                       job->room + (size_t)thread * job->room_each, NULL);
}

/** Find the reason why decoding a slice failed: an impossible body, found by decoding the flags again, or its end. */
static void explain(const slice_job *job, uint32_t index, adcgs_error *why)
{
    const slice *one = &job->slices[index];
    adcgs_range_dec again;
    uint32_t begin, end;
    adcgs_slice_span(job->s, job->first + index, &begin, &end);
    adcgs_range_dec_init(&again, job->payload + one->offset, one->bytes);
    if (job->layer > 0 || adcgs_latents_decode_flags(&job->s->model, begin, end, &again, why) == ADCGS_OK)
        adcgs_range_dec_finish(&one->range, why);
}

/** Decode usable slices on all threads. The first that fails is decoded again for its message. */
static adcgs_status decode_slices(adcgs_segment *s, const adcgs_parse *p, int layer, uint32_t first, slice *slices,
                                  uint32_t usable)
{
    slice_job job = {s, slices, p->r.data, first, layer, NULL, adcgs_latents_room(s->latents)};
    job.room = adcgs_alloc(NULL, (size_t)adcgs_pool_threads(s->options->pool), job.room_each, s->error);
    if (!job.room)
        return adcgs_alloc_status(s->error);
    adcgs_pool_run(s->options->pool, decode_slice, &job, (int)usable);
    adcgs_free(NULL, job.room);
    for (uint32_t i = 0; i < usable; i++) {
        adcgs_error why = {ADCGS_OK, ""};
        if (slices[i].status == ADCGS_OK) {
            adcgs_parse_trace_end(p, &slices[i].range);
            continue;
        }
        explain(&job, i, &why);
        return adcgs_fail(s->error, slices[i].status, "%s: segment %u, slice %u: %.160s", p->chunk, adcgs_segment_number(s),
                          first + i, why.text);
    }
    s->done[layer] += usable;
    return ADCGS_OK;
}

/** Parse the table of slices. Offsets count from the end of the table until check_slices() adds its position. */
static adcgs_status parse_slices(adcgs_parse *p, slice *slices, uint32_t n, uint64_t *total)
{
    *total = 0;
    for (uint32_t i = 0; i < n; i++) {
        adcgs_syn_slice_crc crc;
        ADCGS_TRY(adcgs_parse_varint(p, "slice_bytes", 0, UINT32_MAX, &slices[i].bytes));
        ADCGS_TRY(adcgs_syn_slice_crc_parse(p, &crc));
        slices[i].crc = crc.slice_crc;
        slices[i].offset = (size_t)ADCGS_MIN(*total, SIZE_MAX / 2);
        *total += slices[i].bytes;
    }
    return ADCGS_OK;
}

/** Count the leading slices that are present and have correct checksums. */
static adcgs_status check_slices(adcgs_segment *s, const adcgs_parse *p, slice *slices, uint32_t first, uint32_t n,
                                 uint32_t *usable)
{
    for (*usable = 0; *usable < n; ++*usable) {
        slice *one = &slices[*usable];
        one->offset += p->r.pos;
        if (one->offset > p->r.size || one->bytes > p->r.size - one->offset)
            break;
        adcgs_parse_trace(p, 8 * (uint64_t)one->offset, "slice", "%u bytes", one->bytes);
        if (adcgs_crc32c(0, p->r.data + one->offset, one->bytes) == one->crc)
            continue;
        if (s->options->conceal)
            break;
        return adcgs_fail(s->error, ADCGS_ERR_DATA, "%s: segment %u, slice %u: checksum is wrong", p->chunk,
                          adcgs_segment_number(s), first + *usable);
    }
    return ADCGS_OK;
}

static adcgs_status use_slices(adcgs_segment *s, adcgs_parse *p, int layer, uint32_t first, slice *slices, uint32_t n,
                               int complete)
{
    uint64_t total;
    uint32_t usable = 0;
    const adcgs_status status = parse_slices(p, slices, n, &total);
    if (status != ADCGS_OK)
        return complete ? status : ADCGS_OK; /* the table is cut off: no slice can be used */
    if (complete && total != adcgs_reader_left(&p->r))
        return adcgs_fail(s->error, ADCGS_ERR_DATA, "%s: slices have %llu bytes, the payload has %zu", p->chunk,
                          (unsigned long long)total, adcgs_reader_left(&p->r));
    ADCGS_TRY(check_slices(s, p, slices, first, n, &usable));
    return decode_slices(s, p, layer, first, slices, usable);
}

adcgs_status adcgs_segment_features(adcgs_segment *s, adcgs_parse *p, int layer, int complete)
{
    uint32_t first, n;
    if (s->stage != ADCGS_SEGMENT_PLACED)
        return adcgs_fail(s->error, ADCGS_ERR_DATA, "%s: expected after GEOM", p->chunk);
    if (layer >= adcgs_params_layers(&s->stream->params))
        return adcgs_fail(s->error, ADCGS_ERR_DATA, "%s: the stream's parameters give %d layers", p->chunk,
                          adcgs_params_layers(&s->stream->params));
    if (layer >= adcgs_layers_wanted(s))
        return ADCGS_OK;
    const uint32_t ready = layer == 0 ? s->n_slices : s->done[layer - 1], next = s->done[layer];
    if (next >= ready)
        return adcgs_fail(s->error, ADCGS_ERR_DATA, "%s: slices of the layer below are missing", p->chunk);
    adcgs_status status = adcgs_parse_varint(p, "first_slice", next, next, &first);
    if (status == ADCGS_OK)
        status = adcgs_parse_varint(p, "slices", 1, ready - next, &n);
    if (status != ADCGS_OK)
        return complete ? status : ADCGS_OK;
    slice *slices = adcgs_alloc(s->options->memory, n, sizeof *slices, s->error);
    if (!slices)
        return adcgs_alloc_status(s->error);
    status = use_slices(s, p, layer, first, slices, n, complete);
    adcgs_free(s->options->memory, slices);
    return status;
}
