"""What hostile_scenes.py leaves out: with these every key of every schema is in some scene (untried_keys())."""
import copy, json, pathlib

import hostile_scenes
from hostile_scenes import ACTIONS, MODEL, SCENARIO

SCHEMAS = pathlib.Path(__file__).resolve().parents[2] / "schemas"

# A model's keys that few models have.
REST = {
    **copy.deepcopy(MODEL),
    "analyses": {"p_delta": "cubic", "modes": 2, "mass": "lumped", "shift": 0.5},
    "frame3dd": {"exaggeration": 10.0, "zoom": 1.0, "increment": 10.0, "method": 1, "tolerance": 1e-9, "mode_exaggeration": 10.0, "animated": [1, 2],
                 "pan": 1.0, "condensation": {"method": 1, "nodes": {"E": [1, 1, 1, 0, 0, 0]}, "modes": [1, 2, 3]}},
    "joint_changes": [{"joints": "P*", "strength": 0.9, "tension": 1e6, "compression": 2e6, "shear_y": 1e5, "shear_z": 1e5, "torsion": 1e5,
                       "moment_y": 1e5, "moment_z": 1e5}],
    "cuts": {"half": {"at": [0, 0, 1.5], "normal": [0, 0, 1], "along": [1, 0, 0], "parts": ["P1", "P2", "P*", "S"]}},
}
REST["members"]["P1"]["design"] = {"length_y": 3.0, "length_z": 3.0, "length_torsion": 3.0, "restraints": [1.5], "moment_factor": 1.1,
                                   "equivalent_moment_y": 0.9, "equivalent_moment_z": 0.9, "stiffener_spacing": 1.0}
REST["members"]["P2"]["design"] = {"factor_y": 1.0, "factor_z": 0.9, "factor_torsion": 1.0, "restraints": "none"}
REST["loads"]["live"]["members"]["B2"] = [{"temperature": {"faces_y": [10, 20], "depth_y": 0.2, "faces_z": [5, 0], "depth_z": 0.3, "expansion": 1e-5}}]
PLAN = {
    "topple": 1, "materials": MODEL["materials"], "sections": MODEL["sections"], "joints": MODEL["joints"],
    "loads": {"dead": {"self_weight": 1}}, "combinations": {"collapse": {"dead": 1}},
    "buildings": [{"name": "T", "origin": [0, 0, 0], "places": {"A": [0, 0], "B": [6, 0], "C": [3, 5]}, "storeys": 2, "storey_height": 3.5,
                   "post": [{"places": ["A", "B", "C*"], "storeys": [1, 2], "section": "col", "material": "steel", "joint": "j", "groups": ["core"]}],
                   "beam": [{"between": [["A", "B", "C", "A"]], "storeys": [1, 2], "section": "beam", "material": "steel", "joint": "j",
                             "load": {"dead": 5000}, "groups": ["floors"], "design": "none"}],
                   "base": "fixed"}]}
DRAWN = {**copy.deepcopy(MODEL), "meshes": {"x": {"file": "x.glb", "bind": {"a": "P1"}, "density": 2000, "material": "concrete"}}}
CUTS = {"cuts": {"half": {"at": [0, 0, 1.5], "normal": [0, 0, 1], "along": [1, 0, 0], "parts": ["P1", "P*"]}, "slope": {"at": [1, 1, 1], "normal": [1, 0.5, 0.2]}}}
GROUND = "time,ax,ay,az\n0,0,0,0\n0.02,1.5,0.5,0\n0.04,-1,0,0.2\n0.1,0,0,0\n"
POSTS = copy.deepcopy(MODEL)
for member in ("P1", "P2", "P3", "P4"):
    POSTS["members"][member]["kind"] = "post"
OPTIMISE = {
    "topple": 1, "base": {"model": "m.json", "analyse": ["--lose-each", "posts", "--combination", "collapse"]}, "seed": 1,
    "vary": [{"name": "fy", "at": "/materials/steel/yield_strength", "normal": {"mean": 2.35e8, "sd": 1e7, "low": 2e8, "high": 3e8}}],
    "record": {"kg": "weight", "worst": "worst_loss_use", "survived": "losses_survived", "use": "largest_use"},
    "optimise": {"least": "kg", "subject_to": {"worst": {"below": 9, "above": 0}}, "runs": 4, "repeats": 1, "finalists": {"designs": 1, "repeats": 1},
                 "unseen": 1, "method": "random",
                 "choose": [{"name": "posts", "at": "/sections/col/catalogue", "choice": ["HEB200", "HEB220"], "weights": [1, 2]},
                            {"name": "depth", "at": "/sections/beam/depth", "grid": [0.3, 0.4]}]}}
CHARGES = {
    "topple": 1, "base": {"scenario": "s.json"}, "seed": 1,
    "record": {"down": "share_down", "height": "height_left", "charges": "charges", "reach": "debris_reach"},
    "optimise": {"greatest": "down", "subject_to": {"charges": {"below": 2.5}}, "runs": 2, "unseen": 0,
                 "choose": [{"name": "posts", "charges": ["P1", "P2"], "together": True, "when": {"choice": [0.02, 0.04]}, "used": {"choice": [True, False]}}]}}
LOSSES = {"topple": 1, "base": {"model": "m.json", "analyse": []}, "vary": [{"name": "lost", "lose_each": "P*"}], "samples": 4, "record": {"use": "largest_use"}}
CONNECT = {**copy.deepcopy(MODEL), "connect": 0.001}
QUAKE = {**ACTIONS, "actions": [{"at": 0.0, "earthquake": {"peak": 3.0, "over": 0.1}}, {"at": 0.02, "earthquake": {"file": "ground.csv"}},
                                {"at": 0.1, "quit": True}]}
QUICK = dict(SCENARIO, duration=0.1, events=[])


def keys_of(tree):
    if isinstance(tree, dict):
        for key, value in tree.items():
            yield key
            yield from keys_of(value)
    elif isinstance(tree, list):
        for value in tree:
            yield from keys_of(value)


def properties_of(schema):
    if isinstance(schema, dict):
        yield from schema.get("properties", {})
        for value in schema.values():
            yield from properties_of(value)
    elif isinstance(schema, list):
        for value in schema:
            yield from properties_of(value)


def untried_keys():
    """Keys that a schema of inputs has and no scene."""
    scenes = [value for place in (vars(hostile_scenes), globals()) for name, value in place.items() if name.isupper() and isinstance(value, dict)]
    tried = {key for scene in scenes for key in keys_of(scene)}
    schemas = [json.loads((SCHEMAS / f"{name}.schema.json").read_text()) for name in ("model", "scenario", "study", "panel", "cuts", "actions")]
    return sorted({key for schema in schemas for key in properties_of(schema)} - tried)
