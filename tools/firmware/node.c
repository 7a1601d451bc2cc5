/* SPDX-License-Identifier: MIT */
#include "node.h"

#include "node_bearings.h"
#include "node_settings.h"
#include "node_step.h"
#include "rhotrack/message.h"
#include "rhotrack/publish.h"
#include "rhotrack/udpm.h"

#define STATUS_INTERVAL_US 1000000

static struct node_config settings;
static struct rho_feed feed;
static struct rho_tracker tracker;
static struct rho_initiator initiator;
static struct rho_report report;

static struct rho_udpm_guard guard;

static uint8_t buffer[RHO_UDPM_MAX_DATAGRAM]; /* the datagram that goes out */
static struct {
    int is_started;
    int32_t step;
    uint32_t restarts; /* of the tracker, since the start */
    uint32_t datagrams_sent, datagrams_refused;
    uint32_t plots_refused;           /* of scans that were not stepped for want of room */
    int64_t step_sum_us, step_max_us; /* since the last status */
    int32_t step_count;
    int64_t status_due_us;
} node;

/* ---- Messages that go out ---- */

/* Another one after each start, and where the sensors' clock was set. */
static int32_t epoch(void)
{
    return (int32_t)((uint32_t)settings.boot << 8 | (node.restarts & 0xffu));
}

/* Sends what write makes behind the datagram's head. */
typedef enum rho_status (*writer)(uint8_t *message, size_t capacity, size_t *size,
                                  const void *what);

static void publish(const char *channel, writer write, const void *what)
{
    size_t head, size;
    if (rho_udpm_begin(buffer, sizeof buffer, node.datagrams_sent, channel, &head) == RHO_OK &&
        write(buffer + head, sizeof buffer - head, &size, what) == RHO_OK) {
        node.datagrams_sent++;
        settings.send(settings.context, buffer, head + size);
    }
}

static enum rho_status write_tracks(uint8_t *message, size_t capacity, size_t *size,
                                    const void *part)
{
    return rho_publish_tracks(&report, node.step, epoch(), *(const uint16_t *)part, message,
                              capacity, size);
}

static enum rho_status write_peaks(uint8_t *message, size_t capacity, size_t *size,
                                   const void *searched)
{
    const struct node_searched *of = searched;
    const struct rho_passive *passive = RHO_FEED_HAS(RHO_FEED_BEARINGS) ? of->passive : NULL;
    return rho_publish_peaks(of->initiator, passive, report.time_us, node.step, message, capacity,
                             size);
}

static enum rho_status write_status(uint8_t *message, size_t capacity, size_t *size,
                                    const void *status)
{
    return rho_message_status_encode(status, message, capacity, size);
}

static enum rho_status write_work(uint8_t *message, size_t capacity, size_t *size, const void *work)
{
    return rho_message_work_encode(work, message, capacity, size);
}

static void add(int32_t *counter, uint32_t more)
{
    *counter = more < (uint32_t)(INT32_MAX - *counter) ? *counter + (int32_t)more : INT32_MAX;
}

static void publish_status(void)
{
    struct rho_message_status status;
    rho_publish_status(&feed, node_bearings_frames(), &tracker, &initiator, &status);
    status.utime = report.time_us;
    status.scan = node.step;
    status.epoch = epoch();
    add(&status.fragments_refused, node.datagrams_refused);
    add(&status.fragments_refused, guard.refused_source);
    add(&status.fragments_refused, guard.refused_mac);
    add(&status.plots_in, node.plots_refused);
    add(&status.inputs_no_room, node.plots_refused);
    if (node.step_count > 0) {
        status.step_us = (float)(int32_t)node.step_sum_us / (float)node.step_count;
        status.step_max_us = (float)(int32_t)node.step_max_us;
    }
    node.step_sum_us = node.step_max_us = node.step_count = 0;
    publish(RHO_MESSAGE_STATUS_CHANNEL, write_status, &status);
}

static void publish_work(void)
{
    struct rho_message_work work;
    rho_publish_work(&tracker, &work);
    work.utime = report.time_us;
    work.scan = node.step;
    work.epoch = epoch();
    work.num_steps = (uint32_t)node.step;
    publish(RHO_MESSAGE_WORK_CHANNEL, write_work, &work);
}

static void publish_state(void)
{
    publish_status();
    publish_work();
}

/* ---- Steps ---- */

static void count_time(int64_t took_us)
{
    node.step_count++;
    node.step_sum_us += took_us;
    if (took_us > node.step_max_us) {
        node.step_max_us = took_us;
    }
}

/* A step that began at start_us was made. */
static void finish_step(int64_t start_us, const struct node_searched *searched)
{
    count_time(settings.clock_us(settings.context) - start_us);
    node.step = node.step == INT32_MAX ? INT32_MIN : node.step + 1;
    if (settings.stepped) {
        settings.stepped(settings.context, &report);
    }
    for (uint16_t part = 0; part < rho_publish_num_parts(&report); part++) {
        publish(RHO_MESSAGE_TRACK_LIST_CHANNEL, write_tracks, &part);
    }
    publish(RHO_MESSAGE_PEAK_LIST_CHANNEL, write_peaks, searched);
}

void node_step_scan(const struct rho_scan *scan)
{
    const struct node_searched searched = {&initiator, NULL};
    int64_t start_us = settings.clock_us(settings.context);
    if (rho_tracker_step(&tracker, &initiator, scan, &report) == RHO_OK) {
        finish_step(start_us, &searched);
    }
}

void node_step_frame(struct rho_passive *passive, const struct rho_frame *frame)
{
    const struct node_searched searched = {NULL, passive};
    int64_t start_us = settings.clock_us(settings.context);
    if (rho_tracker_step_frame(&tracker, passive, frame, &report) == RHO_OK) {
        finish_step(start_us, &searched);
    }
}

static int is_heard(int32_t sensor_id)
{
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        if (feed.sources[i].is_used && feed.sources[i].sensor_id == sensor_id) {
            return 1;
        }
    }
    return 0;
}

/* The feed holds no more sensors than there is room for: those that it has given up make room. */
int node_describe(const struct rho_sensor *sensor)
{
    if (rho_tracker_set_sensor(&tracker, sensor) == RHO_OK) {
        return 1;
    }
    for (unsigned i = tracker.num_sensors; i-- > 0;) {
        if (!is_heard(tracker.sensors[i].sensor_id)) {
            (void)!rho_tracker_forget_sensor(&tracker, tracker.sensors[i].sensor_id);
        }
    }
    return rho_tracker_set_sensor(&tracker, sensor) == RHO_OK;
}

/* ---- Scans that come in ---- */

static enum rho_status open_tracker(void)
{
    const struct rho_tracker_counters counters = tracker.counters;
    const struct rho_tracker_work work = tracker.work;
    enum rho_status status = rho_tracker_init(&tracker, sizeof tracker, &settings.tracker);
    if (status == RHO_OK) {
        tracker.counters = counters;
        tracker.work = work;
        status = rho_initiator_init(&initiator, sizeof initiator, &settings.initiator);
    }
    return status;
}

/* The config was taken once already: it is again. */
void node_restart(void)
{
    node.is_started = open_tracker() == RHO_OK && node_bearings_open_search() == RHO_OK;
    node.restarts++;
}

static void take_item(const struct rho_feed_item *item)
{
    if (item->is_restart) {
        node_bearings_close_before(INT64_MAX);
        node_restart();
        node.is_started &= node_bearings_open_frames() == RHO_OK;
    }
    if (RHO_FEED_IS(item->kind, RHO_FEED_BEARINGS)) {
        node_bearings_take(item);
        return;
    }
    node_bearings_close_before(item->scan.time_us);
    if (!item->has_sensor || node_describe(&item->sensor)) {
        node_step_scan(&item->scan);
    } else { /* without its sensor's place it would say something else */
        node.plots_refused = rho_count(node.plots_refused, item->scan.num_plots);
    }
}

static void step_due(int64_t now_us)
{
    struct rho_feed_item item;
    while (rho_feed_next(&feed, now_us, &item)) {
        take_item(&item);
    }
}

const struct rho_udpm_guard *node_guard(void)
{
    return &guard;
}

static int is_welcome(const uint8_t *bytes, size_t *size, uint32_t source_ipv4)
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
    struct rho_feed_item item;
    if (!node.is_started || !is_welcome(bytes, &size, source_ipv4)) {
        return;
    }
    if (rho_udpm_parse(bytes, size, &datagram) != RHO_OK) {
        node.datagrams_refused = rho_count(node.datagrams_refused, 1);
        return;
    }
    while (rho_feed_take(&feed, datagram.channel, datagram.payload, datagram.payload_size,
                         now_us) == RHO_ERROR_CAPACITY) {
        if (rho_feed_next(&feed, now_us, &item)) {
            take_item(&item);
        }
    }
    step_due(now_us);
}

void node_tick(int64_t now_us)
{
    if (!node.is_started) {
        return;
    }
    step_due(now_us);
    if (now_us >= node.status_due_us) {
        node.status_due_us = now_us + STATUS_INTERVAL_US;
        publish_state();
    }
}

int64_t node_due_us(void)
{
    int64_t due_us = rho_feed_due_us(&feed);
    return due_us < node.status_due_us ? due_us : node.status_due_us;
}

void node_flush(void)
{
    if (node.is_started) {
        step_due(INT64_MAX);
        node_bearings_close_before(INT64_MAX);
        publish_state();
    }
}

/* ---- Start ---- */

void node_config_default(struct node_config *config)
{
    *config = (struct node_config){.boot = 0};
    rho_feed_config_default(&config->feed);
    node_settings(&config->tracker, &config->initiator);
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
    node.status_due_us = INT64_MIN; /* at once */
    status = rho_feed_init(&feed, sizeof feed, &config->feed);
    for (uint16_t i = 0; i < config->num_sensors && status == RHO_OK; i++) {
        status = rho_feed_set_sensor(&feed, &config->sensors[i]);
    }
    if (status == RHO_OK) {
        status = open_tracker();
    }
    if (status == RHO_OK) {
        status = node_bearings_open_search();
    }
    if (status == RHO_OK) {
        status = node_bearings_open_frames();
    }
    node.is_started = status == RHO_OK;
    return status;
}
