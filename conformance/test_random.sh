#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# Random valid streams give the same results at every CPU level, with any number of threads and however the input comes
# (REQ-CONF-004), and come back from the writer as the same models.
exec conformance/random_stream check 1 50
