/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Poses of objects at a time, rays among them, and shading of the surfaces that rays hit. */
#include "synthetic/trace.h"

#include "geometry/rotation.h"
#include "synthetic/shapes.h"
#include "synthetic/sine.h"
#include "synthetic/texture.h"

#include <math.h>

#define SAMPLES_MAX 8 /* rays along a side of a pixel; chosen by hand */
#define DEPTH_MAX 6   /* limit of surfaces on a ray's path: transparent or mirroring ones, and the last */

/* An object at one time. */
typedef struct pose {
    double centre[3];
    double axes[9];    /* rows are the local axes in the world */
    double stretch[3]; /* along these axes */
    double slide[3];   /* displacement of its texture */
    double fade;
    double bound2; /* squared radius of a ball around it; negative: absent or invisible */
    int shines;    /* nonzero: a lamp */
} pose;

typedef struct job {
    const adcgs_trace_object *objects;
    const pose *poses;
    int n, width, height, samples;
    const adcgs_trace_camera *camera;
    double light[SAMPLES_MAX * SAMPLES_MAX][3];
    uint32_t which; /* objects whose coverage is requested */
    float *out;     /* colours or coverage */
} job;

typedef struct hit {
    double t;
    int object;
    double painted[3], normal[3]; /* texture coordinates; normal in local axes, not turned towards the ray */
} hit;

void adcgs_trace_look(adcgs_trace_camera *camera, const double eye[3], const double target[3])
{
    static const double up[3] = {0.0, 0.0, 1.0};
    adcgs_look_at(camera->to_world, eye, target, up);
    adcgs_pose_other_axes(camera->to_world);
}

/* Turns a vector about a unit axis. */
static void rotate(double v[3], const double axis[3], double turns)
{
    adcgs_v3_rotate(axis, adcgs_trace_sin(turns), adcgs_trace_cos(turns), v);
}

/* Triangle wave, 0 to 1 and back: 0 at whole numbers, 1 halfway between them. */
static double there_and_back(double x)
{
    const double f = 2.0 * (x - (double)(int)x);
    return f <= 1.0 ? f : 2.0 - f;
}

static void pose_at(pose *out, const adcgs_trace_object *o, double time)
{
    static const double x_axis[3] = {1.0, 0.0, 0.0}, z_axis[3] = {0.0, 0.0, 1.0};
    for (int a = 0; a < 3; a++) {
        double *const axis = out->axes + 3 * a;
        for (int i = 0; i < 3; i++)
            axis[i] = a == i ? 1.0 : 0.0;
        rotate(axis, x_axis, o->tilt);
        if (o->turn != 0.0)
            rotate(axis, z_axis, o->turn);
        rotate(axis, o->spin_axis, o->spin * time);
        out->centre[a] = o->position[a] + o->velocity[a] * time + o->zigzag[a] * there_and_back(o->zigs * time);
        out->slide[a] = o->slide[a] * time;
    }
    if (o->bounces > 0.0) {
        const double phase = o->bounces * time, f = phase - (double)(int)phase;
        out->centre[2] += o->bounce_height * 4.0 * f * (1.0 - f);
    }
    if (o->orbit_turns != 0.0) {
        const double s = adcgs_trace_sin(o->orbit_turns * time), c = adcgs_trace_cos(o->orbit_turns * time);
        const double dx = out->centre[0] - o->orbit[0], dy = out->centre[1] - o->orbit[1];
        out->centre[0] = o->orbit[0] + c * dx - s * dy;
        out->centre[1] = o->orbit[1] + s * dx + c * dy;
    }
    double longest = 1.0;
    for (int a = 0; a < 3; a++) {
        out->stretch[a] = 1.0 + o->stretch[a] * adcgs_trace_sin(o->beats * time);
        longest = ADCGS_MAX(longest, out->stretch[a]);
    }
    out->fade = time * time * (3.0 - 2.0 * time);
    const int is_there = time >= o->from && (o->until == 0.0 || time < o->until), is_lamp = o->shape == ADCGS_SHAPE_LAMP;
    out->bound2 = !is_there || is_lamp ? -1.0 : longest * longest * adcgs_shapes_bound2(o);
    out->shines = is_there && is_lamp;
}

/* True if the ray passes through the ball around the object, in front of the ray's origin. */
static int near_object(const pose *at, const double from[3], const double direction[3])
{
    double to[3];
    for (int i = 0; i < 3; i++)
        to[i] = at->centre[i] - from[i];
    const double along = adcgs_v3_dot(to, direction), d2 = adcgs_v3_dot(to, to);
    return d2 < at->bound2 || (along > 0.0 && d2 - along * along < at->bound2);
}

/* Converts to the axes of the undeformed object, which undoes stretching. */
static void to_local(const pose *at, const double v[3], double out[3])
{
    for (int a = 0; a < 3; a++)
        out[a] = adcgs_v3_dot(at->axes + 3 * a, v) / at->stretch[a];
}

static double hit_object(const job *j, int i, const double from[3], const double direction[3], hit *out)
{
    const pose *const at = &j->poses[i];
    double relative[3], o[3], d[3], normal[3] = {0.0, 0.0, 1.0};
    for (int a = 0; a < 3; a++)
        relative[a] = from[a] - at->centre[a];
    to_local(at, relative, o);
    to_local(at, direction, d);
    const double t = adcgs_shapes_hit(&j->objects[i], o, d, normal);
    if (t < out->t) {
        out->t = t;
        out->object = i;
        for (int a = 0; a < 3; a++) {
            out->painted[a] = o[a] + t * d[a] - at->slide[a];
            out->normal[a] = normal[a] / at->stretch[a];
        }
        adcgs_v3_normalise(out->normal);
    }
    return t;
}

static int casts_shadow(const adcgs_trace_object *object)
{
    return object->shape < ADCGS_SHAPE_FLOOR && !object->glows && object->clear < 0.5;
}

static int in_shadow(const job *j, const double point[3], const double light[3])
{
    for (int i = 0; i < j->n; i++) {
        hit h = {.t = ADCGS_SHAPES_FAR};
        if (casts_shadow(&j->objects[i]) && near_object(&j->poses[i], point, light) &&
            hit_object(j, i, point, light, &h) < ADCGS_SHAPES_FAR)
            return 1;
    }
    return 0;
}

static void surface_colour(const job *j, const hit *h, double colour[3])
{
    const adcgs_trace_object *const o = &j->objects[h->object];
    const double mix = adcgs_texture_mix(o, h->painted);
    const double fine[3] = {h->painted[0] * 9.0, h->painted[1] * 9.0, h->painted[2] * 9.0};
    const double grain = o->detail > 0.0 ? 1.0 + o->detail * (adcgs_texture_noise(fine, o->seed + 77u) - 0.5) : 1.0;
    for (int c = 0; c < 3; c++)
        colour[c] = (o->colour[0][c] + (o->colour[1][c] - o->colour[0][c]) * mix + o->fade[c] * j->poses[h->object].fade) * grain;
}

/* Light from a lamp on a surface that faces it. */
static double lamp_light(const adcgs_trace_object *lamp, const pose *at, const double point[3], const double normal[3])
{
    double to[3], square = 0.0;
    for (int i = 0; i < 3; i++) {
        to[i] = at->centre[i] - point[i];
        square += to[i] * to[i];
    }
    const double facing = adcgs_v3_dot(to, normal);
    const double share = square / (lamp->size[0] * lamp->size[0]);
    return facing > 0.0 ? 0.45 * facing / sqrt(square) / (1.0 + share * share) : 0.0;
}

/* The normal of a hit in world axes. */
static void turn_normal(const job *j, const hit *h, double normal[3])
{
    const pose *const at = &j->poses[h->object];
    for (int i = 0; i < 3; i++)
        normal[i] = at->axes[i] * h->normal[0] + at->axes[3 + i] * h->normal[1] + at->axes[6 + i] * h->normal[2];
}

static void shade(const job *j, const hit *h, const double from[3], const double direction[3], int sample, double colour[3])
{
    static const double fill[3] = {-0.64, -0.48, 0.6};
    surface_colour(j, h, colour);
    if (j->objects[h->object].shape == ADCGS_SHAPE_DOME || j->objects[h->object].glows)
        return;
    const double *const light = j->light[sample];
    double normal[3], point[3];
    turn_normal(j, h, normal);
    for (int i = 0; i < 3; i++)
        point[i] = from[i] + h->t * direction[i] + 1e-6 * normal[i];
    const double key = adcgs_v3_dot(normal, light), side = adcgs_v3_dot(normal, fill);
    double level = 0.42 + 0.10 * normal[2] + (side > 0.0 ? 0.12 * side : 0.0);
    if (key > 0.0 && !in_shadow(j, point, light))
        level += 0.48 * key;
    for (int i = 0; i < j->n; i++)
        if (j->poses[i].shines)
            level += lamp_light(&j->objects[i], &j->poses[i], point, normal);
    for (int c = 0; c < 3; c++)
        colour[c] *= level;
}

static hit trace_ray(const job *j, const double from[3], const double direction[3])
{
    hit nearest = {.t = ADCGS_SHAPES_FAR};
    for (int i = 0; i < j->n; i++)
        if (near_object(&j->poses[i], from, direction))
            hit_object(j, i, from, direction, &nearest);
    return nearest;
}

/* The ray of sample k of pixel (x, y). */
static void aim(const job *j, int x, int y, int k, double direction[3])
{
    const double *const m = j->camera->to_world;
    const int s = j->samples;
    const double u = (x + (k % s + 0.5) / s - 0.5 * j->width) / j->camera->focal;
    const double v = (0.5 * j->height - y - (k / s + 0.5) / s) / j->camera->focal;
    for (int i = 0; i < 3; i++)
        direction[i] = m[4 * i] * u + m[4 * i + 1] * v - m[4 * i + 2];
    adcgs_v3_normalise(direction);
}

/* Transparency of a flame: smooth, with clear edges of its tongues. */
static double gaps_of_flame(double mix)
{
    const double x = (0.62 - mix) / 0.24;
    return x <= 0.0 ? 0.0 : x >= 1.0 ? 1.0 : x;
}

/* Continues a ray through a transparent surface or from a mirror. Returns the share of light that arrives along it. */
static double go_on(const job *j, const hit *h, double from[3], double direction[3])
{
    const adcgs_trace_object *const o = &j->objects[h->object];
    const double through = o->glows ? gaps_of_flame(adcgs_texture_mix(o, h->painted)) : o->clear;
    double normal[3];
    for (int i = 0; i < 3; i++)
        from[i] += (h->t + (o->mirror > 0.0 ? 0.0 : 1e-6)) * direction[i];
    if (o->mirror == 0.0)
        return through;
    turn_normal(j, h, normal);
    const double along = adcgs_v3_dot(direction, normal);
    for (int i = 0; i < 3; i++) {
        from[i] += 1e-6 * normal[i];
        direction[i] -= 2.0 * along * normal[i];
    }
    return o->mirror;
}

static void trace_colour(const job *j, const double eye[3], const double towards[3], int sample, double colour[3])
{
    double from[3] = {eye[0], eye[1], eye[2]}, direction[3] = {towards[0], towards[1], towards[2]}, weight = 1.0;
    for (int depth = 0; depth < DEPTH_MAX && weight > 0.0; depth++) {
        const hit nearest = trace_ray(j, from, direction);
        double own[3];
        if (nearest.t >= ADCGS_SHAPES_FAR)
            return;
        shade(j, &nearest, from, direction, sample, own);
        const double share = go_on(j, &nearest, from, direction);
        for (int c = 0; c < 3; c++)
            colour[c] += weight * (1.0 - share) * own[c];
        weight *= share;
    }
}

static void colour_row(void *arg, int y, int thread)
{
    const job *const j = arg;
    const double *const m = j->camera->to_world, eye[3] = {m[3], m[7], m[11]};
    const int s = j->samples;
    (void)thread;
    for (int x = 0; x < j->width; x++) {
        double sum[3] = {0.0, 0.0, 0.0};
        for (int k = 0; k < s * s; k++) {
            double direction[3], colour[3] = {0.0, 0.0, 0.0};
            aim(j, x, y, k, direction);
            trace_colour(j, eye, direction, k, colour);
            for (int c = 0; c < 3; c++)
                sum[c] += colour[c];
        }
        float *const pixel = j->out + 3 * ((size_t)y * (size_t)j->width + (size_t)x);
        for (int c = 0; c < 3; c++) {
            const double mean = sum[c] / (s * s);
            pixel[c] = (float)(mean < 0.0 ? 0.0 : mean > 1.0 ? 1.0 : mean);
        }
    }
}

static void alpha_row(void *arg, int y, int thread)
{
    const job *const j = arg;
    const double *const m = j->camera->to_world, eye[3] = {m[3], m[7], m[11]};
    const int samples = j->samples * j->samples;
    (void)thread;
    for (int x = 0; x < j->width; x++) {
        int met = 0;
        for (int k = 0; k < samples; k++) {
            double direction[3];
            aim(j, x, y, k, direction);
            met += trace_ray(j, eye, direction).t < ADCGS_SHAPES_FAR;
        }
        j->out[(size_t)y * (size_t)j->width + (size_t)x] = (float)met / (float)samples;
    }
}

static void cover_row(void *arg, int y, int thread)
{
    const job *const j = arg;
    const double *const m = j->camera->to_world, eye[3] = {m[3], m[7], m[11]};
    const int samples = j->samples * j->samples;
    (void)thread;
    for (int x = 0; x < j->width; x++) {
        int covered = 0;
        for (int k = 0; k < samples; k++) {
            double direction[3];
            aim(j, x, y, k, direction);
            const hit nearest = trace_ray(j, eye, direction);
            covered += nearest.t < ADCGS_SHAPES_FAR && (j->which >> nearest.object & 1);
        }
        j->out[(size_t)y * (size_t)j->width + (size_t)x] = 2 * covered >= samples ? 1.0f : 0.0f;
    }
}

/* A disc of light directions, one per sample of a pixel: shadows have a soft edge that is the same from every viewpoint. */
static void spread_light(job *j)
{
    const int s = j->samples;
    for (int k = 0; k < s * s; k++) {
        double *const light = j->light[k];
        light[0] = 0.42 + 0.16 * ((k % s + 0.5) / s - 0.5);
        light[1] = -0.30 + 0.16 * ((k / s + 0.5) / s - 0.5);
        light[2] = 0.86;
        adcgs_v3_normalise(light);
    }
}

static adcgs_status trace(job *j, double time, adcgs_pool *pool, adcgs_work_fn row, adcgs_error *error)
{
    if (j->samples < 1 || j->samples > SAMPLES_MAX)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "ray tracer: %d samples, expected 1..%d", j->samples, SAMPLES_MAX);
    pose *const poses = adcgs_alloc(NULL, (size_t)j->n, sizeof *poses, error);
    if (!poses)
        return adcgs_alloc_status(error);
    for (int i = 0; i < j->n; i++)
        pose_at(&poses[i], &j->objects[i], time);
    j->poses = poses;
    spread_light(j);
    adcgs_pool_run(pool, row, j, j->height);
    adcgs_free(NULL, poses);
    return ADCGS_OK;
}

adcgs_status adcgs_trace_render(const adcgs_trace_object *objects, int n, const adcgs_trace_camera *camera, double time,
                                int width, int height, int samples, adcgs_pool *pool, float *rgb, adcgs_error *error)
{
    job j = {.objects = objects, .n = n, .width = width, .height = height, .samples = samples, .camera = camera, .out = rgb};
    return trace(&j, time, pool, colour_row, error);
}

adcgs_status adcgs_trace_alpha(const adcgs_trace_object *objects, int n, const adcgs_trace_camera *camera, double time, int width,
                               int height, int samples, adcgs_pool *pool, float *alpha, adcgs_error *error)
{
    job j = {.objects = objects, .n = n, .width = width, .height = height, .samples = samples, .camera = camera, .out = alpha};
    return trace(&j, time, pool, alpha_row, error);
}

adcgs_status adcgs_trace_cover(const adcgs_trace_object *objects, int n, uint32_t which, const adcgs_trace_camera *camera,
                               double time, int width, int height, int samples, adcgs_pool *pool, float *cover,
                               adcgs_error *error)
{
    job j = {.objects = objects,
             .n = n,
             .width = width,
             .height = height,
             .samples = samples,
             .camera = camera,
             .which = which,
             .out = cover};
    return trace(&j, time, pool, cover_row, error);
}
