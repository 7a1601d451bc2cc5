/* SPDX-License-Identifier: MIT */
/* show_hypotheses: a message of one track's hypotheses, model probabilities and evidence. */
#include "rhotrack/detail/approx.h"
#include "show_writers.h"

enum {
    PLOT_NONE = -1,   /* the hypothesis took no plot of the scan */
    PLOT_UNKNOWN = -2 /* a track of one filter does not store its older plots */
};

/* Element of the state's mean over a hypothesis's two models, weighted by their probabilities. */
static float mean_over_models(const struct rho_imm *imm, int element)
{
    return imm->steady.state[element] +
           imm->probability * (imm->state[element] - imm->steady.state[element]);
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
        const struct rho_hypothesis *at = rho_hypotheses_at(pool, track->slot, i);
        struct rho_message_hypothesis message = {.share = at->share / sum,
                                                 .x_m = mean_over_models(&at->imm, 0),
                                                 .y_m = mean_over_models(&at->imm, 1),
                                                 .vx_mps = mean_over_models(&at->imm, 3),
                                                 .vy_mps = mean_over_models(&at->imm, 4),
                                                 .maneuver_probability = at->imm.probability};
        for (int k = 0; k < RHO_HYPOTHESES_MEMORY; k++) {
            message.plots[k] = at->picks[k] >= 0 ? at->picks[k] : PLOT_NONE;
        }
        status = rho_message_hypotheses_add(writer, &message);
    }
    return status;
}

/* Sets the evidence of the track, or of the line that started it in this step, where known. */
static void find_evidence(const struct rho_show_source *source, unsigned track,
                          struct rho_message_hypotheses_head *head)
{
    const struct rho_paper_starts *starts = source->starts;
    struct rho_tracker_evidence found = {0.0f, 0.0f, 0.0f};
    if (rho_tracker_evidence_of(source->tracker, track, &found)) {
        head->evidence = RHO_MESSAGE_HYPOTHESES_PLOTS;
    }
    for (uint32_t i = 0; starts && starts->has_searched && i < starts->result.num_peaks; i++) {
        const struct rho_hough_memberships *sums = &starts->lines[i].line.sums;
        const float truth = (float)sums->truth, falsity = (float)sums->falsity;
        const float indeterminacy = (float)sums->indeterminacy;
        const float all = truth + indeterminacy + falsity;
        if (starts->lines[i].track_id == source->tracker->tracks[track].track_id && all > 0.0f) {
            found = (struct rho_tracker_evidence){truth / all, indeterminacy / all, falsity / all};
            head->evidence = RHO_MESSAGE_HYPOTHESES_LINE;
            break;
        }
    }
    head->support = rho_smaller(found.support, 1.0f);
    head->shared = rho_smaller(found.shared, 1.0f);
    head->clutter = rho_smaller(found.clutter, 1.0f);
}

enum rho_status rho_show_write_hypotheses(const struct rho_show_source *source, unsigned track,
                                          struct rho_show_output *output)
{
    if (track >= source->tracker->num_tracks) {
        return RHO_ERROR_STATE;
    }
    const struct rho_track *at = &source->tracker->tracks[track];
    const struct rho_hypotheses *pool = &source->tracker->hypotheses;
    const int has_pool = RHO_TRACK_IS_BY(at, RHO_TRACK_HYPOTHESES);
    struct rho_message_hypotheses_head head = {.utime = source->report->time_us,
                                               .scan = source->step,
                                               .epoch = source->epoch,
                                               .track_id = (int32_t)(at->track_id & INT32_MAX),
                                               .score_nat = (float)at->score_mnat * 0.001f,
                                               .maneuver = at->maneuver_probability,
                                               .not_sent = output->not_sent};
    if (has_pool) { /* probabilities of the models, over all hypotheses */
        const float sum = sum_of_shares(pool, at);
        head.maneuver = 0.0f;
        for (unsigned i = 0; i < rho_hypotheses_count(pool, at->slot); i++) {
            const struct rho_hypothesis *hypothesis = rho_hypotheses_at(pool, at->slot, i);
            const float share = hypothesis->share / sum;
            head.maneuver += share * hypothesis->imm.probability;
            head.calm += share * (1.0f - hypothesis->imm.probability) * hypothesis->imm.calm;
        }
    }
    head.steady = rho_larger(1.0f - head.maneuver - head.calm, 0.0f);
    find_evidence(source, track, &head);
    output->channel = RHO_MESSAGE_HYPOTHESES_CHANNEL;
    enum rho_status status =
        rho_message_hypotheses_begin(&output->writer, output->buffer, output->capacity, &head);
    if (status == RHO_OK && has_pool) {
        status = add_hypotheses(pool, at, &output->writer);
    } else if (status == RHO_OK) { /* the one hypothesis of a track with a single filter */
        const struct rho_message_hypothesis only = {
            .share = 1.0f,
            .x_m = at->kalman.state[0],
            .y_m = at->kalman.state[1],
            .vx_mps = at->kalman.state[3],
            .vy_mps = at->kalman.state[4],
            .maneuver_probability = at->maneuver_probability,
            .plots = {PLOT_UNKNOWN, PLOT_UNKNOWN, at->plot >= 0 ? at->plot : PLOT_NONE}};
        status = rho_message_hypotheses_add(&output->writer, &only);
    }
    return status;
}
