/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Data shared by both reports of adcgs-info. */
#include "apps/info/info_report.h"

#include "base/digest.h"
#include "model/inter.h"
#include "model/model_priv.h"
#include "stream/chunk.h"

void adcgs_info_list_components(const adcgs_bytes *b, adcgs_info_component out[ADCGS_INFO_COMPONENTS])
{
    const adcgs_info_component list[ADCGS_INFO_COMPONENTS] = {
        {"header", b->header},   {"networks", b->networks}, {"geometry", b->geometry}, {"layer0", b->layer[0]},
        {"layer1", b->layer[1]}, {"layer2", b->layer[2]},   {"layer3", b->layer[3]},   {"layer4", b->layer[4]},
        {"cameras", b->cameras}, {"metadata", b->metadata},
    };
    memcpy(out, list, sizeof list);
}

uint32_t adcgs_info_count_gaussians(const adcgs_model *m)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < m->n; i++)
        for (unsigned bits = m->mask[i]; bits; bits &= bits - 1)
            n++;
    return n;
}

adcgs_status adcgs_info_kept(const adcgs_info_report *r, uint32_t segment, uint32_t *same, uint32_t *refined, adcgs_error *error)
{
    const adcgs_model *now = &r->stream.segments[segment];
    adcgs_inter kept = {.n = 0};
    *same = *refined = 0;
    if (!now->predicted)
        return ADCGS_OK;
    const adcgs_status status = adcgs_inter_find(&kept, now - 1, now, error);
    for (uint32_t i = 0; status == ADCGS_OK && i < now[-1].n; i++) {
        *same += kept.mode[i] == ADCGS_INTER_SAME;
        *refined += kept.mode[i] == ADCGS_INTER_REFINED;
    }
    adcgs_inter_clear(&kept, NULL);
    return status;
}

/** Types of chunks that belong to the whole stream, wherever they are. */
static int is_of_stream(const char *type)
{
    static const char *const types[] = {"HEAD", "cams", "meta", "INDX", "ENDC"};
    for (size_t i = 0; i < ADCGS_COUNTOF(types); i++)
        if (strcmp(type, types[i]) == 0)
            return 1;
    return 0;
}

static int begins_segment(const adcgs_info_chunk *c)
{
    return strcmp(c->type, "SEGM") == 0;
}

uint64_t adcgs_info_segment_bytes(const adcgs_info_report *r, uint32_t segment, size_t *at)
{
    uint64_t bytes = 0;
    while (*at < r->n_chunks && !(begins_segment(&r->chunks[*at]) && r->chunks[*at].segment >= segment))
        ++*at;
    if (*at == r->n_chunks || r->chunks[*at].segment != segment)
        return 0;
    do {
        if (!is_of_stream(r->chunks[*at].type))
            bytes += (uint64_t)r->chunks[*at].bytes + ADCGS_CHUNK_BYTES;
    } while (++*at < r->n_chunks && !begins_segment(&r->chunks[*at]));
    return bytes;
}

void adcgs_info_digest(const adcgs_info_report *r, uint32_t segment, char text[33])
{
    uint8_t digest[16];
    adcgs_model_digest(&r->stream.segments[segment], digest);
    adcgs_md5_hex(digest, text);
}
