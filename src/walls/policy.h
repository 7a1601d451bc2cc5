/* SPDX-License-Identifier: MIT */
/* policy: constants that no physics or parameter sets; tools/gates/mutate.py varies numbers. */
#ifndef RHOTRACK_WALLS_POLICY_H
#define RHOTRACK_WALLS_POLICY_H

/* Both files */

/*
 * Looks in which a track's errors are about alike, so that together they tell what one tells. Half:
 * lines move with the errors of single tracks, tracks that have not settled count, and fewer looks
 * decide. Twice: images of tracks that stay for a short time are not learned from.
 */
#define ALIKE_LOOKS 8

/* Least hits of a confirmed track that may have an image, and looks that judge a witness. */
#define TARGET_HITS ALIKE_LOOKS
#define JUDGED_LOOKS (ALIKE_LOOKS * 3)

/*
 * Sigmas that errors explain: of a pair's distance and angle to a line, of the spread of witnesses'
 * distances, of a body's size. Half: pairs of one wall begin several lines, and two lanes beside
 * each other pass as wall and image. Twice: pairs of two walls are one line.
 */
#define ERROR_SIGMAS 3.0f

/*
 * Sigmas by which two places differ whose errors cannot explain it: a target and its image, a line
 * and another wall.
 */
#define APART_SIGMAS (ERROR_SIGMAS * 2.0f)

/* wall_pairs.c */

/*
 * Most pairs of tracks that are compared in a step. Half: with many tracks it takes twice as many
 * steps until each pair has been compared. Twice: a step costs more.
 */
#define PAIRS_MAX 256u

/*
 * Least hits of a track that may be an image; images are seen less often than targets. Half: false
 * tracks begin lines. Twice: images that are lost soon begin none.
 */
#define IMAGE_HITS 5

/*
 * Limit of chi-square that two tracks are beside each other, at one speed along the line: 99 % of
 * two dimensions. Half: every tenth pair of target and image is left out. Twice: tracks that
 * are not beside each other are taken for pairs.
 */
#define PAIR_CHI2 9.2f

/*
 * Least speed along the line, in sigmas of its component across: the line has its direction from
 * the velocities. Half: lines of slow tracks point anywhere. Twice: slow tracks begin no line.
 */
#define SPEED_SIGMAS 5.0f

/* reflector_learning.c */

/*
 * Images that are looked for in a step, and comparisons of a plot with an image. Half: a line takes
 * twice as many steps to be judged where there are many tracks or plots. Twice: a step costs more.
 */
#define IMAGES_MAX 16u
#define PLOTS_MAX 65536u

/*
 * Pairs of tracks on a line from which it is observed. Half: lines of chance pairs take the looks
 * of others. Twice: a wall with little traffic is learned later.
 */
#define OBSERVED_PAIRS 3.0f

/*
 * Hits at its image that a witness for a line has for each hit beside the image, and one more.
 * Half: traffic beside the wall speaks for a line. Twice: clutter beside an image speaks against.
 */
#define HITS_OF_OTHER 3

/*
 * Witnesses for a wall, and for each witness against it; half of them began after the first. Half:
 * two vehicles that drive in company make a wall. Twice: a wall takes longer to be learned.
 */
#define WALL_WITNESSES 4
#define WALL_LATE_ONES (WALL_WITNESSES / 2)

/* Number of witnesses at which the counts for and against a line are halved. */
#define MEMORY_WITNESSES (WALL_WITNESSES * 4)

#endif
