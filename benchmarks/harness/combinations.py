"""What ten load combinations cost beside one: the whole process of `topple analyse`, and its solve stage."""

import json
import os
import statistics

import output
import peers

COLUMNS = [("frame", "posts x storeys"), ("combinations", "combinations"), ("runs", "runs"), ("median", "median s"), ("low", "lower quartile"), ("high", "upper quartile"), ("least", "least s"),
           ("processor", "processor s"), ("solve", "solve stage s"), ("memory", "peak MiB")]
SOLVE_ASKED, WHOLE_ASKED = 3.0, 1.5


def write_models(frame, folder):
    """one.json and ten.json: dead and live load with wind from each side, or without live load and wind; one of them alone."""
    peers.write_topple(frame, os.path.join(folder, "base.json"))
    with open(os.path.join(folder, "base.json"), encoding="utf-8") as stored:
        model = json.load(stored)
    floors = model["loads"]["case"]["members"]
    nx, ny = (int(part) for part in frame.name.split("x")[:2])
    level = lambda k: range(k * nx * ny, (k + 1) * nx * ny)
    levels = range(1, len(frame.nodes) // (nx * ny))
    side_x = ["n%d" % (n + 1) for k in levels for n in level(k) if n % nx == 0]
    side_y = ["n%d" % (n + 1) for k in levels for n in level(k) if n % (nx * ny) < nx]
    model["loads"] = {"dead": {"self_weight": 1}, "live": {"members": floors}, "wind x": {"nodes": {name: {"x": 1e4} for name in side_x}},
                      "wind y": {"nodes": {name: {"y": 1e4} for name in side_y}}}
    combinations = {}
    for dead, live in ((1.35, 1.5), (1.0, 0.0)):
        for x, y in ((0, 0), (1.5, 0), (-1.5, 0), (0, 1.5), (0, -1.5)):
            combinations["c%d" % (len(combinations) + 1)] = {"dead": dead, "live": live, "wind x": x, "wind y": y}
    for name, chosen in (("one", ["c2"]), ("ten", list(combinations))):
        model["combinations"] = {combination: combinations[combination] for combination in chosen}
        with open(os.path.join(folder, name + ".json"), "w", encoding="utf-8") as out:
            json.dump(model, out)


def solve_seconds(folder):
    """From the last line of results.json: the whole of it would weigh on what is measured next."""
    with open(os.path.join(folder, "out", "results.json"), "rb") as stored:
        stored.seek(-2000, os.SEEK_END)
        line = stored.read().decode().strip().splitlines()[-1]
    return json.loads("{" + line.lstrip(","))["seconds"]["solve"]


def run(context):
    rows, lines = [], []
    for nx, ny, storeys, runs in ((6, 6, 30, 7), (10, 10, 40, 5)):
        frame = peers.Frame(nx, ny, storeys)
        folder = os.path.join(context.results, "combinations", frame.name)
        os.makedirs(folder)
        write_models(frame, folder)
        figures = {name: [] for name in ("one", "ten")}
        for _ in range(3 if context.quick else runs):  # in turn, so that what else the machine does meets both
            for name in figures:
                command = [os.path.join(context.programs, "topple"), "analyse", name + ".json", "-o", "out"]
                seconds, work, peak = peers.measured(command, folder, dict(os.environ))
                figures[name].append((seconds, work, solve_seconds(folder), peak))
        for name, measured in figures.items():
            seconds, work, solve, peak = zip(*measured)
            low, high = output.quartiles(seconds)
            rows.append({"frame": frame.name, "combinations": {"one": 1, "ten": 10}[name], "runs": len(measured),
                         "median": statistics.median(seconds), "low": low, "high": high, "least": min(seconds), "processor": statistics.median(work),
                         "solve": statistics.median(solve), "memory": max(peak)})
        for what, place, asked in (("the whole process", 0, WHOLE_ASKED), ("the processor time", 1, None), ("the solve stage", 2, SOLVE_ASKED)):
            ratios = sorted(ten[place] / one[place] for one, ten in zip(figures["one"], figures["ten"]))
            lines.append("%s: ten combinations take %.2f times %s of one%s (median of %d pairs; %.2f to %.2f)"
                         % (frame.name, statistics.median(ratios), what, "" if asked is None else ", asked: under %g" % asked, len(ratios),
                            ratios[0], ratios[-1]))
            print("bench: " + lines[-1])
    output.print_table(rows, COLUMNS)
    output.write_results(context, "combinations", rows, COLUMNS, ("frame", "combinations"), lines)
    return [("Ten combinations beside one", "Whole runs of topple analyse, from the file read to results.json written, in turn.", [],
             (rows, COLUMNS))]
