/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The threads that render, if the browser lets workers share memory. */
#ifndef ADCGS_WEB_WASM_THREADS_H
#define ADCGS_WEB_WASM_THREADS_H

#include <adcgs/types.h>

/** NULL if there is one thread. */
adcgs_pool *adcgs_page_pool(void);

#endif
