#!/usr/bin/env python3
"""Hostile inputs against the built programs: hostile.py BIN [--cases N] [--only WORD] [--slice I/N] [--seed S] [--list].

Every numeric option of every command with what is no number; every number and every text of models, scenarios, panel
files and drawings at its extremes; files that are none; outputs that cannot be written. Whatever comes in, a program
ends within ten seconds of a processor with a status that says what happened and one line that says why:

  no signal, no hang, no status 1 for a wrong input, nothing that is not a number printed with status 0, no file that is
  not whole, no temporary left.
"""
import argparse, copy, json, os, pathlib, random, re, shutil, signal, struct, subprocess, sys, tempfile
from concurrent.futures import ThreadPoolExecutor

from hostile_odd import odd_cases
from hostile_rest import (CHARGES, CONNECT, CUTS, DRAWN, GROUND, LOSSES, OPTIMISE, PLAN, POSTS, QUAKE, QUICK, REST,
                          untried_keys)
from hostile_scenes import (ACTIONS, BRITTLE, BUILDING, FRAME3DD, HISTORY, LOCAL, MODEL, MORE_ACTIONS, MOVING, PANEL, PLAIN, QUADS, SCENARIO,
                            STUDY, WIDE)

LIMIT = 10  # s of a processor
WAIT = 90   # s by the clock, as the machine may be busy
BOUNDS = f"ulimit -v 12000000; ulimit -S -t {LIMIT}"
SANITIZED = f"ulimit -S -t {6 * LIMIT}"  # which need addresses without end
ROOT = pathlib.Path(__file__).resolve().parents[2]
WORDS = ["nan", "-nan", "inf", "-inf", "1e400", "-1e400", "-0", "", "1e300", "-1", "0x10", "1e18", "abc", "1 2",
         "99999999999999999999", "5e-324", "\u0661", "1,5"]
NUMBERS = [0, -0.0, 5e-324, 1e-300, 1e-30, 1e30, 1e300, -1e300, -1, 2**31, 2**63, 1e18, 0.5, 3]
OTHERS = [None, True, "", "nan", [], {}, "\u001b[31m", "a\nb", "x" * 70000]

def places(tree, at=()):
    """Every leaf of a JSON tree as a path."""
    if isinstance(tree, (dict, list)):
        for key in (tree if isinstance(tree, dict) else range(len(tree))):
            yield from places(tree[key], at + (key,))
    else:
        yield at


def put(tree, at, value):
    tree = copy.deepcopy(tree)
    spot = tree
    for key in at[:-1]:
        spot = spot[key]
    spot[at[-1]] = value
    return tree


def inner_places(tree, at=()):
    """Every key and index of a JSON tree as a path."""
    if isinstance(tree, (dict, list)):
        for key in (tree if isinstance(tree, dict) else range(len(tree))):
            yield at + (key,)
            yield from inner_places(tree[key], at + (key,))


def without(tree, at):
    tree = copy.deepcopy(tree)
    spot = tree
    for key in at[:-1]:
        spot = spot[key]
    del spot[at[-1]]
    return tree


def text(tree):
    """JSON, except that infinity is a number too large to hold."""
    return json.dumps(tree).replace("Infinity", "1e999")


def glb(meshes, nodes, accessors=None, views=None, buffer=None, uri=None):
    points = struct.pack("<12f", 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1)
    indices = struct.pack("<12H", 0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3)
    binary = points + indices if buffer is None else buffer
    document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": nodes, "meshes": meshes,
                "accessors": accessors or [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                                           {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}],
                "bufferViews": views or [{"buffer": 0, "byteOffset": 0, "byteLength": 48},
                                         {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
                "buffers": [{"byteLength": len(binary), **({"uri": uri} if uri else {})}]}
    header = json.dumps(document).encode()
    header += b" " * (-len(header) % 4)
    binary += b"\0" * (-len(binary) % 4)
    body = struct.pack("<II", len(header), 0x4E4F534A) + header
    if not uri:
        body += struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<III", 0x46546C67, 2, 12 + len(body)) + body


class Case:
    """One run: files to lay down (a text, bytes, or a function of the path), the program's words, what status may come."""

    def __init__(self, name, words, files=None, statuses=(0, 2, 3), program="topple", unchanged=(), stdout=None):
        self.name, self.words, self.files, self.statuses = name, words, files or {}, statuses
        self.program, self.unchanged, self.stdout = program, unchanged, stdout
        self.before, self.quiet = "true", False  # what a shell does first; whether nothing may be said


def numeric_options(bin_dir):
    """(command, option) of every option that takes a value, as --help tells them."""
    listing = subprocess.run([bin_dir / "topple", "--help"], capture_output=True, text=True).stdout
    commands = re.findall(r"^  (\w+)  ", listing.split("Subcommands:")[-1].replace("SUBCOMMANDS:", ""), re.M)
    for command in commands:
        shown = subprocess.run([bin_dir / "topple", command, "--help"], capture_output=True, text=True).stdout
        for option in re.findall(r"^  (?:-\w,)?(--[\w-]+) (?:FLOAT|INT|UINT|NUMBER)", shown, re.M):
            yield command, option


def option_cases(bin_dir):
    companion = {"--sudden": ["--lose-each", "posts"], "--drift-limit": ["--code", "en1993"], "--rate": ["--gltf", "-o", "out"],
                 "--save": ["-o", "out"]}
    scene = {"analyse": "m.json", "demolish": "s.json"}
    for command, option in numeric_options(bin_dir):
        for word in WORDS:
            yield Case(f"option {command} {option} {word!r}",
                       [command, scene.get(command, "m.json"), f"{option}={word}", *companion.get(option, [])],
                       {"m.json": text(MODEL), "s.json": text(SCENARIO)})
    for option in ["--at", "--rate", "--scale", "--size"]:
        for word in WORDS:
            yield Case(f"option viewer {option} {word!r}",
                       ["m.json", "--headless", "--panel", "--screenshot", "p.png", f"{option}={word}",
                        *(["--record", "r", "--at=0.05"] if option == "--rate" else [])],
                       {"m.json": text(MODEL)}, program="topple-viewer")


def tree_cases(kind, tree, name, words, beside=None):
    for at in places(tree):
        value = tree
        for key in at:
            value = value[key]
        tried = NUMBERS + [float("inf")] if isinstance(value, (int, float)) and not isinstance(value, bool) else []
        for other in tried + OTHERS:
            label = f"{kind} {'.'.join(map(str, at))} = {str(other)[:20]!r}"
            yield Case(label, words, {**(beside or {}), name: text(put(tree, at, other))})


def token_cases(kind, whole, apart, words, files):
    """A text whose every token (what `apart` does not match) becomes another one."""
    for token in re.finditer(f"(?:(?!{apart}).)+", whole, re.S):
        for other in WORDS + ["0", "\"", "\0", "=1+1", "x" * 70000, "2147483648", "9223372036854775808"]:
            changed = whole[:token.start()] + other + whole[token.end():]
            yield Case(f"{kind} at {token.start()} {token[0][:12]!r} = {other[:20]!r}", words, files(changed))


def text_cases(bin_dir):
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        lay_down(folder, {"m.json": text(PLAIN), "b.json": text(BRITTLE), "s.json": text(dict(MOVING, model="b.json", duration=0.1))})
        for words in (["convert", "m.json", "t"], ["demolish", "s.json", "-o", "o", "--save", "0.06"]):
            subprocess.run([bin_dir / "topple", *words], cwd=folder, check=True, capture_output=True)
        tables = {path.name: path.read_text() for path in (folder / "t").iterdir()}
        saved = next((folder / "o").glob("*.topple")).read_bytes()
    for name, whole in tables.items():
        few = "".join(whole.splitlines(True)[:3])  # the header and two rows
        for case in token_cases(f"table {name}", few, r"[,\n]", ["analyse", "t", "-o", "o"],
                                lambda changed: {f"t/{n}": t for n, t in tables.items()} |
                                {f"t/{name}": changed + whole[len(few):]}):
            yield case
    yield from token_cases("3dd", FRAME3DD, r"\s", ["analyse", "m.3dd", "-o", "o"], lambda changed: {"m.3dd": changed})
    yield from token_cases("history", HISTORY, r"[,\n]", ["analyse", "m.json", "--time-history", "h.csv", "--history", "E", "-o", "o"],
                           lambda changed: {"m.json": text(MODEL), "h.csv": changed})
    scene = {"b.json": text(BRITTLE), "s.json": text(dict(MOVING, model="b.json", duration=0.1))}
    for at in range(0, len(saved), 7):
        yield Case(f"snapshot with byte {at} changed", ["demolish", "s.json", "--resume", "x.topple"],
                   {**scene, "x.topple": saved[:at] + bytes([saved[at] ^ 0x41]) + saved[at + 1:]}, (2,))
        yield Case(f"snapshot of {at} bytes", ["demolish", "s.json", "--resume", "x.topple"], {**scene, "x.topple": saved[:at]}, (2,))


def word_cases(bin_dir):
    """Every option and argument that takes a text."""
    words = ["", "-", "nan", "../..", "/", "x" * 5000, os.fsdecode(b"b\xe4y"), "a\nb", "\x1b[31m", "*", "m.json", "/dev/full", "%s%n"]
    scene = {"m.json": text(MODEL), "s.json": text(dict(SCENARIO, duration=0.1)), "p.json": text(PANEL), "t.json": text(STUDY)}
    first = {"analyse": ["m.json"], "demolish": ["s.json"], "fracture": ["p.json", "-o", "o"], "convert": ["m.json", "n.3dd"],
             "study": ["t.json", "-o", "o"], "check": ["m.json"]}
    for command, arguments in first.items():
        shown = subprocess.run([bin_dir / "topple", command, "--help"], capture_output=True, text=True).stdout
        for option in re.findall(r"^  (?:-\w,)?(--[\w-]+) TEXT", shown, re.M):
            for word in words:
                yield Case(f"word {command} {option} {word[:20]!r}", [command, *arguments, f"{option}={word}"], scene)
        for at in range(len(arguments)):
            for word in words:
                if not (arguments[at - 1] == "-o" and word in ("/", "../..", "-")):
                    yield Case(f"word {command} {at} {word[:20]!r}", [command, *arguments[:at], word, *arguments[at + 1:]], scene)
    for name in (b"b\xe4y.json", b"\x1b[31m.json", "\u202ex.json".encode()):
        for command, content in (("analyse", MODEL), ("demolish", dict(SCENARIO, duration=0.1)), ("fracture", PANEL), ("check", MODEL)):
            yield Case(f"word {command} of a file {name!r}", [command, os.fsdecode(name), *(["-o", "o"] if command != "check" else [])],
                       {"m.json": text(MODEL), os.fsdecode(name): text(content)})


def count_cases():
    for count in [0, 1000, 10**6, 2**31, 2**53, 2**63]:
        shell = put(MODEL, ("panels", "S", "model"), "shell")
        shell["panels"]["S"]["mesh"] = [count, count]
        yield Case(f"count mesh {count}", ["analyse", "m.json"], {"m.json": text(shell)})
        building = json.loads((ROOT / "models/seed_building.json").read_text())
        for at in places(building.get("building", {})):
            changed = put(building, ("building",) + at, count)
            yield Case(f"count building.{'.'.join(map(str, at))} {count}", ["check", "m.json"], {"m.json": text(changed)})
        for copies in [count]:
            street = json.loads((ROOT / "models/street.json").read_text())
            for at in places(street.get("building", {})):
                if isinstance(at[-1], str):
                    yield Case(f"count street.{'.'.join(map(str, at))} {copies}", ["check", "m.json"],
                               {"m.json": text(put(street, ("building",) + at, copies))})


def file_cases():
    def fifo(path):
        os.mkfifo(path)

    def folder(path):
        path.mkdir()

    def link(to):
        return lambda path: path.symlink_to(to)

    def locked(path):
        path.write_text("{}")
        path.chmod(0)

    kinds = {"fifo": fifo, "folder": folder, "zero": link("/dev/zero"), "null": link("/dev/null"), "loop": link("x.json"),
             "missing": None, "locked": locked, "empty": b"", "nul": text(MODEL).encode() + b"\0x",
             "latin": text(MODEL).encode().replace(b"bay", b"b\xe4y"), "deep": b"[" * 100000, "bom": b"\xff\xfe{}",
             "half": text(MODEL).encode()[:500], "wide": b'{"a":' + b"1" * 2_000_000 + b"}"}
    uses = {"analyse": (["analyse", "x.json"], "x.json"), "check": (["check", "x.json"], "x.json"),
            "3dd": (["analyse", "x.3dd"], "x.3dd"), "convert": (["convert", "x.json", "o.3dd"], "x.json"),
            "demolish": (["demolish", "x.json"], "x.json"), "fracture": (["fracture", "x.json", "-o", "o"], "x.json"),
            "resume": (["demolish", "s.json", "--resume", "x.topple"], "x.topple"),
            "model of a scenario": (["demolish", "s.json"], "m.json"), "table": (["analyse", "t"], "t/nodes.csv"),
            "glb": (["demolish", "g.json", "-o", "o"], "x.glb"), "check glb": (["check", "d.json"], "x.glb"),
            "analyse glb": (["analyse", "d.json"], "x.glb")}
    drawn = dict(MODEL, meshes={"x": {"file": "x.glb", "bind": "nearest", "density": 2000}})
    for use, (words, name) in uses.items():
        for kind, content in kinds.items():
            files = {"m.json": text(MODEL), "s.json": text(dict(SCENARIO, duration=0.1)), "d.json": text(drawn),
                     "g.json": text(dict(SCENARIO, model="d.json", duration=0.1)), "t/members.csv": "name,start,end\n"}
            if content is None:
                files.pop(name, None)
            else:
                files[name] = content
            statuses = (2, 3) if kind in ("fifo", "folder", "zero", "missing") and use != "model of a scenario" else (0, 2, 3)
            if kind == "locked" and os.geteuid() == 0:
                statuses = (0, 2, 3)
            if use == "check glb":
                statuses = (0, 2, 3)
            yield Case(f"file {use} {kind}", words, files, statuses)


def drawing_cases():
    mesh = [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}]
    drawn = dict(MODEL, meshes={"x": {"file": "x.glb", "bind": "nearest", "density": 2000}})
    scene = {"m.json": text(drawn), "s.json": text(dict(SCENARIO, duration=0.1))}
    points = {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"}
    whole = {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}
    views = [{"buffer": 0, "byteOffset": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}]
    sound = glb(mesh, [{"mesh": 0}])
    head = json.loads(sound[20:20 + struct.unpack("<I", sound[12:16])[0]])
    for at in places(head):
        for other in NUMBERS + OTHERS:
            header = text(put(head, at, other)).encode()
            header += b" " * (-len(header) % 4)
            body = struct.pack("<II", len(header), 0x4E4F534A) + header + sound[20 + struct.unpack("<I", sound[12:16])[0]:]
            yield Case(f"drawing {'.'.join(map(str, at))} = {str(other)[:20]!r}", ["analyse", "m.json"],
                       {**scene, "x.glb": struct.pack("<III", 0x46546C67, 2, 12 + len(body)) + body})
    drawings = {"sound": glb(mesh, [{"mesh": 0}]),
                "nested": glb(mesh, [{"children": [i + 1, i + 1]} for i in range(40)] + [{"mesh": 0}]),
                "cycle": glb(mesh, [{"children": [0], "mesh": 0}]),
                "huge scale": glb(mesh, [{"mesh": 0, "scale": [1e5, 1e5, 1e5]}]),
                "millimetres": glb(mesh, [{"mesh": 0, "scale": [4000, 4000, 4000]}]),
                "infinite": glb(mesh, [{"mesh": 0, "scale": [1e300, 1e300, 1e300]}]),
                "zero scale": glb(mesh, [{"mesh": 0, "scale": [0, 0, 0]}])}
    for count in [0, 1, 5, 2**31, 2**32, 2**60, 2**62, 2**63 - 1, 1537228672809129302]:
        for which in (0, 1):
            drawings[f"count {which} {count}"] = glb(mesh, [{"mesh": 0}], [dict(points, count=count if which == 0 else 4),
                                                                          dict(whole, count=count if which else 12)])
    for offset in [1, 47, 2**31, 2**62, 2**63 - 1]:
        drawings[f"offset {offset}"] = glb(mesh, [{"mesh": 0}], [dict(points, byteOffset=offset), whole])
        drawings[f"view offset {offset}"] = glb(mesh, [{"mesh": 0}], None, [dict(views[0], byteOffset=offset), views[1]])
    for kind in [5120, 5121, 5122, 5123, 5124, 5125, 5126, 5130, 0, -1, 99999]:
        drawings[f"points of type {kind}"] = glb(mesh, [{"mesh": 0}], [dict(points, componentType=kind), whole])
        drawings[f"indices of type {kind}"] = glb(mesh, [{"mesh": 0}], [points, dict(whole, componentType=kind)])
    for stride in [-4, 0, 1, 4, 252, 2**31]:
        drawings[f"stride {stride}"] = glb(mesh, [{"mesh": 0}], None, [dict(views[0], byteStride=stride), views[1]])
    for name, bytes_ in drawings.items():
        yield Case(f"drawing {name}", ["analyse", "m.json"], {**scene, "x.glb": bytes_})
        yield Case(f"drawing {name} demolished", ["demolish", "s.json", "-o", "o"], {**scene, "x.glb": bytes_})
    for uri in ["../secret.bin", "/etc/passwd", "$(touch owned).bin", "~/x", "http://x/y", "a/../../secret.bin", "data:,x"]:
        yield Case(f"drawing uri {uri}", ["analyse", "d/m.json"],
                   {"d/m.json": text(drawn), "secret.bin": b"\0" * 72,
                    "d/x.glb": glb(mesh, [{"mesh": 0}], uri=uri)}, statuses=(2, 3))


def output_cases():
    files = {"m.json": text(MODEL), "s.json": text(dict(SCENARIO, duration=0.1)), "p.json": text(PANEL), "taken": "x",
             "results.json": text(MODEL), "events.jsonl": "x", "summary.json": text(PANEL), "model.3dd": ""}
    runs = {"analyse": ["analyse", "m.json", "-o"], "demolish": ["demolish", "s.json", "-o"],
            "fracture": ["fracture", "p.json", "-o"]}
    for name, words in runs.items():
        yield Case(f"output {name} into a file", words + ["taken"], files, (2,), unchanged=["taken"])
        yield Case(f"output {name} into a file's folder", words + ["taken/x"], files, (2,), unchanged=["taken"])
        yield Case(f"output {name} into a device", words + ["/dev/null"], files, (2,))
        yield Case(f"output {name} into /proc", words + ["/proc/x"], files, (2,))
        yield Case(f"output {name} into a name too long", words + ["x" * 300], files, (2,))
        yield Case(f"output {name} over a folder", words + ["o"],
                   {**files, **{f"o/{n}/x": "" for n in ("results.json", "events.jsonl", "panel.glb", "summary.json")}}, (2,))
        yield Case(f"output {name} with standard output full", words[:-1] + ["-o", "o"], files, (1,), stdout="/dev/full")
    yield Case("output over the input", ["analyse", "results.json", "-o", "."], files, (2,), unchanged=["results.json"])
    yield Case("output over the panel", ["fracture", "summary.json", "-o", "."], files, (2,), unchanged=["summary.json"])
    yield Case("convert onto itself", ["convert", "m.json", "m.json"], files, (2,), unchanged=["m.json"])
    yield Case("convert onto itself by another name", ["convert", "m.json", "./m.json"], files, (2,), unchanged=["m.json"])
    yield Case("convert onto a link to itself", ["convert", "m.json", "l.json"],
               {**files, "l.json": lambda path: path.symlink_to("m.json")}, (2,), unchanged=["m.json"])
    yield Case("convert onto a device", ["convert", "m.json", "n.3dd"],
               {**files, "n.3dd": lambda path: os.mkfifo(path)}, (2,))
    yield Case("check with standard output full", ["check", "m.json"], files, (1,), stdout="/dev/full")
    for flag in ["--screenshot", "--usd", "--gltf", "--replay", "--save", "--model"]:
        for target in ["taken/x", "no/such/x", "folder"]:
            yield Case(f"output viewer {flag} {target}", ["m.json", "--headless", flag, target],
                       {**files, "folder/x": ""}, (2,), program="topple-viewer", unchanged=["taken"])


def lay_down(folder, files):
    for name, content in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if callable(content):
            content(path)
        elif isinstance(content, bytes):
            path.write_bytes(content)
        else:
            path.write_text(content)


NO_NUMBER = re.compile(r"(?<![A-Za-z_\"'])-?(?:nan|inf)(?![A-Za-z_])")


def fault(case, bin_dir, folder):
    """What went wrong, or none."""
    lay_down(folder, case.files)
    before = {name: (folder / name).read_bytes() for name in case.unchanged}
    out = open(case.stdout, "w") if case.stdout else subprocess.PIPE
    environment = dict(os.environ, LC_ALL="C")
    command = ["bash", "-c", f"{BOUNDS}; {case.before}; exec \"$0\" \"$@\"", str(bin_dir / case.program), *case.words]
    try:
        run = subprocess.run(command, cwd=folder, stdout=out, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL,
                             timeout=WAIT, env=environment)
    except subprocess.TimeoutExpired:
        return f"no end in {WAIT} s"
    # How far it is, on a busy machine.
    told, said = re.sub(rb"^topple: \d+ s, .*\n", b"", run.stderr, flags=re.M), run.stdout or b""
    line = told.decode(errors="replace").strip()[:200]
    if run.returncode in (-signal.SIGXCPU, 128 + signal.SIGXCPU):
        return f"no end in {LIMIT} s of a processor"
    if run.returncode < 0 or run.returncode >= 128:
        return f"signal {run.returncode}: {line}"
    if run.returncode not in case.statuses:
        return f"status {run.returncode}, expected {case.statuses}: {line}"
    if run.returncode != 0 and not line and not case.quiet:
        return f"status {run.returncode} without a word"
    if b"\x1b" in told.replace(b"\x1b[K", b"") or b"\x1b" in said:
        return "an escape reached the terminal"
    if run.returncode != 0 and told.strip().count(b"\n") > 0 and case.program == "topple":
        return f"more than one line: {line}"
    named = re.search(r"(?:= |^word .*)'(-?(?:nan|inf))'$", case.name)  # a text now, which is shown as one
    if run.returncode == 0 and not named and NO_NUMBER.search(said.decode(errors="replace")):
        return "no number printed with status 0: " + NO_NUMBER.search(said.decode(errors="replace"))[0]
    for name, whole in before.items():
        if (folder / name).read_bytes() != whole:
            return f"{name} was changed"
    for path in folder.rglob("*"):
        if path.name.startswith(".topple-") or path.name.endswith(".part"):
            return f"{path.name} was left"
        if path.name == "owned":
            return "a command of the file was run"
        if run.returncode == 0 and path.suffix == ".json" and path.name not in case.files:
            try:
                json.loads(path.read_bytes().decode("utf-8"), parse_constant=lambda word: 1 / 0)
            except (ValueError, ZeroDivisionError) as error:
                return f"{path.name} is no JSON: {error or 'not a number'}"
    return None


def base_cases():
    """What everything else is a change of: refused, nothing would be tried."""
    files = {"m.json": text(MODEL), "s.json": text(SCENARIO), "plain.json": text(PLAIN)}
    more = {"w.json": text(WIDE), "b.json": text(BUILDING), "v.json": text(dict(MOVING, model="p.json")), "p.json": text(BRITTLE), "t.json": text(STUDY), "f.3dd": FRAME3DD, "h.csv": HISTORY,
            "m.json": text(MODEL), "a.json": text(ACTIONS)}
    for words in (["analyse", "w.json", *ALL], ["analyse", "b.json"], ["demolish", "v.json"], ["study", "t.json", "-o", "o"],
                  ["analyse", "f.3dd"], ["analyse", "m.json", "--time-history", "h.csv", "--history", "E", "-o", "o"]):
        yield Case(f"base {' '.join(words[:2])}", words, more, (0,))
    for name, tree in [("actions", ACTIONS), ("more actions", MORE_ACTIONS)]:
        yield Case(f"base {name}", [*ACT, "a.json"], {**more, "a.json": text(tree)}, (0,), program="topple-viewer")
    for words in (["analyse", "m.json", "-o", "o"], ["demolish", "s.json", "-o", "o"], ["convert", "plain.json", "t"]):
        yield Case(f"base {words[0]}", words, files, (0,))
    for name, panel in [("voronoi", PANEL), ("local", LOCAL), ("quadrilateral", QUADS)]:
        yield Case(f"base {name}", ["fracture", "p.json", "-o", "o"], {"p.json": text(panel)}, (0,))


ALL = ["--modes", "2", "--buckling", "1", "--code", "en1993", "--p-delta", "--stations", "3", "-o", "o", "--csv"]
ACT = ["m.json", "--headless", "--actions"]


def rest_scenes():
    """(kind, tree, its file, words, files beside it, program) of what few files have."""
    model = {"m.json": text(MODEL)}
    yield "rest of a model", REST, "m.json", ["analyse", "m.json", "--code", "en1993", "-o", "o", "--csv"], {}, "topple"
    yield "rest of a model converted", REST, "m.json", ["convert", "m.json", "n.json"], {}, "topple"
    yield "connected", CONNECT, "m.json", ["analyse", "m.json", "-o", "o"], {}, "topple"
    yield "plan", PLAN, "m.json", ["analyse", "m.json", "-o", "o"], {}, "topple"
    yield "drawn", DRAWN, "m.json", ["check", "m.json"], {"x.glb": glb([{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}], [{"mesh": 0, "name": "a"}])}, "topple"
    yield "cuts", CUTS, "c.json", ["analyse", "m.json", "--cuts", "c.json", "-o", "o"], model, "topple"
    yield "optimise", OPTIMISE, "t.json", ["study", "t.json", "-o", "o", "--threads", "1", "--html"], {"m.json": text(POSTS)}, "topple"
    yield "charges", CHARGES, "t.json", ["study", "t.json", "-o", "o", "--threads", "1"], {**model, "s.json": text(QUICK)}, "topple"
    yield "losses", LOSSES, "t.json", ["study", "t.json", "-o", "o", "--threads", "1"], model, "topple"
    yield "earthquake", QUAKE, "a.json", [*ACT, "a.json"], {**model, "ground.csv": GROUND}, "topple-viewer"


def rest_cases():
    for kind, tree, name, words, beside, program in rest_scenes():
        for case in [Case(f"base {kind}", words, {**beside, name: text(tree)}, (0,)), *tree_cases(kind, tree, name, words, beside)]:
            case.program = program
            yield case


def sample_cases():
    """Studies that put what is hostile into one place of a model, each value as a sample: samples fail, and the study goes on."""
    for kind, tree in (("model", MODEL), ("rest", REST)):
        for at in places(tree):
            pointer = "".join("/" + str(key).replace("~", "~0").replace("/", "~1") for key in at)
            study = {"topple": 1, "base": {"model": "m.json", "analyse": ["--modes", "1"]}, "record": {"use": "largest_use", "kg": "weight"},
                     "vary": [{"name": "v", "at": pointer, "grid": NUMBERS + OTHERS}]}
            yield Case(f"samples of a {kind} {'.'.join(map(str, at))}", ["study", "t.json", "-o", "o", "--threads", "1", "--html"],
                       {"m.json": text(tree), "t.json": text(study)}, (0, 2))


def shape_cases():
    """Keys and items that are not there, that are there twice, or hold something of another shape."""
    scenes = [*rest_scenes(), ("wide", WIDE, "m.json", ["analyse", "m.json", *ALL], {}, "topple"),
              ("moving", MOVING, "s.json", ["demolish", "s.json", "-o", "o"], {"m.json": text(BRITTLE)}, "topple"),
              ("scenario", SCENARIO, "s.json", ["demolish", "s.json", "-o", "o"], {"m.json": text(MODEL)}, "topple"),
              ("panel", PANEL, "p.json", ["fracture", "p.json", "-o", "o"], {}, "topple"),
              ("study", STUDY, "t.json", ["study", "t.json", "-o", "o", "--threads", "1"], {"m.json": text(MODEL)}, "topple")]
    for kind, tree, name, words, beside, program in scenes:
        for at in inner_places(tree):
            spot = tree
            for key in at[:-1]:
                spot = spot[key]
            others = {"gone": None, "empty": [] if isinstance(spot[at[-1]], list) else {}, "a list": [spot[at[-1]]]}
            if isinstance(spot[at[-1]], list):
                others.update({"twice": spot[at[-1]] * 2, "backwards": spot[at[-1]][::-1]})
            for what, other in others.items():
                case = Case(f"shape {kind} {'.'.join(map(str, at))} {what}", words,
                            {**beside, name: text(without(tree, at) if what == "gone" else put(tree, at, other))})
                case.program = program
                yield case


def all_cases(bin_dir):
    yield from base_cases()
    yield from rest_cases()
    yield from shape_cases()
    yield from sample_cases()
    yield from tree_cases("wide model", WIDE, "m.json", ["analyse", "m.json", *ALL])
    yield from tree_cases("wide model as 3dd", WIDE, "m.json", ["convert", "m.json", "m.3dd"])
    yield from tree_cases("building", BUILDING, "m.json", ["analyse", "m.json", "-o", "o"])
    yield from tree_cases("moving scenario", MOVING, "s.json", ["demolish", "s.json", "-o", "o"], {"m.json": text(BRITTLE)})
    yield from tree_cases("study", STUDY, "t.json", ["study", "t.json", "-o", "o", "--threads", "1"], {"m.json": text(MODEL)})
    for name, tree in [("study", STUDY), ("scenario", SCENARIO), ("panel", PANEL), ("model", MODEL)]:
        yield from tree_cases(f"checked {name}", tree, "x.json", ["check", "x.json"], {"m.json": text(MODEL)})
    for name, tree in [("actions", ACTIONS), ("more actions", MORE_ACTIONS)]:
        for case in tree_cases(name, tree, "a.json", [*ACT, "a.json"], {"m.json": text(MODEL)}):
            case.program = "topple-viewer"
            yield case
    yield from text_cases(bin_dir)
    yield from word_cases(bin_dir)
    yield from option_cases(bin_dir)
    yield from tree_cases("model", MODEL, "m.json", ["analyse", "m.json", "-o", "o", "--buckling", "1"])
    yield from tree_cases("demolished model", MODEL, "m.json", ["demolish", "s.json", "-o", "o"],
                          {"s.json": text(dict(SCENARIO, duration=0.3))})
    yield from tree_cases("scenario", SCENARIO, "s.json", ["demolish", "s.json", "-o", "o"], {"m.json": text(MODEL)})
    for name, panel in [("voronoi", PANEL), ("local", LOCAL), ("quadrilateral", QUADS)]:
        yield from tree_cases(f"panel {name}", panel, "p.json", ["fracture", "p.json", "-o", "o"])
    yield from tree_cases("converted model", PLAIN, "m.json", ["convert", "m.json", "t"])
    yield from count_cases()
    yield from file_cases()
    yield from drawing_cases()
    yield from output_cases()
    yield from odd_cases(Case, glb)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("--cases", type=int, help="so many, drawn at random")
    parser.add_argument("--only", default="", help="those whose name holds this word")
    parser.add_argument("--slice", default="0/1", help="every N-th from the I-th on, I from 0")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--sanitized", action="store_true", help="the programs are built with sanitizers: six times the time")
    parser.add_argument("--list", action="store_true")
    options = parser.parse_args()
    bin_dir = options.bin.resolve()
    if options.sanitized:
        global BOUNDS
        BOUNDS = SANITIZED
    if untried := untried_keys():
        print(f"hostile: no scene has {', '.join(untried)}")
        return 1
    cases = [case for case in all_cases(bin_dir) if options.only in case.name]
    cases = [case for case in cases if (bin_dir / case.program).exists()]
    first, step = map(int, options.slice.split("/"))
    cases = cases[first::step]
    if options.cases and options.cases < len(cases):
        base = [case for case in cases if case.name.startswith("base ")]
        cases = base + random.Random(options.seed).sample(cases, options.cases)
    if options.list:
        print("\n".join(case.name for case in cases))
        return 0

    def tried(case):
        with tempfile.TemporaryDirectory(prefix="hostile-") as folder:
            return case, fault(case, bin_dir, pathlib.Path(folder))

    wrong = 0
    with ThreadPoolExecutor(options.jobs) as pool:
        for case, what in pool.map(tried, cases):
            if what:
                wrong += 1
                print(f"{case.name}: {what}", flush=True)
    print(f"hostile: {len(cases)} inputs, {wrong} wrong")
    return 1 if wrong or not cases else 0


if __name__ == "__main__":
    sys.exit(main())
