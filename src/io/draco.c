/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The module that holds Draco. */
#include "config.h"

#include "io/draco_shim.h"

#if defined MODULES

static adcgs_module module = {
    .file = "adcgs_draco.so",
    .symbol = "adcgs_draco_table",
    .purpose = "its points need Draco",
    .lock = PTHREAD_MUTEX_INITIALIZER,
};

adcgs_status adcgs_draco_get(const adcgs_draco **draco, const char *path, adcgs_error *error)
{
    const void *table;
    const adcgs_status status = adcgs_module_get(&module, &table, path, error);
    *draco = table;
    return status;
}

#elif defined HAVE_ENCODER

adcgs_status adcgs_draco_get(const adcgs_draco **draco, const char *path, adcgs_error *error)
{
    *draco = &adcgs_draco_table;
    return ADCGS_OK;
}

#else

adcgs_status adcgs_draco_get(const adcgs_draco **draco, const char *path, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: this build has no Draco", path);
}

#endif
