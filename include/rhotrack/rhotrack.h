/* SPDX-License-Identifier: MIT */
/*
 * rhotrack: all that programs call, in one include.
 *
 *     #include "rhotrack/rhotrack.h"
 *
 * Scans of plots or bearings go in, tracks come out. Each header below is the manual of its part;
 * types.h states the conventions, settings.h what is to be said of a radar, tracker.h the step.
 * detail/ has what the objects of these embed, and comes with them: detail/recurring_clutter_map.h
 * the echoes of a tracker, detail/kalman.h, detail/measurement.h and detail/track.h parts for
 * programs that build a tracker of their own. Including all costs nothing: functions that a program
 * does not call are not linked. All headers are C99, and C++17 through extern "C".
 */
#ifndef RHOTRACK_RHOTRACK_H
#define RHOTRACK_RHOTRACK_H

#include "rhotrack/config.h"
#include "rhotrack/types.h"

/* Tracking. */
#include "rhotrack/body.h"
#include "rhotrack/initiator.h"
#include "rhotrack/operator.h"
#include "rhotrack/passive.h"
#include "rhotrack/reflectors.h"
#include "rhotrack/settings.h"
#include "rhotrack/snapshot.h"
#include "rhotrack/tracker.h"

/* Scans and tracks as messages. */
#include "rhotrack/command.h"
#include "rhotrack/message.h"
#include "rhotrack/node.h"
#include "rhotrack/publish.h"
#include "rhotrack/scan_assembler.h"
#include "rhotrack/udpm.h"
#include "rhotrack/zones.h"

/* The methods of the papers, to compare with. */
#include "rhotrack/hough.h"
#include "rhotrack/paper_starts.h"
#include "rhotrack/passive_paper.h"

/*
 * The one place where the version of rhotrack stands. Program and packages have it from here, and
 * tests/integration/packages.sh holds tools/python, which states it twice, against it. CHANGELOG.md
 * says what a version promises.
 */
#define RHO_VERSION_MAJOR 0
#define RHO_VERSION_MINOR 9
#define RHO_VERSION_PATCH 0

#endif
