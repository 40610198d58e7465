"""What a step takes beside the same moment moved on by Bullet alone, every part a rigid body and every joint a constraint."""

import os
import statistics
import subprocess

import output

COLUMNS = [("scenario", "scenario"), ("time", "at, s"), ("awake", "bodies awake"), ("milliseconds", "ms a step"), ("own", "without the engine"),
           ("parts", "Bullet alone: bodies"), ("joints", "joints"), ("bullet", "ms a step"), ("ratio", "times as long")]
SCENARIO, EVERY, RUNS = "seed_hit", 2.0, 3

TEXT = ("At each moment of a collapse its parts are handed to Bullet as boxes where they are and as fast as they are, those that lie still asleep, the joints that are left as fixed "
        "constraints, and Bullet moves them on for eleven steps with ten iterations of sequential impulse, after one that finds what touches. Parts that are joined do not meet there, which saves "
        "Bullet work. Medians of eleven steps around the moment, of %d runs. What is not shown: at ten iterations a building as it stands there sags by metres (Stiffness), "
        "so that no such moment would come; a heap at ten iterations creeps." % RUNS)


def bullet_alone(context, path):
    """Bodies, joints, and milliseconds of a step."""
    told = subprocess.run([os.path.join(context.programs, "bench_moment"), path], capture_output=True, text=True, check=True).stdout.split()
    return int(told[0]), int(told[1]), float(told[3])


def run(context):
    folder = os.path.join(context.results, "moments")
    os.makedirs(folder)
    found = {}
    for i in range(1 if context.quick else RUNS):
        command = [os.path.join(context.programs, "bench_moments"), SCENARIO, repr(EVERY), folder]
        for line in subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines():
            time, awake, whole, own, path = line.split()
            row = found.setdefault(float(time), {"scenario": SCENARIO, "time": float(time), "awake": int(awake), "wholes": [], "owns": [], "bullets": []})
            row["wholes"].append(float(whole))
            row["owns"].append(float(own))
            row["parts"], row["joints"], bullet = bullet_alone(context, path)
            row["bullets"].append(bullet)
        output.progress(context, "moments of %s, run %d" % (SCENARIO, i + 1))
    rows = [found[time] for time in sorted(found)]
    for row in rows:
        row["milliseconds"], row["own"], row["bullet"] = (statistics.median(row[key]) for key in ("wholes", "owns", "bullets"))
        row["ratio"] = row["bullet"] / row["milliseconds"]
    slower = [row["time"] for row in rows if row["ratio"] < 1]
    lines = ["%s: a step takes fewer milliseconds than Bullet alone at %d of %d moments (asked: all)%s"
             % (SCENARIO, len(rows) - len(slower), len(rows), "; not from %g s on" % slower[0] if slower else "")]
    print("bench: " + lines[0])
    output.print_table(rows, COLUMNS)
    output.write_results(context, "moments", rows, COLUMNS, ("scenario", "time"), lines)
    return [("A collapse beside Bullet alone", TEXT, [], (rows, COLUMNS))]
