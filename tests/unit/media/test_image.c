/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Images in files: round trips of every format, damage, atomic writing, frame outputs. */
#include "outside_files.h"

#include "media/image/image.h"
#include "media/sink.h"
#include "system/atomic.h"

#include <math.h>

#define WIDTH 37
#define HEIGHT 21

/** 8-bit levels; alpha never 0, so that colours survive premultiplication. */
static void make_image(adcgs_image *image, int channels)
{
    assert_int_equal(adcgs_image_alloc(image, WIDTH, HEIGHT, channels, "picture", &error), ADCGS_OK);
    for (int i = 0; i < WIDTH * HEIGHT * channels; i++)
        image->data[i] = (float)((i * 37 + i / 11 * 5) % 256) / 255.0f;
    for (int i = channels - 1; channels % 2 == 0 && i < WIDTH * HEIGHT * channels; i += channels)
        image->data[i] = (float)(64 + i % 190) / 255.0f;
}

/** Writes, probes and reads; returns the largest difference. */
static double round_trip(const char *name, int channels, int half)
{
    adcgs_image image, back;
    int width, height, stored;
    make_image(&image, channels);
    assert_int_equal(adcgs_image_write(&image, in(name), half, &error), ADCGS_OK);
    assert_int_equal(adcgs_image_probe(&width, &height, &stored, in(name), &error), ADCGS_OK);
    assert_int_equal(adcgs_image_read(&back, in(name), &error), ADCGS_OK);
    assert_true(width == WIDTH && height == HEIGHT && stored == channels);
    assert_true(back.width == WIDTH && back.height == HEIGHT && back.channels == channels);
    double worst = 0.0;
    for (int i = 0; i < WIDTH * HEIGHT * channels; i++)
        worst = fmax(worst, fabs((double)image.data[i] - (double)back.data[i]));
    adcgs_image_free(&image);
    adcgs_image_free(&back);
    unlink(in(name));
    return worst;
}

static void test_round_trips(void **state)
{
    assert_true(round_trip("a.ppm", 3, 0) == 0.0);
    assert_true(round_trip("a.pgm", 1, 0) == 0.0);
    assert_true(round_trip("a.exr", 3, 0) == 0.0);
    assert_true(round_trip("a.exr", 1, 0) == 0.0);
    assert_true(round_trip("a.exr", 4, 0) < 1e-6);
    assert_true(round_trip("a.exr", 3, 1) < 2.5e-4);
    assert_true(round_trip("a.exr", 4, 1) < 2e-3);
    assert_true(round_trip("a.tif", 3, 0) == 0.0);
    assert_true(round_trip("a.tif", 4, 0) == 0.0);
    assert_int_equal(count_files(), 0);
}

static void test_png(void **state)
{
    adcgs_image image;
    make_image(&image, 3);
    const adcgs_status status = adcgs_image_write(&image, in("p.png"), 0, &error);
    adcgs_image_free(&image);
    if (status == ADCGS_ERR_UNSUPPORTED) {
        expect_error(status, ADCGS_ERR_UNSUPPORTED, "p.png", "cannot write .png");
        skip();
    }
    assert_true(round_trip("q.png", 3, 0) == 0.0);
    assert_true(round_trip("q.png", 4, 0) == 0.0);
    assert_true(round_trip("q.png", 2, 0) == 0.0);
    unlink(in("p.png"));
}

static void test_sixteen_bits(void **state)
{
    static const uint8_t file[] = "P5 # a comment\n2\t1 # another\n65535\n\xff\xff\x80\x00";
    adcgs_image image;
    put_bytes("s.pgm", file, sizeof file - 1);
    assert_int_equal(adcgs_image_read(&image, in("s.pgm"), &error), ADCGS_OK);
    assert_true(image.data[0] == 1.0f && image.data[1] == 32768.0f / 65535.0f);
    adcgs_image_free(&image);
}

static void expect_bad(const char *name, const char *text, adcgs_status status, const char *what)
{
    adcgs_image image;
    put_text(name, text);
    expect_error(adcgs_image_read(&image, in(name), &error), status, name, what);
    assert_null(image.data);
}

static void test_damage(void **state)
{
    adcgs_image image;
    expect_bad("d.ppm", "P6\n4 4\n255\n0123456789", ADCGS_ERR_DATA, "ends in row 0");
    expect_bad("d.ppm", "P6\n4 0\n255\n0123456789", ADCGS_ERR_DATA, "header");
    expect_bad("d.ppm", "P6\n4 -4\n255\n0123456789", ADCGS_ERR_DATA, "header");
    expect_bad("d.ppm", "P6\n99999999999 4\n255\n", ADCGS_ERR_DATA, "header");
    expect_bad("d.ppm", "P6\n16385 1\n255\n", ADCGS_ERR_DATA, "16385x1");
    expect_bad("d.ppm", "P6\n99999 99999\n255\n", ADCGS_ERR_DATA, "99999x99999 pixels, expected at most 16384x16384");
    expect_bad("d.ppm", "P6\n4 4\n70000\n", ADCGS_ERR_DATA, "header");
    expect_bad("d.ppm", "P", ADCGS_ERR_DATA, "too short");
    expect_bad("d.exr", "\x76\x2f\x31\x01 and then nothing of use", ADCGS_ERR_DATA, "d.exr");
    expect_bad("d.tif", "II*\001 and then nothing of use", ADCGS_ERR_DATA, "d.tif");
    expect_bad("d", "what is this?", ADCGS_ERR_DATA, "d: a file of unknown kind, expected an image (PNG, ");
    expect_error(adcgs_image_read(&image, in("absent.ppm"), &error), ADCGS_ERR_IO, "absent.ppm", "No such file");
    expect_error(adcgs_image_read(&image, folder, &error), ADCGS_ERR_IO, folder, "");
}

/** Every cut of a good file is either read (by a format that can) or refused, never a crash. */
static void test_cuts(void **state)
{
    static uint8_t bytes[65536];
    adcgs_image image, back;
    make_image(&image, 3);
    const char *names[] = {"c.exr", "c.tif", "c.ppm"};
    for (size_t i = 0; i < ADCGS_COUNTOF(names); i++) {
        assert_int_equal(adcgs_image_write(&image, in(names[i]), 1, &error), ADCGS_OK);
        FILE *file = fopen(in(names[i]), "rb");
        const size_t size = fread(bytes, 1, sizeof bytes, file);
        fclose(file);
        for (size_t cut = 0; cut < size; cut += 1 + size / 60) {
            put_bytes(names[i], bytes, cut);
            if (adcgs_image_read(&back, in(names[i]), &error) == ADCGS_OK)
                adcgs_image_free(&back);
            else
                assert_non_null(strstr(error.text, names[i]));
        }
    }
    adcgs_image_free(&image);
}

/**
 * PNG and JPEG files that end early are refused, as is a PNG file with any byte changed. Additional bytes at the end are valid.
 */
static void test_whole(void **state)
{
    static const char *const names[] = {"w.png", "w.jpg"};
    static uint8_t bytes[65536];
    adcgs_image image, back;
    make_image(&image, 3);
    for (size_t i = 0; i < ADCGS_COUNTOF(names); i++) {
        const adcgs_status status = adcgs_image_write(&image, in(names[i]), 0, &error);
        if (status == ADCGS_ERR_UNSUPPORTED)
            continue;
        assert_int_equal(status, ADCGS_OK);
        FILE *file = fopen(in(names[i]), "rb");
        const size_t size = fread(bytes, 1, sizeof bytes - 1, file);
        fclose(file);
        for (size_t cut = 0; cut < size; cut += cut + 40 < size ? 1 + size / 50 : 1) {
            put_bytes(names[i], bytes, cut);
            expect_error(adcgs_image_read(&back, in(names[i]), &error), ADCGS_ERR_DATA, names[i], "");
        }
        for (size_t at = 8; i == 0 && at < size; at += 1 + size / 50) {
            bytes[at] ^= 0x10;
            put_bytes(names[i], bytes, size);
            expect_error(adcgs_image_read(&back, in(names[i]), &error), ADCGS_ERR_DATA, names[i], "damaged image");
            bytes[at] ^= 0x10;
        }
        put_bytes(names[i], bytes, size + 1);
        assert_int_equal(adcgs_image_read(&back, in(names[i]), &error), ADCGS_OK);
        adcgs_image_free(&back);
    }
    adcgs_image_free(&image);
}

static void test_unwritable(void **state)
{
    adcgs_image image;
    make_image(&image, 3);
    const int before = count_files();
    expect_error(adcgs_image_write(&image, in("no/such/folder.ppm"), 0, &error), ADCGS_ERR_IO, "folder.ppm", "No such file");
    expect_error(adcgs_image_write(&image, in("a.foo"), 0, &error), ADCGS_ERR_UNSUPPORTED, "a.foo", ".foo");
    expect_error(adcgs_image_write(&image, in("noextension"), 0, &error), ADCGS_ERR_USAGE, "noextension", "extension");
    expect_error(adcgs_image_write(&image, folder, 0, &error), ADCGS_ERR_USAGE, folder, "extension");
    assert_int_equal(count_files(), before);
    adcgs_image_free(&image);
}

static void test_to_u8(void **state)
{
    const float values[] = {-1.0f, 0.0f, 0.00196f, 0.00197f, 0.5f, 1.0f, 7.0f, NAN, INFINITY, -INFINITY};
    const uint8_t expected[] = {0, 0, 0, 1, 128, 255, 255, 0, 255, 0};
    uint8_t got[ADCGS_COUNTOF(values)];
    adcgs_image_to_u8(values, ADCGS_COUNTOF(values), got);
    assert_memory_equal(got, expected, sizeof got);
}

static void test_atomic(void **state)
{
    adcgs_atomic atomic;
    put_text("t.txt", "old");
    const int before = count_files();
    assert_int_equal(adcgs_atomic_open(&atomic, in("t.txt"), &error), ADCGS_OK);
    fputs("new text", atomic.file);
    assert_int_equal(count_files(), before + 1);
    adcgs_atomic_abort(&atomic);
    adcgs_atomic_abort(&atomic);
    assert_int_equal(count_files(), before);
    struct stat status;
    assert_int_equal(stat(in("t.txt"), &status), 0);
    assert_int_equal(status.st_size, 3);
    assert_int_equal(adcgs_atomic_open(&atomic, in("t.txt"), &error), ADCGS_OK);
    fputs("new text", atomic.file);
    assert_int_equal(adcgs_atomic_commit(&atomic, &error), ADCGS_OK);
    assert_int_equal(stat(in("t.txt"), &status), 0);
    assert_int_equal(status.st_size, 8);
    assert_int_equal(count_files(), before);
    assert_int_equal(adcgs_atomic_open(&atomic, "/dev/null", &error), ADCGS_OK);
    assert_null(atomic.temporary);
    assert_int_equal(adcgs_atomic_commit(&atomic, &error), ADCGS_OK);
    expect_error(adcgs_atomic_open(&atomic, folder, &error), ADCGS_ERR_IO, folder, "is a folder");
}

static unsigned mode_of(const char *name)
{
    struct stat status;
    assert_int_equal(lstat(in(name), &status), 0);
    return status.st_mode & (S_IFMT | 07777);
}

static void expect_text(const char *name, const char *text)
{
    char held[32] = "";
    FILE *file = fopen(in(name), "rb");
    assert_non_null(file);
    const size_t n = fread(held, 1, sizeof held - 1, file);
    fclose(file);
    held[n] = 0;
    assert_string_equal(held, text);
}

/**
 * A new file has the mode that the umask leaves. A replacing file keeps the other's mode, and a protected file is not replaced.
 */
static void test_modes(void **state)
{
    const mode_t before = umask(027);
    assert_int_equal(adcgs_atomic_save(in("m"), "one", 3, &error), ADCGS_OK);
    assert_int_equal(mode_of("m"), S_IFREG | 0640);
    assert_int_equal(chmod(in("m"), 0604), 0);
    assert_int_equal(adcgs_atomic_save(in("m"), "two", 3, &error), ADCGS_OK);
    assert_int_equal(mode_of("m"), S_IFREG | 0604);
    expect_text("m", "two");
    umask(before);
    assert_int_equal(chmod(in("m"), 0444), 0);
    if (access(in("m"), W_OK)) { /* else we are root, and may */
        expect_error(adcgs_atomic_save(in("m"), "three", 5, &error), ADCGS_ERR_IO, "m", "Permission denied");
        expect_text("m", "two");
    }
}

/** Writing through links, relative ones in another folder too, writes the final target, whether it exists or not. */
static void test_links(void **state)
{
    assert_int_equal(mkdir(in("deep"), 0777), 0);
    put_text("end", "old");
    assert_int_equal(symlink("../end", in("deep/near")), 0);
    assert_int_equal(symlink("deep/near", in("far")), 0);
    assert_int_equal(symlink("none", in("deep/dangling")), 0);
    assert_int_equal(symlink("round", in("round")), 0);
    const int before = count_files();
    assert_int_equal(adcgs_atomic_save(in("far"), "new", 3, &error), ADCGS_OK);
    assert_int_equal(adcgs_atomic_save(in("deep/dangling"), "made", 4, &error), ADCGS_OK);
    assert_true(S_ISLNK(mode_of("far")) && S_ISLNK(mode_of("deep/near")) && S_ISREG(mode_of("end")));
    assert_true(S_ISLNK(mode_of("deep/dangling")) && S_ISREG(mode_of("deep/none")));
    expect_text("end", "new");
    expect_text("deep/none", "made");
    expect_error(adcgs_atomic_save(in("round"), "x", 1, &error), ADCGS_ERR_IO, "round", "symbolic links");
    assert_int_equal(count_files(), before);
}

static void test_same_file(void **state)
{
    put_text("here", "x");
    assert_int_equal(symlink("here", in("there")), 0);
    assert_int_equal(symlink("later", in("soon")), 0);
    assert_true(adcgs_atomic_same(in("here"), in("there")) && adcgs_atomic_same(in("here"), in("./here")));
    assert_true(adcgs_atomic_same(in("later"), in("soon")) && adcgs_atomic_same(in("later"), in("deep/../later")));
    assert_true(!adcgs_atomic_same(in("here"), in("later")) && !adcgs_atomic_same(in("later"), in("never")));
    assert_true(!adcgs_atomic_same(in("later"), in("deep/later")) && !adcgs_atomic_same("/dev/null", "/dev/null"));
}

static void test_full_disk(void **state)
{
    if (access("/dev/full", W_OK))
        skip();
    adcgs_atomic atomic;
    assert_int_equal(adcgs_atomic_open(&atomic, "/dev/full", &error), ADCGS_OK);
    for (int i = 0; i < 100000; i++)
        fputc('x', atomic.file);
    expect_error(adcgs_atomic_commit(&atomic, &error), ADCGS_ERR_IO, "/dev/full", "No space left");
    expect_error(adcgs_atomic_save("/dev/full", "x", 1, &error), ADCGS_ERR_IO, "/dev/full", "No space left");
}

static void test_patterns(void **state)
{
    char text[32];
    assert_int_equal(adcgs_pattern_format("f%04d.png", 12, text, sizeof text), 0);
    assert_string_equal(text, "f0012.png");
    assert_int_equal(adcgs_pattern_format("100%%-%d", 7, text, sizeof text), 0);
    assert_string_equal(text, "100%-7");
    assert_int_equal(adcgs_pattern_format("%s", 1, text, sizeof text), -1);
    assert_int_equal(adcgs_pattern_format("%d%d", 1, text, sizeof text), -1);
    assert_int_equal(adcgs_pattern_format("%99999d", 1, text, sizeof text), -1);
    assert_int_equal(adcgs_pattern_format("%040d", 1, text, sizeof text), -1);
    assert_int_equal(adcgs_pattern_format("a%", 1, text, sizeof text), -1);
    assert_int_equal(adcgs_pattern_places("x%d"), 1);
    assert_int_equal(adcgs_pattern_places("x%%d"), 0);
    assert_int_equal(adcgs_pattern_places("x%n"), -1);
    assert_int_equal(adcgs_pattern_places("x%"), -1);
}

static float pixels[WIDTH * HEIGHT * 3];

static adcgs_status sink_frames(const char *target, const char *format, adcgs_depth depth, int frames)
{
    const adcgs_frame frame = {WIDTH, HEIGHT, pixels};
    const adcgs_sink_config config = {.target = target,
                                      .format = format,
                                      .depth = depth,
                                      .frame_rate = 30.0,
                                      .width = WIDTH,
                                      .height = HEIGHT,
                                      .frames = frames};
    adcgs_sink *sink;
    ADCGS_TRY(adcgs_sink_open(&sink, &config, &error));
    for (int i = 0; i < frames; i++)
        assert_int_equal(adcgs_sink_write(sink, &frame, i, &error), ADCGS_OK);
    return adcgs_sink_close(&sink, &error);
}

static long size_of(const char *name)
{
    struct stat status;
    return stat(in(name), &status) ? -1 : (long)status.st_size;
}

static void test_y4m(void **state)
{
    /* Y, Cb, Cr of black, white, red, green, blue and of values out of range (BT.709, limited). */
    static const float rgb[6][3] = {{0, 0, 0}, {1, 1, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-3, 2, NAN}};
    static const uint8_t expected[6][3] = {{16, 128, 128}, {235, 128, 128}, {63, 102, 240},
                                           {173, 42, 26},  {32, 240, 118},  {173, 42, 26}};
    static const char header[] = "YUV4MPEG2 W37 H21 F30:1 Ip A1:1 C444 XCOLORRANGE=LIMITED\nFRAME\n";
    static uint8_t bytes[65536];
    memcpy(pixels, rgb, sizeof rgb);
    assert_int_equal(sink_frames(in("v.y4m"), NULL, ADCGS_DEPTH_DEFAULT, 3), ADCGS_OK);
    FILE *file = fopen(in("v.y4m"), "rb");
    const size_t n = fread(bytes, 1, sizeof bytes, file), plane = WIDTH * HEIGHT;
    fclose(file);
    assert_int_equal(n, strlen(header) - 6 + 3 * (6 + 3 * plane));
    assert_memory_equal(bytes, header, strlen(header));
    for (size_t i = 0; i < 6; i++)
        for (size_t c = 0; c < 3; c++)
            assert_int_equal(bytes[strlen(header) + c * plane + i], expected[i][c]);
}

static void test_sinks(void **state)
{
    const long n = WIDTH * HEIGHT * 3;
    assert_int_equal(sink_frames(in("r.raw"), NULL, ADCGS_DEPTH_DEFAULT, 2), ADCGS_OK);
    assert_int_equal(size_of("r.raw"), 2 * n);
    assert_int_equal(sink_frames(in("r.bin"), "raw", ADCGS_DEPTH_FLOAT, 2), ADCGS_OK);
    assert_int_equal(size_of("r.bin"), 8 * n);
    assert_int_equal(sink_frames("nothing", "null", ADCGS_DEPTH_DEFAULT, 2), ADCGS_OK);
    assert_int_equal(sink_frames(in("i%03d.ppm"), NULL, ADCGS_DEPTH_DEFAULT, 2), ADCGS_OK);
    assert_true(size_of("i000.ppm") > n && size_of("i001.ppm") > n && size_of("i002.ppm") < 0);
    assert_int_equal(sink_frames(in("one.exr"), NULL, ADCGS_DEPTH_FLOAT, 1), ADCGS_OK);
    expect_error(sink_frames(in("i.ppm"), NULL, ADCGS_DEPTH_DEFAULT, 2), ADCGS_ERR_USAGE, "i.ppm", "%04d");
    expect_error(sink_frames(in("i%s.ppm"), NULL, ADCGS_DEPTH_DEFAULT, 2), ADCGS_ERR_USAGE, "i%s.ppm", "%04d");
    expect_error(sink_frames(in("i%d.ppm"), NULL, ADCGS_DEPTH_FLOAT, 2), ADCGS_ERR_USAGE, "i%d.ppm", "float");
    expect_error(sink_frames(in("i%d.ppm"), NULL, ADCGS_DEPTH_HALF, 2), ADCGS_ERR_USAGE, "i%d.ppm", "half");
    expect_error(sink_frames("-", "png", ADCGS_DEPTH_DEFAULT, 2), ADCGS_ERR_USAGE, "standard output", "png");
    /* A named format has priority over the extension; videos need both. */
    assert_int_equal(sink_frames(in("k.ppm"), NULL, ADCGS_DEPTH_DEFAULT, 1), ADCGS_OK);
    assert_int_equal(sink_frames(in("nameless"), "ppm", ADCGS_DEPTH_DEFAULT, 1), ADCGS_OK);
    assert_int_equal(size_of("nameless"), size_of("k.ppm"));
    expect_error(sink_frames(in("i.ppm"), "mp4", ADCGS_DEPTH_DEFAULT, 1), ADCGS_ERR_USAGE, "i.ppm", ".mp4");
    expect_error(sink_frames(in("noextension"), NULL, ADCGS_DEPTH_DEFAULT, 1), ADCGS_ERR_USAGE, "noextension", ".ppm");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_round_trips), cmocka_unit_test(test_png),      cmocka_unit_test(test_sixteen_bits),
        cmocka_unit_test(test_damage),      cmocka_unit_test(test_cuts),     cmocka_unit_test(test_whole),
        cmocka_unit_test(test_unwritable),  cmocka_unit_test(test_to_u8),    cmocka_unit_test(test_atomic),
        cmocka_unit_test(test_full_disk),   cmocka_unit_test(test_modes),    cmocka_unit_test(test_links),
        cmocka_unit_test(test_same_file),   cmocka_unit_test(test_patterns), cmocka_unit_test(test_y4m),
        cmocka_unit_test(test_sinks),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
