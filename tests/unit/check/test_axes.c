/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The check for poses in another convention than stated: for a ball with cameras around it and a room with cameras looking out,
 * by points, by images and by camera positions. Correct scenes cause no report.
 */
#include "outside_files.h"

#include "ball.h"

#include "check/axes.h"

#include <math.h>

enum { CAMERAS = 12, SIDE = 72, POINTS = 400 };

static adcgs_scene scene;
static adcgs_scene_view views[CAMERAS];
static char names[CAMERAS][300];
static double positions[POINTS][3];

/** The image of a sphere of radius 1 about the middle: its near side from outside, the wall from inside. */
static void put_picture(const char *name, const adcgs_camera *c)
{
    adcgs_image image;
    const double *m = c->cam_to_world;
    assert_int_equal(adcgs_image_alloc(&image, SIDE, SIDE, 3, name, &error), ADCGS_OK);
    for (int i = 0; i < SIDE * SIDE; i++) {
        const double d[3] = {(i % SIDE + 0.5 - c->cx) / c->fx, (i / SIDE + 0.5 - c->cy) / c->fy, 1.0};
        double w[3], x[3];
        for (int a = 0; a < 3; a++)
            w[a] = m[4 * a] * d[0] + m[4 * a + 1] * d[1] + m[4 * a + 2] * d[2];
        const int hits = ball_hit((const double[]){m[3], m[7], m[11]}, w, x) > 0.0;
        for (int k = 0; k < 3; k++)
            image.data[3 * i + k] = hits ? (float)ball_shows(x, (uint32_t)k) : 0.5f;
    }
    assert_int_equal(adcgs_image_write(&image, name, 0, &error), ADCGS_OK);
    adcgs_image_free(&image);
}

/** Cameras on an arc of a radius about the middle, above it. From outside they look at the middle, from inside away from it. */
static void make_scene(double radius, double degrees)
{
    for (int i = 0; i < CAMERAS; i++) {
        const double a = degrees * (i - 0.5 * (CAMERAS - 1)) / (CAMERAS - 1) * M_PI / 180.0, look = radius > 1.0 ? -1.0 : 1.0;
        const double z[3] = {look * cos(a), look * sin(a), 0.0}, down[3] = {0.0, 0.0, -1.0};
        adcgs_camera *c = &views[i].camera;
        *c = (adcgs_camera){.width = SIDE,
                            .height = SIDE,
                            .fx = radius > 1.0 ? 1.6 * SIDE : 0.6 * SIDE,
                            .cx = 0.5 * SIDE,
                            .cy = 0.5 * SIDE};
        c->fy = c->fx;
        for (int k = 0; k < 3; k++) {
            c->cam_to_world[4 * k] = down[(k + 1) % 3] * z[(k + 2) % 3] - down[(k + 2) % 3] * z[(k + 1) % 3];
            c->cam_to_world[4 * k + 1] = down[k];
            c->cam_to_world[4 * k + 2] = z[k];
            c->cam_to_world[4 * k + 3] = k < 2 ? radius * look * z[k] : 0.1;
        }
        snprintf(names[i], sizeof names[i], "%s/%d.ppm", folder, i);
        put_picture(names[i], c);
        views[i].path = names[i];
    }
    scene = (adcgs_scene){.directory = folder, .n_views = {CAMERAS}, .views = {views}, .n_times = 1};
}

static void add_points(void)
{
    for (int i = 0; i < POINTS; i++) {
        const double z = 2.0 * (i + 0.5) / POINTS - 1.0, a = 2.4 * i, r = sqrt(1.0 - z * z);
        positions[i][0] = r * cos(a);
        positions[i][1] = r * sin(a);
        positions[i][2] = z;
    }
    scene.points.n = POINTS;
    scene.points.position = positions;
}

/** Writes the poses in another convention. */
static void write_otherwise(adcgs_axes_reading reading)
{
    for (int i = 0; i < CAMERAS; i++) {
        const int turned = reading == ADCGS_READ_TURNED || reading == ADCGS_READ_INVERSE_OPENGL;
        const double sign = turned ? -1.0 : 1.0; /* inverted, in axes of OpenGL: of y and z, in the world and in the camera */
        double *p = views[i].camera.cam_to_world, q[12];
        memcpy(q, p, sizeof q);
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 3; c++)
                if (reading < ADCGS_READ_INVERSE)
                    p[4 * r + c] = (c ? sign : 1.0) * q[4 * r + c];
                else
                    p[4 * r + c] = (r ? sign : 1.0) * (c ? sign : 1.0) * q[4 * c + r];
        for (int r = 0; r < 3 && reading >= ADCGS_READ_INVERSE; r++)
            p[4 * r + 3] = -(r ? sign : 1.0) * (q[r] * q[3] + q[4 + r] * q[7] + q[8 + r] * q[11]);
    }
}

/** matched: images are used, too. */
static adcgs_axes_check doubt(int matched)
{
    adcgs_axes_check out;
    adcgs_stereo found = {.n_frames = 0};
    if (matched) {
        adcgs_stereo_options options = {.still = 10, .scale = 1.0, .judges = 1};
        int applies;
        assert_int_equal(adcgs_stereo_applies(&scene, &applies, &error), ADCGS_OK);
        assert_true(applies);
        assert_int_equal(adcgs_stereo_find(&found, &scene, &options, NULL, &error), ADCGS_OK);
        print_message("%d pairs, %.2f pixels off\n", found.poses.pairs, found.poses.median);
    }
    assert_int_equal(adcgs_axes_check_run(&out, &scene, &found, NULL, &error), ADCGS_OK);
    adcgs_stereo_clear(&found);
    return out;
}

static void expect(adcgs_axes_reading meant, adcgs_axes_evidence by, int matched)
{
    const adcgs_axes_check d = doubt(matched);
    assert_int_equal(d.meant, meant);
    if (meant != ADCGS_READ_AS_GIVEN)
        assert_int_equal(d.by, by);
}

static void test_around(void **state)
{
    for (int r = ADCGS_READ_AS_GIVEN; r < ADCGS_READINGS; r++) {
        make_scene(4.0, 120.0);
        write_otherwise((adcgs_axes_reading)r);
        expect((adcgs_axes_reading)r, ADCGS_BY_IMAGES, 1);
        expect((adcgs_axes_reading)r, ADCGS_BY_PLACES, 0);
        add_points();
        expect((adcgs_axes_reading)r, ADCGS_BY_POINTS, 0);
    }
}

/** Cameras that look out of a room are correct. By camera positions alone, the check suggests another convention. */
static void test_room(void **state)
{
    make_scene(0.4, 300.0);
    expect(ADCGS_READ_AS_GIVEN, ADCGS_BY_IMAGES, 1);
    expect(ADCGS_READ_TURNED, ADCGS_BY_PLACES, 0);
    add_points();
    expect(ADCGS_READ_AS_GIVEN, ADCGS_BY_POINTS, 0);
}

/** All look nearly in one direction: their directions give no evidence, but their images do. */
static void test_forward(void **state)
{
    make_scene(4.0, 20.0);
    expect(ADCGS_READ_AS_GIVEN, ADCGS_BY_IMAGES, 1);
    expect(ADCGS_READ_AS_GIVEN, ADCGS_BY_PLACES, 0);
    write_otherwise(ADCGS_READ_TURNED);
    expect(ADCGS_READ_TURNED, ADCGS_BY_IMAGES, 1);
    expect(ADCGS_READ_AS_GIVEN, ADCGS_BY_PLACES, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_around),
        cmocka_unit_test(test_room),
        cmocka_unit_test(test_forward),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
