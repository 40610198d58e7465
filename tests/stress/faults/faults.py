#!/usr/bin/env python3
"""Faults of the machine: faults.py BIN [--short] [--only WORD] [--calls CALL,...].

Each program writes into a folder that holds an earlier run's results, and one call of it fails (a write, rename, fsync,
close or open; an allocation) or is its last (SIGKILL, at any system call too); or Ctrl-C ends it at any system call.
Afterwards every file there is the old one or a new one, whole; the status is 0 only when all are new; a failure is told;
no temporary is left by a program that could take it away. A study goes on afterwards and ends as if nothing had been.
"""
import argparse, hashlib, os, pathlib, random, shutil, signal, subprocess, sys, tempfile
from concurrent.futures import ThreadPoolExecutor

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import hostile  # noqa: E402  the scenes

LIMIT = 60  # s
SCENE = {"m.json": hostile.text(hostile.MODEL), "plain.json": hostile.text(hostile.PLAIN), "s.json": hostile.text(dict(hostile.SCENARIO, duration=0.2)),
         "p.json": hostile.text(hostile.PANEL),
         "t.json": hostile.text({
             "topple": 1, "base": {"model": "m.json"}, "samples": 5, "seed": 2,
             "vary": [{"name": "fy", "at": "/materials/steel/yield_strength", "uniform": [2e8, 3e8]},
                      {"name": "post", "at": "/sections/col/catalogue", "choice": ["HEB200", "HEB220", "HEA200"]}],
             "record": {"use": "largest_use", "height": "results:/combinations/collapse/displacements/E/2"}})}
# name: program, words of a first run that leaves the old files, words of the run with a fault, where results are
RUNS = {
    "analyse": ("topple", ["analyse", "m.json", "-o", "out", "--csv", "--vtu"],
                ["analyse", "m.json", "-o", "out", "--csv", "--vtu", "--stations", "5"], "out"),
    "demolish": ("topple", ["demolish", "s.json", "-o", "out", "--save", "0.1"],
                 ["demolish", "s.json", "-o", "out", "--save", "0.1", "--gltf"], "out"),
    "fracture": ("topple", ["fracture", "p.json", "-o", "out"], ["fracture", "p.json", "-o", "out", "--obj"], "out"),
    "study": ("topple", ["study", "t.json", "-o", "out", "--threads", "1", "--samples", "0:2"],
              ["study", "t.json", "-o", "out", "--threads", "1", "--resume"], "out"),
    "convert": ("topple", ["convert", "plain.json", "out"], ["convert", "plain.json", "out"], "out"),
    "viewer": ("topple-viewer", ["m.json", "--headless", "--size", "64x48", "--screenshot", "out/p.png", "--gltf", "out/a.glb",
                                 "--save", "out/s.topple", "--usd", "out/a.usda", "--model", "out/m.json"],
               ["m.json", "--headless", "--size", "80x48", "--screenshot", "out/p.png", "--gltf", "out/a.glb", "--save",
                "out/s.topple", "--usd", "out/a.usda", "--model", "out/m.json", "--at", "0.1"], "out"),
}
TIMES = ("results.json", "summary.json")  # hold seconds of the clock: told apart by their ends alone
GROWING = ("journal.jsonl", "times.csv")  # of a study: a line for each sample as it ends, and gone on with


def digest(folder):
    """Every file and what is in it; of one that holds times, whether it is whole."""
    found = {}
    for path in sorted(folder.rglob("*")):
        if path.is_file() and path.name not in GROWING:
            content = path.read_bytes()
            if path.name in TIMES:
                content = b"whole" if content.rstrip().endswith(b"}") and len(content) > 100 else content
            found[str(path.relative_to(folder))] = hashlib.sha256(content).hexdigest()
    return found


class Trial:
    def __init__(self, bin_dir, tools, name):
        self.bin_dir, self.shim, self.name = bin_dir, tools / "faulty_calls.so", name
        self.at_call = tools / "at_system_call"
        self.program, self.first, self.second, self.out = RUNS[name]
        self.base = pathlib.Path(tempfile.mkdtemp(prefix="faults-"))
        hostile.lay_down(self.base, SCENE)
        (self.base / self.out).mkdir()
        assert self.run(self.base, self.first, {}).returncode == 0, name
        self.old = digest(self.base / self.out)
        done = self.copy()
        run = self.run(done, self.second, {})
        assert run.returncode == 0, (name, run.stderr)
        self.new = digest(done / self.out)
        shutil.rmtree(done)

    def copy(self):
        folder = pathlib.Path(tempfile.mkdtemp(prefix="faults-"))
        shutil.copytree(self.base, folder, dirs_exist_ok=True)
        return folder

    def run(self, folder, words, faults, before=()):
        environment = dict(os.environ, XDG_CACHE_HOME=str(folder / "cache"), **faults)  # not the user's own states
        if "FAULT_CALL" in faults:
            environment["LD_PRELOAD"] = str(self.shim)
        return subprocess.run([*map(str, before), str(self.bin_dir / self.program), *words], cwd=folder, env=environment,
                              timeout=LIMIT, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)

    def count(self, call):
        folder = self.copy()
        if call == "any":
            self.run(folder, self.second, {"COUNT_FILE": str(folder / "count")}, [self.at_call, 0, 0])
        else:
            self.run(folder, self.second, {"FAULT_CALL": call, "FAULT_COUNT": str(folder / "count")})
        number = int((folder / "count").read_text())
        shutil.rmtree(folder)
        return number

    def fault(self, call, at, how):
        folder = self.copy()
        try:
            if call == "any":
                end = signal.SIGKILL if how == "kill" else signal.SIGINT
                run = self.run(folder, self.second, {}, [self.at_call, at, int(end)])
            else:
                run = self.run(folder, self.second, {"FAULT_CALL": call, "FAULT_AT": str(at), "FAULT_HOW": how})
            return self.judge(folder, run, how) or self.judge_going_on(folder)
        except subprocess.TimeoutExpired:
            return f"no end in {LIMIT} s"
        finally:
            shutil.rmtree(folder)

    def judge(self, folder, run, how):
        now = digest(folder / self.out)
        left = [name for name in now if name.startswith(".topple-") or name.endswith(".part")]
        for name in left:
            del now[name]
        for name, content in now.items():
            if content not in (self.old.get(name), self.new.get(name)):
                return f"{name} is neither the old file nor the new one"
        if how == "interrupt" and not left and run.returncode in (-signal.SIGINT, 0, 1):
            return None
        gone = [name for name in self.old if name not in now and name in self.new]
        if gone:
            return f"{gone[0]} is gone"
        if how == "kill":
            return None if run.returncode in (-9, 0) else f"status {run.returncode}"
        if run.returncode < 0:
            return f"signal {-run.returncode}: {run.stderr.decode(errors='replace')[-200:]}"
        if left:
            return f"{left[0]} was left"
        if run.returncode == 0 and now != self.new:
            return "status 0, and not all files are new"
        if run.returncode != 0 and not run.stderr.strip():
            return f"status {run.returncode} without a word"
        return None


    def judge_going_on(self, folder):
        """A study takes up what its journal holds."""
        if self.name != "study":
            return None
        run = self.run(folder, [*self.second[:-1], "--retry-failed"], {})
        if run.returncode != 0:
            return f"does not go on: {run.stderr.decode(errors='replace')[-200:]}"
        now = digest(folder / self.out)
        wrong = [name for name, content in self.new.items() if now.get(name) != content]
        return f"gone on with, {wrong[0]} is another" if wrong else None


def spread(count, most, seed):
    """At most so many of 1 ... count: the first two fifths of them, the rest at random."""
    if count <= most:
        return list(range(1, count + 1))
    first = most * 2 // 5
    return list(range(1, first + 1)) + sorted(random.Random(seed).sample(range(first + 1, count + 1), most - first))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("--short", action="store_true", help="a few of each kind, for the suite of tests")
    parser.add_argument("--only", default="")
    parser.add_argument("--calls", default="write,rename,fsync,close,open,new,any", help="calls that fail: of these, new, any")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--seed", type=int, default=3)
    options = parser.parse_args()
    bin_dir = options.bin.resolve()
    tools = pathlib.Path(tempfile.mkdtemp(prefix="faults-"))
    compiler = [os.environ.get("CXX", "g++"), "-std=c++20", "-O1"]
    subprocess.run([*compiler, "-shared", "-fPIC", "-o", tools / "faulty_calls.so", HERE / "faulty_calls.cpp", "-ldl"], check=True)
    subprocess.run([*compiler, "-o", tools / "at_system_call", HERE / "at_system_call.cpp"], check=True)
    wrong = tried = 0
    for name in RUNS:
        if options.only not in name or not (bin_dir / RUNS[name][0]).exists():
            continue
        trial = Trial(bin_dir, tools, name)
        faults = []
        for call in ("write", "rename", "fsync", "close", "open"):
            most = 6 if options.short else 10_000
            faults += [(call, at, "fail") for at in spread(trial.count(call), most, 1)]
            faults += [(call, at, "kill") for at in spread(trial.count(call), 3 if options.short else 100, 2)]
        allocations, calls = trial.count("new"), trial.count("any")
        chance = random.Random(options.seed)
        if options.short:
            faults += [("new", at, "fail") for at in chance.sample(range(1, allocations + 1), 12)]
        else:
            faults += [("new", at, "fail") for at in spread(allocations, 500, options.seed)]
        for how, most in (("kill", 4 if options.short else 125), ("interrupt", 4 if options.short else 60)):
            faults += [("any", at, how) for at in chance.sample(range(1, calls + 1), min(most, calls))]
        faults = [fault for fault in faults if fault[0] in options.calls.split(",")]
        with ThreadPoolExecutor(options.jobs) as pool:
            for fault, what in zip(faults, pool.map(lambda one: trial.fault(*one), faults)):
                tried += 1
                if what:
                    wrong += 1
                    print(f"{name}: {fault[0]} {fault[1]} ({fault[2]}): {what}", flush=True)
        shutil.rmtree(trial.base)
    print(f"faults: {tried} tried, {wrong} wrong")
    return 1 if wrong or not tried else 0


if __name__ == "__main__":
    sys.exit(main())
