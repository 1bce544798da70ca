/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The pixels that training compares with: exposure and black levels of cameras, contrast, masks, crops. */
#include "training_runs.h"

#include "encode/encode.h"
#include "train/density/sample.h"
#include "train/exposure/black_level.h"
#include "train/exposure/contrast.h"
#include "train/train_views.h"

#include <math.h>

/* ---- Parts of images ---- */

/** A crop of a view is rendered exactly as in the whole image, and its loss is that of its pixels. */
static void crops_are_parts_of_pictures(void **state)
{
    enum { X = 16, Y = 9, W = 16, H = 20, SIDE = 32 };
    static float whole[3 * SIDE * SIDE];
    adcgs_train_config config = small_config();
    adcgs_trainer *t = make_trainer(&config, pool);
    adcgs_loss_value value;
    const float *target;
    double square = 0;
    assert_int_equal(adcgs_trainer_load_views(t, 1, &error), ADCGS_OK);
    adcgs_trainer_prepare_networks(t);
    adcgs_pass_forward(t->pass, t->f, 0.5f, &(adcgs_pass_mode){.deform = 1});
    assert_int_equal(adcgs_view_render(t, &t->views.list[0].view, 0, whole, 0, &error), ADCGS_OK);
    adcgs_view crop = t->views.list[0].view;
    assert_true(crop.width == SIDE && crop.height == SIDE);
    adcgs_view_crop(&crop, X, Y, W, H);
    assert_int_equal(adcgs_view_render(t, &crop, 0, t->image, 0, &error), ADCGS_OK);
    assert_int_equal(adcgs_trainer_target(t, 0, NULL, &target, &error), ADCGS_OK);
    for (int c = 0; c < 3; c++)
        for (int y = 0; y < H; y++)
            for (int x = 0; x < W; x++) {
                const int at = (c * SIDE + Y + y) * SIDE + X + x;
                const float drawn = t->image[(c * H + y) * W + x];
                assert_float_equal(drawn, whole[at], 1e-4);
                square += (double)((drawn - target[at]) * (drawn - target[at])) / (3 * W * H);
            }
    assert_int_equal(adcgs_trainer_loss_crop(t, 0, &crop, &value, &error), ADCGS_OK);
    assert_float_equal(value.mse, square, 1e-6);
    adcgs_trainer_free(&t);
}

/* ---- Brightness of cameras ---- */

/** Multiplies all images by a factor. */
static void dim(adcgs_trainer *t, float by)
{
    for (uint32_t i = 0; i < t->views.n; i++) {
        const size_t n = 3 * (size_t)t->views.list[i].view.width * (size_t)t->views.list[i].view.height;
        assert_int_equal(adcgs_image_store_get(t->views.store, i, t->taken, &error), ADCGS_OK);
        for (size_t j = 0; j < n; j++)
            t->taken[j] *= by;
        assert_int_equal(adcgs_image_store_put(t->views.store, i, t->taken, &error), ADCGS_OK);
    }
}

/** A scene filmed with half the light is coded twice as finely. A lambda set by the user is used unchanged. */
static void lambda_follows_contrast(void **state)
{
    adcgs_train_config config = small_config();
    adcgs_trainer *t = make_trainer(&config, pool);
    double contrast, half, lambda;
    assert_int_equal(adcgs_trainer_load_views(t, 1, &error), ADCGS_OK);
    assert_int_equal(adcgs_contrast(t, &contrast, &error), ADCGS_OK);
    assert_true(contrast > 0.05 && contrast < 0.5); /* values in [0,1] deviate by 0.5 at most */
    assert_int_equal(adcgs_contrast_lambda(t, &error), ADCGS_OK);
    lambda = t->rate.lambda;
    assert_float_equal(lambda, (double)config.lambda * contrast / ADCGS_CONTRAST_NOMINAL, 1e-9);
    dim(t, 0.5f);
    assert_int_equal(adcgs_contrast(t, &half, &error), ADCGS_OK);
    assert_float_equal(half, contrast / 2, 1e-4 * contrast);
    assert_int_equal(adcgs_contrast_lambda(t, &error), ADCGS_OK); /* the contrast has been measured and stays */
    assert_float_equal(t->rate.lambda, lambda, 0);
    t->rate.contrast = 0;
    assert_int_equal(adcgs_contrast_lambda(t, &error), ADCGS_OK);
    assert_float_equal(t->rate.lambda, lambda / 2, 1e-4 * lambda);
    dim(t, 0); /* images of one colour: the rate still has a price */
    t->rate.contrast = 0;
    assert_int_equal(adcgs_contrast_lambda(t, &error), ADCGS_OK);
    assert_true(t->rate.lambda > 0);
    assert_int_equal(adcgs_train_set_value(&t->config, "lambda", (double)config.lambda, &error), ADCGS_OK);
    assert_int_equal(adcgs_contrast_lambda(t, &error), ADCGS_OK);
    assert_float_equal(t->rate.lambda, config.lambda, 0);
    adcgs_trainer_free(&t);
}

/**
 * The images of three cameras in turn: half of each image (of the last camera's: last_share) is within one level of the camera's
 * black, in levels of 255. The rest is bright.
 */
static void darken(adcgs_trainer *t, const float black[3], float last_share)
{
    for (uint32_t i = 0; i < t->views.n; i++) {
        const size_t plane = (size_t)t->views.list[i].view.width * (size_t)t->views.list[i].view.height;
        const uint32_t camera = t->exposure.of[i];
        const float share = camera == 2 ? last_share : 0.5f;
        for (size_t j = 0; j < 3 * plane; j++)
            t->taken[j] = j % plane < share * (float)plane ? (black[camera] + (float)(j % 3) / 2) / 255 : 0.5f;
        assert_int_equal(adcgs_image_store_put(t->views.store, i, t->taken, &error), ADCGS_OK);
    }
}

/** A camera's black offset is found only where all cameras see black. The exposure correction then removes it. */
static void black_levels_are_found(void **state)
{
    adcgs_train_config config = small_config();
    adcgs_trainer *t = make_trainer(&config, pool);
    adcgs_scene_view *views = calloc(t->views.n, sizeof *views);
    assert_non_null(views);
    for (uint32_t i = 0; i < t->views.n; i++)
        views[i].camera.cam_to_world[3] = i % 3;
    assert_int_equal(adcgs_exposure_create(&t->exposure, views, t->views.n, 0, &error), ADCGS_OK);
    free(views);
    assert_int_equal(t->exposure.n, 3);
    assert_int_equal(adcgs_trainer_load_views(t, 1, &error), ADCGS_OK);
    const float black[3] = {10, 2, 16};
    darken(t, black, 0.5f);
    assert_int_equal(adcgs_black_levels(t, &error), ADCGS_OK);
    for (int i = 0; i < 3; i++)
        for (int c = 0; c < 3; c++)
            assert_float_equal(t->exposure.cameras[i].black[c], (black[i] - 10) / 255, 0.3 / 255);
    const float taken[3] = {0.5f, 0.25f, 0.125f};
    float even[3];
    adcgs_exposure_even(&t->exposure, 1, taken, even, 1); /* the second view is the second camera's */
    for (int c = 0; c < 3; c++)
        assert_float_equal(even[c], taken[c] + 8.0f / 255, 0.3 / 255);
    /* A camera that sees too little black, or a darkness of its own, prevents an estimate for all cameras. */
    darken(t, black, 0.1f);
    assert_int_equal(adcgs_black_levels(t, &error), ADCGS_OK);
    for (int i = 0; i < 3; i++)
        assert_true(t->exposure.cameras[i].black[0] == 0);
    darken(t, (const float[]){10, 2, 40}, 0.5f);
    assert_int_equal(adcgs_black_levels(t, &error), ADCGS_OK);
    assert_true(t->exposure.cameras[1].black[2] == 0);
    adcgs_trainer_free(&t);
}

enum { CAMERAS = 3, PICTURES = 5, PLANE = 64 };

static void follow_picture(adcgs_exposure *exposure, uint32_t view, const float *drawn, const float *taken)
{
    adcgs_exposure_sums sums;
    adcgs_exposure_sum(exposure, view, drawn, taken, PLANE, &sums);
    adcgs_exposure_follow(exposure, view, &sums);
}

/**
 * Images by cameras of these gains, followed in capture order. even receives the images as the mean camera would have taken them.
 */
static uint32_t follow_cameras(const float *gain, uint32_t n_views, int still, float even[][3 * PLANE], const float *drawn)
{
    adcgs_scene_view views[CAMERAS * PICTURES] = {{.time = 0}};
    adcgs_exposure exposure = {.n = 0};
    float taken[3 * PLANE];
    for (uint32_t i = 0; i < n_views; i++)
        views[i].camera.cam_to_world[3] = i % CAMERAS;
    assert_int_equal(adcgs_exposure_create(&exposure, views, n_views, still, &error), ADCGS_OK);
    for (int even_out = 0; even_out < 2; even_out++)
        for (uint32_t i = 0; exposure.n && i < n_views; i++) {
            for (int j = 0; j < 3 * PLANE; j++)
                taken[j] = gain[i % CAMERAS] * drawn[j];
            if (even_out)
                adcgs_exposure_even(&exposure, i, taken, even[i], PLANE);
            else
                follow_picture(&exposure, i, drawn, taken);
        }
    const uint32_t n = exposure.n;
    adcgs_exposure_clear(&exposure);
    return n;
}

static void cameras_are_evened_out(void **state)
{
    float drawn[3 * PLANE], even[CAMERAS * PICTURES][3 * PLANE];
    for (int j = 0; j < 3 * PLANE; j++)
        drawn[j] = 0.1f + (float)(j * 29 % 101) / 250;
    /* Gains of mean 1 are found to within 3 %, for any images. */
    assert_int_equal(follow_cameras((const float[]){0.5f, 1, 2}, CAMERAS * PICTURES, 0, even, drawn), CAMERAS);
    for (int i = 0; i < CAMERAS * PICTURES; i++) {
        const double left = exp(0.03 * (i % CAMERAS - 1));
        for (int j = 0; j < 3 * PLANE; j++)
            assert_float_equal(even[i][j], left * (double)drawn[j], 1e-5);
    }
    /* Images of cameras that agree stay unchanged to the bit. */
    const float near[] = {0.99f, 1, 1.01f};
    assert_int_equal(follow_cameras(near, CAMERAS * PICTURES, 0, even, drawn), CAMERAS);
    for (int i = 0; i < CAMERAS * PICTURES; i++)
        for (int j = 0; j < 3 * PLANE; j++)
            assert_true(even[i][j] == near[i % CAMERAS] * drawn[j]);
    /* Too few images per camera give no estimate. */
    assert_int_equal(follow_cameras(near, CAMERAS * 3, 0, even, drawn), 0);
    /* In a static scene one image per camera is enough, as soon as every camera has one. */
    assert_int_equal(follow_cameras((const float[]){0.5f, 1, 2}, CAMERAS, 1, even, drawn), CAMERAS);
    for (int i = 0; i < CAMERAS; i++)
        assert_float_equal(even[i][7], exp(0.03 * (i % CAMERAS - 1)) * (double)drawn[7], 1e-5);
    adcgs_exposure exposure = {.n = 0};
    adcgs_scene_view views[2] = {{.time = 0}};
    float bright[3 * PLANE];
    views[1].camera.cam_to_world[3] = 1;
    for (int j = 0; j < 3 * PLANE; j++)
        bright[j] = 2 * drawn[j];
    assert_int_equal(adcgs_exposure_create(&exposure, views, 2, 1, &error), ADCGS_OK);
    follow_picture(&exposure, 0, drawn, bright);
    adcgs_exposure_even(&exposure, 0, bright, even[0], PLANE);
    assert_memory_equal(even[0], bright, sizeof bright);
    follow_picture(&exposure, 1, drawn, drawn);
    adcgs_exposure_even(&exposure, 0, bright, even[0], PLANE);
    assert_true(even[0][7] < 0.8f * bright[7]);
    adcgs_exposure_clear(&exposure);
}

/** No gain leaves the range of the images' brightness, for any model. */
static void gains_are_bounded_by_images(void **state)
{
    adcgs_scene_view views[CAMERAS] = {{.time = 0}};
    adcgs_exposure exposure = {.n = 0};
    double brightness[CAMERAS] = {0.2, 0.25, 0.2};
    float drawn[3 * PLANE], taken[3 * PLANE], even[3 * PLANE];
    for (int i = 0; i < CAMERAS; i++)
        views[i].camera.cam_to_world[3] = i;
    assert_int_equal(adcgs_exposure_create(&exposure, views, CAMERAS, 1, &error), ADCGS_OK);
    adcgs_exposure_bound(&exposure, brightness);
    for (uint32_t i = 0; i < CAMERAS; i++) {
        for (int j = 0; j < 3 * PLANE; j++) {
            drawn[j] = i ? 0.3f : 0.1f; /* haze before the first camera doubles the brightness there */
            taken[j] = 0.3f;
        }
        follow_picture(&exposure, i, drawn, taken);
    }
    adcgs_exposure_even(&exposure, 0, taken, even, PLANE);
    assert_float_equal(log(0.3 / (double)even[0]), log(0.25 / 0.2) + 0.1, 1e-5);
    adcgs_exposure_clear(&exposure);
}

/** An overexposed pixel is a lower bound of the mean camera's value, except where it is the background of an image with alpha. */
static void burnt_pixels_are_lower_bounds(void **state)
{
    adcgs_scene_view views[2] = {{.time = 0}};
    adcgs_exposure exposure = {.n = 0};
    float target[3 * PLANE], drawn[3 * PLANE];
    const float white[3] = {1, 1, 1};
    views[1].camera.cam_to_world[3] = 1;
    assert_int_equal(adcgs_exposure_create(&exposure, views, 2, 1, &error), ADCGS_OK);
    for (int i = 0; i < 2; i++)
        for (int c = 0; c < 3; c++)
            exposure.cameras[i] = (adcgs_exposure_camera){.square = {1, 1, 1}, .gain = {i ? 1 : 2, i ? 1 : 2, i ? 1 : 2}};
    for (int j = 0; j < 3 * PLANE; j++) {
        target[j] = j % PLANE == 0 ? 1 : j % PLANE == 1 ? 0.5f : j == 2 ? 1 : 0.25f; /* white, grey, and overexposed red */
        drawn[j] = 1.5f;
    }
    adcgs_exposure_even(&exposure, 0, target, target, PLANE);
    const float grey = target[1], red = target[2], even_white = target[0];
    assert_true(even_white < 0.8f);
    adcgs_exposure_allow_burnt(&exposure, 0, drawn, white, target, PLANE);
    assert_true(target[0] == even_white && target[1] == grey && target[2] == 1.5f && target[PLANE + 2] < 0.25f);
    drawn[2] = 0.5f * red; /* a value below the bound is still an error */
    target[2] = red;
    adcgs_exposure_allow_burnt(&exposure, 0, drawn, white, target, PLANE);
    assert_true(target[2] == red);
    adcgs_exposure_allow_burnt(&exposure, 0, drawn, NULL, target, PLANE);
    assert_true(target[0] == 1.5f);
    adcgs_exposure_clear(&exposure);
}

/** Where nothing covers the background of images with alpha, there is no error, at any gain. */
static void backgrounds_have_no_gain(void **state)
{
    adcgs_scene white = *scene;
    adcgs_train_config config = small_config();
    const float *target;
    white.has_alpha = 1;
    for (int c = 0; c < 3; c++)
        white.background[c] = 1;
    const adcgs_scene *const before = scene;
    adcgs_trainer *t;
    assert_int_equal(adcgs_trainer_create(&t, &white, &config, adcgs_cpu_best(), pool, &error), ADCGS_OK);
    assert_ptr_equal(scene, before);
    adcgs_scene_view *views = calloc(t->views.n, sizeof *views);
    assert_non_null(views);
    for (uint32_t i = 0; i < t->views.n; i++)
        views[i].camera.cam_to_world[3] = i % 2;
    assert_int_equal(adcgs_exposure_create(&t->exposure, views, t->views.n, 0, &error), ADCGS_OK);
    free(views);
    t->exposure.cameras[0] = (adcgs_exposure_camera){.square = {1, 1, 1}, .gain = {2, 2, 2}};
    t->exposure.cameras[1] = (adcgs_exposure_camera){.square = {1, 1, 1}, .gain = {1, 1, 1}};
    assert_int_equal(adcgs_trainer_load_views(t, 1, &error), ADCGS_OK);
    memset(t->f->keep, 0, (size_t)t->f->groups * ADCGS_LANES * t->f->params.k * sizeof *t->f->keep);
    adcgs_pass_forward(t->pass, t->f, 0, &(adcgs_pass_mode){.deform = ADCGS_DEFORM_NONE});
    for (uint32_t i = 0; i < 2; i++) {
        const size_t values = 3 * (size_t)t->views.list[i].view.width * (size_t)t->views.list[i].view.height;
        for (size_t j = 0; j < values; j++)
            t->taken[j] = 1;
        assert_int_equal(adcgs_image_store_put(t->views.store, i, t->taken, &error), ADCGS_OK);
        assert_int_equal(adcgs_view_render(t, &t->views.list[i].view, i, t->image, 0, &error), ADCGS_OK);
        assert_int_equal(adcgs_trainer_target(t, i, NULL, &target, &error), ADCGS_OK);
        for (size_t j = 0; j < values; j++)
            assert_float_equal(t->image[j], target[j], 1e-6);
        assert_int_equal(target[0] < 0.8f, i == 0);
    }
    adcgs_trainer_free(&t);
}

/* ---- Masks ---- */

enum { MASK_FROM = 6, MASK_UNTIL = 19 }; /* columns and rows */

static int is_masked(int i, int width)
{
    const int x = i % width, y = i / width;
    return x >= MASK_FROM && x < MASK_UNTIL && y >= MASK_FROM && y < MASK_UNTIL;
}

/** Writes a copy of a view's image, under a name of its own, with other values behind the mask. */
static void put_behind_mask(adcgs_scene_view *v, uint32_t number, float value)
{
    char name[64];
    adcgs_image image;
    assert_int_equal(adcgs_image_read(&image, v->path, &error), ADCGS_OK);
    for (int i = 0; i < image.width * image.height; i++)
        for (int c = 0; is_masked(i, image.width) && c < image.channels; c++)
            image.data[i * image.channels + c] = value * (float)((i + c + (int)number) % 3) / 2;
    snprintf(name, sizeof name, "behind_%u_%g.ppm", number, (double)value);
    assert_int_equal(adcgs_image_write(&image, in(name), 0, &error), ADCGS_OK);
    adcgs_image_free(&image);
    v->path = strdup(in(name));
}

/** A run on views with a mask, and its report at the end. */
static void run_behind_mask(float value, adcgs_buffer *end, double *psnr)
{
    adcgs_train_config config = small_config();
    adcgs_scene masked = *scene;
    const uint32_t n = masked.n_views[ADCGS_SPLIT_TRAIN];
    adcgs_scene_view *views = calloc(n, sizeof *views);
    masked.views[ADCGS_SPLIT_TRAIN] = views;
    for (uint32_t i = 0; i < n; i++) {
        views[i] = scene->views[ADCGS_SPLIT_TRAIN][i];
        put_behind_mask(&views[i], i, value);
        views[i].mask = strdup(in("mask.pgm"));
    }
    adcgs_trainer *t;
    assert_int_equal(adcgs_trainer_create(&t, &masked, &config, adcgs_cpu_best(), pool, &error), ADCGS_OK);
    t->quantise = adcgs_encode_quantise_hook;
    run(t, NULL, NULL);
    store(t, end);
    assert_int_equal(adcgs_sample_psnr(t, 4, psnr, &error), ADCGS_OK);
    assert_true(all_finite(t->f) && t->run.rollbacks == 0);
    adcgs_trainer_free(&t);
    for (uint32_t i = 0; i < n; i++) {
        unlink(views[i].path);
        adcgs_scene_view_clear(&views[i]);
    }
    free(views);
}

/** Pixels behind a mask have no effect: with any values the run ends in the same state, to the bit. */
static void masked_pixels_have_no_part(void **state)
{
    const int side = 32; /* of the tiny scene's images */
    adcgs_image mask;
    adcgs_buffer dark, bright;
    double psnr[2];
    assert_int_equal(adcgs_image_alloc(&mask, side, side, 1, "mask", &error), ADCGS_OK);
    for (int i = 0; i < side * side; i++)
        mask.data[i] = !is_masked(i, side);
    assert_int_equal(adcgs_image_write(&mask, in("mask.pgm"), 0, &error), ADCGS_OK);
    adcgs_image_free(&mask);
    run_behind_mask(0, &dark, &psnr[0]);
    run_behind_mask(1, &bright, &psnr[1]);
    assert_same(&dark, &bright);
    assert_true(psnr[0] == psnr[1] && psnr[0] > 10);
    adcgs_buffer_clear(&dark);
    adcgs_buffer_clear(&bright);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(black_levels_are_found),      cmocka_unit_test(cameras_are_evened_out),
        cmocka_unit_test(gains_are_bounded_by_images), cmocka_unit_test(burnt_pixels_are_lower_bounds),
        cmocka_unit_test(backgrounds_have_no_gain),    cmocka_unit_test(lambda_follows_contrast),
        cmocka_unit_test(crops_are_parts_of_pictures), cmocka_unit_test(masked_pixels_have_no_part),
    };
    return cmocka_run_group_tests_name("exposure", tests, open_scene, close_scene);
}
