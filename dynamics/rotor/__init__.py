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

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
