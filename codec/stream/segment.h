/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Reading one time segment: SEGM, KEEP, GEOM, the slices of its layers as they arrive, and the work at its end. */
#ifndef ADCGS_STREAM_SEGMENT_H
#define ADCGS_STREAM_SEGMENT_H

#include "stream/parts.h"

/** The chunks of a segment read so far. */
typedef enum adcgs_segment_stage { ADCGS_SEGMENT_NONE, ADCGS_SEGMENT_STARTED, ADCGS_SEGMENT_PLACED } adcgs_segment_stage;

/** The segment being read; one object serves the whole stream. */
typedef struct adcgs_segment {
    adcgs_stream *stream; /**< receives the models of finished segments */
    const adcgs_read_options *options;
    const adcgs_level *limits;
    uint32_t max_anchors;
    const adcgs_net_table *nets;
    uint32_t capacity;  /**< of stream->segments */
    adcgs_cost left;    /**< remaining model bytes and work of the level */
    adcgs_buffer index; /**< expected contents of INDX, without the count */
    int64_t ticks[3];   /**< of the last segment read: start, end, reach */

    adcgs_segment_stage stage;
    uint64_t origin;     /**< position of SEGM */
    adcgs_model model;   /**< model with the anchors of the last GEOM, until it is finished */
    adcgs_model coarser; /**< kept anchors, or the earlier tiers joined; without networks. n = 0: none */
    int tier;            /**< tier of the current model */
    int is_joined;       /**< the model already has everything received of its tier, and the coarser anchors */
    adcgs_role_ids ids;
    uint16_t sent; /**< roles whose networks were sent in the segment, before GEOM */
    int has_kept;  /**< KEEP was read */
    int is_key;    /**< depends on no earlier segment */
    adcgs_latents *latents;
    uint32_t n_slices;
    uint32_t done[ADCGS_LAYERS]; /**< slices decoded, by layer */
    int has_hash;
    uint8_t hash[16];
    adcgs_error *error;
} adcgs_segment;

adcgs_status adcgs_segment_start(adcgs_segment *s, adcgs_parse *p, uint64_t origin);
/** Note a NETW that was just entered into the table. */
void adcgs_segment_networks(adcgs_segment *s);
adcgs_status adcgs_segment_keep(adcgs_segment *s, adcgs_parse *p);
adcgs_status adcgs_segment_place(adcgs_segment *s, adcgs_parse *p);
/** The expected tier of the next chunk, GEOM or one of FEAx. */
int adcgs_segment_tier(const adcgs_segment *s, int is_geom);
/** FEAx; complete is zero if the stream ended inside: the received part is used. */
adcgs_status adcgs_segment_features(adcgs_segment *s, adcgs_parse *p, int layer, int complete);
adcgs_status adcgs_segment_hash(adcgs_segment *s, adcgs_parse *p);
/**
 * End the current segment, if any, at this position. With truncated, a segment without a complete layer 0 is dropped. If it has
 * several tiers, only the tiers without a complete layer 0 are dropped.
 */
adcgs_status adcgs_segment_finish(adcgs_segment *s, uint64_t end, int truncated);
/** Copy the segment as it would be if nothing more came; *drawable: it can be rendered. The caller clears the model. */
adcgs_status adcgs_segment_peek(const adcgs_segment *s, adcgs_model *model, int *drawable, adcgs_error *error);
/** Whether the segment can be rendered if nothing more comes. */
int adcgs_segment_is_drawable(const adcgs_segment *s);
/** Whether no further chunk can change the segment: all tiers are present, with all requested layers. */
int adcgs_segment_is_whole(const adcgs_segment *s);
/** Number of its tiers that can be rendered. */
int adcgs_segment_tiers(const adcgs_segment *s);
/** Drop the tier that was begun if it is incomplete; the segment must be renderable without it. */
void adcgs_segment_drop_tier(adcgs_segment *s);
/** Drop the segment that was begun, if any. */
void adcgs_segment_drop(adcgs_segment *s);
void adcgs_segment_clear(adcgs_segment *s);

#endif
