/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Commands that change the slices of a stream: whole slices, and sub-streams coded decision by decision. */
#include "edit_priv.h"

/* ---- Slices ---- */

static adcgs_status change_slice(adcgs_slices *s, uint32_t i, const char *word, adcgs_error *error)
{
    int64_t n = 0;
    if (adcgs_word_value(word, "append"))
        return adcgs_hex_decode(word + 7, &s->data[i], error);
    if (adcgs_word_value(word, "hex")) {
        s->data[i].size = 0;
        return adcgs_hex_decode(word + 4, &s->data[i], error);
    }
    if (adcgs_word_value(word, "drop")) {
        ADCGS_TRY(adcgs_word_int(word + 5, 1, (int64_t)s->data[i].size, &n, error));
        s->data[i].size -= (size_t)n;
        return ADCGS_OK;
    }
    if (!adcgs_word_value(word, "damage"))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "\"%s\": slices have no such property", word);
    ADCGS_TRY(adcgs_word_int(word + 7, 1, UINT32_MAX, &n, error));
    s->damage[i] = (uint32_t)n;
    return ADCGS_OK;
}

/* slice CHUNK NUMBER append=HEX|hex=HEX|drop=N|damage=MASK */
adcgs_status adcgs_edit_slice(adcgs_editor *e, const adcgs_command *c, adcgs_error *error)
{
    adcgs_raw_chunk *chunk;
    adcgs_slices s;
    int64_t number;
    ADCGS_TRY(adcgs_command_words(c, 3, 3, error));
    ADCGS_TRY(adcgs_edit_find(e, c->word[1], &chunk, error));
    adcgs_status status = adcgs_slices_read(&s, &chunk->payload, error);
    if (status == ADCGS_OK)
        status = adcgs_word_int(c->word[2], 0, (int64_t)s.n - 1, &number, error);
    if (status == ADCGS_OK)
        status = change_slice(&s, (uint32_t)number, c->word[3], error);
    if (status == ADCGS_OK)
        adcgs_slices_write(&s, 0, s.n, &chunk->payload);
    adcgs_slices_clear(&s);
    return status;
}

/* keep CHUNK N: its first N slices; split CHUNK N: the others in a chunk of their own */
adcgs_status adcgs_edit_split(adcgs_editor *e, const adcgs_command *c, adcgs_error *error)
{
    adcgs_slices s;
    int64_t n;
    int at;
    ADCGS_TRY(adcgs_command_words(c, 2, 2, error));
    ADCGS_TRY(adcgs_chunk_list_find(e->list, c->word[1], &at, error));
    adcgs_status status = adcgs_slices_read(&s, &e->list->chunk[at].payload, error);
    if (status == ADCGS_OK)
        status = adcgs_word_int(c->word[2], 1, (int64_t)s.n - 1, &n, error);
    if (status == ADCGS_OK && adcgs_command_is(c, "split")) {
        status = adcgs_chunk_list_insert(e->list, at + 1, e->list->chunk[at].type, error);
        if (status == ADCGS_OK) {
            e->list->chunk[at + 1].segment = e->list->chunk[at].segment;
            adcgs_slices_write(&s, (uint32_t)n, s.n, &e->list->chunk[at + 1].payload);
        }
    }
    if (status == ADCGS_OK)
        adcgs_slices_write(&s, 0, (uint32_t)n, &e->list->chunk[at].payload);
    adcgs_slices_clear(&s);
    return status;
}

/* ---- Sub-streams, coded decision by decision ---- */

/* code element NAME | slice CHUNK NUMBER | append CHUNK, up to "end" */
adcgs_status adcgs_edit_begin_code(adcgs_editor *e, const adcgs_command *c, adcgs_error *error)
{
    ADCGS_TRY(adcgs_command_words(c, 2, 3, error));
    e->code = c;
    return adcgs_script_begin(&e->script, error);
}

static adcgs_status put_slice(adcgs_editor *e, const adcgs_buffer *bytes, adcgs_error *error)
{
    adcgs_raw_chunk *chunk;
    adcgs_slices s;
    int64_t number;
    ADCGS_TRY(adcgs_edit_find(e, e->code->word[2], &chunk, error));
    adcgs_status status = adcgs_slices_read(&s, &chunk->payload, error);
    if (status == ADCGS_OK)
        status = adcgs_word_int(e->code->word[3], 0, (int64_t)s.n - 1, &number, error);
    if (status == ADCGS_OK) {
        s.data[number].size = 0;
        adcgs_write_bytes(&s.data[number], bytes->data, bytes->size);
        adcgs_slices_write(&s, 0, s.n, &chunk->payload);
    }
    adcgs_slices_clear(&s);
    return status;
}

static adcgs_status put_code(adcgs_editor *e, const adcgs_buffer *bytes, adcgs_error *error)
{
    adcgs_raw_chunk *chunk;
    adcgs_element element;
    if (strcmp(e->code->word[1], "slice") == 0 && e->code->n == 4)
        return put_slice(e, bytes, error);
    if (strcmp(e->code->word[1], "element") == 0) {
        ADCGS_TRY(adcgs_element_find(e->list, e->code->word[2], &element, error));
        return adcgs_element_replace(e->list, &element, bytes, error);
    }
    ADCGS_TRY(adcgs_edit_find(e, e->code->word[2], &chunk, error));
    adcgs_write_bytes(&chunk->payload, bytes->data, bytes->size);
    return ADCGS_OK;
}

adcgs_status adcgs_edit_end_code(adcgs_editor *e, const adcgs_command *c, adcgs_error *error)
{
    adcgs_buffer bytes;
    (void)c;
    if (!e->script)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "end without code");
    adcgs_buffer_init(&bytes);
    adcgs_status status = adcgs_script_end(e->script, &bytes, error);
    if (status == ADCGS_OK)
        status = put_code(e, &bytes, error);
    adcgs_buffer_clear(&bytes);
    adcgs_script_free(&e->script);
    return status;
}
