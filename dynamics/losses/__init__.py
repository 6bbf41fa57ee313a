"""Power losses of meshes, gears in mist and oil baths, oil jets and seals.

Of the pinion of `dynamics.gear` at 2170 rpm, in air of 90 degC with a little oil:

>>> from math import pi
>>> from dynamics.losses import GearRotor, Mist, gear_windage, mist_density
>>> mist = Mist(density=mist_density(0.97, 840.0, oil_volume_fraction=0.005), viscosity=21.5e-6)
>>> loss = gear_windage("test/pinion", GearRotor.of_pair(pair, 0), 2170.0 * pi / 30.0, mist)
>>> print(f"{loss.power:.1f} W")
2.0 W
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
