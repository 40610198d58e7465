"""Time and memory of everything that grows with the building, against its size, with fitted exponents and the share of what the machine
can do."""

import json
import math
import os
import statistics
import subprocess
import time

import output
import peers

BULKY = [(2, 2, 4), (3, 3, 6), (4, 4, 10), (6, 6, 14), (8, 8, 25), (12, 12, 36), (17, 17, 58), (21, 21, 120)]
WIDE = [(2, 2, 4), (3, 3, 6), (5, 5, 6), (9, 9, 6), (17, 17, 6), (29, 29, 6), (53, 53, 6), (92, 92, 6), (167, 167, 6)]
QUICK_FREEDOMS = 32000

COLUMNS = [("shape", "shape"), ("frame", "posts x storeys"), ("freedoms", "freedoms"), ("members", "members"), ("reading_seconds", "reading s"),
           ("analysis_seconds", "analysis s"), ("order_seconds", "order s"), ("factor_seconds", "factor s"), ("joint_breaks_seconds", "a joint breaks s"),
           ("load_changes_seconds", "a load changes s"), ("segments_seconds", "segments s"), ("segmentation_seconds", "a joint cut, segmentation s"),
           ("simulation_seconds", "simulation made s"), ("cut_step_seconds", "step with a cut s"), ("flight_step_seconds", "step with a flight s"), ("idle_step_seconds", "idle step s"),
           ("reading_peak_mib", "reading MiB"), ("analysis_peak_mib", "analysis MiB"), ("standing_peak_mib", "reanalysis MiB"), ("simulation_peak_mib", "simulation MiB"),
           ("factor_entries", "factor entries"), ("product_share", "factor, share of matrix product"), ("bandwidth_share", "load change, share of bandwidth"),
           ("error_bound", "stated bound"), ("note", "note")]
# Stored beside each time: quartiles within a run, or the least and the largest of several runs.
SPREADS = [(key.replace("_seconds", "_" + end), title.replace(" s", "", -1) + ", " + name) for key, title in COLUMNS if key.endswith("_seconds")
           for end, name in (("low", "low"), ("high", "high"))] + [("runs", "runs")]
REPEATED, QUICK_RUN = 3, 4.0  # processes for a size of which one takes less than so many seconds
TIMED = [("reading_seconds", "reading"), ("analysis_seconds", "analysis"), ("factor_seconds", "factor"), ("joint_breaks_seconds", "a joint breaks"), ("load_changes_seconds", "a load changes"),
         ("segmentation_seconds", "segmentation of a cut"), ("cut_step_seconds", "step with a cut"), ("flight_step_seconds", "step with a flight"), ("idle_step_seconds", "idle step")]
KEPT = [("analysis_peak_mib", "memory of the analysis"), ("standing_peak_mib", "memory of the reanalysis"), ("simulation_peak_mib", "memory of the simulation")]
FITTED_FROM = 900  # freedoms: below, everything is too quick to tell
MEMORY_SHARE = 0.6  # of what is free: a size that would need more is left out

TEXT = ("Regular frames, bulky (as high as wide) and wide (six storeys), self weight and floor loads, each in a process of its own, one thread; medians of %d "
        "processes where one takes less than %g s (the spread of each time is in scaling.csv). "
        "Reading: text to checked building. Analysis: ordering, factor, solution and its checks. A joint breaks, a load changes: the new answer of a standing frame "
        "(medians of 9). Segmentation: one joint cut, which parts hang together (median of 49). Step with a cut: a tool cuts a beam's joint, everything that "
        "follows is checked (median of 5); with a flight: one body in the air (51); idle: nothing moves (101). Exponents p of size^p are fitted to %d freedoms and "
        "more. Shares: operations of the factorisation over its time, of the rate of the matrix product on one thread; two passes over the factor over the time of a load "
        "change, of the memory's bandwidth on one thread (small factors lie in caches, and can exceed it). Memory is the peak of the process during that stage. What is not shown: panels, "
        "debris in numbers, more threads." % (REPEATED, QUICK_RUN, FITTED_FROM))

FIGURE = """
set xlabel 'freedoms'
set ylabel '%s'
set title '%s'
set key tmargin center vertical maxrows 3 Left reverse font ',10'
plot %s
"""
COLOURS = ("#c0392b", "#2471a3", "#1e8449", "#b7950b", "#7d3c98", "#d35400", "#17a589", "#566573", "#000000")


def write_model(posts_x, posts_y, storeys, path):
    """The frame of the peers, with joints that can break, and never do by themselves."""
    frame = peers.Frame(posts_x, posts_y, storeys)
    peers.write_topple(frame, path)
    with open(path, encoding="utf-8") as stored:
        model = json.load(stored)
    model["joints"] = {"strong": {"capacity": {sense: 1e15 for sense in ("tension", "compression", "shear_y", "shear_z", "torsion", "moment_y", "moment_z")}}}
    for member in model["members"].values():
        member["joints"] = ["strong", "strong"]
    with open(path, "w", encoding="utf-8") as out:
        json.dump(model, out)
    return frame.freedoms


def free_mib():
    with open("/proc/meminfo", encoding="utf-8") as info:
        for line in info:
            if line.startswith("MemAvailable:"):
                return float(line.split()[1]) / 1024
    return 0.0


def exponent(points):
    """p of y = c x^p by least squares of the logarithms; None with fewer than three points."""
    points = [(math.log(x), math.log(y)) for x, y in points if x >= FITTED_FROM and y]
    if len(points) < 3:
        return None
    mx, my = sum(x for x, _ in points) / len(points), sum(y for _, y in points) / len(points)
    return sum((x - mx) * (y - my) for x, y in points) / sum((x - mx) ** 2 for x, _ in points)


def needs(earlier, freedoms):
    """MiB that a size will take, by the growth of the last two."""
    known = [(row["freedoms"], max(row["analysis_peak_mib"], row["simulation_peak_mib"])) for row in earlier if row.get("simulation_peak_mib")]
    if len(known) < 2:
        return 0.0
    (a, x), (b, y) = known[-2:]
    power = max(1.0, math.log(y / x) / math.log(b / a))
    return y * (freedoms / b) ** power


def together(runs):
    """One row of several runs of the same size: medians of what each told; of a time that a run measured once, the least and the largest;
    of one with quartiles, the outermost of them."""
    row = {"runs": len(runs)}
    for key, first in runs[0].items():
        values = [run[key] for run in runs]
        if not isinstance(first, (int, float)):
            row[key] = first
        elif key.endswith("_low"):
            row[key] = min(values)
        elif key.endswith("_high"):
            row[key] = max(values)
        else:
            row[key] = statistics.median(values)
            low, high = key.replace("_seconds", "_low"), key.replace("_seconds", "_high")
            if key.endswith("_seconds") and low not in runs[0] and len(runs) > 1:
                row[low], row[high] = min(values), max(values)
    return row


def measured(context, shape, size, earlier):
    frame = "%dx%dx%d" % size
    freedoms = 6 * size[0] * size[1] * size[2]
    row = {"shape": shape, "frame": frame, "freedoms": freedoms}
    expected, free = needs(earlier, freedoms), free_mib()
    if expected > MEMORY_SHARE * free:
        row["note"] = "not run: expected to take %.0f MiB of %.0f MiB that are free" % (expected, free)
        return row
    path = os.path.join(context.results, "scaling_%s.json" % frame)
    write_model(*size, path)
    found = []
    for _ in range(REPEATED):
        start = time.time()
        done = subprocess.run([os.path.join(context.programs, "bench_scaling"), path], capture_output=True, text=True)
        if done.returncode != 0:
            row["note"] = "failed: " + (done.stderr.strip().split("\n")[-1] or "signal %d" % -done.returncode)
            break
        found.append(json.loads(done.stdout))
        if time.time() - start > QUICK_RUN:
            break
    os.remove(path)
    if not found or row.get("note"):
        return row
    row.update(together(found))
    row["freedoms"] = int(row["freedoms"])
    row["product_share"] = row["factor_operations"] / row["factor_seconds"] / (1e9 * context.machine["product_gflops"])
    row["bandwidth_share"] = 16 * row["factor_entries"] / row["load_changes_seconds"] / (1e9 * context.machine["bandwidth_gbytes"])
    return row


def figure(context, shape, rows, columns, name, axis):
    data, parts = {}, []
    for i, (key, title) in enumerate(columns):
        points = [(row["freedoms"], row[key]) for row in rows if row.get(key)]
        power = exponent(points)
        if not points:
            continue
        data["d%d" % i] = points
        parts.append("$d%d using 1:2 with linespoints pt 7 ps 0.7 lc rgb '%s' title '%s%s'"
                     % (i, COLOURS[i % len(COLOURS)], title, "" if power is None else ", power %.2f" % power))
    if not parts:
        return None
    return output.plot(os.path.join(context.results, "scaling_%s_%s.svg" % (shape, name)), FIGURE % (axis, "%s frames: %s against size" % (shape.capitalize(), name), ", ".join(parts)), data)


def run(context):
    rows, lines, figures = [], [], []
    for shape, sizes in (("bulky", BULKY), ("wide", WIDE)):
        mine = []
        for size in sizes:
            if context.quick and 6 * size[0] * size[1] * size[2] > QUICK_FREEDOMS:
                continue
            start = time.time()
            mine.append(measured(context, shape, size, mine))
            output.progress(context, "scaling, %s: %s, %d freedoms (%.1f s)%s" % (shape, mine[-1]["frame"], mine[-1]["freedoms"], time.time() - start,
                                                                               " " + mine[-1]["note"] if mine[-1].get("note") else ""))
        powers = ["%s %.2f" % (title, power) for key, title in TIMED + KEPT
                  if (power := exponent([(row["freedoms"], row[key]) for row in mine if row.get(key)])) is not None]
        if powers:
            lines.append("%s frames, to %d freedoms, grow with size to the power of: %s" % (shape, max(row["freedoms"] for row in mine if row.get("analysis_seconds")), ", ".join(powers)))
            print("bench: " + lines[-1])
        figures += [figure(context, shape, mine, TIMED, "seconds", "seconds"), figure(context, shape, mine, KEPT, "memory", "MiB")]
        rows += mine
    output.write_results(context, "scaling", rows, COLUMNS + SPREADS, ("shape", "frame"), lines)
    return [("Scaling", TEXT, [drawn for drawn in figures if drawn], (rows, COLUMNS))]
