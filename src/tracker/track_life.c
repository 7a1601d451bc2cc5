/* SPDX-License-Identifier: MIT */
/*
 * track_life: the probability that a track's target exists, and what follows from it.
 *
 *                 hide                     A target is visible, hidden behind something, or gone.
 *      visible <--------> hidden           Time passes between looks by the rates of a chain in
 *         |      appear     |              continuous time; its unit is the scan interval of the
 *         | death           | death        slowest sensor that sees the track, so that a fast
 *         v                 v              sensor beside it makes no target die sooner.
 *                gone
 *
 * A look tells G, the likelihood of what it saw near the track over that of clutter alone. It was
 * scored with P_D times the share of such targets that it can see (rho_life_detection), as misses
 * of a hidden target are no evidence, and clutter must not draw its track away. So G is that of an
 * existing target, and with it, of a visible target's L = 1 + (G - 1) / share,
 *
 *      visible' = visible L / N     hidden' = hidden / N     N = 1 + visible (L - 1)
 *
 * Whose miss is it? Where a sensor sees nothing, all its tracks are missed at once. A look is blind
 * with a small probability, and says nothing then; given all looks at established tracks the odds
 * of it are prior / (1 - prior) over the product of their N. Another one probably follows, scored
 * with a lower P_D. Targets may leave together: tracks are spared for coast_scans_max scans.
 *
 * Rates of death and hiding are learned over half an hour: scans that established tracks lived,
 * ends, and expected returns. A track in doubt is kept, unlisted, until it has next to no chance:
 * that costs nothing, and a return teaches.
 *
 * From the probabilities follow a track's status, once its score has confirmed it, and its end.
 * What the chain does not know stands beside it: seldom_seen.c, unseen_tracks.c, and places here.
 */
#include "clutter.h"
#include "plots.h"
#include "policy.h"
#include "rhotrack/detail/approx.h"
#include "sight.h"
#include "step.h"

/* Odds beyond which a look surely sees; largest probability of hiding or of detection. */
#define SURELY_SEES 1e12f
#define SURE_MISS 0.999f

void rho_life_end(const struct step *step, struct rho_track *track)
{
    struct rho_report *report = step->report;
    if (track->was_confirmed) {
        report->ended[report->num_ended++] = track->track_id;
    }
    rho_pd_take_back(&step->look, track);
    rho_track_free_hypotheses(track, &step->look.model);
    rho_track_apply_event(track, RHO_TRACK_DROP);
    step->tracker->counters.tracks_ended = rho_count(step->tracker->counters.tracks_ended, 1);
}

unsigned rho_tracker_find_row(const struct rho_tracker *tracker, uint32_t track_id)
{
    unsigned row = 0;
    while (row < tracker->num_tracks && (tracker->tracks[row].track_id != track_id ||
                                         tracker->tracks[row].status == RHO_TRACK_FREE)) {
        row++;
    }
    return row < tracker->num_tracks ? row : RHO_MAX_TRACKS;
}

void rho_life_remove_ended(struct rho_tracker *tracker)
{
    unsigned live = 0;
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        if (tracker->tracks[i].status != RHO_TRACK_FREE) {
            if (RHO_KEEPS_OFFERS) {
                rho_assignment_move_pairs(&tracker->assignment, i, live);
            }
            tracker->tracks[live++] = tracker->tracks[i];
        }
    }
    tracker->num_tracks = (uint16_t)live;
    if (RHO_KEEPS_OFFERS && tracker->assignment.num_rows > live) {
        tracker->assignment.num_rows = (uint16_t)live;
    }
}

int32_t rho_life_least_mnat(const struct rho_tracker *tracker)
{
    return tracker->start_mnat - TENTATIVE_FALL_MNAT;
}

static float limited_exp(float nat)
{
    return rho_exp(rho_smaller(rho_larger(nat, -RHO_LOOK_LIMIT_NAT), RHO_LOOK_LIMIT_NAT));
}

float rho_life_at_start(int32_t score_mnat, int32_t confirm_mnat)
{
    const float nat = rho_smaller(0.001f * (float)(score_mnat - confirm_mnat), START_MAX_NAT);
    const float odds = CONFIRMED_ODDS * limited_exp(nat);
    return odds / (1.0f + odds);
}

void rho_life_begin(struct rho_track *track, int64_t time_us, int32_t confirm_mnat)
{
    track->visible = rho_life_at_start(track->score_mnat, confirm_mnat);
    track->hidden = 0.0f;
    track->lived_us = time_us;
    track->look_nat = 0.0f;
    track->seen_nat = (float)track->hits * HIT_NAT;
    track->missed = 0.0f;
    track->unseen = 0.0f;
    track->rest_miss = REST_MISS;
    track->seen_share = 1.0f;
    track->start_m[0] = track->kalman.state[0];
    track->start_m[1] = track->kalman.state[1];
    track->start_sigma_m = rho_track_sigma_m(track);
}

/* Notes, at a plot, whether the track has surely left the place where it started. */
static void note_move(const struct rho_look *look, struct rho_track *track)
{
    if (!track->has_moved && look->scan && look->teaches && track->plot >= 0 &&
        track->was_confirmed && track->hits >= TARGET_TRACK_HITS) {
        const float far_m = MOVED_SIGMAS * (rho_track_sigma_m(track) + track->start_sigma_m);
        const float dx_m = track->kalman.state[RHO_X] - track->start_m[0],
                    dy_m = track->kalman.state[RHO_Y] - track->start_m[1];
        track->has_moved = dx_m * dx_m + dy_m * dy_m > far_m * far_m;
    }
}

struct rho_tracker_life rho_tracker_life(const struct rho_tracker *tracker)
{
    if (!tracker || !rho_tracker_is_ready(tracker)) {
        return (struct rho_tracker_life){0};
    }
    const float lived = tracker->lived + LIFE_PRIOR_SCANS;
    const float death = (tracker->gone + LIFE_PRIOR_SCANS / LIFETIME_SCANS) / lived;
    return (struct rho_tracker_life){
        .death = death,
        .hide = (tracker->returned + LIFE_PRIOR_SCANS / LIFETIME_SCANS) / lived,
        .appear = 1.0f / (HIDDEN_SHARE * (float)tracker->config.coast_scans_max),
        .lived_scans = tracker->lived,
    };
}

/* Share of targets like this one that the look can see: not hidden, and the look not blind. */
static float seeing_share(const struct rho_look *look, const struct rho_track *track)
{
    const float both = track->visible + track->hidden;
    const float sees = look->row && track->was_confirmed ? 1.0f - look->row->blind : 1.0f;
    const float share = both > 0.0f ? sees * track->visible / both : 1.0f;
    return share < SURELY_VISIBLE ? rho_larger(share, 1e-6f) : 1.0f;
}

/* Lets time go by until the look's: the target may have gone, become hidden or visible. */
static void pass_time(struct rho_tracker *tracker, const struct rho_look *look,
                      const struct rho_tracker_life *rates, struct rho_track *track)
{
    const float dt_s = rho_seconds_between(track->lived_us, look->time_us);
    track->appeared = 0.0f;
    if (dt_s > 0.0f) {
        const float interval_s = rho_unseen_interval_s(look, track);
        const float scans = interval_s > 0.0f ? dt_s / interval_s : 1.0f;
        const float both = track->visible + track->hidden;
        /* an operator who declares a notch says that targets stay in it */
        const float lived = rho_notch_is_mostly_blind(track) ? 0.0f : scans;
        const float exists = both * rho_exp(-rates->death * lived);
        const float was_hidden = both > 0.0f ? track->hidden / both : 0.0f;
        const float settled = rates->hide / (rates->hide + rates->appear);
        const float stays = rho_exp(-(rates->hide + rates->appear) * scans);
        /* the score of a track that was never confirmed has to fall by all misses */
        const float is_hidden =
            track->was_confirmed ? rho_smaller(settled + (was_hidden - settled) * stays, SURE_MISS)
                                 : 0.0f;
        track->hidden = exists * is_hidden;
        track->visible = exists * (1.0f - is_hidden);
        track->appeared = was_hidden * (1.0f - settled) * (1.0f - stays) / (1.0f - is_hidden);
        track->lived_us = look->time_us;
        tracker->lived += rho_life_is_established(track) ? lived : 0.0f;
    }
    track->seen_share = seeing_share(look, track);
}

void rho_life_pass(struct rho_tracker *tracker, const struct rho_look *look)
{
    const struct rho_tracker_life rates = rho_tracker_life(tracker);
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        struct rho_track *track = &tracker->tracks[row];
        if (track->status != RHO_TRACK_FREE && !rho_track_is_frozen(track)) {
            pass_time(tracker, look, &rates, track);
        }
    }
}

struct detection rho_life_detection(const struct rho_track *track, struct detection visible)
{
    if (track->seen_share < 1.0f) {
        const float pd = track->seen_share * rho_exp(visible.log_pd);
        const float miss = rho_exp(visible.log_miss); /* in a notch not 1 - pd */
        return (struct detection){rho_log(pd), rho_log(1.0f - track->seen_share * (1.0f - miss))};
    }
    return visible;
}

static int was_looked_at(const struct rho_track *track)
{
    return track->status != RHO_TRACK_FREE && (track->look_nat > 0.0f || track->look_nat < 0.0f);
}

/*
 * L - 1 of a visible target; ratio: G (top of file). It is that of a miss at least: hypotheses that
 * are dropped make G smaller, and L would be negative.
 */
static float visible_gain(const struct rho_track *track, float ratio)
{
    return rho_larger((ratio - 1.0f) / track->seen_share, -SURE_MISS);
}

/* Probability that the look was blind, by all established tracks (top of file). */
static float blind_probability(const struct rho_look *look)
{
    const struct rho_tracker *tracker = look->tracker;
    const float prior = rho_larger(look->row ? look->row->blind : 0.0f, BLIND_PRIOR);
    float seeing = (1.0f - prior) / prior; /* odds */
    for (unsigned row = 0; row < tracker->num_tracks && seeing < SURELY_SEES; row++) {
        const struct rho_track *track = &tracker->tracks[row];
        if (was_looked_at(track) && rho_life_is_established(track)) {
            seeing *= 1.0f + track->visible * visible_gain(track, limited_exp(track->look_nat));
        }
    }
    return 1.0f / (1.0f + seeing);
}

/* Counts for P_D; and evidence that it is a target, not an object that is seldom seen. */
static void count_seen_or_missed(const struct rho_look *look, struct rho_track *track, float ratio,
                                 float seeing, float pd_most)
{
    if (look->row && track->was_confirmed) {
        rho_pd_count_place(look, track, seeing * track->visible, ratio);
    }
    if (ratio > 1.0f) {
        /* likelihood of what the look saw with a target over that with an object seldom seen */
        track->seen_nat += rho_log(ratio / (1.0f + SELDOM * (ratio - 1.0f)));
    } else {
        /* in misses by the sensor that sees most; the square: about as the logarithms */
        const float share = (1.0f - ratio) / pd_most;
        track->missed += seeing * share * share;
    }
}

void rho_life_weigh(struct rho_tracker *tracker, const struct rho_look *look)
{
    const float blind = blind_probability(look), pd_most = rho_pd_most(look);
    if (look->row && look->teaches) {
        look->row->blind = BLIND_STAYS * blind;
    }
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        struct rho_track *track = &tracker->tracks[row];
        if (was_looked_at(track)) {
            const float ratio = limited_exp(track->look_nat);
            const float gain = visible_gain(track, ratio);
            const float sum = 1.0f + track->visible * gain;
            if (look->scan && look->teaches) { /* bearings do not tell one object from another */
                count_seen_or_missed(look, track, ratio, 1.0f - blind, pd_most);
                const float seen = ratio > 1.0f ? track->visible * (1.0f + gain) / sum : 0.0f;
                tracker->returned += rho_life_is_established(track) ? track->appeared * seen : 0.0f;
            }
            /* a blind look spares a track for as long as it may coast; else it is rather gone */
            const float spared =
                track->misses_in_row > tracker->config.coast_scans_max ? 0.0f : blind;
            track->visible *= spared + (1.0f - spared) * (1.0f + gain) / sum;
            track->hidden *= spared + (1.0f - spared) / sum;
            track->visible = rho_smaller(track->visible, 1.0f - track->hidden); /* rounding */
            track->look_nat = 0.0f;
        }
    }
}

void rho_life_apply(const struct step *step, struct rho_track *track, int32_t confirm_mnat)
{
    struct rho_tracker *tracker = step->tracker;
    const float exists = rho_track_existence(track);
    const int was_confirmed = track->was_confirmed;
    note_move(&step->look, track);
    rho_evidence_count(step, track);
    if (was_confirmed ? exists < ENDED : track->score_mnat < rho_life_least_mnat(tracker)) {
        tracker->gone += rho_life_is_established(track) ? 1.0f : 0.0f;
        rho_life_end(step, track);
        return;
    }
    const float least = track->status == RHO_TRACK_TENTATIVE ? SHOWN_AGAIN : SHOWN;
    const int is_shown =
        !rho_evidence_is_lacking(step, track) &&
        (was_confirmed ? exists >= least
                       : track->score_mnat >= confirm_mnat && track->misses_in_row == 0);
    track->was_confirmed |= (uint8_t)is_shown;
    tracker->counters.tracks_confirmed =
        rho_count(tracker->counters.tracks_confirmed, is_shown && !was_confirmed ? 1 : 0);
    rho_track_apply_event(track, is_shown ? RHO_TRACK_CONFIRM : RHO_TRACK_DOUBT);
}

void rho_life_doubt_places(struct rho_tracker *tracker, const struct rho_look *look)
{
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        struct rho_track *track = &tracker->tracks[row];
        const float *p = track->kalman.covariance; /* usually it is as narrow as a plot */
        if (track->time_us == look->time_us && !rho_track_is_frozen(track) &&
            p[RHO_AT(0, 0)] + p[RHO_AT(1, 1)] > 2.0f * look->sigma_max_m * look->sigma_max_m &&
            rho_clutter_in_gate(look, track) > PLACE_CLUTTER_MAX) {
            rho_track_apply_event(track, RHO_TRACK_DOUBT);
        }
    }
}

int rho_life_is_sound(const struct rho_track *track)
{
    return rho_is_within(track->visible + track->hidden, 0.0f, 1.00001f) &&
           rho_is_within(track->visible, 0.0f, 1.0f) && rho_is_within(track->hidden, 0.0f, 1.0f) &&
           rho_is_within(track->appeared, 0.0f, 1.0f) &&
           rho_is_within(track->seen_share, 1e-30f, 1.0f) &&
           rho_is_within(track->look_nat, -1e9f, 1e9f) &&
           rho_is_within(track->seen_nat, 0.0f, 1e9f) && rho_is_within(track->missed, 0.0f, 1e9f) &&
           rho_is_within(track->unseen, 0.0f, 1e9f) &&
           rho_is_within(track->rest_miss, 0.0f, 1.0f) && rho_are_finite(track->start_m, 2) &&
           rho_are_finite(&track->start_sigma_m, 1) && rho_is_stored_time(track->lived_us);
}
