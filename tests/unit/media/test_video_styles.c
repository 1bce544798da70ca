/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Videos in the user's codec, at the user's rate, with alpha. FFmpeg itself decodes the written files. */
#include "outside_files.h"

#include "media/video/video.h"

#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/pixdesc.h>
#include <math.h>

#define expect_good(call)                              \
    do {                                               \
        if ((call) != ADCGS_OK)                        \
            fail_msg("%s: \"%s\"", #call, error.text); \
    } while (0)

enum { W = 64, H = 48, N = 6 };
static float pixels[W * H * 3], coverage[W * H];

/* Suppression for LeakSanitizer: libx265 3.5 leaks a kilobyte per encoder. */
__attribute__((visibility("default"))) const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void)
{
    return "leak:x265";
}

static float straight(int x, int y, int c, int number)
{
    if (c == 1)
        return 0.3f;
    return 0.5f + 0.4f * (c ? cosf(0.05f * (float)y) : sinf(0.07f * (float)x + 0.2f * (float)number));
}

/** A smooth image; with alpha, transparent on the left, opaque on the right, and premultiplied. */
static adcgs_frame paint(int number, int has_alpha)
{
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            coverage[y * W + x] = has_alpha ? (float)x / (W - 1) : 1.0f;
            for (int c = 0; c < 3; c++)
                pixels[3 * (y * W + x) + c] = straight(x, y, c, number) * coverage[y * W + x];
        }
    return (adcgs_frame){W, H, pixels};
}

static adcgs_status write_clip(const char *name, const adcgs_video_style *style)
{
    adcgs_video_writer *w;
    ADCGS_TRY(adcgs_video_write_open(&w, in(name), W, H, 25, style, &error));
    for (int i = 0; i < N; i++) {
        const adcgs_frame frame = paint(i, style->has_alpha);
        expect_good(adcgs_video_write_frame(w, &frame, style->has_alpha ? coverage : NULL, &error));
    }
    return adcgs_video_write_close(&w, &error);
}

static long size_of(const char *name)
{
    FILE *file = fopen(in(name), "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    const long size = ftell(file);
    fclose(file);
    return size;
}

/** The first frame, by the named decoder, or the codec's own. */
static AVFrame *decode(const char *name, const char *decoder, enum AVCodecID *id)
{
    AVFormatContext *f = NULL;
    AVPacket *packet = av_packet_alloc();
    AVFrame *frame = av_frame_alloc();
    assert_int_equal(avformat_open_input(&f, in(name), NULL, NULL), 0);
    *id = f->streams[0]->codecpar->codec_id;
    const AVCodec *const codec = decoder ? avcodec_find_decoder_by_name(decoder) : avcodec_find_decoder(*id);
    assert_non_null(codec);
    AVCodecContext *c = avcodec_alloc_context3(codec);
    avcodec_parameters_to_context(c, f->streams[0]->codecpar);
    assert_int_equal(avcodec_open2(c, codec, NULL), 0);
    int got = 0;
    while (!got) {
        const int more = av_read_frame(f, packet) >= 0;
        avcodec_send_packet(c, more ? packet : NULL);
        av_packet_unref(packet);
        got = !avcodec_receive_frame(c, frame);
        assert_true(got || more);
    }
    avcodec_free_context(&c);
    avformat_close_input(&f);
    av_packet_free(&packet);
    return frame;
}

/** A component's sample, 0 to 1. */
static double sample(const AVFrame *frame, int c, int x, int y)
{
    const AVPixFmtDescriptor *const d = av_pix_fmt_desc_get((enum AVPixelFormat)frame->format);
    uint16_t value;
    av_read_image_line(&value, (const uint8_t **)(uintptr_t)frame->data, frame->linesize, d, x, y, c, 1, 0);
    return value / (double)((1 << d->comp[c].depth) - 1);
}

/* Lossless codecs give the frames rounded to 8 bits, through our reader. */
static void test_lossless(void **state)
{
    static const struct {
        const char *name, *codec;
    } rows[] = {{"a.mkv", "ffv1"}, {"a.mov", "qtrle"}, {"b.mov", "png"}};
    for (size_t i = 0; i < ADCGS_COUNTOF(rows); i++) {
        adcgs_video *video;
        adcgs_image image;
        expect_good(write_clip(rows[i].name, &(adcgs_video_style){.codec = rows[i].codec}));
        expect_good(adcgs_video_open(&video, in(rows[i].name), &error));
        assert_int_equal(adcgs_video_get_info(video)->frames, N);
        for (int f = 0; f < N; f++) {
            expect_good(adcgs_video_read(video, f, &image, &error));
            paint(f, 0);
            for (int n = 0; n < 3 * W * H; n++)
                if (fabsf(image.data[n] - floorf(255.0f * pixels[n] + 0.5f) / 255.0f) > 1e-6f)
                    fail_msg("%s: frame %d, sample %d", rows[i].name, f, n);
            adcgs_image_free(&image);
        }
        adcgs_video_close(&video);
    }
}

/* Alpha is present, with full range, and colours are straight, within the codec's precision. */
static void test_alpha(void **state)
{
    static const struct {
        const char *name, *codec, *decoder;
        int is_rgb;
        double tolerance;
    } rows[] = {{"a.mkv", NULL, NULL, 1, 0.0021}, {"b.mkv", "ffv1", NULL, 1, 0.0021},      {"c.mov", "qtrle", NULL, 1, 0.0021},
                {"d.mov", NULL, NULL, 0, 0.02},   {"e.webm", NULL, "libvpx-vp9", 0, 0.04}, {"f.mov", "png", NULL, 1, 0.0021}};
    for (size_t i = 0; i < ADCGS_COUNTOF(rows); i++) {
        enum AVCodecID id;
        if (write_clip(rows[i].name, &(adcgs_video_style){.codec = rows[i].codec, .has_alpha = 1}) == ADCGS_ERR_UNSUPPORTED) {
            print_message("skipped: %s: %s\n", rows[i].name, error.text);
            continue;
        }
        AVFrame *const frame = decode(rows[i].name, rows[i].decoder, &id);
        const AVPixFmtDescriptor *const d = av_pix_fmt_desc_get((enum AVPixelFormat)frame->format);
        if (!(d->flags & AV_PIX_FMT_FLAG_ALPHA))
            fail_msg("%s: no alpha in %s", rows[i].name, d->name);
        assert_int_equal((d->flags & AV_PIX_FMT_FLAG_RGB) != 0, rows[i].is_rgb);
        for (int y = 0; y < H; y += 5)
            for (int x = 1; x < W; x += 3) {
                const double alpha = (double)x / (W - 1);
                if (fabs(sample(frame, 3, x, y) - alpha) > rows[i].tolerance)
                    fail_msg("%s: alpha %g at %d, expected %g", rows[i].name, sample(frame, 3, x, y), x, alpha);
                for (int c = 0; c < 3 && rows[i].is_rgb; c++)
                    assert_true(fabs(sample(frame, c, x, y) - straight(x, y, c, 0)) < rows[i].tolerance);
                const double luma = 0.2126 * straight(x, y, 0, 0) + 0.7152 * straight(x, y, 1, 0) + 0.0722 * straight(x, y, 2, 0);
                const double least = 16.0 / 255.0, most = 235.0 / 255.0;
                if (!rows[i].is_rgb && fabs((sample(frame, 0, x, y) - least) / (most - least) - luma) > 2 * rows[i].tolerance)
                    fail_msg("%s: luma at %d, %d", rows[i].name, x, y);
            }
        av_frame_free((AVFrame **)(uintptr_t)&frame);
    }
}

/* The requested codec, and the number of bytes that it takes. */
static void test_codecs(void **state)
{
    static const struct {
        const char *name, *codec;
        enum AVCodecID id;
    } rows[] = {{"a.mp4", "h264", AV_CODEC_ID_H264},       {"b.mp4", "hevc", AV_CODEC_ID_HEVC},
                {"c.mkv", "vp9", AV_CODEC_ID_VP9},         {"d.mkv", "av1", AV_CODEC_ID_AV1},
                {"e.avi", "mpeg4", AV_CODEC_ID_MPEG4},     {"f.mov", "prores", AV_CODEC_ID_PRORES},
                {"g.mkv", "libx264rgb", AV_CODEC_ID_H264}, {"h.mkv", "mjpeg", AV_CODEC_ID_MJPEG}};
    for (size_t i = 0; i < ADCGS_COUNTOF(rows); i++) {
        enum AVCodecID id;
        adcgs_video *video;
        if (write_clip(rows[i].name, &(adcgs_video_style){.codec = rows[i].codec}) == ADCGS_ERR_UNSUPPORTED) {
            print_message("skipped: %s: %s\n", rows[i].name, error.text);
            continue;
        }
        AVFrame *frame = decode(rows[i].name, NULL, &id);
        assert_int_equal(id, rows[i].id);
        av_frame_free(&frame);
        expect_good(adcgs_video_open(&video, in(rows[i].name), &error));
        assert_int_equal(adcgs_video_get_info(video)->frames, N);
        adcgs_video_close(&video);
    }
}

static void test_rates(void **state)
{
    expect_good(write_clip("fine.mkv", &(adcgs_video_style){.codec = "vp9", .crf = 10, .has_crf = 1}));
    expect_good(write_clip("coarse.mkv", &(adcgs_video_style){.codec = "vp9", .crf = 60, .has_crf = 1}));
    assert_true(size_of("coarse.mkv") < size_of("fine.mkv"));
    expect_good(write_clip("many.mkv", &(adcgs_video_style){.codec = "vp9", .bit_rate = 4000000}));
    expect_good(write_clip("few.mkv", &(adcgs_video_style){.codec = "vp9", .bit_rate = 10000}));
    assert_true(size_of("few.mkv") < size_of("many.mkv"));
    /* Options are passed on to the encoder, and so is the pixel format. */
    expect_good(write_clip("deep.mkv", &(adcgs_video_style){.codec = "ffv1", .options = "coder=1:pix_fmt=yuv444p16le"}));
    enum AVCodecID id;
    AVFrame *frame = decode("deep.mkv", NULL, &id);
    assert_int_equal(frame->format, AV_PIX_FMT_YUV444P16LE);
    const double luma = 0.2126 * straight(9, 7, 0, 0) + 0.7152 * straight(9, 7, 1, 0) + 0.0722 * straight(9, 7, 2, 0);
    assert_true(fabs(sample(frame, 0, 9, 7) * 65535 / 256 - (16 + 219 * luma)) < 0.01);
    av_frame_free(&frame);
}

static void test_refused(void **state)
{
    static const struct {
        const char *name;
        adcgs_video_style style;
        adcgs_status status;
        const char *text;
    } rows[] = {
        {"a.mp4", {.has_alpha = 1}, ADCGS_ERR_UNSUPPORTED, "no encoder with alpha for .mp4"},
        {"a.mkv", {.has_alpha = 1, .codec = "mpeg4"}, ADCGS_ERR_UNSUPPORTED, "mpeg4 has no alpha"},
        {"a.mp4", {.codec = "ffv1"}, ADCGS_ERR_UNSUPPORTED, ".mp4 files cannot hold ffv1"},
        {"a.mp4", {.codec = "abacus"}, ADCGS_ERR_UNSUPPORTED, "no encoder abacus"},
        {"a.mp4", {.codec = "aac"}, ADCGS_ERR_UNSUPPORTED, "no encoder aac"},
        {"a.avi", {.codec = "mpeg4", .crf = 3, .has_crf = 1}, ADCGS_ERR_USAGE, "the encoder mpeg4 has no option crf"},
        {"a.mkv", {.codec = "ffv1", .options = "nonsense=1"}, ADCGS_ERR_USAGE, "the encoder ffv1 has no option nonsense"},
        {"a.mkv", {.codec = "ffv1", .options = "nonsense"}, ADCGS_ERR_USAGE, "expected NAME=VALUE"},
        {"a.mkv", {.codec = "ffv1", .options = "coder=99"}, ADCGS_ERR_UNSUPPORTED, "cannot encode with these options"},
        {"a.mkv", {.codec = "ffv1", .options = "pix_fmt=pal8"}, ADCGS_ERR_UNSUPPORTED, "does not support pix_fmt=pal8"},
    };
    for (size_t i = 0; i < ADCGS_COUNTOF(rows); i++) {
        adcgs_video_writer *w;
        expect_error(adcgs_video_write_open(&w, in(rows[i].name), W, H, 25, &rows[i].style, &error), rows[i].status, rows[i].name,
                     rows[i].text);
        assert_null(w);
    }
}

int main(void)
{
    av_log_set_level(AV_LOG_QUIET);
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_refused), cmocka_unit_test(test_lossless),
                                       cmocka_unit_test(test_alpha), cmocka_unit_test(test_codecs), cmocka_unit_test(test_rates)};
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
