/* SPDX-License-Identifier: MIT */
#include "maneuver_path.h"

#include <math.h>
#include <stddef.h>

#define SPANS_MAX 4

const char *const maneuver_profile_names[MANEUVER_PROFILES] = {"straight", "pop-up", "weave",
                                                               "turn"};

static const struct {
    double from_s, to_s;
    int side;
} spans[MANEUVER_PROFILES][SPANS_MAX] = {
    [MANEUVER_POPUP] = {{10.0, 14.0, 1}, {18.0, 26.0, -1}, {30.0, 34.0, 1}},
    [MANEUVER_WEAVE] = {{8.0, 12.0, 1}, {12.0, 20.0, -1}, {20.0, 28.0, 1}, {28.0, 32.0, -1}},
    [MANEUVER_TURN] = {{8.0, 14.0, 1}, {16.0, 28.0, -1}, {30.0, 36.0, 1}},
};

int maneuver_side(enum maneuver_profile profile, double t_s)
{
    for (size_t i = 0; i < SPANS_MAX; i++) {
        if (t_s >= spans[profile][i].from_s && t_s < spans[profile][i].to_s) {
            return spans[profile][i].side;
        }
    }
    return 0;
}

void maneuver_accel(enum maneuver_profile profile, double t_s, double pull_mps2,
                    const double start_mps[3], const double velocity_mps[3], double accel_mps2[3])
{
    const double *heading = profile == MANEUVER_TURN ? velocity_mps : start_mps;
    double speed_mps = hypot(heading[0], heading[1]);
    double along_x = speed_mps > 0.0 ? heading[0] / speed_mps : 1.0;
    double along_y = speed_mps > 0.0 ? heading[1] / speed_mps : 0.0;
    double pull = (double)maneuver_side(profile, t_s) * pull_mps2;
    int is_level = profile != MANEUVER_POPUP;
    accel_mps2[0] = is_level ? -pull * along_y : 0.0;
    accel_mps2[1] = is_level ? pull * along_x : 0.0;
    accel_mps2[2] = is_level ? 0.0 : pull;
}
