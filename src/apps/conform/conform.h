/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The conformance manifest (spec clause "Conformance"): reading it, running its vectors on the library or on any program, and
 * reports.
 */
#ifndef ADCGS_APPS_CONFORM_CONFORM_H
#define ADCGS_APPS_CONFORM_CONFORM_H

#include "base/base.h"
#include "system/atomic.h"

#include <adcgs/adcgs.h>

#include <stdio.h>

/* Origin, unless a line states one: chosen by hand, not measured. Counts are the most that a vector of the manifest may have. */
#define ADCGS_VECTOR_MODELS 32  /**< models */
#define ADCGS_VECTOR_CAMERAS 8  /**< cameras */
#define ADCGS_VECTOR_TIMES 8    /**< times of digests of splats */
#define ADCGS_VECTOR_FRAMES 64  /**< rendered frames */
#define ADCGS_VECTOR_LAYERS 4   /**< decodings without layers */
#define ADCGS_HEX 33            /**< bytes of an MD5 in hexadecimal, with its zero; arithmetic */
#define ADCGS_REFUSED "refused" /**< replaces a frame's digest if its camera is refused */
#define ADCGS_WHAT 400          /**< bytes of an explanation */

/** Expected results of a decoder that leaves out layers. */
typedef struct adcgs_fewer {
    int layers, n_models, n_splats;
    char models[ADCGS_VECTOR_MODELS][ADCGS_HEX];
    struct {
        double time;
        char md5[ADCGS_HEX];
    } splats[ADCGS_VECTOR_TIMES];
} adcgs_fewer;

typedef struct adcgs_vector {
    char id[80], file[128], title[256];
    char md5[ADCGS_HEX]; /**< of the file */
    adcgs_status status; /**< ADCGS_OK for a good vector, else the status with which decoding has to end */
    int level, truncated;
    uint32_t elements; /**< lines of the trace */
    char trace[ADCGS_HEX];
    int n_models, n_cameras, n_splats, n_frames;
    char models[ADCGS_VECTOR_MODELS][ADCGS_HEX];
    adcgs_camera cameras[ADCGS_VECTOR_CAMERAS];
    struct {
        double time;
        char md5[ADCGS_HEX];
    } splats[ADCGS_VECTOR_TIMES];
    struct {
        int camera;
        double time;
        char md5[ADCGS_HEX];
    } frames[ADCGS_VECTOR_FRAMES];
    int n_fewer;
    adcgs_fewer fewer[ADCGS_VECTOR_LAYERS];
} adcgs_vector;

typedef struct adcgs_manifest {
    char *directory; /**< of the manifest; files are relative to it */
    int n;
    adcgs_vector *vectors;
} adcgs_manifest;

adcgs_status adcgs_manifest_read(adcgs_manifest *out, const char *path, adcgs_error *error);
void adcgs_manifest_clear(adcgs_manifest *manifest);

/** Reads a class of the manifest: "data", "truncated", "unsupported" or "limit". Returns 0, or -1 if it is unknown. */
int adcgs_vector_class(const char *name, adcgs_status *status);
const char *adcgs_vector_class_name(adcgs_status status);

/** Loads the file of a vector into memory; the caller frees it with free(). */
adcgs_status adcgs_vector_load(const adcgs_manifest *manifest, const adcgs_vector *vector, uint8_t **data, size_t *bytes,
                               adcgs_error *error);
void adcgs_hex_of(const void *data, size_t bytes, char hex[ADCGS_HEX]);

/** Outcome of a vector. A crash or a timeout of the decoder never counts as a refusal. */
typedef enum adcgs_outcome { ADCGS_OUTCOME_OK, ADCGS_OUTCOME_WRONG, ADCGS_OUTCOME_CRASHED, ADCGS_OUTCOME_TIMEOUT } adcgs_outcome;
const char *adcgs_outcome_name(adcgs_outcome outcome);

/** One way to run the library. */
typedef struct adcgs_trial {
    adcgs_cpu_level cpu;
    int threads;
    int step; /**< 0: the input comes in the requested sizes; else in pieces of 1 to step bytes */
} adcgs_trial;

/**
 * Decodes data and compares everything that the vector expects, at all points. Also checks that memory stays within the level's
 * bound. The text receives a description of the difference.
 */
adcgs_outcome adcgs_vector_try(const adcgs_vector *vector, const uint8_t *data, size_t bytes, const adcgs_trial *trial,
                               char what[ADCGS_WHAT]);

/** A decoder that is an external program. */
typedef struct adcgs_program {
    const char *command; /**< for the shell; {in}, {request} and {out} stand for paths */
    int point;           /**< claimed conformance point: 0 to 3 for P, M, S or R */
    int timeout;         /**< seconds */
    int layers;          /**< it claims to be able to leave out layers */
} adcgs_program;

/** Sends the program requests for everything that the vector expects, and compares the answers. */
adcgs_outcome adcgs_program_try(const adcgs_program *program, const adcgs_manifest *manifest, const adcgs_vector *vector,
                                char what[ADCGS_WHAT]);

/**
 * Damages streams, expectations and decoders, one at a time, and prints each damage that the check does not notice. Adds to the
 * counts.
 */
void adcgs_selftest_vector(const adcgs_manifest *manifest, const adcgs_vector *vector, int *runs, int *faults);
void adcgs_selftest_program(const adcgs_manifest *manifest, int *runs, int *faults);

/** Results as JUnit XML. */
typedef struct adcgs_junit {
    adcgs_atomic atomic; /**< the report */
    char *cases;         /**< test cases so far */
    size_t bytes;
    FILE *memory;
    int n, failures, errors;
    double seconds;
} adcgs_junit;

/** path NULL: nothing is written. */
adcgs_status adcgs_junit_open(adcgs_junit *junit, const char *path, adcgs_error *error);
void adcgs_junit_add(adcgs_junit *junit, const adcgs_vector *vector, adcgs_outcome outcome, double seconds, const char *what);
adcgs_status adcgs_junit_close(adcgs_junit *junit, adcgs_error *error);

#endif
