"""Static analysis and interactive demolition of buildings.

    import topple

    model = topple.Model("la3")                      # a shipped model, a file, or a dict
    found = topple.analyse(model, stations=20)       # topple.Analysis
    service = found.combinations[0]
    service.displacements                            # (nodes, 6), m and rad

Numbers are SI, axes global with z up, unless a docstring says otherwise. Six components always come in the order of
COMPONENTS, senses of joints in that of SENSES, diagrams of members in that of DIAGRAMS.
"""

from . import _core
from ._core import *  # noqa: F401,F403
from ._core import __version__

__all__ = [name for name in dir(_core) if not name.startswith("_")] + ["__version__"]
