/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Decoding: open a stream, ask what it holds, derive primitives, render frames.
 *
 * A decoder is not thread-safe by itself (one thread at a time per decoder);
 * it uses its own threads inside a call. Different decoders are independent.
 * All results are bit-identical on every CPU, CPU level and thread count.
 *
 * Streams may come from strangers. Opening one takes memory and time that its
 * level bounds before they are spent, whatever its size: with level 1 at most 64
 * MiB, with level 2 half a GiB, and one or two seconds of one core. A frame is
 * as large as the caller wants it, and its time and memory grow with pixels times splats;
 * memory_limit bounds both (spec annex "Security and resources").
 */
#ifndef ADCGS_DECODER_H
#define ADCGS_DECODER_H

#include <stddef.h>
#include <stdint.h>

#include <adcgs/camera.h>
#include <adcgs/status.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct adcgs_decoder adcgs_decoder;

/** Which variant of the kernels runs. Results never depend on it. */
typedef enum adcgs_cpu_level {
    ADCGS_CPU_AUTO = 0, /**< the best that this CPU and build have */
    ADCGS_CPU_SCALAR = 1,
    ADCGS_CPU_AVX2 = 2,
    ADCGS_CPU_AVX512 = 3
} adcgs_cpu_level;

/** How to decode. Initialise with adcgs_config_init() and change what is needed. */
typedef struct adcgs_config {
    size_t size;            /**< sizeof(adcgs_config), set by adcgs_config_init() */
    int threads;            /**< 1..256; 0: one per online CPU */
    adcgs_cpu_level cpu;    /**< a level above what the machine has is ADCGS_ERR_UNSUPPORTED */
    int layers;             /**< use at most this many layers, 1..5; 0: all */
    uint64_t memory_limit;  /**< bytes a decoder may allocate; 0: the stream's level decides */
    int strict_end;         /**< nonzero: a truncated stream is an error; zero: play what is complete */
} adcgs_config;

ADCGS_API void adcgs_config_init(adcgs_config *config);

/** Bytes of one component of the file, for reports. */
typedef struct adcgs_bytes {
    uint64_t header;   /**< signature, chunk headers, checksums, HEAD, SEGM, INDX, ENDC, hash */
    uint64_t networks; /**< NETW payloads */
    uint64_t geometry; /**< GEOM payloads */
    uint64_t layer[5]; /**< FEA0..FEA4 payloads */
    uint64_t cameras;  /**< cams payloads */
    uint64_t metadata; /**< meta and unknown ancillary payloads */
    uint64_t total;    /**< the whole stream as read */
} adcgs_bytes;

/** What a stream holds. */
typedef struct adcgs_info {
    int version_major, version_minor;
    int profile, level;
    int segments;            /**< complete time segments that can be played */
    uint32_t anchors;        /**< over all segments */
    uint32_t gaussians;      /**< primitives kept, over all segments */
    uint32_t static_anchors;
    uint32_t weights;        /**< network weights and time table, over all networks */
    int k;                   /**< primitives per anchor */
    int layers;              /**< layers present and used, 1..5 */
    int cameras;             /**< stored cameras */
    double time_start, time_end; /**< seconds */
    double frame_rate;       /**< frames per second suggested for playing, > 0 */
    double scene_origin[3];  /**< centre of the scene, world units */
    double scene_scale;      /**< world units per scene unit, > 0 */
    float background[3];
    int truncated;           /**< nonzero: the stream ended early; what was complete is usable */
    char colour[32];         /**< transfer characteristic and primaries, e.g. "sRGB" */
    char axes[32];           /**< world axes, e.g. "right-handed, z up" */
    char units[32];          /**< world unit, e.g. "metre", "unknown" */
    adcgs_bytes bytes;
} adcgs_info;

/** Returns bytes read (0 at end), or a negative number on failure. Must fill as much as it can. */
typedef int64_t (*adcgs_read_fn)(void *user, void *buffer, size_t bytes);

/**
 * Open a stream and decode it completely (all segments, all layers asked for).
 * On failure *out is NULL and error, if not NULL, says why in one line.
 */
ADCGS_API adcgs_status adcgs_open_file(adcgs_decoder **out, const char *path, const adcgs_config *config, adcgs_error *error);
/** As adcgs_open_file() from memory; the bytes may be freed afterwards. */
ADCGS_API adcgs_status adcgs_open_memory(adcgs_decoder **out, const void *data, size_t bytes, const adcgs_config *config,
                                         adcgs_error *error);
/** As adcgs_open_file() from a pipe or any other sequential source; never seeks. */
ADCGS_API adcgs_status adcgs_open_stream(adcgs_decoder **out, adcgs_read_fn read, void *user, const adcgs_config *config,
                                         adcgs_error *error);
/** Close and clear; *decoder may be NULL. */
ADCGS_API void adcgs_close(adcgs_decoder **decoder);

ADCGS_API adcgs_status adcgs_get_info(const adcgs_decoder *decoder, adcgs_info *info);
/** Camera index in [0, info.cameras). */
ADCGS_API adcgs_status adcgs_get_camera(const adcgs_decoder *decoder, int index, adcgs_camera *camera);
/** Text stored under a key of the `meta` chunk; NULL if there is none. Owned by the decoder. */
ADCGS_API const char *adcgs_get_metadata(const adcgs_decoder *decoder, const char *key);

/**
 * Splats at one moment, as structure of arrays in scene units. Slot order is
 * the stream's (spec clause "Primitives"); slots with opacity 0 draw nothing.
 */
typedef struct adcgs_primitives {
    uint32_t n;                  /**< slots in every array */
    const float *mean[3];        /**< centre, scene units */
    const float *scale[3];       /**< standard deviations, scene units, > 0 */
    const float *rotation[4];    /**< unit quaternion w, x, y, z */
    const float *opacity;        /**< 0..0.99 */
    const float *colour[3];      /**< RGB, not clipped */
} adcgs_primitives;

/** Primitives at time t (seconds; clamped to the stream's span). Valid until the next call on this decoder. */
ADCGS_API adcgs_status adcgs_get_primitives(adcgs_decoder *decoder, double time, adcgs_primitives *out);

/** Render at time t; frame->rgb must hold width*height*3 floats and width, height equal the camera's. */
ADCGS_API adcgs_status adcgs_render(adcgs_decoder *decoder, const adcgs_camera *camera, double time, adcgs_frame *frame,
                                    adcgs_error *error);

/** Depth of pixels that no splat touches, and the largest that adcgs_render_depth() gives. */
#define ADCGS_DEPTH_FAR 1e10f

/**
 * Depth and coverage at time t, of the splats and with the weights of adcgs_render(), in a pass of its own that takes as long as
 * a frame. alpha: [height][width], 0..1: the sum of the splats' weights, which is 1 less the part of the background that the
 * frame shows; so a frame less (1 - alpha) times the background is its colours premultiplied by alpha. depth: [height][width],
 * world units along the camera's axis: the mean of the splats' depths by their weights; ADCGS_DEPTH_FAR where alpha is 0.
 * Either may be NULL. As deterministic as frames, but not a point of conformance.
 */
ADCGS_API adcgs_status adcgs_render_depth(adcgs_decoder *decoder, const adcgs_camera *camera, double time, float *depth,
                                          float *alpha, adcgs_error *error);

/** Digest (MD5) of the decoded model of one segment: conformance point M. */
ADCGS_API adcgs_status adcgs_get_model_digest(const adcgs_decoder *decoder, int segment, uint8_t digest[16]);

/** Digest (MD5) of the splats at time t, as adcgs_get_primitives() gives them: conformance point S. */
ADCGS_API adcgs_status adcgs_get_splat_digest(adcgs_decoder *decoder, double time, uint8_t digest[16]);

/** Best CPU level this build has on this machine. */
ADCGS_API adcgs_cpu_level adcgs_cpu_best(void);

#ifdef __cplusplus
}
#endif
#endif
