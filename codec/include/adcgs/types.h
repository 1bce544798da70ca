/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The types of the library, without its functions.
 *
 * New versions add members at the ends of adcgs_config and adcgs_info. Both carry their size, so that programs compiled with
 * older or newer headers work with any version of the library. All other types keep their layout.
 *
 * The cited clauses are those of the bitstream specification (spec/ in the sources).
 */
#ifndef ADCGS_TYPES_H
#define ADCGS_TYPES_H

#include <stddef.h>
#include <stdint.h>

#include <adcgs/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/** An open stream, and the state needed to render it. */
typedef struct adcgs_decoder adcgs_decoder;

/** Threads: a decoder's own, shared by several decoders, or the caller's (pool.h). */
typedef struct adcgs_pool adcgs_pool;

/** Maximum number of threads of a pool. */
#define ADCGS_THREADS_MAX 256

/** Largest width and height of an image, pixels (clause "View"). */
#define ADCGS_SIZE_MAX 16384

/** Variant of the kernels that runs. Results never depend on it. */
typedef enum adcgs_cpu_level {
    ADCGS_CPU_AUTO = 0,   /**< the best that this CPU and build support */
    ADCGS_CPU_SCALAR = 1, /**< portable C; on 64-bit ARM with NEON, on WebAssembly with its SIMD */
    ADCGS_CPU_AVX2 = 2,   /**< AVX2 and FMA */
    ADCGS_CPU_AVX512 = 3  /**< AVX-512 F, DQ, BW, VL */
} adcgs_cpu_level;

/** Severity of a log message. */
typedef enum adcgs_log_level {
    ADCGS_LOG_WARNING = 1, /**< the decoder gives less than the stream was meant to hold */
    ADCGS_LOG_INFO = 2     /**< details for finding faults and for questions of speed */
} adcgs_log_level;

/**
 * Receives a message: one line without line feed, valid during the call. Called in the thread that called the library. It must
 * not call the library with the same decoder.
 */
typedef void (*adcgs_log_fn)(void *user, adcgs_log_level level, const char *text);

/**
 * Writes up to `bytes` bytes of a stream to `buffer`. Returns their number, at least 1; 0 at the end; a negative number on
 * failure, which becomes ADCGS_ERR_IO. Called in the thread that called the library.
 */
typedef int64_t (*adcgs_read_fn)(void *user, void *buffer, size_t bytes);

/**
 * Writes up to `bytes` bytes of a stream, from `offset` on, to `buffer`. The library only asks for bytes within the stream's
 * size. Returns the number of bytes written, at least 1; a negative number on failure, which becomes ADCGS_ERR_IO. Called in the
 * thread that called the library.
 */
typedef int64_t (*adcgs_read_at_fn)(void *user, uint64_t offset, void *buffer, size_t bytes);

/** The part of the stream that the bytes taken by adcgs_push() completed. */
typedef enum adcgs_arrival {
    ADCGS_ARRIVED_NOTHING = 0, /**< nothing yet: more bytes are needed */
    ADCGS_ARRIVED_HEADER = 1,  /**< the properties of the whole stream, for adcgs_get_info() */
    ADCGS_ARRIVED_CAMERAS = 2, /**< the cameras, for adcgs_get_camera() */
    ADCGS_ARRIVED_SEGMENT = 3, /**< a segment that can be rendered, or a further part of one */
    ADCGS_ARRIVED_END = 4      /**< the end of the stream: no more bytes are taken */
} adcgs_arrival;

/**
 * How to decode. Initialise it with adcgs_config_init(), then change members as needed. Zero is the default of every member, also
 * of newer members that a caller's headers do not know.
 */
typedef struct adcgs_config {
    size_t size;           /**< sizeof(adcgs_config) of the caller, set by adcgs_config_init() */
    int threads;           /**< maximum, 1..ADCGS_THREADS_MAX; 0: one for each processor. Ignored if pool is set */
    adcgs_cpu_level cpu;   /**< ADCGS_ERR_UNSUPPORTED if the machine or the build lacks it */
    int layers;            /**< use at most this many layers, 1..5; 0: all (clause "Fewer layers, truncated streams") */
    uint64_t memory_limit; /**< bytes that the decoder may allocate, more is ADCGS_ERR_LIMIT; 0: bounded by the stream's level */
    int strict_end;        /**< nonzero: a truncated stream is ADCGS_ERR_TRUNCATED; zero: its complete part can be played */
    adcgs_pool *pool;      /**< threads to use, not owned: it must outlive the decoder; NULL: the decoder starts its own */
    adcgs_log_fn log;      /**< receives messages; NULL: none */
    void *log_user;        /**< passed to log */
    int conceal;           /**< nonzero: use the intact parts of a damaged stream, and report the damage to log */
    int on_demand;         /**< nonzero: read segments of a file when the caller requests a time (adcgs_open_file()) */
    int tune_in;           /**< nonzero: if the beginning of a stream is missing, begin at the next header and key */
} adcgs_config;

/** Bytes of a stream by content (clause "Chunks"). */
typedef struct adcgs_bytes {
    uint64_t header;   /**< signature, headers and checksums of chunks, HEAD, SEGM, INDX, ENDC, hash */
    uint64_t networks; /**< payloads of NETW */
    uint64_t geometry; /**< payloads of GEOM and KEEP */
    uint64_t layer[5]; /**< payloads of FEA0..FEA4 */
    uint64_t cameras;  /**< payload of cams */
    uint64_t metadata; /**< payloads of meta and of unknown ancillary chunks */
    uint64_t total;    /**< bytes of the stream read so far: the sum of the others */
} adcgs_bytes;

/**
 * Summary of a stream, filled by adcgs_get_info(). With segments read on demand, anchors, gaussians, static_anchors and weights
 * cover the segments in memory: two during a crossfade, none before the first. layers is then the number of requested layers, and
 * bytes.total the bytes read so far. With pushed bytes, until their end, these members cover the complete segments that are still
 * held, and segments may be 0. time_end is the value in the header, or infinity if the header gives none, and bytes.total is the
 * number of bytes taken so far.
 */
typedef struct adcgs_info {
    size_t size;             /**< bytes of this struct that the library filled; the rest is zero */
    int version_major;       /**< of the bitstream (clause "HEAD") */
    int version_minor;       /**< of the bitstream */
    int profile;             /**< 0 (clause "Profiles and levels") */
    int level;               /**< 1..3: bounds of the resources for decoding (clause "Levels") */
    int segments;            /**< complete time segments, at least 1; those from first_segment on can be played */
    uint32_t anchors;        /**< over all segments */
    uint32_t gaussians;      /**< primitives that exist, over all segments */
    uint32_t static_anchors; /**< anchors that never move, over all segments */
    uint32_t weights;        /**< of networks and time tables, each counted once */
    int k;                   /**< primitives per anchor at most, 1..16 */
    int layers;              /**< layers in use: present in all segments, and requested; 1..5 */
    int cameras;             /**< cameras stored in the stream, for adcgs_get_camera() */
    double time_start;       /**< seconds */
    double time_end;         /**< seconds, not before time_start */
    double frame_rate;       /**< suggested frames per second for playing, > 0 */
    double scene_origin[3];  /**< centre of the scene, world units: world = origin + scale * scene */
    double scene_scale;      /**< world units in a scene unit, > 0 */
    float background[3];     /**< RGB behind the splats, as in frames */
    int truncated;           /**< nonzero: the stream ended early; its complete part is available */
    char colour[32];         /**< of frames: "sRGB", "linear BT.709" or "unknown" */
    char axes[32];           /**< of the world: "right-handed, y up", "right-handed, z up", "right-handed, y down", "unknown" */
    char units[32];          /**< of the world: "metre" or "unknown" */
    adcgs_bytes bytes;       /**< bytes of the stream by content */
    int metadata;            /**< texts stored in the stream, for adcgs_get_metadata_key() */
    int faults;              /**< number of concealed faults, if config.conceal is set */
    int tiers;               /**< sets of anchors of the stream (clause "Tiers"): the maximum over its segments, 1..8 */
    int tiers_present;       /**< tiers that are available in all segments */
    double time_committed;   /**< seconds: content before it no longer changes; infinity: no more bytes will come */
    double time_available;   /**< seconds: end of the content that can be rendered now; minus infinity: none */
    int segments_total;      /**< total number of segments of a pushed stream; 0: its header does not give it */
    int tiers_received;      /**< tiers of the segment being received that can be rendered; 0: none, or no such segment */
    int first_segment;       /**< number of the first available segment: above 0 if earlier ones were freed or missed */
    float screen_filter;     /**< variance added to the projection of a splat, square pixels, 0..16 (clause "Projection") */
    uint64_t bytes_max;      /**< maximum size of a stream of this level, bytes (clause "Levels") */
} adcgs_info;

/** Longest name of a camera, bytes without the zero. */
#define ADCGS_CAMERA_NAME_MAX 63

/**
 * A pinhole camera (clause "View"). Axes are OpenCV's: x right, y down, looking along +z. A point (X, Y, Z) in camera
 * coordinates projects to u = fx X/Z + cx, v = fy Y/Z + cy, in pixels. The image covers [0,width] x [0,height], so the centre of
 * its first pixel is at (0.5, 0.5).
 */
typedef struct adcgs_camera {
    int32_t width;                        /**< pixels, 1..ADCGS_SIZE_MAX */
    int32_t height;                       /**< pixels, 1..ADCGS_SIZE_MAX */
    double fx;                            /**< focal length in pixel widths, 2^-10..2^24 */
    double fy;                            /**< focal length in pixel heights, 2^-10..2^24 */
    double cx;                            /**< principal point in pixels, within 2^20 */
    double cy;                            /**< principal point in pixels, within 2^20 */
    double cam_to_world[12];              /**< row-major 3x4 [R|c]: R orthonormal, c the camera's centre in world units */
    double near_plane;                    /**< world units, > 0: nothing closer is rendered */
    char name[ADCGS_CAMERA_NAME_MAX + 1]; /**< UTF-8, may be empty */
} adcgs_camera;

/**
 * A camera as the renderer uses it: scene units, binary32 (clause "View"). For programs that render the splats of
 * adcgs_get_primitives() themselves. The floats lie in a row without padding. A point p of the scene has the camera
 * coordinates rotation p + translation.
 */
typedef struct adcgs_view {
    int32_t width;        /**< pixels, of the camera */
    int32_t height;       /**< pixels, of the camera */
    float rotation[9];    /**< row-major 3x3: from the scene's axes to the camera's */
    float translation[3]; /**< scene units */
    float fx;             /**< focal length in pixel widths, of the camera */
    float fy;             /**< focal length in pixel heights, of the camera */
    float cx;             /**< principal point in pixels, of the camera */
    float cy;             /**< principal point in pixels, of the camera */
    float near_plane;     /**< scene units: nothing closer is rendered */
    float limit[4];       /**< X/Z lowest and highest, then Y/Z: bounds of a splat's centre in the derivative of its projection */
} adcgs_view;

/** A rendered frame, RGB in the stream's transfer characteristic, 0 black to 1 white, not clipped. */
typedef struct adcgs_frame {
    int32_t width;  /**< pixels */
    int32_t height; /**< pixels */
    float *rgb;     /**< [height][width][3], owned by the caller */
} adcgs_frame;

/** Meaning of the fourth sample of a pixel. Coverage is the alpha of adcgs_render_depth(). */
typedef enum adcgs_alpha {
    ADCGS_ALPHA_OPAQUE = 0,       /**< 255: the colours are the frame's, with the stream's background behind the splats */
    ADCGS_ALPHA_STRAIGHT = 1,     /**< coverage; the colours are those of the splats alone, black where there are none */
    ADCGS_ALPHA_PREMULTIPLIED = 2 /**< coverage; the colours are those of the splats alone, times coverage */
} adcgs_alpha;

/** Depth of pixels that no splat touches, and the largest that adcgs_render_depth() gives. */
#define ADCGS_DEPTH_FAR 1e10f

/**
 * Splats at one time, in scene units, as arrays of n slots each, 64-byte aligned. Slots are in the stream's order (clause
 * "Splats"); those with opacity 0 are invisible. Owned by the decoder.
 */
typedef struct adcgs_primitives {
    uint32_t n;               /**< slots in every array, a multiple of 64 */
    const float *mean[3];     /**< centre: x, y, z */
    const float *scale[3];    /**< standard deviations along the splat's axes, > 0 */
    const float *rotation[4]; /**< unit quaternion w, x, y, z: from the splat's axes to the scene's */
    const float *opacity;     /**< 0..0.99 */
    const float *colour[3];   /**< RGB as in frames, not clipped */
} adcgs_primitives;

#ifdef __cplusplus
}
#endif
#endif
