/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Depth and coverage. The renderer's pass against the binary64 reference and against the frames' transmittance; the decoder's
 * against the reference over its primitives. Both are the same on every CPU level and number of threads, and leave frames
 * unchanged. Also the frames that adcgs-dec makes with them.
 */
#include "config.h"

#include "apps/shared/canvas.h"
#include "random_model.h"
#include "unit/pixels_reference.h"

#include <adcgs/decoder.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <cmocka.h>

#define WIDTH 61
#define HEIGHT 47
#define PIXELS ((size_t)WIDTH * HEIGHT)

static const double origin[3] = {0.0, 0.0, 0.0};
static const float black[3] = {0.0f, 0.0f, 0.0f};

/** The sums by the slow renderer: its splats coloured by depth, one and nothing. */
static void reference_sums(const scene_splats *splats, const adcgs_view *view, double filter, double *sums)
{
    reference_scene scene = reference_from(splats);
    for (uint32_t i = 0; i < scene.n; i++) {
        double z = view->translation[2];
        for (int b = 0; b < 3; b++)
            z += (double)view->rotation[6 + b] * reference_value(&scene, SCENE_MEAN + b, i);
        scene.data[(size_t)SCENE_COLOUR * scene.n + i] = z;
        scene.data[(size_t)(SCENE_COLOUR + 1) * scene.n + i] = 1.0;
        scene.data[(size_t)(SCENE_COLOUR + 2) * scene.n + i] = 0.0;
    }
    reference_render(&scene, view, black, filter, sums);
    free(scene.data);
}

/** Renders depth, or a frame with its transmittance by pixel, for one setting. */
static void draw(const scene_splats *s, const adcgs_view *view, adcgs_cpu_level cpu, int threads, float *sums, float *light)
{
    const adcgs_primitives p = scene_primitives(s);
    adcgs_raster *raster;
    adcgs_pool *pool;
    assert_int_equal(adcgs_pool_create(&pool, threads, NULL), ADCGS_OK);
    assert_int_equal(adcgs_raster_create(&raster, cpu, pool, NULL, NULL), ADCGS_OK);
    if (light) {
        float *rgb = malloc(3 * PIXELS * sizeof *rgb);
        adcgs_kept kept;
        assert_int_equal(adcgs_raster_forward(raster, &p, view, black, 0.3f, rgb, 1, NULL), ADCGS_OK);
        adcgs_raster_kept(raster, &kept);
        for (int y = 0; y < HEIGHT; y++)
            for (int x = 0; x < WIDTH; x++) {
                const int tile = y / 16 * kept.tiles_x + x / 16, block = y % 16 / 4 * 4 + x % 16 / 4;
                light[y * WIDTH + x] = kept.transmittance[(tile * 16 + block) * 16 + y % 4 * 4 + x % 4];
            }
        free(rgb);
    }
    assert_int_equal(adcgs_raster_depth(raster, &p, view, 0.3f, sums, NULL), ADCGS_OK);
    adcgs_raster_free(&raster);
    adcgs_pool_free(&pool);
}

static void test_sums(void **state)
{
    static double expected[3 * PIXELS];
    static float sums[3 * PIXELS], other[3 * PIXELS], light[PIXELS];
    for (uint32_t n = 3; n <= 300; n *= 10) {
        scene_splats s = scene_room(n, n / 10.0, n);
        const adcgs_camera camera = scene_camera(WIDTH, HEIGHT);
        adcgs_view view;
        size_t covered = 0;
        assert_int_equal(adcgs_view_init(&view, &camera, origin, 1.0, NULL), ADCGS_OK);
        reference_sums(&s, &view, 0.3, expected);
        draw(&s, &view, ADCGS_CPU_AUTO, 1, sums, light);
        for (size_t i = 0; i < PIXELS; i++) {
            assert_true(fabs(sums[i] - expected[i]) < 2e-2);
            assert_true(fabs(sums[PIXELS + i] - expected[PIXELS + i]) < 5e-3);
            assert_true(fabsf(sums[PIXELS + i] - (1.0f - light[i])) < 2e-6f);
            assert_true(sums[2 * PIXELS + i] == 0.0f);
            covered += sums[PIXELS + i] > 0.1f;
        }
        assert_true(covered > 20);
        for (adcgs_cpu_level cpu = ADCGS_CPU_SCALAR; cpu <= adcgs_cpu_best(); cpu++)
            for (int threads = 1; threads <= 5; threads += 2) {
                draw(&s, &view, cpu, threads, other, NULL);
                assert_memory_equal(other, sums, sizeof sums);
            }
        adcgs_free(NULL, s.data);
    }
}

/* ---- The decoder ---- */

static const adcgs_camera eye = {.width = WIDTH,
                                 .height = HEIGHT,
                                 .fx = 60,
                                 .fy = 60,
                                 .cx = 30,
                                 .cy = 23,
                                 .near_plane = 0.1,
                                 .cam_to_world = {1, 0, 0, 0, 0, 1, 0, 0.75, 0, 0, 1, -9}};

static void make_stream(adcgs_stream *stream, adcgs_buffer *bytes, uint32_t anchors)
{
    adcgs_params params;
    uint64_t seed = 11;
    adcgs_random_params(&params, 1, &seed);
    params.k = 4;
    params.n_fg = 4;
    params.chunks = 2;
    adcgs_buffer_init(bytes);
    assert_int_equal(adcgs_random_stream(stream, &params, 1, anchors, 5, &seed, NULL), ADCGS_OK);
    stream->scene_scale = 2.5;
    stream->scene_origin[1] = 0.75;
    stream->background[0] = 0.5f;
    assert_int_equal(adcgs_stream_write(stream, bytes, NULL), ADCGS_OK);
}

static scene_splats copy_primitives(const adcgs_primitives *p)
{
    scene_splats s = scene_create(p->n);
    const float *const arrays[SCENE_ARRAYS] = {p->mean[0],  p->mean[1],     p->mean[2],     p->scale[0],    p->scale[1],
                                               p->scale[2], p->rotation[0], p->rotation[1], p->rotation[2], p->rotation[3],
                                               p->opacity,  p->colour[0],   p->colour[1],   p->colour[2]};
    for (int a = 0; a < SCENE_ARRAYS; a++)
        memcpy(scene_array(&s, a), arrays[a], p->n * sizeof(float));
    return s;
}

/** Depth in world units against the reference's, for pixels with enough coverage. */
static void check_depth(const adcgs_stream *stream, const adcgs_primitives *p, const float *depth, const float *alpha)
{
    static double sums[3 * PIXELS];
    scene_splats s = copy_primitives(p);
    adcgs_view view;
    size_t seen = 0;
    assert_int_equal(adcgs_view_init(&view, &eye, stream->scene_origin, stream->scene_scale, NULL), ADCGS_OK);
    reference_sums(&s, &view, stream->screen_filter, sums);
    for (size_t i = 0; i < PIXELS; i++) {
        assert_true(alpha[i] >= 0.0f && alpha[i] <= 1.0f && fabs(alpha[i] - sums[PIXELS + i]) < 5e-3);
        if (alpha[i] > 0.2f) {
            const double expected = stream->scene_scale * sums[i] / sums[PIXELS + i];
            assert_true(fabs(depth[i] / expected - 1.0) < 2e-2);
            seen++;
        }
    }
    assert_true(seen > 20);
    adcgs_free(NULL, s.data);
}

/** An empty view: the whole scene lies behind the camera. */
static void check_nothing(adcgs_decoder *d, const adcgs_stream *stream)
{
    static float rgb[3 * PIXELS], depth[PIXELS], alpha[PIXELS];
    adcgs_frame frame = {WIDTH, HEIGHT, rgb};
    adcgs_camera away = eye;
    away.cam_to_world[0] = away.cam_to_world[10] = -1.0;
    away.cam_to_world[11] = -1e6;
    assert_int_equal(adcgs_render(d, &away, 0.01, &frame, NULL), ADCGS_OK);
    assert_int_equal(adcgs_render_depth(d, &away, 0.01, depth, alpha, NULL), ADCGS_OK);
    for (size_t i = 0; i < PIXELS; i++)
        assert_true(alpha[i] == 0.0f && depth[i] == ADCGS_DEPTH_FAR && rgb[3 * i] == stream->background[0]);
}

static void test_decoder(void **state)
{
    static float rgb[3 * PIXELS], again[3 * PIXELS], depth[PIXELS], alpha[PIXELS], other[2][PIXELS];
    adcgs_stream stream;
    adcgs_buffer bytes;
    adcgs_error error = {ADCGS_OK, ""};
    make_stream(&stream, &bytes, 90);
    for (int threads = 1; threads <= 7; threads += 3)
        for (int cpu = ADCGS_CPU_SCALAR; cpu <= (int)adcgs_cpu_best(); cpu++) {
            const int first = threads == 1 && cpu == ADCGS_CPU_SCALAR;
            adcgs_decoder *d;
            adcgs_config config;
            adcgs_primitives primitives;
            adcgs_frame frame = {WIDTH, HEIGHT, rgb};
            adcgs_config_init(&config, sizeof config);
            config.threads = threads;
            config.cpu = (adcgs_cpu_level)cpu;
            assert_int_equal(adcgs_open_memory(&d, bytes.data, bytes.size, &config, &error), ADCGS_OK);
            assert_int_equal(adcgs_render_depth(d, &eye, 0.01, first ? depth : other[0], first ? alpha : other[1], &error),
                             ADCGS_OK);
            if (!first) {
                assert_memory_equal(other[0], depth, sizeof depth);
                assert_memory_equal(other[1], alpha, sizeof alpha);
            }
            assert_int_equal(adcgs_render(d, &eye, 0.01, &frame, &error), ADCGS_OK);
            assert_int_equal(adcgs_render_depth(d, &eye, 0.02, other[0], NULL, &error), ADCGS_OK);
            assert_int_equal(adcgs_render_depth(d, &eye, 0.01, NULL, other[1], &error), ADCGS_OK);
            assert_memory_equal(other[1], alpha, sizeof alpha);
            frame.rgb = again;
            assert_int_equal(adcgs_render(d, &eye, 0.01, &frame, &error), ADCGS_OK);
            assert_memory_equal(again, rgb, sizeof rgb);
            assert_int_equal(adcgs_get_primitives(d, 0.01, &primitives, &error), ADCGS_OK);
            if (first)
                check_depth(&stream, &primitives, depth, alpha);
            check_nothing(d, &stream);
            adcgs_camera bad = eye;
            bad.near_plane = 0;
            assert_int_equal(adcgs_render_depth(d, &bad, 0.01, depth, alpha, &error), ADCGS_ERR_USAGE);
            adcgs_close(&d);
        }
    adcgs_stream_clear(&stream, NULL);
    adcgs_buffer_clear(&bytes);
}

/** The output of adcgs-dec: colours over any background reproduce the frame; another stream's frame next to the first. */
static void test_canvas(void **state)
{
    static float rgb[3 * PIXELS];
    const adcgs_camera_frame shot = {eye, 0.01};
    const int size[2] = {WIDTH, HEIGHT};
    adcgs_stream stream;
    adcgs_buffer bytes;
    adcgs_decoder *d;
    adcgs_info info;
    adcgs_canvas canvas;
    adcgs_frame frame = {WIDTH, HEIGHT, rgb};
    make_stream(&stream, &bytes, 2); /* few splats leave some transmittance */
    assert_int_equal(adcgs_open_memory(&d, bytes.data, bytes.size, NULL, NULL), ADCGS_OK);
    assert_int_equal(adcgs_get_info(d, &info, sizeof info, NULL), ADCGS_OK);
    assert_int_equal(adcgs_render(d, &eye, 0.01, &frame, NULL), ADCGS_OK);
    assert_int_equal(adcgs_canvas_init(&canvas, size, &info, 1, 0, 0, NULL), ADCGS_OK);
    assert_int_equal(adcgs_render(d, &eye, 0.01, &canvas.frame, NULL), ADCGS_OK);
    assert_int_equal(adcgs_canvas_finish(&canvas, d, NULL, &shot, NULL), ADCGS_OK);
    assert_true(canvas.extras.camera == &shot.camera && canvas.extras.time == 0.01 && !canvas.extras.depth);
    double removed = 0.0;
    for (size_t i = 0; i < 3 * PIXELS; i++) {
        const double behind = (1.0 - canvas.extras.alpha[i / 3]) * stream.background[i % 3];
        assert_true(fabs(canvas.shown.rgb[i] + behind - rgb[i]) < 2e-6);
        removed = fmax(removed, behind);
    }
    assert_true(removed > 0.1);
    adcgs_canvas_clear(&canvas);
    assert_int_equal(adcgs_canvas_init(&canvas, size, &info, 0, 0, 1, NULL), ADCGS_OK);
    assert_int_equal(adcgs_render(d, &eye, 0.02, &canvas.frame, NULL), ADCGS_OK);
    assert_int_equal(adcgs_canvas_finish(&canvas, d, d, &shot, NULL), ADCGS_OK);
    assert_true(canvas.shown.width == 2 * WIDTH + ADCGS_MOSAIC_GAP && canvas.shown.height == HEIGHT && !canvas.extras.camera);
    for (size_t y = 0; y < HEIGHT; y++) {
        const float *line = canvas.shown.rgb + 3 * y * (2 * WIDTH + ADCGS_MOSAIC_GAP);
        assert_memory_equal(line, canvas.frame.rgb + 3 * y * WIDTH, 3 * WIDTH * sizeof *line);
        assert_true(line[3 * WIDTH] == 1.0f);
        assert_memory_equal(line + 3 * (WIDTH + ADCGS_MOSAIC_GAP), rgb + 3 * y * WIDTH, 3 * WIDTH * sizeof *line);
    }
    adcgs_canvas_clear(&canvas);
    adcgs_close(&d);
    adcgs_stream_clear(&stream, NULL);
    adcgs_buffer_clear(&bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sums),
        cmocka_unit_test(test_decoder),
        cmocka_unit_test(test_canvas),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
