/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The backward pass against differences of the binary64 reference, and against itself on other CPUs and threads. */
#include "grad/raster.h"
#include "unit/pixels_reference.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <cmocka.h>

enum { GRAD_WEIGHT = SCENE_ARRAYS, GRAD_SCREEN, GRAD_ARRAYS };
static const float background[3] = {0.3f, 0.1f, 0.2f};

static float *grads_create(uint32_t n)
{
    return adcgs_alloc(NULL, (size_t)n * GRAD_ARRAYS, sizeof(float), NULL);
}

typedef struct frame {
    adcgs_view view;
    size_t pixels;
    float *rgb, *grad;
    int without_screen; /* screen gradients are not requested */
} frame;

static frame frame_create(const adcgs_camera *camera, uint64_t seed)
{
    static const double origin[3] = {0.0, 0.0, 0.0};
    frame f = {.pixels = (size_t)camera->width * (size_t)camera->height};
    assert_int_equal(adcgs_view_init(&f.view, camera, origin, 1.0, NULL), ADCGS_OK);
    f.rgb = malloc(3 * f.pixels * sizeof(float));
    f.grad = malloc(3 * f.pixels * sizeof(float));
    for (size_t i = 0; i < 3 * f.pixels; i++)
        f.grad[i] = (float)scene_normal(&seed);
    return f;
}

static void frame_free(frame *f)
{
    free(f->rgb);
    free(f->grad);
}

static void run(frame *f, const scene_splats *s, float *grads, adcgs_cpu_level cpu, int threads)
{
    adcgs_raster *raster;
    adcgs_raster_back *back;
    adcgs_pool *pool;
    const adcgs_primitives p = scene_primitives(s);
    adcgs_raster_grads g = adcgs_raster_grads_of(grads, s->n);
    if (f->without_screen)
        g.screen = NULL;
    assert_int_equal(adcgs_pool_create(&pool, threads, NULL), ADCGS_OK);
    assert_int_equal(adcgs_raster_create(&raster, cpu, pool, NULL, NULL), ADCGS_OK);
    assert_int_equal(adcgs_raster_back_create(&back, cpu, pool, NULL), ADCGS_OK);
    assert_int_equal(adcgs_raster_forward(raster, &p, &f->view, background, 0.3f, f->rgb, 1, NULL), ADCGS_OK);
    assert_int_equal(adcgs_raster_backward(back, raster, &p, &f->view, background, 0.3f, f->rgb, f->grad, &g, NULL), ADCGS_OK);
    adcgs_raster_back_free(&back);
    adcgs_raster_free(&raster);
    adcgs_pool_free(&pool);
}

static double reference_loss(const reference_scene *r, const frame *f, double *rgb)
{
    double loss = 0.0;
    reference_render(r, &f->view, background, 0.3f, rgb);
    for (size_t i = 0; i < 3 * f->pixels; i++)
        loss += f->grad[i] * rgb[i];
    return loss;
}

/* Splats so large and faint that no alpha is near 1/255 and no transmittance near 1e-4 anywhere in a small image. */
static scene_splats faint_scene(uint32_t n, uint64_t seed)
{
    scene_splats s = scene_create(n);
    for (uint32_t i = 0; i < n; i++) {
        for (int a = 0; a < 3; a++) {
            scene_array(&s, SCENE_MEAN + a)[i] = (float)(0.8 * scene_uniform(&seed) - 0.4);
            scene_array(&s, SCENE_SCALE + a)[i] = (float)(0.5 + 0.5 * scene_uniform(&seed));
            scene_array(&s, SCENE_COLOUR + a)[i] = (float)(2.0 * scene_uniform(&seed) - 0.5);
        }
        scene_random_rotation(&s, i, &seed);
        scene_array(&s, SCENE_OPACITY)[i] = (float)(0.1 + 0.15 * scene_uniform(&seed));
    }
    return s;
}

static void check_gradients(const adcgs_camera *camera, uint64_t seed)
{
    scene_splats s = faint_scene(20, seed);
    frame f = frame_create(camera, seed + 1);
    float *grads = grads_create(s.n);
    run(&f, &s, grads, ADCGS_CPU_AUTO, 1);
    reference_scene r = reference_from(&s);
    double *rgb = malloc(3 * f.pixels * sizeof(double));
    for (int array = 0; array < SCENE_ARRAYS; array++) {
        double worst = 0.0, largest = 0.0;
        for (uint32_t i = 0; i < 20; i++) {
            double *value = r.data + (size_t)array * r.n + i;
            const double kept = *value, h = 1e-6;
            *value = kept + h;
            const double up = reference_loss(&r, &f, rgb);
            *value = kept - h;
            const double down = reference_loss(&r, &f, rgb);
            *value = kept;
            const double expected = (up - down) / (2.0 * h);
            worst = fmax(worst, fabs(expected - grads[(size_t)array * s.n + i]));
            largest = fmax(largest, fabs(expected));
        }
        if (worst > 2e-4 * largest)
            fail_msg("array %d: gradient differs by %g of at most %g", array, worst, largest);
    }
    free(rgb);
    free(r.data);
    adcgs_free(NULL, grads);
    adcgs_free(NULL, s.data);
    frame_free(&f);
}

static void test_gradients(void **state)
{
    adcgs_camera c = scene_camera(23, 18);
    check_gradients(&c, 11);
    c.cx += 4.0;
    c.fy *= 1.3;
    c.cam_to_world[3] = 0.3;
    check_gradients(&c, 12);
}

/* The splats lie next to a small image, so that the Jacobian's limits apply to most of them. */
static void test_gradients_limited(void **state)
{
    adcgs_camera c = scene_camera(6, 7);
    c.fx = c.fy = 23.0;
    c.cam_to_world[3] = 1.0;
    check_gradients(&c, 13);
    c.cam_to_world[3] = 0.0;
    c.cam_to_world[7] = -1.0;
    check_gradients(&c, 14);
}

static void test_weight(void **state)
{
    scene_splats s = scene_room(500, 20.0, 3);
    const adcgs_camera c = scene_camera(61, 47);
    frame f = frame_create(&c, 5);
    float *grads = grads_create(s.n);
    run(&f, &s, grads, ADCGS_CPU_AUTO, 1);
    /* The weights and the remaining transmittance sum to the light of every pixel. */
    for (uint32_t i = 0; i < s.n; i++)
        for (int a = 0; a < 3; a++)
            scene_array(&s, SCENE_COLOUR + a)[i] = 1.0f;
    double weight = 0.0, light = 0.0;
    for (uint32_t i = 0; i < s.n; i++)
        weight += grads[(size_t)GRAD_WEIGHT * s.n + i];
    run(&f, &s, grads, ADCGS_CPU_AUTO, 1);
    for (size_t i = 0; i < f.pixels; i++)
        light += (f.rgb[i] - background[0]) / (1.0 - background[0]);
    assert_true(fabs(weight / light - 1.0) < 1e-4);
    adcgs_free(NULL, grads);
    adcgs_free(NULL, s.data);
    frame_free(&f);
}

static void test_same_everywhere(void **state)
{
    scene_splats s = scene_room(3000, 40.0, 7);
    const adcgs_camera c = scene_camera(133, 90);
    frame f = frame_create(&c, 6);
    float *expected = grads_create(s.n), *grads = grads_create(s.n);
    run(&f, &s, expected, ADCGS_CPU_SCALAR, 1);
    static const int threads[] = {1, 2, 7};
    for (adcgs_cpu_level cpu = ADCGS_CPU_SCALAR; cpu <= adcgs_cpu_best(); cpu++)
        for (size_t t = 0; t < ADCGS_COUNTOF(threads); t++) {
            memset(grads, 0xff, (size_t)s.n * GRAD_ARRAYS * sizeof(float));
            run(&f, &s, grads, cpu, threads[t]);
            assert_memory_equal(grads, expected, (size_t)s.n * GRAD_ARRAYS * sizeof(float));
        }
    adcgs_free(NULL, grads);
    adcgs_free(NULL, expected);
    adcgs_free(NULL, s.data);
    frame_free(&f);
}

/** Screen gradients that are not requested are not written, and nothing else changes. */
static void test_without_screen(void **state)
{
    scene_splats s = scene_room(700, 30.0, 8);
    const adcgs_camera c = scene_camera(75, 61);
    frame f = frame_create(&c, 9);
    const size_t others = (size_t)GRAD_SCREEN * s.n * sizeof(float);
    float *expected = grads_create(s.n), *grads = grads_create(s.n);
    run(&f, &s, expected, ADCGS_CPU_SCALAR, 1);
    f.without_screen = 1;
    for (adcgs_cpu_level cpu = ADCGS_CPU_SCALAR; cpu <= adcgs_cpu_best(); cpu++) {
        memset(grads, 0xff, (size_t)s.n * GRAD_ARRAYS * sizeof(float));
        run(&f, &s, grads, cpu, 1);
        assert_memory_equal(grads, expected, others);
        for (uint32_t i = 0; i < s.n; i++)
            assert_true(isnan(grads[(size_t)GRAD_SCREEN * s.n + i]));
    }
    adcgs_free(NULL, grads);
    adcgs_free(NULL, expected);
    adcgs_free(NULL, s.data);
    frame_free(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_without_screen), cmocka_unit_test(test_gradients),       cmocka_unit_test(test_gradients_limited),
        cmocka_unit_test(test_weight),         cmocka_unit_test(test_same_everywhere),
    };
    return cmocka_run_group_tests_name("raster_back", tests, NULL, NULL);
}
