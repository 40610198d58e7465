"""Whether the outcome of a collapse hangs on the length of the step, or on the substeps in it: distributions over inputs that are moved a
little, the same ones at every length."""

import concurrent.futures
import json
import math
import os
import random
import re
import statistics
import subprocess
import types

import output
import scatter

# Scenario, samples, samples of a quick run.
# Of the hits with a mass in their names some bring all down and some do not: there the test has power.
SCENARIOS = [("seed_hit", 128, 12), ("seed_hit_500", 128, 12), ("tower_hit", 128, 12), ("tower_hit_2000", 128, 12), ("house_hit", 128, 12), ("house_hit_40", 128, 12),
             ("bridge_hit", 128, 12), ("tower_fire", 12, 2)]
RATE = 60  # steps a second, unless a scenario says otherwise
# What is made finer, and which two of its values are compared. The default has 8 substeps of 1/480 s at 60 steps a second.
STEPS = types.SimpleNamespace(name="steps", title="steps a second", values=[30, 60, 120, 240, 480], coarse=60, fine=240, says="%d steps a second")
SUBSTEPS = types.SimpleNamespace(name="substeps", title="substeps of 1/60 s", values=[4, 8, 16, 32], coarse=8, fine=32, says="%d substeps of 1/60 s")
ASKED_SHARE, ASKED_TIME, ASKED_P = 0.12, 0.10, 0.01
RESAMPLES = 4000

OUTCOMES = [("samples", "samples"), ("share", "share of members down"), ("share_error", "standard error"),
           ("half", "half of them down, s"), ("half_error", "standard error"), ("joints", "joints broken"), ("joints_error", "standard error"),
           ("rest", "at rest, s"), ("failed", "runs that failed")]



def columns(finer):
    return [("scenario", "scenario"), ("value", finer.title)] + OUTCOMES


TEXT = ("Each sample moves the projectile's line sideways by up to %g m and up or down by up to %g m (or scatters the strength that a fire leaves by a fiftieth); the same samples are run with each "
        "number of %s. Who falls on whom hangs on the last bit, so that single runs cannot agree: what is compared is the distribution. The 90 %% interval of the difference of mean shares between "
        "%d and %d is by bootstrap over inputs; the permutation test exchanges the two within each input and takes the largest standardised difference over all scenarios and both quantities.")


def members_of(context, scenario):
    with open(scatter.path_of(context.root, scenario), encoding="utf-8") as stored:
        model = json.load(stored)["model"]
    told = subprocess.run([os.path.join(context.programs, "topple"), "check", os.path.join(context.root, "models", model + ".json")], capture_output=True, text=True, check=True).stdout
    return int(re.search(r"(\d+) members", told).group(1))


def half_down(events, down):
    """When the half of the members that are down at the end had left, s; None when none are."""
    if down == 0:
        return None
    left = 0
    for event in events:
        if event["kind"] == "detached":
            left += len(event.get("members", []))
            if 2 * left >= down:
                return event["time"]
    return None


def write_scenario(context, path, scenario, rate, sample, seed, substeps=None):
    """The input of one run: its scatter, so many steps a second, and so many substeps in each (none: as by default)."""
    content = scatter.moved(context.root, scenario, seed, sample)
    content["step"] = 1.0 / rate
    if substeps is not None:
        content["dynamics"] = {**content.get("dynamics", {}), "substeps": substeps}
    content["model"] = os.path.join(context.root, "models", content["model"] + ".json")
    with open(path, "w", encoding="utf-8") as out:
        json.dump(content, out)


def run_one(context, finer, scenario, value, sample, seed):
    """One collapse: what came of it, or why it failed."""
    name = "%s-%s-%d-%d" % (scenario, finer.name, value, sample)
    folder = os.path.join(context.results, "convergence", name)
    os.makedirs(folder)
    path = os.path.join(folder, "scenario.json")
    rate, substeps = (value, None) if finer is STEPS else (RATE, value)
    write_scenario(context, path, scenario, rate, sample, seed, substeps)
    done = subprocess.run([os.path.join(context.programs, "topple"), "demolish", path, "-o", folder], capture_output=True, text=True)
    if done.returncode != 0:
        return {"failed": done.stderr.strip()[-300:]}
    with open(os.path.join(folder, "summary.json"), encoding="utf-8") as stored:
        summary = json.load(stored)
    with open(os.path.join(folder, "events.jsonl"), encoding="utf-8") as stored:
        events = [json.loads(line) for line in stored]
    counts = summary["counts"]
    for left in ("events.jsonl", "standing.json"):
        os.remove(os.path.join(folder, left))
    return {"down": counts["members_down"], "joints": counts["joints_broken"], "rest": summary["simulated_seconds"] if summary["at_rest"] else None,
            "half": half_down(events, counts["members_down"]), "residual": abs(summary["ledger"]["energy"]["residual"])}


def run_all(context, run, jobs, seed):
    """By job, what run(context, *job, seed) returned; as many at a time as there are processors."""
    found = {}
    with concurrent.futures.ThreadPoolExecutor(max_workers=os.cpu_count() or 1) as pool:
        started = {pool.submit(run, context, *job, seed): job for job in jobs}
        for number, one in enumerate(concurrent.futures.as_completed(started)):
            found[started[one]] = one.result()
            if number % 50 == 0:
                output.progress(context, "%d of %d collapses" % (number + 1, len(jobs)))
    return found


def mean_and_error(values):
    values = [value for value in values if value is not None]
    if not values:
        return None, None
    return statistics.fmean(values), statistics.stdev(values) / math.sqrt(len(values)) if len(values) > 1 else None


def bootstrap_interval(differences, draw):
    """Of the mean, 90 %."""
    means = sorted(statistics.fmean(draw.choices(differences, k=len(differences))) for _ in range(RESAMPLES))
    return means[int(0.05 * RESAMPLES)], means[int(0.95 * RESAMPLES) - 1]


def standardised(differences):
    spread = math.sqrt(sum(value * value for value in differences))
    return abs(sum(differences)) / spread if spread > 0 else 0.0


def permutation_p(groups, draw):
    """groups: differences by input, each list one quantity of one scenario. Two-sided, over all of them at once."""
    groups = [group for group in groups if any(group)]
    if not groups:
        return 1.0
    seen = max(standardised(group) for group in groups)
    as_large = sum(max(standardised([value if draw.random() < 0.5 else -value for value in group]) for group in groups) >= seen * (1 - 1e-12)
                   for _ in range(RESAMPLES))
    return (as_large + 1) / (RESAMPLES + 1)


def rows_of(scenario, members, found, values, samples):
    rows = []
    for value in values:
        runs = [found[(scenario, value, sample)] for sample in range(samples)]
        good = [run for run in runs if "failed" not in run]
        row = {"scenario": scenario, "value": value, "samples": samples, "failed": len(runs) - len(good)}
        row["share"], row["share_error"] = mean_and_error([run["down"] / members for run in good])
        for key in ("half", "joints", "rest"):
            row[key], row[key + "_error"] = mean_and_error([run[key] for run in good])
        rows.append(row)
    return rows


def both_runs(finer, scenario, found, samples):
    """Of each input, the two runs that are compared."""
    return [(found[(scenario, finer.coarse, k)], found[(scenario, finer.fine, k)]) for k in range(samples)]


def members_down(finer, scenario, found, samples):
    return [(a["down"], b["down"]) for a, b in both_runs(finer, scenario, found, samples) if "down" in a and "down" in b]


def collapses(finer, scenario, members, found, samples):
    """When half was down, of the inputs with which more than half of the members come down in both: else the share of those that
    do would be in it a second time."""
    return [(a["half"], b["half"]) for a, b in both_runs(finer, scenario, found, samples) if 2 * min(a.get("down", 0), b.get("down", 0)) > members]


def as_told(finer, time):
    """s: events carry the time at which their step begins. Of what happens at one instant, longer steps tell an earlier time."""
    return math.floor(time * finer.coarse + 1e-6) / finer.coarse if finer is STEPS else time


def judge(context, finer, names, members, found, counts, draw):
    """What is asked of every scenario, in words; what is not as it must be goes to context.broken."""
    lines, groups = [], []
    for scenario in names:
        shares = [(a - b) / members[scenario] for a, b in members_down(finer, scenario, found, counts[scenario])]
        times = [(a, as_told(finer, b)) for a, b in collapses(finer, scenario, members[scenario], found, counts[scenario])]
        if not shares:
            context.broken.append("%s: no run to compare" % scenario)
            continue
        low, high = bootstrap_interval(shares, draw)
        line = "%s: mean share down with %s less with %d: %+.3f, 90 %% within %+.3f and %+.3f (asked: +-%g)" % (scenario, finer.says % finer.coarse, finer.fine, statistics.fmean(shares), low, high, ASKED_SHARE)
        worst = None
        if times:
            worst = statistics.fmean(a for a, _ in times) / statistics.fmean(b for _, b in times) - 1
            line += "; half down %+.1f %% (asked: %g %%)" % (100 * worst, 100 * ASKED_TIME)
        lines.append(line)
        if max(-low, high) > ASKED_SHARE or (worst is not None and abs(worst) > ASKED_TIME):
            lines[-1] += ": MISSED"
        groups += [shares, [a - b for a, b in times]]
    p = permutation_p(groups, draw)
    lines.append("permutation test over everything: p = %.3f (asked: above %g)%s" % (p, ASKED_P, "" if p > ASKED_P else ": MISSED"))
    return lines


FIGURE = """set logscale x
unset logscale y
set format y '%g'
set format x '%g'
set ylabel 'share of members down'
set yrange [-0.05:1.05]
set key outside right
"""


def draw_figure(context, finer, rows, names):
    data = {"s%d" % i: [(row["value"], row["share"], row["share_error"] or 0.0) for row in rows if row["scenario"] == name and row["share"] is not None] for i, name in enumerate(names)}
    lines = ", ".join("$s%d using 1:2:3 with yerrorlines title '%s' noenhanced" % (i, name) for i, name in enumerate(names))
    path = output.plot(os.path.join(context.results, result_name(finer) + ".svg"), FIGURE + "set xlabel '%s'\nplot " % finer.title + lines + "\n", data)
    return [path] if path else []


def result_name(finer):
    return "convergence" if finer is STEPS else "convergence_" + finer.name


def run(context):
    finer = SUBSTEPS if context.substeps else STEPS
    seed = context.provenance["commit"]
    names = context.scenarios or [name for name, _, _ in SCENARIOS if not (context.quick and name == "tower_fire")]
    counts = {name: context.samples or (quick if context.quick else whole) for name, whole, quick in SCENARIOS}
    values = finer.values[:-1] if context.quick and finer is STEPS else finer.values
    members = {name: members_of(context, name) for name in names}
    jobs = [(finer, name, value, sample) for name in names for value in values for sample in range(counts[name])]
    found = {job[1:]: outcome for job, outcome in run_all(context, run_one, jobs, seed).items()}
    rows = [row for name in names for row in rows_of(name, members[name], found, values, counts[name])]
    failed = sorted({run["failed"] for run in found.values() if "failed" in run})
    context.broken += ["a run failed: " + why for why in failed]
    lines = judge(context, finer, names, members, found, counts, random.Random(seed))
    residual = max((run["residual"] for run in found.values() if "failed" not in run), default=0.0)
    lines.append("largest residual of the ledger over all runs: %.2g %% (asked: 0.5 %%)" % (100 * residual))
    for line in lines:
        print("bench: " + line)
    output.print_table(rows, columns(finer))
    output.write_results(context, result_name(finer), rows, columns(finer), ("scenario", "value"), lines)
    text = TEXT % (scatter.SIDEWAYS, scatter.UP, finer.title, finer.coarse, finer.fine)
    return [("Outcomes against the number of " + finer.title, text, draw_figure(context, finer, rows, names), (rows, columns(finer)))]
