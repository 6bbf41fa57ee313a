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

from typing import TYPE_CHECKING

import lazy_loader

if TYPE_CHECKING:
    from dynamics.rotor.bearing import BearingOperation as BearingOperation
    from dynamics.rotor.bearing import OilSupply as OilSupply
    from dynamics.rotor.graph import Drivetrain as Drivetrain
    from dynamics.rotor.graph import assemble as assemble
    from dynamics.rotor.journal import JournalBearing as JournalBearing
    from dynamics.rotor.parts import Coupling as Coupling
    from dynamics.rotor.parts import GearBody as GearBody
    from dynamics.rotor.parts import MeshConnection as MeshConnection
    from dynamics.rotor.parts import Motor as Motor
    from dynamics.rotor.rolling import RollingBearing as RollingBearing
    from dynamics.rotor.shaft import Section as Section
    from dynamics.rotor.shaft import Shaft as Shaft
    from dynamics.rotor.static_loop import LoopLoad as LoopLoad
    from dynamics.rotor.torsional_modes import loop_modes as loop_modes

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
        "bearing": ["BearingOperation", "OilSupply"],
        "graph": ["Drivetrain", "assemble"],
        "journal": ["JournalBearing"],
        "parts": ["Coupling", "GearBody", "MeshConnection", "Motor"],
        "rolling": ["RollingBearing"],
        "shaft": ["Section", "Shaft"],
        "static_loop": ["LoopLoad"],
        "torsional_modes": ["loop_modes"],
    },
)
