#!/bin/bash
# SPDX-License-Identifier: MIT
# tools/gates/house.py finds no figure of the sources beyond its bound, and goes red for each figure
# where a copy of the sources has too much of it. Runs beside others.
here=$(realpath "$(dirname "$0")")
# shellcheck source=tests/integration/checks.bash
. "$here/checks.bash"
root=$(realpath "$here/../..")
gate=$root/tools/gates/house.py
check 'no figure has grown' "$gate" --check
check 'the table has all figures' test "$("$gate" | grep -cE ' (ok|beyond)$')" -eq 17

mkdir -p tree/tools/lab
cp -R "$root/src" "$root/include" tree
cp -R "$root/tools/rhotrack" "$root/tools/firmware" tree/tools
check 'a copy holds' "$gate" --check tree

# The gate refuses this figure of the copy; with fault=none it finds the figure well.
judge() {
    local status=0
    "$gate" --check --only "$1" tree >said 2>&1 || status=$?
    if [ "$fault" = none ]; then
        [ "$status" -eq 0 ] && return
    else
        [ "$status" -eq 1 ] && grep -q "^$1: .*, at most [0-9]" said && return
    fi
    cat said
    return 1
}
seen() { # figure, new file, command that writes it
    local status=0
    "${@:3}" >"tree/$2"
    judge "$1" || status=$?
    rm "tree/$2"
    return "$status"
}
seen_within() { # figure, first words of a struct or function, number, text: so many within it
    local status=0 path
    path=$(grep -rl "^$2" --include='*.[ch]' tree/include tree/src | tail -n 1)
    cp "$path" kept
    awk -v begin="$2" -v number="$3" -v text="$4" '{print} index($0, begin) == 1 {found = 1}
        found && /[{]$/ {for (; number > 0; number--) print text}' kept >"$path"
    judge "$1" || status=$?
    mv kept "$path"
    return "$status"
}
# many NUMBER TEXT: so many copies of the text, each with its number for @
many() {
    seq "$1" | while read -r number; do printf '%b' "${2//@/$number}"; done
}
seen_in_new_files() { # figure, number of files, name, text of each
    local status=0 number
    for number in $(seq "$2"); do printf '%b' "$4" >"tree/${3/@/$number}"; done
    judge "$1" || status=$?
    for number in $(seq "$2"); do rm "tree/${3/@/$number}"; done
    return "$status"
}
long_name=@_name_of_a_function_with_forty_letters
four_words=one_two_three_four_@.c
begin=$'\n{\n    return 0;\n}\n'

fault=seeded
check 'many prototypes are seen' seen prototypes src/step/a.h many 150 'int a@(\n    int b);\n'
check 'many changers of a step are seen' seen step_changers src/step/a.c many 200 \
    "static int a@(int b, struct step *step)$begin"
check 'many conditions of the step are seen' seen_within step_conditions \
    'enum rho_status rho_tracker_step(' 14 '    if (0) {}'
check 'many tables of sensors are seen' seen_within sensor_tables 'struct rho_tracker {' 6 \
    '    int a[RHO_MAX_SENSORS], b;'
check 'many files that know late scans are seen' seen_in_new_files late_files 22 src/step/a@.c \
    'int is_late;\n'
check 'many long names of src are seen' seen long_names_src src/base/a.c many 600 \
    "static int f$long_name(void)$begin"
check 'many long names of tools are seen' seen long_names_tools tools/rhotrack/a.c many 300 \
    "static int f$long_name(void)$begin"
check 'many long file names of src are seen' seen_in_new_files long_stems_src 60 \
    "src/base/$four_words" ''
check 'many long file names of tools are seen' seen_in_new_files long_stems_tools 70 \
    "tools/rhotrack/io/$four_words" ''
check 'many functions called once are seen' seen statics_called_once src/base/a.c many 1500 \
    "static int a@(void)${begin}int b@ = a@();\n"
check 'many files that know a column are seen' seen_in_new_files azimuth_files 4 \
    tools/rhotrack/io/a@.c 'const char *column = "azimuth_deg";\n'
echo 'int rho_wall_step(int a);' >>tree/include/rhotrack/reflectors.h
check "calls of the walls' step are seen" seen outer_steps tools/firmware/a.c many 4 \
    'int a@ = rho_wall_step(0);\n'
check "calls of the zones' step are seen" seen outer_steps tools/rhotrack/a.c many 4 \
    'int a@ = rho_zones_step(0, 0);\n'
check 'many numbers are seen' seen numeric_defines src/base/a.c many 600 '#define A@ (-1.0f)\n'
check 'many lines are seen' seen lines include/rhotrack/a.h many 9000 '\n\n\n\n\n\n'
check 'many objects of a node are seen' seen_within node_objects \
    "struct $(sed -n '/ rho_node_init(/,/;/s/.*struct \([a-z_]*\) \*[a-z]*);/\1/p' \
        "$root/include/rhotrack/node.h") {" 8 '    struct rho_zones *zones;'

check 'banners are seen' seen odd_comments src/step/a.h many 30 '/* ---- a@ ---- */\n'
check 'other signs of comments are seen' seen odd_comments include/rhotrack/a.h many 10 \
    '/** a@ */\nint a@; // b\n/*! c */\n'

mkdir tree/src/seed
policy() { # comment of a constant
    seen bare_policy src/seed/policy.h printf '%b' "/* policy */\n$1#define SHARE 0.5f\n"
}
good='/* Beams meet here. Half: gaps. Twice:\n * overlap. */\n'
check 'a constant without a comment is seen' policy '\n'
check 'one with a reason alone is seen' policy '/* Beams meet here. */\n'
check 'one without a reason is seen' policy '/* Half: gaps. Twice: overlap. */\n'
check 'one that does not say twice is seen' policy '/* Beams meet here. Half: gaps. */\n'
check 'the third one below a comment is seen' policy "$good#define OTHER 2\n#define MORE 3\n"
check 'one in the next lines is seen' policy "$good#define OTHER 2\n\n"

fault=none
check 'one that says all is right' policy "$good"
check 'one that has one text for both is' policy '/* Beams meet. Half or twice: gaps. */\n'
check 'and the bound of another is' policy "$good#define SHARE_MAX 2\n"
check 'readers of a step may be many' seen step_changers src/step/a.c many 200 \
    "static int a@(int b, const struct step *step)$begin"
check 'comments may name late scans' seen_in_new_files late_files 22 src/step/a@.c \
    '/* is_late */\n'
finish
