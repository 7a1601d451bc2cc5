/* SPDX-License-Identifier: MIT */
/*
 * Two nodes with --standby on a simulated network and clock: one publishes, also after one is
 * killed, stopped, cut off or started again, or where another program speaks as a node does.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "live/standby.h"
#include "rhotrack/message.h"

enum { NODES = 2, TURN_US = 50000, WORD_US = 1000000, QUEUE = 4096 };
#define SECOND_US INT64_C(1000000)

/* A node as command_node runs it: it reads what it was sent, then speaks once a second. */
struct node {
    struct standby standby;
    int32_t epoch;
    bool is_stopped, is_cut, is_without_standby;
    unsigned said;
    int64_t word_us, start_us;
    int queue[QUEUE], num_queued; /* senders of messages that it has not read: -1: a radar */
};

static struct node nodes[NODES];
static int64_t now_us;
static bool has_radar;
static int64_t silent_us, longest_us; /* nobody publishes to the radar's side */
static int64_t both_us;               /* both publish to it */

static void send_to(int node, int from)
{
    if (!nodes[node].is_cut && nodes[node].num_queued < QUEUE) {
        nodes[node].queue[nodes[node].num_queued++] = from;
    }
}

static void start_node(int i, int64_t at_us, int32_t epoch)
{
    nodes[i] = (struct node){.epoch = epoch, .start_us = at_us, .word_us = at_us};
    nodes[i].standby = standby_open(at_us, "udpm://239.255.76.67:7667");
}

static void begin(void)
{
    now_us = 1000 * SECOND_US;
    has_radar = true;
    silent_us = longest_us = both_us = 0;
    start_node(0, now_us, 7);
    start_node(1, now_us + 313 * 1000, 7);
}

static void read_message(struct node *node, int from)
{
    struct rho_message_status status = {.epoch = from < 0 ? 0 : nodes[from].epoch};
    uint8_t bytes[RHO_MESSAGE_STATUS_MAX_SIZE];
    struct transport_message message = {
        .channel = from < 0 ? "RHO_PLOTS_7" : RHO_MESSAGE_STATUS_CHANNEL,
        .data = bytes,
        .sender = {0x0a090002u + (uint32_t)from, 5001, from >= 0 && node == &nodes[from]}};
    int32_t epoch;

    assert_int_equal(rho_message_status_encode(&status, bytes, sizeof bytes, &message.size),
                     RHO_OK);
    standby_note_message(&node->standby, &message, now_us);
    if (from >= 0 && !message.sender.is_own &&
        standby_hear(&node->standby, &message, now_us, &epoch, NULL) && epoch == node->epoch) {
        node->epoch++;
    }
}

static void take_turn(struct node *node)
{
    bool is_heard = false;

    if (standby_take_turn(&node->standby, true, now_us, NULL)) {
        node->word_us = now_us;
    }
    if (now_us >= node->word_us) {
        node->word_us = now_us + WORD_US;
        if (standby_may_send(&node->standby, now_us) || node->is_without_standby) {
            node->said++;
            is_heard = !node->is_cut;
        }
    }
    for (int i = 0; i < NODES; i++) {
        if (is_heard) {
            send_to(i, (int)(node - nodes));
        }
    }
    for (int k = 0; k < node->num_queued; k++) {
        read_message(node, node->queue[k]);
    }
    node->num_queued = 0;
}

static bool publishes(int i)
{
    return !nodes[i].is_stopped && now_us >= nodes[i].start_us &&
           (nodes[i].is_without_standby || standby_may_send(&nodes[i].standby, now_us));
}

static void run(double seconds)
{
    const int64_t end_us = now_us + (int64_t)(seconds * 1e6);

    for (; now_us < end_us; now_us += TURN_US) {
        for (int i = 0; i < NODES; i++) {
            if (has_radar && now_us / TURN_US % 10 == 0) {
                send_to(i, -1);
            }
            if (!nodes[i].is_stopped && now_us >= nodes[i].start_us) {
                take_turn(&nodes[i]);
            }
        }
        const bool is_first = publishes(0) && !nodes[0].is_cut;
        const bool is_second = publishes(1) && !nodes[1].is_cut;

        silent_us = is_first || is_second ? 0 : silent_us + TURN_US;
        longest_us = silent_us > longest_us ? silent_us : longest_us;
        both_us += is_first && is_second ? TURN_US : 0;
        if (is_first && is_second) {
            assert_int_not_equal(nodes[0].epoch, nodes[1].epoch);
        }
    }
}

static void expect_publisher(int node)
{
    for (int i = 0; i < NODES; i++) {
        assert_int_equal(publishes(i), i == node);
    }
}

static void the_one_that_was_first_publishes(void **state)
{
    (void)state;
    begin();
    run(2.0);
    assert_false(publishes(0) || publishes(1));
    run(1.0);
    expect_publisher(0);
    run(600.0);
    expect_publisher(0);
    assert_int_equal(nodes[1].said, 0);
    assert_int_equal(both_us, 0);
}

static void a_killed_one_is_followed_within_three_seconds(void **state)
{
    (void)state;
    begin();
    run(5.0);
    nodes[0].is_stopped = true;
    longest_us = 0;
    run(3.0);
    expect_publisher(1);
    assert_true(longest_us >= 1 * SECOND_US && longest_us < 3 * SECOND_US);
    start_node(0, now_us, 8);
    run(100.0);
    expect_publisher(1);
    assert_int_equal(nodes[0].said, 0);
    assert_int_equal(both_us, 0);
}

static void one_word_that_is_lost_changes_nothing(void **state)
{
    (void)state;
    begin();
    run(5.0);
    for (int i = 0; i < 20; i++) {
        nodes[1].is_cut = true;
        run(1.0);
        nodes[1].is_cut = false;
        run(3.0);
        expect_publisher(0);
    }
    assert_int_equal(nodes[1].said, 0);
}

/* All phases of a stop within the second of the node's words. */
static void a_stopped_one_says_nothing_when_it_goes_on(void **state)
{
    (void)state;
    for (int phase = 0; phase < 20; phase++) {
        for (int quarters = 1; quarters < 40; quarters += 3) {
            begin();
            run(5.0 + 0.05 * phase);
            nodes[0].is_stopped = true;
            run(0.25 * quarters);
            const bool is_followed = publishes(1);
            const unsigned said = nodes[0].said;

            nodes[0].is_stopped = false;
            run(3.0);
            expect_publisher(is_followed ? 1 : 0);
            assert_true(!is_followed || nodes[0].said == said);
            assert_int_equal(both_us, 0);
        }
    }
}

static void a_stopped_silent_one_reads_before_it_speaks(void **state)
{
    (void)state;
    begin();
    run(5.0);
    nodes[1].is_stopped = true;
    run(20.0);
    nodes[1].is_stopped = false;
    run(5.0);
    expect_publisher(0);
    assert_int_equal(nodes[1].said, 0);
}

static void one_that_was_cut_off_falls_silent_when_it_is_back(void **state)
{
    (void)state;
    for (int phase = 0; phase < 20; phase++) {
        begin();
        run(5.0);
        nodes[0].is_cut = true;
        run(10.0 + 0.05 * phase);
        assert_true(publishes(0) && publishes(1));
        nodes[0].is_cut = false;
        longest_us = 0;
        run(5.0);
        expect_publisher(1);
        assert_int_equal(longest_us, 0);
        assert_in_range(both_us, 0, WORD_US + TURN_US);
    }
}

static void both_cut_off_agree_within_four_seconds(void **state)
{
    (void)state;
    begin();
    run(5.0);
    nodes[0].is_cut = nodes[1].is_cut = true;
    run(10.0);
    nodes[0].is_cut = nodes[1].is_cut = false;
    run(5.0);
    assert_true(publishes(0) != publishes(1));
    assert_int_equal(silent_us, 0);
}

static void one_without_standby_is_given_way_to(void **state)
{
    (void)state;
    begin();
    run(5.0);
    nodes[0].is_stopped = true;
    run(5.0);
    expect_publisher(1);
    start_node(0, now_us, 7);
    nodes[0].is_without_standby = true;
    run(4.0);
    expect_publisher(0);
    assert_in_range(both_us, 0, 3 * SECOND_US);
}

static void silence_of_the_sensors_is_none_of_the_nodes(void **state)
{
    (void)state;
    begin();
    has_radar = false;
    run(600.0);
    expect_publisher(0);
    assert_int_equal(nodes[1].said, 0);
}

/* SECURITY.md: a forged word each two seconds, and no longer than these come. */
static void forged_words_keep_it_silent_while_they_come(void **state)
{
    (void)state;
    begin();
    run(5.0);
    nodes[1].is_stopped = true;
    for (int i = 0; i < 30; i++) {
        send_to(0, 1);
        run(2.0);
    }
    assert_false(publishes(0));
    run(3.0);
    expect_publisher(0);
}

static void a_node_without_standby_publishes_always(void **state)
{
    struct standby none = {.is_on = false};

    (void)state;
    assert_true(standby_may_send(&none, 1));
    assert_true(standby_may_send(&none, 100 * SECOND_US));
    assert_false(standby_take_turn(&none, true, 200 * SECOND_US, NULL));
    assert_true(standby_may_send(&none, 300 * SECOND_US));
    assert_int_equal(standby_due_us(&none), INT64_MAX);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_one_that_was_first_publishes),
        cmocka_unit_test(a_killed_one_is_followed_within_three_seconds),
        cmocka_unit_test(one_word_that_is_lost_changes_nothing),
        cmocka_unit_test(a_stopped_one_says_nothing_when_it_goes_on),
        cmocka_unit_test(a_stopped_silent_one_reads_before_it_speaks),
        cmocka_unit_test(one_that_was_cut_off_falls_silent_when_it_is_back),
        cmocka_unit_test(both_cut_off_agree_within_four_seconds),
        cmocka_unit_test(one_without_standby_is_given_way_to),
        cmocka_unit_test(silence_of_the_sensors_is_none_of_the_nodes),
        cmocka_unit_test(forged_words_keep_it_silent_while_they_come),
        cmocka_unit_test(a_node_without_standby_publishes_always),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
