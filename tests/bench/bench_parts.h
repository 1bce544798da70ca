/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The parts of the benchmark. Each prints its groups. */
#ifndef ADCGS_BENCH_BENCH_PARTS_H
#define ADCGS_BENCH_BENCH_PARTS_H

#include "measure.h"

/** Frames of the given image size and number of splats: complete, compared with the baseline, and stage by stage. */
void bench_frames(const bench *b, int width, int height, uint32_t splats);
/** The same kernel at each CPU level, and compiled without the rules that make it exact. */
void bench_levels(const bench *b);
/** Networks, entropy coding and the trainer's other kernels. */
void bench_kernels(const bench *b);
/** Networks of an anchor model forward and backward, in binary32 and in bf16. */
void bench_networks(const bench *b);
/** Complete iterations of training; then decoding and playing of the trained model. scenes: folder for the scene. */
void bench_training(const bench *b, const char *scenes, int width, int height, uint32_t anchors, const char *preset);

#endif
