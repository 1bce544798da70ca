/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Input of the player without a window: events, scripts, letters and panels. */
#include "play_rig.h"

#include "play/actions.h"
#include "play/overlay.h"
#include "play/panel.h"
#include "play/play_state.h"
#include "play/script.h"

#include <math.h>

static adcgs_play_state make_state(const adcgs_camera cameras[2])
{
    const adcgs_info info = make_info("right-handed, z up");
    const adcgs_camera home = make_camera();
    adcgs_play_state play;
    adcgs_play_init(&play, &info, &home, cameras);
    adcgs_play_resize(&play, 640, 480, 1.0);
    adcgs_play_tick(&play, 50.0);
    return play;
}

static void key(adcgs_play_state *play, int code)
{
    adcgs_play_event(play, &(adcgs_event){.kind = ADCGS_EVENT_KEY, .key = code, .down = 1});
    adcgs_play_event(play, &(adcgs_event){.kind = ADCGS_EVENT_KEY, .key = code});
}

static void button(adcgs_play_state *play, int which, int down, double x, double y)
{
    adcgs_play_event(play, &(adcgs_event){.kind = ADCGS_EVENT_BUTTON, .button = which, .down = down, .x = x, .y = y});
}

static void motion(adcgs_play_state *play, double x, double y, double dx, double dy)
{
    adcgs_play_event(play, &(adcgs_event){.kind = ADCGS_EVENT_MOTION, .x = x, .y = y, .dx = dx, .dy = dy});
}

static void test_keys(void **state)
{
    adcgs_camera cameras[2] = {make_camera(), make_camera()};
    cameras[1].cam_to_world[3] = 7.0;
    adcgs_play_state play = make_state(cameras);
    key(&play, ' ');
    assert_true(play.clock.playing && adcgs_play_moving(&play));
    key(&play, ADCGS_KEY_RIGHT);
    assert_true(!play.clock.playing && adcgs_play_clock_frame(&play.clock) == 1);
    key(&play, ADCGS_KEY_END);
    assert_int_equal(adcgs_play_clock_frame(&play.clock), 9);
    key(&play, 'l');
    assert_false(play.clock.loop);
    for (int i = 0; i < 9; i++)
        key(&play, '-');
    assert_int_equal(play.layers, 1);
    key(&play, '=');
    assert_int_equal(play.layers, 2);
    key(&play, '1');
    assert_true(play.jumped == 1 && play.control.camera.cam_to_world[3] == 7.0);
    key(&play, ']');
    assert_int_equal(play.jumped, 0);
    key(&play, '[');
    assert_int_equal(play.jumped, 1);
    key(&play, '7'); /* no such camera */
    assert_true(play.jumped == 1 && strstr(play.message, "2 cameras"));
    key(&play, 'r');
    assert_true(play.jumped == -1 && play.control.camera.cam_to_world[3] == 1.0);
    key(&play, 'p');
    assert_int_equal(play.shot, ADCGS_SOURCE_IMAGE_PNG);
    adcgs_play_event(&play, &(adcgs_event){.kind = ADCGS_EVENT_KEY, .key = ADCGS_KEY_SHIFT, .down = 1});
    key(&play, 'p');
    assert_int_equal(play.shot, ADCGS_SOURCE_IMAGE_EXR);
    key(&play, 'k'); /* with shift, still */
    assert_int_equal(play.key_frame, -1);
    adcgs_play_event(&play, &(adcgs_event){.kind = ADCGS_EVENT_KEY, .key = ADCGS_KEY_SHIFT, .down = 0});
    key(&play, 'k');
    assert_int_equal(play.key_frame, 1);
    key(&play, 'v');
    assert_true(play.record);
    key(&play, 'v');
    assert_false(play.record);
    key(&play, ADCGS_KEY_F11);
    key(&play, 'h');
    key(&play, ADCGS_KEY_ESCAPE);
    assert_true(!play.help && play.full && !play.quit);
    key(&play, ADCGS_KEY_ESCAPE);
    assert_true(!play.full && !play.quit);
    key(&play, ADCGS_KEY_ESCAPE);
    assert_true(play.quit);
}

/** q quits, except in flight, where it moves down. */
static void test_quit(void **state)
{
    adcgs_camera cameras[2] = {make_camera(), make_camera()};
    adcgs_play_state play = make_state(cameras);
    key(&play, 'f');
    adcgs_play_event(&play, &(adcgs_event){.kind = ADCGS_EVENT_KEY, .key = 'q', .down = 1});
    assert_true(play.held && !play.quit);
    adcgs_play_event(&play, &(adcgs_event){.kind = ADCGS_EVENT_KEY, .key = 'q', .down = 0});
    key(&play, 'f');
    key(&play, 'q');
    assert_true(play.quit);
}

/** A held key repeats single steps, and nothing else. */
static void test_repeats(void **state)
{
    adcgs_camera cameras[2] = {make_camera(), make_camera()};
    adcgs_play_state play = make_state(cameras);
    for (int i = 0; i < 3; i++) {
        adcgs_play_event(&play, &(adcgs_event){.kind = ADCGS_EVENT_KEY, .key = 'i', .down = 1, .again = i > 0});
        adcgs_play_event(&play, &(adcgs_event){.kind = ADCGS_EVENT_KEY, .key = ADCGS_KEY_RIGHT, .down = 1, .again = i > 0});
    }
    assert_true(play.statistics && adcgs_play_clock_frame(&play.clock) == 3);
}

static void test_mouse(void **state)
{
    adcgs_camera cameras[2] = {make_camera(), make_camera()};
    adcgs_play_state play = make_state(cameras);
    const adcgs_orbit_control before = play.control;
    motion(&play, 10, 10, 10, 10); /* without a button nothing moves */
    assert_memory_equal(&play.control, &before, sizeof before);
    assert_false(adcgs_play_moving(&play));
    button(&play, 1, 1, 100, 100);
    motion(&play, 200, 100, 100, 0);
    assert_true(adcgs_play_moving(&play) && fabs(adcgs_orbit_control_distance(&play.control) - 6.0) < 1e-12);
    assert_true(play.control.camera.cam_to_world[3] < 1.0 && looks_at(&play.control, play.control.centre) > 1.0 - 1e-12);
    assert_string_equal(play.control.camera.name, ""); /* no longer the first camera */
    button(&play, 1, 0, 200, 100);
    adcgs_play_tick(&play, 51.0);
    assert_false(adcgs_play_moving(&play));
    key(&play, 'r');
    button(&play, 3, 1, 100, 100); /* the point under the pointer stays there: 50 pixels of 500 at a depth of 6 */
    motion(&play, 150, 100, 50, 0);
    button(&play, 3, 0, 150, 100);
    assert_true(fabs(play.control.camera.cam_to_world[3] - (1.0 - 0.6)) < 1e-12);
    adcgs_play_event(&play, &(adcgs_event){.kind = ADCGS_EVENT_WHEEL, .dy = 1.0});
    assert_true(fabs(adcgs_orbit_control_distance(&play.control) - 5.4) < 1e-9);
}

static void test_scrub(void **state)
{
    adcgs_camera cameras[2] = {make_camera(), make_camera()};
    adcgs_play_state play = make_state(cameras);
    const adcgs_orbit_control before = play.control;
    const adcgs_rect bar = adcgs_play_bar(&play);
    assert_true(bar.width > 400 && bar.y + bar.height == 480);
    button(&play, 1, 1, bar.width - 1, bar.y + 3);
    assert_int_equal(adcgs_play_clock_frame(&play.clock), 9);
    motion(&play, bar.width / 3.0, 20, -9, -9); /* the bar is still dragged, wherever the pointer is */
    assert_int_equal(adcgs_play_clock_frame(&play.clock), 3);
    button(&play, 1, 0, 0, 20);
    assert_memory_equal(&play.control, &before, sizeof before);
    key(&play, 'b');
    assert_int_equal(adcgs_play_bar(&play).width, 0);
}

static void test_flight(void **state)
{
    adcgs_camera cameras[2] = {make_camera(), make_camera()};
    adcgs_play_state play = make_state(cameras);
    key(&play, 'f');
    adcgs_play_event(&play, &(adcgs_event){.kind = ADCGS_EVENT_KEY, .key = 'w', .down = 1});
    adcgs_play_tick(&play, 50.5); /* half a second at one scene unit per second: 1.5 along +y */
    assert_true(fabs(play.control.camera.cam_to_world[7] + 2.5) < 1e-12 && adcgs_play_moving(&play));
    adcgs_play_event(&play, &(adcgs_event){.kind = ADCGS_EVENT_LOST}); /* losing the focus releases all keys */
    adcgs_play_tick(&play, 55.0);
    assert_true(fabs(play.control.camera.cam_to_world[7] + 2.5) < 1e-12);
    motion(&play, 0, 0, 16, 0);
    assert_true(play.control.camera.cam_to_world[2] > 0.05); /* turns to the right */
    key(&play, ADCGS_KEY_ESCAPE);
    assert_true(!play.flying && !play.quit);
}

/* ---- Letters and panels. ---- */

static uint32_t pixel(const adcgs_panel *panel, int x, int y)
{
    const uint8_t *p = panel->rgba + 4 * (y * panel->width + x);
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3];
}

static void test_letters(void **state)
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
    adcgs_panel panel = {0};
    adcgs_panel_init(&panel, 60, 40, 0x01020304);
    adcgs_panel_text(&panel, 3, 5, 2, "\nA", 0xa0b0c0d0);
    for (int y = 0; y < 40; y++)
        for (int x = 0; x < 60; x++) {
            const int column = (x - 3) / 2, row = (y - 5 - 2 * ADCGS_CELL_HEIGHT) / 2;
            const int inside = x >= 3 && y >= 5 + 2 * ADCGS_CELL_HEIGHT && column < 6 && row < 9;
            assert_int_equal(pixel(&panel, x, y), inside && picture[6 * row + column] == '#' ? 0xa0b0c0d0 : 0x01020304);
        }
    /* Nothing is written beyond the edges: the sanitizers watch. */
    adcgs_panel_text(&panel, -7, -5, 3, "cut off on all sides\nyes\nyes\nyes", 1);
    adcgs_panel_fill(&panel, -100, -100, 1000, 1000, 0xffffffff);
    assert_int_equal(pixel(&panel, 59, 39), 0xffffffff);
    adcgs_panel_init(&panel, 100000, 1, 0);
    assert_int_equal(panel.width, 0);
    adcgs_panel_free(&panel);
    for (int c = ' ' + 1; c < 127; c++) /* all letters exist, and no two are equal */
        for (int d = c + 1; d < 127; d++)
            assert_memory_not_equal(adcgs_glyph((char)c), adcgs_glyph((char)d), ADCGS_GLYPH_HEIGHT);
    assert_ptr_equal(adcgs_glyph((char)0xe4), adcgs_glyph('?'));
    assert_ptr_equal(adcgs_glyph('\t'), adcgs_glyph('?'));
}

static void test_overlay(void **state)
{
    adcgs_camera cameras[2] = {make_camera(), make_camera()};
    const adcgs_play_figures figures = {.seconds = 0.01, .width = 640, .height = 480};
    adcgs_play_state play = make_state(cameras);
    adcgs_panel panels[ADCGS_PANELS] = {{0}};
    int shown = 0;
    adcgs_overlay_draw(panels, &play, &figures);
    for (int i = 0; i < ADCGS_PANELS; i++)
        shown += panels[i].width > 0;
    assert_int_equal(shown, 1); /* the bar */
    key(&play, 'i');
    key(&play, 'h');
    adcgs_play_say(&play, "%s", "a word");
    for (int size = 64; size < 2000; size += 97) { /* in a window of any size, panels begin inside it */
        adcgs_play_resize(&play, size, 2100 - size, 1.0 + size / 700);
        adcgs_overlay_draw(panels, &play, &figures);
        for (int i = 0; i < ADCGS_PANELS; i++)
            assert_true(panels[i].width > 0 && panels[i].x >= 0 && panels[i].y >= 0 && panels[i].x < size);
    }
    adcgs_play_resize(&play, 640, 480, 1.0);
    adcgs_play_tick(&play, 60.0);
    adcgs_overlay_draw(panels, &play, &figures);
    assert_int_equal(panels[2].width, 0);    /* the message is gone */
    for (int i = 0; i < ADCGS_PANELS; i++) { /* at this size everything is visible */
        assert_true(panels[i].x + panels[i].width <= 640 && panels[i].y + panels[i].height <= 480);
        adcgs_panel_free(&panels[i]);
    }
}

/* ---- Scripts. ---- */

static adcgs_status read_script(adcgs_script *script, const char *text)
{
    FILE *file = fopen(in("a.script"), "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
    return adcgs_script_read(script, in("a.script"), &error);
}

static void test_script(void **state)
{
    adcgs_script script;
    assert_int_equal(read_script(&script, "\xef\xbb\xbf# a word\n\n wait 10 frames\r\nwait 0.5 seconds\n"
                                          "drag shift-left 1 2 3.5 -4\nkey shift-p\nkey f1\n"
                                          "size 640x480\nexpect time 0.5 1e-3\nexpect size 64x65\nquit"),
                     ADCGS_OK);
    assert_int_equal(script.n, 9);
    const adcgs_script_line *const l = script.lines;
    assert_true(l[0].line == 3 && l[0].kind == ADCGS_SCRIPT_WAIT_FRAMES && l[0].number[0] == 10.0);
    assert_true(l[1].kind == ADCGS_SCRIPT_WAIT_SECONDS && l[1].number[0] == 0.5);
    assert_true(l[2].kind == ADCGS_SCRIPT_DRAG && l[2].shift && l[2].key == 1 && l[2].number[3] == -4.0);
    assert_true(l[3].key == 'p' && l[3].shift && l[4].key == ADCGS_KEY_F1 && !l[4].shift);
    assert_true(l[5].number[0] == 640.0 && l[5].number[1] == 480.0);
    assert_true(!strcmp(l[6].text, "time") && l[6].number[0] == 0.5 && l[6].number[1] == 1e-3);
    assert_true(l[7].number[1] == 65.0 && l[8].kind == ADCGS_SCRIPT_QUIT);
    adcgs_script_clear(&script);
    assert_int_equal(read_script(&script, "wait 3 bytes\nwait 2 tiers\nwait 4 segments\nwait end\n"), ADCGS_OK);
    assert_true(script.n == 4 && script.lines[0].kind == ADCGS_SCRIPT_WAIT_BYTES && script.lines[0].number[0] == 3.0);
    assert_true(script.lines[1].kind == ADCGS_SCRIPT_WAIT_TIERS && script.lines[2].kind == ADCGS_SCRIPT_WAIT_SEGMENTS);
    assert_true(script.lines[3].kind == ADCGS_SCRIPT_WAIT_END);
    adcgs_script_clear(&script);
}

static void test_bad_scripts(void **state)
{
    static const char *const bad[] = {"jump",
                                      "wait",
                                      "wait 3",
                                      "wait end 3",
                                      "wait 3 end",
                                      "wait -1 frames",
                                      "wait x frames",
                                      "drag left 1 2 3",
                                      "key",
                                      "drag nose 1 2 3 4",
                                      "key enter2",
                                      "key shift-",
                                      "size 10x10",
                                      "size 640",
                                      "size 640x480x3",
                                      "size 1e5x70",
                                      "screenshot",
                                      "grab a b",
                                      "expect",
                                      "expect time",
                                      "expect time 1 2 3",
                                      "expect size 3",
                                      "quit now",
                                      "wheel nan",
                                      "wheel 1e300",
                                      "move 1"};
    for (size_t i = 0; i < ADCGS_COUNTOF(bad); i++) {
        adcgs_script script;
        char text[100];
        snprintf(text, sizeof text, "quit\n%s\nquit\n", bad[i]);
        if (read_script(&script, text) != ADCGS_ERR_USAGE)
            fail_msg("\"%s\" was accepted as a command", bad[i]);
        assert_non_null(strstr(error.text, "a.script: line 2 is no command"));
        assert_null(script.lines);
    }
    adcgs_script script;
    assert_int_equal(adcgs_script_read(&script, in("none"), &error), ADCGS_ERR_IO);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_keys),        cmocka_unit_test(test_quit),    cmocka_unit_test(test_repeats),
        cmocka_unit_test(test_mouse),       cmocka_unit_test(test_scrub),   cmocka_unit_test(test_flight),
        cmocka_unit_test(test_letters),     cmocka_unit_test(test_overlay), cmocka_unit_test(test_script),
        cmocka_unit_test(test_bad_scripts),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
