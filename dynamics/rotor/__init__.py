"""Shafts, bearings, joints as a graph and as matrices: torsion or six degrees of freedom, power loop, modes.

Two gearboxes with the gears of `dynamics.gear` and `dynamics.tooth`, braced against each other:

>>> from dynamics.rotor import Coupling, Drivetrain, GearBody, MeshConnection, Motor, Section, Shaft, loop_modes
>>> boxes, gears = ("test", "slave"), ("pinion", "wheel")
>>> inertias = {f"{box}_{gear}": inertia for box in boxes for gear, inertia in zip(gears, pair.inertias)}
>>> rig = Drivetrain(
...     shafts=tuple(Shaft(name=name, sections=(Section(length=0.3, outer_diameter=0.035),)) for name in inertias),
...     gears=tuple(
...         GearBody(name=name, shaft=name, position=0.1, inertia=inertia, stiffness=2e6, damping=50.0)
...         for name, inertia in inertias.items()
...     ),
...     couplings=tuple(
...         Coupling(name=gear, shafts=(f"test_{gear}", f"slave_{gear}"), stiffness=1e5, damping=20.0) for gear in gears
...     ),
...     meshes=tuple(
...         MeshConnection(
...             name=box,
...             pinion=f"{box}_pinion",
...             wheel=f"{box}_wheel",
...             base_radii=pair.base_radii,
...             teeth=pair.teeth,
...             centre_distance=pair.centre_distance,
...         )
...         for box in boxes
...     ),
...     motor=Motor(shaft="slave_wheel", position=0.3, inertia=0.02),
...     bracing_coupling="pinion",
... )
>>> print([f"{mode.frequency:.0f} Hz" for mode in loop_modes(rig, (law, law), highest_frequency=4e3)])
['0 Hz', '500 Hz', '1488 Hz', '3740 Hz']
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from dynamics.rotor.bearing import BearingOperation, OilSupply
    from dynamics.rotor.graph import Drivetrain, assemble
    from dynamics.rotor.journal import JournalBearing
    from dynamics.rotor.parts import Coupling, GearBody, MeshConnection, Motor
    from dynamics.rotor.rolling import RollingBearing
    from dynamics.rotor.shaft import Section, Shaft
    from dynamics.rotor.static_loop import LoopLoad
    from dynamics.rotor.torsional_modes import loop_modes

__all__ = [
    "BearingOperation",
    "Coupling",
    "Drivetrain",
    "GearBody",
    "JournalBearing",
    "LoopLoad",
    "MeshConnection",
    "Motor",
    "OilSupply",
    "RollingBearing",
    "Section",
    "Shaft",
    "assemble",
    "loop_modes",
]

_HOMES = {
    "BearingOperation": "bearing",
    "Coupling": "parts",
    "Drivetrain": "graph",
    "GearBody": "parts",
    "JournalBearing": "journal",
    "LoopLoad": "static_loop",
    "MeshConnection": "parts",
    "Motor": "parts",
    "OilSupply": "bearing",
    "RollingBearing": "rolling",
    "Section": "shaft",
    "Shaft": "shaft",
    "assemble": "graph",
    "loop_modes": "torsional_modes",
}


def __getattr__(name: str) -> object:
    """Import a name on first use."""
    if name in _HOMES:
        return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
