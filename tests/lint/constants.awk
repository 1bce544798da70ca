# SPDX-License-Identifier: BSD-2-Clause
# Prints constants without a comment, or without an origin, for test_constants.sh. A constant is a #define, a static const at file
# scope, or an enumerator, with a number. Its comment stands on its line or directly above it, or is the first of its block, which
# ends at an empty line. The block states an origin. A comment that begins with "Origin" describes no constant.

function end_block(    i)
{
    for (i = 0; i < n; i++) {
        if (!described[i] && !heading)
            print place[i] ": no comment with quantity, unit and origin: " line[i]
        else if (!origin)
            print place[i] ": no origin (geometry, literature, 'calibrated on', 'chosen by hand, not measured'): " line[i]
    }
    n = heading = origin = above = 0
}

# end_comment TEXT: notes a comment that stands on lines of its own.
function end_comment(text)
{
    above = text !~ /^[ \t]*Origin[,:]/
    if (!n && above)
        heading = 1
}

function has_number(text) { return text ~ /(^|[^A-Za-z_0-9.])[0-9]*[.]?[0-9]/ }

function is_constant(code,    value)
{
    value = code
    if (sub(/^#define [A-Za-z_0-9]+ +/, "", value))
        return has_number(value) && value !~ /^(["{.]|[A-Za-z_]+\()/
    if (code ~ /^static const (float|double|int|unsigned|long|size_t|u?int[0-9]+_t) /)
        return has_number(substr(code, index(code, "=")))
    return in_enum && index(code, "=") && has_number(substr(code, index(code, "=")))
}

FNR == 1 { end_block(); in_comment = in_enum = in_body = 0 }
/^[ \t]*$/ { end_block(); next }
/^\{/ { end_block(); in_body = 1 }
in_body { if (/^\}/) in_body = 0; next }

tolower($0) ~ /chosen by hand|calibrated|measured|checked on|geometry|arithmetic|literature|definition/ { origin = 1 }
in_comment {
    text = text $0
    if (/\*\//) {
        in_comment = 0
        gsub(/(\/|^ *|  *)\*+/, "", text)
        end_comment(text)
    }
    next
}
/^[ \t]*\/\*/ {
    text = $0
    sub(/^[ \t]*\/\*+/, "", text)
    in_comment = !/\*\//
    if (!in_comment)
        end_comment(text)
    next
}

/^enum.*\{/ { in_enum = 1 }
{
    code = $0
    sub(/\/\*.*/, "", code)
    if (is_constant(code)) {
        place[n] = FILENAME ":" FNR
        line[n] = $0
        described[n++] = above || /\/\*/
    }
    above = 0
}
/\}/ { in_enum = 0 }
END { end_block() }
