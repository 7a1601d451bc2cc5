/* SPDX-License-Identifier: MIT */
/*
 * wire: encodes, decodes, validates, assembles or publishes one full message;
 * tools/gates/instructions.sh counts the instructions. The argument is encode, decode, validate,
 * take or publish. Prints the message's size in bytes.
 */
#include <stdlib.h>
#include <string.h>

#include "count.h"
#include "rhotrack/message.h"
#include "rhotrack/publish.h"
#include "rhotrack/scan_assembler.h"

static struct rho_message_plot_scan scan;
static struct rho_report report;
static struct rho_scan_assembler assembler;
static uint8_t bytes[RHO_MESSAGE_PLOT_SCAN_MAX_SIZE];
static size_t size;
static enum rho_status status;

static void encode_scan(void)
{
    status = rho_message_plot_scan_encode(&scan, bytes, sizeof bytes, &size);
}

static void decode_scan(void)
{
    status = rho_message_plot_scan_decode(bytes, size, &scan);
}

static void validate_scan(void)
{
    status = rho_message_plot_scan_validate(&scan, NULL);
}

static void assemble_scan_from_message(void)
{
    status = rho_scan_assembler_take(&assembler, "RHO_PLOTS_1", bytes, size, 0);
    if (status == RHO_OK && assembler.counters.scans_accepted != 1) {
        status = RHO_ERROR_VALUE;
    }
}

static void encode_track_report(void)
{
    status = rho_publish_tracks(&report, 1, 1, 0, bytes, sizeof bytes, &size);
}

static void fill_messages(void)
{
    struct rho_scan_assembler_config config;

    scan = (struct rho_message_plot_scan){.scan = 1,
                                          .sensor_id = 1,
                                          .kind = RHO_MESSAGE_PLOT_SCAN_POSITION_2D,
                                          .num_parts = 1,
                                          .num_plots = RHO_MESSAGE_PLOT_SCAN_MAX_PLOTS};
    for (int i = 0; i < RHO_MESSAGE_PLOT_SCAN_MAX_PLOTS; i++) {
        scan.plots[i].x_m = 1000.0f * (float)i;
        scan.plots[i].y_m = -500.0f * (float)i;
    }
    report.num_tracks = RHO_MESSAGE_TRACK_LIST_MAX_TRACKS;
    for (unsigned i = 0; i < report.num_tracks; i++) {
        report.tracks[i].track_id = i + 1;
        report.tracks[i].status = RHO_TRACK_CONFIRMED;
    }
    rho_scan_assembler_config_default(&config);
    status = rho_scan_assembler_init(&assembler, sizeof assembler, &config);
}

int main(int argc, char **argv)
{
    static const struct {
        const char *name;
        void (*work)(void);
    } jobs[] = {{"encode", encode_scan},
                {"decode", decode_scan},
                {"validate", validate_scan},
                {"take", assemble_scan_from_message},
                {"publish", encode_track_report}};

    fill_messages();
    encode_scan();
    for (size_t i = 0; i < sizeof jobs / sizeof *jobs; i++) {
        if (argc == 2 && status == RHO_OK && strcmp(argv[1], jobs[i].name) == 0) {
            count_begin();
            jobs[i].work();
            count_end();
            printf("%lu bytes\n", (unsigned long)size);
            count_print_totals();
            return status == RHO_OK ? EXIT_SUCCESS : EXIT_FAILURE;
        }
    }
    fprintf(stderr, "no such job\n");
    return EXIT_FAILURE;
}
