#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# The keys of all JSON that the programs write, and their types, against doc/json.md: each printed key is documented, and each
# documented key is printed. The programs run on tiny scenes; adcgs-sweep runs stand-ins for the other programs.
# shellcheck disable=SC2030,SC2031
set -u
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-check adcgs-demo-scene adcgs-enc adcgs-eval adcgs-info adcgs-dec adcgs-import adcgs-sweep tests/cli/make-scenes
command -v python3 >/dev/null || { echo "skipped: no python3"; exit 77; }
top=$(cd "${srcdir:-.}" && pwd)
: >"$dir/samples"
: >"$dir/partial"

# sample OUTPUT FILE: compare the file with the rows of this output in the document.
sample() { printf '%s\t%s\n' "$1" "$2" >>"$dir/samples"; }
# partial OUTPUT WHY: the samples lack some optional keys of the output here.
partial()
{
    echo "skipped: optional keys of $1: $2"
    printf '%s\n' "$1" >>"$dir/partial"
}
# printed NAME COMMAND...: the command prints JSON to $dir/NAME.json.
printed()
{
    report=$dir/$1.json
    shift
    "$@" >"$report" 2>"$dir/err" || { bad "$*"; cat "$dir/err"; }
}

# Short runs on the tiny scene, which live.sh makes in $scene. With a target, exit code 1 means that the run missed it.
. "${srcdir:-.}/tests/cli/live.sh"
draft="--preset draft --max-anchors 100 --threads 2"
# shellcheck disable=SC2086
{
    ./adcgs-enc "$scene" -o "$dir/s.adcgs" $draft --iterations 300 --size 14k --log "$dir/s.log" --json \
        >"$dir/enc.json" 2>"$dir/err"
    [ $? -le 1 ] || { bad "adcgs-enc --size"; cat "$dir/err"; }
    printed raw ./adcgs-enc "$scene" -o "$dir/r.adcgs" $draft --iterations 10 --uncompressed "$dir/raw" --log "$dir/r.log" --json
    printed parts ./adcgs-enc "$scene" -o "$dir/p.adcgs" $draft --iterations 20 --segment 0.1 --log "$dir/p.log" --json
    expect 0 "" ./adcgs-enc "$scene" --plan "$dir/plan.json" --preset draft --max-anchors 100 --iterations 20 --cut 0.1 --psnr 20
    printed part ./adcgs-enc "$scene" --plan "$dir/plan.json" --segment 1 --json
}
for name in enc raw parts; do sample adcgs-enc "$dir/$name.json"; done
for name in s r p; do sample log "$dir/$name.log"; done
sample plan "$dir/plan.json"
sample "adcgs-enc --plan --segment" "$dir/part.json"
for name in s p; do
    printed "info-$name" ./adcgs-info --json "$dir/$name.adcgs"
    sample adcgs-info "$dir/info-$name.json"
done
# A scene whose images have no times, which is a finding.
mkdir "$dir/untimed" && cp -r "$scene/train" "$dir/untimed" &&
    sed 's/"time": *[0-9.e-]*,\{0,1\}//' "$scene/transforms_train.json" >"$dir/untimed/transforms.json" || bad "no scene without times"
./adcgs-check "$dir/untimed" --json --quiet >"$dir/check.json" 2>"$dir/err"
[ $? -eq 1 ] || { bad "adcgs-check finds nothing"; cat "$dir/err" "$dir/check.json"; }
sample adcgs-check "$dir/check.json"
printed eval ./adcgs-eval "$dir/s.adcgs" "$scene" --json
printed eval-all ./adcgs-eval "$dir/s.adcgs" "$scene" --json --split train --metrics all --crop=-1,-1,-1,1,1,1
printed eval-dynamic ./adcgs-eval "$dir/s.adcgs" "$scene" --json --metrics dynamic-psnr
for name in eval eval-all eval-dynamic; do sample adcgs-eval "$dir/$name.json"; done
expect 0 "" ./adcgs-dec "$dir/s.adcgs" --cameras "$dir/stored.json"
expect 0 "" ./adcgs-dec "$dir/s.adcgs" --camera "$dir/stored.json" --cameras "$dir/flight.json"
for name in stored flight; do sample "camera path" "$dir/$name.json"; done

# A film, whose stream has a path.
./adcgs-demo-scene --scene film-cross20 --size 32x24 --frames 8 -o "$dir/shots" -q &&
    # shellcheck disable=SC2086
    ./adcgs-enc "$dir/shots" -o "$dir/f.adcgs" $draft --iterations 10 -q || bad "a film"
printed info-film ./adcgs-info --json "$dir/f.adcgs"
sample adcgs-info "$dir/info-film.json"

# Live footage that is complete, and a stream that continues.
scene_file "$dir/live" images
put "$dir/live" 0 1 2 3 4 5
touch "$dir/live/end"
# shellcheck disable=SC2086
{
    live="$draft --iterations 20 --segment 0.1 --json"
    printed live ./adcgs-enc --live "$dir/live" -o "$dir/l.adcgs" $live --delay 100
    put "$dir/live" 6 7
    printed resumed ./adcgs-enc --live "$dir/live" -o "$dir/l.adcgs" $live --resume "$dir/l.adcgs"
}
for name in live resumed; do sample "adcgs-enc --live" "$dir/$name.json"; done

# Imported pictures and videos, with a stand-in for COLMAP.
export FAKE=$dir/fake
import() { printed "$@" --mapper colmap --colmap "$top/tests/cli/fake-colmap" -o "$dir/imported-$1" --json; }
tests/cli/make-scenes "$dir" >"$dir/kinds" || bad "make-scenes"
import film ./adcgs-import --fps 10 "$dir/llff/images"
names=film
if grep -q '^neu3d-videos' "$dir/kinds"; then
    import rig ./adcgs-import "$dir"/neu3d-videos/cam*.mp4
    names="film rig"
else
    partial adcgs-import "this build reads no videos"
fi
if ! ffmpeg -v error -f lavfi -i testsrc=size=24x16:duration=1 -f lavfi -i sine=duration=1 -c:v mpeg4 -c:a aac "$dir/sound.mp4" 2>"$dir/err"; then
    partial adcgs-import "no ffmpeg that makes a video with sound"
elif [ "$names" = film ] || ! ffmpeg -v error -encoders | grep -q libopus; then
    partial adcgs-import "no ffmpeg with Opus"
else
    import sound ./adcgs-import "$dir/sound.mp4"
    names="$names sound"
fi
for name in $names; do
    sample adcgs-import "$dir/$name.json"
    sample "scene file" "$dir/imported-$name/scene.json"
done

# Sweeps, in a shell of their own, because pretend.sh works in $dir.
mkdir "$dir/sweep"
(
    dir=$dir/sweep
    . "${srcdir:-.}/tests/cli/pretend.sh"
    touch "$dir/views" "$dir/moving"
    sweep --lambda 1,2 --ablation --seeds 1,2 --frames 0:9:1 --dataset transforms --fixed
    [ $got -eq 0 ] || fail "a sweep: $(cat "$dir/err")"
    out=$dir/grid
    sweep --lambda 1 --k 5,10 --yardsticks none
    [ $got -eq 0 ] || fail "a grid: $(cat "$dir/err")"
) || failed=1
for folder in out grid; do
    sample sweep.json "$dir/sweep/$folder/sweep.json"
    for file in "$dir/sweep/$folder"/*.portions.json; do sample RUN.portions.json "$file"; done
    for file in "$dir/sweep/$folder"/*.json; do
        case $file in */sweep.json | *.portions.json) ;; *) sample RUN.json "$file" ;; esac
    done
done
for tool in zstd xz; do command -v $tool >/dev/null || partial sweep.json "no $tool"; done

cat >"$dir/compare.py" <<'END_OF_PYTHON'
import json, re, subprocess, sys

document, scene_document, folder = sys.argv[1:4]
TYPES = {'integer', 'number', 'string', 'boolean', 'array', 'object', 'null'}
faults = []


class Key:
    def __init__(self):
        self.types, self.optional, self.seen = set(), False, False


def read_document():
    """Returns {output: {path: Key}} of all tables. The scene file has no keys there, but a link."""
    outputs, output, keys = {}, None, None
    for line in open(document, encoding='utf-8'):
        cells = [c.strip() for c in line.strip()[1:-1].split('|')]
        if not line.startswith('| ') or cells[0] == 'output':
            continue
        if len(cells) != 5 or cells[4] not in ('yes', 'no'):
            faults.append('not a row of five cells with yes or no at the end: ' + line.strip())
            continue
        output = cells[0].strip('`') or output
        keys = outputs.setdefault(output, {})
        objects = ['' if o == 'top' else o.strip('`') + '.' for o in cells[1].split(', ')]
        for group in cells[2].split(';') if not cells[2].startswith('[') else []:
            words = re.sub('`[^`]*`', '', group).replace(',', ' ').split()
            for path in [o + k for o in objects for k in re.findall('`([^`]+)`', group)]:
                if path in keys:
                    faults.append('%s: %s is documented twice' % (output, path))
                key = keys[path] = Key()
                key.types = set(words) - {'or', 'optional'}
                key.optional = 'optional' in words
                if not key.types or key.types - TYPES:
                    faults.append('%s: %s: unknown type "%s"' % (output, path, ' '.join(words)))
    return outputs


def read_scene_document():
    """Returns the keys of a scene file and of its cameras, from the tables of its own document."""
    tables = re.split('^## .*$', open(scene_document, encoding='utf-8').read(), flags=re.M)[1:3]
    keys = {}
    for prefix, table in zip(('', 'cameras[].'), tables):
        for cell in re.findall(r'^\| (`[^|]*)\|', table, flags=re.M):
            for first, last in re.findall('`(k[0-9])` ... `(k[0-9])`', cell):
                cell += ''.join(' `k%d`' % i for i in range(int(first[1]), int(last[1]) + 1))
            for name in re.findall('`([^`]+)`', cell):
                keys[prefix + name] = Key()
                keys[prefix + name].types, keys[prefix + name].optional = TYPES, True
    return keys


def write_scenes(keys):
    """Scene files that have all documented keys: the reader may complain about values, but not about keys."""
    names = [k for k in keys if '.' not in k and k != 'adcgs_scene']
    of_camera = [k.split('.')[1] for k in keys if '.' in k]
    with open(folder + '/top.json', 'w') as file:
        json.dump(dict({'adcgs_scene': 1}, **dict.fromkeys(names)), file)
    with open(folder + '/camera.json', 'w') as file:
        json.dump({'adcgs_scene': 1, 'cameras': [dict.fromkeys(of_camera)]}, file)


def types_of(value):
    if value is None:
        return {'null', 'number'}
    if isinstance(value, bool):
        return {'boolean'}
    if isinstance(value, int):
        return {'integer', 'number'}
    return {{float: 'number', str: 'string', list: 'array', dict: 'object'}[type(value)]}


def compare(keys, value, at, where):
    """Compares the keys of an object with the documented keys that begin with at."""
    for name, member in value.items():
        path = at + name
        key = keys.get(path) or keys.get(at + '*')
        inner = path + ('[].' if isinstance(member, list) else '.')
        has_inner = any(k.startswith(inner) for k in keys)
        if key:
            key.seen = True
            if not key.types & types_of(member):
                faults.append('%s: %s is %s, documented as %s' % (where, path, json.dumps(member)[:40], ' or '.join(key.types)))
        if not key and not has_inner:
            faults.append('%s: %s is not documented' % (where, path))
        for one in (member if isinstance(member, list) else [member]) if has_inner else []:
            if isinstance(one, dict):
                compare(keys, one, inner, where)
            else:
                faults.append('%s: %s has a value that is no object' % (where, path))
    for path, key in keys.items():
        name = path[len(at):]
        child = re.split(r'\[\]\.|\.', name)[0]
        holder = keys.get(at + child)
        if path.startswith(at) and name != '*' and child not in value and not (holder or key).optional:
            faults.append('%s: %s is missing in an object, but not documented as optional' % (where, path))


def samples():
    for line in open(folder + '/samples', encoding='utf-8'):
        output, path = line.rstrip('\n').split('\t')
        with open(path, encoding='utf-8') as file:
            values = [json.loads(text) for text in file] if output == 'log' else [json.load(file)]
        for value in values:
            stage = value.get('stage') if output == 'log' else None
            yield 'log, ' + stage if stage in ('settings', 'decisions') else output, value


def check_programs(outputs):
    """A program has --json if and only if the document has its report."""
    text = open(document, encoding='utf-8').read()
    without = re.findall('`([^`]+)`', re.search('^No option `--json`:(.*)$', text, flags=re.M).group(1))
    for program in sys.argv[4:]:
        has = '--json' in subprocess.run(['./' + program, '--help'], stdout=subprocess.PIPE, check=True).stdout.decode()
        if has != (program in outputs) or has == (program in without):
            faults.append('%s: the document is wrong about its --json' % program)


outputs = read_document()
outputs['scene file'] = read_scene_document()
write_scenes(outputs['scene file'])
met = set()
for output, value in samples():
    met.add(output)
    compare(outputs.get(output, {}), value, '', output)
check_programs(outputs)
lenient = set(open(folder + '/partial', encoding='utf-8').read().splitlines()) | {'scene file'}
for output, keys in outputs.items():
    if output not in met:
        faults.append('%s: documented, but this test has no sample' % output)
    for path, key in keys.items():
        if not key.seen and not (key.optional and output in lenient):
            faults.append('%s: %s is documented, but was not printed' % (output, path))
for fault in sorted(set(faults)):
    print('FAILED: doc/json.md: ' + fault)
print('%d keys of %d outputs compared' % (sum(len(k) for k in outputs.values()), len(outputs)))
sys.exit(bool(faults))
END_OF_PYTHON
# All programs but adcgs-demo-grid, which is not installed.
programs=$(find . -maxdepth 1 -type f -name 'adcgs-*' -perm -u+x ! -name adcgs-demo-grid | sed 's|.*/||' | sort)
# shellcheck disable=SC2086
python3 "$dir/compare.py" "$top/doc/json.md" "$top/doc/scene-file.md" "$dir" $programs || failed=1
for name in top camera; do
    expect 4 "$name.json: " ./adcgs-enc "$dir/$name.json" -o "$dir/x.adcgs"
    ! grep "unknown field" "$dir/err" || bad "doc/scene-file.md has a key that programs do not read"
done
exit $failed
