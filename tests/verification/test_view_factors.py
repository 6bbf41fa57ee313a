"""View factors against closed forms, reciprocity, and the heat of enclosures with a known solution.

Closed forms: Howell, A Catalog of Radiation Heat Transfer Configuration Factors, 3rd ed., C-11 (parallel
rectangles), C-14 (perpendicular rectangles with a common edge), C-91 and C-92 (coaxial cylinders).
"""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.builders.curved_blocks import cylinder_sector
from tests.builders.exact_view_factors import view_factors
from tests.builders.two_blocks import renamed
from thermal.conditions.boundary import Adiabatic, ConditionError, PrescribedTemperature
from thermal.conditions.enclosure import Enclosure
from thermal.conditions.ray_view_factors import ray_view_factors
from thermal.conditions.view_factor_closure import EnclosureError, close_view_factors
from thermal.conduction.setup import Condition, ConductionSetup
from thermal.conduction.steady import solve_steady
from thermal.fe.mesh import CellName, NamedMesh, box_mesh, disjoint_union
from thermal.films.law import STEFAN_BOLTZMANN


def parallel(x: float, y: float) -> float:
    """Opposite rectangles a x b at distance c; x = a/c, y = b/c."""
    one_x, one_y = 1.0 + x * x, 1.0 + y * y
    total = 0.5 * np.log(one_x * one_y / (1.0 + x * x + y * y))
    total += x * np.sqrt(one_y) * np.arctan(x / np.sqrt(one_y)) - x * np.arctan(x)
    total += y * np.sqrt(one_x) * np.arctan(y / np.sqrt(one_x)) - y * np.arctan(y)
    return float(2.0 * total / (np.pi * x * y))


def perpendicular(h: float, w: float) -> float:
    """From a rectangle of width w to one of height h that stands on a common edge of length 1."""
    h2, w2 = h * h, w * w
    s = h2 + w2
    logs = (1.0 + w2) * (1.0 + h2) / (1.0 + s)
    logs *= (w2 * (1.0 + s) / ((1.0 + w2) * s)) ** w2 * (h2 * (1.0 + s) / ((1.0 + h2) * s)) ** h2
    arcs = w * np.arctan(1.0 / w) + h * np.arctan(1.0 / h) - np.sqrt(s) * np.arctan(1.0 / np.sqrt(s))
    return float((arcs + 0.25 * np.log(logs)) / (np.pi * w))


def coaxial(ratio: float, length: float) -> tuple[float, float]:
    """Outer to inner and outer to itself; ratio of radii and length over the inner radius."""
    r, h = ratio, length
    a, b = h * h + r * r - 1.0, h * h - r * r + 1.0
    inner = (
        np.sqrt((a + 2.0) ** 2 - 4.0 * r * r) * np.arccos(b / (r * a))
        + b * np.arcsin(1.0 / r)
        - np.pi * a / 2
    )
    to_inner = (1.0 - (np.arccos(b / a) - inner / (2.0 * h)) / np.pi) / r
    root = np.sqrt(4.0 * r * r + h * h) / h
    first = (4.0 * (r * r - 1.0) + h * h / (r * r) * (r * r - 2.0)) / (h * h + 4.0 * (r * r - 1.0))
    braces = root * np.arcsin(first) - np.arcsin(1.0 - 2.0 / (r * r)) + np.pi / 2.0 * (root - 1.0)
    to_self = 1.0 - 1.0 / r + 2.0 / (np.pi * r) * np.arctan(2.0 * np.sqrt(r * r - 1.0) / h)
    return float(to_inner), float(to_self - h / (2.0 * np.pi * r) * braces)


def cavity(cell: CellName = "tetra10") -> NamedMesh:
    """Six plates around a room of 1.0 x 0.8 x 0.6 m, each with a face to the room."""
    size, t = np.array([1.0, 0.8, 0.6]), 0.1
    plates = []
    for axis, letter in enumerate("xyz"):
        for end, start in (("low", -t), ("high", size[axis])):
            edges, origin, parts = size.copy(), np.zeros(3), [3, 3, 3]
            edges[axis], origin[axis], parts[axis] = t, start, 1
            name = f"{letter}_{end}"
            box = box_mesh(tuple(edges), tuple(parts), tuple(origin), name, cell)  # type: ignore[arg-type]
            plates.append(renamed(box, name))
    return disjoint_union(*plates)


FACES = ["x_low_x_max", "x_high_x_min", "y_low_y_max", "y_high_y_min", "z_low_z_max", "z_high_z_min"]


@pytest.mark.parametrize("cell", ["tetra10", "hexahedron20"])
def test_rectangles(cell: CellName) -> None:
    factors = np.array(view_factors(cavity(cell), FACES))
    assert factors[0, 1] == pytest.approx(parallel(0.8, 0.6), rel=1e-3)
    assert factors[2, 3] == pytest.approx(parallel(1.0 / 0.8, 0.6 / 0.8), rel=1e-3)
    assert factors[4, 5] == pytest.approx(parallel(1.0 / 0.6, 0.8 / 0.6), rel=1e-3)
    assert factors[4, 0] == pytest.approx(perpendicular(0.6 / 0.8, 1.0 / 0.8), rel=1e-3)
    assert factors[2, 4] == pytest.approx(perpendicular(0.8 / 1.0, 0.6 / 1.0), rel=1e-3)
    assert_allclose(factors.sum(axis=1), 1.0, atol=2e-3)
    assert_allclose(np.diag(factors), 0.0, atol=1e-12)


def test_a_cavity_closes_and_obeys_reciprocity() -> None:
    raw = np.array(view_factors(cavity(), FACES))
    areas = np.array([0.48, 0.48, 0.6, 0.6, 0.8, 0.8])
    closed = close_view_factors(raw, areas, FACES, opening=False)
    assert_allclose(closed.sum(axis=1), 1.0, rtol=0.0, atol=1e-13)
    exchange = areas[:, None] * closed
    assert_allclose(exchange, exchange.T, rtol=1e-12)
    assert_allclose(closed, raw, atol=2e-3)


def test_coaxial_cylinders_hide_the_far_side_from_each_other() -> None:
    full = 2.0 * np.pi
    inner = cylinder_sector((0.4, 0.5), (1, 16, 3), "inner", angle=full, length=2.0)
    outer = cylinder_sector((1.0, 1.1), (1, 16, 3), "outer", angle=full, length=2.0)
    mesh = disjoint_union(inner, outer)
    factors = np.array(view_factors(mesh, ["inner_outer", "outer_inner"]))
    to_inner, to_self = coaxial(2.0, 4.0)
    assert factors[1, 0] == pytest.approx(to_inner, rel=0.01)
    assert factors[1, 1] == pytest.approx(to_self, rel=0.01)
    assert factors[0, 0] == 0.0
    blind = np.array(view_factors(mesh, ["outer_inner"]))
    assert blind[0, 0] > 1.5 * to_self


def test_a_named_obstacle_hides_what_is_behind() -> None:
    low = renamed(box_mesh((1.0, 1.0, 0.1), (3, 3, 1), name="low"), "low")
    high = renamed(box_mesh((1.0, 1.0, 0.1), (3, 3, 1), (0.0, 0.0, 1.1), "high"), "high")
    screen = renamed(box_mesh((3.0, 3.0, 0.1), (3, 3, 1), (-1.0, -1.0, 0.55), "screen"), "screen")
    mesh = disjoint_union(low, high, screen)
    pair = ["low_z_max", "high_z_min"]
    assert np.array(view_factors(mesh, pair))[0, 1] == pytest.approx(parallel(1.0, 1.0), rel=1e-3)
    assert np.array(view_factors(mesh, pair, ["screen_z_min"])).max() == 0.0


def slabs() -> NamedMesh:
    """Two slabs that face each other; heat flows along x only."""
    hot = renamed(box_mesh((0.05, 0.2, 0.2), (2, 2, 2), name="hot"), "hot")
    cold = renamed(box_mesh((0.05, 0.2, 0.2), (2, 3, 3), (0.1, 0.0, 0.0), "cold"), "cold")
    return disjoint_union(hot, cold)


def slab_conditions(enclosure: Enclosure) -> list[Condition]:
    sides = [f"{body}_{a}_{e}" for body in ("hot", "cold") for a in "yz" for e in ("min", "max")]
    return [
        PrescribedTemperature(surface="hot_x_min", temperature=900.0),
        PrescribedTemperature(surface="cold_x_max", temperature=400.0),
        enclosure,
        *(Adiabatic(surface=side) for side in sides),
    ]


def test_two_grey_surfaces_exchange_what_the_network_says() -> None:
    """Siegel, Howell, eq. 7-18 for two surfaces, the second one concave: F22 = 0.3."""
    e1, e2, f12, f21 = 0.7, 0.4, 1.0, 0.7
    mesh = slabs()
    wide = replace(mesh, points=mesh.points * np.where(mesh.points[:, :1] > 0.07, [1.0, 1.0, 1.0 / 0.7], 1.0))
    enclosure = Enclosure(
        name="gap",
        surfaces=("hot_x_max", "cold_x_min"),
        emissivities=(e1, e2),
        view_factors=((0.0, f12), (f21, 1.0 - f21)),
    )
    solution = solve_steady(
        ConductionSetup(wide, {"hot": 30.0, "cold": 30.0}), slab_conditions(enclosure), tolerance=1e-11
    )
    rows = {row.surface: row for row in solution.balance.rows if row.kind == "enclosure"}
    hot, cold = rows["hot_x_max"], rows["cold_x_min"]
    resistance = (1.0 - e1) / (e1 * hot.area) + 1.0 / (hot.area * f12) + (1.0 - e2) / (e2 * cold.area)
    heat = STEFAN_BOLTZMANN * (hot.mean_temperature**4 - cold.mean_temperature**4) / resistance
    assert hot.power == pytest.approx(-heat, rel=1e-8)
    assert cold.power == pytest.approx(heat, rel=1e-8)
    assert hot.mean_temperature > cold.mean_temperature + 50.0


def test_a_surface_that_sees_only_the_opening_radiates_to_surroundings() -> None:
    enclosure = Enclosure(
        name="gap",
        surfaces=("hot_x_max", "cold_x_min"),
        emissivities=(0.7, 1.0),
        view_factors=((0.0, 0.0), (0.0, 0.0)),
        opening_temperature=350.0,
    )
    solution = solve_steady(
        ConductionSetup(slabs(), {"hot": 30.0, "cold": 30.0}), slab_conditions(enclosure), tolerance=1e-11
    )
    for row in solution.balance.rows:
        if row.kind == "enclosure":
            emissivity = 0.7 if row.surface == "hot_x_max" else 1.0
            by_hand = emissivity * STEFAN_BOLTZMANN * row.area * (350.0**4 - row.mean_temperature**4)
            assert row.power == pytest.approx(by_hand, rel=1e-8)


NAMES = ("a", "b")
BAD = [
    (((0.0, 0.5), (0.5, 0.0)), False, "a add up to 0.5 and cannot close.*opening_temperature"),
    (((0.0, 1.0), (0.5, 0.5)), False, "A F = 1 m2 one way and 0.5 m2"),
    (((0.6, 0.6), (0.6, 0.4)), True, "a add up to 1.2 and cannot close.*hidden"),
    (((0.0, -0.1), (0.0, 0.0)), True, "finite and not negative"),
    (((1.0,), (0.0,)), False, r"of shape \(2, 1\): need \(2, 2\)"),
    (((0.99, 0.0), (0.0, 0.0)), False, "b add up to 0 and cannot close"),
]


@pytest.mark.parametrize(("factors", "opening", "message"), BAD)
def test_view_factors_that_cannot_close_are_refused(factors, opening: bool, message: str) -> None:
    with pytest.raises(EnclosureError, match=message):
        close_view_factors(np.array(factors), np.ones(2), NAMES, opening)


def test_unknown_surfaces_and_large_meshes_are_refused() -> None:
    with pytest.raises(ConditionError, match="unknown surface 'roof'"):
        view_factors(cavity(), ["roof"])
    with pytest.raises(ConditionError, match="take a coarser mesh"):
        view_factors(box_mesh((1.0, 1.0, 1.0), (40, 40, 1)), ["z_min"])


@pytest.mark.parametrize("cell", ["tetra10", "hexahedron20"])
def test_rays_between_rectangles(cell: CellName) -> None:
    mesh = cavity(cell)
    exchange = ray_view_factors(mesh, FACES)
    factors = np.array(exchange.factors)
    assert factors[0, 1] == pytest.approx(parallel(0.8, 0.6), abs=3e-3)
    assert factors[4, 0] == pytest.approx(perpendicular(0.6 / 0.8, 1.0 / 0.8), abs=3e-3)
    assert_allclose(factors, np.array(view_factors(mesh, FACES)), atol=3e-3)
    assert_allclose(factors.sum(axis=1), 1.0, atol=3e-3)
    exchanged = np.array(exchange.areas)[:, None] * factors
    assert_allclose(exchanged, exchanged.T, rtol=1e-12)
    assert_allclose(exchange.areas, [0.48, 0.48, 0.6, 0.6, 0.8, 0.8], rtol=1e-12)
    assert exchange.elsewhere == {}
    assert ray_view_factors(mesh, FACES) == exchange


def test_rays_between_coaxial_cylinders() -> None:
    full = 2.0 * np.pi
    inner = cylinder_sector((0.4, 0.5), (1, 48, 3), "inner", angle=full, length=2.0)
    outer = cylinder_sector((1.0, 1.1), (1, 48, 3), "outer", angle=full, length=2.0)
    factors = np.array(ray_view_factors(disjoint_union(inner, outer), ["inner_outer", "outer_inner"]).factors)
    to_inner, to_self = coaxial(2.0, 4.0)
    assert factors[1, 0] == pytest.approx(to_inner, abs=3e-3)
    assert factors[1, 1] == pytest.approx(to_self, abs=3e-3)
    assert factors[0, 0] == 0.0


def test_rays_stop_at_surfaces_that_are_no_members_and_name_them() -> None:
    low = renamed(box_mesh((1.0, 1.0, 0.1), (3, 3, 1), name="low"), "low")
    high = renamed(box_mesh((1.0, 1.0, 0.1), (3, 3, 1), (0.0, 0.0, 1.1), "high"), "high")
    screen = renamed(box_mesh((1.0, 0.5, 0.1), (3, 3, 1), (0.0, 0.0, 0.55), "screen"), "screen")
    pair = ["low_z_max", "high_z_min"]
    free = ray_view_factors(disjoint_union(low, high), pair)
    assert free.factors[0][1] == pytest.approx(parallel(1.0, 1.0), abs=3e-3)
    hidden = ray_view_factors(disjoint_union(low, high, screen), pair)
    assert hidden.factors[0][1] < 0.6 * free.factors[0][1]
    assert hidden.elsewhere["screen_z_min"] > 0.15


def test_faces_that_touch_see_each_other() -> None:
    low = renamed(box_mesh((1.0, 1.0, 0.1), (3, 3, 1), name="low"), "low")
    high = renamed(box_mesh((1.0, 1.0, 0.1), (2, 2, 1), (0.0, 0.0, 0.1), "high"), "high")
    factors = ray_view_factors(disjoint_union(low, high), ["low_z_max", "high_z_min"]).factors
    assert_allclose(factors, [[0.0, 1.0], [1.0, 0.0]], atol=1e-3)


def test_rays_want_known_surfaces_and_numbers_that_say_something() -> None:
    with pytest.raises(ConditionError, match="unknown surface 'x_lo'; known: x_high_x_max"):
        ray_view_factors(cavity(), ["x_lo"])
    with pytest.raises(ConditionError, match="by 10 rays a surface, the limit is 100"):
        ray_view_factors(cavity(), FACES, rays=10)


def test_a_held_surface_radiates_and_what_holds_it_takes_the_heat() -> None:
    """Plates a = 1 m2 opposite each other, closed by reflection: q = sigma (T1^4 - T2^4) / (1/e1 + 1/e2 - 1)."""
    low = renamed(box_mesh((1.0, 1.0, 0.1), (2, 2, 1), name="low"), "low")
    high = renamed(box_mesh((1.0, 1.0, 0.1), (2, 2, 1), (0.0, 0.0, 0.6), "high"), "high")
    mesh = disjoint_union(low, high)
    held = {"low_z_max": 500.0, "high_z_min": 400.0}
    conditions: list[Condition] = [
        Enclosure(
            name="gap",
            surfaces=tuple(held),
            emissivities=(0.8, 0.5),
            view_factors=((0.0, 1.0), (1.0, 0.0)),
        ),
        *(PrescribedTemperature(surface=name, temperature=value) for name, value in held.items()),
        *(Adiabatic(surface=name) for name in mesh.surfaces if name not in held),
    ]
    solution = solve_steady(ConductionSetup(mesh, {"low": 50.0, "high": 50.0}), conditions, 450.0)
    flux = STEFAN_BOLTZMANN * (500.0**4 - 400.0**4) / (1.0 / 0.8 + 1.0 / 0.5 - 1.0)
    rows = {(row.surface, row.kind): row.power for row in solution.balance.rows}
    assert rows["low_z_max", "enclosure"] == pytest.approx(-flux, rel=1e-9)
    assert rows["low_z_max", "prescribed_temperature"] == pytest.approx(flux, rel=1e-9)
    assert rows["high_z_min", "prescribed_temperature"] == pytest.approx(-flux, rel=1e-9)
    assert solution.balance.closure < 1e-9
