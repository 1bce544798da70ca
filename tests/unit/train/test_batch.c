/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Iterations of several view passes: the tree by which they are summed, the resulting mean, whole runs of them, and runs that
 * share them.
 */
#include "tiny_scene.h"

#include "grad/random.h"
#include "train/batch.h"
#include "train/stages.h"
#include "train/view_pass.h"

#include <math.h>
#include <pthread.h>

/* ---- The tree ---- */

enum { MOST = 40, WIDE = 5 };

static float value_of(uint32_t place, size_t i)
{
    return (float)adcgs_random_normal(7, place, i) * (float)(1 << (place * 7 + i) % 20);
}

/** By tree_sum.h: two halves; the first is the longest power of two that leaves something. */
static float sum_of(uint32_t first, uint32_t n, size_t i)
{
    uint32_t half = 1;
    if (n == 1)
        return value_of(first, i);
    while (half * 2 < n)
        half *= 2;
    return sum_of(first, half, i) + sum_of(first + half, n - half, i);
}

/** The sum has the same bits for any division of the places between ranks. */
static void parts_sum_to_the_same_bits(void **state)
{
    static float room[MOST][WIDE];
    (void)state;
    for (uint32_t n = 1; n <= MOST; n++)
        for (uint32_t ranks = 1; ranks <= n && ranks < 9; ranks++) {
            adcgs_tree_part all[ADCGS_TREE_PARTS];
            int n_all = 0;
            for (uint32_t r = 0; r < ranks; r++) {
                adcgs_tree_part own[ADCGS_TREE_PARTS];
                int n_own = 0;
                for (uint32_t place = n * r / ranks; place < n * (r + 1) / ranks; place++) {
                    for (size_t i = 0; i < WIDE; i++)
                        room[place][i] = value_of(place, i);
                    n_own = adcgs_tree_add(own, n_own, (adcgs_tree_part){place, 1, room[place]}, WIDE);
                    assert_in_range(n_own, 1, ADCGS_TREE_PARTS - 1);
                }
                for (int i = 0; i < n_own; i++)
                    n_all = adcgs_tree_add(all, n_all, own[i], WIDE);
            }
            adcgs_tree_end(all, n_all, WIDE);
            assert_int_equal(all[0].n, n);
            for (size_t i = 0; i < WIDE; i++)
                assert_int_equal(adcgs_float_bits(all[0].sum[i]), adcgs_float_bits(sum_of(0, n, i)));
        }
}

/* ---- One iteration ---- */

/** A trainer before its step at an iteration. */
static adcgs_trainer *make_at(const adcgs_train_config *config, uint32_t stop)
{
    adcgs_trainer *t = make_trainer(config, pool);
    int stopped;
    assert_int_equal(adcgs_trainer_run(t, stop_at, &stop, &stopped, &error), ADCGS_OK);
    assert_int_equal(adcgs_stages_before(t, adcgs_trainer_progress(t), &error), ADCGS_OK);
    return t;
}

/** At the start, and while noise stands for rounding: the mean of four view passes, and the sum of their statistics. */
static void gradients_are_the_mean(void **state)
{
    static const uint32_t stops[] = {0, 20};
    adcgs_train_config config = small_config();
    config.iterations = 60;
    config.batch = 4;
    (void)state;
    for (size_t s = 0; s < ADCGS_COUNTOF(stops); s++) {
        adcgs_trainer *t = make_at(&config, stops[s]), *by_hand = make_at(&config, stops[s]);
        const double progress = adcgs_trainer_progress(t);
        const adcgs_param *p = &t->f->param[ADCGS_P_THETA], *q = &by_hand->f->param[ADCGS_P_THETA];
        float *g[4];
        double bits = 0;
        assert_int_equal(adcgs_batch_run(t, progress, &error), ADCGS_OK);
        for (uint32_t i = 0; i < 4; i++) {
            adcgs_view_result seen;
            g[i] = calloc(q->n, sizeof **g);
            assert_int_equal(adcgs_view_pass(by_hand, progress, 4 * stops[s] + i, &by_hand->stats, &seen, &error), ADCGS_OK);
            memcpy(g[i], q->g, q->n * sizeof *q->g);
            for (int j = 0; j < ADCGS_P_COUNT; j++)
                memset(by_hand->f->param[j].g, 0, by_hand->f->param[j].n * sizeof *q->g);
            assert_true(seen.loss > 0 && seen.loss == t->batch.results[i].loss && seen.mse == t->batch.results[i].mse);
            assert_true(seen.bits[ADCGS_GROUP_FV] == t->batch.results[i].bits[ADCGS_GROUP_FV]);
            bits += seen.bits[ADCGS_GROUP_FV];
        }
        assert_true((bits > 0) == (s > 0));
        for (size_t i = 0; i < p->n; i++)
            assert_true(p->g[i] == ((g[0][i] + g[1][i]) + (g[2][i] + g[3][i])) / 4);
        assert_int_equal(t->stats.n, by_hand->stats.n);
        for (size_t i = 0; i < adcgs_train_stats_size(t->f); i++)
            assert_float_equal(t->stats.weight[i], by_hand->stats.weight[i], 1e-5 * fabsf(t->stats.weight[i]));
        for (int i = 0; i < 4; i++)
            free(g[i]);
        adcgs_trainer_free(&t);
        adcgs_trainer_free(&by_hand);
    }
}

/* ---- Runs ---- */

static adcgs_train_config run_config(uint32_t batch)
{
    adcgs_train_config c = small_config();
    c.iterations = 40;
    c.batch = batch;
    c.densify_interval = 7;
    c.freeze_start = 0.92f;
    c.average_share = 0.1f;
    assert_int_equal(adcgs_train_set(&c, "rigidity_weight=0.02", &error), ADCGS_OK);
    c.params.adaptive_steps = batch % 2;
    return c;
}

static void assert_ends_alike(adcgs_trainer *a, adcgs_trainer *b)
{
    adcgs_buffer ends[2];
    store(a, &ends[0]);
    store(b, &ends[1]);
    assert_int_equal(ends[0].size, ends[1].size);
    assert_memory_equal(ends[0].data, ends[1].data, ends[0].size);
    adcgs_buffer_clear(&ends[0]);
    adcgs_buffer_clear(&ends[1]);
}

/** A run depends neither on threads nor on stopping at any stage. */
static void runs_end_alike(void **state)
{
    (void)state;
    for (uint32_t batch = 2; batch <= 3; batch++) {
        const adcgs_train_config config = run_config(batch);
        adcgs_trainer *through = make_trainer(&config, pool), *stopping = make_trainer(&config, NULL);
        run_trainer(through, NULL, NULL);
        for (uint32_t stop = 10; stop < config.iterations; stop += 10) {
            adcgs_buffer middle;
            run_trainer(stopping, stop_at, &stop);
            store(stopping, &middle);
            adcgs_trainer_free(&stopping);
            stopping = make_trainer(&config, NULL);
            assert_int_equal(adcgs_trainer_restore(stopping, middle.data, middle.size, &error), ADCGS_OK);
            adcgs_buffer_clear(&middle);
        }
        run_trainer(stopping, NULL, NULL);
        assert_ends_alike(through, stopping);
        adcgs_trainer_free(&through);
        adcgs_trainer_free(&stopping);
    }
}

/* ---- Teams of one thread each ---- */

enum { TEAM_MOST = 4 };

/** The place where team members swap data. */
typedef struct board {
    pthread_barrier_t all;
    const adcgs_ranks_part *out[TEAM_MOST];
    int n_out[TEAM_MOST];
    int faults;
    size_t bytes; /* swapped */
} board;

typedef struct member {
    adcgs_team team;
    board *board;
    adcgs_trainer *t;
    adcgs_train_observe observe;
    uint32_t stop;
    adcgs_status status;
    adcgs_error error;
    int stopped;
    pthread_t thread;
} member;

static adcgs_status swap(void *user, const adcgs_ranks_part *out, int n_out, const adcgs_ranks_part *in, int n_in,
                         adcgs_error *why)
{
    const member *m = user;
    board *b = m->board;
    int taken[TEAM_MOST] = {0};
    (void)why;
    b->out[m->team.rank] = out;
    b->n_out[m->team.rank] = n_out;
    pthread_barrier_wait(&b->all);
    for (int i = 0; i < n_in; i++) {
        const int from = in[i].rank;
        while (taken[from] < b->n_out[from] && b->out[from][taken[from]].rank != m->team.rank)
            taken[from]++;
        const adcgs_ranks_part *part = taken[from] < b->n_out[from] ? &b->out[from][taken[from]++] : NULL;
        if (part && part->bytes == in[i].bytes)
            memcpy(in[i].data, part->data, part->bytes);
        else
            b->faults = 1;
        b->bytes += m->team.rank == 0 && part ? part->bytes : 0;
    }
    pthread_barrier_wait(&b->all);
    return ADCGS_OK;
}

static void *run_member(void *user)
{
    member *m = user;
    m->status = adcgs_trainer_run(m->t, m->observe, &m->stop, &m->stopped, &m->error);
    return NULL;
}

/** Runs the team's trainers to their end, or until the first one's observer says stop. */
static void run_team(member *team, int size, board *b)
{
    *b = (board){.faults = 0};
    assert_int_equal(pthread_barrier_init(&b->all, NULL, (unsigned)size), 0);
    for (int r = 0; r < size; r++) {
        team[r].team = (adcgs_team){r, size, swap, &team[r]};
        team[r].board = b;
        team[r].t->team = &team[r].team;
        assert_int_equal(pthread_create(&team[r].thread, NULL, run_member, &team[r]), 0);
    }
    for (int r = 0; r < size; r++)
        pthread_join(team[r].thread, NULL);
    pthread_barrier_destroy(&b->all);
    assert_int_equal(b->faults, 0);
}

/** With any number of members, each ends with the state of a single run. All stop where the first one does. */
static void teams_end_as_one(void **state)
{
    static const int sizes[][2] = {{4, 2}, {5, 3}};
    (void)state;
    for (size_t i = 0; i < ADCGS_COUNTOF(sizes); i++) {
        const adcgs_train_config config = run_config((uint32_t)sizes[i][0]);
        const int size = sizes[i][1];
        adcgs_trainer *alone = make_trainer(&config, pool);
        member team[TEAM_MOST];
        board b;
        run_trainer(alone, NULL, NULL);
        for (int r = 0; r < size; r++)
            team[r] = (member){.t = make_trainer(&config, NULL), .observe = r ? NULL : stop_at, .stop = 20};
        run_team(team, size, &b);
        for (int r = 0; r < size; r++) {
            assert_int_equal(team[r].status, ADCGS_OK);
            assert_int_equal(team[r].t->run.iteration, 20);
            assert_true(team[r].stopped);
            team[r].stop = UINT32_MAX;
        }
        run_team(team, size, &b);
        assert_true(b.bytes > 0);
        for (int r = 0; r < size; r++) {
            assert_int_equal(team[r].status, ADCGS_OK);
            assert_ends_alike(alone, team[r].t);
            adcgs_trainer_free(&team[r].t);
        }
        adcgs_trainer_free(&alone);
    }
}

/** A member with a different computation is detected. */
static void strangers_are_noticed(void **state)
{
    const adcgs_train_config config = run_config(2);
    member team[2];
    board b;
    (void)state;
    for (int r = 0; r < 2; r++)
        team[r] = (member){.t = make_trainer(&config, NULL)};
    team[1].t->f->param[ADCGS_P_THETA].p[3] += 1e-6f;
    run_team(team, 2, &b);
    for (int r = 0; r < 2; r++) {
        assert_int_equal(team[r].status, ADCGS_ERR_DATA);
        assert_non_null(strstr(team[r].error.text, "at iteration 0 run 2 of the 2 that train together has a different model"));
        adcgs_trainer_free(&team[r].t);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parts_sum_to_the_same_bits), cmocka_unit_test(gradients_are_the_mean), cmocka_unit_test(runs_end_alike),
        cmocka_unit_test(teams_end_as_one),           cmocka_unit_test(strangers_are_noticed),
    };
    return cmocka_run_group_tests(tests, open_scene, close_scene);
}
