"""How much the outcome of a collapse hangs on each constant of docs/constants.md: the same inputs with the constant halved and doubled."""

import json
import os
import random
import statistics
import subprocess

import convergence
import output

SCENARIOS = ["house_hit", "house_hit_40", "tower_hit"]
SAMPLES, QUICK_SAMPLES = 12, 4
FACTORS = [0.5, 2]
RATE = 60

COLUMNS = [("constant", "constant"), ("factor", "times"), ("scenario", "scenario"), ("share", "share of members down"), ("change", "change"),
           ("low", "90 % from"), ("high", "90 % to"), ("half", "half down, change, s"), ("failed", "runs that failed")]

TEXT = ("Each constant of docs/constants.md halved and doubled (whole numbers at least 1), with the same inputs as without: lines of the projectile moved as in the suite convergence. The interval of the "
        "change of the mean share of members down is by bootstrap over inputs. Of so many changes one in ten lies outside of its interval by chance.")


def input_of(context, scenario, sample):
    return os.path.join(context.results, "constants", "%s-%d.json" % (scenario, sample))


def run_one(context, scenario, sample, change, _seed):
    words = [os.path.join(context.programs, "bench_constants"), input_of(context, scenario, sample)] + ([change[0], str(change[1])] if change else [])
    done = subprocess.run(words, capture_output=True, text=True)
    if done.returncode != 0:
        return {"failed": done.stderr.strip()[-300:]}
    return json.loads(done.stdout)


def row_of(change, scenario, runs, before, draw):
    both = [(a, b) for a, b in zip(runs, before) if "failed" not in a and "failed" not in b]
    row = {"constant": change[0], "factor": change[1], "scenario": scenario, "failed": sum("failed" in run for run in runs)}
    if both:
        shares = [a["share"] - b["share"] for a, b in both]
        halves = [a["half"] - b["half"] for a, b in both if a["half"] is not None and b["half"] is not None]
        row["share"] = statistics.fmean(a["share"] for a, _ in both)
        row["change"] = statistics.fmean(shares)
        row["low"], row["high"] = convergence.bootstrap_interval(shares, draw)
        row["half"] = statistics.fmean(halves) if halves else None
    return row


def run(context):
    seed = context.provenance["commit"]
    os.makedirs(os.path.join(context.results, "constants"))
    listed = subprocess.run([os.path.join(context.programs, "bench_constants"), "--list"], capture_output=True, text=True, check=True).stdout
    names = [line.split()[0] for line in listed.splitlines()]
    scenarios = context.scenarios or (SCENARIOS[:2] if context.quick else SCENARIOS)
    samples = context.samples or (QUICK_SAMPLES if context.quick else SAMPLES)
    changes = [None] + [(name, factor) for name in names for factor in FACTORS]
    jobs = [(scenario, sample, change) for change in changes for scenario in scenarios for sample in range(samples)]
    for scenario in scenarios:
        for sample in range(samples):
            convergence.write_scenario(context, input_of(context, scenario, sample), scenario, RATE, sample, seed)
    found = convergence.run_all(context, run_one, jobs, seed)
    draw = random.Random(seed)
    runs = lambda scenario, change: [found[(scenario, sample, change)] for sample in range(samples)]
    rows = [row_of(change, scenario, runs(scenario, change), runs(scenario, None), draw) for change in changes[1:] for scenario in scenarios]
    rows.sort(key=lambda row: -abs(row.get("change", 0)))
    lines = ["%s as they are: mean share down %.3f" % (scenario, statistics.fmean(run["share"] for run in runs(scenario, None) if "failed" not in run)) for scenario in scenarios]
    for row in rows:
        if row["failed"]:
            context.broken.append("%s times %g, %s: %d runs failed" % (row["constant"], row["factor"], row["scenario"], row["failed"]))
        if "change" in row and (row["low"] > 0 or row["high"] < 0):
            lines.append("%s times %g, %s: %+.3f, 90 %% within %+.3f and %+.3f" % (row["constant"], row["factor"], row["scenario"], row["change"], row["low"], row["high"]))
    for line in lines:
        print("bench: " + line)
    output.print_table(rows, COLUMNS)
    output.write_results(context, "constants", rows, COLUMNS, ("constant", "factor", "scenario"), lines)
    return [("Outcomes against constants", TEXT, [], (rows, COLUMNS))]
