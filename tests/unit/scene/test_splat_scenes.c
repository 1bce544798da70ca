/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats as scenes: a decoder's splats written and read back, cameras for splats, view-dependent colours, real files. */
#include "ply_splats.h"

#include "apps/info/info_points.h"
#include "media/splats/splats.h"
#include "render/render.h"
#include "scene/layouts/open.h"

#include <adcgs/adcgs.h>

#include <math.h>

/* ---- A decoder's splats ---- */

typedef struct fixture {
    adcgs_stream stream;
    adcgs_decoder *decoder;
    adcgs_info info;
} fixture;

static int open_stream(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    adcgs_params params;
    adcgs_buffer bytes;
    uint64_t seed = 11;
    adcgs_random_params(&params, 1, &seed);
    params.k = 4;
    params.n_fg = 4;
    params.chunks = 2;
    adcgs_buffer_init(&bytes);
    if (!f || adcgs_random_stream(&f->stream, &params, 2, 90, 5, &seed, &error) != ADCGS_OK)
        return -1;
    f->stream.scene_scale = 2.5;
    f->stream.scene_origin[1] = 0.75;
    *state = f;
    const int failed = adcgs_stream_write(&f->stream, &bytes, &error) != ADCGS_OK ||
                       adcgs_open_memory(&f->decoder, bytes.data, bytes.size, NULL, &error) != ADCGS_OK ||
                       adcgs_get_info(f->decoder, &f->info, sizeof f->info, NULL) != ADCGS_OK;
    adcgs_buffer_clear(&bytes);
    return failed;
}

static int close_stream(void **state)
{
    fixture *f = *state;
    adcgs_close(&f->decoder);
    adcgs_stream_clear(&f->stream, NULL);
    free(f);
    return 0;
}

/** Takes the decoder's splats, slot by slot, in world units, without invisible ones. */
static void test_take(void **state)
{
    const fixture *f = *state;
    adcgs_primitives p;
    adcgs_splats s;
    assert_int_equal(adcgs_get_primitives(f->decoder, 0.5 * f->info.time_end, &p, NULL), ADCGS_OK);
    expect_good(adcgs_splats_take(&s, &p, f->info.scene_origin, f->info.scene_scale, NULL, "taken", &error));
    uint32_t n = 0;
    for (uint32_t i = 0; i < p.n; i++) {
        if (p.opacity[i] == 0.0f)
            continue;
        assert_true(s.opacity[n] == p.opacity[i]);
        for (int a = 0; a < 3; a++) {
            assert_true(s.mean[a][n] == (float)((a == 1 ? 0.75 : 0.0) + 2.5 * (double)p.mean[a][i]));
            assert_true(s.scale[a][n] == (float)(2.5 * (double)p.scale[a][i]));
            assert_true(s.colour[a][n] == p.colour[a][i]);
        }
        for (int a = 0; a < 4; a++)
            assert_true(s.rotation[a][n] == p.rotation[a][i]);
        n++;
    }
    assert_true(n > 100 && n < p.n && s.n == n);
    adcgs_splats_primitives(&s, &p);
    for (uint32_t i = n; i < p.n; i++)
        assert_true(p.opacity[i] == 0.0f);
    adcgs_splats_free(&s);
}

/** Anchors as points: at the places in the stream, in the colours that the decoder gives at the middle of the stream. */
static void test_points(void **state)
{
    const fixture *f = *state;
    const double middle = 0.5 * (f->info.time_start + f->info.time_end);
    const adcgs_model *m = &f->stream.segments[f->stream.segments[1].time_start <= middle];
    adcgs_points points;
    adcgs_primitives p;
    double offset[3];
    expect_good(adcgs_info_points(&points, offset, &f->stream, "points", &error));
    assert_int_equal(adcgs_get_primitives(f->decoder, middle, &p, NULL), ADCGS_OK);
    assert_int_equal(points.n, m->n);
    uint32_t grey = 0;
    for (uint32_t i = 0; i < m->n; i++) {
        double sum[3] = {0, 0, 0}, weight = 0.0;
        for (int a = 0; a < 3; a++) {
            const double scene = (double)m->origin[a] + 0.5 * (2.0 * m->pos[3 * i + (uint32_t)a] + 1.0) * (double)m->voxel;
            near((float)points.position[i][a], (float)((a == 1 ? 0.75 : 0.0) + 2.5 * scene), 2e-7, 1e-9);
        }
        for (uint32_t slot = i / 64 * 4 * 64 + i % 64; slot < (i / 64 + 1) * 4 * 64; slot += 64)
            for (int c = 0; c < 3; c++) {
                sum[c] += (double)p.opacity[slot] * (double)p.colour[c][slot];
                weight += c ? 0.0 : (double)p.opacity[slot];
            }
        for (int c = 0; c < 3; c++)
            assert_true(fabs((weight > 0 ? 255.0 * fmin(fmax(sum[c] / weight, 0), 1) : 128.0) - points.colour[i][c]) < 0.51);
        grey += weight == 0.0;
    }
    assert_true(grey < m->n && points.coloured);
    adcgs_points_free(&points);
}

static double psnr(const float *a, const float *b, size_t n, double *variance)
{
    double square = 0.0, sum = 0.0, squares = 0.0;
    for (size_t i = 0; i < n; i++) {
        square += pow((double)a[i] - (double)b[i], 2);
        sum += (double)b[i];
        squares += (double)b[i] * (double)b[i];
    }
    *variance = squares / (double)n - pow(sum / (double)n, 2);
    return 10.0 * log10((double)n / fmax(square, 1e-12));
}

/** Renders the splats themselves, in their own units. Negative colours become 0, as in other PLY renderers; [0,1], planar. */
static float *draw(const adcgs_primitives *p, const double origin[3], double scale, const adcgs_camera *camera)
{
    const size_t n = 3 * (size_t)camera->width * (size_t)camera->height;
    const float black[3] = {0.0f, 0.0f, 0.0f};
    float *rgb = malloc(n * sizeof *rgb), *colour = aligned_alloc(64, 3 * p->n * sizeof *colour);
    adcgs_primitives clipped = *p;
    adcgs_raster *raster;
    adcgs_view view;
    assert_true(rgb && colour);
    for (size_t c = 0; c < 3; c++) {
        for (uint32_t i = 0; i < p->n; i++)
            colour[c * p->n + i] = fmaxf(p->colour[c][i], 0.0f);
        clipped.colour[c] = colour + c * p->n;
    }
    expect_good(adcgs_view_init(&view, camera, origin, scale, &error));
    expect_good(adcgs_raster_create(&raster, ADCGS_CPU_SCALAR, NULL, NULL, &error));
    expect_good(adcgs_raster_forward(raster, &clipped, &view, black, ADCGS_SCREEN_FILTER, rgb, 0, &error));
    adcgs_raster_free(&raster);
    free(colour);
    for (size_t i = 0; i < n; i++)
        rgb[i] = fminf(fmaxf(rgb[i], 0.0f), 1.0f);
    return rgb;
}

static adcgs_scene *open_splats(const char *path)
{
    adcgs_scene *scene;
    expect_good(adcgs_scene_open(&scene, path, NULL, &error));
    return scene;
}

/** Compares the image of a scene's view with one of the primitives from the same camera. */
static void same_picture(const adcgs_scene *scene, const adcgs_scene_view *view, const adcgs_primitives *p,
                         const double origin[3], double scale)
{
    adcgs_camera camera;
    float *rgb;
    double variance;
    expect_good(adcgs_scene_image(scene, view, 1, &rgb, &camera, &error));
    float *expected = draw(p, origin, scale, &camera);
    const double db = psnr(rgb, expected, 3 * (size_t)camera.width * (size_t)camera.height, &variance);
    if (!(db > 60.0 && variance > 1e-4))
        fail_msg("%s: %.2f dB, variance %g", view->camera.name, db, variance);
    free(rgb);
    free(expected);
}

/** A stream's splats, exported and read as a scene, look the same as in the stream. */
static void test_export(void **state)
{
    const fixture *f = *state;
    adcgs_primitives p;
    adcgs_splats s;
    assert_int_equal(adcgs_get_primitives(f->decoder, 0.04, &p, NULL), ADCGS_OK);
    expect_good(adcgs_splats_take(&s, &p, f->info.scene_origin, f->info.scene_scale, NULL, "e.ply", &error));
    expect_good(write_splats(&s, in("e.ply")));
    adcgs_splats_free(&s);
    adcgs_scene *scene = open_splats(in("e.ply"));
    for (uint32_t i = 0; i < 20; i += 5)
        same_picture(scene, &scene->views[ADCGS_SPLIT_TEST][i], &p, f->info.scene_origin, f->info.scene_scale);
    adcgs_scene_free(&scene);
}

/* ---- Scenes ---- */

/** Expects a camera to look straight at a point from a distance, in a right-handed frame. */
static void looks_at(const adcgs_camera *c, const double point[3], double distance)
{
    const double *m = c->cam_to_world;
    double det = 0.0;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        det += m[4 * i] * (m[4 * j + 1] * m[4 * k + 2] - m[4 * k + 1] * m[4 * j + 2]);
        assert_true(fabs(m[4 * i + 3] + distance * m[4 * i + 2] - point[i]) < 1e-9 * (1.0 + distance));
        double dot = 0.0;
        for (int r = 0; r < 3; r++)
            dot += m[4 * r + i] * m[4 * r + j];
        assert_true(fabs(dot) < 1e-12);
    }
    assert_true(fabs(det - 1.0) < 1e-12);
}

static double between(const adcgs_camera *a, const adcgs_camera *b)
{
    double dot = 0.0;
    for (int i = 0; i < 3; i++)
        dot += a->cam_to_world[4 * i + 2] * b->cam_to_world[4 * i + 2];
    return acos(fmin(dot, 1.0));
}

/** A splat far out and an invisible one change nothing. The others are in the middle of every view. */
static void test_cameras(void **state)
{
    adcgs_splats s = random_splats(501, 2.0, 10.0, 8);
    for (int a = 0; a < 3; a++)
        s.mean[a][100] = 10.0f;
    s.mean[0][7] = 1e6f;
    s.mean[1][8] = -1e20f;
    s.opacity[8] = 0.001f;
    expect_good(write_splats(&s, in("c.ply")));
    adcgs_scene *scene = open_splats(in("c.ply"));
    assert_true(scene->n_views[0] == 100 && scene->n_views[1] == 10 && scene->n_views[2] == 20);
    assert_true(scene->n_times == 1 && scene->duration == 0.0 && !scene->has_alpha && scene->background[0] == 0.0f);
    assert_int_equal(scene->axes, ADCGS_AXES_UNKNOWN);
    const adcgs_camera *first = &scene->views[0][0].camera, *second = &scene->views[0][1].camera;
    double centre[3], outer = 0.0;
    for (int a = 0; a < 3; a++) { /* intersection of the axes of two cameras */
        const double *m = first->cam_to_world, *w = second->cam_to_world;
        double b = 0.0, d = 0.0, e = 0.0;
        for (int r = 0; r < 3; r++) {
            b += m[4 * r + 2] * w[4 * r + 2];
            d += m[4 * r + 2] * (w[4 * r + 3] - m[4 * r + 3]);
            e += w[4 * r + 2] * (w[4 * r + 3] - m[4 * r + 3]);
        }
        outer = (d - b * e) / (1.0 - b * b);
        centre[a] = m[4 * a + 3] + outer * m[4 * a + 2];
        assert_true(fabs(centre[a] - 10.0) < 0.5);
    }
    assert_true(outer > 2.0 / sin(0.44) && outer < 4.0 / sin(0.43)); /* the cube's half edge is 2 */
    double nearest = 10.0;
    for (int split = 0; split < ADCGS_SPLITS; split++)
        for (uint32_t i = 0; i < scene->n_views[split]; i++) {
            const adcgs_scene_view *v = &scene->views[split][i];
            looks_at(&v->camera, centre, i % 2 ? 0.7 * outer : outer);
            assert_true(v->camera.near_plane > 0.0 && v->camera.near_plane < 0.05 * outer);
            for (uint32_t j = 0; split && j < scene->n_views[0]; j++)
                nearest = fmin(nearest, between(&v->camera, &scene->views[0][j].camera));
        }
    assert_true(nearest > 1e-3);    /* no test view equals a training view */
    for (int i = 0; i < 500; i++) { /* and no direction is farther than 25 degrees from a training view */
        const double h = cos(0.1 + i * 0.006), r = sqrt(1 - h * h);
        const adcgs_camera c = {.cam_to_world = {0, 0, r * cos(i), 0, 0, 0, h, 0, 0, 0, r * sin(i), 0}};
        double least = 10.0;
        for (uint32_t j = 0; j < 100; j++)
            least = fmin(least, between(&c, &scene->views[0][j].camera));
        assert_true(least < 0.44);
    }
    uint32_t points = 0;
    for (uint32_t i = 0; i < s.n; i++)
        points += s.opacity[i] > 0.1f;
    assert_true(scene->points.n == points && scene->points.coloured && points > 400);
    assert_true(scene->points.position[0][2] == (double)s.mean[2][s.opacity[0] > 0.1f ? 0 : 1]);
    adcgs_scene_free(&scene);
    adcgs_splats_free(&s);
}

static void test_scene(void **state)
{
    adcgs_splats s = random_splats(300, 1.0, 0.0, 9);
    adcgs_scene *scene;
    const adcgs_scene_options white = {.has_background = 1, .background = {1.0f, 0.5f, 0.0f}};
    float *rgb, *half;
    adcgs_camera camera;
    expect_good(write_splats(&s, in("s.ply")));
    put_text("p.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
                      "end_header\n1 2 3\n");
    expect_good(adcgs_scene_open(&scene, in("s.ply"), &white, &error));
    expect_good(adcgs_scene_image(scene, &scene->views[0][0], 1, &rgb, NULL, &error));
    expect_good(adcgs_scene_image(scene, &scene->views[0][0], 2, &half, &camera, &error));
    assert_true(camera.width == 200 && camera.fx == 0.5 * scene->views[0][0].camera.fx);
    assert_true(rgb[0] == 1.0f && rgb[400 * 400] == 0.5f && rgb[2 * 400 * 400] == 0.0f); /* a corner shows the background */
    const size_t at = 100 * 200 + 100, from = 200 * 400 + 200;
    near(half[at], 0.25f * (rgb[from] + rgb[from + 1] + rgb[from + 400] + rgb[from + 401]), 1e-6, 1e-7);
    free(rgb);
    free(half);
    adcgs_scene_free(&scene);
    const adcgs_scene_options points = {.points_path = in("p.ply")};
    expect_good(adcgs_scene_open(&scene, in("s.ply"), &points, &error));
    assert_true(scene->points.n == 1 && scene->points.position[0][2] == 3.0);
    adcgs_scene_free(&scene);
    expect_error(adcgs_scene_open(&scene, in("p.ply"), NULL, &error), ADCGS_ERR_DATA, "p.ply", "not splats");
    for (uint32_t i = 0; i < s.n; i++)
        s.opacity[i] = 0.003f;
    expect_good(write_splats(&s, in("s.ply")));
    expect_error(adcgs_scene_open(&scene, in("s.ply"), NULL, &error), ADCGS_ERR_DATA, "s.ply", "no splat is visible");
    for (uint32_t i = 0; i < s.n; i++) {
        s.opacity[i] = 0.9f;
        for (int a = 0; a < 3; a++)
            s.mean[a][i] = i % 2 ? 3e38f : -3e38f;
    }
    expect_good(write_splats(&s, in("s.ply")));
    expect_error(adcgs_scene_open(&scene, in("s.ply"), NULL, &error), ADCGS_ERR_DATA, "s.ply", "1e-9 to 1e9");
    adcgs_splats_free(&s);
}

/* ---- View-dependent colours ---- */

/** A splat in the middle whose green grows along z: f_rest is channel by channel, with the direction from the camera. */
static void test_view_dependence(void **state)
{
    put_splats("v.ply", NULL, NULL, NULL, 9, "1", "0 0 0 0 0 0 8 -1 -1 -1 1 0 0 0  0 0 0  0 1 0  0 0 0\n");
    adcgs_scene *scene = open_splats(in("v.ply"));
    for (uint32_t i = 0; i < 20; i++) {
        const adcgs_scene_view *v = &scene->views[ADCGS_SPLIT_TEST][i];
        const size_t middle = 200 * 400 + 200, plane = 400 * 400;
        float *rgb;
        expect_good(adcgs_scene_image(scene, v, 1, &rgb, NULL, &error));
        const double green = 0.5 + sqrt(0.75 / M_PI) * v->camera.cam_to_world[10];
        near(rgb[middle], 0.99f * 0.5f, 1e-3, 0.0);
        near(rgb[plane + middle], 0.99f * (float)fmax(green, 0.0), 1e-3, 0.0);
        free(rgb);
    }
    adcgs_scene_free(&scene);
    /* Coefficients that are all zero mean no dependence. */
    adcgs_splats s;
    put_splats("v.ply", NULL, NULL, NULL, 24, "1", GOOD "0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 -0\n");
    expect_good(adcgs_splats_read(&s, in("v.ply"), &error));
    assert_true(s.degree == 0 && !s.harmonics);
    adcgs_splats_free(&s);
    put_splats("v.ply", NULL, NULL, NULL, 24, "1", GOOD "1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24\n");
    expect_good(adcgs_splats_read(&s, in("v.ply"), &error));
    assert_true(s.degree == 2 && s.harmonics[0] == 1.0f && s.harmonics[23] == 24.0f);
    adcgs_splats_free(&s);
}

/* ---- Real files ---- */

static void test_sunflower(void **state)
{
    const char *path = real_data("splats/sunflower_tile.ply");
    adcgs_splats s, back;
    adcgs_primitives p;
    const double origin[3] = {0, 0, 0};
    expect_good(adcgs_splats_read(&s, path, &error));
    assert_true(s.n == 14051 && s.degree == 0);
    for (uint32_t i = 0; i < s.n; i++) /* the range of a decoder's values */
        s.opacity[i] = fminf(fmaxf(s.opacity[i], 1e-6f), 0.99f);
    adcgs_scene *scene = open_splats(path);
    adcgs_splats_primitives(&s, &p);
    same_picture(scene, &scene->views[ADCGS_SPLIT_TEST][3], &p, origin, 1.0);
    same_picture(scene, &scene->views[ADCGS_SPLIT_TEST][12], &p, origin, 1.0);
    adcgs_scene_free(&scene);
    expect_good(write_splats(&s, in("again.ply")));
    expect_good(adcgs_splats_read(&back, in("again.ply"), &error));
    same_splats(&back, &s, OPACITY_ERROR, SCALE_ERROR);
    adcgs_splats_free(&s);
    adcgs_splats_free(&back);
}

static void test_compressed(void **state)
{
    adcgs_scene *scene;
    expect_good(adcgs_scene_open(&scene, real_data("splats/biker.compressed.ply"), NULL, &error));
    assert_int_equal(scene->n_views[ADCGS_SPLIT_TRAIN], 100);
    assert_true(scene->points.n > 1000 && scene->points.coloured);
    adcgs_scene_free(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_take, open_stream, close_stream),
        cmocka_unit_test_setup_teardown(test_points, open_stream, close_stream),
        cmocka_unit_test_setup_teardown(test_export, open_stream, close_stream),
        cmocka_unit_test(test_cameras),
        cmocka_unit_test(test_scene),
        cmocka_unit_test(test_view_dependence),
        cmocka_unit_test(test_sunflower),
        cmocka_unit_test(test_compressed),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
