/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Footage that grows while it is read, in a separate folder, and its segments. */
#ifndef ADCGS_TESTS_LIVE_FOOTAGE_H
#define ADCGS_TESTS_LIVE_FOOTAGE_H

#include "media/image/image.h"
#include "scene/live/live_scene.h"

#include <adcgs/adcgs.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmocka.h>

enum { CAMERAS = 2, FRAMES = 12, SEGMENTS = 4 };

static adcgs_error error;
static char folder[] = "/tmp/adcgs-test-live-XXXXXX";
static int interrupted;

static inline int is_interrupted(void)
{
    return interrupted;
}

static inline const char *in_folder(const char *format, int camera, int frame)
{
    static char path[128], name[64];
    snprintf(name, sizeof name, format, camera, frame);
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static inline void put(int camera, int frame)
{
    float pixels[3 * 16] = {0};
    const adcgs_image image = {4, 4, 3, pixels};
    pixels[0] = (float)frame / FRAMES;
    assert_int_equal(adcgs_image_write(&image, in_folder("c%d-%02d.ppm", camera, frame), 0, &error), ADCGS_OK);
}

static inline void put_end(void)
{
    FILE *file = fopen(in_folder("end", 0, 0), "wb");
    assert_non_null(file);
    fclose(file);
}

static inline void start_again(void)
{
    for (int c = 0; c < CAMERAS; c++)
        for (int i = 0; i < FRAMES; i++)
            unlink(in_folder("c%d-%02d.ppm", c, i));
    unlink(in_folder("end", 0, 0));
    interrupted = 0;
}

/** Two cameras of ten frames a second; the second is half a frame later. */
static inline int set_up(void **state)
{
    static const char text[] =
        "{\"adcgs_scene\": 1, \"frame_rate\": 10, \"up\": \"y\", \"defaults\": {\"width\": 4, \"height\": 4, \"fx\": 4},"
        "\"cameras\": [{\"name\": \"a\", \"images\": \"c0-%02d.ppm\", \"time_offset\": 3, \"R\": [[1,0,0],[0,1,0],[0,0,1]], "
        "\"t\": [0,0,2]}, {\"name\": \"b\", \"images\": \"c1-%02d.ppm\", \"time_offset\": 3.05, "
        "\"R\": [[1,0,0],[0,1,0],[0,0,1]], \"t\": [1,0,2]}, {\"name\": \"c\", \"images\": \"none-%02d.ppm\", \"split\": \"test\","
        "\"R\": [[1,0,0],[0,1,0],[0,0,1]], \"t\": [1,0,3]}]}";
    (void)state;
    if (!mkdtemp(folder))
        return -1;
    FILE *file = fopen(in_folder("scene.json", 0, 0), "wb");
    return file && fputs(text, file) >= 0 && !fclose(file) ? 0 : -1;
}

static inline int tear_down(void **state)
{
    (void)state;
    start_again();
    unlink(in_folder("scene.json", 0, 0));
    return rmdir(folder);
}

static inline adcgs_live *open_live(double seconds, int unbounded)
{
    adcgs_live *live = NULL;
    const adcgs_live_options options = {.seconds = seconds, .unbounded = unbounded, .interrupted = is_interrupted};
    assert_int_equal(adcgs_live_open(&live, folder, &options, &error), ADCGS_OK);
    return live;
}

/** Expects a segment of this span with so many views, whose times ascend for each camera. */
static inline void expect_segment(adcgs_live *live, adcgs_live_segment *s, double begin, double end, uint32_t views,
                                  uint32_t moments)
{
    assert_int_equal(adcgs_live_next(live, s, &error), ADCGS_OK);
    assert_non_null(s->scene);
    assert_float_equal(s->begin, begin, 1e-6);
    assert_float_equal(s->end, end, 1e-6);
    assert_float_equal(s->scene->duration, end - begin, 1e-6);
    assert_int_equal(s->scene->n_views[ADCGS_SPLIT_TRAIN], views);
    assert_int_equal(s->scene->n_times, moments);
    assert_ptr_equal(s->scene->whole, adcgs_live_whole(live));
    for (uint32_t i = 0; i < views; i++) {
        const adcgs_scene_view *v = &s->scene->views[ADCGS_SPLIT_TRAIN][i];
        const int camera = v->camera.name[0] - 'a', frame = (int)((s->begin + v->time - (camera ? 0.05 : 0)) * 10 + 0.5);
        assert_true(v->time >= 0 && v->time <= s->scene->duration);
        assert_string_equal(v->path, in_folder("c%d-%02d.ppm", camera, frame));
        assert_true(v->camera.near_plane > 0);
    }
}

static inline void expect_over(adcgs_live *live, adcgs_live_segment *s)
{
    assert_int_equal(adcgs_live_next(live, s, &error), ADCGS_OK);
    assert_null(s->scene);
}

#endif
