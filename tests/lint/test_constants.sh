#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# Each constant of src/ has a comment with quantity, unit and origin: geometry, literature, arithmetic, definition, 'calibrated on'
# with the scenes, or 'chosen by hand, not measured'. constants.awk states the rule.
set -u
cd "${srcdir:-.}" || exit 99
dir=$(mktemp -d) || exit 99
trap 'rm -rf "$dir"' EXIT
faults=0

# undescribed FILE...: constants without a comment, or without an origin.
undescribed()
{
    awk -f tests/lint/constants.awk "$@"
}

find src -type f -name '*.[ch]' >"$dir/files"
# shellcheck disable=SC2046 # no name in the tree has a blank
undescribed $(cat "$dir/files") >"$dir/found"
[ ! -s "$dir/found" ] || { cat "$dir/found" >&2; faults=1; }

# The check detects planted faults, and nothing else.
cat >"$dir/good.c" <<'END'
/* Origin, unless a line states one: chosen by hand, not measured. */
enum {
    TRIES = 3, /* rounds */
    SIDE       /* pixels, without a number */
};
#define NEAR 0.1f /* scene units */
/* Pixels: how far a match may lie. */
#define FAR 4

/* Shares of the views; calibrated on table and room. */
static const double LEAST = 0.1, MOST = 0.9;
static const char name[] = "3";
#define TEXT "4"

int body(void)
{
    static const int local = 5;
    return local;
}
END
cat >"$dir/bad.c" <<'END'
#define ALONE 1
/* Origin: chosen by hand, not measured. */
#define BARE 0.5f

/* Quantity and unit, but no more. */
enum { FEW = 2 };

static const float half = 0.5f;

#define SOME 3 /* points; geometry */
enum {
    MANY = 4
};
END
undescribed "$dir/good.c" >"$dir/found"
[ ! -s "$dir/found" ] || { echo "a described constant is reported:" >&2; cat "$dir/found" >&2; faults=1; }
reported=$(undescribed "$dir/bad.c" | cut -d: -f2 | tr '\n' ' ')
[ "$reported" = "1 3 6 8 12 " ] || { echo "lines ${reported}are reported, expected 1 3 6 8 12" >&2; faults=1; }

# Without their comments, the rooms have faults.
for room in train init check encode fmodel grad session media system; do
    mkdir -p "$dir/$room"
    grep "^src/$room/" "$dir/files" | while read -r file; do
        sed -E 's:/\*([^*]|\*[^/])*\*/::' "$file" >"$dir/$room/${file##*/}"
    done
    [ "$(undescribed "$dir/$room"/*.[ch] | grep -c .)" -gt 2 ] ||
        { echo "src/$room without its comments has no faults" >&2; faults=1; }
done
exit $faults
