/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Whether a PNG or JPEG file is whole: its chunks and their checksums, or its segments up to the end of the picture. */
#include "config.h"

#include "io/whole.h"

#include "io/image.h"

#include <stdlib.h>

#define STEP 65536

/* ---- PNG ---- */

static const uint8_t png_magic[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
enum { IHDR_BYTES = 13, TABLE = 256 };

typedef struct png {
    FILE *file;
    const char *path;
    adcgs_error *error;
    uint32_t table[TABLE]; /* of the checksum */
    uint8_t data[STEP];
} png;

static uint32_t load_be32(const uint8_t *p)
{
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3];
}

/** The CRC of ISO 3309, which zlib has too: 0xedb88320, bits from the lowest. */
static void make_table(uint32_t table[TABLE])
{
    for (uint32_t i = 0; i < TABLE; i++) {
        uint32_t c = i;
        for (int bit = 0; bit < 8; bit++)
            c = c & 1 ? 0xedb88320u ^ c >> 1 : c >> 1;
        table[i] = c;
    }
}

static uint32_t update(const png *p, uint32_t crc, const uint8_t *data, size_t n)
{
    for (size_t i = 0; i < n; i++)
        crc = p->table[(crc ^ data[i]) & 0xff] ^ crc >> 8;
    return crc;
}

static adcgs_status ends_early(const png *p)
{
    return adcgs_fail(p->error, ADCGS_ERR_DATA, "%s: damaged image: the file ends early, expected PNG's chunk IEND", p->path);
}

static adcgs_status check_header(const png *p, uint32_t bytes)
{
    static const uint32_t depths[7] = {1 << 1 | 1 << 2 | 1 << 4 | 1 << 8 | 1 << 16, 0, 1 << 8 | 1 << 16,
                                       1 << 1 | 1 << 2 | 1 << 4 | 1 << 8, 1 << 8 | 1 << 16, 0, 1 << 8 | 1 << 16};
    const uint8_t *d = p->data;
    if (bytes != IHDR_BYTES || d[8] > 16 || d[9] > 6 || !(depths[d[9]] & 1u << d[8]) || d[10] || d[11] || d[12] > 1)
        return adcgs_fail(p->error, ADCGS_ERR_DATA, "%s: damaged image: its header IHDR is none of PNG", p->path);
    const uint32_t width = load_be32(d), height = load_be32(d + 4);
    if (!width || !height || width > ADCGS_IMAGE_MAX || height > ADCGS_IMAGE_MAX)
        return adcgs_fail(p->error, ADCGS_ERR_DATA, "%s: %ux%u pixels, expected 1x1 to %dx%d", p->path, width, height,
                          ADCGS_IMAGE_MAX, ADCGS_IMAGE_MAX);
    return ADCGS_OK;
}

/** What a chunk holds, and its checksum; its first bytes are in p->data. */
static adcgs_status read_chunk(png *p, const uint8_t name[4], uint32_t bytes)
{
    uint32_t crc = update(p, 0xffffffff, name, 4), left = bytes;
    uint8_t stored[4];
    while (left) {
        const size_t n = ADCGS_MIN(left, (uint32_t)STEP);
        if (fread(p->data, 1, n, p->file) != n)
            return ends_early(p);
        crc = update(p, crc, p->data, n);
        left -= (uint32_t)n;
    }
    if (fread(stored, 1, 4, p->file) != 4)
        return ends_early(p);
    if ((crc ^ 0xffffffff) != load_be32(stored))
        return adcgs_fail(p->error, ADCGS_ERR_DATA, "%s: damaged image: the checksum of a chunk %.4s is wrong", p->path,
                          (const char *)name);
    return ADCGS_OK;
}

static adcgs_status check_chunks(png *p, int all)
{
    uint8_t head[8];
    make_table(p->table);
    for (int first = 1;; first = 0) {
        if (fread(head, 1, 8, p->file) != 8)
            return ends_early(p);
        const uint32_t bytes = load_be32(head);
        const uint8_t *name = head + 4;
        if (bytes > INT32_MAX || first != !memcmp(name, "IHDR", 4))
            return adcgs_fail(p->error, ADCGS_ERR_DATA, "%s: damaged image: no chunk of PNG where one is expected", p->path);
        if (!all && !memcmp(name, "IDAT", 4))
            return ADCGS_OK;
        ADCGS_TRY(read_chunk(p, name, bytes));
        if (first)
            ADCGS_TRY(check_header(p, bytes));
        if (!memcmp(name, "IEND", 4))
            return ADCGS_OK;
    }
}

static adcgs_status check_png(FILE *file, int all, const char *path, adcgs_error *error)
{
    png *p = malloc(sizeof *p);
    if (!p)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    p->file = file;
    p->path = path;
    p->error = error;
    const adcgs_status status = check_chunks(p, all);
    free(p);
    return status;
}

/* ---- JPEG ---- */

enum { STUFFED = 0x00, TEM = 0x01, RST0 = 0xd0, RST7 = 0xd7, SOI = 0xd8, EOI = 0xd9, MARKER = 0xff };

/** The next marker with a meaning of its own; between segments, and in coded data, there is nothing else of note. */
static int next_marker(FILE *file)
{
    for (int c = getc(file); c != EOF; c = getc(file)) {
        if (c != MARKER)
            continue;
        while (c == MARKER)
            c = getc(file);
        if (c != STUFFED && c != TEM && !(c >= RST0 && c <= RST7) && c != SOI)
            return c;
    }
    return EOF;
}

static adcgs_status check_jpeg(FILE *file, const char *path, adcgs_error *error)
{
    for (int marker = next_marker(file); marker != EOI; marker = next_marker(file)) {
        const int high = marker == EOF ? EOF : getc(file), low = high == EOF ? EOF : getc(file);
        const int bytes = low == EOF ? 0 : high << 8 | low; /* with these two */
        if (bytes < 2 || fseek(file, bytes - 2, SEEK_CUR))
            return adcgs_fail(error, ADCGS_ERR_DATA, "%s: damaged image: the file ends early, expected JPEG's marker EOI", path);
    }
    return ADCGS_OK;
}

adcgs_status adcgs_whole_check(FILE *file, int all, const char *path, adcgs_error *error)
{
    uint8_t magic[8];
    const size_t n = fread(magic, 1, sizeof magic, file);
    adcgs_status status = ADCGS_OK;
    if (n == sizeof magic && !memcmp(magic, png_magic, sizeof magic))
        status = check_png(file, all, path, error);
    else if (all && n >= 3 && magic[0] == MARKER && magic[1] == SOI && magic[2] == MARKER && !fseek(file, 2, SEEK_SET))
        status = check_jpeg(file, path, error);
    if (status == ADCGS_OK && fseek(file, 0, SEEK_SET))
        status = adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot read", path);
    return status;
}
