/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A camera whose footage arrives while it is recorded. */
#include "config.h"

#include "scene/live/live_camera.h"

#include "system/paths.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define DEFAULT_FRAME_RATE ((adcgs_fps){30, 1}) /* frames per second, if no file or option states them */
#define HELD_BYTES 65536                        /* capacity of a pipe; definition of Linux, pipe(7) */
#define AHEAD 8                                 /* images after a missing one that are looked for */
#define AHEAD_LEAST 2                           /* an image may arrive before its predecessor, but not before earlier ones */

static adcgs_status no_memory(const adcgs_live_camera *c, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", c->source->name);
}

void adcgs_live_camera_init(adcgs_live_camera *c, const adcgs_source_camera *source, double begin)
{
    *c = (adcgs_live_camera){.source = source, .rate = source->rate, .offset = source->offset - begin, .refused = -1, .fd = -1};
    if (!c->rate.den && !source->video)
        c->rate = DEFAULT_FRAME_RATE;
}

void adcgs_live_camera_clear(adcgs_live_camera *c)
{
    if (c->fd >= 0 && !c->source->is_input)
        close(c->fd);
    if (c->spool)
        fclose(c->spool);
    free(c->held);
    free(c->there);
}

double adcgs_live_camera_time(const adcgs_live_camera *c, int64_t frame)
{
    return c->offset + (double)frame * c->rate.den / c->rate.num;
}

int64_t adcgs_live_camera_from(const adcgs_live_camera *c, double time, double within)
{
    const double frame = ceil((time - within - c->offset) * c->rate.num / c->rate.den);
    return frame > 0 ? (int64_t)frame : 0;
}

int adcgs_live_camera_has(const adcgs_live_camera *c, int64_t frame)
{
    return frame >= c->base && frame < c->next && c->there[frame - c->base];
}

void adcgs_live_camera_pass_over(adcgs_live_camera *c, int64_t frame)
{
    c->first = frame;
    if (!c->source->video) /* bytes of a video are read nevertheless, to find the beginnings of frames */
        c->base = c->next = frame;
}

void adcgs_live_camera_forget(adcgs_live_camera *c, int64_t frame)
{
    const int64_t to = ADCGS_MIN(frame, c->next);
    if (to <= c->base)
        return;
    memmove(c->there, c->there + (to - c->base), (size_t)(c->next - to));
    c->base = to;
}

/** Records the next frame as available or missing. */
static adcgs_status decide(adcgs_live_camera *c, int is_there, int *progress, adcgs_error *error)
{
    const int64_t n = c->next - c->base;
    if (n == c->capacity) {
        const int64_t capacity = 2 * n + 64;
        uint8_t *there = realloc(c->there, (size_t)capacity);
        if (!there)
            return no_memory(c, error);
        c->there = there;
        c->capacity = capacity;
    }
    if (!is_there && !c->n_missing++)
        c->first_missing = c->next;
    c->there[n] = (uint8_t)is_there;
    c->next++;
    *progress = 1;
    return ADCGS_OK;
}

char *adcgs_live_camera_path(const adcgs_live_camera *c, int64_t frame, const adcgs_live_limits *limits, uint32_t stretch)
{
    return c->source->video ? adcgs_path("%s/%u-%u.y4m", limits->folder, limits->index, stretch)
                            : adcgs_footage_number(c->source->folder, c->source->images, c->source->first + frame);
}

/* ---- Images ---- */

/** True if the file can be read now and has the camera's size. A file that could not be read is skipped until it changes. */
static int can_be_read(adcgs_live_camera *c, int64_t frame, const char *path)
{
    adcgs_image image;
    adcgs_error ignored;
    struct stat s;
    if (stat(path, &s) || !S_ISREG(s.st_mode) || s.st_size == 0)
        return 0;
    if (c->refused == frame && c->refused_bytes == s.st_size && c->refused_time.tv_sec == s.st_mtim.tv_sec &&
        c->refused_time.tv_nsec == s.st_mtim.tv_nsec)
        return 0;
    int fits = adcgs_image_read(&image, path, &ignored) == ADCGS_OK;
    if (fits) {
        c->width = c->width ? c->width : image.width;
        c->height = c->height ? c->height : image.height;
        fits = image.width == c->width && image.height == c->height;
        adcgs_image_free(&image);
    }
    if (!fits) {
        c->refused = frame;
        c->refused_bytes = s.st_size;
        c->refused_time = s.st_mtim;
    }
    return fits;
}

static int has_picture(adcgs_live_camera *c, int64_t frame)
{
    char *path = adcgs_live_camera_path(c, frame, NULL, 0);
    const int there = path && can_be_read(c, frame, path);
    free(path);
    return there;
}

/** True if images taken after a missing one are available. */
static int has_later(const adcgs_live_camera *c, int64_t frame, int is_end)
{
    for (int64_t i = frame + (is_end ? 1 : AHEAD_LEAST); i <= frame + AHEAD; i++) {
        char *path = adcgs_live_camera_path(c, i, NULL, 0);
        const int there = adcgs_is_there(path);
        free(path);
        if (there)
            return 1;
    }
    return 0;
}

static adcgs_status look_for_picture(adcgs_live_camera *c, const adcgs_live_limits *l, int *progress, adcgs_error *error)
{
    const double time = adcgs_live_camera_time(c, c->next);
    c->is_over |= c->source->count && c->next >= c->source->count;
    if (c->is_over || time > l->until)
        return ADCGS_OK;
    const int there = has_picture(c, c->next);
    if (there || time < l->given_up || has_later(c, c->next, l->is_end))
        return decide(c, there, progress, error);
    c->is_over = l->is_end;
    return ADCGS_OK;
}

/* ---- Y4M ---- */

/** Opens a file or a pipe, if it exists. */
static adcgs_status open_file(adcgs_live_camera *c, adcgs_error *error)
{
    const char *path = c->source->video;
    struct stat s;
    c->fd = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (c->fd < 0)
        return errno == ENOENT ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_IO, "%s: %s", path, strerror(errno));
    if (fstat(c->fd, &s) || (!S_ISREG(s.st_mode) && !S_ISFIFO(s.st_mode)))
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: neither a file nor a pipe", path);
    c->is_pipe = S_ISFIFO(s.st_mode);
    return ADCGS_OK;
}

static adcgs_status open_video(adcgs_live_camera *c, adcgs_error *error)
{
    if (c->fd >= 0)
        return ADCGS_OK;
    if (c->source->is_input) {
        c->fd = STDIN_FILENO;
        c->is_pipe = 1;
    } else
        ADCGS_TRY(open_file(c, error));
    if (c->fd < 0)
        return ADCGS_OK;
    c->held = malloc(HELD_BYTES);
    return c->held ? ADCGS_OK : no_memory(c, error);
}

/** Reads some bytes if any have arrived. A pipe without writers has ended; a file may grow. */
static adcgs_status fetch(adcgs_live_camera *c, adcgs_error *error)
{
    if (c->held_begin < c->held_end || c->fd < 0)
        return ADCGS_OK;
    struct pollfd input = {.fd = c->fd, .events = POLLIN};
    if (c->source->is_input && poll(&input, 1, 0) <= 0) /* standard input is shared and may block */
        return ADCGS_OK;
    const ssize_t n = read(c->fd, c->held, HELD_BYTES);
    c->held_begin = c->held_end = 0;
    if (n < 0 && errno != EAGAIN && errno != EINTR)
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot read: %s", c->source->video, strerror(errno));
    if (n > 0)
        c->held_end = (size_t)n;
    c->has_begun |= n > 0 || c->source->is_input;
    c->is_over |= n == 0 && c->has_begun && c->is_pipe;
    return ADCGS_OK;
}

/** Continues a line; *whole: it has ended, and is in text without its line feed. */
static adcgs_status read_line(adcgs_live_camera *c, int *whole, adcgs_error *error)
{
    *whole = 0;
    while (!*whole && c->held_begin < c->held_end) {
        const char next = (char)c->held[c->held_begin++];
        *whole = next == '\n';
        if (c->text_bytes == ADCGS_Y4M_LINE_MAX || !next)
            return adcgs_fail(error, ADCGS_ERR_DATA, "%s: not Y4M, or damaged before frame %lld", c->source->video,
                              (long long)c->next);
        c->text[c->text_bytes++] = *whole ? '\0' : next;
    }
    if (*whole)
        c->text_bytes = 0;
    return ADCGS_OK;
}

adcgs_status adcgs_live_camera_begin(adcgs_live_camera *c, adcgs_error *error)
{
    int whole = 0;
    if (!c->source->video || c->shape.frame_bytes)
        return ADCGS_OK;
    ADCGS_TRY(open_video(c, error));
    ADCGS_TRY(fetch(c, error));
    ADCGS_TRY(read_line(c, &whole, error));
    if (!whole)
        return ADCGS_OK;
    memcpy(c->line, c->text, sizeof c->line);
    ADCGS_TRY(adcgs_y4m_shape_parse(&c->shape, c->line, c->source->video, error));
    c->width = c->shape.width;
    c->height = c->shape.height;
    if (!c->rate.den)
        c->rate = c->shape.rate.den ? c->shape.rate : DEFAULT_FRAME_RATE;
    return ADCGS_OK;
}

static adcgs_status spool_failed(const adcgs_live_camera *c, const adcgs_live_limits *l, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot store the footage of %s: %s", l->folder, c->source->name, strerror(errno));
}

/** Opens the file for the next frame. */
static adcgs_status open_spool(adcgs_live_camera *c, const adcgs_live_limits *l, adcgs_error *error)
{
    const uint32_t stretch = l->stretch(l->user, adcgs_live_camera_time(c, c->next));
    if (c->spool && c->stretch == stretch)
        return ADCGS_OK;
    if (c->spool)
        fclose(c->spool); /* each frame was flushed */
    char *path = adcgs_live_camera_path(c, c->next, l, stretch);
    c->spool = path ? fopen(path, "wb") : NULL;
    free(path);
    c->stretch = stretch;
    return c->spool && fprintf(c->spool, "%s\n", c->line) > 0 ? ADCGS_OK : spool_failed(c, l, error);
}

/** Reads the line in front of a frame. */
static adcgs_status begin_frame(adcgs_live_camera *c, const adcgs_live_limits *l, adcgs_error *error)
{
    int whole;
    ADCGS_TRY(read_line(c, &whole, error));
    if (!whole)
        return ADCGS_OK;
    if (strncmp(c->text, "FRAME", 5) != 0)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: damaged before frame %lld, expected FRAME", c->source->video,
                          (long long)c->next);
    c->left = c->shape.frame_bytes;
    if (c->next < c->first)
        return ADCGS_OK;
    ADCGS_TRY(open_spool(c, l, error));
    return fputs("FRAME\n", c->spool) >= 0 ? ADCGS_OK : spool_failed(c, l, error);
}

static adcgs_status go_on_with_frame(adcgs_live_camera *c, const adcgs_live_limits *l, int *progress, adcgs_error *error)
{
    const size_t n = ADCGS_MIN(c->left, c->held_end - c->held_begin);
    const int is_kept = c->next >= c->first;
    if (is_kept && n > 0 && fwrite(c->held + c->held_begin, 1, n, c->spool) != n)
        return spool_failed(c, l, error);
    c->held_begin += n;
    c->left -= n;
    if (c->left > 0 || n == 0)
        return ADCGS_OK;
    if (!is_kept) {
        c->base = ++c->next;
        return ADCGS_OK;
    }
    return fflush(c->spool) ? spool_failed(c, l, error) : decide(c, 1, progress, error);
}

static adcgs_status look_for_frames(adcgs_live_camera *c, const adcgs_live_limits *l, int *progress, adcgs_error *error)
{
    const int64_t before = c->next;
    c->waits = !c->shape.frame_bytes; /* adcgs_live_camera_begin() reads the first line */
    while (!c->is_over && !c->waits && c->next == before && (c->left > 0 || adcgs_live_camera_time(c, c->next) <= l->until)) {
        ADCGS_TRY(fetch(c, error));
        c->waits = c->held_begin == c->held_end;
        if (c->waits)
            break;
        *progress = 1;
        ADCGS_TRY(c->left > 0 ? go_on_with_frame(c, l, progress, error) : begin_frame(c, l, error));
    }
    c->is_over |= l->is_end && c->waits;
    return ADCGS_OK;
}

adcgs_status adcgs_live_camera_look(adcgs_live_camera *c, const adcgs_live_limits *limits, int *progress, adcgs_error *error)
{
    return c->source->video ? look_for_frames(c, limits, progress, error) : look_for_picture(c, limits, progress, error);
}
