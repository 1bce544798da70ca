/* SPDX-License-Identifier: BSD-2-Clause */
/**
 * \file Positions: every GEOM of a stream, independent of the rest. Decoded positions are the same when coded and decoded again.
 */
#include "decode_positions.h"
#include "fuzz.h"
#include "stream_edit.h"

#include "geom/geom.h"

#define ANCHORS_MAX 20000U
#define FIXED_BYTES 21  /* elements before the positions */
#define COUNT_BYTES 4   /* these alone in predicted segments, which use the grid of the previous segment */
#define PREDICTED_AT 20 /* offset in SEGM */

const char *const adcgs_fuzz_seeds[] = {"conformance/vectors", "tests/fuzz/regressions/geom", NULL};

static void check_positions(const uint32_t *voxels, uint32_t n, int depth)
{
    uint64_t last = 0;
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t *v = voxels + 3 * (size_t)i;
        const uint64_t code = adcgs_morton(v);
        FUZZ_REQUIRE((v[0] | v[1] | v[2]) >> depth == 0);
        FUZZ_REQUIRE(i == 0 || code > last);
        last = code;
    }
}

static void try_positions(uint32_t n, int depth, const uint8_t *data, size_t size)
{
    adcgs_buffer out;
    uint32_t *voxels = calloc(n ? n : 1, 3 * sizeof *voxels), *again = calloc(n ? n : 1, 3 * sizeof *again);
    FUZZ_REQUIRE(voxels && again);
    adcgs_buffer_init(&out);
    if (decode_positions(data, size, n, depth, voxels, NULL) == ADCGS_OK) {
        check_positions(voxels, n, depth);
        FUZZ_REQUIRE(adcgs_geom_encode(&out, voxels, n, depth, NULL) == ADCGS_OK);
        FUZZ_REQUIRE(decode_positions(out.data, out.size, n, depth, again, NULL) == ADCGS_OK);
        FUZZ_REQUIRE(memcmp(voxels, again, 3 * (size_t)n * sizeof *voxels) == 0);
    }
    adcgs_buffer_clear(&out);
    free(voxels);
    free(again);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    adcgs_found_chunk c;
    int predicted = 0, depth = 0;
    for (size_t pos = ADCGS_SIGNATURE_BYTES; adcgs_next_chunk(data, size, &pos, &c);) {
        const uint8_t *payload = data + c.payload;
        const size_t fixed = predicted ? COUNT_BYTES : FIXED_BYTES;
        if (c.type == ADCGS_TYPE_SEGM)
            predicted = c.length > PREDICTED_AT && payload[PREDICTED_AT];
        if (c.type != ADCGS_TYPE_GEOM || c.length < fixed || adcgs_load_le32(payload) > ANCHORS_MAX)
            continue;
        depth = predicted ? depth : payload[COUNT_BYTES] % (ADCGS_GEOM_DEPTH_MAX + 2);
        try_positions(adcgs_load_le32(payload), depth, payload + fixed, c.length - fixed);
    }
    return 0;
}
