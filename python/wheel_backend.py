# SPDX-License-Identifier: BSD-2-Clause
"""Build backend of the package (PEP 517): a wheel that holds libadcgs. It needs no other package, so it works offline.

ADCGS_LIBRARY names a libadcgs.so to use; without it the library is compiled from the sources around this folder. Only the folder
of the wheel is written to, except that a checkout without `configure` gets one.
"""
import base64
import hashlib
import os
import pathlib
import re
import subprocess
import sysconfig
import tempfile
import zipfile

HERE = pathlib.Path(__file__).resolve().parent
TOP = HERE.parent
METADATA = """Metadata-Version: 2.1
Name: adcgs
Version: {version}
Summary: Decode and render streams of dynamic Gaussian splats
License: BSD-2-Clause
Requires-Python: >=3.10
Provides-Extra: arrays
Requires-Dist: numpy>=1.22; extra == "arrays"
Description-Content-Type: text/markdown

{description}"""
WHEEL = """Wheel-Version: 1.0
Generator: adcgs {version}
Root-Is-Purelib: false
Tag: {tag}
"""


def _version():
    header = (TOP / "codec/include/adcgs/version.h").read_text()
    return ".".join(re.findall(r"#define ADCGS_VERSION_(?:MAJOR|MINOR|PATCH) +(\d+)", header))


def _compile(folder):
    """The library, built without the encoder, for which a C compiler suffices."""
    if not (TOP / "configure").exists():
        (TOP / "m4").mkdir(exist_ok=True)
        subprocess.run(["autoreconf", "-fi"], cwd=TOP, check=True)
    subprocess.run([str(TOP / "configure"), "--disable-encoder", "--disable-static"], cwd=folder, check=True)
    subprocess.run(["make", f"-j{os.cpu_count() or 1}", "libadcgs.la"], cwd=folder, check=True)
    return pathlib.Path(folder, ".libs/libadcgs.so").read_bytes()


def _library():
    given = os.environ.get("ADCGS_LIBRARY")
    if given:
        return pathlib.Path(given).read_bytes()
    with tempfile.TemporaryDirectory(prefix="adcgs-") as folder:
        return _compile(folder)


def _files(version, tag):
    """Names and contents, in the order of the archive."""
    for path in sorted((HERE / "adcgs").glob("*.py")):
        if path.name != "_where.py":  # of a build in the source tree
            yield f"adcgs/{path.name}", path.read_bytes()
    yield "adcgs/py.typed", b""
    yield "adcgs/_where.py", b'LIBRARY = "libadcgs.so"\n'
    yield "adcgs/libadcgs.so", _library()
    information = f"adcgs-{version}.dist-info"
    description = (TOP / "doc/python.md").read_text(encoding="utf-8")
    yield f"{information}/COPYING", (TOP / "COPYING").read_bytes()
    yield f"{information}/METADATA", METADATA.format(version=version, description=description).encode()
    yield f"{information}/WHEEL", WHEEL.format(version=version, tag=tag).encode()


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    version = _version()
    tag = "py3-none-" + re.sub(r"[-.]", "_", sysconfig.get_platform())
    name = f"adcgs-{version}-{tag}.whl"
    record = f"adcgs-{version}.dist-info/RECORD"
    rows = []
    with zipfile.ZipFile(os.path.join(wheel_directory, name), "w", zipfile.ZIP_DEFLATED) as archive:

        def add(path, data):
            entry = zipfile.ZipInfo(path)  # a fixed date: the same files give the same wheel
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, data, zipfile.ZIP_DEFLATED)

        for path, data in _files(version, tag):
            add(path, data)
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            rows.append(f"{path},sha256={digest},{len(data)}\n")
        add(record, "".join(rows) + f"{record},,\n")
    return name


def build_sdist(sdist_directory, config_settings=None):
    raise RuntimeError("adcgs: the source distribution is the tarball of `make dist`; pip wheel needs the whole source tree")
