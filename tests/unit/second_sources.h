/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Second sources of test programs. Each function runs the tests of its source and returns the number of failed ones. */
#ifndef ADCGS_TESTS_SECOND_SOURCES_H
#define ADCGS_TESTS_SECOND_SOURCES_H

int adcgs_test_cli_json(void);
int adcgs_test_filmed_views(void);
int adcgs_test_glb_faults(void);
int adcgs_test_hypernerf_real(void);
int adcgs_test_lens_images(void);
int adcgs_test_net_weights(void);
int adcgs_test_nets_widths(void);
int adcgs_test_play_controls(void);
int adcgs_test_play_window(void);
int adcgs_test_points_draco(void);
int adcgs_test_rigs_real(void);
int adcgs_test_scene_faults(void);

#endif
