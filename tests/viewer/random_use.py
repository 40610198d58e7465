#!/usr/bin/env python3
"""random_use.py VIEWER SOURCE SECONDS [SEED]: headless runs of what a person might do by chance, until the time is over: tools, keys,
views, clicks and drags anywhere (in the panels too), looking back, saving and loading, other rules, in the shipped scenes that are not large.
Ends with the first run that does not end well (OpenGL errors end the viewer; so do the sanitizers' findings), and keeps its script."""
import json
import os
import pathlib
import random
import re
import subprocess
import sys
import tempfile
import time

viewer, source, seconds = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2]), float(sys.argv[3])
seed = int(sys.argv[4]) if len(sys.argv) > 4 else int(time.time())
environment = dict(os.environ, TOPPLE_MODELS=str(source / "models"))
environment["ASAN_OPTIONS"] = "detect_leaks=1:" + os.environ.get("ASAN_OPTIONS", "")
scenes = ["town_house", "seed_building", "seed_hit", "seed_hit_fracture", "seed_house_hit", "house_hit", "hall_buckling", "bridge_hit",
          "shell_house_hit", "wall_hit", "tower_hit", "tower_charges", "seed_shear_walls"]
width, height = 480, 360
folder = tempfile.mkdtemp(prefix="topple-random-")


def accepted(words):
    done = subprocess.run([viewer, "town_house", "--headless", *words], cwd=folder, env=environment, capture_output=True, text=True)
    found = re.search(r"accepted: (.*)", done.stderr)
    if not found:
        print("SKIPPED:", done.stderr)
        sys.exit(0)
    return [word.strip() for word in found[1].split(",")]


def script(actions):
    path = pathlib.Path(folder) / "actions.json"
    path.write_text(json.dumps({"topple": 1, "size": [width, height], "actions": actions}))
    return str(path)


keys = accepted(["--actions", script([{"at": 0, "key": "nonsense"}])])
views = accepted(["--screenshot", "no.png", "--show", "nonsense"])


def view(chance):
    word = chance.choice(views)
    if word == "diagram COMPONENT":
        return "diagram " + chance.choice(["axial", "shear_y", "shear_z", "torsion", "moment_y", "moment_z"])
    if word.startswith(("vibration", "buckling")):
        return word.replace("NUMBER", str(chance.randint(1, 3)))
    return word.replace("NUMBER", f"{chance.uniform(0, 1):.2f}")


def pixel(chance, whole=False):
    return [chance.randrange(width), chance.randrange(height)] if whole else [chance.randrange(width // 2), chance.randrange(height // 2)]


def tool(chance):
    return chance.choice([
        {"name": "fire", "speed": chance.uniform(10, 200), "mass": chance.uniform(50, 5000), "radius": chance.uniform(0.1, 1)},
        {"name": "wrecking ball", "cable": chance.uniform(3, 20), "angle": chance.uniform(0.2, 1.5)},
        {"name": "cut joint"}, {"name": "remove part"}, {"name": "remove support"}, {"name": "load path"}, {"name": "select"},
        {"name": "charge", "reach": chance.uniform(1, 10)}, {"name": "explosion", "charge": chance.uniform(1, 100)},
        {"name": "burn", "reach": chance.uniform(1, 8), "over": chance.uniform(0.5, 5)}, {"name": "thermite", "over": chance.uniform(0.5, 3)},
        {"name": "hook", "force": chance.uniform(1e4, 2e6), "over": chance.uniform(0.2, 3)}])


def action(chance, saved):
    kinds = {
        "key": 8, "show": 6, "tool": 8, "click": 14, "drag": 4, "panel_click": 5, "pan": 1, "zoom": 2, "fly": 1, "fire": 5, "earthquake": 1,
        "gravity": 1, "look_at": 2, "go_on": 1, "restart": 1, "save": 1, "load": 1 if saved else 0, "set": 2, "screenshot": 6}
    kind = chance.choices(list(kinds), list(kinds.values()))[0]
    return {
        "key": lambda: {"key": chance.choice(keys)},
        "show": lambda: {"show": view(chance)},
        "tool": lambda: {"tool": tool(chance)},
        "click": lambda: {"click": pixel(chance)},
        "panel_click": lambda: {"click": pixel(chance, True)},
        "drag": lambda: {"drag": [pixel(chance, True), pixel(chance, True)]},
        "pan": lambda: {"pan": [pixel(chance), pixel(chance)]},
        "zoom": lambda: {"zoom": chance.uniform(-3, 3)},
        "fly": lambda: {"fly": [chance.uniform(-3, 3) for _ in range(3)]},
        "fire": lambda: {"fire": {"pixel": pixel(chance), "speed": chance.uniform(20, 150), "mass": chance.uniform(100, 5000)}},
        "earthquake": lambda: {"earthquake": {"peak": chance.uniform(0.5, 10), "over": chance.uniform(0.5, 4)}},
        "gravity": lambda: {"gravity": chance.uniform(0, 20)},
        "look_at": lambda: {"look_at": chance.choice(["present", chance.uniform(0, 3)])},
        "go_on": lambda: {"go_on": True},
        "restart": lambda: {"restart": {"bracing": chance.choice(["buckling", "classic", "none"]), "second_order": chance.random() < 0.3}},
        "save": lambda: {"save": "run.topple"},
        "load": lambda: {"load": "run.topple"},
        "set": lambda: {"set": {"joints": chance.choice(["posts", "beams", "slabs", "*"]), "strength": chance.uniform(0.3, 3)}},
        "screenshot": lambda: {"screenshot": "picture.png"},
    }[kind]()


begun, runs, refusals = time.time(), 0, 0
while time.time() - begun < seconds:
    chance = random.Random(seed + runs)
    scene, actions, at = chance.choice(scenes), [], 0.0
    for _ in range(chance.randint(10, 50)):
        at += chance.choice([0, 0, 0.02, 0.05, 0.2])
        one = action(chance, any("save" in done for done in actions))
        actions.append({"at": round(at, 3), **one})
    actions.append({"at": round(at + 0.3, 3), "screenshot": "picture.png"})
    words = [viewer, scene, "--headless", "--panel", "--actions", script(actions)] + (["--sound", "run.wav"] if chance.random() < 0.3 else [])
    done = subprocess.run(words, cwd=folder, env=environment, capture_output=True, text=True)
    if "Tracer caught signal" in done.stderr:  # the search for leaks stumbled itself, over a thread that was just ending: told, and asked again
        print(f"{scene}, seed {seed + runs}: the leak sanitizer failed and is run again", flush=True)
        done = subprocess.run(words, cwd=folder, env=environment, capture_output=True, text=True)
    # A line that refuses (a joint that does not exist any more, rules that this building cannot be run by) ends a script in good order.
    refused = done.returncode in (2, 3) and done.stderr.count("\n") == 1 and "ERROR" not in done.stderr
    if done.returncode != 0 and not refused:
        sys.exit(f"{scene}, seed {seed + runs}: status {done.returncode}; its script is {folder}/actions.json\n{done.stdout}{done.stderr}")
    runs += 1
    refusals += refused
print(f"{runs} runs ({refusals} ended by a refusal) in {time.time() - begun:.0f} s, seeds {seed} to {seed + runs - 1}")
