/* SPDX-License-Identifier: MIT */
#include "live/node_sensor_warnings.h"

#include <math.h>

#include "rhotrack/message.h"

/*
 * Share of the other sensors' tracks below which a suspect sensor is suspect for what it misses;
 * above, for its innovations.
 */
#define SHARE_LOW 0.3f
#define US_PER_S 1e6

/*
 * Channel prefix of a sensor's kind, which tells sensors of one number apart. Bearings may be on
 * the channel of directions as well.
 */
static const char *sensor_channel_prefix(const struct rho_message_sensor *sensor)
{
    return sensor->kind == RHO_MESSAGE_SENSOR_PLOTS   ? RHO_MESSAGE_PLOT_SCAN_CHANNEL
           : sensor->kind == RHO_MESSAGE_SENSOR_POLAR ? RHO_MESSAGE_POLAR_SCAN_CHANNEL
                                                      : RHO_MESSAGE_BEARING_SCAN_CHANNEL;
}

unsigned node_sensors_list_established(const struct node_core *core,
                                       struct rho_message_sensor sensors[RHO_MAX_SENSORS])
{
    const unsigned count = node_core_list_sensors(core, sensors);
    unsigned kept = 0;

    for (unsigned i = 0; i < count; i++) {
        if (sensors[i].scans >= node_core_sensor_scans_min(core)) {
            sensors[kept++] = sensors[i];
        }
    }
    return kept;
}

/* ---- Lines on standard error ---- */

static void print_suspect_sensor(const struct rho_message_sensor *sensor, FILE *to)
{
    if (sensor->seen_share < SHARE_LOW) {
        fprintf(to,
                "rhotrack: sensor %d is suspect: it sees %.0f %% of the tracks that others see\n",
                sensor->sensor_id, 100.0 * (double)sensor->seen_share);
    } else {
        fprintf(to,
                "rhotrack: sensor %d is suspect: its innovations are %.1f times what its sigmas "
                "say\n",
                sensor->sensor_id, sqrt((double)sensor->innovation_factor));
    }
}

static void print_silent_sensor(const struct rho_message_sensor *sensor, FILE *to)
{
    const int id = sensor->sensor_id;

    fprintf(to, "rhotrack: sensor %d is silent: nothing on %s%d", id, sensor_channel_prefix(sensor),
            id);
    if (sensor->kind == RHO_MESSAGE_SENSOR_BEARINGS) {
        fprintf(to, " or %s%d", RHO_MESSAGE_DIRECTION_SCAN_CHANNEL, id);
    }
    fprintf(to, " for %.0f s\n", sensor->heard_age_us / US_PER_S);
}

static void print_sensor_off_clock(const struct rho_message_sensor *sensor, double ahead_s,
                                   FILE *to)
{
    fprintf(to,
            "rhotrack: sensor %d: its clock is %.1f s %s the others': its scans are left aside "
            "until it is right, or sensor.%d.time_bias_s = %.1f says so\n",
            sensor->sensor_id, fabs(ahead_s), ahead_s < 0.0 ? "behind" : "ahead of",
            sensor->sensor_id, ahead_s);
}

static void print_health_change(const struct node_sensor *before,
                                const struct rho_message_sensor *sensor, FILE *to)
{
    if (sensor->is_doubted && !before->is_doubted) {
        print_suspect_sensor(sensor, to);
    } else if (!sensor->is_doubted && before->is_doubted) {
        fprintf(to, "rhotrack: sensor %d is trusted again\n", sensor->sensor_id);
    }
    if (sensor->is_silent && !before->is_silent) {
        print_silent_sensor(sensor, to);
    } else if (!sensor->is_silent && before->is_silent) {
        fprintf(to, "rhotrack: sensor %d is heard again\n", sensor->sensor_id);
    }
}

/* ---- Changes since the last step ---- */

static struct node_sensor previous_sensor_state(const struct node_sensors *sensors,
                                                const struct rho_message_sensor *sensor)
{
    for (unsigned i = 0; i < sensors->count; i++) {
        if (sensors->of[i].sensor_id == sensor->sensor_id && sensors->of[i].kind == sensor->kind) {
            return sensors->of[i];
        }
    }
    return (struct node_sensor){.sensor_id = sensor->sensor_id, .kind = sensor->kind};
}

void node_sensors_print_changes(struct node_sensors *sensors, const struct node_core *core,
                                FILE *to)
{
    struct rho_message_sensor now[RHO_MAX_SENSORS];
    struct node_sensors next = {.count = 0};
    const unsigned count = node_sensors_list_established(core, now);

    for (unsigned i = 0; i < count; i++) {
        const bool has_two_senders = node_core_has_two_senders(core, now[i].sensor_id);
        double ahead_s;
        const bool is_off_clock = node_core_is_off_clock(core, now[i].sensor_id, &ahead_s);

        if (to) {
            struct node_sensor before = previous_sensor_state(sensors, &now[i]);

            print_health_change(&before, &now[i], to);
            if (is_off_clock && !before.is_off_clock) {
                print_sensor_off_clock(&now[i], ahead_s, to);
            } else if (!is_off_clock && before.is_off_clock) {
                fprintf(to, "rhotrack: sensor %d: its clock is right again\n", now[i].sensor_id);
            }
            if (has_two_senders && !before.has_two_senders) {
                fprintf(to,
                        "rhotrack: sensor %d: a scan came twice with different contents: two "
                        "senders use this number\n",
                        now[i].sensor_id);
            }
        }
        next.of[next.count++] =
            (struct node_sensor){now[i].sensor_id, now[i].kind,     now[i].is_doubted,
                                 now[i].is_silent, has_two_senders, is_off_clock};
    }
    *sensors = next;
}

void node_sensors_print_all(const struct node_core *core, FILE *to)
{
    struct rho_message_sensor now[RHO_MAX_SENSORS];
    double ahead_s;
    const unsigned count = node_sensors_list_established(core, now);

    for (unsigned i = 0; i < count; i++) {
        if (now[i].is_doubted) {
            fprintf(to, "rhotrack: sensor %d contradicts the others\n", now[i].sensor_id);
        }
        if (now[i].is_silent) {
            print_silent_sensor(&now[i], to);
        }
        if (node_core_is_off_clock(core, now[i].sensor_id, &ahead_s)) {
            print_sensor_off_clock(&now[i], ahead_s, to);
        }
    }
}
