/* SPDX-License-Identifier: MIT */
/* main: the table of commands of the command-line program, and their dispatch. */
#include <cjson/cJSON.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "base/name_hint.h"
#include "command_line.h"
#include "commands.h"
#include "io/csv/columns.h"
#include "rhotrack/rhotrack.h"

#define INPUT_FORMATS                                                                              \
    "Plots in CSV have t_s,sensor_id and x_m,y_m[,z_m] or range_m,azimuth_rad; for places also\n"  \
    "lat_deg,lon_deg[,alt_m] (with the parameters origin_lat_deg and origin_lon_deg); and\n"       \
    "received_s, when a row came, where some come late. INPUT may be an LCM log (NAME.lcm)\n"      \
    "or a recording in ASTERIX (NAME.ast; CAT048, CAT034, CAT001, CAT002), also of the network\n"  \
    "(NAME.pcap, NAME.pcapng); its first radar is the origin if none is set.\n"
#define TRACK_FORMATS                                                                              \
    "OUTPUT, by its name: .lcm an LCM log, .ast ASTERIX (CAT062), .geojson a map (needs the\n"     \
    "origin), any other CSV.\n"

static const struct command commands[] = {
    {"track", command_track, "INPUT... [-o OUTPUT] [--gate best|hough|nearest] [--follow]", 1,
     INT_MAX, "omPgWfcMZjks3CN", "the main job: scans in, tracks out",
     "Reads plots (CSV: t_s,sensor_id,x_m,y_m and optional columns) and bearings (t_s,sensor_id,\n"
     "sensor_x_m,sensor_y_m,bearing_rad), several inputs merged by time, starts and maintains "
     "tracks,\n"
     "and writes one row a track and scan to OUTPUT or standard output (CSV).\n"
     "\n" INPUT_FORMATS "\n" TRACK_FORMATS "\n"
     "A summary goes to standard error. With --json the results go to standard output as one JSON\n"
     "object, and tracks only to OUTPUT. INPUT - is standard input (CSV). Files may be of any\n"
     "length: memory does not grow with them.\n"
     "\n"
     "--show adds to OUTPUT, an LCM log, what the tracks and the methods of the papers think:\n"
     "RHO_GHOSTS, RHO_ACCUMULATOR with RHO_PLANE, and RHO_HYPOTHESES; at most 50 messages of a\n"
     "kind a second.\n"
     "\n"
     "--clutter-map keeps what is known of towers and other echoes that come back, so that they "
     "start\n"
     "no tracks in the next run. By hand: sensor_id,x_m,y_m.\n"
     "\n"
     "With --follow one CSV file of plots (or a pipe) is tracked while it grows, as tail -f shows "
     "it.\n"
     "OUTPUT is then written in place, and each scan's rows are there at once. A scan is complete\n"
     "when a later one begins, or the file has not grown for follow_quiet_s (--set; 2 s); half a "
     "row\n"
     "waits for its rest. It ends on SIGINT and SIGTERM with exit code 0, and with 1 where the "
     "file\n"
     "becomes shorter, is replaced or removed; rows that were written stay.\n"},
    {"initiate", command_initiate, "INPUT [-o OUTPUT] [--method METHOD]", 1, 1, "omjks3CN",
     "initiation alone, on the last scans as one batch",
     "Takes the last N scans of the file (parameter scans) as one batch and writes the tracks "
     "found\n"
     "in it (CSV), best first, at the time of the last scan. Methods: kernel and, for bearings,\n"
     "passive (the defaults), and those of the literature, for comparison: ht, mht, iht, nht, for\n"
     "bearings passive-paper (score: votes; place and velocity are fitted through what voted).\n"
     "Sectors of a turning radar are one scan a turn. OUTPUT is an LCM log where it is NAME.lcm.\n"
     "\n" INPUT_FORMATS},
    {"maintain", command_maintain, "INPUT [-o OUTPUT] [--gate best|hough|nearest|none]", 1, 1,
     "ogicjkSs3CN", "one track alone, never dropped",
     "The first plot of the first scan starts a track; of each further scan it takes one plot, or "
     "none.\n"
     "Writes one row a scan (CSV) to OUTPUT or standard output. Gates: best (the default: several\n"
     "hypotheses, two motions), hough (clutter elimination in velocity space, of the literature; "
     "needs\n"
     "columns vx_mps, vy_mps), nearest (the least Mahalanobis distance), none (any plot, drawn "
     "with\n"
     "--seed). hough, nearest and none run a Kalman filter with input estimation.\n"
     "\n" INPUT_FORMATS "\n" TRACK_FORMATS},
    {"simulate", command_simulate, "SCENE -o DIR [--runs N] [--seed S]", 1, 1, "orSsC",
     "made-up targets, noise, misses and clutter",
     "Writes DIR/plots.csv, DIR/bearings.csv and DIR/truth.csv of a scene; with several runs "
     "DIR/run-0000/\n"
     "and so on. The same seed gives the same data.\n"
     "\n"
     "A scene is a file NAME.json, or the name of one that ships; all stands in it\n"
     "(tools/scenes/README.md), and --set changes it, as in --set radars.0.pd=0.7.\n"},
    {"evaluate", command_evaluate, "TRUTH TRACKS [-o FILE.svg|FILE.csv] [--by-target]", 2, 2,
     "oBjs3CN", "tracks against the truth",
     "GOSPA and its parts, OSPA, completeness, switches, fragments, delay, false tracks, errors "
     "and "
     "their\n"
     "consistency (NEES) of a tracks file against a truth file; confirmed and coasting tracks "
     "count.\n"
     "A truth without the tracks' times is interpolated to them. A target exists from its first "
     "to\n"
     "its last row, gaps apart: rows farther apart than truth_gap_s, by default 5 times their "
     "median\n"
     "interval. Tracks where no target is are false.\n"
     "\n"
     "-o FILE.svg draws GOSPA, its parts, and the numbers of targets and tracks over time; -o "
     "FILE.csv\n"
     "writes these figures, a row a time. --json has them, too (over_time), and every target's\n"
     "(by_target).\n"},
    {"plot", command_plot,
     "scans|tracks|parameter-space|errors|clutter-map FILES... -o NAME.svg|.png|.html", 2, INT_MAX,
     "oms3CN", "pictures",
     "Draws plots or bearings, tracks, the parameter space of lines, errors, or a clutter map (and "
     "the\n"
     "plots of further files beneath), as .svg, .png or .html. With --method ht, mht, iht or nht "
     "the parameter\n"
     "space has that method's votes; of nht also truth, indeterminacy and falsity.\n"},
    {"convert", command_convert, "IN OUT [--kind plots|polar|bearings|truth|tracks]", 2, 2,
     "Kcks3CN", "CSV files, LCM logs and ASTERIX to one another",
     "Writes a CSV file (plots, polar plots, bearings, truth or tracks) as an LCM log, or the\n"
     "messages of one kind of a log as a CSV file. CSV files end with .csv, LCM logs with .lcm.\n"
     "Tracks of either become a map where OUT is NAME.geojson; that needs the parameters\n"
     "origin_lat_deg and origin_lon_deg.\n"
     "Values keep float32 and times microseconds. Rows of one sensor are one scan where they have\n"
     "the same scan and epoch (columns), else the same t_s, or are within scan_interval_s; "
     "received_s\n"
     "(plots) becomes the times of the events, and lat_deg,lon_deg places in the local frame. "
     "Damaged\n"
     "places of a log are skipped and reported; bad messages are refused, or with --keep-going\n"
     "skipped and counted. Recordings in ASTERIX (NAME.ast; CAT048 and CAT034), also within those\n"
     "of the network (NAME.pcap, NAME.pcapng), become either; tracks come from CAT062, and become "
     "it\n"
     "where OUT ends with .ast.\n"},
    {"node", command_node,
     "[--lcm URL] [--print] [--log FILE] [--snapshot FILE] [--gate best|hough|nearest]", 0, 0,
     "lpLRTAF2EmPgWMs3C", "the live tracker: LCM messages in, LCM messages out",
     "Tracks what sensors say on RHO_PLOTS_<n>, RHO_POLAR_<n>, RHO_BEARINGS_<n> and\n"
     "RHO_DIRECTIONS_<n>, and publishes RHO_TRACKS and RHO_PEAKS at each scan, with body_max_m\n"
     "RHO_BODIES, and once a second RHO_STATUS, RHO_WORK and RHO_SENSORS,\n"
     "with them what is learned of each sensor in turn, RHO_LEARNED, and of tracks' lives, "
     "RHO_LIFE,\n"
     "and what is known of clutter that comes back, RHO_CLUTTER, every five. Bad, late and lost "
     "messages are\n"
     "counted and end nothing. --show adds RHO_GHOSTS, RHO_ACCUMULATOR with RHO_PLANE, and\n"
     "RHO_HYPOTHESES, at most 50 messages of a kind a second. Sensors that contradict the others "
     "or fall\n"
     "silent are named. With --snapshot a node that is started again goes on with its tracks.\n"
     "With --commands it does what `rhotrack command` asks for after the next step, ten a second "
     "at\n"
     "most, and names each with its sender; --commands-from does so for some senders alone.\n"
     "Areas, settings and frozen tracks of earlier commands in the snapshot are named, and "
     "without\n"
     "--commands left out.\n"
     "Of two nodes with --standby one publishes; the other one does, with its own epoch, where "
     "that "
     "is\n"
     "silent for two seconds.\n"
     "A log goes into files of log_file_mb or log_file_s, of which the newest log_files stay; "
     "SIGHUP\n"
     "opens its name anew. --metrics tells counters and times to programs of this machine.\n"
     "It ends on SIGINT and SIGTERM, or at the end of a log\n"
     "(--lcm file://NAME.lcm?speed=0), with a summary on standard error and exit code 0.\n"
     "udpm:// URLs have the options ttl=N (0: this machine, 1: this network), recv_buf_size=BYTES\n"
     "and sources_allowed=ADDRESS,... (IPv4; others are refused and counted).\n"},
    {"publish", command_publish, "INPUT... [--lcm URL] [--speed X] [--loop]", 1, INT_MAX,
     "lxOTks3CN", "plays files as sensors, live",
     "Sends the messages of LCM logs, CSV files (plots, polar plots, bearings, truth, tracks) and\n"
     "recordings in ASTERIX (NAME.ast, or in NAME.pcap, NAME.pcapng) in time, the first one at "
     "once.\n"
     "CSV files\n"
     "may have lat_deg, lon_deg, alt_m for places (parameters origin_lat_deg and origin_lon_deg);\n"
     "received_s sets when rows are sent. Messages of logs are sent as they are. With --loop "
     "times\n"
     "and numbers of scans "
     "go "
     "on\n"
     "from pass to pass, as of sensors that go on. A CSV file without a column epoch has the "
     "program's\n"
     "own, so that a second run is a restart of its sensors: a node follows after follow_scans "
     "(3)\n"
     "scans that agree, and gives its tracks again. To a file: --lcm file://NAME.lcm?mode=w.\n"
     "\n"
     "INPUT udp://ADDRESS:PORT: what radars send there in ASTERIX (CAT048, CAT034) goes on as\n"
     "messages, scan by scan.\n"},
    {"command", command_command, "ACTION [NUMBER...] [KEY=VALUE...] [--lcm URL] [--for SECONDS]", 1,
     INT_MAX, "lT", "an operator's word to a live tracker",
     "Sends a command to the nodes that run with --commands, and says what the first answer is. It "
     "is\n"
     "done after the node's next step; without an answer in --for seconds (15) the exit code is 1, "
     "as\n"
     "where it is refused.\n"
     "\n"
     "  start x_m=X y_m=Y [sigma_m=S] [vx_mps=V vy_mps=V sigma_mps=S]\n"
     "                             a track at a place (sigma_m 100)\n"
     "  drop TRACK                 the track ends\n"
     "  renumber TRACK NEW         it gets another identity, as of a lost track\n"
     "  freeze TRACK, thaw TRACK   it coasts without plots and does not end; it goes on\n"
     "  exclude x_m=X y_m=Y x_max_m=X y_max_m=Y\n"
     "                             no tracks start in this area; tracks pass through\n"
     "  include x_m=X y_m=Y        areas that hold this place are excluded no more\n"
     "  set NAME VALUE             a setting while tracking; the answer says when it applies:\n"
     "                             v_min_mps v_max_mps accel_max_mps2 pd scan_interval_s\n"
     "                             sigma_range_m sigma_azimuth_rad sigma_elevation_rad\n"
     "                             sigma_range_rate_mps sigma_rad range_min_m range_max_m scans\n"
     "                             min_scans coast_scans_max false_tracks_per_hour work_max\n"
     "                             standing (0: clutter, 1: targets)\n"
     "\n"
     "Nothing proves who sent a command: a node's --commands-from limits the addresses, and\n"
     "sources_allowed of --lcm those of all messages. Beyond ten a second it gives no answer.\n"},
    {"config", command_config, "[--method METHOD]", 0, 0, "mjs3C",
     "every parameter with unit, default and range",
     "Prints each parameter's unit, default, range, and its value now with where it came from; "
     "with\n"
     "--method, that method's customary values.\n"},
    {"calibrate", command_calibrate, "INPUT... [-o FILE.ini]", 1, INT_MAX, "ogjks3CN",
     "noise, pd, clutter, turn time and speeds of a recording",
     "Reads plots, tracks each radar alone, and tells what it is like: noise along the line of\n"
     "sight and across it (of places: on each axis), pd, clutter, turn time, and the speeds of "
     "what\n"
     "moved, each with its sigma. What the plots do not tell is said to be not known. -o writes "
     "an\n"
     "INI file for --config; with -o - it is on standard output, and the table on standard "
     "error.\n"},
    {"register", command_register, "INPUT... [-o FILE.ini]", 1, INT_MAX, "ogjks3CN",
     "biases of radars from common targets",
     "Reads polar plots of two or more radars, tracks each radar alone, finds the targets that "
     "several\n"
     "of them see, and estimates each radar's bias of range, azimuth and time, each with its "
     "sigma, in\n"
     "all with what --set and --config say already. Time: one radar's counts as right (parameter\n"
     "reference_sensor). What the plots do not tell is said to be not known. -o writes the biases "
     "as an\n"
     "INI file for --config; with -o - it is on standard output, and the table on standard "
     "error.\n"},
};

enum { NUM_COMMANDS = sizeof commands / sizeof *commands };

static const char *command_name_at(size_t index)
{
    return index < NUM_COMMANDS ? commands[index].name : command_lab_name(index - NUM_COMMANDS);
}

static void print_help(void)
{
    struct output output = output_open(NULL);

    fputs("rhotrack: from radar plots to tracks.\n\nUsage: rhotrack COMMAND ...\n\nCommands:\n",
          output.file);
    for (size_t i = 0; i < NUM_COMMANDS; i++) {
        fprintf(output.file, "  %-11s %s\n", commands[i].name, commands[i].summary);
    }
    fputs("  experiment  a Monte Carlo experiment with tables and figures (the lab)\n"
          "  bench       speed, memory, cost a scan (the lab)\n",
          output.file);
    fputs("\n`rhotrack COMMAND --help` says more; `rhotrack --version` prints the version.\n\n"
          "Exit codes: 0 success, 1 a failure at run time, 2 bad usage or bad input.\n",
          output.file);
    output_close(&output);
}

static void print_version(void)
{
    struct output output = output_open(NULL);

    fprintf(output.file, "rhotrack %d.%d.%d\n", RHO_VERSION_MAJOR, RHO_VERSION_MINOR,
            RHO_VERSION_PATCH);
    output_close(&output);
}

static const struct command *must_find_command(const char *name)
{
    const char *hint;

    if (*name == '-') {
        fail(EXIT_USAGE, "unknown option '%s'; see rhotrack --help", name);
    }
    for (size_t i = 0; i < NUM_COMMANDS; i++) {
        if (strcmp(commands[i].name, name) == 0) {
            return &commands[i];
        }
    }
    hint = name_hint_nearest(name, command_name_at);
    if (hint) {
        fail(EXIT_USAGE, "unknown command '%s', did you mean '%s'?", name, hint);
    }
    fail(EXIT_USAGE, "unknown command '%s'; see rhotrack --help", name);
}

int main(int argc, char **argv)
{
    static struct command_line line;
    cJSON_Hooks hooks = {must_alloc, free};
    const struct command *command;

    cJSON_InitHooks(&hooks);
    if (argc < 2) {
        fail(EXIT_USAGE, "no command; see rhotrack --help");
    }
    if (!strcmp(argv[1], "--help") || !strcmp(argv[1], "-h")) {
        print_help();
        return 0;
    }
    if (!strcmp(argv[1], "--version")) {
        print_version();
        return 0;
    }
    if (command_lab_has(argv[1])) {
        command_lab_execute(argv);
    }
    command = must_find_command(argv[1]);
    command_line_read(&line, command, argc - 1, argv + 1);
    if (command->run == command_convert) {
        convert_refuse_radar(&line);
    }
    command_line_set_places(&line);
    const int exit_code = command->run(&line);

    columns_check_option_used();
    return exit_code;
}
