/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A small rig in every layout: cameras on an arc that look at the origin, images of 24x16, points around the origin. The poses
 * are made here, in OpenCV axes, and written in each layout's convention.
 */
#ifndef ADCGS_TESTS_LAYOUT_FILES_H
#define ADCGS_TESTS_LAYOUT_FILES_H

#include "outside_files.h"

#include "media/video/video.h"
#include "scene/scene.h"

#include <math.h>

enum { RIG_WIDTH = 24, RIG_HEIGHT = 16, RIG_POINTS = 27 };
#define RIG_FOCAL 20.0
/** A user's own point: 1 2 3. */
#define RIG_PLY \
    "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n"

/** Cameras 0, rig_moved, 2 * rig_moved, ... are elsewhere, much farther off, with nearer bounds. 0: no camera. */
static int rig_moved;

static inline int rig_is_moved(int i)
{
    return rig_moved && i % rig_moved == 0;
}

/** Camera to world: the position on an arc of radius 3, up is -y of the world (y points down). */
static inline void rig_pose(int i, double pose[12])
{
    const double angle = 0.2 * i - 0.5 + (rig_is_moved(i) ? 0.7 : 0.0), radius = rig_is_moved(i) ? 300.0 : 3.0;
    const double p[3] = {radius * sin(angle), 0.3 * (i % 3), -radius * cos(angle)};
    const double length = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    const double z[3] = {-p[0] / length, -p[1] / length, -p[2] / length}, across = sqrt(z[0] * z[0] + z[2] * z[2]);
    const double x[3] = {z[2] / across, 0, -z[0] / across}; /* y cross z */
    const double y[3] = {z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0]};
    for (int a = 0; a < 3; a++) {
        pose[4 * a] = x[a];
        pose[4 * a + 1] = y[a];
        pose[4 * a + 2] = z[a];
        pose[4 * a + 3] = p[a];
    }
}

static inline void rig_point(int i, double x[3])
{
    x[0] = 0.5 * (i % 3 - 1);
    x[1] = 0.4 * (i / 3 % 3 - 1);
    x[2] = 0.3 * (i / 9 - 1);
}

static inline void expect_pose(const adcgs_scene_view *view, int i, double scale, double tolerance)
{
    double pose[12];
    rig_pose(i, pose);
    for (int k = 0; k < 12; k++)
        if (!(fabs(view->camera.cam_to_world[k] - pose[k] * (k % 4 == 3 ? scale : 1.0)) <= tolerance))
            fail_msg("%s: entry %d of the pose is %.17g, expected %.17g", view->camera.name, k, view->camera.cam_to_world[k],
                     pose[k] * (k % 4 == 3 ? scale : 1.0));
}

static inline void put_folder(const char *name)
{
    if (mkdir(in(name), 0777))
        assert_int_equal(access(in(name), F_OK), 0);
}

/** An image whose colours encode its number. */
static inline void put_picture(const char *name, int number, int width, int height)
{
    adcgs_image image;
    assert_int_equal(adcgs_image_alloc(&image, width, height, 3, name, &error), ADCGS_OK);
    for (int i = 0; i < width * height * 3; i++)
        image.data[i] = (float)((i * 7 + number * 31) % 251) / 255.0f;
    assert_int_equal(adcgs_image_write(&image, in(name), 0, &error), ADCGS_OK);
    adcgs_image_free(&image);
}

/** Writes this many frames; returns 0 if this build writes no videos. */
static inline int put_video(const char *name, int number, int frames, int width, int height)
{
    adcgs_video_writer *writer;
    float *rgb = malloc((size_t)(3 * width * height) * sizeof *rgb);
    const adcgs_frame frame = {width, height, rgb};
    assert_non_null(rgb);
    const adcgs_status status =
        adcgs_video_write_open(&writer, in(name), width, height, 25, &(const adcgs_video_style){0}, &error);
    for (int f = 0; status == ADCGS_OK && f < frames; f++) {
        for (int i = 0; i < 3 * width * height; i++)
            rgb[i] = (float)((i / 24 + 16 * f + 31 * number) % 200) / 255.0f;
        assert_int_equal(adcgs_video_write_frame(writer, &frame, NULL, &error), ADCGS_OK);
    }
    free(rgb);
    if (status == ADCGS_ERR_UNSUPPORTED)
        return 0;
    assert_int_equal(status, ADCGS_OK);
    assert_int_equal(adcgs_video_write_close(&writer, &error), ADCGS_OK);
    return 1;
}

/** poses_bounds.npy for n cameras. Height, width and focal length are those of images `times` as large. */
static inline void put_poses(int n, double times)
{
    char header[128];
    uint8_t *data = malloc(128 + (size_t)n * 17 * 8);
    assert_non_null(data);
    const int length = snprintf(header, sizeof header, "{'descr': '<f8', 'fortran_order': False, 'shape': (%d, 17), }", n);
    memset(data, ' ', 128);
    memcpy(data, "\x93NUMPY\x01\0\x76\0", 10);
    memcpy(data + 10, header, (size_t)length);
    data[127] = '\n';
    for (int i = 0; i < n; i++) {
        double pose[12], row[17];
        rig_pose(i, pose);
        for (int a = 0; a < 3; a++) {
            row[5 * a] = pose[4 * a + 1];      /* down */
            row[5 * a + 1] = pose[4 * a];      /* right */
            row[5 * a + 2] = -pose[4 * a + 2]; /* backwards */
            row[5 * a + 3] = pose[4 * a + 3];
        }
        row[4] = RIG_HEIGHT * times;
        row[9] = RIG_WIDTH * times;
        row[14] = RIG_FOCAL * times;
        row[15] = rig_is_moved(i) ? 0.01 : 2.0 + 0.01 * i;
        row[16] = 4.5;
        for (int k = 0; k < 17; k++)
            adcgs_store_le64(data + 128 + 8 * (17 * i + k), adcgs_double_bits(row[k]));
    }
    put_bytes("poses_bounds.npy", data, 128 + (size_t)n * 17 * 8);
    free(data);
}

/** The inverse rotation of a pose as a quaternion. Cameras of the rig never look backwards, so that w is not 0. */
static inline void rig_quaternion(const double pose[12], double q[4], double t[3])
{
    q[0] = 0.5 * sqrt(1 + pose[0] + pose[5] + pose[10]);
    q[1] = (pose[6] - pose[9]) / (4 * q[0]);
    q[2] = (pose[8] - pose[2]) / (4 * q[0]);
    q[3] = (pose[1] - pose[4]) / (4 * q[0]);
    for (int i = 0; i < 3; i++)
        t[i] = -(pose[i] * pose[3] + pose[4 + i] * pose[7] + pose[8 + i] * pose[11]);
}

/** A file that is written number by number. */
typedef struct writer {
    uint8_t data[8192];
    size_t n;
} writer;

static inline void put32(writer *w, uint32_t v)
{
    assert_true(w->n + 4 <= sizeof w->data);
    adcgs_store_le32(w->data + w->n, v);
    w->n += 4;
}

static inline void put64(writer *w, uint64_t v)
{
    assert_true(w->n + 8 <= sizeof w->data);
    adcgs_store_le64(w->data + w->n, v);
    w->n += 8;
}

static inline void put_double(writer *w, double v)
{
    put64(w, adcgs_double_bits(v));
}

/** Images are listed backwards, with the ids 10, 11, ...; point i is seen by images i % n and (i + 1) % n. */
static inline void put_model_binary(const char *place, int n, const char *names)
{
    static writer w;
    char path[64], name[64];
    w.n = 0;
    put64(&w, 1);
    put32(&w, 7);
    put32(&w, 1); /* PINHOLE */
    put64(&w, RIG_WIDTH);
    put64(&w, RIG_HEIGHT);
    put_double(&w, RIG_FOCAL);
    put_double(&w, RIG_FOCAL);
    put_double(&w, 0.5 * RIG_WIDTH);
    put_double(&w, 0.5 * RIG_HEIGHT);
    snprintf(path, sizeof path, "%s/cameras.bin", place);
    put_bytes(path, w.data, w.n);
    w.n = 0;
    put64(&w, (uint64_t)n);
    for (int i = n - 1; i >= 0; i--) {
        double pose[12], q[4], t[3];
        rig_pose(i, pose);
        rig_quaternion(pose, q, t);
        put32(&w, 10 + (uint32_t)i);
        for (int k = 0; k < 4; k++)
            put_double(&w, q[k]);
        for (int k = 0; k < 3; k++)
            put_double(&w, t[k]);
        put32(&w, 7);
        const int length = snprintf(name, sizeof name, names, i);
        memcpy(w.data + w.n, name, (size_t)length + 1);
        w.n += (size_t)length + 1;
        put64(&w, 1); /* a feature */
        put64(&w, 0);
        put64(&w, 0);
        put64(&w, UINT64_MAX);
    }
    snprintf(path, sizeof path, "%s/images.bin", place);
    put_bytes(path, w.data, w.n);
    w.n = 0;
    put64(&w, RIG_POINTS);
    for (int i = 0; i < RIG_POINTS; i++) {
        double x[3];
        rig_point(i, x);
        put64(&w, 100 + (uint64_t)i);
        for (int a = 0; a < 3; a++)
            put_double(&w, x[a]);
        w.data[w.n++] = (uint8_t)(i * 9);
        w.data[w.n++] = 128;
        w.data[w.n++] = 255;
        put_double(&w, 0.5);
        put64(&w, 2);
        put32(&w, 10 + (uint32_t)(i % n));
        put32(&w, 0);
        put32(&w, 10 + (uint32_t)((i + 1) % n));
        put32(&w, 0);
    }
    snprintf(path, sizeof path, "%s/points3D.bin", place);
    put_bytes(path, w.data, w.n);
}

/** The same in text, with the camera line given. */
static inline void put_model_text(const char *place, int n, const char *names, const char *camera)
{
    char path[64], *text = malloc(65536);
    assert_non_null(text);
    snprintf(path, sizeof path, "%s/cameras.txt", place);
    put_text(path, camera);
    size_t at = (size_t)sprintf(text, "# remark\n");
    for (int i = n - 1; i >= 0; i--) {
        double pose[12], q[4], t[3];
        char name[64];
        rig_pose(i, pose);
        rig_quaternion(pose, q, t);
        snprintf(name, sizeof name, names, i);
        at += (size_t)sprintf(text + at, "%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g 7 %s\n%s\n", 10 + i, q[0], q[1], q[2],
                              q[3], t[0], t[1], t[2], name, i % 2 ? "" : "1.5 2.5 -1");
    }
    snprintf(path, sizeof path, "%s/images.txt", place);
    put_text(path, text);
    at = 0;
    for (int i = 0; i < RIG_POINTS; i++) {
        double x[3];
        rig_point(i, x);
        at += (size_t)sprintf(text + at, "%d %.17g %.17g %.17g %d 128 255 0.5 %d 0 %d 0\r\n", 100 + i, x[0], x[1], x[2], i * 9,
                              10 + i % n, 10 + (i + 1) % n);
    }
    snprintf(path, sizeof path, "%s/points3D.txt", place);
    put_text(path, text);
    free(text);
}

/** Number of the rig's points that remain in a model of n images when every period-th is for testing. */
static inline uint32_t count_kept_points(int n, int period)
{
    uint32_t kept = 0;
    for (int i = 0; i < RIG_POINTS; i++)
        kept += i % n % period && (i + 1) % n % period;
    return kept;
}

/** A row-major 3x4 matrix as JSON. */
static inline const char *json_matrix(const double m[12])
{
    static char text[512];
    snprintf(text, sizeof text, "[[%.17g,%.17g,%.17g,%.17g],[%.17g,%.17g,%.17g,%.17g],[%.17g,%.17g,%.17g,%.17g]]", m[0], m[1],
             m[2], m[3], m[4], m[5], m[6], m[7], m[8], m[9], m[10], m[11]);
    return text;
}

/** The same with OpenGL axes. */
static inline const char *json_opengl(const double m[12])
{
    double gl[12];
    memcpy(gl, m, sizeof gl);
    for (int a = 0; a < 3; a++) {
        gl[4 * a + 1] = -gl[4 * a + 1];
        gl[4 * a + 2] = -gl[4 * a + 2];
    }
    return json_matrix(gl);
}

#endif
