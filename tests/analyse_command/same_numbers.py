#!/usr/bin/env python3
"""same_numbers.py A B: whether two results.json hold the same answers, but for rounding and what the factor's name is.

Both are refined to a backward error of rounding; the condition of these models (1e7) leaves nine digits of what is large.
Names are not compared: of equals in a
symmetric building any may be named. So each number may differ by 1e-8 of the largest of its kind, the numbers under the same key. A mode may have either sign:
signs of modes are taken from their largest component.
"""
import json, sys

SKIP = {"settings", "seconds", "quality", "statistics", "program", "solver", "largest_displacement"}
TOLERANCE = 1e-8


def signed(node):
    """A mode with its largest component positive."""
    numbers = []

    def walk(x):
        if isinstance(x, (int, float)) and not isinstance(x, bool):
            numbers.append(x)
        elif isinstance(x, dict):
            for v in x.values():
                walk(v)
        elif isinstance(x, list):
            for v in x:
                walk(v)
    walk(node)
    return -1 if numbers and max(numbers, key=abs) < 0 else 1


def gather(node, key, path, sign, out):
    if isinstance(node, dict):
        for k, v in sorted(node.items()):  # what comes first of equals is a matter of rounding
            if k in SKIP:
                continue
            gather(v, k, path + [k], signed(v) if k in ("shape", "modes_shape") else sign, out)
    elif isinstance(node, list):
        # An extreme is a value and a place: of equal ones any may be named.
        for i, v in enumerate(node[:1] if key in ("min", "max") else node):
            gather(v, key, path + [str(i)], sign, out)
    elif isinstance(node, (int, float)) and not isinstance(node, bool):
        out.append((key, "/".join(path), node * sign))


first, second = [], []
for name, out in ((sys.argv[1], first), (sys.argv[2], second)):
    with open(name) as file:
        gather(json.load(file), "", [], 1, out)
assert len(first) == len(second), f"{len(first)} values and {len(second)}"
largest = {}
for key, path, value in first:
    largest[key] = max(largest.get(key, 0), abs(value))
wrong = []
for (key, path, a), (_, other, b) in zip(first, second):
    assert path == other, (path, other)
    if not abs(a - b) <= TOLERANCE * largest[key]:  # a NaN is no agreement
        wrong.append(f"{path}: {a} and {b}")
if wrong:
    sys.exit(f"{len(wrong)} of {len(first)} differ:\n" + "\n".join(wrong[:20]))
