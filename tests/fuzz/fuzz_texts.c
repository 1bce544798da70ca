/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Untrusted small control files, and texts of command lines. The first byte selects the kind: C, H, U a camera path, W a page
 * with a stream, L a scene file of future footage, P a script of the player, R requests for digests, A a table of another method,
 * J the sweep.json of an earlier sweep, G a grid, F a range of frames, N frames per second, Y the first line of Y4M, S settings
 * of the trainer, O faults of a scene, B a budget; H also the header lines of a web server.
 */
#define _GNU_SOURCE

#include "outside_file.h"

#include "apps/dec/dec_budget.h"
#include "apps/shared/answer.h"
#include "apps/sweep/sweep.h"
#include "camera/path.h"
#include "media/page_stream.h"
#include "media/video/fps.h"
#include "media/video/y4m_shape.h"
#include "net/http_head.h"
#include "play/script.h"
#include "scene/frames.h"
#include "scene/layouts/scene_file.h"
#include "synthetic/spoil.h"
#include "train/settings.h"

#include <math.h>
#include <sys/stat.h>

const char *const adcgs_fuzz_seeds[] = {"tests/fuzz/seeds/texts", "tests/fuzz/regressions/texts", NULL};

typedef adcgs_status reader(const char *path, adcgs_error *error);

static adcgs_status read_camera_path(const char *path, adcgs_error *error)
{
    const adcgs_info info = {.time_start = 0, .time_end = 2, .frame_rate = 10};
    const adcgs_camera like = {.width = 32, .height = 24, .fx = 30, .fy = 30, .cx = 16, .cy = 12, .near_plane = 0.01};
    const adcgs_camera_path_request requests[] = {{.camera = path}, {.camera = path, .size = {40, 30}}};
    adcgs_status status = ADCGS_OK;
    for (size_t i = 0; i < ADCGS_COUNTOF(requests); i++) {
        adcgs_camera_path frames = {.n = 0};
        status = adcgs_camera_path_read(&frames, &info, &requests[i], &like, error);
        for (int j = 0; status == ADCGS_OK && j < frames.n; j++) {
            FUZZ_REQUIRE(isfinite(frames.frame[j].time) && frames.frame[j].camera.width > 0 && frames.frame[j].camera.height > 0);
            for (int a = 0; a < 12; a++)
                FUZZ_REQUIRE(isfinite(frames.frame[j].camera.cam_to_world[a]));
        }
        adcgs_camera_path_free(&frames);
    }
    return status;
}

static adcgs_status read_sources(const char *path, adcgs_error *error)
{
    adcgs_source_camera *cameras = NULL;
    uint32_t n = 0;
    const adcgs_status status = adcgs_source_cameras_read(&cameras, &n, path, error);
    FUZZ_REQUIRE(status != ADCGS_OK || (n > 0 && cameras));
    adcgs_source_cameras_free(&cameras, n);
    return status;
}

/** The stream of a page is the same read in order and from its end. */
static adcgs_status read_page(const char *path, adcgs_error *error)
{
    adcgs_page_stream *page;
    const adcgs_status status = adcgs_page_stream_open(&page, path, error);
    const uint64_t size = status == ADCGS_OK ? adcgs_page_stream_size(page) : 0;
    FUZZ_REQUIRE(status == ADCGS_OK ? size > 0 : !page);
    uint8_t *const data = malloc((size_t)size + 1);
    FUZZ_REQUIRE(data != NULL);
    if (page)
        FUZZ_REQUIRE(adcgs_page_stream_read(page, data, (size_t)size + 1) == (int64_t)size &&
                     !strchr(adcgs_page_stream_name(page), '/'));
    for (uint64_t at = size; at-- > 0 && at + 16 > size;) {
        uint8_t one;
        FUZZ_REQUIRE(adcgs_page_stream_read_at(page, at, &one, 1) == 1 && one == data[at]);
    }
    free(data);
    adcgs_page_stream_close(&page);
    return status;
}

static adcgs_status read_script(const char *path, adcgs_error *error)
{
    adcgs_script script = {.n = 0};
    const adcgs_status status = adcgs_script_read(&script, path, error);
    adcgs_script_clear(&script);
    return status;
}

static adcgs_status read_requests(const char *path, adcgs_error *error)
{
    adcgs_requests requests = {.n = 0};
    const adcgs_status status = adcgs_requests_read(&requests, path, error);
    for (int i = 0; status == ADCGS_OK && i < requests.n; i++)
        FUZZ_REQUIRE(requests.request[i].kind != ADCGS_REQUEST_FRAME ||
                     (requests.request[i].camera >= 0 && requests.request[i].camera < requests.n_cameras));
    adcgs_requests_clear(&requests);
    return status;
}

/** A plan takes a megabyte, so it is allocated. The readers only add curves to it. */
static adcgs_status read_curves(const char *path, int is_table, adcgs_error *error)
{
    adcgs_sweep_plan *plan = calloc(1, sizeof *plan);
    char text[128];
    FUZZ_REQUIRE(plan != NULL);
    adcgs_status status;
    if (is_table) {
        snprintf(text, sizeof text, "other=%s", path);
        status = adcgs_sweep_add_tables(plan, text, error);
    } else {
        snprintf(text, sizeof text, "%.*s", (int)(strrchr(path, '/') - path), path);
        const adcgs_sweep sweep = {.scene = "data/robot", .directory = "/tmp/adcgs-none", .against = text};
        status = adcgs_sweep_add_against(plan, &sweep, error);
    }
    FUZZ_REQUIRE(status != ADCGS_OK || (plan->n_curves == 1 && plan->curve[0].n > 0));
    for (int i = 0; status == ADCGS_OK && i < plan->curve[0].n; i++)
        FUZZ_REQUIRE(plan->curve[0].point[i].bytes.mean >= 1 && isfinite(plan->curve[0].point[i].psnr.mean));
    adcgs_sweep_plan_clear(plan);
    free(plan);
    return status;
}

static adcgs_status read_table(const char *path, adcgs_error *error)
{
    return read_curves(path, 1, error);
}

static adcgs_status read_earlier(const char *path, adcgs_error *error)
{
    return read_curves(path, 0, error);
}

static const struct kind {
    char letter;
    const char *name;
    reader *read;
} kinds[] = {
    {'C', "path.json", read_camera_path}, {'H', "path.chan", read_camera_path}, {'U', "path.usda", read_camera_path},
    {'L', "scene.json", read_sources},    {'P', "script", read_script},         {'R', "requests", read_requests},
    {'A', "table.csv", read_table},       {'J', "sweep.json", read_earlier},    {'W', "page.html", read_page},
};

static void check(adcgs_status status, const adcgs_error *error)
{
    FUZZ_REQUIRE(status == ADCGS_OK || (error->status == status && error->text[0] && !strchr(error->text, '\n')));
}

static void parse_grid(const char *text)
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_sweep_grid grid = {.n = 0};
    const adcgs_status status = adcgs_sweep_grid_parse(&grid, text, &error);
    check(status, &error);
    for (int i = 0; status == ADCGS_OK && i < ADCGS_MIN(adcgs_sweep_grid_count(&grid), 16); i++) {
        char choice[ADCGS_SWEEP_CHOICE];
        adcgs_sweep_grid_choice(choice, &grid, i);
    }
    if (status == ADCGS_OK)
        check(adcgs_sweep_grid_check(&grid, "draft", NULL, &error), &error);
}

static void parse_frames(const char *text)
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_frame_range range = {0, 0, 0};
    int64_t count;
    const adcgs_status status = adcgs_frames_parse(&range, text, &error);
    check(status, &error);
    if (status == ADCGS_OK)
        check(adcgs_frames_count(&range, 1000, &count, "fuzz", &error), &error);
}

static void parse_rate(const char *text)
{
    adcgs_fps rate;
    if (!adcgs_fps_parse(text, &rate))
        FUZZ_REQUIRE(rate.num > 0 && rate.den > 0 && isfinite(adcgs_fps_value(rate)));
}

static void parse_shape(const char *text)
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_y4m_shape shape;
    const adcgs_status status = adcgs_y4m_shape_parse(&shape, text, "fuzz.y4m", &error);
    check(status, &error);
    FUZZ_REQUIRE(status != ADCGS_OK || (shape.width > 0 && shape.height > 0 && shape.frame_bytes > 0));
}

static void parse_settings(const char *text)
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_train_config config;
    FUZZ_REQUIRE(adcgs_train_preset(&config, "draft", &error) == ADCGS_OK);
    check(adcgs_train_set(&config, text, &error), &error);
}

static void parse_spoil(const char *text)
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_spoil spoil;
    const adcgs_status status = adcgs_spoil_parse(&spoil, text, &error);
    check(status, &error);
    for (int i = 0; status == ADCGS_OK && i < ADCGS_SPOILS; i++)
        FUZZ_REQUIRE(spoil.strength[i] >= 0 && spoil.strength[i] <= 180);
}

static void parse_budget(const char *text)
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_budget budget;
    const adcgs_status status = adcgs_budget_parse(&budget, text, &error);
    check(status, &error);
    FUZZ_REQUIRE(status != ADCGS_OK || (budget.of != ADCGS_BUDGET_NONE && budget.most > 0 && budget.most < 2e12));
}

/** A parsed range is inside the file; a text that is returned to the server is one line. */
static void parse_head(const char *text)
{
    adcgs_http_head head = {.first = ADCGS_HTTP_UNKNOWN, .size = ADCGS_HTTP_UNKNOWN};
    for (const char *end; *text; text = end) {
        end = strchr(text, '\n');
        end = end ? end + 1 : text + strlen(text);
        adcgs_http_head_line(&head, text, (size_t)(end - text));
    }
    FUZZ_REQUIRE(head.first == ADCGS_HTTP_UNKNOWN || (head.first <= head.last && head.last < head.size));
    FUZZ_REQUIRE(memchr(head.tag, 0, sizeof head.tag) && memchr(head.modified, 0, sizeof head.modified));
    FUZZ_REQUIRE(!strpbrk(head.tag, "\r\n") && !strpbrk(head.modified, "\r\n"));
}

/** Texts that are not files. */
static const struct {
    char letter;
    void (*parse)(const char *text);
} texts[] = {
    {'G', parse_grid},     {'F', parse_frames}, {'N', parse_rate},   {'Y', parse_shape},
    {'S', parse_settings}, {'O', parse_spoil},  {'B', parse_budget}, {'H', parse_head},
};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char folder[] = "/tmp/adcgs-fuzz-XXXXXX", path[64];
    adcgs_error error = {ADCGS_OK, ""};
    const char letter = size ? (char)*data : 'C';
    const size_t bytes = size - (size > 0);
    uint8_t *text = fuzz_file(data + (size > 0), bytes);
    for (size_t i = 0; i < ADCGS_COUNTOF(texts); i++)
        if (texts[i].letter == letter)
            texts[i].parse((const char *)text);
    for (size_t i = 0; i < ADCGS_COUNTOF(kinds); i++) {
        if (kinds[i].letter != letter)
            continue;
        FUZZ_REQUIRE(mkdtemp(folder));
        snprintf(path, sizeof path, "%s/%s", folder, kinds[i].name);
        write_outside_file(path, text, bytes);
        check(kinds[i].read(path, &error), &error);
        unlink(path);
        rmdir(folder);
    }
    free(text);
    return 0;
}
