/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Video files through FFmpeg's libraries, in a module of their own. Colours are
 * converted to RGB by the stream's own matrix and range. By default, large
 * videos have BT.709's matrix, small ones BT.601's, and the range is limited.
 * High dynamic range (HLG, PQ) is converted to the range of ordinary screens.
 */
#ifndef ADCGS_MEDIA_VIDEO_VIDEO_H
#define ADCGS_MEDIA_VIDEO_VIDEO_H

#include "media/image/image.h"
#include "media/video/fps.h"

#include <adcgs/types.h>

typedef struct adcgs_video adcgs_video;

typedef struct adcgs_video_info {
    int width, height; /**< as shown: rotation applied, square pixels */
    int64_t frames;    /**< counted; the header's number is not trusted */
    adcgs_fps rate;    /**< the mean rate; always known */
    const char *hdr;   /**< name of the first frame's high dynamic range, "HLG" or "PQ", which is converted; NULL: none */
    const char *round; /**< projection of a panorama, as "equirectangular"; NULL: an ordinary lens */
    int has_sound;     /**< the file has a sound track, which is not read */
    double start;      /**< time of the first frame by the clock of the file, which the sound shares, seconds */
} adcgs_video_info;

/** True if the name ends like a video file's (mp4, mov, mkv, webm, avi, m4v, ...). */
int adcgs_is_video(const char *path);

/**
 * ADCGS_ERR_UNSUPPORTED without FFmpeg or for a codec it lacks, ADCGS_ERR_IO if the file does not exist, ADCGS_ERR_DATA if it is
 * not a video, or one without a frame.
 */
adcgs_status adcgs_video_open(adcgs_video **out, const char *path, adcgs_error *error);
void adcgs_video_close(adcgs_video **video);
const adcgs_video_info *adcgs_video_get_info(const adcgs_video *video);
/**
 * Read the frame of an index, from 0, in presentation order, as three channels. Cheap in ascending order; one thread at a time.
 * ADCGS_ERR_DATA, naming file and frame, for a missing or damaged frame.
 */
adcgs_status adcgs_video_read(adcgs_video *video, int64_t frame, adcgs_image *out, adcgs_error *error);

/** Seconds from the first frame to this one by the file's timestamps; by the mean rate if it has none. */
double adcgs_video_time(const adcgs_video *video, int64_t frame);

typedef struct adcgs_video_writer adcgs_video_writer;

/** How a video is coded. All zero: the container's default, H.264 or a codec that this FFmpeg has, with little loss. */
typedef struct adcgs_video_style {
    const char *codec;   /**< FFmpeg's name of an encoder or a codec, or a codec's common name; NULL: by the container */
    const char *options; /**< for the encoder, in FFmpeg's form: "name=value:name=value"; also pix_fmt. NULL: none */
    double crf;          /**< constant rate factor, if has_crf */
    int has_crf;
    uint64_t bit_rate;  /**< bits per second; 0: by quality */
    const char *sound;  /**< file whose sound goes into the video unchanged; NULL: none */
    double sound_start; /**< position in it at the first frame, seconds; negative: the sound begins later */
    int has_alpha;      /**< frames have alpha, which the codec must support */
} adcgs_video_style;

/**
 * Start a video. Container by extension; BT.709 of limited range, or RGB, tagged accordingly. style: {0} for the defaults; its
 * strings are not needed after the call.
 */
adcgs_status adcgs_video_write_open(adcgs_video_writer **out, const char *path, int width, int height, double frame_rate,
                                    const adcgs_video_style *style, adcgs_error *error);
/** The size of the frames in the file: that of the input, or one row or column more if the codec needs even sizes. */
void adcgs_video_write_size(const adcgs_video_writer *writer, int *width, int *height);
/**
 * Add a frame. alpha: [height][width], by which its colours are premultiplied; the file stores straight colours. NULL: opaque.
 */
adcgs_status adcgs_video_write_frame(adcgs_video_writer *writer, const adcgs_frame *frame, const float *alpha,
                                     adcgs_error *error);
/** Complete the file. On failure, and after adcgs_video_write_abort(), no file is left. */
adcgs_status adcgs_video_write_close(adcgs_video_writer **writer, adcgs_error *error);
void adcgs_video_write_abort(adcgs_video_writer **writer);

#endif
