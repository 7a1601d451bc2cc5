/* SPDX-License-Identifier: MIT */
#include "rhotrack/scan_assembler.h"

#include <string.h>

#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/measurement.h"
#include "scan_assembler_internal.h"

#define MAGIC 0x66656564u
#define HOLD_MAX_US 10000000
#define LATE_MAX_US 60000000
#define JUMP_MIN_US 1000000
#define JUMP_MAX_US 3600000000ll
#define FLOOD_MAX 1000000u
#define STRANGER_PLOTS RHO_CONFIG_PICK(64, 256)
#define CHECK_START 2166136261u /* offset basis of the FNV-1a hash */
#define CHECK_FACTOR 16777619u  /* prime of the FNV-1a hash */

typedef char rho_scan_assembler_fits_its_formula
    [sizeof(struct rho_scan_assembler) <= RHO_RAM_SCAN_ASSEMBLER_BYTES ? 1 : -1];

static int is_initialised(const struct rho_scan_assembler *assembler)
{
    return assembler->magic == MAGIC;
}

/* ---- Configuration ---- */

static int is_sigma_in_limits(float sigma)
{
    return rho_is_within(sigma, RHO_LIMIT_SIGMA_MIN, RHO_LIMIT_SIGMA_MAX);
}

static int is_sigma_rad_in_limits(float sigma_rad)
{
    return rho_is_within(sigma_rad, RHO_LIMIT_SIGMA_RAD_MIN, RHO_LIMIT_SIGMA_RAD_MAX);
}

static int is_usable_noise(const struct rho_scan_assembler_noise *noise)
{
    return is_sigma_in_limits(noise->sigma_m) && is_sigma_in_limits(noise->sigma_mps) &&
           is_sigma_in_limits(noise->sigma_range_m) &&
           is_sigma_in_limits(noise->sigma_range_rate_mps) &&
           is_sigma_rad_in_limits(noise->sigma_azimuth_rad) &&
           is_sigma_rad_in_limits(noise->sigma_elevation_rad) &&
           is_sigma_rad_in_limits(noise->sigma_rad);
}

static int is_usable_sensor(const struct rho_scan_assembler_sensor *known)
{
    return is_usable_noise(&known->noise) &&
           rho_measurement_has_valid_place_and_biases(&known->sensor);
}

static int is_usable_config(const struct rho_scan_assembler_config *config)
{
    return config->hold_us >= 0 && config->hold_us <= HOLD_MAX_US && config->late_max_us >= 0 &&
           config->late_max_us <= LATE_MAX_US && config->jump_max_us >= JUMP_MIN_US &&
           config->jump_max_us <= JUMP_MAX_US && config->flood_per_s >= 1 &&
           config->flood_per_s <= FLOOD_MAX && config->follow_scans >= 2 &&
           config->follow_scans <= 255 && config->stranger_plots_per_s >= 1 &&
           config->stranger_plots_per_s <= FLOOD_MAX && config->num_allowed <= RHO_MAX_SENSORS &&
           is_usable_sensor(&config->other);
}

void rho_scan_assembler_config_default(struct rho_scan_assembler_config *config)
{
    *config = (struct rho_scan_assembler_config){
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

enum rho_status rho_scan_assembler_init(struct rho_scan_assembler *assembler, size_t size,
                                        const struct rho_scan_assembler_config *config)
{
    if (!assembler || !config) {
        return RHO_ERROR_NULL;
    }
    if (size != sizeof *assembler) {
        return RHO_ERROR_SIZE;
    }
    if (!is_usable_config(config)) {
        return RHO_ERROR_CONFIG;
    }
    memset(assembler, 0, sizeof *assembler);
    memcpy(&assembler->config, config, sizeof assembler->config);
    assembler->strangers.left = config->flood_per_s;
    assembler->stranger_plots.left = config->stranger_plots_per_s;
    assembler->out_us = INT64_MIN;
    assembler->magic = MAGIC;
    return RHO_OK;
}

enum rho_status rho_scan_assembler_set_sensor(struct rho_scan_assembler *assembler,
                                              const struct rho_scan_assembler_sensor *sensor)
{
    unsigned i = 0;

    if (!assembler || !sensor) {
        return RHO_ERROR_NULL;
    }
    if (!is_initialised(assembler)) {
        return RHO_ERROR_STATE;
    }
    if (!is_usable_sensor(sensor)) {
        return RHO_ERROR_CONFIG;
    }
    while (i < assembler->num_known &&
           assembler->known[i].sensor.sensor_id != sensor->sensor.sensor_id) {
        i++;
    }
    if (i == RHO_MAX_SENSORS) {
        return RHO_ERROR_CAPACITY;
    }
    assembler->known[i] = *sensor;
    assembler->num_known = (uint16_t)(assembler->num_known + (i == assembler->num_known));
    return RHO_OK;
}

/* ---- Channels ---- */

/*
 * Reads the sensor number at the end of a channel's name: no sign but -, no leading zeros, within
 * int16_t. Returns 0 where the text is no such number.
 */
static int parse_sensor_number(const char *text, int16_t *number)
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

static int parse_channel(const char *channel, enum rho_scan_assembler_kind *kind,
                         int16_t *sensor_id)
{
    static const char prefixes[RHO_NUM_SCAN_ASSEMBLER_KINDS][14] = {
        [RHO_SCAN_ASSEMBLER_PLOTS] = RHO_MESSAGE_PLOT_SCAN_CHANNEL,
        [RHO_SCAN_ASSEMBLER_POLAR] = RHO_MESSAGE_POLAR_SCAN_CHANNEL,
        [RHO_SCAN_ASSEMBLER_BEARINGS] = RHO_MESSAGE_BEARING_SCAN_CHANNEL,
    };

    for (unsigned i = 0; i < RHO_NUM_SCAN_ASSEMBLER_KINDS; i++) {
        unsigned length = 0;

        while (prefixes[i][length] != '\0' && channel[length] == prefixes[i][length]) {
            length++;
        }
        if (prefixes[i][length] == '\0' && RHO_SCAN_ASSEMBLER_HAS(i)) {
            *kind = (enum rho_scan_assembler_kind)i;
            return parse_sensor_number(channel + length, sensor_id);
        }
    }
    return 0;
}

/* ---- Sources ---- */

static struct rho_scan_assembler_source *find_source(struct rho_scan_assembler *assembler,
                                                     enum rho_scan_assembler_kind kind,
                                                     int16_t sensor_id)
{
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        struct rho_scan_assembler_source *source = &assembler->sources[i];

        if (source->is_used && source->kind == kind && source->sensor_id == sensor_id) {
            return source;
        }
    }
    return NULL;
}

static int is_source_unproven_off_clock_or_silent(const struct rho_scan_assembler *assembler,
                                                  const struct rho_scan_assembler_source *source,
                                                  int64_t now_us)
{
    return !rho_scan_assembler_is_proven(&assembler->config, source) || source->off_clock > 0 ||
           rho_elapsed_us(now_us, source->heard_us) > (uint64_t)assembler->config.jump_max_us;
}

/* A free place for a sensor, or that of the replaceable one heard longest ago; NULL: none. */
static struct rho_scan_assembler_source *
find_free_or_replaceable_source(struct rho_scan_assembler *assembler, int64_t now_us)
{
    struct rho_scan_assembler_source *oldest = NULL;

    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        struct rho_scan_assembler_source *source = &assembler->sources[i];

        if (!source->is_used) {
            return source;
        }
        if (is_source_unproven_off_clock_or_silent(assembler, source, now_us) &&
            (!oldest || source->heard_us < oldest->heard_us)) {
            oldest = source;
        }
    }
    return oldest;
}

/* ---- A message of a scan ---- */

static void refuse_scan(struct rho_scan_assembler *assembler,
                        struct rho_scan_assembler_source *source, enum scan_verdict verdict,
                        const struct scan_heading *heading)
{
    if (FOLLOWS_REPEATS && (verdict == SCAN_DUPLICATE || verdict == SCAN_TOO_LATE) &&
        rho_scan_assembler_may_begin_sequence(&assembler->config, source, &heading->place,
                                              verdict)) {
        rho_scan_assembler_remember_refused_scan(&assembler->config, source, &heading->place);
    }
    if (verdict == SCAN_DUPLICATE && source->off_clock > 0) {
        rho_scan_assembler_increment(
            &assembler->counters.clock_jumps); /* another part of a scan refused for its clock */
    } else if (verdict == SCAN_DUPLICATE && source->check == CHECK_NOT_ADMITTED &&
               heading->place.scan == source->place.scan) {
        rho_scan_assembler_increment(
            &assembler->counters.messages_flooded); /* part of a newcomer's scan without a turn */
    } else if (verdict == SCAN_DUPLICATE) {
        rho_scan_assembler_count_duplicate(assembler, source, heading);
    } else if (verdict == SCAN_TOO_LATE) {
        rho_scan_assembler_increment(&assembler->counters.scans_late);
    } else {
        rho_scan_assembler_remember_refused_scan(&assembler->config, source, &heading->place);
        rho_scan_assembler_increment(verdict == SCAN_WRONG_TIME ? &assembler->counters.clock_jumps
                                                                : &assembler->counters.scans_bad);
    }
}

static void open_accepted_scan(struct rho_scan_assembler *assembler,
                               const struct rho_scan_assembler_source *source,
                               const struct scan_heading *heading,
                               const union scan_message *message, enum slot_order order,
                               int64_t now_us)
{
    struct rho_scan_assembler_slot *slot =
        rho_scan_assembler_find_slot_in_state(assembler, SLOT_FREE);

    rho_scan_assembler_increment(&assembler->counters.scans_accepted);
    rho_scan_assembler_open_scan(assembler, slot, source, heading, order);
    rho_scan_assembler_add_part(assembler, slot, heading, message, now_us);
}

/* 1 where a live sensor of another kind has the number: the config names that one. */
static int has_live_sensor_of_other_kind(const struct rho_scan_assembler *assembler,
                                         const struct scan_heading *heading, int64_t now_us)
{
    for (unsigned i = 0; HAS_OTHERS && i < RHO_MAX_SENSORS; i++) {
        const struct rho_scan_assembler_source *source = &assembler->sources[i];

        if (source->is_used && source->sensor_id == heading->sensor_id &&
            source->kind != heading->kind &&
            rho_scan_assembler_is_proven(&assembler->config, source) &&
            rho_elapsed_us(now_us, source->heard_us) <= (uint64_t)assembler->config.jump_max_us) {
            return 1;
        }
    }
    return 0;
}

/* 1 where the config allows or describes the sensor of a message. */
static int is_sensor_named_in_config(const struct rho_scan_assembler *assembler,
                                     const struct scan_heading *heading, int64_t now_us)
{
    return (assembler->config.num_allowed > 0 ||
            rho_scan_assembler_sensor_or_default(assembler, heading->sensor_id) !=
                &assembler->config.other) &&
           !has_live_sensor_of_other_kind(assembler, heading, now_us);
}

/*
 * Admits one scan of all newcomers together between two scans of the other sensors: several empty
 * scans in a row would be misses in a row, which end tracks. Returns 0 for a newcomer's further
 * scans.
 */
static int admit_newcomer_in_turn(struct rho_scan_assembler *assembler,
                                  const struct scan_heading *heading, int is_newcomer)
{
    if (!is_newcomer) {
        assembler->newcomers = 0;
    } else if (heading->is_new && assembler->newcomers++ > 0) {
        rho_scan_assembler_increment(&assembler->counters.messages_flooded);
        assembler->newcomers = 1;
        return 0;
    }
    return 1;
}

/* Begins a scan that is its sensor's newest, and completes the sensor's scans before it. */
static void begin_newest_scan(struct rho_scan_assembler *assembler,
                              struct rho_scan_assembler_source *source, enum scan_verdict verdict,
                              const struct scan_heading *heading, const union scan_message *message,
                              int is_newcomer, int64_t now_us)
{
    enum scan_clock clock;

    rho_scan_assembler_complete_open_scans(assembler, source, verdict == SCAN_RESTARTS_SENSOR);
    assembler->counters.scans_lost =
        rho_count(assembler->counters.scans_lost,
                  rho_scan_assembler_set_newest_and_count_skipped(
                      &assembler->config, source, &heading->place, verdict, now_us));
    if (verdict == SCAN_RESTARTS_SENSOR) {
        rho_scan_assembler_increment(&assembler->counters.sensor_restarts);
    }
    clock = rho_scan_assembler_update_common_clock(assembler, source, heading->place.time_us,
                                                   verdict, now_us);
    if (clock == CLOCK_SET) {
        rho_scan_assembler_drop_waiting_scans(assembler);
    }
    if (clock == CLOCK_OTHER) {
        rho_scan_assembler_increment(&assembler->counters.clock_jumps);
    } else if (admit_newcomer_in_turn(assembler, heading, is_newcomer)) {
        open_accepted_scan(assembler, source, heading, message, ORDER_NEXT, now_us);
    } else {
        source->check = CHECK_NOT_ADMITTED;
    }
}

/*
 * Begins a scan whose number was skipped before. One such scan of a sensor at a time may wait for
 * its parts, where there is room.
 */
static void open_out_of_sequence_scan_of_skipped_number(struct rho_scan_assembler *assembler,
                                                        struct rho_scan_assembler_source *source,
                                                        const struct scan_heading *heading,
                                                        const union scan_message *message,
                                                        int is_newcomer, int64_t now_us)
{
    if (!admit_newcomer_in_turn(assembler, heading, is_newcomer)) {
        return;
    }
    rho_scan_assembler_increment(&assembler->counters.scans_late);
    if (!rho_scan_assembler_find_slot_in_state(assembler, SLOT_FREE) ||
        (heading->num_parts > 1 &&
         rho_scan_assembler_has_open_out_of_sequence(assembler, source))) {
        return;
    }
    rho_scan_assembler_mark_number_received(source, heading->place.scan);
    open_accepted_scan(assembler, source, heading, message, ORDER_OUT_OF_SEQUENCE, now_us);
}

/* Starts a new sensor at a place, and completes the open scans of the sensor that it replaces. */
static void start_source(struct rho_scan_assembler *assembler,
                         struct rho_scan_assembler_source *source,
                         const struct scan_heading *heading)
{
    rho_scan_assembler_complete_open_scans(assembler, source, 1);
    *source =
        (struct rho_scan_assembler_source){.messages = {.full_us = assembler->strangers.full_us,
                                                        .left = assembler->config.flood_per_s},
                                           .sensor_id = heading->sensor_id,
                                           .kind = heading->kind,
                                           .is_used = 1};
}

/*
 * 1 where a waiting scan may go out to make room. For a newcomer or an unproven sensor it must be
 * one whose release neither cuts short nor makes out of sequence the scan of an established sensor.
 */
static int may_release_scan_for_room(struct rho_scan_assembler *assembler,
                                     const struct rho_scan_assembler_source *source,
                                     int is_newcomer, int64_t now_us)
{
    return (source && rho_scan_assembler_is_proven(&assembler->config, source) && !is_newcomer) ||
           rho_scan_assembler_find_slot_in_state(assembler, SLOT_GIVEN) ||
           rho_scan_assembler_find_scan_to_release_early(assembler, now_us);
}

/* Takes a decoded part of a scan. CAPACITY: a waiting scan must go out to make room for it. */
static enum rho_status take_scan_part(struct rho_scan_assembler *assembler,
                                      const struct scan_heading *heading,
                                      const union scan_message *message,
                                      struct rho_scan_assembler_source *source, int is_newcomer,
                                      int64_t now_us)
{
    struct rho_scan_assembler_slot *slot =
        source ? rho_scan_assembler_find_open_scan(assembler, source, heading) : NULL;
    struct rho_scan_assembler_source *place;
    enum scan_verdict verdict;
    int is_free;

    if (slot) {
        rho_scan_assembler_add_part(assembler, slot, heading, message, now_us);
        return RHO_OK;
    }
    verdict = source ? rho_scan_assembler_classify_scan(assembler, source, &heading->place, now_us)
                     : SCAN_NEXT;
    if (verdict != SCAN_NEXT && verdict != SCAN_RESTARTS_SENSOR &&
        verdict != SCAN_OUT_OF_SEQUENCE) {
        refuse_scan(assembler, source, verdict, heading);
        return RHO_OK;
    }
    if (verdict == SCAN_OUT_OF_SEQUENCE) {
        open_out_of_sequence_scan_of_skipped_number(assembler, source, heading, message,
                                                    is_newcomer, now_us);
        return RHO_OK;
    }
    place = source ? source : find_free_or_replaceable_source(assembler, now_us);
    is_free =
        place && rho_scan_assembler_find_free_slot_or_drop_scan(assembler, is_newcomer, now_us);
    if (!place ||
        (!is_free && !may_release_scan_for_room(assembler, source, is_newcomer, now_us))) {
        rho_scan_assembler_increment(&assembler->counters.sensors_no_room);
        return RHO_OK;
    }
    if (!is_free) {
        assembler->is_pressed = 1;
        return RHO_ERROR_CAPACITY;
    }
    if (!source) {
        start_source(assembler, place, heading);
    }
    begin_newest_scan(assembler, place, verdict, heading, message, is_newcomer, now_us);
    return RHO_OK;
}

static int is_allowed_sensor(const struct rho_scan_assembler_config *config, int16_t sensor_id)
{
    for (unsigned i = 0; i < config->num_allowed; i++) {
        if (config->allowed[i] == sensor_id) {
            return 1;
        }
    }
    return config->num_allowed == 0;
}

static uint32_t message_checksum(const uint8_t *data, size_t size)
{
    uint32_t check = CHECK_START;

    for (size_t i = 0; i < size; i++) {
        check = (uint32_t)((uint64_t)(check ^ data[i]) * CHECK_FACTOR & UINT32_MAX);
    }
    return check > CHECK_NOT_ADMITTED ? check : CHECK_NOT_ADMITTED + 1u;
}

enum rho_status rho_scan_assembler_take(struct rho_scan_assembler *assembler, const char *channel,
                                        const uint8_t *data, size_t size, int64_t now_us)
{
    struct rho_scan_assembler_source *source;
    struct rho_scan_assembler_bucket *bucket;
    union scan_message message;
    struct scan_heading heading;
    int is_new;
    enum rho_scan_assembler_kind kind;
    enum rho_status status;
    int16_t sensor_id;

    if (!assembler || !channel || !data) {
        return RHO_ERROR_NULL;
    }
    if (!is_initialised(assembler)) {
        return RHO_ERROR_STATE;
    }
    if (!parse_channel(channel, &kind, &sensor_id)) {
        return RHO_ERROR_TYPE;
    }
    if (!is_allowed_sensor(&assembler->config, sensor_id)) {
        rho_scan_assembler_increment(&assembler->counters.messages_not_allowed);
        return RHO_OK;
    }
    source = find_source(assembler, kind, sensor_id);
    is_new = rho_scan_assembler_is_newcomer(
        source ? source->known_us : 0,
        rho_scan_assembler_eldest_sensor_known_us(assembler, now_us));
    bucket = source && !is_new ? &source->messages : &assembler->strangers;
    if (!rho_scan_assembler_take_tokens(bucket, 1, assembler->config.flood_per_s, now_us)) {
        rho_scan_assembler_increment(&assembler->counters.messages_flooded);
        return RHO_OK;
    }
    status = rho_scan_assembler_decode_message(kind, data, size, &message, &heading);
    if (status != RHO_OK || heading.sensor_id != sensor_id) {
        rho_scan_assembler_increment(status == RHO_ERROR_TYPE
                                         ? &assembler->counters.messages_wrong_type
                                         : &assembler->counters.messages_bad);
        return RHO_OK;
    }
    if (!rho_scan_assembler_subtract_time_bias(assembler, &heading)) {
        rho_scan_assembler_increment(&assembler->counters.messages_bad);
        return RHO_OK;
    }
    if (heading.num_parts > RHO_MAX_PARTS) {
        rho_scan_assembler_increment(&assembler->counters.scans_bad);
        return RHO_OK;
    }
    heading.is_new = (uint8_t)(is_new && !is_sensor_named_in_config(assembler, &heading, now_us));
    if (heading.is_new &&
        !rho_scan_assembler_take_tokens(&assembler->stranger_plots, heading.num_inputs,
                                        assembler->config.stranger_plots_per_s, now_us)) {
        rho_scan_assembler_increment(&assembler->counters.messages_flooded);
        return RHO_OK;
    }
    heading.check = message_checksum(data, size);
    status = take_scan_part(assembler, &heading, &message, source, is_new, now_us);
    if (status ==
        RHO_ERROR_CAPACITY) { /* give back the tokens: the caller will give the message again */
        bucket->left++;
        assembler->stranger_plots.left += heading.is_new ? heading.num_inputs : 0u;
    }
    return status;
}

/* ---- Scans that are due ---- */

int rho_scan_assembler_next(struct rho_scan_assembler *assembler, int64_t now_us,
                            struct rho_scan_assembler_item *item)
{
    struct rho_scan_assembler_slot *slot;

    if (!assembler || !item || !is_initialised(assembler)) {
        return 0;
    }
    slot = rho_scan_assembler_find_slot_in_state(assembler, SLOT_GIVEN);
    if (slot) {
        slot->state = SLOT_FREE;
    }
    if (rho_scan_assembler_find_slot_in_state(assembler, SLOT_FREE)) {
        assembler->is_pressed = 0; /* there is room: no scan has to go out early */
    }
    slot = rho_scan_assembler_complete_and_find_due(assembler, now_us);
    if (!slot) {
        return 0;
    }
    slot->state = SLOT_GIVEN;
    assembler->out_us =
        assembler->out_us > slot->place.time_us ? assembler->out_us : slot->place.time_us;
    rho_scan_assembler_fill_item_with_scan(slot, item);
    item->is_restart = assembler->is_restart;
    assembler->is_restart = 0;
    return 1;
}

int64_t rho_scan_assembler_due_us(const struct rho_scan_assembler *assembler)
{
    int64_t due_us = INT64_MAX;

    if (!assembler || !is_initialised(assembler)) {
        return due_us;
    }
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        const struct rho_scan_assembler_slot *slot = &assembler->slots[i];
        int waits = slot->state == SLOT_COMPLETE ||
                    (slot->state == SLOT_OPEN && assembler->config.hold_us > 0);

        if (waits && slot->heard_us <= INT64_MAX - assembler->config.hold_us) {
            int64_t held_us = slot->heard_us + assembler->config.hold_us;
            int64_t early_us =
                slot->state == SLOT_COMPLETE
                    ? rho_scan_assembler_scan_of_new_sensor_held_until_us(assembler, slot)
                    : INT64_MIN;

            held_us = early_us > held_us ? early_us : held_us;
            due_us = held_us < due_us ? held_us : due_us;
        }
    }
    return due_us;
}
