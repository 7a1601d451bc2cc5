/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "base/common.h"
#include "experiment_classic.h"

#define TEXT 48

/* ---- numbers as text ------------------------------------------------------------------------- */

/* "0.98" as ".98". */
static void strip_zero(char *text)
{
    text += text[0] == '-';
    if (text[0] == '0' && text[1] == '.') {
        memmove(text, text + 1, strlen(text));
    }
}

static void put_number(char text[TEXT], enum classic_figure figure, double value)
{
    switch (figure) {
    case CLASSIC_FALSE:
        snprintf(text, TEXT, value < 9.95 ? "%.1f" : "%.0f", value);
        break;
    case CLASSIC_RHO:
    case CLASSIC_THETA:
        snprintf(text, TEXT, value < 0.995 ? "%.2f" : "%.1f", value);
        break;
    case CLASSIC_VOTES:
        snprintf(text, TEXT,
                 value >= 1e6   ? "%.2fM"
                 : value >= 1e3 ? "%.1fk"
                                : "%.0f",
                 value >= 1e6   ? value / 1e6
                 : value >= 1e3 ? value / 1e3
                                : value);
        break;
    default:
        snprintf(text, TEXT, "%.2f", value);
    }
    strip_zero(text);
}

/* "-" where there is none. */
static const char *number(char text[TEXT], const struct classic_summary *summary,
                          enum classic_figure figure)
{
    put_number(text, figure, summary->mean[figure]);
    return isnan(summary->mean[figure]) ? "-" : text;
}

/* The measured figure, a slash, the reference's. */
static const char *with_reference(char text[TEXT], size_t situation,
                                  const struct classic_summary *summary, enum classic_figure figure)
{
    char measured[TEXT];
    bool has_reference = classic_expected(situation, summary->method, figure).is_given;
    const char *reference =
        has_reference ? classic_references[situation][summary->method].figures[figure] : "";
    const char *dots = strstr(reference, "..");
    int length = dots ? (int)(dots - reference) : (int)strlen(reference);
    snprintf(text, TEXT, "%.20s%s%.*s%s%.10s", number(measured, summary, figure),
             has_reference ? "/" : "", length, reference, dots ? "-" : "", dots ? dots + 2 : "");
    return text;
}

static const char *milliseconds(char text[TEXT], double time_us)
{
    snprintf(text, TEXT, time_us < 9.95e3 ? "%.2f" : "%.1f", time_us / 1e3);
    return isnan(time_us) ? "-" : text;
}

/* ---- the tables ------------------------------------------------------------------------------ */

/* Of the verdicts about one Situation and method: their names start with both. */
static const char *row_verdict(const struct classic_report *report,
                               const struct classic_summary *summary)
{
    char start[TEXT];
    size_t count = 0;
    int length = snprintf(start, sizeof start, "%s %s: ", summary->situation->name,
                          classic_method_names[summary->method]);
    for (size_t i = 0; i < report->num_verdicts; i++) {
        if (strncmp(report->verdicts[i].what, start, (size_t)length) == 0) {
            count++;
            if (!report->verdicts[i].is_held) {
                return "MISSED";
            }
        }
    }
    return count > 0 ? "ok" : "-";
}

struct grid classic_situations_grid(const struct classic_report *report)
{
    struct grid grid = grid_start(
        2, "case|method|detected|met|false|discrim.|top 3|rho m|theta mrad|votes|ms|verdict");
    for (size_t i = 0; i < SITUATIONS; i++) {
        for (size_t method = 0; method < CLASSIC_METHODS; method++) {
            const struct classic_summary *summary = &report->summaries[i][method];
            char text[CLASSIC_VOTES + 1][TEXT], ms[TEXT];
            if (!classic_has(report, method)) {
                continue;
            }
            for (enum classic_figure figure = 0; figure <= CLASSIC_VOTES; figure++) {
                with_reference(text[figure], i, summary, figure);
            }
            grid_row(&grid, "%s|%s|%s|%s|%s|%s|%s|%s|%s|%s|%s|%s", summary->situation->name,
                     classic_method_names[method], text[CLASSIC_DETECTED], text[CLASSIC_MET],
                     text[CLASSIC_FALSE], text[CLASSIC_DISCRIMINATION], text[CLASSIC_TOP3],
                     text[CLASSIC_RHO], text[CLASSIC_THETA], text[CLASSIC_VOTES],
                     milliseconds(ms, summary->time_us), row_verdict(report, summary));
        }
    }
    return grid;
}

struct grid classic_words_grid(const struct classic_report *report)
{
    struct grid grid = grid_start(
        2, "case|method|discrimination|paper|holds|divergence m|mrad|paper|decline|paper");
    for (size_t i = 0; i <= SITUATION_IV; i++) {
        for (size_t method = 0; method < CLASSIC_KERNEL; method++) {
            const struct classic_summary *summary = &report->summaries[i][method];
            char discrimination[TEXT], rho[TEXT], theta[TEXT], decline[TEXT];
            if (!classic_has(report, method)) {
                continue;
            }
            bool is_high = summary->mean[CLASSIC_DISCRIMINATION] > 1.0;
            bool holds = is_high == (strcmp(classic_word(i, method, 0), "high") == 0);
            grid_row(&grid, "%s|%s|%s|%s|%s|%s|%s|%s|%s|%s", summary->situation->name,
                     classic_method_names[method],
                     number(discrimination, summary, CLASSIC_DISCRIMINATION),
                     classic_word(i, method, 0), holds ? "yes" : "no",
                     number(rho, summary, CLASSIC_RHO), number(theta, summary, CLASSIC_THETA),
                     classic_word(i, method, 1), number(decline, summary, CLASSIC_DECLINE),
                     classic_word(i, method, 2));
        }
    }
    return grid;
}

struct grid classic_sweep_grid(const struct classic_report *report)
{
    static const size_t methods[] = {RHO_HOUGH_IHT, RHO_HOUGH_NHT_A, RHO_HOUGH_NHT_C,
                                     CLASSIC_KERNEL};
    struct grid grid = grid_start(2, "noise m|method|detected|met|false|discrim.|top 3");
    for (size_t i = 0; i < CLASSIC_NOISES; i++) {
        for (size_t j = 0; j < sizeof methods / sizeof methods[0]; j++) {
            const struct classic_summary *summary = &report->sweep[i][methods[j]];
            char text[CLASSIC_FIGURES][TEXT];
            if (classic_has(report, methods[j])) {
                grid_row(
                    &grid, "%g|%s|%s|%s|%s|%s|%s", report->sweep_situations[i].noise_m,
                    classic_method_names[methods[j]], number(text[0], summary, CLASSIC_DETECTED),
                    number(text[1], summary, CLASSIC_MET), number(text[2], summary, CLASSIC_FALSE),
                    number(text[3], summary, CLASSIC_DISCRIMINATION),
                    number(text[4], summary, CLASSIC_TOP3));
            }
        }
    }
    return grid;
}

struct grid classic_times_grid(const struct classic_report *report)
{
    struct grid grid =
        grid_start(0, "clutter/km^2|dense HT ms|HT ms|MHT ms|IHT ms|NHT A ms|NHT C ms|default ms|"
                      "NHT C / dense HT|HT / dense HT");
    for (size_t i = 0; i < report->num_times; i++) {
        const struct classic_time *time = &report->times[i];
        char text[CLASSIC_METHODS + 1][TEXT], c[TEXT], ht[TEXT];
        for (size_t method = 0; method <= CLASSIC_METHODS; method++) {
            milliseconds(text[method], time->time_us[method]);
            if (isnan(time->time_us[method])) {
                snprintf(text[method], TEXT, "-");
            }
        }
        snprintf(c, sizeof c, "%.3f",
                 time->time_us[RHO_HOUGH_NHT_C] / time->time_us[CLASSIC_DENSE]);
        snprintf(ht, sizeof ht, "%.3f", time->time_us[RHO_HOUGH_HT] / time->time_us[CLASSIC_DENSE]);
        grid_row(&grid, "%g|%s|%s|%s|%s|%s|%s|%s|%s|%s", time->per_km2, text[CLASSIC_DENSE],
                 text[RHO_HOUGH_HT], text[RHO_HOUGH_MHT], text[RHO_HOUGH_IHT],
                 text[RHO_HOUGH_NHT_A], text[RHO_HOUGH_NHT_C], text[CLASSIC_KERNEL],
                 classic_has(report, RHO_HOUGH_NHT_C) ? c : "-",
                 classic_has(report, RHO_HOUGH_HT) ? ht : "-");
    }
    return grid;
}

struct grid classic_verdicts_grid(const struct classic_report *report, bool only_missed)
{
    struct grid grid = grid_start(1, "what must hold|measured|must be|+-|verdict");
    for (size_t i = 0; i < report->num_verdicts; i++) {
        const struct classic_verdict *verdict = &report->verdicts[i];
        bool is_near = verdict->relation[0] == '~';
        char tolerance[TEXT] = "";
        if (verdict->is_held && only_missed) {
            continue;
        }
        if (is_near) {
            snprintf(tolerance, sizeof tolerance, "%.2g", verdict->tolerance);
        }
        grid_row(&grid, "%s|%.4g|%s%s%.4g|%s|%s", verdict->what, verdict->value,
                 is_near ? "" : verdict->relation, is_near ? "" : " ", verdict->expected, tolerance,
                 verdict->is_held ? "ok" : "MISSED");
    }
    return grid;
}

/* ---- the terminal ---------------------------------------------------------------------------- */

static void print_grid(struct grid grid)
{
    if (grid.num_rows > 1) {
        grid_print(&grid, stdout);
        printf("\n");
    }
    grid_free(&grid);
}

void classic_print(const struct classic_report *report)
{
    printf("The paper's experiments: %zu runs a case, seed %llu; measured/reference\n\n",
           report->num_runs, (unsigned long long)report->seed);
    print_grid(classic_situations_grid(report));
    printf("The paper's Table 2\n\n");
    print_grid(classic_words_grid(report));
    printf("Situation IV at other noises, %zu runs each\n\n", report->num_sweep_runs);
    print_grid(classic_sweep_grid(report));
    printf("Times of one search in Situation IV, one at a time\n\n");
    print_grid(classic_times_grid(report));
    print_grid(classic_verdicts_grid(report, true));
    printf("Of the paper's experiments: %d held, %d missed\n\n", report->held, report->missed);
}

/* ---- JSON ------------------------------------------------------------------------------------ */

static cJSON *summary_json(const struct classic_summary *summary)
{
    static const char *const names[CLASSIC_FIGURES] = {"detected",         "met",   "false_peaks",
                                                       "discrimination",   "top3",  "rho_error_m",
                                                       "theta_error_mrad", "votes", "decline"};
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "case", summary->situation->name);
    cJSON_AddStringToObject(object, "method", classic_method_names[summary->method]);
    json_add_number(object, "noise_m", summary->situation->noise_m);
    for (size_t i = 0; i < CLASSIC_FIGURES; i++) {
        char name[TEXT];
        json_add_number(object, names[i], summary->mean[i]);
        snprintf(name, sizeof name, "%s_standard_error", names[i]);
        json_add_number(object, name, summary->error[i]);
    }
    if (summary->method == CLASSIC_KERNEL) {
        json_add_number(object, "found", summary->found);
        json_add_number(object, "false_tracks", summary->false_tracks);
    }
    json_add_number(object, "time_us", summary->time_us);
    return object;
}

static cJSON *time_json(const struct classic_time *time)
{
    static const char *const names[CLASSIC_METHODS + 1] = {"ht",    "mht",     "iht",     "nht_a",
                                                           "nht_c", "default", "dense_ht"};
    cJSON *object = cJSON_CreateObject();
    json_add_number(object, "clutter_per_km2", time->per_km2);
    for (size_t i = 0; i <= CLASSIC_METHODS; i++) {
        char name[TEXT];
        snprintf(name, sizeof name, "%s_time_us", names[i]);
        json_add_number(object, name, time->time_us[i]);
        snprintf(name, sizeof name, "%s_votes", names[i]);
        json_add_number(object, name, time->votes[i]);
    }
    return object;
}

static cJSON *verdict_json(const struct classic_verdict *verdict)
{
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "what", verdict->what);
    json_add_number(object, "value", verdict->value);
    cJSON_AddStringToObject(object, "relation", verdict->relation);
    json_add_number(object, "expected", verdict->expected);
    json_add_number(object, "tolerance", verdict->tolerance);
    cJSON_AddBoolToObject(object, "held", verdict->is_held);
    return object;
}

void classic_json(const struct classic_report *report, cJSON *root)
{
    cJSON *object = cJSON_AddObjectToObject(root, "paper");
    cJSON *cases = cJSON_AddArrayToObject(object, "cases"),
          *sweep = cJSON_AddArrayToObject(object, "noise_sweep");
    cJSON *times = cJSON_AddArrayToObject(object, "times"),
          *bars = cJSON_AddArrayToObject(object, "bars");
    for (size_t method = 0; method < CLASSIC_METHODS; method++) {
        for (size_t i = 0; i < SITUATIONS && classic_has(report, method); i++) {
            cJSON_AddItemToArray(cases, summary_json(&report->summaries[i][method]));
        }
        for (size_t i = 0; i < CLASSIC_NOISES && report->sweep[0][method].situation != NULL; i++) {
            cJSON_AddItemToArray(sweep, summary_json(&report->sweep[i][method]));
        }
    }
    for (size_t i = 0; i < report->num_times; i++) {
        cJSON_AddItemToArray(times, time_json(&report->times[i]));
    }
    for (size_t i = 0; i < report->num_verdicts; i++) {
        cJSON_AddItemToArray(bars, verdict_json(&report->verdicts[i]));
    }
    json_add_number(object, "table3_nht_a_votes", report->table3_votes);
    cJSON_AddNumberToObject(object, "bars_held", report->held);
    cJSON_AddNumberToObject(object, "bars_missed", report->missed);
}
