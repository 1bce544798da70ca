/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Pixels of the player's overlay, from the module with SDL: its dummy driver needs no display. */
#include "play_rig.h"
#include "second_sources.h"

#include "play/actions.h"
#include "play/font.h"
#include "play/overlay.h"
#include "play/window.h"

#define EVENTS_MAX 1000
#define FONTS "/usr/share/fonts/truetype/dejavu" /* Debian's fonts-dejavu-core, which bootstrap installs */

static const adcgs_play_figures figures = {.seconds = 0.01, .width = 640, .height = 480};
static const int sizes[][2] = {{320, 240}, {1280, 720}, {3840, 2160}};

/** A window, its state, and the pixels of its last drawing. */
typedef struct screen {
    const adcgs_sdl *sdl;
    adcgs_window *window;
    adcgs_filmed_camera cameras[2];
    adcgs_play_state play;
    adcgs_drawing drawing;
    uint8_t *rgb;
} screen;

/** NULL if this build has no player. fonts: a configuration of fontconfig; NULL: the system's. */
static screen *open_screen(const char *fonts)
{
    screen *const s = calloc(1, sizeof *s);
    setenv("SDL_VIDEODRIVER", "dummy", 1);
    setenv("SDL_RENDER_DRIVER", "software", 1);
    if (fonts)
        setenv("FONTCONFIG_FILE", fonts, 1);
    else
        unsetenv("FONTCONFIG_FILE");
    if (adcgs_sdl_get(&s->sdl, "a window", &error) == ADCGS_ERR_UNSUPPORTED) {
        print_message("skipped: %s\n", error.text);
        free(s);
        return NULL;
    }
    assert_int_equal(s->sdl->open(&s->window, "a window", 320, 240, &error), ADCGS_OK);
    s->cameras[0] = s->cameras[1] = (adcgs_filmed_camera){.camera = make_camera(), .path = -1};
    s->play = make_state(s->cameras);
    return s;
}

static void close_screen(screen *s)
{
    s->sdl->close(&s->window);
    free(s->rgb);
    free(s);
}

static void resize(screen *s, const int size[2])
{
    int width, height;
    double density;
    adcgs_event event;
    s->sdl->resize(s->window, size[0], size[1]);
    for (int i = 0; i < EVENTS_MAX && s->sdl->event(s->window, 0, &event); i++) {
    }
    s->sdl->size(s->window, &width, &height, &density);
    assert_true(width == size[0] && height == size[1]);
    adcgs_play_resize(&s->play, width, height, 1.0);
    free(s->rgb);
    s->rgb = malloc(3 * (size_t)width * (size_t)height);
}

static void show(screen *s)
{
    assert_int_equal(s->sdl->show(s->window, &s->drawing, s->rgb, &error), ADCGS_OK);
}

/** The brightest sample of a pixel. */
static int ink(const screen *s, int x, int y)
{
    const uint8_t *const p = s->rgb + 3 * ((size_t)y * (size_t)s->play.width + (size_t)x);
    return ADCGS_MAX(p[0], ADCGS_MAX(p[1], p[2]));
}

/** The bounding box of all pixels that are not black. */
static adcgs_rect ink_box(const screen *s)
{
    int low[2] = {s->play.width, s->play.height}, high[2] = {-1, -1};
    for (int y = 0; y < s->play.height; y++)
        for (int x = 0; x < s->play.width; x++)
            if (ink(s, x, y) > 40) {
                low[0] = ADCGS_MIN(low[0], x);
                low[1] = ADCGS_MIN(low[1], y);
                high[0] = ADCGS_MAX(high[0], x);
                high[1] = ADCGS_MAX(high[1], y);
            }
    return (adcgs_rect){low[0], low[1], high[0] - low[0] + 1, high[1] - low[1] + 1};
}

/** Every line of text is rendered alone: its letters fill its place, and are nowhere else. \return the mean height of letters */
static double check_lines(screen *s)
{
    double heights = 0.0;
    int lines = 0;
    const adcgs_drawing all = s->drawing;
    for (int i = 0; i < all.n; i++) {
        const adcgs_shape *const shape = &all.shape[i];
        if (shape->kind != ADCGS_SHAPE_TEXT)
            continue;
        s->drawing.n = 1;
        s->drawing.shape[0] = *shape;
        s->drawing.shape[0].colour = 0xffffffffu;
        show(s);
        const adcgs_rect box = ink_box(s), *const place = &shape->place;
        const int overhang = 1 + shape->size / 8; /* of slanted and round letters */
        assert_true(box.width > 0 && box.height > 0);
        assert_true(box.x >= place->x - overhang && box.x + box.width <= place->x + place->width + overhang);
        assert_true(box.y >= place->y && box.y + box.height <= place->y + place->height);
        assert_true(box.width >= place->width - shape->size);
        assert_true(box.x > 0 && box.y > 0 && box.x + box.width < s->play.width && box.y + box.height < s->play.height);
        heights += box.height;
        lines++;
    }
    s->drawing = all;
    assert_true(lines > 0);
    return heights / lines;
}

static void check_sizes(screen *s, double tolerance)
{
    double hint[3], help[3];
    for (size_t i = 0; i < ADCGS_COUNTOF(sizes); i++) {
        resize(s, sizes[i]);
        s->play.help = 0;
        adcgs_overlay_draw(&s->drawing, s->sdl->type(s->window), &s->play, &figures);
        assert_true(adcgs_drawing_inside(&s->drawing, sizes[i][0], sizes[i][1]));
        hint[i] = check_lines(s);
        s->play.help = 1;
        adcgs_overlay_draw(&s->drawing, s->sdl->type(s->window), &s->play, &figures);
        assert_true(adcgs_drawing_inside(&s->drawing, sizes[i][0], sizes[i][1]));
        help[i] = i < 2 ? check_lines(s) : help[1] * hint[2] / hint[1]; /* its many large images would take seconds */
    }
    assert_true(hint[0] >= 6.0 && hint[1] > 1.3 * hint[0] && fabs(hint[2] / hint[1] - 3.0) <= tolerance);
    assert_true(help[0] >= 4.0 && help[1] > 1.5 * help[0]);
}

/** Text grows with the window, and nothing is cut off. */
static void test_fonts(void **state)
{
    screen *const s = open_screen(NULL);
    if (!s)
        skip();
    if (*s->sdl->plain(s->window)) {
        print_message("skipped: %s\n", s->sdl->plain(s->window));
        close_screen(s);
        skip();
    }
    check_sizes(s, 0.3);
    adcgs_drawing_init(&s->drawing, s->sdl->type(s->window)); /* a text without visible letters is no failure */
    adcgs_drawing_text(&s->drawing, 5, 5, 20, 100, "\xe2\x80\x8b", 0xffffffffu);
    show(s);
    close_screen(s);
}

static void write_fonts(const char *name, const char *contents)
{
    FILE *const file = fopen(name, "w");
    assert_non_null(file);
    fprintf(file, "<?xml version=\"1.0\"?>\n<!DOCTYPE fontconfig SYSTEM \"fonts.dtd\">\n<fontconfig>%s</fontconfig>\n", contents);
    fclose(file);
}

/** Letters outside ASCII are different letters, not boxes, also if the usual font lacks them: the Tifinagh ones at the end. */
static void test_letters(void **state)
{
    static const char *const texts[] = {"\xc3\xa4", "\xc3\xb1", "\xd0\xaf", "\xce\xa9", "\xe2\xb5\xa3", "\xe2\xb4\xb1"};
    uint8_t seen[ADCGS_COUNTOF(texts)][40 * 40];
    if (access(FONTS "/DejaVuSans.ttf", R_OK) || access(FONTS "/DejaVuSansMono.ttf", R_OK)) {
        print_message("skipped: no " FONTS "\n");
        skip();
    }
    write_fonts(in("mono.conf"), "<dir>" FONTS "</dir><alias><family>sans-serif</family><prefer><family>DejaVu Sans Mono</family>"
                                 "</prefer></alias>");
    screen *const s = open_screen(in("mono.conf"));
    if (!s)
        skip();
    if (*s->sdl->plain(s->window)) {
        print_message("skipped: %s\n", s->sdl->plain(s->window));
        close_screen(s);
        skip();
    }
    resize(s, sizes[0]);
    for (size_t i = 0; i < ADCGS_COUNTOF(texts); i++) {
        adcgs_drawing_init(&s->drawing, s->sdl->type(s->window));
        adcgs_drawing_text(&s->drawing, 5, 5, 20, 100, texts[i], 0xffffffffu);
        show(s);
        for (int p = 0; p < 40 * 40; p++)
            seen[i][p] = (uint8_t)ink(s, p % 40, p / 40);
        for (size_t k = 0; k < i; k++)
            assert_memory_not_equal(seen[i], seen[k], sizeof seen[i]);
    }
    close_screen(s);
}

/** Without a font, letters are the built-in ones. */
static void test_plain(void **state)
{
    static const char picture[] = "..#..."
                                  ".#.#.."
                                  "#...#."
                                  "#...#."
                                  "#####."
                                  "#...#."
                                  "#...#."
                                  "......"
                                  "......";
    write_fonts(in("fonts.conf"), "");
    screen *const s = open_screen(in("fonts.conf"));
    if (!s)
        skip();
    assert_true(*s->sdl->plain(s->window));
    check_sizes(s, 0.3);
    resize(s, sizes[0]);
    adcgs_drawing_init(&s->drawing, s->sdl->type(s->window));
    adcgs_drawing_rect(&s->drawing, (adcgs_rect){0, 0, 60, 60}, 0x102030ffu);
    adcgs_drawing_text(&s->drawing, 3, 5, 18, 50, "A", 0xa0b0c0ffu);
    show(s);
    const adcgs_rect *const place = &s->drawing.shape[1].place;
    const int top = place->y + (place->height - 2 * ADCGS_GLYPH_HEIGHT) / 2;
    for (int y = 0; y < 60; y++)
        for (int x = 0; x < 60; x++) {
            const int column = (x - 3) / 2, row = (y - top) / 2, inside = x >= 3 && y >= top && column < 6 && row < 9;
            assert_int_equal(ink(s, x, y), inside && picture[6 * row + column] == '#' ? 0xc0 : 0x30);
        }
    close_screen(s);
}

int adcgs_test_play_window(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_fonts), cmocka_unit_test(test_letters),
                                       cmocka_unit_test(test_plain)};
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
