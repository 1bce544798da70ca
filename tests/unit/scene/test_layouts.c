/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Properties of scenes of every layout: test views do not affect the start of training, frames can be selected, a kind can be
 * forced.
 */
#include "layout_kinds.h"

#include "scene/layouts/open.h"
#include "train/initialise.h"
#include "train/scene_frame.h"
#include "train/settings.h"
#include "train/start_points.h"

static adcgs_scene *scene;

static void expect_good(adcgs_status status)
{
    if (status != ADCGS_OK)
        fail_msg("%s", error.text);
}

static const char *scene_path(const layout *l)
{
    return *l->scene ? in(l->scene) : folder;
}

/** Makes the folder again from scratch. */
static void begin_anew(const layout *l)
{
    assert_int_equal(remove_folder(NULL), 0);
    assert_int_equal(mkdir(folder, 0777), 0);
    l->put();
}

/* ---- Test views kept apart ---- */

/** Everything that training starts from. */
typedef struct start {
    adcgs_scene *scene;
    double origin[3], scale;
    adcgs_fmodel *model;
    adcgs_stereo found;
} start;

static start make_start(const layout *l)
{
    start s = {.scale = 0};
    expect_good(adcgs_scene_open(&s.scene, scene_path(l), NULL, &error));
    return s;
}

static void finish_start(start *s)
{
    adcgs_train_config config;
    expect_good(adcgs_train_preset(&config, "draft", &error));
    config.start_anchors = 60;
    config.matching_frames = s->scene->splats && !getenv("ADCGS_FULL") ? 0 : 2; /* its hundred views take half a minute */
    assert_int_equal(adcgs_scene_frame(s->scene, s->origin, &s->scale, &error), ADCGS_OK);
    expect_good(adcgs_start_match(&s->found, 0, s->scene, &config, NULL, &error));
    expect_good(adcgs_initialise(&s->model, s->scene, &config, &s->found, &error));
}

static void free_start(start *s)
{
    adcgs_scene_free(&s->scene);
    adcgs_fmodel_free(&s->model);
    adcgs_stereo_clear(&s->found);
}

static void expect_same(const start *a, const start *b)
{
    const uint32_t n = a->scene->n_views[ADCGS_SPLIT_TRAIN];
    assert_memory_equal(a->origin, b->origin, sizeof a->origin);
    assert_true(a->scale == b->scale && a->scene->duration == b->scene->duration && a->scene->n_times == b->scene->n_times);
    assert_true(a->scene->rate.num == b->scene->rate.num && a->scene->rate.den == b->scene->rate.den);
    assert_true(a->scene->axes == b->scene->axes);
    assert_true(a->scene->has_alpha == b->scene->has_alpha && n == b->scene->n_views[ADCGS_SPLIT_TRAIN]);
    for (uint32_t i = 0; i < n; i++) {
        const adcgs_scene_view *v = &a->scene->views[ADCGS_SPLIT_TRAIN][i], *w = &b->scene->views[ADCGS_SPLIT_TRAIN][i];
        assert_memory_equal(&v->camera, &w->camera, sizeof v->camera); /* with the near plane */
        assert_true(v->time == w->time && v->frame == w->frame && !strcmp(v->path, w->path));
    }
    assert_int_equal(a->scene->points.n, b->scene->points.n);
    assert_memory_equal(a->scene->points.position, b->scene->points.position,
                        a->scene->points.n * sizeof *a->scene->points.position);
    assert_int_equal(a->model->n, b->model->n);
    assert_true(a->model->n > 16 && a->model->voxel == b->model->voxel);
    assert_memory_equal(a->model->pos, b->model->pos, a->model->n * sizeof *a->model->pos);
    for (int p = 0; p < ADCGS_P_COUNT; p++)
        assert_memory_equal(a->model->param[p].p, b->model->param[p].p, a->model->param[p].n * sizeof(float));
}

enum { REPLACE, REMOVE };

/** Removes or replaces all files of the test views. Returns their number. */
static int touch_tests(const layout *l, int what)
{
    int n = 0;
    for (int i = l->first; i <= l->last; i += l->step, n++) {
        char name[64];
        snprintf(name, sizeof name, l->tests, i);
        assert_int_equal(unlink(in(name)), 0);
        if (what == REPLACE && l->videos)
            put_video(name, 50 + i, MOMENTS, RIG_WIDTH, RIG_HEIGHT);
        else if (what == REPLACE)
            put_picture(name, 50 + i, RIG_WIDTH, RIG_HEIGHT);
    }
    return n;
}

/** Makes cameras and times of an open scene's test views NaN, and removes their files. */
static void spoil_tests(const layout *l, adcgs_scene *opened)
{
    for (int s = ADCGS_SPLIT_VAL; s < ADCGS_SPLITS; s++)
        for (uint32_t i = 0; i < opened->n_views[s]; i++) {
            adcgs_scene_view *view = &opened->views[s][i];
            memset(&view->camera, 0xff, sizeof view->camera);
            view->time = NAN;
            view->frame = INT64_MAX;
            *strrchr(view->path, '/') = '_';
        }
    assert_true(!l->tests || touch_tests(l, REMOVE) > 0);
}

/** Other test views, from elsewhere and deleted after the scene was opened, leave the start of training unchanged, to the bit. */
static void test_apart(void **state)
{
    for (size_t i = 0; i < LAYOUTS; i++) {
        const layout *l = &layouts[i];
        if (l->videos && !put_video("probe.mp4", 0, 1, RIG_WIDTH, RIG_HEIGHT)) {
            print_message("skipped: %s: this build writes no videos\n", l->name);
            continue;
        }
        begin_anew(l);
        start first = make_start(l), second;
        finish_start(&first);
        assert_true(first.scene->n_views[ADCGS_SPLIT_TEST] > 0 && first.scene->n_views[ADCGS_SPLIT_TRAIN] > 0);
        rig_moved = l->period;
        begin_anew(l);
        rig_moved = 0;
        assert_true(!l->tests || touch_tests(l, REPLACE) > 0);
        second = make_start(l);
        if (l->period)
            assert_memory_not_equal(&first.scene->views[ADCGS_SPLIT_TEST][0].camera.cam_to_world,
                                    &second.scene->views[ADCGS_SPLIT_TEST][0].camera.cam_to_world, sizeof(double[12]));
        spoil_tests(l, second.scene);
        finish_start(&second);
        expect_same(&first, &second);
        free_start(&first);
        free_start(&second);
    }
}

/** Images and poses of training views do change the start of training: the test above can fail. */
static void test_apart_notices(void **state)
{
    for (int moved = 0; moved < 2; moved++) {
        begin_anew(&layouts[LLFF]);
        start first = make_start(&layouts[LLFF]), second;
        finish_start(&first);
        if (moved) {
            rig_moved = 5;
            begin_anew(&layouts[LLFF]);
            rig_moved = 0;
        } else
            put_picture("images/4.ppm", 99, RIG_WIDTH, RIG_HEIGHT);
        second = make_start(&layouts[LLFF]);
        finish_start(&second);
        int same = first.model->n == second.model->n;
        for (int p = 0; same && p < ADCGS_P_COUNT; p++)
            same = !memcmp(first.model->param[p].p, second.model->param[p].p, first.model->param[p].n * sizeof(float));
        assert_false(same);
        assert_int_equal(first.scene->near_bound != second.scene->near_bound, moved);
        assert_int_equal(memcmp(first.origin, second.origin, sizeof first.origin) != 0, moved);
        free_start(&first);
        free_start(&second);
    }
}

/** Other cameras and images of the test views, and other views of the same times, change nothing. Only their times count. */
static void test_apart_poses(void **state)
{
    begin_anew(&layouts[DNERF]);
    start first = make_start(&layouts[DNERF]), second;
    finish_start(&first);
    put_text("transforms_test.json",
             "{\"fl_x\":99,\"w\":24,\"h\":16,\"ply_file_path\":\"0.ppm\",\"frames\":["
             "{\"file_path\":\"0.ppm\",\"time\":1,\"transform_matrix\":[[1,0,0,70],[0,1,0,0],[0,0,1,900]]},"
             "{\"file_path\":\"8.ppm\",\"time\":0,\"transform_matrix\":[[1,0,0,9],[0,1,0,0],[0,0,1,-900]]}]}");
    second = make_start(&layouts[DNERF]);
    finish_start(&second);
    expect_same(&first, &second);
    free_start(&first);
    free_start(&second);
}

/** Where frames do not state their size, the size of test images is not taken for the others. */
static void test_apart_sizes(void **state)
{
    const layout *l = &layouts[NERFSTUDIO];
    begin_anew(l);
    put_transforms("transforms.json", 0, 1);
    char *text = malloc(65536);
    assert_non_null(text);
    FILE *file = fopen(in("transforms.json"), "rb");
    const size_t n = fread(text, 1, 65535, file);
    fclose(file);
    text[n] = 0;
    memset(strstr(text, "\"w\":24,"), ' ', 7);
    memset(strstr(text, "\"h\":16,"), ' ', 7);
    put_text("transforms.json", text);
    free(text);
    start first = make_start(l), second;
    finish_start(&first);
    put_picture("0.ppm", 0, 2 * RIG_WIDTH, 2 * RIG_HEIGHT);
    put_picture("8.ppm", 8, 2 * RIG_WIDTH, 2 * RIG_HEIGHT);
    second = make_start(l);
    finish_start(&second);
    expect_same(&first, &second);
    assert_int_equal(second.scene->views[ADCGS_SPLIT_TEST][0].camera.width, 2 * RIG_WIDTH);
    free_start(&first);
    free_start(&second);
}

/* ---- Texts ---- */

static int n_marked;

/** Puts a byte order mark before a text file. */
static int mark(const char *path, const struct stat *status, int kind, struct FTW *place)
{
    const char *end = strrchr(path, '.');
    if (kind != FTW_F || !end || (strcmp(end, ".json") && strcmp(end, ".txt")))
        return 0;
    const size_t n = (size_t)status->st_size;
    char *text = malloc(n + 1);
    FILE *file = fopen(path, "r+b");
    assert_true(text && file && fread(text, 1, n, file) == n);
    rewind(file);
    assert_true(fputs("\xef\xbb\xbf", file) >= 0 && fwrite(text, 1, n, file) == n);
    fclose(file);
    free(text);
    n_marked++;
    return 0;
}

/** A byte order mark, which some editors write, changes nothing. */
static void test_marks(void **state)
{
    static const int which[] = {DNERF, NERFSTUDIO, HYPERNERF, COLMAP_TEXT, SCENE_FILE};
    for (size_t i = 0; i < ADCGS_COUNTOF(which); i++) {
        begin_anew(&layouts[which[i]]);
        start first = make_start(&layouts[which[i]]), second;
        finish_start(&first);
        n_marked = 0;
        assert_int_equal(nftw(folder, mark, 8, FTW_PHYS), 0);
        assert_true(n_marked > 0);
        second = make_start(&layouts[which[i]]);
        finish_start(&second);
        expect_same(&first, &second);
        free_start(&first);
        free_start(&second);
    }
}

/* ---- Frames ---- */

static void expect_range(const char *text, int64_t begin, int64_t end, int64_t step)
{
    adcgs_frame_range range = {9, 9, 9};
    expect_good(adcgs_frames_parse(&range, text, &error));
    assert_true(range.begin == begin && range.end == end && range.step == step);
}

static void test_parse_frames(void **state)
{
    static const char *const bad[] = {"", "7", "1:2:0", "1:2:3:4", "-1:5", "1:-5", "a:b", "1:2x", "1 :2", "1:2:", "9999999999:"};
    adcgs_frame_range range;
    expect_range("2:9", 2, 9, 1);
    expect_range("2:9:3", 2, 9, 3);
    expect_range(":", 0, 0, 1);
    expect_range("5:", 5, 0, 1);
    expect_range("::2", 0, 0, 2);
    for (size_t i = 0; i < ADCGS_COUNTOF(bad); i++)
        if (i != 9) /* a step may be left out */
            expect_error(adcgs_frames_parse(&range, bad[i], &error), ADCGS_ERR_USAGE, "--frames", "expected A:B");
    expect_error(adcgs_frames_parse(&range, "5:5", &error), ADCGS_ERR_USAGE, "holds no frame", "5 is not below 5");
    expect_error(adcgs_frames_parse(&range, "0:0", &error), ADCGS_ERR_USAGE, "holds no frame", "");
}

static void open_range(const layout *l, int64_t begin, int64_t end, int64_t step, adcgs_status expected, const char *what)
{
    const adcgs_scene_options options = {.frames = {begin, end, step}, .rate = {10, !l->videos}};
    const adcgs_status status = adcgs_scene_open(&scene, scene_path(l), &options, &error);
    if (expected == ADCGS_OK)
        expect_good(status);
    else
        expect_error(status, expected, what, "");
}

/** Timestamps of single images: training 1, 3, 5, 7 and testing 0, 8, all over 8. */
static void test_frames_of_pictures(void **state)
{
    begin_anew(&layouts[DNERF]);
    open_range(&layouts[DNERF], 1, 5, 2, ADCGS_OK, NULL); /* of the timestamps 0 1 3 5 7 8: 1 and 5 */
    assert_true(scene->n_views[ADCGS_SPLIT_TRAIN] == 2 && scene->n_views[ADCGS_SPLIT_TEST] == 0);
    assert_string_equal(scene->views[ADCGS_SPLIT_TRAIN][1].camera.name, "5");
    assert_true(scene->views[ADCGS_SPLIT_TRAIN][0].time == 0.0 && scene->duration == 0.1);
    assert_true(scene->views[ADCGS_SPLIT_TRAIN][1].time == scene->duration);
    adcgs_scene_free(&scene);
    open_range(&layouts[DNERF], 3, 0, 1, ADCGS_OK, NULL);
    assert_true(scene->n_views[ADCGS_SPLIT_TRAIN] == 2 && scene->n_views[ADCGS_SPLIT_TEST] == 1);
    assert_true(scene->views[ADCGS_SPLIT_TRAIN][0].time == 0.0 && scene->views[ADCGS_SPLIT_TEST][0].time == scene->duration);
    adcgs_scene_free(&scene);
    open_range(&layouts[DNERF], 6, 0, 1, ADCGS_ERR_DATA, "begins with frame 6, but there are 6");
    open_range(&layouts[DNERF], 5, 0, 1, ADCGS_ERR_DATA, "leaves no view for training");
}

/** Frames of cameras: the step reduces the number of frames, not their duration. */
static void test_frames_of_cameras(void **state)
{
    static const int which[] = {NEU3D, NEU3D_VIDEOS, COLMAP_VIDEOS, SCENE_FILE};
    for (size_t i = 0; i < ADCGS_COUNTOF(which); i++) {
        const layout *l = &layouts[which[i]];
        if (l->videos && !put_video("probe.mp4", 0, 1, RIG_WIDTH, RIG_HEIGHT))
            continue;
        begin_anew(l);
        open_range(l, 1, 0, 2, ADCGS_OK, NULL); /* frames 1 and 3 */
        const adcgs_scene_view *train = scene->views[ADCGS_SPLIT_TRAIN];
        assert_true(scene->n_views[ADCGS_SPLIT_TRAIN] == 2 * (CAMERAS - 1) && scene->n_views[ADCGS_SPLIT_TEST] == 2);
        assert_true(scene->n_times == 2 && train[0].time == 0.0 && train[1].time == scene->duration);
        assert_true(train[0].is_video == l->videos && train[1].frame == (l->videos ? 3 : 0));
        assert_true(l->videos || strstr(train[1].path, "0003.ppm"));
        /*
         * Videos have 25 frames per second; with every second frame, 12.5. Images have 10 by the option, but a scene file's
         * frames have their own times, at 30.
         */
        assert_true(fabs(scene->duration - (l->videos ? 2 / 25.0 : *l->scene ? 2 / 30.0 : 0.1)) < 1e-12);
        assert_true(adcgs_fps_value(scene->rate) == (l->videos ? 12.5 : 10));
        adcgs_scene_free(&scene);
        open_range(l, 4, 0, 1, ADCGS_ERR_DATA, "begins with frame 4, but there are 4");
    }
}

/* ---- Kinds ---- */

static void open_as(int dataset, adcgs_status expected, const char *what)
{
    const adcgs_scene_options options = {.dataset = dataset};
    const adcgs_status status = adcgs_scene_open(&scene, folder, &options, &error);
    if (expected == ADCGS_OK) {
        expect_good(status);
        adcgs_scene_free(&scene);
    } else
        expect_error(status, expected, what, folder);
}

static void test_kinds(void **state)
{
    begin_anew(&layouts[LLFF]);
    put_folder("sparse");
    put_model_text("sparse", CAMERAS, "%d.ppm", "7 PINHOLE 24 16 20 20 12 8\n");
    expect_good(adcgs_scene_open(&scene, folder, NULL, &error)); /* LLFF has priority */
    assert_true(scene->near_bound == 2.01);
    adcgs_scene_free(&scene);
    open_as(ADCGS_DATASET_COLMAP, ADCGS_OK, NULL);
    open_as(ADCGS_DATASET_LLFF, ADCGS_OK, NULL);
    open_as(ADCGS_DATASET_HYPERNERF, ADCGS_ERR_IO, "dataset.json");
    open_as(ADCGS_DATASET_TRANSFORMS, ADCGS_ERR_IO, "transforms.json");
    open_as(ADCGS_DATASET_ADCGS, ADCGS_ERR_USAGE, "expected a scene file");
    assert_int_equal(remove_folder(NULL), 0);
    assert_int_equal(mkdir(folder, 0777), 0);
    open_as(ADCGS_DATASET_AUTO, ADCGS_ERR_DATA, "poses_bounds.npy, nor a COLMAP model");
    open_as(ADCGS_DATASET_LLFF, ADCGS_ERR_IO, "poses_bounds.npy");
    open_as(ADCGS_DATASET_COLMAP, ADCGS_ERR_DATA, "no COLMAP model");
    put_text("scene.json", "{}");
    const adcgs_scene_options as_llff = {.dataset = ADCGS_DATASET_LLFF}, as_file = {.dataset = ADCGS_DATASET_ADCGS};
    expect_error(adcgs_scene_open(&scene, in("scene.json"), &as_llff, &error), ADCGS_ERR_USAGE, "a file", "of the kind llff");
    expect_error(adcgs_scene_open(&scene, in("scene.json"), &as_file, &error), ADCGS_ERR_DATA, "adcgs_scene", "version 1");
    expect_error(adcgs_scene_open(&scene, in("scene.json"), NULL, &error), ADCGS_ERR_DATA, "scene.json", "frames");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_apart),
        cmocka_unit_test(test_apart_notices),
        cmocka_unit_test(test_marks),
        cmocka_unit_test(test_apart_poses),
        cmocka_unit_test(test_apart_sizes),
        cmocka_unit_test(test_parse_frames),
        cmocka_unit_test(test_frames_of_pictures),
        cmocka_unit_test(test_frames_of_cameras),
        cmocka_unit_test(test_kinds),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
