#!/usr/bin/env python3
"""Runs `topple study`: the same bytes of journal whatever computes the samples, also after it was killed; failed samples are told
and the study goes on; wrong files are refused with one line that names the place.

usage: check.py TOPPLE [MPIRUN]
"""
import csv
import fcntl
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

topple = sys.argv[1]
models = pathlib.Path(__file__).resolve().parents[2] / "models"
failures = []


def expect(holds, what):
    if not holds:
        failures.append(what)


def run(*arguments, **options):
    return subprocess.run([topple, "study", *map(str, arguments)], capture_output=True, text=True, **options)


def journal(folder):
    """Lines in the order of their samples."""
    lines = (pathlib.Path(folder) / "journal.jsonl").read_text().splitlines()
    return sorted(lines, key=lambda line: json.loads(line)["sample"])


# A third of the samples fails: a projectile of a negative mass is refused.
# What stands is at rest: a sample takes a hundredth of a second.
hits = {"topple": 1, "samples": 24, "seed": 7, "vary": [
    {"at": "/events/0/projectile/from/1", "uniform": [-0.1, 0.1], "add": True, "name": "aim"},
    {"at": "/events/0/projectile/mass", "uniform": [-400, 800], "name": "mass"},
    {"joints": "posts", "each": True, "strength": {"normal": {"mean": 1.0, "sd": 0.1, "low": 0.5}}}],
    "record": {"down": "summary:/counts/members_down", "hit": "members_down", "rest": "time_to_rest"}}

with tempfile.TemporaryDirectory() as folder:
    place = pathlib.Path(folder)
    still = json.loads((models / "scenarios/house_hit.json").read_text())
    still.update(standing="static", model=str(models / "house.json"))
    (place / "house_hit.json").write_text(json.dumps(still))
    hits["base"] = {"scenario": str(place / "house_hit.json")}
    study = place / "hits.json"
    study.write_text(json.dumps(hits))
    done = run(study, "-o", place / "one", "--threads", 1)
    expect(done.returncode == 0, f"a study ends with {done.returncode}: {done.stderr}")
    lines = journal(place / "one")
    samples = [json.loads(line) for line in lines]
    expect([s["sample"] for s in samples] == list(range(24)), "samples are missing")
    failed = [s for s in samples if "failed" in s]
    expect(3 < len(failed) < 14, f"{len(failed)} failed samples")
    for sample in samples:
        expect((sample["inputs"]["mass"] <= 0) == ("failed" in sample), f"sample {sample['sample']}: mass and failure")
        if "failed" in sample:
            expect("events[0].projectile.mass" in sample["failed"] and "accepted" in sample["failed"], sample["failed"])
        else:
            expect(sample["outputs"]["down"] == sample["outputs"]["hit"], "the path and the ready output differ")
    rows = list(csv.DictReader((place / "one" / "samples.csv").open()))
    expect(len(rows) == 24 and all(float(r["mass"]) == s["inputs"]["mass"] for r, s in zip(rows, samples)), "samples.csv")
    times = list(csv.DictReader((place / "one" / "times.csv").open()))
    expect(len(times) == 24 and all(float(t["seconds"]) >= 0 for t in times), "times.csv")

    # One sample as `topple demolish` has it: the same scenario written out by hand.
    sample = next(s for s in samples if "failed" not in s)
    event = {"from": [-20, sample["inputs"]["aim"], 2], "velocity": [60, 0, 0], "mass": sample["inputs"]["mass"], "radius": 0.4}
    model = json.loads((pathlib.Path(__file__).parents[2] / "models" / "house.json").read_text())
    model["joint_changes"] = [{"joints": name.removeprefix("strength of posts "), "strength": value}
                              for name, value in sample["inputs"].items() if name.startswith("strength of posts ")]
    (place / "by_hand_model.json").write_text(json.dumps(model))
    (place / "by_hand.json").write_text(json.dumps({"topple": 1, "model": "by_hand_model.json", "combination": "collapse", "standing": "static",
                                                    "duration": 60,
                                                    "events": [{"at": 1.0, "projectile": event}]}))
    by_hand = subprocess.run([topple, "demolish", place / "by_hand.json", "-o", place / "by_hand"], capture_output=True, text=True)
    expect(by_hand.returncode == 0, f"the scenario by hand: {by_hand.stderr}")
    summary = json.loads((place / "by_hand" / "summary.json").read_text())
    expect(summary["counts"]["members_down"] == sample["outputs"]["down"] and summary["simulated_seconds"] == sample["outputs"]["rest"],
           f"sample {sample['sample']} is not what demolish has: {summary['counts']} {sample['outputs']}")

    done = run(study, "-o", place / "two", "--threads", 2)
    expect(journal(place / "two") == lines, "two threads give another journal")
    for part in ("0:7", "20:", "7:20"):
        done = run(study, "-o", place / "slices", "--samples", part, "--resume")
        expect(done.returncode == 0, f"--samples {part}: {done.stderr}")
    expect(journal(place / "slices") == lines, "slices give another journal")
    expect(run(study, "-o", place / "one").returncode == 2, "a journal is written over")

    # Killed in the middle, and gone on with; a line cut in the middle as well.
    for kill, expected in ((signal.SIGKILL, -signal.SIGKILL), (signal.SIGINT, 1)):
        out = place / f"killed{kill}"
        longer = place / f"longer{kill}.json"
        longer.write_text(json.dumps({**hits, "samples": 120}))
        process = subprocess.Popen([topple, "study", str(longer), "-o", str(out), "--threads", "2"], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        for _ in range(600):
            if (out / "journal.jsonl").exists() and (out / "journal.jsonl").read_text().count("\n") >= 30:
                break
            time.sleep(0.02)
        process.send_signal(kill)
        status = process.wait()
        found = (out / "journal.jsonl").read_text()
        expect(status == expected or found.count("\n") == 120, f"signal {kill}: status {status}")
        if kill == signal.SIGKILL:
            (out / "journal.jsonl").write_text(found[:-40])
        # At once: what the killed run left behind neither holds its folder nor writes to it.
        resumed = run(longer, "-o", out, "--resume")
        expect(resumed.returncode == 0, f"a killed study does not go on: {resumed.stderr}")
        if resumed.returncode != 0:
            continue
        expect(len(journal(out)) == 120, "a resumed study lacks samples")
    if not failures:
        expect(journal(place / f"killed{signal.SIGKILL}") == journal(place / f"killed{signal.SIGINT}"), "a killed study has another journal")
    expect("another study" in run(study, "-o", place / f"killed{signal.SIGKILL}", "--resume").stderr, "a foreign journal is taken")

    # A killed run's workers are in the middle of a long sample, and yet hold nothing that the next run needs.
    slow = place / "slow.json"
    slow.write_text(json.dumps({"topple": 1, "base": {"scenario": "seed_hit"}, "samples": 4, "record": {"down": "members_down"},
                                "vary": [{"at": "/events/0/projectile/from/1", "uniform": [-0.01, 0.01], "add": True}]}))
    process = subprocess.Popen([topple, "study", str(slow), "-o", str(place / "slow"), "--threads", "2"], stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL)
    children = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children")
    workers = []
    for _ in range(600):
        workers = children.read_text().split()
        if len(workers) == 2:
            break
        time.sleep(0.02)
    time.sleep(0.1)
    process.kill()
    process.wait()
    folder_file = os.open(place / "slow", os.O_RDONLY)
    try:
        fcntl.flock(folder_file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        expect(False, "workers of a killed study hold its folder")
    os.close(folder_file)
    expect(len(workers) == 2, f"{len(workers)} workers")
    time.sleep(0.3)
    expect(not any(pathlib.Path(f"/proc/{worker}/environ").exists() and
                   "topple" in pathlib.Path(f"/proc/{worker}/cmdline").read_text() for worker in workers),
           "workers of a killed study go on")

    # Samples that failed are done; they are run once more where that is asked for, and fail again.
    count = len((place / "one" / "journal.jsonl").read_text().splitlines())
    expect(run(study, "-o", place / "one", "--resume").returncode == 0, "resuming what is done")
    expect(len((place / "one" / "journal.jsonl").read_text().splitlines()) == count, "a failed sample was run again unasked")
    expect(run(study, "-o", place / "one", "--retry-failed").returncode == 0, "--retry-failed")
    expect(len((place / "one" / "journal.jsonl").read_text().splitlines()) == count + len(failed), "--retry-failed runs what failed")
    expect(sorted(set((place / "one" / "journal.jsonl").read_text().splitlines())) == sorted(lines), "failed samples fail alike")

    # Nothing is run: a plan of inputs.
    plan = place / "plan.json"
    plan.write_text(json.dumps({"topple": 1, "base": None, "samples": 16, "sampling": "sobol", "vary": [{"at": "x", "uniform": [0, 1]}]}))
    expect(run(plan, "-o", place / "plan").returncode == 0, "a plan of inputs")
    xs = sorted(float(row["x"]) for row in csv.DictReader((place / "plan" / "samples.csv").open()))
    expect(all(i / 16 <= x < (i + 1) / 16 for i, x in enumerate(xs)), "sixteen Sobol points, one in each sixteenth")

    # An analysis: the deflection under a load is proportional to 1 / E.
    beam = {"topple": 1, "materials": {"m": {"youngs_modulus": 2e11, "poisson_ratio": 0.3}},
            "sections": {"s": {"area": 0.01, "Iy": 1e-4, "Iz": 1e-4, "J": 1e-4}}, "nodes": {"A": [0, 0, 0], "B": [3, 0, 0]},
            "members": {"AB": {"nodes": ["A", "B"], "section": "s", "material": "m"}}, "supports": {"A": "fixed"},
            "loads": {"tip": {"nodes": {"B": {"z": -1000}}}}}
    (place / "beam.json").write_text(json.dumps(beam))
    sweep = place / "sweep.json"
    sweep.write_text(json.dumps({"topple": 1, "base": {"model": "beam.json"}, "vary": [
        {"at": "/materials/m/youngs_modulus", "grid": [1, 0.5, 0.25], "times": True, "name": "E"},
        {"at": "/loads/tip/nodes/B/z", "grid": [-1000, -3000], "name": "P"}],
        "record": {"tip": "results:/combinations/tip/displacements/B/2", "most": "largest_displacement"}}))
    expect(run(sweep, "-o", place / "sweep").returncode == 0, "a sweep over grids")
    for row in csv.DictReader((place / "sweep" / "samples.csv").open()):
        exact = float(row["P"]) * 27 / (3 * 2e11 * float(row["E"]) * 1e-4)
        expect(abs(float(row["tip"]) - exact) < 1e-12 * abs(exact) and abs(float(row["most"]) + exact) < 1e-12 * abs(exact), f"{row} {exact}")

    # Optimised: the least weight of a cantilever that bends by 5 mm at most. With a square section of side b the answer is in closed form.
    side = (1000 * 27 * 12 / (3 * 2e11 * 0.005)) ** 0.25
    square = {**beam, "sections": {"s": {"shape": "rectangle", "depth": 0.1, "width": 0.1, "shear_deformation": False}}}
    square["materials"]["m"]["density"] = 7850
    (place / "square.json").write_text(json.dumps(square))

    def optimised(name, **keys):
        value = {"topple": 1, "base": {"model": "square.json"}, "seed": 3, "record": {"kg": "weight", "tip": "largest_displacement"},
                 "optimise": {"least": "kg", "subject_to": {"tip": {"below": 0.005}}, "unseen": 0, **keys}}
        (place / f"{name}.json").write_text(json.dumps(value))
        done = run(place / f"{name}.json", "-o", place / name)
        expect(done.returncode == 0, f"{name}: {done.stderr}")
        return json.loads((place / name / "study.json").read_text())["optimise"] if done.returncode == 0 else None

    sides = [{"at": f"/sections/s/{key}", "name": key, "uniform": [0.02, 0.2]} for key in ("depth", "width")]
    best = optimised("cobyla", runs=200, choose=sides)["best"]
    # Least weight: as narrow and deep as the bounds allow. I = w d^3 / 12 with w = 0.02.
    deep = (12 * 1000 * 27 / (3 * 2e11 * 0.005) / 0.02) ** (1 / 3)
    expect(abs(best["outputs"]["kg"] / (7850 * 3 * 0.02 * deep) - 1) < 1e-3 and best["outputs"]["tip"] < 0.005 * (1 + 1e-6), f"COBYLA: {best} {deep}")
    best = optimised("isres", runs=1500, method="isres", choose=sides)["best"]
    expect(best["feasible"] and best["outputs"]["kg"] < 7850 * 3 * 0.02 * deep * 1.1, f"ISRES: {best} {deep}")
    lists = [{"at": f"/sections/s/{key}", "name": key, "choice": [0.02 + 0.01 * i for i in range(19)]} for key in ("depth", "width")]
    allowed = [w * d for w in lists[0]["choice"] for d in lists[0]["choice"] if 1000 * 27 / (3 * 2e11 * w * d ** 3 / 12) < 0.005]
    best = optimised("entropy", runs=250, choose=lists)["best"]
    expect(best["feasible"] and abs(best["outputs"]["kg"] / (7850 * 3 * min(allowed)) - 1) < 1e-9, f"cross-entropy: {best} {min(allowed) * 23550}")
    whole = journal(place / "entropy")
    out = place / "entropy_again"
    done = run(place / "entropy.json", "-o", out, "--threads", 1)
    (out / "journal.jsonl").write_text("\n".join((out / "journal.jsonl").read_text().splitlines()[:100]) + "\n")
    done = run(place / "entropy.json", "-o", out, "--resume", "--html")
    expect(journal(out) == whole and "Chosen" in (out / "study.html").read_text(), "a resumed optimisation goes another way")

    # Finalists: the best designs of the search, each once, judged by all their samples; the answer is the best of these.
    noisy = {"topple": 1, "base": {"model": "square.json"}, "seed": 5, "record": {"tip": "largest_displacement"},
             "vary": [{"at": "/sections/s/width", "name": "wrong", "normal": {"mean": 1, "sd": 0.3, "low": 0.3, "high": 2}, "times": True}],
             "optimise": {"least": "tip", "runs": 12, "repeats": 2, "finalists": {"designs": 3, "repeats": 4}, "unseen": 5,
                          "choose": [{"at": "/sections/s/depth", "name": "depth", "choice": [0.1, 0.11, 0.12, 0.13, 0.14]}]}}
    (place / "noisy.json").write_text(json.dumps(noisy))
    done = run(place / "noisy.json", "-o", place / "noisy", "--html")
    expect(done.returncode == 0, f"finalists: {done.stderr}")
    answer = json.loads((place / "noisy" / "study.json").read_text())["optimise"]
    samples = {s["sample"]: s for s in map(json.loads, journal(place / "noisy"))}
    expect(sorted(samples) == list(range(12 * 2 + 3 * 4 + 5)), f"samples of finalists: {sorted(samples)}")
    means = {}
    for f, one in enumerate(sorted(answer["finalists"], key=lambda d: min(k for k in range(24, 36) if samples[k]["inputs"]["depth"] == d["inputs"]["depth"]))):
        own = [samples[k] for k in (2 * one["run"], 2 * one["run"] + 1, *range(24 + 4 * f, 28 + 4 * f))]
        expect(len({s["inputs"]["depth"] for s in own}) == 1 and len({s["inputs"]["wrong"] for s in own}) == 6, f"samples of finalist {f}: {own}")
        means[one["run"]] = sum(s["outputs"]["tip"] for s in own) / 6
        expect(abs(one["outputs"]["tip"] / means[one["run"]] - 1) < 1e-12, f"mean of finalist {f}")
    expect(answer["best"]["run"] == min(means, key=means.get) == answer["finalists"][0]["run"], f"the answer among finalists: {answer}")
    expect(len({d["inputs"]["depth"] for d in answer["finalists"]}) == 3 and answer["best"]["inputs"]["depth"] == 0.14, f"finalists: {answer['finalists']}")
    expect(not {samples[k]["inputs"]["wrong"] for k in range(36)} & {samples[k]["inputs"]["wrong"] for k in range(36, 41)}, "unseen samples were seen")
    expect("tried again" in (place / "noisy" / "study.html").read_text(), "the page does not tell of finalists")

    if len(sys.argv) > 2:
        mpirun = [sys.argv[2], "--allow-run-as-root", "--oversubscribe", "--bind-to", "none"]
        for ranks in (1, 2, 3):
            done = subprocess.run([*mpirun, "-n", str(ranks), topple, "study", str(study), "-o", str(place / f"ranks{ranks}")],
                                  capture_output=True, text=True)
            expect(done.returncode == 0, f"{ranks} ranks end with {done.returncode}: {done.stderr}")
            expect(journal(place / f"ranks{ranks}") == lines, f"{ranks} ranks give another journal")
        # Losses: a factor of its own for each rank, which answers whatever losses come to it.
        losses = place / "losses.json"
        losses.write_text(json.dumps({"topple": 1, "base": {"model": "la3"}, "vary": [{"lose_each": "posts"}],
                                      "record": {"worst": "worst_loss_use", "survived": "losses_survived"}}))
        expect(run(losses, "-o", place / "losses1", "--threads", 1).returncode == 0, "losses as samples")
        expect(run(losses, "-o", place / "losses2", "--threads", 2).returncode == 0, "losses on two threads")
        lost = journal(place / "losses1")
        expect(len(lost) == 105 and len({json.loads(line)["inputs"]["lost"] for line in lost}) == 105, f"{len(lost)} losses")
        expect(journal(place / "losses2") == lost, "losses on two threads give another journal")
        for ranks in (2, 3):
            done = subprocess.run([*mpirun, "-n", str(ranks), topple, "study", str(losses), "-o", str(place / f"losses_of{ranks}")],
                                  capture_output=True, text=True)
            expect(done.returncode == 0 and journal(place / f"losses_of{ranks}") == lost, f"losses on {ranks} ranks give another journal")
        # A rank dies: the journal is whole, and what is missing is made by one process.
        longer, out = place / "longer9.json", place / "rank_dies"
        job = subprocess.Popen([*mpirun, "-n", "3", topple, "study", str(longer), "-o", str(out)], stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL, start_new_session=True)
        for _ in range(1500):
            if (out / "journal.jsonl").exists() and (out / "journal.jsonl").read_text().count("\n") >= 20:
                break
            time.sleep(0.02)
        children = [int(p) for p in subprocess.run(["ps", "-o", "pid=", "--ppid", str(job.pid)], capture_output=True, text=True).stdout.split()]
        if len(children) == 3:
            os.kill(children[2], signal.SIGKILL)
        expect(len(children) == 3 and job.wait(timeout=120) != 0, f"a dead rank does not end the job: {children}")
        expect(run(longer, "-o", out, "--resume").returncode == 0, "a study does not go on after a rank has died")
        here, there = journal(out), journal(place / f"killed{signal.SIGKILL}")
        differ = [(a[:60], b[:60]) for a, b in zip(here, there) if a != b][:2]
        expect(here == there, f"after a rank has died the journal is another: {len(here)} lines, {len(there)}, {differ}")
        wrong = place / "wrong.json"
        wrong.write_text(json.dumps({**hits, "record": {"down": "down"}}))
        done = subprocess.run([*mpirun, "-n", "2", topple, "study", str(wrong), "-o", str(place / "none")], capture_output=True, text=True)
        expect(done.returncode == 2 and done.stderr.count("record.down") == 1, f"a wrong study on ranks: {done.returncode} {done.stderr}")

    def varied(**entry):
        return {**hits, "vary": [entry]}

    wrong = {
        "base": ({**hits, "base": {}}, "base: found an object"), "nothing varies": ({**hits, "vary": []}, "vary:"),
        "scenario": ({**hits, "base": {"scenario": "no_such"}}, "base.scenario: no_such"),
        "pointer": (varied(at="/events/0/projectile/weight/1", uniform=[0, 1]), "vary[0].at: house_hit.json has no \"weight\""),
        "model pointer": (varied(at="model:/materials/S999/density", uniform=[0, 1]), "vary[0].at: house.json has no \"S999\""),
        "no number": (varied(at="/title", uniform=[0, 1], add=True), "vary[0].at: \"House, a corner post hit\""),
        "two distributions": (varied(at="/duration", uniform=[0, 1], normal={"mean": 1, "sd": 1}), "vary[0]: two distributions"),
        "turned": (varied(at="/duration", uniform=[1, 0]), "vary[0].uniform: found an array of 2"),
        "no spread": (varied(at="/duration", normal={"mean": 1}), "vary[0].normal: found an object"),
        "lognormal": (varied(at="/duration", lognormal={"mean": -1, "sd": 1}), "vary[0].lognormal.mean: found -1"),
        "joints": (varied(joints="columns", strength={"uniform": [0.9, 1.1]}), "vary[0].joints: "),
        "members": (varied(lose_each="no"), "vary[0].lose_each: there is no member or group \"no\""),
        "output": ({**hits, "record": {"down": "down"}}, "record.down: found \"down\""),
        "output of an analysis": ({**hits, "record": {"w": "worst_loss_use"}}, "record.w: worst_loss_use"),
        "collapse": ({**hits, "collapse_if": {"dwn": {"above": 1}}}, "collapse_if.dwn: there is no output \"dwn\""),
        "fragility": ({**hits, "collapse_if": {"down": {"above": 1}}, "fragility": "speed"}, "fragility: there is no entry \"speed\""),
        "groups": ({**hits, "groups": [{"of": ["aim", "mass"], "correlation": [[1, 0.5], [0.4, 1]]}]}, "groups[0].correlation: it is no"),
        "definite": ({**hits, "groups": [{"of": ["aim", "mass"], "correlation": 1}]}, "not positive definite"),
        "samples": ({**hits, "samples": 0}, "samples: found 0"), "key": ({**hits, "sample": 1}, "sample: unknown key"),
        "weights": (varied(at="/duration", choice=[1, 2], weights=[1]), "vary[0].weights: found an array of 1"),
    }
    file = place / "wrong.json"
    for what, (value, named) in wrong.items():
        file.write_text(json.dumps(value))
        done = run(file, "-o", place / "none")
        expect(done.returncode == 2 and done.stderr.count("\n") == 1, f"{what}: {done.returncode} {done.stderr}")
        expect("wrong.json" in done.stderr and named in done.stderr, f"{what}: {done.stderr}")
    expect(not (place / "none" / "journal.jsonl").exists(), "something was written for a wrong study")
    checked = subprocess.run([topple, "check", str(study)], capture_output=True, text=True)
    expect(checked.returncode == 0 and "24 samples of" in checked.stdout, f"topple check: {checked.stdout} {checked.stderr}")

for failure in failures[:30]:
    print(failure)
print(f"{len(failures)} failures")
sys.exit(1 if failures else 0)
