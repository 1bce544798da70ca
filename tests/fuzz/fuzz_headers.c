/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The payloads of all chunks, each parsed alone, whatever its checksum and place. Valid HEAD, SEGM, KEEP, cams and meta are
 * written and read again. Parts that depend on the previous segment use one with a few anchors of zeros.
 */
#include "fuzz.h"
#include "stream_edit.h"

#include "model/inter_priv.h"
#include "model/model_priv.h"
#include "stream/parts.h"

#define BEFORE 60U /* anchors of the segment before a predicted one */

const char *const adcgs_fuzz_seeds[] = {"conformance/vectors", "tests/fuzz/regressions/headers", NULL};

typedef adcgs_status (*part_parse)(adcgs_parse *p, adcgs_stream *stream, adcgs_memory *memory);
typedef adcgs_status (*part_write)(adcgs_buffer *out, const adcgs_stream *stream, adcgs_error *error);

static adcgs_parse parse_of(const uint8_t *data, size_t size)
{
    adcgs_parse p = {.chunk = "part"};
    adcgs_reader_init(&p.r, data, size);
    return p;
}

/** cams or meta: a valid chunk can be written and read, and writing it again gives the same bytes. */
static void try_extras(const uint8_t *data, size_t size, part_parse parse, part_write write)
{
    adcgs_stream first, second;
    adcgs_buffer a, b;
    adcgs_memory memory = {.limit = 0};
    adcgs_stream_init(&first);
    adcgs_stream_init(&second);
    adcgs_buffer_init(&a);
    adcgs_buffer_init(&b);
    adcgs_parse p = parse_of(data, size);
    if (parse(&p, &first, &memory) == ADCGS_OK) {
        FUZZ_REQUIRE(write(&a, &first, NULL) == ADCGS_OK);
        p = parse_of(a.data, a.size);
        FUZZ_REQUIRE(parse(&p, &second, &memory) == ADCGS_OK);
        FUZZ_REQUIRE(write(&b, &second, NULL) == ADCGS_OK);
        FUZZ_REQUIRE(a.size == b.size && memcmp(a.data, b.data, a.size) == 0);
    }
    adcgs_stream_clear(&first, &memory);
    adcgs_stream_clear(&second, &memory);
    FUZZ_REQUIRE(memory.used == 0);
    adcgs_buffer_clear(&a);
    adcgs_buffer_clear(&b);
}

static int try_head(const uint8_t *data, size_t size, adcgs_stream *stream)
{
    adcgs_syn_head head, again;
    adcgs_buffer out;
    adcgs_parse p = parse_of(data, size);
    if (adcgs_head_parse(&p, &head, stream) != ADCGS_OK)
        return 0;
    adcgs_buffer_init(&out);
    stream->n_segments = head.segments; /* the writer counts its models, and here it has none */
    FUZZ_REQUIRE(adcgs_head_write(&out, stream, head.max_anchors, NULL) == ADCGS_OK);
    stream->n_segments = 0;
    FUZZ_REQUIRE(out.size == size && memcmp(out.data, data, size) == 0);
    p = parse_of(out.data, out.size);
    FUZZ_REQUIRE(adcgs_head_parse(&p, &again, stream) == ADCGS_OK);
    adcgs_buffer_clear(&out);
    return 1;
}

static void try_segm(const uint8_t *data, size_t size, const adcgs_stream *stream)
{
    adcgs_model model = {.params = stream->params};
    adcgs_role_ids ids;
    int64_t ticks[3];
    adcgs_buffer out;
    adcgs_parse p = parse_of(data, size);
    if (adcgs_segm_parse(&p, stream, &model, &ids, ticks) != ADCGS_OK)
        return;
    adcgs_buffer_init(&out);
    if (adcgs_segm_write(&out, stream, &model, &ids, NULL) == ADCGS_OK) { /* may fail: huge time bases lose ticks */
        adcgs_model again = {.params = stream->params};
        adcgs_role_ids same;
        p = parse_of(out.data, out.size);
        FUZZ_REQUIRE(adcgs_segm_parse(&p, stream, &again, &same, ticks) == ADCGS_OK);
        FUZZ_REQUIRE(memcmp(model.d_fv, again.d_fv, sizeof model.d_fv) == 0 && ids.mask == same.mask);
        FUZZ_REQUIRE(memcmp(model.eta_mu, again.eta_mu, sizeof model.eta_mu) == 0 && model.predicted == again.predicted);
    }
    adcgs_buffer_clear(&out);
}

static void require_same(const adcgs_inter *a, const adcgs_inter *b, const adcgs_model *before)
{
    FUZZ_REQUIRE(a->n == b->n && memcmp(a->mode, b->mode, before->n) == 0);
    for (int g = 0; g < ADCGS_INTER_GROUPS; g++)
        FUZZ_REQUIRE(memcmp(a->rows[g], b->rows[g], before->n * (size_t)adcgs_inter_channels(&before->params, g) * 2) == 0);
}

/** KEEP, the data of inter-segment prediction: equal when coded and read again, possibly in other bytes. */
static void try_keep(const uint8_t *data, size_t size, const adcgs_model *before)
{
    adcgs_inter kept = {.n = 0}, again = {.n = 0};
    adcgs_cost left = {UINT64_MAX, UINT64_MAX};
    adcgs_memory memory = {.limit = 0};
    adcgs_buffer out;
    adcgs_parse p = parse_of(data, size);
    adcgs_buffer_init(&out);
    if (adcgs_keep_parse(&p, adcgs_level_get(1), before, &kept, &left, &memory) == ADCGS_OK) {
        FUZZ_REQUIRE(adcgs_inter_encode(&kept, before, &out, NULL) == ADCGS_OK);
        p = parse_of(out.data, out.size);
        FUZZ_REQUIRE(adcgs_keep_parse(&p, adcgs_level_get(1), before, &again, &left, &memory) == ADCGS_OK);
        require_same(&kept, &again, before);
    }
    adcgs_inter_clear(&kept, &memory);
    adcgs_inter_clear(&again, &memory);
    FUZZ_REQUIRE(memory.used == 0);
    adcgs_buffer_clear(&out);
}

/** The previous segment: all latents are 0, or near the limits, where differences are clipped. */
static void make_before(adcgs_model *before, const adcgs_params *params)
{
    adcgs_model_clear(before, NULL);
    *before = (adcgs_model){.params = *params, .n = BEFORE, .depth = 2};
    FUZZ_REQUIRE(adcgs_model_alloc(before, NULL, NULL) == ADCGS_OK);
    for (uint32_t i = 0; i < BEFORE; i++) {
        before->is_static[i] = params->time_rows > 0 && i % 3 == 0;
        before->fv[i * params->n_fv] = before->colour[i * ADCGS_COLOUR_N] = i % 2 ? 32700 : -32700;
    }
}

/** The elements that can begin a chunk, at every place. */
static void try_elements(const uint8_t *data, size_t size)
{
    adcgs_parse p = parse_of(data, size);
    adcgs_syn_index entry;
    adcgs_syn_endc endc;
    adcgs_syn_chunk_header header;
    char *text;
    while (adcgs_syn_index_parse(&p, &entry) == ADCGS_OK)
        ;
    p = parse_of(data, size);
    (void)adcgs_syn_endc_parse(&p, &endc);
    p = parse_of(data, size);
    (void)adcgs_syn_chunk_header_parse(&p, &header);
    p = parse_of(data, size);
    for (int more = 1; more;) {
        text = NULL;
        more = adcgs_parse_text(&p, "text", 1, UINT32_MAX, NULL, &text) == ADCGS_OK;
        adcgs_free(NULL, text);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    adcgs_model before = {.n = 0};
    adcgs_stream stream, second; /* second: the same with a previous segment, for predicted parts */
    adcgs_found_chunk c;
    int has_head = 0;
    adcgs_stream_init(&stream);
    for (size_t pos = ADCGS_SIGNATURE_BYTES; adcgs_next_chunk(data, size, &pos, &c);) {
        const uint8_t *payload = data + c.payload;
        try_elements(payload, c.length);
        if (c.type == ADCGS_TYPE_HEAD && try_head(payload, c.length, &stream)) {
            has_head = 1;
            make_before(&before, &stream.params);
        } else if (c.type == ADCGS_TYPE_cams) {
            try_extras(payload, c.length, adcgs_cams_parse, adcgs_cams_write);
        } else if (c.type == ADCGS_TYPE_meta) {
            try_extras(payload, c.length, adcgs_meta_parse, adcgs_meta_write);
        } else if (c.type == ADCGS_TYPE_SEGM && has_head) {
            second = stream;
            second.segments = &before;
            second.n_segments = 1;
            try_segm(payload, c.length, &second);
        } else if (c.type == ADCGS_TYPE_KEEP && has_head) {
            try_keep(payload, c.length, &before);
        }
    }
    adcgs_model_clear(&before, NULL);
    return 0;
}
