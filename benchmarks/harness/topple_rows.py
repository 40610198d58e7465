"""Topple's own ways to an answer on one building, measured once in a run of the benchmarks."""

import json
import os
import subprocess

PUSH = 1e5  # N, downwards on one corner of the roof; half and one and a half of it at alternate steps


def measured(context, model):
    if model not in context.topple_runs:
        with open(model, encoding="utf-8") as stored:
            building = json.load(stored)["building"]
        large = building["storeys"] * building["posts"][0] * building["posts"][1] > 300
        repeats = (60 if large else 200) if context.quick else (200 if large else 2000)
        context.topple_runs[model] = measure(context, model, repeats)
    return context.topple_runs[model]


def measure(context, model, repeats):
    """Like measured(), without looking whether it was measured before."""
    done = subprocess.run([os.path.join(context.programs, "bench_topple"), model, "--repeats", str(repeats), "--push", repr(PUSH)],
                          capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def row(found, situation, way, **more):
    told = found[situation][way]
    result = {"precision": "double", "milliseconds": told["milliseconds"], "low": told["low"], "high": told["high"], "runs": told["runs"],
              "error_bound": told["error_bound"], "note": ""}
    result.update(told["errors"])
    result.update(more)
    return result
