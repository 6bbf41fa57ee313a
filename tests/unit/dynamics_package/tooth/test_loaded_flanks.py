"""Contact on front and back flanks under misalignment and twist, and with pitch deviations."""

from dataclasses import replace

import numpy as np
import pytest

from dynamics.gear.flank import PARALLEL, AxisMisalignment, Flank
from dynamics.gear.microgeometry import Microgeometry, Topography
from dynamics.gear.pair import GearPair
from dynamics.tooth.loaded_mesh import transverse_load_factor
from dynamics.tooth.mesh_cycle import MeshCycle
from dynamics.tooth.pair_gap import PairGap
from dynamics.tooth.points import face_sense, modified_gap
from tests.builders.elastic_pairs import equal_helical_pair
from tests.builders.loaded_mesh import equal_gears, fzg_c, sliced_mesh

PLAIN = Microgeometry()
FORCE = 10e3


def cycle_of(
    pair: GearPair,
    flank: Flank,
    axes: AxisMisalignment = PARALLEL,
    micro: tuple[Microgeometry, Microgeometry] = (PLAIN, PLAIN),
) -> MeshCycle:
    gap = modified_gap(PairGap.of_pair(pair, micro, axes), flank)
    return sliced_mesh(pair, coupling=1.5, gap=gap, n_positions=16).cycle(FORCE)


def centre(cycle: MeshCycle, flank: Flank) -> float:
    """Face position z of the centre of the load [m]."""
    return face_sense(flank) * cycle.pattern(0).centre[1]


@pytest.mark.parametrize("pair", [equal_gears(), equal_helical_pair()])
def test_skewed_axes_shift_the_load_to_opposite_ends_of_front_and_back_flanks(pair: GearPair) -> None:
    """Skew parts the front flanks at z > 0 and closes the back flanks there; the load moves against z, and along it."""
    axes = AxisMisalignment(skew=4e-4)
    straight = {flank: centre(cycle_of(pair, flank), flank) for flank in ("front", "back")}
    moved = {
        flank: centre(cycle_of(pair, flank, axes), flank) - straight[flank] for flank in ("front", "back")
    }
    assert moved["front"] < -1e-3
    # helical: the two flanks are those of one gear turned round, the line of action leans the same way in each
    assert moved["back"] == pytest.approx(-moved["front"], rel=1e-6)


def test_inclined_axes_shift_the_load_to_the_same_end_of_both_flanks() -> None:
    pair, axes = equal_gears(), AxisMisalignment(inclination=12e-4)
    front, back = (centre(cycle_of(pair, flank, axes), flank) for flank in ("front", "back"))
    assert front < -1e-3
    assert back == pytest.approx(front, rel=1e-6)


def test_intended_twist_presses_the_same_corners_of_both_flanks() -> None:
    """Relieved at the tip of z > 0 and the root of z < 0: the pinion's tip carries at z < 0, on either flank."""
    pair, micro = equal_gears(), (Microgeometry(profile_twist=15e-6), PLAIN)
    for flank in ("front", "back"):
        pattern = cycle_of(pair, flank, micro=micro).pattern(0)
        z, tip = face_sense(flank) * pattern.face, pattern.roll > np.median(pattern.roll)
        load = np.where(tip, pattern.line_load, 0.0).sum(axis=0)
        assert load[z < 0.0].sum() > 1.5 * load[z > 0.0].sum()


def test_back_flanks_carry_with_their_own_topography() -> None:
    """Front flanks measured ideal, back flanks relieved at z < 0: only the back contact moves."""
    pair, face = equal_gears(), np.array([-10e-3, 10e-3])
    angle = np.array([0.0, 1.0])
    relieved = np.array([[[20e-6, 0.0], [20e-6, 0.0]]])
    micro = Microgeometry(
        topography=Topography(roll_angle=angle, face=face, removed=np.zeros((1, 2, 2))),
        back_topography=Topography(roll_angle=angle, face=face, removed=relieved),
    )
    front, back = (centre(cycle_of(pair, flank, micro=(micro, PLAIN)), flank) for flank in ("front", "back"))
    assert front == pytest.approx(0.0, abs=1e-9)
    assert back > 1e-3


def test_one_pair_ahead_takes_more_up_to_all_of_the_load() -> None:
    mesh = sliced_mesh(fzg_c(), n_face=1, n_positions=32)
    ideal = mesh.cycle(FORCE)
    factors = [transverse_load_factor(mesh, ideal, deviation) for deviation in (0.0, 1e-6, 1e-3)]
    # single contact carries all of it anyway
    assert factors == pytest.approx([1.0, 1.0, 1.0], abs=1e-9)
    double = sliced_mesh(equal_helical_pair(), n_positions=32)
    ideal = double.cycle(FORCE)
    factors = [transverse_load_factor(double, ideal, deviation) for deviation in (0.0, 2e-6, 8e-6, 60e-6)]
    assert factors[0] == 1.0
    assert np.all(np.diff(factors) > 0.02)
    assert factors[-1] * ideal.load_share.max() == pytest.approx(1.0, rel=1e-6)


def test_transverse_factor_is_near_that_of_iso_6336() -> None:
    """K_Halpha of ISO 6336-1, 8.3.2, from the mesh stiffness of the same contact; it takes one rule for all gears."""
    pair = equal_helical_pair()
    mesh = sliced_mesh(pair, n_positions=32)
    ideal = mesh.cycle(FORCE)
    stiffness = 1e-9 * float(ideal.tangent_stiffness.mean()) / pair.face_width
    total = pair.total_contact_ratio
    load = 1e-3 * FORCE / pair.face_width
    for deviation in (4.0, 8.0):
        x = stiffness * deviation / load
        standard = (
            0.9 + 0.4 * (2.0 * (total - 1.0) / total) ** 0.5 * x
            if total > 2.0
            else 0.5 * total * (0.9 + 0.4 * x)
        )
        found = transverse_load_factor(mesh, ideal, 1e-6 * deviation)
        assert found == pytest.approx(max(standard, 1.0), rel=0.2)


def test_grid_of_a_pair_that_runs_on_its_back_is_turned_round() -> None:
    pair = equal_helical_pair()
    gap = PairGap.of_pair(pair, (replace(PLAIN, helix_slope=10e-6), PLAIN))
    one, z = np.zeros(1, dtype=np.int64), np.array([5e-3])
    path, rolls = np.zeros(1), tuple(np.array([roll]) for roll in pair.rolling_radii)
    front = modified_gap(gap)(one, z, path, rolls)  # type: ignore[arg-type]
    back = modified_gap(gap, "back")(one, -z, path, rolls)  # type: ignore[arg-type]
    assert back == pytest.approx(front)
