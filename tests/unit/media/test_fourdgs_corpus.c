/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The conformance corpus of .4dgs: files with the answers of a decoder, to 6 decimals, or the reason to refuse them. */
#include "dynamic_fixture.h"

#include "media/dynamic/dynamic_reader.h"
#include "media/dynamic/fourdgs_births.h"
#include "media/dynamic/fourdgs_states.h"

#define CORPUS SAMPLES "4dgs_corpus"
#define SAMPLE 16 /* splats of an answer, at most; definition (the corpus) */

static const json_t *get(const json_t *object, const char *key)
{
    const json_t *const value = json_object_get(object, key);
    if (!value)
        fail_msg("no %s", key);
    return value;
}

/** Whole numbers are strings. */
static uint64_t whole(const json_t *object, const char *key)
{
    const char *const text = json_string_value(get(object, key));
    return text ? strtoull(text, NULL, 10) : 0; /* null: not in this chunk */
}

static void near(double found, const json_t *wanted, double most, const char *what, int index)
{
    if (!json_is_number(wanted))
        fail_msg("no number of %s %d", what, index);
    expect_near(found, json_number_value(wanted), most + 1e-6 * fabs(json_number_value(wanted)), what, index);
}

/** Fields of one splat of the sample: names and numbers, in the order by which the corpus sorts splats. */
static void get_fields(double v[19], const adcgs_motion *m, const adcgs_fourdgs_window *window, uint32_t i)
{
    const adcgs_splats *const s = &m->base;
    const double all[19] = {(double)s->mean[0][i],      (double)s->mean[1][i],      (double)s->mean[2][i],
                            (double)s->scale[0][i],     (double)s->scale[1][i],     (double)s->scale[2][i],
                            (double)s->rotation[1][i],  (double)s->rotation[2][i],  (double)s->rotation[3][i],
                            (double)s->rotation[0][i],  (double)s->colour[0][i],    (double)s->colour[1][i],
                            (double)s->colour[2][i],    (double)s->opacity[i],      (double)m->motion[0][0][i],
                            (double)m->motion[0][1][i], (double)m->motion[0][2][i], (double)m->centre[i],
                            (double)m->sigma[i]};
    memcpy(v, all, sizeof all);
    assert_true(m->begin[i] >= (float)(window->begin - 1e-4) && m->end[i] <= (float)window->end);
}

static void expect_fields(const double v[19], const json_t *sample, size_t k)
{
    static const struct {
        const char *name;
        size_t first, n;
    } rows[] = {{"positions", 0, 3}, {"scales", 3, 3}, {"rotations", 6, 4}, {"colors", 10, 4}, {"motions", 14, 3}};
    for (size_t r = 0; r < ADCGS_COUNTOF(rows); r++)
        for (size_t c = 0; c < rows[r].n; c++)
            near(v[rows[r].first + c], json_array_get(json_array_get(get(sample, rows[r].name), k), c), 1e-6, rows[r].name,
                 (int)k);
    near(v[17], json_array_get(get(sample, "muT"), k), 1e-6, "muT", (int)k);
    const json_t *const sigma = json_array_get(get(sample, "sigmaT"), k);
    if (json_is_null(sigma))
        assert_true(isinf(v[18]));
    else
        near(v[18], sigma, 1e-6, "sigmaT", (int)k);
}

static const adcgs_motion *sorted;

static int compare_rows(const void *a, const void *b)
{
    static const adcgs_fourdgs_window all = {-INFINITY, INFINITY};
    double x[19], y[19];
    get_fields(x, sorted, &all, *(const uint32_t *)a);
    get_fields(y, sorted, &all, *(const uint32_t *)b);
    for (int k = 0; k < 19; k++) {
        const double p = isinf(x[k]) ? x[k] : rint(1e6 * x[k]), q = isinf(y[k]) ? y[k] : rint(1e6 * y[k]);
        if (p != q)
            return p < q ? -1 : 1;
    }
    return 0;
}

/** The splats' order in the answers; the caller frees it. */
static uint32_t *sort_rows(const adcgs_motion *m)
{
    uint32_t *const order = malloc(m->base.n * sizeof *order + 1);
    for (uint32_t i = 0; i < m->base.n; i++)
        order[i] = i;
    sorted = m;
    qsort(order, m->base.n, sizeof *order, compare_rows);
    return order;
}

/** The window of a splat is that of the sample, cut to its chunk. */
static void expect_window(const adcgs_fourdgs *f, const adcgs_motion *m, uint32_t row, const json_t *sample, size_t k)
{
    uint32_t chunk = 0, first = 0;
    while (row >= first + f->chunks[chunk].n)
        first += f->chunks[chunk++].n;
    const double begin = json_number_value(json_array_get(get(sample, "winLo"), k));
    const double end = json_number_value(json_array_get(get(sample, "winHi"), k));
    expect_near((double)m->begin[row], fmax(begin, f->chunks[chunk].begin), 2e-5, "begin", (int)k);
    expect_near((double)m->end[row], fmin(end, f->chunks[chunk].end), 2e-5, "end", (int)k);
}

static void expect_aggregate(const adcgs_motion *m, const uint32_t *order, const json_t *wanted)
{
    double opacity = 0.0, sum[3] = {0.0};
    uint64_t constant = 0, still = 0;
    for (uint32_t k = 0; k < m->base.n; k++) {
        const uint32_t i = order[k];
        opacity += (double)m->base.opacity[i];
        for (int a = 0; a < 3; a++)
            sum[a] += (double)m->base.mean[a][i];
        constant += isinf(m->sigma[i]);
        still += m->motion[0][0][i] == 0.0f && m->motion[0][1][i] == 0.0f && m->motion[0][2][i] == 0.0f;
    }
    near(opacity, get(wanted, "opacitySum"), 1e-7 * m->base.n, "opacitySum", 0);
    for (size_t a = 0; a < 3; a++)
        near(sum[a], json_array_get(get(wanted, "positionSum"), a), 1e-7 * m->base.n, "positionSum", (int)a); /* of binary32 */
    assert_true(constant == whole(wanted, "neverFadesCount") && still == whole(wanted, "zeroMotionCount"));
}

/** Checksum of all coefficients as bytes: of each splat, those of red, then green, then blue. */
static void expect_harmonics(const adcgs_motion *m, const uint32_t *order, const json_t *wanted)
{
    const size_t per = adcgs_fourdgs_coefficients(m->base.degree);
    size_t n = 0;
    if (json_is_null(wanted)) {
        assert_int_equal(m->base.degree, 0);
        return;
    }
    uint8_t *const bytes = malloc(m->base.n * 3 * per + 1);
    for (uint32_t k = 0; k < m->base.n; k++)
        for (size_t j = 0; j < 3 * per; j++)
            bytes[n++] = (uint8_t)rint(((double)m->base.harmonics[order[k] * 3 * per + j] + 4.0) * 255.0 / 8.0);
    assert_true(per == whole(wanted, "coefficients") && m->base.degree == json_integer_value(get(wanted, "degree")));
    assert_int_equal(adcgs_planes_crc32(bytes, n), whole(wanted, "crc"));
    free(bytes);
}

/** Poses of tracks, of a splat at the origin. */
static void expect_tracks(const adcgs_fourdgs *f, const json_t *objects)
{
    const json_t *const tracks = get(objects, "tracks");
    assert_int_equal(f->n_tracks, json_array_size(tracks));
    for (size_t i = 0; i < f->n_tracks; i++) {
        const json_t *const track = json_array_get(tracks, i), *const poses = get(track, "posesAt");
        const uint32_t object = (uint32_t)whole(track, "objectId");
        assert_true(f->tracks[i].object == object && f->tracks[i].n == whole(track, "sampleCount"));
        assert_int_equal(f->tracks[i].is_step, json_integer_value(get(track, "interpolation")));
        for (size_t k = 0; k < json_array_size(poses); k++) {
            const json_t *const pose = json_array_get(poses, k);
            adcgs_splats s;
            assert_int_equal(adcgs_splats_alloc(&s, 1, "one", &error), ADCGS_OK);
            assert_int_equal(adcgs_fourdgs_move(&s, &object, f, json_number_value(get(pose, "time")), &error), ADCGS_OK);
            for (size_t a = 0; a < 3; a++)
                near((double)s.mean[a][0], json_array_get(get(pose, "translation"), a), 1e-6, "translation", (int)k);
            for (size_t a = 0; a < 4; a++)
                near((double)s.rotation[(a + 1) % 4][0], json_array_get(get(pose, "rotation"), a), 1e-6, "rotation", (int)k);
            adcgs_splats_free(&s);
        }
    }
}

static void expect_header(const adcgs_fourdgs *f, const json_t *root)
{
    assert_string_equal(json_string_value(get(root, "temporalModel")), f->has_keyframes ? "keyframe-delta" : "gaussian-birth");
    assert_int_equal(f->n, whole(root, "gaussianCount"));
    near(f->cutoff, get(root, "cutoff"), 1e-6, "cutoff", 0);
    near(f->duration, get(root, "durationSec"), 1e-6, "duration", 0);
}

static void expect_births(const adcgs_fourdgs *f, const json_t *root)
{
    const json_t *const sample = get(root, "sample"), *const intervals = get(root, "chunkIntervals");
    adcgs_motion m;
    uint32_t *objects;
    if (adcgs_fourdgs_births(&m, &objects, f, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    uint32_t *const order = sort_rows(&m);
    assert_true(f->degree == json_integer_value(get(root, "shDegree")) && f->n_chunks == json_array_size(intervals));
    assert_true(json_is_true(get(root, "summaryCrcOk")) == (f->summary_crc != 0)); /* adcgs_fourdgs_read() has checked it */
    for (size_t i = 0; i < f->n_chunks; i++) {
        near(f->chunks[i].begin, json_array_get(json_array_get(intervals, i), 0), 1e-6, "begin", (int)i);
        near(f->chunks[i].end, json_array_get(json_array_get(intervals, i), 1), 1e-6, "end", (int)i);
    }
    assert_int_equal(json_array_size(get(sample, "positions")), ADCGS_MIN(m.base.n, SAMPLE));
    for (uint32_t k = 0; k < m.base.n && k < SAMPLE; k++) {
        double v[19];
        const adcgs_fourdgs_window window = {json_number_value(json_array_get(get(sample, "winLo"), k)),
                                             json_number_value(json_array_get(get(sample, "winHi"), k))};
        get_fields(v, &m, &window, order[k]);
        expect_fields(v, sample, k);
        expect_window(f, &m, order[k], sample, k);
        if (json_object_get(sample, "objectIds"))
            assert_int_equal(objects[order[k]],
                             strtoul(json_string_value(json_array_get(get(sample, "objectIds"), k)), NULL, 10));
    }
    expect_aggregate(&m, order, get(root, "aggregate"));
    expect_harmonics(&m, order, get(root, "sh"));
    if (json_object_get(root, "objects"))
        expect_tracks(f, get(root, "objects"));
    free(order);
    free(objects);
    adcgs_motion_free(&m);
}

static void expect_chunks(const adcgs_fourdgs *f, const json_t *list)
{
    adcgs_fourdgs_states states;
    assert_int_equal(f->n_chunks, json_array_size(list));
    assert_int_equal(adcgs_fourdgs_states_open(&states, f, &error), ADCGS_OK);
    for (uint32_t i = f->n_chunks; i-- > 0;) { /* backwards: each state is composed from its keyframe */
        const adcgs_fourdgs_chunk *const k = &f->chunks[i];
        const json_t *const wanted = json_array_get(list, i);
        const void *part;
        assert_string_equal(json_string_value(get(wanted, "kind")), k->is_delta ? "delta" : "keyframe");
        assert_int_equal(k->is_delta ? k->n : 0, whole(wanted, "birthCount"));
        assert_true(k->updates == whole(wanted, "updateCount") && k->deaths == whole(wanted, "deathCount"));
        assert_int_equal(k->depth, whole(wanted, "depth"));
        if (k->is_delta)
            assert_string_equal(json_string_value(get(wanted, "deltaMode")), k->mode ? "chained" : "keyframe-referenced");
        near(k->begin, get(wanted, "t0"), 1e-6, "t0", (int)i);
        near(k->end, get(wanted, "t1"), 1e-6, "t1", (int)i);
        assert_int_equal(adcgs_recent_take(&states.recent, i, &part, &error), ADCGS_OK);
        assert_int_equal(((const adcgs_fourdgs_state *)part)->n, whole(wanted, "liveCount"));
        adcgs_recent_give(&states.recent, part);
    }
    adcgs_fourdgs_states_close(&states);
}

static int is_near(double found, const json_t *array, size_t k, size_t a)
{
    const double wanted = json_number_value(json_array_get(json_array_get(array, k), a));
    return fabs(found - wanted) <= 1e-6 + 1e-6 * fabs(wanted);
}

/** True if visible splat i is row k of the sample. */
static int is_row(const adcgs_splats *s, uint32_t i, const json_t *sample, size_t k)
{
    const json_t *const scales = json_object_get(sample, "scales"), *const turns = json_object_get(sample, "orientations");
    int same = s->opacity[i] > 0.0f;
    for (size_t a = 0; a < 3; a++)
        same &= is_near((double)s->mean[a][i], get(sample, "positions"), k, a) &&
                (!scales || is_near((double)s->scale[a][i], scales, k, a));
    for (size_t a = 0; a < 4; a++)
        same &= !turns || is_near((double)s->rotation[(a + 1) % 4][i], turns, k, a);
    return same;
}

/** Compares the visible splats at a time; of these small files the sample has all of them. */
static void expect_state(const adcgs_dynamic *d, const json_t *state)
{
    const json_t *const sample = get(state, "sample"), *const sum = get(get(state, "aggregate"), "positionSum");
    const size_t n = json_array_size(get(sample, "positions"));
    double opacity = 0.0, total[3] = {0.0};
    size_t visible = 0;
    adcgs_splats s;
    assert_int_equal(d->reader->at(d, json_number_value(get(state, "t")), &s, &error), ADCGS_OK);
    for (uint32_t i = 0; i < s.n; i++) {
        visible += s.opacity[i] > 0.0f;
        opacity += (double)s.opacity[i];
        for (size_t a = 0; a < 3 && s.opacity[i] > 0.0f; a++)
            total[a] += (double)s.mean[a][i];
    }
    assert_true(visible == whole(state, "liveCount") && visible == n);
    for (size_t k = 0; k < n; k++) {
        uint32_t i = 0;
        while (i < s.n && !is_row(&s, i, sample, k))
            i++;
        if (i == s.n)
            fail_msg("no splat is row %zu", k);
    }
    near(opacity, get(get(state, "aggregate"), "opacitySum"), 2e-6, "opacitySum", 0);
    for (size_t a = 0; a < 3; a++)
        near(total[a], json_array_get(sum, a), 2e-6, "positionSum", (int)a);
    adcgs_splats_free(&s);
}

/** Answers that concern no splat: records that the reader skips. */
static void expect_known(const json_t *root)
{
    static const char *const known[] = {"aggregate", "chunkIntervals", "chunks", "cutoff", "durationSec", "gaussianCount",
                                        "objects", "sample", "sh", "shDegree", "states", "summaryCrcOk", "temporalModel",
                                        /* Skipped. */
                                        "attachments", "audioSources", "camera", "hasAudio", "headerAttributes", "library",
                                        "metadataRecords", "profile", "statistics", "summaryOffsets"};
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)(uintptr_t)root, key, value)
    {
        size_t i = 0;
        while (i < ADCGS_COUNTOF(known) && strcmp(known[i], key))
            i++;
        if (i == ADCGS_COUNTOF(known))
            fail_msg("the corpus has the answer %s", key);
    }
}

static void expect_file(const char *name, const json_t *root)
{
    char path[512];
    uint8_t *data;
    size_t bytes;
    snprintf(path, sizeof path, "%s/%s.4dgs", CORPUS, name);
    const char *const refused = json_string_value(json_object_get(root, "refused"));
    if (refused) {
        static const char *const parts[][2] = {{"magic-mismatch", "magic"},
                                               {"unknown-stream-codec", "codec 9, expected 0 (deflate) or 1 (zstd)"},
                                               {"window-index-out-of-range", "window"}};
        adcgs_dynamic *d;
        size_t i = 0;
        while (i < ADCGS_COUNTOF(parts) && strcmp(parts[i][0], refused))
            i++;
        assert_true(i < ADCGS_COUNTOF(parts));
        expect_error(adcgs_dynamic_open(&d, real_data(path), NULL, &error), i == 1 ? ADCGS_ERR_UNSUPPORTED : ADCGS_ERR_DATA, name,
                     parts[i][1]);
        return;
    }
    expect_known(root);
    assert_int_equal(adcgs_file_load(&data, &bytes, real_data(path), 1 << 20, &error), ADCGS_OK);
    adcgs_fourdgs f = {.path = name, .data = data, .bytes = bytes};
    if (adcgs_fourdgs_read(&f, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    expect_header(&f, root);
    if (f.has_keyframes)
        expect_chunks(&f, get(root, "chunks"));
    else
        expect_births(&f, root);
    adcgs_dynamic *d = open_sample(path, NULL);
    assert_true(d->has_identity && d->is_continuous && d->n == f.n && d->frames == ADCGS_MAX(1, ceil(30.0 * f.duration)));
    for (size_t i = 0; i < json_array_size(json_object_get(root, "states")); i++)
        expect_state(d, json_array_get(json_object_get(root, "states"), i));
    adcgs_dynamic_free(&d);
    adcgs_fourdgs_free(&f);
    free(data);
}

static void test_corpus(void **state)
{
    char folder_of_corpus[1024];
    int n = 0;
    if (adcgs_planes_check("corpus", ".4dgs", &error) != ADCGS_OK)
        skip();
    snprintf(folder_of_corpus, sizeof folder_of_corpus, "%s", real_data(CORPUS));
    DIR *const list = opendir(folder_of_corpus);
    assert_non_null(list);
    for (const struct dirent *entry; (entry = readdir(list));) {
        char path[2048], name[300];
        const size_t length = strlen(entry->d_name);
        if (length < 5 || strcmp(entry->d_name + length - 5, ".json"))
            continue;
        snprintf(path, sizeof path, "%s/%s", folder_of_corpus, entry->d_name);
        snprintf(name, sizeof name, "%.*s", (int)length - 5, entry->d_name);
        json_t *const root = json_load_file(path, 0, NULL);
        assert_non_null(root);
        print_message("%s\n", name);
        expect_file(name, root);
        json_decref(root);
        n++;
    }
    closedir(list);
    assert_int_equal(n, 21);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_corpus)};
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
