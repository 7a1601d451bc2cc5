/* SPDX-License-Identifier: MIT */
/* parameters_zones: zones' parameters of INI files and --set. */
#include <math.h>
#include <string.h>

#include "base/common.h"
#include "base/parse.h"
#include "settings/parameters.h"

static const char *const keys[NUM_ZONE_PARAMETERS] = {"corners_m", "heading_rad", "margin_m",
                                                      "queue_mps"};

/* Finds a zone's parameters, or adds an empty zone; NULL where there is no room. */
static struct zone_parameters *find_or_add_zone(struct parameters *parameters, int32_t zone_id)
{
    struct zone_parameters *zone;

    for (size_t i = 0; i < parameters->num_zones; i++) {
        if (parameters->zones[i].zone.zone_id == zone_id) {
            return &parameters->zones[i];
        }
    }
    if (parameters->num_zones == RHO_MAX_ZONES) {
        return NULL;
    }
    zone = &parameters->zones[parameters->num_zones++];
    *zone = (struct zone_parameters){.zone.zone_id = zone_id};
    return zone;
}

/* Parses corners "x y, x y, ..." into the zone; false with the reason where that fails. */
static bool parse_zone_corners(const char *value, struct rho_zone *zone, char *reason)
{
    static const char between[] = " \t,";
    const char *whole = value;
    float numbers[2 * RHO_ZONE_CORNERS];
    unsigned count = 0;

    for (value += strspn(value, between); *value; value += strspn(value, between)) {
        double number;

        if (count == 2 * RHO_ZONE_CORNERS || parse_next_number(&value, &number)) {
            break;
        }
        numbers[count++] = (float)number;
    }
    if (*value || count < 6 || count % 2) {
        snprintf(reason, PARAMETER_REASON_BYTES,
                 "corners_m '%.60s' is not 'x y, x y, x y', with 3 to %d corners", whole,
                 RHO_ZONE_CORNERS);
        return false;
    }
    zone->num_corners = (uint16_t)(count / 2);
    for (unsigned i = 0; i < zone->num_corners; i++) {
        zone->x_m[i] = numbers[2 * i];
        zone->y_m[i] = numbers[2 * i + 1];
    }
    return true;
}

static bool parse_zone_number(enum zone_parameter_id id, const char *value, struct rho_zone *zone,
                              char *reason)
{
    static const struct {
        double min, max;
    } ranges[NUM_ZONE_PARAMETERS] = {
        [ZONE_HEADING_RAD] = {-RHO_ZONE_HEADING_MAX_RAD, RHO_ZONE_HEADING_MAX_RAD},
        [ZONE_MARGIN_M] = {0, RHO_ZONE_MARGIN_MAX_M},
        [ZONE_QUEUE_MPS] = {0, RHO_ZONE_QUEUE_MAX_MPS}};
    float *const fields[NUM_ZONE_PARAMETERS] = {[ZONE_HEADING_RAD] = &zone->heading_rad,
                                                [ZONE_MARGIN_M] = &zone->margin_m,
                                                [ZONE_QUEUE_MPS] = &zone->queue_mps};
    double number;

    if (parse_number_or_give_reason(value, &number) ||
        !(number >= ranges[id].min && number <= ranges[id].max)) {
        snprintf(reason, PARAMETER_REASON_BYTES, "%s '%.60s' is not a number of %.9g .. %.9g",
                 keys[id], value, ranges[id].min, ranges[id].max);
        return false;
    }
    *fields[id] = (float)number;
    zone->has_heading = zone->has_heading || id == ZONE_HEADING_RAD;
    return true;
}

/* Index of a zone's key; -1 with the reason where it is unknown. */
static int index_of_zone_parameter_name(const char *name, char *reason)
{
    for (int i = 0; i < NUM_ZONE_PARAMETERS; i++) {
        if (!strcmp(keys[i], name)) {
            return i;
        }
    }
    snprintf(reason, PARAMETER_REASON_BYTES,
             "a zone has no '%.40s'; it has corners_m, heading_rad, margin_m, queue_mps", name);
    return -1;
}

bool parameters_assign_zone(struct parameters *parameters, const char *key, const char *value,
                            enum parameter_source source, char reason[PARAMETER_REASON_BYTES])
{
    const char *dot = strchr(key, '.');
    char digits[16] = "";
    struct zone_parameters *zone, read;
    int32_t zone_id;
    int id;

    if (dot && (size_t)(dot - key) < sizeof digits) {
        memcpy(digits, key, (size_t)(dot - key));
    }
    if (!dot || parse_int32_or_give_reason(digits, &zone_id)) {
        snprintf(reason, PARAMETER_REASON_BYTES,
                 "'zone.%.60s' is not zone.N.key with a whole number N", key);
        return false;
    }
    id = index_of_zone_parameter_name(dot + 1, reason);
    zone = id < 0 ? NULL : find_or_add_zone(parameters, zone_id);
    if (!zone) {
        if (id >= 0) {
            snprintf(reason, PARAMETER_REASON_BYTES, "more than %d zones", RHO_MAX_ZONES);
        }
        return false;
    }
    read = *zone;
    if (!(id == ZONE_CORNERS_M
              ? parse_zone_corners(value, &read.zone, reason)
              : parse_zone_number((enum zone_parameter_id)id, value, &read.zone, reason))) {
        return false;
    }
    if (source >= zone->source[id]) {
        *zone = read;
        zone->source[id] = source;
    }
    return true;
}

void parameters_to_zones(const struct parameters *parameters, struct rho_zones *zones)
{
    must_succeed(rho_zones_init(zones, sizeof *zones), "zones");
    for (size_t i = 0; i < parameters->num_zones; i++) {
        const struct rho_zone *zone = &parameters->zones[i].zone;

        if (zone->num_corners == 0) {
            fail(EXIT_USAGE, "zone %d has no corners_m", (int)zone->zone_id);
        }
        if (rho_zones_add(zones, zone) != RHO_OK) {
            fail(EXIT_USAGE, "zone %d: its corners enclose no area, or are farther than %.0f m",
                 (int)zone->zone_id, (double)RHO_LIMIT_POSITION_M);
        }
    }
}
