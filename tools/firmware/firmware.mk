# SPDX-License-Identifier: MIT
#
# Images for Cortex-M4F and M7 on Arm's MPS2 boards, which QEMU emulates, and what runs in them.
# Part of the Makefile.

firmware := $(BUILD)/firmware
firmware_folder := tools/firmware
board := $(firmware_folder)/board
ARM_CC ?= arm-none-eabi-gcc
# For little flash: the whole program at once, no code moved out of loops, none rearranged, no paths
# taken apart, parameters as they are written. For 4 KiB of stack: no large frames put into one
# another.
FIRMWARE_OPT := -Os -flto -flto-partition=one -fno-reorder-blocks -fno-move-loop-invariants \
                -fno-tree-loop-im -fno-schedule-insns2 \
                -fno-tree-dominator-opts -fno-ipa-sra \
                --param=large-stack-frame=64 --param=large-stack-frame-growth=40

m4_cpu := -mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard
m4_flags := $(m4_cpu) -DMPS2_ETHERNET=0x40200000u
m7_flags := -mcpu=cortex-m7 -mthumb -mfpu=fpv5-d16 -mfloat-abi=hard -DMPS2_ETHERNET=0xA0000000u
firmware_flags := -std=c99 $(common_flags) $(warnings) -ffunction-sections -fdata-sections \
                  -I$(firmware_folder)
firmware_link := -nostartfiles -Wl,--gc-sections -L$(board)/mps2
radar_flags := $(firmware_flags) -DRHO_CONFIG_FILE='"nodes/full.h"'
replay_flags := $(firmware_flags)
# What a compiler calls must not be made of calls to itself.
memory_flags := -fno-builtin -fno-tree-loop-distribute-patterns -fno-lto

# What any compiler can look at: all but what is the board's.
firmware_portable := $(wildcard $(firmware_folder)/*.c $(board)/*.c $(board)/host/*.c)
firmware_scripts := $(wildcard $(board)/mps2/*.ld) $(firmware_folder)/firmware.mk
firmware_node := $(firmware_folder)/lcm_datagram_node.c
radar_sources := $(library_sources) $(firmware_node) $(firmware_folder)/radar_node_main.c \
                 $(board)/udp_frame.c $(board)/memory.c \
                 $(addprefix $(board)/mps2/,startup.c board_mps2.c lan9118.c)
replay_sources := $(library_sources) $(firmware_node) $(firmware_folder)/replay.c \
                  $(board)/memory.c \
                  $(addprefix $(board)/mps2/,startup.c semihosting.c)

# --- images: build/firmware/CORE/IMAGE.elf ---------------------------------------------------

# The configurations of nodes/, and whose processor is to take them.
node_names_m4 := en_route marine people smallest paper traffic
node_names_m7 := traffic
worst_names_m4 := full finders $(filter-out paper,$(node_names_m4))
# Those that play records, too.
replay_names := smallest paper people traffic
replays := $(replay_names:%=$(firmware)/m4/nodes/%-replay.elf)
node_images := $(foreach core,m4 m7,$(node_names_$(core):%=$(firmware)/$(core)/nodes/%.elf))
worst_images := $(worst_names_m4:%=$(firmware)/m4/worst/%.elf)
firmware_images := $(foreach core,m4 m7,$(firmware)/$(core)/radar.elf \
                                        $(firmware)/$(core)/replay.elf)

## Build the firmware example for Cortex-M4F and M7: a radar node, and the node on records
## (build/firmware)
firmware: $(firmware_images) $(node_images)
	@BUILD=$(BUILD) $(firmware_folder)/check_memory.sh

## Run these images in QEMU: the same bytes as everywhere, LCM over their Ethernet, load; ends with
## `N passed, N failed`
firmware-test:
	@tools/setup.sh
	@tools/setup.sh firmware
	@BUILD=$(BUILD) tools/setup_python.sh
	@$(MAKE) --no-print-directory $(jobs) all $(firmware_images) $(node_images) $(replays) \
	    $(worst_images) $(replay) $(replay_radar) $(replay_paper) $(firmware_tests)
	@BUILD=$(BUILD) tests/run.sh $(firmware_tests) $(sort $(wildcard tests/firmware/*.sh))

firmware_tests := $(addprefix $(BUILD)/tests/firmware/,test_udp_frame test_node_sender_filter)
$(BUILD)/tests/firmware/test_node_sender_filter: $(firmware_node) $(library)
$(BUILD)/tests/firmware/%: tests/firmware/%.c $(board)/udp_frame.c Makefile
	$(call compile,$(test_flags)) -MF $@.d $(LDFLAGS) -o $@ $(filter %.c %.a,$^) -lcmocka -lm

firmware_compile = @mkdir -p $(@D) && echo "  arm      $@" && $(ARM_CC) $(1) -c -o $@ $<
firmware_bind = @echo "  link     $@" && $(ARM_CC) $(1) $(firmware_link) -Wl,-Map=$@.map -o $@ $(2)

$(firmware)/m4/%/memory.o $(firmware)/m7/%/memory.o: private part_flags := $(memory_flags)
# The one node's address, known in all functions, would be loaded field by field.
$(foreach core,m4 m7,$(firmware)/$(core)/%/lcm_datagram_node.o): private part_flags := -fno-ipa-cp
# The update of hypotheses is not put into the step: starts need the stack that it leaves.
$(foreach core,m4 m7,$(firmware)/$(core)/%/step/update.o): private \
    part_flags := -fno-inline-functions-called-once

define firmware_core # m4 or m7
$(firmware)/$(1)/radar.elf: $(radar_sources:%.c=$(firmware)/$(1)/radar/%.o) $(firmware_scripts)
	$$(call firmware_bind,$$($(1)_flags) $(FIRMWARE_OPT) -nostdlib -T node.ld,$$(filter %.o,$$^) -lgcc)
$(firmware)/$(1)/replay.elf: $(replay_sources:%.c=$(firmware)/$(1)/replay/%.o) $(firmware_scripts)
	$$(call firmware_bind,$$($(1)_flags) $(FIRMWARE_OPT) -nodefaultlibs -T large.ld, \
	    $$(filter %.o,$$^) -lc -lgcc)
$(firmware)/$(1)/radar/%.o: %.c Makefile $(firmware_folder)/firmware.mk
	$$(call firmware_compile,$$($(1)_flags) $(radar_flags) $(FIRMWARE_OPT) $$(part_flags))
$(firmware)/$(1)/replay/%.o: %.c Makefile $(firmware_folder)/firmware.mk
	$$(call firmware_compile,$$($(1)_flags) $(replay_flags) $(FIRMWARE_OPT) $$(part_flags))
endef
$(foreach core,m4 m7,$(eval $(call firmware_core,$(core))))

# --- configurations of nodes/: build/firmware/CORE/nodes/NAME.elf; their worst scans: worst/ ------

worst_search_finders := worst_bearing_search
worst_sources = $(library_sources) \
                tools/instructions/$(or $(worst_search_$(1)),worst_step_search).c \
                $(addprefix $(board)/mps2/,startup.c semihosting.c newlib_stdout.c)

define node_of # core, name
$(firmware)/$(1)/nodes/$(2).elf: \
    $(patsubst %.c,$(firmware)/$(1)/nodes/$(2)/%.o,$(radar_sources)) \
    $(firmware_scripts)
	$$(call firmware_bind,$$($(1)_flags) $(FIRMWARE_OPT) -nostdlib -T node.ld,$$(filter %.o,$$^) -lgcc)
$(firmware)/$(1)/nodes/$(2)/%.o: %.c Makefile $(firmware_folder)/firmware.mk
	$$(call firmware_compile,$$($(1)_flags) $(firmware_flags) \
	    -DRHO_CONFIG_FILE='"nodes/$(2).h"' $(FIRMWARE_OPT) $$(part_flags))
endef
define worst_of # core, name
$(firmware)/$(1)/worst/$(2).elf: \
    $(patsubst %.c,$(firmware)/$(1)/worst/$(2)/%.o,$(call worst_sources,$(2))) \
    $(firmware_scripts)
	$$(call firmware_bind,$$($(1)_flags) $(FIRMWARE_OPT) --specs=rdimon.specs -T large.ld, \
	    $$(filter %.o,$$^))
$(firmware)/$(1)/worst/$(2)/%.o: %.c Makefile $(firmware_folder)/firmware.mk
	$$(call firmware_compile,$$($(1)_flags) $(firmware_flags) -DCOUNT_ON_TARGET \
	    -DRHO_CONFIG_FILE='"nodes/$(2).h"' $(FIRMWARE_OPT))
endef
$(foreach core,m4 m7,$(foreach name,$(node_names_$(core)),$(eval $(call node_of,$(core),$(name)))))
$(foreach name,$(worst_names_m4),$(eval $(call worst_of,m4,$(name))))

define replay_of # name
$(firmware)/m4/nodes/$(1)-replay.elf: \
    $(patsubst %.c,$(firmware)/m4/nodes/$(1)/%.o,$(replay_sources)) \
    $(firmware_scripts)
	$$(call firmware_bind,$$(m4_flags) $(FIRMWARE_OPT) -nodefaultlibs -T large.ld, \
	    $$(filter %.o,$$^) -lc -lgcc)
endef
$(foreach name,$(replay_names),$(eval $(call replay_of,$(name))))

## Search for the scans that cost each shipped configuration of the node most (WORST_SKIES=400
## WORST_SEED=1); minutes
worst: $(worst_images)
	@BUILD=$(BUILD) tools/gates/worst_steps.sh

# --- jobs of tools/instructions: build/firmware/CORE/jobs/NAME.elf ---------------------------

job_sources := $(sort $(wildcard tools/instructions/*.c))
job_parts := $(addprefix $(board)/mps2/,startup.c semihosting.c newlib_stdout.c)
job_names := $(filter-out hough worst_%,$(basename $(notdir $(job_sources))))
job_images := $(foreach core,m4 m7,$(job_names:%=$(firmware)/$(core)/jobs/%.elf))
job_flags := $(firmware_flags) -DCOUNT_ON_TARGET -O2

define job_core # m4 or m7
$(firmware)/$(1)/jobs/librhotrack.a: $(library_sources:%.c=$(firmware)/$(1)/jobs/%.o)
	@rm -f $$@ && echo "  ar       $$@" && ar rcs $$@ $$^
$(firmware)/$(1)/jobs/%.elf: $(firmware)/$(1)/jobs/tools/instructions/%.o \
                             $(job_parts:%.c=$(firmware)/$(1)/jobs/%.o) \
                             $(firmware)/$(1)/jobs/librhotrack.a $(firmware_scripts)
	$$(call firmware_bind,$$($(1)_flags) --specs=rdimon.specs -T large.ld,$$(filter %.o %.a,$$^))
$(firmware)/$(1)/jobs/%.o: %.c Makefile $(firmware_folder)/firmware.mk
	$$(call firmware_compile,$$($(1)_flags) $(job_flags))
endef
$(foreach core,m4 m7,$(eval $(call job_core,$(core))))

# --- the replay on this machine --------------------------------------------------------------

# Many sources at once leave no list of the headers that each needs.
replay_needs := $(firmware_node) $(firmware_folder)/replay.c $(board)/host/files_host.c
replay_headers := $(wildcard include/rhotrack/*.h include/rhotrack/detail/*.h src/*/*.h \
                             $(firmware_folder)/*.h $(board)/*.h)

replay := $(BUILD)/firmware/replay
$(replay): $(replay_needs) $(library) $(replay_headers) Makefile
	$(call compile,$(replay_flags)) $(LDFLAGS) -MF /dev/null -o $@ $(filter %.c %.a,$^)

# With the capacities of an image: what it must send.
replay_radar := $(BUILD)/firmware/replay-radar
$(replay_radar): $(replay_needs) $(library_sources) $(replay_headers) Makefile
	$(call compile,$(radar_flags)) $(LDFLAGS) -MF /dev/null -o $@ $(filter %.c,$^)
replay_paper := $(BUILD)/firmware/replay-paper
$(replay_paper): $(replay_needs) $(library_sources) $(replay_headers) \
                 $(firmware_folder)/nodes/paper.h Makefile
	$(call compile,$(firmware_flags) -DRHO_CONFIG_FILE='"nodes/paper.h"') $(LDFLAGS) \
	    -MF /dev/null -o $@ $(filter %.c,$^)

.PHONY: firmware firmware-test job-images worst
job-images: $(job_images)
.SECONDARY: $(foreach core,m4 m7,$(job_sources:%.c=$(firmware)/$(core)/jobs/%.o) \
                                 $(job_parts:%.c=$(firmware)/$(core)/jobs/%.o))

-include $(firmware_tests:=.d) $(shell find $(firmware) -name "*.d" 2>/dev/null)
