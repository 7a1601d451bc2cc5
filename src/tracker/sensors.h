/* SPDX-License-Identifier: MIT */
/* sensors: the table of sensors, and what is learned of each. Private from src/tracker on. */
#ifndef RHOTRACK_SENSORS_H
#define RHOTRACK_SENSORS_H

#include "sight.h"

/* sensors.c: index of a sensor's row in tracker->sensors; num_rows: it has none */
unsigned rho_sensors_row(const struct rho_tracker *tracker, int32_t sensor_id);
/* Row of a sensor that sends a scan; NULL: all rows are of other, described sensors. */
struct rho_tracker_sensor *rho_sensors_hear(struct rho_tracker *tracker, int32_t sensor_id);
const struct rho_sensor *rho_sensors_find(const struct rho_tracker *tracker,
                                          int32_t sensor_id); /* NULL: not described */
int rho_sensors_is_usable(const struct rho_sensor *sensor);

/* plot_noise.c: sets the noise and the notch of the look's sensor, before plots are gated */
void rho_look_open_noise(struct rho_tracker *tracker, struct rho_look *look);

/* unseen_tracks.c: measures the scan interval of a sensor, which is at the origin if NULL */
void rho_pace_update(struct rho_tracker_pace *pace, const struct rho_sensor *sensor,
                     int64_t time_us, float sector_from_rad, float sector_to_rad);

/* sensor_health.c (RHO_SECTORS): finds sensors that contradict the others */
/* Decides whether the scan's sensor is suspect. Returns the factor on its plots' sigmas. */
float rho_health_sigma_factor(struct rho_tracker *tracker, struct rho_look *look);
/* Compares the assigned plots with the tracks' predictions, before tracks are updated. */
void rho_health_compare(struct rho_tracker *tracker, struct rho_look *look);

/*
 * sensor_learning.c: noise and notch of a sensor, estimated from established tracks. Noise is
 * set before plots are gated, and learned between assignment and update. suspicion: factor of
 * sensor_health on the sigmas of a suspect sensor, else 1
 */
/* Writes the learned noise factors, times suspicion, into this description of the sensor. */
void rho_learning_write_noise(const struct rho_look *look, float suspicion,
                              struct rho_sensor *sensor);
/* notch_learning.c (RHO_DOPPLER_NOTCH): writes the learned notch where none is stated */
void rho_learning_apply_notch(const struct rho_look *look);
/* Learns noise and notch of the scan's sensor from this scan's plots and misses. */
void rho_learning_take_look(struct rho_tracker *tracker, const struct rho_look *look);
int rho_learning_is_sound(const struct rho_tracker_learned *learned);

/* bearing_errors.c: variance of errors that last, 0: none are sure */
float rho_bearing_errors_rad2(const struct rho_bearing_errors *errors);
/* Sets what is known of a look's bearings; row: NULL, nothing. */
void rho_bearing_errors_open(struct rho_look *look, const struct rho_tracker_sensor *row);
/* Compares a bearing with the last plot of the track that will claim it, once a plot. */
void rho_bearing_errors_compare(const struct rho_look *look, struct rho_bearing_errors *errors,
                                struct rho_track *track, const struct rho_bearing *bearing);
int rho_bearing_errors_are_sound(const struct rho_bearing_errors *errors);

/* Sensors are learned with hypotheses alone: else manoeuvres count as noise. */
static inline int rho_learning_is_on(const struct rho_tracker_config *config)
{
    return RHO_HAS_FILTER(RHO_TRACK_HYPOTHESES) && config->gate == RHO_TRACKER_BEST;
}
/* counted_pd.c: counts begin anew */
void rho_pd_forget(struct rho_tracker_sensor *row);
int rho_pd_is_sound(const struct rho_tracker_sensor *row);
/* P_D in a ring of range of a described sensor; as stated, but for a tenth. */
float rho_pd_in_ring(const struct rho_tracker *tracker, const struct rho_tracker_sensor *row,
                     unsigned ring);

/* notch_learning.c (RHO_DOPPLER_NOTCH): true where a notch is learned of the look's sensor */
int rho_learning_seeks_notch(const struct rho_look *look);
/* Counts a look in the interval of the track's range rate. */
void rho_learning_count_rate(const struct rho_look *look, const struct rho_track *track,
                             unsigned is_seen);
/* Width of the learned notch, m/s; 0: none. */
float rho_learning_notch_mps(const struct rho_sensor *sensor,
                             const struct rho_tracker_learned *learned);
int rho_learning_is_sound_notch(const struct rho_tracker_learned *learned);

/* resolution_cell.c (RHO_SHARES_PLOTS): distances at which a sensor does not resolve two targets */
int rho_cell_is_usable(const struct rho_sensor *sensor);
/* Variances of such distances at a plot's place, along the line of sight and across it. */
void rho_cell_variances_at(const struct rho_look *look, const struct rho_plot *plot,
                           const struct rho_measurement *seen, float near_m2[2]);
/* Variance of differences of range rate that are not resolved, (m/s)^2; 0: the rate is not used. */
float rho_cell_rate_variance(const struct rho_sensor *sensor);
/* A pair of near tracks that the resolution cell is learned from; [2]: along, across. */
struct apart {
    float is_one;       /* probability that a plot is merged, of both targets */
    float of_one_m2[2]; /* expected squared distance of the targets if it is merged */
    float of_two_m2[2]; /* expected squared distance of the targets if it is of one of them */
    float near_m2[2];   /* variances by rho_cell_variances_at */
};
void rho_cell_learn(const struct rho_look *look, const struct apart *apart);
/* Learned resolution cell on an axis, in sigmas of a plot; 0: not learned yet. */
float rho_cell_learned_sigmas(const struct rho_tracker_learned *learned, int axis);
int rho_cell_is_sound(const struct rho_tracker_learned *learned);

#endif
