/* SPDX-License-Identifier: BSD-2-Clause */
/** \file E24 kernels in portable C. */
#define E24_NAME(x) x##_scalar
#include "net/e24_kernels.h"
