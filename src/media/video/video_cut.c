/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Detecting videos that are shorter than their headers declare, since FFmpeg
 * takes the end of the file for the end of the video.
 */
#include "config.h"

#include "media/video/video_input.h"

#include <sys/stat.h>
#include <unistd.h>

#define HEAD_BYTES 4096 /* of a file, read to find its headers; chosen by hand, not measured */

/** Parse an EBML number, whose first byte gives its length. \return the length; 0 if the number is incomplete */
static size_t ebml_number(uint64_t *value, const uint8_t *p, size_t bytes)
{
    size_t n = 1;
    while (bytes && n <= 8 && !(p[0] & 0x80 >> (n - 1)))
        n++;
    if (!bytes || n > 8 || n > bytes)
        return 0;
    *value = p[0] & (0xffu >> n);
    for (size_t i = 1; i < n; i++)
        *value = *value << 8 | p[i];
    return n;
}

/** End of the element after a four-byte name; 0 if it is not declared. *body: start of the element. */
static uint64_t element_end(uint64_t *body, const uint8_t *head, size_t bytes, uint64_t at, uint32_t name)
{
    uint64_t size = 0;
    if (at > bytes || bytes - at < 4)
        return 0;
    const uint8_t *p = head + at;
    if (((uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3]) != name)
        return 0;
    const size_t n = ebml_number(&size, p + 4, bytes - at - 4);
    if (!n || size == ((uint64_t)1 << 7 * n) - 1)
        return 0;
    *body = at + 4 + n;
    return *body + size;
}

static uint64_t declared_end(const uint8_t *head, size_t bytes)
{
    uint64_t body;
    if (bytes >= 12 && !memcmp(head, "RIFF", 4) && !memcmp(head + 8, "AVI ", 4))
        return (uint64_t)adcgs_load_le32(head + 4) + 8;
    const uint64_t segment = element_end(&body, head, bytes, 0, 0x1a45dfa3);
    return segment ? element_end(&body, head, bytes, segment, 0x18538067) : 0;
}

int adcgs_video_input_cut(const adcgs_video_input *input)
{
    uint8_t head[HEAD_BYTES];
    struct stat status;
    const ssize_t n = pread(input->fd, head, sizeof head, 0);
    return n > 0 && !fstat(input->fd, &status) && declared_end(head, (size_t)n) > (uint64_t)status.st_size;
}
