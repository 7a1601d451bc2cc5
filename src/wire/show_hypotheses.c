/* SPDX-License-Identifier: MIT */
/* show_hypotheses: a message of one track's hypotheses, model probabilities and evidence. */
#include "show_writers.h"

#define PLOT_NONE (-1)    /* the hypothesis took no plot of the scan */
#define PLOT_UNKNOWN (-2) /* a track of one filter does not store its older plots */

/* ---- hypotheses ------------------------------------------------------------------------------ */

/* Element of the state's mean over a hypothesis's two models, weighted by their probabilities. */
static float mean_over_models(const struct rho_imm *imm, int element)
{
    return imm->steady.state[element] +
           imm->probability * (imm->state[element] - imm->steady.state[element]);
}

static struct rho_message_hypothesis hypothesis_message_of(const struct rho_hypothesis *at,
                                                           float sum)
{
    struct rho_message_hypothesis hypothesis = {.share = at->share / sum,
                                                .x_m = mean_over_models(&at->imm, 0),
                                                .y_m = mean_over_models(&at->imm, 1),
                                                .vx_mps = mean_over_models(&at->imm, 3),
                                                .vy_mps = mean_over_models(&at->imm, 4),
                                                .maneuver_probability = at->imm.probability};
    for (int i = 0; i < RHO_HYPOTHESES_MEMORY; i++) {
        hypothesis.plots[i] = at->picks[i] >= 0 ? at->picks[i] : PLOT_NONE;
    }
    return hypothesis;
}

/* Makes the one hypothesis of a track with a single filter. */
static struct rho_message_hypothesis hypothesis_message_of_filter(const struct rho_track *track)
{
    return (struct rho_message_hypothesis){
        .share = 1.0f,
        .x_m = track->kalman.state[0],
        .y_m = track->kalman.state[1],
        .vx_mps = track->kalman.state[3],
        .vy_mps = track->kalman.state[4],
        .maneuver_probability = track->maneuver_probability,
        .plots = {PLOT_UNKNOWN, PLOT_UNKNOWN, track->plot >= 0 ? track->plot : PLOT_NONE}};
}

static float sum_of_shares(const struct rho_hypotheses *pool, const struct rho_track *track)
{
    float sum = 0.0f;
    for (unsigned i = 0; i < rho_hypotheses_count(pool, track->slot); i++) {
        sum += rho_hypotheses_at(pool, track->slot, i)->share;
    }
    return sum;
}

static enum rho_status add_hypotheses(const struct rho_hypotheses *pool,
                                      const struct rho_track *track,
                                      struct rho_message_writer *writer)
{
    const float sum = sum_of_shares(pool, track);
    enum rho_status status = RHO_OK;
    for (unsigned i = 0; i < rho_hypotheses_count(pool, track->slot) && status == RHO_OK; i++) {
        const struct rho_message_hypothesis hypothesis =
            hypothesis_message_of(rho_hypotheses_at(pool, track->slot, i), sum);
        status = rho_message_hypotheses_add(writer, &hypothesis);
    }
    return status;
}

/* ---- models ---------------------------------------------------------------------------------- */

static void set_model_probabilities(const struct rho_hypotheses *pool,
                                    const struct rho_track *track,
                                    struct rho_message_hypotheses_head *head)
{
    head->maneuver = track->maneuver_probability;
    head->calm = 0.0f;
    if (RHO_TRACK_IS_BY(track, RHO_TRACK_HYPOTHESES)) {
        const float sum = sum_of_shares(pool, track);
        head->maneuver = 0.0f;
        for (unsigned i = 0; i < rho_hypotheses_count(pool, track->slot); i++) {
            const struct rho_hypothesis *at = rho_hypotheses_at(pool, track->slot, i);
            const float share = at->share / sum;
            head->maneuver += share * at->imm.probability;
            head->calm += share * (1.0f - at->imm.probability) * at->imm.calm;
        }
    }
    head->steady = 1.0f - head->maneuver - head->calm;
    head->steady = head->steady > 0.0f ? head->steady : 0.0f;
}

/* ---- evidence -------------------------------------------------------------------------------- */

static float clamp_to_one(float share)
{
    return share < 1.0f ? share : 1.0f;
}

static void set_evidence(struct rho_message_hypotheses_head *head, int8_t kind, float support,
                         float shared, float clutter)
{
    head->evidence = kind;
    head->support = clamp_to_one(support);
    head->shared = clamp_to_one(shared);
    head->clutter = clamp_to_one(clutter);
}

/* Sets the neutrosophic sums of the line that started the track in this step; 0: none did. */
static int set_evidence_if_line_started_track(const struct rho_paper_starts *starts,
                                              uint32_t track_id,
                                              struct rho_message_hypotheses_head *head)
{
    for (uint32_t i = 0; starts && starts->has_searched && i < starts->result.num_peaks; i++) {
        const struct rho_hough_memberships *sums = &starts->lines[i].line.sums;
        const float truth = (float)sums->truth, falsity = (float)sums->falsity;
        const float indeterminacy = (float)sums->indeterminacy;
        const float all = truth + indeterminacy + falsity;
        if (starts->lines[i].track_id == track_id && all > 0.0f) {
            set_evidence(head, RHO_MESSAGE_HYPOTHESES_LINE, truth / all, indeterminacy / all,
                         falsity / all);
            return 1;
        }
    }
    return 0;
}

static void find_and_set_evidence(const struct rho_show_source *source, unsigned track,
                                  struct rho_message_hypotheses_head *head)
{
    struct rho_tracker_evidence evidence;
    if (!set_evidence_if_line_started_track(source->starts, source->tracker->tracks[track].track_id,
                                            head) &&
        rho_tracker_evidence_of(source->tracker, track, &evidence)) {
        set_evidence(head, RHO_MESSAGE_HYPOTHESES_PLOTS, evidence.support, evidence.shared,
                     evidence.clutter);
    }
}

/* ---- the message ----------------------------------------------------------------------------- */

const char *rho_show_write_hypotheses_message(const struct rho_show_source *source, unsigned track,
                                              const struct rho_show_output *output)
{
    if (track >= source->tracker->num_tracks) {
        return NULL;
    }
    const struct rho_track *at = &source->tracker->tracks[track];
    const struct rho_hypotheses *pool = &source->tracker->hypotheses;
    struct rho_message_writer writer;
    struct rho_message_hypotheses_head head = {.utime = source->report->time_us,
                                               .scan = source->step,
                                               .epoch = source->epoch,
                                               .track_id = (int32_t)(at->track_id & INT32_MAX),
                                               .score_nat = (float)at->score_mnat * 0.001f,
                                               .not_sent = output->not_sent};
    set_model_probabilities(pool, at, &head);
    find_and_set_evidence(source, track, &head);
    enum rho_status status =
        rho_message_hypotheses_begin(&writer, output->buffer, output->capacity, &head);
    if (status == RHO_OK && RHO_TRACK_IS_BY(at, RHO_TRACK_HYPOTHESES)) {
        status = add_hypotheses(pool, at, &writer);
    } else if (status == RHO_OK) {
        const struct rho_message_hypothesis only = hypothesis_message_of_filter(at);
        status = rho_message_hypotheses_add(&writer, &only);
    }
    return status == RHO_OK && rho_message_end(&writer, output->size) == RHO_OK
               ? RHO_MESSAGE_HYPOTHESES_CHANNEL
               : NULL;
}
