"""Models: from names, files and dicts; names and geometry; errors that say where."""
import gc
import json

import numpy as np
import pytest

import frames
import topple


def test_a_shipped_model_is_found_by_its_name():
    model = topple.Model("seed_building")
    assert (len(model.node_names), len(model.member_names), len(model.panel_names)) == (140, 306, 156)
    assert len(model.joint_names) == 2 * 306 + 4 * 156
    assert model.combination_names == ["service", "collapse"]
    assert model.positions.shape == (140, 3)
    assert model.panel_nodes.shape == (156, 4)


def test_a_file_a_path_and_a_dict_give_the_same_model(tmp_path):
    text = frames.column({"push": {"x": 1e3}})
    file = tmp_path / "column.json"
    file.write_text(json.dumps(text))
    models = [topple.Model(str(file)), topple.Model(file), topple.Model(text)]
    for model in models:
        assert model.title == "Column"
        assert np.array_equal(model.positions, [[0, 0, 0], [0, 0, frames.LENGTH]])
    assert models[0].file == "column.json" and models[2].file == "model"


def test_dicts_may_hold_numpy_numbers_and_arrays():
    text = frames.column({"push": {"x": np.float32(1e3)}})
    text["nodes"] = {"N0": np.zeros(3), "N1": np.array([0, 0, np.int64(4)])}
    model = topple.Model(text)
    assert model.member_lengths.tolist() == [4.0]


def test_units_of_the_file_become_si():
    text = frames.column({"push": {"x": 1.0}}, units={"length": "mm", "force": "kN", "mass": "kg"}, gravity=9806.65)
    text["nodes"] = {"N0": [0, 0, 0], "N1": [0, 0, 4000]}
    text["materials"]["steel"].update(youngs_modulus=210, density=7850e-9)
    text["sections"]["s"] = {"area": 1e4, "Iy": 8e7, "Iz": 2e7, "J": 1e6}
    text["joints"] = {"j": {"capacity": {"tension": 1e3, "moment_y": 1e5}}}
    model = topple.Model(text)
    assert model.units == {"length": ("mm", 1e-3), "force": ("kN", 1e3), "mass": ("kg", 1.0)}
    assert model.member_lengths[0] == pytest.approx(4)
    assert model.gravity == pytest.approx(9.80665)
    moment = topple.SENSES.index("moment_y")
    assert model.capacities[0][[0, 1, moment]] == pytest.approx([1e6, np.inf, 1e5])


def test_names_lead_to_indices_and_back():
    model = topple.Model("seed_building")
    assert model.member_names[model.member("P-2-1-1")] == "P-2-1-1"
    assert model.node_names[model.node("N-1-1-6")] == "N-1-1-6"
    assert model.joint_names[model.joint("P-2-1-1:2")] == "P-2-1-1:2"
    posts = [model.member_names[i] for i in model.members_matching("P-1-1-*")]
    assert posts == [f"P-1-1-{storey}" for storey in range(1, 7)]
    members, panels = model.group("posts")
    assert len(members) == 120 and len(panels) == 0
    assert {model.member_kinds[i] for i in members} == {"post"}
    with pytest.raises(KeyError, match="did you mean P-2-1-1"):
        model.member("P-2-1-l")
    with pytest.raises(KeyError, match="accepted: posts, beams"):
        model.group("columns")


def test_axes_are_right_handed_rows_and_x_runs_along_the_member():
    model = topple.Model("la3")
    ends = model.positions[model.member_nodes] + model.member_offsets
    along = ends[:, 1] - ends[:, 0]
    assert np.linalg.norm(along, axis=1) == pytest.approx(model.member_lengths)
    axes = model.member_axes
    assert axes[:, 0] == pytest.approx(along / model.member_lengths[:, None])
    assert np.cross(axes[:, 0], axes[:, 1]) == pytest.approx(axes[:, 2])


def test_arrays_are_read_only_views_that_keep_the_model_alive():
    model = topple.Model("seed_building")
    positions = model.positions
    assert np.shares_memory(positions, model.positions)
    with pytest.raises(ValueError):
        positions[0, 0] = 1
    before = positions.copy()
    del model
    gc.collect()
    topple.Model("la3")  # something else in the memory that would be free
    assert np.array_equal(positions, before)


def test_an_error_of_a_file_carries_its_place(tmp_path):
    text = frames.column({"push": {"x": 1e3}})
    text["members"]["C1"]["section"] = "S"
    file = tmp_path / "wrong.json"
    file.write_text(json.dumps(text, indent=1))
    line = 1 + next(i for i, one in enumerate(file.read_text().splitlines()) if '"section"' in one)
    with pytest.raises(topple.InputError) as raised:
        topple.Model(file)
    assert raised.value.where == f"wrong.json, line {line}"
    assert raised.value.path == "members.C1.section"
    assert "accepted" in raised.value.problem
    assert str(raised.value) == f"wrong.json, line {line}, members.C1.section: {raised.value.problem}"
    assert isinstance(raised.value, ValueError)


def test_an_error_of_a_dict_carries_its_place_without_a_line():
    text = frames.column({"push": {"x": 1e3}})
    text["materials"]["steel"]["youngs_modulus"] = -1
    with pytest.raises(topple.InputError) as raised:
        topple.Model(text)
    assert (raised.value.where, raised.value.path) == ("model", "materials.steel.youngs_modulus")
    assert str(raised.value) == "model, materials.steel.youngs_modulus: found -1; accepted: a number above 0"


def test_an_error_of_a_table_names_its_column(tmp_path):
    (tmp_path / "nodes.csv").write_text("name,x,y,z\nN0,0,0,zero\n")
    (tmp_path / "model.csv").write_text("key,value\n")
    with pytest.raises(topple.InputError) as raised:
        topple.Model(tmp_path)
    assert raised.value.where is None or "csv" in raised.value.where
    assert "accepted" in str(raised.value)


def test_what_is_no_model_is_refused():
    with pytest.raises(topple.InputError, match="there is no such model"):
        topple.Model("no_such_model")
    with pytest.raises(TypeError, match="found int; accepted: a shipped model's name, a path, or a dict"):
        topple.Model(3)
    with pytest.raises(TypeError, match="accepted: what JSON can hold"):
        topple.Model({"topple": 1, "title": object()})
    with pytest.raises(topple.InputError, match="found nan; accepted: a number that is finite") as raised:
        topple.Model({"topple": 1, "nodes": {"A": np.array([0, 1, np.nan])}})
    assert raised.value.path == "nodes.A[2]"
