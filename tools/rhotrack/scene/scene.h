/* SPDX-License-Identifier: MIT */
/*
 * scene: what a JSON file says of sensors, targets, clutter and events (tools/scenes/README.md has
 * the format).
 *
 * Places are in metres, x east, y north; angles counter-clockwise from +x; times in seconds from
 * the scene's start. Everything has a stream of random numbers of its own (scene_random.h): other
 * clutter does not change the targets, nor another target the rest.
 */
#ifndef RHOTRACK_TOOL_SCENE_H
#define RHOTRACK_TOOL_SCENE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "scene/scene_json.h"
#include "scene/scene_notch.h"
#include "scene/scene_path.h"
#include "scene/scene_reflectors.h"
#include "settings/parameters.h"

#define SCENE_SENSORS_MAX 16 /* radars, and as many passive sensors */
#define SCENE_ITEMS_MAX 32   /* sources of clutter, and as many events */
#define SCENE_CURVE_MAX 16
#define SCENE_TARGETS_MAX 100000
#define SCENE_SCANS_MAX 10000000

/* A probability over range, straight between its points, the same beyond the first and the last. */
struct scene_curve {
    size_t count;
    double range_m[SCENE_CURVE_MAX], value[SCENE_CURVE_MAX];
};

/* Where a sensor can see. */
struct scene_coverage {
    struct json_span range_m;
    bool has_sector; /* else all round */
    double from_rad, to_rad;
};

/* The description of a sensor that a tracker is given, where it is not the truth. */
struct scene_stated {
    double x_m, y_m, pd;
    double sigma_m, sigma_mps, sigma_range_m, sigma_azimuth_rad, sigma_range_rate_mps, sigma_rad;
    double range_bias_m, azimuth_bias_rad, time_bias_s;
    struct scene_coverage coverage;
    struct scene_notch notch;
};

struct scene_sensor {
    int32_t sensor_id;
    bool is_passive;   /* bearings alone */
    bool is_cartesian; /* plots are x and y, with sigma_m */
    double x_m, y_m;
    bool turns; /* else it looks everywhere at each scan's time */
    bool is_counter_clockwise;
    size_t sectors;            /* scans of a turn */
    double turn_s;             /* of a sensor that does not turn, the time between scans */
    double start_s, start_rad; /* of a run: drawn between */
    struct json_span starts_s, starts_rad;
    struct scene_coverage coverage;
    struct scene_curve pd;
    double sigma_m, sigma_range_m, sigma_azimuth_rad, sigma_rad;
    bool has_range_rate;
    double sigma_range_rate_mps, range_rate_span_mps;
    struct scene_notch notch; /* of plots in range and azimuth, with range rates or without */
    double sigma_mps;         /* with sigma_m: plots have velocities; 0: they have none */
    double resolution_m, resolution_rad; /* targets nearer in both give one plot; 0: none do */
    double range_bias_m, azimuth_bias_rad, time_bias_s; /* as of struct rho_sensor */
    double late_share, late_s;                          /* so many scans arrive so much late */
    double false_bearings;                              /* of a passive sensor: mean a scan, */
    double false_from_rad, false_to_rad;                /* in this sector */
    struct scene_stated told;
};

enum clutter_kind {
    CLUTTER_UNIFORM,
    CLUTTER_CELL,
    CLUTTER_STANDING,
    CLUTTER_SPIKES,
    CLUTTER_STROBE,
    CLUTTER_FLOCK,
    CLUTTER_SECOND_TIME,
    CLUTTER_ABOUT_TARGETS,
    CLUTTER_KINDS
};

struct scene_clutter {
    enum clutter_kind kind;
    uint32_t sensors; /* a bit for each sensor that sees it */
    double from_s, until_s;
    double plots;                 /* uniform, cell, strobe: mean a scan */
    double plots_per_km2;         /* uniform, in place of plots */
    struct scene_coverage within; /* uniform, standing, spikes: where; strobe: its ranges */
    bool has_box;
    double box_m[4]; /* uniform, standing, spikes: x_min, x_max, y_min, y_max in place of within */
    bool is_disc;    /* cell: even in a disc, else Gaussian */
    double x_m, y_m, vx_mps, vy_mps, radius_m; /* cell, flock */
    double rate_sigma_mps; /* cell: spread of its range rates; uniform: in place of rate_max_mps */
    double rate_max_mps;   /* uniform: its range rates are uniform within, either way */
    uint64_t count;        /* standing, flock; about-targets: a scan, of each target */
    double (*places_m)[2]; /* standing: listed ones, or NULL */
    double pd;             /* standing, spikes, flock, second time */
    double per_s;          /* spikes: born a second */
    struct json_span life_s;
    double speed_mps; /* flock: each against the others; spikes: their drift, in any direction */
    double azimuth_rad, width_rad, azimuth_radps; /* strobe; about-targets: width */
    double unambiguous_m;                         /* second time */
    struct scene_targets targets;
};

enum event_kind { EVENT_OUTAGE, EVENT_FADES, EVENT_MASK, EVENT_SPLIT, EVENT_KINDS };

struct scene_event {
    enum event_kind kind;
    uint32_t sensors;
    double from_s, until_s;
    bool is_silent;               /* outage: no scans, else empty ones */
    struct scene_coverage within; /* mask */
    double per_hour;              /* fades of each target; 0: one, from from_s until until_s */
    struct json_span for_s;
    bool has_targets; /* fades: these targets, by the index of targets[], alone */
    uint32_t targets;
    double pd;    /* fades: then */
    double share; /* split: this share of a target's plots has a second one, off by */
    struct json_span range_sigmas, azimuth_sigmas, range_m, azimuth_rad;
};

struct scene {
    char *name;  /* of the file, as messages say it */
    char *title; /* what the file says of itself in a line */
    double duration_s;
    bool has_area;
    double area_m[4];               /* x_min, x_max, y_min, y_max */
    char *settings;                 /* lines of an INI file */
    double v_max_mps;               /* of the settings */
    size_t num_sensors, num_radars; /* radars first */
    struct scene_sensor sensors[2 * SCENE_SENSORS_MAX];
    struct scene_targets targets;
    bool has_heights; /* some target is said to have one */
    size_t num_clutter;
    struct scene_clutter clutter[SCENE_ITEMS_MAX];
    struct scene_reflectors reflectors;
    size_t num_events;
    struct scene_event events[SCENE_ITEMS_MAX];
};

/*
 * The file's scene, checked: exit 2 with file, line and place where something is wrong. Frees the
 * text. Each of the sets, `radars[0].pd=0.7`, puts a value in the place of what stands there.
 */
struct scene *scene_read(const char *name, char *text, size_t length, const char *const *sets,
                         size_t num_sets);
void scene_free(struct scene *scene);

/*
 * The scene of a file, where the name has a slash or ends with .json, or one that ships with the
 * program; NULL where it is none.
 */
struct scene *scene_find(const char *name, const char *const *sets, size_t num_sets);

/* Names of the scenes that ship; NULL past the last. */
const char *scene_shipped_name(size_t index);

/*
 * One run as files: plots.csv, bearings.csv where there are passive sensors, truth.csv, paths.csv,
 * scenario.ini.
 */
void scene_simulate(const struct scene *scene, const char *name, const char *folder, uint64_t seed,
                    uint64_t run);

#endif
