/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Panoramas, by the metadata of a JPEG. */
#include "config.h"

#include "media/image/panorama.h"

#include "system/file.h"

#include <ctype.h>
#include <stdlib.h>

#define BYTES_MOST ((size_t)256 << 10) /* examined at the beginning: metadata precede the image; chosen by hand, not measured */

/* Segments of a JPEG (definition: ITU-T T.81, Annex B): a marker, then a length that includes itself. */
#define APP1 0xe1 /* EXIF, and XMP with a name before its packet */
#define SOS 0xda  /* the image follows */

static const char xmp[] = "http://ns.adobe.com/xap/1.0/"; /* with its zero */
static const char property[] = "GPano:ProjectionType";

static int is_end(uint8_t c)
{
    return c == '"' || c == '\'' || c == '<' || c == '>' || isspace(c);
}

/** The value after a property's name: ="VALUE", or >VALUE<. */
static void read_value(char projection[ADCGS_PANORAMA_NAME], const uint8_t *text, size_t n)
{
    size_t at = 0, length = 0;
    while (at < n && (is_end(text[at]) || text[at] == '='))
        at++;
    for (; at < n && !is_end(text[at]) && isgraph(text[at]) && length < ADCGS_PANORAMA_NAME - 1; at++)
        projection[length++] = (char)text[at];
    projection[length] = 0;
}

static void find_in_packet(char projection[ADCGS_PANORAMA_NAME], const uint8_t *packet, size_t n)
{
    const size_t name = sizeof property - 1;
    for (size_t at = 0; at + name <= n && !*projection; at++)
        if (packet[at] == 'G' && !memcmp(packet + at, property, name))
            read_value(projection, packet + at + name, n - at - name);
}

void adcgs_panorama_find(char projection[ADCGS_PANORAMA_NAME], const uint8_t *data, size_t n)
{
    *projection = 0;
    if (n < 2 || data[0] != 0xff || data[1] != 0xd8)
        return;
    for (size_t at = 2; at + 4 <= n && data[at] == 0xff && data[at + 1] != SOS && !*projection;) {
        const size_t length = (size_t)data[at + 2] << 8 | data[at + 3], all = ADCGS_MIN(length, n - at - 2);
        const uint8_t *const content = data + at + 4;
        if (data[at + 1] == APP1 && all > 2 + sizeof xmp && !memcmp(content, xmp, sizeof xmp))
            find_in_packet(projection, content + sizeof xmp, all - 2 - sizeof xmp);
        at += 2 + ADCGS_MAX(length, 2);
    }
}

adcgs_status adcgs_panorama_of(char projection[ADCGS_PANORAMA_NAME], const char *path, adcgs_error *error)
{
    FILE *file;
    *projection = 0;
    ADCGS_TRY(adcgs_file_open(&file, path, error));
    uint8_t *const data = malloc(BYTES_MOST);
    if (data)
        adcgs_panorama_find(projection, data, fread(data, 1, BYTES_MOST, file));
    free(data);
    fclose(file);
    return data ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
}
