/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Videos: writing and reading again, damaged files, many at once. */
#include "video_files.h"

#include "base/thread_pool.h"
#include "media/video/video.h"
#include "scene/clips.h"
#include "scene/image_cache.h"
#include "scene/scene.h"

#include <math.h>

#ifdef HAVE_FFMPEG

/* Every container keeps the number of frames, their rate and their content; odd sizes are kept or made even. */
static void test_round_trip(void **state)
{
    static const struct {
        const char *name;
        int width, height, even;
        double rate;
        adcgs_fps exact; /* if the container keeps it */
    } rows[] = {{"a.mp4", 64, 48, 1, 30, {30, 1}},  {"b.mov", 64, 48, 1, 30000 / 1001.0, {30000, 1001}},
                {"c.mkv", 64, 48, 1, 24, {24, 1}},  {"d.avi", 64, 48, 1, 12.5, {25, 2}},
                {"e.webm", 64, 48, 0, 25, {25, 1}}, {"f.mp4", 65, 47, 1, 30, {30, 1}},
                {"g.webm", 65, 47, 0, 30, {30, 1}}};
    for (size_t i = 0; i < ADCGS_COUNTOF(rows); i++) {
        const int w = rows[i].width, h = rows[i].height;
        adcgs_video *video;
        write_clip(rows[i].name, w, h, 20, rows[i].rate);
        expect_good(adcgs_video_open(&video, in(rows[i].name), &error));
        const adcgs_video_info *info = adcgs_video_get_info(video);
        assert_int_equal(info->frames, 20);
        assert_true(info->rate.num == rows[i].exact.num && info->rate.den == rows[i].exact.den);
        assert_true(info->width == w || (rows[i].even && info->width == w + 1));
        assert_true(info->height == h || (rows[i].even && info->height == h + 1));
        for (int f = 0; f < 20; f++) {
            adcgs_image image;
            expect_good(adcgs_video_read(video, f, &image, &error));
            const double quality = psnr(&image, w, h, f);
            if (quality < 40)
                fail_msg("%s: frame %d has %.2f dB", rows[i].name, f, quality);
            if (image.width > w) /* the edge is repeated */
                assert_true(fabsf(image.data[3 * w] - image.data[3 * w - 3]) < 0.05f);
            adcgs_image_free(&image);
        }
        expect_error(adcgs_video_read(video, 20, &(adcgs_image){0}, &error), ADCGS_ERR_DATA, rows[i].name, "frame 20");
        expect_error(adcgs_video_read(video, -1, &(adcgs_image){0}, &error), ADCGS_ERR_DATA, rows[i].name, "frame -1");
        adcgs_video_close(&video);
    }
}

static void test_same_bytes(void **state)
{
    size_t a_bytes, b_bytes;
    write_clip("same.mp4", 64, 48, 12, 30);
    char *a = load_file("same.mp4", &a_bytes);
    write_clip("same.mp4", 64, 48, 12, 30);
    char *b = load_file("same.mp4", &b_bytes);
    assert_int_equal(a_bytes, b_bytes);
    assert_memory_equal(a, b, a_bytes);
    free(a);
    free(b);
}

/* A key frame every two seconds: frames read singly, backwards and in mixed order equal those of one pass. */
static void test_any_order(void **state)
{
    enum { N = 70, W = 48, H = 32 };
    static float all[N][W * H * 3];
    adcgs_video *video;
    adcgs_image image;
    write_clip("long.mp4", W, H, N, 10);
    expect_good(adcgs_video_open(&video, in("long.mp4"), &error));
    for (int i = 0; i < N; i++) {
        expect_good(adcgs_video_read(video, i, &image, &error));
        memcpy(all[i], image.data, sizeof all[i]);
        adcgs_image_free(&image);
    }
    for (int i = 0; i < 3 * N; i++) {
        const int f = i < N ? N - 1 - i : (i * 31) % N;
        expect_good(adcgs_video_read(video, f, &image, &error));
        assert_memory_equal(image.data, all[f], sizeof all[f]);
        adcgs_image_free(&image);
    }
    adcgs_video_close(&video);
}

/* ---- Damage ---- */

static void test_no_video(void **state)
{
    adcgs_video *video;
    char list[600];
    expect_error(adcgs_video_open(&video, in("nowhere.mp4"), &error), ADCGS_ERR_IO, "nowhere.mp4", "No such");
    expect_error(adcgs_video_open(&video, folder, &error), ADCGS_ERR_IO, folder, "regular");
    bad_file("empty.mp4", "", 0);
    bad_file("text.mp4", "this is no video at all\n", 24);
    bad_file("png.mp4", "\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16);
    /* Lists that name other files are not followed. */
    write_clip("good.mp4", 64, 48, 3, 30);
    const int n = snprintf(list, sizeof list, "ffconcat version 1.0\nfile %s\n", in("good.mp4"));
    bad_file("list.mp4", list, (size_t)n);
    const int m =
        snprintf(list, sizeof list, "#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\n%s\n#EXT-X-ENDLIST\n", in("good.mp4"));
    bad_file("list.m3u8", list, (size_t)m);
    /* Declared sizes without data. */
    const char huge[] = "YUV4MPEG2 W30000 H30000 F30:1 Ip A1:1 C420\nFRAME\nabc";
    bad_file("huge.y4m", huge, sizeof huge - 1);
    const char wide[] = "YUV4MPEG2 W2000000000 H2 F30:1 Ip A1:1 C420\nFRAME\nabc";
    bad_file("wide.y4m", wide, sizeof wide - 1);
    const char cut[] = "YUV4MPEG2 W64 H48 F30:1 Ip A1:1 C420\nFRAME\nabc";
    bad_file("cut.y4m", cut, sizeof cut - 1);
}

/* Cut anywhere: existing frames are right, and the errors name the missing ones. */
static void test_truncated(void **state)
{
    static const char *const names[] = {"whole.mp4", "whole.mkv", "whole.avi", "whole.webm"};
    for (size_t i = 0; i < ADCGS_COUNTOF(names); i++) {
        size_t bytes;
        const char *const end = strrchr(names[i], '.');
        char cut[32];
        write_clip(names[i], 64, 48, 16, 30);
        char *data = load_file(names[i], &bytes);
        assert_int_equal(refused(names[i], 16), 0);
        snprintf(cut, sizeof cut, "cut%s", end);
        for (size_t part = 1; part < 16; part++) {
            put_bytes(cut, data, bytes * part / 16);
            assert_true(refused(cut, 16) > 0);
        }
        free(data);
    }
}

/* An index at the start, as for streaming, lists frames that a cut removes. They are counted, and refused by number. */
static void test_listed(void **state)
{
    size_t bytes;
    adcgs_video *video;
    adcgs_image image;
    write_clip("listed.mp4", 64, 48, 16, 30);
    char *data = load_file("listed.mp4", &bytes);
    /* An MP4 with its boxes in another order: ftyp, moov, mdat; offsets of chunks move by the size of moov. */
    size_t moov = 0, mdat = 0, at = 0, size;
    for (; at + 8 <= bytes; at += size) {
        const uint8_t *box = (const uint8_t *)data + at;
        size = (size_t)box[0] << 24 | (size_t)box[1] << 16 | (size_t)box[2] << 8 | box[3];
        assert_true(size >= 8);
        moov = memcmp(box + 4, "moov", 4) ? moov : at;
        mdat = memcmp(box + 4, "mdat", 4) ? mdat : at;
    }
    assert_true(moov > mdat && mdat > 0);
    const size_t head = mdat, media = moov - mdat, index = bytes - moov;
    for (size_t i = moov; i + 16 <= bytes; i++)
        if (!memcmp(data + i, "stco", 4))
            for (uint32_t k = 0; k < (uint8_t)data[i + 11]; k++) {
                uint8_t *p = (uint8_t *)data + i + 12 + 4 * k;
                const uint32_t to = ((uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3]) + (uint32_t)index;
                for (int b = 0; b < 4; b++)
                    p[b] = (uint8_t)(to >> (24 - 8 * b));
            }
    char *moved = malloc(bytes);
    memcpy(moved, data, head);
    memcpy(moved + head, data + moov, index);
    memcpy(moved + head + index, data + mdat, media);
    put_bytes("moved.mp4", moved, bytes);
    assert_int_equal(refused("moved.mp4", 16), 0);
    put_bytes("moved.mp4", moved, head + index + media / 2);
    expect_good(adcgs_video_open(&video, in("moved.mp4"), &error));
    assert_int_equal(adcgs_video_get_info(video)->frames, 16);
    expect_good(adcgs_video_read(video, 0, &image, &error));
    adcgs_image_free(&image);
    expect_error(adcgs_video_read(video, 15, &image, &error), ADCGS_ERR_DATA, "moved.mp4: frame 15", "missing");
    adcgs_video_close(&video);
    assert_true(refused("moved.mp4", 16) > 3);
    free(moved);
    free(data);
}

/* Bytes changed in the middle give only good frames and error messages. */
static void test_damaged(void **state)
{
    size_t bytes;
    int found = 0;
    write_clip("flip.mp4", 64, 48, 16, 30);
    char *data = load_file("flip.mp4", &bytes);
    for (size_t i = 0; i < 40; i++) {
        const size_t at = 8 + i * (bytes - 8) / 40;
        char kept[8];
        adcgs_video *video;
        memcpy(kept, data + at, 8);
        memset(data + at, (int)(0x5a + i), 8);
        put_bytes("flipped.mp4", data, bytes);
        int bad = adcgs_video_open(&video, in("flipped.mp4"), &error) != ADCGS_OK;
        for (int f = 0; !bad && f < adcgs_video_get_info(video)->frames; f++) {
            adcgs_image image;
            bad = adcgs_video_read(video, f, &image, &error) != ADCGS_OK;
            adcgs_image_free(&image);
        }
        adcgs_video_close(&video);
        if (bad)
            assert_non_null(strstr(error.text, "flipped.mp4"));
        found += bad;
        memcpy(data + at, kept, 8);
    }
    assert_true(found > 10);
    free(data);
}

/* ---- Failing writes ---- */

static void test_write_failures(void **state)
{
    adcgs_video_writer *w;
    const int before = count_files();
    expect_error(adcgs_video_write_open(&w, in("x.mpg"), 64, 48, 30, &(const adcgs_video_style){0}, &error),
                 ADCGS_ERR_UNSUPPORTED, "x.mpg", ".webm");
    expect_error(adcgs_video_write_open(&w, in("no/x.mp4"), 64, 48, 30, &(const adcgs_video_style){0}, &error), ADCGS_ERR_IO,
                 "no/x.mp4", "No such");
    expect_error(adcgs_video_write_open(&w, in("x.mp4"), 20000, 48, 30, &(const adcgs_video_style){0}, &error), ADCGS_ERR_USAGE,
                 "x.mp4", "20000");
    expect_error(adcgs_video_write_open(&w, in("x.mp4"), 64, 48, 0, &(const adcgs_video_style){0}, &error), ADCGS_ERR_UNSUPPORTED,
                 "x.mp4", "per second");
    assert_null(w);
    expect_good(adcgs_video_write_open(&w, in("x.mp4"), 64, 48, 30, &(const adcgs_video_style){0}, &error));
    const adcgs_frame wrong = paint(32, 32, 0);
    expect_error(adcgs_video_write_frame(w, &wrong, NULL, &error), ADCGS_ERR_USAGE, "x.mp4", "32x32");
    expect_error(adcgs_video_write_close(&w, &error), ADCGS_ERR_USAGE, "x.mp4", "without a frame");
    expect_good(adcgs_video_write_open(&w, in("x.mp4"), 64, 48, 30, &(const adcgs_video_style){0}, &error));
    const adcgs_frame frame = paint(64, 48, 0);
    expect_good(adcgs_video_write_frame(w, &frame, NULL, &error));
    adcgs_video_write_abort(&w);
    assert_null(w);
    assert_int_equal(count_files(), before);
    if (!access("/dev/full", W_OK)) { /* a link with the right name */
        assert_int_equal(symlink("/dev/full", in("full.mkv")), 0);
        adcgs_status status = adcgs_video_write_open(&w, in("full.mkv"), 64, 48, 30, &(const adcgs_video_style){0}, &error);
        if (status == ADCGS_OK && (status = adcgs_video_write_frame(w, &frame, NULL, &error)) == ADCGS_OK)
            status = adcgs_video_write_close(&w, &error);
        adcgs_video_write_abort(&w);
        expect_error(status, ADCGS_ERR_IO, "full.mkv", "No space left");
    }
}

/* ---- Many at once ---- */

enum { VIDEOS = ADCGS_CLIPS_OPEN + 5, FRAMES = 8 };
static char paths[VIDEOS][300];
static adcgs_scene_view views[VIDEOS * FRAMES];

/** Copies of one clip under many names, and the views of all frames, ordered by time and then by video. */
static adcgs_clips *make_views(void)
{
    size_t bytes;
    adcgs_clips *clips;
    write_clip("v.mp4", 32, 32, FRAMES, 30);
    char *data = load_file("v.mp4", &bytes);
    for (int v = 0; v < VIDEOS; v++) {
        char name[20];
        snprintf(name, sizeof name, "v%d.mp4", v);
        put_bytes(name, data, bytes);
        snprintf(paths[v], sizeof paths[v], "%s", in(name));
    }
    free(data);
    for (int i = 0; i < VIDEOS * FRAMES; i++)
        views[i] = (adcgs_scene_view){.path = paths[i % VIDEOS],
                                      .is_video = 1,
                                      .frame = i / VIDEOS,
                                      .camera = {.width = 32, .height = 32}};
    expect_good(adcgs_clips_create(&clips, &error));
    return clips;
}

typedef struct load_job {
    adcgs_scene scene;
    adcgs_view_runs runs;
    int one_by_one, bad;
} load_job;

static int good_view(const load_job *job, uint32_t view)
{
    float *rgb;
    if (adcgs_scene_image(&job->scene, &views[view], 1, &rgb, NULL, NULL) != ADCGS_OK)
        return 0;
    double green = 0;
    for (int i = 0; i < 1024; i++)
        green += (double)rgb[1024 + i] / 1024;
    free(rgb);
    return fabs(green - 0.2 - 0.01 * (double)views[view].frame) < 0.004;
}

static void load_some(void *arg, int i, int thread)
{
    load_job *job = arg;
    if (job->one_by_one)
        job->bad |= !good_view(job, (uint32_t)i);
    else
        for (uint32_t v = job->runs.begin[i]; v < job->runs.begin[i + 1]; v++)
            job->bad |= !good_view(job, job->runs.order[v]);
}

/* By runs or one by one, from several threads, with more videos than may be open: each view gets its frame. */
static void test_clips(void **state)
{
    adcgs_pool *pool;
    load_job job = {.scene = {.clips = make_views()}};
    expect_good(adcgs_pool_create(&pool, 4, &error));
    expect_good(adcgs_view_runs_make(&job.runs, views, VIDEOS * FRAMES, &error));
    assert_int_equal(job.runs.n, VIDEOS);
    for (uint32_t r = 0; r < job.runs.n; r++)
        for (uint32_t v = job.runs.begin[r], f = 0; v < job.runs.begin[r + 1]; v++, f++) {
            assert_int_equal(views[job.runs.order[v]].frame, f);
            assert_ptr_equal(views[job.runs.order[v]].path, views[job.runs.order[job.runs.begin[r]]].path);
        }
    adcgs_pool_run(pool, load_some, &job, (int)job.runs.n);
    assert_false(job.bad);
    job.one_by_one = 1;
    adcgs_pool_run(pool, load_some, &job, VIDEOS * FRAMES);
    assert_false(job.bad);
    views[0].frame = FRAMES;
    assert_false(good_view(&job, 0));
    adcgs_view_runs_clear(&job.runs);
    adcgs_clips_free(&job.scene.clips);
    adcgs_pool_free(&pool);
}

/** Frames that the scene keeps equal those of the video, and are not decoded again. */
static void test_kept_frames(void **state)
{
    adcgs_scene scene = {.clips = make_views()};
    adcgs_scene direct = scene;
    uint64_t decoded, kept;
    expect_good(adcgs_image_cache_create(&scene.images, &error));
    adcgs_image_cache_limit(scene.images, 1 << 20);
    for (int divide = 1; divide <= 4; divide++)
        for (int i = 0; i < VIDEOS * FRAMES; i += VIDEOS) {
            float *got, *want;
            const size_t side = (size_t)((32 + divide - 1) / divide);
            expect_good(adcgs_scene_image(&scene, &views[i], divide, &got, NULL, &error));
            expect_good(adcgs_scene_image(&direct, &views[i], divide, &want, NULL, &error));
            assert_memory_equal(got, want, 3 * side * side * sizeof *got);
            free(got);
            free(want);
        }
    adcgs_image_cache_facts(scene.images, &decoded, &kept);
    assert_int_equal(decoded, FRAMES);
    adcgs_image_cache_free(&scene.images);
    adcgs_clips_free(&scene.clips);
}

#else

static void test_without(void **state)
{
    adcgs_video *video;
    adcgs_video_writer *writer;
    expect_error(adcgs_video_open(&video, in("a.mp4"), &error), ADCGS_ERR_UNSUPPORTED, "a.mp4", "FFmpeg");
    expect_error(adcgs_video_write_open(&writer, in("a.mp4"), 64, 48, 30, &(const adcgs_video_style){0}, &error),
                 ADCGS_ERR_UNSUPPORTED, "a.mp4", "FFmpeg");
    assert_int_equal(count_files(), 0);
}

#endif

static void test_names(void **state)
{
    assert_true(adcgs_is_video("a/b.mp4") && adcgs_is_video("B.MKV") && adcgs_is_video("x.y.webm"));
    assert_false(adcgs_is_video("a.png") || adcgs_is_video("mp4") || adcgs_is_video("a.mp4/b") || adcgs_is_video("a.y4m"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_names),
#ifdef HAVE_FFMPEG
        cmocka_unit_test(test_round_trip),  cmocka_unit_test(test_same_bytes),     cmocka_unit_test(test_any_order),
        cmocka_unit_test(test_no_video),    cmocka_unit_test(test_truncated),      cmocka_unit_test(test_listed),
        cmocka_unit_test(test_damaged),     cmocka_unit_test(test_write_failures), cmocka_unit_test(test_clips),
        cmocka_unit_test(test_kept_frames),
#else
        cmocka_unit_test(test_without),
#endif
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
