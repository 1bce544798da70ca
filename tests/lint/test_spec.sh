#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# The specification builds to HTML without a warning. ADCGS_FULL=1: also to PDF (a missing glyph is a warning), which contains
# characters that only some fonts have; and again by make html pdf, with the same bytes.
set -u
command -v asciidoctor >/dev/null || { echo "skipped: no asciidoctor"; exit 77; }
pdf=${ADCGS_FULL-}
[ -z "$pdf" ] || command -v asciidoctor-pdf >/dev/null || { echo "skipped: no asciidoctor-pdf"; exit 77; }
top=$(cd "${srcdir:-.}" && pwd) || exit 99
dir=$(mktemp -d) || exit 99
trap 'rm -rf "$dir"' EXIT
faults=0

# build PROGRAM FILE
build()
{
    SOURCE_DATE_EPOCH=0 "$1" -v --failure-level WARN -r "$top/spec/theme/requirements.rb" -o "$dir/$2" "$top/spec/adcgs.adoc" 2>"$dir/log" ||
        faults=1
    grep -E 'WARN|ERROR|possible invalid reference' "$dir/log" >&2 && faults=1
}

build asciidoctor 1.html
if [ -n "$pdf" ]; then
    build asciidoctor-pdf 1.pdf
    make html pdf >"$dir/log" 2>&1 || { cat "$dir/log"; faults=1; }
    cmp "$dir/1.html" spec/adcgs.html || faults=1
    cmp "$dir/1.pdf" spec/adcgs.pdf || faults=1
fi
grep -q '>REQ-PARS-001<' "$dir/1.html" || { echo "requirements have no numbers in print" >&2; faults=1; }
if [ -z "$pdf" ]; then
    echo "skipped: the PDF: only with ADCGS_FULL=1"
elif command -v pdftotext >/dev/null; then
    pdftotext "$dir/1.pdf" "$dir/text" || faults=1
    for sign in Σ η ϖ μ ≤ ⌊ √ ½ − · ∈; do
        grep -q "$sign" "$dir/text" || { echo "the PDF does not show $sign" >&2; faults=1; }
    done
else
    echo "skipped: characters in the PDF: no pdftotext"
fi
# Each document contains the tables byte for byte, and the page has the figures.
python3 - "$dir/1.html" "${pdf:+$dir/1.pdf}" "$top/spec" <<'END' || faults=1
import base64, os, re, sys, zlib

def streams(data):
    for found in re.finditer(rb"(?<!end)stream\r?\n(.*?)\r?\nendstream", data, re.S):
        yield found.group(1)
        try:
            yield zlib.decompress(found.group(1))
        except zlib.error:
            pass

with open(sys.argv[1], encoding="utf-8") as file:
    html = file.read()
pdf = b""
if sys.argv[2]:
    with open(sys.argv[2], "rb") as file:
        pdf = file.read()
links = dict(re.findall(r'download="([^"]+)" href="data:text/csv;base64,([^"]+)"', html))
attached = list(streams(pdf))
faults = []
for name in ("logistic.csv", "values.csv"):
    with open(os.path.join(sys.argv[3], "tables", name), "rb") as file:
        table = file.read()
    if base64.b64decode(links.get(name, "")) != table:
        faults.append("the page has no %s" % name)
    if pdf and (table not in attached or b"(%s)" % name.encode() not in pdf):
        faults.append("the PDF has no attachment %s" % name)
figures = len(os.listdir(os.path.join(sys.argv[3], "diagrams")))
if html.count("data:image/svg+xml;base64,") != figures:
    faults.append("the page has not %d figures" % figures)
print("\n".join(faults), end="\n" if faults else "", file=sys.stderr)
sys.exit(1 if faults else 0)
END
exit $faults
