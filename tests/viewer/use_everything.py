#!/usr/bin/env python3
"""use_everything.py VIEWER SOURCE [--replay]: headless runs that use everything the viewer has: every word of its views, every key, every
action, the panels, what it writes and what it takes up again. The lists are those with which the viewer refuses a wrong word, so
that nothing new is left out. The viewer itself ends with an error when OpenGL reports one; built with the address sanitizer it
also ends with one when it leaks."""
import json
import os
import pathlib
import re
import stat
import subprocess
import sys
import tempfile

viewer, source = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2])
replay = ["--replay", "run.html"] if "--replay" in sys.argv else []  # built with the page
scratch = tempfile.TemporaryDirectory()
folder = pathlib.Path(scratch.name)
environment = dict(os.environ, TOPPLE_MODELS=str(source / "models"), PATH=f"{folder}/bin:{os.environ['PATH']}")
environment["ASAN_OPTIONS"] = "detect_leaks=1:" + os.environ.get("ASAN_OPTIONS", "")


def run(*words, status=0):
    done = subprocess.run([viewer, *words], cwd=folder, env=environment, capture_output=True, text=True)
    if "no picture can be drawn" in done.stderr:
        print("SKIPPED:", done.stderr)
        sys.exit(0)
    if done.returncode != status:
        sys.exit(f"{' '.join(words)}: status {done.returncode}, not {status}\n{done.stdout}{done.stderr}")
    return done


def script(actions, name, size=(900, 640)):
    (folder / name).write_text(json.dumps({"topple": 1, "size": size, "actions": actions}))
    return name


def accepted(words, text):
    """The names that a refusal lists after 'accepted: '."""
    found = re.search(r"accepted: (.*)", run(*words, status=2).stderr)
    if not found:
        sys.exit(f"{text}: nothing is said to be accepted")
    return [name.strip() for name in found[1].split(",") if name.strip()]


def views():
    """Each word of `show`, with what it needs."""
    for word in accepted(["--headless", "--screenshot", "no.png", "--show", "nonsense"], "show"):
        if word == "diagram COMPONENT":
            yield from ("diagram " + c for c in ("axial", "shear_y", "shear_z", "torsion", "moment_y", "moment_z"))
        elif word.endswith(" NUMBER"):
            yield word.replace("NUMBER", "0.5" if word.endswith(("scale NUMBER", "opacity NUMBER")) else "2")
        else:
            yield word


def keys():
    names = accepted(["--headless", "--actions", script([{"at": 0, "key": "nonsense"}], "key.json")], "key")
    return [name for name in names if name not in ("n", "r", "space", "u")]  # those steer the run: below


def seen(at, name="view.png"):
    return {"at": at, "screenshot": name}


camera = {"eye": [-24, -22, 14], "target": [9, 12, 9], "field_of_view": 0.8}
corner, middle = [300, 520], [300, 300]  # pixels of the building from there


def looking():
    """While nothing moves: every view, every key, the eye."""
    yield {"at": 0, "camera": camera}
    for words in views():
        yield {"at": 0, "show": words}
        yield seen(0)
    for name in keys():
        yield {"at": 0, "key": name}
        yield seen(0)
    yield {"at": 0, "drag": [[100, 100], [140, 120]]}
    yield {"at": 0, "pan": [[100, 100], [110, 90]]}
    yield {"at": 0, "zoom": 2}
    yield {"at": 0, "fly": [1, -0.5, 0.25]}
    yield seen(0)


def acting():
    """The panels, every tool, rules, looking back, files."""
    yield {"at": 0, "camera": camera}
    yield {"at": 0, "show": "no dust"}
    yield {"at": 0, "select": "P-1-1-1"}
    yield {"at": 0, "key": "h"}
    yield seen(0)
    yield {"at": 0, "key": "h"}
    yield {"at": 0, "key": "v"}
    for tab in ([576, 309], [616, 309], [657, 309], [698, 309], [747, 309], [800, 309], [845, 309], [657, 309]):
        yield {"at": 0, "click": tab}
    yield {"at": 0, "drag": [[681, 375], [700, 375]]}  # the strength of all joints, in the tab that tunes
    yield seen(0, "tuned.png")
    yield {"at": 0.05, "set": {"joints": "posts", "strength": 2, "moment_y": 5e5}}
    yield {"at": 0.05, "tool": {"name": "load path"}}
    yield {"at": 0.05, "click": middle}
    for settings in ({"name": "cut joint"}, {"name": "remove part"}, {"name": "remove support"},
                     {"name": "charge", "reach": 2}, {"name": "burn", "reach": 2, "over": 1, "strength": 0.5, "stiffness": 0.5},
                     {"name": "explosion", "charge": 5}, {"name": "thermite", "over": 1}, {"name": "hook", "force": 1e5, "over": 1},
                     {"name": "wrecking ball", "cable": 8, "angle": 1, "mass": 4000, "radius": 0.8},
                     {"name": "fire", "speed": 70, "mass": 900, "radius": 0.5}):
        yield {"at": 0.1, "tool": settings}
        yield {"at": 0.1, "click": corner}
    yield {"at": 0.15, "key": "space"}
    yield {"at": 0.15, "key": "n"}
    yield {"at": 0.2, "key": "space"}
    yield {"at": 0.3, "fire": {"pixel": middle, "speed": 60, "mass": 500, "radius": 0.4}}
    yield seen(1.0, "acted.png")
    yield {"at": 1.0, "save": "run.topple"}
    for ending in ("usda", "glb"):
        yield {"at": 1.0, "export": "run." + ending}
    yield {"at": 1.1, "key": "u"}
    yield {"at": 1.15, "load": "run.topple"}
    yield {"at": 1.2, "look_at": 0.35}
    yield seen(1.2, "back.png")
    yield {"at": 1.2, "go_on": True}
    yield {"at": 1.2, "drag": [[500, 599], [200, 599]]}  # the slider of time
    yield {"at": 1.2, "look_at": "present"}
    yield {"at": 1.2, "key": "v"}
    yield {"at": 1.2, "click": [698, 309]}
    for button in ([808, 350], [811, 406]):  # the picture, all pictures
        yield {"at": 1.2, "click": button}
    yield {"at": 1.25, "gravity": 4}
    yield {"at": 1.25, "camera": dict(camera, eye=[-26, -20, 12], over=0.2)}
    yield {"at": 1.26, "earthquake": {"peak": 2, "over": 1}}
    yield {"at": 1.3, "restart": {"bracing": "classic", "mechanism": "detach", "sudden": 1.5,
                                  "second_order": True, "fracture": "voronoi", "cell": 1.5, "materials": {"steel": 0.9}}}
    yield {"at": 1.35, "fire": {"pixel": middle, "speed": 60, "mass": 500, "radius": 0.4}}
    yield seen(2.0, "by_other_rules.png")
    yield {"at": 2.0, "key": "r"}
    yield {"at": 2.0, "quit": True}


(folder / "bin").mkdir()
ffmpeg = folder / "bin" / "ffmpeg"  # one that keeps what it is given, so that the way to it is used where there is none
ffmpeg.write_text('#!/bin/sh\nfor word; do last=$word; done\nexec /bin/cat > "$last"\n')
ffmpeg.chmod(ffmpeg.stat().st_mode | stat.S_IXUSR)

looks, acts = [*looking()], [*acting()]
unused = set(accepted(["--headless", "--actions", script([{"at": 0}], "none.json")], "actions"))
unused -= {name for action in looks + acts for name in action}
if unused:
    sys.exit(f"actions that this run does not use: {sorted(unused)}")
run("seed_building", "--headless", "--actions", script(looks, "looks.json", (240, 160)))
run("seed_building", "--headless", "--panel", "--scale", "1", "--actions", script(acts, "acts.json"), "--model", "tuned.json")
run("seed_hit_fracture", "--headless", "--size", "160x100", "--at", "1.6", "--rate", "10", "--record", "frames", "--video",
    "run.webm", *replay, "--sound", "run.wav", "--usd", "fractured.usda", "--gltf", "fractured.glb", "--save", "fractured.topple", "--screenshot", "fractured.png")
run("seed_hit_fracture", "--headless", "--size", "160x100", "--load", "fractured.topple", "--screenshot", "again.png")

written = ["view.png", "tuned.png", "acted.png", "back.png", "by_other_rules.png", "run.topple", "run.usda", "run.glb",
           "tuned.json", "topple.png", "pictures/frame-00000.png", "pictures/frame-00010.png", "frames/frame-00016.png",
           "run.webm", "run.wav", *replay[1:], "fractured.usda", "fractured.glb", "fractured.topple", "fractured.png", "again.png"]
missing = [name for name in written if not (folder / name).is_file() or (folder / name).stat().st_size == 0]
if missing:
    sys.exit(f"not written: {missing}")
if (folder / "acted.png").read_bytes() == (folder / "tuned.png").read_bytes():
    sys.exit("the tools changed nothing")
print(f"{len(looks) + len(acts)} actions, {len(written)} files")
