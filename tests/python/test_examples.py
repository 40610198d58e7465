"""The examples run, and so does every piece of Python that the documents show."""
import os
import pathlib
import re
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).parent.parent.parent


def run(*words, folder):
    done = subprocess.run([sys.executable, "-B", *map(str, words)], cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_columns_are_lost_one_by_one(tmp_path):
    said = run(ROOT / "examples/python/lose_each_column.py", folder=tmp_path)
    assert re.search(r"120 columns, each lost alone", said)
    assert re.search(r"\d+ of 120 losses break no further joint", said)


def test_a_ball_brings_something_down(tmp_path):
    said = run(ROOT / "examples/python/swing_a_ball.py", "fallen.png", folder=tmp_path)
    assert "joint_broke" in said
    standing, members = map(int, re.search(r"(\d+) of (\d+) members stand", said).groups())
    assert standing < members
    assert abs(float(re.search(r"out of balance by (-?[\d.]+) %", said)[1])) < 1
    assert (tmp_path / "fallen.png").stat().st_size > 10000


def test_the_figure_of_the_readme_is_made_again(tmp_path):
    said = run(ROOT / "examples/python/moments_of_the_seed_building.py", "moments.png", folder=tmp_path)
    assert "306 members" in said
    import matplotlib.image

    picture = matplotlib.image.imread(tmp_path / "moments.png")[..., :3]
    red = (picture[..., 0] - picture[..., 2] > 0.3).sum()
    blue = (picture[..., 2] - picture[..., 0] > 0.3).sum()
    # Both colours of the viewer's picture are there in plenty, neither hides the other.
    assert red > 2000 and blue > 2000
    shown = matplotlib.image.imread(ROOT / "docs/pictures/moments.png")[..., :3]
    assert ((shown[..., 0] - shown[..., 2] > 0.3).sum() > 500) and ((shown[..., 2] - shown[..., 0] > 0.3).sum() > 500)


@pytest.mark.parametrize("document", ["README.md", "docs/python.md"])
def test_python_of_the_documents_runs(document, tmp_path):
    blocks = re.findall(r"^```python\n(.*?)^```$", (ROOT / document).read_text(), flags=re.M | re.S)
    assert blocks
    for block in blocks:
        file = tmp_path / "block.py"
        file.write_text(block)
        run(file, folder=tmp_path)
