/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Camera paths as USD text. */
#include "config.h"

#include "camera/euler.h"
#include "camera/path_files.h"
#include "camera/usda.h"
#include "geometry/rotation.h"
#include "scene/pose_check.h"
#include "system/atomic.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* USD's defaults, by definition: lengths in tenths of a scene unit; time codes per second. */
#define APERTURE 20.955
#define FOCAL 50.0
#define CODES_A_SECOND 24.0

/* Origin: chosen by hand, not measured. */
#define WRITTEN_APERTURE 36.0 /* horizontal aperture in written files, tenths of a unit, as in 35 mm photography */
#define FAR_PLANE 1e6         /* in written files, world units */
#define OP "xformOp:"

static int is_wanted(const char *name)
{
    static const char *const names[] = {"focalLength",
                                        "horizontalAperture",
                                        "verticalAperture",
                                        "horizontalApertureOffset",
                                        "verticalApertureOffset",
                                        "clippingRange",
                                        "projection",
                                        "xformOpOrder",
                                        "adcgs:size",
                                        "adcgs:time",
                                        "startTimeCode",
                                        "endTimeCode",
                                        "timeCodesPerSecond",
                                        "framesPerSecond"};
    for (size_t i = 0; i < ADCGS_COUNTOF(names); i++)
        if (!strcmp(name, names[i]))
            return 1;
    return !strncmp(name, OP, sizeof OP - 1);
}

/** The camera in a file, and the reader's input. */
typedef struct usd_camera {
    adcgs_usda file;
    int prim;
    const adcgs_path_reader *r;
} usd_camera;

/** Numbers of a property at a time; 0, with out unchanged, if their count is not n. */
static int get(const usd_camera *c, int prim, const char *name, double at, double *out, int n)
{
    double v[ADCGS_USDA_NUMBERS];
    const adcgs_usda_property *const property = adcgs_usda_find(&c->file, prim, name);
    if (!property || property->n != n)
        return 0;
    adcgs_usda_value(property, at, v);
    memcpy(out, v, (size_t)n * sizeof *out);
    return 1;
}

/* ---- Pose. Matrices here multiply column vectors, as ours do; USD's multiply row vectors. ---- */

typedef struct matrix {
    double m[4][4];
} matrix;

static const matrix unit = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};

static matrix multiply(const matrix *a, const matrix *b)
{
    matrix out = {{{0}}};
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            for (int k = 0; k < 4; k++)
                out.m[i][j] += a->m[i][k] * b->m[k][j];
    return out;
}

static matrix from_pose(const double pose[12])
{
    matrix out = unit;
    memcpy(out.m, pose, 12 * sizeof *pose);
    return out;
}

static adcgs_status refuse(const usd_camera *c, const char *name, const char *what)
{
    return adcgs_fail(c->r->error, ADCGS_ERR_UNSUPPORTED, "%s: %.60s: %s", c->r->path, name, what);
}

/** Parse rotateXYZ and the other orders, rotateX and so on; 0 for another name. */
static int rotation(const char *kind, size_t length, const double *v, int n, matrix *out)
{
    double degrees[3] = {0}, pose[12] = {0};
    char order[4] = "";
    if (strncmp(kind, "rotate", 6) || (length != 9 && length != 7))
        return 0;
    for (size_t i = 0; i < length - 6; i++)
        order[i] = (char)(kind[6 + i] - 'X' + 'x');
    if (length == 7 && n == 1 && order[0] >= 'x' && order[0] <= 'z') {
        degrees[order[0] - 'x'] = v[0];
        adcgs_euler_to_pose(degrees, ADCGS_ROTATION_XYZ, pose);
        *out = from_pose(pose);
        return 1;
    }
    for (int i = 0; adcgs_rotation_orders[i] && length == 9 && n == 3; i++)
        if (!strcmp(order, adcgs_rotation_orders[i])) {
            adcgs_euler_to_pose(v, (adcgs_rotation_order)i, pose);
            *out = from_pose(pose);
            return 1;
        }
    return 0;
}

/** Matrix of one operation of xformOpOrder. */
static adcgs_status operation(const usd_camera *c, int prim, const char *name, double at, matrix *out)
{
    const adcgs_usda_property *const property = adcgs_usda_find(&c->file, prim, name);
    double v[ADCGS_USDA_NUMBERS], pose[12] = {0};
    if (strncmp(name, OP, sizeof OP - 1))
        return refuse(c, name, "an operation that is not supported");
    if (!property || !property->n)
        return adcgs_fail(c->r->error, ADCGS_ERR_DATA, "%s: %.60s: named in xformOpOrder, but it has no value", c->r->path, name);
    const char *const kind = name + sizeof OP - 1;
    const size_t length = strcspn(kind, ":");
    const int n = property->n;
    adcgs_usda_value(property, at, v);
    *out = unit;
    if (!strncmp(kind, "transform", length) && n == 16)
        for (int i = 0; i < 16; i++)
            out->m[i % 4][i / 4] = v[i];
    else if (!strncmp(kind, "translate", length) && n == 3)
        for (int i = 0; i < 3; i++)
            out->m[i][3] = v[i];
    else if (!strncmp(kind, "scale", length) && n == 3)
        for (int i = 0; i < 3; i++)
            out->m[i][i] = v[i];
    else if (!strncmp(kind, "orient", length) && n == 4) {
        const double size = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + v[3] * v[3]);
        for (int i = 0; i < 4; i++)
            v[i] /= size > 0.0 ? size : 1.0;
        adcgs_rotation_to_pose(v, pose);
        *out = from_pose(pose);
    } else if (!rotation(kind, length, v, n, out))
        return refuse(c, name, "an operation that is not supported");
    return ADCGS_OK;
}

/** The product of a prim's operations; *alone: ignore its parents. */
static adcgs_status local_matrix(const usd_camera *c, int prim, double at, matrix *out, int *alone)
{
    const adcgs_usda_property *const order = adcgs_usda_find(&c->file, prim, "xformOpOrder");
    *out = unit;
    for (const char *line = order ? order->text : NULL; line && *line;) {
        char name[100];
        const size_t n = strcspn(line, "\n");
        matrix one;
        snprintf(name, sizeof name, "%.*s", (int)n, line);
        line += n + 1;
        if (!strcmp(name, "!resetXformStack!")) {
            *alone = 1;
            continue;
        }
        ADCGS_TRY(operation(c, prim, name, at, &one));
        *out = multiply(out, &one);
    }
    return ADCGS_OK;
}

static adcgs_status read_pose(const usd_camera *c, double at, adcgs_camera *camera)
{
    matrix all = unit, one;
    int alone = 0;
    for (int prim = c->prim; prim >= 0 && !alone; prim = c->file.prims[prim].parent) {
        ADCGS_TRY(local_matrix(c, prim, at, &one, &alone));
        all = multiply(&one, &all);
    }
    for (int j = 0; j < 3; j++) { /* a camera's scale has no effect */
        const double size = sqrt(all.m[0][j] * all.m[0][j] + all.m[1][j] * all.m[1][j] + all.m[2][j] * all.m[2][j]);
        for (int i = 0; i < 3; i++)
            all.m[i][j] /= size;
    }
    memcpy(camera->cam_to_world, all.m, sizeof camera->cam_to_world);
    const char *const wrong = adcgs_pose_from_opengl(camera->cam_to_world);
    return wrong ? adcgs_fail(c->r->error, ADCGS_ERR_DATA, "%s: the camera's pose at time code %g: %s", c->r->path, at, wrong)
                 : ADCGS_OK;
}

/* ---- Lens ---- */

static adcgs_status read_lens(const usd_camera *c, double at, adcgs_camera *camera)
{
    double focal = FOCAL, across = APERTURE, up = 0.0, right = 0.0, raised = 0.0, size[2], clip[2];
    get(c, c->prim, "focalLength", at, &focal, 1);
    get(c, c->prim, "horizontalAperture", at, &across, 1);
    get(c, c->prim, "horizontalApertureOffset", at, &right, 1);
    get(c, c->prim, "verticalApertureOffset", at, &raised, 1);
    if (get(c, c->prim, "adcgs:size", at, size, 2) && size[0] >= 1.0 && size[1] >= 1.0 && size[0] <= ADCGS_SIZE_MAX &&
        size[1] <= ADCGS_SIZE_MAX) {
        camera->width = (int32_t)size[0];
        camera->height = (int32_t)size[1];
        if (!get(c, c->prim, "verticalAperture", at, &up, 1))
            up = across * camera->height / camera->width;
    } else if (get(c, c->prim, "verticalAperture", at, &up, 1) && up > 0.0 && across > 0.0) /* pixels are square */
        camera->height = (int32_t)fmin(fmax(floor(camera->width * up / across + 0.5), 1.0), ADCGS_SIZE_MAX);
    else
        up = across * camera->height / camera->width;
    if (!(focal > 0.0 && across > 0.0 && up > 0.0))
        return adcgs_fail(c->r->error, ADCGS_ERR_DATA, "%s: a focal length of %g, apertures of %g and %g: expected more than 0",
                          c->r->path, focal, across, up);
    camera->fx = focal * camera->width / across;
    camera->fy = focal * camera->height / up;
    camera->cx = 0.5 * camera->width - right * camera->width / across;
    camera->cy = 0.5 * camera->height + raised * camera->height / up;
    if (get(c, c->prim, "clippingRange", at, clip, 2) && clip[0] > 0.0)
        camera->near_plane = clip[0];
    return ADCGS_OK;
}

/* ---- Time ---- */

/** The span of time codes, by default from the first sample to the last. */
static void find_span(const usd_camera *c, double *begin, double *end)
{
    *begin = INFINITY, *end = -INFINITY;
    for (int i = 0; i < c->file.n_properties; i++) {
        const adcgs_usda_property *const p = &c->file.properties[i];
        if (p->is_fixed || !p->n_samples)
            continue;
        *begin = fmin(*begin, p->samples[0].at);
        *end = fmax(*end, p->samples[p->n_samples - 1].at);
    }
    if (*begin > *end)
        *begin = *end = 0.0;
    get(c, -1, "startTimeCode", 0.0, begin, 1);
    get(c, -1, "endTimeCode", 0.0, end, 1);
    *end = fmax(*begin, *end);
}

static adcgs_status read_frames(adcgs_camera_path *out, const usd_camera *c)
{
    const adcgs_path_reader *const r = c->r;
    double begin, end, codes = CODES_A_SECOND;
    find_span(c, &begin, &end);
    get(c, -1, "timeCodesPerSecond", 0.0, &codes, 1);
    double rate = codes;
    get(c, -1, "framesPerSecond", 0.0, &rate, 1);
    if (!(codes >= 1e-3 && codes <= 1e6 && rate >= 1e-3 && rate <= 1e4))
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: %g time codes and %g frames in a second", r->path, codes, rate);
    ADCGS_TRY(adcgs_camera_path_alloc(out, floor((end - begin) / codes * rate + 1e-6) + 1.0, r->path, r->error));
    out->frame_rate = rate;
    for (int i = 0; i < out->n; i++) {
        adcgs_camera_frame *const frame = &out->frame[i];
        const double at = begin + i * codes / rate;
        frame->camera = *r->like;
        snprintf(frame->camera.name, sizeof frame->camera.name, "frame %d", i);
        frame->time = r->info->time_start + i / rate;
        get(c, c->prim, "adcgs:time", at, &frame->time, 1);
        if (r->request->has_times)
            frame->time = r->request->begin;
        ADCGS_TRY(read_lens(c, at, &frame->camera));
        ADCGS_TRY(read_pose(c, at, &frame->camera));
        const adcgs_camera *const first = &out->frame[0].camera;
        if (frame->camera.width != first->width || frame->camera.height != first->height)
            adcgs_camera_fit(&frame->camera, first->width, first->height, 0);
    }
    return ADCGS_OK;
}

adcgs_status adcgs_path_usd_read(adcgs_camera_path *out, const adcgs_path_reader *r)
{
    usd_camera c = {.prim = -1, .r = r};
    ADCGS_TRY(adcgs_usda_read(&c.file, r->path, is_wanted, r->error));
    for (int i = 0; i < c.file.n_prims && c.prim < 0; i++)
        if (!strcmp(c.file.prims[i].type, "Camera"))
            c.prim = i;
    const adcgs_usda_property *const kind = c.prim < 0 ? NULL : adcgs_usda_find(&c.file, c.prim, "projection");
    adcgs_status status = ADCGS_OK;
    if (c.prim < 0)
        status = adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: no prim of type Camera", r->path);
    else if (kind && kind->text && strcmp(kind->text, "perspective\n"))
        status = refuse(&c, "projection", "expected \"perspective\"");
    if (status == ADCGS_OK)
        status = read_frames(out, &c);
    adcgs_usda_free(&c.file);
    return status;
}

/* ---- Writing ---- */

/** Writes a property of a camera at one key. */
typedef void (*write_fn)(FILE *file, const adcgs_camera_key *key);

static double tenth(const adcgs_camera *c, double pixels) /* converts lengths along the width to tenths of a unit */
{
    return pixels * WRITTEN_APERTURE / c->width;
}

static double rows_of(const adcgs_camera *c) /* height in tenths of a unit, at the focal length of the width */
{
    return tenth(c, c->height) * c->fx / c->fy;
}

static void write_focal(FILE *file, const adcgs_camera_key *key)
{
    fprintf(file, "%.17g", tenth(&key->frame.camera, key->frame.camera.fx));
}

static void write_vertical(FILE *file, const adcgs_camera_key *key)
{
    fprintf(file, "%.17g", rows_of(&key->frame.camera));
}

static void write_right(FILE *file, const adcgs_camera_key *key)
{
    const adcgs_camera *const c = &key->frame.camera;
    fprintf(file, "%.17g", tenth(c, 0.5 * c->width - c->cx));
}

static void write_raised(FILE *file, const adcgs_camera_key *key)
{
    const adcgs_camera *const c = &key->frame.camera;
    fprintf(file, "%.17g", (c->cy - 0.5 * c->height) / c->height * rows_of(c));
}

static void write_time(FILE *file, const adcgs_camera_key *key)
{
    fprintf(file, "%.17g", key->frame.time);
}

static void write_transform(FILE *file, const adcgs_camera_key *key)
{
    double pose[12];
    memcpy(pose, key->frame.camera.cam_to_world, sizeof pose);
    adcgs_pose_other_axes(pose);
    for (int j = 0; j < 4; j++)
        fprintf(file, "%s(%.17g, %.17g, %.17g, %d)", j ? ", " : "(", pose[j], pose[4 + j], pose[8 + j], j == 3);
    fputc(')', file);
}

static void write_samples(FILE *file, const char *name, const adcgs_camera_key *keys, int n, double rate, write_fn write)
{
    fprintf(file, "    %s.timeSamples = {\n", name);
    for (int i = 0; i < n; i++) {
        fprintf(file, "        %.17g: ", (keys[i].at - keys[0].at) * rate + 1.0);
        write(file, &keys[i]);
        fputs(",\n", file);
    }
    fputs("    }\n", file);
}

adcgs_status adcgs_path_usd_write(const adcgs_camera_key *keys, int n, int has_times, double frame_rate, const adcgs_info *info,
                                  const char *path, adcgs_error *error)
{
    const adcgs_camera *const first = &keys[0].frame.camera;
    adcgs_atomic atomic;
    ADCGS_TRY(adcgs_atomic_open(&atomic, path, error));
    FILE *const f = atomic.file;
    fprintf(f, "#usda 1.0\n(\n    defaultPrim = \"camera\"\n    upAxis = \"%c\"\n", strstr(info->axes, "z up") ? 'Z' : 'Y');
    if (!strcmp(info->units, "metre"))
        fputs("    metersPerUnit = 1\n", f);
    fprintf(f, "    startTimeCode = 1\n    endTimeCode = %.17g\n", (keys[n - 1].at - keys[0].at) * frame_rate + 1.0);
    fprintf(f, "    timeCodesPerSecond = %.17g\n    framesPerSecond = %.17g\n)\n\n", frame_rate, frame_rate);
    fputs("def Camera \"camera\"\n{\n    token projection = \"perspective\"\n", f);
    fprintf(f, "    float2 clippingRange = (%.17g, %g)\n", first->near_plane, fmax(FAR_PLANE, 2.0 * first->near_plane));
    fprintf(f, "    float horizontalAperture = %g\n    custom int2 adcgs:size = (%d, %d)\n", WRITTEN_APERTURE, first->width,
            first->height);
    write_samples(f, "float verticalAperture", keys, n, frame_rate, write_vertical);
    write_samples(f, "float horizontalApertureOffset", keys, n, frame_rate, write_right);
    write_samples(f, "float verticalApertureOffset", keys, n, frame_rate, write_raised);
    write_samples(f, "float focalLength", keys, n, frame_rate, write_focal);
    if (has_times)
        write_samples(f, "custom double adcgs:time", keys, n, frame_rate, write_time);
    write_samples(f, "matrix4d xformOp:transform", keys, n, frame_rate, write_transform);
    fputs("    uniform token[] xformOpOrder = [\"xformOp:transform\"]\n}\n", f);
    return adcgs_atomic_commit(&atomic, error);
}
