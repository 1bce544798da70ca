# SPDX-License-Identifier: BSD-2-Clause
"""The package's structs, enums and prototypes are those of the headers, and its layouts those of the C compiler.

usage: test_layout.py SOURCE FOLDER COMPILER...
"""
import ctypes
import pathlib
import re
import subprocess
import sys

import adcgs
from adcgs import _library, _structs

source, folder, compiler = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3:]
include = source / "codec" / "include"
headers = {path.name: re.sub(r"/\*.*?\*/", "", path.read_text(), flags=re.S) for path in (include / "adcgs").glob("*.h")}
text = "\n".join(headers.values())
faults = []


def members(struct):
    """Names of a struct's members, in the order of the header."""
    body = re.search(r"typedef struct %s \{(.*?)\} %s;" % (struct, struct), text, re.S).group(1)
    return [re.search(r"(\w+)\s*(\[[^\]]*\])?$", line.strip()).group(1) for line in body.split(";") if line.strip()]


def constants(enum):
    body = re.search(r"typedef enum %s \{(.*?)\} %s;" % (enum, enum), text, re.S).group(1)
    return [(name.lower(), int(value)) for name, value in re.findall(r"(\w+) = (-?\d+)", body)]


def same(what, ours, theirs):
    if ours != theirs:
        faults.append(f"{what}: the package has {ours}, C has {theirs}")


def compare_names():
    for struct in _structs.STRUCTS:
        same(struct.__name__, [name for name, _ in struct._fields_], members(struct.__name__))
    for kind, struct in ((adcgs.Info, _structs.adcgs_info), (adcgs.Bytes, _structs.adcgs_bytes)):
        same(kind.__name__, list(kind._fields), [name for name, _ in struct._fields_ if name != "size"])
    for enum, prefix, names in (("adcgs_cpu_level", "adcgs_cpu_", enumerate(_structs.CPU_LEVELS)),
                                ("adcgs_arrival", "adcgs_arrived_", enumerate(_structs.ARRIVALS)),
                                ("adcgs_alpha", "adcgs_alpha_", enumerate(_structs.ALPHAS)),
                                ("adcgs_log_level", "adcgs_log_", _structs.LOG_LEVELS.items())):
        same(enum, [(prefix + name, i) for i, name in names], constants(enum))
    same("adcgs_status", sorted(_library.BY_STATUS), sorted(value for _, value in constants("adcgs_status") if value))


def compare_prototypes():
    """Each function of the headers, with its number of parameters; except adcgs_pool_wrap(), which takes threads of C."""
    theirs = {}
    for name, parameters in re.findall(r"ADCGS_API [^;(]*?(adcgs_\w+)\(([^;]*)\);", text, re.S):
        theirs[name] = 0 if parameters.strip() == "void" else parameters.count(",") + 1
    del theirs["adcgs_pool_wrap"]
    same("functions", {name: len(arguments) for name, (_, arguments) in sorted(_library.PROTOTYPES.items())},
         dict(sorted(theirs.items())))


def compare_layouts():
    """A C program prints sizes and offsets of all members."""
    lines = ['#include <adcgs/adcgs.h>', '#include <stdio.h>', 'int main(void) {']
    ours = []
    for struct in _structs.STRUCTS:
        name = struct.__name__
        lines.append(f'printf("{name} %zu\\n", sizeof({name}));')
        ours.append(f"{name} {ctypes.sizeof(struct)}")
        for member, _ in struct._fields_:
            field = getattr(struct, member)
            lines.append(f'printf("{name}.{member} %zu %zu\\n", offsetof({name}, {member}), sizeof((({name} *)0)->{member}));')
            ours.append(f"{name}.{member} {field.offset} {field.size}")
    for kind in ("adcgs_status", "adcgs_cpu_level", "adcgs_arrival", "adcgs_alpha", "adcgs_log_level"):
        lines.append(f'printf("{kind} %zu\\n", sizeof({kind}));')
        ours.append(f"{kind} {ctypes.sizeof(ctypes.c_int)}")
    (folder / "layout.c").write_text("\n".join(lines + ["return 0; }", ""]))
    subprocess.run([*compiler, "-std=c11", f"-I{include}", str(folder / "layout.c"), "-o", str(folder / "layout")], check=True)
    theirs = subprocess.run([str(folder / "layout")], check=True, capture_output=True, text=True).stdout.splitlines()
    for mine, its in zip(ours, theirs, strict=True):
        same("layout", mine, its)


compare_names()
compare_prototypes()
compare_layouts()
print("\n".join(faults))
sys.exit(bool(faults))
