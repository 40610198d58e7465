#!/usr/bin/env python3
"""Holds the JSON Schemas against the examples in docs/, the shipped models and scenarios, mistakes that they must refuse, and
what the programs write.

usage: check_schemas.py SOURCE_DIR TOPPLE
"""
import copy
import functools
import json
import pathlib
import re
import subprocess
import sys
import tempfile

try:
    import jsonschema
except ImportError:
    print("SKIPPED: python3-jsonschema is not installed")
    sys.exit(0)

source, topple = pathlib.Path(sys.argv[1]), sys.argv[2]
failures = []
checked = 0


def schema(name):
    return json.loads((source / "schemas" / f"{name}.schema.json").read_text())


@functools.cache
def validator(name):
    return jsonschema.Draft202012Validator(schema(name))


def faults(name, value):
    return [f"{'/'.join(map(str, e.path))}: {e.message[:200]}" for e in validator(name).iter_errors(value)]


def expect_valid(name, value, what):
    global checked
    checked += 1
    for fault in faults(name, value):
        failures.append(f"{what} is not a valid {name}: {fault}")


def expect_invalid(name, value, what):
    global checked
    checked += 1
    if not faults(name, value):
        failures.append(f"the schema of {name} lets through: {what}")


def documented_examples():
    """Each block of JSON in docs/ that stands below `<!-- schema: NAME -->`."""
    for document in sorted((source / "docs").glob("*.md")):
        for kind, text in re.findall(r"<!-- schema: (.*?) -->\n```json\n(.*?)```", document.read_text(), re.S):
            yield document.name, kind, text


def set_at(value, path, new):
    changed = copy.deepcopy(value)
    place = changed
    for key in path[:-1]:
        place = place[key]
    if new is None:
        del place[path[-1]]
    else:
        place[path[-1]] = new
    return changed


for name in ["model", "scenario", "results", "events", "summary", "standing", "panel", "actions", "study"]:
    jsonschema.Draft202012Validator.check_schema(schema(name))

examples = {}
for document, kind, text in documented_examples():
    value = json.loads(text)
    if kind == "model building":  # a fragment: it stands in a model
        value, kind = {"topple": 1, **value}, "model"
    else:
        examples[kind] = value
    expect_valid(kind, value, f"the example in {document}")
for kind in ["model", "scenario", "results", "events", "summary", "standing", "panel", "actions", "study"]:
    if kind not in examples:
        failures.append(f"docs/ shows no example of {kind}")

for file in sorted((source / "models").glob("*.json")):
    expect_valid("model", json.loads(file.read_text()), file.name)
for file in sorted((source / "models" / "scenarios").glob("*.json")):
    expect_valid("scenario", json.loads(file.read_text()), file.name)

for file in sorted((source / "models" / "studies").glob("*.json")):
    expect_valid("study", json.loads(file.read_text()), file.name)

# Each mistake is refused by the schema and, where it is a model, by the reader as well.
model_mistakes = [
    (["topple"], 2), (["topple"], None), (["titel"], "x"), (["units", "length"], "yd"), (["gravity"], -1),
    (["materials", "S355", "youngs_modulus"], None), (["materials", "S355", "density"], "7850"),
    (["materials", "S355", "poisson_ratio"], 0.7), (["sections", "col", "web"], None), (["sections", "tube", "shape"], "I"),
    (["sections", "w14", "depth"], 0.3), (["sections", "raw", "J"], 0), (["joints", "given", "strength"], 0),
    (["joints", "given", "capacity", "bending"], 1), (["joints", "original", "capacity", "force"], [1, 2]),
    (["joints", "original", "capacity", "from"], "section"), (["joints", "given", "capacity", "ratio"], 0.5),
    (["joints", "ductile", "interaction"], "sum"), (["joints", "pin", "stiffness", "ry"], -1), (["nodes", "A0"], [0, 0]),
    (["nodes", "A*"], [9, 9, 9]), (["members", "PA", "nodes"], ["A0", "A0"]), (["members", "PA", "section"], None),
    (["members", "PA", "kind"], "column"), (["members", "PA", "joints"], ["given"]), (["panels", "S1", "thickness"], 0),
    (["panels", "S1", "model"], "plate"), (["panels", "W1", "openings"], [[[0, 0], [1, 0]]]), (["supports", "A0"], "clamped"),
    (["supports", "C0", "x"], False), (["loads", "live", "members", "BC", 2, "at"], None),
    (["loads", "live", "members", "BC", 2, "frame"], "projected"), (["loads", "live", "members", "BC", 0, "uniform"], {"w": 1}),
    (["combinations", "service"], {}), (["members", "PA", "design"], {"length_y": -1}), (["members", "PA", "design"], "all"),
    (["members", "PA", "design"], {"restraints": "top"}), (["analyses"], {"p_delta": "exact"}), (["analyses"], {"mass": "lumped"}),
    (["frame3dd"], {"tolerance": 0}),
]
scenario_mistakes = [
    (["model"], None), (["step"], 0), (["failure", "bracing"], "strong"), (["failure", "sudden"], 0.5),
    (["impact", "restitution"], 2), (["debris", "limit"], 1.5), (["events", 0, "at"], None),
    (["events", 0, "gravity"], [0, 0, 0]), (["events", 0, "projectile", "mass"], 0), (["events", 3, "charge", "radius"], None),
    (["events", 4, "weaken", "stiffness"], 0), (["events", 5, "wrecking_ball", "anchor"], None),
    (["events", 1, "cut", "members", 0, "where"], 1.5),
]
study_mistakes = [
    (["base"], None), (["base"], {"model": "a", "scenario": "b"}), (["samples"], 0), (["sampling"], "grid"),
    (["vary", 0, "uniform"], [1]), (["vary", 0, "uniform"], None), (["vary", 0, "at"], None), (["vary", 1, "lognormal", "cov"], 0),
    (["vary", 2, "strength"], {"mean": 1}), (["record", "down"], "summary"), (["record"], {}), (["collapse_if", "down"], {}),
    (["record", "down"], "down"),
]
with tempfile.TemporaryDirectory() as folder:
    file = pathlib.Path(folder) / "model.json"

    def reader_says(value):
        file.write_text(json.dumps(value))
        return subprocess.run([topple, "check", str(file)], capture_output=True, text=True)

    if "model" in examples:
        fine = reader_says(examples["model"])
        if fine.returncode != 0:
            failures.append(f"the documented model is refused: {fine.stderr}")
        for path, new in model_mistakes:
            wrong = set_at(examples["model"], path, new)
            expect_invalid("model", wrong, f"{path} = {new}")
            told = reader_says(wrong)
            if told.returncode != 2 or told.stderr.count("\n") != 1:
                failures.append(f"the reader lets through: {path} = {new}: {told.returncode} {told.stderr}")
if "scenario" in examples:
    for path, new in scenario_mistakes:
        expect_invalid("scenario", set_at(examples["scenario"], path, new), f"{path} = {new}")
if "study" in examples:
    for path, new in study_mistakes:
        expect_invalid("study", set_at(examples["study"], path, new), f"{path} = {new}")

# What the programs write: an analysis, and the first seconds of a collapse.
collapse = {"topple": 1, "model": "tower", "combination": "collapse", "duration": 2, "events": [
    {"at": 0.1, "projectile": {"from": [-4, 0, 2], "velocity": [80, 0, 0], "mass": 2000, "radius": 0.5}}]}
most_events = 2000  # held one by one
with tempfile.TemporaryDirectory() as folder:
    place = pathlib.Path(folder)
    (place / "collapse.json").write_text(json.dumps(collapse))
    for command, files in [(["analyse", "tower"], ["results.json"]),
                           (["analyse", "tower", "--code", "en1993", "--stations", "3"], ["results.json"]),
                           (["analyse", "tower", "--lose", "P-1-1-1", "--lose-each", "storey-2"], ["results.json"]),
                           (["demolish", str(place / "collapse.json")], ["events.jsonl", "summary.json", "standing.json"])]:
        run = subprocess.run([topple, *command, "-o", folder], capture_output=True, text=True)
        if run.returncode != 0:
            failures.append(f"topple {command[0]} ends with {run.returncode}: {run.stderr}")
            continue
        for name in files:
            text = (place / name).read_text()
            values = text.splitlines()[:most_events] if name.endswith("jsonl") else [text]
            for number, value in enumerate(values):
                expect_valid(name.split(".")[0], json.loads(value), f"{name}, value {number}")

# A Frame3DD file with loads of every kind, modes and condensation, as a JSON model.
frame3dd = """Everything that a file can hold
3
1 0 0 0 0
2 0 0 3000 10
3 2000 0 3000 0
1
1 1 1 1 1 1 1
2
1 1 2 100 50 60 10 20 30 200000 80000 0 7.85e-9
2 2 3 100 50 60 10 20 30 200000 80000 30 7.85e-9
1 1 10 1 -1
1
0 0 -9806.65
1
3 0 0 -1000 0 0 0
1
1 0 1 0
1
2 0 0 0 0 500 1500 0.1 0.2 0 0 0 0
1
2 0 -5 0 1500
1
1 12e-6 100 200 10 20 30 70
1
1 0 0 -2.5 0 0 0
2 1 0 1e-9 0 10
1
3 1 2 3 4
1
2 5
1 1
0
2 1
3 1 0 0 0 0 0
1
"""
with tempfile.TemporaryDirectory() as folder:
    place = pathlib.Path(folder)
    (place / "all.3dd").write_text(frame3dd)
    run = subprocess.run([topple, "convert", str(place / "all.3dd"), str(place / "all.json")], capture_output=True, text=True)
    if run.returncode != 0:
        failures.append(f"topple convert ends with {run.returncode}: {run.stderr}")
    else:
        expect_valid("model", json.loads((place / "all.json").read_text()), "a converted .3dd file")

for failure in failures:
    print(failure)
print(f"{checked} checks, {len(failures)} failures")
sys.exit(1 if failures else 0)
