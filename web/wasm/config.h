/* SPDX-License-Identifier: BSD-2-Clause */
/** \file In place of what configure found: that is about the machine it runs on, and nothing of it holds for WebAssembly. */
