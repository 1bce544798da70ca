/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats that a GLB file packs as SPZ. */
#include "config.h"

#include "media/splats/glb_spz.h"

#include "media/splats/glb.h"
#include "media/splats/splats_move.h"
#include "media/splats/spz.h"

#define NAME ADCGS_GLB_SPLATS "_compression_spz"

int adcgs_glb_is_spz(const char *extension)
{
    return !strcmp(extension, NAME "_2") || !strcmp(extension, NAME);
}

/** Check the counts of the accessors, which describe the unpacked splats. */
static adcgs_status check_counts(const adcgs_glb *g, uint32_t n)
{
    const char *name;
    json_t *index;
    json_object_foreach(g->attributes, name, index)
    {
        const json_t *const accessor = json_array_get(json_object_get(g->root, "accessors"), (size_t)json_integer_value(index));
        const json_int_t count = json_integer_value(json_object_get(accessor, "count"));
        if (count != (json_int_t)n)
            return adcgs_fail(g->error, ADCGS_ERR_DATA, "%s: glTF: %.64s: %lld elements, but the SPZ has %u splats", g->path,
                              name, (long long)count, n);
    }
    return ADCGS_OK;
}

adcgs_status adcgs_glb_take_spz(adcgs_splats *out, const adcgs_glb *g, json_t *packed)
{
    /* SPZ's axes are right, up, back; glTF's are left, up, front. */
    static const double half_a_turn[12] = {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0};
    const uint8_t *at;
    size_t bytes;
    ADCGS_TRY(adcgs_glb_bytes(&at, &bytes, g, packed, NAME "_2"));
    if (!adcgs_spz_is(at, bytes))
        return adcgs_fail(g->error, ADCGS_ERR_DATA, "%s: glTF: " NAME "_2: a view of %zu bytes that is not SPZ", g->path, bytes);
    ADCGS_TRY(adcgs_spz_parse(out, at, bytes, g->path, g->error));
    ADCGS_TRY(check_counts(g, out->n));
    return adcgs_splats_move(out, half_a_turn, g->path, g->error);
}
