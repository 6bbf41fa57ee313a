"""Root stress of the teeth over the path of contact, dynamic and quasi-static.

The forces on single teeth are those of the mesh law. Where that comes from influence numbers, so does the stress: at
all points of the fillet and over the face, with the forces on both neighbours. Else every force has the lever of its
place and the stress of the factors of ISO 6336-3.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from dynamics.rating.root_stress import RootInfluence, root_influence, root_stress_over_face
from dynamics.rotor.static_loop import PortModel, StaticState
from dynamics.tooth.mesh_force import ToothForces, tooth_forces
from dynamics.tooth.root_field import PairForces, RootField, Side, root_field
from dynamics.vibration.response_curve import CurvePoint
from rigdesign.coupling.mesh_models import MeshModel
from rigdesign.postprocessing.loaded_contact import ROOT
from rigdesign.results.loads import RootStressPath
from rigdesign.results.teeth import FROM_FACTORS, FROM_INFLUENCE, StressSource
from rigdesign.rig.model import Rig

Array = NDArray[np.float64]
Stress = tuple[Array, Array]
"""Path positions (n,) [m], rising, and root stress (n,) [Pa] of one tooth through its contact."""
Pair = tuple[Stress, Stress]
"""Of pinion and wheel."""
PATH_POINTS = 161
"""Points of a stress history over the path of contact."""


class MeshRoots(Protocol):
    """Root stress of both gears of a warm mesh by the forces on their teeth."""

    @property
    def source(self) -> StressSource:
        """Where the stress per force comes from."""

    def highest(self, forces: PairForces) -> Pair:
        """Highest stress over fillet and face while a tooth is in contact."""

    def at_highest(self, forces: PairForces) -> "MeshRoots":
        """The same where these forces stress the fillets most, for comparison of many states."""


@dataclass(frozen=True)
class FactorRoots:
    """By the form and stress correction factors of ISO 6336-3 at the place of every force, slice by slice."""

    model: MeshModel
    source: StressSource = FROM_FACTORS

    def highest(self, forces: PairForces) -> Pair:
        """Highest stress over the slices."""
        law, pair = self.model.law, self.model.pair
        path, slices = forces.path.ravel(), forces.force.reshape(forces.path.size, -1)
        touching = slices.sum(axis=1) > 0.0
        path, slices = path[touching], slices[touching]
        order = np.argsort(path, kind="stable")
        path, slices = path[order], slices[order]
        pinion, wheel = (
            root_stress_over_face(influence, slices, path, law.slice_shift, pair.face_width).max(axis=1)
            for influence in self._influences
        )
        return (path, pinion), (path, wheel)

    @cached_property
    def _influences(self) -> tuple[RootInfluence, RootInfluence]:
        return root_influence(self.model.pair, 0), root_influence(self.model.pair, 1)

    def at_highest(self, forces: PairForces) -> "FactorRoots":
        """The factors have one point of the fillet."""
        return self


@dataclass(frozen=True, eq=False)
class FieldRoots:
    """By influence numbers, at the points of the fillet that are its root."""

    fields: tuple[RootField, RootField]
    source: StressSource = FROM_INFLUENCE

    def highest(self, forces: PairForces) -> Pair:
        """Highest stress over fillet and face."""
        carrying = forces.path[forces.force.any(axis=2)]
        if not carrying.size:
            nothing = np.zeros(0)
            return (nothing, nothing), (nothing, nothing)
        pinion, wheel = (self._highest(field, forces, carrying) for field in self.fields)
        return pinion, wheel

    @staticmethod
    def _highest(field: RootField, forces: PairForces, carrying: Array) -> Stress:
        course = field.course(forces)
        own = (course.path >= carrying.min()) & (course.path <= carrying.max())
        return course.path[own], course.stress[own].max(axis=(1, 2))

    def at_highest(self, forces: PairForces) -> "FieldRoots":
        """One point of the fillet for every face position."""
        pinion, wheel = (
            field.at(field.course(forces).stress.max(axis=0).argmax(axis=0)) for field in self.fields
        )
        return replace(self, fields=(pinion, wheel))


def mesh_roots(rig: Rig, model: MeshModel) -> MeshRoots:
    """Root stress as the tooth model of the rig has it."""
    if rig.mesh_stiffness != "influence_numbers":
        return FactorRoots(model)
    return FieldRoots((field_of(rig, model, 0), field_of(rig, model, 1)))


def field_of(rig: Rig, model: MeshModel, gear: Literal[0, 1], side: Side = 1) -> RootField:
    """Stress of pinion (0) or wheel (1) per slice force at the points of the fillet that are its root.

    side : 1 the fillet under the loaded flank, -1 the other
    """
    drawn = rig.pairs[model.name]
    numbers, compliance = (
        rig.tooth_influence.of_pair(drawn)[gear],
        rig.tooth_influence.compliances(drawn)[gear],
    )
    field = root_field(model.law, model.pair, numbers, compliance, gear, side)
    return field.within(numbers.fillet.tangent >= ROOT)


def dynamic_forces(
    model: MeshModel, points: Sequence[CurvePoint], mesh: int, every: int = 1
) -> list[PairForces]:
    """Forces on the teeth of a mesh, by its number, at every so many instants of periodic points.

    One mesh period holds every tooth at another place: put together by path they are one tooth's whole contact. All
    points together, as the tables of the law are made once.
    """
    states = np.concatenate(
        [
            [row[mesh, ::every] for row in (p.wave.angle, p.wave.approach, p.wave.omega_1, p.wave.omega_2)]
            for p in points
        ],
        axis=1,
    )
    forces = tooth_forces(model.law, *states)
    ends = np.cumsum([0, *(point.wave.angle[mesh, ::every].size for point in points)])
    return [
        PairForces.of(forces, slice(a, b), front=bool(point.flank[mesh] > 0))
        for point, a, b in zip(points, ends[:-1], ends[1:])
    ]


def static_forces(model: MeshModel, state: StaticState, ports: PortModel, mesh: int) -> PairForces:
    """The same for the quasi-static state of the loop."""
    pinion = ports.pinions[mesh]
    angle = ports.ratios[pinion] * state.angles + state.ports[:, pinion]
    forces: ToothForces = tooth_forces(model.law, angle, state.approach[:, mesh])
    return PairForces.of(forces, front=bool(state.mean_torque[mesh] > 0.0))


def peak(stress: Stress) -> float:
    """Largest root stress [Pa]; 0 without contact."""
    return float(stress[1].max(initial=0.0))


@dataclass(frozen=True)
class StressedGear:
    """A gear at the held stage that stresses it most; base radius [m]."""

    gear: str
    stage: str
    base_radius: float
    source: StressSource


def over_path(place: StressedGear, dynamic: Stress, static: Stress) -> RootStressPath:
    """Both curves on one grid of the rolling angle of the gear, zero at the pitch point."""
    low = min(dynamic[0].min(), static[0].min())
    high = max(dynamic[0].max(), static[0].max())
    path = np.linspace(low, high, PATH_POINTS)

    def on_grid(stress: Stress) -> tuple[float, ...]:
        return tuple(map(float, np.interp(path, *stress, left=0.0, right=0.0)))

    return RootStressPath(
        gear=place.gear,
        stage=place.stage,
        rolling_angle=tuple(float(s) / place.base_radius for s in path),
        dynamic=on_grid(dynamic),
        quasi_static=on_grid(static),
        source=place.source,
    )
