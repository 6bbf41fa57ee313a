"""The mesh of a parametric gearbox: complete, valid, true to the closed forms, the same every time."""

import hashlib
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.builders.housing import BEARING, ONE_CHAMBER, PINION, PROTOTYPE, WHEEL, _triangles, area
from thermal.fe.mesh import MeshError, NamedMesh, facet_keys, facet_table
from thermal.housing.curving import bend_round_axes, jacobian_ratio, straighten_inverted
from thermal.housing.gearbox import (
    ClampingField,
    EndBearing,
    GearDisc,
    GeometryError,
    HousingGeometry,
    MeshSizes,
    ShaftGeometry,
    body_names,
    build_gearbox,
    exact_areas,
    exact_volumes,
    mesh_sizes,
    surface_names,
)
from thermal.housing.shaft_geometry import SIDES
from thermal.housing.stations import GearboxModel

WIDE, LOOSE = replace(BEARING, width=0.045), replace(BEARING, clearance=5e-5)
ROLLING = EndBearing(journal_diameter=0.035, width=0.034, clearance=0.0185)

THREE_SHAFTS = replace(
    PROTOTYPE,
    width=0.42,
    field=None,
    shafts=(
        replace(PINION, name="left", y=-0.1, front=WIDE, rear=WIDE, bore_diameter=0.016),
        replace(PINION, name="middle", y=0.0, rear=ROLLING, gear=None, overhang_rear=0.0),
        replace(PINION, name="right", y=0.1, front=LOOSE, rear=LOOSE, overhang_diameter=0.044),
    ),
)
"""Bosses, a hollow shaft, a blind one without a gear and with a bearing of its own at each end, an overhang thicker
than its journal; no field."""


def volume(mesh: NamedMesh, body: str) -> float:
    """Volume of a body of curved tetrahedra [m3], integrated as the flux of position through its facets."""
    cells = mesh.cells[mesh.bodies[body]]
    table = facet_table(cells, len(mesh.points))
    return sum(flux for _, flux in _triangles(mesh.points, table.nodes[table.on_boundary])) / 3.0


BUILT = {"two shafts on a field": PROTOTYPE, "three shafts": THREE_SHAFTS, "one chamber": ONE_CHAMBER}


@pytest.fixture(scope="module", params=BUILT)
def built(request: pytest.FixtureRequest) -> tuple[HousingGeometry, GearboxModel]:
    geometry = BUILT[request.param]
    return geometry, build_gearbox(geometry, "quick")


def test_every_boundary_facet_has_exactly_one_name(built: tuple[HousingGeometry, GearboxModel]) -> None:
    geometry, model = built
    mesh = model.mesh
    assert set(mesh.surfaces) == set(surface_names(geometry))
    table = facet_table(mesh.cells, len(mesh.points))
    named = np.concatenate([facet_keys(facets[:, :3], len(mesh.points)) for facets in mesh.surfaces.values()])
    assert np.array_equal(np.sort(named), table.keys[table.on_boundary])


def test_every_cell_is_in_exactly_one_body(built: tuple[HousingGeometry, GearboxModel]) -> None:
    geometry, model = built
    assert set(model.mesh.bodies) == set(body_names(geometry))
    cells = np.sort(np.concatenate(list(model.mesh.bodies.values())))
    assert np.array_equal(cells, np.arange(len(model.mesh.cells)))
    assert np.array_equal(np.unique(model.mesh.cells), np.arange(len(model.mesh.points)))


def test_areas_are_the_closed_forms(built: tuple[HousingGeometry, GearboxModel]) -> None:
    """Seven curved elements a turn leave 0.04 % on a mantle and 0.13 % on a disc.

    The three-shaft box has a few elements so flat that they are straightened; each such edge loses 3 % of its
    own arc, 0.2 % of a turn.
    """
    geometry, model = built
    tolerance = 2.5e-3 if geometry is PROTOTYPE else 5e-3
    for surface, exact in exact_areas(geometry).items():
        assert area(model.mesh, surface) == pytest.approx(exact, rel=tolerance), surface


def test_volumes_are_the_closed_forms(built: tuple[HousingGeometry, GearboxModel]) -> None:
    geometry, model = built
    tolerance = 2e-3 if geometry is PROTOTYPE else 4e-3
    for body, exact in exact_volumes(geometry).items():
        assert volume(model.mesh, body) == pytest.approx(exact, rel=tolerance), body


def test_no_element_is_inverted(built: tuple[HousingGeometry, GearboxModel]) -> None:
    mesh = built[1].mesh
    assert jacobian_ratio(mesh.points, mesh.cells).min() > 0.09


def test_bores_and_journals_are_pure_cylinders(built: tuple[HousingGeometry, GearboxModel]) -> None:
    """Corners of every bore and journal lie on the radius that station and geometry give."""
    geometry, model = built
    shafts = {shaft.name: shaft for shaft in geometry.shafts}
    rings = [(b.journal_surface, b.centre, b.diameter / 2) for b in model.bearings]
    seats = {f"{name}_{side}": shaft.bearing(side) for name, shaft in shafts.items() for side in SIDES}
    assert [(b.diameter, b.width) for b in model.bearings] == [
        (seats[b.name].journal_diameter, seats[b.name].width) for b in model.bearings
    ]
    rings += [(b.bore_surface, b.centre, seats[b.name].bore_radius) for b in model.bearings]
    rings += [(s.shaft_surface, s.centre, s.shaft_diameter / 2) for s in model.seals]
    rings += [(s.bore_surface, s.centre, s.shaft_diameter / 2 + s.radial_gap) for s in model.seals]
    for surface, centre, radius in rings:
        points = model.mesh.points[np.unique(model.mesh.surfaces[surface][:, :3])]
        assert np.hypot(*(points[:, 1:] - centre[1:]).T) == pytest.approx(radius, abs=1e-9), surface
        assert (points[:, 0].min() + points[:, 0].max()) / 2 == pytest.approx(centre[0], abs=1e-9), surface


def test_warm_cold_line_is_imprinted() -> None:
    mesh = build_gearbox(PROTOTYPE, "quick").mesh
    x = mesh.points[np.unique(mesh.surfaces["outer_warm"]), 0]
    assert (x.min(), x.max()) == pytest.approx(PROTOTYPE.warm_limits, abs=1e-9)


def test_field_shares_nodes_with_the_housing_and_shafts_with_nothing_but_their_gears() -> None:
    mesh = build_gearbox(PROTOTYPE, "quick").mesh
    nodes = {body: set(np.unique(mesh.cells[cells]).tolist()) for body, cells in mesh.bodies.items()}
    joined = {(a, b) for a in nodes for b in nodes if a < b and nodes[a] & nodes[b]}
    assert joined == {("field", "housing"), ("gear_pinion", "shaft_pinion"), ("gear_wheel", "shaft_wheel")}
    foot = np.array(sorted(nodes["field"] & nodes["housing"]))
    assert mesh.points[foot, 2] == pytest.approx(0.0, abs=1e-9)


def test_surface_normals_point_outwards() -> None:
    mesh = build_gearbox(PROTOTYPE, "quick").mesh
    facets = mesh.surfaces["outer_cold_front"]
    corners = mesh.points[facets[:, :3]]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]).sum(axis=0)
    bore = mesh.points[mesh.surfaces["bearing_bore_wheel_front"][:, :3]]
    inwards = np.cross(bore[:, 1] - bore[:, 0], bore[:, 2] - bore[:, 0])
    radial = bore.mean(axis=1) - (0.0, 0.04975, 0.14)
    assert normal[0] < 0.0
    assert np.all(np.einsum("fi,fi->f", inwards[:, 1:], radial[:, 1:]) < 0.0)


def test_stations() -> None:
    model = build_gearbox(PROTOTYPE, "quick")
    assert [b.name for b in model.bearings if b.locating] == ["pinion_front", "wheel_rear"]
    assert [s.name for s in model.seals] == [
        "pinion_front", "pinion_rear", "pinion_rear_end",
        "wheel_front", "wheel_rear", "wheel_front_end", "wheel_rear_end",
    ]  # fmt: skip
    assert model.shafts[1].start == pytest.approx(-0.05)
    assert model.shafts[1].end == pytest.approx(PROTOTYPE.length + 0.06)
    assert model.gears[0].face_width == pytest.approx(0.007)
    assert (model.fixed_body, model.foot_surface) == ("field", "field_bottom")
    named = {name for b in model.bearings for name in (b.bore_surface, b.journal_surface)}
    named |= {name for s in model.seals for name in (s.bore_surface, s.shaft_surface)}
    named |= {name for s in model.shafts for name in (s.start_surface, s.end_surface)}
    named |= {name for g in model.gears for name in (g.rim_surface, *g.side_surfaces)}
    assert named <= set(model.mesh.surfaces)


def test_one_chamber_has_seals_only_where_its_shafts_leave() -> None:
    model = build_gearbox(ONE_CHAMBER, "quick")
    assert [s.name for s in model.seals] == ["pinion_rear_end", "wheel_front_end", "wheel_rear_end"]
    assert not any(word in name for name in model.mesh.surfaces for word in ("cold", "partition"))
    assert [b.centre[0] for b in model.bearings[:2]] == pytest.approx([0.026, ONE_CHAMBER.length - 0.026])


DIGEST = """
import hashlib
from tests_housing import PROTOTYPE
from thermal.housing.gearbox import build_gearbox
mesh = build_gearbox(PROTOTYPE, "quick").mesh
parts = [mesh.points, mesh.cells, *mesh.bodies.values(), *mesh.surfaces.values()]
print(hashlib.sha256(b"".join(part.tobytes() for part in parts)).hexdigest())
"""


def test_two_processes_make_identical_arrays(tmp_path: Path) -> None:
    (tmp_path / "tests_housing.py").write_text(Path(__file__).read_text())
    (tmp_path / "digest.py").write_text(DIGEST)
    mesh = build_gearbox(PROTOTYPE, "quick").mesh
    parts = [mesh.points, mesh.cells, *mesh.bodies.values(), *mesh.surfaces.values()]
    here = hashlib.sha256(b"".join(part.tobytes() for part in parts)).hexdigest()
    command = [sys.executable, "-c", f"import sys; sys.path[:0] = {[str(tmp_path), *sys.path]!r}\n{DIGEST}"]
    there = subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()
    assert there == here


def test_a_model_is_built_once() -> None:
    assert build_gearbox(PROTOTYPE, "quick") is build_gearbox(replace(PROTOTYPE), "quick")


def test_node_counts_of_the_fidelities() -> None:
    assert 7_000 < len(build_gearbox(PROTOTYPE, "quick").mesh.points) < 13_000
    assert 25_000 < len(build_gearbox(PROTOTYPE, "standard").mesh.points) < 38_000


def test_node_count_hardly_depends_on_the_size_of_the_gearbox() -> None:
    def scaled(shaft: ShaftGeometry) -> ShaftGeometry:
        assert shaft.gear is not None
        lengths = {
            name: 3.0 * getattr(shaft, name)
            for name in (
                "y", "seal_diameter", "seat_diameter", "overhang_diameter", "overhang_front", "overhang_rear",
            )
        }  # fmt: skip
        gear = GearDisc(outer_diameter=3 * shaft.gear.outer_diameter, width=3 * shaft.gear.width)
        bearing = EndBearing(journal_diameter=3 * BEARING.journal_diameter, width=3 * BEARING.width)
        return replace(shaft, gear=gear, front=bearing, rear=bearing, **lengths)

    large = HousingGeometry(
        chamber_length=0.3, cold_length_front=0.27, cold_length_rear=0.27, height=0.84, width=0.96,
        wall_thickness=0.039, floor_thickness=0.045, top_thickness=0.036, partition_thickness=0.045,
        end_wall_thickness=0.09, shaft_height=0.42, shafts=(scaled(PINION), scaled(WHEEL)),
        end_seal_width=0.018, field=ClampingField(length=2.4, width=3.6, thickness=0.45),
    )  # fmt: skip
    ratio = len(build_gearbox(large).mesh.points) / len(build_gearbox(PROTOTYPE).mesh.points)
    assert 0.8 < ratio < 1.25


def test_finer_mesh_comes_closer_to_the_cylinder() -> None:
    """Second-order arcs: halving the angle cuts the error of a mantle sixteenfold, at least eightfold."""
    sizes = mesh_sizes(PROTOTYPE, "quick")
    exact = exact_areas(PROTOTYPE)["seal_bore_wheel_rear"]
    errors = [
        abs(area(build_gearbox(PROTOTYPE, replace(sizes, circle=n)).mesh, "seal_bore_wheel_rear") / exact - 1)
        for n in (7, 14)
    ]
    assert errors[0] > 8 * errors[1]


def test_unknown_fidelity_and_impossible_sizes_are_refused() -> None:
    with pytest.raises(GeometryError, match="'fine' is unknown; use one of quick, standard, reference"):
        build_gearbox(PROTOTYPE, "fine")  # type: ignore[arg-type]
    with pytest.raises(GeometryError, match="wall = -1"):
        MeshSizes(wall=-1.0, field=0.1, shaft=0.1, circle=8)
    with pytest.raises(GeometryError, match="circle = 3"):
        MeshSizes(wall=0.1, field=0.1, shaft=0.1, circle=3)


def test_missing_system_library_surfaces_as_the_loaders_error(monkeypatch: pytest.MonkeyPatch) -> None:
    import builtins

    real = builtins.__import__

    def refuse(name: str, *args: object, **kwargs: object) -> object:
        if name == "gmsh":
            raise OSError("libGLU.so.1: cannot open shared object file")
        return real(name, *args, **kwargs)  # type: ignore[arg-type]

    monkeypatch.setattr(builtins, "__import__", refuse)
    with pytest.raises(OSError, match=r"libGLU\.so\.1"):
        build_gearbox(replace(PROTOTYPE, height=0.2801), "quick")


def test_gmsh_is_finalised_after_a_failure(monkeypatch: pytest.MonkeyPatch) -> None:
    import gmsh

    def fail(dimension: int) -> None:
        raise Exception("no")

    with monkeypatch.context() as patch:
        patch.setattr(gmsh.model.mesh, "generate", fail)
        with pytest.raises(MeshError, match="could not mesh housing: no"):
            build_gearbox(replace(PROTOTYPE, height=0.2802), "quick")
    assert not gmsh.isInitialized()
    assert len(build_gearbox(replace(PROTOTYPE, height=0.2802), "quick").mesh.cells) > 1000


# ---------------------------------------------------------------------- curved elements

UNIT = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
STRAIGHT = np.concatenate(
    [UNIT, [(UNIT[a] + UNIT[b]) / 2 for a, b in ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))]]
)
CELL = np.arange(10, dtype=np.int32)[None]


def test_jacobian_ratio_of_straight_and_inverted_elements() -> None:
    assert jacobian_ratio(STRAIGHT, CELL) == pytest.approx(1.0)
    bulged = STRAIGHT.copy()
    bulged[5] = (0.05, 0.05, 0.0)
    assert jacobian_ratio(bulged, CELL)[0] < 0.0
    mirrored = STRAIGHT * (-1.0, 1.0, 1.0)
    assert jacobian_ratio(mirrored, CELL)[0] == -np.inf


def test_straightening_repairs_curved_elements_and_refuses_inverted_ones() -> None:
    bulged = STRAIGHT.copy()
    bulged[5] = (0.05, 0.05, 0.0)
    assert straighten_inverted(bulged, CELL) == pytest.approx(STRAIGHT)
    with pytest.raises(MeshError, match="1 of 1 elements are inverted"):
        straighten_inverted(STRAIGHT * (-1.0, 1.0, 1.0), CELL)


def test_bending_puts_free_middles_on_the_circle_of_their_ends() -> None:
    """Edge 1-2 spans 80 degrees at radius 2 round the x axis; its middle belongs at radius 2."""
    half = np.radians(40.0)
    corners = np.array(
        [
            [0.0, 1, 0],
            [0, 2 * np.cos(half), -2 * np.sin(half)],
            [0, 2 * np.cos(half), 2 * np.sin(half)],
            [1, 1, 0],
        ]
    )
    points = np.concatenate(
        [
            corners,
            [(corners[a] + corners[b]) / 2 for a, b in ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))],
        ]
    )
    free = np.ones(10, dtype=bool)
    bent = bend_round_axes(points, CELL, free, [(0.0, 0.0, 2.0)])
    assert bent[5] == pytest.approx([0.0, 2.0, 0.0])
    assert np.array_equal(bent[:4], corners)
    assert bend_round_axes(points, CELL, ~free, [(0.0, 0.0, 2.0)]) == pytest.approx(points)
    assert bend_round_axes(points, CELL, free, [(0.0, 0.0, 0.5)])[5] == pytest.approx(points[5])
