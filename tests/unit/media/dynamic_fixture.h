/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Files of splats over time with known values: ADCGS_DATA/splats4d/expected.json. */
#ifndef ADCGS_TESTS_MEDIA_DYNAMIC_FIXTURE_H
#define ADCGS_TESTS_MEDIA_DYNAMIC_FIXTURE_H

#include "outside_files.h"

#include "media/dynamic/dynamic_splats.h"
#include "system/file.h"

#include <jansson.h>
#include <math.h>

#define SAMPLES "splats4d/"

/** Largest differences from the expected values. */
typedef struct tolerance {
    double position, colour, alpha, scale, rotation;
} tolerance;

/** A member of expected.json; the caller drops *root. */
static inline json_t *expected(json_t **root, const char *name)
{
    *root = json_load_file(real_data(SAMPLES "expected.json"), 0, NULL);
    assert_non_null(*root);
    json_t *const member = json_object_get(*root, name);
    assert_non_null(member);
    return member;
}

static inline double number_of(const json_t *splat, const char *key, size_t i)
{
    const json_t *const value = json_object_get(splat, key);
    assert_non_null(value);
    return json_number_value(json_is_array(value) ? json_array_get(value, i) : value);
}

static inline void expect_near(double found, double wanted, double most, const char *what, int index)
{
    if (!(fabs(found - wanted) <= most))
        fail_msg("splat %d: %s %.7g, expected %.7g within %g", index, what, found, wanted, most);
}

/** Compares splat `row` with an entry of expected.json; absent members are not compared. */
static inline void expect_splat(const adcgs_splats *s, uint32_t row, const json_t *wanted, const tolerance *most)
{
    const int index = (int)json_integer_value(json_object_get(wanted, "index"));
    assert_true(row < s->n);
    for (size_t a = 0; a < 3; a++) {
        expect_near((double)s->mean[a][row], number_of(wanted, "position", a), most->position, "position", index);
        if (json_object_get(wanted, "rgb"))
            expect_near((double)s->colour[a][row], number_of(wanted, "rgb", a), most->colour, "colour", index);
        if (json_object_get(wanted, "scale"))
            expect_near((double)s->scale[a][row], number_of(wanted, "scale", a), most->scale, "scale", index);
    }
    if (json_object_get(wanted, "alpha"))
        expect_near((double)s->opacity[row], number_of(wanted, "alpha", 0), most->alpha, "alpha", index);
    if (!json_object_get(wanted, "rotation_wxyz"))
        return;
    double dot = 0.0;
    for (size_t a = 0; a < 4; a++)
        dot += (double)s->rotation[a][row] * number_of(wanted, "rotation_wxyz", a);
    for (size_t a = 0; a < 4; a++)
        expect_near((dot < 0.0 ? -1.0 : 1.0) * (double)s->rotation[a][row], number_of(wanted, "rotation_wxyz", a), most->rotation,
                    "rotation", index);
}

/** Compares all answers of expected.json; `length` is the number of seconds of its unit of time. Rows are indices. */
static inline void expect_answers(const adcgs_dynamic *dynamic, const char *name, double length, const tolerance *most)
{
    json_t *root, *const answers = json_object_get(expected(&root, name), "answers");
    assert_true(json_array_size(answers) > 0);
    for (size_t i = 0; i < json_array_size(answers); i++) {
        const json_t *const answer = json_array_get(answers, i), *const splats = json_object_get(answer, "splats");
        adcgs_splats s;
        if (adcgs_dynamic_at(dynamic, length * number_of(answer, "t", 0), &s, &error) != ADCGS_OK)
            fail_msg("%s", error.text);
        for (size_t j = 0; j < json_array_size(splats); j++) {
            const json_t *const splat = json_array_get(splats, j);
            expect_splat(&s, (uint32_t)json_integer_value(json_object_get(splat, "index")), splat, most);
        }
        adcgs_splats_free(&s);
    }
    json_decref(root);
}

static inline adcgs_dynamic *open_sample(const char *name, const adcgs_dynamic_options *options)
{
    adcgs_dynamic *dynamic;
    const char *const path = real_data(name);
    if (adcgs_dynamic_open(&dynamic, path, options, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    return dynamic;
}

/** Reads a state of a file that may be damaged; all numbers must be finite. */
static inline void survive(const uint8_t *data, size_t bytes)
{
    adcgs_dynamic *dynamic;
    if (adcgs_dynamic_parse(&dynamic, data, bytes, "damaged", NULL, &error) != ADCGS_OK)
        return;
    for (int i = 0; i < 3; i++) {
        adcgs_splats s;
        if (adcgs_dynamic_at(dynamic, 0.5 * i * adcgs_dynamic_duration(dynamic), &s, &error) != ADCGS_OK)
            continue;
        for (uint32_t k = 0; k < s.n; k++)
            assert_true(isfinite(s.mean[0][k]) && s.scale[0][k] > 0.0f && isfinite(s.scale[0][k]) && s.opacity[k] >= 0.0f &&
                        s.opacity[k] <= 1.0f && isfinite(s.rotation[0][k]) && isfinite(s.colour[0][k]));
        adcgs_splats_free(&s);
    }
    adcgs_dynamic_free(&dynamic);
}

/** A sample, cut short at a hundred places or with single bytes replaced, neither crashes nor gives infinite numbers. */
static inline void survive_damage(const char *name)
{
    uint8_t *data;
    size_t bytes;
    uint32_t random = 1;
    assert_int_equal(adcgs_file_load(&data, &bytes, real_data(name), 1 << 24, &error), ADCGS_OK);
    for (size_t n = 0; n < bytes; n += n < 64 ? 1 : bytes / 100 + 1)
        survive(data, n);
    for (int i = 0; i < 200; i++) {
        random = random * 1664525 + 1013904223;
        const size_t at = i % 2 ? random % bytes : random % ADCGS_MIN(bytes, 2048); /* half of them in the header */
        const uint8_t before = data[at];
        data[at] = (uint8_t)(random >> 24);
        survive(data, bytes);
        data[at] = before;
    }
    free(data);
}

#endif
