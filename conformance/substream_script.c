/* SPDX-License-Identifier: BSD-2-Clause */
/**
 * \file Sub-streams written decision by decision: for numbers that our encoder never writes. The recipe names the
 * adaptive contexts; each starts afresh at the first occurrence of its name.
 */
#include "edit.h"

#include "net/net.h"

#include <stdio.h>
#include <stdlib.h>

#define CONTEXTS 512

typedef struct named_context {
    char name[24];
    adcgs_adaptive context;
} named_context;

struct adcgs_script {
    adcgs_buffer out;
    adcgs_range_enc range;
    int n;
    named_context contexts[CONTEXTS];
};

adcgs_status adcgs_script_begin(adcgs_script **out, adcgs_error *error)
{
    *out = calloc(1, sizeof **out);
    if (!*out)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "no memory for a script");
    adcgs_range_enc_init(&(*out)->range, &(*out)->out);
    return ADCGS_OK;
}

void adcgs_script_free(adcgs_script **script)
{
    if (*script)
        adcgs_buffer_clear(&(*script)->out);
    free(*script);
    *script = NULL;
}

/* Codes a decision under the context NAME.INDEX, which is created at its first use. */
static void code_flag(adcgs_script *s, const char *name, int64_t index, int bit)
{
    char full[sizeof s->contexts[0].name];
    int i = 0;
    snprintf(full, sizeof full, "%.12s.%d", name, (int)index);
    while (i < s->n && strcmp(s->contexts[i].name, full))
        i++;
    if (i == CONTEXTS)
        return;
    if (i == s->n) {
        memcpy(s->contexts[s->n].name, full, sizeof full);
        adcgs_adaptive_init(&s->contexts[s->n++].context, 1);
    }
    adcgs_adaptive_enc(&s->range, &s->contexts[i].context, bit);
}

/* Codes n bits, most significant first, in a tree of contexts. */
static void code_tree(adcgs_script *s, const char *name, int64_t value, int64_t n)
{
    int64_t node = 1;
    for (int64_t i = n - 1; i >= 0; i--) {
        code_flag(s, name, node, (int)(value >> i & 1));
        node = 2 * node + (value >> i & 1);
    }
}

static void code_bits(adcgs_script *s, int64_t value, int64_t n)
{
    if (n > 16)
        adcgs_range_enc_bits(&s->range, (uint32_t)(value >> 16), (int)n - 16);
    if (n > 0)
        adcgs_range_enc_bits(&s->range, (uint32_t)value & (n < 16 ? (1U << n) - 1 : 0xffff), (int)ADCGS_MIN(n, 16));
}

/*
 * bits N VALUE         raw bits
 * flag NAME VALUE      one adaptive decision
 * tree NAME N VALUE    N adaptive decisions
 * unary NAME N MAX     N times 1, then 0 unless N is MAX
 * tail NAME N VALUE    N bits, the first two adaptive
 * value SI N           a quantised value
 */
int adcgs_script_step(adcgs_script *s, const adcgs_command *c, adcgs_status *status, adcgs_error *error)
{
    static const char *const verbs[] = {"bits", "flag", "tree", "unary", "tail", "value", NULL};
    static const int words[] = {2, 2, 3, 3, 3, 2};
    static const int named[] = {0, 1, 1, 1, 1, 0};
    int64_t v[3] = {0, 0, 0};
    int verb;
    if (adcgs_word_choice(c->word[0], verbs, &verb, NULL) != ADCGS_OK)
        return 0;
    *status = adcgs_command_words(c, words[verb], words[verb], error);
    for (int i = named[verb]; i < words[verb] && *status == ADCGS_OK; i++)
        *status = adcgs_word_int(c->word[1 + i], -100000, INT64_C(1) << 40, &v[i], error);
    if (*status != ADCGS_OK)
        return 1;
    if (verb == 0) {
        code_bits(s, v[1], v[0]);
    } else if (verb == 1) {
        code_flag(s, c->word[1], 0, (int)v[1]);
    } else if (verb == 2) {
        code_tree(s, c->word[1], v[2], v[1]);
    } else if (verb == 3) {
        for (int64_t i = 0; i < v[1] + (v[1] < v[2]); i++)
            code_flag(s, c->word[1], i, i < v[1]);
    } else if (verb == 4) {
        const int64_t adaptive = ADCGS_MIN(v[1], 2);
        code_tree(s, c->word[1], v[2] >> (v[1] - adaptive), adaptive);
        code_bits(s, v[2] & ((INT64_C(1) << (v[1] - adaptive)) - 1), v[1] - adaptive);
    } else {
        adcgs_value_enc(&s->range, (int)v[0] & 63, (int32_t)v[1]);
    }
    return 1;
}

adcgs_status adcgs_script_end(adcgs_script *s, adcgs_buffer *out, adcgs_error *error)
{
    adcgs_range_enc_finish(&s->range);
    out->size = 0;
    adcgs_write_bytes(out, s->out.data, s->out.size);
    return out->failed ? adcgs_fail(error, ADCGS_ERR_MEMORY, "no memory for a script") : ADCGS_OK;
}
