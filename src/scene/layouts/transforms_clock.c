/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Fields that give the time of a frame of a transforms file in other programs. */
#include "config.h"

#include "scene/layouts/transforms_clock.h"

#include "base/base.h"

#include <strings.h>

/** True if other programs use this name for a time or the number of a frame. "time" itself is excluded, since it is read. */
static int is_clock_name(const char *name, int is_number)
{
    static const char *const names[] = {"t", "sec", "secs", "seconds", "date", "datetime"};
    if (!strcmp(name, "time"))
        return 0;
    for (size_t i = 0; i < ADCGS_COUNTOF(names); i++)
        if (!strcasecmp(name, names[i]))
            return 1;
    for (; *name; name++)
        if (!strncasecmp(name, "time", 4) || (is_number && !strncasecmp(name, "frame", 5)))
            return 1;
    return 0;
}

const char *adcgs_transforms_clock(json_t *frames, size_t n)
{
    const char *name;
    json_t *first;
    json_object_foreach(json_array_get(frames, 0), name, first)
    {
        const int is_number = json_is_number(first);
        if ((!is_number && !json_is_string(first)) || !is_clock_name(name, is_number))
            continue;
        for (size_t i = 1; i < n; i++) {
            json_t *other = json_object_get(json_array_get(frames, i), name);
            if (other && json_is_number(other) == is_number && !json_equal(first, other))
                return name;
        }
    }
    return NULL;
}
