/* SPDX-License-Identifier: MIT */
/*
 * An image of a running tracker with changed bytes and a right checksum: it is refused with nothing
 * changed, or the loaded objects can be stepped on, whatever numbers they hold. In the embedded
 * profile.
 */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "check.h"
#include "rhotrack/snapshot.h"
#include "rhotrack/tracker.h"

#define PI 3.14159265358979323846
#define SCENES 4
#define STEPS 20 /* scans before the image is saved */
#define MORE_STEPS 6
#define PLOTS 40
#define IMAGE_MAX 400000

struct pipeline {
    struct rho_tracker tracker;
    struct rho_initiator initiator;
    struct rho_passive passive;
};

static struct pipeline chain, before;
static struct rho_report report;
static _Alignas(8) uint8_t images[SCENES][IMAGE_MAX], image[IMAGE_MAX];
static size_t image_bytes;
static uint64_t random_state;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static double uniform(double from, double to)
{
    random_state = random_state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return from + (to - from) * (double)(random_state >> 11) / 9007199254740992.0;
}

/* ---- scans that are stepped ------------------------------------------------------------------ */

static double target_m(int target, double t_s, int axis)
{
    return axis ? 6e3 + 2e3 * target + 90.0 * t_s : -8e3 + 4e3 * target + (target - 1.5) * 70 * t_s;
}

/*
 * Steps a scan of a scene: 0 turns with heights and range rates, 1 sectors, 2 bearings, 3 the gate
 * of one Kalman filter.
 */
static void step_plots(int scene, int k)
{
    struct rho_plot plots[PLOTS];
    struct rho_scan scan = {.time_us = 3000000 * (int64_t)k, .sensor_id = 1, .plots = plots};
    if (scene == 0) {
        scan.measures = RHO_MEASURES_Z | RHO_MEASURES_RANGE_RATE;
    }
    if (scene == 1) {
        scan.time_us = 500000 * (int64_t)k;
        scan.sector_from_rad = (float)(k % 6 * (PI / 3) - PI);
        scan.sector_to_rad = (float)((k % 6 + 1) * (PI / 3) - PI);
    }
    for (int i = 0; i < PLOTS; i++) {
        const double t_s = 1e-6 * (double)scan.time_us, range_m = uniform(1e3, 2e4);
        const double azimuth_rad = uniform(-PI, PI);
        double x_m = i < 4 ? target_m(i, t_s, 0) : range_m * cos(azimuth_rad);
        double y_m = i < 4 ? target_m(i, t_s, 1) : range_m * sin(azimuth_rad);
        x_m += uniform(-20, 20);
        y_m += uniform(-20, 20);
        if (scene == 1 && (atan2(y_m, x_m) < (double)scan.sector_from_rad ||
                           atan2(y_m, x_m) >= (double)scan.sector_to_rad)) {
            continue;
        }
        plots[scan.num_plots++] = (struct rho_plot){.x_m = (float)x_m,
                                                    .y_m = (float)y_m,
                                                    .z_m = 1000.0f,
                                                    .range_rate_mps = (float)uniform(-90, 90),
                                                    .sigma_range_m = 20.0f,
                                                    .sigma_cross_m = 30.0f,
                                                    .sigma_up_m = 50.0f,
                                                    .sigma_range_rate_mps = 40.0f};
    }
    (void)!rho_tracker_step(&chain.tracker, &chain.initiator, &scan, &report);
}

static void step_bearings(int k)
{
    struct rho_bearing bearings[3][5];
    struct rho_bearing_scan looks[3];
    const double t_s = 5.0 * k;
    for (int s = 0; s < 3; s++) {
        looks[s] = (struct rho_bearing_scan){.time_us = 5000000 * (int64_t)k,
                                             .sensor_id = 10 + s,
                                             .x_m = (float)(9e3 * (s - 1)),
                                             .y_m = s == 1 ? -3e3f : 0.0f,
                                             .num_bearings = 5,
                                             .bearings = bearings[s]};
        for (int i = 0; i < 5; i++) {
            const double x_m = target_m(i, t_s, 0) - (double)looks[s].x_m;
            const double y_m = target_m(i, t_s, 1) - (double)looks[s].y_m;
            bearings[s][i] = (struct rho_bearing){
                .bearing_rad = (float)(i < 4 ? atan2(y_m, x_m) : uniform(-PI, PI)),
                .sigma_rad = 0.003f,
                .elevation_rad = (float)atan2(2000.0, hypot(x_m, y_m)),
                .sigma_elevation_rad = s == 0 ? 0.005f : 0.0f};
        }
    }
    for (int s = 0; s < 3; s++) {
        (void)!rho_tracker_step_bearings(&chain.tracker, &chain.passive, &looks[s], &report);
    }
}

static void step_scene(int scene, int k)
{
    if (scene == 2) {
        step_bearings(k);
    } else {
        step_plots(scene, k);
    }
}

static void start_objects(int scene)
{
    struct rho_tracker_config maintain;
    struct rho_initiator_config start;
    struct rho_passive_config passive;
    const struct rho_sensor radar = {.sensor_id = 1, .pd = 0.9f, .range_max_m = 50e3f};
    memset(&chain, 0, sizeof chain);
    rho_tracker_config_default(&maintain);
    rho_initiator_config_default(&start);
    rho_passive_config_default(&passive);
    maintain.gate = scene == 3 ? RHO_TRACKER_NEAREST : RHO_TRACKER_BEST;
    maintain.input.is_estimated = scene == 3;
    maintain.v_max_mps = start.v_max_mps = 300.0f;
    CHECK(rho_tracker_init(&chain.tracker, sizeof chain.tracker, &maintain) == RHO_OK);
    CHECK(rho_initiator_init(&chain.initiator, sizeof chain.initiator, &start) == RHO_OK);
    CHECK(rho_passive_init(&chain.passive, sizeof chain.passive, &passive) == RHO_OK);
    CHECK(rho_tracker_set_sensor(&chain.tracker, &radar) == RHO_OK);
}

/* ---- images ---------------------------------------------------------------------------------- */

static void list_snapshot_parts(struct rho_snapshot_part parts[3])
{
    parts[0] =
        (struct rho_snapshot_part){RHO_SNAPSHOT_TRACKER, 0, &chain.tracker, sizeof chain.tracker};
    parts[1] = (struct rho_snapshot_part){RHO_SNAPSHOT_INITIATOR, 0, &chain.initiator,
                                          sizeof chain.initiator};
    parts[2] =
        (struct rho_snapshot_part){RHO_SNAPSHOT_PASSIVE, 0, &chain.passive, sizeof chain.passive};
}

static void make_images(void)
{
    struct rho_snapshot_part parts[3];
    list_snapshot_parts(parts);
    for (int scene = 0; scene < SCENES; scene++) {
        random_state = 5;
        start_objects(scene);
        for (int k = 0; k < STEPS; k++) {
            step_scene(scene, k);
        }
        CHECK(report.num_tracks > 0);
        CHECK(rho_snapshot_save(parts, 3, 0, images[scene], IMAGE_MAX, &image_bytes) == RHO_OK);
        CHECK(image_bytes == rho_snapshot_size(parts, 3) && image_bytes < IMAGE_MAX);
    }
}

static void set_image_checksum(void)
{
    static uint32_t table[256];
    uint32_t crc = UINT32_MAX;
    for (uint32_t byte = 0; table[255] == 0 && byte < 256; byte++) {
        table[byte] = byte;
        for (int bit = 0; bit < 8; bit++) {
            table[byte] = table[byte] & 1u ? table[byte] >> 1 ^ 0xedb88320u : table[byte] >> 1;
        }
    }
    for (size_t i = 0; i < image_bytes - 4; i++) {
        crc = crc >> 8 ^ table[(crc ^ image[i]) & 255u];
    }
    crc = ~crc;
    for (unsigned i = 0; i < 4; i++) {
        image[image_bytes - 4 + i] = (uint8_t)(crc >> 8 * i);
    }
}

/* Regions of the image that are few bytes but hold most counts, indices and links. */
struct region {
    size_t first, bytes;
};

#define HEAD (24 + 3 * 16)
#define IN_TRACKER(field) (HEAD + offsetof(struct rho_tracker, field))
#define IN_INITIATOR(field)                                                                        \
    (HEAD + (sizeof(struct rho_tracker) + 7) / 8 * 8 + offsetof(struct rho_initiator, field))
#define IN_PASSIVE(field)                                                                          \
    (HEAD + (sizeof(struct rho_tracker) + 7) / 8 * 8 +                                             \
     (sizeof(struct rho_initiator) + 7) / 8 * 8 + offsetof(struct rho_passive, field))
#define SCAN_HEAD offsetof(struct rho_window_scan, bin_start)

static const struct region regions[] = {
    {0, HEAD},
    {HEAD, offsetof(struct rho_tracker, tracks)},
    {IN_TRACKER(tracks), 4 * sizeof(struct rho_track)},
    {IN_TRACKER(assignment), 200},
    {IN_TRACKER(hypotheses), offsetof(struct rho_hypotheses, nodes)},
    {IN_TRACKER(hypotheses.nodes), sizeof(struct rho_hypothesis) * RHO_MAX_HYPOTHESES},
    {IN_INITIATOR(magic), offsetof(struct rho_initiator, density[0].count)},
    {IN_INITIATOR(candidates), 2 * sizeof(struct rho_candidate)},
    {IN_INITIATOR(window), offsetof(struct rho_window, ring) + SCAN_HEAD + 64},
    {IN_INITIATOR(window.ring[1]), SCAN_HEAD + 64},
    {IN_INITIATOR(window.ring[5]), SCAN_HEAD + 64},
    {IN_INITIATOR(window.ring[5].marks), 2 * PLOTS},
    {IN_INITIATOR(window.ring[5].plots), PLOTS * sizeof(struct rho_window_plot)},
    {IN_PASSIVE(magic), offsetof(struct rho_passive, tracks)},
    {IN_PASSIVE(batch), offsetof(struct rho_batch, bearings) + 400},
};

/* Changes one place of the image as eight bytes of the input say. */
static void change_one_place_of_image(const uint8_t *edit)
{
    static const float numbers[] = {NAN,     INFINITY, -INFINITY, 1e30f,  -1e30f, 1e-30f,
                                    0.0f,    -0.0f,    1e15f,     -1e15f, 2e6f,   -2e6f,
                                    3.4e38f, 1.0f,     -1.0f,     1e9f};
    const unsigned which = edit[0] % (sizeof regions / sizeof regions[0] + 1u);
    struct region region = {0, image_bytes - 8};
    if (which > 0) {
        region = regions[which - 1];
    }
    size_t at =
        region.first +
        ((size_t)edit[1] | (size_t)edit[2] << 8 | (size_t)(edit[3] >> 3) << 16) % region.bytes;
    switch (edit[3] % 8) {
    case 0:
        memcpy(image + at, edit + 4, 1);
        break;
    case 1:
        memcpy(image + at / 2 * 2, edit + 4, 2);
        break;
    case 2:
        memcpy(image + at / 4 * 4, edit + 4, 4);
        break;
    case 3:
        memcpy(image + at / 4 * 4, &numbers[edit[4] % 16], 4);
        break;
    case 4:
        image[at] ^= (uint8_t)(1u << edit[4] % 8);
        break;
    case 5:
        image[at]++;
        break;
    case 6:
        image[at]--;
        break;
    default: /* copies the bytes of another place */
        memmove(image + at / 4 * 4,
                image + region.first +
                    ((size_t)edit[4] | (size_t)edit[5] << 8) % region.bytes / 4 * 4,
                4);
        break;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct rho_snapshot_part parts[3];
    if (image_bytes == 0) {
        make_images();
    }
    if (size < 9) {
        return 0;
    }
    const int scene = data[0] % SCENES;
    memcpy(image, images[scene], image_bytes);
    for (size_t at = 1; at + 8 <= size && at < 8 * 40; at += 8) {
        change_one_place_of_image(data + at);
    }
    set_image_checksum();
    memset(&chain, 0x3c, sizeof chain);
    before = chain;
    list_snapshot_parts(parts);
    if (rho_snapshot_load(parts, 3, image, image_bytes) != RHO_OK) {
        CHECK(memcmp(&before, &chain, sizeof chain) == 0);
        return 0;
    }
    random_state = 77;
    for (int k = 0; k < MORE_STEPS; k++) {
        step_scene(scene, STEPS + k);
        if (k == 3) {
            step_scene(scene == 2 ? 0 : 2, STEPS + k);
        }
    }
    return 0;
}
