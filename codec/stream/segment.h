/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Reading one time segment: SEGM, KEEP, GEOM, the slices of its layers as they come, and what is done when it ends. */
#ifndef ADCGS_STREAM_SEGMENT_H
#define ADCGS_STREAM_SEGMENT_H

#include "stream/parts.h"

/** Which of a segment's chunks have been seen. */
typedef enum adcgs_segment_stage { ADCGS_SEGMENT_NONE, ADCGS_SEGMENT_STARTED, ADCGS_SEGMENT_PLACED } adcgs_segment_stage;

/** The segment being read; lives through the whole stream. */
typedef struct adcgs_segment {
    adcgs_stream *stream; /**< receives the models of finished segments */
    const adcgs_read_options *options;
    const adcgs_level *limits;
    uint32_t max_anchors;
    const adcgs_net_table *nets;
    uint32_t capacity;    /**< of stream->segments */
    adcgs_cost left;      /**< of the level's model bytes and work */
    adcgs_buffer index;   /**< what INDX must hold, less the count */
    int64_t ticks[3];     /**< of the segment read last: start, end, reach */

    adcgs_segment_stage stage;
    uint64_t origin;      /**< position of SEGM */
    adcgs_model model;    /**< of the anchors of its last GEOM, until it is finished */
    adcgs_model coarser;  /**< what is kept, or the tiers before, joined; without networks. n = 0: there is none */
    int tier;             /**< that the model at hand is */
    int is_joined;        /**< the model has all that has come of its tier, and the coarser anchors, already */
    adcgs_role_ids ids;
    uint16_t sent;        /**< roles whose networks stand in the segment, before GEOM */
    int has_kept;         /**< KEEP was read */
    int is_key;           /**< it needs nothing of an earlier segment */
    adcgs_latents *latents;
    uint32_t n_slices;
    uint32_t done[ADCGS_LAYERS]; /**< slices decoded, by layer */
    int has_hash;
    uint8_t hash[16];
    adcgs_error *error;
} adcgs_segment;

adcgs_status adcgs_segment_start(adcgs_segment *s, adcgs_parse *p, uint64_t origin);
/** A NETW, which was just entered into the table. */
void adcgs_segment_networks(adcgs_segment *s);
adcgs_status adcgs_segment_keep(adcgs_segment *s, adcgs_parse *p);
adcgs_status adcgs_segment_place(adcgs_segment *s, adcgs_parse *p);
/** The tier that a chunk, GEOM or one of FEAx, should be of. */
int adcgs_segment_tier(const adcgs_segment *s, int is_geom);
/** FEAx; complete zero: the stream ended inside, and what is there is used. */
adcgs_status adcgs_segment_features(adcgs_segment *s, adcgs_parse *p, int layer, int complete);
adcgs_status adcgs_segment_hash(adcgs_segment *s, adcgs_parse *p);
/**
 * The segment, if one was started, ends at this position. With truncated, one without a complete layer 0 is dropped; of one with
 * several tiers only those are that have none.
 */
adcgs_status adcgs_segment_finish(adcgs_segment *s, uint64_t end, int truncated);
/** The segment as it would be if nothing more came; *drawable: it can be used. The caller clears the model. */
adcgs_status adcgs_segment_peek(const adcgs_segment *s, adcgs_model *model, int *drawable, adcgs_error *error);
/** Whether it can be used if nothing more comes. */
int adcgs_segment_is_drawable(const adcgs_segment *s);
/** Whether nothing that could still come of it would change it: all its tiers are there, with all layers that are wanted. */
int adcgs_segment_is_whole(const adcgs_segment *s);
/** Tiers of it that can be drawn. */
int adcgs_segment_tiers(const adcgs_segment *s);
/** Forget the tier that was begun, if it is not complete; the segment can be drawn without. */
void adcgs_segment_drop_tier(adcgs_segment *s);
/** Forget the segment that was begun, if any. */
void adcgs_segment_drop(adcgs_segment *s);
void adcgs_segment_clear(adcgs_segment *s);

#endif
