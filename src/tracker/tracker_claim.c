/* SPDX-License-Identifier: MIT */
/*
 * tracker_claim: existing tracks are predicted, gate the scan's plots, and are updated by those assigned to them.
 */
#include "rhotrack/angle.h"
#include "rhotrack/approx.h"
#include "rhotrack/measurement.h"
#include "tracker_step.h"

/* The Hough gate needs two velocities that plots have made: it begins at the fourth, as in the paper. */
#define HOUGH_VELOCITIES_MIN 3
/* More than any two velocities within the limits can differ, m/s for nat: only the order counts. */
#define HOUGH_GAIN_MAX_NAT 80000.0f

int32_t rho_tracker_mnat(float nat)
{
    float mnat = nat * 1000.0f;
    if (!(mnat > -(float)RHO_ASSIGNMENT_COST_MAX)) {
        return -RHO_ASSIGNMENT_COST_MAX;
    }
    return mnat < (float)RHO_ASSIGNMENT_COST_MAX ? (int32_t)mnat : RHO_ASSIGNMENT_COST_MAX;
}

/* Standard deviations of a gate, where it is as large as the track's place is unknown. */
#define GATE_SIGMAS 3.0f

/* ---- predict ---------------------------------------------------------------------------------- */

void rho_tracker_predict(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        struct rho_track *track = &tracker->tracks[i];
        track->plot = -1;
        rho_tracker_note_ahead(track);
        if (!rho_tracker_reaches(step, track) || rho_tracker_was_seen(step, track) ||
            rho_tracker_is_hearsay(step, track)) {
            continue;
        }
        step->reached[i / 32] |= 1u << i % 32;
        /* an estimate that time has made worthless cannot be carried on */
        if (rho_track_predict(track, step->time_us, &step->model) != RHO_OK) {
            rho_tracker_end_track(step, track);
        }
    }
}

/* ---- claim ------------------------------------------------------------------------------------ */

float rho_tracker_usual_density(const struct step *step, float x_m, float y_m)
{
    const struct rho_tracker *tracker = step->tracker;
    if (step->initiator) {
        float density = rho_initiator_density(step->initiator, step->scan->sensor_id, x_m, y_m);
        if (density > 0.0f) {
            return density;
        }
    }
    float area_m2 = rho_extent_area_m2(&tracker->extent, RHO_CLUTTER_SIDE_MIN_M);
    return (tracker->unclaimed_plots > 1.0f ? tracker->unclaimed_plots : 1.0f) / area_m2;
}

static float clutter_density(const struct step *step, float x_m, float y_m)
{
    float density = rho_tracker_usual_density(step, x_m, y_m);
    if (RHO_CLAIMS_BEYOND && step->part_share > 0.0f) {
        density *= step->part_share;
        density = step->part_per_m2 > density ? step->part_per_m2 : density;
    }
    return density;
}

float rho_tracker_clutter_in_gate(const struct step *step, const struct rho_track *track)
{
    const float sigma_m = rho_track_sigma_m(track);
    return step->scan ? 0.5f * RHO_TWO_PI * GATE_SIGMAS * GATE_SIGMAS * sigma_m * sigma_m *
                            clutter_density(step, track->kalman.state[0], track->kalman.state[1])
                      : 0.0f;
}

/* ln of the plot's density as the track's, over its density as clutter, whose range rates are any that a target may
 * have. */
static float log_ratio(const struct step *step, const struct rho_gate_result *result,
                       float log_density)
{
    float dimensions = 2.0f;
    if (result->has_z) {
        log_density -= step->log_height;
        dimensions += 1.0f;
    }
    if (result->has_range_rate) {
        log_density -= rho_tracker_log_range_rates(step);
        dimensions += 1.0f;
    }
    return -0.5f * (dimensions * LOG_TWO_PI + result->log_det + result->distance2) - log_density;
}

void rho_tracker_offer(struct step *step, unsigned row, uint32_t column, float gain_nat)
{
    int32_t gain = rho_tracker_mnat(gain_nat);
    (void)!rho_assignment_add(&step->tracker->assignment, row, column, gain > 1 ? -gain : -1);
}

int rho_tracker_gain_offered(const struct step *step, unsigned row, int column, float *gain_nat)
{
    const struct rho_assignment *assignment = &step->tracker->assignment;
    for (unsigned i = 0; i < assignment->num_pairs[row]; i++) {
        if (assignment->pairs[row][i].column == column) {
            *gain_nat = rho_tracker_odds(step, &step->tracker->tracks[row]).log_miss -
                        0.001f * (float)assignment->pairs[row][i].cost;
            return 1;
        }
    }
    return 0;
}

void rho_tracker_assign(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    rho_assignment_solve(&tracker->assignment);
    tracker->counters.gate_plots_dropped =
        rho_count(tracker->counters.gate_plots_dropped, tracker->assignment.pairs_dropped);
}

/* ---- what a Kalman filter's gate lets in ------------------------------------------------------- */

/* The Hough gate's view of a track's plots: set up by the velocities of its last two estimates. */
static int opens_hough(const struct step *step, const struct rho_track *track,
                       struct rho_gate_hough *hough)
{
    const struct rho_tracker_config *config = &step->tracker->config;
    uint8_t planes = config->planes;
    if (!rho_kalman_is_open(&track->kalman, 2)) {
        planes = RHO_GATE_PLANE_XY;
    }
    return RHO_HAS_FILTER(RHO_TRACK_INPUT) && config->gate == RHO_TRACKER_HOUGH &&
           !RHO_TRACK_IS_BY(track, RHO_TRACK_HYPOTHESES) &&
           track->num_velocities >= HOUGH_VELOCITIES_MIN &&
           rho_gate_hough_open(hough, planes, config->theta_cell_rad, track->before_mps,
                               track->newest_mps) == RHO_OK;
}

/* A plot that measures no velocity has the one that brings a target there from where it was last seen. */
static void velocity_of(const struct step *step, const struct rho_track *track,
                        const struct rho_plot *plot, float velocity_mps[3])
{
    const float measured_mps[3] = {plot->vx_mps, plot->vy_mps, plot->vz_mps};
    const float place_m[3] = {plot->x_m, plot->y_m, plot->z_m};
    const int has_z = (step->scan->measures & RHO_MEASURES_Z) != 0;
    float dt_s = rho_seconds_between(track->updated_us, step->time_us + plot->offset_us);
    for (int axis = 0; axis < 3; axis++) {
        velocity_mps[axis] = track->newest_mps[axis];
        if (axis == 2 && !has_z) {
            continue;
        }
        if (step->scan->measures & RHO_MEASURES_VELOCITY) {
            velocity_mps[axis] = measured_mps[axis];
        } else if (dt_s > 0.0f) {
            /* the prediction is where the newest velocity leads */
            velocity_mps[axis] += (place_m[axis] - track->kalman.state[axis]) / dt_s;
        }
    }
}

/* Less of a way from the straight line is better; the constant keeps any better than none. */
static float hough_gain(const struct step *step, const struct rho_track *track,
                        const struct rho_gate_hough *hough, const struct rho_plot *plot)
{
    float velocity_mps[3];
    velocity_of(step, track, plot, velocity_mps);
    return HOUGH_GAIN_MAX_NAT - rho_gate_hough_off(hough, velocity_mps);
}

void rho_tracker_open_gate(const struct step *step, const struct rho_track *track,
                           struct rho_gate *gate)
{
    struct rho_kalman expected;
    rho_track_expect(track, &expected);
    rho_gate_open(gate, &expected,
                  RHO_TRACK_IS_BY(track, RHO_TRACK_INPUT) ? step->model.input->noise_density
                                                          : step->model.noise_density,
                  step->sensor, step->scan ? step->scan->measures : 0);
}

/* Few plots are. */
static int is_in_box(const struct step *step, const struct rho_gate *gate, const float half_m[2],
                     uint32_t i)
{
    const float dx_m = step->scan->plots[i].x_m - gate->predicted.state[0];
    const float dy_m = step->scan->plots[i].y_m - gate->predicted.state[1];
    return dx_m <= half_m[0] && dx_m >= -half_m[0] && dy_m <= half_m[1] && dy_m >= -half_m[1] &&
           step->report->fates[i] == RHO_FATE_HELD;
}

static void gate_plots(struct step *step, unsigned row)
{
    struct rho_tracker *tracker = step->tracker;
    const struct rho_track *track = &tracker->tracks[row];
    struct rho_gate gate;
    struct rho_gate_hough hough;
    struct rho_gate_result result;
    float half_m[2];
    const struct odds odds = rho_tracker_odds(step, track);
    float log_density =
        rho_log(clutter_density(step, track->kalman.state[0], track->kalman.state[1]));
    int by_hough = opens_hough(step, track, &hough);
    rho_tracker_open_gate(step, track, &gate);
    rho_gate_box(&gate, step->sigma_max_m, step->offset_max_s, half_m);
    struct plots_near near = rho_tracker_plots_near(
        step, gate.predicted.state[0] - half_m[0], gate.predicted.state[0] + half_m[0],
        gate.predicted.state[1] - half_m[1], gate.predicted.state[1] + half_m[1]);
    struct plots_near counted = near;
    struct plot_choice choice = rho_tracker_choose_plots(step, track);
    for (uint32_t i; choice.most < rho_tracker_most_near(step, &near) &&
                     rho_tracker_next_plot(step, &counted, &i);) {
        if (is_in_box(step, &gate, half_m, i)) {
            rho_tracker_note_choice(&choice, track, &step->scan->plots[i]);
        }
    }
    rho_tracker_settle_choice(step, &choice);
    for (uint32_t i; rho_tracker_next_plot(step, &near, &i);) {
        const struct rho_plot *plot = &step->scan->plots[i];
        if (is_in_box(step, &gate, half_m, i) && rho_tracker_takes(step, &choice, track, plot) &&
            rho_gate_test(&gate, plot, &result)) {
            rho_tracker_offer(
                step, row, i,
                by_hough
                    ? hough_gain(step, track, &hough, plot)
                    : odds.log_pd +
                          log_ratio(step, &result, log_density + rho_tracker_repeats_nat(step, i)) -
                          odds.log_miss);
        }
    }
}

/* ---- what hypotheses let in --------------------------------------------------------------------- */

static struct rho_hypotheses_clutter clutter_at(const struct step *step,
                                                const struct rho_track *track)
{
    return (struct rho_hypotheses_clutter){
        .log_per_m2 =
            rho_log(clutter_density(step, track->kalman.state[0], track->kalman.state[1])),
        .log_per_m = -step->log_height,
        .log_per_mps = -step->log_rates,
        .log_per_range_rate = -rho_tracker_log_range_rates(step),
    };
}

/* A miss says nothing of a target where the sensor did not look. */
static float log_miss_of(const struct step *step, const struct rho_track *track)
{
    return rho_tracker_scan_looked_at(step, track) ? rho_tracker_odds(step, track).log_miss : 0.0f;
}

/* By the noise and the own time of the plots that have most of them. */
static struct plots_near plots_in_reach(const struct step *step, const struct rho_track *track,
                                        struct rho_hypotheses_reach *reach)
{
    const float slack_m = rho_hypotheses_slack_m(&step->tracker->hypotheses, track->slot, reach,
                                                 step->sigma_max_m, step->offset_max_s);
    return rho_tracker_plots_near(step, reach->x_min_m - slack_m, reach->x_max_m + slack_m,
                                  reach->y_min_m - slack_m, reach->y_max_m + slack_m);
}

/*
 * The plots that a track may go on with: those of all hypotheses' reach; with claims, but for those
 * that others got.
 */
struct offer {
    unsigned row;
    const int16_t *claims;
    struct rho_hypotheses_reach reach;
    struct plots_near near;
};

static int is_offered(const struct step *step, struct offer *offer, uint32_t i)
{
    const struct rho_tracker *tracker = step->tracker;
    const int16_t *claims = offer->claims;
    return step->report->fates[i] == RHO_FATE_HELD &&
           !(claims && claims[i] >= 0 && claims[i] != (int)offer->row) &&
           rho_hypotheses_reaches(&tracker->hypotheses, tracker->tracks[offer->row].slot,
                                  &offer->reach, &step->scan->plots[i], step->scan->measures);
}

static struct plot_choice choose(struct step *step, struct offer *offer)
{
    const struct rho_track *track = &step->tracker->tracks[offer->row];
    struct plot_choice choice = rho_tracker_choose_plots(step, track);
    struct plots_near counted = offer->near;
    for (uint32_t i; choice.most < rho_tracker_most_near(step, &offer->near) &&
                     rho_tracker_next_plot(step, &counted, &i);) {
        if (is_offered(step, offer, i)) {
            rho_tracker_note_choice(&choice, track, &step->scan->plots[i]);
        }
    }
    rho_tracker_settle_choice(step, &choice);
    return choice;
}

/*
 * Without claims, plots are offered to the assignment: one that is worth less than a miss is no better than none. With
 * them, those that others got are left out.
 */
static void weigh_plots(struct step *step, unsigned row, const int16_t *claims)
{
    struct rho_tracker *tracker = step->tracker;
    const struct rho_track *track = &tracker->tracks[row];
    const float log_miss = log_miss_of(step, track);
    const struct rho_hypotheses_clutter usual = clutter_at(step, track);
    struct offer offer = {.row = row, .claims = claims};
    struct rho_imm_plot seen;
    float gain_nat;
    const float log_pd = rho_tracker_odds(step, track).log_pd;
    rho_hypotheses_look(&tracker->hypotheses, track->slot, &offer.reach);
    offer.reach.sigma_factor = rho_measurement_widest_factor(step->sensor);
    offer.near = plots_in_reach(step, track, &offer.reach);
    struct plot_choice choice = choose(step, &offer);
    for (uint32_t i; rho_tracker_next_plot(step, &offer.near, &i);) {
        const struct rho_plot *plot = &step->scan->plots[i];
        if (!is_offered(step, &offer, i) || !rho_tracker_takes(step, &choice, track, plot)) {
            continue;
        }
        rho_imm_open_plot(&seen, plot, step->scan->measures, step->sensor);
        struct rho_hypotheses_clutter clutter = usual;
        clutter.log_per_m2 += rho_tracker_repeats_nat(step, i);
        if (rho_hypotheses_weigh(&tracker->hypotheses, track->slot, &seen,
                                 step->time_us + plot->offset_us, (int16_t)i, log_pd, &clutter,
                                 &gain_nat) &&
            !claims && gain_nat > log_miss) {
            rho_tracker_offer(step, row, i, gain_nat - log_miss);
        }
    }
}

void rho_tracker_claim(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    /* both counts are within the capacities: nothing to refuse */
    (void)!rho_assignment_begin(&tracker->assignment, tracker->num_tracks, step->num_gated);
    rho_tracker_begin_work(step);
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        if (tracker->tracks[row].status == RHO_TRACK_FREE || !rho_tracker_is_reached(step, row)) {
            continue;
        }
        if (RHO_TRACK_IS_BY(&tracker->tracks[row], RHO_TRACK_HYPOTHESES)) {
            weigh_plots(step, row, 0);
        } else {
            gate_plots(step, row);
        }
    }
    rho_tracker_assign(step);
}

/* ---- update ----------------------------------------------------------------------------------- */

static int32_t gain_of(const struct step *step, const struct rho_track *track, uint32_t plot)
{
    struct rho_gate gate;
    struct rho_gate_result result;
    rho_tracker_open_gate(step, track, &gate);
    if (!rho_gate_test(&gate, &step->scan->plots[plot], &result)) {
        return 0;
    }
    float density = clutter_density(step, track->kalman.state[0], track->kalman.state[1]);
    return rho_tracker_mnat(
        rho_tracker_odds(step, track).log_pd +
        log_ratio(step, &result, rho_log(density) + rho_tracker_repeats_nat(step, plot)));
}

struct rho_track_plot rho_tracker_plot_of(const struct step *step, int row)
{
    const struct rho_plot *plot = &step->scan->plots[row];
    return (struct rho_track_plot){
        .time_us = step->scan->time_us + plot->offset_us,
        .measures = step->scan->measures,
        .sensor_id = step->scan->sensor_id,
        .sensor = step->sensor,
        .plot = *plot,
        .row = (int16_t)row,
    };
}

static int claim_plot(struct step *step, struct rho_track *track, int plot)
{
    int32_t gain = gain_of(step, track, (uint32_t)plot);
    struct rho_track_plot seen = rho_tracker_plot_of(step, plot);
    return rho_track_update(track, &seen, &step->model, gain) == RHO_OK;
}

/* A hypothesis has a list of its best plots only: where others got some of these, there may be more that it could go on
 * with, even the one that is assigned to the track. */
static int lacks_plots(const struct step *step, unsigned row)
{
    const struct rho_hypotheses *pool = &step->tracker->hypotheses;
    const int16_t *claims = step->tracker->assignment.column_row;
    const uint16_t slot = step->tracker->tracks[row].slot;
    for (unsigned i = 0; i < rho_hypotheses_count(pool, slot); i++) {
        const struct rho_hypothesis *at = rho_hypotheses_at(pool, slot, i);
        for (unsigned k = 0;
             at->num_candidates == RHO_HYPOTHESES_CHILDREN && k < RHO_HYPOTHESES_CHILDREN; k++) {
            int claim = claims[at->candidates[k].row];
            if (claim >= 0 && claim != (int)row) {
                return 1;
            }
        }
    }
    return 0;
}

/*
 * Hypotheses go on with any plots of theirs that no other track got; the best one's is claimed. By the assignment's optimum
 * that is the one assigned, or none.
 */
static void commit(struct step *step, unsigned row)
{
    struct rho_tracker *tracker = step->tracker;
    struct rho_track *track = &tracker->tracks[row];
    struct rho_assignment *assignment = &tracker->assignment;
    uint32_t refused = tracker->hypotheses.updates_refused;
    const float log_miss = log_miss_of(step, track);
    const int assigned = rho_assignment_column(assignment, row);
    const struct rho_hypotheses_scan scan = {
        .time_us = step->time_us,
        .measures = step->scan->measures,
        .plots = step->scan->plots,
        .sensor = step->sensor,
        .log_miss = log_miss,
        .claims = assignment->column_row,
        .own = (int16_t)row,
    };
    if (!(log_miss < 0.0f) && !rho_hypotheses_has_candidates(&tracker->hypotheses, track->slot)) {
        return;
    }
    if (lacks_plots(step, row)) {
        weigh_plots(step, row, assignment->column_row);
    } else {
        rho_tracker_waive(step);
    }
    /* the track is one of hypotheses: nothing to refuse */
    (void)!rho_track_commit(track, &scan, step->scan->sensor_id, &step->model);
    refused = tracker->hypotheses.updates_refused - refused;
    tracker->counters.updates_refused = rho_count(tracker->counters.updates_refused, refused);
    if (assigned != RHO_ASSIGNMENT_NONE && assigned != track->plot) {
        assignment->column_row[assigned] = RHO_ASSIGNMENT_NONE; /* not taken after all */
    }
    if (track->plot >= 0) {
        assignment->column_row[track->plot] = (int16_t)row;
        step->report->fates[track->plot] = RHO_FATE_CLAIMED;
    }
}

void rho_tracker_update(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    rho_tracker_begin_work(step);
    rho_tracker_share(step);
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        struct rho_track *track = &tracker->tracks[row];
        int plot = rho_assignment_column(&tracker->assignment, row);
        if (track->status == RHO_TRACK_FREE || track->plot >= 0 ||
            !rho_tracker_is_reached(step, row)) {
            continue;
        }
        if (RHO_CLAIMS_BEYOND && step->has_more_parts && plot == RHO_ASSIGNMENT_NONE) {
            continue;
        }
        if (RHO_TRACK_IS_BY(track, RHO_TRACK_HYPOTHESES)) {
            commit(step, row);
        } else if (plot == RHO_ASSIGNMENT_NONE) {
            continue;
        } else if (claim_plot(step, track, plot)) {
            step->report->fates[plot] = RHO_FATE_CLAIMED;
        } else {
            tracker->counters.updates_refused = rho_count(tracker->counters.updates_refused, 1);
        }
    }
}

/* Tracks out of the scan's reach, and those that it started at their plots' own times, stay as they are; reports move what was
 * last known of them. */
void rho_tracker_settle(struct step *step)
{
    for (unsigned i = 0; i < step->tracker->num_tracks; i++) {
        struct rho_track *track = &step->tracker->tracks[i];
        if (!step->scan || track->time_us == step->time_us) {
            rho_track_settle(track, step->time_us, &step->model);
        }
    }
}
