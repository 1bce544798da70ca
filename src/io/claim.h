/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Whose turn it is, on a file system that several machines share: a small file
 * that says which process of which machine is at something, for the time that
 * it is. Locks of the system are not asked for; not every such file system has
 * them, and those of a machine that is gone may stay.
 *
 * The file is made as one that must not be there yet, and a thread touches it every ten seconds while its process lives. On the
 * owner's machine, until that is started again, the system knows whether the process lives, by its number and when it began;
 * no clock has a say. Elsewhere a claim counts no more when it has not been touched for a minute by the clock of the file system.
 * Clocks are set, so it is watched then for as long as an owner takes to touch it again. The process that finds a claim that does
 * not count renames its own over it. So after kill -9 nothing has to be removed by hand.
 */
#ifndef ADCGS_IO_CLAIM_H
#define ADCGS_IO_CLAIM_H

#include "base/base.h"

#define ADCGS_CLAIM_SECONDS 60 /**< untouched for so long, it is nobody's */

typedef struct adcgs_claim adcgs_claim;

/** ADCGS_ERR_IO, naming the other's machine and process, while it is another's. what: for that message, "segment 2". */
adcgs_status adcgs_claim_take(adcgs_claim **claim, const char *path, const char *what, adcgs_error *error);
/** Make sure that it is nobody's; fails as adcgs_claim_take() does. */
adcgs_status adcgs_claim_absent(const char *path, const char *what, adcgs_error *error);
/** Whether it is still ours: one that slept too long, with its machine, finds another's. */
adcgs_status adcgs_claim_check(const adcgs_claim *claim, adcgs_error *error);
/** Remove the file, unless it is another's by now. Accepts what points to NULL. */
void adcgs_claim_drop(adcgs_claim **claim);

#endif
