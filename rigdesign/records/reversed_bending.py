"""Bending both ways of a gear that two meshes load on opposite flanks: stress ratio, mean stress, Y_M."""

from dataclasses import dataclass

from dynamics.standards.iso6336_3_2006 import IDLER_RATIO, Y_M
from rigdesign.records.tooth_history import GearInMesh, gear_meshes, mean_stress, sensitivity
from rigdesign.results.tooth_history import ToothHistory
from rigdesign.rig.model import Rig


@dataclass(frozen=True, kw_only=True)
class ReversedBending:
    """What reversed bending does to the rating of a root.

    mean : stress that the root holds all the time, added to that of the load [Pa]
    stress_ratio : R with it; strength_factor : Y_M of ISO 6336-3 on the strength at R = 0
    """

    mean: float
    stress_ratio: float
    strength_factor: float


def of_history(rig: Rig, gear: str, history: ToothHistory) -> ReversedBending | None:
    """By the stress history of a gear ``gearbox.gear``; None for one that is bent one way."""
    if not _lower_flank(rig, gear_meshes(rig)[gear]):
        return None
    return ReversedBending(
        mean=history.mean.total,
        stress_ratio=history.stress_ratio,
        strength_factor=history.mean_stress_factor,
    )


def by_standard(rig: Rig, gear: str, stress: float, speed: float) -> ReversedBending | None:
    """By ISO 6336-3:2006, Annex B: compression 1.2 times the load of the other flank.

    stress : root stress of the load [Pa]; speed : of the reference gear [rad/s]
    """
    places = gear_meshes(rig)[gear]
    other = _lower_flank(rig, places)
    if not other:
        return None
    mean = mean_stress(rig, places[0], speed).total
    ratio = (mean - IDLER_RATIO * other * stress) / (mean + stress)
    return ReversedBending(
        mean=mean, stress_ratio=ratio, strength_factor=Y_M(ratio, sensitivity(rig, places[0]))
    )


def _lower_flank(rig: Rig, places: list[GearInMesh]) -> float:
    """Load of the flank that carries less over that of the other, per face width [-]; 0 for one loaded flank."""
    loads = {True: 0.0, False: 0.0}
    for place in places:
        name = rig.mesh_names[place.mesh]
        force = rig.mesh_forces[name]
        leading = (place.index == 0) == (force > 0.0)
        loads[leading] = max(loads[leading], abs(force) / rig.pairs[name].face_width)
    highest = max(loads.values())
    return min(loads.values()) / highest if highest > 0.0 else 0.0
