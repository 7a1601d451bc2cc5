/* SPDX-License-Identifier: MIT */
/*
 * A block with settings and a taught clutter map: a device that was off continues with both and
 * without tracks; a damaged block changes nothing.
 */
#include "rhotrack/settings.h"
#include "rhotrack/snapshot.h"
#include "tracker_setup.h"

static struct rho_settings settings, loaded;
static struct rho_clutter_map taught;
static struct rho_tracker before;
static uint64_t block[(sizeof(struct rho_clutter_map) + sizeof(struct rho_settings) + 256) / 8];
static size_t block_bytes;

static unsigned snapshot_parts_of(struct rho_settings *told, struct rho_snapshot_part parts[2])
{
    parts[0] = (struct rho_snapshot_part){
        .kind = RHO_SNAPSHOT_SETTINGS, .object = told, .size = sizeof *told};
    parts[1] = (struct rho_snapshot_part){.kind = RHO_SNAPSHOT_CLUTTER_MAP,
                                          .object = &tracker.clutter_map,
                                          .size = sizeof tracker.clutter_map};
    return 2;
}

static enum rho_status load_block(void)
{
    struct rho_snapshot_part parts[2];
    return rho_snapshot_load(parts, snapshot_parts_of(&loaded, parts), block, block_bytes);
}

/* Saves a block with the settings of a harbour and five taught towers. */
static void save_block(void)
{
    struct rho_snapshot_part parts[2];
    use_usual_configs(5);
    memset(&settings, 0, sizeof settings);
    rho_settings_preset(&settings, RHO_PRESET_COASTAL_HARBOUR);
    settings.range_max_m = 12345.0f;
    begin_tracker();
    for (int i = 0; i < 5; i++) {
        assert_int_equal(rho_clutter_map_teach(&tracker.clutter_map, 7, 1000.0f * (float)i, 500.0f,
                                               10.0f, 20.0f, 50),
                         RHO_OK);
    }
    taught = tracker.clutter_map;
    const unsigned num_parts = snapshot_parts_of(&settings, parts);
    assert_in_range(rho_snapshot_size(parts, num_parts), 1, sizeof block);
    assert_int_equal(
        rho_snapshot_save(parts, num_parts, 0, (uint8_t *)block, sizeof block, &block_bytes),
        RHO_OK);
    assert_int_equal(block_bytes, rho_snapshot_size(parts, num_parts));
}

static void a_block_restores_settings_and_taught_map(void **state)
{
    uint32_t place = 0;
    unsigned echoes = 0;
    (void)state;
    save_block();
    begin_tracker(); /* as after switching the device off and on */
    memset(&loaded, 0x3c, sizeof loaded);
    assert_null(rho_clutter_map_next_known(&tracker.clutter_map, &place));
    assert_int_equal(load_block(), RHO_OK);
    assert_memory_equal(&loaded, &settings, sizeof settings);
    assert_memory_equal(&tracker.clutter_map, &taught, sizeof taught);
    for (place = 0; rho_clutter_map_next_known(&tracker.clutter_map, &place);) {
        echoes++;
    }
    assert_int_equal(echoes, 5);
    assert_true(rho_tracker_is_sound(&tracker));
    (void)add_plot(3000.0, 500.0, 10.0);
    step_at(1.0);
    assert_int_equal(report.num_tracks, 0);
}

/* One wrong bit anywhere makes loading fail; invalid settings and maps are not saved. */
static void a_damaged_block_changes_nothing(void **state)
{
    struct rho_snapshot_part parts[2];
    uint8_t *bytes = (uint8_t *)block;
    (void)state;
    save_block();
    begin_tracker();
    memset(&loaded, 0x3c, sizeof loaded);
    before = tracker;
    const struct rho_settings nothing = loaded;
    const size_t stride = block_bytes / 150 + 1;
    for (size_t at = 0; at < block_bytes; at += at < 300 ? 1 : stride) {
        bytes[at] ^= (uint8_t)(1u << at % 8);
        assert_int_not_equal(load_block(), RHO_OK);
        bytes[at] ^= (uint8_t)(1u << at % 8);
    }
    block_bytes--;
    assert_int_equal(load_block(), RHO_ERROR_SHORT);
    block_bytes++;
    assert_memory_equal(&loaded, &nothing, sizeof loaded);
    assert_memory_equal(&tracker, &before, sizeof before);
    assert_int_equal(load_block(), RHO_OK);

    /* unsound objects are not saved */
    const unsigned num_parts = snapshot_parts_of(&settings, parts);
    settings.pd = 2.0f;
    assert_int_equal(
        rho_snapshot_save(parts, num_parts, 0, (uint8_t *)block, sizeof block, &block_bytes),
        RHO_ERROR_STATE);
    settings.pd = 0.9f;
    tracker.clutter_map.v_min_mps = NAN;
    assert_int_equal(
        rho_snapshot_save(parts, num_parts, 0, (uint8_t *)block, sizeof block, &block_bytes),
        RHO_ERROR_STATE);
    parts[0].size--;
    assert_int_equal(
        rho_snapshot_save(parts, num_parts, 0, (uint8_t *)block, sizeof block, &block_bytes),
        RHO_ERROR_SIZE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_block_restores_settings_and_taught_map),
        cmocka_unit_test(a_damaged_block_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
