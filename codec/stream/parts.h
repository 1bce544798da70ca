/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Payloads of the chunks. One function parses and one writes each kind of payload, both in one file. */
#ifndef ADCGS_STREAM_PARTS_H
#define ADCGS_STREAM_PARTS_H

#include "model/inter.h"
#include "stream/chunk.h"

/** The networks of a stream; a network's id is its index here. */
typedef struct adcgs_net_table {
    adcgs_net *nets;
    uint32_t n, capacity;
    uint64_t weights;
    uint32_t sent[2]; /**< ids of the last chunk read: first, and one past the last */
    int has_gaps;     /**< reading began in the middle: networks of some ids may be missing */
    adcgs_memory *memory;
} adcgs_net_table;

void adcgs_net_table_clear(adcgs_net_table *table);
/** NETW: add its networks. A network whose id is already taken must equal the existing one. left: remaining work of the level. */
adcgs_status adcgs_netw_parse(adcgs_parse *p, const adcgs_params *params, const adcgs_level *limits, adcgs_cost *left,
                              adcgs_net_table *table);
/** Write nets with ids first_id, first_id + 1, ... */
adcgs_status adcgs_netw_write(adcgs_buffer *out, const adcgs_net *const *nets, uint32_t n, uint32_t first_id, adcgs_error *error);

/** HEAD from and to the fields of a stream; segments and max_anchors stay in head. */
adcgs_status adcgs_head_parse(adcgs_parse *p, adcgs_syn_head *head, adcgs_stream *stream);
adcgs_status adcgs_head_write(adcgs_buffer *out, const adcgs_stream *stream, uint32_t max_anchors, adcgs_error *error);

/** Network ids by role; roles without a bit in mask have none. */
typedef struct adcgs_role_ids {
    uint16_t mask;
    uint16_t id[ADCGS_ROLES];
} adcgs_role_ids;

/**
 * SEGM: times, network ids, tiers, steps and the prior of eta. A predicted segment inherits the missing values from the previous
 * one. model->params is set. ticks: its start, end and reach.
 */
adcgs_status adcgs_segm_parse(adcgs_parse *p, const adcgs_stream *stream, adcgs_model *model, adcgs_role_ids *ids,
                              int64_t ticks[3]);
adcgs_status adcgs_segm_write(adcgs_buffer *out, const adcgs_stream *stream, const adcgs_model *model, const adcgs_role_ids *ids,
                              adcgs_error *error);
/** KEEP: the kept anchors of the previous model. left: remaining budget of the level; the function subtracts the cost. */
adcgs_status adcgs_keep_parse(adcgs_parse *p, const adcgs_level *limits, const adcgs_model *before, adcgs_inter *kept,
                              adcgs_cost *left, adcgs_memory *memory);
/**
 * GEOM: allocates the model's arrays after checking the counts, and decodes the positions of a tier or, in a predicted segment,
 * of its new anchors. others: number of other anchors, of earlier tiers or kept. left: remaining budget of the level; the
 * function subtracts the cost.
 */
adcgs_status adcgs_geom_parse(adcgs_parse *p, const adcgs_level *limits, uint32_t max_anchors, uint32_t others, int tier,
                              adcgs_model *model, adcgs_cost *left, const adcgs_nets_cost *nets, adcgs_memory *memory);
adcgs_status adcgs_geom_write(adcgs_buffer *out, const adcgs_model *model, int tier, adcgs_error *error);

adcgs_status adcgs_cams_parse(adcgs_parse *p, adcgs_stream *stream, adcgs_memory *memory);
adcgs_status adcgs_cams_write(adcgs_buffer *out, const adcgs_stream *stream, adcgs_error *error);
adcgs_status adcgs_meta_parse(adcgs_parse *p, adcgs_stream *stream, adcgs_memory *memory);
adcgs_status adcgs_meta_write(adcgs_buffer *out, const adcgs_stream *stream, adcgs_error *error);

#endif
