# SPDX-License-Identifier: MIT
#
# rhotrack. `make help` lists the targets; each stands under the `##` lines that describe it.
#
# Variables for the command line:
#   CC=clang          the compiler (default gcc); AR= its archiver (default ar)
#   OPT=-O3           optimisation (default -O2)
#   CFLAGS=, LDFLAGS= added to every compilation, every link
#   BUILD=folder      where everything goes (default build); give each set of flags its own
#   FUZZ_SECONDS=60   how long `make fuzz` runs, all targets together; FUZZ_SECONDS_EACH= each of
#                     them
#   RHO_CONFIG_FILE=  a header with capacities of your own for build/librhotrack.a
#                     (include/rhotrack/config.h)
#   CROSS=riscv64-unknown-elf-  compilers of `make budget`, by their prefix (default arm-none-eabi-)
#   PACKAGER='NAME <MAIL>', URL=  whose packages `make packages` and `make deb` write
#   PREFIX=, DESTDIR= where `make install` puts things (default /usr/local); BINDIR=, LIBDIR=,
#                     INCLUDEDIR=, DOCDIR=, UNITDIR= (systemd), SYSCONFDIR= single folders
#   PROFILE=workstation  installs the library of that profile (default embedded)
#   LAB='--runs 5'    options of all experiments of `make experiments` (tools/lab/README.md)

VERSION := $(shell awk '$$2 ~ /^RHO_VERSION_[MP]/ {v = v s $$3; s = "."} END {print v}' \
                       include/rhotrack/rhotrack.h)
BUILD := build
# One folder has one name: objects built as one path are found by it.
override BUILD := $(patsubst $(CURDIR)/%,%,$(BUILD))
RHO_CONFIG_FILE :=
PROFILE := embedded
PREFIX := /usr/local
BINDIR := $(PREFIX)/bin
LIBDIR := $(PREFIX)/lib
INCLUDEDIR := $(PREFIX)/include
DOCDIR := $(PREFIX)/share/doc/rhotrack
UNITDIR := $(PREFIX)/lib/systemd/system
SYSCONFDIR := $(if $(filter /usr /usr/local,$(PREFIX)),,$(PREFIX))/etc

ifeq ($(origin CC),default)
CC := gcc
endif
OPT := -O2

# --- what there is ---------------------------------------------------------------------------

library_sources := $(sort $(wildcard src/*/*.c))
program_sources := $(sort $(shell find tools/rhotrack -name '*.c'))
lab_sources := $(sort $(wildcard tools/lab/c/*.c))
scenes := $(sort $(wildcard tools/scenes/*/*.json))
unit_sources := $(sort $(wildcard tests/unit/*/test_*.c))
tool_sources := $(sort $(wildcard tests/tools/*/test_*.c tests/scenario/test_*.c \
                                  tests/lab/test_*.c))
# Laid out by .clang-format: all but the tables that scripts write.
sources := $(sort $(shell find include src tools tests -name '*.[ch]'))
sources := $(filter-out tests/vectors/%,$(sources))

library := $(BUILD)/librhotrack.a
workstation_library := $(BUILD)/workstation/librhotrack.a
program := $(BUILD)/rhotrack
lab := $(BUILD)/rhotrack-lab

embedded_objects := $(library_sources:%.c=$(BUILD)/embedded/%.o)
workstation_objects := $(library_sources:%.c=$(BUILD)/workstation/%.o)
program_objects := $(program_sources:%.c=$(BUILD)/program/%.o) $(BUILD)/program/scenes.o \
                   $(BUILD)/program/page_parts.o
lab_objects := $(lab_sources:%.c=$(BUILD)/program/%.o)

# Unit tests are built and run for both profiles; tests of tools, scenarios and the lab use the
# program's own parts.
unit_programs := $(unit_sources:tests/%.c=$(BUILD)/tests/embedded/%) \
                 $(unit_sources:tests/%.c=$(BUILD)/tests/workstation/%)
tool_programs := $(tool_sources:tests/%.c=$(BUILD)/tests/%)

# --- flags -----------------------------------------------------------------------------------

# No fused multiply-add: every compiler and optimisation must give the same bits.
common_flags := -Iinclude -ffp-contract=off -MMD -MP
warnings := -Wall -Wextra -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Werror
library_flags := -std=c99 $(common_flags) $(warnings) -Wpedantic -Wconversion -Wdouble-promotion \
                 -Wfloat-equal -Wundef -Wcast-qual -Wvla -Wswitch-enum
program_flags := -std=c11 -D_GNU_SOURCE -DRHO_PROFILE_WORKSTATION $(common_flags) $(warnings) \
                 -Wconversion -pthread -Itools/rhotrack
test_flags := -std=c11 -D_GNU_SOURCE $(common_flags) -Itests -Itests/unit -Itools/rhotrack \
              -Itools/lab/c $(warnings) $(TEST_CFLAGS)
capacities := $(if $(RHO_CONFIG_FILE),-DRHO_CONFIG_FILE='"$(abspath $(RHO_CONFIG_FILE))"')
program_libraries := -llcm -lcsv -linih -lcjson -lproj -lpcap -pthread -lm

compile = @mkdir -p $(@D) && echo "  cc       $@" && $(CC) $(1) $(OPT) $(CFLAGS)

# As many jobs as processors, unless the caller said how many.
jobs = $(if $(filter -j%,$(MAKEFLAGS)),,-j$$(nproc))

.DEFAULT_GOAL := all
.DELETE_ON_ERROR:
.PHONY: all lib codegen bench-opencv bench-stonesoup test-programs test fuzz demo demo-live house \
        layers poison gates size size-update instructions examples determinism experiments lint \
        format format-check tidy cppcheck sanitize install clean help

# --- what users build ------------------------------------------------------------------------

## Build the program (build/rhotrack) and the library (build/librhotrack.a); the default
all: $(program) $(lab) lib $(BUILD)/codegen.checked

## Build the library alone, embedded profile
lib: $(library)

$(library): $(embedded_objects)
$(workstation_library): $(workstation_objects)
$(library) $(workstation_library):
	@rm -f $@ && echo "  ar       $@" && $(AR) rcs $@ $^

$(program): $(program_objects) $(workstation_library)
$(lab): $(lab_objects) $(filter-out %/rhotrack/main.o,$(program_objects)) $(workstation_library)
$(program) $(lab):
	$(call compile) $(LDFLAGS) -o $@ $^ $(program_libraries)

$(BUILD)/embedded/%.o: %.c Makefile $(BUILD)/capacities
	$(call compile,$(library_flags) $(capacities)) $(LIBRARY_CFLAGS) -c -o $@ $<

# Changes where RHO_CONFIG_FILE is another one: everything is compiled anew then.
.PHONY: always
$(BUILD)/capacities: always
	@mkdir -p $(@D) && { echo '$(RHO_CONFIG_FILE)' | cmp -s - $@ || echo '$(RHO_CONFIG_FILE)' > $@; }

$(BUILD)/workstation/%.o: %.c Makefile
	$(call compile,$(library_flags) -DRHO_PROFILE_WORKSTATION) $(LIBRARY_CFLAGS) -c -o $@ $<

# What tools/codegen writes is checked in, and must be what it would write.
$(BUILD)/codegen.checked: $(wildcard lcm_types/* tools/codegen/*.py) include/rhotrack/message.h \
                          src/wire/message_types.c src/wire/message_names.c
	@mkdir -p $(@D) && tools/codegen/generate_lcm_codec.py --check && touch $@

## Write the LCM codec from lcm_types/
codegen:
	@tools/codegen/generate_lcm_codec.py

# The votes' loops want vector code, which gcc makes at -O3 only.
ifeq ($(OPT),-O2)
vote_objects := %/src/papers/accumulator.o
$(filter $(vote_objects),$(embedded_objects) $(workstation_objects)): override OPT := -O3
endif

$(lab_objects): private program_flags += -Itools/lab/c
$(BUILD)/program/%.o: %.c Makefile
	$(call compile,$(program_flags)) -c -o $@ $<

# The shipped scenes as texts in the program.
$(BUILD)/program/scenes.c: $(scenes) Makefile
	@mkdir -p $(@D) && { echo '#include "scene/scene_shipped.h"'; \
	  echo 'const struct shipped_scene shipped_scenes[] = {'; \
	  for file in $(scenes); do \
	    echo "{\"$$(basename $$file .json)\","; \
	    sed -e 's/\\/\\\\/g' -e 's/"/\\"/g' -e 's/.*/"&\\n"/' $$file; echo '},'; \
	  done; echo '{0, 0}};'; } > $@

# The page of `plot -o NAME.html` in the program: its text, its script, and d3 (ISC licence, beside
# it).
page_folder := tools/rhotrack/picture/interactive_map_page
$(BUILD)/program/page_parts.c: $(wildcard $(page_folder)/*) Makefile
	@mkdir -p $(@D) && { echo '#include "picture/map_page_parts.h"'; \
	  for part in licence:d3.LICENSE d3:d3.min.js html:page.html style:page.css script:page.js; do \
	    echo "const char page_$${part%%:*}[] ="; \
	    sed -e 's/[\\"?]/\\&/g' -e 's/.*/"&\\n"/' $(page_folder)/$${part#*:}; echo ';'; \
	  done; } > $@

$(BUILD)/program/scenes.o $(BUILD)/program/page_parts.o: %.o: %.c
	$(call compile,$(program_flags)) -c -o $@ $<

## Set up what is missing, build, track real radar plots and show the result (build/demo)
demo:
	@tools/setup.sh
	@$(MAKE) --no-print-directory $(jobs) all
	@RHOTRACK=$(abspath $(program)) tools/demo.sh $(BUILD)/demo

## Set up what is missing, build, and track live for some seconds: a player, a node, LCM between
## them (build/demo-live)
demo-live:
	@tools/setup.sh
	@$(MAKE) --no-print-directory $(jobs) all
	@RHOTRACK=$(abspath $(program)) tools/demo_live.sh $(BUILD)/demo-live

experiment_names := air_traffic bearings claims dense_windows doppler extended extended_rivals \
                    false_alarms fusion initiation low_pd maneuver notch papers_initiation \
                    passive polar real_skies rotating several_radars two_radars
## Set up what is missing, build, and run all experiments of the lab (build/experiment; LAB=options;
## hours)
experiments:
	@tools/setup.sh
	@tools/setup.sh lab
	@$(MAKE) --no-print-directory $(jobs) all python
	@for name in $(experiment_names); do \
	    BUILD=$(abspath $(BUILD)) tools/lab/$$name.py $(LAB) || exit; done

# --- what packagers use ----------------------------------------------------------------------

# The package is built in a folder that is kept, so that a change of one file compiles one file.
python_site := $(BUILD)/python/site
.PHONY: python python-dist
## Build the package for Python in build/python/site, where the lab's scripts import it
python: $(python_site)/built

$(python_site)/built: $(shell find tools/python include src tools/rhotrack -type f)
	@tools/setup.sh && tools/setup.sh python && tools/setup.sh lab
	@rm -rf $(@D) && echo "  python   $(@D)" && python3 -m pip install -q --disable-pip-version-check \
	    --no-deps --root-user-action ignore \
	    --config-settings build-dir=$(abspath $(BUILD))/python/objects --target $(@D) \
	    ./tools/python && PYTHONPATH=$(@D) /usr/bin/python3 -c 'import rhotrack' && touch $@

## Build the package for Python: wheel and source package, in build/python
python-dist:
	@tools/setup.sh
	@tools/setup.sh python
	@BUILD=$(BUILD) tools/python/dist.sh

packages := $(BUILD)/packages
.PHONY: packages deb
## Packages for Arduino, PlatformIO, ESP-IDF, Zephyr, CMSIS, vcpkg, Conan, Meson (build/packages;
## PACKAGER='NAME <MAIL>', URL=)
packages:
	@tools/packaging/write_source_packages.py \
	    $(if $(PACKAGER),--packager='$(subst ','\'',$(PACKAGER))') \
	    $(if $(URL),--url='$(subst ','\'',$(URL))') $(packages)
	@ls -d $(packages)/*

## Debian packages: the program with its service, and the library (build/packages/*.deb)
deb: packages
	@tools/setup.sh
	@tools/setup.sh packages
	@rm -rf $(packages)/deb/rhotrack $(packages)/*.deb && mkdir -p $(packages)/deb/rhotrack && \
	    mv $(packages)/debian $(packages)/deb/rhotrack && \
	    cp CHANGELOG.md $(packages)/deb/rhotrack/NEWS.md && \
	    cd $(packages)/deb/rhotrack && { env -u MAKEFLAGS -u MAKELEVEL \
	    DEB_BUILD_OPTIONS="noautodbgsym parallel=$$(nproc)" \
	    dpkg-buildpackage -b -uc -us >../log 2>&1 || { tail -n 20 ../log; exit 1; }; } && \
	    mv ../*.deb ../..
	@ls $(packages)/*.deb

.PHONY: docs
## Set up what is missing, and write the documentation as pages (build/docs/html/index.html)
docs: python
	@tools/setup.sh docs
	@rm -rf $(BUILD)/docs && \
	    /usr/bin/python3 tools/docs/sphinx_sources.py $(BUILD)/docs/source $(BUILD)
	@PYTHONPATH=$(python_site) /usr/bin/python3 -m sphinx -q -n -W --keep-going -c tools/docs \
	    -d $(BUILD)/docs/doctrees $(BUILD)/docs/source $(BUILD)/docs/html
	@/usr/bin/python3 tools/docs/links.py $(BUILD)/docs/html

# The installed config.h says which capacities the library was built with, so that no application
# can have others by mistake. RHO_CONFIG_FILE itself is installed as rhotrack/config_file.h; it must
# include nothing but system headers.
installed_library := $(library)
ifneq ($(RHO_CONFIG_FILE),)
installed_define := RHO_CONFIG_FILE "rhotrack/config_file.h"
else ifeq ($(PROFILE),workstation)
installed_library := $(workstation_library)
installed_define := RHO_PROFILE_WORKSTATION 1
endif
headers := $(patsubst include/rhotrack/%,%,$(wildcard include/rhotrack/*.h \
                                                      include/rhotrack/detail/*.h))
cmake_folder := $(LIBDIR)/cmake/rhotrack

# Templates have no DESTDIR. Folders under PREFIX are said relative to it; CMake's files are, to
# themselves.
fill_in = sed -e 's|@VERSION@|$(VERSION)|' -e 's|@PREFIX@|$(PREFIX)|' \
              -e 's|@LIBDIR@|$(patsubst $(PREFIX)/%,$${prefix}/%,$(LIBDIR))|' \
              -e 's|@BINDIR@|$(BINDIR)|' -e 's|@SYSCONFDIR@|$(SYSCONFDIR)|' \
              -e 's|@INCLUDEDIR@|$(patsubst $(PREFIX)/%,$${prefix}/%,$(INCLUDEDIR))|' \
              -e "s|@TO_LIBDIR@|$$(realpath -ms --relative-to=$(cmake_folder) $(LIBDIR))|" \
              -e "s|@TO_INCLUDEDIR@|$$(realpath -ms --relative-to=$(cmake_folder) $(INCLUDEDIR))|" \
              -e "s|@POINTER_BYTES@|$$(echo __SIZEOF_POINTER__ | \
                                       $(CC) $(CFLAGS) -E -P - | tail -n 1)|" \
              tools/install/$(1).in > $(2)/$(1) && chmod 644 $(2)/$(1)

refuse = $(if $(strip $(1)),$(error $(strip $(2))))
install_checks = \
    $(call refuse, $(filter-out /%,$(PREFIX) $(BINDIR) $(LIBDIR) $(INCLUDEDIR) $(DOCDIR) \
                                   $(UNITDIR) $(SYSCONFDIR)), \
        PREFIX and the other folders begin with /) \
    $(call refuse, $(filter-out embedded workstation,$(PROFILE)), \
        PROFILE is embedded or workstation) \
    $(call refuse, $(and $(RHO_CONFIG_FILE),$(filter workstation,$(PROFILE))), \
        RHO_CONFIG_FILE is for PROFILE=embedded; \
        the file may define RHO_PROFILE_WORKSTATION itself) \
    $(call refuse, $(findstring -DRHO_,$(CFLAGS) $(LIBRARY_CFLAGS)), \
        capacities in CFLAGS would not be installed; use RHO_CONFIG_FILE or PROFILE)

.PHONY: install-lib install-program install-checks uninstall

## Install program and library (PREFIX, DESTDIR; variables above)
install: install-lib install-program

## Install the library alone: headers, pkg-config file, CMake package; needs a C compiler and
## nothing else
install-lib: install-checks $(installed_library)
	install -d $(DESTDIR)$(LIBDIR)/pkgconfig $(DESTDIR)$(cmake_folder) \
	           $(DESTDIR)$(INCLUDEDIR)/rhotrack/detail $(DESTDIR)$(DOCDIR)
	install -m 644 $(installed_library) $(DESTDIR)$(LIBDIR)/
	install -m 644 include/rhotrack/*.h $(DESTDIR)$(INCLUDEDIR)/rhotrack/
	install -m 644 include/rhotrack/detail/*.h $(DESTDIR)$(INCLUDEDIR)/rhotrack/detail/
	$(if $(installed_define),sed -i '/^#define RHOTRACK_CONFIG_H$$/a #define $(installed_define)' \
	    $(DESTDIR)$(INCLUDEDIR)/rhotrack/config.h)
	$(if $(RHO_CONFIG_FILE),install -m 644 $(RHO_CONFIG_FILE) \
	    $(DESTDIR)$(INCLUDEDIR)/rhotrack/config_file.h)
	install -m 644 LICENSE $(DESTDIR)$(DOCDIR)/
	@$(call fill_in,rhotrack.pc,$(DESTDIR)$(LIBDIR)/pkgconfig)
	@$(call fill_in,rhotrackConfig.cmake,$(DESTDIR)$(cmake_folder))
	@$(call fill_in,rhotrackConfigVersion.cmake,$(DESTDIR)$(cmake_folder))

install-checks:
	@:$(install_checks)

# Settings that are there are the user's.
install-program: install-checks $(program)
	install -d $(DESTDIR)$(BINDIR) $(DESTDIR)$(UNITDIR) $(DESTDIR)$(SYSCONFDIR)/rhotrack
	install -m 755 $(program) $(DESTDIR)$(BINDIR)/
	@$(call fill_in,rhotrack-node.service,$(DESTDIR)$(UNITDIR))
	[ -e $(DESTDIR)$(SYSCONFDIR)/rhotrack/node.ini ] || \
	    install -m 644 tools/install/node.ini $(DESTDIR)$(SYSCONFDIR)/rhotrack/

## Remove what `make install` with the same folders put there
uninstall:
	! cmp -s tools/install/node.ini $(DESTDIR)$(SYSCONFDIR)/rhotrack/node.ini || \
	    rm $(DESTDIR)$(SYSCONFDIR)/rhotrack/node.ini
	rm -f $(DESTDIR)$(UNITDIR)/rhotrack-node.service $(DESTDIR)$(BINDIR)/rhotrack \
	      $(DESTDIR)$(LIBDIR)/librhotrack.a $(DESTDIR)$(LIBDIR)/pkgconfig/rhotrack.pc \
	      $(DESTDIR)$(cmake_folder)/rhotrackConfig.cmake \
	      $(DESTDIR)$(cmake_folder)/rhotrackConfigVersion.cmake $(DESTDIR)$(DOCDIR)/LICENSE \
	      $(addprefix $(DESTDIR)$(INCLUDEDIR)/rhotrack/,$(headers) config_file.h)
	for folder in $(SYSCONFDIR)/rhotrack $(cmake_folder) $(INCLUDEDIR)/rhotrack/detail \
	    $(INCLUDEDIR)/rhotrack $(DOCDIR); do \
	    [ ! -d "$(DESTDIR)$$folder" ] || \
	        rmdir --ignore-fail-on-non-empty "$(DESTDIR)$$folder"; done

# --- tests -----------------------------------------------------------------------------------

# The inner loop: unit tests in the embedded profile, tests of the program's parts, every command
# from end to end with the golden files, and the checks of the sources that take seconds. test-all
# runs everything else behind it.
quick_scripts := $(addprefix tests/integration/,papers_claims_gate.sh command_line.sh \
                   documents_gate.sh document_examples_gate.sh headers.sh layers.sh \
                   security_attacks_have_tests.sh)
quick_scripts := $(wildcard $(quick_scripts)) \
                 $(sort $(wildcard tests/regression/*.sh tests/regression/*.py)) \
                 $(addprefix tools/gates/,layers.py tested.py no_heap.sh \
                   extract_example.sh)
# What the embedded profile leaves out is tested in the other one.
left_out := tracker/test_track_evidence bodies/test_body_extents \
            bodies/test_body_split_evidence bodies/test_duplicate_tracks bodies/test_plot_groups \
            bodies/test_outline bodies/test_sudden_turns step/test_split_bodies
quick_programs := $(filter $(BUILD)/tests/embedded/%,$(unit_programs)) \
                  $(filter-out $(BUILD)/tests/lab/%,$(tool_programs)) \
                  $(left_out:%=$(BUILD)/tests/workstation/unit/%)
other_programs := $(filter-out $(quick_programs),$(unit_programs) $(tool_programs))
other_scripts := $(filter-out $(quick_scripts), \
                   $(sort $(wildcard tests/integration/*.sh tests/lab/test_*.py)) \
                   tools/gates/object_restrictions.py tools/gates/determinism.sh)

# A test that does not build counts as failed, so the build goes on past it (-k) and its runner
# decides. What an earlier build left of it is removed: it would be run, and would pass.
run_tests = @mkdir -p $(BUILD); LC_ALL=C $(MAKE) --no-print-directory -k $(jobs) all $(1) \
                2>$(BUILD)/build-errors.txt || \
                { cat $(BUILD)/build-errors.txt; echo "  ...  the build has failures"; \
                  rm -f $$(sed -n -e "s/.*Target '\(.*\)' not remade because of errors.*/\1/p" \
                                  -e 's/.*\*\*\* \[[^]]*: \(.*\)\] Error.*/\1/p' \
                                  $(BUILD)/build-errors.txt); }; \
            BUILD=$(BUILD) tests/run.sh $(1) $(2)

## Set up what is missing, build and run the tests of minutes; ends with `N passed, N failed`
test:
	@tools/setup.sh
	@BUILD=$(BUILD) tools/setup_python.sh
	$(call run_tests,$(quick_programs),$(quick_scripts))

## All tests: `make test`, then the other profile, the lab, the network, sizes, gates and
## determinism
test-all:
	@$(MAKE) --no-print-directory test || quick=failed; \
	$(MAKE) --no-print-directory test-rest && test -z "$$quick"

.PHONY: test-all test-rest
test-rest:
	@tools/setup.sh
	@tools/setup.sh firmware
	@tools/setup.sh python
	@tools/setup.sh packages
	@tools/setup.sh browser
	@BUILD=$(BUILD) tools/setup_python.sh
# Without it, tests of the lab's scripts say that they are skipped.
	-@$(MAKE) --no-print-directory python
	$(call run_tests,$(other_programs),$(other_scripts))

test-programs: $(unit_programs) $(tool_programs)

# A change of the library links these anew, and compiles none: make mutate does so for each mutant.
.SECONDARY: $(unit_sources:tests/%.c=$(BUILD)/tests/embedded/%.o)
$(BUILD)/tests/embedded/%.o: tests/%.c Makefile
	$(call compile,$(test_flags)) -c -o $@ $<

$(BUILD)/tests/embedded/%: $(BUILD)/tests/embedded/%.o $(library)
	@$(CC) $(OPT) $(CFLAGS) $(LDFLAGS) -o $@ $< $(library) -lcmocka -lm

$(BUILD)/tests/workstation/%: tests/%.c $(workstation_library) Makefile
	$(call compile,$(test_flags) -DRHO_PROFILE_WORKSTATION) -MF $@.d $(LDFLAGS) -o $@ $< \
	    $(workstation_library) -lcmocka -lm

tool_objects := $(filter-out %/main.o,$(program_objects) $(lab_objects))
$(tool_programs): $(BUILD)/tests/%: tests/%.c $(tool_objects) $(workstation_library) Makefile
	$(call compile,$(test_flags) -DRHO_PROFILE_WORKSTATION) -MF $@.d $(LDFLAGS) -o $@ $< \
	    $(tool_objects) $(workstation_library) -lcmocka $(program_libraries)

# Only where OpenCV is installed: `rhotrack bench hough` compares with it.
opencv_flags := $(shell pkg-config --silence-errors --cflags opencv4 2>/dev/null || \
                  { test -d /usr/include/opencv4 && echo -I/usr/include/opencv4; })
## Build what `rhotrack bench hough` compares with, where OpenCV is installed
bench-opencv: $(if $(opencv_flags),$(BUILD)/tests/bench/hough_opencv)

$(BUILD)/tests/bench/hough_opencv: tests/bench/hough_opencv.cpp Makefile
	@mkdir -p $(@D) && echo "  c++      $@" && \
	g++ -O2 $(opencv_flags) -o $@ $< -lopencv_imgproc -lopencv_core

## Install Stone Soup in build/stonesoup (from the package index), where the lab finds it
bench-stonesoup: $(BUILD)/stonesoup/bin/stonesoup.installed

$(BUILD)/stonesoup/bin/stonesoup.installed: tests/bench/requirements.txt
	@mkdir -p $(BUILD) && /usr/bin/python3 -m venv --system-site-packages $(BUILD)/stonesoup && \
	$(BUILD)/stonesoup/bin/python3 -m pip install -q --disable-pip-version-check -r $< && touch $@

## Unit, scenario and bad-input tests with address and undefined-behaviour, unit tests with the
## memory sanitizer (clang)
sanitize: defined-memory
	@$(MAKE) --no-print-directory $(jobs) sanitized-tests BUILD=$(BUILD)/sanitize CC=clang \
	    OPT='-O1 -g' CFLAGS='-fsanitize=address,undefined -fno-sanitize-recover=all' \
	    LIBRARY_CFLAGS=-fsanitize=float-cast-overflow

# What is not compiled with it is unknown to the memory sanitizer: the library alone is looked at.
.PHONY: defined-memory sanitized-tests embedded-tests
defined-memory:
	@$(MAKE) --no-print-directory $(jobs) embedded-tests BUILD=$(BUILD)/memory CC=clang OPT='-O1 -g' \
	    CFLAGS='-fsanitize=memory -fno-sanitize-recover=all' \
	    TEST_CFLAGS='-include tests/unit/defined_memory.h'

embedded_programs := $(filter $(BUILD)/tests/embedded/%,$(unit_programs))
embedded-tests: $(embedded_programs)
	@BUILD=$(BUILD) tests/run.sh $(embedded_programs)

sanitized-tests: $(program) $(unit_programs) $(tool_programs)
	@BUILD=$(BUILD) tests/run.sh $(unit_programs) $(tool_programs) \
	    $(sort $(wildcard tests/integration/bad*.sh))

# --- fuzzing ---------------------------------------------------------------------------------

# What meets bytes from outside is compiled for the fuzzer: the codecs, the readers of the program
# (recordings, tables, INI files, scenes), and src/base that they call; of fuzz_snapshot and
# fuzz_tracker all of the library. The rest of library and program is linked as it is. In src/wire
# an unsigned number that wraps is a finding, too; elsewhere loops and the square root wrap on
# purpose.
fuzz_readers := $(wildcard $(addprefix tools/rhotrack/,io/asterix/*.c io/csv/*.c io/rows/*.c \
                  io/scans/*.c io/turns/*.c io/log/*.c \
                  settings/parameters*.c scene/*.c base/name_hint.c picture/picture_data.c))
fuzz_parts := $(sort $(wildcard src/wire/*.c src/base/*.c)) $(fuzz_readers) \
              tools/firmware/board/udp_frame.c
fuzz_objects := $(fuzz_parts:%.c=$(BUILD)/fuzz/parts/%.o)
fuzz_sources := $(sort $(wildcard tests/fuzz/fuzz_*.c))
fuzz_programs := $(fuzz_sources:tests/fuzz/%.c=$(BUILD)/fuzz/%) $(BUILD)/fuzz/fuzz_tracker_small
fuzz_checks := -fsanitize=address,undefined,float-cast-overflow,float-divide-by-zero
fuzz_integers := -fsanitize=integer -fno-sanitize=unsigned-shift-base
fuzz_flags = -std=c11 -D_GNU_SOURCE -DRHO_PROFILE_WORKSTATION $(common_flags) $(warnings) \
             -Itests -Itests/unit -Itools/rhotrack \
             -O1 -g $(fuzz_checks) -fno-sanitize-recover=all

## Fuzz every decoder and reader, and the tracker: FUZZ_SECONDS=60 in all, or FUZZ_SECONDS_EACH
fuzz:
	@$(MAKE) --no-print-directory $(jobs) $(fuzz_programs)
	@BUILD=$(BUILD) tests/fuzz/run.sh $(fuzz_programs)

export FUZZ_SECONDS FUZZ_SECONDS_EACH

$(filter $(BUILD)/fuzz/parts/src/wire/%,$(fuzz_objects)) $(fuzz_programs): \
    private fuzz_checks += $(fuzz_integers)

$(BUILD)/fuzz/parts/%.o: %.c Makefile
	@mkdir -p $(@D) && echo "  clang    $@" && \
	    clang $(fuzz_flags) -fsanitize=fuzzer-no-link -c -o $@ $<

$(BUILD)/fuzz/parts.a: $(fuzz_objects)
$(BUILD)/fuzz/program.a: $(filter-out %/main.o,$(program_objects))
$(BUILD)/fuzz/parts.a $(BUILD)/fuzz/program.a:
	@rm -f $@ && echo "  ar       $@" && ar rcs $@ $^

# --wrap: a reader that refuses its file comes back to the target instead of ending it, which closes
# its streams.
refusal_programs := $(addprefix $(BUILD)/fuzz/,fuzz_config fuzz_scene fuzz_tables)
$(refusal_programs): $(BUILD)/fuzz/parts/tests/fuzz/catch_reader_fail.o
$(refusal_programs): private refusal_wraps = $(shell \
    grep -o '__wrap_[a-z_]*' tests/fuzz/catch_reader_fail.c | sort -u | \
    sed 's/__wrap_/-Wl,--wrap=/')

$(BUILD)/fuzz/fuzz_%: tests/fuzz/fuzz_%.c $(BUILD)/fuzz/parts.a $(BUILD)/fuzz/program.a \
                      $(workstation_library) Makefile
	@mkdir -p $(@D) && echo "  clang    $@" && clang $(fuzz_flags) -MF $@.d -fsanitize=fuzzer \
	    $(refusal_wraps) -o $@ $< $(filter %.o,$^) $(filter %.a,$^) $(program_libraries)

# What an image of any contents, or a script of calls leads to: all of the library, in the smaller
# profile, with the bodies that it leaves out.
embedded_fuzz_flags = $(filter-out -DRHO_PROFILE_WORKSTATION,$(fuzz_flags))
with_bodies := -DRHO_BODIES=1 -DRHO_KEEPS_OFFERS=1
embedded_fuzz_objects := $(library_sources:%.c=$(BUILD)/fuzz/embedded/%.o)
$(BUILD)/fuzz/embedded/%.o: %.c Makefile
	@mkdir -p $(@D) && echo "  clang    $@" && clang $(embedded_fuzz_flags) \
	    $(with_bodies) -fno-sanitize=float-divide-by-zero -fsanitize=fuzzer-no-link -c -o $@ $<

embedded_fuzz_link = @mkdir -p $(@D) && echo "  clang    $@" && \
    clang $(embedded_fuzz_flags) -MF $@.d \
    -fno-sanitize=unsigned-integer-overflow,implicit-conversion -fsanitize=fuzzer \
    -o $@ $< $(filter %.o,$^) -lm

$(BUILD)/fuzz/fuzz_snapshot $(BUILD)/fuzz/fuzz_tracker: $(BUILD)/fuzz/%: \
    tests/fuzz/%.c $(embedded_fuzz_objects) Makefile
	$(embedded_fuzz_link) $(with_bodies)

# The tracker's script again, with capacities that it exhausts.
small_capacities := -DRHO_CONFIG_FILE='"tests/fuzz/small_capacities.h"' -I.
small_fuzz_objects := $(library_sources:%.c=$(BUILD)/fuzz/small/%.o)
$(small_fuzz_objects): $(BUILD)/fuzz/small/%.o: %.c Makefile
	@mkdir -p $(@D) && echo "  clang    $@" && clang $(embedded_fuzz_flags) \
	    $(small_capacities) -fno-sanitize=float-divide-by-zero -fsanitize=fuzzer-no-link -c -o $@ $<

$(BUILD)/fuzz/fuzz_tracker_small: tests/fuzz/fuzz_tracker.c $(small_fuzz_objects) Makefile
	$(embedded_fuzz_link) $(small_capacities)

# --- gates -----------------------------------------------------------------------------------

## Check every include against the table of rooms in src/DESIGN.md, and that no files need one
## another in a circle
layers: $(library) $(program) $(lab)
	@BUILD=$(BUILD) tools/gates/layers.py

## Check that the library has no heap, no stdio, no double, no mutable globals
poison: $(library)
	@BUILD=$(BUILD) tools/gates/no_heap.sh

## The same in the objects for Cortex-M, Cortex-R and RISC-V, and no recursion, growing frame or
## call by a pointer
gates:
	@BUILD=$(BUILD) tools/gates/object_restrictions.py

## Figures of the sources' shape (size, widths, names), each with its goal
house:
	@tools/gates/house.py

## Build with gcc and clang, -O0 and -O3, and compare what the programs write, byte by byte
determinism:
	@BUILD=$(BUILD) tools/gates/determinism.sh

## Compile and run the C examples of README.md
examples: $(library)
	@BUILD=$(BUILD) tools/gates/extract_example.sh

## Code, RAM and worst stack of each module; red where tools/lab/MEASUREMENTS.md differs, or an
## object does not fit
size:
	@BUILD=$(BUILD) tools/gates/library_size.sh

## Write what `make size` measures into tools/lab/MEASUREMENTS.md
size-update:
	@BUILD=$(BUILD) tools/gates/library_size.sh --update

# A Cortex-M4F where nothing else is said; CC= where it was given.
CROSS := arm-none-eabi-
budget_cc = $(if $(filter command%,$(origin CC)),$(CC),$(CROSS)gcc)
budget_cpu = $(if $(filter -m%,$(CFLAGS)),,$(if \
             $(filter arm-none-eabi-gcc,$(notdir $(budget_cc))),$(m4_cpu)))
budget_opt = $(if $(filter command%,$(origin OPT)),$(OPT),-Os)
.PHONY: budget
## Flash and RAM of RHO_CONFIG_FILE, by module, on a Cortex-M4F (CROSS= or CC=, CFLAGS=, OPT= for
## another processor)
budget:
	@BUILD=$(BUILD) tools/gates/configuration_sizes.py \
	    --config='$(RHO_CONFIG_FILE)' --cc='$(budget_cc)' \
	    --flags='$(strip $(budget_opt) $(budget_cpu) $(CFLAGS))'

## Instructions that typical jobs execute (valgrind); own covariances cost at most 1.5 times
## isotropic noise
instructions: $(library) $(workstation_library)
	@BUILD=$(BUILD) tools/gates/instructions.sh

## Change each policy constant by a factor of two; nine in ten must be noticed (hours;
## MUTATE='--sample 40')
.PHONY: mutate
mutate:
	@BUILD=$(BUILD) tools/gates/mutate.py $(MUTATE)

# One clang-tidy a file, as many at a time as there are processors; silent where all is well.
tidy = printf '%s\n' $(1) | xargs -r -P "$$(nproc)" -n 1 sh -c \
    'found=$$(clang-tidy --quiet "$$1" -- $(filter-out -M%,$(2)) 2>&1) || \
     { echo "$$found"; exit 1; }' tidy

# missingIncludeSystem: the system's headers are not looked into, which is what is wanted.
# invalidTestForOverflow: it reads RHO_AT(3 + i, i) as a test for overflow.
# uninitvar: an array that a loop fills counts as unset, as the loop might not run; clang's analyzer
# looks better.
# _Noreturn: cppcheck knows the attribute only.
cppcheck_flags := --quiet -j 2 --error-exitcode=1 --enable=warning,performance,portability \
                  --inline-suppr --suppress=missingIncludeSystem --suppress=invalidTestForOverflow \
                  --suppress=uninitvar -URHO_CONFIG_FILE \
                  -D_Noreturn='__attribute__((noreturn))' -Iinclude

## Run clang-tidy, cppcheck, the format check and the check of the register of claims
## (`make -k lint`: all findings)
lint: tidy cppcheck format-check claims-check

tidy:
	@echo "  tidy     src tools/rhotrack tools/firmware"
	@$(call tidy,$(library_sources),$(library_flags)) || failed=1; \
	$(call tidy,$(program_sources),$(program_flags)) || failed=1; \
	$(call tidy,$(firmware_portable),$(library_flags) -Itools/firmware) || failed=1; test -z "$$failed"

.PHONY: claims-check
claims-check:
	@tools/gates/papers_claims_register.py

cppcheck:
	@echo "  cppcheck src tools/rhotrack tools/firmware"
	@cppcheck $(cppcheck_flags) --std=c99 src || failed=1; \
	cppcheck $(cppcheck_flags) --std=c11 -DRHO_PROFILE_WORKSTATION -Itools/rhotrack \
	    tools/rhotrack || failed=1; \
	cppcheck $(cppcheck_flags) --std=c99 -DMPS2_ETHERNET=0x40200000u -Itools/firmware \
	    tools/firmware || failed=1; \
	test -z "$$failed"

## Lay out all C sources by .clang-format
format:
	clang-format -i $(sources)

## Check the layout without changing anything
format-check:
	@echo "  format   src include tools tests"
	@for file in $(sources); do \
	    clang-format --dry-run -Werror "$$file" >/dev/null 2>&1 || \
	        { echo "$$file: run make format"; failed=1; }; \
	done; test -z "$$failed"

# --- the viewer for lcm-spy ------------------------------------------------------------------

# Not the lcm-gen that the pip package lcm puts first on PATH: what it writes must fit the jar.
LCM_GEN ?= /usr/bin/lcm-gen
LCM_JARS ?= /usr/share/java/lcm.jar:/usr/share/java/jchart2d.jar

spy := $(BUILD)/spy
spy_jars := $(spy)/rhotrack-types.jar $(spy)/rhotrack-spy.jar
spy_sources := $(sort $(wildcard tools/spy/src/rhotrack/spy/*.java \
                                 tools/spy/src/rhotrack/spy/*/*.java))
spy_tests := $(sort $(wildcard tools/spy/test/rhotrack/spy/*.java))
spy_path := $(LCM_JARS):$(spy)/rhotrack-types.jar:$(spy)/rhotrack-spy.jar
javac = echo "  javac    $@" && rm -rf $(1) && mkdir -p $(1) && \
        javac --release 17 -encoding UTF-8 -d $(1)
java_warnings := -Xlint:all -Werror

## Build the viewer for lcm-spy (build/spy/rhotrack-types.jar, rhotrack-spy.jar); needs liblcm-java
spy: $(spy_jars)

$(spy)/rhotrack-types.jar: $(sort $(wildcard lcm_types/*.lcm)) Makefile
	@for file in $(LCM_GEN) $(subst :, ,$(LCM_JARS)); do test -e $$file || \
	    { echo "spy: no $$file; tools/setup.sh spy installs what is missing" >&2; exit 1; }; done
	@rm -rf $(spy)/types && mkdir -p $(spy)/types && \
	    $(LCM_GEN) -j --jpath $(spy)/types $(filter %.lcm,$^)
	@$(call javac,$(spy)/types-classes) -nowarn -cp $(LCM_JARS) $(spy)/types/rhotrack/*.java
	@jar --create --file $@ -C $(spy)/types-classes .

$(spy)/rhotrack-spy.jar: $(spy_sources) $(spy)/rhotrack-types.jar
	@$(call javac,$(spy)/classes) $(java_warnings) \
	    -cp $(LCM_JARS):$(spy)/rhotrack-types.jar $(spy_sources)
	@jar --create --file $@ -C $(spy)/classes .

# Not /usr/bin/lcm-spy: it asks for a garbage collector that Java has no more.
## Start lcm-spy with the viewer (LCM_URL=udpm://... for another network than LCM's default)
spy-run: spy
	java -Djava.net.preferIPv4Stack=true -cp $(spy_path) lcm.spy.Spy \
	    $(if $(LCM_URL),--lcm-url='$(LCM_URL)')

## Start the viewer without lcm-spy (LCM_URL as above)
spy-view: spy
	java -Djava.net.preferIPv4Stack=true -cp $(spy_path) rhotrack.spy.Viewer \
	    $(if $(LCM_URL),--lcm-url='$(LCM_URL)')

## Test the viewer's parts without a display; ends with `N passed, N failed`
spy-test: spy
	@$(call javac,$(spy)/test-classes) $(java_warnings) -cp $(spy_path) $(spy_tests)
	@java -Djava.awt.headless=true -cp $(spy_path):$(spy)/test-classes rhotrack.spy.SelfTest

.PHONY: spy spy-run spy-view spy-test

# --- firmware --------------------------------------------------------------------------------

include tools/firmware/firmware.mk

# --- the rest --------------------------------------------------------------------------------

## Remove everything that was built
clean:
	rm -rf $(BUILD)

## This list
help:
	@awk '/^## /{text = text (text ? " " : "") substr($$0, 4); next} \
	      text && /^[a-z-]+:/{sub(/:.*/, ""); printf "  %-15s %s\n", $$0, text; text = ""}' \
	    $(filter-out %.d,$(MAKEFILE_LIST))

-include $(embedded_objects:.o=.d) $(workstation_objects:.o=.d) $(program_objects:.o=.d) \
         $(lab_objects:.o=.d) $(unit_programs:=.d) $(tool_programs:=.d) $(fuzz_objects:.o=.d) \
         $(embedded_fuzz_objects:.o=.d) \
         $(small_fuzz_objects:.o=.d) $(fuzz_programs:=.d)
