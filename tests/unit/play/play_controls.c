/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The player's controls and overlay: places, presses, rest, and shapes. Their pixels are in play_window.c. */
#include "play_rig.h"
#include "second_sources.h"

#include "play/actions.h"
#include "play/controls.h"
#include "play/font.h"
#include "play/overlay.h"

#include <math.h>

static const adcgs_play_figures figures = {.seconds = 0.01, .width = 640, .height = 480};

static adcgs_rect place_of(const adcgs_play_state *play, adcgs_play_control control)
{
    adcgs_controls controls;
    adcgs_controls_place(&controls, play);
    return controls.place[control];
}

static void press_at(adcgs_play_state *play, const adcgs_rect *r, int down)
{
    button(play, 1, down, r->x + r->width / 2.0, r->y + r->height / 2.0);
}

static void click(adcgs_play_state *play, adcgs_play_control control)
{
    const adcgs_rect r = place_of(play, control);
    assert_true(r.width > 0);
    press_at(play, &r, 1);
    press_at(play, &r, 0);
}

/** A click has the effect of a key. It needs press and release on the same button, and never moves the camera. */
static void test_presses(void **state)
{
    adcgs_filmed_camera cameras[2] = TWO_CAMERAS;
    adcgs_play_state play = make_state(cameras);
    const adcgs_orbit_control before = play.control;
    click(&play, ADCGS_CONTROL_PLAY);
    assert_true(play.clock.playing);
    click(&play, ADCGS_CONTROL_PLAY);
    assert_false(play.clock.playing);
    click(&play, ADCGS_CONTROL_FULL);
    assert_true(play.full);
    click(&play, ADCGS_CONTROL_HELP);
    assert_true(play.help);
    click(&play, ADCGS_CONTROL_HELP); /* closes it, and its release does not open it again */
    assert_false(play.help);
    const adcgs_rect r = place_of(&play, ADCGS_CONTROL_PLAY), other = place_of(&play, ADCGS_CONTROL_HELP);
    press_at(&play, &r, 1);
    motion(&play, 200, 200, 10, 10);
    press_at(&play, &other, 0);
    assert_true(!play.clock.playing && !play.help);
    click(&play, ADCGS_CONTROL_TIME); /* a text */
    assert_false(play.clock.playing);
    assert_memory_equal(&play.control, &before, sizeof before);
    click(&play, ADCGS_CONTROL_NEXT);
    assert_int_equal(play.jumped, 0);
    click(&play, ADCGS_CONTROL_NEXT);
    assert_int_equal(play.jumped, 1);
    click(&play, ADCGS_CONTROL_PREVIOUS);
    assert_int_equal(play.jumped, 0);
    button(&play, 3, 1, other.x + 1, other.y + 1); /* another button pans, as elsewhere */
    assert_int_equal(play.drag, ADCGS_DRAG_PAN);
}

static void test_scrub(void **state)
{
    adcgs_filmed_camera cameras[2] = TWO_CAMERAS;
    adcgs_play_state play = make_state(cameras);
    const adcgs_orbit_control before = play.control;
    const adcgs_rect bar = place_of(&play, ADCGS_CONTROL_SLIDER);
    assert_true(bar.width > 600);
    button(&play, 1, 1, bar.x + bar.width - 1, bar.y + 3);
    assert_int_equal(adcgs_play_clock_frame(&play.clock), 9);
    motion(&play, bar.x + bar.width / 3.0, 20, -9, -9); /* the slider is still dragged, wherever the pointer is */
    assert_int_equal(adcgs_play_clock_frame(&play.clock), 3);
    motion(&play, -500, 20, -9, -9);
    assert_int_equal(adcgs_play_clock_frame(&play.clock), 0);
    button(&play, 1, 0, 0, 20);
    motion(&play, bar.x + bar.width / 2.0, bar.y + 3, 9, 9);
    assert_int_equal(adcgs_play_clock_frame(&play.clock), 0);
    assert_memory_equal(&play.control, &before, sizeof before);
    key(&play, 'b');
    assert_int_equal(place_of(&play, ADCGS_CONTROL_SLIDER).width, 0);
}

/** While playing, the controls rest three seconds after the last movement of the pointer. Resting controls are not pressed. */
static void test_rest(void **state)
{
    adcgs_filmed_camera cameras[2] = TWO_CAMERAS;
    adcgs_play_state play = make_state(cameras);
    const adcgs_rect r = place_of(&play, ADCGS_CONTROL_HELP), slider = place_of(&play, ADCGS_CONTROL_SLIDER);
    adcgs_play_tick(&play, 59.0);
    assert_true(place_of(&play, ADCGS_CONTROL_PLAY).width > 0); /* not while it is paused */
    key(&play, ' ');
    assert_int_equal(place_of(&play, ADCGS_CONTROL_PLAY).width, 0);
    motion(&play, 300, 100, 1, 0);
    adcgs_play_tick(&play, 61.9);
    assert_true(place_of(&play, ADCGS_CONTROL_PLAY).width > 0);
    adcgs_play_tick(&play, 62.1);
    assert_int_equal(place_of(&play, ADCGS_CONTROL_PLAY).width, 0);
    press_at(&play, &r, 1); /* shows them, but presses none: the user did not see it */
    assert_int_equal(play.drag, ADCGS_DRAG_ORBIT);
    press_at(&play, &r, 0);
    assert_true(!play.help && place_of(&play, ADCGS_CONTROL_PLAY).width > 0);
    press_at(&play, &slider, 1); /* a slider that is dragged stays */
    adcgs_play_tick(&play, 80.0);
    assert_true(place_of(&play, ADCGS_CONTROL_SLIDER).width > 0);
}

static void test_pointed(void **state)
{
    adcgs_filmed_camera cameras[2] = TWO_CAMERAS;
    adcgs_play_state play = make_state(cameras);
    adcgs_drawing *const drawing = malloc(sizeof *drawing);
    assert_int_equal(adcgs_play_pointed(&play), ADCGS_CONTROL_NONE);
    adcgs_overlay_draw(drawing, &adcgs_glyph_type, &play, &figures);
    const int plain = drawing->n;
    for (int c = ADCGS_CONTROL_SLIDER; c <= ADCGS_CONTROL_FULL; c++) {
        const adcgs_rect r = place_of(&play, (adcgs_play_control)c);
        motion(&play, r.x + 1, r.y + 1, 1, 1);
        assert_int_equal(adcgs_play_pointed(&play), c);
        adcgs_overlay_draw(drawing, &adcgs_glyph_type, &play, &figures);
        assert_true(drawing->n >= plain + 2); /* a label and its background */
    }
    adcgs_play_event(&play, &(adcgs_event){.kind = ADCGS_EVENT_LEAVE});
    assert_int_equal(adcgs_play_pointed(&play), ADCGS_CONTROL_NONE);
    motion(&play, 1, 479, 1, 1);
    assert_int_equal(adcgs_play_pointed(&play), ADCGS_CONTROL_BACK);
    key(&play, 'f'); /* in flight the pointer is captured */
    assert_int_equal(adcgs_play_pointed(&play), ADCGS_CONTROL_NONE);
    free(drawing);
}

static int meet(const adcgs_rect *a, const adcgs_rect *b)
{
    return a->width && b->width && a->x < b->x + b->width && b->x < a->x + a->width && a->y < b->y + b->height &&
           b->y < a->y + a->height;
}

/** In a window of any size controls are inside, apart from each other, and large enough to press. */
static void test_places(void **state)
{
    adcgs_filmed_camera cameras[2] = TWO_CAMERAS;
    adcgs_play_state play = make_state(cameras);
    for (int width = 64; width < 4200; width += 37)
        for (int height = 64; height < 2400; height += 53) {
            adcgs_controls c;
            adcgs_play_resize(&play, width, height, 1.0 + width % 3);
            adcgs_controls_place(&c, &play);
            for (int i = ADCGS_CONTROL_SLIDER; i < ADCGS_CONTROL_BACK; i++) {
                const adcgs_rect *const r = &c.place[i];
                assert_true(!r->width ||
                            (r->x >= 0 && r->x + r->width <= width && r->y >= c.back.y && r->y + r->height <= height));
                assert_true(!r->width || (r->height >= c.size && r->width >= c.size));
                for (int k = ADCGS_CONTROL_SLIDER; k < i; k++)
                    assert_false(meet(r, &c.place[k]));
            }
            assert_true(!c.back.width || c.place[ADCGS_CONTROL_PLAY].width);
        }
    play.clock.frames = 1; /* a still scene without cameras has only help and full screen */
    play.cameras = 0;
    adcgs_play_resize(&play, 1280, 720, 1.0);
    for (int i = ADCGS_CONTROL_SLIDER; i < ADCGS_CONTROL_BACK; i++)
        assert_int_equal(place_of(&play, (adcgs_play_control)i).width > 0, i == ADCGS_CONTROL_HELP || i == ADCGS_CONTROL_FULL);
}

static void test_sizes(void **state)
{
    adcgs_filmed_camera cameras[2] = TWO_CAMERAS;
    adcgs_play_state play = make_state(cameras);
    const struct {
        int width, height;
        double density;
        int size;
    } windows[] = {{320, 240, 1.0, 11},  {640, 480, 1.0, 11},  {1280, 720, 1.0, 18}, {3840, 2160, 1.0, 54}, {640, 480, 2.0, 22},
                   {1280, 720, 2.0, 22}, {720, 1280, 1.0, 12}, {64, 64, 1.0, 6},     {3840, 2160, 2.0, 54}, {64, 64, 3.0, 6}};
    for (size_t i = 0; i < ADCGS_COUNTOF(windows); i++) {
        adcgs_play_resize(&play, windows[i].width, windows[i].height, windows[i].density);
        assert_int_equal(adcgs_text_size(&play), windows[i].size);
    }
}

/* ---- Shapes. ---- */

/** Letters that are wider than those of most fonts. */
static int wide_letters(void *arg, int size, const char *text)
{
    int n = 0;
    for (; *text; text++)
        n += ((unsigned char)*text & 0xc0) != 0x80;
    return n * size * 3 / 4;
}

static int has_text(const adcgs_drawing *d, const char *text)
{
    for (int i = 0; i < d->n; i++)
        if (d->shape[i].kind == ADCGS_SHAPE_TEXT && !strcmp(d->text + d->shape[i].text, text))
            return 1;
    return 0;
}

/** All shapes are inside the window. From 320x240 on the help is complete, in a legible size. */
static void test_overlay(void **state)
{
    static const adcgs_type wide = {.width = wide_letters};
    adcgs_filmed_camera cameras[2] = TWO_CAMERAS;
    adcgs_play_state play = make_state(cameras);
    adcgs_drawing *const drawing = malloc(sizeof *drawing);
    int n;
    const adcgs_play_help *const lines = adcgs_play_help_lines(&n);
    key(&play, 'i');
    motion(&play, 1, 470, 1, 1);
    for (int help = 0; help < 2; help++) {
        play.help = help;
        play.hint_end = INFINITY;
        for (int width = 64; width < 4000; width += 173)
            for (int height = 64; height < 2300; height += 119)
                for (int which = 0; which < 2; which++) {
                    adcgs_play_resize(&play, width, height, 1.0 + width / 700);
                    adcgs_play_say(
                        &play, "a long message of many words with/a/very/long/path/that/has/no/space/in/it/at/all/at/all/at/all");
                    adcgs_overlay_draw(drawing, which ? &wide : &adcgs_glyph_type, &play, &figures);
                    assert_true(adcgs_drawing_inside(drawing, width, height));
                }
        adcgs_play_resize(&play, 320, 240, 1.0);
        adcgs_overlay_draw(drawing, &adcgs_glyph_type, &play, &figures);
        for (int i = 0; i < n; i++)
            assert_int_equal(has_text(drawing, lines[i].keys) && has_text(drawing, lines[i].text), help);
    }
    free(drawing);
}

/** The hint is there until the first key, or some seconds; the message for some seconds. */
static void test_hint(void **state)
{
    adcgs_filmed_camera cameras[2] = TWO_CAMERAS;
    adcgs_play_state play = make_state(cameras), second = play;
    adcgs_drawing *const drawing = malloc(sizeof *drawing);
    adcgs_overlay_draw(drawing, &adcgs_glyph_type, &play, &figures);
    assert_true(has_text(drawing, "h for help"));
    motion(&play, 10, 10, 1, 1);
    adcgs_overlay_draw(drawing, &adcgs_glyph_type, &play, &figures);
    assert_true(has_text(drawing, "h for help"));
    key(&play, 'l');
    adcgs_overlay_draw(drawing, &adcgs_glyph_type, &play, &figures);
    assert_true(!has_text(drawing, "h for help") && has_text(drawing, "no loop"));
    adcgs_play_tick(&play, 60.0);
    adcgs_overlay_draw(drawing, &adcgs_glyph_type, &play, &figures);
    assert_false(has_text(drawing, "no loop"));
    adcgs_play_tick(&second, 57.0);
    assert_true(adcgs_overlay_hints(&second));
    adcgs_play_tick(&second, 59.0);
    assert_false(adcgs_overlay_hints(&second));
    free(drawing);
}

static int byte_letters(void *arg, int size, const char *text)
{
    return (int)strlen(text) * size;
}

/** Text is UTF-8. Names of streams may be anything. */
static void test_text(void **state)
{
    adcgs_filmed_camera cameras[2] = TWO_CAMERAS;
    adcgs_play_state play = make_state(cameras);
    static const adcgs_type bytes = {.width = byte_letters};
    adcgs_drawing *const d = malloc(sizeof *d);
    adcgs_drawing_init(d, &adcgs_glyph_type);
    assert_int_equal(adcgs_drawing_text(d, 0, 0, 9, 1000, "\xc3\xa4\xe2\x82\xac", 1), 11);
    assert_string_equal(d->text + d->shape[0].text, "\xc3\xa4\xe2\x82\xac");
    adcgs_drawing_text(d, 0, 0, 9, 1000, "a\xff\x1b[0m\n\xe2\x80\xae", 1);
    assert_string_equal(d->text + d->shape[1].text, "a??[0m??");
    assert_true(adcgs_drawing_text(d, 0, 0, 9, 41, "\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4", 1) <= 41);
    assert_string_equal(d->text + d->shape[2].text, "\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4..."); /* cut between characters */
    assert_int_equal(adcgs_drawing_text(d, 0, 0, 9, 10, "abc", 1), 0);
    assert_int_equal(d->n, 3);
    adcgs_drawing_init(d, &bytes);
    adcgs_drawing_text(d, 0, 0, 1, 8, "\xe2\x82\xac\xe2\x82\xac\xe2\x82\xac", 1);
    assert_string_equal(d->text + d->shape[0].text, "\xe2\x82\xac...");
    char longest[2000];
    memset(longest, 0xc3, sizeof longest);
    for (size_t i = 1; i < sizeof longest; i += 2)
        longest[i] = (char)0xa4;
    longest[sizeof longest - 2] = 0;
    for (int i = 0; i < 1000; i++) /* too much is left out, and noted */
        adcgs_drawing_text(d, 0, 0, 9, 1000, longest, 1);
    assert_true(d->full && !adcgs_drawing_inside(d, 10000, 10000));
    snprintf(play.control.camera.name, sizeof play.control.camera.name, "cam\xc3\xa9ra\n");
    adcgs_overlay_draw(d, &adcgs_glyph_type, &play, &figures);
    assert_true(has_text(d, "cam\xc3\xa9ra?"));
    for (int c = ' ' + 1; c < 127; c++) /* all letters exist, and no two are equal */
        for (int e = c + 1; e < 127; e++)
            assert_memory_not_equal(adcgs_glyph((char)c), adcgs_glyph((char)e), ADCGS_GLYPH_HEIGHT);
    assert_ptr_equal(adcgs_glyph((char)0xe4), adcgs_glyph('?'));
    assert_ptr_equal(adcgs_glyph('\t'), adcgs_glyph('?'));
    free(d);
}

int adcgs_test_play_controls(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_presses), cmocka_unit_test(test_scrub),  cmocka_unit_test(test_rest),
        cmocka_unit_test(test_pointed), cmocka_unit_test(test_places), cmocka_unit_test(test_sizes),
        cmocka_unit_test(test_overlay), cmocka_unit_test(test_hint),   cmocka_unit_test(test_text),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
