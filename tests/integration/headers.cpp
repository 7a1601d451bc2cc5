// SPDX-License-Identifier: MIT
// A C++ program tracks: a target among none, seen every 2 s. Exit code 0 where it is confirmed.
#include <cstdio>
#include <memory>

#include "rhotrack/rhotrack.h"

int main()
{
    // As in C, but for designated initialisers, which C++17 does not have.
    const auto tracker = std::make_unique<rho_tracker>();
    const auto initiator = std::make_unique<rho_initiator>();
    const auto report = std::make_unique<rho_report>();
    rho_tracker_config maintain;
    rho_initiator_config start;

    rho_tracker_config_default(&maintain);
    rho_initiator_config_default(&start);
    if (rho_tracker_init(tracker.get(), sizeof *tracker, &maintain) != RHO_OK ||
        rho_initiator_init(initiator.get(), sizeof *initiator, &start) != RHO_OK) {
        return 1;
    }
    for (int k = 0; k < 8; k++) {
        rho_plot plot{};
        plot.x_m = 500.0f * static_cast<float>(k);
        plot.y_m = 1000.0f;
        plot.sigma_range_m = plot.sigma_cross_m = 10.0f;

        rho_scan scan{};
        scan.time_us = 2000000 * static_cast<int64_t>(k);
        scan.num_plots = 1;
        scan.plots = &plot;
        if (rho_tracker_step(tracker.get(), initiator.get(), &scan, report.get()) != RHO_OK) {
            return 1;
        }
    }
    const rho_track_report &track = report->tracks[0];
    std::printf("tracks: %u; %s, %.0f m/s\n", static_cast<unsigned>(report->num_tracks),
                rho_track_status_name(track.status), static_cast<double>(track.state[3]));
    return report->num_tracks == 1 && track.status == RHO_TRACK_CONFIRMED ? 0 : 1;
}
