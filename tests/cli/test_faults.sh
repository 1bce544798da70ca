#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Every system call by which a program changes files fails: in one run it alone, in another one also all later ones, as on a full
# disk. Then the exit code is 3, one line names the file, files are the old ones or complete new ones, and no other files remain.
# Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-dec adcgs-info adcgs-enc adcgs-join adcgs-eval adcgs-sweep adcgs-conform adcgs-demo-scene adcgs-import tests/cli/fail-nth
vectors=$(cd "${srcdir:-.}/conformance" && pwd)
tests/cli/fail-nth "$dir" "$dir/report" 1 true || exit $?
tiny_stream 40
s=$dir/s.adcgs w=$dir/w

both='once +'
[ -n "${ADCGS_FULL:-}" ] || both=once # a full disk in the full check alone, except for streams
ways=$both
none=1000000 most=$none # number of a call that never occurs; number of the last call to test

# faults NAME COMMAND...: the command writes into $w, and its standard output goes to a file there. Standard output and the files
# whose names end in .log grow line by line. All other files have to be complete.
faults()
{
    name=$1
    shift
    rm -rf "$w" "$dir/good" && mkdir "$w"
    tests/cli/fail-nth "$w" "$dir/report" 0 "$@" >"$w/stdout.log" 2>"$dir/err" || { bad "$name"; cat "$dir/err"; return; }
    read -r total <"$dir/report"
    cp -r "$w" "$dir/good"
    for rest in $ways; do
        [ $rest = once ] && rest=
        n=1
        while :; do
            fresh
            TMPDIR=$w tests/cli/fail-nth "$w" "$dir/report" $n$rest "$@" >"$w/stdout.log" 2>"$dir/err"
            code=$?
            read -r calls <"$dir/report"
            [ "$n" -le "$calls" ] || break
            check_fault "$name, call $n$rest of $calls"
            # All of the first calls and of those at the end of the good run; ever fewer others.
            near=$((n < total ? total - n : n - total))
            near=$((n < near ? n : near))
            n=$((n + 1 + (near > 1 ? near / 2 : 0)))
            [ "$n" -le "$most" ] || n=$none
        done
        [ "$calls" -gt 0 ] || bad "$name: no system call writes"
        [ "$code" -eq 0 ] || { bad "$name: exit code $code without a fault"; cat "$dir/err"; }
    done
}

# fresh: restore the files that the good run wrote, with other content, except those that the command reads ($kept). spare=yes:
# some calls do not matter. rescues=yes: a run that fails saves its state, or says why it cannot.
kept=none spare=no rescues=no
fresh()
{
    rm -rf "$w" && cp -r "$dir/good" "$w"
    find "$w" -type f ! -path "$kept" -exec sh -c 'for file; do echo old >"$file"; done' sh {} +
}

# size_of FILE: number of lines of text, else of bytes. whole FILE: the file is as long as that of the good run; times in it may
# differ. fresh_files: the names of all files that are not the old ones.
size_of() { case $1 in *.tif | *.sgi | *.state) wc -c <"$1" ;; *) wc -l <"$1" ;; esac; }
whole()
{
    cmp -s "$w/$1" "$dir/good/$1" ||
        { case $1 in *.csv | *.json | *.html | *.xml | *.tif | *.sgi | *.state) : ;; *) false ;; esac &&
              [ "$(size_of "$w/$1")" = "$(size_of "$dir/good/$1")" ]; }
}

old=$(echo old | cksum)
fresh_files() { (cd "$w" && find . -type f ! -name '*.log' -exec cksum {} +) | sed "/^$old /d; s/^[0-9]* [0-9]* //"; }

# check_message NAME: the exit code is 3, and one line names the failure.
check_message()
{
    [ "$code" -eq 3 ] || { bad "$1: exit code $code"; cat "$dir/err"; }
    [ "$(grep -v 'its state is lost' "$dir/err" | grep -c 'cannot')" -eq 1 ] && tail -n 1 "$dir/err" | grep -q '^adcgs-.*: .*cannot' ||
        { bad "$1: not one line that says so"; cat "$dir/err"; }
}

check_fault()
{
    if [ "$code" -eq 0 ] && [ $spare = yes ] && diff -r "$w" "$dir/good" >/dev/null; then
        return # for example the messages of another program
    fi
    if [ "$code" -eq 0 ] && [ $rescues = yes ]; then
        grep -rqx old "$w" && bad "$1: exit code 0, but an old file"
    else
        check_message "$1"
    fi
    [ $rescues = no ] || rm -f "$w/x.adcgs.checkpoint"
    [ "$(cd "$w" && find . ! -name '*.gp.log' | sort)" = "$(cd "$dir/good" && find . ! -name '*.gp.log' | sort)" ] ||
        { bad "$1: additional or missing files"; (cd "$w" && find . -name '*tmp*'); }
    fresh_files >"$dir/files"
    while read -r file; do
        whole "$file" || { bad "$1: $file is neither the old nor the new one"; ls -l "$w/$file" "$dir/good/$file"; }
    done <"$dir/files"
}

# imports NAME ARGUMENTS...: adcgs-import makes the folder $w/s. The folder appears complete or not at all. After a failure the
# same command resumes from the remaining files. The last calls are tested, and ever fewer of the earlier ones (ADCGS_FULL=1:
# more).
imports()
{
    name=$1
    shift
    set -- ./adcgs-import --colmap "$fake" -o "$w/s" "$@"
    rm -rf "$w" "$dir/good" && mkdir "$w"
    tests/cli/fail-nth "$w" "$dir/report" 0 "$@" >"$w/stdout.log" 2>"$dir/err" || { bad "$name"; cat "$dir/err"; return; }
    cp -r "$w/s" "$dir/good"
    read -r calls <"$dir/report"
    back=0
    while [ $back -lt "$calls" ]; do
        rm -rf "$w" && mkdir "$w"
        what="$name, call $((calls - back)) of $calls"
        tests/cli/fail-nth "$w" "$dir/report" $((calls - back)) "$@" >"$w/stdout.log" 2>"$dir/err"
        code=$?
        [ "$code" -eq 3 ] && [ "$(grep -c 'cannot' "$dir/err")" -eq 1 ] || { bad "$what: exit code $code"; cat "$dir/err"; }
        [ -e "$w/s" ] || "$@" >"$dir/out" 2>"$dir/err" || { bad "$what: resuming failed"; cat "$dir/err"; }
        diff -r "$w/s" "$dir/good" >"$dir/out" || { bad "$what: another scene"; cat "$dir/out"; }
        [ "$(ls "$w")" = "$(printf 's\nstdout.log')" ] || { bad "$what: other files remain"; ls "$w"; }
        back=$((back + 1 + (back > 1 ? back : 0) ${ADCGS_FULL:+/ 4}))
    done
}

# The decoder: images of each writer, streams, a video, splats, cameras, standard output.
for extension in png jpg ppm exr; do
    faults "$extension" ./adcgs-dec "$s" --time 0:0.06 --camera 0 -o "$w/%d.$extension"
done
ways=once
for extension in tif sgi; do # written from memory, and through a file
    if ./adcgs-dec "$s" --time 0 -o "$dir/x.$extension" 2>/dev/null; then
        faults "$extension" ./adcgs-dec "$s" --time 0 --camera 0 --size 40x30 -o "$w/x.$extension"
    fi
done
ways=$both
faults y4m ./adcgs-dec "$s" --time 0:0.1 -o "$w/x.y4m"
faults raw ./adcgs-dec "$s" --time 0 -o "$w/x.raw" --float
if ./adcgs-dec "$s" --time 0 -o "$dir/x.mp4" 2>/dev/null; then
    faults mp4 ./adcgs-dec "$s" --time 0:0.2 -o "$w/x.mp4"
fi
faults "standard output" ./adcgs-dec "$s" --time 0:0.1 -o -
faults "digests" ./adcgs-dec "$s" --time 0:0.1 --md5
faults "splats" ./adcgs-dec "$s" --time 0 --splats "$w/x.ply"
faults "splats as GLB" ./adcgs-dec "$s" --time 0 --splats "$w/x.glb"
for format in SPZ SOG; do # if this build supports the format
    if grep -q "define HAVE_$format" config.h; then
        faults "splats as $format" ./adcgs-dec "$s" --time 0 --splats "$w/x.$(echo $format | tr '[:upper:]' '[:lower:]')"
    fi
done
faults "cameras" ./adcgs-dec "$s" --cameras "$w/x.json"

# The player's images of the scene and of its window, at a fixed time.
printf 'screenshot %s\ngrab %s\nquit\n' "$w/shot.png" "$w/window.ppm" >"$dir/script"
mkdir -p "$w"
if SDL_VIDEODRIVER=dummy ./adcgs-dec "$s" --play --time 0.1 --script "$dir/script" >/dev/null 2>&1; then
    faults "player" env SDL_VIDEODRIVER=dummy ./adcgs-dec "$s" --play --time 0.1 --script "$dir/script" --threads 1
fi

# Reports about a stream, and its anchors.
faults "report" ./adcgs-info "$s" --bits
faults "JSON" ./adcgs-info "$s" --json
faults "trace" ./adcgs-info "$s" --trace
faults "anchors" ./adcgs-info "$s" --points "$w/x.ply"
if ./adcgs-info "$s" --points "$dir/x.drc" 2>/dev/null; then
    faults "Draco" ./adcgs-info "$s" --points "$w/x.drc"
fi

# Evaluation: table, images, reports.
faults "table" ./adcgs-eval "$s" "$dir/scene" --csv "$w/x.csv" --images "$w/views" --beside
faults "evaluation" ./adcgs-eval "$s" "$dir/scene" --json
faults "table printed" ./adcgs-eval "$s" "$dir/scene" --csv -

# The encoder: stream; plain numbers; images that go to a file or are decoded again since memory is limited; the beginning of a
# run.
spare=yes rescues=yes
short="--preset draft --set matching_frames=0,tiers=1 --max-anchors 60 --iterations 10 --threads 1 --quiet"
# shellcheck disable=SC2086
faults "encoder" ./adcgs-enc "$dir/scene" -o "$w/x.adcgs" $short --memory 1 --uncompressed "$w/x.bin"
# shellcheck disable=SC2086
faults "beginning" ./adcgs-enc "$dir/scene" --beginning "$w/x.state" $short --iterations 20
spare=no rescues=no

# Joining of segments.
# shellcheck disable=SC2086
./adcgs-enc "$dir/scene" --plan "$dir/plan.json" --cut 9 $short &&
    ./adcgs-enc "$dir/scene" --plan "$dir/plan.json" --segment 1 --quiet || bad "adcgs-enc --plan"
faults "join" ./adcgs-join "$dir/plan.json" -o "$w/x.adcgs"
faults "list of parts" ./adcgs-join "$dir/plan.json" --list

# The built-in scene, and the report of adcgs-conform.
ways=+
faults "scene" ./adcgs-demo-scene --scene tiny --size 16x16 -o "$w/scene"
ways='once +'
faults "conformance" ./adcgs-conform "$vectors/manifest.json" --filter 'bad-geom-depth*' --junit "$w/x.xml"

# A scene from footage: reduced images, masks, points. COLMAP's own files are in another folder.
fake=$(cd "${srcdir:-.}/tests/cli" && pwd)/fake-colmap
export FAKE="$dir/fake" FAKE_ASIDE="$dir/aside"
mkdir "$dir/aside" "$dir/views" "$dir/masks"
for i in 0 1 2; do
    ./adcgs-dec "$s" --time 0.0$i --camera 0 --size 96x64 -o "$dir/views/$i.png" 2>"$dir/err" || cat "$dir/err"
    { printf 'P6 24 16 255\n'; head -c 1152 /dev/zero; } >"$dir/masks/$i.ppm"
done
imports "import" "$dir/views" --masks "$dir/masks" --side 64

# Tables and page of a sweep whose runs exist.
if ./adcgs-sweep "$dir/scene" -o "$dir/sweep" --lambda 0.1 --preset draft --iterations 10 --yardsticks none >/dev/null 2>"$dir/err"; then
    # The last calls are those of adcgs-eval, which has its own test; here its messages go to its log.
    kept="$w/sweep/lambda*" spare=yes most=2000
    faults "sweep" sh -c '[ -e "$1/sweep" ] || cp -r "$2" "$1/sweep"; shift 2; exec "$@"' sh "$w" "$dir/sweep" \
        ./adcgs-sweep "$dir/scene" -o "$w/sweep" --lambda 0.1 --preset draft --iterations 10 --yardsticks none --resume
else
    bad "adcgs-sweep"
    cat "$dir/err"
fi
exit $failed
