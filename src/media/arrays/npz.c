/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Arrays in NPZ files. The directory at the end gives the position and size of
 * each file. Local headers are read only for their own length, since numpy puts
 * the sizes there into an extra field. Sizes are checked against the bytes
 * present before use.
 */
#include "config.h"

#include "media/arrays/npz.h"

#include "system/file.h"

#include <stdlib.h>

#ifdef HAVE_SPZ /* HAVE_SPZ implies zlib */
#include <zlib.h>
#endif

/* Origin, unless a line states one: chosen by hand, not measured. */
#define FILE_MAX ((uint64_t)4 << 30) /* bytes of an archive */
#define RATIO_MAX 1100               /* upper bound of deflate's compression ratio, which is 1032 (zlib's documentation) */

/* Origin: definition (ZIP, APPNOTE.TXT). Sizes are bytes without names, extra fields and comments. */
#define END_BYTES 22               /* end record, 4.3.16 */
#define ENTRY_BYTES 46             /* entry of the directory, 4.3.12 */
#define LOCAL_BYTES 30             /* local header, 4.3.7 */
#define COMMENT_MAX 65535          /* bytes of the archive's comment: its length has 16 bits */
#define END_MAGIC 0x06054b50u      /* signatures, 4.3.16, 4.3.12 and 4.3.7 */
#define ENTRY_MAGIC 0x02014b50u    /* signature of an entry */
#define LOCAL_MAGIC 0x04034b50u    /* signature of a local header */
#define ENCRYPTED 1u               /* bit of the flags, 4.4.4 */
enum { STORED = 0, DEFLATED = 8 }; /* methods of compression, 4.4.5 */

typedef struct archive {
    const uint8_t *data;
    size_t bytes;
    const char *path;
    adcgs_error *error;
} archive;

/** A file in the directory. */
typedef struct entry {
    unsigned method;
    uint32_t packed, whole, local;
} entry;

static adcgs_status bad(const archive *a, const char *text)
{
    return adcgs_fail(a->error, ADCGS_ERR_DATA, "%s: damaged NPZ file: %s", a->path, text);
}

/** Position of the directory, and its number of files. */
static adcgs_status find_directory(const archive *a, size_t *at, unsigned *n)
{
    const size_t least = a->bytes < END_BYTES + COMMENT_MAX ? 0 : a->bytes - END_BYTES - COMMENT_MAX;
    if (a->bytes < END_BYTES)
        return bad(a, "too short");
    for (size_t i = a->bytes - END_BYTES + 1; i-- > least;)
        if (adcgs_load_le32(a->data + i) == END_MAGIC) {
            *n = adcgs_load_le16(a->data + i + 10);
            *at = adcgs_load_le32(a->data + i + 16);
            return *at <= i ? ADCGS_OK : bad(a, "its directory lies beyond its end");
        }
    return bad(a, "no directory, so the file ends early");
}

static int is_named(const uint8_t *name, size_t n, const char *array)
{
    const size_t stem = strlen(array);
    return n == stem + 4 && !memcmp(name, array, stem) && !memcmp(name + stem, ".npy", 4);
}

static adcgs_status find_entry(const archive *a, const char *array, entry *out)
{
    size_t at = 0;
    unsigned n = 0;
    ADCGS_TRY(find_directory(a, &at, &n));
    for (; n; n--) {
        if (a->bytes - at < ENTRY_BYTES || adcgs_load_le32(a->data + at) != ENTRY_MAGIC)
            return bad(a, "its directory ends early");
        const uint8_t *e = a->data + at;
        const size_t name = adcgs_load_le16(e + 28), rest = (size_t)adcgs_load_le16(e + 30) + adcgs_load_le16(e + 32);
        if (a->bytes - at - ENTRY_BYTES < name + rest)
            return bad(a, "its directory ends early");
        at += ENTRY_BYTES + name + rest;
        if (!is_named(e + ENTRY_BYTES, name, array))
            continue;
        *out = (entry){adcgs_load_le16(e + 10), adcgs_load_le32(e + 20), adcgs_load_le32(e + 24), adcgs_load_le32(e + 42)};
        return adcgs_load_le16(e + 8) & ENCRYPTED ? bad(a, "it is encrypted") : ADCGS_OK;
    }
    return adcgs_fail(a->error, ADCGS_ERR_DATA, "%s: no array %s in the file", a->path, array);
}

static adcgs_status find_bytes(const archive *a, const entry *e, const uint8_t **packed)
{
    if (e->local > a->bytes || a->bytes - e->local < LOCAL_BYTES || adcgs_load_le32(a->data + e->local) != LOCAL_MAGIC)
        return bad(a, "a file is not where its directory says");
    const uint8_t *local = a->data + e->local;
    const size_t head = LOCAL_BYTES + (size_t)adcgs_load_le16(local + 26) + adcgs_load_le16(local + 28);
    if (a->bytes - e->local < head || a->bytes - e->local - head < e->packed)
        return bad(a, "it ends early");
    *packed = local + head;
    return ADCGS_OK;
}

static adcgs_status unpack(const archive *a, const entry *e, const uint8_t *packed, uint8_t *out)
{
    if (e->method == STORED) {
        memcpy(out, packed, e->whole);
        return ADCGS_OK;
    }
#ifdef HAVE_SPZ
    z_stream z = {.next_in = (uint8_t *)(uintptr_t)packed, .avail_in = e->packed, .next_out = out, .avail_out = e->whole};
    if (inflateInit2(&z, -MAX_WBITS) != Z_OK)
        return adcgs_fail(a->error, ADCGS_ERR_MEMORY, "%s: out of memory", a->path);
    const int result = inflate(&z, Z_FINISH);
    const int whole = result == Z_STREAM_END && z.avail_out == 0;
    inflateEnd(&z);
    return whole ? ADCGS_OK : bad(a, "deflated data do not have the length that the directory says");
#else
    return adcgs_fail(a->error, ADCGS_ERR_UNSUPPORTED, "%s: deflated, which this build cannot read: store it by numpy.savez",
                      a->path);
#endif
}

static adcgs_status extract_array(const archive *a, const char *array, uint8_t **out, size_t *bytes)
{
    const uint8_t *packed = NULL;
    entry e = {.method = STORED};
    ADCGS_TRY(find_entry(a, array, &e));
    ADCGS_TRY(find_bytes(a, &e, &packed));
    if (e.method != STORED && e.method != DEFLATED)
        return bad(a, "neither stored nor deflated");
    if (e.method == STORED ? e.whole != e.packed : e.whole / RATIO_MAX > e.packed)
        return bad(a, "a file's size differs from the declared size");
    uint8_t *data = malloc((size_t)e.whole + 1);
    if (!data)
        return adcgs_fail(a->error, ADCGS_ERR_MEMORY, "%s: out of memory", a->path);
    data[e.whole] = 0;
    const adcgs_status status = unpack(a, &e, packed, data);
    if (status != ADCGS_OK) {
        free(data);
        return status;
    }
    *out = data;
    *bytes = e.whole;
    return ADCGS_OK;
}

adcgs_status adcgs_npz_read(uint8_t **out, size_t *bytes, const char *path, const char *array, adcgs_error *error)
{
    uint8_t *data;
    archive a = {.path = path, .error = error};
    *out = NULL;
    ADCGS_TRY(adcgs_file_load(&data, &a.bytes, path, FILE_MAX, error));
    a.data = data;
    const adcgs_status status = extract_array(&a, array, out, bytes);
    free(data);
    return status;
}
