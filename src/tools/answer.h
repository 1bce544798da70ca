/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The conformance protocol on a decoder's side (spec clause "Conformance", "Requests and answers"): a file of requests is read,
 * a stream is decoded, and one line per answer goes to standard output.
 */
#ifndef ADCGS_TOOLS_ANSWER_H
#define ADCGS_TOOLS_ANSWER_H

#include "base/base.h"

#include <adcgs/decoder.h>

typedef enum adcgs_request_kind {
    ADCGS_REQUEST_TRACE,
    ADCGS_REQUEST_MODEL,
    ADCGS_REQUEST_SPLATS,
    ADCGS_REQUEST_FRAME
} adcgs_request_kind;

typedef struct adcgs_request {
    adcgs_request_kind kind;
    int camera;      /**< of FRAME */
    double time;     /**< seconds; of SPLATS and FRAME */
    char text[64];   /**< the time as the file has it, which the answer repeats */
} adcgs_request;

typedef struct adcgs_requests {
    int n, n_cameras;
    adcgs_request *request;
    adcgs_camera *camera;
    int complete; /**< a stream that ends early is refused */
    int layers;   /**< use at most so many; 0: all */
} adcgs_requests;

/** A mistake in the file is ADCGS_ERR_USAGE. */
adcgs_status adcgs_requests_read(adcgs_requests *out, const char *path, adcgs_error *error);
void adcgs_requests_clear(adcgs_requests *requests);
/** Print the answers. decoder has decoded the file at path, which is read once more for a trace. */
adcgs_status adcgs_requests_answer(const adcgs_requests *requests, const char *path, adcgs_decoder *decoder,
                                   adcgs_error *error);
/** The class under which the protocol reports a status of decoding, NULL if the status is not about the stream. */
const char *adcgs_fault_class(adcgs_status status);

#endif
