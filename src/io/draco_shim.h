/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Draco seen from C. No exception and no C++ type crosses this border. The shim
 * is a module, opened when the first Draco file is read or written, so that
 * programs start without it; a build without shared libraries links it.
 */
#ifndef ADCGS_IO_DRACO_SHIM_H
#define ADCGS_IO_DRACO_SHIM_H

#ifdef __cplusplus
extern "C" {
#endif

#include "io/module.h"
#include "io/points.h"

/** What the module offers. Any thread may call. */
typedef struct adcgs_draco {
    const char *version; /**< of the programs that the module belongs to */
    /** See adcgs_draco_parse(). */
    adcgs_status (*parse)(adcgs_points *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error);
    /** What adcgs_draco_write() writes, in memory; the caller free()s *data. */
    adcgs_status (*encode)(uint8_t **data, size_t *bytes, const adcgs_points *points, const char *path, adcgs_error *error);
} adcgs_draco;

/** The one thing that the module exports. */
ADCGS_MODULE_EXPORT extern const adcgs_draco adcgs_draco_table;

/** The module's table (see module.h), for the file `path`, which messages name. ADCGS_ERR_UNSUPPORTED when it is not there. */
adcgs_status adcgs_draco_get(const adcgs_draco **draco, const char *path, adcgs_error *error);

#ifdef __cplusplus
}
#endif
#endif
