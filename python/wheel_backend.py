# SPDX-License-Identifier: BSD-2-Clause
"""Build backend of the package (PEP 517): a wheel that holds libadcgs, and a source distribution of both. It needs no other
package, so it works offline.

ADCGS_LIBRARY names a libadcgs.so to use; without it the library is compiled from the sources around this folder. Only the folder
of the wheel is written to, except that a checkout without `configure` gets one.
"""
import base64
import gzip
import hashlib
import io
import os
import pathlib
import re
import shutil
import subprocess
import sysconfig
import tarfile
import tempfile
import zipfile

DATE = 315532800  # of all files in archives: 1980
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


def _makefiles(name="Makefile.am"):
    """Makefile.am, and the files that it includes: make looks for all of them."""
    yield name
    for included in re.findall(r"^include (\S+)$", (TOP / name).read_text(), re.MULTILINE):
        yield from _makefiles(included)


def _sources(top):
    """The paths of the package, of the decoder, and of the files that build it, also those that autoreconf makes."""
    found = {*_makefiles(), "configure.ac", "COPYING", "doc/python.md", "doc/Doxyfile.in", "build-aux/version.sh"}
    for pattern in ("python/adcgs/*.py", "python/adcgs/py.typed", "python/*.toml", "python/wheel_backend.py", "codec/**/*.[ch]",
                    "codec/**/*.in", "codec/**/*.map", "m4/*.m4", "build-aux/*", "configure", "aclocal.m4", "config.h.in", "Makefile.in"):
        found |= {str(path.relative_to(top)) for path in top.glob(pattern)}
    return sorted(found - {"python/adcgs/_where.py"})


def _configured(folder):
    """A copy of the sources with a `configure`."""
    for path in _sources(TOP):
        pathlib.Path(folder, path).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(TOP / path, pathlib.Path(folder, path))
    pathlib.Path(folder, "m4").mkdir(exist_ok=True)
    subprocess.run(["autoreconf", "-fi"], cwd=folder, check=True)
    shutil.rmtree(pathlib.Path(folder, "autom4te.cache"), ignore_errors=True)
    return pathlib.Path(folder)


def _write_sdist(top, path, version):
    with gzip.GzipFile(path, "wb", mtime=0) as zipped, tarfile.open(fileobj=zipped, mode="w", format=tarfile.PAX_FORMAT) as archive:

        def add(name, data, mode=0o644):
            entry = tarfile.TarInfo(f"adcgs-{version}/{name}")  # one date for all: make takes no file for newer than another
            entry.mode, entry.mtime, entry.size = mode, DATE, len(data)
            archive.addfile(entry, io.BytesIO(data))

        description = (top / "doc/python.md").read_text(encoding="utf-8")
        add("PKG-INFO", METADATA.format(version=version, description=description).encode())
        add("pyproject.toml", (HERE / "pyproject.toml").read_bytes().replace(b'["."]', b'["python"]'))
        for name in _sources(top):
            add(name, (top / name).read_bytes(), 0o755 if os.access(top / name, os.X_OK) else 0o644)


def build_sdist(sdist_directory, config_settings=None):
    """The package and the decoder, which pip compiles with a C compiler and make."""
    version = _version()
    name = f"adcgs-{version}.tar.gz"
    with tempfile.TemporaryDirectory(prefix="adcgs-") as folder:
        top = TOP if (TOP / "configure").exists() else _configured(folder)
        _write_sdist(top, os.path.join(sdist_directory, name), version)
    return name
