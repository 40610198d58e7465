"""The types that are shipped are those of the compiled module, and mypy takes the examples by them."""
import importlib.machinery
import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).parent.parent.parent
needs_mypy = pytest.mark.skipif(not shutil.which("stubgen"), reason="SKIPPED: mypy is not here")


def maker():
    file = str(ROOT / "apps/python/make_stubs")
    loader = importlib.machinery.SourceFileLoader("make_stubs", file)
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("make_stubs", loader))
    loader.exec_module(module)
    return module


@needs_mypy
def test_the_stubs_are_those_of_the_module():
    import topple

    folder = pathlib.Path(topple.__file__).parent.parent
    shipped = (ROOT / "apps/python/topple/_core.pyi").read_text()
    made = maker().stubs(str(folder))
    assert made == shipped, "run: apps/python/make_stubs build/release/python apps/python/topple/_core.pyi"
    assert "def analyse(model: Any, combinations: Any = ..., *, stations: int" in shipped


@needs_mypy
def test_mypy_takes_the_package_and_the_examples():
    examples = sorted(str(file) for file in (ROOT / "examples/python").glob("*.py"))
    run = subprocess.run(["mypy", "--no-incremental", "--cache-dir", os.devnull, "--strict", "--allow-untyped-calls",
                          "--allow-any-generics", "--ignore-missing-imports", "--python-executable", sys.executable,
                          *examples], capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stdout + run.stderr


def test_every_public_name_says_what_it_is():
    import topple

    silent = []
    for name in topple.__all__:
        thing = getattr(topple, name)
        if isinstance(thing, (str, tuple)):
            continue
        if not (thing.__doc__ or "").strip():
            silent.append(name)
        for attribute, value in vars(thing).items() if isinstance(thing, type) else ():
            if not attribute.startswith("_") and not (getattr(value, "__doc__", None) or "").strip() and value is not None:
                silent.append(f"{name}.{attribute}")
    assert silent == []
