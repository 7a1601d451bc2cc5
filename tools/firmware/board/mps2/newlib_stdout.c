/* SPDX-License-Identifier: MIT */
/*
 * newlib_stdout: connects newlib's standard output to the debugger (rdimon), for the
 * measuring programs of tools/instructions.
 */
#include <stdio.h>

#include "mps2.h"

/* Defined in newlib's rdimon. */
void initialise_monitor_handles(void);

/* Required by newlib's exit to link; these images never call it. */
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
