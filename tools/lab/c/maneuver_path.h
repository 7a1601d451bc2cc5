/* SPDX-License-Identifier: MIT */
/*
 * maneuver_path: how the targets of popup, weave and hard-turn accelerate.
 *
 * A target pulls with one acceleration or flies straight; when, and to which side, is the
 * profile's:
 *
 *     pop-up   up 10 to 14 s, down 18 to 26 s, up 30 to 34 s: it ends at its old height
 *     weave    to the left of its first heading 8 to 12 s, right 12 to 20 s, left 20 to 28 s, right 28 to 32 s
 *     turn     to the left of its heading 8 to 14 s, right 16 to 28 s, left 30 to 36 s: the acceleration turns with it
 *
 * Each begins at its first second and ends before its last.
 */
#ifndef RHOTRACK_TOOL_MANEUVER_PATH_H
#define RHOTRACK_TOOL_MANEUVER_PATH_H

#define MANEUVER_G_MPS2 9.80665

enum maneuver_profile {
    MANEUVER_STRAIGHT,
    MANEUVER_POPUP,
    MANEUVER_WEAVE,
    MANEUVER_TURN,
    MANEUVER_PROFILES
};

/* "straight", "pop-up", "weave", "turn". */
extern const char *const maneuver_profile_names[MANEUVER_PROFILES];

/* 1: up or to the left, -1: down or to the right, 0: straight. */
int maneuver_side(enum maneuver_profile profile, double t_s);

/*
 * The acceleration at a time of a target that started with start_mps and has velocity_mps by now; a
 * heading of none is taken as +x. Weave looks at the start alone, turn at the velocity alone,
 * pop-up at neither.
 */
void maneuver_accel(enum maneuver_profile profile, double t_s, double pull_mps2,
                    const double start_mps[3], const double velocity_mps[3], double accel_mps2[3]);

#endif
