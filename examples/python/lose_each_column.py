"""Which columns of a building may be lost? Each is taken away suddenly, alone; the answer is an exact correction of the
standing building's factor, so that hundreds of losses take seconds.

    python3 lose_each_column.py [MODEL]
"""
import sys

import numpy as np

import topple


def main(name: str = "seed_building") -> int:
    model = topple.Model(name)
    found = topple.analyse(model, lose_each="posts")

    # Worst first: mechanisms, then by the largest utilisation of any joint that is left.
    print(f"{model.title}: {len(found.losses)} columns, each lost alone (dynamic factor 2)")
    for loss in found.losses[:10]:
        worst = max(loss.states, key=lambda state: np.inf if not state.stands else state.utilisation)
        if not worst.stands:
            print(f"  {loss.member:12} {worst.combination}: {worst.mechanism}")
        else:
            print(f"  {loss.member:12} {worst.combination}: {worst.worst} at {worst.utilisation:.2f} in {worst.sense}")

    survived: int = sum(loss.survives for loss in found.losses)
    print(f"{survived} of {len(found.losses)} losses break no further joint")
    return survived


if __name__ == "__main__":
    main(*sys.argv[1:])
