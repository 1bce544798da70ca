/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The module that holds OpenImageIO. */
#include "config.h"

#include "io/oiio_shim.h"

#ifdef MODULES

static adcgs_module module = {
    .file = "adcgs_oiio.so",
    .symbol = "adcgs_oiio_table",
    .purpose = "images need OpenImageIO",
    .lock = PTHREAD_MUTEX_INITIALIZER,
};

adcgs_status adcgs_oiio_get(const adcgs_oiio **oiio, const char *path, adcgs_error *error)
{
    const void *table;
    const adcgs_status status = adcgs_module_get(&module, &table, path, error);
    *oiio = table;
    return status;
}

#else

adcgs_status adcgs_oiio_get(const adcgs_oiio **oiio, const char *path, adcgs_error *error)
{
    *oiio = &adcgs_oiio_table;
    return ADCGS_OK;
}

#endif
