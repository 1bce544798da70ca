/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The syntax structures of the stream (spec clause "Stream"). Each list gives
 * the elements in stream order as F(type, name, min, max) or V(type, name,
 * count, min, max); it defines the C structure here and the table that parses,
 * checks, traces and writes it in syntax.c.
 */
#ifndef ADCGS_STREAM_SYNTAX_H
#define ADCGS_STREAM_SYNTAX_H

#include "stream/fields.h"

#define ADCGS_TICKS_MAX 0x1p52
#define ADCGS_WORLD_MAX 0x1p40

/* Elements of a chunk header after its type. */
#define ADCGS_LIST_CHUNK_HEADER(F, V) \
    F(U32, length, 0, 0x1p30)         \
    F(U16, segment, 0, 65535)         \
    F(U8, flags, 0, 255)              \
    F(U8, version, 0, 255)            \
    F(U32, header_crc, 0, 4294967295.0)

/* HEAD: the elements that show whether a decoder supports the stream, then all others. */
#define ADCGS_LIST_VERSION(F, V)    \
    F(U16, version_major, 0, 65535) \
    F(U16, version_minor, 0, 65535) \
    F(U8, profile, 0, 255)          \
    F(U8, level, 0, 255)            \
    F(U8, arith, 0, 255)            \
    F(U32, features, 0, 4294967295.0)
#define ADCGS_LIST_HEAD(F, V)                                     \
    F(U32, timebase_num, 1, 4294967295.0)                         \
    F(U32, timebase_den, 1, 4294967295.0)                         \
    F(U32, rate_num, 1, 4294967295.0)                             \
    F(U32, rate_den, 1, 4294967295.0)                             \
    F(I64, start_ticks, -ADCGS_TICKS_MAX, ADCGS_TICKS_MAX)        \
    F(I64, duration_ticks, -1, ADCGS_TICKS_MAX)                   \
    F(U32, segments, 0, 65535)                                    \
    F(U32, max_anchors, 1, ADCGS_ANCHORS_MAX)                     \
    V(F64, scene_origin, 3, -ADCGS_WORLD_MAX, ADCGS_WORLD_MAX)    \
    F(F64, scene_scale, 1 / ADCGS_WORLD_MAX, ADCGS_WORLD_MAX)     \
    V(F32, background, 3, -256, 256)                              \
    F(F32, screen_filter, 0, 16)                                  \
    F(U8, colour_space, 0, 2)                                     \
    F(U8, axes, 0, 3)                                             \
    F(U8, units, 0, 1)                                            \
    F(U8, slice_log2, ADCGS_SLICE_LOG2_MIN, ADCGS_SLICE_LOG2_MAX) \
    F(U8, k, 1, ADCGS_K_MAX)                                      \
    F(U8, n_fv, 1, ADCGS_NV_MAX)                                  \
    F(U8, n_fg, 0, ADCGS_NG_MAX)                                  \
    F(U8, chunks, 1, ADCGS_CHUNKS_MAX)                            \
    F(U8, n_eta, 0, ADCGS_ETA_MAX)                                \
    F(U8, octaves, 0, ADCGS_OCTAVES_MAX)                          \
    F(U8, fine_uses_fv, 0, 1)                                     \
    F(U8, coarse_rotation, 0, 1)                                  \
    F(U8, adaptive_steps, 0, 1)                                   \
    F(U8, spans, 0, 1)                                            \
    F(U8, bodies, 0, ADCGS_BODIES_MAX)                            \
    F(U8, smooth_time, 0, 1)                                      \
    F(U16, time_rows, 0, ADCGS_TIME_ROWS_MAX)                     \
    F(U16, time_width, 0, ADCGS_TIME_WIDTH_MAX)

/* A network: role; e24 for E24 roles; prior for priors; then layers. The form of a layer is 64 mode + e, plus 128 if residual. */
#define ADCGS_LIST_NET(F, V)        \
    F(U8, role, 0, ADCGS_ROLES - 1) \
    F(U8, n_layers, 1, ADCGS_NET_LAYERS_MAX)
#define ADCGS_LIST_NET_E24(F, V) F(U8, in_shift, 0, 8)
#define ADCGS_LIST_NET_PRIOR(F, V) \
    F(U8, sigma_shift, 0, 24)      \
    F(I16, sigma_offset, -64, 127)
#define ADCGS_LIST_LAYER(F, V) F(U8, weight_form, 0, 255)
#define ADCGS_LIST_LAYER_BIAS(F, V) F(U8, bias_form, 0, 127)
#define ADCGS_LIST_LAYER_E24(F, V) F(U8, shift, 0, 24)

#define ADCGS_LIST_SEGM(F, V)                              \
    F(I64, start_ticks, -ADCGS_TICKS_MAX, ADCGS_TICKS_MAX) \
    F(I64, end_ticks, -ADCGS_TICKS_MAX, ADCGS_TICKS_MAX)   \
    F(U32, reach_ticks, 0, 4294967295.0)                   \
    F(U8, predicted, 0, 1)                                 \
    F(U16, roles, 0, (1 << ADCGS_ROLES) - 1)
#define ADCGS_LIST_TIERS(F, V) F(U8, tiers, 1, ADCGS_TIERS_MAX)
#define ADCGS_LIST_GROWTH(F, V) F(U8, growth, 0, ADCGS_GROWTH_MAX)
#define ADCGS_LIST_STEP_FORM(F, V) F(U8, step_form, 0, 3)
#define ADCGS_LIST_STEP(F, V) F(F32, step, 0x1p-40, 0x1p10)
#define ADCGS_LIST_STEP_SHORT(F, V) F(U16, step_high, 0, 65535)
#define ADCGS_LIST_ETA(F, V)      \
    F(I16, eta_mu, -32767, 32767) \
    F(U8, eta_si, 0, ADCGS_SIGMA_LEVELS - 1)

#define ADCGS_LIST_GEOM(F, V) F(U32, anchors, 0, ADCGS_ANCHORS_MAX)
#define ADCGS_LIST_GRID(F, V)             \
    F(U8, depth, 0, ADCGS_GEOM_DEPTH_MAX) \
    V(F32, origin, 3, -0x1p15, 0x1p15)    \
    F(F32, voxel, 0x1p-40, 0x1p10)

#define ADCGS_LIST_SLICE_CRC(F, V) F(U32, slice_crc, 0, 4294967295.0)

#define ADCGS_LIST_CAMERA(F, V) F(U8, camera_flags, 0, 15)
#define ADCGS_LIST_LENS(F, V)                        \
    F(U16, width, 1, 16384)                          \
    F(U16, height, 1, 16384)                         \
    F(F64, fx, 1 / ADCGS_WORLD_MAX, ADCGS_WORLD_MAX) \
    F(F64, fy, 1 / ADCGS_WORLD_MAX, ADCGS_WORLD_MAX) \
    F(F64, cx, -ADCGS_WORLD_MAX, ADCGS_WORLD_MAX)    \
    F(F64, cy, -ADCGS_WORLD_MAX, ADCGS_WORLD_MAX)    \
    F(F64, near_plane, 1 / ADCGS_WORLD_MAX, ADCGS_WORLD_MAX)
#define ADCGS_LIST_POSE(F, V) V(F64, cam_to_world, 12, -ADCGS_WORLD_MAX, ADCGS_WORLD_MAX)
#define ADCGS_LIST_POSE_SHORT(F, V) V(F32, cam_to_world_short, 12, -ADCGS_WORLD_MAX, ADCGS_WORLD_MAX)

#define ADCGS_LIST_CAMERA_TIME(F, V) F(F64, camera_time, -ADCGS_WORLD_MAX, ADCGS_WORLD_MAX)

#define ADCGS_LIST_INDEX(F, V)                             \
    F(I64, start_ticks, -ADCGS_TICKS_MAX, ADCGS_TICKS_MAX) \
    F(I64, end_ticks, -ADCGS_TICKS_MAX, ADCGS_TICKS_MAX)   \
    F(U32, reach_ticks, 0, 4294967295.0)                   \
    F(U64, offset, 0, 0x1p53)                              \
    F(U64, bytes, 0, 0x1p53)                               \
    F(U8, key, 0, 1)

#define ADCGS_LIST_ENDC(F, V)     \
    F(U64, file_bytes, 0, 0x1p53) \
    F(U32, crc_of_crcs, 0, 4294967295.0)

/** X(list, structure): every structure of the stream. */
#define ADCGS_STRUCTURES(X)                 \
    X(CHUNK_HEADER, adcgs_syn_chunk_header) \
    X(VERSION, adcgs_syn_version)           \
    X(HEAD, adcgs_syn_head)                 \
    X(NET, adcgs_syn_net)                   \
    X(NET_E24, adcgs_syn_net_e24)           \
    X(NET_PRIOR, adcgs_syn_net_prior)       \
    X(LAYER, adcgs_syn_layer)               \
    X(LAYER_BIAS, adcgs_syn_layer_bias)     \
    X(LAYER_E24, adcgs_syn_layer_e24)       \
    X(SEGM, adcgs_syn_segm)                 \
    X(TIERS, adcgs_syn_tiers)               \
    X(GROWTH, adcgs_syn_growth)             \
    X(STEP_FORM, adcgs_syn_step_form)       \
    X(STEP, adcgs_syn_step)                 \
    X(STEP_SHORT, adcgs_syn_step_short)     \
    X(ETA, adcgs_syn_eta)                   \
    X(GEOM, adcgs_syn_geom)                 \
    X(GRID, adcgs_syn_grid)                 \
    X(SLICE_CRC, adcgs_syn_slice_crc)       \
    X(CAMERA, adcgs_syn_camera)             \
    X(LENS, adcgs_syn_lens)                 \
    X(POSE, adcgs_syn_pose)                 \
    X(POSE_SHORT, adcgs_syn_pose_short)     \
    X(CAMERA_TIME, adcgs_syn_camera_time)   \
    X(INDEX, adcgs_syn_index)               \
    X(ENDC, adcgs_syn_endc)

#define ADCGS_CTYPE_U8 uint8_t
#define ADCGS_CTYPE_U16 uint16_t
#define ADCGS_CTYPE_U32 uint32_t
#define ADCGS_CTYPE_U64 uint64_t
#define ADCGS_CTYPE_I16 int16_t
#define ADCGS_CTYPE_I64 int64_t
#define ADCGS_CTYPE_F32 float
#define ADCGS_CTYPE_F64 double
#define ADCGS_MEMBER(type, name, min, max) ADCGS_CTYPE_##type name;
#define ADCGS_MEMBERS(type, name, count, min, max) ADCGS_CTYPE_##type name[count];

/* The structure, its table, and functions adcgs_syn_xxx_parse() and adcgs_syn_xxx_write() over it. */
#define ADCGS_DECLARE(list, structure)                            \
    typedef struct structure {                                    \
        ADCGS_LIST_##list(ADCGS_MEMBER, ADCGS_MEMBERS)            \
    } structure;                                                  \
    adcgs_status structure##_parse(adcgs_parse *p, structure *s); \
    adcgs_status structure##_write(adcgs_buffer *out, const char *chunk, const structure *s, adcgs_error *error);
ADCGS_STRUCTURES(ADCGS_DECLARE)

#endif
