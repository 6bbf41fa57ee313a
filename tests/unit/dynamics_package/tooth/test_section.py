"""Division of the section of a gear: every gear that can be drawn, no folded element, its own area."""

from dataclasses import replace

import numpy as np
import pytest

from dynamics.errors import DynamicsInputError
from dynamics.gear.tooth_form import TipEdge, ToothForm
from dynamics.tooth import segment as section_module
from dynamics.tooth.influence_numbers import STANDARD, TEETH, GearBody
from dynamics.tooth.segment import anticlockwise, gear_section, least_jacobian, on_circles
from tests.builders.influence import COARSE, drawn_gear
from thermal.fe.reference_elements import QUAD_8

BODY = GearBody(bore_radius=20e-3)


def area(points, cells):
    """Of quadrilaterals with curved sides [m2]."""
    at, weight = np.polynomial.legendre.leggauss(4)
    at, weight = 0.5 * (at + 1.0), 0.5 * weight
    places = np.array([[x, y] for x in at for y in at])
    jacobian = np.einsum("nka,qkb->nqab", points[cells], QUAD_8.gradients(places))
    return float((np.linalg.det(jacobian) @ np.outer(weight, weight).ravel()).sum())


def drawn_area(form, body):
    """Three teeth and the disc under them, less the bore [m2]."""
    gear = form.gear
    rolls = np.linspace(gear.roll_length(form.form_radius), form.flank_tip_roll, 400)
    half = np.concatenate([form.fillet(400), form.flank_point(rolls), form.tip_points(), [[0.0, 0.0]]])
    x, y = half.T
    sector = 0.5 * abs(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))
    # from the end of the fillet on the root circle to the middle of the space
    ground = np.pi / gear.teeth - np.arctan2(half[0, 0], half[0, 1])
    disc = np.pi * (1.0 - len(TEETH) / gear.teeth) + len(TEETH) * ground
    return 2 * len(TEETH) * sector + form.root_radius**2 * disc - np.pi * body.bore_radius**2


@pytest.mark.parametrize(("teeth", "helix"), [(12, 0.0), (17, 35.0), (28, 0.0), (60, 35.0), (150, 0.0)])
@pytest.mark.parametrize(
    ("pressure_angle", "shift", "tool"), [(18.0, 0.4, 0.38), (20.0, 0.0, 0.3), (25.0, 0.4, 0.2)]
)
def test_every_gear_divides_into_its_own_area(teeth, helix, pressure_angle, shift, tool):
    module = {12: 10e-3, 17: 4.5e-3}.get(teeth, 1e-3)
    form = ToothForm(
        gear=drawn_gear(
            teeth, module=module, helix=helix, shift=shift, pressure_angle=pressure_angle, tool_radius=tool
        )
    )
    for share in (0.1, 0.8 if teeth < 40 else 0.95):
        body = GearBody(bore_radius=share * form.root_radius)
        section = gear_section(form, body)
        assert least_jacobian(section.points, section.cells) > 0.05
        assert area(section.points, section.cells) == pytest.approx(drawn_area(form, body), rel=1e-3)
        rim = 0.6 * (form.root_radius - body.bore_radius)
        spoked = gear_section(form, replace(body, rim_thickness=rim, web_thickness=1e-3))
        assert least_jacobian(spoked.points, spoked.cells) > 0.05
        radii = np.hypot(*spoked.points[spoked.cells[spoked.web, :4]].T)
        assert len(spoked.web) and radii.max() == pytest.approx(form.root_radius - rim, rel=1e-9)
        others = np.delete(np.arange(len(spoked.cells)), spoked.web)
        assert np.hypot(*spoked.points[spoked.cells[others, :4]].T).min() > form.root_radius - rim - 1e-9


@pytest.mark.parametrize("module", [0.5e-3, 20e-3])
def test_undercut_teeth_divide(module):
    form = ToothForm(gear=drawn_gear(12, module=module))
    assert form.gear.undercut
    section = gear_section(form, GearBody(bore_radius=0.5 * form.root_radius))
    assert least_jacobian(section.points, section.cells) > 0.05


@pytest.mark.parametrize(
    "details",
    [
        {"tip_edge": TipEdge(rounding=0.05e-3)},
        {"tip_edge": TipEdge(rounding=0.8e-3)},
        {"tip_edge": TipEdge(chamfer=0.05e-3)},
        {"tip_edge": TipEdge(chamfer=0.6e-3)},
        {"protuberance": 0.02e-3},
        {"protuberance": 0.4e-3},
        {"protuberance": 0.1e-3, "tip_edge": TipEdge(chamfer=0.4e-3)},
    ],
)
@pytest.mark.parametrize(
    "division", [STANDARD, COARSE, STANDARD.finer(2)], ids=["standard", "coarse", "finer"]
)
def test_tip_edges_and_protuberance(details, division):
    form = ToothForm(gear=drawn_gear(28, module=4e-3), **details)
    section = gear_section(form, BODY, division)
    assert least_jacobian(section.points, section.cells) > 0.05
    assert area(section.points, section.cells) == pytest.approx(drawn_area(form, BODY), rel=1e-3)


@pytest.fixture(scope="module")
def form():
    return ToothForm(gear=drawn_gear(28, module=4e-3))


@pytest.fixture(scope="module")
def section(form):
    return gear_section(form, BODY)


def test_curves_lie_where_they_are_named(form, section):
    pitch = 2.0 * np.pi / 28
    for tooth in TEETH:
        c, s = np.cos(tooth * pitch), np.sin(tooth * pitch)
        upright = section.points @ np.array([[c, s], [-s, c]])  # anticlockwise, back to the y axis
        flank = upright[section.flanks[tooth]]
        radii = np.hypot(*flank.T)
        assert np.all(np.diff(radii) > 0.0)
        assert radii[[0, -1]] == pytest.approx([form.form_radius, form.gear.tip_radius], rel=1e-9)
        angles = [form.half_angle(radius) for radius in radii]
        assert np.arctan2(*flank.T) == pytest.approx(angles, abs=2e-6)
        assert upright[section.axes[tooth]][:, 0] == pytest.approx(0.0, abs=1e-12)
        assert np.all(np.diff(upright[section.axes[tooth]][:, 1]) > 0.0)
        for side in (1, -1):
            fillet = upright[section.fillets[tooth, side]]
            assert np.arctan2(*fillet[0]) == pytest.approx(side * 0.5 * pitch, abs=1e-9)
            assert np.hypot(*fillet[[0, -1]].T) == pytest.approx(
                [form.root_radius, form.form_radius], rel=1e-9
            )
    assert np.hypot(*section.points[section.bore].T) == pytest.approx(BODY.bore_radius, rel=1e-9)
    for side in (1, -1):
        rim = section.points[section.rims[side]]
        assert np.hypot(*rim.T) == pytest.approx(form.root_radius, rel=1e-9)
        assert rim[-1] == pytest.approx([0.0, -form.root_radius], abs=1e-9)
    assert not len(section.web)


def test_cells_meet_in_whole_sides(section):
    """A side has the same three nodes in both cells, and the sides of one cell alone close three curves at most."""
    sides = np.sort(np.concatenate([section.cells[:, [k, (k + 1) % 4, 4 + k]] for k in range(4)]), axis=1)
    _, counts = np.unique(sides, axis=0, return_counts=True)
    assert counts.max() == 2
    corners = np.sort(np.concatenate([section.cells[:, [k, (k + 1) % 4]] for k in range(4)]), axis=1)
    assert len(np.unique(corners, axis=0)) == len(counts)
    assert len(np.unique(section.cells)) == len(section.points)


def test_finer_divides_every_element(form):
    twice = gear_section(form, BODY, STANDARD.finer(2))
    assert len(twice.flanks[0]) == 4 * STANDARD.profile + 1
    assert len(twice.fillets[0, 1]) == 4 * STANDARD.fillet + 1
    assert len(twice.flanks[1]) == 4 * STANDARD.neighbours[0] + 1


@pytest.mark.parametrize(
    "body",
    [
        GearBody(bore_radius=60e-3),
        GearBody(bore_radius=0.0),
        GearBody(bore_radius=50.9e-3),
        GearBody(bore_radius=20e-3, rim_thickness=0.5e-3),
        GearBody(bore_radius=20e-3, rim_thickness=-1e-3),
        GearBody(bore_radius=20e-3, rim_thickness=40e-3),
        GearBody(bore_radius=float("nan")),
    ],
)
def test_body_that_leaves_nothing_under_the_teeth_is_named(form, body):
    with pytest.raises(
        DynamicsInputError, match=r"bore_radius = .* rim_thickness = .* 0\.2 modules .*; correct"
    ):
        gear_section(form, body)


def test_rim_down_to_the_bore_is_named(form):
    body = GearBody(bore_radius=20e-3, rim_thickness=form.root_radius - 20e-3)
    with pytest.raises(DynamicsInputError, match="correct bore or rim"):
        gear_section(form, body)


def test_web_without_rim_is_named(form):
    with pytest.raises(
        DynamicsInputError, match=r"web_thickness = 3\.000 mm without rim_thickness.*; give the rim"
    ):
        gear_section(form, GearBody(bore_radius=20e-3, web_thickness=3e-3))


def test_section_that_folds_is_named(form, monkeypatch):
    monkeypatch.setattr(section_module, "least_jacobian", lambda points, cells: -0.1)
    with pytest.raises(
        DynamicsInputError, match=r"28 teeth and module 4 mm: elements fold.*a tenth of the module"
    ):
        gear_section(form, BODY)


def test_least_jacobian_sees_a_fold():
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0.5, 0], [1, 0.5], [0.5, 1], [0, 0.5]], dtype=float)
    cell = np.arange(8, dtype=np.int32)[None, :]
    assert least_jacobian(square, cell) == pytest.approx(1.0)
    folded = square.copy()
    folded[4] = [0.5, 1.2]
    assert least_jacobian(folded, cell) < 0.0
    clockwise = cell[:, [0, 3, 2, 1, 7, 6, 5, 4]]
    assert least_jacobian(square, clockwise) < 0.0
    assert np.array_equal(anticlockwise(square, clockwise), cell)


def test_wide_thin_cells_follow_the_circle():
    angles, radii = np.radians([0.0, 30.0]), np.array([1.0, 1.02])
    corners = np.array(
        [[r * np.cos(a), r * np.sin(a)] for a, r in zip(angles[[0, 0, 1, 1]], radii[[0, 1, 1, 0]])]
    )
    straight = np.concatenate([corners, 0.5 * (corners + np.roll(corners, -1, axis=0))])
    straight[7] *= 1.0 / np.hypot(*straight[7])  # one side on its circle, as gmsh leaves it
    cell = np.arange(8, dtype=np.int32)[None, :]
    assert least_jacobian(straight, cell) < 0.0
    assert least_jacobian(on_circles(straight, cell), cell) > 0.5
