/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Runs that are given what they cannot thrive on: steps too long, none at all, points that no camera sees, pictures of which
 * nothing is known. They end well, or say why not.
 */
#include "tiny_scene.h"

#include "encode/encode.h"
#include "train/contrast.h"
#include "train/schedule.h"
#include "train/views.h"

#include <math.h>

static adcgs_trainer *make(const adcgs_train_config *config)
{
    adcgs_trainer *t;
    if (adcgs_trainer_create(&t, scene, config, adcgs_cpu_best(), pool, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    t->quantise = adcgs_encode_quantise_hook;
    return t;
}

/* ---- Steps ---- */

/* ---- Points and pictures ---- */

/** Pixels that are not known have no part in the contrast, and so none in lambda. */
static void contrast_is_of_what_is_known(void **state)
{
    const adcgs_train_config config = small_config();
    adcgs_trainer *t = make(&config);
    double contrast;
    (void)state;
    assert_int_equal(adcgs_trainer_load_views(t, 1, &error), ADCGS_OK);
    for (int known = 2; known >= 0; known--) { /* a pixel in so many, which is black or white by turns */
        for (uint32_t i = 0; i < t->n_views; i++) {
            const size_t plane = (size_t)t->views[i].view.width * (size_t)t->views[i].view.height;
            for (size_t j = 0; j < plane; j++)
                for (size_t c = 0; c < 3; c++)
                    t->taken[c * plane + j] = !known || (known == 2 && j % 2) ? (float)NAN : (float)(j / 2 % 2);
            assert_int_equal(adcgs_pictures_put(t->pictures, i, t->taken, &error), ADCGS_OK);
        }
        assert_int_equal(adcgs_contrast(t, &contrast, &error), ADCGS_OK);
        assert_float_equal(contrast, known ? 0.5 : 0, 1e-9);
    }
    adcgs_trainer_free(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(contrast_is_of_what_is_known),
    };
    return cmocka_run_group_tests_name("recovery", tests, open_scene, close_scene);
}
