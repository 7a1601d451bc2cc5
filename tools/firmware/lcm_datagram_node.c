/* SPDX-License-Identifier: MIT */
#include "lcm_datagram_node.h"

#include "node_initiation.h"
#include "node_settings_defaults.h"
#include "rhotrack/body.h"
#include "rhotrack/frames.h"
#include "rhotrack/message.h"
#include "rhotrack/node.h"
#include "rhotrack/reflectors.h"
#include "rhotrack/udpm.h"

#define STATUS_INTERVAL_US 1000000

static struct node_config settings;
static struct rho_scan_assembler assembler;
static struct rho_tracker tracker;
static struct rho_frames frames;
static struct rho_report report;
static struct rho_node node;
static struct rho_reflector_learning learning; /* used where NODE_LEARNS_REFLECTORS is 1 */

static struct rho_udpm_guard guard;

static uint8_t buffer[RHO_UDPM_MAX_DATAGRAM]; /* the datagram being sent */
static int is_started;
static uint32_t datagrams_sent, datagrams_refused;
static int64_t status_due_us;

/* ---- Sent messages ---- */

/* Epoch of track numbers: differs after each start, and after each jump of the sensors' clock. */
static int32_t current_epoch(void)
{
    return (int32_t)((uint32_t)settings.boot << 8 | (node.counters.restarts & 0xffu));
}

/*
 * Writes the datagram's header for the channel; returns where its message goes, NULL where the
 * channel is not valid.
 */
static uint8_t *begin_message(const char *channel, size_t *head)
{
    return rho_udpm_begin(buffer, sizeof buffer, datagrams_sent, channel, head) == RHO_OK
               ? buffer + *head
               : NULL;
}

static void send_if_encoded(enum rho_status status, size_t size)
{
    if (status == RHO_OK) {
        datagrams_sent++;
        settings.send(settings.context, buffer, size);
    }
}

static void publish_messages_of_step(void)
{
    for (uint16_t part = 0; part < rho_node_num_messages(&node); part++) {
        size_t head, size = 0;
        uint8_t *message = begin_message(rho_node_channel(&node, part), &head);
        enum rho_status status = rho_node_publish(&node, track_starts_initiator_or_null(), part,
                                                  message, sizeof buffer - head, &size);
        send_if_encoded(status, head + size);
    }
}

static void add_saturating(int32_t *counter, uint32_t more)
{
    *counter = more < (uint32_t)(INT32_MAX - *counter) ? *counter + (int32_t)more : INT32_MAX;
}

static void publish_status(void)
{
    struct rho_message_status state;
    struct rho_message_work work;
    struct rho_message_learned learned;
    size_t head, size = 0;
    uint8_t *message = begin_message(RHO_MESSAGE_STATUS_CHANNEL, &head);
    enum rho_status status;
    rho_node_status(&node, track_starts_initiator_or_null(), &state);
    add_saturating(&state.fragments_refused, datagrams_refused);
    add_saturating(&state.fragments_refused, guard.refused_source);
    add_saturating(&state.fragments_refused, guard.refused_mac);
    status = rho_message_status_encode(&state, message, sizeof buffer - head, &size);
    send_if_encoded(status, head + size);
    message = begin_message(RHO_MESSAGE_WORK_CHANNEL, &head);
    rho_node_work(&node, &work);
    status = rho_message_work_encode(&work, message, sizeof buffer - head, &size);
    send_if_encoded(status, head + size);
    /* a library without the filter of hypotheses (RHO_FILTERS 4) learns nothing */
    if (((RHO_FILTERS)&4) != 0 && rho_node_learned(&node, &learned)) {
        message = begin_message(RHO_MESSAGE_LEARNED_CHANNEL, &head);
        status = rho_message_learned_encode(&learned, message, sizeof buffer - head, &size);
        send_if_encoded(status, head + size);
    }
}

/* ---- Steps ---- */

static enum rho_status init_tracker_keeping_counters(void)
{
    const struct rho_tracker_counters counters = tracker.counters;
    const struct rho_tracker_work work = tracker.work;
    enum rho_status status = rho_tracker_init(&tracker, sizeof tracker, &settings.tracker);
    if (status == RHO_OK) {
        tracker.counters = counters;
        tracker.work = work;
        status = track_starts_init(&settings);
    }
    if (RHO_BODIES && NODE_BODY_MAX_M > 0.0f && status == RHO_OK) {
        status = rho_tracker_set_body_max(&tracker, NODE_BODY_MAX_M);
    }
    return status;
}

static void step_and_publish(void)
{
    int64_t start_us = settings.clock_us(settings.context);
    if (node_step_and_start_tracks(&node) == RHO_OK) {
        if (NODE_LEARNS_REFLECTORS && node.stepped == RHO_NODE_SCAN) {
            (void)!rho_reflector_learning_step(&learning, &tracker, &node.scan, &report);
        }
        rho_node_count_time(&node, settings.clock_us(settings.context) - start_us);
        if (settings.stepped) {
            settings.stepped(settings.context, &report);
        }
        publish_messages_of_step();
    }
}

/*
 * Steps and publishes all scans that are due; at a restart initialises the tracker anew with the
 * same settings.
 */
static void step_all_due(int64_t now_us)
{
    enum rho_node_due due;
    while ((due = rho_node_next(&node, now_us)) != RHO_NODE_NOTHING) {
        if (due == RHO_NODE_RESTART) {
            is_started = init_tracker_keeping_counters() == RHO_OK;
            node.epoch = current_epoch();
        } else {
            step_and_publish();
        }
    }
}

/* ---- Received datagrams ---- */

const struct rho_udpm_guard *node_sender_filter(void)
{
    return &guard;
}

/*
 * Whether the sender is allowed and the authentication code is right; removes the code from *size
 * and counts refused datagrams.
 */
static int admit_datagram_and_strip_mac(const uint8_t *bytes, size_t *size, uint32_t source_ipv4)
{
    const size_t whole = *size;
    if (!rho_udpm_admits(&guard, source_ipv4)) {
        return 0;
    }
    if (settings.is_authentic &&
        (!settings.is_authentic(settings.context, bytes, size) || *size > whole)) {
        guard.refused_mac = rho_count(guard.refused_mac, 1);
        return 0;
    }
    return 1;
}

void node_receive(const uint8_t *bytes, size_t size, uint32_t source_ipv4, int64_t now_us)
{
    struct rho_udpm_datagram datagram;
    if (!is_started || !admit_datagram_and_strip_mac(bytes, &size, source_ipv4)) {
        return;
    }
    if (rho_udpm_parse(bytes, size, &datagram) != RHO_OK) {
        datagrams_refused = rho_count(datagrams_refused, 1);
        return;
    }
    while (rho_node_take(&node, datagram.channel, datagram.payload, datagram.payload_size,
                         now_us) == RHO_ERROR_CAPACITY) {
        step_all_due(now_us);
    }
    step_all_due(now_us);
}

void node_tick(int64_t now_us)
{
    if (!is_started) {
        return;
    }
    step_all_due(now_us);
    if (now_us >= status_due_us) {
        status_due_us = now_us + STATUS_INTERVAL_US;
        publish_status();
    }
}

int64_t node_due_us(void)
{
    int64_t due_us = rho_node_due_us(&node);
    return due_us < status_due_us ? due_us : status_due_us;
}

void node_step_waiting_scans(void)
{
    if (is_started) {
        step_all_due(INT64_MAX);
        publish_status();
    }
}

/* ---- Start ---- */

void node_config_default(struct node_config *config)
{
    *config = (struct node_config){.boot = 0};
    rho_scan_assembler_config_default(&config->assembler);
    node_settings(&config->tracker, &config->initiator);
}

static enum rho_status init_assembler(const struct node_config *config)
{
    enum rho_status status =
        rho_scan_assembler_init(&assembler, sizeof assembler, &config->assembler);
    for (uint16_t i = 0; i < config->num_sensors && status == RHO_OK; i++) {
        status = rho_scan_assembler_set_sensor(&assembler, &config->sensors[i]);
    }
    return status;
}

static enum rho_status init_library_node(void)
{
    struct rho_node_config config = {
        .assembler = &assembler, .tracker = &tracker, .report = &report, .epoch = current_epoch()};
    enum rho_status status = RHO_OK;
    if (NODE_HAS_BEARINGS) {
        struct rho_frames_config gather;
        rho_frames_config_default(&gather);
        status = rho_frames_init(&frames, sizeof frames, &gather);
        config.frames = &frames;
    }
    track_starts_set_bearings(&config);
    return status == RHO_OK ? rho_node_init(&node, sizeof node, &config) : status;
}

enum rho_status node_start(const struct node_config *config)
{
    enum rho_status status;
    if (!config || !config->send || !config->clock_us) {
        return RHO_ERROR_NULL;
    }
    if (config->num_sources > RHO_UDPM_MAX_SOURCES || (config->num_sources && !config->sources)) {
        return RHO_ERROR_VALUE;
    }
    settings = *config;
    guard = (struct rho_udpm_guard){.num_sources = config->num_sources};
    for (uint16_t i = 0; i < config->num_sources; i++) {
        guard.sources[i] = config->sources[i];
    }
    status_due_us = INT64_MIN; /* the first status is due at once */
    status = init_assembler(config);
    if (status == RHO_OK) {
        status = init_tracker_keeping_counters();
    }
    if (status == RHO_OK) {
        status = init_library_node();
    }
    if (NODE_LEARNS_REFLECTORS && status == RHO_OK) {
        status = rho_reflector_learning_init(&learning, sizeof learning);
    }
    is_started = status == RHO_OK;
    return status;
}
