/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Size of the frames of a Y4M stream. */
#include "config.h"

#include "media/video/y4m_shape.h"

#include "media/image/image.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/** Chroma subsampling of a colour space by the beginning of its name, across and down; 0: no chroma. */
static const struct {
    const char *name;
    int across, down;
} spaces[] = {{"420", 2, 2}, {"422", 2, 1}, {"444", 1, 1}, {"411", 4, 1}, {"mono", 0, 0}};

/** The rest of the name: bytes per sample, and whether there is an alpha plane. */
static const struct {
    const char *name;
    int bytes, alpha;
} kinds[] = {{"", 1, 0},    {"jpeg", 1, 0}, {"mpeg2", 1, 0}, {"paldv", 1, 0}, {"alpha", 1, 1}, {"p9", 2, 0}, {"p10", 2, 0},
             {"p12", 2, 0}, {"p14", 2, 0},  {"p16", 2, 0},   {"9", 2, 0},     {"10", 2, 0},    {"12", 2, 0}, {"16", 2, 0}};

/** Bytes of a frame; 0 for an unknown colour space. */
static size_t frame_bytes(const char *space, size_t width, size_t height)
{
    for (size_t i = 0; i < ADCGS_COUNTOF(spaces); i++) {
        const size_t length = strlen(spaces[i].name);
        if (strncmp(space, spaces[i].name, length) != 0)
            continue;
        const size_t across = (size_t)spaces[i].across, down = (size_t)spaces[i].down;
        const size_t chroma = across ? 2 * ((width + across - 1) / across) * ((height + down - 1) / down) : 0;
        for (size_t k = 0; k < ADCGS_COUNTOF(kinds); k++)
            if (!strcmp(space + length, kinds[k].name))
                return (size_t)kinds[k].bytes * (width * height * (size_t)(1 + kinds[k].alpha) + chroma);
    }
    return 0;
}

/** A whole number up to `most` without trailing characters; -1 for other text. */
static long read_number(const char *text, long most)
{
    char *end;
    const long value = strtol(text, &end, 10);
    return *text >= '0' && *text <= '9' && !*end && value <= most ? value : -1;
}

static void read_rate(adcgs_fps *rate, const char *text)
{
    char *end;
    const unsigned long num = strtoul(text, &end, 10), den = *end == ':' ? strtoul(end + 1, NULL, 10) : 0;
    if (num > 0 && den > 0 && num <= UINT32_MAX && den <= UINT32_MAX)
        *rate = adcgs_fps_of((double)num / (double)den);
}

adcgs_status adcgs_y4m_shape_parse(adcgs_y4m_shape *out, const char *line, const char *path, adcgs_error *error)
{
    static const char magic[] = "YUV4MPEG2 ";
    char copy[ADCGS_Y4M_LINE_MAX + 1], *rest = NULL, space[32] = "420";
    *out = (adcgs_y4m_shape){.width = -1, .height = -1};
    if (strncmp(line, magic, sizeof magic - 1) != 0 || strlen(line) >= sizeof copy)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: expected Y4M, which begins with YUV4MPEG2", path);
    strcpy(copy, line + sizeof magic - 1);
    for (char *field = strtok_r(copy, " ", &rest); field; field = strtok_r(NULL, " ", &rest)) {
        if (*field == 'W')
            out->width = (int)read_number(field + 1, ADCGS_IMAGE_MAX);
        else if (*field == 'H')
            out->height = (int)read_number(field + 1, ADCGS_IMAGE_MAX);
        else if (*field == 'F')
            read_rate(&out->rate, field + 1);
        else if (*field == 'C')
            snprintf(space, sizeof space, "%s", field + 1);
    }
    if (out->width < 1 || out->height < 1)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: its first line has no width and height from 1 to %d", path,
                          ADCGS_IMAGE_MAX);
    out->frame_bytes = frame_bytes(space, (size_t)out->width, (size_t)out->height);
    return out->frame_bytes
               ? ADCGS_OK
               : adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: Y4M in the colour space %.31s is not supported", path, space);
}
