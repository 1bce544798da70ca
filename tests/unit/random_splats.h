/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats of any kind, and files of them, for the tests of their formats. */
#ifndef ADCGS_TESTS_RANDOM_SPLATS_H
#define ADCGS_TESTS_RANDOM_SPLATS_H

#include "outside_files.h"
#include "random_model.h"

#include "media/splats/splats.h"
#include "system/file.h"

#include <math.h>

static inline void expect_good(adcgs_status status)
{
    if (status != ADCGS_OK)
        fail_msg("%s", error.text);
}

static inline void near(float a, float b, double relative, double absolute)
{
    if (!(fabs((double)a - (double)b) <= relative * fabs((double)b) + absolute))
        fail_msg("%.9g, expected %.9g", (double)a, (double)b);
}

/** Expects read splats to equal the written ones, within relative errors of opacities and scales, and rounding of the others. */
static inline void same_splats(const adcgs_splats *a, const adcgs_splats *b, double opacity, double scale)
{
    assert_int_equal(a->n, b->n);
    for (uint32_t i = 0; i < a->n; i++) {
        near(a->opacity[i], b->opacity[i], opacity, 0.0);
        for (int c = 0; c < 3; c++) {
            assert_true(a->mean[c][i] == b->mean[c][i]);
            near(a->scale[c][i], b->scale[c][i], scale, 0.0);
            near(a->colour[c][i], b->colour[c][i], 0.0, 1.3e-7 * (1.0 + fabs((double)b->colour[c][i])));
        }
        for (int c = 0; c < 4; c++)
            near(a->rotation[c][i], b->rotation[c][i], 0.0, 2e-7);
    }
}

static inline float any(uint64_t *state, double lo, double hi)
{
    return (float)(lo + (hi - lo) * (double)adcgs_random_range(state, 0, 1 << 24) / (1 << 24));
}

/** n splats of any kind in [-1,1]^3 * size + offset. */
static inline adcgs_splats random_splats(uint32_t n, double size, double offset, uint64_t seed)
{
    adcgs_splats s;
    expect_good(adcgs_splats_alloc(&s, n, "random", &error));
    for (uint32_t i = 0; i < n; i++) {
        double length = 1e-9;
        for (int a = 0; a < 4; a++) {
            s.rotation[a][i] = any(&seed, -1.0, 1.0);
            length += (double)s.rotation[a][i] * (double)s.rotation[a][i];
        }
        for (int a = 0; a < 4; a++)
            s.rotation[a][i] = (float)((double)s.rotation[a][i] / sqrt(length));
        for (int a = 0; a < 3; a++) {
            s.mean[a][i] = (float)(offset + size * (double)any(&seed, -1.0, 1.0));
            s.scale[a][i] = (float)(size * exp((double)any(&seed, -5.0, -2.5)));
            s.colour[a][i] = any(&seed, -0.2, 1.2);
        }
        s.opacity[i] = any(&seed, 0.001, 0.99);
    }
    return s;
}

static inline adcgs_status write_splats(const adcgs_splats *splats, const char *path)
{
    return adcgs_splats_write(splats, &(adcgs_splats_style){.comment = "here"}, path, &error);
}

/** Loads a file of the folder; the caller frees it. */
static inline uint8_t *load_file(const char *name, size_t *bytes)
{
    uint8_t *data = NULL;
    expect_good(adcgs_file_load(&data, bytes, in(name), 1 << 24, &error));
    return data;
}

/** The end of one of a splat's axes, one standard deviation from its centre. */
static inline void tip(double out[3], const adcgs_splats *s, uint32_t i, int axis)
{
    const double w = (double)s->rotation[0][i], x = (double)s->rotation[1][i], y = (double)s->rotation[2][i];
    const double z = (double)s->rotation[3][i];
    const double m[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                            {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                            {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
    for (int a = 0; a < 3; a++)
        out[a] = (double)s->mean[a][i] + (double)s->scale[axis][i] * m[a][axis];
}

/** PlayCanvas' splat-transform (npm). ADCGS_SPLAT_TRANSFORM may be its command; by default it is searched on the path. */
static inline const char *splat_transform_command(void)
{
    const char *const given = getenv("ADCGS_SPLAT_TRANSFORM");
    return given ? given : "splat-transform";
}

/** Skips the test without the program. A test calls this first, before it owns anything. */
static inline void need_splat_transform(void)
{
    char line[1024];
    snprintf(line, sizeof line, "%s --version >/dev/null 2>&1", splat_transform_command());
    if (system(line)) {
        print_message("skipped: no splat-transform, and no ADCGS_SPLAT_TRANSFORM\n");
        skip();
    }
}

/** Runs the program on a file of the folder. */
static inline void splat_transform(const char *from, const char *options, const char *to)
{
    char line[2048];
    snprintf(line, sizeof line, "%s -w %s %s %s >%s 2>&1", splat_transform_command(), options, in(from), in(to),
             in("splat-transform.log"));
    if (system(line))
        fail_msg("%s", line);
}

/** PlayCanvas' program reads a file of the folder, with harmonics, as we do. */
static inline void expect_as_splat_transform(const char *name)
{
    adcgs_splats s, theirs;
    splat_transform(name, "", "theirs.ply");
    expect_good(adcgs_splats_read(&s, in(name), &error));
    expect_good(adcgs_splats_read(&theirs, in("theirs.ply"), &error));
    assert_true(s.n == theirs.n && s.degree == theirs.degree && s.degree > 0);
    for (uint32_t i = 0; i < s.n; i++) {
        double dot = 0.0;
        near(theirs.opacity[i], s.opacity[i], 1e-5, 2e-6);
        for (int a = 0; a < 3; a++) {
            near(theirs.mean[a][i], s.mean[a][i], 1e-5, 1e-6);
            near(theirs.scale[a][i], s.scale[a][i], 1e-5, 0.0);
            near(theirs.colour[a][i], s.colour[a][i], 1e-5, 1e-6);
        }
        for (int a = 0; a < 4; a++)
            dot += (double)theirs.rotation[a][i] * (double)s.rotation[a][i];
        assert_true(fabs(dot) > 0.99999);
    }
    for (size_t k = 0; k < s.n * 3 * (size_t)((s.degree + 1) * (s.degree + 1) - 1); k++)
        near(theirs.harmonics[k], s.harmonics[k], 0.0, 1e-5);
    adcgs_splats_free(&s);
    adcgs_splats_free(&theirs);
}

#endif
