# SPDX-License-Identifier: MIT
#
# Images for Cortex-M4F and M7, and the replay for this machine. Part of the Makefile.

firmware := $(BUILD)/firmware
firmware_parts := tools/firmware
board := $(firmware_parts)/board
ARM_PREFIX ?= arm-none-eabi-
FIRMWARE_OPT := -Os

m4_flags := -mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard -DMPS2_ETHERNET=0x40200000u
m7_flags := -mcpu=cortex-m7 -mthumb -mfpu=fpv5-d16 -mfloat-abi=hard -DMPS2_ETHERNET=0xA0000000u
# errno: newlib's square root would ask for it where the processor has an instruction
firmware_flags := -std=c99 $(common_flags) $(warnings) -ffreestanding -fno-math-errno -ffunction-sections \
                  -fdata-sections -I$(firmware_parts)
firmware_link := -nostartfiles -nodefaultlibs -Wl,--gc-sections -L$(board)/mps2
firmware_c := $(ARM_PREFIX)gcc

node_parts := $(addprefix $(firmware_parts)/,node.c node_bearings.c)
mps2_parts := $(addprefix $(board)/,mps2/startup.c mps2/board_mps2.c mps2/lan9118.c udp_frame.c)
radar_parts := $(library_sources) $(node_parts) $(firmware_parts)/main.c $(mps2_parts)
replay_parts := $(library_sources) $(node_parts) $(firmware_parts)/replay.c $(board)/mps2/startup.c \
                $(board)/mps2/semihosting.c

firmware_images := $(foreach core,m4 m7,$(firmware)/$(core)/radar.elf $(firmware)/$(core)/replay.elf)

## Build the firmware example for Cortex-M4F and M7: a radar node, and the same on records (build/firmware)
firmware: $(firmware_images)
	@BUILD=$(BUILD) $(firmware_parts)/budget.sh

define firmware_core # m4 or m7
$(firmware)/$(1)/radar.elf: $(radar_parts:%.c=$(firmware)/$(1)/radar/%.o)
	@echo "  link     $$@" && $(firmware_c) $$($(1)_flags) $(firmware_link) -T node.ld -Wl,-Map=$$@.map -o $$@ $$^ -lc -lgcc
$(firmware)/$(1)/replay.elf: $(replay_parts:%.c=$(firmware)/$(1)/replay/%.o)
	@echo "  link     $$@" && $(firmware_c) $$($(1)_flags) $(firmware_link) -T large.ld -Wl,-Map=$$@.map -o $$@ $$^ -lc -lgcc
$(firmware)/$(1)/radar/%.o: %.c Makefile $(firmware_parts)/firmware.mk
	@mkdir -p $$(@D) && echo "  arm      $$@" && $(firmware_c) $$($(1)_flags) $(firmware_flags) $(FIRMWARE_OPT) -c -o $$@ $$<
$(firmware)/$(1)/replay/%.o: %.c Makefile $(firmware_parts)/firmware.mk
	@mkdir -p $$(@D) && echo "  arm      $$@" && $(firmware_c) $$($(1)_flags) $(firmware_flags) $(FIRMWARE_OPT) -DNODE_BEARINGS=1 -c -o $$@ $$<
endef
$(eval $(call firmware_core,m4))
$(eval $(call firmware_core,m7))

.PHONY: firmware

-include $(foreach core,m4 m7,$(radar_parts:%.c=$(firmware)/$(core)/radar/%.d) $(replay_parts:%.c=$(firmware)/$(core)/replay/%.d))
