/* SPDX-License-Identifier: BSD-2-Clause */
/** \file From models to chunks, without the checks of the codec's writer, so that invalid streams can be written. */
#include "edit.h"

#include "base/digest.h"
#include "model/model_priv.h"
#include "stream/parts.h"

/** Networks in the stream so far, by id. */
typedef struct id_table {
    adcgs_chunk_list *list;
    uint32_t n, extra; /**< networks that segments name; further ones with the next ids */
    const adcgs_net *net[ADCGS_PLAN_SEGMENTS * ADCGS_ROLES];
} id_table;

static adcgs_status add(adcgs_chunk_list *list, const char *type, uint32_t segment, int flags, adcgs_buffer **payload,
                        adcgs_error *error)
{
    ADCGS_TRY(adcgs_chunk_list_insert(list, list->n, type, error));
    adcgs_raw_chunk *const c = &list->chunk[list->n - 1];
    c->segment = (uint16_t)segment;
    c->flags = (uint8_t)flags;
    *payload = &c->payload;
    return ADCGS_OK;
}

static adcgs_status add_copy(adcgs_chunk_list *list, const char *type, uint32_t segment, int flags, const adcgs_buffer *bytes,
                             adcgs_error *error)
{
    adcgs_buffer *payload;
    ADCGS_TRY(add(list, type, segment, flags, &payload, error));
    adcgs_write_bytes(payload, bytes->data, bytes->size);
    return ADCGS_OK;
}

/* In a predicted segment only networks that the model before lacks get ids. Returns the number of ids in use before. */
static uint32_t assign_ids(id_table *table, const adcgs_model *m, adcgs_role_ids *ids)
{
    const uint32_t before = table->n;
    for (int role = 0; role < ADCGS_ROLES; role++) {
        const adcgs_net *const net = &m->net[role];
        uint32_t id = 0;
        if (!net->present || (m->predicted && adcgs_net_equal(&(m - 1)->net[role], net)))
            continue;
        while (id < table->n && !adcgs_net_equal(table->net[id], net))
            id++;
        if (id == table->n)
            table->net[table->n++] = net;
        ids->mask |= (uint16_t)(1 << role);
        ids->id[role] = (uint16_t)id;
    }
    return before;
}

static adcgs_status add_layers(adcgs_plan *plan, uint32_t segment, int tier, adcgs_chunk_list *out, adcgs_error *error)
{
    const adcgs_drawn_tier *const d = &plan->drawn[segment].tier[tier];
    for (int layer = 0; d->n_slices > 0 && layer < adcgs_params_layers(&plan->stream.params); layer++) {
        const char type[5] = {'F', 'E', 'A', (char)('0' + layer), 0};
        const adcgs_buffer *const slice = d->data + (size_t)layer * d->n_slices;
        adcgs_buffer *payload;
        ADCGS_TRY(add(out, type, segment, ADCGS_CHUNK_OF_TIER(tier), &payload, error));
        adcgs_write_varint(payload, 0);
        adcgs_write_varint(payload, d->n_slices);
        for (uint32_t i = 0; i < d->n_slices; i++) {
            adcgs_write_varint(payload, (uint32_t)slice[i].size);
            adcgs_write_uint(payload, adcgs_crc32c(0, slice[i].data, slice[i].size), 4);
        }
        for (uint32_t i = 0; i < d->n_slices; i++)
            adcgs_write_bytes(payload, slice[i].data, slice[i].size);
    }
    return ADCGS_OK;
}

static adcgs_status add_extra(id_table *table, const adcgs_net *const *nets, uint32_t n, adcgs_error *error)
{
    adcgs_buffer *payload;
    ADCGS_TRY(add(table->list, "NETW", 0, 0, &payload, error));
    ADCGS_TRY(adcgs_netw_write(payload, nets, n, table->n + table->extra, error));
    table->extra += n;
    return ADCGS_OK;
}

/* The network of a role; the stream must have exactly one segment. */
static adcgs_status find_net(const adcgs_plan *plan, const char *name, const adcgs_net **net, adcgs_error *error)
{
    int role = 0;
    while (role < ADCGS_ROLES && strcmp(name, adcgs_role_name(role)))
        role++;
    *net = &plan->stream.segments[0].net[role % ADCGS_ROLES];
    if (role < ADCGS_ROLES && (*net)->present && plan->segments == 1)
        return ADCGS_OK;
    return adcgs_fail(error, ADCGS_ERR_USAGE, "\"%s\": no such network, or more than one segment", name);
}

/* unnamed ROLE N: copies of the network; no segment names them. */
static adcgs_status add_unnamed(adcgs_plan *plan, const adcgs_command *c, void *user, adcgs_error *error)
{
    const adcgs_net *copies[ADCGS_ROLES];
    int64_t left;
    ADCGS_TRY(adcgs_command_words(c, 2, 2, error));
    ADCGS_TRY(adcgs_word_int(c->word[2], 1, 65535, &left, error));
    for (int i = 0; i < ADCGS_ROLES; i++)
        ADCGS_TRY(find_net(plan, c->word[1], &copies[i], error));
    for (; left > 0; left -= ADCGS_ROLES)
        ADCGS_TRY(add_extra(user, copies, (uint32_t)ADCGS_MIN(left, ADCGS_ROLES), error));
    return ADCGS_OK;
}

/* poke ROLE LAYER w|b INDEX VALUE: a copy of the network with one number changed; no segment names the copy. */
static adcgs_status add_poked(adcgs_plan *plan, const adcgs_command *c, void *user, adcgs_error *error)
{
    const adcgs_net *net;
    adcgs_net copy;
    ADCGS_TRY(adcgs_command_words(c, 5, 5, error));
    ADCGS_TRY(find_net(plan, c->word[1], &net, error));
    adcgs_status status = adcgs_net_copy(&copy, net, NULL, error);
    net = &copy;
    if (status == ADCGS_OK)
        status = adcgs_plan_set_weight(plan, c, &copy, error);
    if (status == ADCGS_OK)
        status = add_extra(user, &net, 1, error);
    adcgs_net_release(&copy, NULL);
    return status;
}

static adcgs_status add_segment(adcgs_plan *plan, uint32_t segment, id_table *table, adcgs_chunk_list *out, adcgs_error *error)
{
    const adcgs_model *const m = &plan->stream.segments[segment];
    adcgs_role_ids ids = {0};
    adcgs_buffer *payload;
    uint8_t digest[16];
    const uint32_t first = assign_ids(table, m, &ids), added = table->n - first;
    int used = 0;
    for (int role = 0; role < ADCGS_ROLES; role++)
        used += ids.mask >> role & 1;
    ADCGS_TRY(add(out, "SEGM", segment, !m->predicted && (int)added == used ? ADCGS_CHUNK_KEY : 0, &payload, error));
    ADCGS_TRY(adcgs_segm_write(payload, &plan->stream, m, &ids, error));
    if (added > 0) {
        ADCGS_TRY(add(out, "NETW", segment, 0, &payload, error));
        ADCGS_TRY(adcgs_netw_write(payload, table->net + first, added, first, error));
    }
    ADCGS_TRY(adcgs_plan_each(plan, "unnamed", add_unnamed, table, error));
    ADCGS_TRY(adcgs_plan_each(plan, "poke", add_poked, table, error));
    if (m->predicted)
        ADCGS_TRY(add_copy(out, "KEEP", segment, 0, &plan->drawn[segment].keep, error));
    for (int tier = 0; tier <= (m->predicted ? 0 : m->finest); tier++) {
        const adcgs_buffer *const geom = &plan->drawn[segment].tier[tier].geom;
        ADCGS_TRY(add_copy(out, "GEOM", segment, ADCGS_CHUNK_OF_TIER(tier), geom, error));
        ADCGS_TRY(add_layers(plan, segment, tier, out, error));
    }
    if (plan->no_digest)
        return ADCGS_OK;
    ADCGS_TRY(add(out, "hash", segment, ADCGS_CHUNK_LAST, &payload, error));
    adcgs_model_digest(m, digest);
    adcgs_write_bytes(payload, digest, sizeof digest);
    return ADCGS_OK;
}

adcgs_status adcgs_plan_compose(adcgs_plan *plan, adcgs_chunk_list *out, adcgs_error *error)
{
    id_table table = {.list = out};
    adcgs_buffer *payload;
    uint32_t most = 0;
    for (uint32_t i = 0; i < plan->segments; i++)
        most = ADCGS_MAX(most, plan->stream.segments[i].n);
    ADCGS_TRY(add(out, "HEAD", 0, 0, &payload, error));
    ADCGS_TRY(adcgs_head_write(payload, &plan->stream, most, error));
    if (plan->stream.n_cameras > 0) {
        ADCGS_TRY(add(out, "cams", 0, 0, &payload, error));
        ADCGS_TRY(adcgs_cams_write(payload, &plan->stream, error));
    }
    if (plan->stream.n_meta > 0) {
        ADCGS_TRY(add(out, "meta", 0, 0, &payload, error));
        ADCGS_TRY(adcgs_meta_write(payload, &plan->stream, error));
    }
    for (uint32_t i = 0; i < plan->segments; i++)
        ADCGS_TRY(add_segment(plan, i, &table, out, error));
    if (plan->segments > 1)
        ADCGS_TRY(add(out, "INDX", 0, 0, &payload, error));
    return add(out, "ENDC", 0, 0, &payload, error);
}

/* An unknown verb is a misspelling. Commands about the recipe (title, covers, violates, expect) are used later. */
static adcgs_status check_used(const adcgs_recipe *r, adcgs_error *error)
{
    for (int i = 0; i < r->n; i++)
        if (!r->command[i].used && !adcgs_recipe_is_about(&r->command[i])) {
            adcgs_fail(error, ADCGS_ERR_USAGE, "\"%s\": unknown command, or not allowed here", r->command[i].word[0]);
            return adcgs_command_locate(r, &r->command[i], ADCGS_ERR_USAGE, error);
        }
    return ADCGS_OK;
}

adcgs_status adcgs_plan_build(adcgs_plan *plan, adcgs_recipe *recipe, adcgs_buffer *file, adcgs_error *error)
{
    adcgs_chunk_list list = {.n = 0};
    adcgs_status status = adcgs_plan_init(plan, recipe, error);
    if (status == ADCGS_OK)
        status = adcgs_plan_draw(plan, error);
    if (status == ADCGS_OK)
        status = adcgs_plan_compose(plan, &list, error);
    if (status == ADCGS_OK)
        status = adcgs_edit_apply(plan, &list, file, error);
    adcgs_chunk_list_clear(&list);
    return status == ADCGS_OK ? check_used(recipe, error) : status;
}
