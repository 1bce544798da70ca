/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The kind of a file by its first bytes. One table for all programs has the
 * formats that are read and others that users have, each with its name and
 * advice. The extension counts only if a kind has no bytes of its own (raw
 * images of cameras in TIFF, videos of two fisheyes in MP4).
 */
#ifndef ADCGS_MEDIA_KIND_H
#define ADCGS_MEDIA_KIND_H

#include "base/base.h"

#define ADCGS_KIND_BYTES 4096 /**< bytes examined at the beginning of a file; chosen by hand, not measured */
#define ADCGS_KIND_TAIL 32    /**< bytes examined at its end; definition (length of the magic at the end of Insta360's files) */

/** The content of a file. */
typedef enum adcgs_kind_class {
    ADCGS_KIND_UNKNOWN, /**< not in the table: the reader has its own message */
    ADCGS_KIND_FOLDER,
    ADCGS_KIND_STREAM, /**< an adcgs stream */
    ADCGS_KIND_PAGE,   /**< a page (HTML), which may have a stream in it */
    ADCGS_KIND_IMAGE,
    ADCGS_KIND_VIDEO,
    ADCGS_KIND_SPLATS,
    ADCGS_KIND_POINTS,
    ADCGS_KIND_SCENE, /**< cameras and the like, as text */
    ADCGS_KIND_OTHER,
    ADCGS_KIND_CLASSES
} adcgs_kind_class;

typedef struct adcgs_kind {
    adcgs_kind_class class;
    const char *name;   /**< with its article: "a TIFF image" */
    const char *reader; /**< for images that are read: OpenImageIO's name of the format; else NULL */
    const char *advice; /**< for a kind that is not read; or NULL */
    int is_read;        /**< true: programs that expect its class read it */
    int is_over_time;   /**< true: splats over time, which are a scene, but no static splats or points */
} adcgs_kind;

/** The content that a program expects of a file. */
typedef enum adcgs_want {
    ADCGS_WANT_STREAM,
    ADCGS_WANT_SCENE,
    ADCGS_WANT_SPLATS,
    ADCGS_WANT_POINTS,
    ADCGS_WANT_IMAGE,
    ADCGS_WANTS
} adcgs_want;

/**
 * The kind of a file of `size` bytes that begins with n bytes, at most ADCGS_KIND_BYTES; never NULL. name: of the file. tail: its
 * last ADCGS_KIND_TAIL bytes, or NULL.
 */
const adcgs_kind *adcgs_kind_of(const uint8_t *begin, size_t n, uint64_t size, const uint8_t *tail, const char *name);
/** The kind of the file at a path; unknown if it cannot be read, or is neither a regular file nor a folder. */
const adcgs_kind *adcgs_kind_at(const char *path);

/** "PATH: a GIF image, expected a scene: ..." as ADCGS_ERR_DATA, or ADCGS_ERR_UNSUPPORTED if it is of the right class. */
adcgs_status adcgs_kind_refuse(const adcgs_kind *kind, const char *path, adcgs_want want, adcgs_error *error);
/** Refuse a file of a known kind that does not fit. Unknown kinds, pipes and URLs pass. */
adcgs_status adcgs_kind_check(const char *path, adcgs_want want, adcgs_error *error);

#endif
