/* SPDX-License-Identifier: MIT */
#include "lcm_datagram_node.h"

#include "node_settings_defaults.h"
#include "rhotrack/message.h"
#include "rhotrack/node.h"
#include "rhotrack/udpm.h"

#define STATUS_INTERVAL_US 1000000

static struct rho_node node;
static struct node_hooks hooks;
static struct rho_udpm_guard guard;

static uint8_t buffer[RHO_UDPM_MAX_DATAGRAM]; /* the datagram being sent */
static int is_started;
static int32_t boot;
static uint32_t datagrams_sent, datagrams_refused;
static int64_t status_due_us;

/* ---- Sent messages ---- */

/* Epoch of track numbers: differs after each start, and after each jump of the sensors' clock. */
static int32_t current_epoch(void)
{
    return (int32_t)((uint32_t)boot << 8 | (node.counters.restarts & 0xffu));
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
        hooks.send(hooks.context, buffer, size);
    }
}

static void publish_messages_of_step(void)
{
    for (uint16_t part = 0; part < rho_node_num_messages(&node); part++) {
        size_t head, size = 0;
        uint8_t *message = begin_message(rho_node_channel(&node, part), &head);
        enum rho_status status =
            rho_node_publish(&node, part, message, sizeof buffer - head, &size);
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
    rho_node_status(&node, &state);
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
    for (uint16_t part = 0; status == RHO_OK; part++) {
        message = begin_message(RHO_MESSAGE_LIFE_CHANNEL, &head);
        status = rho_node_life(&node, part, message, sizeof buffer - head, &size);
        send_if_encoded(status, head + size);
    }
}

/* ---- Steps ---- */

/* Makes and publishes all steps that are due. */
static void step_all_due(int64_t now_us)
{
    enum rho_node_due done = RHO_NODE_RESTART;
    while (done != RHO_NODE_NOTHING) {
        int64_t start_us = hooks.clock_us(hooks.context);
        done = rho_node_next(&node, now_us);
        if (done == RHO_NODE_SCAN || done == RHO_NODE_BEARINGS) {
            rho_node_count_time(&node, hooks.clock_us(hooks.context) - start_us);
            if (hooks.stepped) {
                hooks.stepped(hooks.context, &node.report);
            }
        }
        if (done != RHO_NODE_NOTHING) {
            publish_messages_of_step();
        }
        if (done == RHO_NODE_RESTART) { /* its answers are of the epoch before */
            node.epoch = current_epoch();
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
    if (hooks.is_authentic && (!hooks.is_authentic(hooks.context, bytes, size) || *size > whole)) {
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
    *config = (struct node_config){.num_sensors = 0};
    node_settings(&config->settings, &config->node);
}

static enum rho_status prepare_node(const struct node_config *config)
{
    enum rho_status status = rho_node_init(&node, sizeof node, &config->settings);
    if (status == RHO_OK) {
        status = rho_node_configure(&node, &config->node);
    }
    for (uint16_t i = 0; i < config->num_sensors && status == RHO_OK; i++) {
        status = rho_scan_assembler_set_sensor(&node.assembler, &config->sensors[i]);
    }
    return status;
}

enum rho_status node_start(const struct node_config *config)
{
    enum rho_status status;
    if (!config || !config->hooks.send || !config->hooks.clock_us) {
        return RHO_ERROR_NULL;
    }
    if (config->num_sources > RHO_UDPM_MAX_SOURCES || (config->num_sources && !config->sources)) {
        return RHO_ERROR_VALUE;
    }
    hooks = config->hooks;
    boot = config->boot;
    guard = (struct rho_udpm_guard){.num_sources = config->num_sources};
    for (uint16_t i = 0; i < config->num_sources; i++) {
        guard.sources[i] = config->sources[i];
    }
    status_due_us = INT64_MIN; /* the first status is due at once */
    status = prepare_node(config);
    is_started = status == RHO_OK;
    node.epoch = current_epoch();
    return status;
}
