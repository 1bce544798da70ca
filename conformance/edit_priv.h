/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The stream that is being edited, and the commands in a file of their own. */
#ifndef ADCGS_CONFORMANCE_EDIT_PRIV_H
#define ADCGS_CONFORMANCE_EDIT_PRIV_H

#include "edit.h"

/** A stream that is being edited. */
typedef struct adcgs_editor {
    adcgs_chunk_list *list;
    adcgs_buffer *out; /**< the stream, from the first change of bytes on */
    int is_bytes;
    adcgs_script *script; /**< between "code" and "end" */
    const adcgs_command *code;
} adcgs_editor;

/** The chunk of a name. */
static inline adcgs_status adcgs_edit_find(const adcgs_editor *e, const char *name, adcgs_raw_chunk **chunk, adcgs_error *error)
{
    int index;
    ADCGS_TRY(adcgs_chunk_list_find(e->list, name, &index, error));
    *chunk = &e->list->chunk[index];
    return ADCGS_OK;
}

/* In edit_slices.c: slices, whole or decision by decision. */
adcgs_status adcgs_edit_slice(adcgs_editor *e, const adcgs_command *c, adcgs_error *error);
adcgs_status adcgs_edit_split(adcgs_editor *e, const adcgs_command *c, adcgs_error *error);
adcgs_status adcgs_edit_begin_code(adcgs_editor *e, const adcgs_command *c, adcgs_error *error);
adcgs_status adcgs_edit_end_code(adcgs_editor *e, const adcgs_command *c, adcgs_error *error);

#endif
