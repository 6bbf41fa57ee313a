"""Motion of the drivetrain: periodic over speed, over a schedule in time, in events; orders of unequal teeth.

The dynamic factor of both meshes of `dynamics.rotor` at three speeds of the pinion:

>>> from math import pi
>>> from dynamics.rotor import LoopLoad, assemble
>>> from dynamics.vibration import periodic_response
>>> speeds = [rpm * pi / 30.0 for rpm in (1000.0, 2000.0, 3000.0)]
>>> curve = periodic_response(assemble(rig), (law, law), speeds, LoopLoad(torque=302.0))
>>> print([f"{test:.2f} {slave:.2f}" for test, slave in (point.dynamic_factor for point in curve.points)])
['1.04 1.06', '1.05 1.07', '1.06 1.05']
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
