/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The conformance manifest (spec clause "Conformance"), and trying one of its vectors on the library. */
#ifndef ADCGS_TOOLS_CONFORM_H
#define ADCGS_TOOLS_CONFORM_H

#include "base/base.h"

#include <adcgs/adcgs.h>

#define ADCGS_VECTOR_MODELS 32
#define ADCGS_VECTOR_CAMERAS 8
#define ADCGS_VECTOR_FRAMES 32
#define ADCGS_HEX 33

typedef struct adcgs_vector {
    char file[128], title[256];
    char md5[ADCGS_HEX];       /**< of the file */
    adcgs_status status;       /**< ADCGS_OK for a good vector, else how decoding has to end */
    int n_models, n_cameras, n_frames;
    char models[ADCGS_VECTOR_MODELS][ADCGS_HEX];
    adcgs_camera cameras[ADCGS_VECTOR_CAMERAS];
    struct {
        int camera;
        double time;
        char md5[ADCGS_HEX];
    } frames[ADCGS_VECTOR_FRAMES];
} adcgs_vector;

typedef struct adcgs_manifest {
    char *directory; /**< of the manifest; files are relative to it */
    int n;
    adcgs_vector *vectors;
} adcgs_manifest;

adcgs_status adcgs_manifest_read(adcgs_manifest *out, const char *path, adcgs_error *error);
void adcgs_manifest_clear(adcgs_manifest *manifest);

/** "data", "truncated", "unsupported", "limit": the classes of the manifest. Returns 0, or -1 if unknown. */
int adcgs_vector_class(const char *name, adcgs_status *status);

/** The file of a vector in memory; free() it. */
adcgs_status adcgs_vector_load(const adcgs_manifest *manifest, const adcgs_vector *vector, uint8_t **data, size_t *bytes,
                               adcgs_error *error);

/**
 * Decode data and compare everything the vector expects. Returns nonzero if all is as expected; else what[size] says what is not.
 */
int adcgs_vector_try(const adcgs_vector *vector, const uint8_t *data, size_t bytes, adcgs_cpu_level cpu, int threads, char *what,
                     size_t size);

#endif
