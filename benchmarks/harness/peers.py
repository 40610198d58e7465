"""Topple's whole process against that of CalculiX (ccx), Frame3DD and OpenSees on regular steel frames: from the file read to the results
written."""

import json
import math
import os
import shutil
import statistics
import subprocess
import sys

import other_peers
import output

COLUMNS = [("frame", "posts x storeys"), ("freedoms", "freedoms"), ("program", "program"), ("runs", "runs"),
           ("median", "median s"), ("low", "lower quartile"), ("high", "upper quartile"), ("least", "least s"), ("processor", "processor s"), ("memory", "peak MiB"), ("roof", "roof sag m"), ("off", "roof sag off by")]

# The frames of docs/verification's peers: bay, storey height, outer box of the columns, beams; no shear deformation.
BAY, HEIGHT = 6.0, 3.5
YOUNG, SHEAR, DENSITY, GRAVITY, FLOOR = 210e9, 210e9 / 2.6, 7850.0, 9.81, 5000.0
OUTER, WALL = 0.3, 0.015
COLUMN = {"area": OUTER**2 - (OUTER - 2 * WALL) ** 2, "Iy": (OUTER**4 - (OUTER - 2 * WALL) ** 4) / 12,
          "Iz": (OUTER**4 - (OUTER - 2 * WALL) ** 4) / 12}
# CalculiX's U1 takes J = I11 + I22, so every program gets that J.
COLUMN["J"] = COLUMN["Iy"] + COLUMN["Iz"]
BEAM = {"area": 8.5e-3, "Iy": 1.6e-4, "Iz": 1.2e-5, "J": 1.6e-4 + 1.2e-5}
FRAME3DD_FREEDOMS = 7000  # its matrices are dense: 24,000 freedoms take 4.6 GiB
# CalculiX takes one processor unless these say more.
CALCULIX_THREADS = ["OMP_NUM_THREADS", "CCX_NPROC_EQUATION_SOLVER", "CCX_NPROC_STIFFNESS"]
FRAMES = [(6, 6, 30, 7), (10, 10, 40, 5), (17, 17, 110, 3)]  # posts, posts, storeys, runs of each program


class Frame:
    """Nodes from 1, posts and beams as (node, node, load per length downwards)."""

    def __init__(self, nx, ny, storeys):
        self.name = "%dx%dx%d" % (nx, ny, storeys)
        self.nodes = [(BAY * i, BAY * j, HEIGHT * k) for k in range(storeys + 1) for j in range(ny) for i in range(nx)]
        self.fixed = nx * ny
        at = lambda i, j, k: (k * ny + j) * nx + i + 1
        share = lambda line, lines: FLOOR * BAY / 2 * (0.5 if line in (0, lines - 1) else 1.0)
        own = lambda section: GRAVITY * DENSITY * section["area"]
        self.posts = [(at(i, j, k), at(i, j, k + 1), own(COLUMN)) for k in range(storeys) for j in range(ny) for i in range(nx)]
        self.beams = []
        for k in range(1, storeys + 1):
            self.beams += [(at(i, j, k), at(i + 1, j, k), own(BEAM) + share(j, ny)) for j in range(ny) for i in range(nx - 1)]
            self.beams += [(at(i, j, k), at(i, j + 1, k), own(BEAM) + share(i, nx)) for j in range(ny - 1) for i in range(nx)]
        self.roof = range(storeys * nx * ny + 1, (storeys + 1) * nx * ny + 1)

    @property
    def freedoms(self):
        return 6 * (len(self.nodes) - self.fixed)


def write_topple(frame, path):
    """The self weight as `self_weight`, the floors as line loads."""
    sections = {"column": COLUMN, "beam": BEAM}
    members, loads = {}, {}
    for kind, parts, section in (("post", frame.posts, COLUMN), ("beam", frame.beams, BEAM)):
        for a, b, load in parts:
            name = str(len(members) + 1)
            members[name] = {"kind": kind, "nodes": ["n%d" % a, "n%d" % b], "section": "column" if kind == "post" else "beam",
                             "material": "steel"}
            floor = load - GRAVITY * DENSITY * section["area"]
            if kind == "beam":
                loads[name] = [{"uniform": {"z": -floor}}]
    model = {"topple": 1, "title": frame.name, "gravity": GRAVITY,
             "materials": {"steel": {"youngs_modulus": YOUNG, "shear_modulus": SHEAR, "density": DENSITY}}, "sections": sections,
             "nodes": {"n%d" % (n + 1): place for n, place in enumerate(frame.nodes)}, "members": members,
             "supports": {"n%d" % (n + 1): "fixed" for n in range(frame.fixed)},
             "loads": {"case": {"self_weight": 1, "members": loads}}}
    with open(path, "w", encoding="utf-8") as out:
        json.dump(model, out)


def write_calculix(frame, path):
    """CalculiX 2.20's U1 has a sign error in its third local direction and a wrong shear correction. Two of them for each
    member, each with half of the area and one of the inertias (I22 = 0, the second turned by 90 degrees), with a huge
    shear factor, are exact Euler-Bernoulli beams with J = I11 + I22. Loads go to the nodes, fixed-end moments with them."""
    lines = ["*NODE, NSET=ALL"]
    lines += ["%d, %.9g, %.9g, %.9g" % ((n + 1,) + place) for n, place in enumerate(frame.nodes)]
    lines += ["*USER ELEMENT, TYPE=U1, NODES=2, INTEGRATION POINTS=2, MAXDOF=6"]
    element = 0
    # Axis 1 of a section, and its inertia: about the strong and the weak axis in turn.
    groups = []
    for name, parts, section, axes in (("POST", frame.posts, COLUMN, ("1., 0., 0.", "0., 1., 0.")),
                                       ("BEAMX", [b for b in frame.beams if b[1] == b[0] + 1], BEAM, ("0., 0., 1.", "0., 1., 0.")),
                                       ("BEAMY", [b for b in frame.beams if b[1] != b[0] + 1], BEAM, ("0., 0., 1.", "1., 0., 0."))):
        for which, axis, inertia in (("A", axes[0], section["Iy"]), ("B", axes[1], section["Iz"])):
            groups.append((name + which, section["area"] / 2, inertia, axis))
            lines.append("*ELEMENT, TYPE=U1, ELSET=%s" % (name + which))
            for a, b, _ in parts:
                element += 1
                lines.append("%d, %d, %d" % (element, a, b))
    lines += ["*MATERIAL, NAME=STEEL", "*ELASTIC", "%.9g, %.9g" % (YOUNG, YOUNG / (2 * SHEAR) - 1)]
    for name, area, inertia, axis in groups:
        lines += ["*BEAM SECTION, ELSET=%s, MATERIAL=STEEL, SECTION=GENERAL" % name,
                  "%.12g, %.12g, 0., 0., 1.e6" % (area, inertia), axis]
    lines += ["*BOUNDARY"] + ["%d, 1, 6" % (n + 1) for n in range(frame.fixed)]
    forces = {}
    for a, b, load in frame.posts + frame.beams:
        along = [q - p for p, q in zip(frame.nodes[a - 1], frame.nodes[b - 1])]
        length = math.sqrt(sum(x * x for x in along))
        for node, sign in ((a, 1), (b, -1)):
            force = forces.setdefault(node, [0.0] * 6)
            force[2] -= load * length / 2
            # sign * r x f with f = -load z: along x the moment is about y, along y about x.
            force[3] -= sign * load * length * along[1] / 12
            force[4] += sign * load * length * along[0] / 12
    lines += ["*STEP", "*STATIC", "*CLOAD"]
    for node, force in sorted(forces.items()):
        if node > frame.fixed:
            lines += ["%d, %d, %.12g" % (node, c + 1, value) for c, value in enumerate(force) if abs(value) > 1e-9]
    lines += ["*NODE FILE", "U", "*NODE PRINT, NSET=ALL", "U", "*END STEP", ""]
    with open(path, "w", encoding="utf-8") as out:
        out.write("\n".join(lines))


def measured(command, folder, environment):
    """Seconds, processor seconds and peak MiB of a whole process; its output when it fails."""
    runner = os.path.join(os.path.dirname(os.path.abspath(__file__)), "spent.py")
    done = subprocess.run([sys.executable, "-I", runner] + command, cwd=folder, env=environment, capture_output=True, text=True, check=True)
    spent = json.loads(done.stdout)
    if spent["status"] != 0:
        raise RuntimeError("%s ended with %d:\n%s" % (command[0], spent["status"], spent["text"]))
    return spent["seconds"], spent["processor"], spent["mib"]


def roof_of_topple(folder, frame):
    with open(os.path.join(folder, "out", "results.json"), encoding="utf-8") as stored:
        moved = json.load(stored)["combinations"]["case"]["displacements"]
    return -sum(moved["n%d" % n][2] for n in frame.roof) / len(frame.roof)


def roof_of_calculix(folder, frame):
    wanted = set(frame.roof)
    found = {}
    with open(os.path.join(folder, "frame.dat"), encoding="utf-8") as stored:
        for line in stored:
            cells = line.split()
            if len(cells) == 7 and cells[0].isdigit() and int(cells[0]) in wanted:
                found[int(cells[0])] = float(cells[3])
    if len(found) != len(wanted):
        raise RuntimeError("frame.dat has displacements of %d of %d roof nodes" % (len(found), len(wanted)))
    return -sum(found.values()) / len(found)


def contestants(context, frame, folder):
    """(name, command, roof's sag, runs at most) of each program that is here; its input is written."""
    sections = {"column": COLUMN, "beam": BEAM}
    write_topple(frame, os.path.join(folder, "frame.json"))
    found = [("Topple", [os.path.join(context.programs, "topple"), "analyse", "frame.json", "-o", "out"], lambda: roof_of_topple(folder, frame), 99)]
    ccx = shutil.which("ccx")
    if ccx is not None:
        write_calculix(frame, os.path.join(folder, "frame.inp"))
        found.append(("CalculiX", [ccx, "-i", "frame"], lambda: roof_of_calculix(folder, frame), 99))
        processors = len(os.sched_getaffinity(0))
        if processors > 1:
            told = ["env"] + ["%s=%d" % (name, processors) for name in CALCULIX_THREADS]
            found.append(("CalculiX on %d" % processors, told + [ccx, "-i", "frame"], lambda: roof_of_calculix(folder, frame), 99))
    if context.frame3dd and frame.freedoms <= FRAME3DD_FREEDOMS:
        frame3dd_out = os.path.join(folder, "frame3dd.out")
        other_peers.write_frame3dd(frame, sections, os.path.join(folder, "frame.3dd"), YOUNG, SHEAR, DENSITY)
        found.append(("Frame3DD", [context.frame3dd, "-q", "-i", "frame.3dd", "-o", frame3dd_out],
                      lambda: other_peers.roof_of_frame3dd(frame3dd_out, frame.roof), 3))
    if context.opensees:
        opensees_out = os.path.join(folder, "opensees.out")
        other_peers.write_opensees(frame, sections, os.path.join(folder, "frame.tcl"), YOUNG, SHEAR, opensees_out)
        found.append(("OpenSees", [context.opensees, "frame.tcl"], lambda: other_peers.roof_of_opensees(opensees_out, frame.roof), 5))
    return found


def taken(programs, turns, folder, environment, lines):
    """Seconds, processor seconds and MiB of each run, by program. A peer that fails is left out, and a line says why; Topple must not."""
    spent = {name: [] for name, _, _, _ in programs}
    for turn in range(turns):  # in turn, so that what else the machine does meets all
        for name, command, _, most in programs:
            if turn >= most or name not in spent:
                continue
            try:
                spent[name].append(measured(command, folder, environment))
            except RuntimeError as error:
                if name == "Topple":
                    raise
                del spent[name]
                lines.append("%s: %s" % (name, " ".join(str(error).split())[:300]))
                print("bench: " + lines[-1])
    return spent


def tell_absent(context):
    for name, present, how in (("ccx", shutil.which("ccx"), "Debian: calculix-ccx"), ("Frame3DD", context.frame3dd, "--frame3dd PATH"),
                               ("OpenSees", context.opensees, "--opensees PATH")):
        if not present:
            context.lines.append("peers: %s is not here (%s); it is left out" % (name, how))
            print("bench: " + context.lines[-1])


def run(context):
    tell_absent(context)
    environment = {name: value for name, value in os.environ.items() if name not in CALCULIX_THREADS}
    rows, lines = [], []
    for nx, ny, storeys, runs in FRAMES[:2] if context.quick else FRAMES:
        frame = Frame(nx, ny, storeys)
        folder = os.path.join(context.results, "peers", frame.name)
        os.makedirs(folder)
        programs = contestants(context, frame, folder)
        spent = taken(programs, 3 if context.quick else runs, folder, environment, lines)
        output.progress(context, "peers: " + frame.name)
        ours = programs[0][2]()
        for name, _, roof, _ in programs:
            if name not in spent:
                continue
            try:
                sag = roof()
            except (RuntimeError, OSError, ValueError) as error:
                if name == "Topple":
                    raise
                lines.append("%s: %s: no answer that can be read: %s" % (frame.name, name, error))
                print("bench: " + lines[-1])
                continue
            seconds, work, peak = zip(*spent[name])
            low, high = output.quartiles(seconds)
            rows.append({"frame": frame.name, "freedoms": frame.freedoms, "program": name, "runs": len(seconds),
                         "median": statistics.median(seconds), "low": low, "high": high, "least": min(seconds), "processor": statistics.median(work), "memory": max(peak),
                         "roof": sag, "off": abs(sag / ours - 1)})
            if name == "Topple":
                continue
            for what, place in (("as long", 0), ("the processor time", 1)):
                ratios = sorted(theirs[place] / own[place] for own, theirs in zip(spent["Topple"], spent[name]))
                lines.append("%s: %s takes %.2f times %s (median of %d pairs; %.2f to %.2f)"
                             % (frame.name, name, statistics.median(ratios), what, len(ratios), ratios[0], ratios[-1]))
                print("bench: " + lines[-1])
        shutil.rmtree(folder)
    output.print_table(rows, COLUMNS)
    output.write_results(context, "peers", rows, COLUMNS, ("frame", "program"), lines)
    return [("Whole process against others", "Each program reads its file, solves and writes its results; run in turn. Topple takes all processors, CalculiX one as it is installed, and all where that is said. The roof's mean sag says whether "
             "they solved the same frame. Topple writes the end forces, extremes and deflections of every member besides; CalculiX and OpenSees displacements alone.", [], (rows, COLUMNS))]
