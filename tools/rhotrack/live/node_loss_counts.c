/* SPDX-License-Identifier: MIT */
#include "live/node_loss_counts.h"

#include <string.h>

#define MESSAGE_TALLIES 15
#define STEP_TALLIES (NODE_TALLIES - MESSAGE_TALLIES)

/* Collects losses by the network, of messages, and of operators' commands. */
static void collect_tallies(const struct node_core *core, const struct transport *transport,
                            const struct command_gate *gate,
                            struct node_loss_counts tallies[MESSAGE_TALLIES])
{
    const struct rho_scan_assembler_counters *assembler = node_core_assembler_counters(core);
    const struct rho_node_counters *own = node_core_node_counters(core);
    const struct transport_counters network = transport_counters(transport);
    const struct node_loss_counts all[MESSAGE_TALLIES] = {
        {"datagrams refused (fragments, or no LCM)", network.refused, NODE_TALLY_FAULT, false},
        {"datagrams of addresses that are not in sources_allowed", network.refused_source,
         NODE_TALLY_FAULT, false},
        {"datagrams dropped by the kernel (receive buffer full: net.core.rmem_max, recv_buf_size)",
         network.dropped, NODE_TALLY_FAULT, false},
        {"messages not sent", transport_can_send(transport) ? network.not_sent : 0,
         NODE_TALLY_FAULT, false},
        {"messages bad", assembler->messages_bad, NODE_TALLY_FAULT, true},
        {"messages of another type or version", assembler->messages_wrong_type, NODE_TALLY_FAULT,
         true},
        {"messages flooded", assembler->messages_flooded, NODE_TALLY_FAULT, true},
        {"messages of sensors that are not in sensors_allowed", assembler->messages_not_allowed,
         NODE_TALLY_FAULT, true},
        {"messages of too many sensors", assembler->sensors_no_room, NODE_TALLY_FAULT, true},
        {"commands not taken: the node runs without --commands", own->commands_not_allowed,
         NODE_TALLY_FAULT, false},
        {"commands of addresses that are not in --commands-from", gate->from.refused_source,
         NODE_TALLY_FAULT, false},
        {"commands beyond the rate that is taken", gate->beyond, NODE_TALLY_FAULT, false},
        {"commands bad", own->commands_bad, NODE_TALLY_FAULT, false},
        {"commands refused", own->commands_refused, NODE_TALLY_FAULT, false},
        {"commands done", own->commands_done, NODE_TALLY_USUAL, false},
    };

    memcpy(tallies, all, sizeof all);
}

/* Collects counts of scans and steps: late, lost and refused scans, and fates of plots. */
static void collect_scan_and_plot_tallies(const struct node_core *core,
                                          struct node_loss_counts tallies[STEP_TALLIES])
{
    const struct rho_scan_assembler_counters *assembler = node_core_assembler_counters(core);
    const struct rho_tracker_counters *tracker = node_core_tracker_counters(core);
    const struct rho_node_counters *own = node_core_node_counters(core);
    const struct scan_losses losses =
        out_of_sequence_counts_losses(node_core_used_out_of_sequence(core), assembler);
    const struct node_loss_counts all[STEP_TALLIES] = {
        {"scans out of order", losses.out_of_order, NODE_TALLY_USUAL, false},
        {"scans late, dropped", losses.dropped, NODE_TALLY_FAULT, true},
        {"scans double", assembler->scans_duplicate, NODE_TALLY_MAY_FALL, true},
        {"scans double with other contents (two senders of one sensor's number)",
         assembler->scans_other, NODE_TALLY_FAULT, true},
        {"scans that did not wait for hold_ms (no room for more)", own->scans_early,
         NODE_TALLY_USUAL, false},
        {"scans lost", losses.lost, NODE_TALLY_MAY_FALL, true},
        {"scans bad", assembler->scans_bad, NODE_TALLY_MAY_FALL, true},
        {"scans incomplete", assembler->scans_incomplete, NODE_TALLY_FAULT, false},
        {"scans far off the clock", assembler->clock_jumps, NODE_TALLY_MAY_FALL, true},
        {"sensor restarts", assembler->sensor_restarts, NODE_TALLY_USUAL, false},
        {"tracker restarts", own->restarts, NODE_TALLY_USUAL, false},
        {"plots beyond a scan's capacity", assembler->plots_no_room, NODE_TALLY_FAULT, true},
        {"scans refused", own->scans_refused, NODE_TALLY_FAULT, false},
        {"bearing scans refused (places, too many sensors)", own->bearings_refused,
         NODE_TALLY_FAULT, false},
        {"sensors' descriptions refused", own->sensors_refused, NODE_TALLY_FAULT, false},
        {"inputs stale", tracker->fates[RHO_FATE_STALE], NODE_TALLY_FAULT, false},
        {"inputs invalid", tracker->fates[RHO_FATE_INVALID] - tracker->plots_outside,
         NODE_TALLY_FAULT, false},
        {"inputs outside of their sensor's coverage", tracker->plots_outside, NODE_TALLY_USUAL,
         false},
        {"inputs without room", tracker->fates[RHO_FATE_NO_ROOM], NODE_TALLY_USUAL, false},
        {"tracks without room", tracker->tracks_no_room, NODE_TALLY_USUAL, false},
        {"gate plots dropped", tracker->gate_plots_dropped, NODE_TALLY_USUAL, false},
        {"updates refused", tracker->updates_refused, NODE_TALLY_USUAL, false},
        {"hypotheses cut", tracker->hypotheses_cut, NODE_TALLY_USUAL, false},
    };

    memcpy(tallies, all, sizeof all);
}

void node_loss_counts_collect(const struct node_core *core, const struct transport *transport,
                              const struct command_gate *gate,
                              struct node_loss_counts tallies[NODE_TALLIES])
{
    collect_tallies(core, transport, gate, tallies);
    collect_scan_and_plot_tallies(core, tallies + MESSAGE_TALLIES);
}
