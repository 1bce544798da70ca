/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Kinds of files by their first bytes. Images are read by the reader of their kind, and no other file is opened. */
#include "outside_files.h"

#include "media/image/image.h"
#include "media/kind.h"
#include "media/splats/splats.h"
#include "scene/layouts/open.h"

#include <math.h>
#ifdef __linux__
#include <sys/inotify.h>
#endif

#define BYTES(text) text, sizeof text - 1

/* LeakSanitizer calls this: libx265, which makes the test's HEIC image, keeps memory of its own. */
const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void)
{
    return "leak:libx265";
}

/** The kind of a file with these first n bytes and zeros up to `size`. */
static const adcgs_kind *kind_of(const char *name, const char *bytes, size_t n, size_t size)
{
    static uint8_t begin[ADCGS_KIND_BYTES];
    memset(begin, 0, sizeof begin);
    memcpy(begin, bytes, n);
    return adcgs_kind_of(begin, size < sizeof begin ? size : sizeof begin, size, NULL, name);
}

/** The first bytes of a file, and its kind. */
typedef struct kind_case {
    const char *name, *bytes;
    size_t n;
    const char *kind;
    adcgs_kind_class class;
} kind_case;

/** Each file is of its kind, and each of its beginnings of some kind. */
static void expect_kinds(const kind_case *cases, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        const adcgs_kind *const kind = kind_of(cases[i].name, cases[i].bytes, cases[i].n, cases[i].n);
        if (strcmp(kind->name, cases[i].kind) || kind->class != cases[i].class)
            fail_msg("case %zu: %s, expected %s", i, kind->name, cases[i].kind);
        for (size_t cut = 0; cut < cases[i].n; cut++)
            assert_non_null(kind_of(cases[i].name, cases[i].bytes, cut, cut)->name);
    }
}

static void test_names_of_pictures(void **state)
{
    static const kind_case cases[] = {
        {"a.png", BYTES("\xff\xd8\xff\xe0"), "a JPEG image", ADCGS_KIND_IMAGE},
        {"a", BYTES("RIFF\1\2\3\4WEBPVP8 "), "a WebP image", ADCGS_KIND_IMAGE},
        {"a", BYTES("II*\0\x08\0\0\0\0\0"), "a TIFF image", ADCGS_KIND_IMAGE},
        {"a", BYTES("MM\0+\0\x08\0\0"), "a TIFF image", ADCGS_KIND_IMAGE},
        {"a.NEF", BYTES("MM\0*\0\0\0\x08\0\0"), "a raw image of a camera", ADCGS_KIND_IMAGE},
        {"a", BYTES("II*\0\x10\0\0\0CR\2\0"), "a raw image of a camera", ADCGS_KIND_IMAGE},
        {"a", BYTES("II*\0\x08\0\0\0\1\0\xfe\0\4\0\1\0\0\0\1\0\0\0"), "a raw image of a camera", ADCGS_KIND_IMAGE},
        {"a", BYTES("MM\0*\0\0\0\x08\0\1\xc6\x12\0\1\0\0\0\4\1\4\0\0"), "a raw image (DNG)", ADCGS_KIND_IMAGE},
        {"a",
         BYTES("\0\0\0\x18"
               "ftypcrx "),
         "a raw image of a camera (CR3)", ADCGS_KIND_IMAGE},
        {"a",
         BYTES("\0\0\0\x18"
               "ftypheic\0\0\0\0mif1heic"),
         "an HEIC image", ADCGS_KIND_IMAGE},
        {"a",
         BYTES("\0\0\0\x18"
               "ftypmif1\0\0\0\0mif1avif"),
         "an AVIF image", ADCGS_KIND_IMAGE},
        {"a",
         BYTES("\0\0\0\x18"
               "ftypisom\0\0\0\0isomavc1"),
         "a video (MP4 or QuickTime)", ADCGS_KIND_VIDEO},
        {"a.jpg", BYTES("\0\0\0\x08wide\0\0\0\0mdat"), "a video (MP4 or QuickTime)", ADCGS_KIND_VIDEO},
        {"VID_0.INSV",
         BYTES("\0\0\0\x18"
               "ftypavc1"),
         "a video of two fisheyes (Insta360)", ADCGS_KIND_VIDEO},
        {"a", BYTES("\x1a\x45\xdf\xa3"), "a video (Matroska or WebM)", ADCGS_KIND_VIDEO},
        {"a", BYTES("RIFF\1\2\3\4AVI LIST"), "a video (AVI)", ADCGS_KIND_VIDEO},
        {"a", BYTES("YUV4MPEG2 W4"), "a video (YUV4MPEG2)", ADCGS_KIND_VIDEO},
        {"a", BYTES("ffconcat version 1.0\nfile b.mp4\n"), "a playlist (ffconcat)", ADCGS_KIND_OTHER},
        {"a", BYTES("#EXTM3U\n#EXTINF:1,\nb.ts\n"), "a playlist (M3U, HLS)", ADCGS_KIND_OTHER},
        {"a", BYTES("BM\0\1\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\1\0\0\0\1\0\0\0"), "a BMP image", ADCGS_KIND_IMAGE},
        {"a", BYTES("P4\n1 1\n"), "a PBM, PGM, PPM or PFM image", ADCGS_KIND_IMAGE},
        {"a", BYTES("8BPS\0\1"), "a Photoshop document", ADCGS_KIND_IMAGE},
    };
    expect_kinds(cases, ADCGS_COUNTOF(cases));
}

static void test_names_of_splats(void **state)
{
    static const kind_case cases[] = {
        {"a",
         BYTES("\x8b"
               "ADC\r\n\x1a\n"),
         "an adcgs stream", ADCGS_KIND_STREAM},
        {"a", BYTES("<!DOCTYPE html>\n<!-- SPDX-License-Identifier: BSD-2-Clause -->\n<html"), "a page of adcgs-share",
         ADCGS_KIND_PAGE},
        {"a", BYTES("\xef\xbb\xbf <html lang=\"de\">"), "a page (HTML)", ADCGS_KIND_PAGE},
        {"a", BYTES("NGSP\4"), "splats (SPZ)", ADCGS_KIND_SPLATS},
        {"a", BYTES("glTF\2\0\0\0"), "a glTF binary file (GLB)", ADCGS_KIND_SPLATS},
        {"a", BYTES("ply\nformat ascii 1.0\nelement vertex 1\nproperty float f_dc_0\n"), "splats (PLY)", ADCGS_KIND_SPLATS},
        {"a", BYTES("ply\r\nformat ascii 1.0\r\n"), "a PLY file", ADCGS_KIND_SPLATS},
        {"a", BYTES("Kg\0\0\xe9\0\0\0[{"), "splats over time (.splatv)", ADCGS_KIND_SPLATS},
        {"a",
         BYTES("\x89"
               "4DGS0\r\n"),
         "splats over time (.4dgs)", ADCGS_KIND_SPLATS},
        {"a", BYTES("SP4D\1\0\0\0"), "splats over time (.splat4d)", ADCGS_KIND_SPLATS},
        {"a", BYTES("ply\nformat ascii 1.0\nelement vertex 1\nproperty float f_dc_0\nproperty float trbf_center\n"),
         "splats over time (SpacetimeGaussians PLY)", ADCGS_KIND_SPLATS},
        {"a", BYTES("ply\nformat ascii 1.0\ncomment ftgs_version 1\n"), "splats over time (FTGS PLY)", ADCGS_KIND_SPLATS},
        {"a.tsog", BYTES("PK\3\4\x14\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x0c\0\0\0means_l.webp"), "splats over time (TSOG)",
         ADCGS_KIND_SPLATS},
        {"a", BYTES("PK\3\4 meta.json{\"version\":4,\"profile\":{\"id\":\"org.opsiclear.tsog-playback\""),
         "splats over time (TSOG)", ADCGS_KIND_SPLATS},
        {"a", BYTES("PK\3\4 means3D.npy"), "splats over time (params.npz of Dynamic 3D Gaussians)", ADCGS_KIND_SPLATS},
        {"a.zip", BYTES("PK\3\4\x14\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x05\0\0\0b.png"), "an archive (ZIP)",
         ADCGS_KIND_OTHER},
        {"a.sog", BYTES("PK\3\4\x14\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x0c\0\0\0means_l.webp"), "splats (SOG)",
         ADCGS_KIND_SPLATS},
        {"a", BYTES("PK\3\4\x14 scales.webp"), "splats (SOG)", ADCGS_KIND_SPLATS},
        {"meta.json", BYTES("\xef\xbb\xbf {\"version\":2,\"means\":{\"mins\":[0,0,0],\"files\":[\"a.webp\",\"b.webp\"]"),
         "splats (meta.json of SOG)", ADCGS_KIND_SPLATS},
        {"a", BYTES("PK\3\4 params.npy"), "arrays of NumPy (NPZ)", ADCGS_KIND_OTHER},
        {"a", BYTES("LASF"), "a point cloud (LAS or LAZ)", ADCGS_KIND_POINTS},
    };
    expect_kinds(cases, ADCGS_COUNTOF(cases));
}

static void test_names_of_texts(void **state)
{
    static const kind_case cases[] = {
        {"a", BYTES("{\"w\":1,\"h\":1,\"K\":[1],\"poses\":[[1]]}"), "Record3D's metadata.json", ADCGS_KIND_SCENE},
        {"a", BYTES("{\"poses\":[["), "Record3D's metadata.json", ADCGS_KIND_SCENE},
        {"a", BYTES("{\"w\":1,\"h\":1,\"k\":[],\"w2c\":[],\"fn\":[]}"), "the cameras of a scene (JSON)", ADCGS_KIND_SCENE},
        {"a", BYTES("[{\"id\":0,\"img_name\":\"a\",\"position\":[],\"rotation\":[]}]"),
         "cameras.json as 3D Gaussian splatting writes it", ADCGS_KIND_SCENE},
        {"a", BYTES("{\"camera_angle_x\":1,\"frames\":[{\"transform_matrix\":"), "the cameras of a scene (JSON)",
         ADCGS_KIND_SCENE},
        {"a", BYTES("{\"K\":1,\"poses\":2,\"frames\":[]}"), "a file of unknown kind", ADCGS_KIND_UNKNOWN},
        {"a", BYTES("<?xml version=\"1.0\"?>\n<document version=\"2.0.0\">\n<chunk label=\"a\">"),
         "Agisoft Metashape's cameras (XML)", ADCGS_KIND_SCENE},
        {"a", BYTES("<?xml version=\"1.0\"?>\n<b/>"), "an XML text", ADCGS_KIND_OTHER},
        {"a", BYTES("#name,x,y,alt\na,1,2,3\n"), "RealityCapture's cameras (CSV)", ADCGS_KIND_SCENE},
        {"a", BYTES("name;b,x,y\na,1,2\n"), "a table (CSV)", ADCGS_KIND_OTHER},
        {"a", BYTES("SQLite format 3"), "a database (SQLite, as COLMAP's database.db)", ADCGS_KIND_SCENE},
        {"a", BYTES("# Image list with two lines"), "COLMAP's images.txt", ADCGS_KIND_SCENE},
        {"a.txt", BYTES("some words"), "a file of unknown kind", ADCGS_KIND_UNKNOWN},
        {"a.null?RES=64x64&CHANNELS=3", BYTES("whatever"), "a file of unknown kind", ADCGS_KIND_UNKNOWN},
        {"a", BYTES(""), "a file of unknown kind", ADCGS_KIND_UNKNOWN},
    };
    expect_kinds(cases, ADCGS_COUNTOF(cases));
}

/** Signatures that lie far behind the first byte. */
static void test_names_by_late_bytes(void **state)
{
    char text[300] = "";
    memcpy(text + 128, "DICM", 4);
    assert_string_equal(kind_of("a", text, 200, 200)->name, "a DICOM image");
    memcpy(text + 128, "\0\0\0\0", 4);
    memcpy(text + 257, "ustar", 5);
    assert_string_equal(kind_of("a", text, 300, 512)->name, "an archive (tar)");
}

/** Kinds without a signature: records of 32 bytes that are splats, and the header of KSplat. */
static void test_unmarked(void **state)
{
    uint8_t splat[320], ksplat[5120] = {0, 1, 0, 0, 1};
    for (size_t i = 0; i < sizeof splat / 32; i++) {
        for (size_t k = 0; k < 6; k++)
            adcgs_store_le32(splat + 32 * i + 4 * k, adcgs_float_bits(k < 3 ? (float)i - 4.0f : 0.1f));
        memcpy(splat + 32 * i + 24, "\x80\x80\x80\xff\xff\x80\x80\x80", 8);
    }
    assert_string_equal(kind_of("a", (char *)splat, sizeof splat, sizeof splat)->name, "splats (.splat)");
    assert_true(kind_of("a", (char *)splat, sizeof splat, sizeof splat)->is_read);
    assert_int_equal(kind_of("a", (char *)splat, sizeof splat, sizeof splat + 1)->class, ADCGS_KIND_UNKNOWN);
    splat[32 * 9 + 28] = 0x80; /* no quaternion */
    assert_int_equal(kind_of("a", (char *)splat, sizeof splat, sizeof splat)->class, ADCGS_KIND_UNKNOWN);
    splat[32 * 9 + 28] = 0xff;
    adcgs_store_le32(splat + 32 * 9 + 12, 0x7fc00000u);
    assert_int_equal(kind_of("a", (char *)splat, sizeof splat, sizeof splat)->class, ADCGS_KIND_UNKNOWN);
    ksplat[16] = 4;
    assert_string_equal(kind_of("a", (char *)ksplat, 100, sizeof ksplat)->name, "splats (.ksplat)");
    assert_true(kind_of("a", (char *)ksplat, 100, sizeof ksplat)->is_read);
    assert_int_equal(kind_of("a", (char *)ksplat, 100, 5000)->class, ADCGS_KIND_UNKNOWN);
}

/* ---- Images ---- */

static void refused(const char *name, const char *bytes, size_t n, adcgs_status status, const char *what)
{
    adcgs_image image;
    int width, height, channels;
    put_bytes(name, bytes, n);
    expect_error(adcgs_image_read(&image, in(name), &error), status, name, what);
    assert_null(image.data);
    expect_error(adcgs_image_probe(&width, &height, &channels, in(name), &error), status, name, what);
}

/** A file that is no supported image is refused with its kind, under any name. */
static void test_no_images(void **state)
{
    refused("x.null?RES=64x64&CHANNELS=3", BYTES("any bytes"), ADCGS_ERR_DATA, "expected an image");
    refused("x.png", BYTES("any bytes"), ADCGS_ERR_DATA, "a file of unknown kind");
    refused("x", BYTES("any bytes"), ADCGS_ERR_DATA, "x: a file of unknown kind");
    refused("x.mp4",
            BYTES("\0\0\0\x18"
                  "ftypisom\0\0\0\0isomavc1"),
            ADCGS_ERR_DATA, "a video (MP4 or QuickTime), expected an image");
    refused("x.jpg", BYTES("\x1a\x45\xdf\xa3\x9f"), ADCGS_ERR_DATA, "adcgs-import extracts its frames");
    refused("x.tga", BYTES("\0\0\2\0\0\0\0\0\0\0\0\0\1\0\1\0\x18\0\1\2\3"), ADCGS_ERR_DATA, "x.tga: ");
    refused("x.psd", BYTES("8BPS\0\1\0\0\0\0\0\0\0\3"), ADCGS_ERR_UNSUPPORTED,
            "a Photoshop document, which is not read: convert");
    refused("x.vdb", BYTES(" BDV\0\0\0\0"), ADCGS_ERR_DATA, "x.vdb: ");
    refused("x.dcm", BYTES("\0\0\0\0DICM"), ADCGS_ERR_DATA, "x.dcm: ");
    refused("x.nef", BYTES("MM\0*\0\0\0\x08\0\0\0\0"), ADCGS_ERR_UNSUPPORTED,
            "a raw image of a camera, which is not read: develop");
    refused("x.adcgs",
            BYTES("\x8b"
                  "ADC\r\n\x1a\n"),
            ADCGS_ERR_DATA, "an adcgs stream, expected an image");
}

/** Sizes are checked against the bound before memory is allocated for pixels. */
static void test_sizes(void **state)
{
    refused("x.gif", BYTES("GIF89a\xff\xff\xff\xff\x80\0\0\0\0\0\xff\xff\xff,\0\0\0\0\xff\xff\xff\xff\0\2\2D\1\0;"),
            ADCGS_ERR_DATA, "x.gif: 65535x65535 pixels, expected 1x1 to 16384x16384");
    refused("x.bmp", BYTES("BM\0\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\xff\xff\xff\x7f\1\0\0\0\1\0\x18\0"), ADCGS_ERR_DATA,
            "x.bmp: 2147483647x1 pixels, expected");
    refused("x.bmp", BYTES("BM\0\0\0\0\0\0\0\0\x1a\0\0\0\x0c\0\0\0\1\0\xff\xff\1\0\x18\0"), ADCGS_ERR_DATA,
            "x.bmp: 1x65535 pixels");
    refused("x.hdr", BYTES("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 70000 +X 70000\n"), ADCGS_ERR_DATA, "70000x70000 pixels");
    refused("x.pgm", BYTES("P2\n70000 70000\n255\n1 2 3\n"), ADCGS_ERR_DATA, "70000x70000 pixels");
}

#ifdef __linux__
/** True if a file of the folder was opened since watching began. */
static int was_opened(int watch, const char *name)
{
    char buffer[8192] __attribute__((aligned(8)));
    int found = 0;
    for (ssize_t n; (n = read(watch, buffer, sizeof buffer)) > 0;)
        for (char *at = buffer; at < buffer + n;) {
            const struct inotify_event *const event = (void *)at;
            found |= event->len && !strcmp(event->name, name);
            at += sizeof *event + event->len;
        }
    return found;
}

/** An image that names other files opens none of them. */
static void test_nothing_else(void **state)
{
    static const struct {
        const char *name, *text;
    } cases[] = {{"x.mp4", "ffconcat version 1.0\nfile secret.mp4"},
                 {"x.avi", "ffconcat version 1.0\nfile secret.mp4"},
                 {"x.mp4", "#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\nsecret.mp4\n#EXT-X-ENDLIST\n"},
                 {"x.png", "ffconcat version 1.0\nfile secret.mp4"},
                 {"x.mp4", "secret.mp4"},
                 {"secret.mp4.null", "some bytes"}};
    const int watch = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
    put_bytes("secret.mp4", BYTES("\0\0\0\x18"
                                  "ftypisom\0\0\0\0isomavc1"));
    if (watch < 0 || inotify_add_watch(watch, folder, IN_OPEN) < 0)
        skip();
    fclose(fopen(in("secret.mp4"), "rb"));
    assert_true(was_opened(watch, "secret.mp4")); /* the watch works */
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        refused(cases[i].name, cases[i].text, strlen(cases[i].text), ADCGS_ERR_DATA, "expected an image");
        assert_false(was_opened(watch, "secret.mp4"));
    }
    close(watch);
}
#endif

/** The name does not matter, and OpenImageIO's readers read our own open file. */
static void test_readers(void **state)
{
    static const char *const ends[] = {"tif", "webp", "bmp", "hdr", "exr", "gif", "heic", "png", "jpg", "ppm", "pfm"};
    adcgs_image image, back;
    int read = 0;
    assert_int_equal(adcgs_image_alloc(&image, 16, 8, 3, "image", &error), ADCGS_OK);
    for (size_t i = 0; i < 16 * 8 * 3; i++)
        image.data[i] = (float)(i / 48) / 8.0f;
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) {
        const adcgs_image_options as = {.format = ends[i]};
        if (adcgs_image_write_as(&image, &as, in("no extension"), &error) != ADCGS_OK)
            continue; /* not every build of OpenImageIO writes all of them */
        const adcgs_status status = adcgs_image_read(&back, in("no extension"), &error);
        if (status == ADCGS_ERR_UNSUPPORTED)
            continue;
        if (status != ADCGS_OK)
            fail_msg("%s: %s", ends[i], error.text);
        assert_true(back.width == 16 && back.height == 8 && back.channels >= 3);
        for (int y = 0; y < 8; y++)
            assert_true(fabs((double)back.data[back.channels * 16 * y] - (double)y / 8) < 0.06);
        adcgs_image_free(&back);
        read++;
    }
    assert_true(read >= 5);
    adcgs_image_free(&image);
}

/* ---- Expected kinds ---- */

static void test_wants(void **state)
{
    adcgs_scene *scene;
    put_bytes("s.adcgs", BYTES("\x8b"
                               "ADC\r\n\x1a\n and more"));
    put_text("p.html", "<!DOCTYPE html>\n<!-- SPDX-License-Identifier: BSD-2-Clause -->\n<html>");
    put_text("t.json", "{\"frames\":[]}");
    assert_int_equal(adcgs_kind_check(in("s.adcgs"), ADCGS_WANT_STREAM, &error), ADCGS_OK);
    assert_int_equal(adcgs_kind_check(in("t.json"), ADCGS_WANT_SCENE, &error), ADCGS_OK);
    assert_int_equal(adcgs_kind_check(in("absent"), ADCGS_WANT_STREAM, &error), ADCGS_OK);
    assert_int_equal(adcgs_kind_check("-", ADCGS_WANT_STREAM, &error), ADCGS_OK);
    assert_int_equal(adcgs_kind_check("http://127.0.0.1:9/a.adcgs", ADCGS_WANT_STREAM, &error), ADCGS_OK);
    assert_int_equal(adcgs_kind_check(in("p.html"), ADCGS_WANT_STREAM, &error), ADCGS_OK); /* it may have one */
    expect_error(adcgs_kind_check(in("p.html"), ADCGS_WANT_SCENE, &error), ADCGS_ERR_DATA, "p.html",
                 "a page of adcgs-share, expected a scene: adcgs-dec renders its stream");
    put_bytes("s.splatv", BYTES("Kg\0\0\xe9\0\0\0[{"));
    assert_int_equal(adcgs_kind_check(in("s.splatv"), ADCGS_WANT_SCENE, &error), ADCGS_OK);
    expect_error(adcgs_kind_check(in("s.splatv"), ADCGS_WANT_SPLATS, &error), ADCGS_ERR_UNSUPPORTED, "s.splatv",
                 "splats over time (.splatv), expected splats (" ADCGS_SPLATS_FORMATS "): adcgs-enc makes a stream of it");
    expect_error(adcgs_kind_check(in("s.splatv"), ADCGS_WANT_POINTS, &error), ADCGS_ERR_DATA, "s.splatv", "expected points");
    expect_error(adcgs_kind_check(folder, ADCGS_WANT_STREAM, &error), ADCGS_ERR_DATA, folder,
                 "a folder, expected an adcgs stream");
    expect_error(adcgs_scene_open(&scene, in("s.adcgs"), NULL, &error), ADCGS_ERR_DATA, "s.adcgs",
                 "an adcgs stream, expected a scene: adcgs-dec renders it");
    assert_int_equal(mkfifo(in("pipe"), 0600), 0);
    assert_int_equal(adcgs_kind_check(in("pipe"), ADCGS_WANT_STREAM, &error), ADCGS_OK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_names_of_pictures),
        cmocka_unit_test(test_names_of_splats),
        cmocka_unit_test(test_names_of_texts),
        cmocka_unit_test(test_names_by_late_bytes),
        cmocka_unit_test(test_unmarked),
        cmocka_unit_test(test_no_images),
        cmocka_unit_test(test_sizes),
        cmocka_unit_test(test_readers),
        cmocka_unit_test(test_wants),
#ifdef __linux__
        cmocka_unit_test(test_nothing_else),
#endif
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
