/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Claims on a file system that several machines share: a small file names the
 * process and the machine that hold a resource. Locks of the system are not
 * used. Some shared file systems have none, and locks of a machine that is gone
 * may stay.
 *
 * The owner creates the file exclusively. A thread touches it every ten seconds
 * while the process is alive. On the owner's machine, until its next boot, the
 * process id and start time show whether the process is alive; no clock is
 * used. Elsewhere a claim is suspect when it has not been touched for a minute
 * by the clock of the file system. Clocks can be set, so a suspect claim is
 * then watched for as long as an owner takes to touch it again. A process that
 * finds a claim without a live owner renames its own over it. So after kill -9
 * no file has to be removed by hand.
 */
#ifndef ADCGS_SYSTEM_CLAIM_H
#define ADCGS_SYSTEM_CLAIM_H

#include "base/base.h"

#define ADCGS_CLAIM_SECONDS 60 /**< seconds without a touch after which a claim is suspect; chosen by hand, not measured */

typedef struct adcgs_claim adcgs_claim;

/**
 * Take a claim. ADCGS_ERR_IO, naming the other machine and process, if another process holds it. what: the resource in that
 * message, "segment 2".
 */
adcgs_status adcgs_claim_take(adcgs_claim **claim, const char *path, const char *what, adcgs_error *error);
/** Make sure that no process holds a claim; fails as adcgs_claim_take() does. */
adcgs_status adcgs_claim_absent(const char *path, const char *what, adcgs_error *error);
/** Check that the claim is still ours: after a long suspension of the machine, another process may have taken it. */
adcgs_status adcgs_claim_check(const adcgs_claim *claim, adcgs_error *error);
/** Remove the file, except if another process owns it by now. *claim may be NULL. */
void adcgs_claim_drop(adcgs_claim **claim);

#endif
