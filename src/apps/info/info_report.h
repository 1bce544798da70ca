/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The data of adcgs-info on a stream, and its report as JSON. */
#ifndef ADCGS_APPS_INFO_INFO_REPORT_H
#define ADCGS_APPS_INFO_INFO_REPORT_H

#include "stream/stream.h"

/** A chunk, from the elements of its header. */
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
    int trace;  /**< print elements as they arrive */
    int failed; /**< allocation failure for a chunk */
} adcgs_info_report;

/** One line of the table of components. */
typedef struct adcgs_info_component {
    const char *name;
    uint64_t bytes;
} adcgs_info_component;

#define ADCGS_INFO_COMPONENTS 10 /* kinds of bytes in a stream; definition */

void adcgs_info_list_components(const adcgs_bytes *bytes, adcgs_info_component out[ADCGS_INFO_COMPONENTS]);
uint32_t adcgs_info_count_gaussians(const adcgs_model *model);
/**
 * Counts the anchors that a predicted segment takes from the previous one: unchanged anchors, and anchors with differences. Zero
 * for other segments.
 */
adcgs_status adcgs_info_kept(const adcgs_info_report *report, uint32_t segment, uint32_t *same, uint32_t *refined,
                             adcgs_error *error);
/**
 * Bytes of a segment's chunks with their headers, from its SEGM to the next one. Header, cameras, metadata and index belong to
 * the stream. NETW may have another segment's number, so its place counts. *at: 0 for the first segment, then as the call for the
 * previous one left it, so that all segments take one pass over the chunks.
 */
uint64_t adcgs_info_segment_bytes(const adcgs_info_report *report, uint32_t segment, size_t *at);
/** Writes the digest of a segment's model in hexadecimal digits. */
void adcgs_info_digest(const adcgs_info_report *report, uint32_t segment, char text[33]);

/** Prints one JSON object to standard output. ADCGS_ERR_UNSUPPORTED in a build without jansson, that is, without the encoder. */
adcgs_status adcgs_info_print_json(const adcgs_info_report *report, adcgs_error *error);

#endif
