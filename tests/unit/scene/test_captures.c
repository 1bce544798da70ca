/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Scenes as other users film them: camera places, alpha, exposures, shapes. */
#define _POSIX_C_SOURCE 200809L

#include "media/image/image.h"
#include "synthetic/scene_views.h"
#include "synthetic/scenes.h"
#include "synthetic/shapes.h"
#include "synthetic/texture.h"

#include "geometry/vector.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

enum { SIZE = 24, CAMERAS = 6 };

typedef struct axis {
    double eye[3], ahead[3];
    double time;
} axis;

static axis axis_of(const char *name, int split, int i)
{
    const adcgs_scenes_view v = adcgs_scenes_view_at(adcgs_scenes_entry_find(name), split, i, SIZE);
    axis out = {.time = v.time};
    for (int r = 0; r < 3; r++) {
        out.eye[r] = v.camera.to_world[4 * r + 3];
        out.ahead[r] = -v.camera.to_world[4 * r + 2];
    }
    return out;
}

static int views_of(const char *name, int split)
{
    return adcgs_scenes_split_size(adcgs_scenes_entry_find(name), split);
}

/* A point's distance along an axis and from it. */
static double along_axis(const axis *a, const double point[3], double *beside)
{
    double to[3];
    for (int r = 0; r < 3; r++)
        to[r] = point[r] - a->eye[r];
    const double along = adcgs_v3_dot(to, a->ahead);
    *beside = sqrt(fmax(adcgs_v3_dot(to, to) - along * along, 0.0));
    return along;
}

/* The point nearest to all axes lies behind every camera, all objects lie in front of it. */
static void axes_of_a_sweep_diverge(void **state)
{
    const adcgs_scenes_entry *const scene = adcgs_scenes_entry_find("sweep");
    const double focus[3] = {scene->target[0], scene->target[1] - scene->distance - 10.0, scene->target[2]};
    double beside;
    (void)state;
    for (int split = 0; split < ADCGS_SPLITS; split++)
        for (int i = 0; i < views_of("sweep", split); i++) {
            const axis a = axis_of("sweep", split, i);
            assert_true(along_axis(&a, focus, &beside) < -9.9);
            assert_true(beside < 1e-6);
            for (int k = 0; k < scene->n_objects; k++)
                assert_true(along_axis(&a, scene->objects[k].position, &beside) > 4.0);
        }
    assert_true(axis_of("sweep", ADCGS_SPLIT_TRAIN, 0).ahead[0] < -0.09);
    assert_true(axis_of("sweep", ADCGS_SPLIT_TRAIN, 39).ahead[0] > 0.09);
}

static void a_dome_is_seen_from_all_round(void **state)
{
    const adcgs_scenes_entry *const scene = adcgs_scenes_entry_find("dome");
    int octants[8] = {0}, below = 0;
    double beside;
    (void)state;
    for (int i = 0; i < views_of("dome", ADCGS_SPLIT_TRAIN); i++) {
        const axis a = axis_of("dome", ADCGS_SPLIT_TRAIN, i);
        assert_true(fabs(along_axis(&a, scene->target, &beside) - scene->distance) < 1e-6 && beside < 1e-6);
        octants[(a.ahead[0] > 0.0) + 2 * (a.ahead[1] > 0.0) + 4 * (fabs(a.ahead[0]) > fabs(a.ahead[1]))]++;
        below += a.ahead[2] > 0.1;
    }
    for (int k = 0; k < 8; k++)
        assert_true(octants[k] >= 5);
    assert_in_range(below, 6, 20);
}

static void test_shapes_of_other_paths(void **state)
{
    static const double room[3] = {0.0, 0.0, 1.35};
    double beside;
    (void)state;
    for (int split = 0; split < ADCGS_SPLITS; split++) {
        for (int i = 0; i < views_of("walk", split); i++) {
            const axis a = axis_of("walk", split, i);
            assert_true(along_axis(&a, room, &beside) < -0.6);
        }
        for (int i = 0; i < views_of("portrait", split); i++)
            assert_true(axis_of("portrait", split, i).ahead[1] > 0.96); /* within 30 degrees */
        for (int i = 0; i < views_of("tripod", split); i++) {
            const axis first = axis_of("tripod", ADCGS_SPLIT_TRAIN, 0), a = axis_of("tripod", split, i);
            assert_memory_equal(first.eye, a.eye, sizeof a.eye);
            assert_memory_equal(first.ahead, a.ahead, sizeof a.ahead);
        }
    }
    /* Three cameras at a time are side by side, and drive forward. */
    const axis left = axis_of("street", ADCGS_SPLIT_TRAIN, 0), right = axis_of("street", ADCGS_SPLIT_TRAIN, 2);
    const axis last = axis_of("street", ADCGS_SPLIT_TRAIN, views_of("street", ADCGS_SPLIT_TRAIN) - 1);
    assert_true(left.time == right.time && left.eye[1] == right.eye[1] && right.eye[0] - left.eye[0] > 0.9);
    assert_true(left.ahead[0] < -0.4 && right.ahead[0] > 0.4 && last.eye[1] - left.eye[1] > 7.9 && last.time == 1.0);
    /* Test views have times between those of training. */
    assert_true(fabs(axis_of("tripod", ADCGS_SPLIT_TEST, 3).time * 59.0 - 11.5) < 1e-9);
}

static void exposures_are_even(void **state)
{
    const adcgs_scenes_entry *const scene = adcgs_scenes_entry_find("dome");
    double sum = 0.0, least = 9.0, most = -9.0, step = 0.0;
    (void)state;
    for (int i = 0; i < scene->cameras; i++) {
        const double stops = adcgs_scenes_stops(scene, i);
        sum += stops;
        least = fmin(least, stops);
        most = fmax(most, stops);
        step += fabs(stops - adcgs_scenes_stops(scene, (i + 1) % scene->cameras)) / scene->cameras;
        assert_true(adcgs_scenes_stops(adcgs_scenes_entry_find("dome-even"), i) == 0.0);
    }
    assert_true(fabs(sum) < 1e-9 && least == -1.0 && most == 1.0 && step > 0.5);
    adcgs_scenes_entry one = *scene;
    one.cameras = 1;
    assert_true(adcgs_scenes_stops(&one, 0) == 0.0);
}

/* Image i of a split of a scene, six cameras, written to the folder. */
static adcgs_image image_of(const char *folder, const char *name, const char *split, int i)
{
    char path[512];
    const adcgs_scenes_options options = {.name = name, .width = SIZE, .height = SIZE, .cameras = CAMERAS};
    adcgs_image image;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    assert_int_equal(adcgs_scenes_write(path, &options, NULL, NULL, NULL, NULL), ADCGS_OK);
    snprintf(path, sizeof path, "%s/%s/%s/r_%03d.png", folder, name, split, i);
    assert_int_equal(adcgs_image_read(&image, path, NULL), ADCGS_OK);
    return image;
}

static void remove_folder(const char *folder)
{
    char command[128];
    snprintf(command, sizeof command, "rm -r '%s'", folder);
    assert_int_equal(system(command), 0);
}

/* Exposure changes straight colours up to white, never alpha; test views have none. */
static void alpha_is_real_and_exposure_leaves_it(void **state)
{
    char folder[] = "/tmp/adcgs-captures-XXXXXX";
    adcgs_scenes_entry scene = *adcgs_scenes_entry_find("dome");
    int inside = 0, edges = 0, outside = 0;
    (void)state;
    assert_non_null(mkdtemp(folder));
    scene.cameras = CAMERAS;
    for (int i = 0; i < CAMERAS; i++) {
        adcgs_image taken = image_of(folder, "dome", "train", i), truth = image_of(folder, "dome-even", "train", i);
        const float gain = (float)exp2(adcgs_scenes_stops(&scene, i));
        assert_true(taken.channels == 4 && truth.channels == 4);
        for (int p = 0; p < 4 * SIZE * SIZE; p += 4) {
            const float alpha = truth.data[p + 3];
            assert_true(taken.data[p + 3] == alpha);
            inside += alpha == 1.0f;
            outside += alpha == 0.0f;
            edges += alpha > 0.1f && alpha < 0.9f;
            for (int c = 0; c < 3 && alpha > 0.0f; c++)
                assert_true(fabsf(taken.data[p + c] - fminf(gain * truth.data[p + c], 1.0f)) < 0.6f / 255.0f * (1.0f + gain));
        }
        adcgs_image_free(&taken);
        adcgs_image_free(&truth);
    }
    assert_true(inside > 200 && edges > 100 && outside > 1000);
    adcgs_image tested = image_of(folder, "dome", "test", 1), even = image_of(folder, "dome-even", "test", 1);
    assert_memory_equal(tested.data, even.data, sizeof(float) * 4 * SIZE * SIZE);
    adcgs_image_free(&tested);
    adcgs_image_free(&even);
    remove_folder(folder);
}

/* The other two are the first one over black and over white. */
static void grounds_are_composited_after_exposure(void **state)
{
    static const char *const names[2] = {"dome-black", "dome-white"};
    char folder[] = "/tmp/adcgs-captures-XXXXXX";
    (void)state;
    assert_non_null(mkdtemp(folder));
    adcgs_image with = image_of(folder, "dome", "train", 2);
    for (int k = 0; k < 2; k++) {
        adcgs_image on = image_of(folder, names[k], "train", 2);
        assert_int_equal(on.channels, 3);
        for (int p = 0; p < SIZE * SIZE; p++)
            for (int c = 0; c < 3; c++) {
                const float alpha = with.data[4 * p + 3], want = alpha * with.data[4 * p + c] + (1.0f - alpha) * (float)k;
                assert_true(fabsf(on.data[3 * p + c] - want) < 2.0f / 255.0f);
            }
        adcgs_image_free(&on);
    }
    adcgs_image_free(&with);
    remove_folder(folder);
}

/* Frames of a static scene have no time, those of a video have one. */
static void static_scenes_have_no_times(void **state)
{
    static const char *const names[2] = {"sweep", "tripod"};
    (void)state;
    for (int k = 0; k < 2; k++) {
        char folder[] = "/tmp/adcgs-captures-XXXXXX", path[64], text[4096] = "";
        const adcgs_scenes_options options = {.name = names[k], .width = 4, .height = 4, .format = "ppm"};
        assert_non_null(mkdtemp(folder));
        assert_int_equal(adcgs_scenes_write(folder, &options, NULL, NULL, NULL, NULL), ADCGS_OK);
        snprintf(path, sizeof path, "%s/transforms_train.json", folder);
        FILE *const file = fopen(path, "r");
        assert_non_null(file);
        assert_true(fread(text, 1, sizeof text - 1, file) > 100);
        fclose(file);
        assert_int_equal(strstr(text, "\"time\"") != NULL, k);
        remove_folder(folder);
    }
}

/* Distance of a point from the centre line of a shape. */
static double off_line(const adcgs_trace_object *object, const double p[3])
{
    double best = 1e9, bow = object->shape == ADCGS_SHAPE_HAIR ? object->size[1] : 0.0;
    for (int k = 0; k <= 4000; k++) {
        /* Corners of the chain are every eighth of its length. */
        const double f = k / 2000.0 - 1.0, a = floor(4.0 * f) / 4.0, b = a + 0.25, share = (f - a) / 0.25;
        const double x = bow * ((1.0 - share) * (1.0 - a * a) + share * (1.0 - b * b)), z = object->size[2] * f;
        best = fmin(best, sqrt((p[0] - x) * (p[0] - x) + p[1] * p[1] + (p[2] - z) * (p[2] - z)));
    }
    return best;
}

/* Rays from outside meet capsules and hair at their radius, on the near side, within the bounding ball. */
static void thick_lines_are_where_they_should_be(void **state)
{
    static const adcgs_trace_object shapes[2] = {{.shape = ADCGS_SHAPE_CAPSULE, .size = {0.3, 0.0, 0.5}},
                                                 {.shape = ADCGS_SHAPE_HAIR, .size = {0.1, -0.4, 0.8}}};
    (void)state;
    for (int k = 0; k < 2; k++) {
        int met = 0;
        for (int i = 0; i < 200; i++) {
            double o[3], d[3], normal[3], p[3];
            for (int a = 0; a < 3; a++) {
                o[a] = 6.0 * (adcgs_texture_random(i, a, 0, 5u) - 0.5);
                d[a] = 1.4 * (adcgs_texture_random(i, a, 1, 5u) - 0.5) - o[a];
            }
            adcgs_v3_normalise(d);
            if (off_line(&shapes[k], o) <= shapes[k].size[0] + 0.01)
                continue;
            const double t = adcgs_shapes_hit(&shapes[k], o, d, normal);
            if (t >= ADCGS_SHAPES_FAR)
                continue;
            for (int a = 0; a < 3; a++)
                p[a] = o[a] + t * d[a];
            assert_true(fabs(off_line(&shapes[k], p) - shapes[k].size[0]) < 1e-3);
            assert_true(adcgs_v3_dot(normal, d) < 0.0 && fabs(adcgs_v3_dot(normal, normal) - 1.0) < 1e-9);
            assert_true(adcgs_v3_dot(p, p) <= adcgs_shapes_bound2(&shapes[k]) + 1e-9);
            met++;
        }
        assert_true(met > 25);
    }
}

static void a_room_is_seen_from_inside(void **state)
{
    static const adcgs_trace_object room = {.shape = ADCGS_SHAPE_ROOM, .size = {3.0, 2.0, 1.0}};
    static const double eye[3] = {1.0, 0.5, 0.0}, ahead[3] = {-1.0, 0.0, 0.0}, up[3] = {0.0, 0.6, 0.8};
    double normal[3];
    (void)state;
    assert_true(fabs(adcgs_shapes_hit(&room, eye, ahead, normal) - 4.0) < 1e-12 && normal[0] == 1.0);
    assert_true(fabs(adcgs_shapes_hit(&room, eye, up, normal) - 1.25) < 1e-12 && normal[2] == -1.0);
}

static void wrong_wishes_are_refused(void **state)
{
    static const struct {
        adcgs_scenes_options options;
        const char *text;
    } wrong[] = {{{.name = "dome", .format = "ppm"}, "expected png"},
                 {{.name = "tripod", .cameras = 2}, "one camera"},
                 {{.name = "walk", .watch = 5}, "not on an arc"},
                 {{.name = "sweep", .aside = 0.1}, "not on an arc"}};
    adcgs_error error;
    (void)state;
    for (size_t i = 0; i < ADCGS_COUNTOF(wrong); i++) {
        assert_int_equal(adcgs_scenes_write("/nowhere", &wrong[i].options, NULL, NULL, NULL, &error), ADCGS_ERR_USAGE);
        assert_non_null(strstr(error.text, wrong[i].text));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(axes_of_a_sweep_diverge),
        cmocka_unit_test(a_dome_is_seen_from_all_round),
        cmocka_unit_test(test_shapes_of_other_paths),
        cmocka_unit_test(exposures_are_even),
        cmocka_unit_test(alpha_is_real_and_exposure_leaves_it),
        cmocka_unit_test(grounds_are_composited_after_exposure),
        cmocka_unit_test(static_scenes_have_no_times),
        cmocka_unit_test(thick_lines_are_where_they_should_be),
        cmocka_unit_test(a_room_is_seen_from_inside),
        cmocka_unit_test(wrong_wishes_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
