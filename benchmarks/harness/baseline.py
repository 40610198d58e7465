"""Bullet's ways of holding a building up: what is run, with which options, and what each run told."""

import json
import os
import subprocess

import output

# Mean roof sag (m) seen before with the same Bullet 3.24 on these buildings: the baseline must come within 5 % of it at 10 to 200
# iterations. The figures of the sum move by that much with details that were not told.
PUBLISHED = {
    "3x3x12": {"sequential impulse 10": 2.45, "sequential impulse 50": 0.46, "sequential impulse 200": 0.11,
               "sequential impulse 1000": 0.017, "sequential impulse 20 x 10": 0.0058},
    "4x5x6": {"sequential impulse 10": 0.79, "sequential impulse 50": 0.154, "sequential impulse 200": 0.034,
              "sequential impulse 1000": 0.0030},
    "3x3x12 frame only": {"sequential impulse 10": 0.226, "sequential impulse 50": 0.040, "sequential impulse 200": 0.0054},
}
MUST_COME_NEAR = ("sequential impulse 10", "sequential impulse 50", "sequential impulse 200")
NEAR = 0.05

ERRORS = ("reaction_error", "post_force_error", "beam_shear_error", "beam_moment_error")
DIRECT = ("projected Gauss-Seidel 50", "Dantzig", "Dantzig, compliance", "Lemke")
DENSE_GIB = 4.0  # a direct solver's dense matrix must stay below this


def methods(quick):
    """Name, options of the program, simulated seconds."""
    iterations = [(10, 12, "4"), (50, 6, "2"), (200, 4, "2")] + ([] if quick else [(1000, 10, "2")])
    rows = [("sequential impulse %d" % n, ["--iterations", str(n), "--average", average], seconds) for n, seconds, average in iterations]
    rows += [("sequential impulse 20 x 10", ["--iterations", "10", "--substeps", "20"], 4),
             ("conjugate gradient 50", ["--solver", "nncg", "--iterations", "50"], 5),
             ("projected Gauss-Seidel 50", ["--solver", "pgs", "--iterations", "50"], 5),
             ("Dantzig", ["--solver", "dantzig"], 5),
             ("Dantzig, compliance", ["--solver", "dantzig", "--compliance", "1e-7"], 5),
             ("Lemke", ["--solver", "lemke"], 5),
             ("Featherstone, tree", ["--solver", "featherstone", "--average", "1"], 2)]
    return rows


def scene(context, model, push=0.0, frame_only=False):
    """Writes the building as rigid bodies and joints, once; `frame_only`: without its panels and what acts on them. Path of the file."""
    name = os.path.basename(model)[:-len(".json")].replace("regular_", "")
    path = os.path.join(context.results, "scene_%s%s%s.txt" % (name, "_frame_only" if frame_only else "", "_pushed" if push else ""))
    if not os.path.exists(path):
        with open(path, "w", encoding="utf-8") as out:
            subprocess.run([os.path.join(context.programs, "bench_scene"), model, "--push", repr(push)]
                           + (["--frame-only"] if frame_only else []), stdout=out, check=True)
    return path


def _dense_gib(scene_path):
    with open(scene_path, encoding="utf-8") as lines:
        joints = sum(line.startswith("joint ") for line in lines)
    return (6.0 * joints) ** 2 * 8 / 2**30


def run(context, scene_path, method, precision):
    """A row of figures with errors, times and a note, or a note alone. Each method runs once in a run of the benchmarks."""
    done = context.baseline_runs
    key = (scene_path, method[0], precision)
    if key not in done:
        done[key] = measure(context, scene_path, method, precision)
    return dict(done[key])


def measure(context, scene_path, method, precision):
    """Like run(), without looking whether it was measured before."""
    name, options, seconds = method
    row = {"method": name, "precision": precision}
    program = os.path.join(context.programs, "bench_baseline_" + precision)
    if not os.path.exists(program):
        row["note"] = "not measured: Bullet in %s precision is not installed" % precision
        return row
    direct = name in DIRECT
    if direct and _dense_gib(scene_path) > DENSE_GIB:
        row["note"] = "not run: its dense matrix takes %.0f GiB" % _dense_gib(scene_path)
        return row
    # Processor seconds; what needs a thousand iterations must have time to settle.
    limit = (3 if context.quick else 15) if direct else 60 if name == "sequential impulse 1000" else 40
    wall = 2 * limit  # the program looks at its limit between steps, and one step of a direct solver can take minutes
    try:
        ended = subprocess.run([program, scene_path, "--seconds", str(seconds), "--limit", str(limit)] + options, capture_output=True,
                               text=True, timeout=wall)
    except subprocess.TimeoutExpired:
        row["note"] = "timed out: no answer within %d s" % wall
        return row
    if ended.returncode != 0:
        row["note"] = "failed: " + (ended.stderr.strip().split("\n")[-1] or "signal %d" % -ended.returncode)
        return row
    return _row(row, json.loads(ended.stdout))


def _row(row, found):
    for key in ("sag", "static_sag", "reaction_sum", "least_share", "largest_share") + ERRORS:
        row[key] = found[key]
    row.update(milliseconds=found["milliseconds_per_step"], low=found["milliseconds_low"], high=found["milliseconds_high"], runs=found["steps"])
    row["sag_error"] = abs(found["sag"] - found["static_sag"]) / found["static_sag"] if found["sag"] is not None else None
    if found["steps_to_settle"] is not None:
        row["settled"] = found["steps_to_settle"] * found["milliseconds_per_step"]
    notes = []
    if found["timed_out"]:
        notes.append("timed out after %d steps" % found["steps"])
    if found["diverged"]:
        notes.append("diverged")
    if found["silent_fallbacks"]:
        notes.append("fell back to sequential impulse %d times" % found["silent_fallbacks"])
    if found["joints_left_out"]:
        notes.append("%d joints that close loops are left out" % found["joints_left_out"])
    if found["steps_to_settle"] is None:
        notes.append("still moves")
    row["note"] = "; ".join(notes)
    return row


def label(row):
    """In a figure: what was stopped before its time is said."""
    return row["method"].replace("sequential impulse", "SI") + (", stopped" if "timed out" in (row.get("note") or "") else "")


def nearness(size, rows):
    """Lines that say how near the sags come to what was seen before."""
    lines, worst = [], 0.0
    for row in rows:
        seen = PUBLISHED.get(size, {}).get(row["method"])
        if seen is None or row.get("sag") is None or row["method"] not in MUST_COME_NEAR or row["precision"] != "double":
            continue
        worst = max(worst, abs(row["sag"] / seen - 1))
    if worst:
        lines.append("%s: sags at 10 to 200 iterations come within %.1f %% of those seen before (asked: %.0f %%)" % (size, 100 * worst, 100 * NEAR))
    for line in lines:
        print("bench: " + line)
    return lines


def progress(context, size, done, count, method, precision, seconds):
    output.progress(context, "%s, %d of %d: %s, %s (%.1f s)" % (size, done, count, method, precision, seconds))
