/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The sound of a page. */
#include "config.h"

#include "apps/share/share_sound.h"

#include "scene/layouts/sound_file.h"
#include "system/file.h"

#include <stdlib.h>

/* Bytes: many times the stream, and in base 64 a third more; chosen by hand, not measured. */
#define SOUND_FILE_MAX ((uint64_t)64 << 20)

/** The type of a file that begins with these bytes; NULL: no sound that browsers know. */
static const char *type_of(const uint8_t *data, size_t bytes)
{
    static const struct {
        size_t at;
        const char *text;
        const char *type;
    } types[] = {{0, "OggS", "audio/ogg"},  {0, "\x1a\x45\xdf\xa3", "audio/webm"},
                 {4, "ftyp", "audio/mp4"},  {8, "WAVE", "audio/wav"},
                 {0, "fLaC", "audio/flac"}, {0, "ID3", "audio/mpeg"}};
    for (size_t i = 0; i < ADCGS_COUNTOF(types); i++) {
        const size_t length = strlen(types[i].text);
        if (bytes >= types[i].at + length && !memcmp(data + types[i].at, types[i].text, length))
            return types[i].type;
    }
    /* MP3 without a tag: the sync word of a frame of layer III, which AAC's frames lack. */
    return bytes >= 2 && data[0] == 0xff && (data[1] & 0xe6) == 0xe2 ? "audio/mpeg" : NULL;
}

static adcgs_status load_file(adcgs_share_sound *sound, const char *path, adcgs_error *error)
{
    ADCGS_TRY(adcgs_file_load(&sound->data, &sound->bytes, path, SOUND_FILE_MAX, error));
    sound->type = type_of(sound->data, sound->bytes);
    return sound->type ? ADCGS_OK
                       : adcgs_fail(error, ADCGS_ERR_DATA, "%.160s: no sound, expected Ogg, WebM, MP4, MP3, FLAC or WAV", path);
}

adcgs_status adcgs_share_load_sound(adcgs_share_sound *sound, const char *path, adcgs_error *error)
{
    char *file;
    ADCGS_TRY(adcgs_sound_file_find(&file, &sound->offset, path, error));
    const adcgs_status status = file ? load_file(sound, file, error) : ADCGS_OK;
    free(file);
    return status;
}
