/* SPDX-License-Identifier: MIT */
#include "io/csv/local_frame.h"

#include <math.h>
#include <proj.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/common.h"

#define DEG_RAD 0.017453292519943295
#define EARTH_RADIUS_M 6371000.0 /* only for the first guess of an iteration */

struct local_frame {
    PJ_CONTEXT *context;
    PJ *to_local; /* longitude, latitude (radians), height to x, y, z */
    double alt_m; /* height of the origin */
};

struct local_frame *local_frame_open(double lat_deg, double lon_deg, double alt_m)
{
    struct local_frame *frame = must_calloc(1, sizeof *frame);
    char pipeline[256];

    snprintf(pipeline, sizeof pipeline,
             "+proj=pipeline +step +proj=cart +ellps=WGS84 +step +proj=topocentric +ellps=WGS84 "
             "+lat_0=%.17g +lon_0=%.17g +h_0=%.17g",
             lat_deg, lon_deg, alt_m);
    frame->context = proj_context_create();
    /* PROJ complains of its missing database, which is not needed */
    proj_log_level(frame->context, PJ_LOG_NONE);
    frame->to_local = proj_create(frame->context, pipeline);
    if (!frame->to_local) {
        fail(EXIT_RUNTIME, "PROJ: %s: %s", pipeline,
             proj_context_errno_string(frame->context, proj_context_errno(frame->context)));
    }
    frame->alt_m = alt_m;
    return frame;
}

void local_frame_close(struct local_frame *frame)
{
    if (frame) {
        proj_destroy(frame->to_local);
        proj_context_destroy(frame->context);
        free(frame);
    }
}

void local_frame_to_local(const struct local_frame *frame, const double geodetic[3],
                          double place_m[3])
{
    PJ_COORD from = proj_coord(geodetic[1] * DEG_RAD, geodetic[0] * DEG_RAD, geodetic[2], 0);
    PJ_COORD to = proj_trans(frame->to_local, PJ_FWD, from);

    place_m[0] = to.enu.e;
    place_m[1] = to.enu.n;
    place_m[2] = to.enu.u;
}

void local_frame_to_geodetic(const struct local_frame *frame, const double place_m[3],
                             double geodetic[3])
{
    PJ_COORD from = proj_coord(place_m[0], place_m[1], place_m[2], 0);
    PJ_COORD to = proj_trans(frame->to_local, PJ_INV, from);

    geodetic[0] = to.lpz.phi / DEG_RAD;
    geodetic[1] = to.lpz.lam / DEG_RAD;
    geodetic[2] = to.lpz.z;
}

void local_frame_at_height(const struct local_frame *frame, double x_m, double y_m, double alt_m,
                           double geodetic[3])
{
    double place_m[3] = {x_m, y_m, alt_m - frame->alt_m};

    for (int i = 0; i < 10; i++) { /* each step leaves a twentieth of the error at 2000 km */
        local_frame_to_geodetic(frame, place_m, geodetic);
        place_m[2] += alt_m - geodetic[2];
    }
}

void local_frame_convert_place(const struct local_frame *from, const struct local_frame *to,
                               const double place_m[3], double other_m[3])
{
    double geodetic[3];

    local_frame_to_geodetic(from, place_m, geodetic);
    local_frame_to_local(to, geodetic, other_m);
}

double local_frame_convergence_rad(const struct local_frame *from, const struct local_frame *to)
{
    static const double origin_m[3] = {0, 0, 0}, north_m[3] = {0, 1000, 0};
    double origin[3], north[3];

    local_frame_convert_place(from, to, origin_m, origin);
    local_frame_convert_place(from, to, north_m, north);
    return atan2(origin[0] - north[0], north[1] - origin[1]);
}

/*
 * Newton's method for the sine of the elevation, with which the height increases steadily. On a
 * sphere of radius a the height follows from the triangle with the earth's centre, (a + h)^2 = (a +
 * s)^2 + r^2 + 2 (a + s) r sin e, whose derivative is used on the ellipsoid: the error of each step
 * is relative to its flattening, 1/298.
 */
bool local_frame_from_slant_range(const struct local_frame *radar,
                                  const struct local_frame_plot *plot, double place_m[3])
{
    enum { STEPS_MAX = 50 };
    const double tolerance_m = 1e-4;
    double target_m = EARTH_RADIUS_M + plot->alt_m, radar_m = EARTH_RADIUS_M + radar->alt_m;
    double slope = radar_m * plot->range_m / target_m;
    double sine = (plot->alt_m - radar->alt_m) / plot->range_m;

    if (!(fabs(sine) <= 1)) {
        return false;
    }
    for (int i = 0; i < STEPS_MAX; i++) {
        double found_m[3], geodetic[3];

        double cos_elevation = sqrt(1 - sine * sine);

        found_m[0] = plot->range_m * cos_elevation * cos(plot->azimuth_rad);
        found_m[1] = plot->range_m * cos_elevation * sin(plot->azimuth_rad);
        found_m[2] = plot->range_m * sine;
        local_frame_to_geodetic(radar, found_m, geodetic);
        if (fabs(geodetic[2] - plot->alt_m) <= tolerance_m) {
            for (int axis = 0; axis < 3; axis++) {
                place_m[axis] = found_m[axis];
            }
            return true;
        }
        sine += (plot->alt_m - geodetic[2]) / slope;
        sine = fmax(-1, fmin(1, sine));
    }
    return false;
}
