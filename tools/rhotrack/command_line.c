/* SPDX-License-Identifier: MIT */
#include "command_line.h"

#include <errno.h>
#include <getopt.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "base/name_hint.h"
#include "io/asterix/asterix_file.h"
#include "io/asterix/asterix_plot_rows.h"
#include "io/csv/columns.h"
#include "io/csv/guess_origin.h"
#include "settings/initiation_methods.h"

enum { NUM_OPTIONS = 32, RUNS_MAX = 1000000 };

/* All options. Letters identify options inside the program; users can type -o and -h alone. */
static const struct {
    char letter;
    /* text NULL: the option is accepted, and not listed by --help */
    const char *name, *argument, *text;
} options[NUM_OPTIONS] = {
    {'o', "output", "OUTPUT",
     "where to write; it appears there only when it is complete (--follow: in place)"},
    {'m', "method", "METHOD",
     "how tracks are initiated: " METHOD_NAMES "; or an experiment's part"},
    {'P', "pipeline", "paper",
     "the papers' methods for all: nht, passive-paper, gate hough, inputs"},
    {'W', "show", "KINDS",
     "ghosts,votes,hypotheses: messages of what the methods of the papers and tracks think"},
    {'g', "gate", "GATE", "how a track chooses its plots; the parameter gate says the same"},
    {'K', "kind", "KIND", "which messages of a log: plots, polar, bearings, truth or tracks"},
    {'i', "no-input-estimation", NULL, "gates hough, nearest, none: a plain Kalman filter"},
    {'f', "follow", NULL, "go on with what is added to INPUT, until SIGINT or SIGTERM"},
    {'c', "covariance", NULL, "tracks with 21 columns more: the covariance's lower triangle"},
    {'B', "by-target", NULL, "a table with a row a target, too"},
    {'r', "runs", "N", "how many runs"},
    {'S', "seed", "S", "start of the random numbers, a whole number (default 1)"},
    {'j', "json", NULL, "one JSON object with the results on standard output"},
    {'k', "keep-going", NULL, "skip and count bad rows instead of stopping at the first"},
    {'s', "set", "KEY=VALUE", "a parameter; may be repeated; `rhotrack config` lists them"},
    {'C', "config", "FILE",
     "parameters from an INI file; may be repeated, the last one counts; --set goes before it"},
    {'3', "preset", "KIND",
     "parameters of a kind of radar: en_route, approach, marine, coastal_harbour, drone_defence, "
     "traffic"},
    {'N', "columns", "NAME=COLUMN,...",
     "CSV: the file's COLUMN is read as NAME (x_m, range_km, time_ms, ...)"},
    {'l', "lcm", "URL",
     "LCM network; without it $LCM_DEFAULT_URL, else udpm://239.255.76.67:7667?ttl=0"},
    {'p', "print", NULL, "tracks as they come: a table on a terminal, else as CSV"},
    {'L', "log", "FILE", "an LCM log of what comes in and goes out"},
    {'M', "clutter-map", "FILE",
     "echoes that come back: read from FILE if it is there, written to it at the end (CSV)"},
    {'Z', "zone-events", "FILE", "tracks that enter and leave zones ([zone N] of --config), CSV"},
    {'R', "snapshot", "FILE", "goes on with what it holds; written once a minute and at the end"},
    {'x', "speed", "X", "so many times as fast as it was; 0: without waiting (default 1)"},
    {'O', "loop", NULL, "again and again; times and numbers of scans go on"},
    {'T', "for", "SECONDS", "ends by itself"},
    {'A', "commands", NULL, "takes an operator's commands, of `rhotrack command` (RHO_COMMANDS)"},
    {'F', "commands-from", "ADDRESS,...", "takes them from these IPv4 addresses alone"},
    {'2', "standby", NULL, "publishes while no other node does"},
    {'E', "metrics", "PORT", "http://127.0.0.1:PORT/metrics: counters, for Prometheus"},
    {'h', "help", NULL, "this text"},
};

static bool command_takes_option(const struct command *command, char letter)
{
    return letter == 'h' || strchr(command->options, letter);
}

static const char *option_name_at(size_t index)
{
    return index < NUM_OPTIONS ? options[index].name : NULL;
}

static void print_command_help(const struct command *command, FILE *file)
{
    fprintf(file, "Usage: rhotrack %s %s\n\n%s\nOptions:\n", command->name, command->usage,
            command->text);
    for (size_t i = 0; i < NUM_OPTIONS; i++) {
        char left[48];

        if (!command_takes_option(command, options[i].letter) || !options[i].text) {
            continue;
        }
        snprintf(left, sizeof left, "%s--%s%s%s",
                 options[i].letter == 'o'   ? "-o, "
                 : options[i].letter == 'h' ? "-h, "
                                            : "    ",
                 options[i].name, options[i].argument ? " " : "",
                 options[i].argument ? options[i].argument : "");
        fprintf(file, "  %-26s %s\n", left, options[i].text);
    }
}

static _Noreturn void print_help_and_exit(const struct command *command)
{
    struct output output = output_open(NULL);

    print_command_help(command, output.file);
    output_close(&output);
    exit(0);
}

static uint64_t parse_whole_number(const char *option, const char *text, uint64_t min, uint64_t max)
{
    char *end;
    unsigned long long number;

    errno = 0;
    number = strtoull(text, &end, 10);
    if (*text < '0' || *text > '9' || *end) {
        fail(EXIT_USAGE, "--%s '%s' is not a whole number", option, text);
    }
    if (errno || number < min || number > max) {
        fail(EXIT_USAGE, "--%s %s is outside %llu .. %llu", option, text, (unsigned long long)min,
             (unsigned long long)max);
    }
    return number;
}

static double parse_decimal(const char *option, const char *text, double min, double max)
{
    char *end;
    double number = strtod(text, &end);

    if (((*text < '0' || *text > '9') && *text != '.') || *end || strchr(text, 'x')) {
        fail(EXIT_USAGE, "--%s '%s' is not a number", option, text);
    }
    if (!(number >= min && number <= max)) {
        fail(EXIT_USAGE, "--%s %s is outside %g .. %g", option, text, min, max);
    }
    return number;
}

static bool store_live_option(struct command_line *line, char letter, char *argument)
{
    switch (letter) {
    case 'l':
        line->lcm = argument;
        return true;
    case 'p':
        line->print = true;
        return true;
    case 'L':
        line->log = argument;
        return true;
    case 'R':
        line->snapshot = argument;
        return true;
    case 'W':
        line->show = argument;
        return true;
    case 'x':
        line->speed = parse_decimal("speed", argument, 0, 1e6);
        return true;
    case 'O':
        line->loop = true;
        return true;
    case 'A':
        line->commands = true;
        return true;
    case 'F':
        line->commanders = argument;
        return true;
    case '2':
        line->standby = true;
        return true;
    case 'E':
        line->metrics = (uint16_t)parse_whole_number("metrics", argument, 1, UINT16_MAX);
        return true;
    case 'T':
        line->seconds = parse_decimal("for", argument, 1e-3, 1e9);
        return true;
    default:
        return false;
    }
}

/* Keeps a setting as the user typed it: the suggested next command repeats it. */
static void keep_setting_as_typed(struct command_line *line, const char *option, const char *value)
{
    line->settings =
        must_realloc(line->settings, (line->num_settings + 2) * sizeof *line->settings);
    line->settings[line->num_settings++] = option;
    line->settings[line->num_settings++] = value;
}

static void set_preset(struct command_line *line, const char *name)
{
    char reason[PARAMETER_REASON_BYTES];

    if (!parameters_assign_preset(&line->parameters, name, reason)) {
        fail(EXIT_USAGE, "--preset: %s", reason);
    }
    keep_setting_as_typed(line, "--preset", name);
}

static bool apply_setting_option(struct command_line *line, char letter, char *argument)
{
    switch (letter) {
    case 's':
        parameters_set_assignment(&line->parameters, argument);
        keep_setting_as_typed(line, "--set", argument);
        return true;
    case '3':
        set_preset(line, argument);
        return true;
    case 'N':
        columns_set_option(argument);
        keep_setting_as_typed(line, "--columns", argument);
        return true;
    case 'C':
        parameters_load_ini(&line->parameters, argument);
        keep_setting_as_typed(line, "--config", argument);
        return true;
    default:
        return false;
    }
}

static void store_option(struct command_line *line, char letter, char *argument)
{
    switch (letter) {
    case 'o':
        line->output = argument;
        break;
    case 'm':
        line->method = argument;
        break;
    case 'P':
        line->pipeline = argument;
        break;
    case 'g':
        line->gate = argument;
        break;
    case 'K':
        line->kind = argument;
        break;
    case 'M':
        line->clutter_map = argument;
        break;
    case 'Z':
        line->zone_events = argument;
        break;
    case 'f':
        line->follow = true;
        break;
    case 'i':
        line->no_input_estimation = true;
        break;
    case 'c':
        line->covariance = true;
        break;
    case 'B':
        line->by_target = true;
        break;
    case 'r':
        line->runs = (long)parse_whole_number("runs", argument, 1, RUNS_MAX);
        break;
    case 'S':
        line->seed = parse_whole_number("seed", argument, 0, UINT64_MAX);
        break;
    case 'j':
        line->json = true;
        break;
    case 'k':
        line->keep_going = true;
        break;
    default:
        if (!store_live_option(line, letter, argument) &&
            !apply_setting_option(line, letter, argument)) {
            fail(EXIT_RUNTIME, "an option without a use");
        }
    }
}

/*
 * Fills getopt_long's table with the options of all commands: an option of another command then
 * gets a clearer message than getopt's own.
 */
static void fill_getopt_table(struct option table[NUM_OPTIONS + 1])
{
    for (size_t i = 0; i < NUM_OPTIONS; i++) {
        table[i] =
            (struct option){options[i].name, options[i].argument ? required_argument : no_argument,
                            NULL, options[i].letter};
    }
    table[NUM_OPTIONS] = (struct option){NULL, 0, NULL, 0};
}

static const char *option_name_of_letter(int letter)
{
    for (size_t i = 0; i < NUM_OPTIONS; i++) {
        if (options[i].letter == letter) {
            return options[i].name;
        }
    }
    return NULL;
}

/* Exit 2, with the option that may be meant. */
static _Noreturn void refuse_unknown_option(const struct command *command, char **argv)
{
    const char *typed = argv[optind - 1], *hint;
    char name[64];

    if (optopt && strncmp(typed, "--", 2) == 0 && option_name_of_letter(optopt)) {
        fail(EXIT_USAGE, "%s: --%s takes no value", command->name, option_name_of_letter(optopt));
    }
    if (optopt) {
        fail(EXIT_USAGE, "%s: unknown option '-%c'; see rhotrack %s --help", command->name, optopt,
             command->name);
    }
    snprintf(name, sizeof name, "%.*s", (int)strcspn(typed + 2, "="), typed + 2);
    hint = name_hint_nearest(name, option_name_at);
    if (hint) {
        fail(EXIT_USAGE, "%s: unknown option '%s', did you mean '--%s'?", command->name, typed,
             hint);
    }
    fail(EXIT_USAGE, "%s: unknown option '%s'; see rhotrack %s --help", command->name, typed,
         command->name);
}

static void read_options(struct command_line *line, const struct command *command, int argc,
                         char **argv)
{
    struct option table[NUM_OPTIONS + 1];
    size_t room = 0;
    int letter;

    fill_getopt_table(table);
    opterr = 0;
    while ((letter = getopt_long(argc, argv, ":o:h", table, NULL)) != -1) {
        if (letter == '?') {
            refuse_unknown_option(command, argv);
        }
        if (letter == ':') {
            fail(EXIT_USAGE, "%s: --%s needs a value", command->name,
                 option_name_of_letter(optopt));
        }
        if (letter == 'h') {
            print_help_and_exit(command);
        }
        if (!command_takes_option(command, (char)letter)) {
            fail(EXIT_USAGE, "%s takes no --%s; see rhotrack %s --help", command->name,
                 option_name_of_letter(letter), command->name);
        }
        /* --set of simulate changes the scene */
        if (letter == 's' && strcmp(command->name, "simulate") == 0) {
            line->scene_sets = must_make_room_for_one(line->scene_sets, line->num_scene_sets, &room,
                                                      sizeof *line->scene_sets);
            line->scene_sets[line->num_scene_sets++] = optarg;
        } else {
            store_option(line, (char)letter, optarg);
        }
    }
}

/*
 * Suggests the origin of the local frame where none is set: the place of a recording's first radar,
 * or the first place of a CSV file.
 */
static void set_default_origin_if_lacking(struct command_line *line, const char *path,
                                          struct asterix_place place)
{
    if (place.is_given && !parameters_has_origin(&line->parameters)) {
        asterix_set_default_origin(path, &place, &line->parameters);
    }
}

/* Takes the origin from the first rows, and warns of azimuths that count clockwise. */
static void set_csv_origin(struct command_line *line, const char *path)
{
    const struct origin_and_azimuth_sense look = guess_origin_from_rows(path);

    set_default_origin_if_lacking(
        line, path, (struct asterix_place){look.has_place, look.lat_deg, look.lon_deg, look.alt_m});
    if (look.has_compass_azimuths) {
        fprintf(stderr,
                "rhotrack: %s: azimuth_rad goes from 0 to 2 pi and rises with time, as that of a "
                "compass does; it is read counter-clockwise from east. Clockwise from north: "
                "--columns azimuth_compass_rad=azimuth_rad\n",
                path);
    }
}

/*
 * Selects the arguments that may hold plots, from which an origin can be taken: none of evaluate.
 */
static void note_plot_arguments(struct command_line *line, const struct command *command)
{
    /* the first argument of plot is the kind of picture */
    const int skipped = strcmp(command->name, "plot") == 0;

    line->plot_files = line->arguments + skipped;
    line->num_plot_files =
        strcmp(command->name, "convert") == 0 ? 1
        : command_takes_option(command, 'N') && strcmp(command->name, "evaluate") != 0
            ? line->num_arguments - skipped
            : 0;
}

void command_line_read(struct command_line *line, const struct command *command, int argc,
                       char **argv)
{
    *line = (struct command_line){.seed = 1, .speed = 1};
    parameters_set_defaults(&line->parameters);
    read_options(line, command, argc, argv);
    line->arguments = argv + optind;
    line->num_arguments = argc - optind;
    if (line->num_arguments < command->min_arguments) {
        fail(EXIT_USAGE, "%s: too few arguments; usage: rhotrack %s %s", command->name,
             command->name, command->usage);
    }
    if (line->num_arguments > command->max_arguments) {
        fail(EXIT_USAGE, "%s: '%s' is one argument too many; usage: rhotrack %s %s", command->name,
             line->arguments[command->max_arguments], command->name, command->usage);
    }
    note_plot_arguments(line, command);
}

void refuse_output_that_is_an_input(const struct command_line *line)
{
    for (int i = 0; line->output && i < line->num_arguments; i++) {
        if (is_same_file(line->output, line->arguments[i])) {
            fail(EXIT_USAGE, "%s: the output cannot be an input", line->arguments[i]);
        }
    }
}

static void refuse_same_input_file_twice(const struct command_line *line, const char *command)
{
    for (int i = 0; i < line->num_arguments; i++) {
        for (int other = 0; other < i; other++) {
            if (is_same_file(line->arguments[other], line->arguments[i])) {
                fail(EXIT_USAGE, "%s: %s is given twice, and its plots would count twice", command,
                     line->arguments[i]);
            }
        }
    }
}

static void refuse_ending_of_other_format(const struct command_line *line, const char *command)
{
    static const char *const endings[] = {".csv",     ".lcm",  ".ast", ".asterix",
                                          ".geojson", ".json", ".svg"};

    for (size_t i = 0; line->output && i < sizeof endings / sizeof *endings; i++) {
        if (path_ends_with(line->output, endings[i])) {
            fail(EXIT_USAGE, "%s: %s writes an INI file, and %s is the ending of another",
                 line->output, command, endings[i]);
        }
    }
}

bool is_output_explicitly_stdout(const struct command_line *line)
{
    return line->output && strcmp(line->output, "-") == 0;
}

void command_line_check_ini_output(const struct command_line *line, const char *command)
{
    refuse_output_that_is_an_input(line);
    refuse_same_input_file_twice(line, command);
    refuse_ending_of_other_format(line, command);
    if (line->json && is_output_explicitly_stdout(line)) {
        fail(EXIT_USAGE, "%s: --json and -o - both write on standard output", command);
    }
}

/* True where all plot files are regular files, whose headers can be read ahead; not pipes. */
static bool are_plot_files_regular(const struct command_line *line)
{
    for (int i = 0; i < line->num_plot_files; i++) {
        if (regular_file_size_or_zero(line->plot_files[i]) == 0) {
            return false;
        }
    }
    return true;
}

void command_line_set_places(struct command_line *line)
{
    for (int i = 0; i < line->num_arguments && !parameters_has_origin(&line->parameters); i++) {
        set_default_origin_if_lacking(line, line->arguments[i],
                                      asterix_file_radar_place(line->arguments[i]));
    }
    for (int i = 0; i < line->num_plot_files; i++) {
        set_csv_origin(line, line->plot_files[i]);
    }
    if (line->num_plot_files > 0 && are_plot_files_regular(line)) {
        columns_check_option_used();
    }
    parameters_locate_sensors(&line->parameters);
}
