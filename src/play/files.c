/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Unused file names. */
#include "config.h"

#include "play/files.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define NUMBERS_MAX 999999 /* largest number in a name: six digits, arithmetic */

int adcgs_play_free_name(char out[PATH_MAX], const char *stream, const char *extension)
{
    const char *const slash = strrchr(stream, '/'), *const name = slash ? slash + 1 : stream, *const dot = strrchr(name, '.');
    const int length = dot && dot > name ? (int)(dot - name) : (int)strlen(name);
    for (int i = 1; i <= NUMBERS_MAX; i++) {
        snprintf(out, PATH_MAX, "%.*s-%06d.%s", length, name, i, extension);
        if (access(out, F_OK))
            return 1;
    }
    *out = 0;
    return 0;
}
