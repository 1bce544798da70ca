/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Parts of the programs that are opened when first needed, because the
 * libraries below them take a decoder's time many times over to load. A module
 * is a shared object that exports one table of functions, whose first member
 * is the version of the programs it belongs to. A build without shared
 * libraries links what would be modules.
 */
#ifndef ADCGS_IO_MODULE_H
#define ADCGS_IO_MODULE_H

#include "base/base.h"

#include <pthread.h>

#if defined __GNUC__
#define ADCGS_MODULE_EXPORT __attribute__((visibility("default")))
#else
#define ADCGS_MODULE_EXPORT
#endif

typedef struct adcgs_module {
    const char *file;     /**< "adcgs_oiio.so" */
    const char *symbol;   /**< of its table: starts with a const char *version */
    const char *purpose;  /**< for messages: "images need OpenImageIO" */
    pthread_mutex_t lock; /**< begins as PTHREAD_MUTEX_INITIALIZER; the rest begins as zero */
    int tried;
    const void *table;
    char reason[160];     /**< why there is no table */
} adcgs_module;

/**
 * The module's table, opened at the first call, for `path`, which messages name. Where it is looked for:
 * the directory that ADCGS_MODULES names, and nowhere else if that is set; then in ../lib/adcgs as seen from the running
 * program; then where it was to be installed. Programs of the build tree take ADCGS_MODULES. ADCGS_ERR_UNSUPPORTED when it is
 * in none of them.
 */
adcgs_status adcgs_module_get(adcgs_module *module, const void **table, const char *path, adcgs_error *error);

/**
 * Defines adcgs_status get(const type **out, const char *path, adcgs_error *error), which finds a table as adcgs_module_get()
 * does, or takes the one that is linked in where config.h says that there are no modules.
 */
#ifdef MODULES
#define ADCGS_MODULE_GET(get, type, table, so, what)                                                                    \
    adcgs_status get(const type **out, const char *path, adcgs_error *error)                                            \
    {                                                                                                                   \
        static adcgs_module module = {.file = so, .symbol = #table, .purpose = what, .lock = PTHREAD_MUTEX_INITIALIZER}; \
        const void *found;                                                                                              \
        const adcgs_status status = adcgs_module_get(&module, &found, path, error);                                     \
        *out = found;                                                                                                   \
        return status;                                                                                                  \
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
