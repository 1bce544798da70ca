/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Commands that change a finished stream. Commands that change chunks and
 * syntax elements come first; all dependent parts (lengths, checksums, index,
 * end chunk) are recomputed. Commands that change bytes come last and leave
 * the rest unchanged.
 */
#ifndef ADCGS_CONFORMANCE_EDIT_H
#define ADCGS_CONFORMANCE_EDIT_H

#include "chunks.h"
#include "recipe_plan.h"

/** Apply the recipe's edits and write the stream. */
adcgs_status adcgs_edit_apply(adcgs_plan *plan, adcgs_chunk_list *list, adcgs_buffer *out, adcgs_error *error);

/** A syntax element: its place in its chunk's payload, and the part of its type that is needed to change it. */
typedef struct adcgs_element {
    int chunk;
    size_t offset, bytes;
    int type;        /**< adcgs_field_type, or one of the following */
    char value[192]; /**< in the form of the trace */
} adcgs_element;
#define ADCGS_ELEMENT_VAR 100
#define ADCGS_ELEMENT_TEXT 101
#define ADCGS_ELEMENT_BYTES 102

/** Find "HEAD.level", or, counted from 0, "SEGM.step#3", by a trace of the stream. */
adcgs_status adcgs_element_find(adcgs_chunk_list *list, const char *name, adcgs_element *out, adcgs_error *error);
/** Replace an element's bytes. */
adcgs_status adcgs_element_replace(adcgs_chunk_list *list, const adcgs_element *element, const adcgs_buffer *bytes,
                                   adcgs_error *error);
/** A number, +N for a sum, raw:HEX for any bytes, or the text itself. */
adcgs_status adcgs_element_encode(const adcgs_element *element, const char *word, adcgs_buffer *out, adcgs_error *error);
adcgs_status adcgs_hex_decode(const char *hex, adcgs_buffer *out, adcgs_error *error);

/** The payload of a chunk FEA0 to FEA4, slice by slice. */
typedef struct adcgs_slices {
    uint32_t first, n;
    adcgs_buffer *data;
    uint32_t *damage; /**< XORed to the checksums */
} adcgs_slices;
adcgs_status adcgs_slices_read(adcgs_slices *out, const adcgs_buffer *payload, adcgs_error *error);
/** Write slices begin to end - 1. */
void adcgs_slices_write(const adcgs_slices *slices, uint32_t begin, uint32_t end, adcgs_buffer *payload);
void adcgs_slices_clear(adcgs_slices *slices);

/** A sub-stream that is coded decision by decision. */
typedef struct adcgs_script adcgs_script;
adcgs_status adcgs_script_begin(adcgs_script **out, adcgs_error *error);
/** Returns nonzero if the verb is a script's; *status is then its result. */
int adcgs_script_step(adcgs_script *script, const adcgs_command *command, adcgs_status *status, adcgs_error *error);
/** End the sub-stream and write its bytes to out. */
adcgs_status adcgs_script_end(adcgs_script *script, adcgs_buffer *out, adcgs_error *error);
void adcgs_script_free(adcgs_script **script);

#endif
