"""Elastic rotors against closed forms: beams, rigid rotors, Jeffcott, internal damping, the geared rotor of V5."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.linalg import eigh

from dynamics.rotor.assembly import ElasticModel, assemble_rig
from dynamics.rotor.beam import ShearRule, shear_coefficient
from dynamics.rotor.bearing_state import BearingCoefficients, RowSpring, RunningState, isotropic_bearing
from dynamics.rotor.craig_bampton import approach_row
from dynamics.rotor.damped_modes import damped_modes, mode_character, orbit
from dynamics.rotor.graph import Drivetrain, assemble
from dynamics.rotor.parts import BearingPlace, MeshConnection, Motor
from dynamics.rotor.reduction import reduce_rig
from dynamics.rotor.rotor_model import AxialLocation, ElasticRig, ShaftPlacement
from dynamics.rotor.shaft import STEEL_DENSITY, STEEL_SHEAR_MODULUS, Disc, Section, Shaft
from tests.builders.elastic_rig import bearings, gear_on, prototype_drivetrain, prototype_rig, single_shaft
from tests.builders.full_matrices import full_matrices
from tests.builders.harmonic_response import Unbalance, unbalance_load
from tests.builders.static_deflection import static_deflection

OUTER, INNER, LENGTH = 0.060, 0.020, 0.500
MODULUS = 2.0 * STEEL_SHEAR_MODULUS * 1.3
AREA = 0.25 * math.pi * (OUTER**2 - INNER**2)
MOMENT = math.pi / 64.0 * (OUTER**4 - INNER**4)
TUBE = (Section(length=LENGTH, outer_diameter=OUTER, inner_diameter=INNER),)
KAPPA = float(shear_coefficient(np.array(INNER / OUTER), 0.3))


def pinned_frequency(mode: int, shear: ShearRule) -> float:
    """[Hz] of a pinned Timoshenko beam: sin(n pi x / L) solves it, a quadratic in omega^2 (Timoshenko 1921)."""
    wave = mode * math.pi / LENGTH
    inertia = STEEL_DENSITY * AREA + STEEL_DENSITY * MOMENT * wave**2
    if shear == "rigid":
        return math.sqrt(MODULUS * MOMENT * wave**4 / inertia) / (2.0 * math.pi)
    soft = 1.0 / (KAPPA * STEEL_SHEAR_MODULUS)
    inertia += STEEL_DENSITY * MOMENT * MODULUS * soft * wave**2
    quartic = STEEL_DENSITY**2 * MOMENT * soft
    root = math.sqrt(inertia**2 - 4.0 * quartic * MODULUS * MOMENT * wave**4)
    return math.sqrt((inertia - root) / (2.0 * quartic)) / (2.0 * math.pi)


def pinned_modes(elements: int, shear: ShearRule) -> np.ndarray:
    """[Hz] in one plane, the end deflections taken out."""
    model = assemble_rig(replace(single_shaft(TUBE, (0.0, LENGTH), LENGTH / elements), shear=shear))
    plane = [i for i, name in enumerate(model.names) if name.endswith(("u_y", "theta_z"))]
    free = np.delete(plane, [0, len(plane) - 2])
    squared = eigh(
        model.stiffness[free][:, free].toarray(), model.mass[free][:, free].toarray(), eigvals_only=True
    )
    return np.asarray(np.sqrt(squared) / (2.0 * math.pi))


@pytest.mark.parametrize(("shear", "order", "finest"), [("cowper", 2.0, 1e-4), ("rigid", 4.0, 1e-7)])
def test_pinned_beam_converges_to_timoshenko(shear: ShearRule, order: float, finest: float) -> None:
    """Shear is constant in an element, so the error of its share falls with h^2; bending alone with h^4."""
    for mode in (1, 2):
        exact = pinned_frequency(mode, shear)
        errors = [pinned_modes(n, shear)[mode - 1] / exact - 1.0 for n in (8, 16, 32)]
        rates = [math.log2(a / b) for a, b in pairwise(errors)]
        assert rates == pytest.approx([order, order], abs=0.15)
        assert 0.0 < errors[-1] < finest * mode**4


def test_nodal_loads_bend_a_beam_exactly() -> None:
    """P L^3 / 48 E I + P L / 4 kappa G A + the yield of two bearings, with two elements only."""
    rig = single_shaft(TUBE, (0.0, LENGTH), 0.5 * LENGTH)
    model = assemble_rig(rig)
    middle = model.freedoms.on_shaft("rotor", 0.5 * LENGTH).rows(model.size)
    for stiffness in (1e8, 3e6):
        state = RunningState(bearings=bearings(rig, stiffness))
        found = static_deflection(model, state, 1e3 * middle[1])
        bent = LENGTH**3 / (48.0 * MODULUS * MOMENT) + LENGTH / (4.0 * KAPPA * STEEL_SHEAR_MODULUS * AREA)
        assert middle[1] @ found.deflection == pytest.approx(1e3 * (bent + 0.5 / stiffness), rel=1e-9)
        assert found.unbalanced == pytest.approx([0.0], abs=1e-9)


def test_film_with_cross_coupling_moves_a_rotor_aside() -> None:
    """Two like bearings share the weight: K u = W / 2 for a shaft that is stiff against them (to its own bending)."""
    rig = single_shaft(TUBE, (0.0, LENGTH), 0.05)
    model = assemble_rig(rig)
    film = np.array([[2.0e5, 1.5e5], [-2.5e5, 4.0e5]])
    state = RunningState(
        bearings={
            name: BearingCoefficients(stiffness=film, damping=np.zeros((2, 2))) for name in ("b0", "b1")
        }
    )
    found = static_deflection(model, state, model.weight())
    weight = 9.80665 * STEEL_DENSITY * AREA * LENGTH
    for port in model.ports.values():
        assert port[:2] @ found.deflection == pytest.approx(
            np.linalg.solve(film, [0.0, -0.5 * weight]), rel=1e-9
        )


@pytest.mark.parametrize("speed", [0.0, 600.0, 1500.0])
def test_rigid_rotor_whirls_as_euler_says(speed: float) -> None:
    """Conical modes of a cylinder on soft bearings at its ends: I_t w^2 -+ I_p s w = k L^2 / 2; forward is higher."""
    stiffness = 1e4
    rig = single_shaft(TUBE, (0.0, LENGTH), 0.05)
    reduced = reduce_rig(assemble_rig(rig), bearings(rig, stiffness, 0.0))
    modes = damped_modes(reduced, RunningState(speed=speed, bearings=bearings(rig, stiffness, 0.0)), 100.0)
    mass = STEEL_DENSITY * AREA * LENGTH
    polar = mass * (OUTER**2 + INNER**2) / 8.0
    across = 0.5 * polar + mass * LENGTH**2 / 12.0
    root = math.sqrt((polar * speed) ** 2 + 2.0 * across * stiffness * LENGTH**2)
    backward, forward = ((sign * polar * speed + root) / (2.0 * across) for sign in (-1.0, 1.0))
    parallel = math.sqrt(2.0 * stiffness / mass)
    found = 2.0 * math.pi * modes.frequency
    # the shaft yields by 1e-4 of what the bearings of 1e4 N/m do
    assert found == pytest.approx([parallel, parallel, backward, forward], rel=1e-4)
    if speed:
        assert (found[3] - found[2]) == pytest.approx(forward - backward, rel=1e-3)
        whirl = mode_character(reduced, modes.shapes).whirl[:, 0]
        assert whirl[2:] == pytest.approx([-1.0, 1.0], abs=1e-6)


def jeffcott(sense: int = 1) -> tuple[ElasticModel, float, float]:
    """Disc in the middle of a light shaft on stiff bearings, a damper at the disc: model, stiffness, mass."""
    mass, diameter, length = 8.0, 0.02, 0.4
    rig = single_shaft(
        (Section(length=length, outer_diameter=diameter),),
        (0.0, 0.5 * length, length),
        0.1,
        discs=(Disc(name="disc", position=0.5 * length, inertia=0.02, mass=mass),),
        density=1e-3,
    )
    rig = replace(rig, shear="rigid", placements=(replace(rig.placements[0], sense=sense),))
    bending = 48.0 * MODULUS * math.pi / 64.0 * diameter**4 / length**3
    return assemble_rig(rig), 1.0 / (1.0 / bending + 0.5 / 1e9), mass


@pytest.mark.parametrize("sense", [1, -1])
def test_jeffcott_rotor_answers_unbalance_in_closed_form(sense: int) -> None:
    model, stiffness, mass = jeffcott(sense)
    damping, moment = 120.0, 3e-4
    state = {
        "b0": isotropic_bearing(1e9),
        "b1": isotropic_bearing(0.0, damping),
        "b2": isotropic_bearing(1e9),
    }
    critical = math.sqrt(stiffness / mass)
    rows = model.rows("rotor/disc")
    for speed in (0.3 * critical, critical, 2.5 * critical):
        load, frequency = unbalance_load(
            model, (Unbalance(place="rotor/disc", moment=moment, angle=0.4),), speed
        )
        matrices = full_matrices(model, RunningState(speed=speed, bearings=state))
        motion = rows[1:3] @ matrices.response(load[:, None], frequency)[:, 0]
        exact = moment * speed**2 / (stiffness - mass * speed**2 + 1j * speed * damping) * np.exp(0.4j)
        # the mass of the shaft is 1e-8 of the disc; at resonance the answer is 1e2 as sensitive
        assert motion == pytest.approx([exact, -1j * sense * exact], rel=1e-5)
        circle = orbit(motion[0], motion[1], sense)
        assert (circle.major, circle.minor) == pytest.approx((abs(exact), abs(exact)), rel=1e-5)


def test_internal_damping_drives_whirl_above_its_threshold() -> None:
    """s_limit = w (1 + c_e / c_i), Kimball 1924, with the modal dampings of the undamped mode (small damping)."""
    rig = single_shaft(
        TUBE[:1], (0.0, LENGTH), 0.05, discs=(Disc(name="disc", position=0.25, inertia=0.05, mass=20.0),),
        damping_time=4e-7,
    )  # fmt: skip
    model = assemble_rig(rig)
    held = bearings(rig, 2e7, 4.0)
    reduced = reduce_rig(model, held)
    k = int(np.flatnonzero(reduced.squared > 1.0)[0])
    shape = reduced.basis[:, k]
    internal = float(shape @ (model.damping @ shape))
    external = sum(4.0 * float(np.sum((port[:2] @ shape) ** 2)) for port in model.ports.values())
    limit = math.sqrt(reduced.squared[k]) * (1.0 + external / internal)
    growth = []
    for share in (0.99, 1.01):  # gyroscopics of the shaft raise the forward mode by 0.2 %
        modes = damped_modes(reduced, RunningState(speed=share * limit, bearings=held), 400.0)
        forward = int(np.argmax(mode_character(reduced, modes.shapes).whirl[:2, 0]))
        growth.append(float(modes.poles[forward].real))
    assert growth[0] < 0.0 < growth[1]
    # without the circulation of the rotating dampers nothing would grow
    assert (
        np.abs(reduced.circulation + reduced.circulation.T) < 1e-9 * np.abs(reduced.circulation).max()
    ).all()


def kahraman(modulus: float) -> ElasticRig:
    """V5: Kahraman, Oezgueven, Houser, Zakrajsek 1992, two like shafts with gears in the middle."""
    names, radius, angle = ("driver", "driven"), 0.0445, math.radians(20.0)
    distance = 2.0 * radius / math.cos(angle)
    section = Section(length=0.254, outer_diameter=0.037, inner_diameter=0.010)
    return ElasticRig(
        drivetrain=Drivetrain(
            shafts=tuple(
                Shaft(name=name, sections=(section,), shear_modulus=modulus / 2.6, element_length=0.0127)
                for name in names
            ),
            gears=tuple(gear_on(f"{name} gear", name, 0.127, 0.0018, 1.84) for name in names),
            meshes=(
                MeshConnection(
                    name="mesh", pinion="driver gear", wheel="driven gear", base_radii=(radius, radius),
                    teeth=(28, 28), centre_distance=distance,
                ),
            ),
            motor=Motor(shaft="driver", position=0.0),
            bearings=tuple(
                BearingPlace(name=f"{name} {end}", shaft=name, position=place)
                for name in names
                for end, place in (("left", 0.0), ("right", 0.254))
            ),
        ),
        placements=(
            ShaftPlacement(shaft="driver", y=0.0, z=0.0, sense=1),
            ShaftPlacement(shaft="driven", y=distance, z=0.0, sense=-1),
        ),
        axial_locations=tuple(AxialLocation(bearing=f"{name} left", stiffness=1e9) for name in names),
    )  # fmt: skip


def test_geared_rotor_of_kahraman() -> None:
    """581, 687 to 691 and 2524 Hz within 2 % (ours 572.9, 681.9, 2521). The elastic modulus is assumed: 2.0e11 Pa would
    give 559.8 and 665.9 Hz; without shear 2.1e11 Pa gives 587.3 and 698.9 Hz."""
    rig = kahraman(2.10e11)
    model = assemble_rig(rig)
    held = bearings(rig, 1e9, 0.0)
    reduced = reduce_rig(model, held)
    spring = RowSpring(row=approach_row(model, "mesh"), stiffness=1e8)
    modes = damped_modes(reduced, RunningState(bearings=held, springs=(spring,)), 3e3)
    for low, high in ((581.0, 581.0), (687.0, 691.0), (2524.0, 2524.0)):
        assert ((modes.frequency > 0.98 * low) & (modes.frequency < 1.02 * high)).any()
    assert modes.real_poles.tolist() == [0.0]
    # across the line of action the gears move as if there were no mesh: 681.9 Hz stands twice more
    assert np.sum(np.abs(modes.frequency / modes.frequency[1] - 1.0) < 1e-6) == 3


def test_torsion_alone_is_the_torsional_model() -> None:
    """Lumped torsional inertia: the same numbers in the same order, so the same chain to rounding."""
    rig = prototype_rig()
    shafts = tuple(replace(shaft, damping_time=1e-6) for shaft in rig.drivetrain.shafts)
    rig = replace(rig, drivetrain=replace(rig.drivetrain, shafts=shafts))
    model = assemble_rig(rig)
    torsional = assemble(rig.drivetrain)
    turns = np.flatnonzero(np.array(model.freedoms.family) == 0)
    for ours, theirs in (
        (model.mass, torsional.inertia),
        (model.stiffness, torsional.stiffness),
        (model.damping, torsional.damping),
    ):
        found = ours[turns][:, turns].toarray()
        assert np.abs(found - theirs).max() < 1e-12 * np.abs(theirs).max()
        assert np.diag(found) == pytest.approx(np.diag(theirs), rel=1e-12)
    loads = model.joint("pinion side", "coupling").load("turn")
    assert loads[turns] == pytest.approx(torsional.twist_load, rel=1e-15)
    assert [name.removesuffix(" turn") for name in np.array(model.names)[turns]] == list(torsional.dofs)


def test_locked_bearings_give_the_torsional_loop_with_its_meshes() -> None:
    """Bending and axial freedoms locked, mesh springs on the approach of the contract: frequencies to 1e-6."""
    drivetrain = prototype_drivetrain()
    rig = prototype_rig()
    model = assemble_rig(rig)
    torsional = assemble(drivetrain)
    springs = tuple(
        RowSpring(row=approach_row(model, name), stiffness=k)
        for name, k in (("test", 1.14e8), ("reference", 7.09e8))
    )
    full = full_matrices(model, RunningState(bearings=bearings(rig), springs=springs))
    turns = np.flatnonzero(np.array(model.freedoms.family) == 0)
    ours = eigh(
        full.stiffness[turns][:, turns].toarray(), full.mass[turns][:, turns].toarray(), eigvals_only=True
    )
    stiffness = torsional.stiffness.copy()
    for (a, b), mesh, spring in zip(torsional.mesh_ports, drivetrain.meshes, springs):
        row = np.zeros(len(torsional.dofs))
        row[a], row[b] = mesh.base_radii[0], -mesh.base_radii[1]
        stiffness += spring.stiffness * np.outer(row, row)
    theirs = eigh(stiffness, torsional.inertia, eigvals_only=True)
    assert np.sqrt(ours[1:]) == pytest.approx(np.sqrt(theirs[1:]), rel=1e-6)


def test_prototype_is_as_soft_sideways_as_an_independent_code_found() -> None:
    """Issue figures: bearings of 1e8 N/m and bending give 0.75 to 1.15e8 N/m at the gears, and lower the loop stiffness
    to 16.3 kN m/rad."""
    rig = prototype_rig()
    model = assemble_rig(rig)
    held = bearings(rig)
    found = []
    for mesh in rig.drivetrain.meshes:
        for gear in (mesh.pinion, mesh.wheel):
            row = model.row(gear, "u_z")
            deflection = static_deflection(model, RunningState(bearings=held), row).deflection
            found.append(1.0 / float(row @ deflection))
    assert (min(found), max(found)) == pytest.approx((0.75e8, 1.15e8), rel=0.01)
    springs = tuple(
        RowSpring(row=approach_row(model, name), stiffness=k)
        for name, k in (("test", 1.14e8), ("reference", 7.09e8))
    )
    coupling = model.joint("pinion side", "coupling")
    twist = static_deflection(
        model, RunningState(bearings=held, springs=springs), coupling.load("turn")
    ).deflection
    loop = 138e3 * (1.0 - float(coupling.row("turn") @ twist))
    assert loop == pytest.approx(16.3e3, rel=0.005)
