"""The gear pairs of the reference, a pair at a position as two plane bodies, and what is kept of a result."""

from dataclasses import dataclass, replace
from functools import lru_cache
from math import pi
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from dynamics.gear.flank import FlankField
from dynamics.gear.microgeometry import Microgeometry
from dynamics.gear.pair import GearPair
from dynamics.gear.tooth_form import ToothForm
from rigdesign.case.loader import load_case
from rigdesign.rig.model import build_rig
from tests.reference.tooth_contact.deck import PENALTY, STEEL, ContactPair, PlaneModel, PlaneResult, solve
from tests.reference.tooth_contact.section import MM, EdgeSizes, PlaneMesh, gear_section

Array = NDArray[np.float64]
PairName = Literal["uhcf", "fzg_c"]
TEETH = 5
PAIRS = range(-2, 3)


@dataclass(frozen=True, kw_only=True)
class ContactCase:
    """A gear pair under torque at the pinion [N m].

    profile_crowning : C_alpha of pinion and wheel [m]
    """

    pair: GearPair
    torque: float
    profile_crowning: tuple[float, float] = (0.0, 0.0)

    @property
    def width(self) -> float:
        """Face width in contact [m]."""
        return self.pair.face_width

    @property
    def force(self) -> float:
        """In the line of action [N]."""
        return self.torque / self.pair.base_radii[0]

    @property
    def micro(self) -> tuple[Microgeometry, Microgeometry]:
        """Modifications that a plane section can have."""
        first, second = self.profile_crowning
        return Microgeometry(profile_crowning=first), Microgeometry(profile_crowning=second)

    @property
    def body_twist(self) -> float:
        """Twist of both bodies between bore and root circle under the torque, along the line of action [m].

        Ring under shear: T/(4 pi G b) (1/r_i^2 - 1/r_o^2).
        """
        shear = STEEL[0] * 1e6 / (2.0 * (1.0 + STEEL[1]))
        radii = zip(self.pair.base_radii, self.pair.bore_diameters, self.pair.root_radii, strict=True)
        return sum(
            self.force * base**2 / (4.0 * pi * shear * self.width) * (4.0 / bore**2 - 1.0 / root**2)
            for base, bore, root in radii
        )


@lru_cache
def contact_case(name: str) -> ContactCase:
    """``uhcf``, ``uhcf_crowned``: test gears of the prototype at 180 N m; ``fzg_c``: FZG gears type C at 302 N m."""
    if name == "fzg_c":
        pair = build_rig(load_case("cases/fzg"), "standard").pairs["test.main"]
        return ContactCase(pair=replace(pair, tip_diameters=(82.46e-3, 118.36e-3)), torque=302.0)
    pair = build_rig(load_case("cases/uhcf_prototype"), "standard").pairs["test.main"]
    crowning = 7e-6 if name == "uhcf_crowned" else 0.0
    return ContactCase(pair=pair, torque=180.0, profile_crowning=(crowning, crowning))


@lru_cache(maxsize=4)
def gear_mesh(case: ContactCase, index: int, sizes: EdgeSizes) -> PlaneMesh:
    """Section of gear ``index`` with its tooth 0 on the x axis."""
    pair = case.pair
    flank = FlankField(pair=pair, index=index, micro=case.micro[index])

    def removed(roll: Array) -> Array:
        return flank.modification(roll, 0.0)

    cut = removed if case.profile_crowning[index] else None
    bore = 0.5 * pair.bore_diameters[index]
    return gear_section(ToothForm(gear=pair.gears[index]), bore, teeth=TEETH, sizes=sizes, removed=cut)


def contact_model(
    case: ContactCase, path: float, sizes: EdgeSizes, *, penalty: float = PENALTY
) -> PlaneModel:
    """Pinion and wheel with tooth pair 0 at a path position [m] before the load, pairs j at ``path`` - j base pitches.

    Pinion tooth j meets wheel tooth -j. The side whose corner may touch is the slave: the wheel's ahead of the middle
    of the path, the pinion's behind it.
    """
    pair = case.pair
    bodies = []
    for index, gear in enumerate(pair.gears):
        roll = pair.rolling_radii[index] + (path if index == 0 else -path)
        angle = pair.working_pressure_angle + gear.base_half_angle - roll / gear.base_radius + index * pi
        centre = (index * pair.centre_distance * MM, 0.0)
        bodies.append(gear_mesh(case, index, sizes).placed(angle, centre))
    middle = 0.5 * (pair.path.start + pair.path.end)
    pairs = []
    for j in PAIRS:
        sides = ((0, (f"flank_{j}", f"tip_{j}")), (1, (f"flank_{-j}", f"tip_{-j}")))
        slave, master = sides if path - j * pair.base_pitch >= middle else sides[::-1]
        pairs.append(ContactPair(name=f"{j}", slave=slave, master=master))
    return PlaneModel(
        bodies=bodies,
        thickness=case.width * MM,
        pairs=pairs,
        driven=(0, "bore"),
        held=(1, "bore"),
        lever=pair.base_radii[0] * MM,
        penalty=penalty,
    )


def solve_contact(
    case: ContactCase,
    path: float,
    sizes: EdgeSizes,
    folder: Path,
    *,
    penalty: float = PENALTY,
    start: float = 20e-6,
) -> dict[str, Any]:
    """Loaded contact with pair 0 at ``path`` [m]; what is kept of it, SI (see the README of this folder).

    start : approach from which the torque takes over [m]
    """
    model = contact_model(case, path, sizes, penalty=penalty)
    result = solve(model, folder, first=[start * MM], force=case.force)
    return _kept(case, path, model, result)


def _kept(case: ContactCase, path: float, model: PlaneModel, result: PlaneResult) -> dict[str, Any]:
    torque = case.torque * MM
    teeth = []
    for pair in model.pairs:
        j = int(pair.name)
        moment = result.forces[pair.name][1] * (1.0 if pair.slave[0] == 0 else -1.0)
        force = result.forces[pair.name][0] * (1.0 if pair.slave[0] == 1 else -1.0)
        roots = [root_stress(model, result, body, sign * j) for body, sign in ((0, 1), (1, -1))]
        teeth.append(
            {
                "tooth_pair": j,
                "path": path - j * case.pair.base_pitch,
                "share": moment / torque,
                "force": float(np.hypot(*force)),
                "direction": float(np.arctan2(force[0], -force[1])) if np.any(force) else None,
                "pressure": result.pressure[pair.name] * 1e6,
                "root_stress": [root["stress"] for root in roots],
                "root_stress_extrapolated": [root["extrapolated"] for root in roots],
                "root_radius": [root["radius"] for root in roots],
                "root_tangent_angle": [root["tangent"] for root in roots],
            }
        )
    return {
        "path": path,
        "approach": result.approach / MM,
        "torque_balance": sum(tooth["share"] for tooth in teeth) - 1.0,
        "nodes": int(model.starts[-1]),
        "seconds": result.seconds,
        "pairs": teeth,
    }


def root_stress(model: PlaneModel, result: PlaneResult, body: int, tooth: int) -> dict[str, float]:
    """Largest tension along the fillet of the working side: stress [Pa], radius [m], angle of the tangent [rad].

    Stress on the free surface from the strain along it, at the middle of the edges, in plane strain; ``extrapolated``
    is that of CalculiX, from its integration points to the nodes.
    """
    mesh, start = model.bodies[body], model.starts[body]
    line = mesh.lines[f"fillet_{tooth}"]
    points, moved = mesh.points[line], result.displacement[line + start]
    along, stretch = points[2::2] - points[:-2:2], moved[2::2] - moved[:-2:2]
    strain = (stretch * along).sum(axis=1) / (along**2).sum(axis=1)
    stress = STEEL[0] / (1.0 - STEEL[1] ** 2) * strain
    top = int(np.argmax(stress))
    tangent = along / np.hypot(*along.T)[:, None]
    middle = line[1::2]
    sigma = result.stress[middle + start]
    given = tangent[:, 0] ** 2 * sigma[:, 0] + tangent[:, 1] ** 2 * sigma[:, 1]
    given += 2.0 * tangent[:, 0] * tangent[:, 1] * sigma[:, 3]
    centre = mesh.points[mesh.lines["bore"][:-1:2]].mean(axis=0)
    tip = mesh.points[mesh.lines[f"tip_{tooth}"]][[0, -1]].mean(axis=0) - centre
    axis = tip / np.hypot(*tip)
    return {
        "stress": float(stress[top]) * 1e6,
        "extrapolated": float(given.max()) * 1e6,
        "radius": float(np.hypot(*(mesh.points[middle[top]] - centre))) / MM,
        "tangent": float(np.arccos(min(1.0, abs(float(tangent[top] @ axis))))),
    }
