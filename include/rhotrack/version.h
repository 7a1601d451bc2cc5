/* SPDX-License-Identifier: MIT */
/*
 * version: the one place where the version of rhotrack stands. Program and packages have it from
 * here, and tests/integration/packages.sh holds tools/python, which states it twice, against it.
 * CHANGELOG.md says what a version promises.
 */
#ifndef RHOTRACK_VERSION_H
#define RHOTRACK_VERSION_H

#define RHO_VERSION_MAJOR 0
#define RHO_VERSION_MINOR 1
#define RHO_VERSION_PATCH 0

#endif
