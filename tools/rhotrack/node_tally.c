/* SPDX-License-Identifier: MIT */
#include "node_tally.h"

void node_tally(const struct node_core *core, const struct transport *transport,
                struct node_tally tallies[NODE_TALLIES])
{
    const struct rho_feed_counters *feed = node_core_feed(core);
    const struct rho_frames_counters *frames = node_core_frames(core);
    const struct rho_tracker_counters *tracker = node_core_tracker(core);
    const struct node_core_counters *own = node_core_counters(core);
    struct transport_counters network = transport_counters(transport);
    const struct node_tally all[NODE_TALLIES] = {
        {"datagrams refused (fragments, or no LCM)", network.refused, true},
        {"datagrams dropped by the kernel (receive buffer full: net.core.rmem_max, recv_buf_size)",
         network.dropped, true},
        {"messages not sent", transport_can_send(transport) ? network.not_sent : 0, true},
        {"messages bad", feed->messages_bad, true},
        {"messages of another type or version", feed->messages_wrong_type, true},
        {"messages flooded", feed->messages_flooded, true},
        {"messages of too many sensors", feed->sensors_no_room, true},
        {"scans late", feed->scans_late, true},
        {"scans double", feed->scans_duplicate, true},
        {"scans that did not wait for hold_ms (no room for more)", own->scans_early, false},
        {"scans lost", feed->scans_lost, true},
        {"scans bad", feed->scans_bad, true},
        {"scans incomplete", feed->scans_incomplete, true},
        {"scans far off the clock", feed->clock_jumps, true},
        {"sensor restarts", feed->sensor_restarts, true},
        {"tracker restarts", own->restarts, true},
        {"plots beyond a scan's capacity", feed->plots_no_room, true},
        {"scans refused", own->scans_refused, true},
        {"frames refused", own->frames_refused, true},
        {"bearing scans refused (places, too many sensors)", own->bearings_refused, true},
        {"sensors' descriptions refused", own->sensors_refused, true},
        {"bearing scans late", frames->scans_late, true},
        {"bearing scans far off the clock", frames->scans_off_clock, true},
        {"frames incomplete", frames->frames_incomplete, false},
        {"bearings beyond a scan's capacity", frames->bearings_no_room, false},
        {"inputs stale", tracker->fates[RHO_FATE_STALE], true},
        {"inputs invalid", tracker->fates[RHO_FATE_INVALID], true},
        {"inputs without room", tracker->fates[RHO_FATE_NO_ROOM], false},
        {"tracks without room", tracker->tracks_no_room, false},
        {"gate plots dropped", tracker->gate_plots_dropped, false},
        {"updates refused", tracker->updates_refused, false},
        {"hypotheses cut", tracker->hypotheses_cut, false},
    };

    for (int i = 0; i < NODE_TALLIES; i++) {
        tallies[i] = all[i];
    }
}
