/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * ZIP with the features that uncompressed files need. Times are the format's
 * first day, so that the same splats give the same bytes.
 */
#include "config.h"

#include "system/zip.h"

#ifdef HAVE_SOG

#include <zlib.h>

/* Origin: definition (ZIP, APPNOTE.TXT 4.3.7, 4.3.12, 4.3.16, 4.4.3, 4.4.6). */
#define LOCAL 30       /* bytes of a file's header */
#define CENTRAL 46     /* bytes of its entry in the directory */
#define END 22         /* bytes of the record after the directory */
#define NEEDED 20      /* tenths of the version that a reader must support */
#define FIRST_DAY 0x21 /* 1 January 1980 in the form of MS-DOS */

static void put(adcgs_zip *zip, const void *data, size_t bytes)
{
    fwrite(data, 1, bytes, zip->file);
    zip->at += (uint32_t)bytes;
}

/** Write the 26 bytes that a file's header and its entry share, beginning with the needed version. */
static void put_common(uint8_t *to, const adcgs_zip *zip, int i)
{
    adcgs_store_le16(to, NEEDED);
    adcgs_store_le16(to + 8, FIRST_DAY);
    adcgs_store_le32(to + 10, zip->files[i].crc);
    adcgs_store_le32(to + 14, zip->files[i].bytes);
    adcgs_store_le32(to + 18, zip->files[i].bytes);
    adcgs_store_le16(to + 22, (uint16_t)strlen(zip->files[i].name));
}

void adcgs_zip_add(adcgs_zip *zip, const char *name, const uint8_t *data, size_t bytes)
{
    uint8_t header[LOCAL] = {'P', 'K', 3, 4};
    const int i = zip->n++;
    zip->files[i].name = name;
    zip->files[i].bytes = (uint32_t)bytes;
    zip->files[i].offset = zip->at;
    zip->files[i].crc = (uint32_t)crc32(0, data, (uInt)bytes);
    put_common(header + 4, zip, i);
    put(zip, header, sizeof header);
    put(zip, name, strlen(name));
    put(zip, data, bytes);
}

void adcgs_zip_end(adcgs_zip *zip)
{
    const uint32_t begin = zip->at;
    for (int i = 0; i < zip->n; i++) {
        uint8_t entry[CENTRAL] = {'P', 'K', 1, 2, NEEDED};
        put_common(entry + 6, zip, i);
        adcgs_store_le32(entry + 42, zip->files[i].offset);
        put(zip, entry, sizeof entry);
        put(zip, zip->files[i].name, strlen(zip->files[i].name));
    }
    uint8_t end[END] = {'P', 'K', 5, 6};
    adcgs_store_le16(end + 8, (uint16_t)zip->n);
    adcgs_store_le16(end + 10, (uint16_t)zip->n);
    adcgs_store_le32(end + 12, zip->at - begin);
    adcgs_store_le32(end + 16, begin);
    put(zip, end, sizeof end);
}

#endif
