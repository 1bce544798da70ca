/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The stream in a page of adcgs-share. */
#include "config.h"

#include "media/page_stream.h"

#include "system/base64.h"
#include "system/file.h"

#include <stdlib.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define TAG_MAX 2048         /* bytes of a start tag: its name is that of a file */
#define MARKS 1024           /* stored positions of letters */
#define NOWHERE UINT64_MAX   /* as `next`: the next read goes to a stored position */
#define FIRST_STRIDE 0x10000 /* letters between two marks; doubled when all are in use */

struct adcgs_page_stream {
    FILE *file;
    uint64_t letters; /**< padding included; a multiple of 4 */
    uint64_t size;
    uint64_t stride, mark[MARKS]; /**< mark[i]: position in the file of letter i * stride */
    uint64_t next;                /**< letter at the position of the file */
    uint8_t group[3];             /**< bytes of the group of letters before `next` */
    uint64_t at;                  /**< offset for reading in order */
    char name[TAG_MAX];
};

static int is_blank(int c)
{
    return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f';
}

/* ---- The element ---- */

/** Position in the page while it is examined. */
typedef struct scan {
    adcgs_page_stream *page;
    const char *path;
    uint64_t line;
    int pads;
} scan;

static int next_byte(scan *s)
{
    const int c = getc(s->page->file);
    s->line += c == '\n';
    return c;
}

/** Stores the value of the attribute data-name, without a folder. */
static void store_name(adcgs_page_stream *page, const char *tag)
{
    static const char attribute[] = " data-name=\"";
    static const struct {
        const char *code;
        char is;
    } codes[] = {{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}};
    const char *at = strstr(tag, attribute);
    size_t n = 0;
    for (at = at ? at + sizeof attribute - 1 : ""; *at && *at != '"'; at++) {
        page->name[n] = *at;
        for (size_t i = 0; i < ADCGS_COUNTOF(codes); i++)
            if (!strncmp(at, codes[i].code, strlen(codes[i].code))) {
                page->name[n] = codes[i].is;
                at += strlen(codes[i].code) - 1;
                break;
            }
        n = *at == '/' ? 0 : n + 1;
    }
    page->name[n] = 0;
}

/** Reads up to the end of the start tag of the element. \return 0 if there is none. */
static int find_element(scan *s)
{
    char tag[TAG_MAX];
    size_t n = 0;
    int c, within = 0;
    while ((c = next_byte(s)) != EOF) {
        if (c == '<' || n == sizeof tag - 1) {
            within = c == '<';
            n = 0;
        }
        if (within)
            tag[n++] = is_blank(c) || !c ? ' ' : (char)c;
        if (!within || c != '>')
            continue;
        tag[n] = 0;
        within = 0;
        if (!strncmp(tag, "<script ", 8) && strstr(tag, " id=\"scene\"")) {
            store_name(s->page, tag);
            return 1;
        }
    }
    return 0;
}

/** Stores the position of the letter that was read last, if it is one of those. */
static void store_mark(adcgs_page_stream *page)
{
    if (page->letters % page->stride)
        return;
    if (page->letters / page->stride == MARKS) {
        for (size_t i = 0; i < MARKS / 2; i++)
            page->mark[i] = page->mark[2 * i];
        page->stride *= 2;
    }
    page->mark[page->letters / page->stride] = (uint64_t)ftello(page->file) - 1;
}

static adcgs_status refuse_byte(const scan *s, int c, const char *expected, adcgs_error *error)
{
    char found[24];
    snprintf(found, sizeof found, c > ' ' && c < 0x7f ? "'%c'" : "byte 0x%02x", c);
    return adcgs_fail(error, ADCGS_ERR_DATA, "%.150s: line %llu: %s in the page's stream, expected %s", s->path,
                      (unsigned long long)s->line, found, expected);
}

/** Checks and counts the letters of the element. */
static adcgs_status scan_letters(scan *s, adcgs_error *error)
{
    adcgs_page_stream *const page = s->page;
    int c;
    while ((c = next_byte(s)) != EOF && c != '<') {
        if (is_blank(c))
            continue;
        if (c != '=' && adcgs_base64_value(c) < 0)
            return refuse_byte(s, c, "base 64", error);
        if (s->pads && (c != '=' || s->pads == 2 || page->letters % 4 == 0))
            return refuse_byte(s, c, "its end", error);
        if (c == '=' && page->letters % 4 < 2)
            return refuse_byte(s, c, "a letter of base 64", error);
        s->pads += c == '=';
        store_mark(page);
        page->letters++;
    }
    if (c == EOF)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%.150s: line %llu: the file ends in the page's stream, expected </script>",
                          s->path, (unsigned long long)s->line);
    if (page->letters % 4)
        return adcgs_fail(error, ADCGS_ERR_DATA,
                          "%.150s: line %llu: the page's stream has %llu letters of base 64, expected a multiple of 4", s->path,
                          (unsigned long long)s->line, (unsigned long long)page->letters);
    return ADCGS_OK;
}

static adcgs_status scan_page(scan *s, adcgs_error *error)
{
    adcgs_page_stream *const page = s->page;
    adcgs_status status = ADCGS_OK;
    if (find_element(s))
        status = scan_letters(s, error);
    if (ferror(page->file))
        return adcgs_fail(error, ADCGS_ERR_IO, "%.160s: cannot read", s->path);
    if (status == ADCGS_OK && !page->letters)
        return adcgs_fail(error, ADCGS_ERR_DATA,
                          "%.150s: a page (HTML) without a stream, expected an adcgs stream or a page of adcgs-share with one",
                          s->path);
    page->size = page->letters / 4 * 3 - (uint64_t)s->pads;
    page->next = NOWHERE;
    return status;
}

adcgs_status adcgs_page_stream_open(adcgs_page_stream **out, const char *path, adcgs_error *error)
{
    adcgs_page_stream *page = calloc(1, sizeof *page);
    *out = NULL;
    if (!page)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%.160s: out of memory", path);
    page->stride = FIRST_STRIDE;
    adcgs_status status = adcgs_file_open(&page->file, path, error);
    if (status == ADCGS_OK)
        status = scan_page(&(scan){.page = page, .path = path, .line = 1}, error);
    if (status == ADCGS_OK)
        *out = page;
    else
        adcgs_page_stream_close(&page);
    return status;
}

void adcgs_page_stream_close(adcgs_page_stream **page)
{
    if (*page && (*page)->file)
        fclose((*page)->file);
    free(*page);
    *page = NULL;
}

uint64_t adcgs_page_stream_size(const adcgs_page_stream *page)
{
    return page->size;
}

const char *adcgs_page_stream_name(const adcgs_page_stream *page)
{
    return page->name;
}

/* ---- Its bytes ---- */

/** Reads the next four letters. \return 0 if the file has changed since it was opened. */
static int read_group(adcgs_page_stream *page)
{
    uint32_t bits = 0;
    for (int n = 0; n < 4;) {
        const int c = getc(page->file), value = c == '=' ? 0 : adcgs_base64_value(c);
        if (value < 0 && !is_blank(c))
            return 0;
        if (value < 0)
            continue;
        bits = bits << 6 | (uint32_t)value;
        n++;
    }
    for (int i = 0; i < 3; i++)
        page->group[i] = (uint8_t)(bits >> (16 - 8 * i));
    page->next += 4;
    return 1;
}

/** Makes `group` that of this letter. */
static int find_group(adcgs_page_stream *page, uint64_t letter)
{
    const uint64_t mark = letter / page->stride;
    if (page->next == letter + 4)
        return 1;
    if (page->next > letter || mark * page->stride > page->next) {
        if (fseeko(page->file, (off_t)page->mark[mark], SEEK_SET))
            return 0;
        page->next = mark * page->stride;
    }
    while (page->next <= letter)
        if (!read_group(page))
            return 0;
    return 1;
}

int64_t adcgs_page_stream_read_at(void *user, uint64_t offset, void *buffer, size_t bytes)
{
    adcgs_page_stream *const page = user;
    uint8_t *const out = buffer;
    const size_t n = offset < page->size ? (size_t)ADCGS_MIN((uint64_t)bytes, page->size - offset) : 0;
    for (size_t i = 0; i < n; i++) {
        const uint64_t group = (offset + i) / 3;
        if (!find_group(page, 4 * group)) {
            page->next = NOWHERE;
            return -1;
        }
        out[i] = page->group[(offset + i) % 3];
    }
    return (int64_t)n;
}

int64_t adcgs_page_stream_read(void *user, void *buffer, size_t bytes)
{
    adcgs_page_stream *const page = user;
    const int64_t n = adcgs_page_stream_read_at(page, page->at, buffer, bytes);
    if (n > 0)
        page->at += (uint64_t)n;
    return n;
}
