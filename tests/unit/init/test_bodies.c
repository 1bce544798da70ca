/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Rigid bodies in images: a box that turns by 20 degrees per frame and one that slides are found, separated and followed. Boxes
 * whose appearance changes in each frame are no rigid bodies, nor is a shadow.
 */
#include "outside_files.h"

#include "grad/random.h"
#include "init/stereo.h"
#include "media/image/image.h"
#include "model/model.h"
#include "scene/scene.h"

#include <math.h>

enum { CAMERAS = 6, MOMENTS = 8, VIEWS = CAMERAS * MOMENTS, WIDTH = 104, HEIGHT = 64, FOCAL = 100, BOXES = 2 };
#define PI 3.14159265358979
#define WALL 2.2
#define TURN (20 * PI / 180) /* of the first box, per frame, about y */
#define STEP 0.03            /* of the second box, per frame, along y */

static adcgs_scene_view views[VIEWS];
static adcgs_scene scene =
    {.views = {views}, .n_views = {VIEWS}, .duration = 1, .n_times = MOMENTS, .near_bound = 0.9, .rate = {MOMENTS - 1, 1}};
static const adcgs_stereo_options options = {.scale = 1, .still = 300, .moving = 700, .bodies = ADCGS_BODIES_MAX};
static const double half[BOXES] = {0.2, 0.13};
static adcgs_stereo found; /* without threads */
static int flickers;       /* true if the boxes' appearance changes */
static int shadow;         /* true if there are no boxes, but a round shadow that crosses the wall */

/** Smooth noise with cells of a width. */
static double texture(double x, double y, double width, uint64_t surface)
{
    const double u = x / width + 1000, v = y / width + 1000, a = u - floor(u), b = v - floor(v);
    double corner[4];
    for (int k = 0; k < 4; k++)
        corner[k] = adcgs_random_unit(1, surface,
                                      (uint64_t)(int64_t)(floor(u) + (k & 1)) << 20 ^ (uint64_t)(int64_t)(floor(v) + (k >> 1)));
    return 0.1 + 0.8 * ((corner[0] * (1 - a) + corner[1] * a) * (1 - b) + (corner[2] * (1 - a) + corner[3] * a) * b);
}

/** A point in a box's own axes. */
static void to_box(int box, int moment, const double x[3], double out[3])
{
    const double angle = box ? 0 : TURN * moment, c = cos(angle), s = sin(angle);
    const double at[3] = {x[0] - (box ? 0.38 : -0.2), x[1] - (box ? STEP * (moment - 3.5) : 0), x[2] - 1.2};
    out[0] = c * at[0] - s * at[2];
    out[1] = at[1];
    out[2] = s * at[0] + c * at[2];
}

/** Intersects a ray with a box and returns the colour there; 0 if they do not meet. */
static int hit(int box, int moment, const double eye[3], const double ray[3], int channel, double *colour)
{
    const double far[3] = {eye[0] + ray[0], eye[1] + ray[1], eye[2] + ray[2]};
    double from[3], to[3], near = 0, last = 1e9, x[3];
    int face = 0;
    to_box(box, moment, eye, from);
    to_box(box, moment, far, to);
    for (int a = 0; a < 3; a++) {
        const double d = to[a] - from[a], p = (-half[box] - from[a]) / d, q = (half[box] - from[a]) / d;
        if (fmin(p, q) > near) {
            near = fmin(p, q);
            face = a;
        }
        last = fmin(last, fmax(p, q));
    }
    for (int a = 0; a < 3; a++)
        x[a] = from[a] + near * (to[a] - from[a]);
    const uint64_t surface = (uint64_t)(100 + 60 * box + 6 * channel + 2 * face + (x[face] > 0) + 1000 * flickers * moment);
    *colour = texture(x[(face + 1) % 3], x[(face + 2) % 3], 0.07, surface);
    return near > 0 && near < last;
}

static double colour_at(const adcgs_camera *c, int moment, double px, double py, int channel)
{
    const double ray[3] = {(px - c->cx) / c->fx, (py - c->cy) / c->fy, 1}, *m = c->cam_to_world, eye[3] = {m[3], m[7], m[11]};
    const double x = m[3] + WALL * ray[0], y = m[7] + WALL * ray[1];
    double colour;
    for (int box = 0; box < BOXES && !shadow; box++)
        if (hit(box, moment, eye, ray, channel, &colour))
            return colour;
    return texture(x, y, 0.1, 20 + (uint64_t)channel) * (shadow && hypot(x - 0.16 * (moment - 3.5), y) < 0.2 ? 0.5 : 1);
}

static void put_view(adcgs_scene_view *v, int camera, int moment)
{
    char name[32];
    adcgs_image image;
    v->time = moment / (MOMENTS - 1.0);
    v->camera = (adcgs_camera){.width = WIDTH,
                               .height = HEIGHT,
                               .fx = FOCAL,
                               .fy = FOCAL,
                               .cx = WIDTH / 2,
                               .cy = HEIGHT / 2,
                               .near_plane = 0.01,
                               .cam_to_world = {1, 0, 0, 0.2 * (camera % 3 - 1), 0, 1, 0, 0.2 * (camera / 3) - 0.1, 0, 0, 1, 0}};
    snprintf(name, sizeof name, "%d-%d.ppm", camera, moment);
    free(v->path);
    v->path = strdup(in(name));
    assert_int_equal(adcgs_image_alloc(&image, WIDTH, HEIGHT, 3, name, &error), ADCGS_OK);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++) {
        double sum = 0;
        for (int k = 0; k < 4; k++)
            sum +=
                colour_at(&v->camera, moment, i / 3 % WIDTH + 0.25 + 0.5 * (k & 1), i / 3 / WIDTH + 0.25 + 0.5 * (k >> 1), i % 3);
        image.data[i] = (float)(sum / 4);
    }
    assert_int_equal(adcgs_image_write(&image, v->path, 0, &error), ADCGS_OK);
    adcgs_image_free(&image);
}

static void put_views(void)
{
    for (int i = 0; i < VIEWS; i++)
        put_view(&views[i], i / MOMENTS, i % MOMENTS);
}

static void find(adcgs_stereo *s, adcgs_pool *pool)
{
    if (adcgs_stereo_find(s, &scene, &options, pool, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
}

/** A rotation's angle about y, in degrees. */
static double angle_about_y(const adcgs_stereo_pose *p)
{
    return 2 * atan2(p->q[2], p->q[0]) * 180 / PI;
}

static void check_turning(const adcgs_stereo *s, const adcgs_stereo_body *b)
{
    for (uint32_t m = 1; m < s->n_frames; m++) {
        const double step = angle_about_y(&b->pose[m]) - angle_about_y(&b->pose[m - 1]);
        const double off = remainder(fabs(step) - 20, 360), tilt = hypot(b->pose[m].q[1], b->pose[m].q[3]) * 2 * 180 / PI;
        print_message("frame %u: rotation %.2f degrees, tilt %.2f degrees\n", m, step, tilt);
        assert_true(fabs(off) < 2);
        assert_true(tilt < 2.5);
    }
}

static void check_sliding(const adcgs_stereo *s, const adcgs_stereo_body *b)
{
    for (uint32_t m = 1; m < s->n_frames; m++) {
        const double *p = b->pose[m].way, *q = b->pose[m - 1].way;
        print_message("frame %u: translation %.4f %.4f %.4f\n", m, p[0] - q[0], p[1] - q[1], p[2] - q[2]);
        assert_true(fabs(p[1] - q[1] - STEP) < 0.005 && fabs(p[0] - q[0]) < 0.005 && fabs(p[2] - q[2]) < 0.015);
        assert_true(fabs(b->pose[m].q[0]) > 0.999);
    }
}

static void boxes_are_followed(void **state)
{
    const adcgs_stereo s = found;
    uint32_t n[BOXES + 1] = {0}, right = 0, common = 0, still = 0;
    for (uint32_t b = 0; b < s.n_bodies; b++)
        print_message("%u points about %.2f %.2f %.2f\n", s.body[b].n, s.body[b].pivot[0], s.body[b].pivot[1],
                      s.body[b].pivot[2]);
    assert_int_equal(s.n_bodies, BOXES);
    const uint32_t turning = s.body[0].pivot[0] < 0 ? 0 : 1;
    check_turning(&s, &s.body[turning]);
    check_sliding(&s, &s.body[1 - turning]);
    for (uint32_t i = 0; i < s.n_moving; i++) {
        const uint32_t b = s.moving[i].body;
        assert_true(b <= BOXES);
        n[b]++;
        right += b && (s.moving[i].x[0] < 0.18) == (b == turning + 1);
        common += b == turning + 1 && s.moving[i].in_place;
        still += b == turning + 1 && s.moving[i].in_place == ADCGS_PLACE_STILL;
    }
    print_message("points: %u of the first body, %u of the second, %u of none; of the turning body %u in place, %u static\n",
                  n[1], n[2], n[0], common, still);
    assert_true(common > n[turning + 1] / 4 && still < n[turning + 1] / 20); /* many in place, almost none static */
    assert_true(n[1] >= n[2] && n[1] == s.body[0].n && n[2] == s.body[1].n);
    assert_true(right > 0.98 * (n[1] + n[2]) && n[1] + n[2] > n[0]);
    for (uint32_t b = 0; b < s.n_bodies; b++)
        for (uint32_t m = 0; m < s.n_frames; m++) {
            const double *q = s.body[b].pose[m].q, *before = s.body[b].pose[m ? m - 1 : 0].q;
            assert_true(fabs(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] - 1) < 1e-9);
            assert_true(q[0] * before[0] + q[1] * before[1] + q[2] * before[2] + q[3] * before[3] > 0);
        }
}

static void threads_do_not_show(void **state)
{
    adcgs_pool *pool;
    const adcgs_stereo a = found;
    adcgs_stereo b;
    assert_int_equal(adcgs_pool_create(&pool, 3, &error), ADCGS_OK);
    find(&b, pool);
    assert_int_equal(a.n_bodies, b.n_bodies);
    for (uint32_t i = 0; i < a.n_bodies; i++) {
        assert_memory_equal(a.body[i].pivot, b.body[i].pivot, sizeof a.body[i].pivot);
        assert_memory_equal(a.body[i].pose, b.body[i].pose, a.n_frames * sizeof *a.body[i].pose);
    }
    adcgs_stereo_clear(&b);
    adcgs_pool_free(&pool);
}

static void test_flickering_body_is_refused(void **state)
{
    adcgs_stereo s;
    flickers = 1;
    put_views();
    find(&s, NULL);
    print_message("%u bodies among %u points\n", s.n_bodies, s.n_moving);
    assert_int_equal(s.n_bodies, 0);
    adcgs_stereo_clear(&s);
}

static void a_shadow_is_none(void **state)
{
    adcgs_stereo s;
    uint32_t still = 0;
    shadow = 1;
    put_views();
    find(&s, NULL);
    for (uint32_t i = 0; i < s.n_moving; i++)
        still += s.moving[i].in_place == ADCGS_PLACE_STILL;
    print_message("%u bodies among %u points, %u of them static\n", s.n_bodies, s.n_moving, still);
    assert_true(s.n_moving > 60 * MOMENTS && still > 0.95 * s.n_moving);
    assert_int_equal(s.n_bodies, 0);
    adcgs_stereo_clear(&s);
}

static int put_scene(void **state)
{
    if (make_folder(state) != 0)
        return -1;
    put_views();
    find(&found, NULL);
    return 0;
}

static int remove_scene(void **state)
{
    adcgs_stereo_clear(&found);
    for (int i = 0; i < VIEWS; i++)
        free(views[i].path);
    return remove_folder(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes_are_followed),
        cmocka_unit_test(threads_do_not_show),
        cmocka_unit_test(test_flickering_body_is_refused),
        cmocka_unit_test(a_shadow_is_none),
    };
    return cmocka_run_group_tests(tests, put_scene, remove_scene);
}
