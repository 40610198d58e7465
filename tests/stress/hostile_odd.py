"""Odd uses for hostile.py that are no change of one value: options beside others, texts and encodings of JSON, names that become
files, drawings with what glTF allows and nobody writes, scenarios and studies that contradict themselves, streams and limits of the
system that are not as usual."""
import copy, json, os, struct

from hostile_scenes import (ACTIONS, BRITTLE, BUILDING, FRAME3DD, HISTORY, MODEL, MOVING, PANEL, PLAIN, SCENARIO, STUDY, WIDE)

NUMBERS = ["nan", "inf", "-1", "0", "1e-300", "1e300", "1e9", "2147483648", "9223372036854775808", "abc", ""]
SHORT = dict(SCENARIO, duration=0.1)


def text(tree):
    return json.dumps(tree)


def changed(tree, **parts):
    return {**copy.deepcopy(tree), **parts}


def beside_cases(Case):
    """Options that count only beside others, and options twice."""
    files = {"m.json": text(MODEL), "w.json": text(WIDE), "s.json": text(SHORT), "h.csv": HISTORY, "t.json": text(STUDY)}
    lost = ["analyse", "m.json", "--lose", "P1", "--dynamic"]
    shaken = ["analyse", "m.json", "--time-history", "h.csv", "--history", "E", "-o", "o"]
    for option in ["--over", "--for", "--damping"]:
        for number in NUMBERS:
            yield Case(f"beside loss {option}={number}", lost + [f"{option}={number}"], files)
    for option in ["--for", "--damping"]:
        for number in NUMBERS:
            yield Case(f"beside history {option}={number}", shaken + [f"{option}={number}"], files)
    for option, words in {"--divide": ["--modes", "2"], "--modes": [], "--buckling": [], "--stations": ["-o", "o"], "--threads": []}.items():
        for number in NUMBERS + ["100000"]:
            yield Case(f"beside analyse {option}={number}", ["analyse", "m.json", *words, f"{option}={number}"], files)
    for number in NUMBERS + ["0.5", "3", "100"]:
        yield Case(f"beside convert --join={number}", ["convert", "m.json", "n.json", f"--join={number}"], files)
    for spacing in ["=", "P1=", "=1", "P1=1=2", "P1=nan", "*=0", "*=-1", "P*=1e-300", "P1=1e300", "Q9=1", "P1", "\u0001=1"]:
        yield Case(f"beside --stiffeners {spacing!r}", ["analyse", "m.json", "--code", "en1993", "--stiffeners", spacing], files)
    for samples in [":", "0:", ":2", "2:1", "-1:2", "0:99999999999999999999", "a:b", "1:2:3", "0:2 ", "nan:1", "0x0:2", "3:4"]:
        yield Case(f"beside study --samples {samples!r}", ["study", "t.json", "-o", "o", "--threads", "1", "--samples", samples], files)
    for words in (["analyse", "m.json", "--lose", "P1", "--lose-each", "posts"], ["analyse", "m.json", "-o", "a", "-o", "b"],
                  ["analyse", "m.json", "m.json"], ["analyse"], ["demolish", "m.json"], ["fracture", "m.json", "-o", "o"],
                  ["study", "m.json", "-o", "o"], ["analyse", "s.json"], ["analyse", "t.json"], ["study", "s.json", "-o", "o"],
                  ["convert", "s.json", "n.3dd"], ["check", "h.csv"], ["analyse", "h.csv"], ["analyse", "--", "--help"], ["nosuch"], [],
                  ["analyse", "m.json", "--combination", "collapse", "--combination", "collapse"],
                  ["demolish", "s.json", "--save", "0.05", "--save", "0.05", "-o", "o"], ["demolish", "s.json", "--save", "5", "-o", "o"],
                  ["analyse", "m.json", "--dynamic"], ["analyse", "m.json", "--time-history", "h.csv", "--history", "nobody"],
                  ["demolish", "s.json", "--images"], ["demolish", "s.json", "--rate", "10"],
                  ["demolish", "s.json", "--gltf", "--rate", "1e9", "-o", "o"], ["study", "t.json", "-o", "o", "--retry-failed", "--resume"]):
        yield Case(f"beside {' '.join(words)}", words, files)
    for size in ["0x0", "1x1", "16x16", "-5x5", "99999x99999", "1e3x10", "10", "x", "10x10x10", "nanxnan", "4294967296x16"]:
        yield Case(f"beside viewer --size {size}", ["m.json", "--headless", "--screenshot", "p.png", "--size", size], files, program="topple-viewer")
    for show in ["", "nothing", "joints=nan", "moment_y moment_z", "mode 99999999999", "mode -1", "x" * 3000, "deformed 1e308", "use\n"]:
        yield Case(f"beside viewer --show {show[:20]!r}", ["m.json", "--headless", "--screenshot", "p.png", "--size", "64x48", "--show", show], files,
                   program="topple-viewer")
    yield Case("beside viewer outputs under one name", ["m.json", "--headless", "--usd", "x.usda", "--model", "x.usda", "--size", "64x48"], files,
               program="topple-viewer")


def syntax_cases(Case):
    """JSON that is none, or hardly."""
    whole = text(MODEL)
    texts = {
        "a key twice": whole.replace('"title"', '"topple": 1, "title"', 1), "a member twice": whole.replace('"P2"', '"P1"', 1),
        "a half surrogate": whole.replace("bay", "\\ud800", 1), "a NUL in a name": whole.replace('"P1"', '"P\\u00001"'),
        "an escape in a name": whole.replace('"P1"', '"P\\u001b[2J"'), "a newline in a name": whole.replace('"P1"', '"P\\n1"'),
        "an empty name": whole.replace('"P1"', '""'), "a name from right to left": whole.replace("P1", "\u202eP"),
        "a plus": whole.replace("210000000000.0", "+2.1e11"), "a leading zero": whole.replace("7850", "07850"),
        "a bare point": whole.replace("7850", "7850."), "no digit before the point": whole.replace("0.3,", ".3,", 1),
        "a hexadecimal number": whole.replace("7850", "0x1eaa"), "a comment": "/* x */" + whole, "a trailing comma": whole[:-1] + ",}",
        "Infinity": whole.replace("7850", "Infinity"), "a number of many digits": whole.replace("7850", "1" * 100000),
        "a tiny number of many digits": whole.replace("7850", "0." + "0" * 100000 + "1"), "a large exponent": whole.replace("7850", "1e99999999999999999999"),
        "a small exponent": whole.replace("7850", "1e-99999999999999999999"), "single quotes": whole.replace('"', "'"),
        "UTF-16": whole.encode("utf-16"), "UTF-32": whole.encode("utf-32"), "a byte-order mark": b"\xef\xbb\xbf" + whole.encode(),
        "returns": whole.replace(", ", ",\r").encode(), "an overlong character": whole.encode().replace(b"bay", b"\xc0\xaf"),
        "a character beyond Unicode": whole.encode().replace(b"bay", b"\xf4\x90\x80\x80"), "a cut character": whole.encode()[:-1] + b"\xe2\x82",
        "objects within objects": '{"a":' * 200000, "lists within a known key": whole.replace('"bay"', "[" * 100000, 1),
        "deep and closed": '{"topple": 1, "title": ' + "[" * 60000 + "]" * 60000 + "}", "two values": whole + whole, "spaces alone": " " * 100000,
        "a string without end": '{"topple": 1, "title": "' + "x" * 1000000, "many keys": '{"topple": 1' + "".join(f', "k{i}": 1' for i in range(100000)) + "}",
        "many nodes": text(changed(PLAIN, nodes={**MODEL["nodes"], **{f"n{i}": [i, i, i] for i in range(100000)}})),
        "a list": "[]", "a number": "1", "null": "null", "a text": '"x"', "nothing but a brace": "{", "backslashes": '{"\\\\\\": 1}',
    }
    uses = {"check": ["check", "m.json"], "analyse": ["analyse", "m.json", "-o", "o"], "convert": ["convert", "m.json", "t"]}
    for name, content in texts.items():
        for use, words in uses.items():
            yield Case(f"syntax {use} {name}", words, {"m.json": content})
    for name, content in texts.items():
        yield Case(f"syntax actions {name}", ["m.json", "--headless", "--actions", "a.json", "--size", "64x48"],
                   {"m.json": whole, "a.json": content}, program="topple-viewer")


NAMES = ["../x", "a/b", "/abs", ".", "..", "x" * 300, "\u00e4" * 200, " ", "-o", "a\\b", "COM1", "a:b", "%s%n", "$(touch owned)", "=1+1", "@x", "a,b", 'a"b',
         "<script>alert(1)</script>", "]]>", "--", "*", "a;b", "\u2028"]


def name_cases(Case):
    """Names that become those of files, columns and pages."""
    for name in NAMES:
        model = text(MODEL).replace('"collapse"', json.dumps(name))
        node = text(MODEL).replace('"E"', json.dumps(name))
        panel = text(MODEL).replace('"S"', json.dumps(name))
        every = ["--csv", "--vtu", "--html", "-o", "o"]
        yield Case(f"name of a combination {name[:20]!r}", ["analyse", "m.json", *every], {"m.json": model})
        yield Case(f"name of a node {name[:20]!r}", ["analyse", "m.json", "--time-history", "h.csv", f"--history={name}", *every], {"m.json": node, "h.csv": HISTORY})
        yield Case(f"name of a node in tables {name[:20]!r}", ["convert", "m.json", "t"], {"m.json": text(PLAIN).replace('"E"', json.dumps(name))})
        yield Case(f"name of a panel that breaks {name[:20]!r}", ["demolish", "s.json", "-o", "o", "--gltf"], {"m.json": panel, "s.json": text(SHORT)})
        yield Case(f"name of a title {name[:20]!r}", ["analyse", "m.json", "--html", "-o", "o", f"--project={name}"], {"m.json": text(changed(MODEL, title=name))})
        yield Case(f"name of a variable {name[:20]!r}", ["study", "t.json", "-o", "o", "--threads", "1", "--html"],
                   {"m.json": text(MODEL), "t.json": text(STUDY).replace('"fy"', json.dumps(name))})
        yield Case(f"name of a model {name[:20]!r}", ["demolish", "s.json"], {"s.json": text(changed(SHORT, model=name))})
        yield Case(f"name of a drawing {name[:20]!r}", ["check", "m.json"],
                   {"m.json": text(changed(MODEL, meshes={"x": {"file": name, "bind": "nearest", "density": 2000}}))})


def frame3dd_cases(Case):
    lines = FRAME3DD.splitlines()
    for at in range(len(lines)):
        for what, line in {"gone": None, "twice": lines[at] + "\n" + lines[at], "short": lines[at][:len(lines[at]) // 2], "NUL": lines[at] + "\0",
                           "comment": "# " + lines[at], "minus": "-" + lines[at]}.items():
            content = "\n".join(lines[:at] + ([] if line is None else [line]) + lines[at + 1:]) + "\n"
            yield Case(f"3dd line {at} {what}", ["analyse", "m.3dd", "-o", "o"], {"m.3dd": content})
    for name, content in {"returns": FRAME3DD.replace("\n", "\r"), "both": FRAME3DD.replace("\n", "\r\n"), "no end": FRAME3DD.rstrip(),
                          "comments alone": "# x\n" * 100000, "one long line": "1 " * 1000000, "tabs": FRAME3DD.replace(" ", "\t"),
                          "Latin-1": b"B\xe4y\n" + FRAME3DD.encode(), "UTF-16": FRAME3DD.encode("utf-16")}.items():
        yield Case(f"3dd {name}", ["convert", "m.3dd", "m.json"], {"m.3dd": content})


def table_cases(Case):
    nodes, members = "name,x,y,z\nA,0,0,0\nB,0,0,3\n", "name,start,end,section,material\nM,A,B,s,m\n"
    sound = {"t/nodes.csv": nodes, "t/members.csv": members}
    odd = {"a quote without end": nodes + '"C,1,1,1\n', "a quote within": nodes + 'C",1,1,1\n', "rows of other lengths": nodes + "C,1\nD,1,1,1,1,1\n",
           "a column twice": nodes.replace("y,", "x,", 1), "no row": "name,x,y,z\n", "no header": "A,0,0,0\n", "separators alone": ",,,,\n,,,,\n",
           "many columns": "name," * 100000 + "\n", "a long cell": nodes + "x" * 5000000 + ",1,1,1\n", "returns": nodes.replace("\n", "\r"),
           "UTF-16": nodes.encode("utf-16"), "Latin-1": nodes.encode() + b"\xe4,1,1,1\n", "NUL": nodes + "C\0,1,1,1\n", "commas and semicolons": nodes.replace(",", ";", 3),
           "a name twice": nodes + "A,5,5,5\n", "a formula": nodes + "=1+1,1,1,1\n", "spaces": nodes.replace(",", " , "), "one quote": '"', "empty": ""}
    for name, content in odd.items():
        yield Case(f"tables {name}", ["analyse", "t", "-o", "o"], {**sound, "t/nodes.csv": content})
        yield Case(f"tables {name}, converted", ["convert", "t", "m.json"], {**sound, "t/nodes.csv": content})
        yield Case(f"history {name}", ["analyse", "m.json", "--time-history", "h.csv", "--history", "E", "-o", "o"],
                   {"m.json": text(MODEL), "h.csv": content if isinstance(content, bytes) else content.replace("name,x,y,z", "time,ax,ay,az")})
    yield Case("tables with a folder as a table", ["analyse", "t"], {**sound, "t/sections.csv/x": ""})
    yield Case("tables with a pipe as a table", ["analyse", "t"], {**sound, "t/sections.csv": lambda path: os.mkfifo(path)})
    yield Case("tables in an empty folder", ["analyse", "t"], {"t": lambda path: path.mkdir()})
    yield Case("tables onto themselves", ["convert", "t", "t"], sound, (2,), unchanged=["t/nodes.csv"])
    yield Case("tables into themselves", ["convert", "t", "t/m.json"], sound)


def drawing_cases(Case, glb):
    mesh = [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}]
    drawn = changed(MODEL, meshes={"x": {"file": "x.glb", "bind": "nearest", "density": 2000}})
    sound = glb(mesh, [{"mesh": 0}])
    head = json.loads(sound[20:20 + struct.unpack("<I", sound[12:16])[0]])
    tail = sound[20 + struct.unpack("<I", sound[12:16])[0]:]

    def with_head(**parts):
        header = json.dumps({**head, **parts}).encode()
        header += b" " * (-len(header) % 4)
        body = struct.pack("<II", len(header), 0x4E4F534A) + header + tail
        return struct.pack("<III", 0x46546C67, 2, 12 + len(body)) + body

    points, indices = head["accessors"]
    files = {
        "version 1": sound[:4] + struct.pack("<I", 1) + sound[8:], "a length too great": sound[:8] + struct.pack("<I", 2**32 - 1) + sound[12:],
        "a length of nothing": sound[:8] + struct.pack("<I", 0) + sound[12:], "a chunk too long": sound[:12] + struct.pack("<I", 2**31) + sound[16:],
        "a chunk too long by one": sound[:12] + struct.pack("<I", len(sound)) + sound[16:], "no binary chunk": sound[:len(sound) - len(tail)],
        "the binary chunk first": sound[:12] + tail + sound[12:-len(tail)], "another magic": b"gltf" + sound[4:], "twelve bytes": sound[:12], "thirteen bytes": sound[:13],
        "text": json.dumps(head).encode(), "twice": sound + sound,
        "a sparse accessor": with_head(accessors=[{**points, "sparse": {"count": 2, "indices": {"bufferView": 1, "componentType": 5123},
                                                                      "values": {"bufferView": 0}}}, indices]),
        "a sparse accessor of 2^60": with_head(accessors=[{**points, "sparse": {"count": 2**60, "indices": {"bufferView": 9, "componentType": 5123},
                                                                              "values": {"bufferView": 9}}}, indices]),
        "an accessor without view": with_head(accessors=[{k: v for k, v in points.items() if k != "bufferView"}, indices]),
        "a required extension": with_head(extensionsRequired=["KHR_draco_mesh_compression"], extensionsUsed=["KHR_draco_mesh_compression"]),
        "normalised points": with_head(accessors=[{**points, "normalized": True}, indices]),
        "a morph target": with_head(meshes=[{"primitives": [{**mesh[0]["primitives"][0], "targets": [{"POSITION": 99}]}]}]),
        "no position": with_head(meshes=[{"primitives": [{"attributes": {"NORMAL": 0}}]}]), "no primitive": with_head(meshes=[{"primitives": []}]),
        "no index": with_head(meshes=[{"primitives": [{"attributes": {"POSITION": 0}}]}]),
        "indices as points": with_head(meshes=[{"primitives": [{"attributes": {"POSITION": 1}, "indices": 0}]}]),
        "a matrix of nothing": with_head(nodes=[{"mesh": 0, "matrix": [0] * 16}]), "a matrix of 1e300": with_head(nodes=[{"mesh": 0, "matrix": [1e300] * 16}]),
        "a short matrix": with_head(nodes=[{"mesh": 0, "matrix": [1, 2, 3]}]), "a mirror": with_head(nodes=[{"mesh": 0, "scale": [-1, 1, 1]}]),
        "a turn of nothing": with_head(nodes=[{"mesh": 0, "rotation": [0, 0, 0, 0]}]), "a skin": with_head(nodes=[{"mesh": 0, "skin": 7}], skins=[{"joints": [0, 99]}]),
        "an image": with_head(images=[{"uri": "data:image/png;base64,!!!!"}, {"bufferView": 77, "mimeType": "image/png"}, {"uri": "../../etc/passwd"}]),
        "no scene": with_head(scenes=[]), "scene 9": with_head(scene=9), "a scene of nobody": with_head(scenes=[{"nodes": [99]}]),
        "a long chain": with_head(nodes=[{"children": [i + 1]} for i in range(20000)] + [{"mesh": 0}]),
        "many uses of one mesh": with_head(nodes=[{"mesh": 0}] * 50000, scenes=[{"nodes": list(range(50000))}]),
        "a name to the terminal": with_head(meshes=[{"name": "\u001b[2J\n", **mesh[0]}]), "overlapping views": with_head(bufferViews=[head["bufferViews"][0]] * 2),
        "a buffer of 2^62": with_head(buffers=[{"byteLength": 2**62}]), "two buffers": with_head(buffers=[{"byteLength": 72}, {"byteLength": 1 << 40}]),
        "a wrong type": with_head(accessors=[{**points, "type": "MAT4"}, indices]), "an unknown type": with_head(accessors=[{**points, "type": "X" * 100000}, indices]),
    }
    for mode in [-1, 0, 1, 2, 3, 5, 6, 7, 2**31]:
        files[f"primitives of mode {mode}"] = with_head(meshes=[{"primitives": [{**mesh[0]["primitives"][0], "mode": mode}]}])
    for name, content in files.items():
        for words in (["check", "m.json"], ["analyse", "m.json"], ["demolish", "s.json", "-o", "o"]):
            yield Case(f"odd drawing {name}, {words[0]}", words, {"m.json": text(drawn), "s.json": text(SHORT), "x.glb": content})
    beside = changed(MODEL, meshes={"x": {"file": "x.gltf", "bind": "nearest", "density": 2000}})
    binary = tail[8:]
    for name, uri in {"beside": "b.bin", "missing": "c.bin", "a pipe": "p.bin", "a folder": "d", "percent": "%2e%2e/secret.bin", "a link out": "l.bin", "a device": "/dev/zero",
                      "a url": "file:///etc/passwd", "data": "data:application/octet-stream;base64,AAAA", "bad data": "data:application/octet-stream;base64,@@@@",
                      "nothing": "", "NUL": "b.bin\0x", "endless": "z.bin"}.items():
        document = json.dumps({**head, "buffers": [{"byteLength": len(binary), "uri": uri}]})
        yield Case(f"odd drawing in two files, {name}", ["analyse", "d/m.json"],
                   {"d/m.json": text(beside), "d/x.gltf": document, "d/b.bin": binary, "d/p.bin": lambda path: os.mkfifo(path), "d/d": lambda path: path.mkdir(),
                    "secret.bin": binary, "d/l.bin": lambda path: path.symlink_to("../secret.bin"), "d/z.bin": lambda path: path.symlink_to("/dev/zero")})


def contradiction_cases(Case):
    """Scenarios, panels and studies of which each value is in range, and the whole is not what anyone means."""
    event = {"at": 0.0}
    scenes = {
        "many events": {"events": [{"at": 0.0, "remove": {"members": ["B3"]}}] * 20000}, "the same removed twice": {"events": [{"at": 0.0, "remove": {"members": ["B3", "B3"]}}] * 2},
        "all removed": {"events": [{"at": 0.0, "remove": {"members": list(MODEL["members"])}}]}, "an event after the end": {"events": [{"at": 1e6, "remove": {"members": ["B3"]}}]},
        "an event of nothing": {"events": [event]}, "an event of two things": {"events": [{**event, "gravity": [0, 0, 1], "remove": {"members": ["B3"]}}]},
        "a ball in the building": {"events": [{**event, "projectile": {"from": [2, 2, 3], "velocity": [0, 0, 0], "mass": 1e9, "radius": 5}}]},
        "a ball as large as the world": {"events": [{**event, "projectile": {"from": [2, 2, 3], "velocity": [0, 0, -1e4], "mass": 1e9, "radius": 1e3}}]},
        "a fast and tiny ball": {"events": [{**event, "projectile": {"from": [-9, 0, 2], "velocity": [1e4, 0, 0], "mass": 1e-6, "radius": 1e-3}}]},
        "a cable too short": {"events": [{**event, "wrecking_ball": {"anchor": [0, 0, 900], "from": [-3, 0, 5], "cable": 0.01, "mass": 500, "radius": 0.5}}]},
        "a ball at its anchor": {"events": [{**event, "wrecking_ball": {"anchor": [0, 0, 9], "from": [0, 0, 9], "cable": 5, "mass": 500, "radius": 0.5}}]},
        "a thousand balls": {"events": [{**event, "projectile": {"from": [-3 - i % 7, 2, 2], "velocity": [20, 0, 0], "mass": 200, "radius": 0.3}} for i in range(1000)]},
        "no gravity": {"events": [{**event, "gravity": [0, 0, 0]}]}, "great gravity": {"events": [{**event, "gravity": [0, 0, -1e5]}]},
        "upward gravity": {"events": [{**event, "gravity": [0, 0, 1e5]}]}, "a great load": {"events": [{**event, "load": {"nodes": {"H": {"z": -1e100}}}}]},
        "a step longer than the run": {"step": 1, "duration": 0.01}, "no duration": {"duration": 0}, "the longest run": {"duration": 1e6, "step": 1e-6, "events": []},
        "long and at rest": {"duration": 1e6, "events": []}, "ground above": {"ground": 1e6}, "ground within": {"ground": 1.5}, "ground far below": {"ground": -1e6},
        "slippery debris": {"debris": {"friction": 0, "restitution": 1}}, "a charge everywhere": {"events": [{**event, "charge": {"centre": [0, 0, 0], "radius": 1e3, "strength": [0, 0]}}]},
        "weakened to nothing": {"events": [{**event, "weaken": {"members": ["P4"], "strength": 0, "stiffness": 1e-6, "over": 0, "stages": 1}}]},
        "the smallest chunks": {"fracture": {"method": "voronoi", "cell": 0.01}}, "cells larger than the panel": {"fracture": {"method": "voronoi", "cell": 1000}},
        "a joint of nobody": {"events": [{**event, "cut": {"joints": ["P1:9"]}}]}, "a joint without a number": {"events": [{**event, "cut": {"joints": ["P1:"]}}]},
        "a pattern of everything": {"events": [{**event, "cut": {"joints": ["*"]}}]}, "a pattern without end": {"events": [{**event, "cut": {"joints": ["*a*a*a*a*a*a*a*a*a*a*a*a*b"]}}]},
        "its own model": {"model": "s.json"}, "a folder as model": {"model": "."}, "a device as model": {"model": "/dev/zero"}, "no combination": {"combination": ""},
        "a member through which a cut goes at its end": {"events": [{**event, "cut": {"members": [{"member": "B2", "where": 0}]}}]},
        "a member cut a hundred times": {"events": [{**event, "cut": {"members": [{"member": "B2", "where": i / 101} for i in range(1, 101)]}}]},
    }
    for name, parts in scenes.items():
        for standing in ("static", "dynamic"):
            scenario = changed(changed(MOVING if standing == "dynamic" else SHORT, duration=0.1), **parts)
            yield Case(f"contradiction {standing}: {name}", ["demolish", "s.json", "-o", "o"],
                       {"m.json": text(BRITTLE if standing == "dynamic" else MODEL), "s.json": text(scenario)})
    vary = STUDY["vary"][0]
    studies = {"a place that is not there": {"vary": [{**vary, "at": "/materials/steel/none"}]}, "the root": {"vary": [{**vary, "at": ""}]}, "a slash": {"vary": [{**vary, "at": "/"}]},
               "an object": {"vary": [{**vary, "at": "/materials/steel"}]}, "beyond a number": {"vary": [{**vary, "at": "/materials/steel/density/x/y"}]},
               "the version": {"vary": [{**vary, "at": "/topple"}]}, "an index of 2^64": {"vary": [{**vary, "at": "/nodes/E/18446744073709551616"}]}, "a bad escape": {"vary": [{**vary, "at": "/~2"}]},
               "low above high": {"vary": [{"name": "x", "at": "/nodes/E/0", "uniform": [1, -1]}]}, "nothing to choose": {"vary": [{"name": "x", "at": "/nodes/E/0", "choice": []}]},
               "weights of nothing": {"vary": [{"name": "x", "at": "/nodes/E/0", "choice": [1, 2], "weights": [0, 0]}]}, "a correlation of 2": {"groups": [{"of": ["fy", "e"], "correlation": 2}]},
               "a correlation of nobody": {"groups": [{"of": ["fy", "none"], "correlation": 0.2}]}, "a correlation with itself": {"groups": [{"of": ["fy", "fy"], "correlation": 0.2}]},
               "no spread": {"vary": [{**vary, "lognormal": {"mean": 3e8, "cov": 0}}]}, "a great spread": {"vary": [{**vary, "lognormal": {"mean": 3e8, "cov": 1e6}}]},
               "a value far out": {"vary": [{"name": "x", "at": "/nodes/E/0", "normal": {"mean": 1e300, "sd": 1e300}}], "groups": [], "fragility": "x"},
               "no sample": {"samples": 0}, "many samples": {"samples": 10**9}, "a name twice": {"vary": [vary, vary], "groups": []}, "an output of nobody": {"record": {"use": "none"}},
               "an output that is an object": {"record": {"use": "results:/combinations"}}, "an output of an empty path": {"record": {"use": "results:"}}, "itself as base": {"base": {"model": "t.json"}},
               "another study as base": {"base": {"scenario": "t.json"}}, "both bases": {"base": {"model": "m.json", "scenario": "s.json"}},
               "options that are none": {"base": {"model": "m.json", "analyse": ["--nosuch"]}}, "options that write": {"base": {"model": "m.json", "analyse": ["-o", "../owned"]}},
               "options that read": {"base": {"model": "m.json", "analyse": ["--cuts", "/dev/zero"]}}, "fragility over nobody": {"fragility": "none"},
               "many variables": {"vary": [{"name": f"v{i}", "at": "/nodes/E/0", "uniform": [-0.1, 0.1], "add": True} for i in range(3000)], "groups": [], "fragility": "v1"}}
    for sampling in ["random", "latin", "sobol", "saltelli", "grid", "x"]:
        studies[f"sampling {sampling}"] = {"sampling": sampling}
    for name, parts in studies.items():
        files = {"m.json": text(MODEL), "s.json": text(SHORT), "t.json": text(changed(STUDY, **parts))}
        yield Case(f"contradiction study: {name}", ["check", "t.json"], files)
        if name != "many samples":
            yield Case(f"contradiction study, run: {name}", ["study", "t.json", "-o", "o", "--threads", "1"], files)
    for name in ["journal.jsonl", "samples.csv", "study.json", "times.csv"]:
        for kind, make in {"pipe": lambda path: os.mkfifo(path), "folder": lambda path: path.mkdir(), "full": lambda path: path.symlink_to("/dev/full"),
                           "loop": lambda path: path.symlink_to(path.name), "other text": "{}\n\0\n", "empty": ""}.items():
            for resume in ([], ["--resume"]):
                yield Case(f"contradiction study with {name} a {kind} {resume}", ["study", "t.json", "-o", "o", "--threads", "1", *resume],
                           {"m.json": text(MODEL), "t.json": text(STUDY), f"o/{name}": make})


def system_cases(Case):
    """Streams that are closed, limits that are low, variables that are odd."""
    files = {"m.json": text(MODEL), "s.json": text(SHORT), "p.json": text(PANEL), "t.json": text(STUDY), "a.json": text(ACTIONS)}
    runs = {"analyse": ["analyse", "m.json", "-o", "o", "--csv", "--html"], "demolish": ["demolish", "s.json", "-o", "o", "--gltf"], "fracture": ["fracture", "p.json", "-o", "o"],
            "convert": ["convert", "m.json", "n.json"], "study": ["study", "t.json", "-o", "o", "--threads", "2"], "check": ["check", "m.json"]}
    odd = {"standard output closed": "exec >&-", "standard input closed": "exec <&-", "standard error closed": "exec 2>&-", "all closed": "exec <&- >&- 2>&-", "few files": "ulimit -n 6",
           "small files": "ulimit -f 2", "empty files": "ulimit -f 0", "a small stack": "ulimit -s 256", "one process": "ulimit -u 1",
           "no home": "unset HOME XDG_STATE_HOME", "no place for temporary files": "export TMPDIR=/nonexistent", "models in a pipe": "mkfifo pp; export TOPPLE_MODELS=$PWD/pp",
           "models in a device": "export TOPPLE_MODELS=/dev/zero", "many threads asked": "export OMP_NUM_THREADS=100000 OPENBLAS_NUM_THREADS=100000",
           "another locale": "export LC_ALL=de_DE.UTF-8", "a folder that is gone": "mkdir gone; cp *.json gone; cd gone; rm -r ../gone", "signals ignored": "trap '' INT TERM HUP PIPE XFSZ",
           "a reader that is gone": "exec > >(exit 0); sleep 0.1"}
    for how, before in odd.items():
        for name, words in runs.items():
            quiet = "closed" in how or how in ("small files", "empty files", "few files", "one process", "a reader that is gone", "a small stack")
            case = Case(f"system {how}: {name}", words, files, (0, 1, 2, 3) if quiet else (0, 2, 3))
            case.before = before
            case.quiet = "standard error closed" in how or "all closed" in how
            yield case
        case = Case(f"system {how}: viewer", ["m.json", "--headless", "--size", "64x48", "--screenshot", "p.png", "--usd", "x.usda", "--gltf", "x.glb", "--save", "x.topple"], files,
                    (0, 1, 2, 3), program="topple-viewer")
        case.before, case.quiet = before, "closed" in how
        yield case
    for kind, make in {"pipe": "mkfifo r/topple/recent", "folder": "mkdir r/topple/recent", "endless": "ln -s /dev/zero r/topple/recent", "locked": "touch r/topple/recent; chmod 0 r/topple/recent"}.items():
        case = Case(f"system recent files in a {kind}: viewer", ["m.json", "--headless", "--size", "64x48", "--screenshot", "p.png"], files, program="topple-viewer")
        case.before = f"mkdir -p r/topple; {make}; export XDG_STATE_HOME=$PWD/r"
        yield case


def odd_cases(Case, glb):
    for cases in (beside_cases, syntax_cases, name_cases, frame3dd_cases, table_cases, contradiction_cases, system_cases):
        yield from cases(Case)
    yield from drawing_cases(Case, glb)
