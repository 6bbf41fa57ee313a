"""Loaded contact of P1's test gear, and what P1's text says of contact ratio, pattern and stress at the gauges.

Teeth from influence numbers (`elastic_gears`, `elastic_contact`); on Weber and Banaschek's (`contact_of`) for the
search of the gears, which looks at hundreds of sets.

The text has words for the pattern only: no load at the top left and the bottom right of the pinion flank at 140, 336
and 483 N m, and a pattern that stands to the right at low load. Top is the tip of the pinion; right is hence the end of
the face whose root stays without load.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from dynamics.gear.microgeometry import Microgeometry
from dynamics.gear.pair import GearPair
from dynamics.tooth.compliance import InterpolatedCompliance
from dynamics.tooth.elastic_segment import GearModel
from dynamics.tooth.influence_numbers import SectionDivision
from dynamics.tooth.loaded_mesh import LoadedMesh
from dynamics.tooth.mesh_cycle import ContactPattern, MeshCycle, unloaded_contact_ratio
from dynamics.tooth.pair_gap import PairGap
from dynamics.tooth.points import FaceGrid, flank_gap
from rigdesign.postprocessing.loaded_contact import ElasticGear, stress_at
from rigdesign.rig.strain_gauges import RootGauge
from rigdesign.rig.tooth_influence import InfluenceStore, gear_model
from rigdesign.strain_gauge.measuring_point import GaugeCurve

Divided = Callable[[GearModel], GearModel]
"""Model of a gear with the elements that are wanted."""
CORNER = 0.25
"""Part of the active profile, and of the face, that counts as a corner of the flank."""
POSITIONS_UNLOADED = 2000
"""Positions of a mesh cycle for the limit of no load."""
REACH_UNLOADED = 0.2e-3
"""Approach up to which unloaded points are looked at [m]: above the crownings and the twist together."""

FACE_POSITIONS = 25
"""Positions over the face of the contact on influence numbers."""


def standard(model: GearModel) -> GearModel:
    """As in a check: influence numbers of 5 to 10 s a gear, kept in the store."""
    return model


def coarse(model: GearModel) -> GearModel:
    """For quick work, some seconds a gear: contact ratio and gauge stress of P1's gear within 1 % of the standard."""
    division = SectionDivision(profile=4, thickness=2, fillet=8, depth=1, grading=0.4, neighbours=(2, 1, 4))
    return replace(model, division=division, n_face=7)


def elastic_gears(pair: GearPair, divided: Divided = standard) -> tuple[ElasticGear, ElasticGear]:
    """Influence numbers of pinion and wheel, from the store or computed now and stored."""
    store = InfluenceStore.default()
    pinion, wheel = (store.numbers(divided(gear_model(pair, index))) for index in (0, 1))
    numbers = pinion.reversed_face(), wheel
    first, second = (
        ElasticGear(one, InterpolatedCompliance.of(one, pair.base_helix_angle)) for one in numbers
    )
    return first, second


def elastic_contact(
    pair: GearPair,
    micro: tuple[Microgeometry, Microgeometry],
    gears: tuple[ElasticGear, ElasticGear],
    n_face: int = FACE_POSITIONS,
) -> LoadedMesh:
    """Loaded mesh on influence numbers."""
    return LoadedMesh(
        pair=pair,
        gears=(gears[0].compliance, gears[1].compliance),
        grid=FaceGrid.over(pair.face_width, n_face),
        gap=flank_gap(PairGap.of_pair(pair, micro)),
    )


def pinion_gauges(
    gauges: Mapping[str, RootGauge], cycle: MeshCycle, pinion: ElasticGear
) -> dict[str, GaugeCurve]:
    """Stress at gauges in the root of the pinion, by their names in capitals."""
    pair = cycle.points.pair
    return {
        name.split(".")[2].upper(): stress_at(gauge, cycle, pinion, pair, 0) for name, gauge in gauges.items()
    }


def cycle_at(mesh: LoadedMesh, torque: float) -> MeshCycle:
    """Contact over a mesh cycle under a pinion torque [N m], friction left out."""
    return mesh.cycle(torque / mesh.pair.base_radii[0])


def ratio_without_load(mesh: LoadedMesh) -> float:
    """Contact ratio in the limit of no load, modifications included [-]."""
    return unloaded_contact_ratio(mesh.points(REACH_UNLOADED, POSITIONS_UNLOADED))


def torque_of_ratio(mesh: LoadedMesh, ratio: float, most: float = 500.0) -> float:
    """Pinion torque at which the contact ratio is ``ratio`` [N m]; NaN where none between 0.5 N m and ``most`` is."""

    def above(exponent: float) -> float:
        return cycle_at(mesh, float(np.exp(exponent))).contact_ratio - ratio

    low, high = float(np.log(0.5)), float(np.log(most))
    if above(low) * above(high) > 0.0:
        return float("nan")
    return float(np.exp(brentq(above, low, high, xtol=1e-3)))


@dataclass(frozen=True, kw_only=True)
class CornerLoad:
    """Share of the four corners of the active pinion flank that carries load over a mesh cycle [-].

    root_front, root_rear : at the root, on the face end that comes into mesh first and last; tip_front, tip_rear
    centre : face position of the centre of load, from mid-face to the rear [m]
    """

    root_front: float
    root_rear: float
    tip_front: float
    tip_rear: float
    centre: float

    @property
    def start_to_end(self) -> float:
        """Of the corners in which the mesh starts and ends."""
        return 0.5 * (self.root_front + self.tip_rear)

    @property
    def across(self) -> float:
        """Of the other two."""
        return 0.5 * (self.root_rear + self.tip_front)


def corner_load(pair: GearPair, pattern: ContactPattern) -> CornerLoad:
    """Where the corners of the pinion flank carry, flank on flank; ``pattern`` : of the pinion."""
    path = pattern.path_at(pair.base_helix_angle)
    along = (path - pair.path.start) / pair.path.length
    across = np.broadcast_to(pattern.face / pair.face_width + 0.5, along.shape)
    root, tip = (along >= 0.0) & (along <= CORNER), (along <= 1.0) & (along >= 1.0 - CORNER)
    front, rear = across <= CORNER, across >= 1.0 - CORNER

    def share(area: NDArray[np.bool_]) -> float:
        return float((pattern.touched & area).sum()) / float(area.sum())

    return CornerLoad(
        root_front=share(root & front),
        root_rear=share(root & rear),
        tip_front=share(tip & front),
        tip_rear=share(tip & rear),
        centre=pattern.centre[1],
    )
