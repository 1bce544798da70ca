/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Scenes whose images have lens distortion: the fields of their files, and the images for training. */
#include "outside_files.h"

#include "scene/content.h"
#include "scene/layouts/open.h"
#include "scene/lens_model.h"
#include "scene/scene.h"

#include <math.h>

enum { WIDTH = 96, HEIGHT = 72 };
#define POSE "\"transform_matrix\":[[1,0,0,0],[0,1,0,0],[0,0,1,4],[0,0,0,1]]"
#define FRAME(name, more) "{\"file_path\":\"" name "\"," POSE more "}"
#define UNSEEN FRAME("a.exr", ",\"k1\":0") "," /* the first frame is for testing */
#define INSIDE 0.004
#define EDGE 0.03 /* in the outermost two pixels, where the image's last ones are repeated */

static adcgs_scene *scene;

static void expect_good(adcgs_status status)
{
    if (status != ADCGS_OK)
        fail_msg("%s", error.text);
}

static double pattern_at(double x, double y, int channel)
{
    return 0.5 + 0.3 * sin(9 * x + channel) * cos(8 * y - channel) + 0.1 * sin(5 * (x + y));
}

/** Writes the image of that scene through a lens. */
static void put_picture(const char *name, const adcgs_lens *lens)
{
    const double fold = adcgs_lens_fold(lens);
    adcgs_image image;
    expect_good(adcgs_image_alloc(&image, lens->width, lens->height, 3, name, &error));
    for (int i = 0; i < lens->width * lens->height; i++) {
        double xy[2];
        assert_true(adcgs_lens_invert(lens, fold, i % lens->width + 0.5, i / lens->width + 0.5, xy));
        for (int c = 0; c < 3; c++)
            image.data[3 * i + c] = (float)pattern_at(xy[0], xy[1], c);
    }
    expect_good(adcgs_image_write(&image, in(name), 0, &error));
    adcgs_image_free(&image);
}

/** An image reduced mostly before undistortion is close to one reduced afterwards. */
static void check_reduced(const adcgs_scene_view *view, const float *whole, const adcgs_camera *c)
{
    static const int divides[] = {2, 3, 4, 6, 8};
    for (size_t d = 0; d < ADCGS_COUNTOF(divides); d++) {
        const int by = divides[d];
        adcgs_camera small;
        float *rgb;
        double squares = 0;
        int n = 0;
        expect_good(adcgs_scene_image(scene, view, by, &rgb, &small, &error));
        assert_true(small.width == (c->width + by - 1) / by && small.fx == c->fx / by && small.cy == c->cy / by);
        for (int i = 0; i < 3 * small.width * small.height; i++) {
            const int x = i % small.width * by, y = i / small.width % small.height * by, p = i / small.width / small.height;
            if (x + by > c->width || y + by > c->height)
                continue;
            double mean = 0;
            for (int j = 0; j < by * by; j++)
                mean += (double)whole[(p * c->height + y + j / by) * c->width + x + j % by] / (by * by);
            squares += pow((double)rgb[i] - mean, 2);
            n++;
        }
        assert_true(n > 0 && squares / n < (by < 4 ? 1e-12 : 4e-6)); /* 54 dB of 12x9 pixels */
        free(rgb);
    }
}

/** Expects the view to have this lens and the loaded image to be the pinhole's. */
static void check_view(const adcgs_scene_view *view, const adcgs_lens *lens)
{
    float *rgb;
    adcgs_camera c, small;
    assert_memory_equal(&view->lens, lens, sizeof *lens);
    expect_good(adcgs_scene_image(scene, view, 1, &rgb, &c, &error));
    assert_true(c.width == view->camera.width && c.height == view->camera.height && c.fx == lens->fx && c.fy == lens->fy);
    assert_true(c.width != lens->width || c.height != lens->height || c.cx != lens->cx || c.cy != lens->cy);
    for (int i = 0; i < 3 * c.width * c.height; i++) {
        const int x = i % c.width, y = i / c.width % c.height;
        const double truth = pattern_at((x + 0.5 - c.cx) / c.fx, (y + 0.5 - c.cy) / c.fy, i / c.width / c.height);
        const int inside = x >= 2 && y >= 2 && x < c.width - 2 && y < c.height - 2;
        assert_true(fabs((double)rgb[i] - truth) < (inside ? INSIDE : EDGE));
    }
    check_reduced(view, rgb, &c);
    const double first = ((double)rgb[0] + (double)rgb[1] + (double)rgb[c.width] + (double)rgb[c.width + 1]) / 4;
    free(rgb);
    expect_good(adcgs_scene_image(scene, view, 2, &rgb, &small, &error)); /* undistorted before it is reduced */
    assert_true(small.width == (c.width + 1) / 2 && small.cx == c.cx / 2 && fabs((double)rgb[0] - first) < 1e-6);
    free(rgb);
}

/** Expects one training view with these fields to have this lens. */
static void check_transforms(const char *fields, adcgs_lens lens)
{
    char json[1024];
    put_picture("a.exr", &lens);
    snprintf(json, sizeof json,
             "{\"w\":%d,\"h\":%d,\"fl_x\":%g,\"fl_y\":%g,\"cx\":%g,\"cy\":%g,\"frames\":[" UNSEEN FRAME("a.exr", ",%s") "]}",
             WIDTH, HEIGHT, lens.fx, lens.fy, lens.cx, lens.cy, fields);
    put_text("transforms.json", json);
    expect_good(adcgs_scene_open(&scene, folder, NULL, &error));
    check_view(&scene->views[ADCGS_SPLIT_TRAIN][0], &lens);
    assert_int_equal(scene->views[ADCGS_SPLIT_TEST][0].lens.width, 0);
    assert_int_equal(scene->views[ADCGS_SPLIT_TEST][0].camera.width, WIDTH);
    adcgs_scene_free(&scene);
}

#define TAKEN .width = WIDTH, .height = HEIGHT, .fx = 80, .fy = 82, .cx = 50, .cy = 34

/** Every model of nerfstudio that contains a pinhole or a fisheye, and COLMAP's largest. */
static void test_models(void **state)
{
    check_transforms("\"k1\":-0.1", (adcgs_lens){TAKEN, .k = {-0.1}});
    check_transforms("\"camera_model\":\"SIMPLE_RADIAL\",\"k1\":0.08,\"k2\":0", (adcgs_lens){TAKEN, .k = {0.08}});
    check_transforms("\"camera_model\":\"RADIAL\",\"k1\":-0.12,\"k2\":0.04", (adcgs_lens){TAKEN, .k = {-0.12, 0.04}});
    check_transforms("\"camera_model\":\"OPENCV\",\"k1\":-0.1,\"k2\":0.03,\"k3\":0.01,\"k4\":0.02,\"p1\":0.002,\"p2\":-0.003",
                     (adcgs_lens){TAKEN, .k = {-0.1, 0.03, 0.01}, .p = {0.002, -0.003}, .k8 = 0.02});
    check_transforms("\"camera_model\":\"FULL_OPENCV\",\"k1\":0.3,\"k2\":0.1,\"k3\":0.01,\"k4\":0.4,\"k5\":0.1,\"k6\":0.02,"
                     "\"p1\":0.002,\"p2\":0.003",
                     (adcgs_lens){TAKEN, .k = {0.3, 0.1, 0.01, 0.4, 0.1, 0.02}, .p = {0.002, 0.003}});
    check_transforms("\"camera_model\":\"OPENCV_FISHEYE\",\"k1\":0.05,\"k2\":-0.02,\"k3\":0.01,\"k4\":-0.004,\"p1\":0",
                     (adcgs_lens){TAKEN, .k = {0.05, -0.02, 0.01, -0.004}, .is_fisheye = 1});
    check_transforms("\"is_fisheye\":true,\"k1\":0.05,\"k2\":-0.02,\"k3\":0.01,\"k4\":-0.004",
                     (adcgs_lens){TAKEN, .k = {0.05, -0.02, 0.01, -0.004}, .is_fisheye = 1});
    check_transforms("\"camera_model\":\"RADIAL_FISHEYE\",\"k1\":0.05,\"k2\":-0.02",
                     (adcgs_lens){TAKEN, .k = {0.05, -0.02}, .is_fisheye = 1});
    check_transforms("\"camera_model\":\"SIMPLE_RADIAL_FISHEYE\"", (adcgs_lens){TAKEN, .is_fisheye = 1});
}

/** Lenses for all frames, for single frames, and none. w and h describe the original image, or default to its size. */
static void test_frames(void **state)
{
    const adcgs_lens common = {TAKEN, .k = {-0.15, 0.02}},
                     own = {.width = WIDTH, .height = HEIGHT, .fx = 90, .fy = 90, .cx = 48, .cy = 36, .k = {0.05, 0.02}};
    put_picture("a.exr", &common);
    put_picture("b.exr", &own);
    put_text("transforms.json",
             "{\"fl_x\":80,\"fl_y\":82,\"cx\":50,\"cy\":34,\"k1\":-0.15,\"k2\":0.02,\"frames\":[" FRAME("a.exr", "") "," FRAME(
                 "a.exr", "") "," FRAME("b.exr", ",\"w\":96,\"h\":72,\"fl_x\":90,\"fl_y\":90,\"cx\":48,\"cy\":36,\"k1\":0."
                                                 "05") "," FRAME("a.exr", "") "," FRAME("b.exr", ",\"k1\":0,\"k2\":0") "]}");
    expect_good(adcgs_scene_open(&scene, folder, NULL, &error));
    const adcgs_scene_view *views = scene->views[ADCGS_SPLIT_TRAIN];
    check_view(&views[0], &common);
    check_view(&views[1], &own);
    check_view(&views[2], &common);
    assert_true(views[0].camera.width == views[2].camera.width && views[0].camera.cx == views[2].camera.cx);
    assert_true(views[3].lens.width == 0 && views[3].camera.width == WIDTH && views[3].camera.cx == 50);
    adcgs_scene_free(&scene);
    put_text("transforms.json", "{\"fl_x\":80,\"frames\":[" FRAME("a.exr", "") "," FRAME("a.exr", ",\"w\":90,\"h\":72") "]}");
    expect_error(adcgs_scene_open(&scene, folder, NULL, &error), ADCGS_ERR_DATA, "a.exr: 96x72 pixels", "90x72");
}

/* ---- HyperNeRF ---- */

#define CAMERA(more)                                                                                            \
    "{\"orientation\":[[1,0,0],[0,1,0],[0,0,1]],\"position\":[0,0,-5],\"focal_length\":80,\"principal_point\":" \
    "[50,34],\"image_size\":[96,72],\"pixel_aspect_ratio\":1.05," more "}"
#define BENT "\"skew\":2.5,\"radial_distortion\":[-0.12,0.05,-0.01]"

/** Motion masks are undistorted: the region to the right of EAST moves in the undistorted view, to within a pixel. */
#define EAST 0.1
static void test_moving(void **state)
{
    const adcgs_lens lens = {TAKEN, .k = {-0.15, 0.02}};
    const double fold = adcgs_lens_fold(&lens);
    adcgs_image mask;
    uint8_t *moving;
    put_picture("a.exr", &lens);
    expect_good(adcgs_image_alloc(&mask, WIDTH, HEIGHT, 3, "m", &error));
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        double xy[2];
        assert_true(adcgs_lens_invert(&lens, fold, i % WIDTH + 0.5, i / WIDTH + 0.5, xy));
        mask.data[3 * i] = mask.data[3 * i + 1] = 0;
        mask.data[3 * i + 2] = xy[0] > EAST ? (float)(1 + i % 255) / 255.0f : 0; /* any colour but black */
    }
    expect_good(adcgs_image_write(&mask, in("m.ppm"), 0, &error));
    adcgs_image_free(&mask);
    put_text("transforms.json", "{\"fl_x\":80,\"fl_y\":82,\"cx\":50,\"cy\":34,\"k1\":-0.15,\"k2\":0.02,\"frames\":[" FRAME(
                                    "a.exr", ",\"moving_path\":\"m.ppm\"") "," FRAME("a.exr", "") "]}");
    expect_good(adcgs_scene_open(&scene, folder, NULL, &error));
    const adcgs_scene_view *view = &scene->views[ADCGS_SPLIT_TEST][0];
    const adcgs_camera *c = &view->camera;
    assert_int_equal(view->lens.width, WIDTH);
    expect_good(adcgs_scene_load_moving(view, 1, &moving, &error));
    for (int i = 0; i < c->width * c->height; i++) {
        const double beyond = i % c->width + 0.5 - c->cx - EAST * c->fx; /* pixels */
        assert_true(fabs(beyond) < 1 || moving[i] == (beyond > 0));
    }
    free(moving);
    adcgs_scene_free(&scene);
}

/** The lens of the original image at 1/divide of full size. */
static adcgs_lens hypernerf_lens(int divide)
{
    return (adcgs_lens){.width = WIDTH / divide,
                        .height = HEIGHT / divide,
                        .fx = 80.0 / divide,
                        .fy = 80.0 * 1.05 / divide,
                        .cx = 50.0 / divide,
                        .cy = 34.0 / divide,
                        .skew = 2.5 / divide,
                        .k = {-0.12, 0.05, -0.01},
                        .p = {0.004, -0.003}};
}

static void put_hypernerf(void)
{
    assert_true(!mkdir(in("h"), 0777) && !mkdir(in("h/camera"), 0777) && !mkdir(in("h/rgb"), 0777));
    put_text("h/dataset.json", "{\"train_ids\":[\"a\",\"b\"],\"val_ids\":[\"c\"]}");
    put_text("h/metadata.json", "{\"a\":{\"warp_id\":0},\"b\":{\"warp_id\":1},\"c\":{\"warp_id\":2}}");
    put_text("h/scene.json", "{\"center\":[0,0,0],\"scale\":1}");
    put_text("h/camera/a.json", CAMERA(BENT ",\"tangential_distortion\":[0.004,-0.003]"));
    put_text("h/camera/b.json", CAMERA("\"radial_distortion\":[0,0,0]"));
    put_text("h/camera/c.json", CAMERA(BENT ",\"tangential\":[0.004,-0.003]")); /* the older name */
}

static void test_hypernerf(void **state)
{
    put_hypernerf();
    for (int divide = 2; divide >= 1; divide--) { /* the larger images are used as soon as they exist */
        const adcgs_lens bent = hypernerf_lens(divide);
        char name[64];
        snprintf(name, sizeof name, "h/rgb/%dx", divide);
        assert_int_equal(mkdir(in(name), 0777), 0);
        for (int i = 0; i < 3; i++) {
            snprintf(name, sizeof name, "h/rgb/%dx/%c.exr", divide, 'a' + i);
            put_picture(name, &bent);
        }
        expect_good(adcgs_scene_open(&scene, in("h"), NULL, &error));
        assert_true(scene->n_views[ADCGS_SPLIT_TRAIN] == 2 && scene->n_views[ADCGS_SPLIT_TEST] == 1);
        if (divide == 1) {
            check_view(&scene->views[ADCGS_SPLIT_TRAIN][0], &bent);
            check_view(&scene->views[ADCGS_SPLIT_TEST][0], &bent);
        } else
            assert_memory_equal(&scene->views[ADCGS_SPLIT_TRAIN][0].lens, &bent, sizeof bent);
        const adcgs_scene_view *flat = &scene->views[ADCGS_SPLIT_TRAIN][1];
        assert_true(flat->lens.width == 0 && flat->camera.width == bent.width && flat->camera.cx == bent.cx);
        adcgs_scene_free(&scene);
    }
}

/** Skew and the tangential pair as in HyperNeRF's cameras, by hand for x = 0.5, y = 0.25. */
static void test_hypernerf_terms(void **state)
{
    expect_good(adcgs_scene_open(&scene, in("h"), NULL, &error));
    double uv[2];
    adcgs_lens_project(&scene->views[ADCGS_SPLIT_TRAIN][0].lens, 0.5, 0.25, uv);
    const double r2 = 0.3125, radial = 1 - 0.12 * r2 + 0.05 * r2 * r2 - 0.01 * r2 * r2 * r2;
    const double x = 0.5 * radial + 2 * 0.004 * 0.125 - 0.003 * (r2 + 0.5);
    const double y = 0.25 * radial + 0.004 * (r2 + 0.125) - 2 * 0.003 * 0.125;
    assert_true(fabs(uv[0] - (80 * x + 2.5 * y + 50)) < 1e-12 && fabs(uv[1] - (84 * y + 34)) < 1e-12);
    adcgs_scene_free(&scene);
}

/* Scenes that differ only in lens distortion are different. */
static void test_outline(void **state)
{
    adcgs_scene_view view = {.camera = {.width = 8, .height = 8, .fx = 8, .fy = 8},
                             .lens = {.width = 8, .height = 8, .k = {0.1}}};
    const adcgs_scene one_view = {.views = {&view}, .n_views = {1}};
    uint8_t lens[ADCGS_CONTENT_BYTES], again[ADCGS_CONTENT_BYTES], fisheye[ADCGS_CONTENT_BYTES];
    adcgs_scene_outline(&one_view, lens);
    adcgs_scene_outline(&one_view, again);
    view.lens.is_fisheye = 1;
    adcgs_scene_outline(&one_view, fisheye);
    assert_memory_equal(lens, again, sizeof lens);
    assert_memory_not_equal(lens, fisheye, sizeof lens);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_models),    cmocka_unit_test(test_frames),          cmocka_unit_test(test_moving),
        cmocka_unit_test(test_hypernerf), cmocka_unit_test(test_hypernerf_terms), cmocka_unit_test(test_outline),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
