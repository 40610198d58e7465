"""Work against precision: run time, a step and to the settled answer, against error, for Bullet's solvers and for Topple's ways."""

import os
import statistics
import time

import baseline
import labels
import output
import regular_model
import topple_rows

COLUMNS = [
    ("load", "what happens"), ("method", "method"), ("milliseconds", "ms a step"), ("low", "lower quartile"), ("high", "upper quartile"),
    ("runs", "steps timed"), ("settled", "ms to settled"), ("sag_error", "sag error"), ("reaction_error", "reactions error"),
    ("post_force_error", "post forces error"), ("beam_shear_error", "beam shears error"), ("beam_moment_error", "beam moments error"),
    ("error_bound", "stated bound"), ("note", "note"),
]
IDLE, CHANGING, BREAKS, FIRST = "nothing", "a load at each step", "a joint breaks", "from nothing"
NAMES = {"standing": "Topple, standing", "restricted": "Topple, restricted", "low rank": "Topple, low rank", "own": "Topple, fresh, own factor",
         "simplicial": "Topple, fresh, CHOLMOD simplicial", "supernodal": "Topple, fresh, CHOLMOD supernodal"}
SITUATIONS = (("nothing changes", IDLE), ("a load changes", CHANGING), ("a joint breaks", BREAKS), ("from nothing", FIRST))
ASKED = 1e6  # times smaller error than sequential impulse with 10 iterations, at no more time a step
JUDGED = "4x5x6"
JUDGED_METHOD = "sequential impulse 10"

# On the frame that is larger than the seed's two: some methods take minutes there.
LARGE_QUICK = ("sequential impulse 10", "Featherstone, tree")
LARGE = LARGE_QUICK + ("sequential impulse 50", "sequential impulse 200", "conjugate gradient 50")

TEXT = ("Errors are relative, of the mean roof sag and root mean square over all joints of a kind; Bullet's against the elastic frame, Topple's "
        "against the same frame solved in extended precision. With a load that changes, 100 kN push down on one corner of the roof, half and one and "
        "a half of them at alternate steps; Bullet is measured by its mean over the last seconds against the frame under the mean load, which "
        "favours it, Topple by its last step. Settled: until the sag stays within 5 % of where it ends (steps times the time of one); for Topple "
        "the step is the settled answer. Selective answers are timed until it is known which joint would break next, and measured after they "
        "were made whole. Fresh ways with a changed load keep their factor and refine, recover and check everything at each step. On the largest frame direct "
        "solvers, whose matrices are dense, and the slowest others are left out. A method that was stopped at its time limit is drawn where it was then, and its note says so. What is not shown: debris and contacts; that elastic joints are what is wanted; memory.")

FIGURE = """
set xlabel '%s'
set ylabel 'relative error of the reactions'
set title 'Standing %s: error against time'
set key tmargin center horizontal Left reverse
set xrange [%g:%g]
set yrange [%g:%g]
plot $labels using 4:5:($2-$4):($3-$5) with vectors nohead lw 0.4 lc rgb '#bbbbbb' notitle, \\
     $bullet_idle using 2:3 with points pt 7 ps 1 lc rgb '#c0392b' title 'Bullet, nothing changes', \\
     $bullet_changing using 2:3 with points pt 6 ps 1 lc rgb '#c0392b' title 'Bullet, a load changes', \\
     $topple using 2:3 with points pt 5 ps 1 lc rgb '#2471a3' title 'Topple', \\
     $labels using 2:3:1 with labels left font ',8' notitle
"""


def sizes(context):
    """Name and model of each frame; the largest is written here."""
    found = [(size, os.path.join(context.root, "benchmarks", "models", "regular_%s.json" % size)) for size in ("3x3x12", "4x5x6")]
    for posts_x, posts_y, storeys in ((5, 5, 9),) if context.quick else ((6, 6, 30),):
        name = "%dx%dx%d" % (posts_x, posts_y, storeys)
        path = os.path.join(context.results, "regular_%s.json" % name)
        regular_model.write(found[0][1], path, posts_x, posts_y, storeys)
        found.append((name, path))
    return found


def bullet_rows(context, size, model):
    known = size in baseline.PUBLISHED
    rows = []
    for load, push in ((IDLE, 0.0), (CHANGING, topple_rows.PUSH)):
        scene = baseline.scene(context, model, push)
        todo = [m for m in baseline.methods(context.quick or not known) if not (load == CHANGING and m[0] in baseline.DIRECT)]
        if not known:
            todo = [m for m in todo if m[0] in (LARGE_QUICK if context.quick else LARGE)]
        for i, method in enumerate(todo):
            start = time.time()
            row = baseline.run(context, scene, method, "double")
            row["load"] = load
            rows.append(row)
            baseline.progress(context, "%s, %s" % (size, load), i + 1, len(todo), method[0], "double", time.time() - start)
    return rows


def own_rows(context, model):
    found = topple_rows.measured(context, model)
    rows = []
    for situation, load in SITUATIONS:
        for way in found[situation]:
            row = topple_rows.row(found, situation, way, load=load, method=NAMES[way])
            row["settled"] = row["milliseconds"]
            rows.append(row)
    return rows


def turns(context, model):
    """What a step costs with sequential impulse of 10 iterations and with Topple, in turns, so that what else the machine does meets both.
    For nothing changing and for a changing load: the ratios of Bullet's milliseconds to Topple's, one for each turn."""
    name, options, _ = next(method for method in baseline.methods(True) if method[0] == JUDGED_METHOD)
    ratios = {IDLE: [], CHANGING: []}
    for _ in range(3 if context.quick else 7):
        ours = topple_rows.measure(context, model, 20 if context.quick else 100)
        for load, situation, push in ((IDLE, "nothing changes", 0.0), (CHANGING, "a load changes", topple_rows.PUSH)):
            theirs = baseline.measure(context, baseline.scene(context, model, push), (name, options, 2), "double")
            ratios[load].append(theirs["milliseconds"] / ours[situation]["standing"]["milliseconds"])
    output.progress(context, "%s: sequential impulse 10 and Topple in %d turns" % (JUDGED, len(ratios[IDLE])))
    return ratios


def verdict(context, size, model, rows):
    """Topple's standing answer against sequential impulse with 10 iterations."""
    lines = []
    if size != JUDGED:
        return lines
    ratios_of_turns = turns(context, model)
    for load in (IDLE, CHANGING):
        at = {row["method"]: row for row in rows if row["load"] == load}
        theirs, ours = at[JUDGED_METHOD], at["Topple, standing"]
        ratios = [theirs[key] / max(ours[key], 1e-17) for key in ("sag_error", "reaction_error")]
        lines.append("%s, %s: %.3g ms a step against %.3g ms of sequential impulse with 10 iterations, error %.1e times smaller in sag and %.1e in "
                     "reactions (asked: no more time, %.0e times)" % (size, "nothing changes" if load == IDLE else "a load changes at each step", ours["milliseconds"], theirs["milliseconds"], ratios[0], ratios[1], ASKED))
        paired = ratios_of_turns[load]
        lines[-1] += "; measured in %d turns of both, a step of Bullet takes %.3g times as long (%.3g to %.3g)" % (
            len(paired), statistics.median(paired), min(paired), max(paired))
    for line in lines:
        print("bench: " + line)
    return lines


def figure(context, size, rows, key, axis, name):
    data = {"bullet_idle": [], "bullet_changing": [], "topple": []}
    for row in rows:
        if not row.get(key) or row.get("reaction_error") is None:
            continue
        own = row["method"].startswith("Topple")
        block = "topple" if own else "bullet_idle" if row["load"] == IDLE else "bullet_changing"
        label = baseline.label(row).replace("Topple, ", "").replace("fresh, ", "")
        data[block].append((label + (": " + row["load"] if own else ""), row[key], max(1e-16, row["reaction_error"])))
    if not all(data.values()):
        return None
    points = sum(data.values(), [])
    x_range, y_range = labels.decades([p[1] for p in points]), (1e-16, 1e3)
    data["labels"] = labels.place(data["bullet_idle"] + data["topple"], x_range, y_range)
    path = os.path.join(context.results, "precision_%s_%s.svg" % (size, name))
    return output.plot(path, FIGURE % ((axis, size.replace("x", " x ")) + x_range + y_range), data)


def run(context):
    sections = []
    for size, model in sizes(context):
        rows = bullet_rows(context, size, model) + own_rows(context, model)
        lines = verdict(context, size, model, rows)
        output.print_table(rows, COLUMNS)
        output.write_results(context, "precision_" + size, rows, COLUMNS, ("load", "method"), lines)
        figures = [figure(context, size, rows, "milliseconds", "milliseconds a step", "step"),
                   figure(context, size, rows, "settled", "milliseconds to the settled answer", "settled")]
        sections.append(("Work and precision: %s" % size.replace("x", " x "), TEXT + "".join(" In this run, " + line + "." for line in lines),
                         [drawn for drawn in figures if drawn], (rows, COLUMNS)))
    return sections
