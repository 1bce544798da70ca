/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The default memory limit for images. */
#include "config.h"

#include "scene/image_store.h"

#include <limits.h>
#include <stdio.h>
#include <sys/resource.h>
#include <unistd.h>

/** The lowest limit of the cgroup of this name and its ancestors. */
static uint64_t cgroup_limit(const char *root, const char *name, const char *file, uint64_t least)
{
    char path[PATH_MAX];
    for (size_t n = strlen(name);; n--) {
        unsigned long long value;
        while (n && name[n] != '/' && name[n])
            n--;
        snprintf(path, sizeof path, "%s%.*s/%s", root, (int)n, name, file);
        FILE *const f = fopen(path, "r");
        if (f && fscanf(f, "%llu", &value) == 1) /* "max" is no number */
            least = ADCGS_MIN(least, (uint64_t)value);
        if (f)
            fclose(f);
        if (!n)
            return least;
    }
}

/** Applies the limits of containers and job schedulers: a process beyond them is killed without saving its state. */
static uint64_t limited(uint64_t most)
{
    char line[PATH_MAX];
    struct rlimit space;
    FILE *const f = fopen("/proc/self/cgroup", "r");
    while (f && fgets(line, sizeof line, f)) {
        line[strcspn(line, "\n")] = '\0';
        const char *const controllers = strchr(line, ':'), *const name = controllers ? strchr(controllers + 1, ':') : NULL;
        if (name && !strncmp(line, "0::", 3))
            most = cgroup_limit("/sys/fs/cgroup", name + 1, "memory.max", most);
        else if (name && !strncmp(controllers, ":memory:", 8))
            most = cgroup_limit("/sys/fs/cgroup/memory", name + 1, "memory.limit_in_bytes", most);
    }
    if (f)
        fclose(f);
    return !getrlimit(RLIMIT_AS, &space) && space.rlim_cur != RLIM_INFINITY ? ADCGS_MIN(most, (uint64_t)space.rlim_cur) : most;
}

uint64_t adcgs_image_store_default_memory(void)
{
    const long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGESIZE);
    return limited(pages > 0 && size > 0 ? (uint64_t)pages * (uint64_t)size : (uint64_t)1 << 31) / 2;
}
