/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The public interface: callers older and newer than the library, versions, errors of every function, strict limits, messages.
 */
#include "config.h"

#include "decoder_fixture.h"

#include <math.h>
#include <stdio.h>

#define GUARD 0xa5

/** Room for structs of any version, with guard bytes behind them. */
typedef union guarded {
    adcgs_config config;
    adcgs_info info;
    unsigned char bytes[2048];
} guarded;

static void assert_guarded(const guarded *g, size_t size)
{
    for (size_t i = size; i < sizeof g->bytes; i++)
        if (g->bytes[i] != GUARD)
            fail_msg("byte %zu was written, behind a struct of %zu bytes", i, size);
}

static void test_config_sizes(void **state)
{
    (void)state;
    const size_t sizes[] = {0, 3, sizeof(size_t), offsetof(adcgs_config, pool), sizeof(adcgs_config), sizeof(adcgs_config) + 72};
    for (size_t i = 0; i < ADCGS_COUNTOF(sizes); i++) {
        guarded g;
        memset(&g, GUARD, sizeof g);
        adcgs_config_init(&g.config, sizes[i]);
        assert_guarded(&g, sizes[i]);
        for (size_t k = sizeof(size_t); k < sizes[i]; k++)
            assert_int_equal(g.bytes[k], 0);
        if (sizes[i] >= sizeof(size_t))
            assert_int_equal(g.config.size, sizes[i]);
    }
}

static int layers_of(const fixture *f, const adcgs_config *config)
{
    adcgs_decoder *d = open_with(f, config);
    adcgs_info info;
    assert_int_equal(adcgs_get_info(d, &info, sizeof info, NULL), ADCGS_OK);
    adcgs_close(&d);
    return info.layers;
}

/** Fields beyond an older caller's struct are ignored. Fields of a newer caller beyond ours must have their defaults. */
static void test_callers_of_all_ages(void **state)
{
    const fixture *f = *state;
    adcgs_decoder *d = NULL;
    adcgs_error error = {ADCGS_OK, ""};
    guarded g;
    memset(&g, GUARD, sizeof g);
    adcgs_config_init(&g.config, offsetof(adcgs_config, pool));
    g.config.layers = 1;
    assert_int_equal(layers_of(f, &g.config), 1); /* a pool or a log made of guard bytes would crash */
    memset(&g, GUARD, sizeof g);
    adcgs_config_init(&g.config, sizeof(adcgs_config) + 16);
    g.config.layers = 2;
    assert_int_equal(layers_of(f, &g.config), 2);
    g.bytes[sizeof(adcgs_config) + 15] = 1;
    assert_int_equal(adcgs_open_memory(&d, f->bytes.data, f->bytes.size, &g.config, &error), ADCGS_ERR_UNSUPPORTED);
    assert_non_null(strstr(error.text, "does not know"));
    const size_t wrong[] = {0, 3, offsetof(adcgs_config, pool) - 1, 4097, SIZE_MAX};
    for (size_t i = 0; i < ADCGS_COUNTOF(wrong); i++) {
        adcgs_config_init(&g.config, sizeof g.config);
        g.config.size = wrong[i];
        assert_int_equal(adcgs_open_memory(&d, f->bytes.data, f->bytes.size, &g.config, &error), ADCGS_ERR_USAGE);
        assert_non_null(strstr(error.text, "adcgs_config_init"));
        assert_null(d);
    }
}

static void test_info_sizes(void **state)
{
    const fixture *f = *state;
    const size_t sizes[] = {sizeof(size_t), offsetof(adcgs_info, scene_origin), sizeof(adcgs_info), sizeof(adcgs_info) + 40};
    adcgs_decoder *d = open_with(f, NULL);
    adcgs_error error;
    for (size_t i = 0; i < ADCGS_COUNTOF(sizes); i++) {
        guarded g;
        memset(&g, GUARD, sizeof g);
        assert_int_equal(adcgs_get_info(d, &g.info, sizes[i], NULL), ADCGS_OK);
        assert_guarded(&g, sizes[i]);
        assert_int_equal(g.info.size, ADCGS_MIN(sizes[i], sizeof(adcgs_info)));
        if (sizes[i] > sizeof(size_t))
            assert_true(g.info.segments == 3 && g.info.anchors == fixture_anchors(f) && g.info.frame_rate == 30);
        if (sizes[i] >= sizeof(adcgs_info))
            assert_int_equal(g.info.metadata, f->stream.n_meta);
        for (size_t k = sizeof(adcgs_info); k < sizes[i]; k++)
            assert_int_equal(g.bytes[k], 0);
    }
    guarded g;
    assert_int_equal(adcgs_get_info(d, &g.info, sizeof(size_t) - 1, &error), ADCGS_ERR_USAGE);
    assert_int_equal(adcgs_get_info(d, &g.info, SIZE_MAX, &error), ADCGS_ERR_USAGE);
    adcgs_close(&d);
}

/** With the summary alone, a program renders splats as the decoder does, and knows when a stream is too long. REQ-REND-001 */
static void test_facts_for_rendering(void **state)
{
    const fixture *f = *state;
    const uint64_t bytes_max[] = {UINT64_C(4) << 20, UINT64_C(256) << 20, UINT64_C(64) << 30};
    fixture changed = *f;
    adcgs_view view;
    adcgs_info info;
    changed.bytes = (adcgs_buffer){0};
    for (int level = 1; level <= 3; level++) {
        changed.stream.level = (uint8_t)level;
        changed.stream.screen_filter = 0.25f * (float)level;
        changed.bytes.size = 0;
        assert_int_equal(adcgs_stream_write(&changed.stream, &changed.bytes, NULL), ADCGS_OK);
        adcgs_decoder *d = open_with(&changed, NULL);
        assert_int_equal(adcgs_get_info(d, &info, sizeof info, NULL), ADCGS_OK);
        assert_true(info.level == level && info.bytes_max == bytes_max[level - 1]);
        assert_true(info.screen_filter == 0.25f * (float)level);
        adcgs_close(&d);
    }
    adcgs_buffer_clear(&changed.bytes);
    assert_int_equal(adcgs_view_init(&view, &fixture_camera, info.scene_origin, info.scene_scale, NULL), ADCGS_OK);
    for (int i = 0; i < 9; i++)
        assert_true(view.rotation[i] == (i % 4 ? 0.0f : 1.0f));
    assert_true(view.translation[0] == 0 && view.translation[1] == 0 && view.translation[2] == 3.6f);
    assert_true(view.width == FIXTURE_WIDTH && view.height == FIXTURE_HEIGHT && view.near_plane == (float)(0.1 / 2.5));
    assert_true(view.fx == 60 && view.fy == 60 && view.cx == 30 && view.cy == 23);
    assert_true(view.limit[0] == (float)((-30 - 0.15 * FIXTURE_WIDTH) / 60) && view.limit[3] > (FIXTURE_HEIGHT - 23) / 60.0f);
}

static void test_metadata(void **state)
{
    const fixture *f = *state;
    adcgs_decoder *d = open_with(f, NULL);
    const int n = (int)f->stream.n_meta;
    assert_true(n > 0);
    for (int i = 0; i < n; i++)
        assert_string_equal(adcgs_get_metadata_key(d, i), f->stream.meta[i].key);
    assert_null(adcgs_get_metadata_key(d, n));
    assert_null(adcgs_get_metadata_key(d, -1));
    adcgs_close(&d);
}

static void test_version(void **state)
{
    char text[32];
    (void)state;
    assert_int_equal(adcgs_version_number(), ADCGS_VERSION);
    snprintf(text, sizeof text, "%u.%u.%u", (unsigned)(ADCGS_VERSION / 1000000), (unsigned)(ADCGS_VERSION / 1000 % 1000),
             (unsigned)(ADCGS_VERSION % 1000));
    assert_string_equal(adcgs_version_string(), text);
    assert_true(ADCGS_MAKE_VERSION(0, 1, 999) < ADCGS_MAKE_VERSION(0, 2, 0) && ADCGS_MAKE_VERSION(0, 999, 999) < 1000000);
}

/** A wrong call: its status, and a line that names the fault. */
#define ASSERT_REFUSED(call, word)                                 \
    do {                                                           \
        error = (adcgs_error){ADCGS_OK, ""};                       \
        assert_int_equal(call, ADCGS_ERR_USAGE);                   \
        assert_int_equal(error.status, ADCGS_ERR_USAGE);           \
        if (!strstr(error.text, word))                             \
            fail_msg("\"%s\" does not name %s", error.text, word); \
    } while (0)

static void test_errors(void **state)
{
    const fixture *f = *state;
    adcgs_decoder *d = open_with(f, NULL), *none = NULL;
    adcgs_camera camera = fixture_camera;
    adcgs_view view;
    adcgs_primitives primitives;
    adcgs_frame frame = {FIXTURE_WIDTH, FIXTURE_HEIGHT, NULL};
    adcgs_pool *pool;
    adcgs_info info = {0};
    adcgs_error error;
    uint8_t digest[16];
    ASSERT_REFUSED(adcgs_open_file(NULL, "x", NULL, &error), "out");
    ASSERT_REFUSED(adcgs_open_file(&none, NULL, NULL, &error), "path");
    ASSERT_REFUSED(adcgs_open_memory(&none, NULL, 1, NULL, &error), "data");
    ASSERT_REFUSED(adcgs_open_stream(&none, NULL, NULL, NULL, &error), "read");
    ASSERT_REFUSED(adcgs_get_info(NULL, &info, sizeof info, &error), "decoder");
    ASSERT_REFUSED(adcgs_get_info(d, &info, 1, &error), "size is 1");
    ASSERT_REFUSED(adcgs_get_camera(d, 1000, &camera, &error), "camera 1000");
    ASSERT_REFUSED(adcgs_get_camera(d, -1, &camera, &error), "camera -1");
    ASSERT_REFUSED(adcgs_get_model_digest(d, 3, digest, &error), "segment 3");
    ASSERT_REFUSED(adcgs_get_primitives(NULL, 0, &primitives, &error), "decoder");
    ASSERT_REFUSED(adcgs_get_primitives(d, 0, NULL, &error), "out");
    ASSERT_REFUSED(adcgs_get_splat_digest(d, 0, NULL, &error), "digest");
    ASSERT_REFUSED(adcgs_render(d, &fixture_camera, 0, NULL, &error), "frame");
    ASSERT_REFUSED(adcgs_render(d, &fixture_camera, 0, &frame, &error), "frame");
    ASSERT_REFUSED(adcgs_render(NULL, &fixture_camera, 0, &frame, &error), "adcgs_render: decoder");
    ASSERT_REFUSED(adcgs_render_depth(NULL, &fixture_camera, 0, NULL, NULL, &error), "adcgs_render_depth: decoder");
    ASSERT_REFUSED(adcgs_render_depth(d, NULL, 0, NULL, NULL, &error), "camera");
    ASSERT_REFUSED(adcgs_render_rgba8(d, &fixture_camera, 0, ADCGS_ALPHA_OPAQUE, NULL, 4, &error), "pixels");
    ASSERT_REFUSED(adcgs_view_init(NULL, &fixture_camera, info.scene_origin, 1, &error), "view");
    ASSERT_REFUSED(adcgs_view_init(&view, NULL, info.scene_origin, 1, &error), "camera");
    ASSERT_REFUSED(adcgs_view_init(&view, &fixture_camera, NULL, 1, &error), "origin");
    ASSERT_REFUSED(adcgs_view_init(&view, &fixture_camera, info.scene_origin, -1, &error), "scale");
    ASSERT_REFUSED(adcgs_pool_create(&pool, 257, &error), "257");
    ASSERT_REFUSED(adcgs_pool_wrap(&pool, 4, NULL, NULL, &error), "function");
    assert_int_equal(adcgs_get_info(NULL, &info, sizeof info, NULL), ADCGS_ERR_USAGE);
    assert_int_equal(adcgs_get_camera(d, 1000, &camera, NULL), ADCGS_ERR_USAGE);
    assert_null(adcgs_get_metadata(NULL, "title"));
    assert_null(adcgs_get_metadata(d, NULL));
    adcgs_close(NULL);
    adcgs_close(&d);
}

/** All calls that allocate, with or without an error. Returns how many hit the limit; no other failure is accepted. */
static int count_limits(const fixture *f, uint64_t limit, adcgs_error *error)
{
    static float rgb[3 * FIXTURE_WIDTH * FIXTURE_HEIGHT];
    static uint8_t pixels[4 * FIXTURE_WIDTH * FIXTURE_HEIGHT];
    adcgs_frame frame = {FIXTURE_WIDTH, FIXTURE_HEIGHT, rgb};
    adcgs_decoder *d = NULL;
    adcgs_primitives primitives;
    adcgs_config config;
    uint8_t digest[16];
    int hits = 0;
    adcgs_config_init(&config, sizeof config);
    config.memory_limit = limit;
    config.threads = 1;
    const adcgs_status opened = adcgs_open_memory(&d, f->bytes.data, f->bytes.size, &config, error);
    if (opened != ADCGS_OK) {
        assert_int_equal(opened, ADCGS_ERR_LIMIT);
        assert_true(!error || error->status == ADCGS_ERR_LIMIT);
        return 6;
    }
    const adcgs_status found[] = {
        adcgs_get_primitives(d, 0, &primitives, error),
        adcgs_get_splat_digest(d, 0.01, digest, error),
        adcgs_render(d, &fixture_camera, 0, &frame, error),
        adcgs_render_depth(d, &fixture_camera, 0, rgb, NULL, error),
        adcgs_render_rgba8(d, &fixture_camera, 0, ADCGS_ALPHA_STRAIGHT, pixels, 4 * FIXTURE_WIDTH, error),
    };
    for (size_t i = 0; i < ADCGS_COUNTOF(found); i++) {
        if (found[i] != ADCGS_OK)
            assert_int_equal(found[i], ADCGS_ERR_LIMIT);
        hits += found[i] != ADCGS_OK;
    }
    adcgs_close(&d);
    return hits;
}

/** A call that hits the memory limit returns that status, with and without an error argument. */
static void test_memory_limits(void **state)
{
    const fixture *f = *state;
    adcgs_error error;
    int seen[7] = {0};
    for (uint64_t limit = 1000; limit < 4000000; limit += limit / 40) {
        const int hits = count_limits(f, limit, NULL);
        assert_int_equal(count_limits(f, limit, &error), hits);
        seen[hits] = 1;
    }
    assert_true(seen[0] && seen[1] && seen[5] && seen[6]); /* no call, the largest image alone, all except opening, all */
}

/** The messages that a listener received. */
typedef struct heard {
    int warnings, infos;
    char warning[256], info[256];
} heard;

static void listen(void *user, adcgs_log_level level, const char *text)
{
    heard *h = user;
    assert_null(strchr(text, '\n'));
    if (level == ADCGS_LOG_WARNING)
        h->warnings++;
    else
        h->infos++;
    snprintf(level == ADCGS_LOG_WARNING ? h->warning : h->info, sizeof h->info, "%s", text);
}

static void test_log(void **state)
{
    const fixture *f = *state;
    const char *source = getenv("srcdir");
    char path[1024];
    heard h = {0};
    adcgs_decoder *d = NULL;
    adcgs_config config;
    adcgs_config_init(&config, sizeof config);
    config.log = listen;
    config.log_user = &h;
    d = open_with(f, &config);
    adcgs_close(&d);
    assert_true(h.warnings == 0 && h.infos == 1);
    assert_non_null(strstr(h.info, "3 segments"));
    assert_int_equal(adcgs_open_memory(&d, f->bytes.data, f->bytes.size - 1, &config, NULL), ADCGS_OK);
    adcgs_close(&d);
    assert_true(h.warnings == 1 && h.infos == 2);
    assert_non_null(strstr(h.warning, "before ENDC"));
    snprintf(path, sizeof path, "%s/conformance/vectors/good-unit-ancillary.adcgs", source ? source : ".");
    assert_int_equal(adcgs_open_file(&d, path, &config, NULL), ADCGS_OK);
    adcgs_close(&d);
    assert_true(h.warnings == 1 && h.infos > 3); /* some chunks were skipped */
}

/** The writer enforces the format's bounds. */
static void test_writer_limits(void **state)
{
    fixture *f = *state;
    adcgs_stream *s = &f->stream;
    adcgs_stored_camera *const cameras = s->cameras, *many = calloc(65536, sizeof *many);
    const uint32_t n_cameras = s->n_cameras;
    char *const key = s->meta[0].key, longer[66];
    adcgs_buffer out;
    adcgs_error error;
    adcgs_buffer_init(&out);
    assert_non_null(many);
    for (size_t i = 0; i < 65536; i++)
        many[i] = (adcgs_stored_camera){.camera = fixture_camera, .time = nan(""), .path = -1};
    s->cameras = many;
    s->n_cameras = 65536;
    assert_int_equal(adcgs_stream_write(s, &out, &error), ADCGS_ERR_LIMIT);
    assert_non_null(strstr(error.text, "65536 cameras"));
    s->cameras = cameras;
    s->n_cameras = n_cameras;
    memset(longer, 'k', 65);
    longer[65] = 0;
    s->meta[0].key = longer;
    assert_int_equal(adcgs_stream_write(s, &out, &error), ADCGS_ERR_LIMIT);
    assert_non_null(strstr(error.text, "key of 65 bytes"));
    longer[0] = 0;
    assert_int_equal(adcgs_stream_write(s, &out, &error), ADCGS_ERR_USAGE);
    s->meta[0].key = key;
    const uint32_t anchors = s->segments[0].n;
    s->segments[0].n = ADCGS_ANCHORS_MAX + 1; /* refused before any anchor is read */
    assert_int_equal(adcgs_stream_write(s, &out, &error), ADCGS_ERR_LIMIT);
    assert_non_null(strstr(error.text, "anchors is 1048577"));
    s->segments[0].n = anchors;
    adcgs_buffer_clear(&out);
    free(many);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_config_sizes),  cmocka_unit_test(test_callers_of_all_ages),
        cmocka_unit_test(test_info_sizes),    cmocka_unit_test(test_metadata),
        cmocka_unit_test(test_version),       cmocka_unit_test(test_errors),
        cmocka_unit_test(test_memory_limits), cmocka_unit_test(test_log),
        cmocka_unit_test(test_writer_limits), cmocka_unit_test(test_facts_for_rendering),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
