"""Heat with a film on every side and prescribed displacements: orders in L2, patch test, reciprocity.

The manufactured temperature is u = exp(x / 2) sin(2 y + 1) cos(z); its source is -k laplace u and the fluid
beyond each side has u + (k / h) du/dn. Second-order elements converge with order 3, their linear sub-space
with order 2 (Ciarlet, The Finite Element Method for Elliptic Problems, theorem 3.2.5).
"""

from dataclasses import replace

import numpy as np
import pytest

from tests.builders.direct_solution import solve_direct
from tests.builders.two_blocks import law
from thermal.conditions.boundary import Adiabatic, Film, SurfaceSource
from thermal.conduction.setup import ConductionSetup
from thermal.conduction.steady import solve_steady
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import CellName, NamedMesh, box_mesh
from thermal.fe.solver import constrain

CELLS = ("tetra10", "hexahedron20", "hexahedron27")
K, H = 20.0, 35.0


def exact(at: np.ndarray) -> np.ndarray:
    x, y, z = np.moveaxis(at, -1, 0)
    return np.exp(0.5 * x) * np.sin(2.0 * y + 1.0) * np.cos(z)


def slope(at: np.ndarray) -> np.ndarray:
    x, y, z = np.moveaxis(at, -1, 0)
    growth = np.exp(0.5 * x)
    parts = (
        0.5 * growth * np.sin(2.0 * y + 1.0) * np.cos(z),
        2.0 * growth * np.cos(2.0 * y + 1.0) * np.cos(z),
        -growth * np.sin(2.0 * y + 1.0) * np.sin(z),
    )
    return np.stack(parts, axis=-1)


def error(mesh: NamedMesh, linear: bool) -> float:
    """L2 error of the second-order space or of its linear sub-space."""
    elements = FiniteElements(mesh)
    places, volumes = elements.at_points(mesh.points)
    source = K * (4.0 + 1.0 - 0.25) * exact(places) * volumes
    parts = source.reshape(len(mesh.cells), -1) @ mesh.shape.values(mesh.shape.load_rule.points)
    load = np.bincount(mesh.cells.ravel(), parts.ravel())
    level = elements.coarse if linear else elements.fine
    values = level.conduction(np.full(len(mesh.cells), K))
    for side in elements.surfaces.values():
        film = np.full_like(side.weights, H)
        (side.add_coarse_mass if linear else side.add_mass)(values, film)
        at = side.at_points(mesh.points)
        load += side.load(H * exact(at) + K * np.einsum("fqi,fqi->fq", slope(at), side.normals))
    if linear:
        solution = elements.prolongation @ solve_direct(level.matrix(values), elements.prolongation.T @ load)
    else:
        solution = solve_direct(level.matrix(values), load)
    found, volumes = elements.at_points(solution)
    return float(np.sqrt(volumes @ (found - exact(places)) ** 2))


@pytest.mark.parametrize("cell", CELLS)
@pytest.mark.parametrize(("linear", "order"), [(False, 3.0), (True, 2.0)])
def test_order_with_robin_conditions(cell: CellName, linear: bool, order: float) -> None:
    divisions = (3, 6) if linear else (2, 4)
    coarse, fine = (error(box_mesh((1.0, 1.0, 1.0), (n,) * 3, cell=cell), linear) for n in divisions)
    assert np.log2(coarse / fine) == pytest.approx(order, abs=0.25)


def test_order_three_on_curved_bricks_needs_27_nodes() -> None:
    def bent(n: int, cell: CellName) -> NamedMesh:
        mesh = box_mesh((1.0, 1.0, 1.0), (n,) * 3, cell=cell)
        x, y, z = mesh.points.T
        moved = np.column_stack([x + 0.15 * np.sin(2.0 * z), y + 0.2 * x * z, z + 0.1 * x * y])
        return replace(mesh, points=moved)

    coarse, fine = (error(bent(n, "hexahedron27"), False) for n in (3, 6))
    assert np.log2(coarse / fine) == pytest.approx(3.0, abs=0.25)
    assert fine < error(bent(6, "hexahedron20"), False)


def distorted(cell: CellName) -> NamedMesh:
    """A box whose inner corners are moved at random, with straight edges."""
    mesh = box_mesh((1.0, 1.0, 1.0), (3, 3, 3), cell=cell)
    elements = FiniteElements(mesh)
    corners = mesh.points[elements.corners]
    inside = np.all((corners > 0.01) & (corners < 0.99), axis=1)
    corners = corners + 0.06 * np.random.default_rng(3).uniform(-1.0, 1.0, corners.shape) * inside[:, None]
    return replace(mesh, points=elements.prolongation @ corners)


@pytest.mark.parametrize("cell", CELLS)
def test_patch(cell: CellName) -> None:
    # Irons and Razzaque 1972: displacements linear on the boundary are linear inside, whatever the cells
    elements = FiniteElements(distorted(cell))
    points, n = elements.mesh.points, len(elements.mesh.cells)
    matrix = elements.fine.block_matrix(elements.fine.elasticity(np.full(n, 210e9), np.full(n, 0.3)))
    fixed = np.zeros((len(points), 3), dtype=bool)
    for side in elements.surfaces.values():
        fixed[side.nodes] = True
    strained = points @ np.array([[1.0, 0.3, -0.2], [0.1, -0.5, 0.4], [0.2, 0.1, 0.7]]) * 1e-3
    lift = np.where(fixed, strained, 0.0).ravel()
    right = np.where(fixed.ravel(), 0.0, -(matrix @ lift))
    found = lift + solve_direct(constrain(matrix, fixed.ravel()), right)
    assert np.abs(found - strained.ravel()).max() < 1e-12 * np.abs(strained).max() * 10.0
    assert (~fixed).any()


@pytest.mark.parametrize("cell", CELLS)
def test_reciprocity(cell: CellName) -> None:
    mesh = box_mesh((0.3, 0.2, 0.1), (3, 2, 2), cell=cell)

    def warmed_by(heated: str) -> np.ndarray:
        given = [
            Film(surface="z_min", kind="air", fluid_temperature=300.0, law=law(25.0)),
            SurfaceSource(surface=heated, power=40.0, kind="loss"),
            *(Adiabatic(surface=name) for name in mesh.surfaces if name not in ("z_min", heated)),
        ]
        return solve_steady(ConductionSetup(mesh, {"box": K}), given).temperature - 300.0

    surfaces = FiniteElements(mesh).surfaces
    there = surfaces["y_max"].mean(warmed_by("x_max"))
    back = surfaces["x_max"].mean(warmed_by("y_max"))
    assert there == pytest.approx(back, rel=1e-7)
    assert there > 1.0
