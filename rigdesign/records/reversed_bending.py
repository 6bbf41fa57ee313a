"""Bending both ways of a gear that two meshes load on opposite flanks: stress ratio, mean stress, Y_M.

Each mesh is rated at the fillet that it loads: R is the compression by the opposite flank over the tension of this
mesh. Under the flank that carries less, R falls below the -1.2 at which Annex B of ISO 6336-3 ends; Y_M then keeps the
stress amplitude of -1.2 (`mean_stress_factor`). It is lower than that of the higher loaded mesh, at a lower stress;
the fillet that is stressed most governs.
"""

from dataclasses import dataclass

from dynamics.contact.tooth_turn import Fillet
from dynamics.rating.mean_stress import mean_stress_factor
from dynamics.standards.iso6336_3_2006 import IDLER_RATIO
from rigdesign.records.gear_loads import application_factor
from rigdesign.records.tooth_history import GearInMesh, gear_meshes, mean_stress, sensitivity
from rigdesign.results.teeth import ToothHistory
from rigdesign.rig.model import Rig


@dataclass(frozen=True, kw_only=True)
class ReversedBending:
    """What reversed bending does to the rating of a root.

    mean : stress that the root holds all the time, added to that of the load [Pa]
    stress_ratio : R with it; strength_factor : Y_M on the strength at R = 0
    """

    mean: float
    stress_ratio: float
    strength_factor: float


def bent_both_ways(rig: Rig, gear: str) -> bool:
    """Whether meshes load both flanks of a gear ``gearbox.gear``."""
    return len({_flank(rig, place) for place in gear_meshes(rig)[gear] if _load(rig, place) > 0.0}) > 1


def of_history(rig: Rig, place: GearInMesh, history: ToothHistory) -> ReversedBending | None:
    """Of a gear in one of its meshes by its stress history; None where it is bent one way."""
    if not _opposite_share(rig, place):
        return None
    root = history.of(_flank(rig, place))
    return ReversedBending(
        mean=history.mean.total,
        stress_ratio=root.ratio,
        strength_factor=mean_stress_factor(root.ratio, history.sensitivity),
    )


def by_standard(rig: Rig, place: GearInMesh, stress: float, speed: float) -> ReversedBending | None:
    """By ISO 6336-3:2006, Annex B: compression 1.2 times the load of the opposite flank; None where bent one way.

    stress : root stress of the load of this mesh [Pa]; speed : of the reference gear [rad/s]
    """
    other = _opposite_share(rig, place)
    if not other:
        return None
    mean = mean_stress(rig, place, speed).total
    ratio = (mean - IDLER_RATIO * other * stress) / (mean + stress)
    return ReversedBending(
        mean=mean, stress_ratio=ratio, strength_factor=mean_stress_factor(ratio, sensitivity(rig, place))
    )


def _opposite_share(rig: Rig, place: GearInMesh) -> float:
    """Load of the flank opposite to that of a mesh, over the load of this mesh [-]; 0 without one of them."""
    own, flank = _load(rig, place), _flank(rig, place)
    if own == 0.0:
        return 0.0
    gear = rig.mesh_gears(rig.mesh_names[place.mesh])[place.index]
    opposite = [_load(rig, other) for other in gear_meshes(rig)[gear] if _flank(rig, other) != flank]
    return max(opposite, default=0.0) / own


def _load(rig: Rig, place: GearInMesh) -> float:
    """Load of a mesh per face width, with K_A, per force in the control mesh [1/m]."""
    name = rig.mesh_names[place.mesh]
    box, own = rig.mesh(name)
    width = box.meshes[own].sharing * rig.pairs[name].face_width
    return application_factor(rig, place.mesh) * abs(rig.mesh_forces[name]) / width


def _flank(rig: Rig, place: GearInMesh) -> Fillet:
    """Flank of the gear that a mesh loads."""
    return (
        "leading" if (place.index == 0) == (rig.mesh_forces[rig.mesh_names[place.mesh]] > 0.0) else "trailing"
    )
