/* SPDX-License-Identifier: BSD-2-Clause */
/** \file What the page calls of a module. Each worker and the page itself has an instance of its own. */
#ifndef ADCGS_WEB_EXPORT_H
#define ADCGS_WEB_EXPORT_H

/** In front of a function that the page calls by this name. */
#define PAGE_EXPORT(name) __attribute__((export_name(#name), visibility("default"))) name

#endif
