/* SPDX-License-Identifier: BSD-2-Clause */
/** \file cams and meta: cameras and text stored with the scene. */
#include "stream/parts.h"

#include <math.h>

#define CAMERA_SAME_LENS 1  /**< same size, intrinsics and near plane as the previous camera */
#define CAMERA_SHORT_POSE 2 /**< the pose is twelve binary32 */
#define CAMERA_TIMED 4      /**< a time follows */
#define CAMERA_NEXT_KEY 8   /**< a key of the previous camera's path */
#define CAMERAS_MAX 65535U
#define META_MAX 1024U
#define META_KEY_MAX 64U
#define META_VALUE_MAX 65535U

static void set_lens(adcgs_camera *c, const adcgs_syn_lens *lens)
{
    c->width = lens->width;
    c->height = lens->height;
    c->fx = lens->fx;
    c->fy = lens->fy;
    c->cx = lens->cx;
    c->cy = lens->cy;
    c->near_plane = lens->near_plane;
}

static adcgs_status parse_pose(adcgs_parse *p, int flags, double pose[12])
{
    adcgs_syn_pose_short brief;
    adcgs_syn_pose full;
    if (flags & CAMERA_SHORT_POSE) {
        ADCGS_TRY(adcgs_syn_pose_short_parse(p, &brief));
        for (int i = 0; i < 12; i++)
            pose[i] = (double)brief.cam_to_world_short[i];
    } else {
        ADCGS_TRY(adcgs_syn_pose_parse(p, &full));
        memcpy(pose, full.cam_to_world, sizeof full.cam_to_world);
    }
    return ADCGS_OK;
}

/** Reads the time, and sets the path. paths: number of paths so far. */
static adcgs_status parse_time(adcgs_parse *p, int flags, adcgs_stored_camera *c, adcgs_stored_camera *before, int *paths)
{
    adcgs_syn_camera_time filmed = {.camera_time = (double)NAN};
    if (flags & CAMERA_TIMED)
        ADCGS_TRY(adcgs_syn_camera_time_parse(p, &filmed));
    c->time = filmed.camera_time;
    c->path = -1;
    if (!(flags & CAMERA_NEXT_KEY))
        return ADCGS_OK;
    if (!before || !(c->time > before->time)) /* also if one of them has no time */
        return adcgs_fail(p->error, ADCGS_ERR_DATA,
                          "cams: camera_flags is %d, but the camera is not later than one with a time before it", flags);
    if (before->path < 0)
        before->path = (*paths)++;
    c->path = before->path;
    return ADCGS_OK;
}

static adcgs_status parse_camera(adcgs_parse *p, adcgs_camera *c, const adcgs_camera *before, int *flags, adcgs_memory *memory)
{
    adcgs_syn_camera head;
    adcgs_syn_lens lens;
    char *name = NULL;
    ADCGS_TRY(adcgs_parse_text(p, "name", 0, ADCGS_CAMERA_NAME_MAX, memory, &name));
    memcpy(c->name, name, strlen(name));
    adcgs_free(memory, name);
    ADCGS_TRY(adcgs_syn_camera_parse(p, &head));
    *flags = head.camera_flags;
    if (!(head.camera_flags & CAMERA_SAME_LENS)) {
        ADCGS_TRY(adcgs_syn_lens_parse(p, &lens));
        set_lens(c, &lens);
    } else if (before) {
        c->width = before->width;
        c->height = before->height;
        c->fx = before->fx;
        c->fy = before->fy;
        c->cx = before->cx;
        c->cy = before->cy;
        c->near_plane = before->near_plane;
    } else {
        return adcgs_fail(p->error, ADCGS_ERR_DATA,
                          "cams: camera_flags of the first camera is %u, but there is no camera before it", head.camera_flags);
    }
    return parse_pose(p, head.camera_flags, c->cam_to_world);
}

adcgs_status adcgs_cams_parse(adcgs_parse *p, adcgs_stream *stream, adcgs_memory *memory)
{
    uint32_t n;
    int paths = 0;
    if (stream->cameras)
        return adcgs_fail(p->error, ADCGS_ERR_DATA, "cams: the stream has more than one such chunk");
    ADCGS_TRY(adcgs_parse_varint(p, "cameras", 1, CAMERAS_MAX, &n));
    if (n > p->r.size / 50) /* the shortest camera has 50 bytes */
        return adcgs_fail(p->error, ADCGS_ERR_DATA, "cams: cameras is %u, too many for %zu bytes", n, p->r.size);
    stream->cameras = adcgs_alloc(memory, n, sizeof *stream->cameras, p->error);
    if (!stream->cameras)
        return adcgs_alloc_status(p->error);
    for (; stream->n_cameras < n; stream->n_cameras++) {
        adcgs_stored_camera *c = &stream->cameras[stream->n_cameras], *before = stream->n_cameras > 0 ? c - 1 : NULL;
        int flags;
        ADCGS_TRY(parse_camera(p, &c->camera, before ? &before->camera : NULL, &flags, memory));
        ADCGS_TRY(parse_time(p, flags, c, before, &paths));
    }
    return adcgs_parse_end(p);
}

static adcgs_syn_lens lens_of(const adcgs_camera *c)
{
    const adcgs_syn_lens lens = {
        .width = (uint16_t)(c->width < 0 ? 0 : ADCGS_MIN(c->width, UINT16_MAX)),
        .height = (uint16_t)(c->height < 0 ? 0 : ADCGS_MIN(c->height, UINT16_MAX)),
        .fx = c->fx,
        .fy = c->fy,
        .cx = c->cx,
        .cy = c->cy,
        .near_plane = c->near_plane,
    };
    return lens;
}

static int same_bits(double a, double b)
{
    return adcgs_double_bits(a) == adcgs_double_bits(b);
}

static int same_lens(const adcgs_camera *a, const adcgs_camera *b)
{
    return a->width == b->width && a->height == b->height && same_bits(a->fx, b->fx) && same_bits(a->fy, b->fy) &&
           same_bits(a->cx, b->cx) && same_bits(a->cy, b->cy) && same_bits(a->near_plane, b->near_plane);
}

static int fits_binary32(const double pose[12])
{
    for (int i = 0; i < 12; i++)
        if (!(pose[i] >= -ADCGS_WORLD_MAX && pose[i] <= ADCGS_WORLD_MAX) || !same_bits((double)(float)pose[i], pose[i]))
            return 0;
    return 1;
}

static int flags_of_time(const adcgs_stored_camera *c, const adcgs_stored_camera *before)
{
    const int next = before && c->path >= 0 && c->path == before->path;
    return (isnan(c->time) ? 0 : CAMERA_TIMED) + next * CAMERA_NEXT_KEY;
}

static adcgs_status write_camera(adcgs_buffer *out, const adcgs_camera *c, const adcgs_camera *before, int flags,
                                 adcgs_error *error)
{
    const adcgs_syn_lens lens = lens_of(c);
    const int same = before && same_lens(c, before), brief = fits_binary32(c->cam_to_world);
    const adcgs_syn_camera head = {(uint8_t)(flags + same * CAMERA_SAME_LENS + brief * CAMERA_SHORT_POSE)};
    const char *end = memchr(c->name, 0, sizeof c->name);
    if (!end)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "cams: a camera's name has no terminating zero");
    adcgs_write_varint(out, (uint32_t)(end - c->name));
    adcgs_write_bytes(out, c->name, (size_t)(end - c->name));
    ADCGS_TRY(adcgs_syn_camera_write(out, "cams", &head, error));
    if (!same)
        ADCGS_TRY(adcgs_syn_lens_write(out, "cams", &lens, error));
    adcgs_syn_pose_short short_pose;
    adcgs_syn_pose pose;
    for (int i = 0; i < 12; i++) {
        pose.cam_to_world[i] = c->cam_to_world[i];
        short_pose.cam_to_world_short[i] = brief ? (float)c->cam_to_world[i] : 0;
    }
    return brief ? adcgs_syn_pose_short_write(out, "cams", &short_pose, error) : adcgs_syn_pose_write(out, "cams", &pose, error);
}

static adcgs_status write_stored(adcgs_buffer *out, const adcgs_stored_camera *c, const adcgs_stored_camera *before,
                                 adcgs_error *error)
{
    const int flags = flags_of_time(c, before);
    const adcgs_syn_camera_time filmed = {c->time};
    if (flags & CAMERA_NEXT_KEY && !(c->time > before->time))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "cams: the keys of path %d are not in ascending time", c->path);
    ADCGS_TRY(write_camera(out, &c->camera, before ? &before->camera : NULL, flags, error));
    return flags & CAMERA_TIMED ? adcgs_syn_camera_time_write(out, "cams", &filmed, error) : ADCGS_OK;
}

adcgs_status adcgs_cams_write(adcgs_buffer *out, const adcgs_stream *stream, adcgs_error *error)
{
    const adcgs_stored_camera *c = stream->cameras;
    if (stream->n_cameras > CAMERAS_MAX)
        return adcgs_fail(error, ADCGS_ERR_LIMIT, "cams: %u cameras, expected at most %u", stream->n_cameras, CAMERAS_MAX);
    adcgs_write_varint(out, stream->n_cameras);
    for (uint32_t i = 0; i < stream->n_cameras; i++)
        ADCGS_TRY(write_stored(out, &c[i], i > 0 ? &c[i - 1] : NULL, error));
    return ADCGS_OK;
}

adcgs_status adcgs_meta_parse(adcgs_parse *p, adcgs_stream *stream, adcgs_memory *memory)
{
    uint32_t n;
    if (stream->meta)
        return adcgs_fail(p->error, ADCGS_ERR_DATA, "meta: the stream has more than one such chunk");
    ADCGS_TRY(adcgs_parse_varint(p, "entries", 1, META_MAX, &n));
    stream->meta = adcgs_alloc(memory, n, sizeof *stream->meta, p->error);
    if (!stream->meta)
        return adcgs_alloc_status(p->error);
    for (; stream->n_meta < n; stream->n_meta++) { /* n_meta counts complete entries */
        adcgs_meta *m = &stream->meta[stream->n_meta];
        ADCGS_TRY(adcgs_parse_text(p, "key", 1, META_KEY_MAX, memory, &m->key));
        const adcgs_status status = adcgs_parse_text(p, "value", 0, META_VALUE_MAX, memory, &m->value);
        if (status != ADCGS_OK) {
            adcgs_free(memory, m->key);
            m->key = NULL;
            return status;
        }
    }
    return adcgs_parse_end(p);
}

adcgs_status adcgs_meta_write(adcgs_buffer *out, const adcgs_stream *stream, adcgs_error *error)
{
    if (stream->n_meta > META_MAX)
        return adcgs_fail(error, ADCGS_ERR_LIMIT, "meta: %u entries, expected at most %u", stream->n_meta, META_MAX);
    adcgs_write_varint(out, stream->n_meta);
    for (uint32_t i = 0; i < stream->n_meta; i++) {
        const size_t key = strlen(stream->meta[i].key), value = strlen(stream->meta[i].value);
        if (key < 1 || key > META_KEY_MAX || value > META_VALUE_MAX)
            return adcgs_fail(error, key < 1 ? ADCGS_ERR_USAGE : ADCGS_ERR_LIMIT,
                              "meta: key of %zu bytes, value of %zu, expected 1..%u and at most %u", key, value, META_KEY_MAX,
                              META_VALUE_MAX);
        adcgs_write_varint(out, (uint32_t)key);
        adcgs_write_bytes(out, stream->meta[i].key, key);
        adcgs_write_varint(out, (uint32_t)value);
        adcgs_write_bytes(out, stream->meta[i].value, value);
    }
    return ADCGS_OK;
}
