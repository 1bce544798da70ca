/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A sequence of calls to the public decoder. The bytes after the stream are a script of calls. Bytes are pushed to two decoders
 * that share a pool, with other calls in between; or they are read on demand from a source that fails, returns few bytes, or
 * returns changed bytes. After each failure all queries are made.
 */
#include "fuzz.h"
#include "stream_edit.h"

#include "base/digest.h"

#include <adcgs/adcgs.h>

#include <math.h>

#define SCRIPT_BYTES 64
#define WIDTH 20
#define HEIGHT 12
#define MEMORY_MOST ((uint64_t)48 << 20)
#define STEPS_MOST 400
#define READS_MOST 100000
#define HEAVY 2e8 /* products of a frame's networks; frames are rendered only below this */

const char *const adcgs_fuzz_seeds[] = {"tests/fuzz/seeds/calls", "tests/fuzz/regressions/calls", NULL};

/* ---- The script ---- */

typedef struct script {
    const uint8_t *next;
    size_t left;
    uint32_t state; /**< generates further bytes after the end of the script */
} script;

static uint32_t draw(script *s)
{
    if (s->left > 0) {
        s->left--;
        return *s->next++;
    }
    s->state = s->state * 1664525U + 1013904223U;
    return s->state >> 24;
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max, unsigned int seed)
{
    uint8_t end[SCRIPT_BYTES];
    FUZZ_WRITTEN(&data, sizeof data);
    FUZZ_WRITTEN(&size, sizeof size);
    FUZZ_WRITTEN(&max, sizeof max);
    FUZZ_WRITTEN(&seed, sizeof seed);
    FUZZ_WRITTEN(data, max);
    if (size <= SCRIPT_BYTES || max < size + 4096)
        return LLVMFuzzerMutate(data, size, max);
    const size_t stream = size - SCRIPT_BYTES;
    memcpy(end, data + stream, SCRIPT_BYTES);
    if (seed % 3 == 0) {
        size_t n = LLVMFuzzerMutate(end, SCRIPT_BYTES, SCRIPT_BYTES);
        FUZZ_WRITTEN(&n, sizeof n);
        FUZZ_WRITTEN(end, sizeof end);
        memset(end + n, (int)(seed >> 8 & 255), SCRIPT_BYTES - n);
        memcpy(data + stream, end, SCRIPT_BYTES);
        return size;
    }
    const size_t n = adcgs_mutate_stream(data, stream, max - SCRIPT_BYTES, seed);
    memcpy(data + n, end, SCRIPT_BYTES);
    return n + SCRIPT_BYTES;
}

/* ---- Calls ---- */

/** A decoder and the results of earlier queries. */
typedef struct patient {
    adcgs_decoder *d;
    int is_pushed;
    int segments; /**< from the last info; -1: none yet */
} patient;

static void check(adcgs_status status, const adcgs_error *error)
{
    FUZZ_REQUIRE(status != ADCGS_ERR_INTERNAL);
    if (status != ADCGS_OK)
        FUZZ_REQUIRE(error->status == status && error->text[0] && memchr(error->text, 0, sizeof error->text) &&
                     !strchr(error->text, '\n'));
}

/** Queries the stream's info; 0 if it is not available yet. */
static int ask_info(patient *p, adcgs_info *info)
{
    adcgs_error error = {ADCGS_OK, ""};
    const adcgs_status status = adcgs_get_info(p->d, info, sizeof *info, &error);
    check(status, &error);
    if (status != ADCGS_OK) {
        FUZZ_REQUIRE(p->is_pushed && p->segments < 0);
        return 0;
    }
    FUZZ_REQUIRE(info->frame_rate > 0 && info->scene_scale > 0 && info->segments >= 0);
    FUZZ_REQUIRE(p->is_pushed ? info->segments >= p->segments : p->segments < 0 || info->segments == p->segments);
    FUZZ_REQUIRE(p->is_pushed || info->segments >= 1);
    FUZZ_REQUIRE(!isnan(info->time_start) && !isnan(info->time_end) && info->tiers_present <= info->tiers);
    p->segments = info->segments;
    return 1;
}

static double any_time(script *s, const adcgs_info *info)
{
    const uint32_t kind = draw(s) % 10;
    const double end = isfinite(info->time_end) ? info->time_end : info->time_start + 1;
    const double odd[] = {NAN, INFINITY, -INFINITY, 1e300, info->time_committed};
    return kind < ADCGS_COUNTOF(odd) ? odd[kind] : info->time_start + draw(s) / 255.0 * (end - info->time_start);
}

static adcgs_camera any_camera(script *s, const adcgs_decoder *d)
{
    adcgs_camera c =
        {.fx = 20, .fy = 20, .cx = 10, .cy = 6, .near_plane = 0.01, .cam_to_world = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -3}};
    const uint32_t kind = draw(s);
    if (kind & 1)
        (void)adcgs_get_camera(d, (int)(kind / 2 % 3), &c, NULL);
    c.width = kind & 8 ? WIDTH : 1;
    c.height = HEIGHT;
    if (kind >= 0xe0)
        c.cam_to_world[draw(s) % 12] = kind & 16 ? NAN : 1e30;
    return c;
}

/** Renders one frame, and checks that its pixels are finite. */
static adcgs_status ask_picture(patient *p, const adcgs_camera *camera, double time, int kind, adcgs_error *error)
{
    float rgb[WIDTH * HEIGHT * 3] = {0}, depth[WIDTH * HEIGHT], alpha[WIDTH * HEIGHT];
    uint8_t rgba[4 * WIDTH * HEIGHT];
    adcgs_frame frame = {camera->width, camera->height, rgb};
    const int stride = 4 * camera->width;
    if (kind == 1)
        return adcgs_render_rgba8(p->d, camera, time, ADCGS_ALPHA_STRAIGHT, rgba + (HEIGHT - 1) * stride, -stride, error);
    if (kind == 2)
        return adcgs_render_depth(p->d, camera, time, depth, alpha, error);
    const adcgs_status status = adcgs_render(p->d, camera, time, &frame, error);
    for (size_t i = 0; i < ADCGS_COUNTOF(rgb); i++)
        FUZZ_REQUIRE(rgb[i] - rgb[i] == 0);
    return status;
}

static adcgs_status ask_primitives(patient *p, double time, adcgs_error *error)
{
    adcgs_primitives out;
    const adcgs_status status = adcgs_get_primitives(p->d, time, &out, error);
    for (uint32_t i = 0; status == ADCGS_OK && i < out.n; i++)
        FUZZ_REQUIRE(isfinite(out.mean[0][i]) && isfinite(out.scale[2][i]) && out.opacity[i] >= 0 && out.opacity[i] < 1);
    return status;
}

/** Calls without a time, which fail only for invalid arguments. */
static void ask_texts(patient *p, script *s)
{
    adcgs_info info;
    adcgs_camera camera;
    const size_t size = sizeof info.size + draw(s) % (sizeof info - sizeof info.size);
    if (!ask_info(p, &info))
        return;
    for (int i = -1; i <= info.metadata; i++) {
        const char *const key = adcgs_get_metadata_key(p->d, i);
        FUZZ_REQUIRE((key != NULL) == (i >= 0 && i < info.metadata));
        FUZZ_REQUIRE(!key || adcgs_get_metadata(p->d, key));
    }
    for (int i = -1; i <= info.cameras; i++)
        FUZZ_REQUIRE((adcgs_get_camera(p->d, i, &camera, NULL) == ADCGS_OK) == (i >= 0 && i < info.cameras));
    FUZZ_REQUIRE(adcgs_get_info(p->d, &info, size, NULL) == ADCGS_OK);
}

/** One call with a time or a segment. */
static adcgs_status ask_one(patient *p, script *s, uint32_t kind)
{
    adcgs_info info;
    adcgs_error error = {ADCGS_OK, ""};
    uint8_t digest[16];
    adcgs_status status = ADCGS_OK;
    if (!ask_info(p, &info) || (double)info.weights * info.gaussians > HEAVY)
        return ADCGS_OK;
    const double time = any_time(s, &info);
    const adcgs_camera camera = any_camera(s, p->d);
    if (kind < 3)
        status = ask_picture(p, &camera, time, (int)kind, &error);
    else if (kind == 3)
        status = ask_primitives(p, time, &error);
    else if (kind == 4)
        status = adcgs_get_splat_digest(p->d, time, digest, &error);
    else if (kind == 5)
        status = adcgs_get_model_digest(p->d, info.first_segment + (int)(draw(s) % 8) - 1, digest, &error);
    else if (kind == 6)
        status = adcgs_set_tiers(p->d, (int)(draw(s) % 10) - 1, &error);
    else if (p->is_pushed)
        status = adcgs_push_discard_before(p->d, time, &error);
    check(status, &error);
    return status;
}

/** All calls, as after each failure. */
static void ask_all(patient *p, script *s)
{
    ask_texts(p, s);
    for (uint32_t kind = 0; kind < 8; kind++) {
        (void)ask_one(p, s, kind);
        ask_texts(p, s);
    }
}

static void ask(patient *p, script *s)
{
    if (ask_one(p, s, draw(s) % 8) != ADCGS_OK)
        ask_all(p, s);
}

/* ---- Bytes are pushed ---- */

typedef struct way {
    patient p;
    const uint8_t *data;
    size_t left;
    int is_over;
} way;

static void configure(adcgs_config *config, script *s)
{
    const uint32_t kind = draw(s), memory = draw(s);
    adcgs_config_init(config, sizeof *config);
    config->threads = 1;
    config->cpu = kind & 1 ? ADCGS_CPU_SCALAR : ADCGS_CPU_AUTO;
    config->layers = kind & 2 ? (int)(kind >> 2) % 6 : 0;
    config->tune_in = (kind & 0xc0) == 0x40;
    config->strict_end = (kind & 0xc0) == 0x80;
    config->memory_limit = memory & 1 ? (uint64_t)(memory + 1) << 13 : MEMORY_MOST;
}

/** Pushes a piece of the stream, or ends it. The piece is a copy, so that a sanitizer detects reads beyond its end. */
static void push_on(way *w, script *s)
{
    static const size_t sizes[] = {0, 1, 13, 64, 300, 2000, 65536, 65536};
    const size_t wanted = sizes[draw(s) % 8], n = ADCGS_MIN(wanted, w->left);
    adcgs_arrival arrived = ADCGS_ARRIVED_NOTHING;
    adcgs_error error = {ADCGS_OK, ""};
    size_t used = 0;
    uint8_t *const copy = fuzz_file(w->data, n);
    adcgs_status status = adcgs_push(w->p.d, n ? copy : NULL, n, &used, &arrived, &error);
    free(copy);
    check(status, &error);
    FUZZ_REQUIRE(used <= n && (!w->is_over || used == 0));
    w->data += used;
    w->left -= used;
    if (status == ADCGS_OK && (w->left == 0 || arrived == ADCGS_ARRIVED_END)) {
        status = adcgs_push_end(w->p.d, &error);
        check(status, &error);
        w->is_over = 1;
    }
    w->is_over |= status != ADCGS_OK;
    if (status != ADCGS_OK)
        ask_all(&w->p, s);
}

static void push_both(const uint8_t *data, size_t size, script *s)
{
    adcgs_pool *pool = NULL;
    way ways[2] = {{.is_over = 1}, {.is_over = 1}};
    if (adcgs_pool_create(&pool, 1 + (int)(draw(s) % 2), NULL) != ADCGS_OK)
        return;
    for (int i = 0; i < 2; i++) {
        adcgs_config config;
        configure(&config, s);
        config.pool = pool;
        const size_t skipped = config.tune_in ? size * draw(s) / 256 : 0;
        ways[i] = (way){.p = {.is_pushed = 1, .segments = -1}, .data = data + skipped, .left = size - skipped};
        FUZZ_REQUIRE(adcgs_open_push(&ways[i].p.d, &config, NULL) == ADCGS_OK);
    }
    for (int step = 0; step < STEPS_MOST && !(ways[0].is_over && ways[1].is_over); step++) {
        way *const w = &ways[draw(s) % 2];
        push_on(w, s);
        if (draw(s) % 4 == 0)
            ask(&w->p, s);
    }
    for (int i = 0; i < 2; i++) {
        push_on(&ways[i], s);
        ask_all(&ways[i].p, s);
        adcgs_close(&ways[i].p.d);
    }
    adcgs_pool_free(&pool);
}

/* ---- Bytes are read on demand ---- */

enum { FAILS = 1, DRIPS = 2, ENDS = 4, CHANGES = 8, OPENS_WELL = 16 };

typedef struct source {
    const uint8_t *data, *other;
    size_t size;
    script *script;
    uint32_t faults; /**< flags from the enumeration above; 0: no faults from now on */
    int reads;
} source;

static int64_t read_at(void *user, uint64_t offset, void *buffer, size_t bytes)
{
    source *s = user;
    const uint32_t chance = s->faults ? draw(s->script) : 0;
    FUZZ_REQUIRE(bytes > 0 && offset < s->size && bytes <= s->size - offset && ++s->reads < READS_MOST);
    if (s->faults & FAILS && chance % 11 == 1)
        return chance & 16 ? -1 : INT64_MIN;
    if (s->faults & ENDS && chance % 29 == 2)
        return chance & 16 ? 0 : INT64_MAX;
    const size_t n = s->faults & DRIPS ? ADCGS_MIN(bytes, 1 + (size_t)chance) : bytes;
    memcpy(buffer, (s->faults & CHANGES && chance & 1 ? s->other : s->data) + offset, n);
    return (int64_t)n;
}

/** The stream with some bytes changed, and correct checksums. */
static uint8_t *change(const uint8_t *data, size_t size, script *s)
{
    uint8_t *const other = fuzz_file(data, size);
    for (int i = 0; i < 4; i++)
        other[(draw(s) << 16 | draw(s) << 8 | draw(s)) % size] ^= (uint8_t)draw(s);
    adcgs_repair_stream(other, size, 0);
    return other;
}

/** After its faults have ended, a source gives the models of the whole stream. */
static void compare(patient *p, const source *from, const adcgs_config *config)
{
    adcgs_decoder *whole = NULL;
    adcgs_info info = {.truncated = 1};
    if (adcgs_open_memory(&whole, from->data, from->size, config, NULL) == ADCGS_OK)
        FUZZ_REQUIRE(adcgs_get_info(whole, &info, sizeof info, NULL) == ADCGS_OK);
    for (int i = info.segments - 1; !info.truncated && i >= 0; i--) {
        uint8_t digest[16], expected[16];
        FUZZ_REQUIRE(adcgs_get_model_digest(whole, i, expected, NULL) == ADCGS_OK);
        FUZZ_REQUIRE(adcgs_get_model_digest(p->d, i, digest, NULL) == ADCGS_OK);
        FUZZ_REQUIRE(memcmp(digest, expected, sizeof digest) == 0);
    }
    adcgs_close(&whole);
}

static void seek(const uint8_t *data, size_t size, script *s)
{
    adcgs_config config;
    adcgs_error error = {ADCGS_OK, ""};
    patient p = {.segments = -1};
    if (size == 0)
        return;
    configure(&config, s);
    const uint32_t faults = draw(s) % 32;
    uint8_t *const other = change(data, size, s);
    source from = {data, other, size, s, faults & OPENS_WELL ? 0 : faults, 0};
    const adcgs_status status = adcgs_open_at(&p.d, read_at, &from, size, &config, &error);
    check(status, &error);
    FUZZ_REQUIRE((status == ADCGS_OK) == (p.d != NULL));
    from.faults = faults;
    for (int i = 0; p.d && i < 6; i++)
        ask(&p, s);
    from.faults = 0;
    if (p.d && faults & OPENS_WELL && !(faults & CHANGES) && config.memory_limit == MEMORY_MOST && !config.tune_in)
        compare(&p, &from, &config);
    if (p.d)
        ask_all(&p, s);
    adcgs_close(&p.d);
    free(other);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const size_t n = size > SCRIPT_BYTES ? size - SCRIPT_BYTES : 0, level = ADCGS_SIGNATURE_BYTES + ADCGS_CHUNK_HEADER_BYTES + 5;
    script s = {data + n, size - n, (uint32_t)size};
    const uint32_t kind = draw(&s);
    uint8_t *const stream = fuzz_file(data, n);
    if (n > level)
        stream[level] = ADCGS_MIN(stream[level], (uint8_t)1); /* models of higher levels take too long */
    if (kind % 16)
        adcgs_repair_stream(stream, n, kind & 32 ? 1 : 0);
    if (kind & 64)
        push_both(stream, n, &s);
    else
        seek(stream, n, &s);
    free(stream);
    return 0;
}
