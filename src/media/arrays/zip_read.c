/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Reading ZIP. The directory at the end gives the position and size of each file. Local headers are read only for their own
 * length, since some programs put the sizes there into an extra field, or behind the file. Sizes are checked against the bytes
 * present before use.
 */
#include "config.h"

#include "media/arrays/zip_read.h"
#include "system/zip.h"

#include <stdlib.h>

#if defined(HAVE_SPZ) || defined(HAVE_SOG) /* each implies zlib */
#define HAS_ZLIB
#include <zlib.h>
#endif

/* Origin: definition (ZIP, APPNOTE.TXT). Sizes are bytes without names, extra fields and comments. */
#define END_BYTES 22               /* end record, 4.3.16 */
#define ENTRY_BYTES 46             /* entry of the directory, 4.3.12 */
#define LOCAL_BYTES 30             /* local header, 4.3.7 */
#define COMMENT_MAX 65535          /* bytes of the archive's comment: its length has 16 bits */
#define END_MAGIC 0x06054b50u      /* signatures, 4.3.16, 4.3.12 and 4.3.7 */
#define ENTRY_MAGIC 0x02014b50u    /* signature of an entry */
#define LOCAL_MAGIC 0x04034b50u    /* signature of a local header */
#define ENCRYPTED 1u               /* bit of the flags, 4.4.4 */
#define ZIP64_COUNT 0xffffu        /* a number of entries that an end record of ZIP64 replaces, 4.4.1.4 */
#define ZIP64_SIZE 0xffffffffu     /* a size or position that a field of ZIP64 replaces, 4.4.1.4 */
enum { STORED = 0, DEFLATED = 8 }; /* methods of compression, 4.4.5 */

/** A file in the directory. */
typedef struct entry {
    const uint8_t *name;
    size_t name_bytes;
    unsigned flags, method;
    uint32_t crc, packed, whole, local;
} entry;

static adcgs_status bad(const char *path, const char *text, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_DATA, "%s: damaged ZIP archive: %s", path, text);
}

static adcgs_status zip64(const char *path, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: a ZIP64 archive, expected ZIP of less than 4 GiB", path);
}

int adcgs_zip_is(const uint8_t *data, size_t bytes)
{
    return bytes >= 4 && (adcgs_load_le32(data) == LOCAL_MAGIC || adcgs_load_le32(data) == END_MAGIC);
}

/* ---- The directory ---- */

/** The entry at *at of the directory. Moves *at behind it. \return 0 if the archive ends before */
static int next_entry(const adcgs_zip_archive *zip, size_t *at, entry *out)
{
    if (zip->bytes - *at < ENTRY_BYTES || adcgs_load_le32(zip->data + *at) != ENTRY_MAGIC)
        return 0;
    const uint8_t *const e = zip->data + *at;
    const size_t name = adcgs_load_le16(e + 28), rest = (size_t)adcgs_load_le16(e + 30) + adcgs_load_le16(e + 32);
    if (zip->bytes - *at - ENTRY_BYTES < name + rest)
        return 0;
    *at += ENTRY_BYTES + name + rest;
    *out = (entry){e + ENTRY_BYTES,         name,
                   adcgs_load_le16(e + 8),  adcgs_load_le16(e + 10),
                   adcgs_load_le32(e + 16), adcgs_load_le32(e + 20),
                   adcgs_load_le32(e + 24), adcgs_load_le32(e + 42)};
    return 1;
}

/** Position of the end record, before a comment of any length; the number of bytes without one. */
static size_t find_end(const uint8_t *data, size_t bytes)
{
    const size_t least = bytes < END_BYTES + COMMENT_MAX ? 0 : bytes - END_BYTES - COMMENT_MAX;
    for (size_t i = bytes < END_BYTES ? 0 : bytes - END_BYTES + 1; i-- > least;)
        if (adcgs_load_le32(data + i) == END_MAGIC && adcgs_load_le16(data + i + 20) <= bytes - i - END_BYTES)
            return i;
    return bytes;
}

adcgs_status adcgs_zip_open(adcgs_zip_archive *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error)
{
    const size_t end = find_end(data, bytes);
    *out = (adcgs_zip_archive){.data = data, .bytes = bytes, .path = path};
    if (end == bytes)
        return bad(path, "no directory, so the file ends early", error);
    const unsigned part = adcgs_load_le16(data + end + 4), n = adcgs_load_le16(data + end + 10);
    const uint32_t at = adcgs_load_le32(data + end + 16);
    if (n == ZIP64_COUNT || at == ZIP64_SIZE)
        return zip64(path, error);
    if (part || n != adcgs_load_le16(data + end + 8))
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: a ZIP archive of several parts, expected one file", path);
    if (at > end)
        return bad(path, "its directory lies beyond its end", error);
    size_t next = at;
    entry e;
    for (unsigned i = 0; i < n; i++)
        if (!next_entry(out, &next, &e))
            return bad(path, "its directory ends early", error);
    out->directory = at;
    out->n = n;
    return ADCGS_OK;
}

static int find_entry(const adcgs_zip_archive *zip, const char *name, entry *out)
{
    const size_t bytes = strlen(name);
    size_t at = zip->directory;
    for (unsigned i = 0; i < zip->n && next_entry(zip, &at, out); i++)
        if (out->name_bytes == bytes && !memcmp(out->name, name, bytes))
            return 1;
    return 0;
}

int adcgs_zip_has(const adcgs_zip_archive *zip, const char *name)
{
    entry e;
    return find_entry(zip, name, &e);
}

/* ---- Files ---- */

/** Check the directory's entry of a file, and find its bytes. */
static adcgs_status find_bytes(const adcgs_zip_archive *zip, const entry *e, const uint8_t **packed, adcgs_error *error)
{
    if (e->flags & ENCRYPTED)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: an encrypted ZIP archive", zip->path);
    if (e->packed == ZIP64_SIZE || e->whole == ZIP64_SIZE || e->local == ZIP64_SIZE)
        return zip64(zip->path, error);
    if (e->method != STORED && e->method != DEFLATED)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: a ZIP archive packed by the method %u, expected 0 or 8 (deflate)",
                          zip->path, e->method);
    if (e->local > zip->bytes || zip->bytes - e->local < LOCAL_BYTES || adcgs_load_le32(zip->data + e->local) != LOCAL_MAGIC)
        return bad(zip->path, "a file is not where its directory says", error);
    const uint8_t *const local = zip->data + e->local;
    const size_t head = LOCAL_BYTES + (size_t)adcgs_load_le16(local + 26) + adcgs_load_le16(local + 28);
    if (zip->bytes - e->local < head || zip->bytes - e->local - head < e->packed)
        return bad(zip->path, "it ends early", error);
    if (e->method == STORED ? e->whole != e->packed : e->whole / ADCGS_DEFLATE_RATIO > e->packed)
        return bad(zip->path, "a file's size differs from the declared size", error);
    *packed = local + head;
    return ADCGS_OK;
}

/** Unpack all bytes of a file. */
static adcgs_status fill(const adcgs_zip_archive *zip, const entry *e, const uint8_t *packed, uint8_t *out, adcgs_error *error)
{
    if (e->method == STORED)
        memcpy(out, packed, e->whole);
#ifdef HAS_ZLIB
    if (e->method == DEFLATED) {
        z_stream z = {.next_in = (uint8_t *)(uintptr_t)packed, .avail_in = e->packed, .next_out = out, .avail_out = e->whole};
        if (inflateInit2(&z, -MAX_WBITS) != Z_OK)
            return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", zip->path);
        const int result = inflate(&z, Z_FINISH);
        const int whole = result == Z_STREAM_END && z.avail_out == 0;
        inflateEnd(&z);
        if (!whole)
            return bad(zip->path, "deflated data do not have the declared length", error);
    }
    if (crc32(0, out, e->whole) != e->crc)
        return bad(zip->path, "the checksum of a file does not match", error);
#else
    if (e->method == DEFLATED)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: a deflated ZIP archive, which needs a build with zlib: store it",
                          zip->path);
#endif
    return ADCGS_OK;
}

adcgs_status adcgs_zip_unpack(uint8_t **out, size_t *bytes, const adcgs_zip_archive *zip, const char *name, uint64_t most,
                              adcgs_error *error)
{
    const uint8_t *packed = NULL;
    entry e = {.method = STORED};
    *out = NULL;
    if (!find_entry(zip, name, &e))
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: no file %.100s in the archive", zip->path, name);
    ADCGS_TRY(find_bytes(zip, &e, &packed, error));
    if (e.whole > most)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %.100s: %u bytes, expected at most %llu", zip->path, name, e.whole,
                          (unsigned long long)most);
    uint8_t *const data = malloc((size_t)e.whole + 1);
    if (!data)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %u bytes", zip->path, e.whole);
    const adcgs_status status = fill(zip, &e, packed, data, error);
    if (status != ADCGS_OK) {
        free(data);
        return status;
    }
    data[e.whole] = 0;
    *out = data;
    *bytes = e.whole;
    return ADCGS_OK;
}
