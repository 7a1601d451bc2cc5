/* SPDX-License-Identifier: MIT */
/*
 * Capacities of this project's rhotrack: the embedded profile, but for what is defined here;
 * rhotrack/config.h says what each costs. Compile rhotrack with -ffp-contract=off.
 */
