"""Draw the contact pattern of the case's pinion at the torques of P1's Figure 7: contact_patterns.svg of the README.

`python -m cases.strain_gauge_rig.contact_patterns [FILE]` from the root of the source tree; a minute, seconds once the
influence numbers are stored. As in P1 the tip is on top; its right is the front end of the face, the one that comes
into mesh first.
"""

import sys
from math import tan
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from dynamics.tooth.mesh_cycle import MeshCycle
from rigdesign.case import load_case
from rigdesign.case.shipped import case_folder
from rigdesign.coupling.mesh_models import mesh_microgeometry
from rigdesign.report.figures.drawing import STYLE, new_figure
from rigdesign.rig.model import build_rig
from tests.published.p1_contact import cycle_at, elastic_contact, elastic_gears

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.collections import QuadMesh

TORQUES = (140.0, 336.0, 483.0)
FACE_POSITIONS, RADII = 61, 240
"""Of the picture, over face and active profile."""


def cycles() -> list[MeshCycle]:
    """Contact of the case's test gears at the torques, cold and quasi-static."""
    rig = build_rig(load_case(case_folder("strain_gauge_rig")), "quick")
    pair = rig.pairs["test.main"]
    mesh = elastic_contact(
        pair, mesh_microgeometry(rig, "test.main", pair), elastic_gears(pair), FACE_POSITIONS
    )
    return [cycle_at(mesh, torque) for torque in TORQUES]


def draw(axes: "Axes", cycle: MeshCycle, highest: float) -> "QuadMesh":
    """Pressure over face and radius of the pinion, up to ``highest`` [Pa]."""
    pattern, pair = cycle.pattern(0), cycle.points.pair
    active = pair.rolling_radii[0] + np.array([pair.path.start, pair.path.end])
    rolls = np.linspace(*active, RADII)
    pressure = np.zeros((RADII, len(pattern.face)))
    for column in range(len(pattern.face)):
        # beyond the path a tip edge goes over places that the flank has touched already
        own = pattern.path - pattern.face[column] * tan(pair.base_helix_angle)
        flank = ~pattern.edge[:, column] & (own >= pair.path.start) & (own <= pair.path.end)
        order = np.argsort(pattern.roll[flank, column], kind="stable")
        touched = (part[flank, column][order] for part in (pattern.roll, pattern.pressure))
        pressure[:, column] = np.interp(rolls, *touched)
    axes.set_facecolor("#e8e8e8")
    shown = axes.pcolormesh(
        1e3 * pattern.face, 1e3 * np.hypot(rolls, pair.base_radii[0]), 1e-6 * np.ma.masked_less_equal(pressure, 0.0),
        shading="nearest", cmap="cividis", vmin=0.0, vmax=1e-6 * highest, rasterized=True,
    )  # fmt: skip
    axes.set_xlim(500.0 * pair.face_width, -500.0 * pair.face_width)
    axes.set_ylim(*(1e3 * np.hypot(active, pair.base_radii[0])))
    axes.grid(visible=False)
    axes.set_xlabel("face position z [mm]")
    axes.set_title(f"{cycle.mesh_force * pair.base_radii[0]:.0f} N m")
    return shown


def main(file: Path) -> None:
    import matplotlib as mpl

    found = cycles()
    highest = max(cycle.flank_pressure for cycle in found)
    with mpl.rc_context(STYLE):
        figure = new_figure(2.7)
        panels = figure.subplots(1, len(found), sharey=True)
        for axes, cycle in zip(panels, found, strict=True):
            shown = draw(axes, cycle, highest)
        panels[0].set_ylabel("radius of the pinion [mm]")
        figure.subplots_adjust(left=0.07, right=0.9, top=0.9, bottom=0.19, wspace=0.08)
        bar = figure.colorbar(shown, cax=figure.add_axes((0.915, 0.19, 0.012, 0.71)))
        bar.set_label("pressure [N/mm²]")
        figure.savefig(file, metadata={"Date": None} if file.suffix == ".svg" else None)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).with_name("contact_patterns.svg"))
