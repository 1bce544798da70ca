/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Bytes in the letters of base 64 (RFC 4648). */
#ifndef ADCGS_SYSTEM_BASE64_H
#define ADCGS_SYSTEM_BASE64_H

#include "base/base.h"

#include <stdio.h>

/** Writes base 64 with its padding, in lines of 76 letters (RFC 2045) if lines is not 0. */
void adcgs_base64_write(FILE *file, const uint8_t *data, size_t bytes, int lines);
/** The six bits of a letter; -1 if c is none. */
int adcgs_base64_value(int c);

#endif
