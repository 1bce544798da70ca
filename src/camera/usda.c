/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Reading USD's text format. */
#include "config.h"

#include "camera/usda.h"

#include "system/file.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>

/* Origin: chosen by hand, not measured. */
#define BYTES_MAX ((uint64_t)256 << 20) /* of a file */
#define DEPTH_MAX 64                    /* nested prims */
#define SAMPLES_MAX 1000000             /* of a property */
#define NAME_MAX_BYTES 200              /* of a word, with its end; longer ones are truncated */

typedef struct parser {
    const char *path, *at;
    int line;
    int (*wanted)(const char *name);
    adcgs_usda *out;
    adcgs_error *error;
} parser;

static adcgs_status bad(const parser *p, const char *expected)
{
    return adcgs_fail(p->error, ADCGS_ERR_DATA, "%s: line %d: expected %s", p->path, p->line, expected);
}

static adcgs_status no_memory(const parser *p)
{
    return adcgs_fail(p->error, ADCGS_ERR_MEMORY, "%s: out of memory", p->path);
}

/* ---- Words ---- */

static void blanks(parser *p)
{
    for (;; p->at++) {
        if (*p->at == '#')
            p->at += strcspn(p->at, "\n");
        if (!*p->at || !isspace((unsigned char)*p->at))
            return;
        p->line += *p->at == '\n';
    }
}

/** Take a sign, if it is next. */
static int accept_sign(parser *p, char sign)
{
    blanks(p);
    const int is = *p->at == sign;
    p->at += is;
    return is;
}

static adcgs_status need(parser *p, char sign)
{
    const char expected[] = {'\'', sign, '\'', 0};
    return accept_sign(p, sign) ? ADCGS_OK : bad(p, expected);
}

/** A word of letters, digits and punctuation of names; "" if there is none. Longer words are truncated. */
static void word(parser *p, char out[NAME_MAX_BYTES])
{
    size_t n = 0;
    blanks(p);
    for (; isalnum((unsigned char)*p->at) || (*p->at && strchr("_:.-+!", *p->at)); p->at++)
        if (n + 1 < NAME_MAX_BYTES)
            out[n++] = *p->at;
    out[n] = 0;
}

static int at_string(parser *p)
{
    blanks(p);
    return *p->at == '"' || *p->at == '\'';
}

/** A text in single or triple quotes: its beginning and length. */
static adcgs_status string(parser *p, const char **text, size_t *n)
{
    if (!at_string(p))
        return bad(p, "a text");
    const char quote = *p->at;
    const size_t quotes = p->at[1] == quote && p->at[2] == quote ? 3 : 1;
    *text = p->at += quotes;
    for (;; p->at++) {
        if (!*p->at)
            return bad(p, "the end of a text");
        if (*p->at == quote && (quotes == 1 || (p->at[1] == quote && p->at[2] == quote)))
            break;
        p->line += *p->at == '\n';
        p->at += *p->at == '\\' && p->at[1];
    }
    *n = (size_t)(p->at - *text);
    p->at += quotes;
    return ADCGS_OK;
}

/** Skip a pair of brackets with its content. */
static adcgs_status skip_brackets(parser *p)
{
    const char *text;
    size_t n;
    for (int depth = 0;;) {
        blanks(p);
        if (at_string(p)) {
            ADCGS_TRY(string(p, &text, &n));
            continue;
        }
        if (*p->at == '@') /* a path in @ signs */
            p->at += 1 + strcspn(p->at + 1, "@\n");
        if (!*p->at)
            return bad(p, "a closing bracket");
        depth += strchr("([{", *p->at) ? 1 : strchr(")]}", *p->at) ? -1 : 0;
        p->at++;
        if (!depth)
            return ADCGS_OK;
    }
}

/** Skip a value of an unwanted property. */
static adcgs_status skip_value(parser *p)
{
    const char *text;
    char name[NAME_MAX_BYTES];
    size_t n;
    if (at_string(p))
        return string(p, &text, &n);
    if (*p->at && strchr("([{", *p->at))
        return skip_brackets(p);
    if (*p->at == '@' || *p->at == '<') {
        const char *const end = strchr(p->at + 1, *p->at == '@' ? '@' : '>');
        if (!end)
            return bad(p, "the end of a path");
        p->at = end + 1;
        return ADCGS_OK;
    }
    word(p, name);
    return *name ? ADCGS_OK : bad(p, "a value");
}

/* ---- Values ---- */

/** Numbers, in brackets or single; *n is 0 for None. */
static adcgs_status numbers(parser *p, double out[ADCGS_USDA_NUMBERS], int *n)
{
    int depth = 0;
    *n = 0;
    blanks(p);
    if (!strncmp(p->at, "None", 4)) {
        p->at += 4;
        return ADCGS_OK;
    }
    do {
        while (accept_sign(p, '('))
            depth++;
        char *end;
        blanks(p);
        const double value = strtod(p->at, &end);
        if (end == p->at || !isfinite(value) || *n == ADCGS_USDA_NUMBERS)
            return bad(p, "numbers, at most 16");
        p->at = end;
        out[(*n)++] = value;
        while (depth && accept_sign(p, ')'))
            depth--;
    } while (depth && accept_sign(p, ','));
    return depth ? bad(p, "')'") : ADCGS_OK;
}

static adcgs_status add_sample(parser *p, adcgs_usda_property *to, double at)
{
    adcgs_usda_sample sample = {.at = at};
    int n;
    ADCGS_TRY(numbers(p, sample.v, &n));
    if (!n)
        return ADCGS_OK; /* blocked: treated as missing */
    if (to->n && n != to->n)
        return bad(p, "as many numbers as before");
    if (to->n_samples && at <= to->samples[to->n_samples - 1].at)
        return bad(p, "ascending times");
    to->n = n;
    if (to->n_samples == SAMPLES_MAX)
        return bad(p, "at most a million samples");
    if (!(to->n_samples & (to->n_samples - 1))) { /* a power of two, or zero: double the memory */
        const size_t room = to->n_samples ? 2 * (size_t)to->n_samples : 1;
        adcgs_usda_sample *const more = realloc(to->samples, room * sizeof *more);
        if (!more)
            return no_memory(p);
        to->samples = more;
    }
    to->samples[to->n_samples++] = sample;
    return ADCGS_OK;
}

static adcgs_status time_samples(parser *p, adcgs_usda_property *to)
{
    ADCGS_TRY(need(p, '{'));
    while (!accept_sign(p, '}')) {
        char *end;
        blanks(p);
        const double at = strtod(p->at, &end);
        if (end == p->at || !isfinite(at))
            return bad(p, "a time");
        p->at = end;
        ADCGS_TRY(need(p, ':'));
        ADCGS_TRY(add_sample(p, to, at));
        accept_sign(p, ',');
    }
    return ADCGS_OK;
}

/** A text, or an array of texts. */
static adcgs_status texts(parser *p, adcgs_usda_property *to)
{
    const int is_array = accept_sign(p, '[');
    size_t used = 0;
    while (!is_array || !accept_sign(p, ']')) {
        const char *text;
        size_t n;
        ADCGS_TRY(string(p, &text, &n));
        char *const more = realloc(to->text, used + n + 2);
        if (!more)
            return no_memory(p);
        to->text = more;
        memcpy(more + used, text, n);
        used += n;
        more[used++] = '\n';
        more[used] = 0;
        if (!is_array)
            break;
        accept_sign(p, ',');
    }
    return ADCGS_OK;
}

static adcgs_usda_property *new_property(parser *p, int prim, const char *name)
{
    adcgs_usda *const u = p->out;
    adcgs_usda_property *const more = realloc(u->properties, ((size_t)u->n_properties + 1) * sizeof *more);
    if (!more)
        return NULL;
    u->properties = more;
    adcgs_usda_property *const property = &more[u->n_properties];
    *property = (adcgs_usda_property){.name = strdup(name), .prim = prim};
    u->n_properties += property->name != NULL;
    return property->name ? property : NULL;
}

/** Parse the rest of a property after its name: an optional value and optional metadata. */
static adcgs_status value_of(parser *p, int prim, char name[NAME_MAX_BYTES])
{
    char *const suffix = strstr(name, ".timeSamples");
    const int is_sampled = suffix && !suffix[12];
    if (is_sampled)
        *suffix = 0;
    if (accept_sign(p, '=')) {
        adcgs_usda_property *const to = p->wanted(name) ? new_property(p, prim, name) : NULL;
        if (!to && p->wanted(name))
            return no_memory(p);
        if (!to)
            ADCGS_TRY(skip_value(p));
        else if (is_sampled)
            ADCGS_TRY(time_samples(p, to));
        else if (at_string(p) || *p->at == '[')
            ADCGS_TRY(texts(p, to));
        else {
            ADCGS_TRY(add_sample(p, to, 0.0));
            to->is_fixed = 1;
        }
    }
    p->at += strspn(p->at, " \t");
    return *p->at == '(' ? skip_brackets(p) : ADCGS_OK;
}

/* ---- Prims ---- */

static adcgs_status body(parser *p, int prim, int depth);

/** Parse def Type "name" (...) { ... } after its first word. */
static adcgs_status prim_of(parser *p, int parent, int depth)
{
    adcgs_usda *const u = p->out;
    char type[NAME_MAX_BYTES];
    const char *text;
    size_t n;
    word(p, type);
    ADCGS_TRY(string(p, &text, &n));
    adcgs_usda_prim *const more = realloc(u->prims, ((size_t)u->n_prims + 1) * sizeof *more);
    if (!more)
        return no_memory(p);
    u->prims = more;
    more[u->n_prims] = (adcgs_usda_prim){.parent = parent};
    snprintf(more[u->n_prims].type, sizeof more->type, "%.31s", type);
    const int prim = u->n_prims++;
    blanks(p);
    if (*p->at == '(')
        ADCGS_TRY(skip_brackets(p));
    ADCGS_TRY(need(p, '{'));
    if (depth == DEPTH_MAX)
        return bad(p, "less deeply nested prims");
    ADCGS_TRY(body(p, prim, depth + 1));
    return need(p, '}');
}

/** Skip a prim that only changes, prepares or chooses other prims. */
static adcgs_status skip_prim(parser *p)
{
    while (*p->at && *p->at != '{') {
        const char *text;
        size_t n;
        if (at_string(p))
            ADCGS_TRY(string(p, &text, &n));
        else if (*p->at == '(')
            ADCGS_TRY(skip_brackets(p));
        else if (*p->at && *p->at != '{')
            p->at++;
        blanks(p);
    }
    return *p->at ? skip_brackets(p) : bad(p, "'{'");
}

/** Parse a property of a prim after its first word: [custom] [uniform] type name [= value]. */
static adcgs_status property_of(parser *p, int prim, char name[NAME_MAX_BYTES])
{
    for (;;) {
        p->at += strspn(p->at, " \t[]");
        if (*p->at != '_' && !isalpha((unsigned char)*p->at))
            return value_of(p, prim, name);
        word(p, name);
    }
}

static adcgs_status body(parser *p, int prim, int depth)
{
    for (;;) {
        char name[NAME_MAX_BYTES];
        word(p, name);
        if (!strcmp(name, "def"))
            ADCGS_TRY(prim_of(p, prim, depth));
        else if (!strcmp(name, "over") || !strcmp(name, "class") || !strcmp(name, "variantSet"))
            ADCGS_TRY(skip_prim(p));
        else if (*name)
            ADCGS_TRY(property_of(p, prim, name));
        else if (!accept_sign(p, ';'))
            return ADCGS_OK;
    }
}

/** Parse the file's metadata, in brackets: texts and NAME = VALUE. */
static adcgs_status head(parser *p)
{
    const char *text;
    size_t n;
    if (!accept_sign(p, '('))
        return ADCGS_OK;
    while (!accept_sign(p, ')')) {
        char name[NAME_MAX_BYTES];
        if (at_string(p)) {
            ADCGS_TRY(string(p, &text, &n));
            continue;
        }
        word(p, name);
        if (!*name)
            return bad(p, "a name");
        ADCGS_TRY(value_of(p, -1, name));
        accept_sign(p, ';');
    }
    return ADCGS_OK;
}

adcgs_status adcgs_usda_read(adcgs_usda *out, const char *path, int (*wanted)(const char *name), adcgs_error *error)
{
    uint8_t *data;
    size_t bytes;
    *out = (adcgs_usda){0};
    ADCGS_TRY(adcgs_file_load_text(&data, &bytes, path, BYTES_MAX, error));
    parser p = {path, (const char *)data, 1, wanted, out, error};
    adcgs_status status = ADCGS_OK;
    if (bytes >= 8 && !memcmp(data, "PXR-USDC", 8))
        status = adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: binary USD, expected text; convert it with usdcat", path);
    else if (strncmp(p.at, "#usda 1.", 8) || memchr(data, 0, bytes))
        status = adcgs_fail(error, ADCGS_ERR_DATA, "%s: not USD text, which begins with #usda 1.0", path);
    if (status == ADCGS_OK)
        status = head(&p);
    if (status == ADCGS_OK)
        status = body(&p, -1, 0);
    if (status == ADCGS_OK && *p.at)
        status = bad(&p, "a prim or a property");
    free(data);
    if (status != ADCGS_OK)
        adcgs_usda_free(out);
    return status;
}
