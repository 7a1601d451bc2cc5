/* SPDX-License-Identifier: MIT */
/*
 * Item lengths of EUROCONTROL-SPEC-0149, parts 2a (CAT001), 2b (CAT002, CAT034), 4 (CAT048) and 9
 * (CAT062).
 */
#include "io/asterix/asterix_item_lengths.h"

#define COUNT(list) (uint8_t)(sizeof(list) / sizeof(*(list)))
#define FIXED(name, bytes)                                                                         \
    {                                                                                              \
        name, ASTERIX_FIXED, bytes, 0, NULL                                                        \
    }
#define EXTENDED(name)                                                                             \
    {                                                                                              \
        name, ASTERIX_EXTENDED, 1, 0, NULL                                                         \
    }
#define REPEATED(name, bytes)                                                                      \
    {                                                                                              \
        name, ASTERIX_REPEATED, bytes, 0, NULL                                                     \
    }
#define REPEATED_FX(name, bytes)                                                                   \
    {                                                                                              \
        name, ASTERIX_REPEATED_FX, bytes, 0, NULL                                                  \
    }
#define EXPLICIT(name)                                                                             \
    {                                                                                              \
        name, ASTERIX_EXPLICIT, 0, 0, NULL                                                         \
    }
#define COMPOUND(name, parts)                                                                      \
    {                                                                                              \
        name, ASTERIX_COMPOUND, 0, COUNT(parts), parts                                             \
    }
#define NONE                                                                                       \
    {                                                                                              \
        "", ASTERIX_NONE, 0, 0, NULL                                                               \
    }

#define ANY(name)                                                                                  \
    {                                                                                              \
        name, ASTERIX_ANY, 0, 0, NULL                                                              \
    }

static const struct asterix_item i001[I001_ITEMS] = {
    FIXED("010", 2),
    EXTENDED("020"),
    FIXED("040", 4),
    FIXED("070", 2),
    FIXED("090", 2),
    EXTENDED("130"),
    FIXED("141", 2),
    FIXED("050", 2),
    FIXED("120", 1),
    FIXED("131", 1),
    FIXED("080", 2),
    FIXED("100", 4),
    FIXED("060", 2),
    EXTENDED("030"),
    FIXED("150", 1),
    NONE,
    NONE,
    NONE,
    NONE,
    EXPLICIT("SP"),
    ANY("RFS"),
};

static const struct asterix_item i001_track[I001_TRACK_ITEMS] = {
    FIXED("010", 2), EXTENDED("020"), FIXED("161", 2), FIXED("040", 4), FIXED("042", 4),
    FIXED("200", 4), FIXED("070", 2), FIXED("090", 2), FIXED("141", 2), EXTENDED("130"),
    FIXED("131", 1), FIXED("120", 1), EXTENDED("170"), EXTENDED("210"), FIXED("050", 2),
    FIXED("080", 2), FIXED("100", 4), FIXED("060", 2), EXTENDED("030"), EXPLICIT("SP"),
    ANY("RFS"),      FIXED("150", 1),
};

static const struct asterix_item i002[I002_ITEMS] = {
    FIXED("010", 2), FIXED("000", 1), FIXED("020", 1), FIXED("030", 3),
    FIXED("041", 2), EXTENDED("050"), EXTENDED("060"), REPEATED("070", 2),
    FIXED("100", 8), FIXED("090", 2), EXTENDED("080"), NONE,
    EXPLICIT("SP"),  ANY("RFS"),
};

static const struct asterix_item i034_050[] = {
    FIXED("COM", 1), NONE, NONE, FIXED("PSR", 1), FIXED("SSR", 1), FIXED("MDS", 2)};
static const struct asterix_item i034_060[] = {
    FIXED("COM", 1), NONE, NONE, FIXED("PSR", 1), FIXED("SSR", 1), FIXED("MDS", 1)};

static const struct asterix_item i034[I034_ITEMS] = {
    FIXED("010", 2),
    FIXED("000", 1),
    FIXED("030", 3),
    FIXED("020", 1),
    FIXED("041", 2),
    COMPOUND("050", i034_050),
    COMPOUND("060", i034_060),
    REPEATED("070", 2),
    FIXED("100", 8),
    FIXED("110", 1),
    FIXED("120", 8),
    FIXED("090", 2),
    EXPLICIT("RE"),
    EXPLICIT("SP"),
};

static const struct asterix_item i048_130[] = {FIXED("SRL", 1), FIXED("SRR", 1), FIXED("SAM", 1),
                                               FIXED("PRL", 1), FIXED("PAM", 1), FIXED("RPD", 1),
                                               FIXED("APD", 1)};
static const struct asterix_item i048_120[] = {FIXED("CAL", 2), REPEATED("RDS", 6)};

static const struct asterix_item i048[I048_ITEMS] = {
    FIXED("010", 2),
    FIXED("140", 3),
    EXTENDED("020"),
    FIXED("040", 4),
    FIXED("070", 2),
    FIXED("090", 2),
    COMPOUND("130", i048_130),
    FIXED("220", 3),
    FIXED("240", 6),
    REPEATED("250", 8),
    FIXED("161", 2),
    FIXED("042", 4),
    FIXED("200", 4),
    EXTENDED("170"),
    FIXED("210", 4),
    EXTENDED("030"),
    FIXED("080", 2),
    FIXED("100", 4),
    FIXED("110", 2),
    COMPOUND("120", i048_120),
    FIXED("230", 2),
    FIXED("260", 7),
    FIXED("055", 1),
    FIXED("050", 2),
    FIXED("065", 1),
    FIXED("060", 2),
    EXPLICIT("SP"),
    EXPLICIT("RE"),
};

static const struct asterix_item i062_380[] = {
    FIXED("ADR", 3), FIXED("ID", 6),  FIXED("MHG", 2), FIXED("IAS", 2),     FIXED("TAS", 2),
    FIXED("SAL", 2), FIXED("FSS", 2), EXTENDED("TIS"), REPEATED("TID", 15), FIXED("COM", 2),
    FIXED("SAB", 2), FIXED("ACS", 7), FIXED("BVR", 2), FIXED("GVR", 2),     FIXED("RAN", 2),
    FIXED("TAR", 2), FIXED("TAN", 2), FIXED("GS", 2),  FIXED("VUN", 1),     FIXED("MET", 8),
    FIXED("EMC", 1), FIXED("POS", 6), FIXED("GAL", 2), FIXED("PUN", 1),     REPEATED("MB", 8),
    FIXED("IAR", 2), FIXED("MAC", 2), FIXED("BPS", 2)};
static const struct asterix_item i062_290[] = {
    FIXED("TRK", 1), FIXED("PSR", 1), FIXED("SSR", 1), FIXED("MDS", 1), FIXED("ADS", 2),
    FIXED("ES", 1),  FIXED("VDL", 1), FIXED("UAT", 1), FIXED("LOP", 1), FIXED("MLT", 1)};
static const struct asterix_item i062_295[] = {
    FIXED("MFL", 1), FIXED("MD1", 1), FIXED("MD2", 1), FIXED("MDA", 1), FIXED("MD4", 1),
    FIXED("MD5", 1), FIXED("MHG", 1), FIXED("IAS", 1), FIXED("TAS", 1), FIXED("SAL", 1),
    FIXED("FSS", 1), FIXED("TID", 1), FIXED("COM", 1), FIXED("SAB", 1), FIXED("ACS", 1),
    FIXED("BVR", 1), FIXED("GVR", 1), FIXED("RAN", 1), FIXED("TAR", 1), FIXED("TAN", 1),
    FIXED("GSP", 1), FIXED("VUN", 1), FIXED("MET", 1), FIXED("EMC", 1), FIXED("POS", 1),
    FIXED("GAL", 1), FIXED("PUN", 1), FIXED("MB", 1),  FIXED("IAR", 1), FIXED("MAC", 1),
    FIXED("BPS", 1)};
static const struct asterix_item i062_390[] = {
    FIXED("TAG", 2), FIXED("CS", 7),     FIXED("IFI", 4), FIXED("FCT", 1), FIXED("TAC", 4),
    FIXED("WTC", 1), FIXED("DEP", 4),    FIXED("DST", 4), FIXED("RDS", 3), FIXED("CFL", 2),
    FIXED("CTL", 2), REPEATED("TOD", 4), FIXED("AST", 6), FIXED("STS", 1), FIXED("STD", 7),
    FIXED("STA", 7), FIXED("PEM", 2),    FIXED("PEC", 7)};
static const struct asterix_item i062_110[] = {FIXED("SUM", 1), FIXED("PMN", 4), FIXED("POS", 6),
                                               FIXED("GA", 2),  FIXED("EM1", 2), FIXED("TOS", 1),
                                               FIXED("XP", 1)};
static const struct asterix_item i062_500[] = {FIXED("APC", 4), FIXED("COV", 2), FIXED("APW", 4),
                                               FIXED("AGA", 1), FIXED("ABA", 1), FIXED("ATV", 2),
                                               FIXED("AA", 2),  FIXED("ARC", 1)};
static const struct asterix_item i062_340[] = {FIXED("SID", 2), FIXED("POS", 4), FIXED("HEI", 2),
                                               FIXED("MDC", 2), FIXED("MDA", 2), FIXED("TYP", 1)};

static const struct asterix_item i062[I062_ITEMS] = {
    FIXED("010", 2),
    NONE,
    FIXED("015", 1),
    FIXED("070", 3),
    FIXED("105", 8),
    FIXED("100", 6),
    FIXED("185", 4),
    FIXED("210", 2),
    FIXED("060", 2),
    FIXED("245", 7),
    COMPOUND("380", i062_380),
    FIXED("040", 2),
    EXTENDED("080"),
    COMPOUND("290", i062_290),
    FIXED("200", 1),
    COMPOUND("295", i062_295),
    FIXED("136", 2),
    FIXED("130", 2),
    FIXED("135", 2),
    FIXED("220", 2),
    COMPOUND("390", i062_390),
    EXTENDED("270"),
    FIXED("300", 1),
    COMPOUND("110", i062_110),
    FIXED("120", 2),
    REPEATED_FX("510", 3),
    COMPOUND("500", i062_500),
    COMPOUND("340", i062_340),
    NONE,
    NONE,
    NONE,
    NONE,
    NONE,
    EXPLICIT("RE"),
    EXPLICIT("SP"),
};

const struct asterix_category *asterix_category_find_profile(uint8_t category, bool is_cat001_track)
{
    static const struct asterix_category tracks = {1, I001_TRACK_ITEMS, i001_track};
    static const struct asterix_category categories[] = {{1, I001_ITEMS, i001},
                                                         {2, I002_ITEMS, i002},
                                                         {34, I034_ITEMS, i034},
                                                         {48, I048_ITEMS, i048},
                                                         {62, I062_ITEMS, i062}};

    if (category == tracks.category && is_cat001_track) {
        return &tracks;
    }
    for (size_t i = 0; i < sizeof categories / sizeof *categories; i++) {
        if (categories[i].category == category) {
            return &categories[i];
        }
    }
    return NULL;
}
