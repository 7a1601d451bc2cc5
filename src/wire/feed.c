/* SPDX-License-Identifier: MIT */
#include "rhotrack/feed.h"

#include <string.h>

#include "feed_parts.h"
#include "rhotrack/angle.h"
#include "rhotrack/measurement.h"

#define MAGIC 0x66656564u
#define HOLD_MAX_US 10000000
#define LATE_MAX_US 60000000
#define JUMP_MIN_US 1000000
#define JUMP_MAX_US 3600000000ll
#define FLOOD_MAX 1000000u
#define STRANGER_PLOTS RHO_CONFIG_PICK(64, 256)
#define CHECK_START 2166136261u /* of FNV-1a */
#define CHECK_FACTOR 16777619u

typedef char rho_feed_fits_its_formula[sizeof(struct rho_feed) <= RHO_RAM_FEED_BYTES ? 1 : -1];

static int is_ready(const struct rho_feed *feed)
{
    return feed->magic == MAGIC;
}

/* ---- Configuration ---- */

static int is_sigma(float sigma)
{
    return rho_is_within(sigma, RHO_LIMIT_SIGMA_MIN, RHO_LIMIT_SIGMA_MAX);
}

static int is_sigma_rad(float sigma_rad)
{
    return rho_is_within(sigma_rad, RHO_LIMIT_SIGMA_RAD_MIN, RHO_LIMIT_SIGMA_RAD_MAX);
}

static int is_noise(const struct rho_feed_noise *noise)
{
    return is_sigma(noise->sigma_m) && is_sigma(noise->sigma_mps) &&
           is_sigma(noise->sigma_range_m) && is_sigma(noise->sigma_range_rate_mps) &&
           is_sigma_rad(noise->sigma_azimuth_rad) && is_sigma_rad(noise->sigma_elevation_rad) &&
           is_sigma_rad(noise->sigma_rad);
}

static int is_known(const struct rho_feed_sensor *known)
{
    return is_noise(&known->noise) && rho_measurement_is_sensor(&known->sensor);
}

static int is_config(const struct rho_feed_config *config)
{
    return config->hold_us >= 0 && config->hold_us <= HOLD_MAX_US && config->late_max_us >= 0 &&
           config->late_max_us <= LATE_MAX_US && config->jump_max_us >= JUMP_MIN_US &&
           config->jump_max_us <= JUMP_MAX_US && config->flood_per_s >= 1 &&
           config->flood_per_s <= FLOOD_MAX && config->follow_scans >= 2 &&
           config->follow_scans <= 255 && config->stranger_plots_per_s >= 1 &&
           config->stranger_plots_per_s <= FLOOD_MAX && config->num_allowed <= RHO_MAX_SENSORS &&
           is_known(&config->other);
}

void rho_feed_config_default(struct rho_feed_config *config)
{
    *config = (struct rho_feed_config){
        .hold_us = 20000,
        .late_max_us = RHO_SECTORS ? 20000000 : 0,
        .jump_max_us = 30000000,
        .flood_per_s = 10000,
        .follow_scans = 3,
        .stranger_plots_per_s = STRANGER_PLOTS,
        .other = {.sensor = {.pd = 0.9f, .range_max_m = 2.0f * RHO_LIMIT_POSITION_M},
                  .noise = {.sigma_m = 10.0f,
                            .sigma_mps = 1.0f,
                            .sigma_range_m = 15.0f,
                            .sigma_azimuth_rad = 0.003f,
                            .sigma_elevation_rad = 0.003f,
                            .sigma_range_rate_mps = 1.0f,
                            .sigma_rad = 0.00175f}},
    };
}

enum rho_status rho_feed_init(struct rho_feed *feed, size_t size,
                              const struct rho_feed_config *config)
{
    if (!feed || !config) {
        return RHO_ERROR_NULL;
    }
    if (size != sizeof *feed) {
        return RHO_ERROR_SIZE;
    }
    if (!is_config(config)) {
        return RHO_ERROR_CONFIG;
    }
    memset(feed, 0, sizeof *feed);
    memcpy(&feed->config, config, sizeof feed->config);
    feed->strangers.left = config->flood_per_s;
    feed->stranger_plots.left = config->stranger_plots_per_s;
    feed->out_us = INT64_MIN;
    feed->magic = MAGIC;
    return RHO_OK;
}

enum rho_status rho_feed_set_sensor(struct rho_feed *feed, const struct rho_feed_sensor *sensor)
{
    unsigned i = 0;

    if (!feed || !sensor) {
        return RHO_ERROR_NULL;
    }
    if (!is_ready(feed)) {
        return RHO_ERROR_STATE;
    }
    if (!is_known(sensor)) {
        return RHO_ERROR_CONFIG;
    }
    while (i < feed->num_known && feed->known[i].sensor.sensor_id != sensor->sensor.sensor_id) {
        i++;
    }
    if (i == RHO_MAX_SENSORS) {
        return RHO_ERROR_CAPACITY;
    }
    feed->known[i] = *sensor;
    feed->num_known = (uint16_t)(feed->num_known + (i == feed->num_known));
    return RHO_OK;
}

/* ---- Channels ---- */

/* The number behind the prefix, as a sensor writes it: no sign but -, no leading zeros, within int16_t. 0: none. */
static int read_number(const char *text, int16_t *number)
{
    int is_negative = text[0] == '-';
    const char *digits = text + is_negative;
    int32_t value = 0;

    if (digits[0] == '\0' || (digits[0] == '0' && (digits[1] != '\0' || is_negative))) {
        return 0;
    }
    for (; *digits != '\0'; digits++) {
        if (*digits < '0' || *digits > '9') {
            return 0;
        }
        value = value * 10 + (*digits - '0');
        if (value > INT16_MAX + is_negative) {
            return 0;
        }
    }
    *number = (int16_t)(is_negative ? -value : value);
    return 1;
}

static int read_channel(const char *channel, enum rho_feed_kind *kind, int16_t *sensor_id)
{
    static const char prefixes[RHO_NUM_FEED_KINDS][14] = {
        [RHO_FEED_PLOTS] = RHO_MESSAGE_PLOT_SCAN_CHANNEL,
        [RHO_FEED_POLAR] = RHO_MESSAGE_POLAR_SCAN_CHANNEL,
        [RHO_FEED_BEARINGS] = RHO_MESSAGE_BEARING_SCAN_CHANNEL,
    };

    for (unsigned i = 0; i < RHO_NUM_FEED_KINDS; i++) {
        unsigned length = 0;

        while (prefixes[i][length] != '\0' && channel[length] == prefixes[i][length]) {
            length++;
        }
        if (prefixes[i][length] == '\0' && RHO_FEED_HAS(i)) {
            *kind = (enum rho_feed_kind)i;
            return read_number(channel + length, sensor_id);
        }
    }
    return 0;
}

/* ---- Sources ---- */

static struct rho_feed_source *find_source(struct rho_feed *feed, enum rho_feed_kind kind,
                                           int16_t sensor_id)
{
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        struct rho_feed_source *source = &feed->sources[i];

        if (source->is_used && source->kind == kind && source->sensor_id == sensor_id) {
            return source;
        }
    }
    return NULL;
}

static int gives_way(const struct rho_feed *feed, const struct rho_feed_source *source,
                     int64_t now_us)
{
    return !rho_feed_is_proven(&feed->config, source) || source->off_clock > 0 ||
           rho_elapsed_us(now_us, source->heard_us) > (uint64_t)feed->config.jump_max_us;
}

/* A free place, or that of the one heard longest ago that may give way; NULL: none. */
static struct rho_feed_source *find_room(struct rho_feed *feed, int64_t now_us)
{
    struct rho_feed_source *oldest = NULL;

    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        struct rho_feed_source *source = &feed->sources[i];

        if (!source->is_used) {
            return source;
        }
        if (gives_way(feed, source, now_us) && (!oldest || source->heard_us < oldest->heard_us)) {
            oldest = source;
        }
    }
    return oldest;
}

/* ---- A message of a scan ---- */

static void refuse(struct rho_feed *feed, struct rho_feed_source *source, enum feed_verdict verdict,
                   const struct feed_heading *heading)
{
    if (verdict == FEED_DUPLICATE && source->off_clock > 0) {
        rho_feed_count_one(
            &feed->counters.clock_jumps); /* another part of a scan that was refused */
    } else if (verdict == FEED_DUPLICATE && source->check == FEED_CHECK_NO_TURN &&
               heading->place.scan == source->place.scan) {
        rho_feed_count_one(&feed->counters.messages_flooded); /* likewise, for want of a turn */
    } else if (verdict == FEED_DUPLICATE) {
        rho_feed_count_double(feed, source, heading);
    } else if (verdict == FEED_LATE) {
        rho_feed_count_one(&feed->counters.scans_late);
    } else {
        rho_feed_note_stray(&feed->config, source, &heading->place);
        rho_feed_count_one(verdict == FEED_STRAY_TIME ? &feed->counters.clock_jumps
                                                      : &feed->counters.scans_bad);
    }
}

static void open_scan(struct rho_feed *feed, const struct rho_feed_source *source,
                      const struct feed_heading *heading, const union feed_message *message,
                      enum feed_slot_order order, int64_t now_us)
{
    struct rho_feed_slot *slot = rho_feed_find_state(feed, FEED_SLOT_FREE);

    rho_feed_count_one(&feed->counters.scans_accepted);
    rho_feed_open_slot(feed, slot, source, heading, order);
    rho_feed_add_part(feed, slot, heading, message, now_us);
}

/* The config names it. */
static int is_named(const struct rho_feed *feed, const struct feed_heading *heading)
{
    return feed->config.num_allowed > 0 ||
           rho_feed_known(feed, heading->sensor_id) != &feed->config.other;
}

/*
 * Between two scans of others newcomers have one, all together: more of them, and empty, would be the misses in a row that
 * end tracks.
 */
static int has_turn(struct rho_feed *feed, const struct feed_heading *heading, int is_new)
{
    if (!is_new) {
        feed->newcomers = 0;
    } else if (heading->is_new && feed->newcomers++ > 0) {
        rho_feed_count_one(&feed->counters.messages_flooded);
        feed->newcomers = 1;
        return 0;
    }
    return 1;
}

/* A scan that is believed begins; the one before it of this sensor is as complete as it gets. */
static void begin_scan(struct rho_feed *feed, struct rho_feed_source *source,
                       enum feed_verdict verdict, const struct feed_heading *heading,
                       const union feed_message *message, int is_new, int64_t now_us)
{
    rho_feed_close_open(feed, source, verdict == FEED_FOLLOW);
    feed->counters.scans_lost =
        rho_count(feed->counters.scans_lost,
                  rho_feed_note_place(&feed->config, source, &heading->place, verdict, now_us));
    if (verdict == FEED_FOLLOW) {
        rho_feed_count_one(&feed->counters.sensor_restarts);
    }
    if (!rho_feed_is_on_clock(feed, source, heading->place.time_us, verdict, now_us)) {
        rho_feed_count_one(&feed->counters.clock_jumps);
    } else if (has_turn(feed, heading, is_new)) {
        open_scan(feed, source, heading, message, FEED_ORDER_NEXT, now_us);
    } else {
        source->check = FEED_CHECK_NO_TURN;
    }
}

/* A number that was skipped comes after all. Of a sensor's one at a time waits for its parts, where there is room. */
static void begin_skipped(struct rho_feed *feed, struct rho_feed_source *source,
                          const struct feed_heading *heading, const union feed_message *message,
                          int is_new, int64_t now_us)
{
    if (!has_turn(feed, heading, is_new)) {
        return;
    }
    rho_feed_count_one(&feed->counters.scans_late);
    if (!rho_feed_find_state(feed, FEED_SLOT_FREE) ||
        (heading->num_parts > 1 && rho_feed_has_late_open(feed, source))) {
        return;
    }
    rho_feed_note_skipped(source, heading->place.scan);
    open_scan(feed, source, heading, message, FEED_ORDER_LATE, now_us);
}

/* Takes the place that find_room found. */
static void begin_source(struct rho_feed *feed, struct rho_feed_source *source,
                         const struct feed_heading *heading)
{
    rho_feed_close_open(feed, source, 1);
    *source = (struct rho_feed_source){
        .messages = {.full_us = feed->strangers.full_us, .left = feed->config.flood_per_s},
        .sensor_id = heading->sensor_id,
        .kind = heading->kind,
        .is_used = 1};
}

/*
 * True where room may be made for another scan. A newcomer, and a sensor that is not proven, must neither cut short nor
 * make late a scan of another one while its parts are still coming.
 */
static int may_press(struct rho_feed *feed, const struct rho_feed_source *source, int is_new,
                     int64_t now_us)
{
    return (source && rho_feed_is_proven(&feed->config, source) && !is_new) ||
           rho_feed_find_state(feed, FEED_SLOT_GIVEN) || rho_feed_find_spare(feed, now_us);
}

/* Errors: CAPACITY. */
static enum rho_status take_part(struct rho_feed *feed, const struct feed_heading *heading,
                                 const union feed_message *message, struct rho_feed_source *source,
                                 int is_new, int64_t now_us)
{
    struct rho_feed_slot *slot = source ? rho_feed_find_scan(feed, source, heading) : NULL;
    struct rho_feed_source *place;
    enum feed_verdict verdict;
    int is_free;

    if (slot) {
        rho_feed_add_part(feed, slot, heading, message, now_us);
        return RHO_OK;
    }
    verdict = source ? rho_feed_judge(feed, source, &heading->place, now_us) : FEED_NEXT;
    if (verdict != FEED_NEXT && verdict != FEED_FOLLOW && verdict != FEED_SKIPPED) {
        refuse(feed, source, verdict, heading);
        return RHO_OK;
    }
    if (verdict == FEED_SKIPPED) {
        begin_skipped(feed, source, heading, message, is_new, now_us);
        return RHO_OK;
    }
    place = source ? source : find_room(feed, now_us);
    is_free = place && rho_feed_make_free(feed, is_new, now_us);
    if (!place || (!is_free && !may_press(feed, source, is_new, now_us))) {
        rho_feed_count_one(&feed->counters.sensors_no_room);
        return RHO_OK;
    }
    if (!is_free) {
        feed->is_pressed = 1;
        return RHO_ERROR_CAPACITY;
    }
    if (!source) {
        begin_source(feed, place, heading);
    }
    begin_scan(feed, place, verdict, heading, message, is_new, now_us);
    return RHO_OK;
}

static int is_allowed(const struct rho_feed_config *config, int16_t sensor_id)
{
    for (unsigned i = 0; i < config->num_allowed; i++) {
        if (config->allowed[i] == sensor_id) {
            return 1;
        }
    }
    return config->num_allowed == 0;
}

static uint32_t check_of(const uint8_t *data, size_t size)
{
    uint32_t check = CHECK_START;

    for (size_t i = 0; i < size; i++) {
        check = (uint32_t)((uint64_t)(check ^ data[i]) * CHECK_FACTOR & UINT32_MAX);
    }
    return check > FEED_CHECK_NO_TURN ? check : FEED_CHECK_NO_TURN + 1u;
}

enum rho_status rho_feed_take(struct rho_feed *feed, const char *channel, const uint8_t *data,
                              size_t size, int64_t now_us)
{
    struct rho_feed_source *source;
    struct rho_feed_bucket *bucket;
    union feed_message message;
    struct feed_heading heading;
    int is_new;
    enum rho_feed_kind kind;
    enum rho_status status;
    int16_t sensor_id;

    if (!feed || !channel || !data) {
        return RHO_ERROR_NULL;
    }
    if (!is_ready(feed)) {
        return RHO_ERROR_STATE;
    }
    if (!read_channel(channel, &kind, &sensor_id)) {
        return RHO_ERROR_TYPE;
    }
    if (!is_allowed(&feed->config, sensor_id)) {
        rho_feed_count_one(&feed->counters.messages_not_allowed);
        return RHO_OK;
    }
    source = find_source(feed, kind, sensor_id);
    is_new = rho_feed_is_new(source ? source->known_us : 0, rho_feed_eldest_us(feed, now_us));
    bucket = source && !is_new ? &source->messages : &feed->strangers;
    if (!rho_feed_draw(bucket, 1, feed->config.flood_per_s, now_us)) {
        rho_feed_count_one(&feed->counters.messages_flooded);
        return RHO_OK;
    }
    status = rho_feed_open_message(kind, data, size, &message, &heading);
    if (status != RHO_OK || heading.sensor_id != sensor_id) {
        rho_feed_count_one(status == RHO_ERROR_TYPE ? &feed->counters.messages_wrong_type
                                                    : &feed->counters.messages_bad);
        return RHO_OK;
    }
    if (!rho_feed_right_time(feed, &heading)) {
        rho_feed_count_one(&feed->counters.messages_bad);
        return RHO_OK;
    }
    if (heading.num_parts > RHO_MAX_PARTS) {
        rho_feed_count_one(&feed->counters.scans_bad);
        return RHO_OK;
    }
    heading.is_new = (uint8_t)(is_new && !is_named(feed, &heading));
    if (heading.is_new && !rho_feed_draw(&feed->stranger_plots, heading.num_inputs,
                                         feed->config.stranger_plots_per_s, now_us)) {
        rho_feed_count_one(&feed->counters.messages_flooded);
        return RHO_OK;
    }
    heading.check = check_of(data, size);
    status = take_part(feed, &heading, &message, source, is_new, now_us);
    if (status == RHO_ERROR_CAPACITY) { /* it comes again */
        bucket->left++;
        feed->stranger_plots.left += heading.is_new ? heading.num_inputs : 0u;
    }
    return status;
}

/* ---- Scans that are due ---- */

int rho_feed_next(struct rho_feed *feed, int64_t now_us, struct rho_feed_item *item)
{
    struct rho_feed_slot *slot;

    if (!feed || !item || !is_ready(feed)) {
        return 0;
    }
    slot = rho_feed_find_state(feed, FEED_SLOT_GIVEN);
    if (slot) {
        slot->state = FEED_SLOT_FREE;
    }
    if (rho_feed_find_state(feed, FEED_SLOT_FREE)) {
        feed->is_pressed = 0; /* there is room */
    }
    slot = rho_feed_find_due(feed, now_us);
    if (!slot) {
        return 0;
    }
    slot->state = FEED_SLOT_GIVEN;
    feed->out_us = feed->out_us > slot->place.time_us ? feed->out_us : slot->place.time_us;
    rho_feed_fill_item(slot, item);
    item->is_restart = feed->is_restart;
    feed->is_restart = 0;
    return 1;
}

int64_t rho_feed_due_us(const struct rho_feed *feed)
{
    int64_t due_us = INT64_MAX;

    if (!feed || !is_ready(feed)) {
        return due_us;
    }
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        const struct rho_feed_slot *slot = &feed->slots[i];
        int waits = slot->state == FEED_SLOT_COMPLETE ||
                    (slot->state == FEED_SLOT_OPEN && feed->config.hold_us > 0);

        if (waits && slot->heard_us <= INT64_MAX - feed->config.hold_us) {
            int64_t held_us = slot->heard_us + feed->config.hold_us;
            int64_t early_us =
                slot->state == FEED_SLOT_COMPLETE ? rho_feed_early_until_us(feed, slot) : INT64_MIN;

            held_us = early_us > held_us ? early_us : held_us;
            due_us = held_us < due_us ? held_us : due_us;
        }
    }
    return due_us;
}
