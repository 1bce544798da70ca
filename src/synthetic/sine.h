/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Sine and cosine that are the same on every machine, unlike those of C libraries. */
#ifndef ADCGS_SYNTHETIC_SINE_H
#define ADCGS_SYNTHETIC_SINE_H

/** Sine and cosine of an angle in turns, from basic arithmetic only; error below 1e-11. */
double adcgs_trace_sin(double turns);
double adcgs_trace_cos(double turns);

#endif
