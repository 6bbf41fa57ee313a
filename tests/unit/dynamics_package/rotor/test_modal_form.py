import numpy as np
import pytest

from dynamics.rotor.graph import assemble
from dynamics.rotor.linear_system import LinearSystem, known_modal_form, modal_form
from dynamics.rotor.torsional_modes import closed_matrices
from tests.builders.rig import prototype, prototype_laws


def direct(system: LinearSystem, omega: float, dofs: np.ndarray) -> np.ndarray:
    matrix = -(omega**2) * system.inertia + 1j * omega * system.damping + system.stiffness
    return np.linalg.inv(matrix)[np.ix_(dofs, dofs)]


@pytest.mark.parametrize("linear_drag", [0.0, 7e-4])
def test_receptance_equals_the_inverse_of_the_dynamic_stiffness(linear_drag: float) -> None:
    """Rigid modes, splines with real poles of 5e7 1/s and grounded drag included."""
    system = assemble(prototype(linear_drag=linear_drag))
    form = modal_form(system.inertia, system.damping, system.stiffness, system.rigid)
    assert np.abs(form.poles).max() > 1e7
    dofs = system.mesh_ports.ravel()
    omega = 2.0 * np.pi * np.array([50.0, 825.0, 4022.7, 19.8e3, 49.5e3])
    found = form.receptance(omega, dofs)
    for i, w in enumerate(omega):
        exact = direct(system, w, dofs)
        assert np.abs(found[i] - exact).max() < 1e-9 * np.abs(exact).max()


def test_free_lines_are_rigid_modes_with_mass_one() -> None:
    system = assemble(prototype())
    form = modal_form(system.inertia, system.damping, system.stiffness, system.rigid)
    assert form.rigid.shape == (len(system.dofs), 2)
    assert form.rigid.T @ system.inertia @ form.rigid == pytest.approx(np.eye(2), abs=1e-12)


def test_closed_loop_has_one_rigid_mode_with_the_ratio_of_the_gears() -> None:
    system = assemble(prototype())
    form = modal_form(*closed_matrices(system, prototype_laws()), system.rigid)
    assert form.rigid.shape[1] == 1
    pinion, wheel = system.mesh_ports[0]
    assert form.rigid[pinion, 0] / form.rigid[wheel, 0] == pytest.approx(102 / 99, rel=1e-12)
    slow = np.abs(form.poles[np.argsort(np.abs(form.poles))[:2]])
    assert slow[0] < 1e-6
    assert slow[1] > 100.0


def test_single_oscillator_has_its_textbook_pole() -> None:
    form = modal_form(np.array([[2.0]]), np.array([[0.4]]), np.array([[50.0]]), np.ones((1, 1)))
    assert form.rigid.shape[1] == 0
    expected = -0.1 + 1j * np.sqrt(25.0 - 0.01)
    assert sorted(form.poles, key=lambda p: p.imag) == pytest.approx(
        [expected.conjugate(), expected], rel=1e-12
    )
    omega = np.array([3.0])
    assert form.receptance(omega, np.array([0]))[0, 0, 0] == pytest.approx(
        1.0 / (50.0 - 18.0 + 1.2j), rel=1e-12
    )


def whirling(seed: int = 3) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Full inertia, damping with a gyroscopic and stiffness with a skew part, one rigid shape that neither resists."""
    random = np.random.default_rng(seed)
    n, (a, b, c, d) = 6, random.normal(size=(4, 6, 6))
    rigid = random.normal(size=(n, 1))
    free = np.eye(n) - rigid @ rigid.T / (rigid.T @ rigid)
    inertia = np.eye(n) + 0.1 * a @ a.T
    stiffness = free @ (200.0 * b @ b.T + 80.0 * (c - c.T)) @ free
    damping = 0.4 * d @ d.T + 3.0 * (d - d.T)
    return inertia, damping, stiffness, rigid


def test_full_inertia_gyroscopic_and_skew_parts_give_the_direct_receptance() -> None:
    inertia, damping, stiffness, rigid = whirling()
    form = modal_form(inertia, damping, stiffness, rigid)
    assert form.rigid.shape == (6, 1)
    dofs = np.array([0, 4])
    for omega in (0.7, 9.0, 40.0):
        matrix = -(omega**2) * inertia + 1j * omega * damping + stiffness
        expected = np.linalg.inv(matrix)[np.ix_(dofs, dofs)]
        assert form.receptance(np.array([omega]), dofs)[0] == pytest.approx(expected, rel=1e-9)
    # as many states as coordinates and velocities, less the one rigid displacement that no force depends on
    poles = np.linalg.eigvals(
        np.block(
            [
                [np.zeros((6, 6)), np.eye(6)],
                [-np.linalg.solve(inertia, stiffness), -np.linalg.solve(inertia, damping)],
            ]
        )
    )
    moving = np.sort_complex(poles[np.abs(poles) > 1e-6])
    assert np.sort_complex(form.poles) == pytest.approx(moving, rel=1e-8)


def test_matrices_met_before_are_not_solved_again_and_others_are() -> None:
    system = assemble(prototype())
    matrices = system.inertia, system.damping, system.stiffness, system.rigid
    first = known_modal_form(*matrices)
    assert known_modal_form(*(one.copy() for one in matrices)) is first
    softer = known_modal_form(system.inertia, system.damping, 0.9 * system.stiffness, system.rigid)
    assert np.sort(np.abs(softer.poles)) != pytest.approx(np.sort(np.abs(first.poles)), rel=1e-3)
    wanted = modal_form(system.inertia, system.damping, 0.9 * system.stiffness, system.rigid)
    assert np.array_equal(softer.poles, wanted.poles)
