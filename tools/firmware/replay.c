/* SPDX-License-Identifier: MIT */
/*
 * replay: runs the firmware's node on a recorded log instead of a network, on any machine: `replay
 * IN.lcm OUT.lcm [NAME=VALUE ...]`. Names are gate (best, hough, nearest; the latter two with input
 * estimation), v_min_mps, v_max_mps and accel_mps2 in whole numbers, and radars=1 for those of
 * known_radars.h.
 *
 * IN.lcm is an LCM log of scans; each message is given to the node as a datagram at the time at
 * which it was recorded. OUT.lcm gets the messages that the node sends, and on the channel FATES
 * the fate of each plot or bearing of each step, a byte each. The output must be the same bytes on
 * all machines. Prints one line at the end: steps, track reports, partial steps, and instructions
 * and stack where the machine can count them.
 */
#include <string.h>

#include "board/files.h"
#include "known_radars.h"
#include "lcm_datagram_node.h"
#include "rhotrack/udpm.h"

#define LOG_SYNC 0xEDA1DA01u
#define LOG_HEAD 28u
#define CHANNEL_MAX 63u
/* first steps, which the mean does not include: a window that is not yet full costs less */
#define WARM_UP_STEPS 7

static int output;
static int64_t now_us, events_written;
static int has_failed;
static struct {
    uint32_t steps, track_reports, partial_steps;
    uint32_t instructions_max, instructions_aside; /* aside: in the callbacks, not the node's */
    uint64_t instructions_sum;
    uint32_t instructions_steps;
} tally;

/* ---- The log ---- */

static void put_be32(uint8_t *out, uint32_t value)
{
    for (int i = 0; i < 4; i++) {
        out[i] = (uint8_t)(value >> (24 - 8 * i));
    }
}

static void put_be64(uint8_t *out, int64_t value)
{
    put_be32(out, (uint32_t)((uint64_t)value >> 32));
    put_be32(out + 4, (uint32_t)value);
}

static uint32_t get_be32(const uint8_t *in)
{
    return (uint32_t)in[0] << 24 | (uint32_t)in[1] << 16 | (uint32_t)in[2] << 8 | in[3];
}

static void write_event(const char *channel, const uint8_t *data, size_t size)
{
    uint8_t head[LOG_HEAD];
    size_t length = strlen(channel);
    put_be32(head, LOG_SYNC);
    put_be64(head + 4, events_written++);
    put_be64(head + 12, now_us);
    put_be32(head + 20, (uint32_t)length);
    put_be32(head + 24, (uint32_t)size);
    has_failed |= !files_try_to_write(output, head, sizeof head) ||
                  !files_try_to_write(output, (const uint8_t *)channel, length) ||
                  (size > 0 && !files_try_to_write(output, data, size));
}

/*
 * Reads an event of the log as a datagram and sets now_us to its time. Returns its size, 0 at the
 * end of the log or where it is damaged.
 */
static size_t read_event_as_datagram(int input, uint8_t datagram[RHO_UDPM_MAX_DATAGRAM])
{
    static uint32_t sequence;
    uint8_t event[LOG_HEAD];
    char channel[CHANNEL_MAX + 1] = "";
    size_t head, size, length, got = files_read(input, event, sizeof event);
    if (got == 0) {
        return 0;
    }
    length = get_be32(event + 20);
    size = get_be32(event + 24);
    if (got < sizeof event || get_be32(event) != LOG_SYNC || length > CHANNEL_MAX ||
        files_read(input, (uint8_t *)channel, length) < length ||
        rho_udpm_begin(datagram, RHO_UDPM_MAX_DATAGRAM, sequence++, channel, &head) != RHO_OK ||
        size > RHO_UDPM_MAX_DATAGRAM - head || files_read(input, datagram + head, size) < size) {
        files_print("replay: the input is no log of rhotrack's messages\n");
        has_failed = 1;
        return 0;
    }
    now_us = (int64_t)((uint64_t)get_be32(event + 12) << 32 | get_be32(event + 16));
    return head + size;
}

/* ---- Callbacks of the node: not counted as its instructions ---- */

static void write_sent_datagram_to_log(void *context, const uint8_t *bytes, size_t size)
{
    struct rho_udpm_datagram datagram;
    uint32_t from = files_read_instruction_counter();
    (void)context;
    if (rho_udpm_parse(bytes, size, &datagram) == RHO_OK) {
        write_event(datagram.channel, datagram.payload, datagram.payload_size);
    } else {
        has_failed = 1;
    }
    tally.instructions_aside += files_instructions_elapsed(from, files_read_instruction_counter());
}

static void tally_step_and_log_plot_fates(void *context, const struct rho_report *report)
{
    uint32_t from = files_read_instruction_counter();
    (void)context;
    tally.steps++;
    tally.track_reports += report->num_tracks;
    tally.partial_steps += report->is_partial;
    write_event("FATES", report->fates,
                report->num_plots < RHO_MAX_PLOTS ? report->num_plots : RHO_MAX_PLOTS);
    tally.instructions_aside += files_instructions_elapsed(from, files_read_instruction_counter());
}

/* Clock of the node's step times: always 0, as they would differ from machine to machine. */
static int64_t zero_clock_us(void *context)
{
    (void)context;
    return 0;
}

/* ---- Run ---- */

static float parse_whole_number_or_minus_1(const char *text)
{
    float value = 0.0f;
    while (*text >= '0' && *text <= '9') {
        value = 10.0f * value + (float)(*text++ - '0');
    }
    /* -1 where the text is no number: the node refuses negative values */
    return *text ? -1.0f : value;
}

/* Number of the gate with this name; RHO_NUM_TRACKER_GATES, which the node refuses, for others. */
static int gate_of_name_or_invalid(const char *name)
{
    static const char *const names[RHO_NUM_TRACKER_GATES] = {"best", "hough", "nearest"};
    int gate = 0;
    while (gate < RHO_NUM_TRACKER_GATES && strcmp(name, names[gate]) != 0) {
        gate++;
    }
    return gate;
}

/* Applies an option NAME=VALUE; returns 0 where the name is unknown. */
static int try_to_set_option(struct node_config *config, const char *argument)
{
    const char *value = strchr(argument, '=');
    size_t length = value ? (size_t)(value - argument) : 0;
    struct rho_tracker_config *tracker = &config->node.tracker;
    struct rho_initiator_config *initiator = &config->node.initiator;
    struct rho_hough_config *hough = &config->node.paper_starts.hough;
    if (length == 4 && strncmp(argument, "gate", length) == 0) {
        tracker->gate = (uint8_t)gate_of_name_or_invalid(value + 1);
        tracker->input.is_estimated = tracker->gate != RHO_TRACKER_BEST;
    } else if (length == 9 && strncmp(argument, "v_min_mps", length) == 0) {
        tracker->v_min_mps = parse_whole_number_or_minus_1(value + 1);
        initiator->v_min_mps = hough->v_min_mps = tracker->v_min_mps;
    } else if (length == 9 && strncmp(argument, "v_max_mps", length) == 0) {
        tracker->v_max_mps = parse_whole_number_or_minus_1(value + 1);
        initiator->v_max_mps = hough->v_max_mps = tracker->v_max_mps;
    } else if (length == 10 && strncmp(argument, "accel_mps2", length) == 0) {
        tracker->accel_max_mps2 = parse_whole_number_or_minus_1(value + 1);
        initiator->turn_mps2 = 0.2f * tracker->accel_max_mps2;
    } else if (length == 6 && strncmp(argument, "radars", length) == 0) {
        config->sensors = radars;
        config->num_sensors = value[1] == '1' ? sizeof radars / sizeof *radars : 0;
    } else {
        return 0;
    }
    return 1;
}

static int try_to_start_node_with_options(int count, char **arguments)
{
    struct node_config config;
    node_config_default(&config);
    for (int i = 0; i < count; i++) {
        if (!try_to_set_option(&config, arguments[i])) {
            return 0;
        }
    }
    config.hooks.send = write_sent_datagram_to_log;
    config.hooks.stepped = tally_step_and_log_plot_fates;
    config.hooks.clock_us = zero_clock_us;
    return node_start(&config) == RHO_OK;
}

/*
 * Gives a datagram to the node and counts instructions a step; those of a scan's earlier parts
 * count with the step that its last part causes.
 */
static void receive_and_count_instructions(const uint8_t *datagram, size_t size)
{
    static uint32_t since_step;
    const uint32_t before = tally.steps;
    uint32_t from;
    tally.instructions_aside = 0;
    from = files_read_instruction_counter();
    node_receive(datagram, size, 0, now_us);
    since_step += files_instructions_elapsed(from, files_read_instruction_counter()) -
                  tally.instructions_aside;
    if (tally.steps == before) {
        return;
    }
    if (tally.steps > WARM_UP_STEPS) {
        tally.instructions_sum += since_step;
        tally.instructions_steps += tally.steps - before;
    }
    if (since_step > tally.instructions_max) {
        tally.instructions_max = since_step;
    }
    since_step = 0;
}

static void print_number(const char *text, uint32_t number)
{
    char digits[11];
    char *first = digits + sizeof digits - 1;
    *first = '\0';
    do {
        *--first = (char)('0' + number % 10);
        number /= 10;
    } while (number > 0);
    files_print(text);
    files_print(first);
}

static void print_tally(void)
{
    print_number("steps ", tally.steps);
    print_number(" reports ", tally.track_reports);
    print_number(" partial ", tally.partial_steps);
    if (tally.instructions_max > 0 && tally.instructions_steps > 0) {
        print_number(" instructions mean ",
                     (uint32_t)(tally.instructions_sum / tally.instructions_steps));
        print_number(" max ", tally.instructions_max);
    }
    if (files_stack_used() > 0) {
        print_number(" stack ", (uint32_t)files_stack_used());
    }
    files_print("\n");
}

int main(int argc, char **argv)
{
    static uint8_t datagram[RHO_UDPM_MAX_DATAGRAM];
    int input = argc >= 3 ? files_open_to_read(argv[1]) : 0;
    size_t size;
    output = input ? files_open_to_write(argv[2]) : 0;
    if (!output) {
        files_print("usage: replay IN.lcm OUT.lcm [NAME=VALUE ...]; or a file does not open\n");
        return 2;
    }
    if (!try_to_start_node_with_options(argc - 3, argv + 3)) {
        files_print("replay: a setting is not known, or not taken\n");
        return 2;
    }
    while ((size = read_event_as_datagram(input, datagram)) > 0) {
        receive_and_count_instructions(datagram, size);
    }
    node_step_waiting_scans();
    has_failed |= !files_try_to_close(output);
    print_tally();
    return has_failed;
}
