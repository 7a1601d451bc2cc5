/* SPDX-License-Identifier: MIT */
/*
 * asterix_quantities: keeps only the quantities, heights and Doppler speeds,
 * that all plots of a scan have, since a struct rho_scan measures a quantity for all of its plots
 * or for none.
 */
#include <math.h>

#include "io/asterix/asterix_radar.h"

#define EARTH_RADIUS_M 6371000.0

/* Drops the Doppler speeds of a scan where not all of its plots have one. */
static void keep_dopplers_if_all_have(struct asterix_scan_plots *marks,
                                      struct asterix_counts *counts)
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
 * Ground range from slant range and height, in the triangle of radar, target and the earth's
 * centre. Returns false where there is no such triangle.
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

/*
 * Where not all plots of a scan have a height, converts the slant ranges of those that have one to
 * ground ranges, and drops the heights.
 */
static void make_ground_ranges(struct asterix_scan_plots *marks, const struct asterix_place *place,
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
        struct asterix_scan_plot *mark = &marks->list[i];

        mark->is_ground = mark->has_alt && find_ground_range(mark->range * ASTERIX_RANGE_M,
                                                             mark->alt * ASTERIX_HEIGHT_M,
                                                             place->alt_m, &mark->ground_m);
        mark->has_alt = false;
    }
}

void asterix_keep_common_quantities(struct asterix_scan_plots *marks,
                                    const struct asterix_place *place,
                                    struct asterix_counts *counts)
{
    make_ground_ranges(marks, place, counts);
    keep_dopplers_if_all_have(marks, counts);
}
