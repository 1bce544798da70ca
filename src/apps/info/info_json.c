/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-info --json. */
#include "config.h"

#include "apps/info/info_report.h"

#include "model/model_priv.h"
#include "system/json.h"

#include <math.h>

static void json_header(adcgs_json *j, const adcgs_info_report *r)
{
    const adcgs_info *i = &r->info;
    adcgs_json_int(j, "version_major", i->version_major);
    adcgs_json_int(j, "version_minor", i->version_minor);
    adcgs_json_int(j, "profile", i->profile);
    adcgs_json_int(j, "level", i->level);
    adcgs_json_bool(j, "truncated", i->truncated);
    adcgs_json_real(j, "time_start", i->time_start);
    adcgs_json_real(j, "time_end", i->time_end);
    adcgs_json_real(j, "frame_rate", i->frame_rate);
    adcgs_json_int(j, "anchors", i->anchors);
    adcgs_json_int(j, "static_anchors", i->static_anchors);
    adcgs_json_int(j, "spans", r->stream.params.spans);
    adcgs_json_int(j, "smooth_time", r->stream.params.smooth_time);
    adcgs_json_int(j, "bodies", r->stream.params.bodies);
    adcgs_json_int(j, "time_rows", r->stream.params.time_rows);
    adcgs_json_int(j, "gaussians", i->gaussians);
    adcgs_json_int(j, "weights", i->weights);
    adcgs_json_int(j, "k", i->k);
    adcgs_json_int(j, "layers", i->layers);
    adcgs_json_int(j, "tiers", i->tiers);
    adcgs_json_int(j, "tiers_present", i->tiers_present);
    adcgs_json_real(j, "scene_scale", i->scene_scale);
    adcgs_json_open(j, "scene_origin", '[');
    for (int a = 0; a < 3; a++)
        adcgs_json_real(j, NULL, i->scene_origin[a]);
    adcgs_json_close(j);
    adcgs_json_string(j, "colour", i->colour);
    adcgs_json_string(j, "axes", i->axes);
    adcgs_json_string(j, "units", i->units);
}

static void json_bytes(adcgs_json *j, const adcgs_info_report *r)
{
    adcgs_info_component list[ADCGS_INFO_COMPONENTS];
    adcgs_info_list_components(&r->info.bytes, list);
    adcgs_json_open(j, "bytes", '{');
    for (int i = 0; i < ADCGS_INFO_COMPONENTS; i++)
        adcgs_json_int(j, list[i].name, (int64_t)list[i].bytes);
    adcgs_json_int(j, "total", (int64_t)r->info.bytes.total);
    adcgs_json_close(j);
}

static adcgs_status json_segments(adcgs_json *j, const adcgs_info_report *r, adcgs_error *error)
{
    char text[33];
    size_t at = 0;
    adcgs_json_open(j, "segments", '[');
    for (uint32_t i = 0; i < r->stream.n_segments; i++) {
        const adcgs_model *m = &r->stream.segments[i];
        adcgs_info_digest(r, i, text);
        adcgs_json_open(j, NULL, '{');
        adcgs_json_real(j, "time_start", m->time_start);
        adcgs_json_real(j, "time_end", m->time_end);
        adcgs_json_real(j, "crossfade", m->reach);
        adcgs_json_int(j, "anchors", m->n);
        adcgs_json_int(j, "gaussians", adcgs_info_count_gaussians(m));
        adcgs_json_int(j, "bytes", (int64_t)adcgs_info_segment_bytes(r, i, &at));
        adcgs_json_int(j, "depth", m->depth);
        adcgs_json_int(j, "layers", m->layers);
        adcgs_json_string(j, "digest", text);
        uint32_t same, refined;
        ADCGS_TRY(adcgs_info_kept(r, i, &same, &refined, error));
        adcgs_json_bool(j, "predicted", m->predicted);
        adcgs_json_int(j, "kept", same);
        adcgs_json_int(j, "refined", refined);
        adcgs_json_open(j, "networks", '{');
        for (int role = 0; role < ADCGS_ROLES; role++)
            if (m->net[role].present)
                adcgs_json_int(j, adcgs_role_name(role), adcgs_net_weights(&m->net[role]));
        adcgs_json_close(j);
        adcgs_json_close(j);
    }
    adcgs_json_close(j);
    return ADCGS_OK;
}

static void json_extras(adcgs_json *j, const adcgs_info_report *r)
{
    adcgs_json_open(j, "cameras", '[');
    for (uint32_t i = 0; i < r->stream.n_cameras; i++) {
        const adcgs_camera *c = &r->stream.cameras[i].camera;
        adcgs_json_open(j, NULL, '{');
        adcgs_json_string(j, "name", c->name);
        adcgs_json_int(j, "width", c->width);
        adcgs_json_int(j, "height", c->height);
        if (!isnan(r->stream.cameras[i].time))
            adcgs_json_real(j, "time", r->stream.cameras[i].time);
        if (r->stream.cameras[i].path >= 0)
            adcgs_json_int(j, "path", r->stream.cameras[i].path);
        adcgs_json_close(j);
    }
    adcgs_json_close(j);
    adcgs_json_open(j, "metadata", '['); /* keys may repeat */
    for (uint32_t i = 0; i < r->stream.n_meta; i++) {
        adcgs_json_open(j, NULL, '{');
        adcgs_json_string(j, "key", r->stream.meta[i].key);
        adcgs_json_string(j, "value", r->stream.meta[i].value);
        adcgs_json_close(j);
    }
    adcgs_json_close(j);
}

adcgs_status adcgs_info_print_json(const adcgs_info_report *r, adcgs_error *error)
{
    adcgs_json j;
    adcgs_json_init(&j);
    adcgs_json_open(&j, NULL, '{');
    json_header(&j, r);
    json_bytes(&j, r);
    const adcgs_status status = json_segments(&j, r, error);
    if (status != ADCGS_OK) {
        adcgs_json_clear(&j);
        return status;
    }
    json_extras(&j, r);
    adcgs_json_open(&j, "chunks", '[');
    for (size_t i = 0; i < r->n_chunks; i++) {
        adcgs_json_open(&j, NULL, '{');
        adcgs_json_string(&j, "type", r->chunks[i].type);
        adcgs_json_int(&j, "segment", r->chunks[i].segment);
        adcgs_json_int(&j, "offset", (int64_t)r->chunks[i].offset);
        adcgs_json_int(&j, "bytes", r->chunks[i].bytes);
        adcgs_json_close(&j);
    }
    adcgs_json_close(&j);
    adcgs_json_close(&j);
    return adcgs_json_write(&j, stdout, "standard output", error);
}
