#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""Checks conformance/manifest.json against its schema, and conditions that a schema cannot express.

usage: check_manifest.py SOURCE    the folder with conformance/ and spec/

Supports the part of JSON Schema that schema.json uses, and refuses other keywords, so that no part of it is left unchecked.
"""
import hashlib
import json
import re
import sys
from pathlib import Path

TYPES = {"object": dict, "array": list, "string": str, "boolean": bool}
KNOWN = {"$schema", "$defs", "$ref", "title", "type", "required", "additionalProperties", "properties", "const", "enum",
         "pattern", "minimum", "maximum", "minLength", "minItems", "maxItems", "uniqueItems", "items", "oneOf"}
SIZE_MAX, TOTAL_MAX = 16 * 1024, 4 * 1024 * 1024
FEWEST = {"good": 80, "bad": 80, "at the edges": 10}


def type_fits(value, name):
    if name in ("integer", "number"):
        kinds = int if name == "integer" else (int, float)
        return isinstance(value, kinds) and not isinstance(value, bool)
    return isinstance(value, TYPES[name])


def object_faults(value, schema, root, where):
    members = schema.get("properties", {})
    for name in schema.get("required", []):
        if name not in value:
            yield f"{where}: lacks {name}"
    for name, item in value.items():
        if name in members:
            yield from faults(item, members[name], root, f"{where}.{name}")
        elif schema.get("additionalProperties", True) is False:
            yield f"{where}: {name} is unknown"


def array_faults(value, schema, root, where):
    if not schema.get("minItems", 0) <= len(value) <= schema.get("maxItems", len(value)):
        yield f"{where}: has {len(value)} items"
    if schema.get("uniqueItems") and len(set(map(json.dumps, value))) < len(value):
        yield f"{where}: an item occurs twice"
    for i, item in enumerate(value):
        yield from faults(item, schema.get("items", {}), root, f"{where}[{i}]")


def scalar_faults(value, schema, where):
    if "const" in schema and value != schema["const"]:
        yield f"{where}: is {value!r}, expected {schema['const']!r}"
    if "enum" in schema and value not in schema["enum"]:
        yield f"{where}: is {value!r}"
    if isinstance(value, str):
        if not re.search(schema.get("pattern", ""), value) or len(value) < schema.get("minLength", 0):
            yield f"{where}: is {value!r}"
    elif type_fits(value, "number"):
        if not schema.get("minimum", value) <= value <= schema.get("maximum", value):
            yield f"{where}: is {value}"


def faults(value, schema, root, where):
    """Yields a message for each violation of the schema by a value."""
    unknown = set(schema) - KNOWN
    if unknown:
        yield f"schema: this program does not support {sorted(unknown)}"
    if "$ref" in schema:
        yield from faults(value, root["$defs"][schema["$ref"].removeprefix("#/$defs/")], root, where)
    if "type" in schema and not type_fits(value, schema["type"]):
        yield f"{where}: is no {schema['type']}"
        return
    yield from scalar_faults(value, schema, where)
    if isinstance(value, dict):
        yield from object_faults(value, schema, root, where)
    elif isinstance(value, list):
        yield from array_faults(value, schema, root, where)
    if "oneOf" in schema:
        fits = [not list(faults(value, one, root, where)) for one in schema["oneOf"]]
        if fits.count(True) != 1:
            yield f"{where}: fits {fits.count(True)} of {len(fits)} alternatives"


def vector_faults(vector, folder, requirements):
    """Beyond the schema: the files exist and fit the entry; the requirements exist."""
    name, path = vector["id"], folder / vector["file"]
    if vector["file"] != f"vectors/{name}.adcgs" or vector["recipe"] != f"recipes/{name}.txt":
        yield f"{name}: its files have other names"
    if not name.startswith(vector["verdict"] + "-"):
        yield f"{name}: has another verdict"
    if not path.is_file() or not (folder / vector["recipe"]).is_file():
        yield f"{name}: a file is missing"
        return
    data = path.read_bytes()
    if hashlib.md5(data).hexdigest() != vector["md5"] or len(data) != vector["props"]["bytes"]:
        yield f"{name}: MD5 or size of the file differ from the entry"
    if len(data) > SIZE_MAX:
        yield f"{name}: {len(data)} bytes"
    for requirement in vector.get("covers", []) + vector.get("violates", []):
        if requirement not in requirements:
            yield f"{name}: there is no {requirement}"
    if vector["verdict"] == "good":
        frames = {(frame["camera"], frame["time"]) for frame in vector["expect"]["R"]}
        wanted = {(i, splats["time"]) for i in range(len(vector["cameras"])) for splats in vector["expect"]["S"]}
        if frames != wanted or len(vector["expect"]["M"]) != vector["props"]["segments"]:
            yield f"{name}: the expected results do not fit each other"
        if len(frames) != vector["props"]["frames"]:
            yield f"{name}: has {len(frames)} frames"


def suite_faults(vectors, folder):
    names = [vector["id"].lower() for vector in vectors]
    if len(set(names)) < len(names):
        yield "two vectors have the same name"
    for kind, ending in (("vectors", ".adcgs"), ("recipes", ".txt")):
        there = {path.name for path in (folder / kind).iterdir()}
        for path in sorted(there ^ {name + ending for name in names}):
            yield f"{kind}/{path}: is missing in the manifest or in the folder"
    verdicts = [vector["verdict"] for vector in vectors]
    counts = {"good": verdicts.count("good"), "bad": verdicts.count("bad"),
              "at the edges": verdicts.count("limit") + verdicts.count("unsup")}
    for kind, fewest in FEWEST.items():
        if counts[kind] < fewest:
            yield f"{counts[kind]} vectors are {kind}, fewer than {fewest}"
    total = sum(vector["props"]["bytes"] for vector in vectors)
    if total > TOTAL_MAX:
        yield f"all vectors have {total} bytes, more than {TOTAL_MAX}"


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    source = Path(sys.argv[1])
    folder = source / "conformance"
    manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    schema = json.loads((folder / "schema.json").read_text(encoding="utf-8"))
    clauses = (source / "spec" / "clauses").glob("*.adoc")
    text = "".join(path.read_text(encoding="utf-8") for path in clauses)
    requirements = set(re.findall(r"\[\[(REQ-[A-Z]+-\d+)\]\]", text))
    found = list(faults(manifest, schema, schema, "manifest"))
    if not found:
        for vector in manifest["vectors"]:
            found += vector_faults(vector, folder, requirements)
        found += suite_faults(manifest["vectors"], folder)
    for fault in found:
        print(fault, file=sys.stderr)
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
