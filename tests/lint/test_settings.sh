#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# Only resolve.c changes the settings of a run, so that each change is recorded. Others that write a configuration make a request:
# the table's functions, the options of adcgs-enc, --without, and the reader of plans. The check knows the names
# of configurations in a file by their declarations, and members of other structs by the list below.
set -u
cd "${srcdir:-.}" || exit 99
dir=$(mktemp -d) || exit 99
trap 'rm -rf "$dir"' EXIT

may_write="src/train/resolve.c src/train/settings.c src/train/trial/ablation.c src/apps/enc/enc_configure.c src/session/plan_read.c"
members="config requested whole"

# names_of HEADER: the names of the configuration's members.
names_of()
{
    sed -n '/^typedef struct adcgs_train_config {/,/^}/p' "$1" | sed 's|/\*.*||' |
        sed -n 's/^    [a-z][a-z0-9_]* \(.*\);.*/\1/p; s/^    const char \(.*\);.*/\1/p' | sed 's/\[.*//' | tr -d '*,' | tr '\n' ' '
}

# writes FIELDS FILE...: the lines that assign to a member of a configuration, also inside params, shape and origin, or that call
# adcgs_setting_put().
writes()
{
    awk -v fields="$1" -v members="$members" '
        function either(words) { gsub(/ +/, "|", words); gsub(/^\||\|$/, "", words); return "(" words ")" }
        function check(line, names,   pattern) {
            pattern = "(^|[^a-zA-Z0-9_])" either(names) "(\\.|->)" either(fields) "(\\[[^]]*\\])?(\\.[a-z0-9_]+)?" \
                " *([-+*\\/%&|^]|<<|>>)?=[^=]|(\\+\\+|--)[a-z>.-]*" either(names) "(\\.|->)" either(fields) "($|[^a-zA-Z0-9_])|" \
                "(^|[^a-zA-Z0-9_])" either(names) "(\\.|->)" either(fields) "(\\[[^]]*\\])?(\\.[a-z0-9_]+)? *(\\+\\+|--)"
            return (line " ") ~ pattern || line ~ /(^ |[^a-z_ ] ?|  )adcgs_setting_put\(/ }
        FNR == 1 { names = members }
        /adcgs_train_config \**(const )?[a-z_]+[,;) =]/ {
            rest = $0
            while (match(rest, /adcgs_train_config \**(const )?[a-z_0-9]+/)) {
                name = substr(rest, RSTART, RLENGTH)
                rest = substr(rest, RSTART + RLENGTH)
                sub(/.*[ *]/, "", name)
                names = names " " name } }
        check($0, names) { print FILENAME ":" FNR ": writes a setting, expected a phase of src/train/resolve.c: " $0 }' "${@:2}"
}

fields=$(names_of src/train/train_config.h)
faults=0
for name in preset time_limit target origin iterations lr_scale_entropy params shape without_coarse matching_frames; do
    [[ " $fields " == *" $name "* ]] || { echo "train_config.h: member $name is not found" >&2; faults=1; }
done

# The rooms below train do not know its configuration.
# shellcheck disable=SC2046
writes "$fields" $(find src/train src/encode src/session src/play src/apps -name '*.[ch]' | sort | grep -vxF "$(tr ' ' '\n' <<<"$may_write")") >"$dir/found"
[ ! -s "$dir/found" ] || { cat "$dir/found" >&2; faults=1; }
for file in $may_write; do
    [ -n "$(writes "$fields" "$file")" ] || { echo "$file: writes no setting, so remove it from the list" >&2; faults=1; }
done

# The check detects planted faults, and nothing else.
cat >"$dir/faulty.c" <<'END'
static void f(adcgs_train_config *run, adcgs_trainer *t)
{
    adcgs_train_config local = *run;
    run->batch = 1;
    local.params.k += 2;
    t->config.tiers--;
    ++t->config.scale;
    run->origin[3].given = 1;
    adcgs_setting_put(s, run, 1);
    run->prune_units_at = run->prune_at = 2;
}
END
cat >"$dir/sound.c" <<'END'
static int f(const adcgs_train_config *run, adcgs_trainer *t)
{
    const adcgs_trial_facts facts = {.seed = run->seed};
    other->batch = run->batch;
    config.threads = 2;
    t->config = *run;
    return run->batch == 1 && run->scale >= 2 && adcgs_setting_get(s, run) == 1;
}
END
planted=$(writes "$fields" "$dir/faulty.c" | grep -c .)
[ "$planted" -eq 7 ] || { echo "$planted of 7 planted faults are detected" >&2; faults=1; }
[ -z "$(writes "$fields" "$dir/sound.c")" ] || { writes "$fields" "$dir/sound.c" >&2; faults=1; }
exit $faults
