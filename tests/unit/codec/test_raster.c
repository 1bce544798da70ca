/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The renderer against a pixel-by-pixel evaluation of all splats without any culling (bit for bit) and against the binary64
 * reference (within a tolerance); on every CPU level, for several numbers of threads; with splats that no scene should hold.
 */
#include "base/fmath.h"
#include "render/sort.h"
#include "unit/pixels_reference.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <cmocka.h>

static const double origin[3] = {0.0, 0.0, 0.0};
static const float background[3] = {0.1f, 0.2f, 0.3f};

/* ---- The specification's blend, without tiles or masks ---- */

static float blend_exp2(float p)
{
    const float rounded = p + 0x1.8p23f, f = p - (rounded - 0x1.8p23f);
    float r = fmaf(0x1.409102p-7f, f, 0x1.ca9008p-5f);
    r = fmaf(r, f, 0x1.ebf1b4p-3f);
    r = fmaf(r, f, 0x1.62dfcap-1f);
    return adcgs_scale2(fmaf(r, f, 1.0f), rounded);
}

static void blend_splat(const adcgs_splat2d *g, int x, int y, float t[16], float colour[16][3])
{
    for (int i = 0; i < 16; i++) {
        const float dx = ((float)(x + (i & 3)) + 0.5f) - g->x, dy = ((float)(y + (i >> 2)) + 0.5f) - g->y;
        const float power = fmaf(dx, fmaf(g->a, dx, g->b * dy), fmaf(g->c * dy, dy, g->log2_opacity));
        if (!(power >= -0x1.ffa37cp+2f))
            continue;
        const float alpha = blend_exp2(power), weight = alpha * t[i];
        assert_true(alpha < 0.999f);
        for (int c = 0; c < 3; c++)
            colour[i][c] = fmaf(g->rgb[c], weight, colour[i][c]);
        t[i] = fmaf(-alpha, t[i], t[i]);
    }
}

static void blend_all(const adcgs_kept *k, const adcgs_view *view, int x, int y, float *rgb)
{
    float t[16], colour[16][3] = {{0}};
    for (int i = 0; i < 16; i++)
        t[i] = x + (i & 3) < view->width && y + (i >> 2) < view->height ? 1.0f : 0.0f;
    for (uint32_t s = 0; s < k->n_splats; s++) {
        int light = 0;
        for (int i = 0; i < 16; i++)
            light |= t[i] >= 0x1.a36e2ep-14f;
        if (!light)
            break;
        blend_splat(k->splats + s, x, y, t, colour);
    }
    for (int i = 0; i < 16; i++)
        if (x + (i & 3) < view->width && y + (i >> 2) < view->height)
            for (int c = 0; c < 3; c++)
                rgb[((size_t)c * (size_t)view->height + (size_t)(y + (i >> 2))) * (size_t)view->width + (size_t)(x + (i & 3))] =
                    fmaf(t[i], background[c], colour[i][c]) + 0.0f;
}

/* ---- Rendering once ---- */

static size_t image_bytes(const adcgs_camera *c)
{
    return 3 * sizeof(float) * (size_t)c->width * (size_t)c->height;
}

static void render(const scene_splats *s, const adcgs_camera *camera, float filter, adcgs_cpu_level cpu, int threads, float *rgb,
                   float *plain)
{
    adcgs_raster *raster;
    adcgs_pool *pool;
    adcgs_view view;
    const adcgs_primitives p = scene_primitives(s);
    assert_int_equal(adcgs_view_init(&view, camera, origin, 1.0, NULL), ADCGS_OK);
    assert_int_equal(adcgs_pool_create(&pool, threads, NULL), ADCGS_OK);
    assert_int_equal(adcgs_raster_create(&raster, cpu, pool, NULL, NULL), ADCGS_OK);
    assert_int_equal(adcgs_raster_forward(raster, &p, &view, background, filter, rgb, plain != NULL, NULL), ADCGS_OK);
    if (plain) {
        adcgs_kept kept;
        adcgs_raster_kept(raster, &kept);
        for (int y = 0; y < view.height; y += 4)
            for (int x = 0; x < view.width; x += 4)
                blend_all(&kept, &view, x, y, plain);
    }
    adcgs_raster_free(&raster);
    adcgs_pool_free(&pool);
}

/* Every level and number of threads gives the same image as the plain evaluation, of finite numbers. */
static void check_scene(const scene_splats *s, const adcgs_camera *camera, float filter)
{
    static const int threads[] = {1, 2, 7};
    const size_t bytes = image_bytes(camera);
    float *expected = malloc(bytes), *rgb = malloc(bytes);
    render(s, camera, filter, ADCGS_CPU_AUTO, 1, rgb, expected);
    for (size_t i = 0; i < bytes / sizeof(float); i++)
        assert_true(fabsf(expected[i]) < 1e6f);
    assert_memory_equal(rgb, expected, bytes);
    for (adcgs_cpu_level cpu = ADCGS_CPU_SCALAR; cpu <= adcgs_cpu_best(); cpu++)
        for (size_t t = 0; t < ADCGS_COUNTOF(threads); t++) {
            memset(rgb, 0xff, bytes);
            render(s, camera, filter, cpu, threads[t], rgb, NULL);
            assert_memory_equal(rgb, expected, bytes);
        }
    free(expected);
    free(rgb);
}

/* ---- Tests ---- */

/* REQ-CONF-004, REQ-REND-006, REQ-REND-007, REQ-REND-008 */
static void test_same_everywhere(void **state)
{
    scene_splats s = scene_room(2000, 40.0, 1);
    adcgs_camera c = scene_camera(150, 101);
    check_scene(&s, &c, 0.3f);
    c.cx -= 40.0;
    c.fy *= 1.4;
    c.cam_to_world[11] = -0.9; /* inside the room: splats behind, at the near plane, and to the sides */
    check_scene(&s, &c, 0.3f);
    adcgs_free(NULL, s.data);
}

/* REQ-REND-006 */
static void test_sizes(void **state)
{
    static const int sizes[][2] = {{1, 1}, {3, 2}, {16, 16}, {17, 15}, {64, 1}, {1, 33}, {31, 48}};
    scene_splats s = scene_room(300, 30.0, 2);
    for (size_t i = 0; i < ADCGS_COUNTOF(sizes); i++) {
        const adcgs_camera c = scene_camera(sizes[i][0], sizes[i][1]);
        check_scene(&s, &c, 0.3f);
    }
    adcgs_free(NULL, s.data);
}

/* Scales over thirty octaves, needles and discs, opacities of all sizes, any filter. */
/* REQ-REND-003, REQ-REND-007 */
static void test_wild_splats(void **state)
{
    for (uint64_t seed = 1; seed <= 24; seed++) {
        uint64_t random = seed * 77;
        scene_splats s = scene_room(1 + (uint32_t)(300.0 * scene_uniform(&random)), 40.0, seed);
        adcgs_camera c = scene_camera(1 + (int)(80.0 * scene_uniform(&random)), 1 + (int)(80.0 * scene_uniform(&random)));
        c.cx += c.width * (4.0 * scene_uniform(&random) - 2.0);
        c.cam_to_world[11] = -4.0 * scene_uniform(&random);
        c.near_plane = exp2(-20.0 * scene_uniform(&random));
        const double spread = seed % 3 ? 1.5 : 6.0;
        for (uint32_t i = 0; i < s.n; i++) {
            for (int a = 0; a < 3; a++) {
                float *scale = scene_array(&s, SCENE_SCALE + a) + i;
                *scale = adcgs_clampf(*scale * (float)exp(spread * scene_normal(&random)), 0x1p-20f, 0x1p10f);
                scene_array(&s, SCENE_COLOUR + a)[i] = (float)(256.0 * (2.0 * scene_uniform(&random) - 1.0));
            }
            scene_array(&s, SCENE_OPACITY)[i] = 0.99f * (float)scene_uniform(&random);
        }
        check_scene(&s, &c, seed % 2 ? 0.3f : seed % 4 ? 16.0f : 0.0f);
        adcgs_free(NULL, s.data);
    }
}

/* Exact edge cases: at the camera, on the near plane, behind it, flat, edge-on, enormous, at the ends of the ranges. */
/* REQ-REND-004, REQ-REND-007 */
static void test_hostile_splats(void **state)
{
    static const float values[] = {0.0f, 0x1p-20f, 1.0f, 0x1p10f, 0x1p15f, -0x1p15f, -3.2f, -3.15f, 0x1p-126f};
    static const double focal[] = {46.0, 46.0, 0x1p-8, 1e7, 1e7, 300.0};
    uint64_t random = 9;
    scene_splats s = scene_create(640);
    adcgs_camera c = scene_camera(40, 30);
    for (int round = 0; round < 6; round++) {
        c.fx = focal[round];
        c.cx = 20.0 + (round / 4) * 2e4;
        c.near_plane = round & 1 ? 0x1p-30 : 0.05;
        for (uint32_t i = 0; i < s.n; i++) {
            for (int a = 0; a < 3; a++) {
                scene_array(&s, SCENE_MEAN + a)[i] = values[(size_t)(9.0 * scene_uniform(&random))];
                scene_array(&s, SCENE_SCALE + a)[i] = values[1 + (size_t)(3.0 * scene_uniform(&random))];
                scene_array(&s, SCENE_COLOUR + a)[i] = scene_uniform(&random) < 0.5 ? 256.0f : -256.0f;
            }
            scene_random_rotation(&s, i, &random);
            if (i % 7 == 0)
                for (int a = 0; a < 4; a++)
                    scene_array(&s, SCENE_ROTATION + a)[i] = a == (int)(i / 7 % 4);
            scene_array(&s, SCENE_OPACITY)[i] = i % 3 ? 0.99f : 0x1.010102p-8f;
        }
        check_scene(&s, &c, round & 1 ? 0.0f : 0.3f);
    }
    adcgs_free(NULL, s.data);
}

/* REQ-REND-004, REQ-REND-008 */
static void test_nothing_to_draw(void **state)
{
    scene_splats none = scene_create(0), hidden = scene_create(64);
    const adcgs_camera c = scene_camera(19, 21);
    check_scene(&none, &c, 0.3f);
    check_scene(&hidden, &c, 0.3f);
    float *rgb = malloc(image_bytes(&c));
    render(&none, &c, 0.3f, ADCGS_CPU_AUTO, 2, rgb, NULL);
    for (int i = 0; i < 3 * 19 * 21; i++)
        assert_true(rgb[i] == background[i / (19 * 21)]);
    free(rgb);
    adcgs_free(NULL, none.data);
    adcgs_free(NULL, hidden.data);
}

/* A pixel is never -0, for any sign of the background and with colours that underflow. */
/* REQ-REND-008 */
static void test_zero_has_no_sign(void **state)
{
    static const float nothing[3] = {0.0f, -0.0f, -0.0f};
    scene_splats s = scene_create(64);
    const adcgs_camera c = scene_camera(24, 24);
    const adcgs_primitives p = scene_primitives(&s);
    float *rgb = malloc(image_bytes(&c));
    adcgs_view view;
    scene_array(&s, SCENE_OPACITY)[0] = 0.25f;
    for (int a = 0; a < 3; a++)
        scene_array(&s, SCENE_COLOUR + a)[0] = -0x1p-149f;
    assert_int_equal(adcgs_view_init(&view, &c, origin, 1.0, NULL), ADCGS_OK);
    for (int cpu = ADCGS_CPU_SCALAR; cpu <= (int)adcgs_cpu_best(); cpu++) {
        adcgs_raster *raster;
        assert_int_equal(adcgs_raster_create(&raster, (adcgs_cpu_level)cpu, NULL, NULL, NULL), ADCGS_OK);
        assert_int_equal(adcgs_raster_forward(raster, &p, &view, nothing, 0.3f, rgb, 1, NULL), ADCGS_OK);
        adcgs_kept kept;
        adcgs_raster_kept(raster, &kept);
        assert_int_equal(kept.n_splats, 1);
        for (int i = 0; i < 3 * 24 * 24; i++)
            assert_int_equal(adcgs_float_bits(rgb[i]), 0);
        adcgs_raster_free(&raster);
    }
    free(rgb);
    adcgs_free(NULL, s.data);
}

/* NaN and infinity never come from a stream, but they must not crash a caller either. */
static void test_not_numbers(void **state)
{
    scene_splats s = scene_create(64 * SCENE_ARRAYS);
    const adcgs_camera c = scene_camera(33, 20);
    float *rgb = malloc(image_bytes(&c));
    for (uint32_t i = 0; i < s.n; i++) {
        scene_array(&s, SCENE_OPACITY)[i] = 0.5f;
        scene_array(&s, (int)(i / 64))[i] = i % 3 == 0 ? NAN : i % 3 == 1 ? INFINITY : -INFINITY;
    }
    for (adcgs_cpu_level cpu = ADCGS_CPU_SCALAR; cpu <= adcgs_cpu_best(); cpu++)
        render(&s, &c, 0.3f, cpu, 1, rgb, NULL);
    free(rgb);
    adcgs_free(NULL, s.data);
}

/* REQ-REND-002, REQ-REND-003, REQ-REND-005, REQ-CONV-007, REQ-CONV-008 */
static void test_reference(void **state)
{
    scene_splats s = scene_room(1500, 40.0, 3);
    const adcgs_camera c = scene_camera(90, 70);
    const size_t n = image_bytes(&c) / sizeof(float);
    float *rgb = malloc(n * sizeof *rgb);
    double *expected = malloc(n * sizeof *expected), sum = 0.0;
    adcgs_view view;
    assert_int_equal(adcgs_view_init(&view, &c, origin, 1.0, NULL), ADCGS_OK);
    reference_scene r = reference_from(&s);
    reference_render(&r, &view, background, 0.3, expected);
    render(&s, &c, 0.3f, ADCGS_CPU_AUTO, 1, rgb, NULL);
    for (size_t i = 0; i < n; i++) {
        /* If an alpha is within rounding of 1/255 the two may differ by it. */
        assert_true(fabs(rgb[i] - expected[i]) < 5e-3);
        sum += fabs(rgb[i] - expected[i]);
    }
    assert_true(sum / (double)n < 1e-5);
    free(r.data);
    free(rgb);
    free(expected);
    adcgs_free(NULL, s.data);
}

/* REQ-REND-010. Splats over all of a large image, so many that their pairs would not fit: refused before rendering. */
static void test_limits(void **state)
{
    scene_splats s = scene_create(4096);
    adcgs_camera c = scene_camera(16384, 16384);
    adcgs_memory memory = {.limit = 1u << 20};
    adcgs_raster *raster;
    adcgs_view view;
    adcgs_error error = {0};
    for (uint32_t i = 0; i < s.n; i++)
        scene_array(&s, SCENE_OPACITY)[i] = 0.9f;
    adcgs_primitives p = scene_primitives(&s);
    assert_int_equal(adcgs_view_init(&view, &c, origin, 1.0, NULL), ADCGS_OK);
    assert_int_equal(adcgs_raster_create(&raster, ADCGS_CPU_AUTO, NULL, NULL, NULL), ADCGS_OK);
    assert_int_equal(adcgs_raster_forward(raster, &p, &view, background, 0.3f, NULL, 0, &error), ADCGS_ERR_LIMIT);
    adcgs_raster_free(&raster);
    c = scene_camera(1024, 1024);
    assert_int_equal(adcgs_view_init(&view, &c, origin, 1.0, NULL), ADCGS_OK);
    assert_int_equal(adcgs_raster_create(&raster, ADCGS_CPU_AUTO, NULL, &memory, NULL), ADCGS_OK);
    assert_int_equal(adcgs_raster_forward(raster, &p, &view, background, 0.3f, NULL, 0, &error), ADCGS_ERR_LIMIT);
    p.n = 4095;
    assert_int_equal(adcgs_raster_forward(raster, &p, &view, background, 0.3f, NULL, 0, &error), ADCGS_ERR_USAGE);
    adcgs_raster_free(&raster);
    assert_int_equal(memory.used, 0);
    adcgs_free(NULL, s.data);
}

/* A workspace that has grown allocates nothing more. */
static void test_steady_memory(void **state)
{
    scene_splats s = scene_room(3000, 40.0, 4);
    const adcgs_primitives p = scene_primitives(&s);
    adcgs_memory memory = {0};
    adcgs_raster *raster;
    adcgs_view view;
    adcgs_camera c = scene_camera(120, 120);
    float *rgb = malloc(image_bytes(&c));
    assert_int_equal(adcgs_raster_create(&raster, ADCGS_CPU_AUTO, NULL, &memory, NULL), ADCGS_OK);
    assert_int_equal(adcgs_view_init(&view, &c, origin, 1.0, NULL), ADCGS_OK);
    assert_int_equal(adcgs_raster_forward(raster, &p, &view, background, 0.3f, rgb, 1, NULL), ADCGS_OK);
    const uint64_t peak = memory.peak;
    for (int i = 0; i < 5; i++) {
        c.width -= i;
        assert_int_equal(adcgs_view_init(&view, &c, origin, 1.0, NULL), ADCGS_OK);
        assert_int_equal(adcgs_raster_forward(raster, &p, &view, background, 0.3f, rgb, i & 1, NULL), ADCGS_OK);
    }
    assert_true(memory.peak == peak && memory.used == peak);
    adcgs_raster_free(&raster);
    assert_true(memory.used == 0);
    free(rgb);
    adcgs_free(NULL, s.data);
}

/* REQ-REND-001, REQ-CONV-007 */
static void test_cameras(void **state)
{
    adcgs_camera good = scene_camera(20, 20), bad;
    adcgs_view view;
    const double nan = NAN;
    assert_int_equal(adcgs_view_init(&view, &good, origin, 2.0, NULL), ADCGS_OK);
    assert_true(view.translation[2] == 1.6f && view.near_plane == (float)(0.05 / 2.0));
    assert_int_equal(adcgs_view_init(&view, &good, origin, 0.0, NULL), ADCGS_ERR_USAGE);
    assert_int_equal(adcgs_view_init(&view, &good, origin, nan, NULL), ADCGS_ERR_USAGE);
#define REFUSED(change) \
    bad = good;         \
    change;             \
    assert_int_equal(adcgs_view_init(&view, &bad, origin, 1.0, NULL), ADCGS_ERR_USAGE)
    REFUSED(bad.width = 0);
    REFUSED(bad.height = 16385);
    REFUSED(bad.fx = nan);
    REFUSED(bad.fy = -1.0);
    REFUSED(bad.cx = 1e300);
    REFUSED(bad.near_plane = 0.0);
    REFUSED(bad.cam_to_world[0] = 2.0);
    REFUSED(bad.cam_to_world[1] = nan);
    REFUSED(bad.cam_to_world[3] = 1e30);
}

/* REQ-REND-005 */
static void test_sort(void **state)
{
    uint64_t random = 8;
    for (uint32_t n = 0; n < 5000; n = n * 2 + 1) {
        uint64_t *keys = malloc((n + 1) * sizeof *keys), *other = malloc((n + 1) * sizeof *other);
        const uint64_t range = n % 3 ? UINT32_MAX : 5;
        for (uint32_t i = 0; i < n; i++)
            keys[i] = (uint64_t)(scene_uniform(&random) * (double)range) << 32 | i;
        const uint64_t *sorted = adcgs_sort_keys(keys, other, n);
        for (uint32_t i = 1; i < n; i++)
            assert_true(sorted[i - 1] < sorted[i]); /* stable: equal keys keep the order of their lower halves */
        free(keys);
        free(other);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_same_everywhere),  cmocka_unit_test(test_sizes),           cmocka_unit_test(test_wild_splats),
        cmocka_unit_test(test_hostile_splats),   cmocka_unit_test(test_nothing_to_draw), cmocka_unit_test(test_not_numbers),
        cmocka_unit_test(test_zero_has_no_sign), cmocka_unit_test(test_reference),       cmocka_unit_test(test_limits),
        cmocka_unit_test(test_steady_memory),    cmocka_unit_test(test_cameras),         cmocka_unit_test(test_sort),
    };
    return cmocka_run_group_tests_name("raster", tests, NULL, NULL);
}
