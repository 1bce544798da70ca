/* SPDX-License-Identifier: BSD-2-Clause */
/** \file .4dgs: another encoder's samples, made files, messages, damage. test_fourdgs_corpus.c has the conformance corpus. */
#include "dynamic_fixture.h"

#ifdef HAVE_SPZ

#include "dynamic_threads.h"
#include "fourdgs_maker.h"

/* ---- Samples ---- */

static uint32_t find_nearest(const adcgs_splats *s, const json_t *position)
{
    uint32_t best = 0;
    double least = INFINITY;
    for (uint32_t i = 0; i < s->n; i++) {
        double square = 0.0;
        for (size_t a = 0; a < 3; a++)
            square += pow((double)s->mean[a][i] - json_number_value(json_array_get(position, a)), 2);
        if (square < least && s->opacity[i] > 0.0f)
            least = square, best = i;
    }
    return best;
}

static void test_births(void **state)
{
    json_t *root, *const wanted = expected(&root, "4dgs_birth"), *const list = json_object_get(wanted, "splats");
    adcgs_dynamic *d = open_sample(SAMPLES "4dgs/birth.4dgs", NULL);
    assert_true(d->n == 2700 && d->frames == 60 && d->rate.num == 30 && d->has_identity && d->is_continuous);
    adcgs_splats s = splats_at(d, 0.5);
    for (size_t k = 0; k < json_array_size(list); k++) {
        const json_t *const splat = json_array_get(list, k);
        const uint32_t i = find_nearest(&s, json_object_get(splat, "position"));
        double dot = 0.0;
        for (size_t a = 0; a < 3; a++) {
            expect_near((double)s.mean[a][i], number_of(splat, "position", a), 2e-6, "position", (int)k);
            expect_near((double)s.colour[a][i], number_of(splat, "rgb", a), 1e-5, "colour", (int)k);
        }
        expect_near((double)s.opacity[i], number_of(splat, "alpha_at_0_5", 0), 1e-5, "alpha", (int)k);
        for (size_t a = 0; a < 4; a++)
            dot += (double)s.rotation[(a + 1) % 4][i] * number_of(splat, "rotation_xyzw", a);
        expect_near(fabs(dot), 1.0, 1e-4, "rotation", (int)k);
    }
    json_decref(root);
    adcgs_splats_free(&s);
    adcgs_dynamic_free(&d);
}

static void test_keyframes(void **state)
{
    json_t *root, *const wanted = expected(&root, "4dgs_keyframe_delta"), *const live = json_object_get(wanted, "chunks");
    adcgs_dynamic *d = open_sample(SAMPLES "4dgs/keyframe_delta.4dgs", NULL);
    assert_true(d->n == 1997 && d->frames == 60 && d->has_identity);
    for (size_t k = 0; k < json_array_size(live); k++) {
        const size_t i = k * 3 % 8; /* not in order: states are composed from the keyframe */
        adcgs_splats s = splats_at(d, 0.25 * (double)i + 0.05);
        assert_true(s.n == d->n && count_visible(&s) == json_integer_value(json_array_get(live, i)));
        adcgs_splats_free(&s);
    }
    adcgs_splats s = splats_at(d, number_of(wanted, "at", 0));
    const uint32_t i = find_nearest(&s, json_object_get(wanted, "position"));
    for (size_t a = 0; a < 3; a++)
        expect_near((double)s.mean[a][i], number_of(wanted, "position", a), 2e-6, "position", 1200);
    adcgs_splats_free(&s);
    json_decref(root);
    adcgs_dynamic_free(&d);
}

static void test_clock(void **state)
{
    const adcgs_dynamic_options slow = {.rate = {24, 1},
                                        .frames = 7}; /* seconds are the file's: no number of frames changes them */
    const adcgs_dynamic_options fast = {.rate = {1000000, 1}};
    adcgs_dynamic *d = open_sample(SAMPLES "4dgs/birth.4dgs", &slow);
    assert_true(d->frames == 48 && d->rate.num == 24);
    adcgs_dynamic_free(&d);
    const char *const path = real_data(SAMPLES "4dgs/birth.4dgs");
    expect_error(adcgs_dynamic_open(&d, path, &fast, &error), ADCGS_ERR_UNSUPPORTED, "2e+06 frames", "a lower frame rate");
}

/* ---- Made files ---- */

static const made_splat two[2] = {{.id = 9, .position = {100, 0, 0}, .motion = 50, .centre = 0, .sigma = 0, .opacity = 40},
                                  {.id = 4, .position = {0, 200, -5}, .flags = 1, .opacity = 60, .object = 0x80000001u}};

/** All packings of streams and chunks give the same splats. */
static void test_packings(void **state)
{
    static const char *const packings[] = {"", "deflate", "zstd"};
    for (int i = 0; i < 6; i++) {
        made.codec = i % 2;
        made.packing = packings[i / 2];
        begin_file(&made, "gaussian-birth", 2, 1.0, 0, NULL);
        put_windows(&made, 1, 1.0);
        put_chunk(&made, 0.0, 1.0, 2, two, 0);
        adcgs_dynamic *d = parse_made(NULL);
        adcgs_splats s = splats_at(d, 0.5);
        assert_true(d->frames == 30 && s.n == 2);
        /* sigma 1: visible for sqrt(-2 ln 0.05) seconds, so that the step of the motion is a quarter: 50 * 0.02 / 4 a second */
        expect_near((double)s.mean[0][0], 1.0 + 0.5 * 0.25, 1e-6, "position", 0);
        expect_near((double)s.opacity[0], 0.8 * exp(-0.125), 1e-6, "alpha", 0);
        expect_near((double)s.mean[1][1], 2.0, 1e-6, "position", 1);
        assert_true(s.opacity[1] == 1.0f && s.rotation[0][1] == 1.0f && s.scale[2][0] == 1.0f);
        for (int a = 0; a < 3; a++)
            expect_near((double)s.colour[a][0], 0.2 * (a + 1), 1e-6, "colour", a);
        adcgs_splats_free(&s);
        adcgs_dynamic_free(&d);
    }
    made.packing = "";
}

/** Each frame shows the splat whose window begins with it, however the times are rounded. */
static void test_windows(void **state)
{
    enum { N = 3000 };
    static made_splat s[N];
    for (int i = 0; i < N; i++)
        s[i] = (made_splat){.position = {i * 7919 % N, i, 3}, .flags = 1, .opacity = 50, .window = i};
    begin_file(&made, "gaussian-birth", N, N / 30.0, 0, NULL);
    put_windows(&made, N, 1.0 / 30.0);
    put_chunk(&made, 0.0, N / 30.0, N, s, 0);
    adcgs_dynamic *d = parse_made(NULL);
    assert_int_equal(d->frames, N);
    for (uint32_t frame = 0; frame < N; frame += 7) {
        adcgs_splats at = splats_at(d, frame / 30.0);
        assert_true(count_visible(&at) == 1 && at.opacity[frame] > 0.0f);
        adcgs_splats_free(&at);
    }
    adcgs_dynamic_free(&d);
}

/** Splats are visible only in the interval of their chunk. */
static void test_intervals(void **state)
{
    begin_file(&made, "gaussian-birth", 2, 2.0, 0, NULL);
    put_windows(&made, 1, 2.0);
    put_chunk(&made, 0.0, 1.0, 1, two + 1, 0);
    put_chunk(&made, 1.0, 2.0, 1, two + 1, 0);
    adcgs_dynamic *d = parse_made(NULL);
    for (int i = 0; i < 2; i++) {
        adcgs_splats s = splats_at(d, i);
        assert_true(s.opacity[i] == 1.0f && s.opacity[1 - i] == 0.0f);
        adcgs_splats_free(&s);
    }
    adcgs_dynamic_free(&d);
}

/** Positions far from the origin keep the precision of their bins. */
static void test_far(void **state)
{
    const double origin[3] = {6378137.25, -4000000.5, 123.0};
    begin_file(&made, "gaussian-birth", 2, 1.0, 0, origin);
    put_windows(&made, 1, 1.0);
    put_chunk(&made, 0.0, 1.0, 2, two, 0);
    adcgs_dynamic *d = parse_made(NULL);
    adcgs_splats s = splats_at(d, 0.0);
    expect_near((double)s.mean[0][0] + s.offset[0], origin[0] + 1.0, 1e-6, "position", 0);
    expect_near((double)s.mean[1][1] + s.offset[1], origin[1] + 2.0, 1e-6, "position", 1);
    adcgs_splats_free(&s);
    adcgs_dynamic_free(&d);
}

/** A keyframe of two splats, then changes from 1 to 2 seconds. */
static void make_change(made_change *c, uint64_t count, int degree)
{
    made.codec = 0;
    begin_file(&made, "keyframe-delta", count, 2.0, degree, NULL);
    put_windows(&made, 1, 2.0);
    put_track(&made, 0x80000001u, 10.0);
    c->begin = c->begin ? c->begin : 1.0;
    c->end = 2.0;
    c->depth = c->depth ? c->depth : 1;
    c->keyframe = put_chunk(&made, 0.0, 1.0, 2, two, 1);
    c->reference += c->keyframe;
    if (degree)
        put_band(&made, 2, 100);
    put_change(&made, c);
    if (degree)
        put_band(&made, c->n_births, 200);
}

/** Births, deaths, updates, objects that move, and harmonics. Rows are ids: 4, 7, 9. */
static void test_changes(void **state)
{
    const made_splat update = {.id = 4, .position = {1, 0, 0}}, birth = {.id = 7, .flags = 1, .opacity = 25};
    made_change c = {.n_updates = 1, .updates = &update, .n_births = 1, .births = &birth, .n_deaths = 1, .deaths = two};
    make_change(&c, 3, 1);
    adcgs_dynamic *d = parse_made(NULL);
    assert_true(d->n == 3 && d->has_identity && d->frames == 60);
    adcgs_splats s = splats_at(d, 0.5);
    assert_true(s.n == 3 && s.opacity[0] == 1.0f && s.opacity[1] == 0.0f && s.opacity[2] > 0.0f);
    expect_near((double)s.mean[0][0], 5.0, 1e-6, "moved by its object", 4);
    for (size_t j = 0; j < 9; j++) { /* id 4 is the second splat of the chunk */
        expect_near((double)s.harmonics[j], -4.0 + (double)(109 + j) * 8.0 / 255.0, 1e-6, "harmonic", 4);
        expect_near((double)s.harmonics[18 + j], -4.0 + (double)(100 + j) * 8.0 / 255.0, 1e-6, "harmonic", 9);
    }
    adcgs_splats_free(&s);
    s = splats_at(d, 1.5);
    assert_true(s.opacity[0] == 1.0f && s.opacity[2] == 0.0f);
    expect_near((double)s.opacity[1], 0.5, 1e-6, "opacity", 7);
    expect_near((double)s.mean[0][0], 10.01, 1e-6, "updated, then moved", 4);
    expect_near((double)s.harmonics[9], -4.0 + 200.0 * 8.0 / 255.0, 1e-6, "harmonic", 7);
    adcgs_splats_free(&s);
    adcgs_dynamic_free(&d);
}

static void test_bad_changes(void **state)
{
    const made_splat nobody = {.id = 5}, far = {.id = 9, .position = {INT32_MAX, 0, 0}};
    const made_splat twice[2] = {{.id = 4}, {.id = 4}};
    const struct {
        made_change change;
        uint64_t count;
        const char *message;
    } cases[] = {
        {{.n_deaths = 1, .deaths = &nobody}, 2, "chunk 1: the id 5 dies, but does not exist"},
        {{.n_updates = 1, .updates = &nobody}, 2, "chunk 1: the id 5 changes, but does not exist"},
        {{.n_births = 1, .births = two}, 2, "chunk 1: the id 9 is born, but exists"},
        {{.n_updates = 1, .updates = two, .n_deaths = 1, .deaths = two}, 2, "the id 9 changes, but does not exist"},
        {{.n_deaths = 2, .deaths = twice}, 2, "the id 4 occurs twice in the deaths of chunk 1"},
        {{.n_updates = 1, .updates = &far}, 2, "the positions of id 9 leave 32 bits in chunk 1"},
        {{.n_updates = 1, .updates = two, .forbidden = 8}, 2, "updates sigmas, flags or windows, which never change"},
        {{.depth = 2}, 2, "chunk 1: depth 2,"},
        {{.reference = 1}, 2, "expected an earlier chunk there"},
        {{.begin = 1.1}, 2, "chunk 1 begins at 1.1 seconds, expected 1"},
        {{.n_updates = 1, .updates = two, .n_deaths = 2, .deaths = two}, 2, "chunk 1: 1 updates and 2 deaths of 2 splats"},
        {{.n_births = 0}, 3, "2 ids in its chunks, but 3 in its header"},
    };
    for (size_t i = 0; i < ADCGS_COUNTOF(cases); i++) {
        made_change c = cases[i].change;
        make_change(&c, cases[i].count, 0);
        refuse_made(ADCGS_ERR_DATA, "made", cases[i].message);
    }
}

/** Changes of all splats alike take a few bytes: they are no attack. */
static void test_small_changes(void **state)
{
    static made_splat s[SPLATS];
    for (uint32_t i = 0; i < SPLATS; i++)
        s[i] = (made_splat){.id = i, .position = {(int32_t)(i * 31 % 997), 0, 0}, .flags = 1, .opacity = 20};
    made.codec = 1;
    begin_file(&made, "keyframe-delta", SPLATS, 2.0, 0, NULL);
    put_windows(&made, 1, 2.0);
    const uint64_t k = put_chunk(&made, 0.0, 1.0, SPLATS, s, 1);
    const made_change c = {.begin = 1.0, .end = 2.0, .reference = k, .keyframe = k, .depth = 1, .n_deaths = SPLATS, .deaths = s};
    const size_t before = made.n;
    put_change(&made, &c);
    assert_true(made.n - before < SPLATS / 16);
    adcgs_dynamic *d = parse_made(NULL);
    for (int i = 0; i < 2; i++) {
        adcgs_splats at = splats_at(d, i);
        assert_true(at.n == SPLATS && count_visible(&at) == (i ? 0 : SPLATS));
        adcgs_splats_free(&at);
    }
    adcgs_dynamic_free(&d);
    made.codec = 0;
}

/** With far more ids than splats at a time, splats of different frames are not matched. */
static void test_many_ids(void **state)
{
    enum { CHUNKS = 10 };
    static made_splat s[SPLATS];
    begin_file(&made, "keyframe-delta", CHUNKS * SPLATS, CHUNKS, 0, NULL);
    put_windows(&made, 1, CHUNKS);
    for (uint32_t k = 0; k < CHUNKS; k++) {
        for (uint32_t i = 0; i < SPLATS; i++)
            s[i] = (made_splat){.id = k * SPLATS + i, .position = {(int32_t)(i * 31 % 997), 0, 0}, .flags = 1, .opacity = 20};
        put_chunk(&made, k, k + 1, SPLATS, s, 1);
    }
    adcgs_dynamic *d = parse_made(NULL);
    assert_true(!d->has_identity && d->n == SPLATS && strstr(d->remark, "70000 ids, at most 7000 at a time"));
    adcgs_splats at = splats_at(d, 5.5);
    assert_true(at.n == SPLATS && count_visible(&at) == SPLATS);
    adcgs_splats_free(&at);
    adcgs_dynamic_free(&d);
}

/* ---- Faults ---- */

static void test_messages(void **state)
{
    made.packing = "lz4";
    begin_file(&made, "gaussian-birth", 2, 1.0, 0, NULL);
    put_chunk(&made, 0.0, 1.0, 2, two, 0);
    refuse_made(ADCGS_ERR_UNSUPPORTED, "chunk 0 is packed by \"lz4\"", "deflate or zstd");
    made.packing = "";
    begin_file(&made, "deformation-field", 2, 1.0, 0, NULL);
    refuse_made(ADCGS_ERR_UNSUPPORTED, "\"deformation-field\"", "gaussian-birth or keyframe-delta");
    begin_file(&made, "gaussian-birth", 1, 1.0, 0, NULL);
    put_chunk(&made, 0.0, 1.0, 2, two, 0);
    refuse_made(ADCGS_ERR_DATA, "2 splats in its chunks", "1 in its header");
    begin_file(&made, "gaussian-birth", 2, 1.0, 1, NULL);
    put_chunk(&made, 0.0, 1.0, 2, two, 0);
    refuse_made(ADCGS_ERR_DATA, "chunk 0 has no band 1", "of 1");
    made.bytes[5] = '2';
    refuse_made(ADCGS_ERR_UNSUPPORTED, "version 2", "expected 1");
    begin_file(&made, "gaussian-birth", 0, 1.0, 0, NULL);
    put_track(&made, 3, 1.0);
    put_track(&made, 3, 1.0);
    refuse_made(ADCGS_ERR_DATA, "two tracks", "object 3");
}

/** The index is checked against its checksum, and against the chunks. */
static void test_index(void **state)
{
    uint8_t *data;
    size_t bytes;
    adcgs_dynamic *d;
    assert_int_equal(adcgs_file_load(&data, &bytes, real_data(SAMPLES "4dgs/keyframe_delta.4dgs"), 1 << 24, &error), ADCGS_OK);
    data[bytes - 37 - 77 - 60] ^= 1; /* the footer, the statistics, and the end of the last entry */
    expect_error(adcgs_dynamic_parse(&d, data, bytes, "x", NULL, &error), ADCGS_ERR_DATA, "entry of the index",
                 "differs from chunk 7");
    data[bytes - 37 - 77 - 60] ^= 1;
    data[bytes - 37 - 20] ^= 1; /* in the statistics */
    expect_error(adcgs_dynamic_parse(&d, data, bytes, "x", NULL, &error), ADCGS_ERR_DATA, "checksum of the index", "expected");
    data[bytes - 37 - 20] ^= 1;
    expect_error(adcgs_dynamic_parse(&d, data, bytes - 9, "x", NULL, &error), ADCGS_ERR_DATA, "ends early", "no magic");
    free(data);
}

/** A file of some bytes cannot request memory for many splats. */
static void test_claims(void **state)
{
    begin_file(&made, "gaussian-birth", 1 << 20, 1.0, 0, NULL);
    put_windows(&made, 1, 1.0);
    put_chunk(&made, 0.0, 1.0, 1, two, 0);
    adcgs_store_le32(made.bytes + made.record + 29, 1 << 20);
    refuse_made(ADCGS_ERR_DATA, "chunk 0: 1048576 splats", "16 in a byte");
}

static void test_damage(void **state)
{
    static const char *const names[] = {"4dgs/birth.4dgs", "4dgs/keyframe_delta.4dgs",
                                        "4dgs_corpus/KeyframeDeltaChurn-UseChunkIndex-UseCrc-UseStatistics.4dgs",
                                        "4dgs_corpus/SingleObject-UseChunkIndex-UseCrc.4dgs",
                                        "4dgs_corpus/MixedLifetimes-SHDegree1-UseChunkIndex-UseCrc.4dgs"};
    for (size_t i = 0; i < ADCGS_COUNTOF(names); i++) {
        char path[256];
        snprintf(path, sizeof path, SAMPLES "%s", names[i]);
        survive_damage(path);
    }
}

static void test_threads(void **state)
{
    adcgs_dynamic *d = open_sample(SAMPLES "4dgs/keyframe_delta.4dgs", NULL);
    expect_threads(d);
    adcgs_dynamic_free(&d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_births),   cmocka_unit_test(test_keyframes),     cmocka_unit_test(test_clock),
        cmocka_unit_test(test_packings), cmocka_unit_test(test_windows),       cmocka_unit_test(test_intervals),
        cmocka_unit_test(test_far),      cmocka_unit_test(test_changes),       cmocka_unit_test(test_bad_changes),
        cmocka_unit_test(test_many_ids), cmocka_unit_test(test_small_changes), cmocka_unit_test(test_messages),
        cmocka_unit_test(test_index),    cmocka_unit_test(test_claims),        cmocka_unit_test(test_damage),
        cmocka_unit_test(test_threads),
    };
    made.packing = "";
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

#else

int main(void)
{
    puts("skipped: this build has no zstd");
    return 77;
}

#endif
