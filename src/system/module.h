/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Modules: parts of the programs that are opened when first needed, because
 * their libraries take many times a decoder's run time to load. A module is a
 * shared object that exports one table of functions. The table's first member
 * is the version of the programs that it belongs to. A build without shared
 * libraries links the modules' code.
 */
#ifndef ADCGS_SYSTEM_MODULE_H
#define ADCGS_SYSTEM_MODULE_H

#include "base/base.h"

#include <pthread.h>

#if defined __GNUC__
#define ADCGS_MODULE_EXPORT __attribute__((visibility("default")))
#else
#define ADCGS_MODULE_EXPORT
#endif

typedef struct adcgs_module {
    const char *file;     /**< "adcgs_oiio.so" */
    const char *symbol;   /**< of its table, which starts with a const char *version */
    const char *purpose;  /**< for messages: "images need OpenImageIO" */
    pthread_mutex_t lock; /**< initially PTHREAD_MUTEX_INITIALIZER; the members below are initially zero */
    int tried;
    const void *table;
    char reason[160]; /**< why there is no table */
} adcgs_module;

/**
 * The module's table, opened at the first call. path: the file that messages name. Searched in the directory that ADCGS_MODULES
 * names, and only there if it is set; then in ../lib/adcgs relative to the running program; then in the installation directory.
 * Programs in the build tree are run with ADCGS_MODULES. ADCGS_ERR_UNSUPPORTED if no directory has the module.
 */
adcgs_status adcgs_module_get(adcgs_module *module, const void **table, const char *path, adcgs_error *error);

/**
 * Defines adcgs_status get(const type **out, const char *path, adcgs_error *error). It finds a table as adcgs_module_get() does,
 * or returns the linked table if config.h disables modules.
 */
#ifdef MODULES
#define ADCGS_MODULE_GET(get, type, table, so, what)                                                                     \
    adcgs_status get(const type **out, const char *path, adcgs_error *error)                                             \
    {                                                                                                                    \
        static adcgs_module module = {.file = so, .symbol = #table, .purpose = what, .lock = PTHREAD_MUTEX_INITIALIZER}; \
        const void *found;                                                                                               \
        const adcgs_status status = adcgs_module_get(&module, &found, path, error);                                      \
        *out = found;                                                                                                    \
        return status;                                                                                                   \
    }
#else
#define ADCGS_MODULE_GET(get, type, table, so, what)                         \
    adcgs_status get(const type **out, const char *path, adcgs_error *error) \
    {                                                                        \
        *out = &table;                                                       \
        return ADCGS_OK;                                                     \
    }
#endif

#endif
