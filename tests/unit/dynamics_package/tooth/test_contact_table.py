"""Contact tables: one smooth potential, its derivatives, and the slice sums that it stands for."""

import numpy as np
import pytest

from dynamics.errors import DynamicsInputError
from dynamics.kernels.contact_table import ContactTables
from dynamics.tooth.contact_table import MarchStep, TableGrid, contact_tables
from dynamics.tooth.law import MeshLaw
from dynamics.tooth.mesh_force import evaluate_mesh, evaluate_table
from tests.builders.mesh import BASE_RADIUS_1, BASE_RADIUS_2, TEETH, ramped_law, spur_law, wavy_law
from tests.performance.test_dynamics_speed import TORQUE, shipped_laws

HELIX = {"n_slices": 13, "contact_ratio": 1.448, "span": 11.6e-3}
STATES = np.random.default_rng(7)
THETA = STATES.uniform(0.0, 20.0, 400)
X = np.concatenate((STATES.uniform(5e-6, 3.2e-5, 300), STATES.uniform(-1.3e-4, -1.1e-4, 100)))
BODY = 3e-9


def shared(law: MeshLaw) -> MeshLaw:
    """The law on bodies that all pairs share."""
    return law._replace(body_compliance=BODY, mean_stiffness=1.0 / (1.0 / law.mean_stiffness + BODY))


def with_pitch(law: MeshLaw, slope: float = 0.0) -> MeshLaw:
    """Teeth with pitch deviations of 2 um, and profile slopes of their own [m]."""
    own = np.random.default_rng(3)
    place = np.linspace(-1.0, 1.0, law.stiffness.shape[1])
    first, second = (own.normal(size=(z, 1)) * 2e-6 + own.normal(size=(z, 1)) * slope * place for z in TEETH)
    return law._replace(
        deviation_1=first, deviation_2=second, back_deviation_1=-first, back_deviation_2=-second,
        scale_1=1.0 + 0.05 * own.normal(size=TEETH[0]),
    )  # fmt: skip


def tilting(law: MeshLaw, width: float) -> MeshLaw:
    """Slices over a face of ``width`` [m], crowned by 3 um."""
    n = law.stiffness.shape[0]
    face = ((np.arange(n) + 0.5) / n - 0.5) * width
    return law._replace(slice_face=face, gap=law.gap + 3e-6 * (2.0 * face[:, None] / width) ** 2)


LAWS = {
    "spur": spur_law(),
    "helical": spur_law(**HELIX),
    "single spur teeth": with_pitch(spur_law(), 1e-6),
    "single helical teeth": with_pitch(spur_law(**HELIX)),
    "shared body": shared(spur_law()),
    "single teeth on a shared body": shared(with_pitch(spur_law(**HELIX))),
    "without gaps": ramped_law(),
    "of the phase": wavy_law(),
}
EVERY_LAW = pytest.mark.parametrize("name", LAWS)


def tables_of(law: MeshLaw, grid: TableGrid | None = None, speed: float = 0.0) -> ContactTables:
    """Tables of one law at a speed of the pinion."""
    return contact_tables([law], grid or TableGrid(), MarchStep(step=1e-9, speeds=(speed,)))


@EVERY_LAW
def test_forces_are_the_sums_over_the_slices(name: str) -> None:
    law = LAWS[name]._replace(damping=1e3)
    w_1, w_2 = 120.0, 120.0 * BASE_RADIUS_1 / BASE_RADIUS_2 - 0.2
    exact, found = evaluate_mesh(law, THETA, X, w_1, w_2), evaluate_table(tables_of(law), THETA, X, w_1, w_2)
    for field in ("torque_1", "torque_2", "force_front", "force_back", "energy"):
        expected = getattr(exact, field)
        scale = np.sqrt(np.mean(expected[expected != 0.0] ** 2))
        off = np.abs(getattr(found, field) - expected) / scale
        assert np.sqrt(np.mean(off**2)) < 1e-3, field
        assert off.max() < 2e-2, field
    np.testing.assert_allclose(found.tooth_approach, exact.tooth_approach, atol=5e-8)


def test_error_falls_with_the_size_of_the_table() -> None:
    law = shipped_laws()[1]
    deflection = TORQUE / law.base_radius_1 / law.mean_stiffness
    theta, x = STATES.uniform(0.0, 3.0, 3000), STATES.uniform(0.6, 1.5, 3000) * deflection
    exact = evaluate_mesh(law, theta, x, 0.0, 0.0).force_front
    errors = []
    for per_pitch in (16, 64, 256):
        grid = TableGrid(per_pitch=per_pitch, finest=8e-6 / per_pitch, growth=3.2 / per_pitch)
        found = evaluate_table(contact_tables([law], grid), theta, x).force_front
        errors.append(np.sqrt(np.mean((found - exact) ** 2)) / exact.mean())
    assert errors[0] > 4.0 * errors[1] > 8.0 * errors[2]
    assert errors[1] < 5e-4


def test_one_slice_is_exact_over_the_depth() -> None:
    """A spring that hardens nowhere is a parabola, which one cell holds: only the path is interpolated."""
    law = wavy_law(points=2001)
    grid = TableGrid(per_pitch=256, finest=20e-6, growth=10.0)
    x = STATES.uniform(1e-9, 1e-4, 400)
    exact, found = evaluate_mesh(law, THETA, x, 0.0, 0.0), evaluate_table(tables_of(law, grid), THETA, x)
    np.testing.assert_allclose(found.force_front, exact.force_front, rtol=1e-5)
    np.testing.assert_allclose(found.torque_1, exact.torque_1, rtol=1e-5)


@EVERY_LAW
def test_torques_are_the_gradient_of_the_energy_of_the_table(name: str) -> None:
    tables = tables_of(LAWS[name])
    here, h = evaluate_table(tables, THETA, X), 1e-9

    def energy(d_1: float, d_2: float) -> np.ndarray:
        x = X + BASE_RADIUS_1 * d_1 - BASE_RADIUS_2 * d_2
        return evaluate_table(tables, THETA + d_1, x).energy

    largest = np.abs(here.torque_1).max()
    for found, (d_1, d_2) in ((here.torque_1, (h, 0.0)), (here.torque_2, (0.0, h))):
        slope = (energy(d_1, d_2) - energy(-d_1, -d_2)) / (2.0 * h)
        np.testing.assert_allclose(-slope, found, atol=1e-6 * largest)


@EVERY_LAW
@pytest.mark.parametrize("acts_on", ["relative_rotation", "contact_closing_rate"])
def test_tangents_are_the_derivatives_of_the_torques(name: str, acts_on: str) -> None:
    law = LAWS[name]._replace(damping=1e3, friction=0.05, damping_acts_on=acts_on)
    speeds, h, rate = (100.0, 100.0 * BASE_RADIUS_1 / BASE_RADIUS_2 - 0.02), 1e-10, 1e-6
    # the direction of friction is held in the tangents
    for kind, step, tables in (
        ("approach", (h, 0.0), tables_of(law, speed=speeds[0])),
        ("rate", (0.0, rate), tables_of(law._replace(friction=0.0), speed=speeds[0])),
    ):
        here = evaluate_table(tables, THETA, X, *speeds)
        up, down = (
            evaluate_table(tables, THETA, X + s * step[0], speeds[0], speeds[1] - s * step[1] / BASE_RADIUS_2)
            for s in (1.0, -1.0)
        )
        for torque in ("torque_1", "torque_2"):
            slope = (getattr(up, torque) - getattr(down, torque)) / (2.0 * sum(step))
            off = np.abs(slope - getattr(here, f"{torque}_per_{kind}"))
            # contacts that open in between
            assert np.mean(off > 2e-3 * np.abs(slope).max()) < 0.03


@pytest.mark.parametrize("acts_on", ["relative_rotation", "contact_closing_rate"])
@pytest.mark.parametrize("name", ["spur", "helical", "single helical teeth", "without gaps"])
def test_mesh_power_is_friction_damping_and_stored_energy(name: str, acts_on: str) -> None:
    law = LAWS[name]._replace(damping=1e3, friction=0.05, damping_acts_on=acts_on)
    tables, w_1 = tables_of(law, speed=120.0), np.full_like(THETA, 120.0)
    w_2 = w_1 * BASE_RADIUS_1 / BASE_RADIUS_2 + STATES.normal(size=len(THETA))
    rate = BASE_RADIUS_1 * w_1 - BASE_RADIUS_2 * w_2
    here, t = evaluate_table(tables, THETA, X, w_1, w_2), 1e-10
    ahead = evaluate_table(tables, THETA + w_1 * t, X + rate * t).energy
    behind = evaluate_table(tables, THETA - w_1 * t, X - rate * t).energy
    given = -(here.torque_1 * w_1 + here.torque_2 * w_2)
    taken = (ahead - behind) / (2.0 * t) + here.friction_power + here.damping_power
    np.testing.assert_allclose(given, taken, atol=1e-5 * np.abs(given).max())
    assert here.friction_power.max() > 1.0
    assert here.damping_power.max() > 1.0


@pytest.mark.parametrize("speed", [2.0, 30.0, 600.0, -600.0])
@pytest.mark.parametrize("name", ["spur", "helical", "single helical teeth"])
def test_friction_is_that_of_the_slices(name: str, speed: float) -> None:
    """From creeping, where sliding reverses over the whole path, to one that the cells of the path do not see."""
    law = LAWS[name]._replace(friction=0.05)
    w_2 = speed * BASE_RADIUS_1 / BASE_RADIUS_2
    exact, found = (
        evaluate_mesh(law, THETA, X, speed, w_2),
        evaluate_table(tables_of(law), THETA, X, speed, w_2),
    )
    off = found.friction_power - exact.friction_power
    assert np.sqrt(np.mean(off**2)) < 0.03 * exact.friction_power.mean()


def test_profile_scatter_of_helical_teeth_is_its_mean_over_the_slices() -> None:
    """What varies over the face moves a pair by its mean at one depth: small for the scatter of good teeth."""
    errors = []
    for slope in (0.5e-6, 2e-6):
        law = with_pitch(spur_law(**HELIX), slope)
        exact = evaluate_mesh(law, THETA, X, 0.0, 0.0).force_front
        found = evaluate_table(tables_of(law), THETA, X).force_front
        errors.append(np.sqrt(np.mean((found - exact) ** 2)) / exact.mean())
    assert errors[0] < 2e-3
    assert errors[1] < 1e-2


TILTED = {
    "spur": tilting(spur_law(n_slices=15), 15e-3),
    "helical": tilting(spur_law(**HELIX), 40e-3),
    "single teeth": tilting(with_pitch(spur_law(**HELIX)), 40e-3),
}


@pytest.mark.parametrize("name", TILTED)
def test_tilted_faces_are_those_of_a_law_whose_gaps_are_tilted(name: str) -> None:
    law = TILTED[name]
    face = law.slice_face
    assert face is not None
    most = 6e-6 / np.abs(face).max()
    tables = tables_of(law, TableGrid(tilts=(-most, 1.5 * most), planes=9))
    for tilt in (-0.93 * most, 0.0, 0.4 * most, 1.45 * most):
        exact = evaluate_mesh(law._replace(gap=law.gap - tilt * face[:, None]), THETA, X, 0.0, 0.0)
        found = evaluate_table(tables, THETA, X, tilts=(tilt, tilt))
        for field in ("torque_1", "force_front", "energy"):
            expected = getattr(exact, field)
            off = np.abs(getattr(found, field) - expected) / np.sqrt(np.mean(expected**2))
            assert np.sqrt(np.mean(off**2)) < 2e-3, (tilt, field)


@pytest.mark.parametrize("name", TILTED)
def test_tilting_moment_is_the_derivative_of_the_energy(name: str) -> None:
    law = TILTED[name]
    assert law.slice_face is not None
    most = 6e-6 / np.abs(law.slice_face).max()
    tables = tables_of(law, TableGrid(tilts=(-most, most)))
    tilt, h = STATES.uniform(-most, most, len(THETA)), 1e-6 * most
    here = evaluate_table(tables, THETA, X, tilts=(tilt, tilt))
    ahead, behind = (evaluate_table(tables, THETA, X, tilts=(tilt + d, tilt + d)).energy for d in (h, -h))
    moment = here.moment_front + here.moment_back
    np.testing.assert_allclose((ahead - behind) / (2.0 * h), moment, atol=1e-5 * np.abs(moment).max())
    up, down = (evaluate_table(tables, THETA, X + d, tilts=(tilt, tilt)).energy for d in (1e-11, -1e-11))
    force = here.force_front - here.force_back
    np.testing.assert_allclose((up - down) / 2e-11, force, atol=1e-4 * np.abs(force).max())


def test_refusals_name_the_fault() -> None:
    with pytest.raises(DynamicsInputError, match="per_pitch = 4"):
        TableGrid(per_pitch=4)
    with pytest.raises(DynamicsInputError, match="tilts"):
        TableGrid(tilts=(1e-4, -1e-4))
    with pytest.raises(DynamicsInputError, match="slice_face"):
        contact_tables([spur_law()], TableGrid(tilts=(-1e-4, 1e-4)))
