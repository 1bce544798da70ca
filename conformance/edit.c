/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Commands that change a finished stream, in the order of the recipe: chunks and their elements, then bytes. */
#include "edit_priv.h"

#include <stdio.h>

typedef adcgs_status (*edit_fn)(adcgs_editor *e, const adcgs_command *c, adcgs_error *error);

/* ---- Elements ---- */

/* set ELEMENT VALUE */
static adcgs_status set_element(adcgs_editor *e, const adcgs_command *c, adcgs_error *error)
{
    adcgs_element element;
    adcgs_buffer bytes;
    ADCGS_TRY(adcgs_command_words(c, 2, 2, error));
    ADCGS_TRY(adcgs_element_find(e->list, c->word[1], &element, error));
    adcgs_buffer_init(&bytes);
    adcgs_status status = adcgs_element_encode(&element, c->word[2], &bytes, error);
    if (status == ADCGS_OK)
        status = adcgs_element_replace(e->list, &element, &bytes, error);
    adcgs_buffer_clear(&bytes);
    return status;
}

/* ---- Chunks ---- */

/* NAME=NUMBER of a chunk's header; returns nonzero if it is one. */
static int header_word(adcgs_raw_chunk *chunk, const char *word, adcgs_status *status, adcgs_error *error)
{
    static const char *const names[] = {"segment", "flags", "version", "length", NULL};
    int64_t value = 0;
    for (int i = 0; names[i]; i++) {
        const char *const text = adcgs_word_value(word, names[i]);
        if (!text)
            continue;
        *status = adcgs_word_int(text, 0, UINT32_MAX, &value, error);
        if (i == 0)
            chunk->segment = (uint16_t)value;
        else if (i == 1)
            chunk->flags = (uint8_t)value;
        else if (i == 2)
            chunk->version = (uint8_t)value;
        chunk->has_length |= i == 3;
        chunk->length = i == 3 ? (uint32_t)value : chunk->length;
        return 1;
    }
    return 0;
}

/* header CHUNK NAME=VALUE ...; NAME also type */
static adcgs_status set_header(adcgs_editor *e, const adcgs_command *c, adcgs_error *error)
{
    adcgs_raw_chunk *chunk;
    ADCGS_TRY(adcgs_command_words(c, 2, 6, error));
    ADCGS_TRY(adcgs_edit_find(e, c->word[1], &chunk, error));
    for (int i = 2; i < c->n; i++) {
        adcgs_status status = ADCGS_OK;
        const char *const type = adcgs_word_value(c->word[i], "type");
        if (type)
            snprintf(chunk->type, sizeof chunk->type, "%.4s", type);
        else if (!header_word(chunk, c->word[i], &status, error))
            return adcgs_fail(error, ADCGS_ERR_USAGE, "\"%s\": headers have no such element", c->word[i]);
        ADCGS_TRY(status);
    }
    return ADCGS_OK;
}

/* damage CHUNK header|payload MASK: a wrong checksum */
static adcgs_status damage(adcgs_editor *e, const adcgs_command *c, adcgs_error *error)
{
    static const char *const names[] = {"header", "payload", NULL};
    adcgs_raw_chunk *chunk;
    int which;
    int64_t mask;
    ADCGS_TRY(adcgs_command_words(c, 3, 3, error));
    ADCGS_TRY(adcgs_edit_find(e, c->word[1], &chunk, error));
    ADCGS_TRY(adcgs_word_choice(c->word[2], names, &which, error));
    ADCGS_TRY(adcgs_word_int(c->word[3], 1, UINT32_MAX, &mask, error));
    *(which ? &chunk->payload_damage : &chunk->header_damage) = (uint32_t)mask;
    return ADCGS_OK;
}

/* A further word of an insert: a header element, hex=BYTES, text=TEXT, zeros=N, copy=CHUNK */
static adcgs_status fill_chunk(adcgs_editor *e, int at, const char *word, adcgs_error *error)
{
    adcgs_raw_chunk *const chunk = &e->list->chunk[at];
    adcgs_status status = ADCGS_OK;
    int64_t n = 0;
    int from;
    if (header_word(chunk, word, &status, error))
        return status;
    if (adcgs_word_value(word, "hex"))
        return adcgs_hex_decode(adcgs_word_value(word, "hex"), &chunk->payload, error);
    if (adcgs_word_value(word, "text")) {
        adcgs_write_bytes(&chunk->payload, word + 5, strlen(word + 5));
        return ADCGS_OK;
    }
    if (adcgs_word_value(word, "zeros")) {
        ADCGS_TRY(adcgs_word_int(word + 6, 0, 1 << 22, &n, error));
        while (n-- > 0)
            adcgs_write_uint(&chunk->payload, 0, 1);
        return ADCGS_OK;
    }
    if (!adcgs_word_value(word, "copy"))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "\"%s\": no such part of a chunk", word);
    chunk->type[0] ^= 0x80; /* the search must not find this chunk itself */
    status = adcgs_chunk_list_find(e->list, word + 5, &from, error);
    chunk->type[0] ^= 0x80;
    ADCGS_TRY(status);
    chunk->segment = e->list->chunk[from].segment;
    adcgs_write_bytes(&chunk->payload, e->list->chunk[from].payload.data, e->list->chunk[from].payload.size);
    return ADCGS_OK;
}

/* insert TYPE before|after CHUNK ... */
static adcgs_status insert(adcgs_editor *e, const adcgs_command *c, adcgs_error *error)
{
    static const char *const places[] = {"before", "after", NULL};
    int place, at;
    ADCGS_TRY(adcgs_command_words(c, 3, 12, error));
    ADCGS_TRY(adcgs_word_choice(c->word[2], places, &place, error));
    ADCGS_TRY(adcgs_chunk_list_find(e->list, c->word[3], &at, error));
    at += place;
    ADCGS_TRY(adcgs_chunk_list_insert(e->list, at, c->word[1], error));
    for (int i = 4; i < c->n; i++)
        ADCGS_TRY(fill_chunk(e, at, c->word[i], error));
    e->list->chunk[at].as_is = e->list->chunk[at].payload.size > 0;
    return ADCGS_OK;
}

/* remove CHUNK */
static adcgs_status remove_chunk(adcgs_editor *e, const adcgs_command *c, adcgs_error *error)
{
    int at;
    ADCGS_TRY(adcgs_command_words(c, 1, 1, error));
    ADCGS_TRY(adcgs_chunk_list_find(e->list, c->word[1], &at, error));
    adcgs_chunk_list_remove(e->list, at);
    return ADCGS_OK;
}

/* swap CHUNK CHUNK */
static adcgs_status swap(adcgs_editor *e, const adcgs_command *c, adcgs_error *error)
{
    adcgs_raw_chunk *a, *b;
    ADCGS_TRY(adcgs_command_words(c, 2, 2, error));
    ADCGS_TRY(adcgs_edit_find(e, c->word[1], &a, error));
    ADCGS_TRY(adcgs_edit_find(e, c->word[2], &b, error));
    const adcgs_raw_chunk keep = *a;
    *a = *b;
    *b = keep;
    return ADCGS_OK;
}

/* move CHUNK before|after CHUNK */
static adcgs_status move(adcgs_editor *e, const adcgs_command *c, adcgs_error *error)
{
    static const char *const places[] = {"before", "after", NULL};
    int place, from, to;
    ADCGS_TRY(adcgs_command_words(c, 3, 3, error));
    ADCGS_TRY(adcgs_word_choice(c->word[2], places, &place, error));
    ADCGS_TRY(adcgs_chunk_list_find(e->list, c->word[1], &from, error));
    ADCGS_TRY(adcgs_chunk_list_find(e->list, c->word[3], &to, error));
    to += place;
    ADCGS_TRY(adcgs_chunk_list_insert(e->list, to, "none", error));
    from += from >= to;
    e->list->chunk[to] = e->list->chunk[from];
    adcgs_buffer_init(&e->list->chunk[from].payload);
    adcgs_chunk_list_remove(e->list, from);
    return ADCGS_OK;
}

/* append CHUNK HEX, shorten CHUNK N: the end of a payload */
static adcgs_status append(adcgs_editor *e, const adcgs_command *c, adcgs_error *error)
{
    adcgs_raw_chunk *chunk;
    ADCGS_TRY(adcgs_command_words(c, 2, 2, error));
    ADCGS_TRY(adcgs_edit_find(e, c->word[1], &chunk, error));
    if (!chunk->as_is && (!strcmp(chunk->type, "INDX") || !strcmp(chunk->type, "ENDC"))) {
        adcgs_buffer scratch; /* writing fills the payload to which to append */
        adcgs_buffer_init(&scratch);
        const adcgs_status status = adcgs_chunk_list_write(e->list, &scratch, error);
        adcgs_buffer_clear(&scratch);
        ADCGS_TRY(status);
    }
    chunk->as_is = 1;
    return adcgs_hex_decode(c->word[2], &chunk->payload, error);
}

static adcgs_status shorten(adcgs_editor *e, const adcgs_command *c, adcgs_error *error)
{
    adcgs_raw_chunk *chunk;
    int64_t n;
    ADCGS_TRY(adcgs_command_words(c, 2, 2, error));
    ADCGS_TRY(adcgs_edit_find(e, c->word[1], &chunk, error));
    ADCGS_TRY(adcgs_word_int(c->word[2], 1, (int64_t)chunk->payload.size, &n, error));
    chunk->payload.size -= (size_t)n;
    return ADCGS_OK;
}

/* ---- Bytes ---- */

/* flip BYTE MASK */
static adcgs_status flip(adcgs_editor *e, const adcgs_command *c, adcgs_error *error)
{
    int64_t at, mask;
    ADCGS_TRY(adcgs_command_words(c, 2, 2, error));
    ADCGS_TRY(adcgs_word_int(c->word[1], 0, (int64_t)e->out->size - 1, &at, error));
    ADCGS_TRY(adcgs_word_int(c->word[2], 1, 255, &mask, error));
    e->out->data[at] = (uint8_t)(e->out->data[at] ^ mask);
    return ADCGS_OK;
}

/* cut N, cut CHUNK N: N bytes of the stream are left, or of its last chunk, CHUNK; -N: N bytes fewer than all are left */
static adcgs_status cut(adcgs_editor *e, const adcgs_command *c, adcgs_error *error)
{
    adcgs_raw_chunk *chunk;
    size_t begin = 0, end = e->out->size;
    int64_t n;
    ADCGS_TRY(adcgs_command_words(c, 1, 2, error));
    if (c->n == 3) {
        ADCGS_TRY(adcgs_edit_find(e, c->word[1], &chunk, error));
        begin = chunk->at;
        end = chunk->at + ADCGS_CHUNK_FRAME + chunk->payload.size;
    }
    ADCGS_TRY(adcgs_word_int(c->word[c->n - 1], (int64_t)begin - (int64_t)end, (int64_t)end - (int64_t)begin, &n, error));
    e->out->size = n < 0 ? end - (size_t)-n : begin + (size_t)n;
    return ADCGS_OK;
}

/* tail HEX: bytes after the end */
static adcgs_status tail(adcgs_editor *e, const adcgs_command *c, adcgs_error *error)
{
    ADCGS_TRY(adcgs_command_words(c, 1, 1, error));
    return adcgs_hex_decode(c->word[1], e->out, error);
}

/* ---- All commands ---- */

static const struct {
    const char *verb;
    edit_fn fn;
    int is_bytes;
} edits[] = {
    {"set", set_element, 0},
    {"header", set_header, 0},
    {"damage", damage, 0},
    {"insert", insert, 0},
    {"remove", remove_chunk, 0},
    {"swap", swap, 0},
    {"move", move, 0},
    {"append", append, 0},
    {"shorten", shorten, 0},
    {"slice", adcgs_edit_slice, 0},
    {"keep", adcgs_edit_split, 0},
    {"split", adcgs_edit_split, 0},
    {"code", adcgs_edit_begin_code, 0},
    {"end", adcgs_edit_end_code, 0},
    {"flip", flip, 1},
    {"cut", cut, 1},
    {"tail", tail, 1},
};

static adcgs_status apply(adcgs_editor *e, adcgs_command *c, adcgs_error *error)
{
    adcgs_status status;
    if (e->script && adcgs_script_step(e->script, c, &status, error)) {
        c->used = 1;
        return status;
    }
    for (size_t i = 0; i < ADCGS_COUNTOF(edits); i++) {
        if (!adcgs_command_is(c, edits[i].verb))
            continue;
        c->used = 1;
        if (!edits[i].is_bytes && e->is_bytes)
            return adcgs_fail(error, ADCGS_ERR_USAGE, "commands that change chunks come before those that change bytes");
        if (edits[i].is_bytes && !e->is_bytes)
            ADCGS_TRY(adcgs_chunk_list_write(e->list, e->out, error));
        e->is_bytes = edits[i].is_bytes;
        return edits[i].fn(e, c, error);
    }
    return ADCGS_OK;
}

adcgs_status adcgs_edit_apply(adcgs_plan *plan, adcgs_chunk_list *list, adcgs_buffer *out, adcgs_error *error)
{
    adcgs_editor e = {.list = list, .out = out};
    adcgs_status status = ADCGS_OK;
    for (int i = 0; i < plan->recipe->n && status == ADCGS_OK; i++) {
        adcgs_command *const c = &plan->recipe->command[i];
        status = adcgs_command_locate(plan->recipe, c, apply(&e, c, error), error);
    }
    if (status == ADCGS_OK && !e.is_bytes)
        status = adcgs_chunk_list_write(list, out, error);
    adcgs_script_free(&e.script);
    return status;
}
