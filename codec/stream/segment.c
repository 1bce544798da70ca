/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Reading one time segment: its start, its tiers of anchors, and its end. */
#include "stream/segment.h"

#include "base/digest.h"
#include "model/model_priv.h"
#include "stream/segment_priv.h"

void adcgs_segment_drop(adcgs_segment *s)
{
    adcgs_latents_free(&s->latents);
    adcgs_model_clear(&s->model, s->options->memory);
    adcgs_model_clear(&s->coarser, s->options->memory);
    s->tier = 0;
    s->has_kept = s->sent = s->is_joined = 0;
    memset(s->done, 0, sizeof s->done);
    s->n_slices = 0;
    s->has_hash = 0;
    s->stage = ADCGS_SEGMENT_NONE;
}

void adcgs_segment_clear(adcgs_segment *s)
{
    adcgs_segment_drop(s);
    adcgs_buffer_clear(&s->index);
}

static adcgs_status check_times(const adcgs_segment *s, const int64_t ticks[3])
{
    const adcgs_stream *stream = s->stream;
    if (ticks[0] < stream->start_ticks ||
        (stream->duration_ticks >= 0 && ticks[1] - stream->start_ticks > stream->duration_ticks))
        return adcgs_fail(s->error, ADCGS_ERR_DATA, "SEGM: ticks %lld..%lld lie outside the span in HEAD", (long long)ticks[0],
                          (long long)ticks[1]);
    if (stream->n_segments > 0 && (ticks[0] <= s->ticks[0] || ticks[0] < s->ticks[1]))
        return adcgs_fail(s->error, ADCGS_ERR_DATA, "SEGM: start_ticks is %lld, before the end of the previous segment, %lld",
                          (long long)ticks[0], (long long)s->ticks[1]);
    return ADCGS_OK;
}

adcgs_status adcgs_segment_start(adcgs_segment *s, adcgs_parse *p, uint64_t origin)
{
    int64_t ticks[3];
    if (adcgs_segment_number(s) >= s->limits->segments)
        return adcgs_fail(s->error, ADCGS_ERR_LIMIT, "SEGM: more than %u segments, the level's limit", s->limits->segments);
    s->model.params = s->stream->params;
    adcgs_status status = adcgs_segm_parse(p, s->stream, &s->model, &s->ids, ticks);
    if (status == ADCGS_OK)
        status = check_times(s, ticks);
    if (status != ADCGS_OK) {
        adcgs_segment_drop(s);
        return status;
    }
    s->stage = ADCGS_SEGMENT_STARTED;
    s->origin = origin;
    memcpy(s->ticks, ticks, sizeof ticks);
    return ADCGS_OK;
}

/** The model that a predicted segment is predicted from. */
static const adcgs_model *model_before(const adcgs_segment *s)
{
    return &s->stream->segments[s->stream->n_segments - 1];
}

void adcgs_segment_networks(adcgs_segment *s)
{
    for (int role = 0; s->stage == ADCGS_SEGMENT_STARTED && role < ADCGS_ROLES; role++)
        if (s->ids.mask >> role & 1 && s->ids.id[role] >= s->nets->sent[0] && s->ids.id[role] < s->nets->sent[1])
            s->sent |= (uint16_t)(1U << role);
}

adcgs_status adcgs_segment_keep(adcgs_segment *s, adcgs_parse *p)
{
    if (s->stage != ADCGS_SEGMENT_STARTED || !s->model.predicted || s->has_kept)
        return adcgs_fail(s->error, ADCGS_ERR_DATA, "KEEP: expected once, after SEGM of a predicted segment");
    s->has_kept = 1;
    adcgs_inter kept = {.n = 0};
    adcgs_status status = adcgs_keep_parse(p, s->limits, model_before(s), &kept, &s->left, s->options->memory);
    if (status == ADCGS_OK)
        status = adcgs_inter_model(&s->coarser, &kept, model_before(s), s->options->memory, s->error);
    adcgs_inter_clear(&kept, s->options->memory);
    return status;
}

/** A segment's network: the one that SEGM names or, in a predicted segment, that of the previous segment. NULL: none. */
static const adcgs_net *net_of(const adcgs_segment *s, int role)
{
    if (s->ids.mask >> role & 1)
        return &s->nets->nets[s->ids.id[role]];
    return s->model.predicted && model_before(s)->net[role].present ? &model_before(s)->net[role] : NULL;
}

/** Check that the networks named by SEGM exist, and add up their cost and that of inherited networks. */
static adcgs_status check_nets(const adcgs_segment *s, adcgs_nets_cost *cost)
{
    *cost = (adcgs_nets_cost){0, 0};
    for (int role = 0; role < ADCGS_ROLES; role++) {
        const uint32_t id = s->ids.id[role];
        if (s->ids.mask >> role & 1 && (id >= s->nets->n || !s->nets->nets[id].present || s->nets->nets[id].role != role))
            return adcgs_fail(s->error, ADCGS_ERR_DATA, "SEGM: network_id for %s is %u, but there is no such network",
                              adcgs_role_name(role), id);
        if (net_of(s, role))
            adcgs_nets_cost_add(cost, &s->stream->params, role, net_of(s, role));
    }
    return ADCGS_OK;
}

static adcgs_status copy_nets(adcgs_segment *s)
{
    for (int role = 0; role < ADCGS_ROLES; role++)
        if (net_of(s, role))
            ADCGS_TRY(adcgs_net_copy(&s->model.net[role], net_of(s, role), s->options->memory, s->error));
    return ADCGS_OK;
}

/** Fill missing slices with predicted means. */
static adcgs_status conceal_layers(const adcgs_segment *s, adcgs_model *model, adcgs_error *error)
{
    for (int layer = 1; layer < adcgs_params_layers(&s->stream->params); layer++)
        for (uint32_t i = s->done[layer]; i < s->n_slices; i++) {
            uint32_t begin, end;
            adcgs_slice_span(s, i, &begin, &end);
            if (adcgs_latents_conceal(s->latents, model, layer, begin, end) != ADCGS_OK)
                return adcgs_fail(error, ADCGS_ERR_MEMORY, "segment %u: no memory to conceal layer %d", adcgs_segment_number(s),
                                  layer);
        }
    return ADCGS_OK;
}

/** Complete the model with the received part of a tier: conceal missing layers, join kept anchors and earlier tiers. */
static adcgs_status complete_model(const adcgs_segment *s, adcgs_model *model, adcgs_error *error)
{
    while (model->layers < adcgs_params_layers(&s->stream->params) && s->done[model->layers] == s->n_slices)
        model->layers++;
    ADCGS_TRY(conceal_layers(s, model, error));
    if (s->coarser.n)
        ADCGS_TRY(adcgs_tiers_join(&s->coarser, model, s->options->memory, error));
    model->absent = (uint8_t)(model->predicted ? 0 : model->finest - s->tier);
    return ADCGS_OK;
}

/** Join the current tier with the coarser anchors, once. */
static adcgs_status join_model(adcgs_segment *s)
{
    if (!s->is_joined)
        ADCGS_TRY(complete_model(s, &s->model, s->error));
    s->is_joined = 1;
    return ADCGS_OK;
}

/** Read the anchors of a tier, or the new anchors of a predicted segment. */
static adcgs_status place_anchors(adcgs_segment *s, adcgs_parse *p)
{
    adcgs_nets_cost cost;
    ADCGS_TRY(check_nets(s, &cost));
    if (s->tier > 0)
        cost.weights = 0; /* the tiers share these networks: their weights count once */
    ADCGS_TRY(
        adcgs_geom_parse(p, s->limits, s->max_anchors, s->coarser.n, s->tier, &s->model, &s->left, &cost, s->options->memory));
    if (s->model.n)
        memset(s->model.tier, s->tier, s->model.n);
    ADCGS_TRY(adcgs_tiers_check(&s->coarser, &s->model, s->error));
    if (s->tier == 0)
        ADCGS_TRY(copy_nets(s));
    ADCGS_TRY(adcgs_latents_create(&s->latents, &s->model, s->options->cpu, s->options->memory, s->error));
    s->n_slices = s->model.n ? ((s->model.n - 1) >> s->stream->slice_log2) + 1 : 0;
    return ADCGS_OK;
}

/** Reset the current model to one without anchors but with its networks. The caller owns the returned previous model. */
static adcgs_model begin_tier(adcgs_segment *s)
{
    adcgs_model was = s->model;
    s->model = adcgs_model_frame(&was);
    memcpy(s->model.net, was.net, sizeof was.net);
    memset(was.net, 0, sizeof was.net);
    s->model.n = 0;
    s->model.layers = 0;
    adcgs_latents_free(&s->latents);
    memset(s->done, 0, sizeof s->done);
    s->n_slices = 0;
    s->is_joined = 0;
    return was;
}

/** Finish a tier: join it with the earlier ones, and prepare the model for the next tier. */
static adcgs_status end_tier(adcgs_segment *s)
{
    ADCGS_TRY(join_model(s));
    adcgs_model_clear(&s->coarser, s->options->memory);
    s->coarser = begin_tier(s);
    s->tier++;
    return ADCGS_OK;
}

/** Remove the tier that was begun; the segment keeps the earlier tiers. */
static void undo_tier(adcgs_segment *s)
{
    adcgs_model part = begin_tier(s);
    adcgs_model_clear(&part, s->options->memory);
    s->tier--;
}

adcgs_status adcgs_segment_place(adcgs_segment *s, adcgs_parse *p)
{
    if (s->stage == ADCGS_SEGMENT_NONE)
        return adcgs_fail(s->error, ADCGS_ERR_DATA, "GEOM: expected after SEGM");
    if (s->model.predicted && !s->has_kept)
        return adcgs_fail(s->error, ADCGS_ERR_DATA, "GEOM: expected after KEEP, the segment is predicted");
    if (s->stage == ADCGS_SEGMENT_PLACED && (s->model.predicted || s->tier == s->model.finest))
        return adcgs_fail(s->error, ADCGS_ERR_DATA, "GEOM: expected once for each tier, and there are %d tiers",
                          s->model.predicted ? 1 : s->model.finest + 1);
    if (s->stage == ADCGS_SEGMENT_PLACED && s->done[0] < s->n_slices)
        return adcgs_fail(s->error, ADCGS_ERR_DATA, "GEOM: slices of FEA0 of the previous tier are missing");
    if (s->stage == ADCGS_SEGMENT_PLACED)
        ADCGS_TRY(end_tier(s));
    const adcgs_status status = place_anchors(s, p);
    if (status != ADCGS_OK && s->tier > 0)
        undo_tier(s);
    if (status != ADCGS_OK)
        return status;
    s->is_key = !s->model.predicted && s->sent == s->ids.mask;
    s->stage = ADCGS_SEGMENT_PLACED;
    return ADCGS_OK;
}

adcgs_status adcgs_segment_hash(adcgs_segment *s, adcgs_parse *p)
{
    const uint64_t bit = 8 * (uint64_t)p->r.pos;
    if (s->stage != ADCGS_SEGMENT_PLACED || s->has_hash)
        return adcgs_fail(s->error, ADCGS_ERR_DATA, "hash: expected once, after the layers of its segment");
    char text[33];
    const uint8_t *hash = adcgs_read_bytes(&p->r, sizeof s->hash);
    if (!hash)
        return adcgs_fail(s->error, ADCGS_ERR_DATA, "hash: payload of %zu bytes, expected %zu", p->r.size, sizeof s->hash);
    memcpy(s->hash, hash, sizeof s->hash);
    adcgs_md5_hex(s->hash, text);
    adcgs_parse_trace(p, bit, "md5", "%s", text);
    s->has_hash = 1;
    return adcgs_parse_end(p);
}

static int tier_is_complete(const adcgs_segment *s)
{
    return s->stage == ADCGS_SEGMENT_PLACED && s->done[0] >= s->n_slices;
}

int adcgs_segment_is_drawable(const adcgs_segment *s)
{
    return tier_is_complete(s) || s->tier > 0;
}

int adcgs_segment_is_whole(const adcgs_segment *s)
{
    const int is_last = s->model.predicted || s->tier == s->model.finest;
    return tier_is_complete(s) && is_last && s->done[adcgs_layers_wanted(s) - 1] == s->n_slices;
}

int adcgs_segment_tiers(const adcgs_segment *s)
{
    const int complete = tier_is_complete(s);
    return s->model.predicted && complete ? s->model.finest + 1 : s->tier + complete;
}

int adcgs_segment_tier(const adcgs_segment *s, int is_geom)
{
    return s->tier + (is_geom && s->stage == ADCGS_SEGMENT_PLACED);
}

void adcgs_segment_drop_tier(adcgs_segment *s)
{
    if (tier_is_complete(s) || !s->tier)
        return;
    undo_tier(s); /* leaves a tier without slices, which counts as complete */
}

adcgs_status adcgs_segment_peek(const adcgs_segment *s, adcgs_model *model, int *drawable, adcgs_error *error)
{
    memset(model, 0, sizeof *model);
    *drawable = adcgs_segment_is_drawable(s);
    if (!*drawable)
        return ADCGS_OK;
    if (tier_is_complete(s)) {
        ADCGS_TRY(adcgs_model_copy(model, &s->model, s->options->memory, error));
        return s->is_joined ? ADCGS_OK : complete_model(s, model, error);
    }
    ADCGS_TRY(adcgs_model_copy(model, &s->coarser, s->options->memory, error));
    return adcgs_nets_copy(model, &s->model, s->options->memory, error);
}

static adcgs_status check_hash(const adcgs_segment *s)
{
    uint8_t digest[16];
    char expected[33], found[33];
    if (!s->has_hash || s->model.absent || s->model.layers < adcgs_params_layers(&s->stream->params))
        return ADCGS_OK;
    adcgs_model_digest(&s->model, digest);
    if (memcmp(digest, s->hash, sizeof digest) == 0)
        return ADCGS_OK;
    adcgs_md5_hex(s->hash, expected);
    adcgs_md5_hex(digest, found);
    return adcgs_fail(s->error, ADCGS_ERR_DATA, "hash: model of segment %u has digest %s, expected %s", adcgs_segment_number(s),
                      found, expected);
}

static adcgs_status append_model(adcgs_segment *s)
{
    adcgs_stream *stream = s->stream;
    if (stream->n_segments == s->capacity) {
        const uint32_t capacity = s->capacity ? 2 * s->capacity : 1;
        adcgs_model *models = adcgs_alloc(s->options->memory, capacity, sizeof *models, s->error);
        if (!models)
            return adcgs_alloc_status(s->error);
        if (stream->n_segments > 0)
            memcpy(models, stream->segments, stream->n_segments * sizeof *models);
        adcgs_free(s->options->memory, stream->segments);
        stream->segments = models;
        s->capacity = capacity;
    }
    stream->segments[stream->n_segments++] = s->model;
    memset(&s->model, 0, sizeof s->model);
    return ADCGS_OK;
}

adcgs_status adcgs_segment_finish(adcgs_segment *s, uint64_t end, int truncated)
{
    const adcgs_syn_index entry = {s->ticks[0], s->ticks[1],     (uint32_t)s->ticks[2],
                                   s->origin,   end - s->origin, (uint8_t)s->is_key};
    if (s->stage == ADCGS_SEGMENT_NONE)
        return ADCGS_OK;
    if (!tier_is_complete(s) && !truncated)
        return adcgs_fail(s->error, ADCGS_ERR_DATA, "segment %u: GEOM or slices of FEA0 are missing", adcgs_segment_number(s));
    adcgs_segment_drop_tier(s);
    if (!tier_is_complete(s)) {
        adcgs_segment_drop(s);
        return ADCGS_OK;
    }
    ADCGS_TRY(join_model(s));
    ADCGS_TRY(check_hash(s));
    ADCGS_TRY(adcgs_syn_index_write(&s->index, "INDX", &entry, s->error));
    if (s->index.failed)
        return adcgs_fail(s->error, ADCGS_ERR_MEMORY, "segment %u: no memory for its place in the index",
                          adcgs_segment_number(s));
    ADCGS_TRY(append_model(s));
    adcgs_segment_drop(s);
    return ADCGS_OK;
}
