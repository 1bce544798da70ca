/* SPDX-License-Identifier: BSD-2-Clause */
/** \file What a file's name ends in. */
#ifndef ADCGS_IO_EXTENSION_H
#define ADCGS_IO_EXTENSION_H

#include "base/base.h"

/** What follows the last dot of a path's last part; "" without one. */
static inline const char *adcgs_extension(const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *dot = strrchr(slash ? slash : path, '.');
    return dot ? dot + 1 : "";
}

#endif
