/* SPDX-License-Identifier: BSD-2-Clause */
/** \file In place of configure's results, which describe the machine that runs configure and do not apply to WebAssembly. */
