"""Small frames whose answers are known in closed form."""

LENGTH = 4.0
E = 210e9
AREA, IY, IZ = 0.01, 8e-5, 2e-5
DENSITY = 7850.0


def column(top_loads, pieces=1, **changes):
    """A post of LENGTH, fixed at its foot, free at its top, in `pieces`; `top_loads` by case."""
    nodes = {f"N{i}": [0, 0, LENGTH * i / pieces] for i in range(pieces + 1)}
    members = {
        f"C{i + 1}": {"kind": "post", "nodes": [f"N{i}", f"N{i + 1}"], "section": "s", "material": "steel", "joints": ["j", None]}
        for i in range(pieces)
    }
    model = {
        "topple": 1,
        "title": "Column",
        "materials": {"steel": {"youngs_modulus": E, "poisson_ratio": 0.3, "density": DENSITY}},
        "sections": {"s": {"area": AREA, "Iy": IY, "Iz": IZ, "J": 1e-6, "depth": 0.3, "width": 0.2}},
        "joints": {"j": {"capacity": {"tension": 1e6, "compression": 2e6, "moment_y": 1e5}}},
        "nodes": nodes,
        "members": members,
        "supports": {"N0": "fixed"},
        "loads": {name: {"nodes": {f"N{pieces}": load}} for name, load in top_loads.items()},
        "combinations": {name: {name: 1} for name in top_loads},
    }
    model.update(changes)
    return model
