"""Analyses: answers against closed forms, arrays against the command's files, threads, errors."""
import gc
import json
import os
import subprocess
import threading
import time

import numpy as np
import pytest

import frames
import topple
from frames import AREA, DENSITY, E, IY, IZ, LENGTH

# Closed forms of a prismatic member are what its stiffness is made of: only rounding is between them.
ROUNDING = 1e-9


def test_a_cantilever_bends_as_beams_do():
    push, weight = 1e3, 5e3
    found = topple.analyse(frames.column({"push": {"x": push}, "press": {"z": -weight}}), stations=4)
    assert [one.name for one in found.combinations] == ["push", "press"]
    bent = found["push"]
    # A post's local z is global x: it bends about its strong axis.
    assert bent.displacements[1, 0] == pytest.approx(push * LENGTH**3 / (3 * E * IY), rel=ROUNDING)
    assert bent.displacements[1, 4] == pytest.approx(push * LENGTH**2 / (2 * E * IY), rel=ROUNDING)
    assert bent.reactions[0] == pytest.approx([-push, 0, 0, 0, -push * LENGTH, 0], abs=1e-6)
    assert bent.total_load[:3] == pytest.approx(-bent.total_reaction[:3])
    pressed = found["press"]
    assert pressed.displacements[1, 2] == pytest.approx(-weight * LENGTH / (E * AREA), rel=ROUNDING)
    assert pressed.end_forces[0, 0] == pytest.approx([weight, 0, 0, 0, 0, 0], abs=1e-6)
    assert pressed.end_forces[0, 1] == pytest.approx([-weight, 0, 0, 0, 0, 0], abs=1e-6)
    assert pressed.diagram("axial")[0] == pytest.approx([-weight] * 5)
    moments = np.abs(bent.diagram("moment_y")[0])
    assert bent.station_places[0] == pytest.approx([0, 1, 2, 3, 4])
    assert moments == pytest.approx(push * (LENGTH - bent.station_places[0]), abs=1e-6)
    which = topple.DIAGRAMS.index("moment_y")
    largest = max(bent.minima[0, which], bent.maxima[0, which], key=lambda extreme: abs(extreme[0]))
    assert abs(largest[0]) == pytest.approx(push * LENGTH) and largest[1] == pytest.approx(0, abs=1e-9)


def test_utilisations_are_demand_over_capacity():
    found = topple.analyse(frames.column({"press": {"z": -5e5}, "pull": {"z": 5e5}, "push": {"x": 1e4}}))
    use = {one.name: one for one in found.combinations}
    assert [topple.SENSES[use[name].senses[0]] for name in ("press", "pull", "push")] == [
        "compression", "tension", "moment_y"]
    assert use["press"].utilisations[0] == pytest.approx(5e5 / 2e6)
    assert use["pull"].utilisations[0] == pytest.approx(5e5 / 1e6)
    assert use["push"].utilisations[0] == pytest.approx(1e4 * LENGTH / 1e5)
    assert use["push"].demands[0] == pytest.approx(1e4 * LENGTH) and use["push"].capacities[0] == 1e5
    assert use["push"].utilisations[1] == 0  # the joint at the top has no capacity


def test_buckling_is_eulers():
    found = topple.analyse(frames.column({"press": {"z": -1e4}}), buckling=2)
    first, second = found["press"].buckling
    # Axial shortening is small; shear deformation is not there: Euler's load of a free-standing column is exact.
    assert first.factor == pytest.approx(np.pi**2 * E * IZ / (2 * LENGTH) ** 2 / 1e4, rel=1e-6)
    assert second.factor == pytest.approx(np.pi**2 * E * IY / (2 * LENGTH) ** 2 / 1e4, rel=1e-6)
    assert np.abs(first.shape[:, :3]).max() == pytest.approx(1)
    assert np.abs(first.shape[1, 1]) == pytest.approx(1)  # about the weak axis: along global y


def test_modes_are_those_of_a_clamped_beam():
    pieces = 8
    found = topple.analyse(frames.column({"press": {"z": -1.0}}, pieces=pieces), modes=2)
    # Eight cubic elements: 1e-4 is far above their error in the first mode and below any mistake.
    first = 1.8751040687**2 / LENGTH**2 * np.sqrt(E * IZ / (DENSITY * AREA)) / (2 * np.pi)
    assert found.frequencies[0] == pytest.approx(first, rel=1e-4)
    assert found.modes[0].frequency == found.frequencies[0]
    assert found.modes[0].shape.shape == (pieces + 1, 6)
    assert found.moving_mass == pytest.approx([DENSITY * AREA * LENGTH] * 3, rel=0.1)  # the foot's share is held
    assert np.all((found.modes[0].mass_share >= 0) & (found.modes[0].mass_share <= 1))


def test_second_order_amplifies_the_push_under_a_load():
    euler = np.pi**2 * E * IY / (2 * LENGTH) ** 2
    model = frames.column({"both": {"x": 1e3, "z": -0.3 * euler / 4}})
    linear = topple.analyse(model)["both"].displacements[1, 0]
    found = topple.analyse(model, second_order="exact")["both"].displacements[1, 0]
    # tan(u)/u form of the beam-column: 3 (tan u - u)/u^3, u = L sqrt(N / EI)
    u = LENGTH * np.sqrt(0.3 * euler / 4 / (E * IY))
    assert found / linear == pytest.approx(3 * (np.tan(u) - u) / u**3, rel=1e-6)
    with pytest.raises(ValueError, match='second_order: found "p-delta"; accepted: "none", "exact", "cubic"'):
        topple.analyse(model, second_order="p-delta")


def test_a_lost_member_leaves_the_state_of_the_model_without_it():
    found = topple.analyse("seed_building", combinations="service", lose="P-2-2-1", lose_each="posts", sudden=1)
    by_name = {loss.member: loss for loss in found.losses}
    assert len(by_name) == 120
    state = by_name["P-2-2-1"].states[0]
    assert state.stands and state.combination == "service"
    assert "P-2-2-1" not in [found.model.member_names[i] for i in state.members]
    assert state.end_forces.shape == (305, 2, 6) and state.displacements.shape == (140, 6)
    # What is left bears all: the feet of the posts take the load that the lost one had.
    feet = [i for i, m in enumerate(state.members) if found.model.member_names[m] in
            {f"P-{x}-{y}-1" for x in range(1, 6) for y in range(1, 6)}]
    axes = found.model.member_axes[state.members[feet]]
    lift = np.einsum("mc,mcg->g", state.end_forces[feet, 0, :3], axes)[2]
    whole = found["service"]
    expected = whole.total_reaction[2]
    weight_below = abs(expected) - abs(lift)
    # Loads at the supported nodes themselves (the walls' lower edges) go to the ground without a post.
    assert 0 <= weight_below < 0.2 * abs(expected)
    worst = found.model.joint(state.worst)
    place = list(state.joints).index(worst)
    assert state.utilisations[place] == state.utilisations.max() == state.utilisation


def test_a_sudden_loss_through_time_overshoots_to_twice():
    # A mass between two springs in line: when the lower one goes, what it bore comes on the other at once.
    hanger = {
        "topple": 1, "title": "Hanger",
        "materials": {"steel": {"youngs_modulus": E, "poisson_ratio": 0.3}},
        "sections": {"s": {"area": 1e-4, "Iy": 1e-8, "Iz": 1e-8, "J": 1e-8}},
        "joints": {"j": {"capacity": {"tension": 1e5, "compression": 1e5}}},
        "nodes": {"top": [0, 0, 4], "mid": [0, 0, 2], "foot": [0, 0, 0]},
        "members": {
            "A": {"nodes": ["top", "mid"], "section": "s", "material": "steel", "joints": ["j", "j"]},
            "B": {"nodes": ["mid", "foot"], "section": "s", "material": "steel", "joints": ["j", "j"]}},
        "supports": {"top": "fixed", "foot": "fixed"},
        "loads": {"dead": {"nodes": {"mid": {"z": -1e4}}}},
        "combinations": {"dead": {"dead": 1}},
    }
    found = topple.analyse(hanger, lose="B", dynamic=True, damping=0, duration=0.2, history=["mid", "A:1"])
    motion = found.losses[0].states[0].motion
    assert motion.history_nodes == ["mid"] and motion.history_joints == ["A:1"]
    stiffness, mass = E * 1e-4 / 2, 1e4 / 9.80665
    # The longest period is that of the mass swaying at the end of the hanger that is left, a cantilever.
    sway = 3 * E * 1e-8 / 2**3
    assert motion.period == pytest.approx(2 * np.pi * np.sqrt(mass / sway), rel=1e-3)
    first, last = 1e4 / (2 * stiffness), 1e4 / stiffness
    sag = -motion.history_displacements[:, 0, 2]
    assert sag[0] == pytest.approx(first, rel=1e-3)
    # Undamped: it swings about the new state by the distance between the two; peaks are settled to 0.5 %.
    assert sag.max() == pytest.approx(last + (last - first), rel=6e-3)
    tension = motion.history_demands[:, 0, 0]
    assert tension.max() == pytest.approx(1.5e4, rel=6e-3)
    assert motion.amplifications[list(motion.joints).index(found.model.joint("A:1"))] == pytest.approx(2, rel=0.02)
    assert len(motion.times) == len(sag) and np.all(np.diff(motion.times) > 0)


def test_a_time_history_comes_from_arrays_as_from_a_file(tmp_path):
    model = topple.Model(frames.column({"push": {"x": 1e3}, "press": {"z": -1e5}}))
    times = np.linspace(0, 0.2, 21)
    shake = np.sin(40 * times)
    file = tmp_path / "shake.csv"
    file.write_text("time,ax\n" + "".join(f"{t!r},{a!r}\n" for t, a in zip(times.tolist(), shake.tolist())))
    options = dict(combinations="press", history="N1", duration=0.3)
    by_array = topple.analyse(model, time_history={"time": times, "ax": shake}, **options).motions["press"]
    by_file = topple.analyse(model, time_history=str(file), **options).motions["press"]
    assert np.array_equal(by_array.history_displacements, by_file.history_displacements)
    assert np.abs(by_array.history_displacements[:, 0, 0]).max() > 0
    for wrong, message in [({"time": times}, "no column time, or none beside it"),
                           ({"time": times, "bx": shake}, 'column "bx"; accepted: time, ax, ay, az, push, press'),
                           ({"time": times[::-1], "ax": shake}, r"time\[1\]: times start at 0 or later and ascend"),
                           ({"time": times, "ax": shake[1:]}, "20 numbers; accepted: one for each of 21 times"),
                           ({"time": times, "ax": shake * np.nan}, "out of range")]:
        with pytest.raises(topple.InputError, match=message):
            topple.analyse(model, time_history=wrong, **options)


def test_a_cut_has_what_the_part_above_does_to_the_part_below(tmp_path):
    push = 1e3
    cuts = {"middle": {"at": [0, 0, LENGTH / 2], "normal": [0, 0, 1], "along": [1, 0, 0]}}
    file = tmp_path / "cuts.json"
    file.write_text(json.dumps({"cuts": cuts}))
    column = frames.column({"push": {"x": push}, "press": {"z": -5e3}})
    for given in (cuts, str(file)):
        found = topple.analyse(column, cuts=given)
        middle = found["push"].cuts["middle"]
        # Along the normal (up), x and y: the push, and its moment about the cut.
        assert middle["force"] == pytest.approx([0, push, 0, 0, 0, push * LENGTH / 2], abs=1e-6)
        assert list(middle["parts"].values())[0] == pytest.approx(middle["force"])
        assert found["press"].cuts["middle"]["force"] == pytest.approx([-5e3, 0, 0, 0, 0, 0], abs=1e-6)
    assert topple.analyse(column)["push"].cuts == {}
    with pytest.raises(topple.InputError, match="cuts.low: the key \"at\" is missing"):
        topple.analyse(column, cuts={"low": {"normal": [0, 0, 1]}})
    with pytest.raises(TypeError, match="cuts: accepted"):
        topple.analyse(column, cuts=3)


def test_arrays_hold_what_the_command_writes(tmp_path):
    program = os.path.join(os.environ["TOPPLE_BIN"], "topple")
    subprocess.run([program, "analyse", "la3", "--code", "aisc360", "-o", str(tmp_path)], check=True, capture_output=True)
    written = json.loads((tmp_path / "results.json").read_text())
    found = topple.analyse("la3", code="aisc360")
    for combination in found.combinations:
        of_file = written["combinations"][combination.name]
        names = found.model.node_names
        rows = np.array([of_file["displacements"][name] for name in names])
        assert np.array_equal(rows, combination.displacements)
        ends = np.array([of_file["members"][name]["end_forces"] for name in found.model.member_names])
        assert np.array_equal(ends.reshape(-1, 2, 6), combination.end_forces)
    mine = found.to_dict()
    assert mine["combinations"] == written["combinations"]
    assert max(one.design_utilisations.max() for one in found.combinations) > 0


def test_results_are_views_that_keep_the_analysis_alive():
    found = topple.analyse("seed_building")
    combination = found["service"]
    arrays = [combination.displacements, combination.end_forces, combination.utilisations, combination.reactions]
    assert np.shares_memory(arrays[0], found["service"].displacements)
    assert np.shares_memory(arrays[1], found["service"].end_forces)
    assert not any(array.flags.writeable for array in arrays)
    before = [array.copy() for array in arrays]
    del found, combination
    gc.collect()
    topple.analyse("seed_building", combinations="collapse")
    assert all(np.array_equal(a, b) for a, b in zip(arrays, before))


def test_the_same_bits_with_any_number_of_threads():
    one, two = (topple.analyse("la3", threads=n) for n in (1, 2))
    assert all(np.array_equal(a.displacements, b.displacements) for a, b in zip(one.combinations, two.combinations))


def test_other_threads_run_while_it_computes():
    counted, stop = [0], threading.Event()

    def count():
        while not stop.is_set():
            counted[0] += 1
            time.sleep(0)

    other = threading.Thread(target=count)
    other.start()
    model = topple.Model("tower_10x10x40")
    before = counted[0]
    topple.analyse(model, threads=1)
    during = counted[0] - before
    stop.set()
    other.join()
    # Without the interpreter it would come to the few turns before and after the call.
    assert during > 200


def test_an_unstable_model_says_what_moves():
    model = frames.column({"push": {"x": 1e3}})
    model["supports"] = {"N0": {"x": True, "y": True, "z": True, "rx": True, "rz": True}}
    with pytest.raises(topple.UnstableModel) as raised:
        topple.analyse(model)
    assert raised.value.kind == "mechanism"
    assert "N1" in raised.value.nodes
    assert raised.value.shape.shape == (2, 6)
    assert np.abs(raised.value.shape[:, :3]).max() == pytest.approx(1)
    assert raised.value.partial is None
    assert isinstance(raised.value, RuntimeError)


def test_loads_beyond_the_critical_ones_leave_the_other_combinations():
    euler = np.pi**2 * E * IZ / (2 * LENGTH) ** 2
    model = frames.column({"light": {"z": -0.1 * euler}, "heavy": {"z": -2 * euler, "y": 1.0}})
    with pytest.raises(topple.UnstableModel) as raised:
        topple.analyse(model, second_order="exact")
    assert raised.value.kind == "buckling" and raised.value.combination == "heavy"
    assert [one.name for one in raised.value.partial.combinations] == ["light"]


def test_progress_is_told_and_what_it_raises_is_raised():
    told = []
    topple.analyse("seed_building", progress=lambda stage, share: told.append((stage, share)))
    assert told and all(isinstance(stage, str) and share <= 1 for stage, share in told)

    def refuse(stage, share):
        raise LookupError(stage)

    with pytest.raises(LookupError):
        topple.analyse("seed_building", progress=refuse)


def test_wrong_requests_are_refused_by_name():
    model = topple.Model("seed_building")
    for options, message in [
        (dict(combinations="servise"), "no such combination: servise.*did you mean service"),
        (dict(lose="P-9"), "no such member: P-9"),
        (dict(lose_each="columns"), "no such group of members: columns"),
        (dict(lose="P-1-1-1", dynamic=True, history="Q*"), "no such node or joint"),
        (dict(lose="P-1-1-1", sudden=0.5), "sudden"),
        (dict(stations=-1), "stations"),
    ]:
        with pytest.raises(topple.InputError, match=message):
            topple.analyse(model, **options)
    with pytest.raises(ValueError, match="dynamic: nothing is lost"):
        topple.analyse(model, dynamic=True)
    with pytest.raises(ValueError, match="has no stations"):
        topple.analyse(model)["service"].diagram("axial")
    with pytest.raises(ValueError, match="no diagram"):
        topple.analyse(model, stations=2)["service"].diagram("moment")
    with pytest.raises(KeyError, match="no result of a combination"):
        topple.analyse(model)["servise"]
    with pytest.raises(TypeError):
        topple.analyse(model, station=2)


def test_files_are_written_as_by_the_command(tmp_path):
    found = topple.analyse("seed_building", stations=10)
    found.write(tmp_path / "out", csv=True, vtu=True)
    names = {file.name for file in (tmp_path / "out").iterdir()}
    assert {"results.json", "displacements.csv", "joints.csv", "service.vtu"} <= names
    assert json.loads((tmp_path / "out/results.json").read_text()) == found.to_dict()
    assert "combination service" in found.summary()


def test_numpy_has_its_blas_threads_again():
    import ctypes
    import ctypes.util

    library = ctypes.CDLL(ctypes.util.find_library("openblas") or "libopenblas.so.0")
    library.openblas_set_num_threads(2)
    topple.analyse("seed_building")
    assert library.openblas_get_num_threads() == 2
