/* SPDX-License-Identifier: MIT */
/*
 * scene: the sensors, targets, clutter and events of a simulated scene, read from a JSON file
 * (format: tools/scenes/README.md).
 *
 * Positions are in metres, x east, y north; angles counter-clockwise from +x; times in seconds from
 * the scene's start. Each sensor, target and clutter source draws from its own stream of random
 * numbers (scene_random_streams.h): a change of one does not change the others.
 */
#ifndef RHOTRACK_TOOL_SCENE_H
#define RHOTRACK_TOOL_SCENE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "scene/json_value_reader.h"
#include "scene/scene_path.h"
#include "scene/scene_radar_notch.h"
#include "scene/scene_reflectors.h"
#include "settings/parameters.h"

#define SCENE_SENSORS_MAX 16 /* most radars, and most passive sensors */
#define SCENE_ITEMS_MAX 32   /* most clutter sources, most events */
#define SCENE_CURVE_MAX 16
#define SCENE_SCANS_MAX 10000000

/*
 * A probability as a function of range: linear between its points, constant beyond the first and
 * the last.
 */
struct scene_curve {
    size_t count;
    double range_m[SCENE_CURVE_MAX], value[SCENE_CURVE_MAX];
};

/* Range limits and sector of a sensor's coverage. */
struct scene_coverage {
    struct json_span range_m;
    bool has_sector; /* the coverage is a sector; false: full circle */
    double from_rad, to_rad;
};

/* The description of a sensor that a tracker is given, which may differ from the true sensor. */
struct scene_stated {
    double x_m, y_m, pd;
    double sigma_m, sigma_mps, sigma_range_m, sigma_azimuth_rad, sigma_range_rate_mps, sigma_rad;
    double sigma_elevation_rad;
    double range_bias_m, azimuth_bias_rad, time_bias_s;
    struct scene_coverage coverage;
    struct scene_notch notch;
};

struct scene_sensor {
    int32_t sensor_id;
    bool is_passive;   /* measures bearings only */
    bool is_cartesian; /* plots are x and y with sigma_m, instead of range and azimuth */
    double x_m, y_m;
    bool turns; /* the antenna rotates; false: all places are seen at each scan's time */
    bool is_counter_clockwise;
    size_t sectors; /* scans in one turn of the antenna */
    /* duration of a turn; of a sensor that does not turn, time between scans */
    double turn_s;
    /* start time and antenna azimuth then, drawn for each run from starts_s and starts_rad */
    double start_s, start_rad;
    struct json_span starts_s, starts_rad;
    struct scene_coverage coverage;
    struct scene_curve pd;
    double sigma_m, sigma_range_m, sigma_azimuth_rad, sigma_rad;
    bool has_range_rate;
    double sigma_range_rate_mps, range_rate_span_mps;
    /* Doppler notch of polar radars, whether or not range rates are measured */
    struct scene_notch notch;
    /* of Cartesian plots: sigma of their velocities; 0: plots have none */
    double sigma_mps;
    /* targets closer than both of these are merged into one plot; 0: none are */
    double resolution_m, resolution_rad;
    /* true biases, as defined in struct rho_sensor */
    double range_bias_m, azimuth_bias_rad, time_bias_s;
    /* share of scans that arrive late, and their delay */
    double late_share, late_s;
    /* of a passive sensor: a sine of this amplitude and period in each target's bearings */
    double sway_rad, sway_s;
    /* of a passive sensor: sigma of elevations, 0: it measures none; and its height */
    double sigma_elevation_rad, z_m;
    double false_bearings;               /* of a passive sensor: mean number a scan */
    bool is_geometric;                   /* their distribution; false: Poisson */
    double false_from_rad, false_to_rad; /* sector in which false bearings lie */
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
    uint32_t sensors; /* bit mask of the sensors that see this clutter */
    double from_s, until_s;
    double plots;         /* uniform, cell, strobe: mean plots a scan */
    double plots_per_km2; /* uniform: mean plots a scan and km^2, instead of plots */
    /* uniform, standing, spikes: area as range and sector; strobe: its ranges */
    struct scene_coverage within;
    bool has_box;
    /* uniform, standing, spikes: area as x_min, x_max, y_min, y_max, instead of within */
    double box_m[4];
    bool is_disc; /* cell: uniform in a disc; false: Gaussian about its centre */
    /* cell, flock: centre at time 0, its velocity, and radius */
    double x_m, y_m, vx_mps, vy_mps, radius_m;
    /*
     * cell: sigma of range rates about the cell's own; uniform: sigma of range rates, instead of
     * rate_max_mps
     */
    double rate_sigma_mps;
    double rate_max_mps; /* uniform: range rates are uniform within plus and minus this */
    /* standing, flock: number of echoes; about-targets: plots a scan and target */
    uint64_t count;
    double (*places_m)[2]; /* standing: listed positions; NULL: positions are drawn */
    double pd;             /* standing, spikes, flock, second time: probability of detection */
    double per_s;          /* spikes: new spikes a second */
    struct json_span life_s;
    /* flock: speed of each bird relative to the flock; spikes: drift, in a random direction */
    double speed_mps;
    /* strobe: azimuth, beam width, rate of turn; about-targets: beam width */
    double azimuth_rad, width_rad, azimuth_radps;
    double unambiguous_m; /* second time: unambiguous range */
    struct scene_targets targets;
};

enum event_kind { EVENT_OUTAGE, EVENT_FADES, EVENT_MASK, EVENT_SPLIT, EVENT_KINDS };

struct scene_event {
    enum event_kind kind;
    uint32_t sensors;
    double from_s, until_s;
    bool is_silent;               /* outage: no scans are sent; false: empty ones */
    struct scene_coverage within; /* mask: area that is hidden; fades: where they count */
    /* fades: mean number an hour and target; 0: one fade from from_s until until_s */
    double per_hour;
    struct json_span for_s;
    /* fades: only the targets in the bit mask `targets` of indices in targets[] */
    bool has_targets;
    uint32_t targets;
    double pd; /* fades: largest pd during a fade */
    /* split: share of a target's plots that get a second plot, offset by the spans below */
    double share;
    struct json_span range_sigmas, azimuth_sigmas, range_m, azimuth_rad;
};

struct scene {
    char *name;  /* file name for messages */
    char *title; /* one-line description in the file */
    double duration_s;
    bool has_area;
    double area_m[4];               /* x_min, x_max, y_min, y_max */
    char *settings;                 /* tracker parameters, as lines of an INI file */
    double v_max_mps;               /* v_max_mps of the settings */
    size_t num_sensors, num_radars; /* sensors: radars first, then passive ones */
    struct scene_sensor sensors[2 * SCENE_SENSORS_MAX];
    struct scene_targets targets;
    bool has_heights;    /* some target is given a height: plots then have heights */
    bool has_elevations; /* some passive sensor measures elevations */
    size_t num_clutter;
    struct scene_clutter clutter[SCENE_ITEMS_MAX];
    struct scene_reflectors reflectors;
    size_t num_events;
    struct scene_event events[SCENE_ITEMS_MAX];
};

/*
 * Reads and checks a scene; frees the text. Exits with 2, naming file, line and key, where
 * something is wrong. Each of the sets, such as `radars[0].pd=0.7`, replaces a value of the file.
 */
struct scene *scene_read(const char *name, char *text, size_t length, const char *const *sets,
                         size_t num_sets);
void scene_free(struct scene *scene);

/*
 * Reads the scene of a file, where name contains a slash or ends with .json, or a scene shipped
 * with the program; NULL where there is none of this name.
 */
struct scene *scene_load_by_name(const char *name, const char *const *sets, size_t num_sets);

/* Name of shipped scene number index; NULL past the last. */
const char *scene_shipped_name(size_t index);

/*
 * Simulates one run and writes plots.csv, bearings.csv where there are passive sensors, truth.csv,
 * paths.csv and scenario.ini into folder.
 */
void scene_simulate(const struct scene *scene, const char *name, const char *folder, uint64_t seed,
                    uint64_t run);

#endif
