"""blas_kernels.py TOPPLE: collapses have the same bits with the BLAS kernels of other processors.

OpenBLAS takes its kernels by the processor; OPENBLAS_CORETYPE names others, as long as the processor has their instructions. What they
sum they sum in other orders, and a collapse goes another way by its last bit.
"""
import hashlib, json, os, pathlib, subprocess, sys, tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENARIOS = {"seed_hit": 2.0, "house_hit": 1.5, "shell_house_hit": 2.5}  # s: until much has come off
KERNELS = ["Prescott", "Nehalem", ""]            # SSE3 and SSE4, which every processor has that this is built for; its own


def run(topple, scenario, kernels, folder):
    """What happened and what stands in the end."""
    environment = {key: value for key, value in os.environ.items() if key != "OPENBLAS_CORETYPE"}
    if kernels:
        environment["OPENBLAS_CORETYPE"] = kernels
    out = folder / (kernels or "own")
    subprocess.run([topple, "demolish", str(scenario), "-o", str(out)], env=environment, check=True, capture_output=True)
    return {name: hashlib.sha256((out / name).read_bytes()).hexdigest() for name in ("events.jsonl", "standing.json")}


def check(topple, name, seconds):
    content = json.loads((ROOT / "models" / "scenarios" / f"{name}.json").read_text())
    content |= {"model": str(ROOT / "models" / f"{content['model']}.json"), "duration": seconds}
    with tempfile.TemporaryDirectory() as made:
        folder = pathlib.Path(made)
        (folder / "scenario.json").write_text(json.dumps(content))
        found = {kernels: run(topple, folder / "scenario.json", kernels, folder) for kernels in KERNELS}
        events = len((folder / "own" / "events.jsonl").read_text().splitlines())
    kinds = {str(bits): kernels or "its own" for kernels, bits in found.items()}
    print(f"{name}: {events} events, " + ("the same with all kernels" if len(kinds) == 1 else "other bits with " + ", ".join(kinds.values())))
    return events > 10 and len(kinds) == 1


if __name__ == "__main__":
    sys.exit(0 if all([check(sys.argv[1], name, seconds) for name, seconds in SCENARIOS.items()]) else 1)
