/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Predicted segments: any predicted model is decoded exactly; models that cannot be predicted are refused. */
#include "predicted_streams.h"
#include "stream_edit.h"

#include "base/cpu_detect.h"
#include "base/thread_pool.h"
#include "model/inter_priv.h"
#include "model/model_priv.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

/** Chains of predicted segments, of any parameters. */
/* REQ-STRM-043, REQ-STRM-044, REQ-STRM-045, REQ-STRM-048, REQ-LATN-015, REQ-LATN-016, REQ-LATN-017, REQ-LATN-018 */
static void test_round_trip(void **state)
{
    static const uint32_t counts[] = {1, 3, 63, 64, 65, 200};
    (void)state;
    for (uint64_t seed = 1; seed <= 24; seed++) {
        adcgs_stream stream;
        adcgs_params params;
        uint64_t random = seed;
        adcgs_random_params(&params, (int)(seed & 1), &random);
        make_stream(&stream, &params, 4, counts[seed % ADCGS_COUNTOF(counts)], &random);
        for (int i = 0; i < 3; i++)
            append_follower(&stream, 40, &random);
        check_round_trip(&stream, NULL);
        adcgs_stream_clear(&stream, NULL);
    }
}

/** An unchanged model costs almost nothing: no network, no position, a few bytes of modes. */
/* REQ-STRM-043, REQ-STRM-046, REQ-LATN-015 */
static void test_all_kept(void **state)
{
    adcgs_stream stream;
    uint64_t seed = 3;
    uint32_t anchors = 1;
    const adcgs_params params = some_params(&seed);
    (void)state;
    make_stream(&stream, &params, 2, 500, &seed);
    append_same(&stream, 0);
    const size_t keep = check_round_trip(&stream, &anchors);
    assert_int_equal(anchors, 0);
    assert_true(keep > 0 && keep < 16);
    assert_true(stream.bytes.networks > 0 && stream.bytes.layer[0] > 0);
    const adcgs_bytes both = stream.bytes;
    adcgs_model_clear(&stream.segments[--stream.n_segments], NULL);
    check_round_trip(&stream, NULL);
    assert_true(both.networks == stream.bytes.networks && both.layer[0] == stream.bytes.layer[0]);
    assert_int_equal(both.geometry, stream.bytes.geometry + keep + 4);
    adcgs_stream_clear(&stream, NULL);
}

/**
 * Dropped anchors, one in three or all of them. In the second case new ones take their places, with other values in the fields
 * that have no differences.
 */
/* REQ-LATN-015, REQ-STRM-047 */
static void test_dropped(void **state)
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_stream stream;
    uint64_t seed = 4;
    uint32_t anchors = 1;
    const adcgs_params params = some_params(&seed);
    (void)state;
    make_stream(&stream, &params, 3, 60, &seed);
    assert_int_equal(append_same(&stream, 3)->n, 40);
    check_round_trip(&stream, &anchors);
    assert_int_equal(anchors, 0);
    adcgs_model *const m = append_same(&stream, 0);
    for (uint32_t i = 0; i < m->n; i++)
        m->mask[i] = m->mask[i] == 3 ? 1 : 3;
    memset(m->fg, 0, (size_t)m->n * params.k * params.n_fg * sizeof *m->fg);
    check(adcgs_random_values(m, &seed, &error), &error);
    check(adcgs_inter_renew(m, m - 1, &error), &error);
    assert_true(check_round_trip(&stream, &anchors) < 16);
    assert_int_equal(anchors, 40);
    adcgs_stream_clear(&stream, NULL);
}

/** Changes a latent of each third anchor, if it has the channel. \return number of changed anchors. */
static int change_latents(adcgs_model *m, int group, int channel, int32_t steps)
{
    const int n = adcgs_inter_channels(&m->params, group);
    int changed = 0;
    for (uint32_t i = 0; i < m->n; i += 3) {
        int16_t *const y = adcgs_inter_rows(m, group) + (size_t)i * (size_t)n + channel;
        const int16_t old = *y;
        if (group == ADCGS_INTER_SIGMA && m->is_static[i] && channel >= ADCGS_SIGMA_N)
            continue;
        *y = (int16_t)adcgs_clip(*y + 64 * steps, 32767);
        changed += *y != old;
    }
    return changed;
}

/** Differences of any size, to the limits and beyond, in every channel; no anchor is new. */
/* REQ-LATN-016, REQ-LATN-017, REQ-LATN-018 */
static void test_differences(void **state)
{
    static const int32_t steps[] = {1, -1, 2, -13, 14, -14, 15, -15, 16, 17, -18, 63, 300, -700, 1023, -1023, 2000, -2000};
    (void)state;
    for (size_t s = 0; s < ADCGS_COUNTOF(steps); s++)
        for (int group = 0; group < ADCGS_INTER_GROUPS; group++) {
            adcgs_stream stream;
            uint64_t seed = 5 + s;
            uint32_t anchors = 1;
            adcgs_params params = some_params(&seed);
            params.spans = (uint8_t)(s & 1);
            make_stream(&stream, &params, 2, 30, &seed);
            adcgs_model *const m = append_same(&stream, 0);
            const int channels = adcgs_inter_channels(&params, group);
            for (int c = 0; c < channels; c += 2)
                assert_true(change_latents(m, group, c, steps[s]) > 0);
            assert_true(check_round_trip(&stream, &anchors) > 1);
            assert_int_equal(anchors, 0);
            adcgs_stream_clear(&stream, NULL);
        }
}

/** A change by a fraction of a step, or of a value without differences, drops an anchor. It is new if possible. */
/* REQ-LATN-016 */
static void test_out_of_reach(void **state)
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_stream stream;
    adcgs_inter kept = {.n = 0};
    uint64_t seed = 6;
    adcgs_params params = some_params(&seed);
    params.n_eta = 2;
    (void)state;
    make_stream(&stream, &params, 2, 10, &seed);
    adcgs_model *const m = append_same(&stream, 0);
    m->fv[0]++;
    m->eta[2 * 1]++;
    m->fg[(size_t)2 * 2 * 4]++;
    m->mask[3] ^= 1;
    m->is_static[4] ^= 1;
    m->colour[3 * 5] = (int16_t)(m->colour[3 * 5] - 32);
    m->fv[3 * 6] = 32767; /* the limits are reachable from any value */
    m->fv[3 * 7] = -32767;
    check(adcgs_inter_find(&kept, m - 1, m, &error), &error);
    for (uint32_t i = 0; i < m->n; i++)
        assert_int_equal(kept.mode[i], i < 6 ? ADCGS_INTER_DROPPED : i < 8 ? ADCGS_INTER_REFINED : ADCGS_INTER_SAME);
    assert_int_equal(kept.n, 4);
    adcgs_inter_clear(&kept, NULL);
    adcgs_stream_clear(&stream, NULL);
}

/** New networks are sent, others are not. A segment may add a network, but not remove one. */
/* REQ-STRM-043, REQ-STRM-021 */
static void test_networks(void **state)
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_stream stream;
    uint64_t seed = 7;
    const adcgs_params params = some_params(&seed);
    (void)state;
    make_stream(&stream, &params, 2, 20, &seed);
    adcgs_model *const before = &stream.segments[0];
    adcgs_net_release(&before->net[ADCGS_ROLE_COARSE], NULL);
    before->net[ADCGS_ROLE_COARSE] = (adcgs_net){.present = 0};
    adcgs_model *const m = append_same(&stream, 0);
    check_round_trip(&stream, NULL);
    const uint64_t none = stream.bytes.networks;
    adcgs_model other;
    do { /* until the random model has one */
        check(adcgs_random_model(&other, &params, 1, 4, &seed, &error), &error);
        if (other.net[ADCGS_ROLE_COARSE].present)
            check(adcgs_net_copy(&m->net[ADCGS_ROLE_COARSE], &other.net[ADCGS_ROLE_COARSE], NULL, &error), &error);
        adcgs_model_clear(&other, NULL);
    } while (!m->net[ADCGS_ROLE_COARSE].present);
    check_round_trip(&stream, NULL);
    assert_true(stream.bytes.networks > none);
    assert_true(adcgs_inter_possible(before, m, &error));
    assert_false(adcgs_inter_possible(m, before, &error));
    assert_non_null(strstr(error.text, "networks"));
    adcgs_stream_clear(&stream, NULL);
}

static void check_refused(adcgs_stream *stream, const char *why)
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_buffer bytes;
    adcgs_buffer_init(&bytes);
    assert_int_equal(adcgs_stream_write(stream, &bytes, &error), ADCGS_ERR_USAGE);
    if (!strstr(error.text, why))
        fail_msg("refused with: %s", error.text);
    assert_int_equal(bytes.size, 0);
    adcgs_buffer_clear(&bytes);
}

/* REQ-STRM-043, REQ-STRM-045 */
static void test_writer_refuses(void **state)
{
    adcgs_stream stream;
    uint64_t seed = 8;
    adcgs_params params = some_params(&seed);
    params.n_eta = 1;
    (void)state;
    make_stream(&stream, &params, 2, 20, &seed);
    stream.segments[0].predicted = 1;
    check_refused(&stream, "first segment");
    stream.segments[0].predicted = 0;
    adcgs_model *const m = append_same(&stream, 0);
    struct {
        const char *why;
        void *place;
    } const changes[] = {
        {"grid", &m->depth},       {"grid", &m->voxel},        {"grid", &m->origin[1]},
        {"priors", &m->eta_mu[0]}, {"priors", &m->eta_si[0]},  {"steps", &m->d_fv[2]},
        {"steps", &m->d_sigma[5]}, {"steps", &m->d_colour[0]}, {"steps", &m->d_fg[3]},
    };
    for (size_t i = 0; i < ADCGS_COUNTOF(changes); i++) {
        *(uint8_t *)changes[i].place ^= 1;
        check_refused(&stream, changes[i].why);
        *(uint8_t *)changes[i].place ^= 1;
    }
    check_round_trip(&stream, NULL);
    m->sigma[4] = (int16_t)(m->sigma[4] ^ 1); /* neither reachable by a difference nor given by a network */
    check_refused(&stream, "");
    adcgs_stream_clear(&stream, NULL);
}

/** A small stream of a key and two predicted segments. */
static void make_small(adcgs_stream *stream, adcgs_buffer *bytes)
{
    uint64_t seed = 10;
    const adcgs_params params = some_params(&seed);
    make_stream(stream, &params, 3, 30, &seed);
    append_follower(stream, 20, &seed);
    append_follower(stream, 20, &seed);
    write_stream(stream, bytes);
}

/** From any part of a stream, whole segments are used, and the cut one if its base layer is present. */
/* REQ-STRM-031, REQ-STRM-048 */
static void test_cut_anywhere(void **state)
{
    adcgs_stream stream, part;
    adcgs_buffer bytes;
    uint32_t most = 0;
    (void)state;
    make_small(&stream, &bytes);
    for (size_t n = 0; n < bytes.size; n++) {
        adcgs_error error = {ADCGS_OK, ""};
        uint8_t *copy = malloc(n + (n == 0)); /* exactly n bytes: a sanitizer detects a read beyond */
        assert_non_null(copy);
        memcpy(copy, bytes.data, n);
        if (read_stream(&part, copy, n, &plain, &error) != ADCGS_OK) {
            assert_true(error.status == ADCGS_ERR_TRUNCATED && most == 0);
        } else {
            assert_true(part.truncated && part.n_segments >= most);
            most = part.n_segments;
            for (uint32_t i = 0; i < most; i++)
                if (adcgs_model_validate(&part.segments[i], &error) != ADCGS_OK)
                    fail_msg("%zu bytes, segment %u: %s", n, i, error.text);
                else if (i + 1 < most ||
                         (!part.segments[i].absent && part.segments[i].layers == adcgs_params_layers(&stream.params)))
                    assert_true(adcgs_model_equal(&part.segments[i], &stream.segments[i], NULL));
            adcgs_stream_clear(&part, NULL);
        }
        free(copy);
    }
    assert_int_equal(most, 3);
    adcgs_buffer_clear(&bytes);
    adcgs_stream_clear(&stream, NULL);
}

/** Whole segments of a damaged but readable stream have their original digests. */
static void check_same(const adcgs_stream *stream, const adcgs_stream *part)
{
    adcgs_error error = {ADCGS_OK, ""};
    assert_int_equal(part->n_segments, stream->n_segments);
    for (uint32_t i = 0; i < part->n_segments; i++) {
        uint8_t expected[16], found[16];
        check(adcgs_model_validate(&part->segments[i], &error), &error);
        adcgs_model_digest(&stream->segments[i], expected);
        adcgs_model_digest(&part->segments[i], found);
        if (part->segments[i].layers == adcgs_params_layers(&stream->params))
            assert_memory_equal(expected, found, sizeof found);
    }
}

/** Damage to any byte is detected. With repaired checksums, digests still detect any other model. */
/* REQ-STRM-004, REQ-STRM-027, REQ-CONF-005 */
static void test_damage(void **state)
{
    adcgs_stream stream, part;
    adcgs_buffer bytes;
    adcgs_error error;
    (void)state;
    make_small(&stream, &bytes);
    uint8_t *const copy = malloc(bytes.size);
    assert_non_null(copy);
    for (size_t i = 0; i < bytes.size; i++) {
        memcpy(copy, bytes.data, bytes.size);
        copy[i] ^= (uint8_t)(1 << i % 8);
        if (read_stream(&part, copy, bytes.size, &plain, &error) == ADCGS_OK)
            fail_msg("byte %zu: damage was not detected", i);
        adcgs_repair_stream(copy, bytes.size, 0);
        if (read_stream(&part, copy, bytes.size, &plain, &error) != ADCGS_OK)
            continue;
        if (!part.truncated)
            check_same(&stream, &part);
        adcgs_stream_clear(&part, NULL);
    }
    free(copy);
    adcgs_buffer_clear(&bytes);
    adcgs_stream_clear(&stream, NULL);
}

/** Fewer layers: the lower layers of new and of predicted anchors are right; no digest is compared. */
/* REQ-STRM-042, REQ-STRM-048, REQ-LATN-007 */
static void test_layers(void **state)
{
    adcgs_stream stream, part;
    adcgs_buffer bytes;
    (void)state;
    make_small(&stream, &bytes);
    for (int layers = 1; layers <= 3; layers++) {
        adcgs_error error = {ADCGS_OK, ""};
        adcgs_read_options options = plain;
        options.layers = layers;
        check(read_stream(&part, bytes.data, bytes.size, &options, &error), &error);
        assert_int_equal(part.n_segments, 3);
        for (uint32_t s = 0; s < 3; s++) {
            const adcgs_model *a = &stream.segments[s], *b = &part.segments[s];
            assert_true(b->layers == layers && a->n == b->n);
            assert_memory_equal(a->fv, b->fv, (size_t)a->n * 3 * sizeof *a->fv);
            for (size_t i = 0; i < (size_t)a->n * 8; i++)
                if (i % 4 < 2U * ((unsigned)layers - 1))
                    assert_int_equal(a->fg[i], b->fg[i]);
            assert_int_equal(adcgs_model_equal(a, b, NULL), layers == 3);
        }
        adcgs_stream_clear(&part, NULL);
    }
    adcgs_buffer_clear(&bytes);
    adcgs_stream_clear(&stream, NULL);
}

/* REQ-CONF-004 */
static void test_threads_and_cpus(void **state)
{
    static const int threads[] = {1, 2, 7};
    adcgs_stream stream, back;
    adcgs_buffer bytes;
    uint64_t seed = 11;
    const adcgs_params params = some_params(&seed);
    (void)state;
    make_stream(&stream, &params, 3, 500, &seed);
    append_follower(&stream, 400, &seed);
    append_follower(&stream, 400, &seed);
    write_stream(&stream, &bytes);
    for (size_t i = 0; i < ADCGS_COUNTOF(threads); i++)
        for (int cpu = ADCGS_CPU_SCALAR; cpu <= (int)adcgs_cpu_best(); cpu++) {
            adcgs_error error = {ADCGS_OK, ""};
            adcgs_read_options options = {.cpu = (adcgs_cpu_level)cpu};
            check(adcgs_pool_create(&options.pool, threads[i], &error), &error);
            check(read_stream(&back, bytes.data, bytes.size, &options, &error), &error);
            check_models(&stream, &back);
            adcgs_stream_clear(&back, NULL);
            adcgs_pool_free(&options.pool);
        }
    adcgs_buffer_clear(&bytes);
    adcgs_stream_clear(&stream, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_round_trip),     cmocka_unit_test(test_all_kept),         cmocka_unit_test(test_dropped),
        cmocka_unit_test(test_differences),    cmocka_unit_test(test_out_of_reach),     cmocka_unit_test(test_networks),
        cmocka_unit_test(test_writer_refuses), cmocka_unit_test(test_cut_anywhere),     cmocka_unit_test(test_damage),
        cmocka_unit_test(test_layers),         cmocka_unit_test(test_threads_and_cpus),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
