"""What hostile.py changes: one file of each kind that holds most of what the format has."""
import json

MODEL = {
    "topple": 1, "title": "bay",
    "materials": {"steel": {"youngs_modulus": 2.1e11, "poisson_ratio": 0.3, "density": 7850, "yield_strength": 2.35e8, "thermal_expansion": 1.2e-5},
                  "concrete": {"youngs_modulus": 3e10, "poisson_ratio": 0.2, "density": 2500,
                               "compressive_strength": 3e7, "tensile_strength": 3e6,
                               "fracture": {"method": "voronoi", "cell": 0.5, "jitter": 0.9}}},
    "sections": {"col": {"catalogue": "HEB200"}, "beam": {"shape": "rectangle", "depth": 0.3, "width": 0.2}},
    "nodes": {"A": [0, 0, 0], "B": [4, 0, 0], "C": [4, 4, 0], "D": [0, 4, 0],
              "E": [0, 0, 3], "F": [4, 0, 3], "G": [4, 4, 3], "H": [0, 4, 3]},
    "members": {"P1": {"nodes": ["A", "E"], "section": "col", "material": "steel", "joints": ["j", "j"]},
                "P2": {"nodes": ["B", "F"], "section": "col", "material": "steel", "joints": ["j", "j"]},
                "P3": {"nodes": ["C", "G"], "section": "col", "material": "steel", "joints": ["j", "j"]},
                "P4": {"nodes": ["D", "H"], "section": "col", "material": "steel", "joints": ["j", "j"]},
                "B1": {"nodes": ["E", "F"], "section": "beam", "material": "steel", "joints": ["j", "j"]},
                "B2": {"nodes": ["F", "G"], "section": "beam", "material": "steel", "joints": ["j", "j"]},
                "B3": {"nodes": ["G", "H"], "section": "beam", "material": "steel", "joints": ["j", "j"]},
                "B4": {"nodes": ["H", "E"], "section": "beam", "material": "steel", "joints": ["j", "j"]}},
    "joints": {"j": {"capacity": {"force": [4e6, 2e5, 2e5], "moment": [1e5, 2e5, 2e5]}, "strength": 1.0,
                     "ductility": {"moment_y": 0.02}},
               "edge": {"capacity_per_length": {"tension": 4e5, "compression": 4e6, "shear_y": 4e5, "shear_z": 6e4}}},
    "panels": {"S": {"nodes": ["E", "F", "G", "H"], "thickness": 0.2, "material": "concrete", "joint": "edge"}},
    "supports": {"A": "fixed", "B": "fixed", "C": "fixed", "D": "fixed"},
    "loads": {"dead": {"self_weight": 1.0},
              "live": {"nodes": {"E": {"x": 1000}}, "members": {"B1": [{"uniform": {"z": -2000}, "from": 0.5, "to": 3}, {"temperature": {"uniform": 20, "gradient_z": 15}}]}, "panels": {"S": {"pressure": 1500}}}},
    "combinations": {"collapse": {"dead": 1, "live": 0.5}},
}
PLAIN = json.loads(json.dumps(MODEL))  # what tables can hold
del PLAIN["materials"]["concrete"]["fracture"]
SCENARIO = {
    "topple": 1, "model": "m.json", "combination": "collapse", "step": 0.02, "duration": 1.0, "seed": 3,
    "standing": "static", "failure": {"sudden": 1.5}, "impact": {"restitution": 0.2},
    "debris": {"friction": 0.6, "restitution": 0.1, "limit": 100, "smallest_volume": 0.001},
    "fracture": {"method": "local", "points": [5, 9], "length": [0.3, 0.9], "ring": 0.4},
    "events": [
        {"at": 0.0, "projectile": {"from": [-3, 2, 2], "velocity": [20, 0, 0], "mass": 200, "radius": 0.3}},
        {"at": 0.1, "cut": {"joints": ["P1:1"]}},
        {"at": 0.1, "remove": {"members": ["B3"]}},
        {"at": 0.2, "charge": {"centre": [4, 0, 1], "radius": 2, "strength": [0.1, 1]}},
        {"at": 0.2, "weaken": {"members": ["P4"], "strength": 0.4, "stiffness": 0.5, "over": 0.3, "stages": 3}},
        {"at": 0.3, "wrecking_ball": {"anchor": [0, 0, 9], "from": [-3, 0, 5], "cable": 6, "mass": 500, "radius": 0.5}},
        {"at": 0.4, "gravity": [0.5, 0, -9.8]},
        {"at": 0.5, "load": {"nodes": {"H": {"z": -1000}}}}],
}
PANEL = {"topple": 1, "seed": 2, "panel": {"outline": [[0, 0], [3, 0], [3, 2], [0, 2]], "thickness": 0.2, "density": 2400},
         "fracture": {"method": "voronoi", "cell": 0.4, "jitter": 0.8}, "hits": [{"at": [1.5, 1], "radius": 0.2}]}
LOCAL = dict(PANEL, fracture={"method": "local", "points": [5, 9], "length": [0.3, 0.7], "ring": 0.3})
QUADS = dict(PANEL, fracture={"method": "quadrilateral", "cell": 0.4, "jitter": 0.3})

# Every other key of a model, in units of its own.
WIDE = {
    "topple": 1, "title": "wide", "units": {"length": "mm", "force": "kN", "mass": "t"}, "gravity": 9806.65,
    "materials": {"steel": {"youngs_modulus": 210, "shear_modulus": 81, "density": 7.85e-9, "yield_strength": 0.355, "thermal_expansion": 1.2e-5},
                  "concrete": {"youngs_modulus": 33, "poisson_ratio": 0.2, "density": 2.5e-9, "thermal_expansion": 1e-5}},
    "sections": {"I": {"shape": "I", "depth": 300, "width": 300, "web": 11, "flange": 19, "fillet": 27},
                 "box": {"shape": "box", "depth": 300, "width": 200, "thickness": 15},
                 "round": {"shape": "circle", "diameter": 60}, "pipe": {"shape": "pipe", "diameter": 200, "thickness": 10},
                 "raw": {"area": 1e4, "Iy": 1e8, "Iz": 1e7, "J": 1e6, "shear_area_y": 4e3, "shear_area_z": 6e3, "plastic_modulus_y": 7e5,
                         "plastic_modulus_z": 2e5, "torsion_modulus": 2e4, "depth": 300, "width": 200},
                 "no shear": {"shape": "rectangle", "depth": 300, "width": 200, "shear_deformation": False}},
    "joints": {"given": {"capacity": {"tension": 2e3, "compression": 8e3, "shear_y": 5e2, "shear_z": 5e2, "torsion": 1e5, "moment_y": 6e5, "moment_z": 2e5}},
               "derived": {"capacity": {"from": "section", "ratio": 0.8}, "interaction": "sum"},
               "pin": {"stiffness": {"ry": 0, "rz": 0}}, "spring": {"stiffness": {"ry": 4e7}},
               "edge": {"capacity_per_length": {"tension": 0.4, "compression": 4, "shear_y": 0.4, "shear_z": 0.2}}},
    "nodes": {"A0": [0, 0, 0], "A1": [0, 0, 3500], "B0": [6000, 0, 0], "B1": [6000, 0, 3500], "C0": [6000, 6000, 0],
              "C1": [6000, 6000, 3500], "D0": [0, 6000, 0], "D1": [0, 6000, 3500]},
    "members": {
        "PA": {"kind": "post", "nodes": ["A0", "A1"], "section": "I", "material": "steel", "up": [1, 0, 0], "roll": 0.1, "joints": ["given", None], "groups": ["west"]},
        "PB": {"kind": "post", "nodes": ["B0", "B1"], "section": "box", "material": "steel", "joints": ["given", None]},
        "PC": {"kind": "post", "nodes": ["C0", "C1"], "section": "pipe", "material": "steel"},
        "PD": {"kind": "post", "nodes": ["D0", "D1"], "section": "no shear", "material": "steel", "joints": ["given", None]},
        "AB": {"kind": "beam", "nodes": ["A1", "B1"], "section": "I", "material": "steel", "joints": ["derived", "pin"], "offsets": [[150, 0, 0], [-150, 0, 0]],
               "design": {"length_y": 6000, "factor_z": 0.9, "restraints": [3000]}},
        "BC": {"kind": "beam", "nodes": ["B1", "C1"], "section": "raw", "material": "steel", "joints": ["derived", "spring"]},
        "CD": {"kind": "beam", "nodes": ["C1", "D1"], "section": "I", "material": "steel"},
        "DA": {"kind": "beam", "nodes": ["D1", "A1"], "section": "I", "material": "steel"},
        "X1": {"kind": "brace", "nodes": ["A0", "B1"], "section": "round", "material": "steel", "axial": "tension"}},
    "panels": {"S1": {"kind": "slab", "nodes": ["A1", "B1", "C1", "D1"], "thickness": 200, "material": "concrete", "model": "membrane", "span": "two-way", "joint": "edge"},
               "W1": {"kind": "wall", "nodes": ["D0", "C0", "C1", "D1"], "thickness": 150, "material": "concrete", "model": "shell", "mesh": [3, 2],
                      "openings": [[[1500, 1000], [2500, 1000], [2500, 2100], [1500, 2100]]], "joint": "edge"}},
    "supports": {"A0": "fixed", "B0": "pinned", "C0": {"x": True, "y": True, "z": 50}, "D0": "fixed", "W1:1": "pinned"},
    "diaphragms": {"level 1": ["A1", "B1", "C1", "D1"]},
    "masses": {"nodes": {"A1": 1.2, "B1": [1, 2, 3, 4]}, "loads": {"live": 0.2}},
    "loads": {
        "dead": {"self_weight": [0, 0, -1], "panels": {"S1": {"pressure": 1.5e-6}}},
        "live": {"panels": {"S1": {"pressure": 3e-6, "temperature": 10}}, "nodes": {"B1": {"z": -50, "rx": 0.5}},
                 "members": {"BC": [{"uniform": {"z": -8e-3}, "frame": "projected"}, {"trapezoid": {"z": [-1e-3, -4e-3]}, "from": 1000, "to": 3000},
                                    {"point": {"y": 2, "rz": 100}, "at": 2500, "frame": "local"},
                                    {"temperature": {"uniform": 20, "gradient_y": 0.01, "gradient_z": 0.02}}],
                             "CD": [{"temperature": {"faces_y": [10, 20], "depth_y": 300, "faces_z": [5, 0], "depth_z": 300}}]}},
        "settle": {"settlements": {"B0": {"z": -10}}}},
    "combinations": {"service": {"dead": 1, "live": 1}, "all": {"dead": 1.2, "live": 0.5, "settle": 1}},
}
BUILDING = {"topple": 1, "materials": MODEL["materials"], "sections": MODEL["sections"], "joints": MODEL["joints"],
            "loads": {"dead": {"self_weight": 1}, "live": {}},
            "building": {"name": "A", "origin": [0, 0, 0], "posts": [3, 2], "storeys": 2, "bay": [6.0, [5]], "storey_height": [4.5, 3.5],
                         "post": [{"storeys": [1, 1], "section": "col", "material": "steel", "joint": "j"},
                                  {"storeys": [2, 2], "section": "col", "material": "steel", "joint": "j"}],
                         "beam": {"section": "beam", "material": "steel", "joint": "j", "groups": ["floors"]},
                         "slab": {"thickness": 0.2, "material": "concrete", "joint": "edge", "model": "membrane", "pressure": {"dead": 1500, "live": 3000}},
                         "wall": {"thickness": 0.15, "material": "concrete", "joint": "edge", "model": "cladding", "sides": ["x-", "x2"]},
                         "omit": ["P-2-2-2"], "base": "fixed"},
            "combinations": {"all": {"dead": 1, "live": 0.5}}}
# What stands moves, in a frame whose parts break at once.
BRITTLE = json.loads(json.dumps(PLAIN))
del BRITTLE["joints"]["j"]["ductility"]
MOVING = {"topple": 1, "model": "m.json", "combination": "collapse", "step": 0.02, "duration": 0.3, "until_rest": True, "seed": 1,
          "ground": -0.1, "standing": "dynamic", "dynamics": {"substeps": 4, "damping": 0.05, "spectral_radius": 0.8}, "impact": {"restitution": 0.1, "structure_mass": True},
          "failure": {"bracing": "buckling", "mechanism": "hinge"},
          "events": [{"at": 0, "remove": {"members": ["P1"], "supports": ["B"], "groups": ["slabs"]}},
                     {"at": 0.04, "cut": {"members": [{"member": "B2", "where": 0.5}]}},
                     {"at": 0.06, "load": {"nodes": {"H": {"x": 1e4, "rz": 10}}, "panels": {}}}]}
del MOVING["events"][2]["load"]["panels"]
STUDY = {"topple": 1, "title": "t", "base": {"model": "m.json", "analyse": ["--combination", "collapse"]}, "samples": 3, "seed": 7, "sampling": "latin",
         "vary": [{"name": "fy", "at": "/materials/steel/yield_strength", "lognormal": {"mean": 3e8, "cov": 0.07}},
                  {"name": "x", "at": "/nodes/E/0", "uniform": [-0.1, 0.1], "add": True},
                  {"name": "e", "at": "/materials/steel/youngs_modulus", "normal": {"mean": 1, "sd": 0.1, "low": 0.5, "high": 2}, "times": True},
                  {"name": "post", "at": "/sections/col/catalogue", "choice": ["HEB200", "HEB220"], "weights": [1, 2]},
                  {"name": "strong", "joints": "P*", "each": True, "strength": {"normal": {"mean": 1, "sd": 0.1, "low": 0.5}}}],
         "groups": [{"of": ["fy", "e"], "correlation": 0.3}],
         "record": {"use": "largest_use", "drift": "largest_drift", "there": "results:/combinations/collapse/displacements/E/0"},
         "collapse_if": {"use": {"above": 1}}, "fragility": "fy"}
ACTIONS = {"topple": 1, "size": [160, 120], "actions": [
    {"at": 0.0, "camera": {"eye": [40, -40, 20], "target": [9, 12, 8], "field_of_view": 0.8}}, {"at": 0.02, "click": [64, 36]},
    {"at": 0.04, "fire": {"pixel": [64, 40], "speed": 60, "mass": 500, "radius": 0.4}}, {"at": 0.06, "key": "space"},
    {"at": 0.08, "drag": [[60, 30], [70, 30]]}, {"at": 0.1, "set": {"joints": "beams", "moment_y": 5e5}}, {"at": 0.1, "show": "moment_y"},
    {"at": 0.12, "screenshot": "after.png"}, {"at": 0.14, "quit": True}]}
MORE_ACTIONS = {"topple": 1, "size": [64, 48], "actions": [
    {"at": 0.0, "pan": [[20, 10], [30, 10]]}, {"at": 0.01, "zoom": 2}, {"at": 0.01, "fly": [1, 0, 0]}, {"at": 0.02, "select": "P1"},
    {"at": 0.02, "tool": {"name": "charge", "reach": 2}}, {"at": 0.02, "click": [24, 16]}, {"at": 0.04, "gravity": 12},
    {"at": 0.06, "look_at": 0.02}, {"at": 0.06, "go_on": True},
    {"at": 0.08, "restart": {"bracing": "classic", "mechanism": "detach", "sudden": 1.5, "second_order": False, "fracture": "local", "cell": 0.5,
                             "materials": {"steel": 0.9}}},
    {"at": 0.1, "save": "x.topple"}, {"at": 0.1, "load": "x.topple"}, {"at": 0.1, "export": "x.glb"}, {"at": 0.1, "look_at": "present"},
    {"at": 0.12, "quit": True}]}
HISTORY = "time,ax,live\n0,0,1\n0.1,1.5,0.5\n0.2,-1,0\n0.4,0,0\n"
FRAME3DD = """two members
3
1 0 0 0 0
2 100 0 0 0
3 100 100 0 0
2
1 1 1 1 1 1 1
3 1 1 1 1 1 1
2
1 1 2 10 1 1 1 1000 1000 29000 11500 0 7.33e-7
2 2 3 10 1 1 1 1000 1000 29000 11500 0 7.33e-7
1
1
10
1
1
1
0 0 -386.4
1
2 0 -10 0 0 0 0.5
1
1 0 0.1 0
1
2 0 0 0 0
10 90 0.1 0.2
0 0 0 0
1
1 0 -5 0 50
1
2 1e-5 10 10 20 10 0 0
1
3 0 -0.1 0 0 0 0
2
1
0
1e-9
0
10
1
2 0.1 0 0 0
1
1 0.05
1
1
0.5
"""
