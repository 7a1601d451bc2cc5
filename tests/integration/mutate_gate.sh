#!/bin/bash
# SPDX-License-Identifier: MIT
# tools/gates/mutate.py takes each number of a table of policy, and elsewhere those that are policy.
# Runs beside others.
here=$(realpath "$(dirname "$0")")
# shellcheck source=tests/integration/checks.bash
. "$here/checks.bash"
gate=$(realpath "$here/../../tools/gates/mutate.py")

mkdir -p tree/src/seed
cat >tree/src/seed/policy.h <<'END'
#define RHOTRACK_POLICY_H
/* Half: a. Twice: b. */
#define SHARE_MIN 0.5f
#define LOOKS_MAX 3u /* looks */
#define WORST_NAT (-20.0f)
#define FIRST_BITS 1
#define FAR_M 1.0e12f
#define NO_SHARE 0.0f
#define LOOKS_MORE (2 * LOOKS_MAX)
END
cat >tree/src/seed/seed.c <<'END'
#define SEED_MAGIC 0x5u
#define FAR_M 1.0e12f
#define LOOK_BITS 4
#define GATE 9.0f
static const float decay = 0.9f;
static const float least = -0.9f;
    if (plot >= 0) {
END
"$gate" --list tree >mutants
cat >expected <<'END'
src/seed/policy.h:3: SHARE_MIN 0.5 -> 1.0
src/seed/policy.h:3: SHARE_MIN 0.5 -> 0.25
src/seed/policy.h:4: LOOKS_MAX 3 -> 6
src/seed/policy.h:4: LOOKS_MAX 3 -> 1
src/seed/policy.h:5: WORST_NAT 20.0 -> 40.0
src/seed/policy.h:5: WORST_NAT 20.0 -> 10.0
src/seed/policy.h:6: FIRST_BITS 1 -> 2
src/seed/policy.h:7: FAR_M 1.0e12 -> 2e+12
src/seed/policy.h:7: FAR_M 1.0e12 -> 5e+11
src/seed/seed.c:4: GATE 9.0 -> 18.0
src/seed/seed.c:4: GATE 9.0 -> 4.5
src/seed/seed.c:5: decay 0.9 -> 1.8
src/seed/seed.c:5: decay 0.9 -> 0.45
src/seed/seed.c:7: plot 0 -> 1
END
check 'the mutants of a tree' diff expected mutants
check 'of the sources there are many' test "$("$gate" --list | wc -l)" -gt 100
check 'some of them only' test "$("$gate" --list tree --only GATE | wc -l)" -eq 2
finish
