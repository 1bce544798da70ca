/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A far wall and a moving square in front of it, both textured, seen by six static cameras. */
#ifndef ADCGS_TESTS_SQUARE_SCENE_H
#define ADCGS_TESTS_SQUARE_SCENE_H

#include "outside_files.h"

#include "grad/random.h"
#include "media/image/image.h"
#include "scene/scene.h"

#include <math.h>

enum { CAMERAS = 6, MOMENTS = 9, VIEWS = CAMERAS * MOMENTS, WIDTH = 96, HEIGHT = 72, FOCAL = 80 };
#define WALL 2.0
#define SQUARE 1.2
#define HALF 0.12 /* of the square */
#define SPEED 0.8 /* along x, per unit of time */

static double half_wide = HALF, half_high = HALF;
static adcgs_scene_view views[VIEWS];
static adcgs_scene scene = {.views = {views}, .n_views = {VIEWS}, .duration = 1, .n_times = MOMENTS, .rate = {MOMENTS - 1, 1}};

/** Smooth noise of cells of 0.1, of a colour channel of a surface. */
static double texture(double x, double y, uint64_t surface)
{
    const double u = x / 0.1 + 1000, v = y / 0.1 + 1000, a = u - floor(u), b = v - floor(v);
    double corner[4];
    for (int k = 0; k < 4; k++)
        corner[k] = adcgs_random_unit(1, surface, ((uint64_t)u + (k & 1)) << 20 | ((uint64_t)v + (uint64_t)(k >> 1)));
    return 0.1 + 0.8 * ((corner[0] * (1 - a) + corner[1] * a) * (1 - b) + (corner[2] * (1 - a) + corner[3] * a) * b);
}

static double square_at(double t)
{
    return SPEED * (t - 0.5);
}

static double colour_at(const adcgs_camera *c, double t, double px, double py, int channel)
{
    const double ray[2] = {(px - c->cx) / c->fx, (py - c->cy) / c->fy}, *m = c->cam_to_world;
    const double x = m[3] + SQUARE * ray[0] - square_at(t), y = m[7] + SQUARE * ray[1];
    return fabs(x) < half_wide && fabs(y) < half_high
               ? texture(x, y, 10 + (uint64_t)channel)
               : texture(m[3] + WALL * ray[0], m[7] + WALL * ray[1], 20 + (uint64_t)channel);
}

/** Writes the image of the view's camera at a time; NaN: the wall alone. */
static void put_picture(const adcgs_scene_view *v, double t)
{
    adcgs_image image;
    assert_int_equal(adcgs_image_alloc(&image, WIDTH, HEIGHT, 3, v->path, &error), ADCGS_OK);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        image.data[i] = (float)colour_at(&v->camera, t, i / 3 % WIDTH + 0.5, i / 3 / WIDTH + 0.5, i % 3);
    assert_int_equal(adcgs_image_write(&image, v->path, 0, &error), ADCGS_OK);
    adcgs_image_free(&image);
}

static void put_view(adcgs_scene_view *v, int camera, int moment)
{
    char name[32];
    v->time = moment / (MOMENTS - 1.0);
    v->camera =
        (adcgs_camera){.width = WIDTH,
                       .height = HEIGHT,
                       .fx = FOCAL,
                       .fy = FOCAL,
                       .cx = WIDTH / 2,
                       .cy = HEIGHT / 2,
                       .near_plane = 0.01,
                       .cam_to_world = {1, 0, 0, 0.15 * (camera % 3 - 1), 0, 1, 0, 0.15 * (camera / 3) - 0.075, 0, 0, 1, 0}};
    snprintf(name, sizeof name, "%d-%d.ppm", camera, moment);
    v->path = strdup(in(name));
    put_picture(v, v->time);
}

static int put_scene(void **state)
{
    if (make_folder(state) != 0)
        return -1;
    for (int i = 0; i < VIEWS; i++)
        put_view(&views[i], i / MOMENTS, i % MOMENTS);
    return 0;
}

static int remove_scene(void **state)
{
    for (int i = 0; i < VIEWS; i++)
        free(views[i].path);
    return remove_folder(state);
}

#endif
