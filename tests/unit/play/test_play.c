/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Input of the player without a window: events and scripts. */
#include "play_rig.h"
#include "second_sources.h"

#include "play/actions.h"
#include "play/play_state.h"
#include "play/script.h"

#include <math.h>

static void test_keys(void **state)
{
    adcgs_filmed_camera cameras[2] = TWO_CAMERAS;
    cameras[1].camera.cam_to_world[3] = 7.0;
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
    adcgs_filmed_camera cameras[2] = TWO_CAMERAS;
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
    adcgs_filmed_camera cameras[2] = TWO_CAMERAS;
    adcgs_play_state play = make_state(cameras);
    for (int i = 0; i < 3; i++) {
        adcgs_play_event(&play, &(adcgs_event){.kind = ADCGS_EVENT_KEY, .key = 'i', .down = 1, .again = i > 0});
        adcgs_play_event(&play, &(adcgs_event){.kind = ADCGS_EVENT_KEY, .key = ADCGS_KEY_RIGHT, .down = 1, .again = i > 0});
    }
    assert_true(play.statistics && adcgs_play_clock_frame(&play.clock) == 3);
}

static void test_mouse(void **state)
{
    adcgs_filmed_camera cameras[2] = TWO_CAMERAS;
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

/** The help closes by the same key, by escape, and by a press, which does nothing else. */
static void test_help(void **state)
{
    adcgs_filmed_camera cameras[2] = TWO_CAMERAS;
    adcgs_play_state play = make_state(cameras);
    key(&play, 'h');
    assert_true(play.help);
    key(&play, 'h');
    assert_false(play.help);
    key(&play, ADCGS_KEY_F1);
    key(&play, ADCGS_KEY_ESCAPE);
    assert_true(!play.help && !play.quit);
    const adcgs_orbit_control before = play.control;
    key(&play, 'h');
    button(&play, 1, 1, 300, 200);
    motion(&play, 350, 200, 50, 0);
    button(&play, 1, 0, 350, 200);
    assert_false(play.help);
    assert_memory_equal(&play.control, &before, sizeof before);
}

/** A double click on the image asks for another pivot; on a control it is two clicks. */
static void test_pivot(void **state)
{
    adcgs_filmed_camera cameras[2] = TWO_CAMERAS;
    adcgs_play_state play = make_state(cameras);
    adcgs_event press = {.kind = ADCGS_EVENT_BUTTON, .button = 1, .down = 1, .clicks = 1, .x = 120, .y = 90};
    adcgs_play_event(&play, &press);
    const int asked = play.pivots;
    press.clicks = 2;
    adcgs_play_event(&play, &press);
    assert_true(play.pivots == asked + 1 && play.pivot_at[0] == 120.0 / 640 && play.pivot_at[1] == 90.0 / 480);
    press.y = 475;
    adcgs_play_event(&play, &press);
    assert_int_equal(play.pivots, asked + 1);
}

static void test_flight(void **state)
{
    adcgs_filmed_camera cameras[2] = TWO_CAMERAS;
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
    assert_int_equal(read_script(&script, "point help\nclick previous\nslide 0.25 1\n"), ADCGS_OK);
    assert_true(script.lines[0].kind == ADCGS_SCRIPT_POINT && script.lines[0].key == ADCGS_CONTROL_HELP);
    assert_true(script.lines[1].kind == ADCGS_SCRIPT_CLICK && script.lines[1].key == ADCGS_CONTROL_PREVIOUS);
    assert_true(script.lines[2].kind == ADCGS_SCRIPT_SLIDE && script.lines[2].number[0] == 0.25 &&
                script.lines[2].number[1] == 1.0);
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
                                      "move 1",
                                      "point",
                                      "click back",
                                      "click play play",
                                      "slide 0",
                                      "slide 0 1.1",
                                      "slide -0.1 1"};
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
        cmocka_unit_test(test_keys),        cmocka_unit_test(test_quit),   cmocka_unit_test(test_repeats),
        cmocka_unit_test(test_mouse),       cmocka_unit_test(test_flight), cmocka_unit_test(test_script),
        cmocka_unit_test(test_bad_scripts), cmocka_unit_test(test_help),   cmocka_unit_test(test_pivot),
    };
    const int failed = cmocka_run_group_tests(tests, make_folder, remove_folder);
    return failed + adcgs_test_play_controls() + adcgs_test_play_window();
}
