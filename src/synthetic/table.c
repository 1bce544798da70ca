/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The scenes on a table. To add one, add a line to the table below, and objects if the present ones do not suffice.
 */
#include "synthetic/table.h"

/* A table top under a wide sky. Everything rests on z = 0; the cameras stand on the -y side. */
#define DOME                                                                                                    \
    {.shape = ADCGS_SHAPE_DOME, .size = {7.0}, .texture = ADCGS_TEXTURE_NOISE, .frequency = 0.35,               \
     .colour = {{0.42, 0.56, 0.74}, {0.86, 0.84, 0.80}}, .seed = 11}
#define TABLE_TOP                                                                                               \
    {.shape = ADCGS_SHAPE_FLOOR, .size = {2.6}, .texture = ADCGS_TEXTURE_CHECKER, .frequency = 1.6,             \
     .colour = {{0.72, 0.64, 0.52}, {0.50, 0.46, 0.44}}, .detail = 0.30, .seed = 12}
#define CRATE                                                                                                   \
    {.shape = ADCGS_SHAPE_BOX, .size = {0.36, 0.36, 0.36}, .position = {-0.95, 0.50, 0.36},                     \
     .texture = ADCGS_TEXTURE_PATCHES, .frequency = 6.0, .colour = {{0.15, 0.35, 0.55}, {0.90, 0.85, 0.60}},    \
     .seed = 13}
#define DRUM                                                                                                    \
    {.shape = ADCGS_SHAPE_CYLINDER, .size = {0.28, 0.0, 0.52}, .position = {0.92, 0.62, 0.52},                  \
     .texture = ADCGS_TEXTURE_STRIPES, .frequency = 4.0, .colour = {{0.85, 0.82, 0.78}, {0.22, 0.42, 0.34}},    \
     .detail = 0.2, .seed = 14}
#define DOTTED_BALL                                                                                             \
    {.shape = ADCGS_SHAPE_BALL, .size = {0.22}, .position = {-0.15, -1.00, 0.22}, .texture = ADCGS_TEXTURE_DOTS, \
     .frequency = 7.0, .colour = {{0.92, 0.88, 0.80}, {0.75, 0.25, 0.20}}, .seed = 15}
#define PEDESTAL                                                                                                \
    {.shape = ADCGS_SHAPE_CYLINDER, .size = {0.42, 0.0, 0.16}, .position = {0.0, 0.15, 0.16},                   \
     .texture = ADCGS_TEXTURE_NOISE, .frequency = 5.0, .colour = {{0.30, 0.26, 0.30}, {0.80, 0.76, 0.82}},      \
     .seed = 16}
#define STILL DOME, TABLE_TOP, CRATE, DRUM, DOTTED_BALL

static const adcgs_trace_object stage[] = {
    STILL,
    PEDESTAL,
    /* 6: a ball that hops and rolls */
    {.shape = ADCGS_SHAPE_BALL, .size = {0.26}, .position = {-1.10, -0.45, 0.26}, .texture = ADCGS_TEXTURE_CHECKER,
     .frequency = 5.0, .colour = {{0.95, 0.72, 0.15}, {0.20, 0.22, 0.50}}, .seed = 17, .velocity = {1.0, -0.05, 0.0},
     .bounces = 1.0, .bounce_height = 0.40, .spin_axis = {0.0, 1.0, 0.0}, .spin = 0.45},
    /* 7: a box that turns on a pedestal */
    {.shape = ADCGS_SHAPE_BOX, .size = {0.26, 0.20, 0.26}, .position = {0.0, 0.15, 0.58}, .texture = ADCGS_TEXTURE_RINGS,
     .frequency = 28.0, .colour = {{0.88, 0.50, 0.42}, {0.35, 0.18, 0.35}}, .detail = 0.25, .seed = 18,
     .spin_axis = {0.0, 0.0, 1.0}, .spin = 0.20},
    /* 8: a ball that passes behind the static objects */
    {.shape = ADCGS_SHAPE_BALL, .size = {0.24}, .position = {-0.85, 1.30, 0.24}, .texture = ADCGS_TEXTURE_STRIPES,
     .frequency = 6.0, .colour = {{0.20, 0.60, 0.62}, {0.92, 0.92, 0.86}}, .seed = 19, .velocity = {1.5, -0.15, 0.0},
     .spin_axis = {0.0, 1.0, 0.0}, .spin = 0.60},
    /* 9: a ball that changes colour slowly */
    {.shape = ADCGS_SHAPE_BALL, .size = {0.30}, .position = {1.10, -0.40, 0.30}, .texture = ADCGS_TEXTURE_NOISE,
     .frequency = 5.0, .colour = {{0.85, 0.30, 0.25}, {0.98, 0.62, 0.45}}, .seed = 20, .fade = {-0.60, 0.25, 0.40}},
    /* 10: a small ball that flies around the turning box */
    {.shape = ADCGS_SHAPE_BALL, .size = {0.13}, .position = {-0.50, 0.00, 1.15}, .texture = ADCGS_TEXTURE_CHECKER,
     .frequency = 9.0, .colour = {{0.30, 0.70, 0.30}, {0.90, 0.95, 0.70}}, .seed = 21, .orbit = {0.0, 0.15},
     .orbit_turns = 0.40},
};

/* Moving objects of the demo, as bits by their places; definition. */
enum { HOP = 1 << 6, SPIN = 1 << 7, PASS = 1 << 8, FADE = 1 << 9, ORBIT = 1 << 10 };

/* A few objects that are easy to train. */
static const adcgs_trace_object mini[] = {
    {.shape = ADCGS_SHAPE_DOME, .size = {7.0}, .texture = ADCGS_TEXTURE_NOISE, .frequency = 0.25,
     .colour = {{0.45, 0.55, 0.70}, {0.80, 0.80, 0.80}}, .seed = 31},
    {.shape = ADCGS_SHAPE_FLOOR, .size = {2.4}, .texture = ADCGS_TEXTURE_NOISE, .frequency = 1.5,
     .colour = {{0.70, 0.60, 0.50}, {0.45, 0.45, 0.40}}, .seed = 32},
    {.shape = ADCGS_SHAPE_BOX, .size = {0.45, 0.45, 0.45}, .position = {-0.60, 0.30, 0.45}, .texture = ADCGS_TEXTURE_STRIPES,
     .frequency = 2.0, .colour = {{0.20, 0.35, 0.60}, {0.85, 0.80, 0.60}}, .seed = 33},
    {.shape = ADCGS_SHAPE_BALL, .size = {0.40}, .position = {0.40, -0.40, 0.40}, .texture = ADCGS_TEXTURE_NOISE,
     .frequency = 3.0, .colour = {{0.80, 0.30, 0.20}, {0.95, 0.75, 0.30}}, .seed = 34, .velocity = {0.60, 0.0, 0.0}},
};

/* ---- Motion of a known size: an object with texture to follow, on the demo's table ---- */

#define DISTANCE 4.2 /* scene units from the cameras to the target; chosen by hand */
#define VISIBLE (DISTANCE * 2.0 / ADCGS_SCENES_FOCAL) /* the image's width at the target */

/* A parcel: patches of 5 pixels at the images' default size, with grain. */
#define PATCHED .texture = ADCGS_TEXTURE_PATCHES, .frequency = 9.0, .detail = 0.6,                             \
                .colour = {{0.95, 0.80, 0.35}, {0.35, 0.12, 0.20}}
#define PARCEL .shape = ADCGS_SHAPE_BOX, PATCHED
/* Along x from one side of the target to the other: horizontal in the middle camera of the arc. */
#define CROSSING(share)                                                                                         \
    {PARCEL, .size = {0.26, 0.22, 0.26}, .position = {-0.5 * (share) * VISIBLE, -0.10, 0.26}, .seed = 41,      \
     .velocity = {(share) * VISIBLE, 0.0, 0.0}}
#define TURNING(turns)                                                                                          \
    {PARCEL, .size = {0.34, 0.25, 0.28}, .position = {0.0, 0.15, 0.60}, .seed = 42, .spin_axis = {0.0, 0.0, 1.0}, .spin = (turns)}
#define HALF(side, number)                                                                                      \
    {PARCEL, .size = {0.19, 0.24, 0.28}, .position = {0.19 * (side), -0.10, 0.28}, .seed = (number),           \
     .velocity = {0.55 * (side), 0.0, 0.0}}

static const adcgs_trace_object cross5[] = {STILL, CROSSING(0.05)};
static const adcgs_trace_object cross20[] = {STILL, CROSSING(0.20)};
static const adcgs_trace_object cross80[] = {STILL, CROSSING(0.80)};
static const adcgs_trace_object turn1[] = {STILL, PEDESTAL, TURNING(1.0)};
static const adcgs_trace_object turn3[] = {STILL, PEDESTAL, TURNING(3.0)};
static const adcgs_trace_object appear[] = {
    STILL, PEDESTAL, {PARCEL, .size = {0.28, 0.24, 0.30}, .position = {0.0, 0.15, 0.62}, .seed = 43, .from = 0.5}};
/* Ten seconds, in which a fifth of the image moves. The parcel appears in flight, the ball disappears while it rolls. */
static const adcgs_trace_object clip[] = {
    STILL,
    PEDESTAL,
    {PARCEL, .size = {0.30, 0.22, 0.26}, .position = {0.0, 0.15, 0.58}, .seed = 46, .spin_axis = {0.0, 0.0, 1.0}, .spin = 3.0},
    {.shape = ADCGS_SHAPE_BALL, .size = {0.26}, .position = {-1.10, -0.45, 0.26}, .texture = ADCGS_TEXTURE_CHECKER,
     .frequency = 5.0, .colour = {{0.95, 0.72, 0.15}, {0.20, 0.22, 0.50}}, .seed = 47, .velocity = {1.0, -0.05, 0.0},
     .bounces = 8.0, .bounce_height = 0.40, .until = 0.55},
    {PARCEL, .size = {0.18, 0.18, 0.18}, .position = {0.2, -0.75, 0.9}, .seed = 48, .velocity = {0.9, 0.3, -0.7}, .from = 0.35},
    {.shape = ADCGS_SHAPE_LAMP, .size = {0.7}, .position = {-0.7, -0.1, 1.0}, .from = 0.45},
};
/* Steps of increasing complexity, from one static object to many that flow; other scenes of this size fit in between. */
#define PLAIN_DOME {.shape = ADCGS_SHAPE_DOME, .size = {7.0}, .colour = {{0.55, 0.60, 0.66}, {0.55, 0.60, 0.66}}}
#define STANDING(x, y) {PARCEL, .size = {0.30, 0.24, 0.34}, .position = {x, y, 0.34}, .seed = 51}
#define ARM(side, number)                                                                                       \
    {PARCEL, .size = {0.34, 0.10, 0.08}, .position = {0.40 * (side), 0.15, 0.42}, .seed = (number),            \
     .orbit = {0.0, 0.15}, .orbit_turns = 0.35 * (side), .spin_axis = {0.0, 0.0, 1.0}, .spin = 0.35 * (side)}
#define DROP(x, y, to_x, to_y, hops, height, number)                                                            \
    {.shape = ADCGS_SHAPE_BALL, .size = {0.07}, .position = {x, y, 0.30}, .colour = {{0.25, 0.45, 0.85}, {0.60, 0.85, 0.95}},  \
     .texture = ADCGS_TEXTURE_NOISE, .frequency = 9.0, .seed = (number), .velocity = {to_x, to_y, -0.15},      \
     .bounces = (hops), .bounce_height = (height)}
static const adcgs_trace_object object[] = {PLAIN_DOME, STANDING(0.0, 0.0)};
static const adcgs_trace_object pair[] = {PLAIN_DOME, STANDING(-0.45, 0.0), STANDING(0.45, 0.0)};
static const adcgs_trace_object table[] = {STILL};
static const adcgs_trace_object several[] = {
    STILL, PEDESTAL, TURNING(0.5),
    {PARCEL, .size = {0.18, 0.18, 0.18}, .position = {-0.9, -0.45, 0.18}, .seed = 52, .velocity = {0.8, -0.3, 0.0}},
    {.shape = ADCGS_SHAPE_BALL, .size = {0.22}, .position = {1.0, -0.5, 0.22}, .texture = ADCGS_TEXTURE_CHECKER,
     .frequency = 5.0, .colour = {{0.95, 0.72, 0.15}, {0.20, 0.22, 0.50}}, .seed = 53, .velocity = {-0.5, 0.1, 0.0},
     .bounces = 1.0, .bounce_height = 0.30, .spin_axis = {0.0, 1.0, 0.0}, .spin = -0.3},
};
static const adcgs_trace_object hinge[] = {STILL, PEDESTAL, ARM(-1.0, 54), ARM(1.0, 55)};
static const adcgs_trace_object soft[] = {
    STILL, PEDESTAL,
    {.shape = ADCGS_SHAPE_BALL, PATCHED, .size = {0.30}, .position = {0.0, 0.15, 0.62}, .seed = 56, .stretch = {0.3, 0.0, -0.3},
     .beats = 1.0}};
static const adcgs_trace_object drops[] = {
    STILL, PEDESTAL,
    DROP(0.0, 0.1, 0.6, -0.3, 1.0, 0.60, 61), DROP(0.1, 0.1, -0.6, -0.5, 1.2, 0.50, 62),
    DROP(0.0, 0.2, 0.2, -0.8, 1.5, 0.40, 63), DROP(0.1, 0.2, -0.2, -0.7, 0.8, 0.70, 64),
    DROP(-0.1, 0.1, -0.8, 0.1, 1.1, 0.55, 65), DROP(0.0, 0.0, 0.8, 0.2, 1.4, 0.45, 66),
    DROP(0.1, 0.0, 0.4, -0.6, 0.9, 0.65, 67), DROP(-0.1, 0.2, -0.4, -0.4, 1.3, 0.50, 68),
    DROP(-0.1, 0.0, 0.0, -0.9, 1.0, 0.60, 69), DROP(0.2, 0.1, 0.7, -0.6, 1.6, 0.35, 70),
    DROP(-0.2, 0.1, -0.7, -0.7, 1.2, 0.45, 71), DROP(0.0, 0.3, 0.1, 0.3, 0.9, 0.75, 72),
};
static const adcgs_trace_object split[] = {STILL, HALF(-1.0, 44), HALF(1.0, 45)};

/* ---- Cases where methods fail, one difficulty each; the names or --motion give the degree ---- */

/* Back and forth at constant speed: each zig covers twice the share of the image's width in a clip. */
#define ZIGZAG(share, up, times)                                                                                \
    {PARCEL, .size = {0.24, 0.22, 0.24}, .position = {-0.5 * (share) * VISIBLE, -0.10, 0.24}, .seed = 81,      \
     .zigzag = {(share) * VISIBLE, 0.0, up}, .zigs = (times)}
#define BLINK(moments)                                                                                          \
    {PARCEL, .size = {0.28, 0.24, 0.30}, .position = {0.0, 0.15, 0.62}, .seed = 82, .from = 11.75 / 23.0,       \
     .until = (11.75 + (moments)) / 23.0}
/* Upright, on a rotating circle. The thickness is given in pixels of an image 160 pixels wide. */
#define ROD(pixels, x, y)                                                                                       \
    {.shape = ADCGS_SHAPE_CYLINDER, .size = {0.5 * (pixels) * VISIBLE / 160.0, 0.0, 0.45}, .position = {x, y, 0.77}, \
     .colour = {{0.16, 0.10, 0.22}, {0.16, 0.10, 0.22}}, .orbit = {0.0, 0.15}, .orbit_turns = 0.3}
#define RODS(pixels)                                                                                            \
    ROD(pixels, 0.36, 0.15), ROD(pixels, 0.11, 0.49), ROD(pixels, -0.29, 0.36), ROD(pixels, -0.29, -0.06),      \
        ROD(pixels, 0.11, -0.19)
#define PANE(share, kind)                                                                                       \
    {.shape = ADCGS_SHAPE_BALL, .size = {0.36}, .position = {-0.35, -0.50, 0.40}, .texture = ADCGS_TEXTURE_NOISE, \
     .frequency = 4.0, .colour = {{0.70, 0.30, 0.35}, {0.90, 0.75, 0.55}}, .seed = 83, \
     .velocity = {0.70, 0.0, 0.0}, .kind = (share)}
#define FLAME(x, y, z, radius, speed, pulse, number)                                                            \
    {.shape = ADCGS_SHAPE_BALL, .size = {radius}, .position = {x, y, z}, .texture = ADCGS_TEXTURE_NOISE, .frequency = 5.0, \
     .colour = {{0.75, 0.15, 0.05}, {1.0, 0.85, 0.35}}, .seed = (number), .stretch = {-0.15, -0.15, 0.35}, .beats = (pulse), \
     .slide = {0.2, 0.0, speed}, .glows = 1}

static const adcgs_trace_object race[] = {STILL, ZIGZAG(0.80, 0.0, 1.0)};
static const adcgs_trace_object bounce[] = {STILL, ZIGZAG(0.20, 0.5, 1.0)};
static const adcgs_trace_object collide[] = {
    STILL,
    {PARCEL, .size = {0.20, 0.22, 0.24}, .position = {-0.85, -0.10, 0.24}, .seed = 84, .zigzag = {0.64, 0.0, 0.0}, .zigs = 1.0},
    {PARCEL, .size = {0.20, 0.22, 0.24}, .position = {0.85, -0.10, 0.24}, .seed = 85, .zigzag = {-0.64, 0.0, 0.0}, .zigs = 1.0}};
static const adcgs_trace_object merge[] = {
    STILL,
    {PARCEL, .size = {0.19, 0.24, 0.28}, .position = {-0.74, -0.10, 0.28}, .seed = 86, .zigzag = {0.55, 0.0, 0.0}, .zigs = 1.0},
    {PARCEL, .size = {0.19, 0.24, 0.28}, .position = {0.74, -0.10, 0.28}, .seed = 87, .zigzag = {-0.55, 0.0, 0.0}, .zigs = 1.0}};
static const adcgs_trace_object wall[] = {
    STILL,
    {.shape = ADCGS_SHAPE_BOX, .size = {0.42, 0.05, 0.42}, .position = {0.0, -0.55, 0.42}, .texture = ADCGS_TEXTURE_RINGS,
     .frequency = 14.0, .colour = {{0.55, 0.60, 0.50}, {0.30, 0.36, 0.42}}, .seed = 88},
    CROSSING(0.50)};
static const adcgs_trace_object blink1[] = {STILL, PEDESTAL, BLINK(1)};
static const adcgs_trace_object blink2[] = {STILL, PEDESTAL, BLINK(2)};
static const adcgs_trace_object blink5[] = {STILL, PEDESTAL, BLINK(5)};
static const adcgs_trace_object rods4[] = {STILL, PEDESTAL, RODS(4.0)};
static const adcgs_trace_object rods2[] = {STILL, PEDESTAL, RODS(2.0)};
static const adcgs_trace_object rods1[] = {STILL, PEDESTAL, RODS(1.0)};
static const adcgs_trace_object slide[] = {
    STILL, {PARCEL, .size = {0.34, 0.28, 0.34}, .position = {0.0, -0.10, 0.34}, .seed = 89, .slide = {0.25, 0.0, 0.10}}};
static const adcgs_trace_object glass30[] = {STILL, PANE(0.3, clear)};
static const adcgs_trace_object glass60[] = {STILL, PANE(0.6, clear)};
static const adcgs_trace_object glass90[] = {STILL, PANE(0.9, clear)};
static const adcgs_trace_object mirror30[] = {STILL, PANE(0.3, mirror)};
static const adcgs_trace_object mirror60[] = {STILL, PANE(0.6, mirror)};
static const adcgs_trace_object mirror90[] = {STILL, PANE(0.9, mirror)};
static const adcgs_trace_object fire[] = {
    STILL, PEDESTAL, FLAME(0.0, 0.15, 0.66, 0.28, 2.0, 5.0, 91), FLAME(-0.16, 0.05, 0.52, 0.20, 2.6, 7.0, 92),
    FLAME(0.17, 0.10, 0.54, 0.21, 2.3, 6.0, 93)};

/* The last `movers` of an array move. There are 11 test views, so that none has exactly the time at which an object appears. */
#define LAST_MOVE(things, movers)                                                                               \
    .objects = things, .n_objects = (int)ADCGS_COUNTOF(things),                                                 \
    .moving = ((1u << (movers)) - 1u) << (ADCGS_COUNTOF(things) - (movers)), .size = 160, .distance = DISTANCE, \
    .target = {0.0, 0.0, 0.35}
#define MOVING(things, movers) LAST_MOVE(things, movers), .cameras = 12, .times = 24, .turns = 3, .n_val = 5, .n_test = 11

/* The same from one hand-held camera: 90 times, each seen once. */
#define FILMED(things, movers)                                                                                    \
    LAST_MOVE(things, movers), .path = ADCGS_PATH_HAND, .cameras = 1, .times = 90, .turns = 1, .swings = 1.5, .n_val = 9, \
    .n_test = 22

#define STAGE                                                                                                         \
    .objects = stage, .n_objects = (int)ADCGS_COUNTOF(stage), .size = 256, .cameras = 12, .times = 40, .turns = 3, .n_val = 5, \
    .n_test = 10, .distance = 4.2, .target = {0.0, 0.0, 0.35}

static const adcgs_scenes_entry entries[] = {
    {.name = "demo", .about = "objects on a table: some static, five that hop, turn, pass behind, fade and fly",
     .moving = HOP | SPIN | PASS | FADE | ORBIT, STAGE},
    {.name = "still", .about = "the demo's table, nothing moves", .moving = 0, STAGE},
    {.name = "hop", .about = "the demo's table, only the hopping ball moves", .moving = HOP, STAGE},
    {.name = "spin", .about = "the demo's table, only the box turns", .moving = SPIN, STAGE},
    {.name = "pass", .about = "the demo's table, only the ball at the back moves, hidden at times", .moving = PASS, STAGE},
    {.name = "fade", .about = "the demo's table, only a colour changes", .moving = FADE, STAGE},
    {.name = "orbit", .about = "the demo's table, only the small ball flies", .moving = ORBIT, STAGE},
    {.name = "tiny", .about = "a miniature for tests: a box and a ball that slides", .objects = mini,
     .n_objects = (int)ADCGS_COUNTOF(mini), .moving = 1 << 3, .size = 64, .cameras = 6, .times = 8, .turns = 2, .n_val = 1,
     .n_test = 3, .distance = 4.2, .target = {0.0, 0.0, 0.3}},
    {.name = "cross5", .about = "a box crosses 5 % of the image's width", MOVING(cross5, 1)},
    {.name = "cross20", .about = "a box crosses 20 % of the image's width", MOVING(cross20, 1)},
    {.name = "cross80", .about = "a box crosses 80 % of the image's width", MOVING(cross80, 1)},
    {.name = "turn1", .about = "a box turns once", MOVING(turn1, 1)},
    {.name = "turn3", .about = "a box turns three times", MOVING(turn3, 1)},
    {.name = "appear", .about = "a box appears halfway through the clip", MOVING(appear, 1)},
    {.name = "split", .about = "a box comes apart, and its halves slide away from each other", MOVING(split, 2)},
    {.name = "object", .about = "rising complexity: one static parcel under a plain sky", MOVING(object, 0)},
    {.name = "pair", .about = "two such parcels", MOVING(pair, 0)},
    {.name = "table", .about = "the table's static objects alone", MOVING(table, 0)},
    {.name = "several", .about = "on this table two parcels and a ball that move independently", MOVING(several, 3)},
    {.name = "hinge", .about = "on this table two arms on one hinge", MOVING(hinge, 2)},
    {.name = "soft", .about = "on this table a ball that is stretched and pressed", MOVING(soft, 1)},
    {.name = "drops", .about = "on this table a fountain of twelve drops", MOVING(drops, 12)},
    {.name = "film-cross20", .about = "cross20 filmed by one hand-held camera", FILMED(cross20, 1)},
    {.name = "film-cross80", .about = "cross80 from a hand-held camera", FILMED(cross80, 1)},
    {.name = "film-turn1", .about = "turn1 from a hand-held camera", FILMED(turn1, 1)},
    {.name = "film-demo", .about = "demo from a hand-held camera", .objects = stage, .n_objects = (int)ADCGS_COUNTOF(stage),
     .moving = HOP | SPIN | PASS | FADE | ORBIT, .size = 256, .path = ADCGS_PATH_HAND, .cameras = 1, .times = 120, .turns = 1,
     .swings = 2.0, .n_val = 9, .n_test = 22, .distance = DISTANCE, .target = {0.0, 0.0, 0.35}},
    {.name = "race", .about = "a box moves back and forth over 80 % of the image's width", MOVING(race, 1)},
    {.name = "bounce", .about = "a box moves up a ramp and back, with sharp turns", MOVING(bounce, 1)},
    {.name = "collide", .about = "two boxes meet and return", MOVING(collide, 2)},
    {.name = "merge", .about = "two halves become one box, and part again", MOVING(merge, 2)},
    {.name = "wall", .about = "a box passes behind a wall", MOVING(wall, 1)},
    {.name = "blink1", .about = "a box is visible in one frame", MOVING(blink1, 1)},
    {.name = "blink2", .about = "in two frames", MOVING(blink2, 1)},
    {.name = "blink5", .about = "in five frames", MOVING(blink5, 1)},
    {.name = "rods4", .about = "five upright rods circle; each is four pixels thick", MOVING(rods4, 5)},
    {.name = "rods2", .about = "two pixels", MOVING(rods2, 5)},
    {.name = "rods1", .about = "one pixel", MOVING(rods1, 5)},
    {.name = "slide", .about = "a static box whose pattern moves over it", MOVING(slide, 1)},
    {.name = "glass30", .about = "a moving ball whose sides let 30 % of the light through", MOVING(glass30, 1)},
    {.name = "glass60", .about = "60 %", MOVING(glass60, 1)},
    {.name = "glass90", .about = "90 %", MOVING(glass90, 1)},
    {.name = "mirror30", .about = "a moving ball that reflects 30 % of the light", MOVING(mirror30, 1)},
    {.name = "mirror60", .about = "60 %", MOVING(mirror60, 1)},
    {.name = "mirror90", .about = "90 %", MOVING(mirror90, 1)},
    {.name = "fire", .about = "a fire that flickers", MOVING(fire, 3)},
    {.name = "tripod", .about = "several filmed by one static camera", LAST_MOVE(several, 3), .path = ADCGS_PATH_TRIPOD,
     .cameras = 1, .times = 60, .turns = 1, .n_val = 5, .n_test = 15},
    {.name = "clip", .about = "ten seconds: objects move, one appears, one disappears, a lamp is switched on",
     .objects = clip, .n_objects = (int)ADCGS_COUNTOF(clip), .moving = 0xf << (ADCGS_COUNTOF(clip) - 4), .size = 128,
     .cameras = 12, .times = 300, .turns = 3, .n_val = 5, .n_test = 29, .distance = DISTANCE, .target = {0.0, 0.0, 0.35}},
};

const adcgs_scenes_entry *adcgs_scenes_entry_at(int i)
{
    const int n = (int)ADCGS_COUNTOF(entries);
    if (i < 0)
        return NULL;
    if (i < n)
        return &entries[i];
    for (int k = 0; adcgs_scenes_captures[k].name; k++)
        if (k == i - n)
            return &adcgs_scenes_captures[k];
    return NULL;
}

const adcgs_scenes_entry *adcgs_scenes_entry_find(const char *name)
{
    const adcgs_scenes_entry *entry;
    for (int i = 0; (entry = adcgs_scenes_entry_at(i)); i++)
        if (!strcmp(entry->name, name))
            return entry;
    return NULL;
}
