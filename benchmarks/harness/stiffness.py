"""How stiff a building stands: sag, split of reactions, joint forces and time a step of Bullet's solvers and of Topple."""

import os
import time

import baseline
import labels
import output
import topple_rows

COLUMNS = [
    ("method", "method"), ("precision", "precision"), ("sag", "roof sag m"), ("published_sag", "seen before m"), ("sag_error", "sag error"),
    ("reaction_sum", "sum of reactions"), ("least_share", "least share"), ("largest_share", "largest share"),
    ("reaction_error", "reactions error"), ("post_force_error", "post forces error"), ("beam_shear_error", "beam shears error"),
    ("beam_moment_error", "beam moments error"), ("milliseconds", "ms a step"), ("low", "lower quartile"), ("high", "upper quartile"),
    ("runs", "steps timed"), ("note", "note"),
]

TEXT = ("Each part of the frame is a rigid body and each joint a fixed constraint, steps of 1/60 s, contacts and sleeping off, "
        "forces and sag averaged over the last seconds (four for 10 iterations, where the building sways with a period of three and, with 12 storeys, collapses later). Errors are relative: of the mean roof sag, and root mean square over all "
        "joints of a kind, against the elastic frame (for Topple's own rows against a solution in extended precision). Shares are "
        "the reaction of a post over its elastic one. Bullet's rigid joints have no stiffness that an engineer could give, so even "
        "when they are converged their split of forces is not that of the elastic frame. Featherstone's multi-body is a tree of rigid "
        "links: it has no sag at all, and leaves out the joints that close loops. Milliseconds are processor time for "
        "Bullet and wall time for Topple, on one thread; this machine may be shared. A method that was stopped at its time limit is drawn where it was then, and its note says so. What is not shown: contacts and debris.")

SIZES = ("3x3x12", "4x5x6")

FIGURE = """
set xlabel 'milliseconds a step'
set ylabel 'relative error'
set title 'Standing %s: error against time'
set key tmargin center horizontal Left reverse
set xrange [%g:%g]
set yrange [%g:%g]
plot $labels using 4:5:($2-$4):($3-$5) with vectors nohead lw 0.4 lc rgb '#bbbbbb' notitle, \\
     $bullet using 2:3 with points pt 7 ps 0.9 lc rgb '#c0392b' title 'Bullet, sag', \\
     $bullet using 2:4 with points pt 6 ps 0.9 lc rgb '#c0392b' title 'Bullet, reactions', \\
     $topple using 2:3 with points pt 5 ps 1 lc rgb '#2471a3' title 'Topple, sag', \\
     $topple using 2:4 with points pt 4 ps 1 lc rgb '#2471a3' title 'Topple, reactions', \\
     $labels using 2:3:1 with labels left font ',8' notitle
"""

FLOOR = 1e-16  # an error of zero has no place on a logarithmic scale


def figure(path, size, rows):
    data = {"bullet": [], "topple": []}
    for row in rows:
        if row.get("sag_error") is None or not row.get("milliseconds"):
            continue
        kind = "topple" if row["method"].startswith("Topple") else "bullet"
        data[kind].append((baseline.label(row) + ("" if row["precision"] == "double" else " single"),
                           row["milliseconds"], max(FLOOR, row["sag_error"]), max(FLOOR, row["reaction_error"] or FLOOR)))
    if not all(data.values()):
        return None
    points = data["bullet"] + data["topple"]
    x_range, y_range = labels.decades([p[1] for p in points]), (FLOOR, 1e5)
    data["labels"] = labels.place([p[:3] for p in points], x_range, y_range)
    return output.plot(path, FIGURE % ((size,) + x_range + y_range), data)


def planned(quick):
    """Pairs of method and precision; in a short run the direct and the slowest ones in double precision alone."""
    short = ("sequential impulse 10", "sequential impulse 50", "Featherstone, tree")
    return [(method, precision) for precision in ("double", "single") for method in baseline.methods(quick)
            if precision == "double" or not quick or method[0] in short]


def without_slabs(context):
    """The frame alone, for the sags that were seen before. A section of the page."""
    size = "3x3x12 frame only"
    scene = baseline.scene(context, os.path.join(context.root, "benchmarks", "models", "regular_3x3x12.json"), frame_only=True)
    rows = []
    for method in baseline.methods(context.quick):
        if method[0] in baseline.PUBLISHED[size]:
            row = baseline.run(context, scene, method, "double")
            row["published_sag"] = baseline.PUBLISHED[size][method[0]]
            rows.append(row)
    lines = baseline.nearness(size, rows)
    output.write_results(context, "stiffness_3x3x12_frame_only", rows, COLUMNS, ("method", "precision"), lines)
    return ("Stiffness: 3 x 3 posts, 12 storeys, without slabs", "The same without slabs: Bullet alone, beside the sags that were seen before.", [], (rows, COLUMNS))


def run(context):
    """Returns sections of the page."""
    sections = []
    for size in SIZES:
        model = os.path.join(context.root, "benchmarks", "models", "regular_%s.json" % size)
        scene = baseline.scene(context, model)
        rows = []
        todo = planned(context.quick)
        for i, (method, precision) in enumerate(todo):
            start = time.time()
            row = baseline.run(context, scene, method, precision)
            row["published_sag"] = baseline.PUBLISHED[size].get(method[0])
            rows.append(row)
            baseline.progress(context, size, i + 1, len(todo), method[0], precision, time.time() - start)
        lines = baseline.nearness(size, rows)
        own = topple_rows.measured(context, model)
        for situation, way, title in (("nothing changes", "standing", "Topple, nothing changes"), ("a load changes", "standing", "Topple, a load changes"),
                                      ("from nothing", "standing", "Topple, from nothing")):
            rows.append(topple_rows.row(own, situation, way, method=title))
        print("\nStanding %s, elastic roof sag %.4g mm" % (size, 1e3 * rows[-1]["sag"]))
        output.print_table(rows, COLUMNS)
        print()
        output.write_results(context, "stiffness_" + size, rows, COLUMNS, ("method", "precision"), lines)
        drawn = figure(os.path.join(context.results, "stiffness_%s.svg" % size), size.replace("x", " x "), rows)
        sections.append(("Stiffness: %s posts and storeys" % size.replace("x", " x "), TEXT + "".join(" In this run, " + line + "." for line in lines),
                         [drawn] if drawn else [], (rows, COLUMNS)))
    return sections + [without_slabs(context)]
