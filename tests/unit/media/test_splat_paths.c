/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats over time as pieces, written as FTGS PLY and .splatv, and read back. */
#include "random_splats.h"

#include "media/dynamic/dynamic_splats.h"
#include "media/dynamic/splat_paths.h"

#include <stdio.h>
#include <stdlib.h>

#define PATHS 3
#define FRAMES 41

static adcgs_path_sample samples[PATHS][FRAMES];

/** Path 0 rests, path 1 moves straight, path 2 moves along a circle and is gone in the second half. */
static void make_paths(double opacity)
{
    for (int i = 0; i < PATHS; i++)
        for (int t = 0; t < FRAMES; t++) {
            const double turn = 0.1 * t;
            samples[i][t] = (adcgs_path_sample){
                .mean = {(float)(i == 1   ? 0.05 * t
                                 : i == 2 ? cos(turn)
                                          : 0.0),
                         (float)(10.0 * i + (i == 2 ? sin(turn) : 0.0)), 1.0f},
                .scale = {0.2f, 0.1f, 0.05f},
                .rotation = {t % 2 ? -1.0f : 1.0f}, /* the sign means nothing */
                .opacity = (float)(i == 2 && t > FRAMES / 2 ? 0.0 : opacity),
                .colour = {0.25f, 0.5f, 0.75f},
            };
        }
}

static void fit(adcgs_pieces *pieces, adcgs_piece_form form)
{
    const adcgs_splat_paths paths = {.n = PATHS, .clip = FRAMES, .frames = FRAMES, .tolerance = 1e-3, .sample = &samples[0][0]};
    *pieces = (adcgs_pieces){0};
    expect_good(adcgs_pieces_add(pieces, &paths, form, "x", &error));
    assert_int_equal(pieces->clip, FRAMES);
}

/** The pieces near a path: their weight together, and their mean position. */
static double seen(const adcgs_splats *s, int path, double mean[3])
{
    double left = 1.0, total = 0.0;
    for (int a = 0; a < 3; a++)
        mean[a] = 0.0;
    for (uint32_t i = 0; i < s->n; i++) {
        if (path != (int)rint((double)s->mean[1][i] / 10.0))
            continue;
        left *= 1.0 - (double)s->opacity[i];
        total += (double)s->opacity[i];
        for (int a = 0; a < 3; a++)
            mean[a] += (double)(s->opacity[i] * s->mean[a][i]);
    }
    for (int a = 0; a < 3 && total > 0.0; a++)
        mean[a] /= total;
    return 1.0 - left;
}

/** Reads a file back, and compares all frames with the paths. */
static void compare(const char *path, double opacity, uint32_t rows)
{
    const adcgs_dynamic_options options = {.frames = FRAMES, .rate = {30, 1}};
    adcgs_dynamic *d;
    expect_good(adcgs_dynamic_open(&d, path, &options, &error));
    assert_true(d->frames == FRAMES && d->n == rows && d->is_continuous);
    make_paths(opacity);
    for (int t = 0; t < FRAMES; t++) {
        adcgs_splats s;
        double mean[3];
        expect_good(adcgs_dynamic_at(d, t / 30.0, &s, &error));
        for (int i = 0; i < PATHS; i++) {
            const int is_edge = i == 2 && abs(t - FRAMES / 2) <= 4;
            const double alpha = seen(&s, i, mean);
            if (!is_edge && fabs(alpha - (double)samples[i][t].opacity) > 0.08)
                fail_msg("%s: path %d, frame %d: opacity %g, expected %g", path, i, t, alpha, (double)samples[i][t].opacity);
            for (int a = 0; a < 3 && !is_edge && alpha > 0.1; a++)
                if (fabs(mean[a] - (double)samples[i][t].mean[a]) > 0.05)
                    fail_msg("%s: path %d, frame %d: position %g, expected %g", path, i, t, mean[a],
                             (double)samples[i][t].mean[a]);
        }
        adcgs_splats_free(&s);
    }
    adcgs_dynamic_free(&d);
}

static void test_files(void **state)
{
    static const double opacities[] = {0.3, 0.95};
    (void)state;
    for (size_t i = 0; i < ADCGS_COUNTOF(opacities); i++) {
        adcgs_pieces p;
        make_paths(opacities[i]);
        fit(&p, ADCGS_PIECE_LINEAR);
        assert_true(p.n >= 4 && p.n <= 30);
        expect_good(adcgs_ftgs_write(&p, "test", in("a.ftgs.ply"), &error));
        compare(in("a.ftgs.ply"), opacities[i], p.n);
        free(p.piece);
        make_paths(opacities[i]);
        fit(&p, ADCGS_PIECE_CUBIC);
        expect_good(adcgs_splatv_write(&p, NULL, 0, in("a.splatv"), &error));
        compare(in("a.splatv"), opacities[i], p.n);
        free(p.piece);
    }
}

/** A path at rest and a straight one are one row each, and equal the samples. */
static void test_straight(void **state)
{
    const adcgs_splat_paths paths = {.n = 2, .clip = FRAMES, .frames = FRAMES, .tolerance = 1e-3, .sample = &samples[0][0]};
    adcgs_pieces p = {0};
    adcgs_dynamic *d;
    (void)state;
    make_paths(0.5);
    expect_good(adcgs_pieces_add(&p, &paths, ADCGS_PIECE_LINEAR, "x", &error));
    assert_true(p.n == 2 && p.above == 0 && p.worst < 1e-3);
    expect_good(adcgs_ftgs_write(&p, "test", in("b.ftgs.ply"), &error));
    expect_good(adcgs_dynamic_open(&d, in("b.ftgs.ply"), NULL, &error));
    for (int t = 0; t < FRAMES; t++) {
        adcgs_splats s;
        expect_good(adcgs_dynamic_at(d, t / 30.0, &s, &error));
        for (uint32_t i = 0; i < 2; i++) {
            near(s.mean[0][i], samples[i][t].mean[0], 0.0, 1e-4);
            near(s.opacity[i], 0.5f, 0.0, 1e-4);
            near(s.scale[1][i], 0.1f, 1e-4, 0.0);
            near(s.colour[2][i], 0.75f, 0.0, 1e-5);
        }
        adcgs_splats_free(&s);
    }
    adcgs_dynamic_free(&d);
    free(p.piece);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_files), cmocka_unit_test(test_straight)};
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
