"""Shipped cases fit the schema that the program prints, wrong ones do not, and the user guide names no unknown key.
What is no case ends the program with code 2 and a message that names its place.

usage: schema_test.py QUICKSAND SOURCE_FOLDER
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile

NO_KEYS = {"history.csv", "case.yaml", "summary.json", "crater.csv", "crater_profiles.csv", "bubbles.csv", "events.csv", "fields.xdmf", "report.html"}


def keys_of(schema, path=""):
    """Paths of all keys of a schema, without the numbers of list items."""
    found = set()
    for part in schema.get("oneOf", []):
        found |= keys_of(part, path)
    if "items" in schema:
        found |= keys_of(schema["items"], path)
    for key, value in schema.get("properties", {}).items():
        below = f"{path}.{key}" if path else key
        found |= {below} | keys_of(value, below)
    return found


def check_descriptions(schema, path=""):
    for part in schema.get("oneOf", []) + ([schema["items"]] if "items" in schema else []):
        check_descriptions(part, path)
    for key, value in schema.get("properties", {}).items():
        assert value.get("description"), f"{path}.{key} has no description"
        check_descriptions(value, f"{path}.{key}")
    if "properties" in schema:
        assert schema["additionalProperties"] is False, path


def check_guide(guide, keys):
    """Keys in the tables of the sections of the case file, and dotted keys anywhere in them."""
    ends = {".".join(key.split(".")[n:]) for key in keys for n in range(key.count(".") + 1)}
    text = guide.read_text()
    part = text[text.index("## The case file") :]
    unknown = []
    for line in part.splitlines():
        row = re.match(r"\| (`[^|]*`) \|", line)
        if row and "{" not in row[1]:
            unknown += [key for key in re.findall(r"`([a-z_.]+)`", row[1]) if key not in ends]
        dotted = re.findall(r"`([a-z_]+(?:\.[a-z_]+)+)`", line)
        unknown += [key for key in dotted if key not in ends and key not in NO_KEYS]
    words = {"axis", "symmetry", "free_slip", "no_slip", "periodic", "inviscid", "newtonian", "bingham", "papanastasiou", "herschel_bulkley", "casson"}
    unknown = sorted(set(unknown) - words)
    assert not unknown, f"the user guide names unknown keys: {unknown}"


def check_refusals(quicksand):
    """The program on files that are no cases."""
    wrong = [
        (b"", "is empty"),
        (b"\x7fELF\0\1", "is not a text file"),
        (b"title: [", ":1:"),
        (b"- 1\n- 2\n", ":1:1: must be a mapping of keys"),
        (b"titel: a\n", ":1:1: titel: unknown key; did you mean 'title'?"),
        (b"title: \"a\n", ":1:8: not valid YAML: the quote that begins here is never closed"),
        (b"[" * 100000, "not valid YAML"),
        (None, "is a folder"),
    ]
    with tempfile.TemporaryDirectory() as folder:
        for content, message in wrong:
            path = pathlib.Path(folder)
            if content is not None:
                path = path / "case.yaml"
                path.write_bytes(content)
            for command in ("check", "show", "run"):
                done = subprocess.run([quicksand, command, str(path)], capture_output=True, text=True, cwd=folder, timeout=20)
                assert done.returncode == 2, (content, command, done)
                assert str(path) in done.stderr and message in done.stderr, (content, done.stderr)


def plain(value):
    """YAML 1.1 reads 1e-3 as text; the program and YAML 1.2 as a number."""
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, list):
        return [plain(item) for item in value]
    if isinstance(value, str) and re.fullmatch(r"[+-]?[0-9.]+[eE][+-]?[0-9]+", value):
        return float(value)
    return value


def main():
    quicksand, source = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2])
    check_refusals(quicksand)
    schema = json.loads(subprocess.run([quicksand, "schema"], check=True, capture_output=True, text=True).stdout)
    check_descriptions(schema)
    check_guide(source / "docs/user_guide.md", keys_of(schema))
    try:
        import jsonschema
        import yaml
    except ModuleNotFoundError as error:
        print(f"{error.name} is not there: cases were not compared with the schema")
        return 77
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    files = sorted((source / "configs").rglob("*.yaml"))
    assert files
    for file in files:
        case = plain(yaml.safe_load(file.read_text()))
        for error in validator.iter_errors(case):
            raise AssertionError(f"{file}: {list(error.absolute_path)}: {error.message}")
    template = subprocess.run([quicksand, "show", "--explain"], check=True, capture_output=True, text=True).stdout
    case = plain(yaml.safe_load(template))
    assert validator.is_valid(case), "the template"
    changes = [
        lambda c: c.update(titel=1),
        lambda c: c.pop("grid"),
        lambda c: c["grid"].update(dimension=4),
        lambda c: c["grid"]["x"].update(cells=0),
        lambda c: c["grid"]["x"].update(to="far"),
        lambda c: c["time"].update(cfl=2),
        lambda c: c["time"].update(end=-1),
        lambda c: c["boundaries"].update(x_min="wall"),
        lambda c: c["species"][0].update(density=0),
        lambda c: c["species"][0]["rheology"].update(law="rubber"),
        lambda c: c["species"][0]["rheology"].pop("yield_stress"),
        lambda c: c["initial"][0]["shape"].update(sphere={"center": [0, 0], "radius": 1}),
        lambda c: c["output"].update(history="yes"),
    ]
    for change in changes:
        wrong = json.loads(json.dumps(case))
        change(wrong)
        assert not validator.is_valid(wrong), f"the schema allows {wrong}"
    print(f"{len(files)} cases fit the schema, {len(changes)} wrong ones do not")
    return 0


if __name__ == "__main__":
    sys.exit(main())
