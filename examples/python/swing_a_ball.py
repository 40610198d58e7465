"""A building of one's own, as a dict, and a wrecking ball: what breaks, what falls, and what it costs in energy.

    python3 swing_a_ball.py [PICTURE.png]
"""
import sys
from typing import Any, Dict

import topple


def building(storeys: int) -> Dict[str, Any]:
    """Posts on a grid of 3 x 3, beams, concrete slabs: written out by the generator of the model format."""
    return {
        "topple": 1, "title": f"{storeys} storeys",
        "materials": {"S355": {"youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7850, "yield_strength": 355e6},
                      "C30": {"youngs_modulus": 33e9, "poisson_ratio": 0.2, "density": 2500}},
        "sections": {"post": {"shape": "box", "depth": 0.25, "width": 0.25, "thickness": 0.012}, "beam": {"catalogue": "IPE360"}},
        "joints": {"full": {"capacity": {"from": "section", "ratio": 0.5}}},
        "building": {"posts": [3, 3], "storeys": storeys, "bay": [6, 6], "storey_height": 3.5, "base": "fixed",
                     "post": {"section": "post", "material": "S355", "joint": "full"},
                     "beam": {"section": "beam", "material": "S355", "joint": "full"},
                     "slab": {"thickness": 0.18, "material": "C30", "pressure": {"live": 2000}}},
        "loads": {"dead": {"self_weight": 1.0}, "live": {}},
        "combinations": {"collapse": {"dead": 1, "live": 0.5}},
    }


def main(picture: str = "") -> topple.Simulation:
    run = topple.Simulation(topple.Scenario({"topple": 1, "duration": 20}, model=building(3)))
    run.on_event(lambda event: print(f"{event['time']:6.2f} s  {event['kind']:14} {event.get('name', '')}"))

    # A ball of three tonnes, let go where its cable is level: it strikes the corner post at x = y = 0.
    run.swing(anchor=[0.0, -1.2, 16.0], origin=[0.0, -13.2, 16.0], cable=12.0)
    run.run(until=4)

    standing = int((run.member_bodies == -1).sum())
    print(f"{run.time:.1f} s: {standing} of {len(run.model.member_names)} members stand, {len(run.poses)} bodies")
    ledger = run.ledger
    print(f"gravity did {ledger['gravity_work'] / 1e3:.0f} kJ; energy is out of balance by {100 * ledger['residual']:.3f} %")
    if picture:
        axes = run.plot()
        axes.figure.savefig(picture, dpi=120)
    return run


if __name__ == "__main__":
    main(*sys.argv[1:])
