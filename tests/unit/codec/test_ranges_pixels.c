/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Frames over the whole range of values in streams and cameras: cameras inside, behind and next to splats; splats below a pixel,
 * beyond the image, edge-on, at all limits, in hundreds of layers. Each frame equals the one by the specification's text, at
 * every CPU level. Every intermediate number lies within the annex of bounds.
 */
#include "base/cpu_detect.h"
#include "ranges.h"
#include "ranges_pixels.h"

enum { SCENES = 600, SPLATS = 96, LAYERS = 640 };

static long verdicts[VERDICTS], touched, deepest;
static double weights_off;

/* ---- Cameras ---- */

/* Any rotation, with an error up to the accepted limit, or the axes in another order. */
static void draw_rotation(adcgs_camera *c, uint64_t *random)
{
    double q[4] = {1e-9, 0, 0, 0}, n = 0;
    for (int i = 0; i < 4; i++) {
        q[i] += ranges_chance(random, 0.3) ? 0 : scene_normal(random);
        n += q[i] * q[i];
    }
    const double w = q[0] / sqrt(n), x = q[1] / sqrt(n), y = q[2] / sqrt(n), z = q[3] / sqrt(n);
    const double longer = ranges_chance(random, 0.5) ? 1 : 1 + ranges_between(random, -4.9e-4, 4.9e-4);
    const double m[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
                         2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                         2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
    for (int i = 0; i < 9; i++)
        c->cam_to_world[i / 3 * 4 + i % 3] = longer * m[i];
}

/* One side may have the largest allowed length, if the other is short. */
static void draw_size(adcgs_camera *c, uint64_t *random)
{
    c->width = 1 + (int)(39 * scene_uniform(random));
    c->height = 1 + (int)(39 * scene_uniform(random));
    if (ranges_chance(random, 0.02)) {
        c->width = 16384;
        c->height = 1 + (int)(3 * scene_uniform(random));
    }
}

static void draw_camera(adcgs_camera *c, uint64_t *random)
{
    const int far_away = ranges_chance(random, 0.2);
    draw_size(c, random);
    draw_rotation(c, random);
    const double focal = ranges_chance(random, 0.5) ? ranges_size(random, -10, 24) : c->width * ranges_size(random, -2, 3);
    c->fx = focal;
    c->fy = ranges_chance(random, 0.7) ? ADCGS_MIN(focal * (0.5 + scene_uniform(random)), 0x1p24) : ranges_size(random, -10, 24);
    c->fy = fmax(c->fy, 0x1p-10);
    c->cx = ranges_chance(random, 0.7) ? c->width * scene_uniform(random) : ranges_signed(random, -10, 20);
    c->cy = ranges_chance(random, 0.7) ? c->height * scene_uniform(random) : ranges_signed(random, -10, 20);
    c->near_plane = ranges_chance(random, 0.7) ? ranges_size(random, -30, -3) : ranges_size(random, -30, 30);
    for (int a = 0; a < 3; a++)
        c->cam_to_world[4 * a + 3] = far_away ? ranges_signed(random, -20, 28) : ranges_signed(random, -20, 4);
}

/* ---- Splats ---- */

/* A place that projects to a pixel of the image or next to it, at a depth from just before the near plane on. */
static void aim(float mean[3], double *depth, const adcgs_camera *c, uint64_t *random)
{
    const double *const m = c->cam_to_world;
    const double z = *depth = c->near_plane * (ranges_chance(random, 0.05) ? 1 : ranges_size(random, -0.01, 12));
    const double u = c->width * (1.6 * scene_uniform(random) - 0.3), v = c->height * (1.6 * scene_uniform(random) - 0.3);
    const double x = (u - c->cx) / c->fx * z, y = (v - c->cy) / c->fy * z;
    for (int a = 0; a < 3; a++) {
        const double at = m[4 * a] * x + m[4 * a + 1] * y + m[4 * a + 2] * z + m[4 * a + 3];
        mean[a] = (float)fmin(fmax(at, -0x1p15), 0x1p15);
    }
}

/* Arbitrary extents, or extents of some size in the image, from far below a pixel to far beyond the image. */
static float draw_extent(const adcgs_camera *c, double depth, uint64_t *random)
{
    const double shown = ranges_size(random, -12, 14) * depth / c->fx;
    const double extent = ranges_chance(random, 0.3) ? ranges_size(random, -20, 10) : shown;
    return (float)fmin(fmax(extent, 0x1p-20), 0x1p10);
}

/* A splat far longer than thick, but not too long for the image, so that its sides cross many blocks. */
static void make_needle(scene_splats *s, uint32_t i, const adcgs_camera *c, double depth, uint64_t *random)
{
    const double pixel = depth / c->fx;
    for (int a = 0; a < 3; a++) {
        const double extent = pixel * (a ? ranges_size(random, -12, -2) : ranges_size(random, 0, 9));
        scene_array(s, SCENE_SCALE + a)[i] = (float)fmin(fmax(extent, 0x1p-20), 0x1p10);
    }
}

static float draw_opacity(uint64_t *random)
{
    static const float limits[] = {0x1.010102p-8f, 0x1.0101p-8f, 0x1.010104p-8f, 0x1.fae148p-1f, 0.0f, 0x1p-149f};
    if (ranges_chance(random, 0.3))
        return limits[(size_t)(scene_uniform(random) * ADCGS_COUNTOF(limits))];
    return 0x1.fae148p-1f * (float)(ranges_chance(random, 0.5) ? scene_uniform(random) : ranges_size(random, -9, 0));
}

static void draw_splat(scene_splats *s, uint32_t i, const adcgs_camera *c, uint64_t *random)
{
    float mean[3];
    double depth = ranges_size(random, -10, 15);
    const int aimed = ranges_chance(random, 0.8);
    if (aimed)
        aim(mean, &depth, c, random);
    for (int a = 0; a < 3; a++) {
        scene_array(s, SCENE_MEAN + a)[i] = aimed ? mean[a] : (float)ranges_signed(random, -20, 15);
        scene_array(s, SCENE_SCALE + a)[i] = draw_extent(c, depth, random);
        scene_array(s, SCENE_COLOUR + a)[i] = (float)ranges_signed(random, -149, 8);
    }
    if (ranges_chance(random, 0.3))
        make_needle(s, i, c, depth, random);
    scene_random_rotation(s, i, random);
    if (ranges_chance(random, 0.2)) /* edge-on to some direction */
        for (int a = 0; a < 4; a++)
            scene_array(s, SCENE_ROTATION + a)[i] = a == (int)(i % 4);
    scene_array(s, SCENE_OPACITY)[i] = draw_opacity(random);
}

/* ---- One frame, by the specification's text and at every level ---- */

typedef struct picture {
    const adcgs_view *view;
    const adcgs_primitives *splats;
    float background[3], filter;
    float *expected, *t, *rgb;
} picture;

static void expect_block(const picture *p, const drawn_splat *splats, uint32_t n, int x, int y)
{
    blended pixels[16];
    const size_t plane = (size_t)p->view->width * (size_t)p->view->height;
    ranges_blend_block(pixels, p->view, splats, n, x, y);
    for (int i = 0; i < 16; i++) {
        if (x + (i & 3) >= p->view->width || y + (i >> 2) >= p->view->height)
            continue;
        const size_t at = (size_t)(y + (i >> 2)) * (size_t)p->view->width + (size_t)(x + (i & 3));
        for (size_t c = 0; c < 3; c++) {
            const float value = fmaf(pixels[i].t, p->background[c], pixels[i].colour[c]) + 0.0f;
            p->expected[c * plane + at] = ranges_inside("frame", value, -0x1p10, 0x1p10);
        }
        p->t[at] = pixels[i].t;
        touched += pixels[i].layers > 0;
        deepest = ADCGS_MAX(deepest, pixels[i].layers);
    }
}

static void expect(const picture *p)
{
    drawn_splat *const drawn = malloc((p->splats->n + 1) * sizeof *drawn);
    uint32_t n = 0;
    assert_non_null(drawn);
    for (uint32_t i = 0; i < p->splats->n; i++) {
        const verdict v = ranges_project(drawn + n, p->view, p->splats, i, p->filter);
        verdicts[v]++;
        n += v == DRAWN;
    }
    qsort(drawn, n, sizeof *drawn, ranges_compare);
    for (int y = 0; y < p->view->height; y += 4)
        for (int x = 0; x < p->view->width; x += 4)
            expect_block(p, drawn, n, x, y);
    free(drawn);
}

/* The remaining light and the weights of the splats sum to 1: annex "Accuracy". */
static void check_weights(const picture *p)
{
    const size_t plane = (size_t)p->view->width * (size_t)p->view->height;
    for (size_t i = 0; i < plane; i++) {
        const double off = fabs((double)p->rgb[plane + i] + (double)p->t[i] - 1);
        weights_off = fmax(weights_off, off);
        assert_true(off <= 1e-6);
    }
}

static void check_level(const picture *p, adcgs_cpu_level level)
{
    const size_t bytes = 3 * sizeof(float) * (size_t)p->view->width * (size_t)p->view->height;
    adcgs_raster *raster;
    assert_int_equal(adcgs_raster_create(&raster, level, NULL, NULL, NULL), ADCGS_OK);
    memset(p->rgb, 0xff, bytes);
    assert_int_equal(adcgs_raster_forward(raster, p->splats, p->view, p->background, p->filter, p->rgb, 0, NULL), ADCGS_OK);
    if (memcmp(p->rgb, p->expected, bytes) != 0)
        fail_msg("level %d: the frame differs from the one by the specification's text", (int)level);
    assert_int_equal(adcgs_raster_depth(raster, p->splats, p->view, p->filter, p->rgb, NULL), ADCGS_OK);
    check_weights(p);
    adcgs_raster_free(&raster);
}

/* Values of HEAD: any filter and background. */
static void check_frame(const adcgs_view *view, const adcgs_primitives *splats, uint64_t *random)
{
    const size_t plane = (size_t)view->width * (size_t)view->height;
    picture p = {.view = view, .splats = splats};
    p.filter = ranges_chance(random, 0.3) ? 0.3f : ranges_chance(random, 0.3) ? 0 : (float)ranges_size(random, -149, 4);
    for (int c = 0; c < 3; c++)
        p.background[c] = (float)ranges_between(random, 0, 1);
    p.expected = malloc(7 * plane * sizeof(float));
    assert_non_null(p.expected);
    p.rgb = p.expected + 3 * plane;
    p.t = p.rgb + 3 * plane;
    expect(&p);
    for (adcgs_cpu_level level = ADCGS_CPU_SCALAR; level <= adcgs_cpu_best(); level++)
        check_level(&p, level);
    free(p.expected);
}

/* ---- Tests ---- */

static void check_view(const adcgs_view *v)
{
    for (int i = 0; i < 9; i++)
        ranges_inside("view's rotation", v->rotation[i], -1.0005, 1.0005);
    for (int i = 0; i < 4; i++)
        ranges_inside("view.limits", v->limit[i], -0x1p31, 0x1p31);
}

/* REQ-REND-002, REQ-REND-003, REQ-REND-004, REQ-REND-005, REQ-REND-007, REQ-BNDS-001, REQ-CONF-004 */
static void test_scenes(void **state)
{
    static const double origin[3];
    uint64_t random = 51;
    int refused = 0;
    (void)state;
    for (int n = 0; n < SCENES; n++) {
        adcgs_camera camera;
        adcgs_view view;
        draw_camera(&camera, &random);
        if (adcgs_view_init(&view, &camera, origin, 1.0, NULL) != ADCGS_OK) {
            refused++;
            continue;
        }
        check_view(&view);
        scene_splats s = scene_create(SPLATS);
        for (uint32_t i = 0; i < SPLATS; i++)
            draw_splat(&s, i, &camera, &random);
        const adcgs_primitives p = scene_primitives(&s);
        check_frame(&view, &p, &random);
        adcgs_free(NULL, s.data);
    }
    print_message("%d cameras refused; %ld pixels changed; splats: %ld rendered, %ld behind, %ld faint, %ld outside, %ld flat\n",
                  refused, touched, verdicts[DRAWN], verdicts[BEHIND], verdicts[FAINT], verdicts[ASIDE], verdicts[FLAT_OR_VAST]);
    assert_true(refused < SCENES / 10 && touched > 20 * SCENES);
    for (int v = 0; v < VERDICTS; v++)
        assert_true(verdicts[v] > SCENES);
}

/* Layers of one opacity all over a small image, many at equal depths; colours at their limits. */
/* REQ-REND-005, REQ-REND-007, REQ-REND-008, REQ-BNDS-001 */
static void test_layers(void **state)
{
    static const float opacities[] = {0x1.010102p-8f, 0x1.02p-8f, 0x1p-6f, 0.1f, 0.5f, 0.9f, 0x1.fae148p-1f};
    static const double origin[3];
    const adcgs_camera camera = scene_camera(22, 9);
    uint64_t random = 52;
    adcgs_view view;
    (void)state;
    assert_int_equal(adcgs_view_init(&view, &camera, origin, 1.0, NULL), ADCGS_OK);
    for (size_t n = 0; n < 3 * ADCGS_COUNTOF(opacities); n++) {
        scene_splats s = scene_create(LAYERS);
        for (uint32_t i = 0; i < LAYERS; i++) {
            for (int a = 0; a < 3; a++) {
                scene_array(&s, SCENE_SCALE + a)[i] = n % 3 == 2 ? (float)ranges_size(&random, -6, 10) : 0x1p10f;
                scene_array(&s, SCENE_COLOUR + a)[i] = ranges_chance(&random, n % 3 ? 0.5 : 1) ? 256.0f : -256.0f;
            }
            scene_array(&s, SCENE_MEAN + 2)[i] = (float)(i % 7);
            scene_array(&s, SCENE_OPACITY)[i] = opacities[n / 3];
        }
        const adcgs_primitives p = scene_primitives(&s);
        check_frame(&view, &p, &random);
        adcgs_free(NULL, s.data);
    }
    print_message("%ld layers over a pixel; weights and transmittance sum to 1 within %.3g\n", deepest, weights_off);
    assert_true(deepest >= 500);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_scenes),
        cmocka_unit_test(test_layers),
    };
    return cmocka_run_group_tests_name("ranges of pixels", tests, NULL, NULL);
}
