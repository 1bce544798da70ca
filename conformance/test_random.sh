#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# Random valid streams give the same results at every CPU level, with any number of threads and with any division of the input
# (REQ-CONF-004). Written and read again, they have the same models.
exec conformance/random_stream check 1 50
