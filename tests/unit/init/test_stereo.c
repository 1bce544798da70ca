/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Multi-view stereo: static points lie on the wall. Moving points lie on the square, at its place at their time, with its speed.
 */
#include "square_scene.h"

#include "init/stereo.h"

static const adcgs_stereo_options options = {.scale = 1, .still = 800, .moving = 60, .judges = 1};

static adcgs_stereo found; /* without threads */

static adcgs_stereo find(adcgs_pool *pool)
{
    adcgs_stereo s;
    if (adcgs_stereo_find(&s, &scene, &options, pool, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    return s;
}

static void put_pictures(void)
{
    for (int i = 0; i < VIEWS; i++)
        put_picture(&views[i], views[i].time);
}

static void test_static_points_lie_on_the_wall(void **state)
{
    const adcgs_stereo s = found;
    uint32_t off = 0;
    assert_true(s.n_still > options.still / 2 && s.n_still <= options.still);
    for (uint32_t i = 0; i < s.n_still; i++) {
        const adcgs_stereo_point *p = &s.still[i];
        off += fabs(p->x[2] - WALL) > 0.05 * WALL;
        assert_true(!p->moves && p->size > 0);
        for (int c = 0; c < 3 && fabs(p->x[2] - WALL) < 0.01; c++)
            assert_true(fabs((double)p->rgb[c] - texture(p->x[0], p->x[1], 20 + (uint64_t)c)) < 0.3);
    }
    print_message("%u static points, %u off\n", s.n_still, off);
    assert_true(off < s.n_still / 20);
}

static void test_moving_points_lie_on_the_square(void **state)
{
    const adcgs_stereo s = found;
    uint32_t off = 0, fast = 0, n = 0, astray = 0, seen = 0;
    assert_int_equal(s.n_frames, MOMENTS);
    assert_true(s.n_moving > MOMENTS * options.moving / 3 && s.n_moving <= MOMENTS * options.moving);
    for (uint32_t i = 0; i < s.n_moving; i++) {
        const adcgs_stereo_point *p = &s.moving[i];
        const double x = p->x[0] - square_at((double)p->t);
        assert_true(p->moves && (!i || p->t >= s.moving[i - 1].t));
        if (p->in_place) { /* the background that the square uncovers */
            astray += fabs(p->x[2] - WALL) > 0.05 * WALL;
            seen += p->in_place == ADCGS_PLACE_STILL;
            continue;
        }
        n++;
        off += fabs(p->x[2] - SQUARE) > 0.05 * SQUARE || fabs(x) > HALF + 0.04 || fabs(p->x[1]) > HALF + 0.04;
        fast += fabs((double)p->velocity[0] - SPEED) < 0.3 * SPEED && fabs((double)p->velocity[1]) < 0.3 * SPEED;
    }
    print_message("%u moving points, %u off, %u at the right speed\n", n, off, fast);
    assert_true(n > s.n_moving / 2 && astray < (s.n_moving - n) / 4 && seen >= (s.n_moving - n) * 3 / 4);
    assert_true(off < n / 10);
    assert_true(fast > n * 2 / 3);
}

/** A place that a camera sees is known; a place that none sees is not. */
static void test_known_places(void **state)
{
    assert_true(adcgs_stereo_is_known(&found, (const double[]){0.1, 0, 1}));
    assert_true(adcgs_stereo_is_known(&found, (const double[]){0.1, 0, 3}));
    assert_false(adcgs_stereo_is_known(&found, (const double[]){0, 0, -1}));
}

/** A point in front of a single camera is a floater. A point that many cameras would see, or that one knows to exist, is not. */
static void test_floaters(void **state)
{
    uint32_t floats = 0;
    for (uint32_t i = 0; i < found.n_still; i++)
        floats += (uint32_t)adcgs_stereo_floats(&found, found.still[i].x);
    assert_int_equal(floats, 0);
    for (int camera = 0; camera < CAMERAS; camera++) {
        const double *m = scene.views[ADCGS_SPLIT_TRAIN][camera * MOMENTS].camera.cam_to_world;
        assert_true(adcgs_stereo_floats(&found, (const double[]){m[3], m[7], 0.1}));
        assert_false(adcgs_stereo_floats(&found, (const double[]){m[3], m[7], 1}));
    }
    assert_true(adcgs_stereo_floats(&found, (const double[]){0, 0, -1}));
    assert_false(adcgs_stereo_floats(&(adcgs_stereo){.maps = NULL}, (const double[]){0, 0, -1}));
}

/** Share of the square's points of a frame that end this many frames before and after it. */
static double ending(const adcgs_stereo *s, int moment, double before, double behind)
{
    const double ends[2] = {before / (MOMENTS - 1), behind / (MOMENTS - 1)};
    uint32_t n = 0, right = 0;
    for (uint32_t i = 0; i < s->n_moving; i++) {
        const adcgs_stereo_point *p = &s->moving[i];
        if (p->in_place || fabs((double)p->t * (MOMENTS - 1) - moment) > 0.1)
            continue;
        n++;
        right += fabs((double)p->end[0] - ends[0]) < 0.01 && fabs((double)p->end[1] - ends[1]) < 0.01;
    }
    return n ? (double)right / n : 0;
}

/** An object that exists in two frames ends half a frame before and after them. A permanent object has no end. */
static void test_lifetimes_end(void **state)
{
    (void)state;
    for (int i = 0; i < VIEWS; i++)
        put_picture(&views[i], i % MOMENTS / 2 == 2 ? views[i].time : NAN);
    adcgs_stereo s = find(NULL);
    put_pictures();
    const double first = ending(&s, 4, 0.5, 1.5), second = ending(&s, 5, 1.5, 0.5), stays = ending(&found, 4, 0, 0);
    print_message("share with the right ends: %.2f, %.2f; permanent object %.2f\n", first, second, stays);
    assert_true(first > 0.8 && second > 0.8);
    assert_true(stays > 0.6); /* at its edges, a small error of the velocity suffices for an end */
    adcgs_stereo_clear(&s);
}

/** A stripe one pixel wide, which no matching window shows alone, is found at its own place and not in the wall behind it. */
static void test_thin_stripe_is_found(void **state)
{
    const double pixel = SQUARE / FOCAL;
    uint32_t n = 0, off = 0;
    (void)state;
    half_wide = 0.5 * pixel;
    half_high = 0.4;
    put_pictures();
    adcgs_stereo s = find(NULL);
    half_wide = half_high = HALF;
    put_pictures();
    for (uint32_t i = 0; i < s.n_moving; i++) {
        const adcgs_stereo_point *p = &s.moving[i];
        if (p->in_place)
            continue;
        n++;
        off += fabs(p->x[2] - SQUARE) > 0.05 * SQUARE || fabs(p->x[0] - square_at((double)p->t)) > 2 * pixel;
    }
    print_message("%u points of the thin stripe, %u off; %u in place\n", n, off, s.n_moving - n);
    assert_true(n > MOMENTS * 8 && off < n / 4);
    adcgs_stereo_clear(&s);
}

/** The median error of the poses while cameras are turned by this many pixels, up and down alternately. */
static double off_by(double pixels)
{
    const double turn = pixels / FOCAL;
    for (int i = 0; i < VIEWS; i++) {
        const double a = i / MOMENTS % 2 ? turn : -turn;
        const double rows[9] = {1, 0, 0, 0, cos(a), -sin(a), 0, sin(a), cos(a)};
        for (int k = 0; k < 9; k++)
            views[i].camera.cam_to_world[4 * (k / 3) + k % 3] = rows[k];
    }
    adcgs_stereo s = find(NULL);
    const double median = s.poses.median;
    assert_true(s.poses.pixels == 1 && s.poses.pairs >= CAMERAS);
    adcgs_stereo_clear(&s);
    return median;
}

/** With correct poses, matches lie on their epipolar lines; otherwise as far off them as the poses are wrong. */
static void poses_that_are_off_are_noticed(void **state)
{
    assert_true(found.poses.median < 0.1);
    const double little = off_by(0.25), much = off_by(0.75), again = off_by(0);
    print_message("median error %.3f; with poses off by 0.5: %.3f, by 1.5: %.3f\n", found.poses.median, little, much);
    assert_true(little > 0.2 && little < 0.9 && much > 1.1 && much < 2);
    assert_true(again == found.poses.median);
}

static void threads_do_not_show(void **state)
{
    adcgs_pool *pool;
    assert_int_equal(adcgs_pool_create(&pool, 3, &error), ADCGS_OK);
    const adcgs_stereo a = found;
    adcgs_stereo b = find(pool);
    assert_int_equal(a.n_still, b.n_still);
    assert_int_equal(a.n_moving, b.n_moving);
    assert_memory_equal(&a.poses, &b.poses, sizeof a.poses);
    for (uint32_t i = 0; i < a.n_still; i++)
        assert_memory_equal(a.still[i].x, b.still[i].x, sizeof a.still[i].x);
    for (uint32_t i = 0; i < a.n_moving; i++) {
        assert_memory_equal(a.moving[i].x, b.moving[i].x, sizeof a.moving[i].x);
        assert_memory_equal(a.moving[i].velocity, b.moving[i].velocity, sizeof a.moving[i].velocity);
    }
    adcgs_stereo_clear(&b);
    adcgs_pool_free(&pool);
}

static void test_scenes_that_can_be_matched(void **state)
{
    adcgs_scene other = scene;
    int applies;
    assert_int_equal(adcgs_stereo_applies(&other, &applies, &error), ADCGS_OK);
    assert_true(applies);
    other.n_views[ADCGS_SPLIT_TRAIN] = 2 * MOMENTS; /* two cameras */
    assert_int_equal(adcgs_stereo_applies(&other, &applies, &error), ADCGS_OK);
    assert_false(applies);
}

static int match_pictures(void **state)
{
    if (put_scene(state) != 0)
        return -1;
    found = find(NULL);
    return 0;
}

static int forget_pictures(void **state)
{
    adcgs_stereo_clear(&found);
    return remove_scene(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_static_points_lie_on_the_wall),
        cmocka_unit_test(test_moving_points_lie_on_the_square),
        cmocka_unit_test(test_known_places),
        cmocka_unit_test(test_floaters),
        cmocka_unit_test(threads_do_not_show),
        cmocka_unit_test(test_scenes_that_can_be_matched),
        cmocka_unit_test(poses_that_are_off_are_noticed),
        cmocka_unit_test(test_lifetimes_end),
        cmocka_unit_test(test_thin_stripe_is_found),
    };
    return cmocka_run_group_tests(tests, match_pictures, forget_pictures);
}
