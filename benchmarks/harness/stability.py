"""Where accuracy is lost, and whether the program says so."""

import json
import os
import subprocess

import output

COLUMNS = [("family", "along"), ("what", "what"), ("way", "way"), ("parameter", "value"), ("count", "answers"), ("error", "error"), ("bound", "stated bound"),
           ("force_error", "forces error"), ("backward_error", "backward error"), ("condition", "condition"), ("told", "told"),
           ("false_confidence", "false confidence")]

TEXT = ("Errors against solutions in quadruple precision that share no code with the solver: of the displacements, relative to the largest (rotations times the "
        "mean length of members). The stated bound is what the answer says of itself. Told: the structure was refused as unstable, or the answer carries a "
        "warning. False confidence: an error above the bound without a word; asked: none. Frames made by chance are shown by the decade of their condition, each "
        "by the one whose error comes nearest to its bound. Debris: the error is how far a heavy box on a light one has come down after ten seconds, kept awake, over "
        "its height; stated is twice the deepest lasting overlap that a run tells of (overlaps in summary.json; 3 mm when it tells of none), since the box stands on two places. What is not shown: errors of the model itself.")

FIGURE = """
set xlabel '%s'
set ylabel '%s'
set title '%s'
set tmargin 6.5
set key at screen 0.5,0.99 center top vertical maxrows 4 Left reverse width -4 font ',10'
set xrange [%g:%g]
set yrange [%s]
plot %s
"""
REFUSED_AT = 30.0  # where an answer that was refused stands: it has no error
COLOURS = ("#c0392b", "#2471a3", "#1e8449", "#b7950b", "#7d3c98")
AXES = {"stiffness ratio": "stiffness over that of the rest (or the reverse)", "slenderness": "length over side", "chain length": "members",
        "near-mechanism": "what still holds it (see the key)", "damage sequence": "changes of joints", "by chance": "condition", "debris": "mass of the upper box over the lower"}


def told(row):
    if row.get("refused"):
        return "unstable" if row["mechanism"] else "refused"
    return "warned" if row.get("warned") else ""


def figure(context, family, rows):
    """Points are errors, open points on lines the bounds; what was warned of has a square around it, what was refused stands at the top."""
    across = "condition" if family == "by chance" else "parameter"
    data, parts, warned, refused, places = {}, [], [], [], []
    for i, what in enumerate(sorted({row["what"] for row in rows})):
        shown = [row for row in rows if row["what"] == what and row.get(across) and (row["way"] != "fresh" or family == "by chance")]
        shown.sort(key=lambda row: row[across])
        places += [row[across] for row in shown]
        refused += [(row[across], REFUSED_AT) for row in shown if row.get("refused")]
        answers = [(row[across], max(1e-17, row["error"])) for row in shown if row.get("error") is not None]
        warned += [(row[across], max(1e-17, row["error"])) for row in shown if row.get("error") is not None and row.get("warned")]
        if not answers:
            continue
        colour = COLOURS[i % len(COLOURS)]
        data["e%d" % i] = answers
        parts.append("$e%d using 1:2 with points pt 7 ps 0.9 lc rgb '%s' title \"%s\"" % (i, colour, what))
        bounds = [(row[across], row["bound"]) for row in shown if row.get("bound") is not None]
        if bounds:
            data["b%d" % i] = bounds
            parts.append("$b%d using 1:2 with linespoints pt 6 ps 0.8 lc rgb '%s' notitle" % (i, colour))
    if not parts:
        return None
    parts.append("keyentry with linespoints pt 6 ps 0.8 lc rgb '#777777' title 'stated bound'")
    for name, points, mark, title in (("warned", warned, "pt 4 ps 1.7", "warned"), ("refused", refused, "pt 11 ps 1.1", "refused as unstable")):
        if points:
            data[name] = points
            parts.append("$%s using 1:2 with points %s lc rgb '#222222' title '%s'" % (name, mark, title))
    debris = family == "debris"
    values = (AXES[family], "how far the heavy box came down, over its height" if debris else "relative error of the displacements",
              "%s: error, and the bound that %s" % (family.capitalize(), "follows from the overlaps told" if debris else "the answer states"),
              min(places) / 2, max(places) * 2, "1e-6:1e2" if debris else "1e-17:1e2", ", ".join(parts))
    path = os.path.join(context.results, "stability_%s.svg" % family.replace(" ", "_").replace("-", "_"))
    return output.plot(path, FIGURE % values, data)


def measured(context):
    """Rows as they come, with progress."""
    options = ["--members", "10000", "--changes", "1000", "--frames", "2000"] if context.quick else []
    rows, families = [], []
    running = subprocess.Popen([os.path.join(context.programs, "bench_stability")] + options, stdout=subprocess.PIPE, text=True)
    for line in running.stdout:
        row = json.loads(line)
        row["told"] = told(row)
        rows.append(row)
        if row["family"] not in families:
            families.append(row["family"])
            output.progress(context, "stability: " + row["family"])
    if running.wait() != 0:
        raise RuntimeError("bench_stability ended with status %d" % running.returncode)
    return rows, families


def verdict(rows):
    judged = [row for row in rows if "false_confidence" in row]
    answers = sum(row["count"] for row in judged)
    false = sum(row["false_confidence"] for row in judged)
    refused = sum(row["count"] for row in judged if row.get("false_alarm"))
    mechanisms = [row for row in judged if row.get("mechanism")]
    margin = max(row["error"] / row["bound"] for row in judged if row["family"] != "debris" and row.get("error") and row.get("bound"))
    lines = ["stability: %d answers judged: %d of false confidence (asked: 0); the error that comes nearest to its bound is %.2f of it" % (answers, false, margin),
             "stability: %d mechanisms, %d of them refused; %d structures that stand were refused because fewer than three digits would be left" % (len(mechanisms), sum(row["refused"] for row in mechanisms), refused)]
    lines.append(of_debris([row for row in rows if row["family"] == "debris"]))
    for line in lines:
        print("bench: " + line)
    return lines


def of_debris(rows):
    """From which mass ratio on the box under a heavy one does not hold it, and whether that was said."""
    fallen = [row for row in rows if row["error"] > 0.5]
    if not fallen:
        return "debris: a light box holds a heavy one at every mass ratio tried"
    told = sum(row["warned"] for row in fallen)
    return ("debris: from a mass ratio of %g on, a box under a heavy one is squeezed out within ten seconds; of %d such runs %d warn of overlaps"
            % (min(row["parameter"] for row in fallen), len(fallen), told))


def run(context):
    rows, families = measured(context)
    lines = verdict(rows)
    wrong = sum(row.get("false_confidence", 0) for row in rows)
    if wrong:
        context.broken.append("stability: %d answers of false confidence" % wrong)
    output.write_results(context, "stability", rows, COLUMNS, ("family", "what", "way", "parameter"), lines)
    figures = [figure(context, family, [row for row in rows if row["family"] == family]) for family in families if family in AXES]
    return [("Stability", TEXT + "".join(" In this run, " + line + "." for line in lines), [drawn for drawn in figures if drawn], (rows, COLUMNS))]
