"""Earlier results against new ones, row by row: what has become slower, or less exact, beyond the noise."""

import glob
import os

import output

NOISE = 1.3  # times of single runs on a shared machine differ by up to this factor
SURE = 1.1  # with quartiles that lie apart, this much is more than noise
WORSE = 10.0  # errors at rounding level move by less

GREW = 1.1  # peaks of memory are nearly the same in every run

TIMES = ("milliseconds", "median", "processor", "seconds", "solve", "instructions")
ORIGIN = ("processor", "cores", "compiler", "flags", "blas_kernel", "scheduling_at_start")  # what makes times differ by itself


def is_time(key):
    return key in TIMES or key.endswith("_seconds")


def is_memory(key):
    return key == "memory" or key.endswith("_mib")


def is_error(key):
    return key == "error" or key.endswith("_error")


def quartiles(row, key):
    """Lower and upper quartile of a time; None where the row has none."""
    if key in ("milliseconds", "median"):
        found = row.get("low"), row.get("high")
    else:
        found = row.get(key.replace("_seconds", "_low")), row.get(key.replace("_seconds", "_high"))
    return found if key != "processor" and all(isinstance(value, (int, float)) and value > 0 for value in found) else None


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


def origin(folder):
    """Provenance of the first result in a folder of results, or of one file."""
    for path in [folder] if os.path.isfile(folder) else sorted(glob.glob(os.path.join(folder, "*.json"))):
        stored = output.read_results(path)
        if isinstance(stored, dict) and "keys" in stored:
            return stored["provenance"]
    return {}


def slower(old, new, key):
    """Whether a time has grown beyond the noise: quartiles that lie apart, or without them a large factor."""
    if key == "instructions":
        return new[key] > 1.01 * old[key]
    before, after = quartiles(old, key), quartiles(new, key)
    if before and after:
        return after[0] > before[1] and new[key] > SURE * old[key]
    return new[key] > NOISE * old[key]


def worse(old, new, key):
    """What to call it when `key` has become worse beyond the noise; None when it has not."""
    if is_time(key) and old[key] and new[key] and slower(old, new, key):
        return "slower"
    if is_memory(key) and old[key] and new[key] > GREW * old[key]:
        return "larger"
    if is_error(key) and new[key] > WORSE * max(old[key], 1e-15):
        return "less exact"
    if key == "false_confidence" and new[key] > old[key]:
        return "false confidence"
    return None


def drops(before, after):
    """Lines that name what is worse, and how many figures were compared."""
    lines, compared = [], 0
    for key in sorted(before.keys() & after.keys()):
        old, new = before[key], after[key]
        for name in old:
            if not (is_time(name) or is_memory(name) or is_error(name) or name == "false_confidence"):
                continue
            if not all(isinstance(row.get(name), (int, float)) for row in (old, new)):
                continue
            compared += 1
            found = worse(old, new, name)
            if found:
                lines.append("%s: %s: %s %.3g, was %.3g" % (found, ", ".join(key), name, new[name], old[name]))
    return lines, compared


def differences(before, after):
    """Lines that tell where the two runs were not made alike: their times say little about the program then."""
    return ["not alike: %s is %s, was %s" % (key, after.get(key), before.get(key)) for key in ORIGIN if before.get(key) != after.get(key)]


def report(before, after, origins=({}, {})):
    """Prints, and returns the lines. `origins`: provenance of the two runs."""
    lines, compared = drops(before, after)
    count = len(lines)
    lines = differences(*origins) + lines
    for line in lines:
        print("bench: " + line)
    missing = len(before.keys() - after.keys())
    print("bench: of %d figures in both runs %d are worse beyond the noise; %d rows are in the earlier run alone" % (compared, count, missing))
    return lines
