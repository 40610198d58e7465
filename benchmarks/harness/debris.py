"""Debris that falls, lies and sleeps: what a step of the contact solver costs, and how true it is."""

import json
import os
import statistics
import subprocess

import labels
import output

COLUMNS = [("scene", "scene"), ("engine", "contact solver"), ("seeds", "seeds"), ("bodies", "bodies"), ("milliseconds", "ms a step, awake"), ("low", "lower quartile"),
           ("high", "upper quartile"), ("worst_milliseconds", "longest, ms"), ("over_10_mm", "pairs deeper than 10 mm"), ("over_20_mm", "than 20 mm"),
           ("deepest_mm", "deepest at any time, mm"), ("deepest_end_mm", "in the end, mm"), ("settled_at", "slow from, s"), ("rest", "asleep from, s"), ("height", "mean height, m"),
           ("awake_force_worst", "force residual, awake, worst"), ("awake_force_rms", "rms"), ("awake_moment_worst", "moment residual, awake, worst"), ("awake_moment_rms", "rms"),
           ("asleep_force_worst", "force residual, asleep, worst"), ("asleep_force_rms", "rms"), ("asleep_moment_worst", "moment residual, asleep, worst"),
           ("asleep_moment_rms", "rms"), ("created", "energy created over what fell"), ("momentum", "momentum residual"), ("angular_momentum", "angular"),
           ("bits", "bits of the first seed"), ("same_bits", "same in two runs")]
SHOWN = [(key, title) for key, title in COLUMNS if key in ("scene", "engine", "bodies", "milliseconds", "over_10_mm", "over_20_mm", "deepest_mm", "rest", "awake_force_worst", "asleep_force_worst",
                                                          "created", "momentum", "same_bits")]
ENGINES = ("small-steps", "sequential-impulse")
SEEDS, QUICK_SEEDS = 3, 1
THREADED = ("chunks", "heap")
ONCE = ("heap",)  # by one seed: it is long
QUICK = ("plank", "heavy_10", "heavy_100", "heavy_1000", "stack", "lean", "dominoes", "thrown", "slabs", "floor")
WORST = ("worst_milliseconds", "deepest_mm", "deepest_end_mm", "created", "momentum", "angular_momentum")

TEXT = ("Bodies fall, come to rest and sleep under the collision engine alone, at 60 steps a second. Times: processor time of a step while anything is awake, median over the steps of a run, then over the "
        "seeds that places and turns come from. Overlaps: pairs of bodies, or of a body and what stands, by exact separating axes, in the end, median of the seeds; the deepest by looks "
        "ten times a second. Residuals: of each body, what its contacts and its weight come to beside its change of momentum, over its weight (moments: times its size), awake over each half second, asleep the last "
        "that was told; worst of all bodies and seeds. Energy created: all rises of energy from step to step over what the fall took out. Momentum: that no impulse accounts for, over the most "
        "sum of mass times speed. What is not shown: whether debris of that form would come to lie so.")

FIGURE = """
set xlabel 'processor time of a step while anything is awake, ms'
set ylabel 'deepest overlap at any time, mm'
set title 'Debris: cost of a step against how far things are inside each other'
set tmargin 4
set key at screen 0.5,0.99 center top horizontal Left reverse
set xrange [%g:%g]
set yrange [%g:%g]
%s
plot %s
"""
COLOURS = {"small-steps": "#1e8449", "sequential-impulse": "#c0392b"}


def measured(context, engine, scene, seed, more=()):
    done = subprocess.run([os.path.join(context.programs, "bench_debris"), "--engine", engine, "--seed", str(seed), *more, scene], capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError("bench_debris %s: %s" % (scene, done.stderr.strip()))
    return json.loads(done.stdout)


def median(values):
    """None where a run had none: what never came to rest has no time of rest."""
    return None if any(value is None for value in values) else statistics.median(values)


def together(runs):
    """One row of the runs of several seeds."""
    first = runs[0]
    row = {key: first[key] for key in ("scene", "engine", "bodies", "bits")}
    row["seeds"] = len(runs)
    for key in ("milliseconds", "over_10_mm", "over_20_mm", "settled_at", "rest", "height"):
        row[key] = median([run[key] for run in runs])
    row["low"], row["high"] = output.quartiles([run["milliseconds"] for run in runs]) if len(runs) > 1 else (None, None)
    for key in first:
        found = [run[key] for run in runs if run[key] is not None]
        if key in WORST or key.endswith("_worst"):
            row[key] = max(found) if found else None
        elif key.endswith("_rms"):
            row[key] = statistics.fmean(value * value for value in found) ** 0.5 if found else None
    row["same_bits"] = "yes" if all(run["same_bits"] for run in runs) else "no"
    return row


def figure(context, rows):
    points = [(row["engine"], row["scene"], row["milliseconds"], row["deepest_mm"]) for row in rows if row["milliseconds"] and row["deepest_mm"]]
    if not points:
        return None
    x_range, y_range = (labels.decades([point[place] for point in points]) for place in (2, 3))
    told = []
    for text, x, y, _, _ in labels.place([(scene.replace("_", " "), x, y) for _, scene, x, y in points], x_range, y_range):
        told.append("set label \"%s\" at %g,%g left font ',8' noenhanced" % (text, x, y))
    data, parts = {}, []
    for i, engine in enumerate(engine for engine in ENGINES if any(point[0] == engine for point in points)):
        data["p%d" % i] = [(x, y) for of, _, x, y in points if of == engine]
        parts.append("$p%d using 1:2 with points pt 7 ps 0.9 lc rgb '%s' title '%s'" % (i, COLOURS[engine], engine))
    return output.plot(os.path.join(context.results, "debris.svg"), FIGURE % (x_range + y_range + ("\n".join(told), ", ".join(parts))), data)


def verdict(rows):
    lines = []
    for engine in ENGINES:
        own = [row for row in rows if row["engine"] == engine]
        if not own:
            continue
        forces = [row["asleep_force_worst"] for row in own if row["asleep_force_worst"] is not None]
        awake = [row for row in own if row["rest"] is None and row["scene"] != "thrown"]
        lines.append("debris, %s: two runs agree to the bit in %d of %d scenes; forces of what sleeps are out of balance by at most %s of a body's weight (asked: 1e-3); "
                     "%d pairs deeper than 20 mm in the end; not all asleep in the end: %s"
                     % (engine, sum(row["same_bits"] == "yes" for row in own), len(own), "%.2g" % max(forces) if forces else "-", sum(row["over_20_mm"] for row in own),
                        ", ".join(row["scene"] for row in awake) or "none"))
    return lines


def on_threads(context, scene):
    """A line of what the second thread brings, by the clock; None where the machine has one processor."""
    if (os.cpu_count() or 1) < 2:
        return None
    runs = 1 if context.quick else 3
    alone, shared = (measured(context, "small-steps", scene, 1, ("--runs", str(runs), "--clock", "--threads", str(threads))) for threads in (1, 2))
    if alone["bits"] != shared["bits"] or not shared["same_bits"]:
        context.broken.append("debris: %s on two threads differs from one" % scene)
    return "debris, %s: %.2f ms a step on one thread, %.2f on two (%.2f times as fast), bits %s" % (
        scene, alone["milliseconds"], shared["milliseconds"], alone["milliseconds"] / shared["milliseconds"], "the same" if alone["bits"] == shared["bits"] else "not the same")


def run(context):
    engines = ENGINES if context.engine == "both" else (context.engine,)
    scenes = subprocess.run([os.path.join(context.programs, "bench_debris"), "--scenes"], capture_output=True, text=True, check=True).stdout.split()
    rows = []
    for scene in scenes:
        if context.quick and scene not in QUICK:
            continue
        for engine in engines:
            seeds = QUICK_SEEDS if context.quick or scene in ONCE else SEEDS
            rows.append(together([measured(context, engine, scene, seed) for seed in range(1, seeds + 1)]))
            output.progress(context, "debris: %s, %s" % (scene, engine))
    lines = verdict(rows)
    lines += [line for line in (on_threads(context, scene) for scene in THREADED if not context.quick or scene in QUICK) if line]
    for line in lines:
        print("bench: " + line)
    for row in rows:
        if row["same_bits"] != "yes":
            context.broken.append("debris: two runs of %s under %s differ" % (row["scene"], row["engine"]))
    output.print_table(rows, SHOWN)
    output.write_results(context, "debris", rows, COLUMNS, ("scene", "engine"), lines)
    drawn = figure(context, rows)
    return [("Debris", TEXT + "".join(" In this run, " + line + "." for line in lines), [drawn] if drawn else [], (rows, COLUMNS))]
