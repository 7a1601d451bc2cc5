/* SPDX-License-Identifier: MIT */
/*
 * Inner states of a step as messages: ghosts, accumulators, planes and hypotheses as receivers read
 * them, compared with the objects; message rates, turns, and messages left out.
 */
#include "rhotrack/publish.h"
#include "step_looks.h"
#include "tracker_setup.h"

#define SCAN_S 2.0
#define CLUTTER 12
#define SENSORS 3
#define MESSAGES_MAX 600

static struct rho_show show;
static struct rho_show_config shown;
static uint32_t picture[RHO_SHOW_PICTURE];
static struct rho_paper_starts starts;
static struct rho_passive_paper paper;

/* Messages that the last step sent. */
static struct message {
    char channel[24];
    uint8_t data[RHO_SHOW_MAX_SIZE];
    size_t size;
} messages[MESSAGES_MAX];
static unsigned num_messages;

static void show_kinds(unsigned kinds, unsigned per_s)
{
    rho_show_config_default(&shown);
    shown.kinds = (uint16_t)kinds;
    shown.messages_per_s = (uint16_t)per_s;
    shown.picture = picture;
    assert_int_equal(rho_show_init(&show, sizeof show, &shown), RHO_OK);
}

static void collect_messages(int is_frame, int64_t now_us)
{
    const struct rho_show_source source = {.tracker = &tracker,
                                           .report = &report,
                                           .starts = is_frame ? NULL : &starts,
                                           .paper = is_frame ? &paper : NULL,
                                           .step = 77,
                                           .epoch = 5};
    const char *channel;
    num_messages = 0;
    rho_show_begin(&show, &source, now_us);
    for (;;) {
        assert_true(num_messages < MESSAGES_MAX);
        struct message *next = &messages[num_messages];
        channel = rho_show_next(&show, &source, next->data, sizeof next->data, &next->size);
        if (!channel) {
            break;
        }
        assert_true(next->size > 0 && next->size <= RHO_SHOW_MAX_SIZE);
        strcpy(next->channel, channel);
        num_messages++;
    }
}

static unsigned count_messages_on(const char *channel)
{
    unsigned count = 0;
    for (unsigned i = 0; i < num_messages; i++) {
        count += strcmp(messages[i].channel, channel) == 0;
    }
    return count;
}

/* The n-th message on a channel; NULL: there are fewer. */
static const struct message *nth_message_on(const char *channel, unsigned n)
{
    for (unsigned i = 0; i < num_messages; i++) {
        if (strcmp(messages[i].channel, channel) == 0 && n-- == 0) {
            return &messages[i];
        }
    }
    return NULL;
}

#define READ(type, CHANNEL, n, into)                                                               \
    do {                                                                                           \
        const struct message *read_ = nth_message_on(RHO_MESSAGE_##CHANNEL##_CHANNEL, n);          \
        assert_non_null(read_);                                                                    \
        assert_int_equal(rho_message_##type##_decode(read_->data, read_->size, into), RHO_OK);     \
        assert_int_equal(rho_message_##type##_validate(into, NULL), RHO_OK);                       \
    } while (0)

/* Searches in plots */

static void start_with_method(enum rho_hough_method method, int gate)
{
    struct rho_paper_starts_config lines;
    use_usual_configs(5);
    config.gate = (uint8_t)gate;
    config.input.is_estimated = 1;
    begin_tracker();
    rho_paper_starts_config_default(&lines, method);
    lines.hough.rho_max_m = 5000.0f;
    lines.hough.rho_cell_m = 25.0f;
    lines.hough.theta_cell_rad = 0.02f;
    lines.hough.eps_rho_m = 25.0f;
    lines.hough.eps_theta_rad = 0.02f;
    assert_int_equal(rho_paper_starts_init(&starts, sizeof starts, &lines), RHO_OK);
}

static void step_plots(int k, int clutter)
{
    const double t_s = SCAN_S * k;
    num_plots = 0;
    add_plot(-3000.0 + 220.0 * t_s + 0.5 * normal(), 1500.0 - 90.0 * t_s + 0.5 * normal(), 0.5);
    for (int i = 0; i < clutter; i++) {
        const double x = uniform(-3500.0, 3500.0);
        add_plot(x, uniform(-3500.0, 3500.0), 0.5);
    }
    const struct rho_scan scan = {
        .time_us = (int64_t)(1e6 * t_s), .sensor_id = 1, .num_plots = num_plots, .plots = plots};
    assert_int_equal(rho_tracker_step(&tracker, NULL, &scan, &report), RHO_OK);
    assert_int_equal(rho_paper_starts_step(&starts, &tracker, &scan, &report), RHO_OK);
}

/* For every method: cells are the search's peaks, and one of them started the track. */
static void accumulator_messages_hold_the_searchs_peaks(void **state)
{
    (void)state;
    static const int8_t names[] = {RHO_MESSAGE_ACCUMULATOR_HT, RHO_MESSAGE_ACCUMULATOR_MHT,
                                   RHO_MESSAGE_ACCUMULATOR_IHT, RHO_MESSAGE_ACCUMULATOR_NHT,
                                   RHO_MESSAGE_ACCUMULATOR_NHT};
    for (int method = RHO_HOUGH_HT; method <= (int)RHO_HOUGH_NHT_C; method++) {
        static struct rho_message_accumulator accumulator;
        start_with_method((enum rho_hough_method)method, RHO_TRACKER_BEST);
        show_kinds(1u << RHO_SHOW_VOTES, 1000);
        for (int k = 0; k < 4; k++) {
            step_plots(k, CLUTTER);
            collect_messages(0, report.time_us);
            assert_int_equal(num_messages, k < 3 ? 0 : 5); /* the search needs 4 scans */
        }
        READ(accumulator, ACCUMULATOR, 0, &accumulator);
        assert_int_equal(accumulator.utime, 6000000);
        assert_int_equal(accumulator.oldest_utime, 0);
        assert_int_equal(accumulator.scan, 77);
        assert_int_equal(accumulator.epoch, 5);
        assert_int_equal(accumulator.method, names[method]);
        assert_int_equal(accumulator.has_pair, 0);
        assert_int_equal(accumulator.num_scans, 4);
        assert_in_range(accumulator.rho_cells, 64, 400);
        assert_float_equal(accumulator.rho_max_m - accumulator.rho_min_m,
                           25.0 * accumulator.rho_cells, 0.0);
        assert_true(accumulator.rho_min_m >= -5000.0f && accumulator.rho_max_m <= 5000.0f);
        assert_int_equal(accumulator.theta_cells, 158);
        assert_float_equal(accumulator.votes_max, starts.result.votes_max / 65536.0, 1e-4);
        assert_float_equal(accumulator.votes_min, 0.5 * accumulator.votes_max, 1e-4);
        assert_int_equal(accumulator.num_cells, starts.result.num_peaks);
        assert_float_equal(accumulator.cells[0].votes, accumulator.votes_max, 1e-4);
        unsigned started = 0;
        for (int i = 0; i < accumulator.num_cells; i++) {
            const struct rho_message_accumulator_cell *cell = &accumulator.cells[i];
            assert_true(cell->votes >= accumulator.votes_min - 1e-4f);
            if (cell->track_id > 0) {
                assert_non_null(report_of((uint32_t)cell->track_id));
                started++;
            }
            /* line of the target, (220, -90) m/s through (-3000, 1500) m */
            if (cell->track_id == 1) {
                assert_float_equal(cell->theta_rad, atan2(220.0, 90.0), 0.05);
                assert_float_equal(cell->rho_m, 252.4, 60.0);
                assert_int_equal(cell->scan_mask, starts.lines[i].line.mask);
                assert_in_range(cell->plots, 2, 4);
            }
        }
        assert_int_equal(started, report.num_tracks);
        assert_true(started > 0);
    }
}

/* Number of the 64 columns of a picture of all cells in which there are votes, and the first. */
static unsigned columns_with_votes(const uint32_t *all, unsigned *first)
{
    unsigned last = 0;
    *first = 64;
    for (unsigned i = 0; i < 158 * 400; i++) {
        const unsigned x = i % 400 * 64 / 400;
        *first = all[i] > 0 && x < *first ? x : *first;
        last = all[i] > 0 && x > last ? x : last;
    }
    return last + 1 - *first;
}

/*
 * The four parts are 64 rows: the largest value of each block of cells, in 127ths of the overall
 * maximum. The blocks are of the cells between the outer columns with votes.
 */
static void a_plane_message_is_the_reduced_picture_of_votes(void **state)
{
    (void)state;
    static uint32_t all[158 * 400];
    static struct rho_message_plane plane;
    static struct rho_message_accumulator accumulator;
    start_with_method(RHO_HOUGH_MHT, RHO_TRACKER_BEST);
    show_kinds(1u << RHO_SHOW_VOTES, 1000);
    for (int k = 0; k < 4; k++) {
        step_plots(k, CLUTTER);
        collect_messages(0, report.time_us);
    }
    const struct rho_hough_points points = rho_paper_starts_points(&starts);
    struct rho_votes_picture whole = {.height = 158, .width = 400, .votes = all};
    assert_int_equal(rho_hough_plane(&starts.hough, &points, RHO_HOUGH_VOTES, &whole), RHO_OK);
    unsigned filled = 0, fullest = 0, first;
    const unsigned columns = columns_with_votes(all, &first);
    const unsigned from = (first * 400 + 63) / 64, end = ((first + columns) * 400 + 63) / 64;
    READ(accumulator, ACCUMULATOR, 0, &accumulator);
    assert_true(columns < 64);
    assert_float_equal(accumulator.rho_min_m, -5000.0 + 25.0 * from, 0.0);
    assert_float_equal(accumulator.rho_max_m, -5000.0 + 25.0 * end, 0.0);
    for (unsigned part = 0; part < 4; part++) {
        READ(plane, PLANE, part, &plane);
        assert_int_equal(plane.part, part);
        assert_int_equal(plane.num_parts, 4);
        assert_int_equal(plane.num_rows, 16);
        assert_int_equal(plane.utime, 6000000);
        assert_float_equal(plane.votes_max, starts.result.votes_max / 65536.0, 1e-4);
        for (unsigned y = 0; y < 16; y++) {
            for (unsigned x = 0; x < 64; x++) {
                uint32_t most = 0;
                for (unsigned i = 0; i < 158 * 400; i++) {
                    const unsigned cell = i % 400 - from; /* wraps before the window */
                    if (i / 400 * 64 / 158 == 16 * part + y && cell < end - from &&
                        cell * 64 / (end - from) == x) {
                        most = all[i] > most ? all[i] : most;
                    }
                }
                const double expected = 127.0 * most / starts.result.votes_max;
                assert_int_equal(plane.rows[y].votes[x], (int)ceil(expected - 1e-9));
                filled += most > 0;
                fullest += plane.rows[y].votes[x] == 127;
            }
        }
    }
    assert_true(filled > 100 && filled < 64 * 64);
    assert_true(fullest >= 1);
}

/* The scene of 10 km is in 4 of 64 columns of a range of +-100 km: the plane shows these. */
static void a_plane_spans_the_cells_that_have_votes(void **state)
{
    (void)state;
    for (int method = RHO_HOUGH_HT; method <= (int)RHO_HOUGH_MHT; method++) {
        static struct rho_message_accumulator accumulator;
        static struct rho_message_plane plane;
        struct rho_hough_config wide;
        uint8_t has_votes[64] = {0};
        unsigned columns = 0;
        start_with_method((enum rho_hough_method)method, RHO_TRACKER_BEST);
        wide = starts.hough.config;
        wide.rho_max_m = 100e3f;
        wide.rho_cell_m = 100.0f;
        assert_int_equal(rho_hough_init(&starts.hough, sizeof starts.hough, &wide), RHO_OK);
        show_kinds(1u << RHO_SHOW_VOTES, 1000);
        for (int k = 0; k < 4; k++) {
            step_plots(k, CLUTTER);
            collect_messages(0, report.time_us);
        }
        READ(accumulator, ACCUMULATOR, 0, &accumulator);
        assert_true(accumulator.rho_min_m >= -10e3f && accumulator.rho_max_m <= 10e3f);
        for (unsigned part = 0; part < 4; part++) {
            READ(plane, PLANE, part, &plane);
            for (unsigned i = 0; i < 16 * 64; i++) {
                has_votes[i % 64] |= plane.rows[i / 64].votes[i % 64] > 0;
            }
        }
        for (unsigned x = 0; x < 64; x++) {
            columns += has_votes[x];
        }
        assert_true(columns >= 16);
    }
}

/* A late scan or a window that is not full has no search, and so no message. */
static void without_a_search_no_accumulator_is_sent(void **state)
{
    (void)state;
    start_with_method(RHO_HOUGH_IHT, RHO_TRACKER_BEST);
    show_kinds(1u << RHO_SHOW_VOTES, 1000);
    for (int k = 0; k < 5; k++) {
        step_plots(k, CLUTTER);
    }
    collect_messages(0, report.time_us);
    assert_int_equal(num_messages, 5);
    step_plots(2, CLUTTER);
    collect_messages(0, report.time_us);
    assert_int_equal(num_messages, 0);
    shown.picture = NULL;
    assert_int_equal(rho_show_init(&show, sizeof show, &shown), RHO_OK);
    step_plots(5, CLUTTER);
    collect_messages(0, report.time_us);
    assert_int_equal(num_messages, 1); /* the accumulator without a plane */
    assert_int_equal(count_messages_on(RHO_MESSAGE_ACCUMULATOR_CHANNEL), 1);
}

/* Hypotheses */

static void a_track_started_by_nht_has_the_evidence_of_its_line(void **state)
{
    (void)state;
    struct rho_message_hypotheses of;
    start_with_method(RHO_HOUGH_NHT_C, RHO_TRACKER_HOUGH);
    show_kinds(1u << RHO_SHOW_HYPOTHESES, 1000);
    for (int k = 0; k < 4; k++) {
        step_plots(k, 0);
        collect_messages(0, report.time_us);
    }
    assert_int_equal(report.num_tracks, 1);
    assert_int_equal(num_messages, 1);
    READ(hypotheses, HYPOTHESES, 0, &of);
    const struct rho_hough_memberships *sums = &starts.lines[0].line.sums;
    const double all = (double)sums->truth + sums->indeterminacy + sums->falsity;
    assert_int_equal(of.evidence, RHO_MESSAGE_HYPOTHESES_LINE);
    assert_true(sums->truth > 0);
    assert_float_equal(of.support, sums->truth / all, 1e-5);
    assert_float_equal(of.shared, sums->indeterminacy / all, 1e-5);
    assert_float_equal(of.clutter, sums->falsity / all, 1e-5);
    assert_int_equal(of.num_hypotheses, 1);
    assert_float_equal(of.hypotheses[0].share, 1.0, 0.0);
    /* with one filter only the last plot is known */
    assert_int_equal(of.hypotheses[0].plots[0], -2);
    assert_int_equal(of.hypotheses[0].plots[2], 0);
    step_plots(4, 0);
    collect_messages(0, report.time_us);
    READ(hypotheses, HYPOTHESES, 0, &of);
    assert_int_equal(of.evidence, RHO_KEEPS_OFFERS ? RHO_MESSAGE_HYPOTHESES_PLOTS
                                                   : RHO_MESSAGE_HYPOTHESES_NO_EVIDENCE);
    assert_float_equal(of.maneuver + of.steady, 1.0, 1e-6);
}

static void hypotheses_messages_hold_those_of_the_track(void **state)
{
    (void)state;
    struct rho_message_hypotheses of;
    unsigned several = 0;
    start_with_method(RHO_HOUGH_IHT, RHO_TRACKER_BEST);
    show_kinds(1u << RHO_SHOW_HYPOTHESES, 1000);
    for (int k = 0; k < 12; k++) {
        step_plots(k, k < 4 ? 0 : 40);
        collect_messages(0, report.time_us);
        assert_int_equal(num_messages, report.num_tracks);
        for (unsigned i = 0; i < report.num_tracks; i++) {
            const struct rho_track *track = &tracker.tracks[i];
            READ(hypotheses, HYPOTHESES, i, &of);
            /* tracks take turns, so the list may begin anywhere */
            while (track->track_id != (uint32_t)of.track_id) {
                track =
                    track + 1 < tracker.tracks + tracker.num_tracks ? track + 1 : tracker.tracks;
            }
            float sum = 0.0f;
            assert_int_equal(of.utime, report.time_us);
            assert_float_equal(of.score_nat, 0.001 * track->score_mnat, 1e-3);
            assert_float_equal(of.calm + of.steady + of.maneuver, 1.0, 1e-5);
            assert_int_equal(of.num_hypotheses,
                             rho_hypotheses_count(&tracker.hypotheses, track->slot));
            for (int j = 0; j < of.num_hypotheses; j++) {
                const struct rho_hypothesis *at =
                    rho_hypotheses_at(&tracker.hypotheses, track->slot, (unsigned)j);
                for (int m = 0; m < 3; m++) {
                    assert_int_equal(of.hypotheses[j].plots[m], at->picks[m]);
                }
                assert_true(j == 0 || of.hypotheses[j].share <= of.hypotheses[j - 1].share + 1e-6f);
                sum += of.hypotheses[j].share;
            }
            assert_float_equal(sum, 1.0, 1e-5);
            if (of.hypotheses[0].share > 0.999f) {
                assert_float_equal(of.hypotheses[0].x_m, track->kalman.state[0], 5.0);
                assert_float_equal(of.hypotheses[0].vy_mps, track->kalman.state[4], 5.0);
            }
            several += of.num_hypotheses > 1;
        }
    }
    assert_true(several > 0);
}

/* Searches in bearings */

static const float place_m[SENSORS][2] = {{-20000.0f, 0.0f}, {20000.0f, 0.0f}, {0.0f, -20000.0f}};

/* Bearings of two targets, and a false bearing of the third sensor. */
static void step_bearings(int k, unsigned sensors, unsigned targets)
{
    static struct rho_bearing bearings[SENSORS][RHO_MAX_BEARINGS];
    static struct rho_bearing_scan looks[SENSORS];
    const double t_s = 10.0 * k;
    for (unsigned s = 0; s < sensors; s++) {
        for (unsigned i = 0; i < targets; i++) {
            const double x = -8000.0 + 26000.0 * i + (150.0 - 40.0 * i) * t_s;
            const double y = 30000.0 - 14000.0 * i + 60.0 * t_s;
            bearings[s][i] = (struct rho_bearing){
                .bearing_rad = (float)(atan2(y - place_m[s][1], x - place_m[s][0])),
                .sigma_rad = 0.0005f};
        }
        looks[s] = (struct rho_bearing_scan){.time_us = (int64_t)(1e6 * t_s),
                                             .sensor_id = (int32_t)s + 1,
                                             .x_m = place_m[s][0],
                                             .y_m = place_m[s][1],
                                             .num_bearings = targets,
                                             .bearings = bearings[s]};
    }
    const struct rho_frame frame = {
        .time_us = (int64_t)(1e6 * t_s), .num_scans = sensors, .scans = looks};
    assert_int_equal(step_looks(&tracker, NULL, &paper, &frame, &report), RHO_OK);
}

static void start_with_passive_paper(void)
{
    struct rho_passive_paper_config of_paper;
    use_usual_configs(6);
    begin_tracker();
    rho_passive_paper_config_default(&of_paper);
    assert_int_equal(rho_passive_paper_init(&paper, sizeof paper, &of_paper), RHO_OK);
}

static void ghost_matrices_are_of_the_newest_frame(void **state)
{
    (void)state;
    struct rho_message_ghost_matrix of;
    struct rho_ghost_matrix matrix;
    unsigned pruned = 0;
    start_with_passive_paper();
    show_kinds(1u << RHO_SHOW_GHOSTS, 1000);
    for (int k = 0; k < 6; k++) {
        step_bearings(k, SENSORS, 2);
        collect_messages(1, report.time_us);
        assert_int_equal(num_messages, 3); /* one matrix for each pair of sensors */
        for (unsigned i = 0; i < 3; i++) {
            struct rho_passive_paper_pair pair;
            assert_int_equal(rho_passive_paper_pair(&paper, i, &pair), 1);
            assert_int_equal(rho_passive_paper_ghosts(&paper, &pair, (unsigned)k, &matrix), RHO_OK);
            READ(ghost_matrix, GHOST_MATRIX, i, &of);
            assert_int_equal(of.utime, report.time_us);
            assert_int_equal(of.sensor_a_id, pair.a + 1);
            assert_int_equal(of.sensor_b_id, pair.b + 1);
            assert_float_equal(of.sensor_b_x_m, place_m[pair.b][0], 0.0);
            assert_float_equal(of.sensor_b_y_m, place_m[pair.b][1], 0.0);
            assert_int_equal(of.rule, RHO_MESSAGE_GHOST_MATRIX_LITERAL);
            assert_float_equal(of.range_max_m, 100000.0, 0.0);
            assert_int_equal(of.num_rows, 2);
            assert_int_equal(of.num_columns, 2);
            assert_int_equal(of.num_elements, 4);
            for (int j = 0; j < 4; j++) {
                const struct rho_message_ghost *element = &of.elements[j];
                assert_int_equal(element->row, j / 2);
                assert_int_equal(element->column, j % 2);
                assert_int_equal(element->reason, matrix.reason[j / 2][j % 2]);
                if (element->reason == RHO_MESSAGE_GHOST_KEPT) {
                    assert_float_equal(element->delta_rad, matrix.delta_rad[j / 2][j % 2], 1e-6);
                }
                /* crossings of two bearings of the same target */
                if (element->row == element->column) {
                    const double t_s = 10.0 * k;
                    const int i_target = element->row;
                    assert_float_equal(
                        element->x_m,
                        -8000.0 + 26000.0 * i_target + (150.0 - 40.0 * i_target) * t_s, 20.0);
                    assert_true(element->delta_rad > 0.0f);
                } else {
                    pruned += element->reason != RHO_MESSAGE_GHOST_KEPT;
                }
            }
        }
    }
    assert_true(pruned > 0);
}

/* As many bearings as the capacity: a matrix in several parts. */
static void a_large_ghost_matrix_is_sent_in_parts(void **state)
{
    (void)state;
    struct rho_message_ghost_matrix of;
    const unsigned all = RHO_MAX_BEARINGS * RHO_MAX_BEARINGS;
    const unsigned parts =
        (all + RHO_MESSAGE_GHOST_MATRIX_MAX_ELEMENTS - 1) / RHO_MESSAGE_GHOST_MATRIX_MAX_ELEMENTS;
    unsigned elements = 0;
    start_with_passive_paper();
    show_kinds(1u << RHO_SHOW_GHOSTS, 1000);
    step_bearings(0, 2, RHO_MAX_BEARINGS);
    collect_messages(1, 0);
    assert_int_equal(num_messages, parts);
    for (unsigned part = 0; part < parts; part++) {
        READ(ghost_matrix, GHOST_MATRIX, part, &of);
        assert_int_equal(of.part, part);
        assert_int_equal(of.num_parts, parts);
        for (int j = 0; j < of.num_elements; j++) {
            assert_int_equal((unsigned)of.elements[j].row * RHO_MAX_BEARINGS +
                                 (unsigned)of.elements[j].column,
                             elements++);
        }
    }
    assert_int_equal(elements, all);
}

/* First all pairs of sensors together, then each pair; lines are those of the search. */
static void bearing_accumulators_are_sent_for_all_pairs_and_each_pair(void **state)
{
    (void)state;
    static struct rho_message_accumulator of;
    static struct rho_message_plane plane;
    start_with_passive_paper();
    show_kinds(1u << RHO_SHOW_VOTES, 1000);
    for (int k = 0; k < 8; k++) {
        step_bearings(k, SENSORS, 1);
        collect_messages(1, report.time_us);
        assert_int_equal(num_messages, k < 7 ? 0 : 4 * 5);
    }
    assert_int_equal(report.num_tracks, 1);
    READ(accumulator, ACCUMULATOR, 0, &of);
    assert_int_equal(of.method, RHO_MESSAGE_ACCUMULATOR_PASSIVE_PAPER);
    assert_int_equal(of.has_pair, 0);
    assert_int_equal(of.num_cells, paper.num_lines);
    assert_int_equal(of.num_scans, 8);
    assert_int_equal(of.oldest_utime, 0);
    assert_float_equal(of.votes_max, paper.lines[0].votes_sum, 0.0);
    assert_float_equal(of.votes_min, 7.0, 0.0);
    assert_float_equal(of.origin_x_m, 0.0, 1e-3);
    assert_float_equal(of.origin_y_m, -20000.0 / 3.0, 1e-2);
    int started = 0;
    for (int i = 0; i < of.num_cells; i++) {
        const double rho_m = of.cells[i].rho_m + of.origin_x_m * cos(of.cells[i].theta_rad) +
                             of.origin_y_m * sin(of.cells[i].theta_rad);
        assert_float_equal(rho_m, paper.lines[i].rho_m, 0.1);
        assert_int_equal(of.cells[i].scan_mask, paper.lines[i].scans);
        started += of.cells[i].track_id == (int32_t)report.tracks[0].track_id;
    }
    assert_int_equal(started, 1);
    for (unsigned pair = 0; pair < 3; pair++) {
        static const int16_t ids[3][2] = {{1, 2}, {1, 3}, {2, 3}};
        READ(accumulator, ACCUMULATOR, pair + 1, &of);
        assert_int_equal(of.has_pair, 1);
        assert_int_equal(of.sensor_a_id, ids[pair][0]);
        assert_int_equal(of.sensor_b_id, ids[pair][1]);
        assert_true(of.num_cells > 0);
        assert_float_equal(of.votes_max, 8.0, 0.0); /* one target, seen in each of 8 scans */
        assert_float_equal(of.cells[0].votes, 8.0, 0.0);
        assert_int_equal(of.cells[0].scan_mask, 0xff);
        READ(plane, PLANE, 4 * (pair + 1), &plane);
        assert_int_equal(plane.sensor_b_id, ids[pair][1]);
        assert_float_equal(plane.votes_max, 8.0, 0.0);
    }
    step_bearings(8, 2, 1); /* the third sensor has gone: the row is not whole, nor searched */
    collect_messages(1, report.time_us);
    assert_int_equal(num_messages, 0);
}

/* Message rates */

/* A step a second with 5 messages of votes: messages_per_s pass, and the rest is counted. */
static void pictures_are_sent_whole_within_the_message_rate(void **state)
{
    (void)state;
    static struct rho_message_accumulator of;
    unsigned sent = 0, left = 0;
    start_with_method(RHO_HOUGH_IHT, RHO_TRACKER_BEST);
    show_kinds(1u << RHO_SHOW_VOTES, 2);
    for (int k = 0; k < 3; k++) {
        step_plots(k, CLUTTER);
    }
    for (int k = 3; k < 63; k++) {
        step_plots(k, CLUTTER);
        collect_messages(0, 1000000 * (int64_t)k);
        assert_true(num_messages == 0 || num_messages == 5);
        sent += num_messages;
        left += num_messages == 0 ? 5 : 0;
        assert_int_equal(rho_show_not_sent(&show, RHO_SHOW_VOTES), left);
        if (num_messages > 0) {
            READ(accumulator, ACCUMULATOR, 0, &of);
            assert_int_equal(of.not_sent, left);
        }
    }
    assert_in_range(sent, 2 * 60 - 5, 2 * 60 + 7);
    assert_int_equal(rho_show_not_sent(&show, RHO_SHOW_GHOSTS), 0);
    assert_int_equal(rho_show_not_sent(&show, RHO_NUM_SHOW_KINDS), 0);
    assert_int_equal(rho_show_not_sent(NULL, RHO_SHOW_VOTES), 0);
    step_plots(63, CLUTTER); /* a clock set back starts the rate anew */
    collect_messages(0, 1000);
    assert_int_equal(num_messages, 5);
    step_plots(64, CLUTTER);
    collect_messages(0, 2000);
    assert_int_equal(num_messages, 0);
}

/* Eight tracks at three messages a second: each is sent in turn. */
static void tracks_take_turns_within_the_message_rate(void **state)
{
    (void)state;
    struct rho_message_hypotheses of;
    unsigned shown_times[9] = {0}, sent = 0;
    use_usual_configs(7);
    begin_tracker();
    memset(&starts, 0, sizeof starts);
    show_kinds(1u << RHO_SHOW_HYPOTHESES, 3);
    for (int k = 0; k < 40; k++) {
        for (int i = 0; i < 8; i++) {
            add_plot(200.0 * SCAN_S * k, 3000.0 * i, 10.0);
        }
        step_at(SCAN_S * k);
        if (report.num_tracks == 8) {
            collect_messages(0, 1000000 * (int64_t)k);
            assert_true(num_messages <= 3);
            for (unsigned i = 0; i < num_messages; i++) {
                READ(hypotheses, HYPOTHESES, i, &of);
                shown_times[of.track_id]++;
                sent++;
            }
        }
    }
    for (int id = 1; id <= 8; id++) {
        assert_in_range(shown_times[id], sent / 8, sent / 8 + 1);
    }
    assert_true(sent > 90);
    assert_true(rho_show_not_sent(&show, RHO_SHOW_HYPOTHESES) > 150);
}

/* Refusals */

static void bad_configurations_are_refused(void **state)
{
    (void)state;
    rho_show_config_default(&shown);
    assert_int_equal(shown.kinds, 7);
    assert_int_equal(shown.messages_per_s, 50);
    assert_null(shown.picture);
    assert_int_equal(rho_show_init(NULL, sizeof show, &shown), RHO_ERROR_NULL);
    assert_int_equal(rho_show_init(&show, sizeof show, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_show_init(&show, sizeof show - 1, &shown), RHO_ERROR_SIZE);
    shown.kinds = 0;
    assert_int_equal(rho_show_init(&show, sizeof show, &shown), RHO_ERROR_CONFIG);
    shown.kinds = 8;
    assert_int_equal(rho_show_init(&show, sizeof show, &shown), RHO_ERROR_CONFIG);
    shown.kinds = 7;
    shown.messages_per_s = 0;
    assert_int_equal(rho_show_init(&show, sizeof show, &shown), RHO_ERROR_CONFIG);
    shown.messages_per_s = 10001;
    assert_int_equal(rho_show_init(&show, sizeof show, &shown), RHO_ERROR_CONFIG);
}

static void missing_objects_show_no_messages(void **state)
{
    (void)state;
    uint8_t buffer[RHO_SHOW_MAX_SIZE];
    size_t size;
    start_with_method(RHO_HOUGH_IHT, RHO_TRACKER_BEST);
    show_kinds(7, 1000);
    for (int k = 0; k < 5; k++) {
        step_plots(k, 0);
    }
    const struct rho_show_source good = {.tracker = &tracker, .report = &report, .starts = &starts};
    struct rho_show_source none = good;
    none.tracker = NULL;
    rho_show_begin(&show, &none, 0);
    assert_null(rho_show_next(&show, &none, buffer, sizeof buffer, &size));
    none = good;
    none.report = NULL;
    rho_show_begin(&show, &none, 0);
    assert_null(rho_show_next(&show, &none, buffer, sizeof buffer, &size));
    rho_show_begin(&show, NULL, 0);
    assert_null(rho_show_next(&show, NULL, buffer, sizeof buffer, &size));
    rho_show_begin(NULL, &good, 0);
    assert_null(rho_show_next(NULL, &good, buffer, sizeof buffer, &size));
    rho_show_begin(&show, &good, 0);
    assert_null(rho_show_next(&show, &good, buffer, sizeof buffer - 1, &size));
    assert_null(rho_show_next(&show, &good, NULL, sizeof buffer, &size));
    assert_null(rho_show_next(&show, &good, buffer, sizeof buffer, NULL));
    assert_non_null(rho_show_next(&show, &good, buffer, sizeof buffer, &size));
    show.magic = 0;
    assert_null(rho_show_next(&show, &good, buffer, sizeof buffer, &size));
    assert_int_equal(rho_show_not_sent(&show, RHO_SHOW_VOTES), 0);
}

/* Showing changes no bit of the tracker's results. */
static void showing_does_not_change_the_tracker(void **state)
{
    (void)state;
    static struct rho_report without[10];
    for (int run = 0; run < 2; run++) {
        start_with_method(RHO_HOUGH_NHT_C, RHO_TRACKER_BEST);
        show_kinds(7, 10000);
        for (int k = 0; k < 10; k++) {
            memset(&report, 0, sizeof report);
            step_plots(k, CLUTTER);
            if (run == 0) {
                without[k] = report;
            } else {
                collect_messages(0, report.time_us);
                assert_memory_equal(&report, &without[k], sizeof report);
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(accumulator_messages_hold_the_searchs_peaks),
        cmocka_unit_test(a_plane_message_is_the_reduced_picture_of_votes),
        cmocka_unit_test(a_plane_spans_the_cells_that_have_votes),
        cmocka_unit_test(without_a_search_no_accumulator_is_sent),
        cmocka_unit_test(a_track_started_by_nht_has_the_evidence_of_its_line),
        cmocka_unit_test(hypotheses_messages_hold_those_of_the_track),
        cmocka_unit_test(ghost_matrices_are_of_the_newest_frame),
        cmocka_unit_test(a_large_ghost_matrix_is_sent_in_parts),
        cmocka_unit_test(bearing_accumulators_are_sent_for_all_pairs_and_each_pair),
        cmocka_unit_test(pictures_are_sent_whole_within_the_message_rate),
        cmocka_unit_test(tracks_take_turns_within_the_message_rate),
        cmocka_unit_test(bad_configurations_are_refused),
        cmocka_unit_test(missing_objects_show_no_messages),
        cmocka_unit_test(showing_does_not_change_the_tracker),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
