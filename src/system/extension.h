/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Extension of a file name. */
#ifndef ADCGS_SYSTEM_EXTENSION_H
#define ADCGS_SYSTEM_EXTENSION_H

#include "base/base.h"

/** The text after the last dot of a path's last part; "" without a dot. */
static inline const char *adcgs_extension(const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *dot = strrchr(slash ? slash : path, '.');
    return dot ? dot + 1 : "";
}

#endif
