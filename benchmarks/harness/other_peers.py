"""Frame3DD and OpenSees on the frames of the peers, for those who have them: their input files, and the roof's sag in what they write."""

import math
import os


def write_frame3dd(frame, sections, path, young, shear, density):
    """Axes are those of Frame3DD: along a beam z points up, along a post x does. Shear deformation and geometric stiffness off."""
    posts, beams = frame.posts, frame.beams
    lines = [frame.name, "%d" % len(frame.nodes)]
    lines += ["%d %.9g %.9g %.9g 0" % ((n + 1,) + place) for n, place in enumerate(frame.nodes)]
    lines += ["%d" % frame.fixed] + ["%d 1 1 1 1 1 1" % (n + 1) for n in range(frame.fixed)]
    lines.append("%d" % (len(posts) + len(beams)))
    for kind, members, first in (("column", posts, 1), ("beam", beams, 1 + len(posts))):
        s = sections[kind]
        for i, (a, b, _) in enumerate(members):
            # Areas of shear are read although they count for nothing here.
            lines.append("%d %d %d %.12g %.12g %.12g %.12g %.12g %.12g %.9g %.12g 0 %.9g"
                         % (first + i, a, b, s["area"], s["area"], s["area"], s["J"], s["Iy"], s["Iz"], young, shear, density))
    # No shear deformation, no geometric stiffness; exaggeration, scale and increment of drawings; one load case without gravity of its own.
    lines += ["0", "0", "1.0", "1.0", "-1", "1", "0 0 0", "0", "%d" % (len(posts) + len(beams))]
    lines += ["%d %.12g 0 0" % (i + 1, -load) for i, (_, _, load) in enumerate(posts)]
    lines += ["%d 0 0 %.12g" % (1 + len(posts) + i, -load) for i, (_, _, load) in enumerate(beams)]
    lines += ["0", "0", "0", "0", "0", ""]
    with open(path, "w", encoding="utf-8") as out:
        out.write("\n".join(lines))


def roof_of_frame3dd(path, roof):
    """Mean downward displacement of the roof's nodes, from the table of displacements."""
    wanted, found, inside = set(roof), {}, False
    with open(path, encoding="utf-8") as text:
        for line in text:
            if line.startswith("N O D E   D I S P L A C E M E N T S"):
                inside = True
            elif inside and line.startswith("F R A M E"):
                break
            cells = line.split()
            if inside and len(cells) == 7 and cells[0].isdigit() and int(cells[0]) in wanted:
                found[int(cells[0])] = float(cells[3])
    return _mean_sag(found, wanted, path)


def write_opensees(frame, sections, path, young, shear, result):
    """Tcl for the interpreter OpenSees; the roof's vertical displacements go to `result`, a node and a number a line."""
    lines = ["wipe", "model BasicBuilder -ndm 3 -ndf 6"]
    lines += ["node %d %.9g %.9g %.9g" % ((n + 1,) + place) for n, place in enumerate(frame.nodes)]
    lines += ["fix %d 1 1 1 1 1 1" % (n + 1) for n in range(frame.fixed)]
    lines += ["geomTransf Linear 1 1 0 0", "geomTransf Linear 2 0 0 1"]  # posts, beams: a vector in the plane of x and z
    loads, tag = [], 0
    for kind, members, transformation in (("column", frame.posts, 1), ("beam", frame.beams, 2)):
        s = sections[kind]
        for a, b, load in members:
            tag += 1
            lines.append("element elasticBeamColumn %d %d %d %.12g %.9g %.12g %.12g %.12g %.12g %d"
                         % (tag, a, b, s["area"], young, shear, s["J"], s["Iy"], s["Iz"], transformation))
            # Wy Wz Wx, in the axes of the member.
            loads.append("eleLoad -ele %d -type -beamUniform 0 %.12g %.12g" % ((tag, 0, -load) if kind == "column" else (tag, -load, 0)))
    lines += ["timeSeries Linear 1", "pattern Plain 1 1 {"] + loads + ["}"]
    lines += ["system UmfPack", "numberer RCM", "constraints Plain", "integrator LoadControl 1.0", "algorithm Linear", "analysis Static",
              "if {[analyze 1] != 0} {exit 1}", "set out [open {%s} w]" % result]
    lines += ["puts $out \"%d [nodeDisp %d 3]\"" % (n, n) for n in frame.roof] + ["close $out", "exit", ""]
    with open(path, "w", encoding="utf-8") as out:
        out.write("\n".join(lines))


def roof_of_opensees(path, roof):
    found = {}
    with open(path, encoding="utf-8") as text:
        for line in text:
            cells = line.split()
            if len(cells) == 2:
                found[int(cells[0])] = float(cells[1])
    return _mean_sag(found, set(roof), path)


def _mean_sag(found, wanted, path):
    if set(found) != wanted or not all(math.isfinite(value) for value in found.values()):
        raise RuntimeError("%s has displacements of %d of %d roof nodes" % (os.path.basename(path), len(found), len(wanted)))
    return -sum(found.values()) / len(found)
