"""Studies over functions: the same numbers in any order, a journal, a restart, failures told."""
import json
import os
import subprocess
import sys
import textwrap

import numpy as np
import pytest

import frames
import topple

VARIABLES = {"load": topple.uniform(1.0, 3.0), "factor": topple.lognormal(1.0, 0.2)}


def product(load, factor):
    return load * factor


def test_samples_are_functions_of_their_number():
    study = topple.Study(VARIABLES, 64, seed=5)
    found = study.run(product, outputs=["product"])
    assert found.input_names == ["load", "factor"] and found.output_names == ["product"]
    assert found.numbers.tolist() == list(range(64))
    assert np.array_equal(found.outputs[:, 0], found.inputs[:, 0] * found.inputs[:, 1])
    assert np.all((found.inputs[:, 0] >= 1) & (found.inputs[:, 0] <= 3))
    later = study.run(product, outputs=["product"], samples=(40, 42), threads=2)
    assert np.array_equal(later.outputs, found.outputs[40:42])
    assert study.values(41) == dict(zip(found.input_names, later.inputs[1]))
    other = topple.Study(VARIABLES, 64, seed=6).run(product)
    assert not np.array_equal(other.inputs, found.inputs)


def test_distributions_have_the_moments_that_they_say():
    study = topple.Study({"n": topple.normal(5, 2), "l": topple.lognormal(3, 0.6), "c": topple.choice([1, 4], [3, 1])}, 4096,
                         sampling="latin")
    inputs = study.run(lambda n, l, c: 0.0).inputs
    # A Latin hypercube of 4,096: means are exact to a few thousandths of the spread.
    assert inputs[:, 0].mean() == pytest.approx(5, abs=0.01) and inputs[:, 0].std() == pytest.approx(2, rel=0.01)
    assert inputs[:, 1].mean() == pytest.approx(3, abs=0.01) and inputs[:, 1].std() == pytest.approx(0.6, rel=0.02)
    assert (inputs[:, 2] == 4).mean() == pytest.approx(0.25, abs=1e-3)
    assert topple.uniform(0, 2).quantile(0.25) == 0.5
    correlated = topple.Study({"a": topple.normal(0, 1), "b": topple.normal(0, 1)}, 4096, sampling="sobol",
                              correlated=[(["a", "b"], [[1, 0.7], [0.7, 1]])]).run(lambda a, b: 0.0).inputs
    assert np.corrcoef(correlated.T)[0, 1] == pytest.approx(0.7, abs=0.02)


def test_grids_are_gone_through_in_all_combinations():
    study = topple.Study({"size": topple.grid([1, 2]), "name": topple.grid(["IPE300", "IPE400", "IPE500"])})
    assert study.samples == 6
    seen = set()
    study.run(lambda size, name: seen.add((size, name)) or size)
    assert seen == {(s, n) for s in (1.0, 2.0) for n in ("IPE300", "IPE400", "IPE500")}


def test_a_study_over_analyses_finds_what_closed_forms_say():
    def sag(load, stiffness):
        model = frames.column({"push": {"x": load}})
        model["materials"]["steel"]["youngs_modulus"] = stiffness
        found = topple.analyse(model, threads=1)["push"]
        return {"sag": found.displacements[1, 0], "use": found.utilisations.max()}

    study = topple.Study({"load": topple.uniform(1e3, 2e3), "stiffness": topple.normal(210e9, 10e9)}, 32, sampling="sobol")
    found = study.run(sag, outputs=["sag", "use"], threads=2)
    load, stiffness = found.inputs.T
    assert found.outputs[:, 0] == pytest.approx(load * frames.LENGTH**3 / (3 * stiffness * frames.IY), rel=1e-9)
    assert found.outputs[:, 1] == pytest.approx(load * frames.LENGTH / 1e5, rel=1e-9)


def test_a_journal_is_resumed_to_the_same_bytes(tmp_path):
    study = topple.Study(VARIABLES, 20, seed=3)
    whole = study.run(product, folder=tmp_path / "whole")
    study.run(product, folder=tmp_path / "parts", samples=(5, 12))
    calls = []
    resumed = study.run(lambda load, factor: calls.append(load) or load * factor, folder=tmp_path / "parts", resume=True)
    assert len(calls) == 13
    assert np.array_equal(resumed.outputs, whole.outputs)
    lines = [sorted((tmp_path / name / "journal.jsonl").read_text().splitlines()[-20:]) for name in ("whole", "parts")]
    assert lines[0] == lines[1]
    with pytest.raises(topple.InputError):
        study.run(product, folder=tmp_path / "whole")  # a journal is there
    with pytest.raises(topple.InputError):
        study.run(product, folder=tmp_path / "whole", resume=True, version="2")
    with pytest.raises(topple.InputError):
        topple.Study(VARIABLES, 20, seed=4).run(product, folder=tmp_path / "whole", resume=True)


def test_a_killed_run_goes_on(tmp_path):
    program = tmp_path / "study.py"
    program.write_text(textwrap.dedent("""
        import os, sys, topple
        def slow(x):
            if x > 0.5 and len(sys.argv) > 2 and os.path.exists(sys.argv[1] + "/journal.jsonl") \\
                    and open(sys.argv[1] + "/journal.jsonl").read().count("outputs") > 5:
                os.kill(os.getpid(), 9)
            return x * x
        found = topple.Study({"x": topple.uniform(0, 1)}, 30).run(slow, folder=sys.argv[1], resume=True)
        print(len(found.numbers))
    """))
    folder = tmp_path / "killed"
    assert subprocess.run([sys.executable, program, folder, "kill"], check=False).returncode == -9
    left = (folder / "journal.jsonl").read_text().count("outputs")
    assert 5 < left < 30
    done = subprocess.run([sys.executable, program, folder], check=True, capture_output=True, text=True)
    assert done.stdout.strip() == "30"


def test_a_sample_that_fails_is_told_and_the_study_goes_on(tmp_path):
    def picky(load, factor):
        if load > 2:
            raise topple.InputError(f"too heavy: {load:.3f}")
        return load

    study = topple.Study(VARIABLES, 16)
    found = study.run(picky, folder=tmp_path / "out")
    heavy = found.inputs[:, 0] > 2
    assert 0 < heavy.sum() < 16
    assert sorted(found.failed) == np.flatnonzero(heavy).tolist()
    assert all(reason.startswith("InputError: too heavy") for reason in found.failed.values())
    assert np.array_equal(np.isnan(found.outputs[:, 0]), heavy)
    wrong = study.run(lambda load, factor: (1, 2))
    assert wrong.failed[0] == "the function returned 2 numbers; accepted: 1"
    assert "returned no" in study.run(lambda load, factor: {"other": 1}).failed[0]
    assert "TypeError" in study.run(lambda load: 1).failed[0]
    assert found.csv().count("\n") >= 17

    # Failed samples are done; they are computed once more where that is asked for.
    calls = []

    def patient(load, factor):
        calls.append(load)
        return load
    again = study.run(patient, folder=tmp_path / "out", resume=True)
    assert not calls and again.failed == found.failed
    again = study.run(patient, folder=tmp_path / "out", retry_failed=True)
    assert len(calls) == heavy.sum() and not again.failed
    assert np.array_equal(again.outputs[:, 0], found.inputs[:, 0])


def test_an_interrupt_ends_the_run_and_is_no_failure(tmp_path):
    def interrupted(load, factor):
        if interrupted.calls == 4:
            raise KeyboardInterrupt
        interrupted.calls += 1
        return load

    interrupted.calls = 0
    study = topple.Study(VARIABLES, 16)
    with pytest.raises(KeyboardInterrupt):
        study.run(interrupted, folder=tmp_path / "out")
    resumed = study.run(product, folder=tmp_path / "out", resume=True)
    assert len(resumed.numbers) == 16 and not resumed.failed


def test_progress_is_told_and_ends_the_run_by_what_it_raises():
    told = []
    topple.Study(VARIABLES, 8).run(product, progress=lambda done, all: told.append((done, all)))
    assert told == [(k, 8) for k in range(1, 9)]

    def enough(done, all):
        raise StopIteration

    with pytest.raises(StopIteration):
        topple.Study(VARIABLES, 8).run(product, progress=enough)


def test_studies_of_files_are_those_of_the_command(tmp_path):
    program = os.path.join(os.environ["TOPPLE_BIN"], "topple")
    shipped = topple.Study("la3_steel")
    assert shipped.samples > 0 and shipped.variables
    subprocess.run([program, "study", "la3_steel", "-o", str(tmp_path / "command"), "--samples", "0:4"], check=True,
                   capture_output=True)
    found = shipped.run(folder=tmp_path / "python", samples=(0, 4), threads=0)
    lines = [sorted((tmp_path / name / "journal.jsonl").read_text().splitlines()) for name in ("command", "python")]
    assert lines[0] == lines[1]
    assert found.outputs.shape[0] == 4 and not found.failed
    with pytest.raises(TypeError, match="a study of a file has no function"):
        shipped.run(product)


def test_wrong_studies_are_refused():
    for call, message in [
        (lambda: topple.uniform(1, 1), "low below high"),
        (lambda: topple.lognormal(-1, 1), "above 0"),
        (lambda: topple.normal(0, 1, low=9), "within 8 sd"),
        (lambda: topple.choice([]), "at least one value"),
        (lambda: topple.choice([1, 2], [1]), "a number of 0 or above for each value"),
        (lambda: topple.Study({}, 4), "at least one"),
        (lambda: topple.Study(VARIABLES, 4, sampling="grid"), 'accepted: "random", "latin", "sobol", "saltelli"'),
        (lambda: topple.Study(VARIABLES, 4, correlated=[(["load", "x"], [[1, 0], [0, 1]])]), 'no variable "x"'),
        (lambda: topple.Study(VARIABLES, 4, correlated=[(["load", "factor"], [[1, 2], [2, 1]])]), "positive definite"),
        (lambda: topple.Study(VARIABLES, 4).run(product, samples=(2, 9)), "of 0 to 4"),
    ]:
        with pytest.raises(ValueError, match=message):
            call()
    with pytest.raises(TypeError, match="function is missing"):
        topple.Study(VARIABLES, 4).run()
    with pytest.raises(IndexError):
        topple.Study(VARIABLES, 4).values(4)
    assert json.dumps(topple.Study(VARIABLES, 4).values(0))
