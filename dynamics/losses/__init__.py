"""Power losses of meshes, gears in mist and oil baths, oil jets and seals.

Of the pinion of `dynamics.gear` at 2170 rpm, in air of 90 degC with a little oil:

>>> from math import pi
>>> from dynamics.losses import GearRotor, Mist, gear_windage, mist_density
>>> mist = Mist(density=mist_density(0.97, 840.0, oil_volume_fraction=0.005), viscosity=21.5e-6)
>>> loss = gear_windage("test/pinion", GearRotor.of_pair(pair, 0), 2170.0 * pi / 30.0, mist)
>>> print(f"{loss.power:.1f} W")
2.0 W
"""

from typing import TYPE_CHECKING

import lazy_loader

if TYPE_CHECKING:
    from dynamics.losses.churning import churning_loss as churning_loss
    from dynamics.losses.immersion import DippedGear as DippedGear
    from dynamics.losses.immersion import OilBath as OilBath
    from dynamics.losses.immersion import RunningGear as RunningGear
    from dynamics.losses.loss import Loss as Loss
    from dynamics.losses.loss import mesh_loss as mesh_loss
    from dynamics.losses.oil_jet import OilJet as OilJet
    from dynamics.losses.oil_jet import oil_acceleration as oil_acceleration
    from dynamics.losses.seal_loss import gap_seal_loss as gap_seal_loss
    from dynamics.losses.seal_loss import lip_seal_loss as lip_seal_loss
    from dynamics.losses.windage import GearRotor as GearRotor
    from dynamics.losses.windage import Mist as Mist
    from dynamics.losses.windage import gear_windage as gear_windage
    from dynamics.losses.windage import mist_density as mist_density

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
        "churning": ["churning_loss"],
        "immersion": ["DippedGear", "OilBath", "RunningGear"],
        "loss": ["Loss", "mesh_loss"],
        "oil_jet": ["OilJet", "oil_acceleration"],
        "seal_loss": ["gap_seal_loss", "lip_seal_loss"],
        "windage": ["GearRotor", "Mist", "gear_windage", "mist_density"],
    },
)
