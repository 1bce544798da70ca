/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The conformance protocol on a decoder's side (spec clause "Conformance", "Requests and answers"): reads a file of requests,
 * decodes a stream, and prints one line per answer to standard output.
 */
#ifndef ADCGS_APPS_SHARED_ANSWER_H
#define ADCGS_APPS_SHARED_ANSWER_H

#include "base/base.h"

#include <adcgs/types.h>

typedef enum adcgs_request_kind {
    ADCGS_REQUEST_TRACE,
    ADCGS_REQUEST_MODEL,
    ADCGS_REQUEST_SPLATS,
    ADCGS_REQUEST_FRAME
} adcgs_request_kind;

typedef struct adcgs_request {
    adcgs_request_kind kind;
    int camera;    /**< of FRAME */
    double time;   /**< seconds; of SPLATS and FRAME */
    char text[64]; /**< the time as written in the file; the answer repeats it */
} adcgs_request;

typedef struct adcgs_requests {
    int n, n_cameras;
    adcgs_request *request;
    adcgs_camera *camera;
    int complete; /**< a stream that ends early is refused */
    int layers;   /**< most layers to use; 0: all */
} adcgs_requests;

/** ADCGS_ERR_USAGE for a mistake in the file. */
adcgs_status adcgs_requests_read(adcgs_requests *out, const char *path, adcgs_error *error);
void adcgs_requests_clear(adcgs_requests *requests);
/** Prints the answers. decoder has decoded the file at path, which is read again for a trace. */
adcgs_status adcgs_requests_answer(const adcgs_requests *requests, const char *path, adcgs_decoder *decoder, adcgs_error *error);
/** Returns the protocol's class of a decoding status, NULL if the status is not about the stream. */
const char *adcgs_fault_class(adcgs_status status);

#endif
