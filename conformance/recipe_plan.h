/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The settings of a recipe, and the resulting stream: header, models, and the
 * sub-streams of their features. Values are coded while they are drawn at
 * random, so that codes occur that no encoder would choose.
 */
#ifndef ADCGS_CONFORMANCE_RECIPE_PLAN_H
#define ADCGS_CONFORMANCE_RECIPE_PLAN_H

#include "chunks.h"
#include "recipe.h"

#include "model/inter.h"
#include "stream/stream.h"

#define ADCGS_PLAN_SEGMENTS 20
#define ADCGS_PLAN_CAMERAS 8
#define ADCGS_PLAN_LAYERS 4
#define ADCGS_PLAN_TIMES 8

/** Which bits of masks, or which static flags, are set; which bodies anchors have. */
typedef enum adcgs_pick { ADCGS_PICK_RANDOM, ADCGS_PICK_ALL, ADCGS_PICK_NONE, ADCGS_PICK_FIRST, ADCGS_PICK_TURNS } adcgs_pick;

/** Positions of the anchors' voxels. */
typedef enum adcgs_spread {
    ADCGS_SPREAD_RANDOM, /**< one voxel in each run of equal length along the Morton order */
    ADCGS_SPREAD_DENSE,  /**< the first ones in Morton order */
    ADCGS_SPREAD_PLANE,  /**< random, all in the middle plane of z */
    ADCGS_SPREAD_LINE,   /**< along x, y and z are 0 */
    ADCGS_SPREAD_MIXED,  /**< half dense, half random */
    ADCGS_SPREAD_ENDS    /**< the first and the last ones */
} adcgs_spread;

/** Values that no command forces. */
typedef enum adcgs_fill {
    ADCGS_FILL_PAINT,  /**< extents and colours for a visible image, the rest small */
    ADCGS_FILL_RANDOM, /**< small, occasionally large */
    ADCGS_FILL_ZERO,
    ADCGS_FILL_EDGES,   /**< the outermost symbols of the tables */
    ADCGS_FILL_ESCAPES, /**< escape codes of every length and both signs */
    ADCGS_FILL_CLIPS    /**< so large that the value is clipped */
} adcgs_fill;

/** Anchors that a predicted segment keeps from the segment before. */
typedef enum adcgs_hold {
    ADCGS_HOLD_RANDOM,
    ADCGS_HOLD_ALL,     /**< all, unchanged */
    ADCGS_HOLD_REFINED, /**< all, with differences */
    ADCGS_HOLD_NONE,
    ADCGS_HOLD_FIRST,
    ADCGS_HOLD_TURNS /**< dropped, unchanged, refined, in turn */
} adcgs_hold;

/** Differences of refined anchors. */
typedef enum adcgs_change {
    ADCGS_CHANGE_SMALL,   /**< a few steps, or none */
    ADCGS_CHANGE_ESCAPES, /**< every length of code whose latents stay within 16 bits, both signs */
    ADCGS_CHANGE_CLIPS    /**< to the limits, in both directions */
} adcgs_change;

/** The coded parts of a tier; slices: [layer * n_slices + slice]. */
typedef struct adcgs_drawn_tier {
    adcgs_buffer geom; /**< payload */
    uint32_t n_slices;
    adcgs_buffer *data;
} adcgs_drawn_tier;

/** The coded parts of a segment. */
typedef struct adcgs_drawn {
    adcgs_buffer keep; /**< payload, of a predicted segment */
    adcgs_drawn_tier tier[ADCGS_TIERS_MAX];
} adcgs_drawn;

typedef struct adcgs_plan {
    adcgs_recipe *recipe;
    uint64_t seed, state;
    uint32_t segments;
    uint32_t anchors[ADCGS_PLAN_SEGMENTS]; /**< in predicted segments: new anchors */
    int predicted[ADCGS_PLAN_SEGMENTS];
    int kept, differences, changed;         /**< adcgs_hold, adcgs_change; bits: groups with differences */
    int tiers, growth[ADCGS_TIERS_MAX - 1]; /**< of segments that are not predicted */
    uint8_t depth;
    double origin[3], voxel; /**< voxel 0: the cube's edge is 2 */
    int64_t ticks[2 * ADCGS_PLAN_SEGMENTS];
    uint32_t reach[ADCGS_PLAN_SEGMENTS];           /**< ticks */
    int masks, statics, bodies, positions, values; /**< adcgs_pick, adcgs_spread, adcgs_fill */
    int no_digest;
    adcgs_stream stream;
    adcgs_drawn drawn[ADCGS_PLAN_SEGMENTS];
    int n_cameras, n_times; /**< frames to compare: each camera at each time */
    adcgs_camera cameras[ADCGS_PLAN_CAMERAS];
    double times[ADCGS_PLAN_TIMES];
    int n_fewer, fewer[ADCGS_PLAN_LAYERS]; /**< numbers of layers, below the stream's, for further comparisons */
} adcgs_plan;

/** Set the plan from the settings of the recipe. */
adcgs_status adcgs_plan_init(adcgs_plan *plan, adcgs_recipe *recipe, adcgs_error *error);
void adcgs_plan_clear(adcgs_plan *plan);
/** Make the models and code their features. */
adcgs_status adcgs_plan_draw(adcgs_plan *plan, adcgs_error *error);
/** Choose the kept anchors of a model, in inter_modes.c. The caller clears kept. */
adcgs_status adcgs_plan_keep(adcgs_plan *plan, const adcgs_model *before, adcgs_inter *kept, adcgs_error *error);
/** Carry out a whole recipe: settings, models, chunks, edits. The caller clears plan, also after a failure. */
adcgs_status adcgs_plan_build(adcgs_plan *plan, adcgs_recipe *recipe, adcgs_buffer *file, adcgs_error *error);
/** The stream as chunks. */
adcgs_status adcgs_plan_compose(adcgs_plan *plan, adcgs_chunk_list *out, adcgs_error *error);

/* Networks, in nets.c. */
adcgs_status adcgs_plan_nets(adcgs_plan *plan, uint32_t segment, adcgs_error *error);
/** Apply a command that sets a number of a network (weight, poke) to this network. */
adcgs_status adcgs_plan_set_weight(adcgs_plan *plan, const adcgs_command *command, adcgs_net *net, adcgs_error *error);

/** Call fn for each command with this verb and mark the command as used; messages name its line. */
typedef adcgs_status (*adcgs_command_fn)(adcgs_plan *plan, const adcgs_command *command, void *user, adcgs_error *error);
adcgs_status adcgs_plan_each(adcgs_plan *plan, const char *verb, adcgs_command_fn fn, void *user, adcgs_error *error);

/* Commands that add to lists, in plan_views.c. */
adcgs_status adcgs_plan_add_camera(adcgs_plan *plan, const adcgs_command *command, void *user, adcgs_error *error);
adcgs_status adcgs_plan_add_stored(adcgs_plan *plan, const adcgs_command *command, void *user, adcgs_error *error);
adcgs_status adcgs_plan_add_meta(adcgs_plan *plan, const adcgs_command *command, void *user, adcgs_error *error);

#endif
