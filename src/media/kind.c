/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The kind of the file at a path, and the message for a file of another kind than expected. */
#include "config.h"

#include "media/kind.h"

#include "media/splats/splats.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

static const adcgs_kind folder = {ADCGS_KIND_FOLDER, "a folder", NULL, NULL, 0, 0};

const adcgs_kind *adcgs_kind_at(const char *path)
{
    uint8_t begin[ADCGS_KIND_BYTES], tail[ADCGS_KIND_TAIL];
    const adcgs_kind *const unknown = adcgs_kind_of((const uint8_t *)"", 0, 0, NULL, path);
    struct stat status = {0}; /* MemorySanitizer of clang 14 does not know that stat() writes it */
    if (stat(path, &status))  /* without opening it, so that the writer of a pipe does not see a reader come and go */
        return unknown;
    if (S_ISDIR(status.st_mode))
        return &folder;
    const int fd = S_ISREG(status.st_mode) ? open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK) : -1;
    if (fd < 0)
        return unknown;
    const ssize_t n = pread(fd, begin, sizeof begin, 0);
    const int has_tail = status.st_size >= ADCGS_KIND_TAIL &&
                         pread(fd, tail, ADCGS_KIND_TAIL, status.st_size - ADCGS_KIND_TAIL) == ADCGS_KIND_TAIL;
    close(fd);
    return n > 0 ? adcgs_kind_of(begin, (size_t)n, (uint64_t)status.st_size, has_tail ? tail : NULL, path) : unknown;
}

/* ---- Expected kinds ---- */

static const struct {
    const char *name;
    adcgs_kind_class class;
} wants[ADCGS_WANTS] = {
    {"an adcgs stream", ADCGS_KIND_STREAM},
    {"a scene", ADCGS_KIND_SCENE},
    {"splats (" ADCGS_SPLATS_FORMATS ")", ADCGS_KIND_SPLATS},
    {"points (PLY, Draco, NPY or splats)", ADCGS_KIND_POINTS},
    {"an image (PNG, JPEG, TIFF, EXR, WebP, HEIC, AVIF, BMP, GIF, HDR or netpbm)", ADCGS_KIND_IMAGE},
};

/** Advice for a file that another program or option reads. */
static const char *advise(adcgs_kind_class class, adcgs_want want)
{
    switch (class) {
    case ADCGS_KIND_STREAM:
        return want == ADCGS_WANT_STREAM ? NULL : "adcgs-dec renders it, adcgs-info describes it";
    case ADCGS_KIND_VIDEO:
        return want == ADCGS_WANT_STREAM ? NULL : "adcgs-import extracts its frames and estimates their cameras";
    case ADCGS_KIND_IMAGE:
        return want == ADCGS_WANT_SCENE ? "one image has no camera pose; adcgs-import estimates those of several" : NULL;
    case ADCGS_KIND_SPLATS:
        return want == ADCGS_WANT_IMAGE ? NULL : "adcgs-enc makes a stream of it";
    case ADCGS_KIND_POINTS:
        return want == ADCGS_WANT_SCENE ? "give points with a scene, by --points" : NULL;
    case ADCGS_KIND_SCENE:
    case ADCGS_KIND_FOLDER:
        return want == ADCGS_WANT_STREAM ? "adcgs-enc makes a stream of a scene" : NULL;
    default:
        return NULL;
    }
}

adcgs_status adcgs_kind_refuse(const adcgs_kind *kind, const char *path, adcgs_want want, adcgs_error *error)
{
    const char *const advice = kind->advice ? kind->advice : advise(kind->class, want);
    const adcgs_status status = kind->class == wants[want].class ? ADCGS_ERR_UNSUPPORTED : ADCGS_ERR_DATA;
    if (kind->advice && kind->class == wants[want].class) /* the expected class, but an unsupported format */
        return adcgs_fail(error, status, "%.150s: %s, which is not read: %s", path, kind->name, advice);
    return adcgs_fail(error, status, "%.150s: %s, expected %s%s%s", path, kind->name, wants[want].name, advice ? ": " : "",
                      advice ? advice : "");
}

/** Splats also serve as scenes, and as points; splats over time only as scenes. */
static int fits(const adcgs_kind *kind, adcgs_want want)
{
    if (kind->is_over_time)
        return want == ADCGS_WANT_SCENE;
    return kind->class == ADCGS_KIND_UNKNOWN || (kind->is_read && kind->class == wants[want].class) ||
           (want == ADCGS_WANT_STREAM && kind->class == ADCGS_KIND_PAGE) ||   /* media/page_stream looks for the stream in it */
           (want != ADCGS_WANT_STREAM && kind->class == ADCGS_KIND_FOLDER) || /* other readers need a regular file and report
                                                                                 this */
           (want == ADCGS_WANT_SCENE && kind->is_read && kind->class == ADCGS_KIND_SPLATS) ||
           (want == ADCGS_WANT_POINTS && kind->is_read && kind->class == ADCGS_KIND_SPLATS);
}

adcgs_status adcgs_kind_check(const char *path, adcgs_want want, adcgs_error *error)
{
    const adcgs_kind *const kind = adcgs_kind_at(path);
    return fits(kind, want) ? ADCGS_OK : adcgs_kind_refuse(kind, path, want, error);
}
