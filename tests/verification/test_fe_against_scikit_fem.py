"""Each compiled term equals its form in thermal.forms, entry by entry: every cell, straight and curved, inner joints.

scikit-fem assembles on its own mesh of the same nodes, so what is held together here is the whole way: numbering,
geometry, quadrature, gradients. That its meshes have our volumes and areas is asked at meshes of its own making.
"""

from dataclasses import replace

import numpy as np
import pytest
import skfem
from scipy import sparse

from thermal import forms
from thermal.conduction.capacity import HeatCapacity, VariableConduction
from thermal.fe.elements import LINEAR, VECTOR, FiniteElements
from thermal.fe.mesh import CellName, NamedMesh, box_mesh, named_mesh
from thermal.films.law import STEFAN_BOLTZMANN

YOUNG, POISSON = 210.0, 0.3
CELLS: tuple[CellName, ...] = ("tetra10", "hexahedron20", "hexahedron27")


def two_bodies(cell: CellName, curved: bool) -> NamedMesh:
    """A box of two bodies on common nodes with their joint named, its normals out of `left`; far from the origin."""
    box = box_mesh((1.0, 1.2, 0.8), (2, 2, 2), cell=cell)
    n_corners = box.shape.n_corners
    middle = box.points[box.cells[:, :n_corners], 0].mean(axis=1)
    cells = {"left": np.flatnonzero(middle < 0.5), "right": np.flatnonzero(middle > 0.5)}
    joint = box.facets.nodes_at(np.flatnonzero(np.isin(box.facets.cells, cells["left"])))
    joint = joint[np.all(np.abs(box.points[joint, 0] - 0.5) < 1e-9, axis=1)]
    bodies = {name: members.astype(np.int32) for name, members in cells.items()}
    mesh = named_mesh(box.points, box.cells, bodies, box.surfaces | {"joint": joint})
    x, y, z = mesh.points.T
    bent = np.column_stack([x + 0.1 * z**2, y * (1.0 + 0.2 * x), z + 0.05 * x * y])
    return replace(mesh, points=(bent if curved else mesh.points) + (3.0, -2.0, 5.0))


@pytest.fixture(
    scope="module",
    params=[(c, k) for c in CELLS for k in (False, True)],
    ids=lambda p: f"{p[0]}-{'curved' if p[1] else 'straight'}",
)
def elements(request: pytest.FixtureRequest) -> FiniteElements:
    return FiniteElements(two_bodies(*request.param))


SURFACES = ("x_max", "z_min", "joint")


def close(a: np.ndarray | sparse.sparray, b: np.ndarray | sparse.sparray) -> None:
    assert a.shape == b.shape
    assert abs(a - b).max() <= 1e-12 * abs(b).max()


def warm(elements: FiniteElements) -> np.ndarray:
    """An uneven temperature [K]."""
    return 350.0 + 40.0 * np.sin(elements.mesh.points @ [1.0, 2.0, 3.0])


def test_conduction(elements: FiniteElements) -> None:
    basis = elements.bases.cells(rule=elements.shape.stiffness_rule)
    at_points = 45.0 + elements.fine.at_points(elements.mesh.points[:, 0])
    compiled = elements.fine.matrix(elements.fine.conduction(at_points))
    close(compiled, forms.conduction.assemble(basis, conductivity=at_points))
    close(compiled, forms.conduction.assemble(basis, conductivity=45.0 + basis.global_coordinates()[0]))


def test_conduction_of_the_linear_space(elements: FiniteElements) -> None:
    mesh = elements.mesh
    middles = (
        elements.shape.corner_values(elements.shape.nodes)
        @ mesh.points[mesh.cells[:, : elements.shape.n_corners]]
    )
    straight = mesh.points.copy()
    straight[mesh.cells] = middles
    flat = FiniteElements(replace(mesh, points=straight))
    k = np.linspace(1.0, 2.0, len(mesh.cells))
    basis = flat.bases.cells(space=LINEAR, rule=elements.shape.linear_rule)
    compiled = elements.coarse.matrix(elements.coarse.conduction(k))
    close(compiled, forms.conduction.assemble(basis, conductivity=k[:, None]))


def test_conductivity_that_follows_the_temperature(elements: FiniteElements) -> None:
    field, other = warm(elements), np.cos(elements.mesh.points @ [2.0, 1.0, 0.5])
    variable = VariableConduction(elements, dict.fromkeys(elements.mesh.bodies, lambda t: 50.0 - 0.02 * t))
    basis = elements.bases.cells(rule=elements.shape.stiffness_rule)
    at = basis.interpolate(field)
    conductivity = 50.0 - 0.02 * at
    close(
        variable.heat_out(field),
        forms.conducted_heat.assemble(basis, conductivity=conductivity, temperature=at),
    )
    close(
        elements.fine.matrix(variable.fine_values(field)),
        forms.conduction.assemble(basis, conductivity=conductivity),
    )
    slope = forms.conductivity_slope.assemble(basis, slope=-0.02, temperature=at)
    found = variable.slope(field)(other)
    assert np.abs(found - slope @ other).max() <= 1e-9 * np.abs(found).max()  # by differences of the law


def test_heat_capacity_and_source(elements: FiniteElements) -> None:
    given = {"left": 2.0, "right": 3.0}
    capacity = HeatCapacity(elements, given)
    by_cell = elements.per_cell(given)[:, None]
    close(capacity.matrix, forms.heat_capacity.assemble(elements.bases.cells(), capacity=by_cell))
    linear = forms.heat_capacity.assemble(elements.bases.cells(space=LINEAR), capacity=by_cell)
    close(elements.coarse.matrix(capacity.coarse), linear)
    close(
        elements.body_load("right"), forms.volume_source.assemble(elements.bases.cells("right"), source=1.0)
    )


@pytest.mark.parametrize("name", SURFACES)
def test_films(elements: FiniteElements, name: str) -> None:
    surface, basis = elements.surfaces[name], elements.bases.surface(name)
    close(surface.weights, basis.dx)
    close(surface.normals, np.moveaxis(basis.normals, 0, 2))
    close(surface.at_points(elements.mesh.points), np.moveaxis(basis.global_coordinates(), 0, 2))
    height = surface.at_points(elements.mesh.points)[:, :, 1]
    values = np.zeros(len(elements.fine.indices))
    surface.add_mass(values, 2.0 + height)
    close(
        elements.fine.matrix(values),
        forms.film.assemble(basis, coefficient=2.0 + basis.global_coordinates()[1]),
    )
    coarse = np.zeros(len(elements.coarse.indices))
    surface.add_coarse_mass(coarse, 2.0 + height)
    linear = elements.bases.surface(name, LINEAR)
    close(elements.coarse.matrix(coarse), forms.film.assemble(linear, coefficient=2.0 + height))
    close(surface.load(height), forms.surface_heat.assemble(basis, flux=basis.global_coordinates()[1]))
    close(surface.shares, forms.surface_heat.assemble(basis, flux=1.0))


@pytest.mark.parametrize("name", SURFACES)
def test_radiation(elements: FiniteElements, name: str) -> None:
    surface, basis, field = elements.surfaces[name], elements.bases.surface(name), warm(elements)
    given = {"emissivity": 0.6, "temperature": basis.interpolate(field)}
    wall = surface.at_points(field)
    out = 0.6 * STEFAN_BOLTZMANN * surface.load(wall**4 - 300.0**4)
    close(out, forms.radiation.assemble(basis, surroundings=300.0, **given))
    values = np.zeros(len(elements.fine.indices))
    surface.add_mass(values, 4.0 * 0.6 * STEFAN_BOLTZMANN * wall**3)
    close(elements.fine.matrix(values), forms.radiation_slope.assemble(basis, **given))


def test_elasticity_and_expansion_load(elements: FiniteElements) -> None:
    n, rule = len(elements.mesh.cells), elements.shape.stiffness_rule
    basis = elements.bases.cells(space=VECTOR, rule=rule)
    lam, mu = forms.lame(YOUNG, POISSON)
    blocks = elements.fine.elasticity(np.full(n, YOUNG), np.full(n, POISSON))
    close(
        sparse.csr_array(elements.fine.block_matrix(blocks)), forms.elasticity.assemble(basis, lam=lam, mu=mu)
    )
    temperature = warm(elements)
    at = elements.bases.cells(rule=rule).interpolate(temperature)
    theirs = forms.thermal_expansion.assemble(basis, factor=7.0, temperature=at, reference=300.0)
    close(elements.fine.expansion_load(np.full(n, 7.0), temperature - 300.0).ravel(), theirs)


def test_fluxes_at_points_give_the_same_as_the_matrix(elements: FiniteElements) -> None:
    fine = elements.fine
    field = np.sin(elements.mesh.points @ [1.0, 2.0, 3.0])
    k = np.linspace(1.0, 2.0, len(elements.mesh.cells))
    basis = elements.bases.cells(rule=elements.shape.stiffness_rule)
    close(fine.gradient(field), np.moveaxis(basis.interpolate(field).grad, 0, 2))
    flux = k[:, None, None] * fine.gradient(field)
    close(fine.flux_load(flux), fine.matrix(fine.conduction(k)) @ field)


def test_linear_fields_pass_between_the_levels_unchanged(elements: FiniteElements) -> None:
    k = np.linspace(1.0, 2.0, len(elements.mesh.cells))
    fine, coarse = (level.matrix(level.conduction(k)) for level in (elements.fine, elements.coarse))
    product = (elements.prolongation.T @ fine @ elements.prolongation).toarray()
    slope = elements.mesh.points[elements.corners] @ [1.0, -2.0, 3.0]
    assert elements.prolongation @ slope == pytest.approx(elements.mesh.points @ [1.0, -2.0, 3.0], abs=1e-13)
    assert elements.prolongation @ np.ones(len(slope)) == pytest.approx(1.0, abs=1e-14)
    if np.ptp(elements.fine.volumes / elements.fine.volumes[:1]) < 1e-9:  # straight
        close(coarse.toarray(), product)


@pytest.mark.parametrize("cell", CELLS)
def test_scikit_fem_sees_bodies_and_surfaces_of_its_own_mesh(cell: CellName) -> None:
    """Volumes, areas and the numbers of nodes against a mesh that scikit-fem numbers itself."""
    named = two_bodies(cell, curved=False)
    bases = FiniteElements(named).bases
    kind = skfem.MeshTet if cell == "tetra10" else skfem.MeshHex
    used, packed = np.unique(bases.mesh.t, return_inverse=True)
    own = skfem.Basis(kind(named.points[used].T, packed.reshape(bases.mesh.t.shape)), bases.mesh.elem())
    ours = bases.cells()
    assert ours.dx.sum() == pytest.approx(own.dx.sum(), rel=1e-13)
    assert set(bases.mesh.subdomains) == {"left", "right"}
    load = forms.volume_source.assemble(ours, source=ours.global_coordinates()[1])
    theirs = forms.volume_source.assemble(own, source=own.global_coordinates()[1])
    places = own.doflocs.T
    nearest = np.linalg.norm(named.points[:, None] - places[None], axis=2)
    assert nearest.min(axis=1).max() < 1e-12
    close(load, theirs[nearest.argmin(axis=1)])
