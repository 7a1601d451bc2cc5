/* SPDX-License-Identifier: MIT */
/*
 * library_console: newlib's standard output through the debugger (rdimon), for the jobs of
 * tools/instructions.
 */
#include <stdio.h>

#include "mps2.h"

/* Of newlib's rdimon. */
void initialise_monitor_handles(void);

/* Asked for by newlib's exit, which these images do not end by. */
void _init(void);
void _fini(void);
void _init(void)
{
}
void _fini(void)
{
}

void mps2_open_console(void)
{
    initialise_monitor_handles();
}

void mps2_close_console(void)
{
    fflush(stdout);
    fflush(stderr);
}
