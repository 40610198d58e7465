# %% [markdown]
# # The bending moments of the seed building
#
# The README shows them as the viewer draws them (`docs/pictures/moments.png`). Here the same figure is made from the
# arrays of an analysis. The cells run in a notebook, or all together as a script:
#
#     python3 moments_of_the_seed_building.py [PICTURE.png]

# %%
import sys

import numpy as np

import topple

model = topple.Model("seed_building")
print(model)

# %% [markdown]
# Moments are wanted along the members, so the analysis is asked for stations. The viewer shows a model under the
# combination that it is demolished under.

# %%
found = topple.analyse(model, combinations="collapse", stations=20)
collapse = found["collapse"]
moments = collapse.diagram("moment_y")  # (members, 21), N m
print(f"{moments.shape[0]} members, from {moments.min() / 1e3:.1f} to {moments.max() / 1e3:.1f} kNm")

# %% [markdown]
# What to expect: a slab of 6 m bays hands a triangle of load to each beam along its edges, so moments at the middle of a beam
# tense its lower side (blue, below the axis), and those at its ends the upper one (red).

# %%
beams, _ = model.group("beams")
middle, end = moments[beams, 10], moments[beams, 0]
assert np.all(middle < end)
stiffest = model.member_names[beams[np.argmax(np.abs(end))]]
print(f"the largest end moment is in {stiffest}: {np.abs(end).max() / 1e3:.1f} kNm")

# %% [markdown]
# The figure, seen from where the viewer stands.

# %%
axes = found.plot("collapse", diagram="moment_y")
axes.view_init(elev=12, azim=-52)
axes.set_axis_off()
axes.figure.tight_layout()
if len(sys.argv) > 1:
    axes.figure.savefig(sys.argv[1], dpi=120)
