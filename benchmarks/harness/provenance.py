"""What a result must carry so that it can be traced: commit, compiler, flags, machine, libraries, date."""

import datetime
import json
import os
import platform
import re
import shlex
import subprocess


MEASURED = "/solver/factor/multifrontal.cpp"  # whose flags are told
MISSING = "not a package here"


def _output(*command, cwd=None):
    try:
        done = subprocess.run(command, capture_output=True, text=True, cwd=cwd, timeout=20)
    except (OSError, subprocess.TimeoutExpired):
        return ""
    return done.stdout.strip() if done.returncode == 0 else ""


def _cache(build):
    values = {}
    with open(os.path.join(build, "CMakeCache.txt"), encoding="utf-8") as cache:
        for line in cache:
            key, found, value = line.strip().partition("=")
            if found:
                values[key.split(":")[0]] = value
    return values


def _processor():
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as info:
            for line in info:
                if line.startswith("model name"):
                    return line.partition(":")[2].strip()
    except OSError:
        pass
    return platform.processor() or "unknown"


def _flags(build):
    """With which the solver was compiled, warnings and places left out: what a preset names may be overridden by the project."""
    try:
        with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as stored:
            commands = {command["file"]: command["command"] for command in json.load(stored)}
    except OSError:
        return "unknown"
    for file, command in sorted(commands.items()):
        if file.endswith(MEASURED):
            words = shlex.split(command)
            kept = [word for word in words if re.fullmatch(r"-(O\w+|DNDEBUG|m[\w=.+-]+|f(?!PI)[\w=-]+|std=.*|g\d?)", word)]
            return " ".join(dict.fromkeys(kept))
    return "unknown"


def _memory_gib():
    return "%.1f GiB" % (os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30)


def _package(name):
    return _output("dpkg-query", "-W", "-f", "${Version}", name) or MISSING


def _scheduling():
    """Programs inherit it: real-time priority keeps other work on a shared machine away."""
    policy = {os.SCHED_OTHER: "ordinary", os.SCHED_FIFO: "real time", os.SCHED_RR: "real time"}.get(os.sched_getscheduler(0), "other")
    return "%s, nice %d" % (policy, os.nice(0))


def collect(root, build, blas_kernel):
    """Ordered pairs of name and value."""
    cache = _cache(build)
    changed = _output("git", "status", "--porcelain", "--untracked-files=no", cwd=root)
    compiler = cache.get("CMAKE_CXX_COMPILER", "c++")
    return {
        "commit": _output("git", "rev-parse", "HEAD", cwd=root) + (" with local changes" if changed else ""),
        "date": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"),
        "compiler": _output(compiler, "--version").split("\n")[0],
        "flags": _flags(build),
        "processor": _processor(),
        "cores": str(os.cpu_count()),
        "memory": _memory_gib(),
        "threads": "1",
        "scheduling_at_start": _scheduling(),
        "blas_kernel": blas_kernel,
        "load_at_start": "%.2f" % os.getloadavg()[0],
        "libbullet, single precision": _package("libbullet3.24"),
        "libbullet, double precision": _package("libbullet-double3.24") if _package("libbullet-double3.24") != MISSING else _package("libbullet3.24"),
        "libcholmod": _package("libcholmod3"),
        "libopenblas": _package("libopenblas0-pthread"),
        "libmetis": _package("libmetis5"),
        "eigen": _package("libeigen3-dev"),
        "calculix": _package("calculix-ccx"),
        "valgrind": _package("valgrind"),
    }
