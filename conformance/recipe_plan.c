/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Settings of a recipe: numbers, words and lists of them; defaults. */
#include "recipe_plan.h"

#include "stream/syntax.h"
#include "random_model.h"

/* Settings of one or several numbers, with their place in the plan and their type. */
static const struct {
    const char *verb;
    int type, count;
    size_t offset;
} numbers[] = {
    {"seed", ADCGS_U64, 1, offsetof(adcgs_plan, seed)},
    {"segments", ADCGS_U32, 1, offsetof(adcgs_plan, segments)},
    {"depth", ADCGS_U8, 1, offsetof(adcgs_plan, depth)},
    {"origin", ADCGS_F64, 3, offsetof(adcgs_plan, origin)},
    {"voxel", ADCGS_F64, 1, offsetof(adcgs_plan, voxel)},
    {"level", ADCGS_U8, 1, offsetof(adcgs_plan, stream.level)},
    {"slice_log2", ADCGS_U8, 1, offsetof(adcgs_plan, stream.slice_log2)},
    {"timebase", ADCGS_U32, 2, offsetof(adcgs_plan, stream.timebase_num)},
    {"rate", ADCGS_U32, 2, offsetof(adcgs_plan, stream.rate_num)},
    {"scene_origin", ADCGS_F64, 3, offsetof(adcgs_plan, stream.scene_origin)},
    {"scene_scale", ADCGS_F64, 1, offsetof(adcgs_plan, stream.scene_scale)},
    {"background", ADCGS_F32, 3, offsetof(adcgs_plan, stream.background)},
    {"screen_filter", ADCGS_F32, 1, offsetof(adcgs_plan, stream.screen_filter)},
    {"colour_space", ADCGS_U8, 1, offsetof(adcgs_plan, stream.colour_space)},
    {"axes", ADCGS_U8, 1, offsetof(adcgs_plan, stream.axes)},
    {"units", ADCGS_U8, 1, offsetof(adcgs_plan, stream.units)},
};

static const char *const picks[] = {"random", "all", "none", "first", "turns", NULL};
static const char *const spreads[] = {"random", "dense", "plane", "line", "mixed", "ends", NULL};
static const char *const fills[] = {"paint", "random", "zero", "edges", "escapes", "clips", NULL};

static const char *const holds[] = {"random", "all", "refined", "none", "first", "turns", NULL};

static const char *const digests[] = {"all", "none", NULL};

static const struct {
    const char *verb;
    const char *const *names;
    size_t offset;
} choices[] = {
    {"masks", picks, offsetof(adcgs_plan, masks)},        {"static", picks, offsetof(adcgs_plan, statics)},
    {"bodies", picks, offsetof(adcgs_plan, bodies)},      {"positions", spreads, offsetof(adcgs_plan, positions)},
    {"values", fills, offsetof(adcgs_plan, values)},      {"kept", holds, offsetof(adcgs_plan, kept)},
    {"digest", digests, offsetof(adcgs_plan, no_digest)},
};

adcgs_status adcgs_plan_each(adcgs_plan *plan, const char *verb, adcgs_command_fn fn, void *user, adcgs_error *error)
{
    for (int i = 0; i < plan->recipe->n; i++) {
        adcgs_command *const c = &plan->recipe->command[i];
        if (!adcgs_command_is(c, verb))
            continue;
        c->used = 1;
        ADCGS_TRY(adcgs_command_locate(plan->recipe, c, fn(plan, c, user, error), error));
    }
    return ADCGS_OK;
}

static adcgs_status set_number(void *place, int type, const char *word, adcgs_error *error)
{
    const int64_t most = type == ADCGS_U8 ? UINT8_MAX : type == ADCGS_U32 ? UINT32_MAX : INT64_MAX;
    int64_t whole = 0;
    double real = 0;
    if (type == ADCGS_F32 || type == ADCGS_F64)
        ADCGS_TRY(adcgs_word_real(word, &real, error));
    else
        ADCGS_TRY(adcgs_word_int(word, 0, most, &whole, error));
    const float narrow = (float)real;
    const uint32_t word32 = (uint32_t)whole;
    const uint8_t byte = (uint8_t)whole;
    switch (type) {
    case ADCGS_F64:
        memcpy(place, &real, sizeof real);
        break;
    case ADCGS_F32:
        memcpy(place, &narrow, sizeof narrow);
        break;
    case ADCGS_U32:
        memcpy(place, &word32, sizeof word32);
        break;
    case ADCGS_U8:
        memcpy(place, &byte, sizeof byte);
        break;
    default:
        memcpy(place, &whole, sizeof whole);
    }
    return ADCGS_OK;
}

static adcgs_status set_numbers(adcgs_plan *plan, const adcgs_command *c, void *user, adcgs_error *error)
{
    const size_t i = *(const size_t *)user;
    static const size_t bytes[] = {[ADCGS_U8] = 1, [ADCGS_U32] = 4, [ADCGS_U64] = 8, [ADCGS_F32] = 4, [ADCGS_F64] = 8};
    ADCGS_TRY(adcgs_command_words(c, numbers[i].count, numbers[i].count, error));
    for (int k = 0; k < numbers[i].count; k++)
        ADCGS_TRY(set_number((uint8_t *)plan + numbers[i].offset + (size_t)k * bytes[numbers[i].type], numbers[i].type,
                             c->word[1 + k], error));
    return ADCGS_OK;
}

static adcgs_status set_choice(adcgs_plan *plan, const adcgs_command *c, void *user, adcgs_error *error)
{
    const size_t i = *(const size_t *)user;
    int value;
    ADCGS_TRY(adcgs_command_words(c, 1, 1, error));
    ADCGS_TRY(adcgs_word_choice(c->word[1], choices[i].names, &value, error));
    memcpy((uint8_t *)plan + choices[i].offset, &value, sizeof value);
    return ADCGS_OK;
}

static adcgs_status set_params(adcgs_plan *plan, const adcgs_command *c, void *user, adcgs_error *error)
{
    adcgs_params *const p = &plan->stream.params;
    const struct {
        const char *name;
        uint8_t *byte;
        uint16_t *word;
    } members[] = {{"k", &p->k, NULL},
                   {"n_fv", &p->n_fv, NULL},
                   {"n_fg", &p->n_fg, NULL},
                   {"chunks", &p->chunks, NULL},
                   {"n_eta", &p->n_eta, NULL},
                   {"octaves", &p->octaves, NULL},
                   {"fine_uses_fv", &p->fine_uses_fv, NULL},
                   {"coarse_rotation", &p->coarse_rotation, NULL},
                   {"adaptive_steps", &p->adaptive_steps, NULL},
                   {"spans", &p->spans, NULL},
                   {"bodies", &p->bodies, NULL},
                   {"smooth_time", &p->smooth_time, NULL},
                   {"time_rows", NULL, &p->time_rows},
                   {"time_width", NULL, &p->time_width}};
    (void)user;
    for (int i = 1; i < c->n; i++) {
        int64_t value = -1;
        for (size_t m = 0; m < ADCGS_COUNTOF(members); m++) {
            const char *const text = adcgs_word_value(c->word[i], members[m].name);
            if (!text)
                continue;
            ADCGS_TRY(adcgs_word_int(text, 0, members[m].byte ? UINT8_MAX : UINT16_MAX, &value, error));
            if (members[m].byte)
                *members[m].byte = (uint8_t)value;
            else
                *members[m].word = (uint16_t)value;
        }
        if (value < 0)
            return adcgs_fail(error, ADCGS_ERR_USAGE, "\"%s\": no such parameter", c->word[i]);
    }
    return ADCGS_OK;
}

/* anchors N ...: per segment, in predicted segments new anchors; the last number holds for the remaining segments. */
static adcgs_status set_anchors(adcgs_plan *plan, const adcgs_command *c, void *user, adcgs_error *error)
{
    int64_t n = 1;
    (void)user;
    ADCGS_TRY(adcgs_command_words(c, 1, ADCGS_PLAN_SEGMENTS, error));
    for (int i = 0; i < ADCGS_PLAN_SEGMENTS; i++) {
        if (i + 1 < c->n)
            ADCGS_TRY(adcgs_word_int(c->word[i + 1], 0, ADCGS_ANCHORS_MAX, &n, error));
        plan->anchors[i] = (uint32_t)n;
    }
    return ADCGS_OK;
}

/* predicted N ...: these segments, counted from 0 */
static adcgs_status set_predicted(adcgs_plan *plan, const adcgs_command *c, void *user, adcgs_error *error)
{
    (void)user;
    ADCGS_TRY(adcgs_command_words(c, 1, ADCGS_PLAN_SEGMENTS, error));
    memset(plan->predicted, 0, sizeof plan->predicted);
    for (int i = 1; i < c->n; i++) {
        int64_t segment;
        ADCGS_TRY(adcgs_word_int(c->word[i], 1, ADCGS_PLAN_SEGMENTS - 1, &segment, error));
        plan->predicted[segment] = 1;
    }
    return ADCGS_OK;
}

/* tiers N GROWTH ...: the first N anchors are of tiers 0 to N - 1, the others of any; the last growth holds for the rest */
static adcgs_status set_tiers(adcgs_plan *plan, const adcgs_command *c, void *user, adcgs_error *error)
{
    int64_t n, growth = 0;
    (void)user;
    ADCGS_TRY(adcgs_command_words(c, 1, ADCGS_TIERS_MAX, error));
    ADCGS_TRY(adcgs_word_int(c->word[1], 1, ADCGS_TIERS_MAX, &n, error));
    plan->tiers = (int)n;
    for (int i = 0; i < ADCGS_TIERS_MAX - 1; i++) {
        if (i + 2 < c->n)
            ADCGS_TRY(adcgs_word_int(c->word[i + 2], 0, ADCGS_GROWTH_MAX, &growth, error));
        plan->growth[i] = (int)growth;
    }
    return ADCGS_OK;
}

/* differences HOW GROUP ...: of these groups; of all groups if none is named */
static adcgs_status set_differences(adcgs_plan *plan, const adcgs_command *c, void *user, adcgs_error *error)
{
    static const char *const changes[] = {"small", "escapes", "clips", NULL};
    static const char *const groups[] = {"fv", "sigma", "colour", NULL};
    (void)user;
    ADCGS_TRY(adcgs_command_words(c, 1, 1 + ADCGS_INTER_GROUPS, error));
    ADCGS_TRY(adcgs_word_choice(c->word[1], changes, &plan->differences, error));
    plan->changed = c->n > 2 ? 0 : (1 << ADCGS_INTER_GROUPS) - 1;
    for (int i = 2; i < c->n; i++) {
        int group;
        ADCGS_TRY(adcgs_word_choice(c->word[i], groups, &group, error));
        plan->changed |= 1 << group;
    }
    return ADCGS_OK;
}

static adcgs_status set_ticks(adcgs_plan *plan, const adcgs_command *c, void *user, adcgs_error *error)
{
    (void)user;
    ADCGS_TRY(adcgs_command_words(c, 2, 2 * ADCGS_PLAN_SEGMENTS, error));
    for (int i = 1; i < c->n; i++)
        ADCGS_TRY(adcgs_word_int(c->word[i], -INT64_MAX, INT64_MAX, &plan->ticks[i - 1], error));
    return ADCGS_OK;
}

/* reach N ... */
static adcgs_status set_reach(adcgs_plan *plan, const adcgs_command *c, void *user, adcgs_error *error)
{
    (void)user;
    ADCGS_TRY(adcgs_command_words(c, 1, ADCGS_PLAN_SEGMENTS, error));
    for (int i = 1; i < c->n; i++) {
        int64_t ticks = 0;
        ADCGS_TRY(adcgs_word_int(c->word[i], 0, UINT32_MAX, &ticks, error));
        plan->reach[i - 1] = (uint32_t)ticks;
    }
    return ADCGS_OK;
}

/* layers N ... */
static adcgs_status set_fewer(adcgs_plan *plan, const adcgs_command *c, void *user, adcgs_error *error)
{
    (void)user;
    ADCGS_TRY(adcgs_command_words(c, 1, ADCGS_PLAN_LAYERS, error));
    for (plan->n_fewer = 0; plan->n_fewer < c->n - 1; plan->n_fewer++) {
        int64_t layers;
        ADCGS_TRY(adcgs_word_int(c->word[1 + plan->n_fewer], 1, ADCGS_LAYERS, &layers, error));
        plan->fewer[plan->n_fewer] = (int)layers;
    }
    return ADCGS_OK;
}

static adcgs_status add_time(adcgs_plan *plan, const adcgs_command *c, void *user, adcgs_error *error)
{
    (void)user;
    plan->n_times = 0;
    ADCGS_TRY(adcgs_command_words(c, 1, ADCGS_PLAN_TIMES, error));
    while (plan->n_times < c->n - 1) {
        ADCGS_TRY(adcgs_word_real(c->word[1 + plan->n_times], &plan->times[plan->n_times], error));
        plan->n_times++;
    }
    return ADCGS_OK;
}

static void set_defaults(adcgs_plan *plan)
{
    *plan = (adcgs_plan){.seed = 1, .segments = 1, .depth = 4, .origin = {-1, -1, -1}, .changed = (1 << ADCGS_INTER_GROUPS) - 1};
    adcgs_stream_init(&plan->stream);
    plan->stream.level = 1;
    plan->stream.params = (adcgs_params){.k = 1, .n_fv = 4, .chunks = 1};
    plan->stream.background[0] = 0.25f;
    plan->stream.background[2] = 0.5f;
    for (int i = 0; i < ADCGS_PLAN_SEGMENTS; i++) {
        plan->anchors[i] = 8;
        plan->ticks[2 * i] = 40 * i;
        plan->ticks[2 * i + 1] = 40 * (i + 1);
    }
}

/* Unless the recipe names its own: a camera that sees the cube, the start of the stream, and, if it moves, a later time. */
static void default_views(adcgs_plan *plan)
{
    static const adcgs_camera front = {.width = 24,
                                       .height = 16,
                                       .fx = 20,
                                       .fy = 20,
                                       .cx = 12,
                                       .cy = 8,
                                       .near_plane = 0.01,
                                       .cam_to_world = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -3},
                                       .name = "front"};
    static const double moments[] = {0.0, 0.0137};
    if (plan->n_cameras == 0)
        plan->cameras[plan->n_cameras++] = front;
    if (plan->n_times == 0) {
        plan->n_times = plan->stream.params.time_rows > 0 ? 2 : 1;
        memcpy(plan->times, moments, sizeof moments);
    }
}

adcgs_status adcgs_plan_init(adcgs_plan *plan, adcgs_recipe *recipe, adcgs_error *error)
{
    static const struct {
        const char *verb;
        adcgs_command_fn fn;
    } others[] = {{"params", set_params},
                  {"anchors", set_anchors},
                  {"ticks", set_ticks},
                  {"times", add_time},
                  {"reach", set_reach},
                  {"layers", set_fewer},
                  {"predicted", set_predicted},
                  {"differences", set_differences},
                  {"tiers", set_tiers},
                  {"camera", adcgs_plan_add_camera},
                  {"stored", adcgs_plan_add_stored},
                  {"meta", adcgs_plan_add_meta}};
    set_defaults(plan);
    plan->recipe = recipe;
    for (size_t i = 0; i < ADCGS_COUNTOF(numbers); i++)
        ADCGS_TRY(adcgs_plan_each(plan, numbers[i].verb, set_numbers, &i, error));
    for (size_t i = 0; i < ADCGS_COUNTOF(choices); i++)
        ADCGS_TRY(adcgs_plan_each(plan, choices[i].verb, set_choice, &i, error));
    for (size_t i = 0; i < ADCGS_COUNTOF(others); i++)
        ADCGS_TRY(adcgs_plan_each(plan, others[i].verb, others[i].fn, NULL, error));
    if (plan->segments < 1 || plan->segments > ADCGS_PLAN_SEGMENTS)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: 1 to %d segments", recipe->id, ADCGS_PLAN_SEGMENTS);
    for (uint32_t i = 0; i < plan->segments; i++)
        if (plan->anchors[i] == 0 && !plan->predicted[i])
            return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: segment %u has no anchors", recipe->id, i);
    default_views(plan);
    plan->state = plan->seed;
    return ADCGS_OK;
}

static void clear_tier(adcgs_drawn_tier *d)
{
    for (uint32_t i = 0; d->data && i < ADCGS_LAYERS * d->n_slices; i++)
        adcgs_buffer_clear(&d->data[i]);
    adcgs_free(NULL, d->data);
    adcgs_buffer_clear(&d->geom);
}

void adcgs_plan_clear(adcgs_plan *plan)
{
    for (int s = 0; s < ADCGS_PLAN_SEGMENTS; s++) {
        adcgs_drawn *const d = &plan->drawn[s];
        for (int t = 0; t < ADCGS_TIERS_MAX; t++)
            clear_tier(&d->tier[t]);
        adcgs_buffer_clear(&d->keep);
    }
    adcgs_stream_clear(&plan->stream, NULL);
}
