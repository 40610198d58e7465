"""together.py TOPPLE: several runs into one folder, or onto one file, at the same time.

Of those that write a folder one goes on and the others are refused with the folder's name, or each comes when the one before has
ended. Whatever the order, what lies there afterwards is the whole work of one run: no file of another, no half of one, no temporary.
"""
import json, pathlib, subprocess, sys, tempfile

AT_ONCE, ROUNDS = 6, 10
BAR = {"topple": 1, "materials": {"S": {"youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7850}},
       "sections": {"s": {"area": 0.01, "Iy": 1e-4, "Iz": 2e-5, "J": 1e-6}},
       "nodes": {"A": [0, 0, 0], "B": [0, 0, 4]}, "members": {"P": {"kind": "post", "nodes": ["A", "B"], "section": "s", "material": "S"}},
       "supports": {"A": "fixed"}}
PANEL = {"topple": 1, "panel": {"outline": [[0, 0], [3, 0], [3, 2], [0, 2]], "thickness": 0.2},
         "fracture": {"method": "voronoi", "cell": 0.5}, "hits": [{"at": [1, 1], "radius": 0.4}]}


def text_of(run):
    """What tells the runs apart: the title, which is in the results (and so many hits in a panel's)."""
    return f"run {run}"


def commands(folder, run):
    """Words of each kind, with input files of its own: (words, a file that tells whose it is, what it tells)."""
    model = folder / f"m{run}.json"
    model.write_text(json.dumps({"title": text_of(run), **BAR}))
    (folder / f"s{run}.json").write_text(json.dumps({"topple": 1, "title": text_of(run), "model": model.name, "duration": 0.2 + 0.02 * run}))
    (folder / f"p{run}.json").write_text(json.dumps(dict(PANEL, seed=run)))
    (folder / f"t{run}.json").write_text(json.dumps({"topple": 1, "title": text_of(run), "base": {"model": model.name}, "samples": 3 + run, "seed": 1,
                                                    "vary": [{"name": "E", "at": "/materials/S/youngs_modulus", "uniform": [2e11, 2.2e11]}],
                                                    "record": {"kg": "weight"}}))
    return {"analyse": ["analyse", model.name, "-o", "out", "--csv"], "demolish": ["demolish", f"s{run}.json", "-o", "out"],
            "fracture": ["fracture", f"p{run}.json", "-o", "out"], "study": ["study", f"t{run}.json", "-o", "out", "--threads", "1"],
            "convert": ["convert", model.name, "out.json"]}


def contents(folder):
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir())} if folder.is_dir() else {}


def check(topple, kind):
    wrong = []
    with tempfile.TemporaryDirectory() as place:
        place = pathlib.Path(place)
        alone = {}
        for run in range(AT_ONCE):  # what each writes by itself
            folder = place / f"alone{run}"
            folder.mkdir()
            subprocess.run([topple, *commands(folder, run)[kind]], cwd=folder, check=True, capture_output=True)
            alone[run] = contents(folder / "out") or {"out.json": (folder / "out.json").read_bytes()}
        for turn in range(ROUNDS):
            folder = place / f"together{turn}"
            folder.mkdir()
            calls = [commands(folder, run)[kind] for run in range(AT_ONCE)]
            inputs = {path.name for path in folder.iterdir()}
            processes = [subprocess.Popen([topple, *words], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) for words in calls]
            ended = []
            for run, process in enumerate(processes):
                said = process.communicate(timeout=300)[1].strip()
                if process.returncode == 0:
                    ended.append(run)
                elif process.returncode != 2 or "out" not in said:
                    wrong.append(f"{kind}: status {process.returncode}: {said}")
            found = contents(folder / "out") or {"out.json": (folder / "out.json").read_bytes()}
            same = [run for run in ended if sorted(alone[run]) == sorted(found) and all(like(found[name], alone[run][name], name) for name in found)]
            if not same:
                wrong.append(f"{kind}: of the runs {ended} that ended well, the files are of none")
            left = {path.name for path in folder.iterdir()} - inputs - {"out", "out.json"}
            if left:
                wrong.append(f"{kind}: {left} was left")
    return wrong


def like(one, other, name):
    """The same but for what tells the time that a run took."""
    if name == "times.csv":
        return one.count(b"\n") == other.count(b"\n")
    if name in ("results.json", "summary.json", "study.json"):
        return without_times(json.loads(one)) == without_times(json.loads(other))
    return one == other


def without_times(tree):
    if isinstance(tree, dict):
        return {key: without_times(value) for key, value in tree.items() if "seconds" not in key and "time" not in key and key != "date"}
    return [without_times(item) for item in tree] if isinstance(tree, list) else tree


failures = []
for one in ("analyse", "demolish", "fracture", "study", "convert"):
    failures += check(str(pathlib.Path(sys.argv[1]).resolve()), one)
print("\n".join(failures) or f"together: {5 * AT_ONCE * ROUNDS} runs, none wrong")
sys.exit(bool(failures))
