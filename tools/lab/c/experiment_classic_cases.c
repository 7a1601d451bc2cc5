/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "experiment_classic.h"
#include "settings/method.h"

const char *const classic_method_names[CLASSIC_METHODS] = {"HT",    "MHT",   "IHT",
                                                           "NHT A", "NHT C", "default"};

unsigned classic_methods_named(const char *name)
{
    static const unsigned methods[NUM_METHODS] = {
        [METHOD_KERNEL] = 1u << CLASSIC_KERNEL,
        [METHOD_HT] = 1u << RHO_HOUGH_HT,
        [METHOD_MHT] = 1u << RHO_HOUGH_MHT,
        [METHOD_IHT] = 1u << RHO_HOUGH_IHT,
        [METHOD_NHT] = 1u << RHO_HOUGH_NHT_A | 1u << RHO_HOUGH_NHT_C,
    };
    if (name == NULL) {
        return (1u << CLASSIC_METHODS) - 1u;
    }
    for (int i = 0; i < NUM_METHODS; i++) {
        if (strcmp(name, method_name((enum method)i)) == 0) {
            return methods[i];
        }
    }
    return 0;
}

/* ---- Situations ------------------------------------------------------------------------------ */

#define CROSSING_CASE(label, density, count)                                                       \
    {                                                                                              \
        .group = "-", .name = (label), .paths = PATHS_CROSSING, .box = {0, 4000, -1000, 1500},     \
        .clutter_per_km2 = (density), .clutter_per_scan = (count), .true_pd = 0.99,                \
        .min_scans = 5, .score_min_nat = -3.0, .tolerance_m = 30.0, .bars = {                      \
            NAN,                                                                                   \
            NAN,                                                                                   \
            NAN                                                                                    \
        }                                                                                          \
    }
#define REAL_CASE(label, count)                                                                    \
    {                                                                                              \
        .group = "-", .name = (label), .paths = PATHS_RADAR, .box = {-25000, -1000, 13000, 29000}, \
        .clutter_per_scan = (count), .true_pd = 0.99, .min_scans = 5, .score_min_nat = -3.0,       \
        .tolerance_m = 120.0, .bars = {                                                            \
            NAN,                                                                                   \
            NAN,                                                                                   \
            NAN                                                                                    \
        }                                                                                          \
    }

const struct classic_situation classic_situations[SITUATIONS] = {
    {"I", "Situation I: no noise, no clutter", "Fig. 7", CROSSING_CASE("I", 0, 0), 0.0, 5000.0f,
     30.0},
    {"II", "Situation II: 10 m of noise, no clutter", "Fig. 8", CROSSING_CASE("II", 0, 0), 10.0,
     5000.0f, 30.0},
    {"III", "Situation III: no noise, 10 clutter plots a square kilometre and scan", "Fig. 9",
     CROSSING_CASE("III", 10, 0), 0.0, 5000.0f, 30.0},
    {"IV", "Situation IV: 10 m of noise, 10 clutter plots a square kilometre and scan", "Fig. 10",
     CROSSING_CASE("IV", 10, 0), 10.0, 5000.0f, 30.0},
    {"IV thin", "Situation IV with 10 clutter plots a scan", NULL, CROSSING_CASE("IV thin", 0, 10),
     10.0, 5000.0f, 30.0},
    {"real 10", "Real data with 10 clutter plots a scan", "Fig. 15", REAL_CASE("real 10", 10), 0.0,
     36000.0f, 100.0},
    {"real 100", "Real data with 100 clutter plots a scan", "Fig. 15", REAL_CASE("real 100", 100),
     0.0, 36000.0f, 100.0},
};

/* ---- reference ------------------------------------------------------------------------------- */

#define R(...)                                                                                     \
    {                                                                                              \
        {                                                                                          \
            __VA_ARGS__                                                                            \
        }                                                                                          \
    }

/* Detected, met, false peaks, discrimination, three highest, rho (m), theta (mrad), votes. */
const struct classic_reference classic_references[SITUATIONS][CLASSIC_KERNEL] = {
    [SITUATION_I] = {R("1.00", "1.00", "0", "2.0", "1.00", "1.5", ".79", "65k"),
                     R("1.00", "1.00", "0", "2.0", "1.00", "1.4", ".21", "53"),
                     R("1.00", "1.00", "0", "2.0", "1.00", "1.4", ".21", "22"),
                     R(".98", ".98", "0", "1.95", ".98", "1.4", ".21", "15"),
                     R(".98", ".98", "0", "1.95", ".98", "1.4", ".21", "4.2k")},
    [SITUATION_II] = {R(".98", "1.00", "115", "1.30", ".48", "7.7", "3.5", "65k"),
                      R(".71", ".99", "38", ".79", ".02", "10", "3.9", "53"),
                      R(".70", ".99", "9", ".78", ".02", "9", "3.9", "22"),
                      R(".14", ".35", "0", ".3...4", ".14", "8", "3.9", "2"),
                      R(".14", ".35", "0", ".3...4", ".14", "8", "3.9", "484")},
    [SITUATION_III] = {R("1.00", "1.00", "2362", ".87", ".20", "1.6", ".78", "2.26M"),
                       R(".99", ".99", "114", "1.03", ".51", "1.4", ".22", "63k"),
                       R("1.00", "1.00", "1.1", "1.92", "1.00", "1.4", ".21", "9.4k"),
                       R(".99", ".99", "0.0", "1.93", ".99", "1.4", ".2", "1.9k"),
                       R(".98", ".99", "2.9", "1.50", ".97", "1.4", ".2", "535k")},
    [SITUATION_IV] = {R(".86", ".96", "2729", ".63", ".01", "11", "3.7", "2.26M"),
                      R(".16", ".37", "262", ".34", ".00", "14", "4.0", "63k"),
                      R(".34", ".47", "1335", ".40", ".00", "12", "3.7", "9.4k"),
                      R(".09", ".23", "80", ".24", ".00", "9..12", "3.5..4.3", "1.9k"),
                      R(".07", ".22", "36", ".25", ".01", "9..12", "3.5..4.3", "535k")},
    [SITUATION_THIN] = {R(".96", "1.0", "968", ".84", ".14", "", "", "286k"),
                        R("", "", "", "", "", "", "", ""),
                        R(".69", "1.0", "152", ".73", ".02", "", "", "171"),
                        R("", "", "", "", "", "", "", ""),
                        R(".14", ".35", "1.0", ".32", ".13", "", "", "1150")},
    [SITUATION_REAL] = {R(".97", "1.0", "2156", ".65", ".00", "", "", ""),
                        R(".62", ".96", "896", ".36", ".00", "", "", ""),
                        R(".65", ".99", "112", ".65", ".00", "", "", ""),
                        R(".003", ".02", "1", ".01", "0", "", "", ""),
                        R(".003", ".02", "1", ".01", "0", "", "", "")},
    [SITUATION_REAL_DENSE] = {R(".22", ".61", "4054", ".48", ".00", "", "", "2.26M"),
                              R(".07", ".28", "744", ".25", ".00", "", "", "63k"),
                              R(".62", ".91", "3883", ".37", ".00", "", "", "6.4k"),
                              R(".03", ".12", "74", ".04", ".00", "", "", "238"),
                              R(".01", ".05", "34", ".04", ".00", "", "", "69k")},
};

/* "2.26M": 2.26e6 and half a unit of its last digit, 0.005e6. */
static struct classic_expected one_number(const char *text, const char *end)
{
    double unit = 1.0;
    const char *point = memchr(text, '.', (size_t)(end - text));
    const char *last = end;
    double factor = last[-1] == 'M' ? 1e6 : last[-1] == 'k' ? 1e3 : 1.0;
    if (factor > 1.0) {
        last--;
    }
    for (const char *at = point; point != NULL && at + 1 < last; at++) {
        unit /= 10.0;
    }
    return (struct classic_expected){true, strtod(text, NULL) * factor, unit * factor / 2.0};
}

struct classic_expected classic_expected(size_t situation, size_t method,
                                         enum classic_figure figure)
{
    const char *text = method < CLASSIC_KERNEL && figure <= CLASSIC_VOTES
                           ? classic_references[situation][method].figures[figure]
                           : "";
    const char *dots = strstr(text, "..");
    if (text[0] == '\0') {
        return (struct classic_expected){false, NAN, NAN};
    }
    if (dots == NULL) {
        return one_number(text, text + strlen(text));
    }
    struct classic_expected low = one_number(text, dots),
                            high = one_number(dots + 2, text + strlen(text));
    double half = (high.value - low.value) / 2.0;
    return (struct classic_expected){true, low.value + half, half + high.rounding};
}

/* ---- Table 2 --------------------------------------------------------------------------------- */

const char *classic_word(size_t situation, size_t method, size_t row)
{
    static const char *const words[4][3][4] = {
        {{"high", "high", "high", "high"},
         {"slight", "none", "none", "slight"},
         {"none", "slight", "slight", "slight"}},
        {{"high", "low", "low", "high"},
         {"slight", "medium", "medium", "slight"},
         {"slight", "serious", "serious", "slight"}},
        {{"low", "high", "high", "high"},
         {"slight", "slight", "slight", "slight"},
         {"slight", "slight", "slight", "slight"}},
        {{"low", "low", "low", "high"},
         {"medium", "serious", "serious", "slight"},
         {"medium", "serious", "serious", "slight"}},
    };
    if (situation > SITUATION_IV || method == CLASSIC_KERNEL) {
        return NULL;
    }
    return words[situation][row][method < RHO_HOUGH_NHT_A ? method : 3];
}
