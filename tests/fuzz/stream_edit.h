/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Editing of streams that need not be valid: finding chunks, making checksums right as somebody would who means harm. */
#ifndef ADCGS_TESTS_STREAM_EDIT_H
#define ADCGS_TESTS_STREAM_EDIT_H

#include "stream/chunk.h"

/** A chunk as far as it is there. */
typedef struct adcgs_found_chunk {
    uint32_t type;
    size_t at;       /**< position of its header */
    size_t payload;  /**< position of its payload */
    size_t length;   /**< bytes of the payload, at most what is left of the stream */
    int complete;    /**< the checksum behind the payload is there too */
} adcgs_found_chunk;

/** The chunk at *pos, which is moved behind it; 0 when no header is left. Start with ADCGS_SIGNATURE_BYTES. */
int adcgs_next_chunk(const uint8_t *data, size_t size, size_t *pos, adcgs_found_chunk *found);

/** Make all checksums, and the size in ENDC, right again. With drop_hash, chunks "hash" become unknown ones. */
void adcgs_repair_stream(uint8_t *data, size_t size, int drop_hash);

/** The mutator of streams (mutate_stream.c), as LLVMFuzzerCustomMutator(). */
size_t adcgs_mutate_stream(uint8_t *data, size_t size, size_t max, unsigned int seed);

#endif
