/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Videos from other encoders: codecs, bit depths, colours, shapes, start positions. */
#include "video_clips.h"

#include "media/video/video.h"

#define expect_good(call)                              \
    do {                                               \
        if ((call) != ADCGS_OK)                        \
            fail_msg("%s: \"%s\"", #call, error.text); \
    } while (0)

/* Suppression for LeakSanitizer: libx265 3.5 leaks a kilobyte per encoder. */
__attribute__((visibility("default"))) const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void)
{
    return "leak:x265";
}

/** The largest difference between an image and the samples' true values. */
static double worst(const adcgs_image *image, const geometry *g, sample_fn sample, const void *user)
{
    double most = 0;
    for (int y = 0; y < g->height; y++)
        for (int x = 0; x < g->width; x++) {
            double rgb[3];
            true_pixel(g, sample, user, x, y, rgb);
            for (int c = 0; c < 3; c++)
                most = fmax(most, fabs(rgb[c] - image->data[3 * (y * g->width + x) + c]));
        }
    return most;
}

/* Without loss, pixels equal the formulae for each matrix, range, depth and kind of chroma. */
static void test_colours(void **state)
{
    static const struct {
        recipe clip;
        double red, blue;
    } rows[] = {
        {{"a.mkv", "ffv1", "", AV_PIX_FMT_YUV420P, 60, 38, 3, AVCOL_SPC_BT709, AVCOL_RANGE_MPEG, {0, 1}, 0}, 0.2126, 0.0722},
        {{"b.mkv", "ffv1", "", AV_PIX_FMT_YUV420P, 61, 39, 2, AVCOL_SPC_UNSPECIFIED, AVCOL_RANGE_UNSPECIFIED, {0, 1}, 0},
         0.299,
         0.114},
        {{"c.mkv", "ffv1", "", AV_PIX_FMT_YUV422P, 60, 38, 2, AVCOL_SPC_SMPTE170M, AVCOL_RANGE_JPEG, {0, 1}, 0}, 0.299, 0.114},
        {{"d.mkv", "ffv1", "", AV_PIX_FMT_YUV420P10LE, 60, 38, 2, AVCOL_SPC_BT2020_NCL, AVCOL_RANGE_MPEG, {0, 1}, 0},
         0.2627,
         0.0593},
        {{"e.mkv", "ffv1", "", AV_PIX_FMT_YUV444P12LE, 60, 38, 2, AVCOL_SPC_BT709, AVCOL_RANGE_JPEG, {0, 1}, 0}, 0.2126, 0.0722},
        {{"f.mkv", "ffv1", "", AV_PIX_FMT_YUV420P, 1280, 16, 1, AVCOL_SPC_UNSPECIFIED, AVCOL_RANGE_UNSPECIFIED, {0, 1}, 0},
         0.2126,
         0.0722},
        {{"g.mkv", "libx264", "qp=0", AV_PIX_FMT_YUV420P, 60, 38, 30, AVCOL_SPC_BT709, AVCOL_RANGE_MPEG, {0, 1}, 0},
         0.2126,
         0.0722},
        {{"h.mp4", "libx264", "qp=0", AV_PIX_FMT_YUV420P10LE, 60, 38, 30, AVCOL_SPC_BT709, AVCOL_RANGE_MPEG, {0, 1}, 0},
         0.2126,
         0.0722},
    };
    for (size_t i = 0; i < ADCGS_COUNTOF(rows); i++) {
        const recipe *r = &rows[i].clip;
        const AVPixFmtDescriptor *d = av_pix_fmt_desc_get(r->format);
        const geometry g = {r->width,
                            r->height,
                            1 << d->log2_chroma_w,
                            1 << d->log2_chroma_h,
                            d->comp[0].depth,
                            r->range == AVCOL_RANGE_JPEG,
                            rows[i].red,
                            rows[i].blue};
        adcgs_video *video;
        if (!make_clip(r)) {
            print_message("skipped: no encoder %s\n", r->encoder);
            continue;
        }
        expect_good(adcgs_video_open(&video, in(r->name), &error));
        assert_int_equal(adcgs_video_get_info(video)->frames, r->frames);
        for (int f = r->frames - 1; f >= 0; f -= 7) {
            adcgs_image image;
            const painted p = {g.depth, f};
            expect_good(adcgs_video_read(video, f, &image, &error));
            const double most = worst(&image, &g, painted_sample, &p);
            if (most > 2e-6)
                fail_msg("%s: frame %d is off by %g", r->name, f, most);
            adcgs_image_free(&image);
        }
        adcgs_video_close(&video);
    }
}

/* RGB and grey pass unchanged. */
static void test_rgb(void **state)
{
    static const recipe clips[] =
        {{"rgb.mkv", "ffv1", "", AV_PIX_FMT_GBRP10LE, 30, 20, 2, AVCOL_SPC_RGB, AVCOL_RANGE_JPEG, {0, 1}, 0},
         {"grey.mkv", "ffv1", "", AV_PIX_FMT_GRAY8, 30, 20, 2, AVCOL_SPC_UNSPECIFIED, AVCOL_RANGE_JPEG, {0, 1}, 0}};
    for (size_t i = 0; i < ADCGS_COUNTOF(clips); i++) {
        adcgs_video *video;
        adcgs_image image;
        const int depth = av_pix_fmt_desc_get(clips[i].format)->comp[0].depth;
        assert_true(make_clip(&clips[i]));
        expect_good(adcgs_video_open(&video, in(clips[i].name), &error));
        expect_good(adcgs_video_read(video, 1, &image, &error));
        for (int n = 0; n < 30 * 20; n++)
            for (int c = 0; c < 3; c++) {
                const double v = sample_at(depth, i ? 0 : c, n % 30, n / 30, 1) / (double)((1 << depth) - 1);
                assert_true(fabs(image.data[3 * n + c] - v) < 1e-6);
            }
        adcgs_image_free(&image);
        adcgs_video_close(&video);
    }
}

/** Frames read in any order equal those read from the start, bit for bit. */
static void any_order(const char *name, int frames)
{
    adcgs_video *video;
    adcgs_image *all = calloc((size_t)frames, sizeof *all);
    expect_good(adcgs_video_open(&video, in(name), &error));
    assert_int_equal(adcgs_video_get_info(video)->frames, frames);
    for (int i = 0; i < frames; i++)
        expect_good(adcgs_video_read(video, i, &all[i], &error));
    for (int i = 0; i < 2 * frames; i++) {
        const int f = i < frames ? frames - 1 - i : (i * 37 + 5) % frames;
        adcgs_image image;
        if (adcgs_video_read(video, f, &image, &error) != ADCGS_OK)
            fail_msg("%s, frame %d: %s", name, f, error.text);
        if (memcmp(image.data, all[f].data, 3 * sizeof(float) * (size_t)image.width * (size_t)image.height))
            fail_msg("%s: frame %d differs", name, f);
        adcgs_image_free(&image);
    }
    for (int i = 1; i < frames; i++) /* no frame twice */
        assert_int_not_equal(memcmp(all[i].data, all[i - 1].data, sizeof(float) * 3000), 0);
    for (int i = 0; i < frames; i++)
        adcgs_image_free(&all[i]);
    free(all);
    adcgs_video_close(&video);
}

static void test_codecs(void **state)
{
    static const struct {
        const char *name, *encoder, *options;
        enum AVPixelFormat format;
        int frames;
    } rows[] = {
        {"x264.mp4", "libx264", "crf=20:bf=3", AV_PIX_FMT_YUV420P, 40},
        {"x264.mkv", "libx264", "crf=20:bf=3:x264-params=open-gop=1", AV_PIX_FMT_YUV420P, 40},
        {"x264.ts", "libx264", "crf=20:bf=3:x264-params=open-gop=1", AV_PIX_FMT_YUV420P, 40},
        {"refresh.ts", "libx264", "crf=20:bf=0:x264-params=intra-refresh=1", AV_PIX_FMT_YUV420P, 40},
        {"x264.avi", "libx264", "crf=20:bf=0", AV_PIX_FMT_YUV420P, 40},
        {"x264.h264", "libx264", "crf=20:bf=3", AV_PIX_FMT_YUV420P, 40},
        {"x265.mp4", "libx265", "crf=20:x265-params=log-level=none", AV_PIX_FMT_YUV420P10LE, 40},
        {"vp9.webm", "libvpx-vp9", "crf=20:b=0:cpu-used=5:auto-alt-ref=1:lag-in-frames=12", AV_PIX_FMT_YUV420P, 40},
        {"vp8.webm", "libvpx", "crf=20:b=1M:cpu-used=5:auto-alt-ref=1:lag-in-frames=12", AV_PIX_FMT_YUV420P, 40},
        {"av1.mp4", "libaom-av1", "crf=20:b=0:cpu-used=8", AV_PIX_FMT_YUV420P, 20},
        {"mpeg4.avi", "mpeg4", "bf=2", AV_PIX_FMT_YUV420P, 40},
        {"mpeg2.mpg", "mpeg2video", "bf=2", AV_PIX_FMT_YUV420P, 40},
        {"mjpeg.avi", "mjpeg", "strict=-1", AV_PIX_FMT_YUVJ420P, 20},
    };
    for (size_t i = 0; i < ADCGS_COUNTOF(rows); i++) {
        const recipe clip = {.name = rows[i].name,
                             .encoder = rows[i].encoder,
                             .options = rows[i].options,
                             .format = rows[i].format,
                             .width = 64,
                             .height = 48,
                             .frames = rows[i].frames,
                             .aspect = {0, 1}};
        if (make_clip(&clip))
            any_order(clip.name, clip.frames);
        else
            print_message("skipped: no encoder %s\n", clip.encoder);
    }
}

/* A quarter turn clockwise moves the left side to the top. Pixels twice as wide as high become square. */
static void test_shape(void **state)
{
    const recipe plain = {"plain.mov", "mpeg4", "b=9M", AV_PIX_FMT_YUV420P, 60, 38, 3, 0, 0, {0, 1}, 0};
    recipe turned = plain, wide = plain;
    turned.name = "turned.mov";
    turned.turn = 90;
    wide.name = "wide.mkv";
    wide.aspect = (AVRational){2, 1};
    adcgs_video *video;
    adcgs_image a, b, c;
    assert_true(make_clip(&plain) && make_clip(&turned) && make_clip(&wide));
    expect_good(adcgs_video_open(&video, in(plain.name), &error));
    expect_good(adcgs_video_read(video, 2, &a, &error));
    adcgs_video_close(&video);
    expect_good(adcgs_video_open(&video, in(turned.name), &error));
    assert_int_equal(adcgs_video_get_info(video)->width, 38);
    assert_int_equal(adcgs_video_get_info(video)->height, 60);
    expect_good(adcgs_video_read(video, 2, &b, &error));
    adcgs_video_close(&video);
    for (int y = 0; y < 38; y++)
        for (int x = 0; x < 60; x++)
            assert_memory_equal(a.data + 3 * (y * 60 + x), b.data + 3 * (x * 38 + 37 - y), 3 * sizeof(float));
    expect_good(adcgs_video_open(&video, in(wide.name), &error));
    assert_int_equal(adcgs_video_get_info(video)->width, 120);
    assert_int_equal(adcgs_video_get_info(video)->height, 38);
    expect_good(adcgs_video_read(video, 2, &c, &error));
    adcgs_video_close(&video);
    for (int x = 1; x < 59; x++) /* halfway between the pixels 2x and 2x + 1 is the pixel x */
        for (int k = 0; k < 3; k++) {
            const float *from = a.data + 3 * x + k, *to = c.data + 6 * x + k;
            assert_true(fabs(0.5 * (to[0] + to[3]) - (0.125 * from[-3] + 0.75 * from[0] + 0.125 * from[3])) < 1e-6);
        }
    adcgs_image_free(&a);
    adcgs_image_free(&b);
    adcgs_image_free(&c);
}

/* ---- A clip of another encoder, against its samples as FFmpeg decodes them from start to end ---- */

static double frame_sample(const void *user, int plane, int x, int y)
{
    const AVFrame *f = user;
    return f->data[plane][(ptrdiff_t)y * f->linesize[plane] + x];
}

/** The nth frame that the decoder returns. */
static AVFrame *decode_plainly(const char *path, int nth)
{
    AVFormatContext *f = NULL;
    AVFrame *frame = av_frame_alloc();
    AVPacket *packet = av_packet_alloc();
    assert_int_equal(avformat_open_input(&f, path, NULL, NULL), 0);
    assert_true(avformat_find_stream_info(f, NULL) >= 0);
    AVCodecContext *c = avcodec_alloc_context3(avcodec_find_decoder(f->streams[0]->codecpar->codec_id));
    avcodec_parameters_to_context(c, f->streams[0]->codecpar);
    assert_int_equal(avcodec_open2(c, NULL, NULL), 0);
    for (int found = -1; found < nth;) {
        if (av_read_frame(f, packet) < 0)
            avcodec_send_packet(c, NULL);
        else if (packet->stream_index == 0)
            avcodec_send_packet(c, packet);
        av_packet_unref(packet);
        while (found < nth && !avcodec_receive_frame(c, frame))
            found++;
    }
    avcodec_free_context(&c);
    avformat_close_input(&f);
    av_packet_free(&packet);
    return frame;
}

static void test_real(void **state)
{
    const char *path = real_data("synth_robot_multiview/cam03.mp4");
    const geometry g = {352, 264, 2, 2, 8, 0, 0.2126, 0.0722};
    adcgs_video *video;
    expect_good(adcgs_video_open(&video, path, &error));
    const adcgs_video_info *info = adcgs_video_get_info(video);
    assert_true(info->width == 352 && info->height == 264 && info->frames == 16 && info->rate.num == 30 && info->rate.den == 1);
    for (int f = 15; f >= 0; f -= 5) {
        adcgs_image image;
        AVFrame *frame = decode_plainly(path, f);
        expect_good(adcgs_video_read(video, f, &image, &error));
        assert_true(worst(&image, &g, frame_sample, frame) < 2e-6);
        adcgs_image_free(&image);
        av_frame_free(&frame);
    }
    adcgs_video_close(&video);
}

int main(void)
{
    av_log_set_level(AV_LOG_QUIET);
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_colours), cmocka_unit_test(test_rgb), cmocka_unit_test(test_codecs),
                                       cmocka_unit_test(test_shape), cmocka_unit_test(test_real)};
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
