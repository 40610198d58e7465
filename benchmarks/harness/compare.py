"""Earlier results against new ones, row by row: what has become slower, or less exact, beyond the noise."""

import glob
import os

import output

NOISE = 1.3  # times of single runs on a shared machine differ by up to this factor
SURE = 1.1  # with quartiles that lie apart, this much is more than noise
WORSE = 10.0  # errors at rounding level move by less

TIMES = ("milliseconds", "median", "processor", "seconds", "settled", "instructions")
ERRORS = ("sag_error", "reaction_error", "error", "backward_error")


def load(folder):
    """Rows by file and keys, of a folder of results or of one file."""
    found = {}
    for path in [folder] if os.path.isfile(folder) else sorted(glob.glob(os.path.join(folder, "*.json"))):
        stored = output.read_results(path)
        if not isinstance(stored, dict) or "keys" not in stored:
            continue
        for row in stored["rows"]:
            found[(stored["name"],) + tuple(str(row.get(key)) for key in stored["keys"])] = row
    if not found:
        raise SystemExit("bench: no results in %s" % folder)
    return found


def slower(old, new, key):
    """Whether a time has grown beyond the noise: quartiles that lie apart, or without them a large factor."""
    if not old.get(key) or not new.get(key):
        return False
    if key == "instructions":
        return new[key] > 1.01 * old[key]
    spread = key == "milliseconds" and all(row.get("low") and row.get("high") for row in (old, new))
    if spread:
        return new["low"] > old["high"] and new[key] > SURE * old[key]
    return new[key] > NOISE * old[key]


def drops(before, after):
    """Lines that name what is worse, and how many figures were compared."""
    lines, compared = [], 0
    for key in sorted(before.keys() & after.keys()):
        old, new = before[key], after[key]
        place = ", ".join(key)
        for name in TIMES:
            compared += 1 if old.get(name) and new.get(name) else 0
            if slower(old, new, name):
                lines.append("slower: %s: %s %.3g, was %.3g" % (place, name, new[name], old[name]))
        for name in ERRORS:
            if old.get(name) is None or new.get(name) is None:
                continue
            compared += 1
            if new[name] > WORSE * max(old[name], 1e-15):
                lines.append("less exact: %s: %s %.1e, was %.1e" % (place, name, new[name], old[name]))
    return lines, compared


def report(before, after):
    """Prints, and returns the lines."""
    lines, compared = drops(before, after)
    for line in lines:
        print("bench: " + line)
    missing = len(before.keys() - after.keys())
    print("bench: of %d figures in both runs %d are worse beyond the noise; %d rows are in the earlier run alone" % (compared, len(lines), missing))
    return lines
