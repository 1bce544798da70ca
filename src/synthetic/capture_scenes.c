/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Scenes that imitate common captures: a person in a dome, a walk, a street, a portrait, hair, a sweep. */
#include "synthetic/table.h"

#define PAINT(kind, often, grain, r0, g0, b0, r1, g1, b1, number)                                                     \
    .texture = ADCGS_TEXTURE_##kind, .frequency = (often), .detail = (grain), .colour = {{r0, g0, b0}, {r1, g1, b1}}, \
    .seed = (number)
#define CAPSULE(radius, half, x, y, z) .shape = ADCGS_SHAPE_CAPSULE, .size = {radius, 0.0, half}, .position = {x, y, z}
#define BALL(radius, x, y, z) .shape = ADCGS_SHAPE_BALL, .size = {radius}, .position = {x, y, z}
#define BOX(a, b, c, x, y, z) .shape = ADCGS_SHAPE_BOX, .size = {a, b, c}, .position = {x, y, z}
#define CYLINDER(radius, half, x, y, z) .shape = ADCGS_SHAPE_CYLINDER, .size = {radius, 0.0, half}, .position = {x, y, z}

/* A person 1.9 units tall who faces -y, one arm up, a book in the other hand. */
#define SKIN(number) PAINT(NOISE, 14.0, 0.3, 0.78, 0.56, 0.44, 0.92, 0.72, 0.60, number)
#define SHIRT(number) PAINT(PATCHES, 11.0, 0.4, 0.70, 0.22, 0.20, 0.88, 0.78, 0.55, number)
#define TROUSERS(number) PAINT(STRIPES, 30.0, 0.4, 0.18, 0.24, 0.42, 0.34, 0.42, 0.58, number)
#define SHOE PAINT(PLAIN, 1.0, 0.4, 0.30, 0.20, 0.14, 0.30, 0.20, 0.14, 107)
static const adcgs_trace_object person[] = {
    {CAPSULE(0.19, 0.20, 0.0, 0.0, 1.20), SHIRT(101)},
    {CAPSULE(0.15, 0.06, 0.0, 0.0, 0.92), TROUSERS(102)},
    {CAPSULE(0.065, 0.06, 0.0, 0.0, 1.52), SKIN(103)},
    {CAPSULE(0.125, 0.04, 0.0, -0.01, 1.68), SKIN(104)},
    {BALL(0.135, 0.0, 0.035, 1.735), PAINT(NOISE, 22.0, 0.5, 0.16, 0.10, 0.06, 0.42, 0.28, 0.16, 105)},
    {CAPSULE(0.085, 0.36, 0.10, 0.0, 0.47), .tilt = 0.01, .turn = 0.25, TROUSERS(106)},
    {CAPSULE(0.085, 0.36, -0.12, -0.04, 0.47), .tilt = 0.02, .turn = 0.40, TROUSERS(106)},
    {BOX(0.065, 0.14, 0.05, 0.12, -0.05, 0.05), SHOE},
    {BOX(0.065, 0.14, 0.05, -0.14, -0.12, 0.05), SHOE},
    {CAPSULE(0.062, 0.17, 0.31, 0.0, 1.27), .tilt = 0.10, .turn = -0.25, SHIRT(108)},
    {CAPSULE(0.050, 0.145, 0.39, -0.14, 1.085), .tilt = -0.21, .turn = -0.03, SKIN(109)},
    {BOX(0.14, 0.10, 0.025, 0.36, -0.34, 1.08), PAINT(RINGS, 160.0, 0.2, 0.15, 0.45, 0.35, 0.90, 0.85, 0.40, 110)},
    {CAPSULE(0.062, 0.13, -0.26, -0.03, 1.51), .tilt = 0.088, .turn = -0.19, SHIRT(111)},
    {CAPSULE(0.050, 0.13, -0.39, -0.08, 1.74), .tilt = 0.088, .turn = -0.19, SKIN(112)},
};

/* A furnished room of 6 x 7 x 2.6 units. The visitor walks around ahead of a camera that turns in the middle of the room. */
#define ROOM                                                                                                            \
    {.shape = ADCGS_SHAPE_ROOM, .size = {3.0, 3.5, 1.3}, .position = {0.0, 0.0, 1.3},                                   \
     PAINT(PATCHES, 1.7, 0.5, 0.80, 0.76, 0.66, 0.62, 0.66, 0.70, 121)},                                                \
    {.shape = ADCGS_SHAPE_FLOOR, .size = {4.7}, .position = {0.0, 0.0, 0.002},                                          \
     PAINT(CHECKER, 1.4, 0.5, 0.58, 0.44, 0.32, 0.42, 0.32, 0.24, 122)},                                                \
    {BOX(0.9, 0.25, 0.95, -1.2, 3.2, 0.95), PAINT(PATCHES, 4.5, 0.3, 0.55, 0.25, 0.20, 0.85, 0.75, 0.50, 123)},         \
    {BOX(0.7, 0.45, 0.38, 1.5, 2.6, 0.38), PAINT(STRIPES, 12.0, 0.4, 0.50, 0.36, 0.22, 0.66, 0.50, 0.34, 124)},         \
    {BALL(0.24, 1.4, 2.5, 1.0), PAINT(DOTS, 6.0, 0.0, 0.92, 0.88, 0.80, 0.20, 0.35, 0.70, 125)},                        \
    {BOX(0.35, 0.9, 0.42, 2.5, 0.2, 0.42), PAINT(NOISE, 5.0, 0.4, 0.20, 0.40, 0.35, 0.55, 0.70, 0.50, 126)},            \
    {BOX(0.03, 0.6, 0.4, 2.97, 0.3, 1.65), PAINT(RINGS, 14.0, 0.2, 0.85, 0.35, 0.20, 0.20, 0.30, 0.55, 127)},           \
    {CYLINDER(0.28, 0.35, 2.3, -2.6, 0.35), PAINT(CHECKER, 6.0, 0.2, 0.75, 0.50, 0.35, 0.90, 0.85, 0.75, 128)},         \
    {BALL(0.45, 2.3, -2.6, 1.1), PAINT(NOISE, 9.0, 0.5, 0.10, 0.30, 0.10, 0.45, 0.70, 0.25, 129)},                      \
    {BOX(1.0, 0.35, 0.40, 0.2, -3.0, 0.40), PAINT(PATCHES, 7.0, 0.4, 0.25, 0.25, 0.45, 0.60, 0.55, 0.75, 130)},         \
    {BOX(0.7, 0.03, 0.5, 0.1, -3.47, 1.6), PAINT(NOISE, 4.0, 0.3, 0.90, 0.85, 0.40, 0.15, 0.35, 0.65, 131)},            \
    {BOX(0.25, 0.5, 1.0, -2.7, -1.3, 1.0), PAINT(STRIPES, 9.0, 0.3, 0.70, 0.70, 0.66, 0.35, 0.30, 0.28, 132)},          \
    {CYLINDER(0.04, 0.85, -2.4, 0.9, 0.85), PAINT(PLAIN, 1.0, 0.0, 0.20, 0.20, 0.22, 0.20, 0.20, 0.22, 133)},           \
    {BALL(0.22, -2.4, 0.9, 1.75), PAINT(STRIPES, 20.0, 0.0, 0.95, 0.90, 0.70, 0.80, 0.65, 0.40, 134)},                  \
    {BOX(0.03, 0.5, 0.6, -2.97, 1.9, 1.5), PAINT(CHECKER, 5.0, 0.2, 0.85, 0.85, 0.85, 0.25, 0.45, 0.55, 135)}
static const adcgs_trace_object room[] = {ROOM};
static const adcgs_trace_object visited[] = {
    ROOM, {CAPSULE(0.22, 0.55, 0.0, 2.0, 0.80), PAINT(PATCHES, 8.0, 0.5, 0.95, 0.60, 0.20, 0.30, 0.10, 0.35, 136),
           .orbit_turns = -1.0}};

/* A street along y with a sky 400 units away; a van comes the other way. */
#define HOUSE(x, y, half, tall, r, g, b, number)                                                                        \
    {BOX(2.0, half, tall, x, y, tall), PAINT(PATCHES, 0.75, 0.5, r, g, b, 0.22, 0.26, 0.32, number)}
static const adcgs_trace_object street[] = {
    {.shape = ADCGS_SHAPE_DOME, .size = {400.0}, PAINT(NOISE, 0.012, 0.0, 0.30, 0.50, 0.82, 0.95, 0.95, 0.96, 141)},
    {.shape = ADCGS_SHAPE_FLOOR, .size = {395.0}, PAINT(NOISE, 1.3, 0.4, 0.34, 0.34, 0.36, 0.54, 0.53, 0.50, 142)},
    HOUSE(-7.5, 8.0, 5.0, 3.0, 0.82, 0.62, 0.48, 143),
    HOUSE(-7.8, 19.0, 5.5, 4.2, 0.78, 0.76, 0.66, 144),
    HOUSE(-7.3, 34.0, 9.0, 3.4, 0.66, 0.48, 0.44, 145),
    HOUSE(7.4, 6.0, 4.5, 3.8, 0.72, 0.70, 0.74, 146),
    HOUSE(7.8, 16.5, 5.5, 2.8, 0.84, 0.74, 0.50, 147),
    HOUSE(7.5, 32.0, 9.5, 4.4, 0.60, 0.66, 0.62, 148),
    {BOX(6.0, 2.0, 5.0, 3.0, 62.0, 5.0), PAINT(PATCHES, 0.6, 0.3, 0.70, 0.64, 0.60, 0.30, 0.34, 0.40, 149)},
    {BOX(0.85, 2.0, 0.70, -4.0, 12.0, 0.75), PAINT(NOISE, 2.0, 0.3, 0.60, 0.12, 0.12, 0.80, 0.25, 0.20, 150)},
    {BOX(0.85, 2.0, 0.70, 4.1, 17.5, 0.75), PAINT(STRIPES, 6.0, 0.2, 0.12, 0.25, 0.55, 0.30, 0.45, 0.70, 151)},
    {CYLINDER(0.12, 1.4, 4.6, 12.0, 1.4), PAINT(NOISE, 4.0, 0.3, 0.30, 0.22, 0.16, 0.42, 0.32, 0.24, 152)},
    {BALL(1.3, 4.6, 12.0, 3.6), PAINT(NOISE, 3.0, 0.5, 0.12, 0.32, 0.10, 0.45, 0.65, 0.25, 153)},
    {CYLINDER(0.07, 2.2, -4.8, 16.5, 2.2), PAINT(PLAIN, 1.0, 0.0, 0.25, 0.25, 0.27, 0.25, 0.25, 0.27, 154)},
    {BOX(1.0, 2.2, 1.1, -1.9, 30.0, 1.2), PAINT(PATCHES, 1.8, 0.5, 0.90, 0.88, 0.82, 0.85, 0.45, 0.10, 155),
     .velocity = {0.0, -14.0, 0.0}},
};

/* A head on shoulders before an empty background; it turns by 0.08 about the vertical. */
#define TURNS_HEAD .orbit_turns = 0.08, .spin_axis = {0.0, 0.0, 1.0}, .spin = 0.08
#define FACE(number) PAINT(NOISE, 4.5, 0.4, 0.74, 0.52, 0.42, 0.92, 0.74, 0.62, number)
#define EYE(side)                                                                                                       \
    {BALL(0.085, 0.19 * (side), -0.41, 0.42), PAINT(RINGS, 900.0, 0.0, 0.95, 0.95, 0.93, 0.10, 0.14, 0.20, 166), TURNS_HEAD}
#define EAR(side) {BALL(0.11, 0.49 * (side), 0.02, 0.30), FACE(167), TURNS_HEAD}
static const adcgs_trace_object head[] = {
    {CAPSULE(0.42, 0.55, 0.0, 0.10, -1.05), .tilt = 0.25, .turn = 0.25,
     PAINT(PATCHES, 4.0, 0.5, 0.20, 0.30, 0.45, 0.50, 0.62, 0.70, 161)},
    {CYLINDER(0.24, 0.35, 0.0, 0.06, -0.45), FACE(162)},
    {CAPSULE(0.46, 0.14, 0.0, 0.0, 0.28), FACE(163), TURNS_HEAD},
    {BALL(0.55, 0.0, 0.12, 0.56), PAINT(NOISE, 8.0, 0.7, 0.16, 0.09, 0.05, 0.46, 0.30, 0.16, 164), TURNS_HEAD},
    {CAPSULE(0.055, 0.10, 0.0, -0.48, 0.26), .tilt = -0.03, FACE(165), TURNS_HEAD},
    EYE(-1.0), EYE(1.0), EAR(-1.0), EAR(1.0),
    {BOX(0.15, 0.03, 0.035, 0.0, -0.445, 0.02), PAINT(NOISE, 9.0, 0.2, 0.62, 0.20, 0.20, 0.74, 0.34, 0.30, 168), TURNS_HEAD},
};

/* Hair before a wall; a pixel of an image that is 128 wide is 0.026 units wide at the hair. */
#define HAIR(radius, bow, half, x, y, z, lean, round, tone)                                                            \
    {.shape = ADCGS_SHAPE_HAIR, .size = {radius, bow, half}, .position = {x, y, z}, .tilt = (lean), .turn = (round),   \
     .colour = {{tone, 0.7 * (tone), 0.5 * (tone)}, {tone, 0.7 * (tone), 0.5 * (tone)}}}
static const adcgs_trace_object hair[] = {
    {BOX(4.0, 0.05, 3.0, 0.0, 0.9, 0.35), PAINT(PATCHES, 3.0, 0.6, 0.72, 0.66, 0.54, 0.50, 0.58, 0.62, 171)},
    {BALL(0.24, -0.9, 0.30, -0.45), PAINT(CHECKER, 6.0, 0.3, 0.85, 0.30, 0.25, 0.95, 0.85, 0.60, 172)},
    HAIR(0.013, 0.25, 0.85, -1.15, -0.10, 0.40, 0.00, 0.00, 0.10),  HAIR(0.010, -0.30, 0.95, -0.95, 0.05, 0.45, 0.01, 0.10, 0.16),
    HAIR(0.007, 0.20, 0.90, -0.75, -0.20, 0.35, -0.02, 0.45, 0.08), HAIR(0.010, 0.35, 0.75, -0.60, 0.15, 0.50, 0.02, 0.30, 0.95),
    HAIR(0.013, -0.22, 0.95, -0.40, -0.05, 0.30, 0.00, 0.60, 0.12), HAIR(0.007, 0.28, 1.00, -0.25, 0.10, 0.40, -0.01, 0.80, 0.90),
    HAIR(0.010, 0.18, 0.85, -0.10, -0.25, 0.45, 0.03, 0.20, 0.06),  HAIR(0.010, -0.33, 0.90, 0.05, 0.00, 0.35, -0.03, 0.55, 0.14),
    HAIR(0.007, 0.24, 0.95, 0.20, -0.15, 0.40, 0.01, 0.95, 0.10),   HAIR(0.013, 0.30, 0.80, 0.35, 0.20, 0.50, 0.04, 0.70, 0.92),
    HAIR(0.010, -0.26, 1.00, 0.50, -0.10, 0.30, 0.00, 0.35, 0.12),  HAIR(0.007, 0.34, 0.85, 0.65, 0.05, 0.45, -0.02, 0.15, 0.07),
    HAIR(0.010, 0.20, 0.95, 0.80, -0.20, 0.35, 0.02, 0.85, 0.96),   HAIR(0.013, -0.28, 0.90, 0.95, 0.12, 0.40, -0.01, 0.50, 0.11),
    HAIR(0.007, 0.26, 1.00, 1.10, -0.05, 0.50, 0.01, 0.25, 0.15),   HAIR(0.010, 0.22, 1.10, 0.10, -0.30, 0.40, 0.25, 0.28, 0.09),
    HAIR(0.007, -0.30, 1.05, -0.20, 0.25, 0.55, 0.24, 0.22, 0.90),
};

/* Everything lies in front of cameras at y = -6, up to a wall nine units from them. */
static const adcgs_trace_object shelf[] = {
    {BOX(9.0, 0.05, 4.0, 0.0, 3.0, 2.0), PAINT(PATCHES, 1.6, 0.5, 0.70, 0.62, 0.56, 0.48, 0.54, 0.60, 181)},
    {.shape = ADCGS_SHAPE_FLOOR, .size = {14.0}, .position = {0.0, 0.0, -0.6},
     PAINT(CHECKER, 0.9, 0.5, 0.62, 0.56, 0.46, 0.44, 0.40, 0.36, 182)},
    {BOX(0.6, 0.5, 0.8, -2.6, 1.2, 0.2), PAINT(PATCHES, 4.0, 0.4, 0.15, 0.35, 0.55, 0.90, 0.85, 0.60, 183)},
    {CYLINDER(0.45, 0.7, -1.2, 0.2, 0.1), PAINT(STRIPES, 5.0, 0.2, 0.85, 0.82, 0.78, 0.22, 0.42, 0.34, 184)},
    {BALL(0.5, 0.1, 0.9, -0.1), PAINT(DOTS, 4.0, 0.2, 0.92, 0.88, 0.80, 0.75, 0.25, 0.20, 185)},
    {BOX(0.4, 0.4, 1.1, 1.3, 1.6, 0.5), PAINT(RINGS, 9.0, 0.3, 0.88, 0.50, 0.42, 0.35, 0.18, 0.35, 186)},
    {BOX(0.5, 0.4, 0.4, 2.6, 0.4, -0.2), PAINT(CHECKER, 3.0, 0.3, 0.95, 0.72, 0.15, 0.20, 0.22, 0.50, 187)},
    {BALL(0.6, -3.6, 2.0, 0.0), PAINT(NOISE, 4.0, 0.4, 0.20, 0.60, 0.62, 0.92, 0.92, 0.86, 188)},
    {BOX(0.4, 0.4, 1.2, 3.7, 1.8, 0.6), PAINT(PATCHES, 5.0, 0.4, 0.60, 0.30, 0.30, 0.95, 0.80, 0.35, 189)},
};

#define OF(things) .objects = things, .n_objects = (int)ADCGS_COUNTOF(things)
/* Bits of the last `movers` objects. */
#define LAST(things, movers) ((1u << (movers)) - 1u) << (ADCGS_COUNTOF(things) - (movers))
#define PERSON                                                                                                          \
    OF(person), .size = 120, .cameras = 60, .times = 1, .turns = 1, .n_val = 5, .n_test = 12, .distance = 2.9,          \
    .target = {0.0, 0.0, 0.95}, .path = ADCGS_PATH_ROUND
#define WALK                                                                                                            \
    .size = 128, .height = 96, .turns = 1, .n_val = 5, .n_test = 12, .distance = 0.8, .target = {0.0, 0.0, 1.35},       \
    .path = ADCGS_PATH_WALK, .is_wide = 1

const adcgs_scenes_entry adcgs_scenes_captures[] = {
    {.name = "dome", .about = "a static person, 60 RGBA images from all sides, exposures of plus and minus one stop", PERSON,
     .ground = ADCGS_GROUND_ALPHA, .stops = 1.0},
    {.name = "dome-even", .about = "the same, all exposures equal", PERSON, .ground = ADCGS_GROUND_ALPHA},
    {.name = "dome-black", .about = "dome composited over black, without alpha", PERSON, .stops = 1.0},
    {.name = "dome-white", .about = "dome composited over white, without alpha", PERSON, .ground = ADCGS_GROUND_WHITE,
     .stops = 1.0},
    {.name = "walk", .about = "a static room, 80 images of a camera that turns around in it", OF(room), WALK, .cameras = 80,
     .times = 1},
    {.name = "walk-visitor", .about = "the same as a video, in which a visitor walks ahead of the camera", OF(visited),
     .moving = LAST(visited, 1), WALK, .cameras = 1, .times = 80},
    {.name = "street", .about = "a street under a far sky, three cameras on a car, a van drives towards them", OF(street),
     .moving = LAST(street, 1), .size = 144, .height = 96, .cameras = 3, .times = 24, .turns = 1, .n_val = 5, .n_test = 12,
     .distance = 20.0, .target = {0.0, 0.0, 1.5}, .path = ADCGS_PATH_DRIVE, .is_wide = 1},
    {.name = "portrait", .about = "a slightly turning head before black, six cameras in front", OF(head),
     .moving = LAST(head, 8), .size = 112, .cameras = 6, .times = 12, .turns = 1, .n_val = 5, .n_test = 11, .distance = 3.8,
     .target = {0.0, 0.0, 0.05}, .path = ADCGS_PATH_FRONT},
    {.name = "hair", .about = "static hair, half a pixel to one pixel thick, before a wall", OF(hair), .size = 128,
     .cameras = 30, .times = 1, .turns = 1, .n_val = 5, .n_test = 9, .distance = 4.2, .target = {0.0, 0.0, 0.40},
     .path = ADCGS_PATH_FRONT, .samples = 4},
    {.name = "sweep", .about = "static, a sweeping camera that looks outward: its axes meet behind it", OF(shelf),
     .size = 120, .cameras = 40, .times = 1, .turns = 1, .n_val = 5, .n_test = 11, .distance = 6.0, .target = {0.0, 0.0, 0.8},
     .path = ADCGS_PATH_SWEEP},
    {.name = NULL},
};
