"""Loads on a segment and what is read on it: exact for rigid bodies and for known strains, one newton, reciprocal."""

from dataclasses import replace
from math import atan

import numpy as np
import pytest
from scipy import sparse

from dynamics.tooth.elastic_segment import solve_segment
from dynamics.tooth.influence_model import SegmentReading, rows
from dynamics.tooth.influence_numbers import TEETH
from dynamics.tooth.segment import GearSegment, gear_section, turned
from tests.builders.influence import STEEL, small_model

NU = STEEL.poisson
UNITS = np.eye(3)


class Read:
    """A segment with its reading."""

    def __init__(self, helix):
        self.model = small_model(helix)
        section = gear_section(self.model.form, self.model.body, self.model.division)
        self.segment = GearSegment.of(section, self.model.face, self.model.lead)
        self.reading = SegmentReading(self.model, self.segment)
        self.points = self.segment.points

    def rows(self, entries):
        return rows(entries, self.points.size)

    def frames(self, tooth):
        """Points on the tooth axis (n, 3) and inward normals (n, 3) of every row at the quadrature points of its hat,
        with weights; the mean that the row stands for is taken over them."""
        model, form = self.model, self.model.form
        slope = atan(model.lead * form.gear.base_radius)
        at, weight = np.polynomial.legendre.leggauss(6)
        for roll in self.reading.rolls:
            foot = form.flank_point(roll) - form.axis_depth(roll) * form.flank_normal(roll)
            for hat in range(len(model.face)):
                z, share = [], []
                for first in (hat - 1, hat):
                    if 0 <= first < len(model.face) - 1:
                        low, high = model.face[first : first + 2]
                        place = 0.5 * (at + 1.0)
                        z.append(low + place * (high - low))
                        share.append(weight * (high - low) * (place if first < hat else 1.0 - place))
                z, share = np.concatenate(z), np.concatenate(share)
                turn = tooth * 2.0 * np.pi / form.gear.teeth + model.lead * z
                points = np.column_stack([turned(np.tile(foot, (len(z), 1)), turn), z])
                flat = turned(np.tile(form.flank_normal(roll), (len(z), 1)), turn)
                normals = -np.column_stack([np.cos(slope) * flat, np.full(len(z), -np.sin(slope))])
                yield points, normals, share / share.sum()


@pytest.fixture(scope="module", params=[0.0, 15.0], ids=["spur", "helical"])
def read(request):
    return Read(request.param)


def motion(axis, turning):
    """Displacement at points (n, 3): shift along an axis or turning about it, of order one."""
    return lambda points: (
        np.cross(UNITS[axis], points) / 50e-3 if turning else np.tile(UNITS[axis], (len(points), 1))
    )


def wanted(read, tooth, field):
    return np.array(
        [
            share @ np.einsum("nd,nd->n", field(points), normals)
            for points, normals, share in read.frames(tooth)
        ]
    )


@pytest.mark.parametrize("tooth", TEETH)
@pytest.mark.parametrize("turning", [False, True])
@pytest.mark.parametrize("axis", range(3))
def test_axis_rows_read_rigid_motions(read, tooth, turning, axis):
    field = motion(axis, turning)
    found = read.rows(read.reading.axis(tooth)) @ field(read.points).ravel()
    # turning: bricks of a helical gear follow the helix within some nanometres
    assert found == pytest.approx(wanted(read, tooth, field), abs=1e-7 if turning else 1e-12)


@pytest.mark.parametrize("tooth", [-3, -1, 0, 2])
@pytest.mark.parametrize(("axis", "turning"), [(0, False), (1, False), (2, False), (2, True)])
def test_carried_rows_read_rigid_motions(read, tooth, axis, turning):
    """Not the tilts of a helical gear, whose axial motion is that of the ground instead of the axis point.

    Far from the teeth the parabola of a wide element leaves the root circle by a millionth of its radius.
    """
    field = motion(axis, turning)
    found = read.rows(read.reading.carried(tooth)) @ field(read.points).ravel()
    assert found == pytest.approx(wanted(read, tooth, field), abs=2e-6 if turning else 1e-12)


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("tooth", TEETH)
def test_no_stress_under_rigid_motions(read, tooth, side):
    stress = read.rows(read.reading.root(tooth, side))
    for axis in range(3):
        for turning in (False, True):
            assert np.abs(stress @ motion(axis, turning)(read.points).ravel()).max() < 1e-11


def tangents(read):
    """Angles of the fillet points of tooth 0 (n_points,) to the tooth axis [rad]."""
    return read.reading.fillet.tangent


def test_strain_along_the_gear_axis_gives_its_transverse_stress():
    """Spur gear: e along z gives nu e in the surface, over E/(1 - nu^2), and none on the free ends."""
    spur = Read(0.0)
    field = 1e-3 * spur.points * UNITS[2]
    stress = (spur.rows(spur.reading.root(0, 1)) @ field.ravel()).reshape(-1, len(spur.model.face))
    assert stress[:, 1:-1] == pytest.approx(NU * 1e-3, rel=1e-9)
    assert np.abs(stress[:, [0, -1]]).max() < 1e-12


@pytest.mark.parametrize("side", [1, -1])
def test_strain_along_the_tooth_axis_gives_its_share_along_the_fillet(side):
    """e along y: strain e cos^2 of the angle between fillet and tooth axis."""
    spur = Read(0.0)
    field = 1e-3 * spur.points * UNITS[1]
    stress = (spur.rows(spur.reading.root(0, side)) @ field.ravel()).reshape(-1, len(spur.model.face))
    along = 1e-3 * np.cos(tangents(spur)) ** 2
    for column in (1, 2):
        assert stress[:, column] == pytest.approx(along, abs=2e-6)
    for column in (0, 3):
        assert stress[:, column] == pytest.approx((1.0 - NU**2) * along, abs=2e-6)


def test_strain_along_the_helix():
    """Helical gear: e along z is strain across the helix line as well; plane stress of both in the surface."""
    helical = Read(15.0)
    field = 1e-3 * helical.points * UNITS[2]
    stress = (helical.rows(helical.reading.root(0, 1)) @ field.ravel()).reshape(-1, len(helical.model.face))
    fillet = helical.reading.fillet
    # direction of the helix line of a point at a radius; tangent of the fillet at right angles to it
    radius = np.hypot(*fillet.point.T)
    slope = helical.model.lead * radius
    # the part of the helix line along the fillet: its motion round the gear against the slant of the fillet
    slant = fillet.tangent + np.arctan2(*fillet.point.T)  # of the fillet against the radius
    round_gear = slope / np.sqrt(1.0 + slope**2)
    along_z = 1.0 / np.sqrt(1.0 + slope**2)
    part = round_gear * np.sin(slant)
    across_z = -part * along_z / np.sqrt(1.0 - part**2)
    expected = 1e-3 * (across_z**2 + NU * along_z**2)
    for column in (1, 2):
        assert stress[:, column] == pytest.approx(expected, rel=2e-3)


def test_loads_sum_to_one_newton_along_the_normal(read):
    loads = read.rows(read.reading.loads()).toarray().reshape(-1, *read.points.shape)
    form, face = read.model.form, read.model.face
    assert len(loads) == len(read.reading.rolls) * len(face)
    for number, row in enumerate(loads):
        force = row.sum(axis=0)
        assert np.linalg.norm(force) == pytest.approx(1.0, abs=1e-3 if read.model.lead else 1e-12), number
        slope = atan(read.model.lead * form.gear.base_radius)
        assert force[2] == pytest.approx(np.sin(slope), abs=1e-12)
        # torque about the gear axis: force times base radius, whatever the hat
        torque = (read.points[:, 0] * row[:, 1] - read.points[:, 1] * row[:, 0]).sum()
        assert torque == pytest.approx(form.gear.base_radius * np.cos(slope), rel=1e-6)


def test_surface_compliance_is_reciprocal(read):
    loads = read.rows(read.reading.loads())
    moved = solve_segment(read.segment, STEEL, loads)
    surface = loads @ moved
    assert np.abs(surface - surface.T).max() < 1e-8 * np.abs(surface).max()
    assert np.linalg.eigvalsh(0.5 * (surface + surface.T)).min() > 0.0
    # what carries a force is what moves: no displacement where the shaft holds
    assert np.abs(moved.reshape(-1, 3, len(surface))[read.segment.bore]).max() == 0.0


@pytest.mark.parametrize("web", [None, 0.6])
def test_halves_of_a_spur_gear_give_what_the_whole_gives(monkeypatch, web):
    model = small_model(0.0, n_face=5)
    body = model.body if web is None else replace(model.body, web_thickness=web * 20e-3, rim_thickness=8e-3)
    section = gear_section(model.form, body, model.division)
    segment = GearSegment.of(section, model.face, 0.0, body)
    loads = np.random.default_rng(3).normal(size=(4, segment.points.size))
    assert segment.mirror is not None
    halves = solve_segment(segment, STEEL, sparse.csr_array(loads))
    monkeypatch.setattr(GearSegment, "mirror", None)
    whole = solve_segment(segment, STEEL, sparse.csr_array(loads))
    assert halves == pytest.approx(whole, abs=1e-9 * np.abs(whole).max())


def test_a_helical_gear_and_an_even_number_of_positions_have_no_halves():
    model = small_model(0.0)
    section = gear_section(model.form, model.body, model.division)
    assert GearSegment.of(section, model.face, 3.0).mirror is None
    assert GearSegment.of(section, np.linspace(-1e-2, 1e-2, 4)).mirror is None
    assert GearSegment.of(section, np.linspace(-1e-2, 2e-2, 5)).mirror is None
