/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Settings: the table, presets, changes by name and by option, checks, and output. */
#include "config.h" /* for open_memstream() */

#include "train/settings.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

static adcgs_error error;

static adcgs_train_config preset(const char *name)
{
    adcgs_train_config c;
    assert_int_equal(adcgs_train_preset(&c, name, &error), ADCGS_OK);
    return c;
}

static adcgs_train_config draft_with(const char *settings)
{
    adcgs_train_config c = preset("draft");
    if (adcgs_train_set(&c, settings, &error) != ADCGS_OK)
        fail_msg("%s: %s", settings, error.text);
    return c;
}

static void expect_refused(adcgs_status status, const char *what)
{
    assert_int_equal(status, ADCGS_ERR_USAGE);
    if (!strstr(error.text, what))
        fail_msg("'%s' does not contain '%s'", error.text, what);
}

static void expect_same(const adcgs_train_config *a, const adcgs_train_config *b)
{
    for (const adcgs_setting *s = adcgs_settings; s->name; s++) {
        if (adcgs_setting_get(s, a) != adcgs_setting_get(s, b))
            fail_msg("%s is %g and %g", s->name, adcgs_setting_get(s, a), adcgs_setting_get(s, b));
        assert_int_equal(a->origin[s - adcgs_settings].given, b->origin[s - adcgs_settings].given);
    }
}

/** Every field has one row and one name, and every preset passes the check. */
static void the_table_is_sound(void **state)
{
    for (const adcgs_setting *s = adcgs_settings; s->name; s++) {
        assert_ptr_equal(adcgs_setting_find(s->name), s);
        assert_true(s->min < s->max && s->help[0] && s->help[strlen(s->help) - 1] != '.');
        for (const adcgs_setting *other = adcgs_settings; other < s; other++)
            assert_true(other->offset != s->offset && s->group >= other->group);
    }
    size_t common = 0;
    for (const adcgs_setting *s = adcgs_settings; s->name; s++)
        common += s->class == ADCGS_SETTING_COMMON;
    assert_true(common >= 10 && common <= 20);
    for (int i = 0; i < ADCGS_PRESETS; i++) {
        const adcgs_train_config c = preset(adcgs_train_presets[i]);
        if (adcgs_train_check(&c, &error) != ADCGS_OK)
            fail_msg("%s: %s", adcgs_train_presets[i], error.text);
        for (const adcgs_setting *s = adcgs_settings; s->name; s++)
            assert_true(adcgs_setting_is_preset(s, &c));
    }
    assert_null(adcgs_train_presets[ADCGS_PRESETS]);
    const adcgs_train_config fast = preset("fast"), paper = preset("paper");
    assert_true(fast.iterations == 20000 && fast.lambda == 0.1f && fast.params.k == 6 && fast.shape.step_sigma == 0.06f);
    assert_true(paper.max_anchors == 20000 && paper.params.time_width == 64 && paper.densify_start == 0.0125f);
    adcgs_train_config c;
    expect_refused(adcgs_train_preset(&c, "quick", &error), "unknown preset 'quick'");
}

/** A name sets its field, up to both ends of its range and no further, as a text and as a number. */
static void names_reach_their_fields(void **state)
{
    for (const adcgs_setting *s = adcgs_settings; s->name; s++) {
        char text[100], value[ADCGS_SETTING_TEXT];
        adcgs_train_config c = preset("fast");
        snprintf(text, sizeof text, "%s=%s", s->name, adcgs_setting_print(s, s->max, value));
        if (s->group == ADCGS_SETTING_SWITCHES) {
            expect_refused(adcgs_train_set(&c, text, &error), "unknown setting");
            expect_refused(adcgs_train_set_value(&c, s->name, 1, &error), "unknown setting");
            continue;
        }
        assert_int_equal(adcgs_train_set(&c, text, &error), ADCGS_OK);
        assert_string_equal(adcgs_setting_print(s, adcgs_setting_get(s, &c), text), value);
        for (const adcgs_setting *other = adcgs_settings; other->name; other++)
            assert_int_equal(adcgs_setting_is_given(&c, other->name), other == s);
        assert_int_equal(adcgs_train_set_value(&c, s->name, s->min, &error), ADCGS_OK);
        snprintf(text, sizeof text, "setting %s=", s->name);
        expect_refused(adcgs_train_set_value(&c, s->name, s->max + 1, &error), text);
        expect_refused(adcgs_train_set_value(&c, s->name, s->min - 1e-3, &error), text);
        expect_refused(adcgs_train_set_value(&c, s->name, (double)NAN, &error), text);
        if (s->kind != ADCGS_SETTING_REAL)
            expect_refused(adcgs_train_set_value(&c, s->name, s->min + 0.5, &error), "expected a whole number from");
    }
}

static void texts_that_are_no_settings_are_refused(void **state)
{
    static const char *const texts[][2] = {
        {"k=17", "setting k=17: expected a whole number from 1 to 16"},
        {"k=2.5", "setting k=2.5: expected a whole number"},
        {"k", "setting k=: expected a whole number"},
        {"k=", "setting k=: expected"},
        {"k=4x", "setting k=4x: expected"},
        {"lambda=nan", "setting lambda=nan: expected a number from 0 to 1000"},
        {"dropout=0.91", "expected a number from 0 to 0.9"},
        {"slim_at=0.5", "unknown setting 'slim_at'"},
        {"k=5,,chunks=1", "unknown setting ''"},
        {"lambda=0.0000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000001",
         "expected NAME=VALUE"},
    };
    for (size_t i = 0; i < ADCGS_COUNTOF(texts); i++) {
        adcgs_train_config c = preset("draft");
        expect_refused(adcgs_train_set(&c, texts[i][0], &error), texts[i][1]);
    }
}

/** An option of a program has the effect of its setting. */
static void options_mean_what_settings_mean(void **state)
{
    static const struct {
        const char *text, *name;
        double value;
    } both[] = {{"max_anchors=100", "max_anchors", 100},
                {"max_anchors=5000", "max_anchors", 5000},
                {"k=3", "k", 3},
                {"lambda=0.35", "lambda", 0.35},
                {"iterations=77", "iterations", 77},
                {"scale=2", "scale", 2},
                {"seed=9", "seed", 9}};
    for (size_t i = 0; i < ADCGS_COUNTOF(both); i++) {
        const adcgs_train_config set = draft_with(both[i].text);
        adcgs_train_config option = preset("draft");
        assert_int_equal(adcgs_train_set_value(&option, both[i].name, both[i].value, &error), ADCGS_OK);
        expect_same(&set, &option);
        assert_int_equal(adcgs_train_check(&set, &error), ADCGS_OK);
    }
    assert_int_equal(draft_with("max_anchors=100").start_anchors, 100);
    assert_int_equal(draft_with("max_anchors=100,max_anchors=2000").start_anchors, 600);
    assert_int_equal(draft_with("start_anchors=50,max_anchors=100").start_anchors, 50);
    assert_int_equal(draft_with("max_anchors=100,start_anchors=50").start_anchors, 50);
    const adcgs_train_config c = draft_with("start_anchors=500,max_anchors=100");
    expect_refused(adcgs_train_check(&c, &error), "start_anchors=500 and max_anchors=100");
}

/** A configuration from any source is checked as a whole. */
static void configurations_are_checked(void **state)
{
    static const char *const sets[][2] = {
        {"n_fg=9", "n_fg=9 and chunks=4: expected a multiple"},
        {"time_width=0", "time_rows=40 and time_width=0"},
        {"freeze_start=0.5", "freeze_start=0.5 and quant_round_start=0.85"},
    };
    for (size_t i = 0; i < ADCGS_COUNTOF(sets); i++) {
        const adcgs_train_config c = draft_with(sets[i][0]);
        expect_refused(adcgs_train_check(&c, &error), sets[i][1]);
    }
    adcgs_train_config c = preset("draft");
    c.params.k = 0;
    expect_refused(adcgs_train_check(&c, &error), "setting k=0: expected a whole number from 1 to 16");
    c = preset("draft");
    c.dropout = (float)NAN;
    expect_refused(adcgs_train_check(&c, &error), "setting dropout=nan");
    c = preset("draft");
    c.bf16 = 2;
    expect_refused(adcgs_train_check(&c, &error), "setting bf16=2");
    c = preset("draft");
    c.time_limit = -1;
    expect_refused(adcgs_train_check(&c, &error), "time limit of -1 s");
}

static void targets_are_checked(void **state)
{
    adcgs_train_config c = preset("draft");
    c.target = ADCGS_TARGET_PSNR;
    c.target_value = 30;
    assert_int_equal(adcgs_train_check(&c, &error), ADCGS_OK);
    c.target_value = 81;
    expect_refused(adcgs_train_check(&c, &error), "target of 81 dB: expected 5 to 80");
    c.target = ADCGS_TARGET_SIZE;
    assert_int_equal(adcgs_train_check(&c, &error), ADCGS_OK);
    c.without_rate = 1;
    expect_refused(adcgs_train_check(&c, &error), "need");
    c.without_rate = 0;
    assert_int_equal(adcgs_train_set(&c, "lambda=1", &error), ADCGS_OK);
    expect_refused(adcgs_train_check(&c, &error), "lambda=1 and a target size or PSNR");
}

/** The printed changes of a configuration reproduce it. */
static void changes_make_the_same_again(void **state)
{
    adcgs_train_config c = preset("medium");
    adcgs_buffer text;
    adcgs_buffer_init(&text);
    assert_int_equal(adcgs_train_changes(&c, &text, &error), ADCGS_OK);
    assert_string_equal((const char *)text.data, "");
    text.size = 0;
    assert_int_equal(adcgs_train_set(&c, "k=8,max_anchors=700,dropout=0.123456789,lambda=3,seed=4,iterations=50,scale=2", &error),
                     ADCGS_OK);
    assert_int_equal(adcgs_train_changes(&c, &text, &error), ADCGS_OK);
    assert_string_equal((const char *)text.data, "scale=2,dropout=0.12345679,k=8,start_anchors=700,max_anchors=700");
    adcgs_train_config again = preset("medium");
    assert_int_equal(adcgs_train_set(&again, (const char *)text.data, &error), ADCGS_OK);
    for (const adcgs_setting *s = adcgs_settings; s->name; s++)
        if (strcmp(s->name, "lambda") != 0 && strcmp(s->name, "iterations") != 0 && strcmp(s->name, "seed") != 0)
            assert_true(adcgs_setting_get(s, &c) == adcgs_setting_get(s, &again));
    adcgs_buffer_clear(&text);
}

static void parts_are_left_out(void **state)
{
    static const char *const synonyms[][2] = {{"densification", "refinement"},
                                              {"weight_steps", "lattice"},
                                              {"deformation", "fine,coarse"}};
    for (size_t i = 0; i < ADCGS_COUNTOF(synonyms); i++) {
        adcgs_train_config c = preset("fast"), d = preset("fast");
        assert_int_equal(adcgs_train_leave_out(&c, synonyms[i][0], &error), ADCGS_OK);
        assert_int_equal(adcgs_train_leave_out(&d, synonyms[i][1], &error), ADCGS_OK);
        expect_same(&c, &d);
        assert_int_equal(adcgs_train_check(&c, &error), ADCGS_OK);
    }
    adcgs_train_config c = preset("slow");
    assert_int_equal(adcgs_train_leave_out(&c, "anchors,densification,removal", &error), ADCGS_OK);
    assert_true(c.params.k == 1 && c.params.n_fg == 0 && c.max_anchors == 60000 && c.start_anchors == 60000);
    assert_true(c.without_densification && !c.without_rate && c.prune_units_at == 2 && c.prune_at == 2);
    assert_true(c.static_threshold <= 0 && c.detail_anchors >= 6 * preset("slow").detail_anchors);
    assert_int_equal(adcgs_train_check(&c, &error), ADCGS_OK);
    expect_refused(adcgs_train_leave_out(&c, "fine,", &error), "cannot leave out ''");
}

/** A former name sets the same field and is found in lists; former and present names do not overlap. */
static void former_names_are_understood(void **state)
{
    adcgs_train_config c = draft_with("static_threshold=0.25,lifetimes=0"), former = draft_with("still_below=0.25,spans=0");
    const char *list = "k=4,still_below=0,seed=1,spans=1", *one = "still_below";
    expect_same(&c, &former);
    for (const adcgs_setting_former *f = adcgs_settings_former; f->name; f++) {
        assert_non_null(adcgs_setting_find(f->now));
        for (const adcgs_setting *s = adcgs_settings; s->name; s++)
            assert_string_not_equal(s->name, f->name);
        assert_ptr_equal(adcgs_setting_find(f->name), adcgs_setting_find(f->now));
    }
    assert_string_equal(adcgs_setting_next_former(&list)->now, "static_threshold");
    assert_string_equal(adcgs_setting_next_former(&list)->now, "lifetimes");
    assert_null(adcgs_setting_next_former(&list));
    assert_string_equal(adcgs_setting_next_former(&one)->now, "static_threshold");
    assert_null(adcgs_setting_next_former(&one));
}

/** A line for each setting that has a name of its own, with the preset's value. */
static void the_list_tells_all(void **state)
{
    const adcgs_train_config c = draft_with("max_anchors=321");
    char *text = NULL;
    size_t size = 0, lines = 0;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    adcgs_train_list(&c, file);
    assert_int_equal(fclose(file), 0);
    for (const adcgs_setting *s = adcgs_settings; s->name; s++) {
        char line[60], value[ADCGS_SETTING_TEXT];
        snprintf(line, sizeof line, "\n  %-26s %-8s ", s->name, adcgs_setting_print(s, adcgs_setting_get(s, &c), value));
        assert_int_equal(strstr(text, line) != NULL, s->group != ADCGS_SETTING_SWITCHES);
    }
    for (const char *at = text; *at; at++)
        lines += at[0] == '\n' && at[1] == ' ';
    assert_true(lines > 50 && strstr(text, "\nCommon settings\n  iterations ") && strstr(text, "\nResearch: Run\n"));
    assert_true(strstr(text, "\n  max_anchors ") < strstr(text, "\nResearch: "));
    assert_true(strstr(text, "\n  max_anchors                321 ") && strstr(text, "preset draft"));
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_table_is_sound),
        cmocka_unit_test(names_reach_their_fields),
        cmocka_unit_test(texts_that_are_no_settings_are_refused),
        cmocka_unit_test(options_mean_what_settings_mean),
        cmocka_unit_test(configurations_are_checked),
        cmocka_unit_test(targets_are_checked),
        cmocka_unit_test(changes_make_the_same_again),
        cmocka_unit_test(parts_are_left_out),
        cmocka_unit_test(former_names_are_understood),
        cmocka_unit_test(the_list_tells_all),
    };
    return cmocka_run_group_tests_name("settings", tests, NULL, NULL);
}
