"""Earlier results against new ones, method by method."""

import glob
import os

import output

NOISE = 1.3  # times of single runs on a shared machine differ by up to this factor


def load(folder):
    """Milliseconds a step by file, method and precision."""
    found = {}
    paths = sorted(glob.glob(os.path.join(folder, "*.csv")))
    if not paths:
        raise SystemExit("bench: no results in %s" % folder)
    for path in paths:
        for row in output.read_csv(path):
            if row.get("milliseconds"):
                found[os.path.basename(path), row["method"], row["precision"]] = float(row["milliseconds"])
    return found


def report(before, after):
    slower = [(key, before[key], after[key]) for key in sorted(before.keys() & after.keys()) if after[key] > NOISE * before[key]]
    for (name, method, precision), old, new in slower:
        print("bench: slower: %s, %s, %s: %.3g ms a step, was %.3g" % (name, method, precision, new, old))
    print("bench: %d of %d times are slower than before beyond the noise (factor %.1f)" % (len(slower), len(before.keys() & after.keys()), NOISE))
