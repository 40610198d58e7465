"""Drawings: what is drawn lies where it should, in the colours that it should have."""
import numpy as np
import pytest

import frames
import topple

plt = pytest.importorskip("matplotlib.pyplot")
plot = pytest.importorskip("topple.plot")


@pytest.fixture(autouse=True)
def closed_figures():
    yield
    plt.close("all")


def drawn(axes, kind):
    axes.figure.canvas.draw()
    return [one for one in axes.collections if type(one).__name__ == kind]


def test_a_deformed_cantilever_is_drawn_where_it_bends_to():
    found = topple.analyse(frames.column({"push": {"x": 1e3}}))
    axes = plot.shape(found.model, found["push"].displacements, scale=100)
    ghost, bent = drawn(axes, "Line3DCollection")
    line = np.array(bent._segments3d[0])
    length, push = frames.LENGTH, 1e3
    z = np.linspace(0, length, len(line))
    # The cubic between the ends is the closed form under a force at the tip.
    expected = 100 * push * z**2 * (3 * length - z) / (6 * frames.E * frames.IY)
    assert line[:, 0] == pytest.approx(expected, abs=1e-9)
    assert np.array(ghost._segments3d[0])[:, 0] == pytest.approx(0)
    assert axes.get_zlabel() == "z (m)"


def test_diagrams_lie_on_the_side_that_is_tensed():
    found = topple.analyse(frames.column({"push": {"x": 1e3}}), stations=8)
    axes = plot.diagram(found["push"], "moment_y", scale=1e-3)
    tips = np.concatenate([np.array(one._segments3d).reshape(-1, 3) for one in drawn(axes, "Line3DCollection")])
    # Pushed along +x, the foot is in tension at -x.
    assert tips[:, 0].min() == pytest.approx(-1e-3 * 1e3 * frames.LENGTH)
    assert tips[:, 0].max() == pytest.approx(0, abs=1e-9)
    assert "moment_y" in axes.get_title()
    with pytest.raises(ValueError, match="has no stations"):
        plot.diagram(topple.analyse(frames.column({"push": {"x": 1e3}}))["push"])


def test_modes_buckling_and_diagrams_go_through_one_call():
    found = topple.analyse(frames.column({"press": {"z": -1e4}}, pieces=4), modes=1, buckling=1, stations=4)
    assert "Hz" in found.plot(mode=0).get_title()
    assert "buckling at" in found.plot(buckling=0).get_title()
    assert "axial" in found.plot(diagram="axial").get_title()
    assert found.plot("press").get_title().startswith("displacements x")
    assert found.model.plot() is not None
    values = np.arange(4.0)
    coloured = drawn(plot.shape(found.model, values=values, label="number"), "Line3DCollection")[0]
    assert np.array_equal(coloured.get_array(), values)
    with pytest.raises(ValueError, match="accepted: \\(4,\\)"):
        plot.shape(found.model, values=[1.0])
    with pytest.raises(ValueError, match="accepted: \\(5, 6\\)"):
        plot.shape(found.model, np.zeros((4, 6)))


def test_histories_are_lines_over_time():
    found = topple.analyse("seed_building", combinations="collapse", lose="P-1-1-1", dynamic=True, duration=0.05,
                           history=["N-1-1-1", "BX-1-1-1:1"])
    motion = found.losses[0].states[0].motion
    axes = motion.plot()
    (line,) = axes.lines
    assert np.array_equal(line.get_xdata(), motion.times)
    assert np.array_equal(line.get_ydata(), motion.history_displacements[:, 0, 2])
    assert axes.get_ylabel() == "displacement along z (m)"
    joints = plot.history(motion, component="ry", joints=True)
    assert joints.get_ylabel() == "moment about y (N m)"
    assert np.array_equal(joints.lines[0].get_ydata(), motion.history_demands[:, 0, 4])
    with pytest.raises(ValueError, match="accepted: x, y, z"):
        plot.history(motion, component="up")
    with pytest.raises(ValueError, match="no history was kept"):
        plot.history(topple.analyse("seed_building", combinations="collapse", lose="P-1-1-1", dynamic=True,
                                    duration=0.05).losses[0].states[0].motion)


def test_a_collapse_shows_what_stands_and_what_fell():
    run = topple.Simulation("seed_hit")
    run.run(until=2)
    axes = run.plot()
    standing, fallen = drawn(axes, "Line3DCollection")
    owners = run.member_bodies
    assert len(standing._segments3d) == np.count_nonzero(owners == -1)
    assert len(fallen._segments3d) == np.count_nonzero(owners >= 0)
    assert axes.get_title() == f"{run.time:.2f} s"
    undisturbed = plot.simulation(topple.Simulation("seed_idle"))
    assert len(drawn(undisturbed, "Line3DCollection")) == 1
