/* SPDX-License-Identifier: BSD-2-Clause */
/** \file .4dgs: written clips, read back within the stated bounds. */
#include "outside_files.h"

#ifdef HAVE_SPZ

#include "clip_frames.h"

#include "media/dynamic/dynamic_splats.h"
#include "media/dynamic/fourdgs_write.h"

#include <math.h>

#define STEP 0.002 /* of positions, a fraction of the distances between splats; chosen by hand */

static const double place[3] = {4510728.0, -1512344.0, 4260120.0};

/** All values within half a step; a component of a rotation that follows from the others within two. */
static void expect_frame(const adcgs_splats *is, const adcgs_splats *was)
{
    assert_int_equal(is->n, was->n);
    for (uint32_t i = 0; i < was->n; i++) {
        double dot = 0.0;
        near(is->opacity[i], was->opacity[i], 0.0, 0.5 / 255.0 + 1e-6);
        for (int a = 0; a < 3; a++) {
            const double wrong = (double)is->mean[a][i] + (is->offset[a] - was->offset[a]) - (double)was->mean[a][i];
            assert_true(fabs(wrong) <= 0.5 * STEP + 1e-5);
            near((float)log((double)is->scale[a][i] / (double)was->scale[a][i]), 0.0f, 0.0, 0.5 / 64.0 + 1e-5);
            near(is->colour[a][i], (float)fmin(fmax((double)was->colour[a][i], 0.0), 1.0), 0.0, 0.5 / 255.0 + 1e-6);
        }
        for (int a = 0; a < 4; a++)
            dot += (double)is->rotation[a][i] * (double)was->rotation[a][i];
        for (int a = 0; a < 4; a++)
            near(is->rotation[a][i], (dot < 0.0 ? -1.0f : 1.0f) * was->rotation[a][i], 0.0, 2.0 / 512.0);
    }
}

/** Rows stay in order, since they are sorted by id. Frames are read backwards, so that states are composed from keyframes. */
static void expect_clip(const char *name, const adcgs_splats *frames, uint32_t n_frames)
{
    const adcgs_dynamic_options options = {.rate = {25, 1}};
    adcgs_dynamic *d;
    adcgs_splats s;
    size_t bytes;
    uint8_t *const file = load_file(name, &bytes);
    expect_good(adcgs_dynamic_parse(&d, file, bytes, name, &options, &error));
    assert_true(d->frames == n_frames);
    for (uint32_t f = n_frames; f-- > 0;) {
        expect_good(adcgs_dynamic_at(d, (f + 0.5 * (f % 2)) / 25.0, &s, &error));
        expect_frame(&s, &frames[f]);
        adcgs_splats_free(&s);
    }
    adcgs_dynamic_free(&d);
    free(file);
}

static void test_clips(void **state)
{
    static const struct {
        uint32_t n, frames, group;
        int is_far;
    } cases[] = {{N, FRAMES, 0, 0}, {N, FRAMES, 1, 0}, {N, 1, 0, 0}, {1, 3, 2, 0}, {N, 20, 64, 1}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        adcgs_splats frames[FRAMES];
        make_frames(frames, cases[k].n, cases[k].frames);
        for (uint32_t f = 0; f < cases[k].frames && cases[k].is_far; f++)
            memcpy(frames[f].offset, place, sizeof place);
        const adcgs_splat_clip clip = {frames, cases[k].frames, 25.0, cases[k].group, STEP};
        expect_good(adcgs_fourdgs_write(&clip, in("c.4dgs"), &error));
        expect_clip("c.4dgs", frames, cases[k].frames);
        free_frames(frames, cases[k].frames);
    }
}

/** A clip in which nothing changes takes a few hundred bytes a frame. */
static void test_static(void **state)
{
    adcgs_splats frames[8];
    size_t one, all;
    for (int f = 0; f < 8; f++)
        frames[f] = random_splats(N, 1.0, 0.0, 3);
    expect_good(adcgs_fourdgs_write(&(adcgs_splat_clip){frames, 1, 30.0, 0, 0.0}, in("one.4dgs"), &error));
    expect_good(adcgs_fourdgs_write(&(adcgs_splat_clip){frames, 8, 30.0, 0, 0.0}, in("all.4dgs"), &error));
    free(load_file("one.4dgs", &one));
    free(load_file("all.4dgs", &all));
    assert_true(all - one < 7 * 256);
    frames[3].offset[0] = 1.0;
    expect_error(adcgs_fourdgs_write(&(adcgs_splat_clip){frames, 8, 30.0, 0, 0.0}, in("x.4dgs"), &error), ADCGS_ERR_USAGE,
                 "x.4dgs: frame 3", "the same offset");
    free_frames(frames, 8);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_clips), cmocka_unit_test(test_static)};
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

#else

int main(void)
{
    puts("skipped: this build has no zlib");
    return 77;
}

#endif
