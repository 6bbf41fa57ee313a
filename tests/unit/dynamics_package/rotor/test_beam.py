import numpy as np
import pytest

from dynamics.rotor.beam import (
    DIRECTIONS,
    BeamElements,
    elements_of,
    gyroscopic_matrices,
    mass_matrices,
    shear_coefficient,
    stiffness_matrices,
)
from dynamics.rotor.shaft import Section, Shaft

SECTIONS = (
    Section(length=0.03, outer_diameter=0.04),
    Section(length=0.05, outer_diameter=0.06, inner_diameter=0.02),
)
LENGTHS = np.array([0.03, 0.05])


def elements(**changes: object) -> BeamElements:
    shaft = Shaft(name="s", sections=SECTIONS)
    return elements_of(shaft, LENGTHS, SECTIONS, **changes)  # type: ignore[arg-type]


def rigid_motions(length: float) -> np.ndarray:
    """(12, 6) motions of both nodes of an element that moves as a rigid body, in the order of DIRECTIONS."""
    motions = np.vstack([np.eye(6), np.eye(6)])
    motions[7, 5], motions[8, 4] = length, -length
    return motions


def test_rigid_motions_stretch_nothing() -> None:
    for matrix, length in zip(stiffness_matrices(elements()), LENGTHS):
        assert np.abs(matrix @ rigid_motions(float(length))).max() < 1e-6 * np.abs(matrix).max() * 1e-6
        assert matrix == pytest.approx(matrix.T)
        assert np.linalg.matrix_rank(matrix, tol=1e-6 * np.abs(matrix).max()) == 6


@pytest.mark.parametrize("torsional_inertia", ["lumped", "consistent"])
def test_rigid_motions_have_the_inertia_of_a_cylinder(torsional_inertia: str) -> None:
    """About its middle: m, m, m, I_p, I_p / 2 + m L^2 / 12 twice."""
    for matrix, section in zip(mass_matrices(elements(torsional_inertia=torsional_inertia)), SECTIONS):
        mass = (
            7850.0 * 0.25 * np.pi * (section.outer_diameter**2 - section.inner_diameter**2) * section.length
        )
        polar = mass * (section.outer_diameter**2 + section.inner_diameter**2) / 8.0
        across = 0.5 * polar + mass * section.length**2 / 12.0
        motions = rigid_motions(section.length)
        motions[[1, 7], 5] -= 0.5 * section.length
        motions[[2, 8], 4] += 0.5 * section.length
        inertia = motions.T @ matrix @ motions
        assert inertia == pytest.approx(np.diag([mass, mass, mass, polar, across, across]), abs=1e-12)


def test_gyroscopic_moment_of_a_tilting_cylinder() -> None:
    """H = I_p s along the axis: a tilt rate about y asks a moment -I_p s about z, and no force."""
    for matrix, section in zip(gyroscopic_matrices(elements()), SECTIONS):
        assert matrix == pytest.approx(-matrix.T)
        mass = (
            7850.0 * 0.25 * np.pi * (section.outer_diameter**2 - section.inner_diameter**2) * section.length
        )
        polar = mass * (section.outer_diameter**2 + section.inner_diameter**2) / 8.0
        motions = rigid_motions(section.length)
        moment = motions.T @ matrix @ motions
        expected = np.zeros((6, 6))
        expected[4, 5], expected[5, 4] = polar, -polar
        assert moment == pytest.approx(expected, abs=1e-12)


def test_shear_coefficients() -> None:
    """Full circle: Cowper 6 (1 + nu) / (7 + 6 nu), Hutchinson 6 (1 + nu)^2 / (7 + 12 nu + 4 nu^2) times 1 / (1 + nu);
    thin tube, Cowper: 2 (1 + nu) / (4 + 3 nu)."""
    full, thin = np.array([0.0]), np.array([1.0])
    assert shear_coefficient(full, 0.3) == pytest.approx([6.0 * 1.3 / (7.0 + 1.8)])
    assert shear_coefficient(thin, 0.3) == pytest.approx([2.0 * 1.3 / (4.0 + 0.9)])
    assert shear_coefficient(full, 0.3, "hutchinson") == pytest.approx([6.0 * 1.3 / (7.0 + 3.6 + 0.36)])
    assert not elements(shear="rigid").shear_share.any()


def test_order_of_directions_is_that_of_the_contract() -> None:
    assert DIRECTIONS == ("u_x", "u_y", "u_z", "turn", "theta_y", "theta_z")
