/* SPDX-License-Identifier: BSD-2-Clause */
/** \file What adcgs-info has found in a stream, and its report as JSON. */
#ifndef ADCGS_TOOLS_INFO_REPORT_H
#define ADCGS_TOOLS_INFO_REPORT_H

#include "stream/stream.h"

/** A chunk as the elements of its header tell. */
typedef struct adcgs_info_chunk {
    char type[5];
    uint64_t offset;
    unsigned segment, bytes;
} adcgs_info_chunk;

typedef struct adcgs_info_report {
    adcgs_stream stream;
    adcgs_info info;
    adcgs_info_chunk *chunks;
    size_t n_chunks, capacity;
    int trace;  /**< print elements as they come */
    int failed; /**< no memory for a chunk */
} adcgs_info_report;

/** One line of the table of components. */
typedef struct adcgs_info_component {
    const char *name;
    uint64_t bytes;
} adcgs_info_component;

#define ADCGS_INFO_COMPONENTS 10

void adcgs_info_list_components(const adcgs_bytes *bytes, adcgs_info_component out[ADCGS_INFO_COMPONENTS]);
uint32_t adcgs_info_count_gaussians(const adcgs_model *model);
/** What a predicted segment has of the one before: anchors as they were, anchors with differences. Nothing of others. */
adcgs_status adcgs_info_kept(const adcgs_info_report *report, uint32_t segment, uint32_t *same, uint32_t *refined,
                             adcgs_error *error);
/** The digest of a segment's model in hexadecimal digits. */
void adcgs_info_digest(const adcgs_info_report *report, uint32_t segment, char text[33]);

/** One JSON object on standard output. ADCGS_ERR_UNSUPPORTED in a build without jansson, which is one without the encoder. */
adcgs_status adcgs_info_print_json(const adcgs_info_report *report, adcgs_error *error);

#endif
