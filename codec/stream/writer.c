/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Writing a stream: chunk after chunk in the order of the spec clause "Stream". */
#include "base/cpu_detect.h"
#include "base/digest.h"
#include "model/model_priv.h"
#include "stream/writer.h"

#define ENDC_PAYLOAD 12

/** The sub-streams of one layer of one segment, one after the other. */
typedef struct layer_data {
    adcgs_buffer data;
    uint32_t n_slices;
    uint32_t *bytes; /**< [n_slices] */
} layer_data;

static adcgs_status end_chunk(adcgs_writer *w, uint32_t type, size_t begin)
{
    const size_t payload = w->out->size - begin - ADCGS_CHUNK_HEADER_BYTES;
    if (w->out->failed)
        return adcgs_fail(w->error, ADCGS_ERR_MEMORY, "stream: no memory for the output");
    if (payload > w->limits->chunk_bytes)
        return adcgs_fail(w->error, ADCGS_ERR_LIMIT, "stream: a chunk of %zu bytes exceeds the level's limit", payload);
    adcgs_chunk_end(w->out, begin);
    if (w->out->failed)
        return adcgs_fail(w->error, ADCGS_ERR_MEMORY, "stream: no memory for the output");
    w->crc_of_crcs = adcgs_crc32c(w->crc_of_crcs, w->out->data + w->out->size - 4, 4);
    adcgs_bytes_count(&w->stream->bytes, type, payload);
    return ADCGS_OK;
}

adcgs_status adcgs_writer_head(adcgs_writer *w)
{
    const size_t begin = adcgs_chunk_begin(w->out, ADCGS_TYPE_HEAD, 0, 0);
    ADCGS_TRY(adcgs_head_write(w->out, w->stream, w->max_anchors, w->error));
    return end_chunk(w, ADCGS_TYPE_HEAD, begin);
}

static adcgs_status write_extras(adcgs_writer *w)
{
    if (w->stream->n_cameras > 0) {
        const size_t begin = adcgs_chunk_begin(w->out, ADCGS_TYPE_cams, 0, 0);
        ADCGS_TRY(adcgs_cams_write(w->out, w->stream, w->error));
        ADCGS_TRY(end_chunk(w, ADCGS_TYPE_cams, begin));
    }
    if (w->stream->n_meta > 0) {
        const size_t begin = adcgs_chunk_begin(w->out, ADCGS_TYPE_meta, 0, 0);
        ADCGS_TRY(adcgs_meta_write(w->out, w->stream, w->error));
        ADCGS_TRY(end_chunk(w, ADCGS_TYPE_meta, begin));
    }
    return ADCGS_OK;
}

/** Assign ids to a model's networks, which are sent again except those that a predicted segment shares with the previous one. */
static void assign_ids(adcgs_writer *w, const adcgs_model *before, const adcgs_model *model, adcgs_role_ids *ids)
{
    for (int role = 0; role < ADCGS_ROLES; role++) {
        const adcgs_net *net = &model->net[role];
        if (!net->present || (before && adcgs_net_equal(&before->net[role], net)))
            continue;
        w->weights += adcgs_net_weights(net);
        w->spent.work += adcgs_weights_work(adcgs_net_weights(net));
        ids->mask |= (uint16_t)(1 << role);
        ids->id[role] = (uint16_t)w->n_nets++;
    }
}

/** Add the cost of a segment's tiers; a predicted segment has one. Networks count once. */
static void spend_tiers(adcgs_writer *w, const adcgs_model *model)
{
    adcgs_nets_cost nets = {0, 0};
    for (int role = 0; role < ADCGS_ROLES; role++)
        if (model->net[role].present)
            adcgs_nets_cost_add(&nets, &model->params, role, &model->net[role]);
    for (int tier = 0; tier <= (model->predicted ? 0 : model->finest - model->absent); tier++) {
        uint32_t n = model->predicted ? model->n : 0;
        for (uint32_t i = 0; !model->predicted && i < model->n; i++)
            n += model->tier[i] == tier;
        const adcgs_cost cost = adcgs_segment_cost(&model->params, n, model->depth, &nets);
        w->spent.bytes += cost.bytes;
        w->spent.work += cost.work;
        nets.weights = 0;
    }
}

static adcgs_status check_segment(adcgs_writer *w, const adcgs_model *before, const adcgs_model *model)
{
    const adcgs_level *limits = w->limits;
    spend_tiers(w, model);
    w->spent.work += before ? adcgs_inter_work(adcgs_inter_values(before)) : 0;
    if (w->spent.bytes > limits->model_bytes || w->spent.work > limits->work || w->weights > limits->weights ||
        model->depth > limits->depth || w->n_nets > limits->networks)
        return adcgs_fail(w->error, ADCGS_ERR_LIMIT,
                          "stream: %llu model bytes, work %llu, %llu weights, %u networks or depth %u exceed level %u",
                          (unsigned long long)w->spent.bytes, (unsigned long long)w->spent.work, (unsigned long long)w->weights,
                          w->n_nets, model->depth, w->stream->level);
    return ADCGS_OK;
}

static adcgs_status encode_slices(adcgs_writer *w, const adcgs_latents *latents, adcgs_model *model, int layer, layer_data *l)
{
    const uint32_t slice = 1U << w->stream->slice_log2;
    for (uint32_t i = 0; i < l->n_slices; i++) {
        const uint32_t begin = i * slice, end = ADCGS_MIN(model->n - begin, slice) + begin;
        const size_t size = l->data.size;
        ADCGS_TRY(adcgs_latents_encode(latents, model, layer, begin, end, &l->data, w->error));
        l->bytes[i] = (uint32_t)(l->data.size - size);
    }
    return ADCGS_OK;
}

/** Number of slices from first on that fit into one chunk. \return at least one. */
static uint32_t slices_per_chunk(const adcgs_writer *w, const layer_data *l, uint32_t first)
{
    uint64_t payload = 10; /* two numbers in front; each slice has a length and a CRC */
    uint32_t n = 0;
    while (first + n < l->n_slices && (n == 0 || payload + 9 + l->bytes[first + n] <= w->limits->chunk_bytes))
        payload += 9 + l->bytes[first + n++];
    return n;
}

static adcgs_status write_layer(adcgs_writer *w, uint32_t segment, int tier, int layer, const layer_data *l)
{
    static const uint8_t nothing[1]; /* if all slices are empty, the buffer has no memory */
    const uint8_t *data = l->data.data ? l->data.data : nothing, *slice = data;
    for (uint32_t first = 0, n; first < l->n_slices; first += n) {
        const size_t begin = adcgs_chunk_begin(w->out, ADCGS_TYPE_FEA(layer), segment, ADCGS_CHUNK_OF_TIER(tier));
        n = slices_per_chunk(w, l, first);
        adcgs_write_varint(w->out, first);
        adcgs_write_varint(w->out, n);
        for (uint32_t i = first; i < first + n; i++) {
            const adcgs_syn_slice_crc crc = {adcgs_crc32c(0, slice, l->bytes[i])};
            adcgs_write_varint(w->out, l->bytes[i]);
            ADCGS_TRY(adcgs_syn_slice_crc_write(w->out, "FEA", &crc, w->error));
            slice += l->bytes[i];
        }
        adcgs_write_bytes(w->out, data, (size_t)(slice - data));
        data = slice;
        ADCGS_TRY(end_chunk(w, ADCGS_TYPE_FEA(layer), begin));
    }
    return ADCGS_OK;
}

static adcgs_status write_layers(adcgs_writer *w, uint32_t segment, int tier, const adcgs_latents *latents, adcgs_model *model)
{
    layer_data l = {.n_slices = ((model->n - 1) >> w->stream->slice_log2) + 1};
    adcgs_status status = ADCGS_OK;
    adcgs_buffer_init(&l.data);
    l.bytes = adcgs_alloc(NULL, l.n_slices, sizeof *l.bytes, w->error);
    if (!l.bytes)
        return adcgs_alloc_status(w->error);
    for (int layer = 0; layer < adcgs_params_layers(&model->params) && status == ADCGS_OK; layer++) {
        l.data.size = 0;
        status = encode_slices(w, latents, model, layer, &l);
        if (status == ADCGS_OK)
            status = write_layer(w, segment, tier, layer, &l);
    }
    adcgs_buffer_clear(&l.data);
    adcgs_free(NULL, l.bytes);
    return status;
}

static adcgs_status write_features(adcgs_writer *w, uint32_t segment, int tier, adcgs_model *model)
{
    adcgs_latents *latents = NULL;
    adcgs_cpu_level cpu;
    ADCGS_TRY(adcgs_cpu_resolve(ADCGS_CPU_AUTO, &cpu, w->error));
    ADCGS_TRY(adcgs_latents_create(&latents, model, cpu, NULL, w->error));
    const adcgs_status status = write_layers(w, segment, tier, latents, model);
    adcgs_latents_free(&latents);
    return status;
}

static adcgs_status write_hash(adcgs_writer *w, uint32_t segment, const adcgs_model *model)
{
    uint8_t digest[16];
    const size_t begin = adcgs_chunk_begin(w->out, ADCGS_TYPE_hash, segment, ADCGS_CHUNK_LAST);
    adcgs_model_digest(model, digest);
    adcgs_write_bytes(w->out, digest, sizeof digest);
    return end_chunk(w, ADCGS_TYPE_hash, begin);
}

static adcgs_status write_networks(adcgs_writer *w, uint32_t segment, const adcgs_model *model, const adcgs_role_ids *ids)
{
    const adcgs_net *nets[ADCGS_ROLES];
    uint32_t n = 0;
    for (int role = 0; role < ADCGS_ROLES; role++)
        if (ids->mask >> role & 1)
            nets[n++] = &model->net[role];
    if (n == 0)
        return ADCGS_OK;
    const size_t begin = adcgs_chunk_begin(w->out, ADCGS_TYPE_NETW, segment, 0);
    ADCGS_TRY(adcgs_netw_write(w->out, nets, n, w->n_nets - n, w->error));
    return end_chunk(w, ADCGS_TYPE_NETW, begin);
}

/** Write the positions of a tier's anchors, or of the new anchors of a predicted segment, and their latents. */
static adcgs_status write_anchors(adcgs_writer *w, uint32_t segment, int tier, adcgs_model *added)
{
    const size_t begin = adcgs_chunk_begin(w->out, ADCGS_TYPE_GEOM, segment, ADCGS_CHUNK_OF_TIER(tier));
    ADCGS_TRY(adcgs_geom_write(w->out, added, tier, w->error));
    ADCGS_TRY(end_chunk(w, ADCGS_TYPE_GEOM, begin));
    return added->n ? write_features(w, segment, tier, added) : ADCGS_OK;
}

static adcgs_status write_tiers(adcgs_writer *w, uint32_t segment, adcgs_model *model)
{
    adcgs_status status = ADCGS_OK;
    if (!model->finest)
        return write_anchors(w, segment, 0, model);
    for (int tier = 0; tier <= model->finest - model->absent && status == ADCGS_OK; tier++) {
        adcgs_model part;
        status = adcgs_model_tier(&part, model, tier, NULL, w->error);
        if (status == ADCGS_OK)
            status = write_anchors(w, segment, tier, &part);
        adcgs_model_clear(&part, NULL);
    }
    return status;
}

static adcgs_status write_rest(adcgs_writer *w, uint32_t segment, const adcgs_inter *kept, const adcgs_model *before,
                               const adcgs_model *model)
{
    adcgs_model rest;
    const size_t begin = adcgs_chunk_begin(w->out, ADCGS_TYPE_KEEP, segment, 0);
    ADCGS_TRY(adcgs_inter_encode(kept, before, w->out, w->error));
    ADCGS_TRY(end_chunk(w, ADCGS_TYPE_KEEP, begin));
    adcgs_status status = adcgs_inter_rest(&rest, kept, before, model, w->error);
    for (uint32_t i = 0; status == ADCGS_OK && i < rest.n; i++)
        if (rest.tier[i])
            status =
                adcgs_fail(w->error, ADCGS_ERR_USAGE, "stream: a new anchor of segment %u is of tier %u", segment, rest.tier[i]);
    if (status == ADCGS_OK)
        status = write_anchors(w, segment, 0, &rest);
    adcgs_model_clear(&rest, NULL);
    return status;
}

static adcgs_status write_predicted(adcgs_writer *w, uint32_t segment, const adcgs_model *before, const adcgs_model *model)
{
    adcgs_inter kept = {.n = 0};
    adcgs_status status = adcgs_inter_find(&kept, before, model, w->error);
    if (status == ADCGS_OK)
        status = write_rest(w, segment, &kept, before, model);
    adcgs_inter_clear(&kept, NULL);
    return status;
}

/** Bytes of the stream so far. */
static uint64_t position(const adcgs_writer *w)
{
    return w->gone + (w->out->size - w->begin);
}

/** Index the last segment, which ends here: at the next SEGM, or at INDX. */
static adcgs_status index_last(adcgs_writer *w)
{
    if (w->n_segments == 0)
        return ADCGS_OK;
    w->last.bytes = position(w) - w->last.offset;
    return adcgs_syn_index_write(&w->index, "INDX", &w->last, w->error);
}

static adcgs_status write_parts(adcgs_writer *w, const adcgs_model *before, adcgs_model *model)
{
    const uint32_t segment = w->n_segments;
    adcgs_role_ids ids = {0};
    assign_ids(w, before, model, &ids);
    ADCGS_TRY(check_segment(w, before, model));
    const size_t begin = adcgs_chunk_begin(w->out, ADCGS_TYPE_SEGM, segment, before ? 0 : ADCGS_CHUNK_KEY);
    ADCGS_TRY(adcgs_segm_write(w->out, w->stream, model, &ids, w->error));
    ADCGS_TRY(end_chunk(w, ADCGS_TYPE_SEGM, begin));
    ADCGS_TRY(write_networks(w, segment, model, &ids));
    ADCGS_TRY(before ? write_predicted(w, segment, before, model) : write_tiers(w, segment, model));
    return model->absent ? ADCGS_OK : write_hash(w, segment, model); /* without all tiers no reader would compare it */
}

adcgs_status adcgs_writer_segment(adcgs_writer *w, const adcgs_model *before, adcgs_model *model)
{
    ADCGS_TRY(index_last(w));
    w->last = (adcgs_syn_index){.offset = position(w), .key = !before};
    ADCGS_TRY(adcgs_seconds_to_ticks(w->stream, model->time_start, &w->last.start_ticks, w->error));
    ADCGS_TRY(adcgs_seconds_to_ticks(w->stream, model->time_end, &w->last.end_ticks, w->error));
    ADCGS_TRY(adcgs_reach_ticks(w->stream, model, &w->last.reach_ticks, w->error));
    ADCGS_TRY(write_parts(w, before, model));
    w->n_segments++;
    return ADCGS_OK;
}

/** Write INDX; it is useless in a stream of one segment. */
static adcgs_status write_index(adcgs_writer *w)
{
    if (w->n_segments < 2)
        return ADCGS_OK;
    ADCGS_TRY(index_last(w));
    const size_t begin = adcgs_chunk_begin(w->out, ADCGS_TYPE_INDX, 0, 0);
    adcgs_write_varint(w->out, w->n_segments);
    adcgs_write_bytes(w->out, w->index.data, w->index.size);
    return end_chunk(w, ADCGS_TYPE_INDX, begin);
}

static adcgs_status write_end(adcgs_writer *w)
{
    const uint64_t total = position(w) + ADCGS_CHUNK_BYTES + ENDC_PAYLOAD;
    const adcgs_syn_endc endc = {.file_bytes = total, .crc_of_crcs = w->crc_of_crcs};
    if (total > w->limits->file_bytes)
        return adcgs_fail(w->error, ADCGS_ERR_LIMIT, "stream: %llu bytes exceed level %u", (unsigned long long)total,
                          w->stream->level);
    const size_t begin = adcgs_chunk_begin(w->out, ADCGS_TYPE_ENDC, 0, 0);
    ADCGS_TRY(adcgs_syn_endc_write(w->out, "ENDC", &endc, w->error));
    ADCGS_TRY(end_chunk(w, ADCGS_TYPE_ENDC, begin));
    w->stream->weights = (uint32_t)w->weights;
    adcgs_bytes_finish(&w->stream->bytes, total);
    return ADCGS_OK;
}

adcgs_status adcgs_writer_front(adcgs_writer *w)
{
    adcgs_write_bytes(w->out, ADCGS_SIGNATURE, ADCGS_SIGNATURE_BYTES);
    ADCGS_TRY(adcgs_writer_head(w));
    return write_extras(w);
}

adcgs_status adcgs_writer_end(adcgs_writer *w)
{
    ADCGS_TRY(write_index(w));
    return write_end(w);
}

void adcgs_writer_init(adcgs_writer *w, adcgs_stream *stream, uint32_t max_anchors, adcgs_buffer *out, adcgs_error *error)
{
    *w = (adcgs_writer){.stream = stream,
                        .max_anchors = max_anchors,
                        .out = out,
                        .begin = out->size,
                        .limits = adcgs_level_get(stream->level),
                        .error = error};
    memset(&stream->bytes, 0, sizeof stream->bytes);
    adcgs_buffer_init(&w->index);
}

void adcgs_writer_clear(adcgs_writer *w)
{
    adcgs_buffer_clear(&w->index);
}

/* ---- Checks ---- */

adcgs_status adcgs_writer_check_head(const adcgs_stream *stream, adcgs_error *error)
{
    if (stream->timebase_num < 1 || stream->timebase_den < 1 || stream->level > ADCGS_LEVELS)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "stream: timebase %u/%u, level %u, expected positive, 0..%d",
                          stream->timebase_num, stream->timebase_den, stream->level, ADCGS_LEVELS);
    if (stream->slice_log2 < ADCGS_SLICE_LOG2_MIN || stream->slice_log2 > ADCGS_SLICE_LOG2_MAX)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "stream: slice_log2 is %u, expected %d..%d", stream->slice_log2,
                          ADCGS_SLICE_LOG2_MIN, ADCGS_SLICE_LOG2_MAX);
    return ADCGS_OK;
}

adcgs_status adcgs_writer_check(const adcgs_stream *stream, uint32_t i, const adcgs_model *before, const adcgs_model *model,
                                int64_t span[2], adcgs_error *error)
{
    int64_t start = 0, end = 0;
    uint32_t reach;
    ADCGS_TRY(adcgs_model_validate(model, error));
    if (!adcgs_params_equal(&model->params, &stream->params))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "stream: segment %u has other parameters than the stream", i);
    ADCGS_TRY(adcgs_seconds_to_ticks(stream, model->time_start, &start, error));
    ADCGS_TRY(adcgs_seconds_to_ticks(stream, model->time_end, &end, error));
    ADCGS_TRY(adcgs_reach_ticks(stream, model, &reach, error));
    if (model->predicted && !before)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "stream: the first segment is predicted");
    if (model->predicted && before->absent)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "stream: segment %u is predicted from a segment with absent tiers", i);
    if (model->predicted && !adcgs_inter_possible(before, model, error))
        return ADCGS_ERR_USAGE;
    if (i > 0 && (start <= span[0] || start < span[1]))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "stream: segment %u starts before the previous one ends", i);
    span[0] = start;
    span[1] = end;
    return ADCGS_OK;
}
