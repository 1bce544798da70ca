/* SPDX-License-Identifier: BSD-2-Clause */
/** \file .splat4d: written clips, read back within the stated bounds. */
#include "outside_files.h"

#ifdef HAVE_SPZ

#include "clip_frames.h"

#include "media/dynamic/dynamic_splats.h"
#include "media/dynamic/splat4d_write.h"

#include <math.h>

#define STEP 0.002 /* of positions, a fraction of the distances between splats; chosen by hand */

static double clip01(float v)
{
    return fmin(fmax((double)v, 0.0), 1.0);
}

/** A splat within the bounds: half a step if it changes, else a step. */
static void expect_row(const adcgs_splats *is, uint32_t k, const adcgs_splats *was, uint32_t i, int is_clip)
{
    const double turn = (i % 3 || !is_clip ? 1.2 : 0.5 * ADCGS_SPLAT4D_STEP_ROTATION) / 128.0;
    double dot = 0.0;
    for (int a = 0; a < 3; a++) {
        near(is->mean[a][k], was->mean[a][i], 1e-6, (i % 2 ? 1.0 : 0.5) * STEP + 1e-6);
        near((float)log((double)is->scale[a][k] / (double)was->scale[a][i]), 0.0f, 0.0,
             (i % 11 ? 1.0 : 0.5) * ADCGS_SPLAT4D_STEP_SCALE + 1e-5);
        near(is->colour[a][k], (float)clip01(was->colour[a][i]), 0.0, (i % 5 ? 1.0 : 0.5) / 255.0 + 1e-6);
    }
    near(is->opacity[k], was->opacity[i], 0.0, (i % 7 ? 1.0 : 0.5) / 255.0 + 1e-6);
    for (int a = 0; a < 4; a++)
        dot += (double)is->rotation[a][k] * (double)was->rotation[a][i];
    for (int a = 0; a < 4; a++) /* the length is rounded, too */
        near(is->rotation[a][k], (dot < 0.0 ? -1.0f : 1.0f) * was->rotation[a][i], 0.0, 2.0 * turn);
}

static uint32_t nearest(const adcgs_splats *s, const adcgs_splats *to, uint32_t i)
{
    uint32_t found = 0;
    double least = INFINITY;
    for (uint32_t k = 0; k < s->n; k++) {
        double sum = 0.0;
        for (int a = 0; a < 3; a++)
            sum += pow((double)s->mean[a][k] - (double)to->mean[a][i], 2.0);
        if (sum < least) {
            least = sum;
            found = k;
        }
    }
    return found;
}

/** Reads all frames back; rows that are the nearest in the first frame stay the same splats. */
static void expect_clip(const char *name, const adcgs_splats *frames, uint32_t n_frames)
{
    uint32_t row[N];
    adcgs_dynamic *d;
    adcgs_splats s;
    size_t bytes;
    uint8_t *const file = load_file(name, &bytes);
    expect_good(adcgs_dynamic_parse(&d, file, bytes, name, NULL, &error));
    assert_true(d->n == frames->n && d->frames == n_frames && d->has_identity);
    for (uint32_t f = 0; f < n_frames; f++) {
        expect_good(adcgs_dynamic_at(d, f / adcgs_fps_value(d->rate), &s, &error));
        assert_int_equal(s.n, frames->n);
        for (uint32_t i = 0; i < s.n; i++) {
            row[i] = f ? row[i] : nearest(&s, frames, i);
            expect_row(&s, row[i], &frames[f], i, n_frames > 1);
        }
        adcgs_splats_free(&s);
    }
    adcgs_dynamic_free(&d);
    free(file);
}

static void test_clips(void **state)
{
    static const struct {
        uint32_t n, frames, group;
    } cases[] = {{N, FRAMES, 0}, {N, FRAMES, 1}, {N, 1, 0}, {1, 3, 2}, {N, 20, 64}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        adcgs_splats frames[FRAMES];
        make_frames(frames, cases[k].n, cases[k].frames);
        const adcgs_splat_clip clip = {frames, cases[k].frames, 29.97, cases[k].group, STEP};
        expect_good(adcgs_splat4d_write(&clip, in("c.splat4d"), &error));
        expect_clip("c.splat4d", frames, cases[k].frames);
        free_frames(frames, cases[k].frames);
    }
}

/** A static clip has no groups' streams; the chosen step is a fraction of the scales. */
static void test_static(void **state)
{
    adcgs_splats frames[3];
    size_t bytes, more;
    for (int f = 0; f < 3; f++)
        frames[f] = random_splats(N, 1.0, 0.0, 3);
    adcgs_splat_clip clip = {frames, 3, 30.0, 0, 0.0};
    expect_good(adcgs_splat4d_write(&clip, in("s.splat4d"), &error));
    char *const text = (char *)load_file("s.splat4d", &bytes);
    assert_non_null(strstr(text + 12, "\"dyn\":{\"pos\":0,\"rot\":0,\"rgb\":0,\"alpha\":0,\"scale\":0}"));
    const char *const step = strstr(text + 12, "\"steps\":{\"pos\":0.00");
    assert_non_null(step);
    free(text);
    frames[1].mean[0][7] += 1.0f;
    expect_good(adcgs_splat4d_write(&clip, in("s.splat4d"), &error));
    free(load_file("s.splat4d", &more));
    assert_true(more > bytes);
    free_frames(frames, 3);
}

static void test_refused(void **state)
{
    adcgs_splats frames[2] = {random_splats(4, 1.0, 0.0, 3), random_splats(5, 1.0, 0.0, 3)};
    expect_error(adcgs_splat4d_write(&(adcgs_splat_clip){frames, 2, 30.0, 0, 0.0}, in("x.splat4d"), &error), ADCGS_ERR_USAGE,
                 "x.splat4d: frame 1 has 5 splats", "expected 4");
    expect_error(adcgs_splat4d_write(&(adcgs_splat_clip){frames, 0, 30.0, 0, 0.0}, in("x.splat4d"), &error),
                 ADCGS_ERR_UNSUPPORTED, "x.splat4d: 0 frames", "1 or more");
    expect_error(adcgs_splat4d_write(&(adcgs_splat_clip){frames, 1, 0.0, 0, 0.0}, in("x.splat4d"), &error), ADCGS_ERR_USAGE,
                 "x.splat4d: 0 frames a second", "expected 0.001");
    expect_error(adcgs_splat4d_write(&(adcgs_splat_clip){frames, 1, 30.0, 65, 0.0}, in("x.splat4d"), &error), ADCGS_ERR_USAGE,
                 "x.splat4d: 30 frames a second, 65 in a group", "up to 64");
    expect_error(adcgs_splat4d_write(&(adcgs_splat_clip){frames, 1, 30.0, 0, 1e-12}, in("x.splat4d"), &error),
                 ADCGS_ERR_UNSUPPORTED, "x.splat4d: positions up to", "2^29 steps");
    assert_true(access(in("x.splat4d"), F_OK) != 0);
    free_frames(frames, 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_clips),
        cmocka_unit_test(test_static),
        cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

#else

int main(void)
{
    puts("skipped: this build has no zstd");
    return 77;
}

#endif
