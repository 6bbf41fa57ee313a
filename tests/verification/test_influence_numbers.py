"""Influence numbers and the loaded contact with them against CalculiX, ISO 6336-3 and finer meshes of their own.

CalculiX has triangles of its own, another solver and another contact (tests/reference/tooth_contact); its numbers are
stored. It reads deflections on the tooth axis as well, where they are reciprocal within some per cent only: both sides
are averaged as `InfluenceNumbers.deflection` is.
"""

import json
from dataclasses import replace
from functools import lru_cache
from itertools import pairwise
from math import radians

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from dynamics.gear.pair import GearPair
from dynamics.gear.tooth_form import ToothForm
from dynamics.rating.root_stress import root_influence
from dynamics.tooth import influence_model as build
from dynamics.tooth import influence_model as local_part
from dynamics.tooth.compliance import InterpolatedCompliance
from dynamics.tooth.elastic_segment import Elastic, GearModel
from dynamics.tooth.influence_numbers import STANDARD, GearBody, SectionDivision
from dynamics.tooth.loaded_mesh import LoadedMesh
from dynamics.tooth.pair_gap import PairGap
from dynamics.tooth.points import FaceGrid, flank_gap
from tests.builders.loaded_mesh import fzg_c
from tests.builders.p2_gears import ALLOWANCES, spur_pair
from tests.reference.tooth_contact import tables
from tests.reference.tooth_contact.contact_cases import STEEL, contact_case
from tests.reference.tooth_contact.run_unit_loads import STORED

MATERIAL = Elastic(young=1e6 * STEEL[0], poisson=STEEL[1])
UNIT = json.loads(STORED.read_text())
GEARS = [("uhcf", 0), ("uhcf", 1), ("fzg_c", 0), ("fzg_c", 1)]
PARTS = ("pinion", "wheel")


def slice_of(pair, index, width=1.0, bore=None, **fields):
    """Model of a slice in plane strain."""
    bore = pair.bore_diameters[index] if bore is None else bore
    return GearModel(
        form=ToothForm(gear=pair.gears[index]),
        body=GearBody(bore_radius=0.5 * bore),
        material=MATERIAL,
        face_width=width,
        plane_strain=True,
        **fields,
    )


@lru_cache
def case_numbers(name, index):
    """Numbers of a gear of the reference on the whole face width."""
    case = contact_case(name)
    return build.influence_numbers(slice_of(case.pair, index, case.width)).even()


def between(numbers, rolls):
    """Shares (n, n_profile) of the profile positions in roll lengths (n,)."""
    return CubicSpline(numbers.profile, np.eye(len(numbers.profile)))(
        np.clip(rolls, numbers.profile[0], numbers.profile[-1])
    )


def averaged(block):
    """Deflections (n, f, 3, n, f) of CalculiX as tooth offset -> (point, load), averaged as ours.

    Its teeth are counted anticlockwise.
    """
    raw = {k: block[:, :, 1 - k].reshape(block.shape[0] * block.shape[1], -1).T for k in (-1, 0, 1)}
    return {k: 0.5 * (raw[k] + raw[-k].T) for k in raw}


# -- numbers in plane strain -------------------------------------------------------------------------------------


@pytest.mark.parametrize(("name", "index"), GEARS)
def test_deflection_of_a_slice(name, index):
    """Own tooth within 0.3 % of its largest, neighbours within 0.6 % of theirs."""
    stored = UNIT["plane"][f"{name}_{PARTS[index]}"]["0.25"]
    numbers, width = case_numbers(name, index), contact_case(name).width
    shapes = between(numbers, np.array(stored["roll"]))
    for k, expected in averaged(np.array(stored["deflection"])).items():
        found = width * shapes @ numbers.deflection[k] @ shapes.T
        allowed = 3e-3 if k == 0 else 6e-3
        assert np.abs(found - expected).max() < allowed * np.abs(expected).max()
        assert np.diag(found) == pytest.approx(np.diag(expected), rel=5e-3 if k == 0 else 6e-3)


@pytest.mark.parametrize(("name", "index"), GEARS)
def test_root_stress_of_a_slice(name, index):
    stored = UNIT["plane"][f"{name}_{PARTS[index]}"]["0.25"]
    numbers, width = case_numbers(name, index), contact_case(name).width
    stress = width * numbers.stress[0, 1] @ between(numbers, np.array(stored["roll"])).T
    assert stress.max(axis=0) == pytest.approx(np.ravel(stored["root_stress"]), rel=1e-2)
    radius = np.hypot(*numbers.fillet.point.T)[stress.argmax(axis=0)]
    assert radius == pytest.approx(
        np.array(stored["root_radius"]), abs=0.05 * contact_case(name).pair.normal_module
    )


# -- their own meshes --------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_numbers_converge(monkeypatch):
    """Elements at a half and a third: the standard division is off by 0.2 % (deflection) and 0.5 % (root stress).

    Observed order above 2 of both. The local addition has a mesh of its own.
    """
    monkeypatch.setattr(build, "local_excess", lambda model, rolls: np.zeros_like(rolls))
    found = []
    for division in (STANDARD, STANDARD.finer(2), STANDARD.finer(3)):
        numbers = build.influence_numbers(slice_of(fzg_c(), 0, bore=30e-3, division=division)).even()
        rolls = numbers.profile[0] + np.linspace(0.15, 0.95, 5) * np.ptp(numbers.profile)
        shapes = between(numbers, rolls)
        moved = np.stack([shapes @ numbers.deflection[k] @ shapes.T for k in (-1, 0, 1)])
        found.append((moved, (numbers.stress[0, 1] @ shapes.T).max(axis=0)))
    changes = [
        (np.abs(a - c).max() / np.abs(c).max(), np.abs(b / d - 1.0).max())
        for (a, b), (c, d) in pairwise(found)
    ]
    assert changes[0][0] < 2e-3 and changes[0][1] < 5e-3
    second_order = (1 / 4 - 1 / 9) / (1 - 1 / 4)
    assert changes[1][0] < second_order * changes[0][0]
    assert changes[1][1] < second_order * changes[0][1]


@pytest.mark.slow
def test_local_addition_does_not_depend_on_its_mesh(monkeypatch):
    """Elements half as long again, so that load and reading stand further apart as well.

    Within 0.03 of a bracket of about 17, next to the fillet, where there is flank on one side of the load only, 0.12.
    """
    model = slice_of(fzg_c(), 0, bore=30e-3)
    low, high = (ToothForm(gear=fzg_c().gears[0]).gear.roll_length(r) for r in (
        model.form.form_radius, model.form.flank_tip_radius
    ))  # fmt: skip
    rolls = low + np.linspace(0.1, 0.9, 9) * (high - low)
    usual = local_part.local_excess(model, rolls)
    monkeypatch.setattr(local_part, "FINE", replace(local_part.FINE, profile=28, thickness=8))
    coarser = local_part.local_excess(model, rolls)
    assert coarser[2:] == pytest.approx(usual[2:], abs=0.03)
    assert coarser[:2] == pytest.approx(usual[:2], abs=0.12)
    assert np.all((usual > 0.2) & (usual < 2.0))


# -- finite face width -------------------------------------------------------------------------------------------


def test_finite_face_width_with_free_ends(monkeypatch):
    """FZG pinion of 14 mm, loads in hats of 7 mm: deflection within 1.5 % of the largest and of each tooth's own.

    Root stress within 3 % with seven positions over the face, which take a tenth of the time of eleven (1.4 %).
    """
    monkeypatch.setattr(build, "local_excess", lambda model, rolls: np.zeros_like(rolls))
    stored, pair = UNIT["face_width"]["fzg_c_pinion_1.6_8"], contact_case("fzg_c").pair
    division = SectionDivision(profile=4, thickness=4, fillet=8)
    width = pair.face_widths[0]
    model = replace(slice_of(pair, 0, width), plane_strain=False, n_face=7, division=division)
    numbers = build.influence_numbers(model)
    wide = np.array(stored["face"])
    # a load on a wide hat is one on the narrow hats, each by its height and width
    part = (
        np.array([np.interp(numbers.face, wide, hat) for hat in np.eye(3)]) * FaceGrid.at(numbers.face).width
    )
    part /= part.sum(axis=1, keepdims=True)
    shapes = np.kron(between(numbers, np.array(stored["roll"])), part)
    for k, expected in averaged(np.array(stored["deflection"])).items():
        found = shapes @ numbers.deflection[k] @ shapes.T
        assert np.diag(found) == pytest.approx(np.diag(expected), rel=1.5e-2)
        assert np.abs(found - expected).max() < 1.5e-2 * np.abs(expected).max()
    stress = (numbers.stress[0, 1] @ shapes.T).reshape(-1, 7, 3)[:, [0, 3, 6]].max(axis=0)
    assert stress == pytest.approx(np.array(stored["root_stress"])[0].T, rel=3e-2)


# -- a uniform line load against ISO 6336-3 ------------------------------------------------------------------------

P1_REFERENCE = GearPair.from_centre_distance(
    normal_module=4e-3,
    teeth=(28, 28),
    centre_distance=112.5e-3,
    pressure_angle=radians(18.0),
    face_widths=(25e-3, 25e-3),
    profile_shift_1="equal",
)


@pytest.mark.parametrize(
    ("pair", "bore"),
    [
        (fzg_c(), 30e-3),
        (P1_REFERENCE, 50e-3),
        (spur_pair(thickness_allowances=ALLOWANCES["thickness_allowances"]), 52e-3),
    ],
    ids=["FZG-C", "28/28", "prototype"],
)
@pytest.mark.parametrize("index", [0, 1])
def test_even_line_load_against_iso_6336_3(pair, bore, index, monkeypatch):
    """Within 10 % of Y_F Y_S at the outer point of single contact, where ISO rates, and from there to the tip.

    ISO is 5 to 8 % higher on slender teeth: it leaves out the compression by the radial part of the force. Low on the
    flank it is too low, by up to half on full teeth, and by more on the wheel of the prototype, whose path ends next to
    its fillet: with next to no lever the load itself pulls at the fillet, at a tangent of 45 deg instead of 30.
    """
    monkeypatch.setattr(build, "local_excess", lambda model, rolls: np.zeros_like(rolls))
    numbers = build.influence_numbers(slice_of(pair, index, bore=bore)).even()
    iso, limits = root_influence(pair, index), pair.path
    roll = pair.rolling_radii[0] + iso.path if index == 0 else pair.rolling_radii[1] - iso.path
    away = numbers.fillet.tangent < radians(
        65.0
    )  # the end of the fillet lies next to loads on the flank's foot
    stress = numbers.stress[0, 1][away] @ between(numbers, roll).T
    ratio = stress.max(axis=0) / iso.value
    outer = limits.start + pair.base_pitch if index == 0 else limits.end - pair.base_pitch
    from_outer = iso.path >= outer if index == 0 else iso.path <= outer
    assert np.all((ratio[from_outer] > 0.9) & (ratio[from_outer] < 1.1))
    lowest, highest = (ratio[0], ratio[-1]) if index == 0 else (ratio[-1], ratio[0])
    assert lowest > highest  # ISO's lever falls too fast towards the root
    tangent = np.degrees(numbers.fillet.tangent[away][stress.argmax(axis=0)])
    assert np.all((tangent > 25.0) & (tangent < 55.0))


# -- the loaded contact with them ----------------------------------------------------------------------------------


@lru_cache
def loaded(name):
    """Loaded contact of a case over a base pitch."""
    case = contact_case(name)
    pair = replace(case.pair, face_widths=(case.width, case.width))
    base = "fzg_c" if name == "fzg_c" else "uhcf"
    gears = tuple(InterpolatedCompliance.of(case_numbers(base, index)) for index in (0, 1))
    mesh = LoadedMesh(
        pair=pair,
        gears=gears,
        grid=FaceGrid.over(case.width, 1),
        gap=flank_gap(PairGap.of_pair(pair, case.micro)),
        n_positions=96,
    )
    return mesh.cycle(case.force)


def root_stress(name, index):
    """Largest tension along the fillet of a tooth (n_positions, n_pairs) [Pa], neighbours' loads with it."""
    cycle = loaded(name)
    numbers = case_numbers("fzg_c" if name == "fzg_c" else "uhcf", index)
    force, roll = cycle.force[:, :, 0], cycle.points.place.roll[index][:, :, 0]
    shapes = between(numbers, roll.ravel()).reshape(*roll.shape, -1)
    found = np.zeros((len(numbers.fillet.arc), *force.shape))
    n = force.shape[1]
    for k in (-1, 0, 1):
        for pressed in range(n):
            # pinion teeth that come later stand behind the loaded flank, those of the wheel before it
            seen = pressed - k if index == 0 else pressed + k
            if 0 <= seen < n:
                found[:, :, seen] += (shapes[:, pressed] @ numbers.stress[k, 1].T * force[:, pressed, None]).T
    return found.max(axis=0)


def along_path(name, table, wanted):
    """Values (n_positions, n_pairs) of one tooth pair at path positions [m]."""
    points = loaded(name).points
    path = (points.position[:, None] - points.pair.base_pitch * points.pairs).ravel()
    order = np.argsort(path)
    return np.interp(wanted, path[order], table.ravel()[order])


CASES = pytest.mark.parametrize("name", ["uhcf", "uhcf_crowned", "fzg_c"])


@CASES
def test_load_sharing_in_contact(name):
    """Share within 0.03 at every step of the base pitch, corner contact ahead of A and behind E included."""
    path, table = tables.over_path(name)
    cycle = loaded(name)
    share = along_path(name, cycle.load_share, path)
    assert np.abs(share - table[:, 0]).max() < 0.03
    assert cycle.load_share.max() == pytest.approx(table[:, 0].max(), abs=0.02)
    assert cycle.contact_ratio == pytest.approx(
        tables.contact_ratio(path, table[:, 0], cycle.points.pair.base_pitch), abs=0.03
    )


@pytest.mark.parametrize(("name", "allowed"), [("uhcf", 0.07), ("uhcf_crowned", 0.04), ("fzg_c", 0.05)])
@pytest.mark.parametrize("index", [0, 1])
def test_root_stress_in_contact(name, allowed, index):
    """At the twelve steps a base pitch of CalculiX: largest within 5 %, all others as near, of the largest.

    Flanks without modifications 7 %: they carry on their corners, where shares differ most.
    """
    path, table = tables.over_path(name)
    carries = table[:, 0] > 0.02
    expected = table[:, 1 + index]
    curve = along_path(name, root_stress(name, index), path)
    assert curve[carries].max() == pytest.approx(expected.max(), rel=5e-2)
    assert np.abs(curve - expected)[carries].max() < allowed * expected.max()


@pytest.mark.parametrize(("name", "allowed"), [("uhcf", 0.04), ("uhcf_crowned", 0.01), ("fzg_c", 0.025)])
def test_approach_in_contact(name, allowed):
    """Within 1 % but where a corner of unmodified flanks carries: it is the worst there, 3.7 %.

    FZG: 2.2 % at the one step at which a pair is just entering.
    """
    cycle = loaded(name)
    position, pitch = cycle.points.position, cycle.points.pair.base_pitch
    differences = []
    for record in tables.records(name, sweep=True) + tables.records(name, mesh="fine"):
        under_load = record["path"] + record["approach"]
        place = (under_load - position[0]) % pitch + position[0]
        found = np.interp(
            place, np.append(position, position[0] + pitch), np.append(cycle.approach, cycle.approach[0])
        )
        differences.append(abs(found / record["approach"] - 1.0))
    assert max(differences) < allowed
    assert np.median(differences) < 0.012
