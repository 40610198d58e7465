"""Instructions of small kernels (valgrind's callgrind), where times are noise: the same program with two numbers of repetitions."""

import os
import re
import shutil
import subprocess

import output

COLUMNS = [("kernel", "kernel"), ("instructions", "instructions each"), ("repetitions", "repetitions"), ("note", "note")]
# Name, fewer and more repetitions: enough to weigh more than the start of the program.
REPETITIONS = {"beam stiffness": (10, 1010), "fixed-end forces": (10, 1010), "diagram and its extremes": (10, 1010), "use of a joint": (10, 1010),
               "nothing changes": (10, 10010), "a load changes": (2, 42), "a joint breaks and is mended": (2, 34), "fresh analysis": (1, 3)}
QUICK = ("beam stiffness", "diagram and its extremes", "use of a joint", "a load changes", "a joint breaks and is mended")

TEXT = ("Instructions as valgrind's callgrind counts them, of one repetition, from the difference of two runs; on the 4 x 5 x 6 of the peers. Valgrind knows "
        "no AVX-512, so dense kernels count as they are on processors with AVX2. What is not shown: what an instruction costs.")


def collected(program, name, count):
    environment = {key: value for key, value in os.environ.items() if key != "OPENBLAS_CORETYPE"}
    done = subprocess.run(["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", program, name, str(count)], capture_output=True, text=True, env=environment)
    found = re.search(r"Collected : (\d+)", done.stderr)
    if done.returncode != 0 or found is None:
        raise RuntimeError("valgrind: " + (done.stderr.strip().split("\n")[-1] or "no count"))
    return int(found.group(1))


def run(context):
    if shutil.which("valgrind") is None:
        context.lines.append("kernels: valgrind is not installed (Debian: valgrind); instructions are not counted")
        print("bench: " + context.lines[-1])
        return []
    program = os.path.join(context.programs, "bench_kernels")
    rows = []
    for name, (few, many) in REPETITIONS.items():
        if context.quick and name not in QUICK:
            continue
        row = {"kernel": name, "repetitions": many - few}
        try:
            row["instructions"] = round((collected(program, name, many) - collected(program, name, few)) / (many - few))
        except RuntimeError as error:
            row["note"] = str(error)
        rows.append(row)
        output.progress(context, "kernels: %s, %s instructions" % (name, row.get("instructions", "no")))
    output.write_results(context, "kernels", rows, COLUMNS, ("kernel",))
    return [("Instructions of small kernels", TEXT, [], (rows, COLUMNS))]
