/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Declarations about models and networks that the files of this folder share. */
#ifndef ADCGS_MODEL_MODEL_PRIV_H
#define ADCGS_MODEL_MODEL_PRIV_H

#include "model/model.h"

/** Number of layers of streams with these parameters: 1, or 1 + chunks. */
int adcgs_params_layers(const adcgs_params *params);
/** Coded values of an anchor; bytes of the per-anchor arrays, per anchor (spec "Levels"). */
uint64_t adcgs_anchor_values(const adcgs_params *params);
uint64_t adcgs_anchor_bytes(const adcgs_params *params);
/** Ranges and cross-field rules of the parameters. */
adcgs_status adcgs_params_validate(const adcgs_params *params, adcgs_error *error);
int adcgs_params_equal(const adcgs_params *a, const adcgs_params *b);

/** Shapes against the parameters, value ranges, E24 bounds. */
adcgs_status adcgs_net_validate(const adcgs_params *params, int role, const adcgs_net *net, adcgs_error *error);
/** Roles that a model must have. Of the others, only COARSE and FINE are allowed, and only with a time table. */
int adcgs_role_required(const adcgs_params *params, int role);
int adcgs_role_allowed(const adcgs_params *params, int role);
/** Name of a role for messages and reports, e.g. "E_fv". */
const char *adcgs_role_name(int role);

/** Copy of a model without its anchors' arrays and its networks. */
adcgs_model adcgs_model_frame(const adcgs_model *model);
/** The Morton code of an anchor's position; anchors are sorted by it. */
uint64_t adcgs_anchor_place(const adcgs_model *model, uint32_t anchor);
/** Copy anchor j of one model to be anchor i of another with the same parameters. */
void adcgs_anchor_copy(adcgs_model *to, uint32_t i, const adcgs_model *from, uint32_t j);

/** Deep copy; on failure, adcgs_net_release() frees the contents of dst. */
adcgs_status adcgs_net_copy(adcgs_net *dst, const adcgs_net *src, adcgs_memory *memory, adcgs_error *error);
/** Copy all networks of a model to a model that has none. */
adcgs_status adcgs_nets_copy(adcgs_model *dst, const adcgs_model *src, adcgs_memory *memory, adcgs_error *error);
/** Free the tensors with the memory that they were allocated from, and zero the struct. */
void adcgs_net_release(adcgs_net *net, adcgs_memory *memory);
/** Whether all data of the two networks that the stream carries are equal. */
int adcgs_net_equal(const adcgs_net *a, const adcgs_net *b);

#endif
