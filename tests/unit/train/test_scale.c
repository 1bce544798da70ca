/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Scenes in other units train the same: to the last bit for powers of two, otherwise except for rounding.
 */
#include "tiny_scene.h"

#include "encode/encode.h"
#include "metric/evaluate.h"
#include "metric/metric.h"
#include "scene/extent.h"
#include "scene/layouts/open.h"
#include "train/scene_frame.h"

#include <jansson.h>
#include <adcgs/decoder.h>

#include <math.h>

/** The result of a short run in some units. */
typedef struct result {
    double psnr, decoded;     /**< PSNR of training views; PSNR of test views from the stream */
    double near_plane, scale; /**< in the original units */
    uint32_t anchors;
    float *colours; /**< of the anchors */
    size_t n_colours;
} result;

/** Rewrites a file of transforms with all translations multiplied by a factor. */
static void scale_file(const char *name, double factor)
{
    char path[600], whole[610];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    snprintf(whole, sizeof whole, "%s.whole", path); /* the original file */
    json_t *root = json_load_file(whole, 0, NULL), *frame;
    if (!root) {
        assert_int_equal(rename(path, whole), 0);
        root = json_load_file(whole, 0, NULL);
    }
    assert_non_null(root);
    size_t i;
    json_array_foreach(json_object_get(root, "frames"), i, frame)
    {
        json_t *matrix = json_object_get(frame, "transform_matrix");
        for (size_t row = 0; row < 3; row++) {
            json_t *values = json_array_get(matrix, row);
            json_array_set_new(values, 3, json_real(factor * json_number_value(json_array_get(values, 3))));
        }
    }
    assert_int_equal(json_dump_file(root, path, 0), 0);
    json_decref(root);
}

static double decoded_psnr(const adcgs_trainer *t, const adcgs_scene *scaled)
{
    adcgs_stream stream;
    adcgs_buffer bytes;
    adcgs_decoder *decoder;
    adcgs_config config;
    adcgs_evaluation e;
    adcgs_buffer_init(&bytes);
    assert_int_equal(adcgs_encode_stream(&stream, t, NULL, 0, &error), ADCGS_OK);
    if (adcgs_encode_verified(&stream, &bytes, t->cpu, pool, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    adcgs_config_init(&config, sizeof config);
    config.cpu = t->cpu;
    assert_int_equal(adcgs_open_memory(&decoder, bytes.data, bytes.size, &config, &error), ADCGS_OK);
    assert_int_equal(adcgs_evaluate(&e, decoder, scaled, ADCGS_SPLIT_TEST, 0, NULL, NULL, &error), ADCGS_OK);
    adcgs_close(&decoder);
    adcgs_buffer_clear(&bytes);
    adcgs_stream_clear(&stream, NULL);
    return e.psnr;
}

static result train_scaled(double factor)
{
    adcgs_train_config config = small_config();
    adcgs_scene *scaled;
    adcgs_trainer *t;
    int stopped;
    result r;
    config.iterations = 150;
    for (int s = 0; s < ADCGS_SPLITS; s++) {
        char name[64];
        snprintf(name, sizeof name, "transforms_%s.json", adcgs_split_name((adcgs_split)s));
        scale_file(name, factor);
    }
    if (adcgs_scene_open(&scaled, folder, NULL, &error) != ADCGS_OK)
        fail_msg("%g: %s", factor, error.text);
    assert_int_equal(adcgs_trainer_create(&t, scaled, &config, adcgs_cpu_best(), pool, &error), ADCGS_OK);
    t->quantise = adcgs_encode_quantise_hook;
    if (adcgs_trainer_run(t, NULL, NULL, &stopped, &error) != ADCGS_OK)
        fail_msg("%g: %s", factor, error.text);
    r.psnr = adcgs_psnr_from_mse(t->run.mean_mse);
    r.decoded = decoded_psnr(t, scaled);
    r.near_plane = scaled->views[ADCGS_SPLIT_TRAIN][0].camera.near_plane / factor;
    r.scale = t->scale / factor;
    r.anchors = t->f->n;
    r.n_colours = t->f->param[ADCGS_P_COLOUR].n;
    r.colours = malloc(r.n_colours * sizeof *r.colours);
    memcpy(r.colours, t->f->param[ADCGS_P_COLOUR].p, r.n_colours * sizeof *r.colours);
    adcgs_trainer_free(&t);
    adcgs_scene_free(&scaled);
    return r;
}

static void units_do_not_matter(void **state)
{
    static const struct {
        double factor;
        int exact;
    } rows[] = {{0x1p-20, 1}, {0x1p-13, 1}, {0x1p13, 1}, {0x1p20, 1}, {1e-6, 0}, {1e-4, 0}, {1e4, 0}, {1e6, 0}};
    unlink(in("points3d.ply")); /* else the points determine the units */
    const result one = train_scaled(1);
    if (!(one.psnr > 12 && one.decoded > 12))
        fail_msg("%g and %g dB", one.psnr, one.decoded);
    for (size_t i = 0; i < ADCGS_COUNTOF(rows); i++) {
        const result r = train_scaled(rows[i].factor);
        assert_true(fabs(r.near_plane / one.near_plane - 1) < 1e-12 && fabs(r.scale / one.scale - 1) < 1e-12);
        if (rows[i].exact) {
            assert_int_equal(r.anchors, one.anchors);
            assert_int_equal(r.n_colours, one.n_colours);
            assert_memory_equal(r.colours, one.colours, one.n_colours * sizeof *one.colours);
            assert_true(r.psnr == one.psnr && r.decoded == one.decoded);
        } else if (!(fabs(r.psnr - one.psnr) < 0.3 && fabs(r.decoded - one.decoded) < 0.3))
            fail_msg("%g: %.3f and %.3f dB, expected %.3f and %.3f", rows[i].factor, r.psnr, r.decoded, one.psnr, one.decoded);
        free(r.colours);
    }
    free(one.colours);
}

/* ---- Cameras without evidence of distance ---- */

enum { VIEWS = 5 };

/** Views of a camera array, or of a panorama, in some units, with or without points. */
static void put_views(adcgs_scene *s, adcgs_scene_view views[VIEWS], int panorama, double factor)
{
    memset(views, 0, VIEWS * sizeof *views);
    for (int v = 0; v < VIEWS; v++) {
        double *m = views[v].camera.cam_to_world;
        const double angle = panorama ? v : 0;
        m[0] = m[10] = cos(angle);
        m[2] = sin(angle);
        m[8] = -sin(angle);
        m[5] = 1;
        m[3] = factor * (panorama ? 5 : 5 + 0.25 * v);
        m[11] = factor * -3;
    }
    s->n_views[ADCGS_SPLIT_TRAIN] = VIEWS;
    s->views[ADCGS_SPLIT_TRAIN] = views;
}

/** Parallel cameras, and cameras in one place: the assumed distance of the scene scales with the units, too. */
static void frames_go_with_units(void **state)
{
    static const double factors[] = {0x1p-30, 0x1p-20, 0x1p20, 0x1p30};
    for (int kind = 0; kind < 8; kind++) {
        const int panorama = kind & 1, points = kind >> 1 & 1, bound = kind >> 2;
        double origin[3] = {0}, scale = 0;
        for (int i = -1; i < (int)ADCGS_COUNTOF(factors); i++) {
            const double factor = i < 0 ? 1 : factors[i];
            adcgs_scene_view views[VIEWS];
            adcgs_scene s = {.near_bound = bound ? 0.5 * factor : 0};
            double position[3][3];
            double x[3], length;
            put_views(&s, views, panorama, factor);
            for (int p = 0; p < 3; p++)
                for (int a = 0; a < 3; a++)
                    position[p][a] = factor * (1 + 3 * p + a);
            if (points) {
                s.points.n = 3;
                s.points.position = position;
            }
            double extent;
            assert_int_equal(adcgs_scene_frame(&s, x, &length, &error), ADCGS_OK);
            assert_int_equal(adcgs_scene_extent(&s, &extent, &error), ADCGS_OK);
            assert_true(length > 0 && isfinite(length) && extent > 0);
            if (i < 0) {
                memcpy(origin, x, sizeof x);
                scale = length;
            } else if (points || bound || !panorama) { /* else nothing has a length, and any unit is right */
                assert_true(length == factor * scale);
                for (int a = 0; a < 3; a++)
                    assert_true(fabs(x[a] - factor * origin[a]) <= 1e-12 * length);
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(units_do_not_matter), cmocka_unit_test(frames_go_with_units)};
    return cmocka_run_group_tests(tests, open_scene, close_scene);
}
