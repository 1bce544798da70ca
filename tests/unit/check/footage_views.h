/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Synthetic footage as thumbnail statistics of images, and the faults found in it. */
#ifndef ADCGS_TESTS_FOOTAGE_VIEWS_H
#define ADCGS_TESTS_FOOTAGE_VIEWS_H

#include "check/faults.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

enum { CAMERAS = 6, MOMENTS = 48, MOST = CAMERAS * MOMENTS, SEEDS = 100 };

static adcgs_error error;

/* The recorded footage. A view's path is its number. */
static struct {
    uint32_t n;
    adcgs_scene_view views[MOST];
    adcgs_thumbnail thumbnails[MOST];
    char names[MOST][8];
} film;

static uint32_t random_state;

static inline double draw(void)
{
    random_state = random_state * 1664525u + 1013904223u;
    return (double)(random_state >> 8) / 16777216.0;
}

/* An image by a camera, in shades of its own (0.3 to 0.6, made brighter by the last argument) and plain tints. */
static inline adcgs_thumbnail *add_view(int camera, double time, double brighter)
{
    adcgs_scene_view *const view = &film.views[film.n];
    adcgs_thumbnail *const thumbnail = &film.thumbnails[film.n];
    assert_true(film.n < MOST);
    snprintf(film.names[film.n], sizeof film.names[0], "%u", film.n);
    *view =
        (adcgs_scene_view){.camera = {.width = 64, .height = 64, .fx = 50.0 + camera}, .time = time, .path = film.names[film.n]};
    for (int i = 0; i < ADCGS_THUMBNAIL_CELLS; i++)
        thumbnail->cells[i] = (float)(0.3 + 0.3 * ((i * (camera + 7) * 37) % 101) / 101.0 + brighter);
    for (int i = 0; i < ADCGS_THUMBNAIL_TINTS; i++)
        thumbnail->tints[0][i] = thumbnail->tints[1][i] = 0.01f * (float)(i % 10);
    film.n++;
    return thumbnail;
}

static inline void begin(void)
{
    film.n = 0;
}

static inline adcgs_fault find(char which)
{
    adcgs_fault fault = {.cameras = 99};
    adcgs_camera_order tracks;
    adcgs_status status = ADCGS_OK;
    adcgs_scene scene = {.directory = "here", .views = {film.views}, .n_views = {film.n}};
    assert_int_equal(adcgs_camera_order_find(&tracks, film.views, film.n, &error), ADCGS_OK);
    switch (which) {
    case 'g':
        status = adcgs_fault_gaps(&fault, &scene, &error);
        break;
    case 'd':
        adcgs_fault_duplicates(&fault, NULL, film.views, &tracks, film.thumbnails);
        break;
    case 'x':
        status = adcgs_fault_copied(&fault, film.views, &tracks, film.thumbnails, &error);
        break;
    case 'l':
        status = adcgs_fault_light(&fault, NULL, film.views, &tracks, film.thumbnails, &error);
        break;
    default:
        status = adcgs_fault_clocks(&fault, film.views, &tracks, film.thumbnails, &error);
        break;
    }
    assert_int_equal(status, ADCGS_OK);
    assert_true(fault.cameras <= fault.of && isfinite(fault.from) && isfinite(fault.to) && isfinite(fault.size));
    adcgs_camera_order_clear(&tracks);
    return fault;
}

static const char all[] = "gdxlc";

static inline void expect_silence(const char *which)
{
    for (; *which; which++) {
        const adcgs_fault fault = find(*which);
        if (fault.cameras)
            print_error("fault '%c' at view %s, time %g, size %g\n", *which, fault.path ? fault.path : "-", fault.to, fault.size);
        assert_int_equal(fault.cameras, 0);
    }
}

#endif
