"""Elastic rotors against ROSS (tests/reference/rotor) with the same elements, and the book examples of its tests."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from dynamics.rotor.assembly import assemble_rig
from dynamics.rotor.bearing_state import BearingCoefficients, RowSpring, RunningState, isotropic_bearing
from dynamics.rotor.craig_bampton import approach_row
from dynamics.rotor.damped_modes import damped_modes
from dynamics.rotor.graph import Drivetrain
from dynamics.rotor.parts import BearingPlace, GearBody, MeshConnection, Motor
from dynamics.rotor.reduction import ReducedElasticRig, reduce_rig
from dynamics.rotor.rotor_model import AxialLocation, ElasticRig, ShaftPlacement
from dynamics.rotor.shaft import Disc, Section, Shaft
from tests.builders.full_matrices import full_matrices
from tests.builders.harmonic_response import Unbalance, unbalance_load

ROSS: dict[str, Any] = json.loads(
    (Path(__file__).parents[1] / "reference" / "rotor" / "ross.json").read_text(encoding="utf-8")
)
STEEL = ROSS["steel"]
SAME_ELEMENTS = 1e-8
"""Relative: stations are rounded to 1e-9 m, the unscaled state matrix of the peer leaves about nine digits."""


def shaft(name: str, sections: list[list[float]], discs: list[list[float]]) -> Shaft:
    lengths = [length / count for length, _, _, count in sections for _ in range(int(count))]
    nodes = np.concatenate([[0.0], np.cumsum(lengths)])
    return Shaft(
        name=name,
        sections=tuple(
            Section(length=h, outer_diameter=outer, inner_diameter=inner)
            for (_, outer, inner, count), h in ((s, s[0] / s[3]) for s in sections)
            for _ in range(int(count))
        ),
        discs=tuple(
            Disc(
                name=f"disc {i}", position=float(nodes[n]), inertia=polar, mass=m, diametral_inertia=diametral
            )
            for i, (n, m, diametral, polar) in enumerate(discs)
        ),
        density=STEEL["density"],
        shear_modulus=STEEL["shear_modulus"],
        poisson_ratio=STEEL["elastic_modulus"] / (2.0 * STEEL["shear_modulus"]) - 1.0,
        element_length=1.0,
    )


def positions(part: Shaft) -> list[float]:
    return [0.0, *np.cumsum([section.length for section in part.sections]).tolist()]


def rotor(case: dict[str, Any]) -> tuple[ReducedElasticRig, dict[str, BearingCoefficients]]:
    """All modes of a rotor of the file, and its bearings."""
    part = shaft("rotor", case["sections"], case["discs"])
    nodes = positions(part)
    rig = ElasticRig(
        drivetrain=Drivetrain(
            shafts=(part,),
            gears=(),
            meshes=(),
            motor=Motor(shaft="rotor", position=0.0),
            bearings=tuple(
                BearingPlace(name=f"b{i}", shaft="rotor", position=nodes[b[0]])
                for i, b in enumerate(case["bearings"])
            ),
        ),
        placements=(ShaftPlacement(shaft="rotor", y=0.0, z=0.0, sense=1),),
        axial_locations=(AxialLocation(bearing="b0", stiffness=case["bearings"][0][3]),),
        torsional_inertia="consistent",
    )
    bearings = {
        f"b{i}": BearingCoefficients(stiffness=np.reshape(k, (2, 2)), damping=np.reshape(c, (2, 2)))
        for i, (_, k, c, _) in enumerate(case["bearings"])
    }
    return reduce_rig(assemble_rig(rig), bearings), bearings


def poles_of(record: dict[str, Any]) -> np.ndarray:
    return np.array(record["real"]) + 1j * np.array(record["imag"])


def assert_same_poles(ours: np.ndarray, theirs: np.ndarray, tolerance: float) -> None:
    """One to one: the nearest of ours to each of theirs, no one taken twice, none left in their range."""
    assert ours.size == theirs.size
    left = list(ours)
    for pole in theirs:
        near = int(np.argmin(np.abs(np.array(left) - pole)))
        assert abs(left.pop(near) - pole) <= tolerance * abs(pole)


@pytest.mark.parametrize("name", ["undamped", "damped"])
def test_poles_and_decrements_are_those_of_ross(name: str) -> None:
    rig, bearings = rotor(ROSS[name])
    for record in ROSS[name]["modes"]:
        state = RunningState(speed=record["speed"], bearings=bearings)
        theirs = poles_of(record)
        ours = damped_modes(rig, state, 20e3).poles
        assert_same_poles(ours[ours.imag > 1.0], theirs, SAME_ELEMENTS)
    if name == "damped":
        modes = damped_modes(rig, state, 20e3)
        pole = theirs[np.argmin(np.abs(theirs.imag - 6226.8557706))]
        k = int(np.argmin(np.abs(modes.poles - pole)))
        ratio = -pole.real / abs(pole)
        assert modes.logarithmic_decrement[k] == pytest.approx(
            2.0 * math.pi * ratio / math.sqrt(1.0 - ratio**2), rel=SAME_ELEMENTS
        )


def test_unbalance_response_is_that_of_ross() -> None:
    rig, bearings = rotor(ROSS["damped"])
    model = rig.model
    unbalances = (
        Unbalance(place="rotor/disc 0", moment=2e-4, angle=0.7),
        Unbalance(place="rotor/disc 1", moment=1e-4, angle=-1.1),
    )
    record = ROSS["damped"]["unbalance"]
    theirs = np.array(record["real"]) + 1j * np.array(record["imag"])
    for i, speed in enumerate(record["speeds"]):
        load, frequency = unbalance_load(model, unbalances, speed)
        matrices = full_matrices(model, RunningState(speed=speed, bearings=bearings))
        ours = model.rows("rotor/disc 0")[1:3] @ matrices.response(load[:, None], frequency)
        assert ours[:, 0] == pytest.approx(theirs[:, i], rel=SAME_ELEMENTS)


@pytest.mark.parametrize("name", sorted(ROSS["friswell"]))
def test_friswell_examples_as_ross_solves_them(name: str) -> None:
    case = ROSS["friswell"][name]
    rig, bearings = rotor(case)
    for record in case["modes"]:
        if (name, record["speed"]) == ("5.9.4", 0.0):
            continue  # coupling one way between equal planes: a defective pair, known to the root of the rounding only
        ours = damped_modes(rig, RunningState(speed=record["speed"], bearings=bearings), 1e3).poles
        assert_same_poles(ours[ours.imag > 1.0], poles_of(record), SAME_ELEMENTS)


BOOK = {
    ("5.9.1", 0): [86.66, 86.66, 274.31, 274.31],
    ("5.9.1", 1): [85.39, 87.80, 251.78, 294.71, 600.18],
    ("5.9.2", 0): [82.65, 86.66, 254.52, 274.31, 679.49],
    ("5.9.2", 1): [82.33, 86.86, 239.64, 287.25, 583.49],
    ("5.9.9", 0): [90.14, 90.14, 630.73, 630.73, 830.43, 830.43],
    ("5.9.9", 1): [76.19, 103.91, 565.99, 634.23, 647.75, 1174.2],
}
"""Natural frequencies |s| [rad/s] as the tests of ROSS 2.3 quote them from Friswell et al. 2010, pages 206 to 218, to
1e-3; modes of torsion and axial motion left out."""


@pytest.mark.parametrize(("name", "at"), sorted(BOOK))
def test_friswell_examples_of_the_book(name: str, at: int) -> None:
    rig, bearings = rotor(ROSS["friswell"][name])
    speed = ROSS["friswell"][name]["modes"][at]["speed"]
    found = np.abs(damped_modes(rig, RunningState(speed=speed, bearings=bearings), 1e3).poles)
    for value in BOOK[(name, at)]:
        assert np.abs(found / value - 1.0).min() < 1e-3


def test_geared_shafts_of_opposite_sense_as_ross_solves_them() -> None:
    """The line of action of ROSS (coupling matrix of Stringer 2008) is that of our front flank."""
    case = ROSS["geared"]
    names = ("pinion", "wheel")
    shafts = [shaft(name, sections, []) for name, sections in zip(names, case["sections"])]
    nodes = [positions(part) for part in shafts]
    angle, diameters = case["pressure_angle"], case["pitch_diameters"]
    teeth = tuple(int(gear[4]) for gear in case["gears"])
    rig = ElasticRig(
        drivetrain=Drivetrain(
            shafts=tuple(shafts),
            gears=tuple(
                GearBody(
                    name=f"{name} gear", shaft=name, position=nodes[i][n], inertia=polar, mass=m,
                    diametral_inertia=diametral, stiffness=1e11,
                )
                for i, (name, (n, m, diametral, polar, _)) in enumerate(zip(names, case["gears"]))
            ),
            meshes=(
                MeshConnection(
                    name="mesh", pinion="pinion gear", wheel="wheel gear", teeth=(teeth[0], teeth[1]),
                    base_radii=tuple(0.5 * d * math.cos(angle) for d in diameters),  # type: ignore[arg-type]
                    centre_distance=0.5 * sum(diameters),
                ),
            ),
            motor=Motor(shaft="pinion", position=0.0),
            bearings=tuple(
                BearingPlace(name=f"{name} {end}", shaft=name, position=nodes[i][case["bearings"][i][end]])
                for i, name in enumerate(names)
                for end in (0, 1)
            ),
        ),
        placements=(
            ShaftPlacement(shaft="pinion", y=0.0, z=0.0, sense=1),
            ShaftPlacement(
                shaft="wheel", y=0.5 * sum(diameters), z=0.0, sense=-1,
                start=nodes[0][case["gears"][0][0]] - nodes[1][case["gears"][1][0]],
            ),
        ),
        axial_locations=tuple(AxialLocation(bearing=f"{name} 0", stiffness=1e8) for name in names),
        torsional_inertia="consistent",
    )  # fmt: skip
    model = assemble_rig(rig)
    bearings = {
        f"{name} {end}": isotropic_bearing(case["bearings"][i][2], 3e3)
        for i, name in enumerate(names)
        for end in (0, 1)
    }
    springs = (RowSpring(row=approach_row(model, "mesh"), stiffness=case["mesh_stiffness"]),)
    reduced = reduce_rig(model, bearings)
    for record in case["modes"]:
        state = RunningState(speed=record["speed"], bearings=bearings, springs=springs)
        ours = damped_modes(reduced, state, 12e3).poles
        # the gear of ROSS is rigid with its station; ours sits behind a spring of 1e11 N m/rad
        assert_same_poles(ours[ours.imag > 1.0], poles_of(record), 2e-6)
