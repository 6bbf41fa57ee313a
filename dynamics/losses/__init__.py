"""Power losses of meshes, gears in mist and oil baths, oil jets and seals.

Of the pinion of `dynamics.gear` at 2170 rpm, in air of 90 degC with a little oil:

>>> from math import pi
>>> from dynamics.losses import GearRotor, Mist, gear_windage, mist_density
>>> mist = Mist(density=mist_density(0.97, 840.0, oil_volume_fraction=0.005), viscosity=21.5e-6)
>>> loss = gear_windage("test/pinion", GearRotor.of_pair(pair, 0), 2170.0 * pi / 30.0, mist)
>>> print(f"{loss.power:.1f} W")
2.0 W
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from dynamics.losses.churning import churning_loss
    from dynamics.losses.immersion import DippedGear, OilBath, RunningGear
    from dynamics.losses.loss import Loss, mesh_loss
    from dynamics.losses.oil_jet import OilJet, oil_acceleration
    from dynamics.losses.seal_loss import gap_seal_loss, lip_seal_loss
    from dynamics.losses.windage import GearRotor, Mist, gear_windage, mist_density

__all__ = [
    "DippedGear",
    "GearRotor",
    "Loss",
    "Mist",
    "OilBath",
    "OilJet",
    "RunningGear",
    "churning_loss",
    "gap_seal_loss",
    "gear_windage",
    "lip_seal_loss",
    "mesh_loss",
    "mist_density",
    "oil_acceleration",
]

_HOMES = {
    "DippedGear": "immersion",
    "GearRotor": "windage",
    "Loss": "loss",
    "Mist": "windage",
    "OilBath": "immersion",
    "OilJet": "oil_jet",
    "RunningGear": "immersion",
    "churning_loss": "churning",
    "gap_seal_loss": "seal_loss",
    "gear_windage": "windage",
    "lip_seal_loss": "seal_loss",
    "mesh_loss": "loss",
    "mist_density": "windage",
    "oil_acceleration": "oil_jet",
}


def __getattr__(name: str) -> object:
    """Import a name on first use."""
    if name in _HOMES:
        return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
