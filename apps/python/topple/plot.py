"""Drawings by matplotlib: shapes, diagrams, histories, collapses.

Each function draws into the axes that it is given, or into new ones, and returns them. Lengths are m, axes global with z
up. matplotlib is imported when something is drawn.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Optional, Sequence, Union

import numpy as np

from . import COMPONENTS, DIAGRAMS, Analysis, CombinationResult, Model, Motion, Simulation

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["shape", "diagram", "analysis", "history", "simulation"]

POSITIVE, NEGATIVE = "#c8201f", "#2a4fc8"  # as the viewer draws them
MEMBER, GHOST, PANEL = "#3a4654", "#b9c2cb", "#9fb0c0"

# The local axis along which positive values are drawn: moments on the side that they tense.
_DIRECTION = {
    "axial": (0, 0, 1), "shear_y": (0, 1, 0), "shear_z": (0, 0, 1), "torsion": (0, 1, 0),
    "moment_y": (0, 0, 1), "moment_z": (0, -1, 0), "deflection_y": (0, 1, 0), "deflection_z": (0, 0, 1),
}


def _axes_3d(ax: Optional[Any]) -> Any:
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt

    ax = plt.figure(figsize=(8, 6)).add_subplot(projection="3d")
    ax.set_proj_type("persp")
    return ax


def _frame_view(ax: Any, points: np.ndarray) -> None:
    """Makes a metre as long in each direction, around the points."""
    low, high = points.min(axis=0), points.max(axis=0)
    half = np.maximum((high - low) / 2, 0.05 * max(float((high - low).max()), 1e-3))
    middle = (low + high) / 2
    ax.set_xlim(middle[0] - half[0], middle[0] + half[0])
    ax.set_ylim(middle[1] - half[1], middle[1] + half[1])
    ax.set_zlim(middle[2] - half[2], middle[2] + half[2])
    ax.set_box_aspect(half)
    ax.set_xlabel("x (m)")
    ax.set_ylabel("y (m)")
    ax.set_zlabel("z (m)")


def _ends(model: Model) -> np.ndarray:
    """Ends of the members, shape (members, 2, 3)."""
    return model.positions[model.member_nodes] + model.member_offsets


def _size(model: Model) -> float:
    return float(np.ptp(model.positions, axis=0).max()) or 1.0


def _end_displacements(model: Model, displacements: np.ndarray) -> np.ndarray:
    """Of the members' ends, shape (members, 2, 6): nodes carry rigid arms with them."""
    moved = displacements[model.member_nodes].copy()
    moved[..., :3] += np.cross(moved[..., 3:], model.member_offsets)
    return moved


def _bent(model: Model, displacements: np.ndarray, scale: float, places: int) -> np.ndarray:
    """Points along the members, shape (members, places, 3): cubic between the displaced and turned ends."""
    ends, axes, length = _ends(model), model.member_axes, model.member_lengths[:, None]
    moved = _end_displacements(model, displacements)
    local = np.einsum("mij,mej->mei", axes, moved[..., :3])
    turned = np.einsum("mij,mej->mei", axes, moved[..., 3:])
    s = np.linspace(0, 1, places)[None, :]
    h00, h10 = 2 * s**3 - 3 * s**2 + 1, s**3 - 2 * s**2 + s
    h01, h11 = -2 * s**3 + 3 * s**2, s**3 - s**2
    along = (1 - s) * local[:, :1, 0] + s * local[:, 1:, 0]
    across_y = h00 * local[:, :1, 1] + h01 * local[:, 1:, 1] + length * (h10 * turned[:, :1, 2] + h11 * turned[:, 1:, 2])
    across_z = h00 * local[:, :1, 2] + h01 * local[:, 1:, 2] - length * (h10 * turned[:, :1, 1] + h11 * turned[:, 1:, 1])
    offset = np.einsum("mij,mpi->mpj", axes, np.stack([along, across_y, across_z], axis=-1))
    straight = ends[:, :1] + s[..., None] * (ends[:, 1:] - ends[:, :1])
    return straight + scale * offset


def _draw_panels(ax: Any, model: Model, positions: np.ndarray, keep: Optional[np.ndarray] = None) -> None:
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    corners = positions[model.panel_nodes]
    if keep is not None:
        corners = corners[keep]
    if len(corners):
        ax.add_collection3d(Poly3DCollection(corners, facecolor=PANEL, alpha=0.12, edgecolor="none"))


def shape(model: Model, displacements: Optional[np.ndarray] = None, *, scale: Optional[float] = None,
          values: Optional[Sequence[float]] = None, label: str = "", panels: bool = True, cmap: str = "viridis",
          ax: Optional[Any] = None) -> Any:
    """Draws a model, deformed where displacements are given, over its undeformed shape.

    displacements: shape (nodes, 6), m and rad: of a CombinationResult, or the shape of a mode.
    scale: by how much they are enlarged; None: so that the largest is a twentieth of the building.
    values: a number for each member, shown as its colour; label: what they are.
    panels: draw panels as pale surfaces.
    Returns the axes (3D).
    """
    from mpl_toolkits.mplot3d.art3d import Line3DCollection

    ax = _axes_3d(ax)
    positions = np.array(model.positions)
    if displacements is None:
        lines = _ends(model)
    else:
        displacements = np.asarray(displacements, dtype=float)
        if displacements.shape != (len(positions), 6):
            raise ValueError(f"displacements: found shape {displacements.shape}; accepted: ({len(positions)}, 6)")
        if scale is None:
            largest = float(np.linalg.norm(displacements[:, :3], axis=1).max())
            scale = 0.05 * _size(model) / largest if largest > 0 else 1.0
        ax.add_collection3d(Line3DCollection(_ends(model), colors=GHOST, linewidths=0.6))
        lines = _bent(model, displacements, scale, 9)
        positions = positions + scale * displacements[:, :3]
        ax.set_title(f"displacements x {scale:.3g}", fontsize=9)
    drawn = Line3DCollection(lines, linewidths=1.4)
    if values is None:
        drawn.set_color(MEMBER)
    else:
        values = np.asarray(values, dtype=float)
        if values.shape != (len(model.member_names),):
            raise ValueError(f"values: found shape {values.shape}; accepted: ({len(model.member_names)},)")
        drawn.set_array(values)
        drawn.set_cmap(cmap)
        ax.figure.colorbar(drawn, ax=ax, shrink=0.6, label=label)
    ax.add_collection3d(drawn)
    if panels:
        _draw_panels(ax, model, positions)
    _frame_view(ax, np.concatenate([positions, lines.reshape(-1, 3)]))
    return ax


def diagram(combination: CombinationResult, quantity: str = "moment_y", *, scale: Optional[float] = None,
            members: Optional[Sequence[int]] = None, ax: Optional[Any] = None) -> Any:
    """Draws an internal force along the members, red where positive, blue where negative; moments on the side that they
    tense.

    combination: of an analysis with stations: analyse(..., stations=20).
    quantity: one of topple.DIAGRAMS.
    scale: m for a value of 1; None: so that the largest is a twelfth of the building.
    members: indices of those whose diagrams are drawn; None: all.
    Returns the axes (3D). Raises ValueError for another quantity, and where there are no stations.
    """
    from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection

    values = combination.diagram(quantity)
    model = combination.model
    ax = _axes_3d(ax)
    largest = float(np.abs(values).max())
    if scale is None:
        scale = _size(model) / 12 / largest if largest > 0 else 1.0
    ends = _ends(model)
    shares = combination.station_places / model.member_lengths[:, None]
    base = ends[:, :1] + shares[..., None] * (ends[:, 1:] - ends[:, :1])
    out = np.einsum("mij,i->mj", model.member_axes, np.array(_DIRECTION[quantity], dtype=float))
    tips = base + scale * values[..., None] * out[:, None]
    chosen = range(len(ends)) if members is None else members
    for colour, sign in ((POSITIVE, 1), (NEGATIVE, -1)):
        bands, outlines = [], []
        for m in chosen:
            for i in range(values.shape[1] - 1):
                piece = _piece(base[m, i:i + 2], tips[m, i:i + 2], sign * values[m, i:i + 2])
                if piece is not None:
                    bands.append(piece)
                    outlines.append(piece[2:])
        if bands:
            ax.add_collection3d(Poly3DCollection(bands, facecolor=colour, alpha=0.35, edgecolor="none"))
            ax.add_collection3d(Line3DCollection(outlines, colors=colour, linewidths=0.7))
    ax.add_collection3d(Line3DCollection(ends, colors=MEMBER, linewidths=1.2))
    _frame_view(ax, np.concatenate([ends.reshape(-1, 3), tips.reshape(-1, 3)]))
    unit = "m" if quantity.startswith("deflection") else "N" if quantity in ("axial", "shear_y", "shear_z") else "N m"
    ax.set_title(f"{combination.name}: {quantity}, at most {largest:.4g} {unit}", fontsize=9)
    return ax


def _piece(base: np.ndarray, tips: np.ndarray, values: np.ndarray) -> Optional[np.ndarray]:
    """The part of a strip in which the values are positive, as a quadrilateral: base, base, tip, tip."""
    if values[0] <= 0 and values[1] <= 0:
        return None
    if values[0] * values[1] < 0:
        at = values[0] / (values[0] - values[1])
        crossing = base[0] + at * (base[1] - base[0])
        if values[0] > 0:
            return np.array([base[0], crossing, crossing, tips[0]])
        return np.array([crossing, base[1], tips[1], crossing])
    return np.array([base[0], base[1], tips[1], tips[0]])


def analysis(found: Analysis, combination: Optional[str] = None, *, diagram: Optional[str] = None,
             mode: Optional[int] = None, buckling: Optional[int] = None, ax: Optional[Any] = None, **options: Any) -> Any:
    """Draws what an analysis found: the deformed shape, a diagram, a mode of vibration or of buckling.

    combination: its name; None: the first.
    diagram: one of topple.DIAGRAMS; mode, buckling: the number of a mode, 0 for the lowest.
    options: those of shape() or diagram(). Returns the axes (3D).
    """
    chosen = found.combinations[0] if combination is None else found[combination]
    if diagram is not None:
        return globals()["diagram"](chosen, diagram, ax=ax, **options)
    if mode is not None:
        ax = shape(found.model, found.modes[mode].shape, ax=ax, **options)
        ax.set_title(f"mode {mode + 1}: {found.modes[mode].frequency:.4g} Hz", fontsize=9)
        return ax
    if buckling is not None:
        ax = shape(found.model, chosen.buckling[buckling].shape, ax=ax, **options)
        ax.set_title(f"{chosen.name}: buckling at {chosen.buckling[buckling].factor:.4g} of the loads", fontsize=9)
        return ax
    return shape(found.model, chosen.displacements, ax=ax, **options)


def history(motion: Motion, *, component: Union[str, int] = "z", joints: bool = False, ax: Optional[Any] = None) -> "Axes":
    """Draws the course in time of the nodes (displacements) or joints (demands) that `history` of analyse() named.

    component: one of topple.COMPONENTS, or its number.
    joints: demands of joints (N, N m) instead of displacements of nodes (m, rad).
    Returns the axes. Raises ValueError where nothing was named, and for another component.
    """
    if isinstance(component, str):
        if component not in COMPONENTS:
            raise ValueError(f'component: found "{component}"; accepted: {", ".join(COMPONENTS)}')
        component = COMPONENTS.index(component)
    names = motion.history_joints if joints else motion.history_nodes
    if not names:
        raise ValueError("no history was kept; accepted: analyse(..., history=[names of nodes and joints])")
    if ax is None:
        import matplotlib.pyplot as plt

        ax = plt.figure(figsize=(8, 4)).add_subplot()
    values = motion.history_demands if joints else motion.history_displacements
    for i, name in enumerate(names):
        ax.plot(motion.times, values[:, i, component], label=name, linewidth=1.2)
    kinds = ("force along", "moment about") if joints else ("displacement along", "rotation about")
    units = ("N", "N m") if joints else ("m", "rad")
    ax.set_xlabel("time (s)")
    ax.set_ylabel(f"{kinds[component // 3]} {'xyz'[component % 3]} ({units[component // 3]})")
    ax.legend(fontsize=8)
    ax.grid(alpha=0.3)
    return ax


def _rotation(quaternion: np.ndarray) -> np.ndarray:
    x, y, z, w = quaternion
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ])


def simulation(run: Simulation, *, panels: bool = True, ax: Optional[Any] = None) -> Any:
    """Draws a running collapse: what stands dark, what moves or lies red, balls and chunks as what they are.

    Returns the axes (3D).
    """
    from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection

    ax = _axes_3d(ax)
    model = run.model
    ends, owner = _ends(model), run.member_bodies
    moved = _end_displacements(model, run.displacements)
    standing = (ends + moved[..., :3])[owner == -1]
    if len(standing):
        ax.add_collection3d(Line3DCollection(standing, colors=MEMBER, linewidths=1.2))
    if panels:
        _draw_panels(ax, model, np.array(model.positions), run.panel_bodies == -1)
    points = [standing.reshape(-1, 3)]
    lines, faces, balls = [], [], []
    for body in run.bodies:
        turn = _rotation(body.orientation)

        def placed(at: np.ndarray) -> np.ndarray:
            return body.position + (at - body.rest_centre) @ turn.T

        if body.radius > 0:
            balls.append(body.position)
        elif body.chunk is not None:
            vertices, triangles = body.chunk
            faces.extend((body.position + vertices @ turn.T)[triangles])
        else:
            lines.extend(placed(ends[model.member(name)]) for name in body.members)
            faces.extend(placed(model.positions[model.panel_nodes[model.panel(name)]]) for name in body.panels)
    if lines:
        ax.add_collection3d(Line3DCollection(lines, colors=POSITIVE, linewidths=1.0))
        points.append(np.concatenate(lines))
    if faces:
        ax.add_collection3d(Poly3DCollection(faces, facecolor=POSITIVE, alpha=0.15, edgecolor="none"))
        points.append(np.concatenate(faces))
    if balls:
        ax.scatter(*np.array(balls).T, color="black", s=20)
    _frame_view(ax, np.concatenate([part for part in points if len(part)] or [np.array(model.positions)]))
    ax.set_title(f"{run.time:.2f} s", fontsize=9)
    return ax


assert set(_DIRECTION) == set(DIAGRAMS)
