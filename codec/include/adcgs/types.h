/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The types of the library, without its functions.
 *
 * adcgs_config and adcgs_info grow from version to version, at their ends; they carry their size, so that programs compiled
 * with older or newer headers work with any version of the library. All other types keep their layout.
 *
 * Clauses that are cited stand in the specification of the bitstream (spec/ in the sources).
 */
#ifndef ADCGS_TYPES_H
#define ADCGS_TYPES_H

#include <stddef.h>
#include <stdint.h>

#include <adcgs/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A stream that has been decoded, and what it takes to draw it. */
typedef struct adcgs_decoder adcgs_decoder;

/** Threads: a decoder's own, several decoders', or the caller's (pool.h). */
typedef struct adcgs_pool adcgs_pool;

/** Most threads of a pool. */
#define ADCGS_THREADS_MAX 256

/** Largest width and height of a picture, pixels (clause "View"). */
#define ADCGS_SIZE_MAX 16384

/** Which variant of the kernels runs. Results never depend on it. */
typedef enum adcgs_cpu_level {
    ADCGS_CPU_AUTO = 0,   /**< the best that this CPU and build have */
    ADCGS_CPU_SCALAR = 1, /**< portable C; on 64-bit ARM with NEON, on WebAssembly with its SIMD */
    ADCGS_CPU_AVX2 = 2,   /**< AVX2 and FMA */
    ADCGS_CPU_AVX512 = 3  /**< AVX-512 F, DQ, BW, VL */
} adcgs_cpu_level;

/** How much a message of the log matters. */
typedef enum adcgs_log_level {
    ADCGS_LOG_WARNING = 1, /**< what the decoder gives is less than the stream was meant to hold */
    ADCGS_LOG_INFO = 2     /**< for those who look for a fault or wonder about speed */
} adcgs_log_level;

/**
 * Takes a message: one line without line feed, valid during the call. Called in the thread that called the library, which
 * must not be called from here with the same decoder.
 */
typedef void (*adcgs_log_fn)(void *user, adcgs_log_level level, const char *text);

/**
 * Gives up to `bytes` bytes of a stream to `buffer`. Returns how many, at least 1; 0 at the end; a negative number on failure,
 * which becomes ADCGS_ERR_IO. Called in the thread that called the library.
 */
typedef int64_t (*adcgs_read_fn)(void *user, void *buffer, size_t bytes);

/**
 * Gives `bytes` bytes of a stream, those from `offset` on, which are all there. Returns how many it gave, at least 1; a negative
 * number on failure, which becomes ADCGS_ERR_IO. Called in the thread that called the library.
 */
typedef int64_t (*adcgs_read_at_fn)(void *user, uint64_t offset, void *buffer, size_t bytes);

/** What the bytes that adcgs_push() took have brought. */
typedef enum adcgs_arrival {
    ADCGS_ARRIVED_NOTHING = 0, /**< nothing yet: more bytes are needed */
    ADCGS_ARRIVED_HEADER = 1,  /**< what is true of the whole stream, for adcgs_get_info() */
    ADCGS_ARRIVED_CAMERAS = 2, /**< its cameras, for adcgs_get_camera() */
    ADCGS_ARRIVED_SEGMENT = 3, /**< a segment that can be drawn, or more of it */
    ADCGS_ARRIVED_END = 4      /**< the end of the stream: nothing more is taken */
} adcgs_arrival;

/**
 * How to decode. Set up by adcgs_config_init(), then changed as needed. In every member, zero is the default; members that a
 * caller's headers do not know yet have it, too.
 */
typedef struct adcgs_config {
    size_t size;           /**< sizeof(adcgs_config) of the caller, set by adcgs_config_init() */
    int threads;           /**< most, 1..ADCGS_THREADS_MAX; 0: one for each processor. Not looked at when there is a pool */
    adcgs_cpu_level cpu;   /**< ADCGS_ERR_UNSUPPORTED if the machine or the build lacks it */
    int layers;            /**< use at most this many layers, 1..5; 0: all (clause "Fewer layers, truncated streams") */
    uint64_t memory_limit; /**< bytes that the decoder may allocate, then ADCGS_ERR_LIMIT; 0: the stream's level decides */
    int strict_end;        /**< nonzero: a truncated stream is ADCGS_ERR_TRUNCATED; zero: what is complete can be played */
    adcgs_pool *pool;      /**< threads to use, not owned: it outlives the decoder; NULL: the decoder has its own */
    adcgs_log_fn log;      /**< takes messages; NULL: there are none */
    void *log_user;        /**< for log */
    int conceal;           /**< nonzero: of a damaged stream what is whole is used, and the log told what is not */
    int on_demand;         /**< nonzero: segments of a file are read when a time is asked for (adcgs_open_file()) */
    int join;              /**< nonzero: of a stream whose beginning is missing, what follows the next header and key is read */
} adcgs_config;

/** Bytes of a stream by what they hold (clause "Chunks"). */
typedef struct adcgs_bytes {
    uint64_t header;   /**< signature, headers and checksums of chunks, HEAD, SEGM, INDX, ENDC, hash */
    uint64_t networks; /**< payloads of NETW */
    uint64_t geometry; /**< payloads of GEOM and KEEP */
    uint64_t layer[5]; /**< payloads of FEA0..FEA4 */
    uint64_t cameras;  /**< payload of cams */
    uint64_t metadata; /**< payloads of meta and of ancillary chunks that are unknown */
    uint64_t total;    /**< the stream as far as it was read: the sum of the others */
} adcgs_bytes;

/**
 * What a stream holds. Filled by adcgs_get_info(). Where segments are read on demand, anchors, gaussians, static_anchors and
 * weights are those of the segments at hand, two in a fade, 0 before the first, layers those asked for, and bytes.total is what
 * was read so far. Where bytes are pushed, until their end, these are of complete segments that are kept, segments may be 0,
 * time_end is what the header promises, or infinity if it promises nothing, and bytes.total is what was taken so far.
 */
typedef struct adcgs_info {
    size_t size;            /**< bytes of this struct that the library filled; what lies behind them is zero */
    int version_major;      /**< of the bitstream (clause "HEAD") */
    int version_minor;      /**< of the bitstream */
    int profile;            /**< 0 (clause "Profiles and levels") */
    int level;              /**< 1..3: what the stream may cost (clause "Levels") */
    int segments;           /**< complete time segments, at least 1; those from first_segment on can be played */
    uint32_t anchors;       /**< over all segments */
    uint32_t gaussians;     /**< primitives that exist, over all segments */
    uint32_t static_anchors; /**< anchors that never move, over all segments */
    uint32_t weights;       /**< of networks and time tables, each counted once */
    int k;                  /**< primitives per anchor at most, 1..16 */
    int layers;             /**< layers that are used: present in all segments, and asked for; 1..5 */
    int cameras;            /**< cameras that the stream stores, for adcgs_get_camera() */
    double time_start;      /**< seconds */
    double time_end;        /**< seconds, not before time_start */
    double frame_rate;      /**< frames per second suggested for playing, > 0 */
    double scene_origin[3]; /**< centre of the scene, world units: world = origin + scale * scene */
    double scene_scale;     /**< world units in a scene unit, > 0 */
    float background[3];    /**< RGB behind the splats, as in frames */
    int truncated;          /**< nonzero: the stream ended early, and what was complete is here */
    char colour[32];        /**< of frames: "sRGB", "linear BT.709" or "unknown" */
    char axes[32];          /**< of the world: "right-handed, y up", "right-handed, z up", "right-handed, y down", "unknown" */
    char units[32];         /**< of the world: "metre" or "unknown" */
    adcgs_bytes bytes;      /**< where the stream's bytes are */
    int metadata;           /**< texts that the stream stores, for adcgs_get_metadata_key() */
    int faults;             /**< that were concealed, where config.conceal asked for it */
    int tiers;              /**< sets of anchors that the stream has (clause "Tiers"): the most that a segment has, 1..8 */
    int tiers_present;      /**< those that are there of all segments */
    double time_final;      /**< seconds: what moments before it show stays, whatever comes; infinity: nothing more will come */
    double time_drawable;   /**< seconds: the end of what can be drawn by now; minus infinity: nothing can */
    int segments_promised;  /**< that a stream which is pushed will have; 0: its header does not say */
    int tiers_coming;       /**< of the segment that bytes are pushed of, those that can be drawn; 0: none, or there is no such */
    int first_segment;      /**< number of the first segment that is here: above 0 where others were forgotten, or missed */
} adcgs_info;

/** Longest name of a camera, bytes without the zero. */
#define ADCGS_CAMERA_NAME_MAX 63

/**
 * A pinhole camera (clause "View"). Axes are OpenCV's: x right, y down, looking along +z. A point (X, Y, Z) in camera
 * coordinates falls on u = fx X/Z + cx, v = fy Y/Z + cy, in pixels; the picture covers [0,width] x [0,height], so the centre of
 * its first pixel is at (0.5, 0.5).
 */
typedef struct adcgs_camera {
    int32_t width;           /**< pixels, 1..ADCGS_SIZE_MAX */
    int32_t height;          /**< pixels, 1..ADCGS_SIZE_MAX */
    double fx;               /**< focal length in pixels' widths, 2^-10..2^24 */
    double fy;               /**< focal length in pixels' heights, 2^-10..2^24 */
    double cx;               /**< principal point in pixels, within 2^20 */
    double cy;               /**< principal point in pixels, within 2^20 */
    double cam_to_world[12]; /**< row-major 3x4 [R|c]: R orthonormal, c the camera's place in world units */
    double near_plane;       /**< world units, > 0: nothing closer is drawn */
    char name[ADCGS_CAMERA_NAME_MAX + 1]; /**< UTF-8, may be empty */
} adcgs_camera;

/** A rendered frame, RGB in the stream's transfer characteristic, 0 black to 1 white, not clipped. */
typedef struct adcgs_frame {
    int32_t width;  /**< pixels */
    int32_t height; /**< pixels */
    float *rgb;     /**< [height][width][3], owned by whoever allocated it */
} adcgs_frame;

/** What the fourth sample of a pixel says. Coverage is what adcgs_render_depth() calls alpha. */
typedef enum adcgs_alpha {
    ADCGS_ALPHA_OPAQUE = 0,       /**< 255: the colours are the frame's, with the stream's background behind the splats */
    ADCGS_ALPHA_STRAIGHT = 1,     /**< coverage; the colours are those of the splats alone, black where there are none */
    ADCGS_ALPHA_PREMULTIPLIED = 2 /**< coverage; the colours are those of the splats alone, times coverage */
} adcgs_alpha;

/** Depth of pixels that no splat touches, and the largest that adcgs_render_depth() gives. */
#define ADCGS_DEPTH_FAR 1e10f

/**
 * Splats at one moment, in scene units, as arrays of n slots each, 64-byte aligned. Slots are in the stream's order (clause
 * "Splats"); those of opacity 0 draw nothing. Owned by the decoder.
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
