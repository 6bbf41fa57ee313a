"""Outline of a tooth: fillet, involute, tip edge, protuberance, and what cannot be drawn."""

from math import cos, hypot, pi, radians, sin

import numpy as np
import pytest

from dynamics.gear.involute import GearGeometryError
from dynamics.gear.tooth_form import TipEdge, ToothForm
from tests.builders.influence import drawn_gear

GEARS = [
    drawn_gear(28, module=4e-3),
    drawn_gear(17, module=2e-3, helix=30.0, shift=0.3),
    drawn_gear(99, pressure_angle=18.0, tool_radius=0.3),
    drawn_gear(12, module=5e-3),
]
EACH = pytest.mark.parametrize("gear", GEARS, ids=["28", "helical", "99", "undercut"])


@EACH
def test_fillet_goes_from_the_root_circle_to_the_involute(gear):
    form = ToothForm(gear=gear)
    fillet = form.fillet(101)
    radii = np.hypot(*fillet.T)
    assert radii[0] == pytest.approx(form.root_radius, rel=1e-12)
    assert radii[-1] == pytest.approx(form.form_radius, rel=1e-9)
    assert np.all(np.diff(radii) > 0.0)
    steps = np.hypot(*np.diff(fillet, axis=0).T)
    assert np.ptp(steps) < 1e-3 * steps.mean()
    assert np.arctan2(*fillet[-1]) == pytest.approx(gear.half_angle(form.form_radius), abs=1e-7)
    assert form.form_radius == pytest.approx(gear.form_radius, rel=1e-6)


@pytest.mark.parametrize("gear", [g for g in GEARS if not g.undercut], ids=["28", "helical", "99"])
def test_fillet_runs_into_the_involute_without_a_corner(gear):
    form = ToothForm(gear=gear)
    along = np.diff(form.fillet(2001)[-2:], axis=0)[0]
    normal = form.flank_normal(gear.roll_length(form.form_radius))
    assert abs(along @ normal) / np.hypot(*along) < 2e-3


def test_undercut_fillet_meets_the_involute_in_a_corner():
    gear = GEARS[-1]
    form = ToothForm(gear=gear)
    assert form.form_radius > gear.base_radius
    along = np.diff(form.fillet(2001)[-2:], axis=0)[0]
    assert abs(along @ form.flank_normal(gear.roll_length(form.form_radius))) / np.hypot(*along) > 0.05


@EACH
def test_flank_is_the_involute(gear):
    form = ToothForm(gear=gear)
    roll = np.linspace(gear.roll_length(form.form_radius), form.flank_tip_roll, 50)
    points, normals = form.flank_point(roll), form.flank_normal(roll)
    assert np.hypot(*points.T) == pytest.approx(np.hypot(gear.base_radius, roll))
    assert np.arctan2(*points.T) == pytest.approx(
        [gear.half_angle(r) for r in np.hypot(*points.T)], abs=1e-12
    )
    # normals touch the base circle
    assert points[:, 0] * normals[:, 1] - points[:, 1] * normals[:, 0] == pytest.approx(-gear.base_radius)
    step = form.flank_point(roll + 1e-9) - points
    assert np.abs(np.einsum("nd,nd->n", step, normals)).max() < 1e-15
    feet = form.axis_point(roll)
    assert feet[:, 0] == pytest.approx(0.0, abs=1e-15)
    assert np.all(form.axis_depth(roll) > 0.0)


@EACH
@pytest.mark.parametrize("share", [0.02, 0.1])
def test_rounded_tip_joins_flank_and_tip_circle_smoothly(gear, share):
    rounding = share * gear.normal_module
    form = ToothForm(gear=gear, tip_edge=TipEdge(rounding=rounding))
    edge = form.tip_points()[: form.tip_edge_points]
    centre = form.flank_point(form.flank_tip_roll) - rounding * form.flank_normal(form.flank_tip_roll)
    assert np.hypot(*(edge - centre).T) == pytest.approx(rounding, rel=1e-9)
    assert edge[0] == pytest.approx(form.flank_point(form.flank_tip_roll), abs=1e-12)
    assert hypot(*edge[-1]) == pytest.approx(gear.tip_radius, rel=1e-12)
    # on the tip circle the centre lies on the same radius
    assert np.arctan2(*edge[-1]) == pytest.approx(np.arctan2(*centre), abs=1e-12)
    assert form.flank_tip_radius < gear.tip_radius


def test_chamfer_takes_its_height_off_the_flank():
    gear = GEARS[0]
    form = ToothForm(gear=gear, tip_edge=TipEdge(chamfer=0.4e-3))
    assert form.flank_tip_radius == pytest.approx(gear.tip_radius - 0.4e-3)
    edge = form.tip_points()[: form.tip_edge_points]
    assert len(edge) == 2
    assert hypot(*edge[1]) == pytest.approx(gear.tip_radius)
    across = gear.tip_radius * (np.arctan2(*edge[0]) - np.arctan2(*edge[1]))
    assert across == pytest.approx(0.4e-3)


def test_outline_ends_on_the_tooth_axis():
    for edge in (TipEdge(), TipEdge(rounding=0.3e-3), TipEdge(chamfer=0.3e-3)):
        form = ToothForm(gear=GEARS[0], tip_edge=edge)
        assert form.tip_points()[-1] == pytest.approx([0.0, GEARS[0].tip_radius], abs=1e-15)


def test_protuberance_leaves_an_undercut_of_its_size():
    """At the end of the tip arc the fillet stands the protuberance under the involute, measured along its normal."""
    gear, protuberance = GEARS[0], 0.1e-3
    plain, form = ToothForm(gear=gear), ToothForm(gear=gear, protuberance=protuberance)
    assert form.form_radius > plain.form_radius
    assert form.root_radius == plain.root_radius
    fillet, own = form.fillet(4001), plain.fillet(4001)
    lowest = gear.roll_length(plain.form_radius)
    roll = np.linspace(lowest, gear.roll_length(form.form_radius), 4001)
    involute = form.flank_point(roll)
    outline = np.concatenate([own, involute])
    distance = [np.hypot(*(outline - point).T).min() for point in fillet[::40]]
    assert max(distance) == pytest.approx(protuberance, rel=0.05)


def test_thickness_allowance_makes_the_tooth_thinner():
    thick = ToothForm(gear=GEARS[0])
    radius = GEARS[0].reference_radius
    assert 2.0 * radius * thick.half_angle(radius) == pytest.approx(0.5 * pi * 4e-3, rel=1e-9)
    assert thick.half_angle(0.5 * radius) == thick.half_angle(GEARS[0].base_radius)


def test_helical_fillet_is_the_envelope_of_an_ellipse():
    """The lowest point stands on the root circle, in the transverse section as in the normal one."""
    gear = GEARS[1]
    form = ToothForm(gear=gear)
    x, y = form.fillet_point(0.5 * pi)
    assert hypot(x, y) == pytest.approx(form.root_radius, rel=1e-12)
    # envelope: the trace of the tool's tip arc, rolled without slip, touches it everywhere
    angle, step = radians(50.0), 1e-6
    point, after = (np.array(form.fillet_point(a)) for a in (angle, angle + step))
    along = (after - point) / step
    stretch = 1.0 / cos(gear.helix_angle)
    tangent = np.array([-stretch * sin(angle), cos(angle)])  # of the arc, in the rack
    radius, depth, half = form._tool
    roll = stretch * (half + radius * cos(angle)) - (depth + radius * sin(angle)) * cos(angle) / (
        stretch * sin(angle)
    )
    turn = (roll - 0.5 * pi * gear.transverse_module) / gear.reference_radius
    # the rack's tangent in the gear: mirrored as the outline is, depth counting downwards
    x, y = tangent[0], -tangent[1]
    in_gear = np.array([-(x * cos(turn) + y * sin(turn)), y * cos(turn) - x * sin(turn)])
    sine = (along[0] * in_gear[1] - along[1] * in_gear[0]) / np.hypot(*along) / np.hypot(*in_gear)
    assert abs(sine) < 1e-5


@pytest.mark.parametrize(
    ("details", "message"),
    [
        (
            {"tip_edge": TipEdge(chamfer=9e-3)},
            r"flank from d_Ff = .*nothing is left.*; reduce protuberance or tip edge",
        ),
        (
            {"tip_edge": TipEdge(rounding=2.5e-3)},
            r"tip_edge\.rounding = 2\.500 mm.*overlap by .* mm on a tip.*; reduce",
        ),
        ({"protuberance": -1e-6}, r"protuberance = -1e-06 m must not be negative; give 0"),
        (
            {"protuberance": 1e-3},
            r"protuberance = 1\.000 mm, module 4 mm.*; a tenth of the module is usual, reduce it",
        ),
        (
            {"protuberance": 0.1e-3, "protuberance_angle": radians(20.0)},
            r"protuberance_angle = 20\.000 deg must lie between 0 and .* 20\.000 deg; correct",
        ),
        (
            {"protuberance": 0.1e-3, "protuberance_angle": 0.0},
            r"protuberance_angle = 0\.000 deg must lie between",
        ),
    ],
)
def test_teeth_that_cannot_be_drawn_are_named(details, message):
    with pytest.raises(GearGeometryError, match=message):
        ToothForm(gear=GEARS[0], **details)


def test_pointed_tooth_is_named():
    with pytest.raises(
        GearGeometryError, match=r"12 teeth is pointed: thickness -0\.\d+ mm at the tip; reduce the tip"
    ):
        ToothForm(gear=drawn_gear(12, shift=1.0, addendum=1.2))


@pytest.mark.parametrize(
    "fields", [{"rounding": -1e-6}, {"chamfer": -1e-6}, {"rounding": 1e-6, "chamfer": 1e-6}]
)
def test_bad_tip_edges_are_named(fields):
    with pytest.raises(GearGeometryError, match=r"tip_edge\.\w+ = .*(give 0|set one to 0)"):
        TipEdge(**fields)
