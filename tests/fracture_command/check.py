#!/usr/bin/env python3
"""Runs `topple fracture` on the shipped panels and reads its files back with code of its own: glTF and OBJ must be closed,
outward, and hold the volumes that the summary tells; wrong files must be refused with one line and nothing written.

usage: check.py TOPPLE
"""
import json
import pathlib
import struct
import subprocess
import sys
import tempfile
from collections import Counter

topple = sys.argv[1]
failures = []


def expect(holds, what):
    if not holds:
        failures.append(what)


def read_glb(path):
    data = path.read_bytes()
    magic, version, length = struct.unpack_from("<4sII", data)
    expect(magic == b"glTF" and version == 2 and length == len(data), f"{path.name}: header")
    size, kind = struct.unpack_from("<I4s", data, 12)
    expect(kind == b"JSON", f"{path.name}: first chunk")
    header = json.loads(data[20:20 + size])
    start = 20 + size + 8
    expect(struct.unpack_from("<4s", data, start - 4)[0] == b"BIN\0", f"{path.name}: second chunk")

    def values(index, form, width):
        accessor = header["accessors"][index]
        view = header["bufferViews"][accessor["bufferView"]]
        numbers = struct.unpack_from(f"<{accessor['count'] * width}{form}", data, start + view["byteOffset"])
        return [numbers[i:i + width] for i in range(0, len(numbers), width)]

    primitive = header["meshes"][0]["primitives"][0]
    positions = values(primitive["attributes"]["POSITION"], "f", 3)
    bounds = header["accessors"][primitive["attributes"]["POSITION"]]
    for axis in range(3):
        expect(min(p[axis] for p in positions) == bounds["min"][axis], f"{path.name}: min")
        expect(max(p[axis] for p in positions) == bounds["max"][axis], f"{path.name}: max")
    corners = [i for (i,) in values(primitive["indices"], "I", 1)]
    return positions, [corners[i:i + 3] for i in range(0, len(corners), 3)], header["nodes"][0]


def read_obj(path):
    positions, triangles = [], []
    for line in path.read_text().splitlines():
        word, *rest = line.split()
        if word == "v":
            positions.append(tuple(map(float, rest)))
        if word == "f":
            triangles.append([int(corner.split("/")[0]) - 1 for corner in rest])
    return positions, triangles


def volume_of(name, positions, triangles):
    edges, volume = Counter(), 0.0
    for triangle in triangles:
        a, b, c = (positions[i] for i in triangle)
        for start, end in ((a, b), (b, c), (c, a)):
            edges[start, end] += 1
        volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6
    open_edges = sum(1 for (start, end), count in edges.items() if edges[end, start] != count)
    expect(open_edges == 0, f"{name}: {open_edges} open edges")
    return volume


def run(*arguments):
    return subprocess.run([topple, "fracture", *map(str, arguments)], capture_output=True, text=True)


with tempfile.TemporaryDirectory() as folder:
    place = pathlib.Path(folder)
    for panel in ["wall_voronoi", "wall_quadrilateral", "wall_local"]:
        for option, ending in [([], ".glb"), (["--obj"], ".obj")]:
            out = place / (panel + ending[1:])
            done = run(panel, "-o", out, *option)
            expect(done.returncode == 0, f"{panel} ends with {done.returncode}: {done.stderr}")
            summary = json.loads((out / "summary.json").read_text())
            count = summary["counts"]["chunks"]
            expect(count > 20 and abs(summary["area_error"]) < 1e-12, f"{panel}: {summary['counts']} {summary['area_error']}")
            expect(len(list(out.iterdir())) == count + 3, f"{panel}: files")
            expect((out / "pattern.svg").read_text().count("<path") >= count, f"{panel}: drawing")
            volumes = [summary["volumes"]["remaining"], *summary["volumes"]["chunks"]]
            files = ["panel" + ending, *(chunk["file"] for chunk in summary["chunks"])]
            for file, volume in zip(files, volumes):
                if ending == ".glb":
                    positions, triangles, node = read_glb(out / file)
                    expect(abs(node["extras"]["volume"] - volume) <= 1e-15 + 1e-12 * volume, f"{panel} {file}: extras")
                else:
                    positions, triangles = read_obj(out / file)
                told = volume_of(f"{panel} {file}", positions, triangles)
                # 32-bit coordinates of some metres are off by 2e-7 m.
                expect(abs(told - volume) < (1e-5 if ending == ".glb" else 1e-12), f"{panel} {file}: volume {told} for {volume}")

    again = place / "again"
    run("wall_local", "-o", again)
    for file in (place / "wall_localglb").iterdir():
        expect(file.read_bytes() == (again / file.name).read_bytes(), f"{file.name} differs in a second run")

    good = {"topple": 1, "panel": {"outline": [[0, 0], [6, 0], [6, 3], [0, 3]], "thickness": 0.2},
            "fracture": {"method": "voronoi"}, "hits": [{"at": [1, 1]}]}
    outline = good["panel"]["outline"]
    whole = [[-1, -1], [7, -1], [7, 4], [-1, 4]]

    def shaped(**keys):
        return {**good, "panel": {**good["panel"], **keys}}

    def broken_by(**keys):
        return {**good, "fracture": keys}

    # Each with the place that the message names; what is accepted must stand in it as well.
    wrong = {
        "key": ({**good, "hit": []}, ", hit:"), "method": (broken_by(method="hammer"), "fracture.method: found \"hammer\""),
        "other method's key": (broken_by(method="voronoi", ring=1), "fracture.ring:"),
        "jitter": (broken_by(method="voronoi", jitter=2), "fracture.jitter: found 2"),
        "cell": (broken_by(method="quadrilateral", cell=1e-7), "fracture.cell: found 1e-07"),
        "points": (broken_by(method="local", points=[2, 5]), "fracture.points[0]: found 2"),
        "points turned": (broken_by(method="local", points=[5, 4]), "fracture.points:"),
        "length": (broken_by(method="local", length=[0, 1]), "fracture.length[0]: found 0"),
        "ring": (broken_by(method="local", ring=1e-6), "fracture.ring: found 1e-06"),
        "crossing": (shaped(outline=[outline[0], outline[2], outline[1], outline[3]]), "panel.outline: the polygon crosses"),
        "five corners": (shaped(outline=[*outline, [-1, 1.5]]), "panel.outline: the polygon has not four corners"),
        "dent": (shaped(outline=[outline[0], outline[1], [1, 1], outline[3]]), "panel.outline: the polygon is not convex"),
        "opening": (shaped(openings=[[[1, 1], [2, 1]]]), "panel.openings[0]: found an array of 2"),
        "nothing left": (shaped(openings=[whole]), "panel.openings: nothing of the panel is left"),
        "radius": ({**good, "hits": [{"at": [1, 1], "radius": -0.1}]}, "hits[0].radius: found -0.1"),
        "point": ({**good, "hits": [{"at": [1, 1, 1]}]}, "hits[0].at: found an array of 3"),
        "seed": ({**good, "seed": 1.5}, "seed: found 1.5"), "thickness": (shaped(thickness=0), "panel.thickness: found 0"),
        "density": (shaped(density=-1), "panel.density: found -1"),
    }
    file = place / "wrong.json"
    for what, (value, named) in wrong.items():
        file.write_text(json.dumps(value))
        done = run(file, "-o", place / "none")
        expect(done.returncode == 2 and done.stderr.count("\n") == 1, f"{what}: {done.returncode} {done.stderr}")
        expect("wrong.json, line 1" in done.stderr and named in done.stderr and "accepted: " in done.stderr, f"{what}: {done.stderr}")
    expect(run("wall_local").returncode == 2, "no folder")
    expect(not (place / "none").exists(), "something was written for a wrong file")
    for method in ("voronoi", "quadrilateral", "local"):  # a point alone: the cell that it hits; no length of damage at all
        file.write_text(json.dumps({**good, "fracture": {"method": method}, "hits": [{"at": [1, 1], "radius": 0}]}))
        done = run(file, "-o", place / method)
        chunks = json.loads((place / method / "summary.json").read_text())["counts"]["chunks"] if done.returncode == 0 else -1
        expect(chunks == (0 if method == "local" else 1), f"{method}, radius 0: {chunks} chunks {done.stderr}")
    file.write_text(json.dumps(shaped(outline=outline[::-1])))
    done = run(file, "-o", place / "turned")
    expect(done.returncode == 0, f"a clockwise outline: {done.stderr}")
    file.write_text(json.dumps({**good, "hits": [{"at": [1, 1], "radius": 50}]}))
    done = run(file, "-o", place / "all")
    expect(done.returncode == 0 and json.loads((place / "all" / "summary.json").read_text())["areas"]["remaining"] == 0,
           f"a panel that goes altogether: {done.stderr}")

for failure in failures[:30]:
    print(failure)
print(f"{len(failures)} failures")
sys.exit(1 if failures else 0)
