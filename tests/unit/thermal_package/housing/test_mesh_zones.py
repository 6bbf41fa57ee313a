"""Element sizes by zone: each refines what it names, from the case file to the mesh."""

import numpy as np
import pytest

from rigdesign.case.housing import HousingMesh
from tests.builders.housing import PROTOTYPE
from thermal.fe.mesh import NamedMesh
from thermal.housing.gearbox import GeometryError, MeshSizes, build_gearbox, mesh_sizes

ZONES = {
    "wall": ("outer_warm", 0.014),
    "field": ("field_bottom", 0.07),
    "seal": ("seal_bore_wheel_rear", 0.003),
    "bearing": ("shaft_pinion_journal_front", 0.004),
    "gear": ("gear_wheel_rim", 0.004),
}
"""Surface in each zone, and a size for it well below the usual one at quick [m]."""


def facets(mesh: NamedMesh, surface: str) -> int:
    return len(mesh.surfaces[surface])


@pytest.mark.parametrize(
    "zone", ["wall", *(pytest.param(zone, marks=pytest.mark.slow) for zone in ZONES if zone != "wall")]
)
def test_a_size_refines_its_zone_and_hardly_the_others(zone: str) -> None:
    surface, size = ZONES[zone]
    usual = build_gearbox(PROTOTYPE, "quick").mesh
    ratio = mesh_sizes(PROTOTYPE, "quick").wall / mesh_sizes(PROTOTYPE, "standard").wall
    finer = build_gearbox(PROTOTYPE, mesh_sizes(PROTOTYPE, "quick", {zone: size / ratio})).mesh
    assert facets(finer, surface) > 2.0 * facets(usual, surface)
    others = [other for name, (other, _) in ZONES.items() if name != zone]
    if zone != "wall":
        assert all(facets(finer, other) < 1.6 * facets(usual, other) for other in others)


def test_sizes_of_the_case_hold_at_standard_and_scale_with_the_fidelity() -> None:
    given = HousingMesh(walls="20 mm", bearings="10 mm").sizes()
    assert given == pytest.approx({"wall": 0.02, "bearing": 0.01})
    standard, quick = (mesh_sizes(PROTOTYPE, fidelity, given) for fidelity in ("standard", "quick"))
    assert (standard.wall, standard.bearing) == pytest.approx((0.02, 0.01))
    assert np.isclose(quick.wall, 0.05) and np.isclose(quick.bearing, 0.025)
    assert standard.field == mesh_sizes(PROTOTYPE, "standard").field


def test_sizes_that_would_never_mesh_are_refused() -> None:
    with pytest.raises(ValueError, match="element size of seal is below 1 mm"):
        HousingMesh(seals="0.1 mm")
    with pytest.raises(GeometryError, match="gear = 0"):
        MeshSizes(wall=0.1, field=0.1, shaft=0.1, circle=8, gear=0.0)
