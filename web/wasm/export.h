/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The functions of a module that the page calls. Each worker, and the page itself, has its own instance. */
#ifndef ADCGS_WEB_EXPORT_H
#define ADCGS_WEB_EXPORT_H

/** Exports a function to the page under this name. */
#define PAGE_EXPORT(name) __attribute__((export_name(#name), visibility("default"))) name

#endif
