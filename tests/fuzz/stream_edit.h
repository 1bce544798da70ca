/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Editing of streams that may be invalid: finding chunks, and correcting checksums as an attacker would. */
#ifndef ADCGS_TESTS_STREAM_EDIT_H
#define ADCGS_TESTS_STREAM_EDIT_H

#include "stream/chunk.h"

/** A chunk, possibly cut off. */
typedef struct adcgs_found_chunk {
    uint32_t type;
    size_t at;      /**< position of its header */
    size_t payload; /**< position of its payload */
    size_t length;  /**< bytes of the payload, at most the rest of the stream */
    int complete;   /**< the checksum after the payload is present */
} adcgs_found_chunk;

/** Finds the chunk at *pos and moves *pos behind it; 0 if there is no header left. Start with ADCGS_SIGNATURE_BYTES. */
int adcgs_next_chunk(const uint8_t *data, size_t size, size_t *pos, adcgs_found_chunk *found);

/** Corrects all checksums, and the size in ENDC. With drop_hash, chunks "hash" become unknown ones. */
void adcgs_repair_stream(uint8_t *data, size_t size, int drop_hash);

/** The mutator of streams (mutate_stream.c), with the interface of LLVMFuzzerCustomMutator(). */
size_t adcgs_mutate_stream(uint8_t *data, size_t size, size_t max, unsigned int seed);

#endif
