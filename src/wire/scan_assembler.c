/* SPDX-License-Identifier: MIT */
#include "rhotrack/scan_assembler.h"

#include <string.h>

#include "rhotrack/detail/measurement.h"
#include "scan_internal.h"

enum { SECOND_US = 1000000, PER_S_MAX = 1000000 };

typedef char rho_scan_assembler_fits_its_formula
    [sizeof(struct rho_scan_assembler) <= RHO_RAM_SCAN_ASSEMBLER_BYTES ? 1 : -1];

/* Configuration */

static int is_sigma_in_limits(float sigma)
{
    return rho_is_within(sigma, RHO_LIMIT_SIGMA_MIN, RHO_LIMIT_SIGMA_MAX);
}

static int is_sigma_rad_in_limits(float sigma_rad)
{
    return rho_is_within(sigma_rad, RHO_LIMIT_SIGMA_RAD_MIN, RHO_LIMIT_SIGMA_RAD_MAX);
}

static int is_usable_sensor(const struct rho_scan_assembler_sensor *known)
{
    const struct rho_scan_assembler_noise *noise = &known->noise;
    return is_sigma_in_limits(noise->sigma_m) && is_sigma_in_limits(noise->sigma_mps) &&
           is_sigma_in_limits(noise->sigma_range_m) &&
           is_sigma_in_limits(noise->sigma_range_rate_mps) &&
           is_sigma_rad_in_limits(noise->sigma_azimuth_rad) &&
           is_sigma_rad_in_limits(noise->sigma_elevation_rad) &&
           is_sigma_rad_in_limits(noise->sigma_rad) &&
           rho_measurement_is_valid_site(&known->sensor);
}

void rho_scan_assembler_config_default(struct rho_scan_assembler_config *config)
{
    *config = (struct rho_scan_assembler_config){
        .hold_us = 20000,
        .late_max_us = RHO_SECTORS ? 20000000 : 0,
        .jump_max_us = 30000000,
        .flood_per_s = 10000,
        .follow_scans = 3,
        .stranger_plots_per_s = RHO_CONFIG_PICK(64, 256),
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
    if (config->hold_us < 0 || config->hold_us > 10 * SECOND_US || config->late_max_us < 0 ||
        config->late_max_us > 60 * SECOND_US || config->jump_max_us < SECOND_US ||
        config->jump_max_us > (int64_t)3600 * SECOND_US || config->flood_per_s < 1 ||
        config->flood_per_s > PER_S_MAX || config->follow_scans < 2 || config->follow_scans > 255 ||
        config->stranger_plots_per_s < 1 || config->stranger_plots_per_s > PER_S_MAX ||
        config->num_allowed > RHO_MAX_SENSORS || !is_usable_sensor(&config->other)) {
        return RHO_ERROR_CONFIG;
    }
    memset(assembler, 0, sizeof *assembler);
    memcpy(&assembler->config, config, sizeof assembler->config);
    assembler->strangers.left = config->flood_per_s;
    assembler->stranger_plots.left = config->stranger_plots_per_s;
    assembler->out_us = INT64_MIN;
    assembler->magic = SCAN_MAGIC;
    return RHO_OK;
}

enum rho_status rho_scan_assembler_set_sensor(struct rho_scan_assembler *assembler,
                                              const struct rho_scan_assembler_sensor *sensor)
{
    if (!assembler || !sensor) {
        return RHO_ERROR_NULL;
    }
    if (assembler->magic != SCAN_MAGIC) {
        return RHO_ERROR_STATE;
    }
    if (!is_usable_sensor(sensor)) {
        return RHO_ERROR_CONFIG;
    }
    unsigned i = 0;
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

/* Messages */

/* The kind of the scan that a message of a kind carries. */
static enum rho_scan_assembler_kind kind_of_scan(unsigned message_kind)
{
    return message_kind == SCAN_MESSAGE_DIRECTIONS ? RHO_SCAN_ASSEMBLER_BEARINGS
                                                   : (enum rho_scan_assembler_kind)message_kind;
}

/*
 * Finds the message's kind and sensor number in a channel's name: no sign but -, no leading zeros,
 * within int16_t. Returns 0 where the text is no such channel.
 */
static int parse_channel(const char *channel, unsigned *message_kind, int16_t *sensor_id)
{
    static const char prefixes[NUM_SCAN_MESSAGES][16] = {
        [RHO_SCAN_ASSEMBLER_PLOTS] = RHO_MESSAGE_PLOT_SCAN_CHANNEL,
        [RHO_SCAN_ASSEMBLER_POLAR] = RHO_MESSAGE_POLAR_SCAN_CHANNEL,
        [RHO_SCAN_ASSEMBLER_BEARINGS] = RHO_MESSAGE_BEARING_SCAN_CHANNEL,
        [SCAN_MESSAGE_DIRECTIONS] = RHO_MESSAGE_DIRECTION_SCAN_CHANNEL,
    };
    const char *digits = NULL;
    for (unsigned i = 0; i < NUM_SCAN_MESSAGES && !digits; i++) {
        unsigned length = 0;
        while (prefixes[i][length] != '\0' && channel[length] == prefixes[i][length]) {
            length++;
        }
        if (prefixes[i][length] == '\0' && RHO_SCAN_ASSEMBLER_HAS(kind_of_scan(i))) {
            *message_kind = i;
            digits = channel + length;
        }
    }
    if (!digits) {
        return 0;
    }
    const int is_negative = *digits == '-';
    int32_t value = 0;
    digits += is_negative;
    if (*digits == '\0' || (*digits == '0' && (digits[1] != '\0' || is_negative))) {
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
    *sensor_id = (int16_t)(is_negative ? -value : value);
    return 1;
}

/*
 * A free place for a sensor, or that of the one heard longest ago of those that are unproven, off
 * the clock, or silent for longer than jump_max_us and than they were heard; NULL: none.
 */
static struct rho_scan_assembler_source *find_place(struct rho_scan_assembler *assembler,
                                                    int64_t now_us)
{
    struct rho_scan_assembler_source *oldest = NULL;
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        struct rho_scan_assembler_source *source = &assembler->sources[i];
        if (!source->is_used) {
            return source;
        }
        if ((!rho_scan_is_proven(&assembler->config, source) || source->off_clock > 0 ||
             (!rho_scan_is_live(assembler, source, now_us) &&
              rho_elapsed_us(now_us, source->heard_us) > source->known_us)) &&
            (!oldest || source->heard_us < oldest->heard_us)) {
            oldest = source;
        }
    }
    return oldest;
}

static void refuse_scan(struct rho_scan_assembler *assembler,
                        struct rho_scan_assembler_source *source, enum scan_verdict verdict,
                        const struct scan_heading *heading)
{
    struct rho_scan_assembler_counters *counters = &assembler->counters;
    if (rho_scan_may_begin_sequence(&assembler->config, source, &heading->place, verdict)) {
        rho_scan_remember_refused(&assembler->config, source, &heading->place);
    }
    if (verdict == SCAN_DUPLICATE && source->off_clock > 0) {
        rho_scan_increment(&counters->clock_jumps); /* part of a scan refused for its clock */
    } else if (verdict == SCAN_DUPLICATE && source->check == CHECK_NOT_ADMITTED &&
               heading->place.scan == source->place.scan) {
        rho_scan_increment(&counters->messages_flooded); /* of a newcomer's scan without a turn */
    } else if (verdict == SCAN_DUPLICATE) {
        rho_slot_count_duplicate(assembler, source, heading);
    } else if (verdict == SCAN_TOO_LATE) {
        rho_scan_increment(&counters->scans_late);
    } else {
        rho_scan_increment(verdict == SCAN_WRONG_TIME ? &counters->clock_jumps
                                                      : &counters->scans_bad);
    }
}

/*
 * 1 where the config allows or describes the sensor of a message, unless a live sensor of another
 * kind has the number: the config names that one.
 */
static int is_named_in_config(const struct rho_scan_assembler *assembler,
                              const struct scan_heading *heading, int64_t now_us)
{
    for (unsigned i = 0; HAS_OTHERS && i < RHO_MAX_SENSORS; i++) {
        const struct rho_scan_assembler_source *source = &assembler->sources[i];
        if (source->sensor_id == heading->sensor_id && source->kind != heading->kind &&
            rho_scan_is_proven(&assembler->config, source) &&
            rho_scan_is_live(assembler, source, now_us)) {
            return 0;
        }
    }
    return assembler->config.num_allowed > 0 ||
           rho_scan_sensor(assembler, heading->sensor_id) != &assembler->config.other;
}

/*
 * Admits one scan of all newcomers together between two scans of the other sensors: several empty
 * scans in a row would be misses in a row, which end tracks. Returns 0 for a newcomer's further
 * scans.
 */
static int admit_in_turn(struct rho_scan_assembler *assembler, const struct scan_heading *heading,
                         int is_newcomer)
{
    if (!is_newcomer) {
        assembler->newcomers = 0;
    } else if (heading->is_new && assembler->newcomers++ > 0) {
        rho_scan_increment(&assembler->counters.messages_flooded);
        assembler->newcomers = 1;
        return 0;
    }
    return 1;
}

/* Takes a decoded part of a scan. CAPACITY: a waiting scan must go out to make room for it. */
static enum rho_status take_scan_part(struct rho_scan_assembler *assembler,
                                      const struct scan_heading *heading,
                                      const union scan_message *message,
                                      struct rho_scan_assembler_source *source, int is_newcomer,
                                      int64_t now_us)
{
    struct rho_scan_assembler_counters *counters = &assembler->counters;
    struct rho_scan_assembler_slot *slot =
        source ? rho_slot_find_open(assembler, source, heading) : NULL;
    if (slot) {
        rho_slot_add_part(assembler, slot, heading, message, now_us);
        return RHO_OK;
    }
    const enum scan_verdict verdict =
        source ? rho_scan_classify(assembler, source, &heading->place, now_us) : SCAN_NEXT;
    if (verdict == SCAN_OUT_OF_SEQUENCE) {
        if (!admit_in_turn(assembler, heading, is_newcomer)) {
            return RHO_OK;
        }
        rho_scan_increment(&counters->scans_late);
        /* One such scan of a sensor at a time may wait for its parts, where there is room. */
        if (rho_slot_in_state(assembler, SLOT_FREE) &&
            (heading->num_parts <= 1 || !rho_slot_has_out_of_sequence(assembler, source))) {
            rho_scan_mark_received(source, heading->place.scan);
            slot = rho_slot_open(assembler, source, heading, ORDER_OUT_OF_SEQUENCE);
            rho_slot_add_part(assembler, slot, heading, message, now_us);
        }
        return RHO_OK;
    }
    if (verdict != SCAN_NEXT && verdict != SCAN_RESTARTS_SENSOR) {
        refuse_scan(assembler, source, verdict, heading);
        return RHO_OK;
    }
    struct rho_scan_assembler_source *place = source ? source : find_place(assembler, now_us);
    const int is_free = place && rho_slot_make_free(assembler, is_newcomer, now_us);
    /*
     * A waiting scan may go out to make room. For a newcomer or an unproven sensor it must be one
     * whose release neither cuts short nor makes out of sequence an established sensor's scan.
     */
    if (!place ||
        (!is_free && !(source && rho_scan_is_proven(&assembler->config, source) && !is_newcomer) &&
         !rho_slot_in_state(assembler, SLOT_GIVEN) && !rho_slot_find_spare(assembler, now_us))) {
        rho_scan_increment(&counters->sensors_no_room);
        return RHO_OK;
    }
    if (!is_free) {
        assembler->is_pressed = 1;
        return RHO_ERROR_CAPACITY;
    }
    if (!source) { /* a new sensor; the open scans of the one that it replaces are completed */
        rho_slot_complete_all(assembler, place, 1);
        *place =
            (struct rho_scan_assembler_source){.messages = {.full_us = assembler->strangers.full_us,
                                                            .left = assembler->config.flood_per_s},
                                               .sensor_id = heading->sensor_id,
                                               .kind = heading->kind,
                                               .is_used = 1};
    }
    rho_slot_complete_all(assembler, place, verdict == SCAN_RESTARTS_SENSOR);
    const enum scan_clock clock =
        rho_scan_update_clock(assembler, place, heading->place.time_us, verdict, now_us);
    const uint32_t skipped =
        rho_scan_set_newest(&assembler->config, place, &heading->place, verdict, now_us);
    counters->scans_lost = rho_count(counters->scans_lost, skipped);
    counters->sensor_restarts =
        rho_count(counters->sensor_restarts, verdict == SCAN_RESTARTS_SENSOR);
    if (clock == CLOCK_SET) {
        rho_slot_drop_waiting(assembler);
    }
    if (clock == CLOCK_OTHER) {
        rho_scan_increment(&counters->clock_jumps);
    } else if (admit_in_turn(assembler, heading, is_newcomer)) {
        slot = rho_slot_open(assembler, place, heading, ORDER_NEXT);
        rho_slot_add_part(assembler, slot, heading, message, now_us);
    } else {
        place->check = CHECK_NOT_ADMITTED;
    }
    return RHO_OK;
}

/* Takes count tokens out of a rate limit's bucket; 0: it holds fewer, and is unchanged. */
static int take_tokens(struct rho_scan_assembler_bucket *bucket, uint32_t count, uint32_t per_s,
                       int64_t now_us)
{
    /* A reception clock that went back fills the bucket at once, not when it has caught up. */
    if (rho_elapsed_us(now_us, bucket->full_us) >= SECOND_US || now_us < bucket->full_us) {
        bucket->full_us = now_us;
        bucket->left = per_s;
    }
    if (bucket->left < count) {
        return 0;
    }
    bucket->left -= count;
    return 1;
}

enum rho_status rho_scan_assembler_take(struct rho_scan_assembler *assembler, const char *channel,
                                        const uint8_t *data, size_t size, int64_t now_us)
{
    unsigned message_kind;
    int16_t sensor_id;
    if (!assembler || !channel || !data) {
        return RHO_ERROR_NULL;
    }
    if (assembler->magic != SCAN_MAGIC) {
        return RHO_ERROR_STATE;
    }
    if (!parse_channel(channel, &message_kind, &sensor_id)) {
        return RHO_ERROR_TYPE;
    }
    const struct rho_scan_assembler_config *config = &assembler->config;
    struct rho_scan_assembler_counters *counters = &assembler->counters;
    int is_allowed = config->num_allowed == 0;
    for (unsigned i = 0; i < config->num_allowed; i++) {
        is_allowed |= config->allowed[i] == sensor_id;
    }
    if (!is_allowed) {
        rho_scan_increment(&counters->messages_not_allowed);
        return RHO_OK;
    }
    const enum rho_scan_assembler_kind kind = kind_of_scan(message_kind);
    struct rho_scan_assembler_source *source = NULL;
    for (unsigned i = 0; i < RHO_MAX_SENSORS && !source; i++) {
        struct rho_scan_assembler_source *at = &assembler->sources[i];
        source = at->is_used && at->kind == kind && at->sensor_id == sensor_id ? at : NULL;
    }
    const int is_new = rho_scan_is_newcomer(source ? source->known_us : 0,
                                            rho_scan_eldest_known_us(assembler, now_us));
    struct rho_scan_assembler_bucket *bucket =
        source && !is_new ? &source->messages : &assembler->strangers;
    if (!take_tokens(bucket, 1, config->flood_per_s, now_us)) {
        rho_scan_increment(&counters->messages_flooded);
        return RHO_OK;
    }
    union scan_message message;
    struct scan_heading heading;
    enum rho_status status =
        rho_scan_decode(assembler, message_kind, data, size, &message, &heading);
    if (status != RHO_OK || heading.sensor_id != sensor_id) {
        rho_scan_increment(status == RHO_ERROR_TYPE ? &counters->messages_wrong_type
                                                    : &counters->messages_bad);
        return RHO_OK;
    }
    if (heading.num_parts > RHO_MAX_PARTS) {
        rho_scan_increment(&counters->scans_bad);
        return RHO_OK;
    }
    heading.is_new = (uint8_t)(is_new && !is_named_in_config(assembler, &heading, now_us));
    if (heading.is_new && !take_tokens(&assembler->stranger_plots, heading.num_inputs,
                                       config->stranger_plots_per_s, now_us)) {
        rho_scan_increment(&counters->messages_flooded);
        return RHO_OK;
    }
    heading.check = 2166136261u; /* FNV-1a hash: offset basis and prime */
    for (size_t i = 0; i < size; i++) {
        heading.check = (uint32_t)((uint64_t)(heading.check ^ data[i]) * 16777619u & UINT32_MAX);
    }
    heading.check = heading.check > CHECK_NOT_ADMITTED ? heading.check : CHECK_NOT_ADMITTED + 1u;
    status = take_scan_part(assembler, &heading, &message, source, is_new, now_us);
    if (status == RHO_ERROR_CAPACITY) { /* gives back the tokens: the message will come again */
        bucket->left++;
        assembler->stranger_plots.left += heading.is_new ? heading.num_inputs : 0u;
    }
    return status;
}
