/* SPDX-License-Identifier: MIT */
/* asterix_all_or_none: heights and range rates stay where all plots of a scan have them. */
#include <math.h>

#include "io/asterix/asterix_sensor.h"

#define EARTH_RADIUS_M 6371000.0

/* A scan measures speeds of all its plots, or of none. */
static void dopplers_all_or_none(struct asterix_marks *marks, struct asterix_counts *counts)
{
    size_t with = 0;

    for (size_t i = 0; i < marks->count; i++) {
        with += marks->list[i].has_doppler;
    }
    if (with == marks->count) {
        return;
    }
    counts->dopplers_left += with;
    for (size_t i = 0; i < marks->count; i++) {
        marks->list[i].has_doppler = false;
    }
}

/*
 * The ground range of a slant range and a height: in the triangle of the radar, the target and the
 * earth's centre. False where there is none.
 */
static bool find_ground_range(double slant_m, double alt_m, double radar_alt_m, double *ground_m)
{
    double radar_m = EARTH_RADIUS_M + radar_alt_m, up_m = alt_m - radar_alt_m;
    double sine = (up_m * (2 * radar_m + up_m) - slant_m * slant_m) / (2 * radar_m * slant_m);

    if (!(fabs(sine) < 1)) {
        return false;
    }
    *ground_m = slant_m * sqrt(1 - sine * sine);
    return true;
}

/* A scan measures heights of all its plots, or of none: then they are good for the range. */
static void heights_all_or_none(struct asterix_marks *marks, const struct asterix_place *place,
                                struct asterix_counts *counts)
{
    size_t with = 0;

    for (size_t i = 0; i < marks->count; i++) {
        with += marks->list[i].has_alt;
    }
    if (with == marks->count) {
        return;
    }
    counts->levels_left += with;
    for (size_t i = 0; i < marks->count; i++) {
        struct asterix_mark *mark = &marks->list[i];

        mark->is_ground = mark->has_alt && find_ground_range(mark->range * ASTERIX_RANGE_M,
                                                             mark->alt * ASTERIX_HEIGHT_M,
                                                             place->alt_m, &mark->ground_m);
        mark->has_alt = false;
    }
}

void asterix_marks_all_or_none(struct asterix_marks *marks, const struct asterix_place *place,
                               struct asterix_counts *counts)
{
    heights_all_or_none(marks, place, counts);
    dopplers_all_or_none(marks, counts);
}
