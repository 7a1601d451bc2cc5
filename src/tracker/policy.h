/* SPDX-License-Identifier: MIT */
/* policy: constants that no physics or parameter sets; tools/gates/mutate.py varies numbers. */
#ifndef RHOTRACK_TRACKER_POLICY_H
#define RHOTRACK_TRACKER_POLICY_H

/* sensor_health.c */

/*
 * Memory of a sensor's running means, and the least number that is decided by, in looks or hits.
 * Half: chance makes sensors suspect. Twice: a failure is found after twice as many looks.
 */
#define COMPARED_MAX 16u
#define COMPARED_MIN (COMPARED_MAX * 3u / 4u)
/*
 * Share of other sensors' tracks that a sensor sees, over its pd: below the first it sees too few,
 * above the second enough. Half: a sensor that misses three targets in four stays trusted. Twice:
 * no sensor sees enough to be a witness.
 */
#define SHARE_LOW 0.3f
#define SHARE_GOOD (SHARE_LOW * 2.0f)
/*
 * Mean NIS per dimension of a sensor's plots: above the first the sensor is biased, below the
 * second it agrees. It is 1 in theory, and about 2 with manoeuvres and too small covariances. Half:
 * sensors are suspect as targets turn, or never trusted again. Twice: three sigmas of bias pass.
 */
#define CHI2_HIGH 4.0f
#define CHI2_GOOD 2.5f
/*
 * Largest mean NIS of a witness, over that of the biased sensor: a biased sensor pulls the tracks,
 * so that unbiased sensors look biased, too, but less so. Half: no witness is found. Twice: the
 * biased sensor speaks against the unbiased ones.
 */
#define RIGHTER 0.7f
/*
 * Largest ratio of sigmas at which two sensors' NIS are comparable. Half: equal witnesses do not
 * count. Twice: a coarse sensor, with which all plots agree, counts as a witness.
 */
#define COARSER 1.9f
/* Largest factor on a suspect sensor's sigmas. Half: its bias pulls tracks. Twice: it fits any. */
#define FACTOR_MAX 20.0f

/* sensor_learning.c */

/*
 * Largest probability of the manoeuvring model at which a track teaches noise. Half: calm targets
 * teach little. Twice: manoeuvres are learned as noise.
 */
#define MANEUVER_MAX 0.2f
/*
 * Square of the difference of two innovations at which it is cut, against plots of clutter; the
 * mean below the cut is in update_log_noise. Half or twice: the mean is another one, and stated
 * noise is learned as larger or smaller.
 */
#define CUT2 2.25f
/*
 * The n-th innovation's gain is GAIN / (n + INNOVATIONS_PRIOR). Half: noise is learned at half the
 * speed, or jumps at first. Twice: the factor varies more by chance, or is learned late.
 */
#define GAIN 3.0f
#define INNOVATIONS_PRIOR 40.0f
/*
 * Limit of ln f, either way: 10 times the sigma, as learn_noise_max. Half: noise of three times the
 * stated sigma is not learned. Twice: an ln f beyond use is learned, and returns late.
 */
#define LOG_NOISE_MAX 4.6f
/*
 * Memory: plots and echoes at which sums are halved, innovations at which their count stops; noise
 * is used from a tenth of them on, as ln f then varies by a tenth. Half: less exact. Twice: late.
 */
#define LEARNED_MAX 1000
#define INNOVATIONS_MIN (LEARNED_MAX / 10)
/*
 * Least share of the plot's noise in an innovation's variance; the rest is of the prediction. Half:
 * errors of predictions are learned as noise. Twice: hardly any innovation teaches.
 */
#define NOISE_SHARE_MIN 0.4f
/*
 * Largest ln f, either way, of noise as stated: AS_STATED, and CHANCE over the root of innovations.
 * Half: chance changes noise. Twice: noise of 1.3 times the stated sigma stays unlearned.
 */
#define AS_STATED 0.25f
#define CHANCE 4.0f
/*
 * Largest share of blind looks, per cent, at which a look teaches P_D. Half: slow targets teach
 * nothing. Twice: misses in the notch lower P_D.
 */
#define BLIND_PERCENT_MAX 2

/* bearing_errors.c */

/*
 * Standard errors at which lasting errors are sure. Half: chance takes good bearings away. Twice:
 * tracks are pulled for a minute until they are found.
 */
#define LASTING_SIGMAS 2.0f
/*
 * Time that an error lasts, and most looks in it. Half: a ship that turns once a minute pulls
 * tracks. Twice: errors that last for some seconds take the bearings away.
 */
#define LASTING_S 20.0f
#define LASTING_LOOKS_MAX 1000.0f
/* Square, in sigmas, at which a pair is cut. Half: v is too small. Twice: a false bearing is v. */
#define PAIR_CHI2 16.0f

/* counted_pd.c */

/*
 * Looks that a stated P_D weighs beside those counted, and at which counts are halved. Half: the
 * first misses count for the sensor. Twice: a P_D that is told too high ends the first tracks.
 */
#define STATED_LOOKS 1.0f
#define COUNTED_LOOKS_MAX 2000.0f
/*
 * Looks whose misses count beside a place's; excess that is none. Half: chance makes places. Twice:
 * a sector that sees half ends tracks until it is found.
 */
#define PLACE_LOOKS 6.0f
#define PLACE_SAME 0.1f
/*
 * Speeds at rest: sigmas, and share of the largest speed. Half: some who sit are lost. Twice: who
 * walks slowly teaches no P_D.
 */
#define REST_SIGMAS 2.0f
#define REST_SHARE 0.1f
/* Misses of who rests, a prior; looks. Half: some who sit are lost. Twice: leavers are kept. */
#define REST_MISS 0.5f
#define REST_LOOKS 20.0f
/*
 * Least P_D of a place over that of all. Half: objects that are seldom seen, as echoes of the
 * second time around, pass for targets there. Twice: P_D is never lowered by place.
 */
#define PLACE_LEAST 0.5f
/*
 * P_D of a look whose bearings fill their room, over its usual one. Half: its hits are worth next
 * to nothing. Twice: bearings that were left out count as misses, and end tracks.
 */
#define FULL_SHARE 0.5f
/* Largest learned P_D. Half: hits are worth less. Twice: one miss ends a track. */
#define PD_MOST 0.98f

/* notch_learning.c */

/*
 * Largest pd in a learned notch over that at faster rates: in all its intervals; in the fastest of
 * a new one, filled in part. Half: notches with some plots are not found. Twice: any pd is a notch.
 */
#define BLIND_SHARE 0.65f
#define BLIND_LAST_SHARE 0.85f
/*
 * Above this pd a notch in use loses its fastest interval, as misses count in full there: tracks
 * coast in the notch instead of ending. Half: true notches shrink. Twice: wide ones stay wide.
 */
#define BLIND_USED_SHARE 0.6f
/*
 * Standard deviations by which the pd in a notch is below that at faster rates. Half: chance among
 * many intervals finds notches. Twice: a notch is found after four times the looks.
 */
#define BLIND_SURELY 4.0f
/*
 * Looks needed in a notch; twice as many in an interval that it may lose, three times as many above
 * it. Half: slow targets that fade look like a notch. Twice: a notch is found late.
 */
#define BLIND_LOOKS 20.0f
#define BLIND_USED_LOOKS (BLIND_LOOKS * 2.0f)
#define FASTER_LOOKS (BLIND_LOOKS * 3.0f)
/*
 * Squared upper limit of the first interval of range rates, m^2/s^2; each next one doubles. Half or
 * twice: each interval is another one, and the fastest notch 0.7 or 1.4 times as wide.
 */
#define RATE_MIN2 0.0625f
/* Looks between searches for a notch. Half: twice as many searches. Twice: it is found later. */
#define LOOKS_A_NOTCH 8u
/* Fewest intervals of a notch. Half: stopped targets make one. Twice: none below 2.8 m/s is. */
#define RATES_LEAST 4u

/* coverage.c */

/*
 * Margin of the field of view in standard deviations of the track's place. Half: tracks at its edge
 * lose plots. Twice: tracks far outside are predicted in vain.
 */
#define MARGIN_SIGMAS 8.0f
/*
 * Share of the range in the margin, for biases of the plots. Half: a bias of five per cent loses
 * plots at the edge. Twice: more tracks are predicted in vain.
 */
#define MARGIN_SHARE 0.05f
/*
 * Standard deviations of its noise that a plot may lie outside of the stated coverage: half of a
 * track's, which targets leave as they turn. Half: one plot in forty at the edge is lost. Twice:
 * clutter outside of the coverage is taken.
 */
#define PLOT_SIGMAS (MARGIN_SIGMAS / 2.0f)

/* blind_looks.c */

/* pd of a target in the Doppler notch. Half or twice: a plot there weighs less or more by ln 2. */
#define NOTCH_PD 0.03f
/*
 * Expected clutter plots in its gate up to which a track coasts in the notch. Half: tracks end in
 * thin clutter. Twice: they claim clutter and drift away.
 */
#define COAST_CLUTTER_MAX 3.0f
/*
 * Longest time without a plot for which a track may coast in the notch; then it is rather gone.
 * Half: targets that wait long lose their identity. Twice: tracks of targets that have gone stay.
 */
#define BLIND_MAX_S 300.0f

/* unseen_tracks.c */

/*
 * Weight of the newest interval in a smoothed scan interval. Half: changes of an antenna's speed
 * are followed late. Twice: one odd scan moves the interval by half.
 */
#define INTERVAL_SMOOTHING 0.25f
/*
 * Weights of the newest time between a track's hits: if shorter; if longer, as by missed scans.
 * Half: the first gap lasts. Twice: misses lengthen the interval, and tracks coast too long.
 */
#define SHORTER_SMOOTHING (INTERVAL_SMOOTHING * 2.0f)
#define LONGER_SMOOTHING (INTERVAL_SMOOTHING / 4.0f)
/* Longest new interval over the smoothed one. Half: none ever grows. Twice: an outage counts. */
#define INTERVAL_LONGEST 2.0f
/*
 * Scan intervals without a look in the fixed direction after which another one is chosen. Half: a
 * short outage changes the direction. Twice: a new sector's interval is known late.
 */
#define INTERVALS_GONE 16.0f
/* Scan intervals that a look may be late. Half: jitter ends tracks. Twice: gone targets stay. */
#define OVERDUE 0.5f
/*
 * Scan intervals by which a track that no sensor covers ends before coast_scans_max of them. Half:
 * some end a scan late. Twice: all end more than a scan early.
 */
#define JITTER 0.7f
/*
 * Factor on the coasting time of a track whose place a sensor covers, but does not look at. Half:
 * beams that return late find no track. Twice: tracks of targets that have gone stay.
 */
#define UNLOOKED 4.0f

/* seldom_seen.c */

/*
 * Detection probability of a seldom seen object over that of a target; and the evidence of a hit,
 * ln(1 / SELDOM). Half or twice: hits weigh too little or too much against misses.
 */
#define SELDOM 0.3f
#define HIT_NAT 1.2039728f
/*
 * Wanted number of true tracks for each false one. Half: one confirmed track in six is false.
 * Twice: targets are confirmed later where aircraft come and go.
 */
#define TRUE_PER_FALSE 10.0f
/* Prior number of established tracks. Half: the others weigh more. Twice: more false ones come. */
#define ESTABLISHED_PRIOR 2.0f
/*
 * Standard deviations by which the count of seldom seen tracks may exceed its mean. Half: chance
 * asks for evidence. Twice: clear excess is found later.
 */
#define EXCESS_SIGMAS 0.5f
/*
 * Time in which the counts of seldom seen and of established tracks fade to 1/e. Half: they are
 * small, and vary by chance. Twice: after a front has passed, confirmation stays slow for an hour.
 */
#define MEMORY_S 1600.0f
/*
 * Prior weight of the stated P_D in that of established tracks, in looks. Half: the first misses
 * make objects of targets. Twice: a P_D that is told too high hides targets for longer.
 */
#define PRIOR_LOOKS 10.0f
/*
 * Evidence below which a track is of an object that is seldom seen: a hit less. Half: targets of a
 * lower P_D than told count. Twice: objects are found late, and more of them are shown.
 */
#define SELDOM_NAT (-HIT_NAT)

/* track_life.c */

/*
 * Wald's lower threshold below the start score, ln 100: loses one true track in a hundred. Half:
 * one in ten is lost. Twice: tentative tracks of clutter live twice as long.
 */
#define TENTATIVE_FALL_MNAT 4605
/*
 * Mean times until a target leaves, and until it is hidden, before any is learned, in scan
 * intervals. Half: two misses hide a track. Twice: targets that have gone are shown for longer.
 */
#define LIFETIME_SCANS 200.0f
/* Scans that weigh as much. Half: few tracks set the rates. Twice: they are learned in hours. */
#define LIFE_PRIOR_SCANS (2.0f * LIFETIME_SCANS)
/*
 * Mean time of hiding over coast_scans_max scan intervals. Half: returning targets get new tracks.
 * Twice: lost tracks of turning targets stay beside new ones.
 */
#define HIDDEN_SHARE 0.7f
/*
 * Odds of existence at the confirm threshold; ln of the largest factor on them, as the score knows
 * no images. Half: one miss hides a new track. Twice: clutter is shown for one miss longer.
 */
#define CONFIRMED_ODDS 5.0f
#define START_MAX_NAT 1.5f
/*
 * Probability of existence from which on a track that was confirmed is shown, and is shown again.
 * Half: targets that have gone are shown twice as long. Twice: two misses hide a track.
 */
#define SHOWN 0.48f
#define SHOWN_AGAIN 0.8f
/* Below it a track ends. Half: it takes new targets' first plots. Twice: targets return to none. */
#define ENDED 0.02f
/*
 * Share of targets that a look can see above which it is 1. Half: clutter draws tracks of hidden
 * targets away. Twice: each look costs two logarithms a track, for the same tracks.
 */
#define SURELY_VISIBLE 0.95f
/* Probability of a blind look; of another. Half: fewer tracks are spared. Twice: lost ones, too. */
#define BLIND_PRIOR 0.005f
#define BLIND_STAYS 0.8f
/*
 * Clutter plots expected in an updated gate above which the place is unknown, and not shown. Half:
 * tracks in dense clutter are hidden. Twice: places off by the gate are shown.
 */
#define PLACE_CLUTTER_MAX 1.0f

/* manoeuvre_interval.c */

/*
 * Weight of the default mean time between manoeuvres, in manoeuvres seen. Half: calm_s is doubled
 * after few straight tracks. Twice: hours of straight tracks teach little.
 */
#define MANOEUVRES_PRIOR 4.0f
/*
 * Probability of the manoeuvring model above which a target surely manoeuvres. Half: noise counts
 * as manoeuvres. Twice: nothing does, and calm_s grows always.
 */
#define TURNS_SURELY 0.9f

/* expected_clutter.c */

/*
 * Weight of the newest scan in a smoothed count of plots: a memory of ten scans. Half: the density
 * follows changing clutter later. Twice: it follows the scatter of single scans.
 */
#define NEWEST_SCAN_WEIGHT 0.1f
/*
 * Radius of the circle that stands for a track's gate, sigmas of the track's place: all but one
 * per cent of its plots. Half: a quarter of the clutter is expected there. Twice: four times.
 */
#define GATE_CIRCLE_SIGMAS 3.0f

/* track_life.c, echo_clutter.c, second_plots.c */

/*
 * Hits from which a track that moves is of a target, and above which no track is taken for a second
 * one. Half: tracks of clutter take their returns out of the map. Twice: targets' plots stay in the
 * map for longer, and a neighbouring target's track may still end.
 */
#define TARGET_TRACK_HITS 12
/*
 * Sigmas by which a track has left its start; five are too few with clutter among its plots. Half:
 * wandering tracks of clutter count as moved. Twice: slow targets stay in the map for longer.
 */
#define MOVED_SIGMAS 8.0f
/*
 * Weight of the prior of a learned rate, in looks or plots: of exact range rates, of a sensor's
 * second plots, and of its rate in that of a track. Half: the first plots decide. Twice: sensors
 * that differ from the prior are learned later.
 */
#define RATE_PRIOR_LOOKS 10.0f

/* echo_clutter.c */

/*
 * Limit of the NIS of an echo's plot: e^-9 is cut off. Half: plots of an echo's edge raise no
 * density. Twice: nothing changes but the work, as the density there is nearly 0.
 */
#define ECHO_CHI2 18.0f
/*
 * Largest variance of an echo's place, as a share of its sensor's squared maximum range: a tenth of
 * the range. Half: echoes are forgotten in shorter silences. Twice: lost echoes cost work.
 */
#define ECHO_UNKNOWN_SHARE 0.01f
/*
 * Least share of the clutter density at a plot that an echo must explain to be updated with it.
 * Half: echoes are updated with chance plots. Twice: weak echoes start anew beside their place.
 */
#define ECHO_WEIGHT_MIN 0.3f
/*
 * Share of echoes' plots with exactly the range rate of the echo's own speed, before it is learned.
 * Half: masts are learned later. Twice: so are trees and water.
 */
#define ECHO_EXACT_PRIOR 0.3f
/*
 * Sigma of the range rates of half the other plots; the rest have any rate. Half: the rates of
 * swaying trees count as any. Twice: targets as slow as 2 m/s count as echoes.
 */
#define ECHO_RATE_SIGMA_MPS 1.0f
/*
 * Plots of three neighbouring directions above which a jammer's strobe is sought, and times the
 * usual number that they must exceed. Half: roads and coasts that run towards the sensor are
 * strobes. Twice: weak strobes start tracks.
 */
#define STROBE_PLOTS_MIN 8.0f
#define STROBE_TIMES_USUAL 6.0f
/*
 * Parts of the range, three quarters of which a strobe fills. Half: a few clusters in one direction
 * are a strobe. Twice: none is found, as the clutter map has a byte for the parts with plots.
 */
#define STROBE_RANGES 8u
#define STROBE_RANGES_MIN (STROBE_RANGES * 3u / 4u)

/* second_plots.c */

/*
 * Weight of the prior shares of distances, in plots. Half: the first second plots decide on the
 * distances. Twice: a sensor's own distances are learned later.
 */
#define SECOND_BINS_PRIOR 4.0f
/*
 * Second plots of a claimed plot before any is learned. Half: the first second plots start tracks.
 * Twice: targets beside others start later at first.
 */
#define SECOND_RATE_PRIOR 0.01f
/*
 * Looks at which a track's sums are halved: its aspect changes faster than the sensor. Half: the
 * rate scatters. Twice: it lags behind a target that turns.
 */
#define TRACK_LOOKS_REMEMBERED 50.0f
/*
 * Fewest hits of a track that teaches second plots: a neighbouring target has a track of its own by
 * then. Half: neighbours count as second plots. Twice: short tracks teach nothing.
 */
#define TEACHER_HITS 8
/*
 * ln of the odds that two tracks are of one target: above it the younger track ends; also the
 * largest change by one scan. Half: tracks of close targets end. Twice: second tracks stay longer.
 */
#define ONE_TARGET_END_NAT 3.0f
/*
 * Lower bound of these odds. Half: targets that were apart for long are one after a short approach.
 * Twice: a second track that once looked like a target stays longer.
 */
#define ONE_TARGET_LEAST_NAT (-4.0f)
/*
 * Evidence for one target by a merged plot, to which two near targets come, too. Half: two tracks
 * that share all plots stay longer. Twice: crossing targets lose a track.
 */
#define MERGED_NAT 0.3f
/*
 * Evidence for one target where the younger track has no plot, and the older one's is outside its
 * gate. Half: second tracks without plots stay longer. Twice: two misses end a new track.
 */
#define YOUNGER_MISS_NAT 1.0f

/* work_budget.c */

/*
 * One half of a phase is reserved for the tracks that wait, in even shares. Half (all of it): dense
 * places get no more than empty ones. Twice (a quarter): the last tracks score few plots.
 */
#define KEPT_PARTS 2u
/*
 * A track takes at most a quarter of the rest. Half: the first two tracks take most of it. Twice:
 * tracks in dense places score few of their plots although work is left.
 */
#define FREE_PARTS 4u
/*
 * Units of work, as measured: a plot scored by one hypothesis, in addition to move the hypothesis
 * to the plot's own time; the gate of a Kalman filter; in addition for a measured velocity in two
 * or three axes; an echo and a plot near it, and their range rates; a pair of plots near each
 * other; the image of a track, and a plot tested against an image.
 */
enum {
    SCORE_UNITS = 20,
    MOVE_UNITS = 60,
    GATE_UNITS = 12,
    VELOCITY_UNITS = 70,
    VELOCITY_3D_UNITS = VELOCITY_UNITS * 2,
    ECHO_UNITS = 4,
    ECHO_RATE_UNITS = 6,
    SECOND_UNITS = 12,
    IMAGE_UNITS = 12,
    IMAGE_TEST_UNITS = 3
};

/* resolution_cell.c */

/*
 * Weight of the default cell, and from which a learned cell is reported, in squared slopes of
 * pairs. Half: the first pairs decide on the cell. Twice: the cell is learned later.
 */
#define CELL_WEIGHT_FIRST 4.0f
/* Largest weight that pairs add up to. Half: the cell scatters more. Twice: it follows later. */
#define CELL_WEIGHT_MAX 200.0f
/*
 * Limit of the logarithm of a learned cell either way: cells of 0.3 to 19 sigmas. Half: only cells
 * of 0.8 to 7 sigmas are learned. Twice: wrong pairs may drive the cell to any size.
 */
#define CELL_LOG_MAX 4.2f

/* reflectors.c */

/*
 * Sigmas of a track's place by which the line of sight to its image may miss the wall. Half: images
 * at a wall's ends start tracks. Twice: plots beside the wall count as ghosts.
 */
#define BESIDE_WALL_SIGMAS 3.0f
/*
 * Fewest hits of a track whose images are looked for; one with fewer may be of clutter. Half: plots
 * at images of clutter start no tracks. Twice: images start tracks before their targets count.
 */
#define IMAGED_HITS 3
/*
 * Limit of the NIS of a track and an image in place and velocity: the 99.9 % quantile of chi-square
 * in four dimensions. Half: tracks of images stay. Twice: targets near images end.
 */
#define IMAGE_CHI2 18.5f
/*
 * Hits over looks below which also an established track may be an image. Half: images that are
 * often seen stay. Twice: every track that agrees with an image ends.
 */
#define IMAGE_SHARE 0.6f

#endif
