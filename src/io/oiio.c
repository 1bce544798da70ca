/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The module that holds OpenImageIO: found and opened once. */
#include "config.h"

#include "io/oiio_shim.h"

#ifdef OIIO_MODULE

#include <dlfcn.h>
#include <limits.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#define MODULE "adcgs_oiio.so"

/** Written once, under once. */
static pthread_once_t once = PTHREAD_ONCE_INIT;
static const adcgs_oiio *table;
static char reason[160]; /**< why there is no table */

/** \return whether the module in the directory is ours; else the reason says why not. */
static int open_in(const char *directory, const char *below)
{
    char name[PATH_MAX];
    if ((size_t)snprintf(name, sizeof name, "%s%s/%s", directory, below, MODULE) >= sizeof name)
        return 0;
    if (access(name, R_OK)) {
        if (!*reason)
            snprintf(reason, sizeof reason, "no %s in %.120s", MODULE, directory);
        return 0;
    }
    void *const module = dlopen(name, RTLD_NOW | RTLD_LOCAL);
    const adcgs_oiio *const found = module ? dlsym(module, "adcgs_oiio_table") : NULL;
    if (!found || strcmp(found->version, PACKAGE_VERSION)) {
        const char *const why = module ? "another version's" : dlerror();
        snprintf(reason, sizeof reason, "%.150s", why ? why : name);
        if (module)
            dlclose(module);
        return 0;
    }
    table = found;
    return 1;
}

/** The directory of the running program, without the last slash. Only Linux tells. \return 0 if it is not known. */
static int program_directory(char directory[PATH_MAX])
{
    const ssize_t n = readlink("/proc/self/exe", directory, PATH_MAX - 1);
    directory[n > 0 ? n : 0] = 0;
    char *const slash = strrchr(directory, '/');
    if (slash)
        *slash = 0;
    return slash != NULL;
}

static void open_module(void)
{
    char beside[PATH_MAX];
    const char *const chosen = getenv("ADCGS_MODULES");
    if (chosen && *chosen) {
        open_in(chosen, "");
        return;
    }
    if (program_directory(beside) && (open_in(beside, "/.libs") || open_in(beside, "/../lib/adcgs")))
        return;
    *reason = 0; /* the place where it was installed is the one to name */
    open_in(MODULES_DIRECTORY, "");
}

adcgs_status adcgs_oiio_get(const adcgs_oiio **oiio, const char *path, adcgs_error *error)
{
    pthread_once(&once, open_module);
    *oiio = table;
    return table ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: images need OpenImageIO: %s", path, reason);
}

#else

adcgs_status adcgs_oiio_get(const adcgs_oiio **oiio, const char *path, adcgs_error *error)
{
    *oiio = &adcgs_oiio_table;
    return ADCGS_OK;
}

#endif
