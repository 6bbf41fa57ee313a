"""Misalignment of a mesh over its face from the angles between the axes of its gears in the housing.

Signs. Pinion and wheel turn in planes across x, which runs through the housing from front to rear. With e the direction
from pinion to wheel and the pinion turning in the sense sigma about x (+1: clockwise seen from the front), its teeth
pass the mesh towards t = sigma x cross e. Its front flanks look that way and drive the wheel there. Axes part over
x by their inclination along e and by their skew along x cross e, the wheel against the pinion, so that

    gap of the front flanks = x (inclination sin(alpha_wt) + sigma skew cos(alpha_wt))
    gap of the back flanks  = x (inclination sin(alpha_wt) - sigma skew cos(alpha_wt))

The face position z is positive at the end that comes into mesh last. A right-hand tooth lies further on in the sense
of rotation about +x at larger x: a right-hand pinion that turns about +x (sigma = 1) comes into mesh first at the
rear, and z = -x; in general z = -sigma h x with h = 1 for a right-hand pinion and -1 for a left-hand one. Spur gears
have z = x. Derived here.
"""

from dynamics.flank.axes import AxisMisalignment
from rigdesign.case.gearbox import Gearbox
from rigdesign.case.rotation import last_end, pinion_sense
from rigdesign.coupling.alignment import AxisAngles, axis_angles
from rigdesign.coupling.state import CouplingState
from rigdesign.rig.model import Rig
from thermal.expansion.expansion import Expansion


def misalignment(box: Gearbox, mesh: str, axes: AxisAngles) -> AxisMisalignment:
    """Axes of a mesh of a housing, counted over x from front to rear, over z of its face."""
    last = last_end(box, mesh)
    return AxisMisalignment(
        inclination=last * axes.inclination,
        skew=last * pinion_sense(box, mesh) * axes.skew,
    )


def axes_in_mesh(
    rig: Rig, name: str, coupling_state: CouplingState, shape: Expansion | None = None
) -> AxisMisalignment:
    """Misalignment of mesh ``gearbox.mesh``: as made, by the tilt of its shafts, and of a housing of this shape."""
    box, mesh = rig.mesh(name)
    made = axis_angles(rig, name.split(".")[0], mesh, shape)
    tilt = coupling_state.axis_tilt
    return misalignment(
        box,
        mesh,
        AxisAngles(
            inclination=made.inclination + tilt.get(f"{name}.inclination", 0.0),
            skew=made.skew + tilt.get(f"{name}.skew", 0.0),
        ),
    )
