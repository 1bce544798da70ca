/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The payloads of the chunks: each is parsed by one function and written by another, in one file. */
#ifndef ADCGS_STREAM_PARTS_H
#define ADCGS_STREAM_PARTS_H

#include "model/keep.h"
#include "stream/chunk.h"

/** The networks of a stream: a network's id is its place here. */
typedef struct adcgs_net_table {
    adcgs_net *nets;
    uint32_t n, capacity;
    uint64_t weights;
    uint32_t sent[2]; /**< ids of the chunk read last: from, to below */
    int has_gaps;     /**< reading began in the middle: ids whose networks were not read may be missing */
    adcgs_memory *memory;
} adcgs_net_table;

void adcgs_net_table_clear(adcgs_net_table *table);
/** NETW: add its networks; one whose id is already taken must be equal to it. left is what is left of the level's work. */
adcgs_status adcgs_netw_parse(adcgs_parse *p, const adcgs_params *params, const adcgs_level *limits, adcgs_cost *left,
                              adcgs_net_table *table);
/** nets with ids first_id, first_id + 1, ... */
adcgs_status adcgs_netw_write(adcgs_buffer *out, const adcgs_net *const *nets, uint32_t n, uint32_t first_id, adcgs_error *error);

/** HEAD to and from the fields of a stream; segments and max_anchors stay in head. */
adcgs_status adcgs_head_parse(adcgs_parse *p, adcgs_syn_head *head, adcgs_stream *stream);
adcgs_status adcgs_head_write(adcgs_buffer *out, const adcgs_stream *stream, uint32_t max_anchors, adcgs_error *error);

/** Network ids by role; roles without a bit in mask have none. */
typedef struct adcgs_role_ids {
    uint16_t mask;
    uint16_t id[ADCGS_ROLES];
} adcgs_role_ids;

/**
 * SEGM: times, which networks, shapes, steps and the prior of eta; what a predicted segment has of the one before is taken from
 * it. model->params is set. ticks: its start, its end, its reach.
 */
adcgs_status adcgs_segm_parse(adcgs_parse *p, const adcgs_stream *stream, adcgs_model *model, adcgs_role_ids *ids,
                              int64_t ticks[3]);
adcgs_status adcgs_segm_write(adcgs_buffer *out, const adcgs_stream *stream, const adcgs_model *model, const adcgs_role_ids *ids,
                              adcgs_error *error);
/** KEEP: what is kept of the model before. left: of the level, is used up. */
adcgs_status adcgs_keep_parse(adcgs_parse *p, const adcgs_level *limits, const adcgs_model *before, adcgs_keep *kept,
                              adcgs_cost *left, adcgs_memory *memory);
/**
 * GEOM: allocates the model's arrays once the counts are checked, and decodes the positions of a tier, of a predicted segment
 * those of its new anchors. others: anchors beside these, of the tiers before or kept. left: of the level, is used up.
 */
adcgs_status adcgs_geom_parse(adcgs_parse *p, const adcgs_level *limits, uint32_t max_anchors, uint32_t others, int tier,
                              adcgs_model *model, adcgs_cost *left, const adcgs_nets_cost *nets, adcgs_memory *memory);
adcgs_status adcgs_geom_write(adcgs_buffer *out, const adcgs_model *model, int tier, adcgs_error *error);

adcgs_status adcgs_cams_parse(adcgs_parse *p, adcgs_stream *stream, adcgs_memory *memory);
adcgs_status adcgs_cams_write(adcgs_buffer *out, const adcgs_stream *stream, adcgs_error *error);
adcgs_status adcgs_meta_parse(adcgs_parse *p, adcgs_stream *stream, adcgs_memory *memory);
adcgs_status adcgs_meta_write(adcgs_buffer *out, const adcgs_stream *stream, adcgs_error *error);

#endif
