"""The same mesh, films, radiation and supports in CalculiX 2.20 (Debian calculix-ccx), node by node.

Temperatures agree within 1e-4 of their range, displacements within 1e-4 of the largest. C3D20 takes the
temperature for the thermal strain from its corners alone (2e-4 apart for a wavy field), so hexahedra get a
field that is linear between them and both codes solve the same problem; C3D10 takes all nodes, as we do.
"""

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import tests.builders.calculix as calculix
from tests.builders.two_blocks import law
from thermal.conditions.boundary import Adiabatic, Film, Radiation
from thermal.conduction.setup import ConductionSetup
from thermal.conduction.steady import solve_steady
from thermal.expansion.elastic import ElasticSetup, three_two_one
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import NamedMesh, box_mesh

pytestmark = pytest.mark.skipif(
    shutil.which("ccx") is None, reason="CalculiX is not installed: apt-get install calculix-ccx"
)
COLD, CONDUCTIVITY, STEEL = 293.15, 45.0, (210e9, 0.3, 11.5e-6)
DIVISIONS = {"tetra10": (14, 8, 10), "hexahedron20": (16, 12, 12)}


@pytest.fixture(scope="module", params=DIVISIONS)
def elements(request: pytest.FixtureRequest) -> FiniteElements:
    """A bent block of about 10 k nodes, its cells curved."""
    mesh = box_mesh((0.3, 0.15, 0.2), DIVISIONS[request.param], cell=request.param)
    x, y, z = mesh.points.T
    bent = np.column_stack([x + 0.4 * z**2, y * (1.0 + x), z + 0.3 * x * y])
    return FiniteElements(replace(mesh, points=bent))


def conditions(mesh: NamedMesh) -> list[Film | Radiation | Adiabatic]:
    return [
        Film(surface="x_min", kind="oil", fluid_temperature=433.15, law=law(300.0)),
        Film(surface="z_max", kind="air", fluid_temperature=COLD, law=law(20.0)),
        Radiation(surface="z_max", emissivity=0.6, surroundings_temperature=COLD),
        Film(surface="x_max", kind="oil", fluid_temperature=318.15, law=law(300.0)),
        *(Adiabatic(surface=name) for name in ("y_min", "y_max", "z_min")),
    ]


def test_temperatures(elements: FiniteElements, tmp_path: Path) -> None:
    mesh = elements.mesh
    assert 9_000 < len(mesh.points) < 12_000
    given = conditions(mesh)
    ours = solve_steady(ConductionSetup(mesh, {"box": CONDUCTIVITY}), given).temperature
    lines = calculix.heat_lines(mesh, given, CONDUCTIVITY, COLD, "")
    theirs = calculix.run(lines, tmp_path, "NDTEMP", 1, len(mesh.points)).values[:, 0]
    assert np.ptp(ours) > 50.0
    assert np.abs(ours - theirs).max() < 1e-4 * np.ptp(ours)


def test_expansion(elements: FiniteElements, tmp_path: Path) -> None:
    mesh = elements.mesh
    temperature = COLD + 100.0 + 60.0 * np.sin(20.0 * mesh.points).sum(axis=1)
    if mesh.shape.n_corners == 8:
        between = mesh.shape.corner_values(mesh.shape.nodes)
        temperature[mesh.cells] = temperature[mesh.cells[:, :8]] @ between.T
    fixed = np.zeros((len(mesh.points), 3), dtype=bool)
    foot = np.intersect1d(elements.surfaces["z_min"].nodes, elements.corners)
    for node, directions in three_two_one(mesh.points, foot.astype(np.int32)):
        fixed[node, list(directions)] = True
    ours = ElasticSetup(elements, {"box": STEEL}, fixed).solve(temperature, COLD).values
    lines = calculix.expansion_lines(mesh, STEEL, fixed, temperature, COLD, "")
    theirs = calculix.run(lines, tmp_path, "DISP", 3, len(mesh.points)).values
    assert np.abs(ours).max() > 1e-5
    assert np.abs(ours - theirs).max() < 1e-4 * np.abs(ours).max()
