/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Undistorted images against the scene that they show, and a real calibration. */
#include "lens_reference.h"
#include "second_sources.h"

#include "scene/layouts/open.h"
#include "scene/lens_model.h"
#include "scene/scene.h"

#include <jansson.h>
#include <math.h>

/* ---- Images ---- */

/** A smooth scene: no feature is smaller than a tenth of the focal length. */
static double pattern_at(double x, double y, int channel)
{
    return 0.5 + 0.3 * sin(20 * x + channel) * cos(17 * y - channel) + 0.1 * sin(11 * (x + y));
}

/** The image of that scene through a lens; detail divides the size of its features. */
static void draw(adcgs_image *image, const adcgs_lens *lens, double detail, int channels)
{
    const double fold = adcgs_lens_fold(lens);
    expect_good(adcgs_image_alloc(image, lens->width, lens->height, channels, "x", &error));
    for (int j = 0; j < image->height; j++)
        for (int i = 0; i < image->width; i++) {
            double xy[2];
            const int shown = adcgs_lens_invert(lens, fold, i + 0.5, j + 0.5, xy);
            assert_true(shown || lens->is_fisheye); /* a fisheye also sees behind itself */
            for (int c = 0; c < channels; c++)
                image->data[(j * image->width + i) * channels + c] =
                    shown ? (float)pattern_at(detail * xy[0], detail * xy[1], c) : 0.0f;
        }
}

/** The undistorted image against the pinhole camera's view of the scene. */
typedef struct differences {
    double inside, mean, edge; /**< largest and root mean square inside; largest in the outermost two pixels */
} differences;

static differences compare(adcgs_lens lens, double detail, int channels)
{
    enum { EDGE = 2 };
    adcgs_camera c = {0};
    adcgs_image image;
    differences d = {0.0, 0.0, 0.0};
    double n = 0.0;
    draw(&image, &lens, detail, channels);
    expect_good(adcgs_lens_pinhole(&lens, &c, "x", &error));
    expect_good(adcgs_lens_straighten(&lens, &c, &image, "x", &error));
    assert_true(image.width == c.width && image.height == c.height && image.channels == channels);
    for (int i = 0; i < c.height * c.width * channels; i++) {
        const int x = i / channels % c.width, y = i / channels / c.width;
        const double truth = pattern_at(detail * (x + 0.5 - c.cx) / c.fx, detail * (y + 0.5 - c.cy) / c.fy, i % channels);
        const double off = fabs((double)image.data[i] - truth);
        if (x >= EDGE && y >= EDGE && x < c.width - EDGE && y < c.height - EDGE) {
            d.inside = fmax(d.inside, off);
            d.mean += off * off;
            n++;
        } else
            d.edge = fmax(d.edge, off);
    }
    d.mean = sqrt(d.mean / n);
    adcgs_image_free(&image);
    return d;
}

static adcgs_lens enlarge(adcgs_lens lens, int times)
{
    lens.width *= times;
    lens.height *= times;
    lens.fx *= times;
    lens.fy *= times;
    lens.cx *= times;
    lens.cy *= times;
    lens.skew *= times;
    return lens;
}

/**
 * Errors are below one grey level of 8 bits inside and below two at the edge, where pixels are repeated. They fall with the third
 * power of the pixel's size. At peaks, which are clamped to the range of their pixels, they fall with the second.
 */
static void test_straightened(void **state)
{
    for (size_t n = 0; n < ADCGS_COUNTOF(lenses); n++) {
        const adcgs_lens lens = enlarge(lenses[n], lenses[n].fx < 100 ? 2 : 1);
        const differences d = compare(lens, 1, 3), fine = compare(enlarge(lens, 2), 1, 1);
        print_message("lens %zu: %.1e inside, mean %.1e, edge %.1e; at twice the size %.1e, %.1e, %.1e\n", n, d.inside, d.mean,
                      d.edge, fine.inside, fine.mean, fine.edge);
        assert_true(d.inside < 0.0025 && d.edge < 0.008);
        assert_true(fine.mean < d.mean / 5.0 && fine.inside < d.inside / 2.5);
    }
}

/**
 * The same for a circular image, whose pixels far from the axis span a wider angle than the pinhole's. A larger image has smaller
 * errors. The scene has coarser features, since the image has few pixels for its angle.
 */
static void test_circle_straightened(void **state)
{
    const adcgs_lens lens = CIRCLE;
    const differences d = compare(lens, 0.5, 3), fine = compare(enlarge(lens, 2), 0.5, 1);
    print_message("%.1e inside, mean %.1e, edge %.1e; at twice the size %.1e, %.1e, %.1e\n", d.inside, d.mean, d.edge,
                  fine.inside, fine.mean, fine.edge);
    assert_true(d.inside < 0.01 && d.edge < 0.01 && d.mean < 0.00025);
    assert_true(fine.mean < d.mean / 5.0 && fine.inside < d.inside / 2.5);
}

/** Undistortion invents nothing: values stay in the range of their surroundings, and one colour stays that colour. */
static void test_range(void **state)
{
    adcgs_lens lens = BARREL;
    adcgs_camera c = {0};
    adcgs_image image;
    int between = 0;
    expect_good(adcgs_lens_pinhole(&lens, &c, "x", &error));
    expect_good(adcgs_image_alloc(&image, lens.width, lens.height, 1, "x", &error));
    for (int i = 0; i < lens.width * lens.height; i++)
        image.data[i] = i * 2654435761u >> 31 ? 1.0f : 0.0f;
    expect_good(adcgs_lens_straighten(&lens, &c, &image, "x", &error));
    for (int i = 0; i < c.width * c.height; i++) {
        assert_true(image.data[i] >= 0.0f && image.data[i] <= 1.0f);
        between += image.data[i] > 0.0f && image.data[i] < 1.0f;
    }
    assert_true(between > c.width * c.height / 2);
    adcgs_image_free(&image);
    expect_good(adcgs_image_alloc(&image, lens.width, lens.height, 3, "x", &error));
    for (int i = 0; i < lens.width * lens.height * 3; i++)
        image.data[i] = 0.3f;
    expect_good(adcgs_lens_straighten(&lens, &c, &image, "x", &error));
    for (int i = 0; i < c.width * c.height * 3; i++)
        assert_true(image.data[i] == 0.3f);
    adcgs_image_free(&image);
}

/** The colours of transparent pixels do not leak into their neighbours. */
static void test_alpha(void **state)
{
    adcgs_lens lens = CUSHION;
    adcgs_camera c = {0};
    adcgs_image image;
    int partly = 0;
    expect_good(adcgs_lens_pinhole(&lens, &c, "x", &error));
    expect_good(adcgs_image_alloc(&image, lens.width, lens.height, 4, "x", &error));
    for (int i = 0; i < lens.width * lens.height; i++) {
        const int opaque = i % lens.width > 100 && i / lens.width > 90;
        const float pixel[4] = {opaque ? 0.25f : 1.0f, 0.5f, opaque ? 0.75f : 0.0f, opaque ? 1.0f : 0.0f};
        memcpy(image.data + 4 * i, pixel, sizeof pixel);
    }
    expect_good(adcgs_lens_straighten(&lens, &c, &image, "x", &error));
    for (int i = 0; i < c.width * c.height; i++) {
        const float *pixel = image.data + 4 * i;
        assert_true(pixel[3] >= 0.0f && pixel[3] <= 1.0f);
        partly += pixel[3] > 0.01f && pixel[3] < 0.99f;
        if (pixel[3] > 1e-3f)
            assert_true(fabsf(pixel[0] - 0.25f) < 1e-4f && fabsf(pixel[1] - 0.5f) < 1e-4f && fabsf(pixel[2] - 0.75f) < 1e-4f);
    }
    assert_true(partly > 100);
    adcgs_image_free(&image);
}

/* ---- A real calibration ---- */

static double cell(json_t *rows, size_t i, size_t j)
{
    return json_number_value(json_array_get(json_array_get(rows, i), j));
}

/** One camera of the calibration. Its pixels have their centres at whole numbers; D is k1 k2 p1 p2 k3. */
static adcgs_lens read_lens(json_t *k, json_t *d)
{
    return (adcgs_lens){.width = 1024,
                        .height = 1024,
                        .fx = cell(k, 0, 0),
                        .fy = cell(k, 1, 1),
                        .cx = cell(k, 0, 2) + 0.5,
                        .cy = cell(k, 1, 2) + 0.5,
                        .skew = cell(k, 0, 1),
                        .k = {cell(d, 0, 0), cell(d, 1, 0), cell(d, 4, 0)},
                        .p = {cell(d, 2, 0), cell(d, 3, 0)}};
}

/** Projects a point with the pinhole camera of the published, undistorted images. */
static void see(const adcgs_camera *c, const double point[3], double uv[2])
{
    const double *m = c->cam_to_world;
    double p[3];
    for (int a = 0; a < 3; a++)
        p[a] = m[a] * (point[0] - m[3]) + m[4 + a] * (point[1] - m[7]) + m[8 + a] * (point[2] - m[11]);
    uv[0] = c->fx * p[0] / p[2] + c->cx;
    uv[1] = c->fy * p[1] / p[2] + c->cy;
}

/**
 * Projects triangulated points through the calibration's poses (millimetres) and lens, and back from the original image. The
 * pinhole camera at half the size sees them where the published cameras do.
 */
static void check_camera(const adcgs_scene *scene, const adcgs_camera *pinhole, json_t *all, size_t i, double *bent,
                         uint32_t *inside)
{
    const adcgs_lens lens = read_lens(json_array_get(json_object_get(all, "K"), i), json_array_get(json_object_get(all, "D"), i));
    json_t *r = json_array_get(json_object_get(all, "R"), i), *t = json_array_get(json_object_get(all, "T"), i);
    for (uint32_t n = 0; n < scene->points.n; n++) {
        const double *point = scene->points.position[n];
        double p[3], seen[2], uv[2], xy[2];
        for (size_t a = 0; a < 3; a++)
            p[a] = cell(r, a, 0) * point[0] + cell(r, a, 1) * point[1] + cell(r, a, 2) * point[2] + cell(t, a, 0) / 1000.0;
        adcgs_lens_project(&lens, p[0] / p[2], p[1] / p[2], uv);
        see(pinhole, point, seen);
        if (!(p[2] > 0.0 && seen[0] >= 0.0 && seen[1] >= 0.0 && seen[0] <= pinhole->width && seen[1] <= pinhole->height))
            continue; /* some points are so far off the axis that the model folds before it reaches them */
        (*inside)++;
        *bent = fmax(*bent, hypot(0.5 * uv[0] - seen[0], 0.5 * uv[1] - seen[1]));
        assert_true(unproject(&lens, uv[0], uv[1], xy));
        assert_true(fabs(0.5 * (lens.fx * xy[0] + lens.cx) - seen[0]) < 1e-3);
        assert_true(fabs(0.5 * (lens.fy * xy[1] + lens.cy) - seen[1]) < 1e-3);
    }
    adcgs_lens usable = lens;
    adcgs_camera c = {0};
    expect_good(adcgs_lens_pinhole(&usable, &c, "x", &error));
    assert_true(c.width > 1000 && c.height > 1000);
}

static void test_ring(void **state)
{
    char file[1100];
    const char *path = real_data("zju313_15f");
    adcgs_scene *scene;
    double bent = 0.0;
    uint32_t inside = 0;
    int cameras = 0;
    expect_good(adcgs_scene_open(&scene, path, NULL, &error));
    snprintf(file, sizeof file, "%s/calibration_original.json", path);
    json_t *root = json_load_file(file, 0, NULL), *all = json_object_get(json_object_get(root, "cams"), "20190823");
    assert_int_equal(json_array_size(json_object_get(all, "D")), 21);
    for (int s = 0; s < ADCGS_SPLITS; s++)
        for (uint32_t v = 0; v < scene->n_views[s]; v++) {
            unsigned int camera, frame;
            assert_int_equal(sscanf(strstr(scene->views[s][v].path, "/cam"), "/cam%u/frame_%u", &camera, &frame), 2);
            if (frame == 1) {
                check_camera(scene, &scene->views[s][v].camera, all, camera - 1, &bent, &inside);
                cameras++;
            }
        }
    assert_true(cameras == 21 && inside > 21 * scene->points.n * 9 / 10 && bent > 1.0); /* the distortion is more than nothing */
    print_message("%u points visible; distortion moves them by up to %.2f pixels of 512\n", inside, bent);
    json_decref(root);
    adcgs_scene_free(&scene);
}

int adcgs_test_lens_images(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_straightened),
        cmocka_unit_test(test_range),
        cmocka_unit_test(test_alpha),
        cmocka_unit_test(test_ring),
        cmocka_unit_test(test_circle_straightened),
    };
    return cmocka_run_group_tests_name("lens images", tests, NULL, NULL);
}
