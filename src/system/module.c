/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Finding and opening modules. */
#include "config.h"

#include "system/module.h"

#include <dlfcn.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/** \return whether the directory has the module of this version; if not, sets the reason. */
static int open_in(adcgs_module *m, const char *directory, const char *below)
{
    char name[PATH_MAX];
    if ((size_t)snprintf(name, sizeof name, "%s%s/%s", directory, below, m->file) >= sizeof name)
        return 0;
    if (access(name, R_OK)) {
        if (!*m->reason)
            snprintf(m->reason, sizeof m->reason, "no %s in %.120s", m->file, directory);
        return 0;
    }
    void *const object = dlopen(name, RTLD_NOW | RTLD_LOCAL);
    const char *const *const found = object ? dlsym(object, m->symbol) : NULL;
    if (!found || strcmp(*found, PACKAGE_VERSION)) {
        const char *const why = object ? "it is of another version" : dlerror();
        snprintf(m->reason, sizeof m->reason, "%.150s", why ? why : name);
        if (object)
            dlclose(object);
        return 0;
    }
    m->table = found;
    return 1;
}

/** The directory of the running program, without the last slash. Only Linux reports it. \return 0 if it is unknown. */
static int program_directory(char directory[PATH_MAX])
{
    const ssize_t n = readlink("/proc/self/exe", directory, PATH_MAX - 1);
    directory[n > 0 ? n : 0] = 0;
    char *const slash = strrchr(directory, '/');
    if (slash)
        *slash = 0;
    return slash != NULL;
}

static void open_module(adcgs_module *m)
{
    char beside[PATH_MAX];
    const char *const chosen = getenv("ADCGS_MODULES");
    if (chosen && *chosen) {
        open_in(m, chosen, "");
        return;
    }
    if (program_directory(beside) && open_in(m, beside, "/../lib/adcgs"))
        return;
    *m->reason = 0; /* the message names the installation directory */
    open_in(m, MODULES_DIRECTORY, "");
}

adcgs_status adcgs_module_get(adcgs_module *module, const void **table, const char *path, adcgs_error *error)
{
    pthread_mutex_lock(&module->lock);
    if (!module->tried)
        open_module(module);
    module->tried = 1;
    *table = module->table;
    pthread_mutex_unlock(&module->lock);
    return *table ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: %s: %s", path, module->purpose, module->reason);
}
