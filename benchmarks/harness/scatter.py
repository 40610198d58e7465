"""Inputs moved by small random amounts: sample k is a pure function of a seed and k."""

import copy
import hashlib
import json
import os
import struct


def uniform(seed, scenario, sample, which):
    """In [0, 1): the same number for the same four, whatever else is drawn."""
    digest = hashlib.sha256(("%s/%s/%d/%s" % (seed, scenario, sample, which)).encode()).digest()
    return struct.unpack("<Q", digest[:8])[0] / 2.0**64


# By how much a projectile's line is moved: sideways and up, m. Less than half the width of a post.
SIDEWAYS, UP = 0.1, 0.2


def path_of(root, scenario):
    """Of a shipped scenario, or of one that serves the benchmarks alone."""
    shipped = os.path.join(root, "models", "scenarios", scenario + ".json")
    return shipped if os.path.exists(shipped) else os.path.join(root, "benchmarks", "models", "scenarios", scenario + ".json")


def moved(root, scenario, seed, sample):
    """A scenario whose projectiles are moved at random, as a scenario file's content; its model by an absolute path."""
    with open(path_of(root, scenario), encoding="utf-8") as stored:
        content = copy.deepcopy(json.load(stored))
    number = 0
    for event in content.get("events", []):
        projectile = event.get("projectile")
        if projectile is None:
            continue
        x, y = projectile["velocity"][0], projectile["velocity"][1]
        size = (x * x + y * y) ** 0.5 or 1.0
        across = (-y / size, x / size)
        aside = SIDEWAYS * (2 * uniform(seed, scenario, sample, "aside %d" % number) - 1)
        up = UP * (2 * uniform(seed, scenario, sample, "up %d" % number) - 1)
        projectile["from"] = [projectile["from"][0] + aside * across[0], projectile["from"][1] + aside * across[1], projectile["from"][2] + up]
        number += 1
    if number == 0:
        # Nothing flies: the strength that is left is scattered by a fiftieth.
        for event in content.get("events", []):
            if "weaken" in event:
                event["weaken"]["strength"] *= 1 + 0.02 * (2 * uniform(seed, scenario, sample, "strength") - 1)
    return content
