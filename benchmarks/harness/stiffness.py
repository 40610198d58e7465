"""How stiff a building stands: sag, split of reactions, joint forces and time a step of Bullet's solvers and of Topple."""

import json
import os
import subprocess
import time

import output

COLUMNS = [
    ("method", "method"), ("precision", "precision"), ("sag", "roof sag m"), ("published_sag", "published m"), ("sag_error", "sag error"),
    ("reaction_sum", "sum of reactions"), ("least_share", "least share"), ("largest_share", "largest share"),
    ("reaction_error", "reactions error"), ("post_force_error", "post forces error"), ("beam_shear_error", "beam shears error"),
    ("beam_moment_error", "beam moments error"), ("milliseconds", "ms a step"), ("note", "note"),
]

# Mean roof sag (m) seen before with the same Bullet 3.24 on these buildings: the baseline must come within 5 % of it.
PUBLISHED = {
    "3x3x12": {"sequential impulse 10": 2.45, "sequential impulse 50": 0.46, "sequential impulse 200": 0.11,
               "sequential impulse 1000": 0.017, "sequential impulse 20 x 10": 0.0058},
    "4x5x6": {"sequential impulse 10": 0.79, "sequential impulse 50": 0.154, "sequential impulse 200": 0.034,
              "sequential impulse 1000": 0.0030},
}

TEXT = ("Each part of the frame is a rigid body and each joint a fixed constraint, steps of 1/60 s, contacts and sleeping off, "
        "forces and sag averaged over the last seconds (four for 10 iterations, where the building sways with a period of three and, with 12 storeys, collapses later). Errors are relative: of the mean roof sag, and root mean square over all "
        "joints of a kind, against the elastic frame (for Topple's own rows against a solution in extended precision). Shares are "
        "the reaction of a post over its elastic one. Bullet's rigid joints have no stiffness that an engineer could give, so even "
        "when they are converged their split of forces is not that of the elastic frame. Milliseconds are processor time for "
        "Bullet and wall time for Topple, on one thread; this machine may be shared. What is not shown: contacts and debris.")


def methods(quick):
    """Name, precision, options of the program, simulated seconds."""
    rows = []
    for precision in ("double", "single"):
        for iterations, seconds in ((10, 12), (50, 6), (200, 4)) + (() if quick else ((1000, 10),)):
            if quick and precision == "single" and iterations > 50:
                continue
            options = ["--iterations", str(iterations), "--average", "4" if iterations == 10 else "2"]
            rows.append(("sequential impulse %d" % iterations, precision, options, seconds))
        if precision == "double" or not quick:
            rows.append(("sequential impulse 20 x 10", precision, ["--iterations", "10", "--substeps", "20"], 4))
            rows.append(("conjugate gradient 50", precision, ["--solver", "nncg", "--iterations", "50"], 5))
            rows.append(("projected Gauss-Seidel 50", precision, ["--solver", "pgs", "--iterations", "50"], 5))
            rows.append(("Dantzig", precision, ["--solver", "dantzig"], 5))
            rows.append(("Dantzig, compliance", precision, ["--solver", "dantzig", "--compliance", "1e-7"], 5))
            rows.append(("Lemke", precision, ["--solver", "lemke"], 5))
    return rows


def run_baseline(programs, scene, size, method, quick):
    name, precision, options, seconds = method
    direct = name.split(",")[0] in ("Dantzig", "Lemke", "projected Gauss-Seidel 50")
    limit = (6 if quick else 120) if direct else 300  # processor seconds
    wall = 2 * limit  # the program looks at its limit between steps, and one step of a direct solver can take minutes
    command = [os.path.join(programs, "bench_baseline_" + precision), scene, "--seconds", str(seconds), "--limit", str(limit)] + options
    row = {"method": name, "precision": precision, "published_sag": PUBLISHED[size].get(name)}
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=wall)
    except subprocess.TimeoutExpired:
        row["note"] = "timed out: no answer within %d s" % wall
        return row
    if done.returncode != 0:
        row["note"] = "failed: " + (done.stderr.strip().split("\n")[-1] or "signal %d" % -done.returncode)
        return row
    found = json.loads(done.stdout)
    for key in ("sag", "reaction_sum", "least_share", "largest_share", "reaction_error", "post_force_error", "beam_shear_error",
                "beam_moment_error"):
        row[key] = found[key]
    row["milliseconds"] = found["milliseconds_per_step"]
    row["sag_error"] = abs(found["sag"] - found["static_sag"]) / found["static_sag"] if found["sag"] is not None else None
    notes = []
    if found["timed_out"]:
        notes.append("timed out after %d steps" % found["steps"])
    if found["diverged"]:
        notes.append("diverged")
    if found["silent_fallbacks"]:
        notes.append("fell back to sequential impulse %d times" % found["silent_fallbacks"])
    row["note"] = "; ".join(notes)
    return row


def run_topple(programs, model, quick):
    done = subprocess.run([os.path.join(programs, "bench_topple"), model, "--repeats", "200" if quick else "1000"], capture_output=True,
                          text=True, check=True)
    found = json.loads(done.stdout)
    rows = []
    for kind, title in (("idle", "Topple, nothing changes"), ("changing", "Topple, a load changes"), ("first", "Topple, from nothing")):
        low, high = found[kind + "_milliseconds_quartiles"]
        row = dict(found["after_changes" if kind == "changing" else "at_rest"])
        row.update(method=title, precision=found["precision"], milliseconds=found[kind + "_milliseconds"],
                   note="quartiles %.3g to %.3g ms" % (low, high))
        rows.append(row)
    return rows, found["blas_kernel"]


FIGURE = """
set logscale xy
set format y '10^{%%L}'
set format x '%%g'
set xlabel 'milliseconds a step'
set ylabel 'relative error of the reactions and of the sag'
set title 'Standing %s: error against time'
set key outside below
set grid
set yrange [1e-16:1e4]
plot $bullet using 2:3 with points pt 7 ps 0.9 lc rgb '#c0392b' title 'Bullet, sag', \\
     $bullet using 2:4 with points pt 6 ps 0.9 lc rgb '#c0392b' title 'Bullet, reactions', \\
     $bullet using 2:3:1 with labels left offset 0.6,0.3 font ',8' notitle, \\
     $topple using 2:3 with points pt 5 ps 1 lc rgb '#2471a3' title 'Topple, sag', \\
     $topple using 2:4 with points pt 4 ps 1 lc rgb '#2471a3' title 'Topple, reactions', \\
     $topple using 2:3:1 with labels left offset 0.6,0.6 font ',8' notitle
"""


def figure(path, size, rows):
    floor = 1e-16  # an error of zero has no place on a logarithmic scale
    data = {"bullet": [], "topple": []}
    for row in rows:
        if row.get("sag_error") is None or not row.get("milliseconds"):
            continue
        kind = "topple" if row["method"].startswith("Topple") else "bullet"
        data[kind].append((row["method"].replace("sequential impulse", "SI") + ("" if row["precision"] == "double" else " single"),
                           row["milliseconds"], max(floor, row["sag_error"]), max(floor, row["reaction_error"] or floor)))
    return output.plot(path, FIGURE % size, data) if all(data.values()) else None


def run(context):
    """Returns sections of the page."""
    sections = []
    for size in ("3x3x12", "4x5x6"):
        model = os.path.join(context.root, "benchmarks", "models", "regular_%s.json" % size)
        scene = os.path.join(context.results, "scene_%s.txt" % size)
        with open(scene, "w", encoding="utf-8") as out:
            subprocess.run([os.path.join(context.programs, "bench_scene"), model], stdout=out, check=True)
        rows = []
        todo = methods(context.quick)
        for i, method in enumerate(todo):
            start = time.time()
            rows.append(run_baseline(context.programs, scene, size, method, context.quick))
            print("bench: %s, %d of %d: %s, %s (%.1f s)" % (size, i + 1, len(todo), method[0], method[1], time.time() - start), flush=True)
        own, kernel = run_topple(context.programs, model, context.quick)
        rows += own
        context.provenance["blas_kernel"] = kernel
        print("\nStanding %s, elastic roof sag %.4g mm" % (size, 1e3 * own[0]["sag"]))
        output.print_table(rows, COLUMNS)
        print()
        output.write_csv(os.path.join(context.results, "stiffness_%s.csv" % size), rows, COLUMNS, context.provenance)
        drawn = figure(os.path.join(context.results, "stiffness_%s.svg" % size), size.replace("x", " x "), rows)
        sections.append(("Stiffness: %s posts and storeys" % size.replace("x", " x "), TEXT, [drawn] if drawn else [], (rows, COLUMNS)))
    return sections
