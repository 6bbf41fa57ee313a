"""Front and back flanks of the virtual rig against gears laid out tooth by tooth in the plane.

Teeth are involutes in polar coordinates about the centre of their gear; what the pinion can still turn before a flank
touches is found point by point, without line of action, pressure angle or pairs. The teeth of a gear are one rigid
body: they go with an eccentric centre and with a tooth that stands ahead, whichever flank carries.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from tests.builders.paths import CASES
from tests.virtual_rig import loop_march as kernel
from tests.virtual_rig.case_reader import read_case
from tests.virtual_rig.loop import LoopTruth, Point
from tests.virtual_rig.loop_changes import LoopConstants
from tests.virtual_rig.loop_model import read_circuit
from tests.virtual_rig.teeth import ToothErrors, corner_gap, path_gaps, read_teeth

TEETH = range(-3, 4)


def involute(angle):
    return np.tan(angle) - angle


class PlaneGears:
    """Pinion at the origin, turning against the clock, wheel to its right; lengths as in the case."""

    def __init__(self, mesh, errors):
        self.mesh, self.errors = mesh, errors
        self.distance = sum(mesh.working_radii)
        self.front_half = (
            mesh.back_phase / mesh.base_radii[0] / 2.0
        )  # of a pinion tooth on the working circle
        pitch = 2.0 * math.pi * mesh.working_radii[1] / mesh.z[1]
        play = mesh.backlash / math.cos(mesh.working_angle)
        self.wheel_half = (pitch - play) / mesh.working_radii[1] / 2.0 - self.front_half * (
            mesh.working_radii[0] / mesh.working_radii[1]
        )
        self.radii = np.linspace(1.0005 * mesh.base_radii[1], mesh.tip_radii[1], 2500)

    def centre(self, side, turn, phase):
        """Where the teeth of an eccentric gear have their centre: furthest out in front of it at ``phase``."""
        size = abs(self.errors[side].run_out)
        alpha = self.mesh.working_angle
        if side == 0:  # highest along (sin a, cos a) at the phase
            at = turn - phase + math.pi / 2.0 - alpha
            return size * np.array([math.cos(at), math.sin(at)])
        at = phase - turn - math.pi / 2.0 - alpha  # against (sin a, cos a), turning with the clock
        return np.array([self.distance, 0.0]) + size * np.array([math.cos(at), math.sin(at)])

    def place(self, side, tooth):
        z = self.mesh.z[side]
        return (self.errors[side].places(z)[tooth % z]) / self.mesh.base_radii[side]

    def way_to_go(self, turn, back, shift):
        """Arc on the pinion's base circle until the front (or back) flank of some tooth touches [m]."""
        mesh = self.mesh
        one = turn * mesh.z[0] / mesh.z[1] + 2.0 * math.pi * shift / mesh.z[1]
        centres = [
            self.centre(side, angle, float(np.angle(self.errors[side].run_out)))
            for side, angle in ((0, turn), (1, one))
        ]
        nearest = math.inf
        for p in TEETH:
            own = p + round(turn * mesh.z[0] / (2.0 * math.pi))
            pinion = turn - 2.0 * math.pi * own / mesh.z[0] + self.place(0, own) - self.front_half
            for q in (own, own + 1):
                wheel = turn * mesh.z[0] / mesh.z[1] - 2.0 * math.pi * q / mesh.z[1] + self.wheel_half
                wheel -= self.place(1, q + shift)
                nearest = min(nearest, self._clear(pinion, wheel, centres, back))
        return nearest

    def _clear(self, pinion, wheel, centres, back):
        """Of one tooth of each gear; ``pinion`` against the clock from the right, ``wheel`` with it from the left."""
        mesh, side = self.mesh, (-1.0 if back else 1.0)
        base = mesh.base_radii
        r = self.radii
        half = self.wheel_half + involute(mesh.working_angle) - involute(np.arccos(base[1] / r))
        at = math.pi - (wheel - side * half)
        x = centres[1][0] + r * np.cos(at) - centres[0][0]
        y = centres[1][1] + r * np.sin(at) - centres[0][1]
        far = np.hypot(x, y)
        good = (far > 1.0005 * base[0]) & (far < mesh.tip_radii[0])
        if not good.any():
            return math.inf
        far, angle = far[good], np.arctan2(y[good], x[good])
        half = self.front_half + involute(mesh.working_angle) - involute(np.arccos(base[0] / far))
        if abs(math.remainder(pinion - angle.mean(), 2.0 * math.pi)) > 2.0 * math.pi / mesh.z[0]:
            return math.inf
        clear = [math.remainder(v, 2.0 * math.pi) for v in side * (angle - pinion) - half]
        if min(clear) < -0.5 * self.front_half:  # the other flank of a neighbour
            return math.inf
        return min(clear) * base[0]


def touch(truth, mesh, turns, shift):
    """Approach of the working flanks at which the truth's first pair touches (n,), the gears turned by ``turns``."""
    circuit = read_circuit(truth.tree, truth.meshes, 1.0, 100.0, {})
    point = Point(speed=1.0, torque=100.0, tooth_offset={truth.meshes[mesh].name: shift})
    dt = float(turns[1] - turns[0])
    z = truth.meshes[mesh].z
    still = {"angles": [turns[0]] * 2, "wheel_angles": [turns[0] * z[0] / z[1]] * 2}
    tables = truth._tables(circuit, 1.0, dt, point, still["angles"])
    outer = truth._outer(circuit, point, still, len(turns), dt)[0][mesh]
    numbers = tables[0]
    found = []
    for n in range(len(turns)):
        place = numbers[mesh, kernel.OFFSET] + numbers[mesh, kernel.RATE] * n
        low, high = -2e-4, 2e-4
        for _ in range(40):
            middle = 0.5 * (low + high)
            force = kernel.pair_force(middle, 0.0, place, mesh, *tables)[0]
            low, high = (low, middle) if force > 0.0 else (middle, high)
        found.append(high - outer[n])
    return np.array(found)


@pytest.mark.parametrize("mesh", [0, 1], ids=["front", "back"])
@pytest.mark.parametrize("case", ["loop_1to1", "loop_hunting"])
def test_rigid_gears_touch_where_their_outlines_do(case, mesh):
    """Eccentric gears with two teeth out of place, the wheel put on five teeth further."""
    tree = read_case(CASES / case / "case.toml")
    plain = LoopTruth(tree)
    assert plain.meshes[mesh].name.startswith(("test", "reference")[mesh])
    steps = [0.0] * plain.meshes[mesh].z[0], [0.0] * plain.meshes[mesh].z[1]
    steps[0][3], steps[1][9] = 5e-6, 7e-6
    errors = [
        ToothErrors(run_out=20e-6 * np.exp(0.7j), place=tuple(steps[0])),
        ToothErrors(run_out=13e-6 * np.exp(-2.1j), place=tuple(steps[1])),
    ]
    own = plain.meshes[mesh]
    truth = LoopTruth(tree, LoopConstants(errors=dict(zip(own.gears, errors)), hertz=0.0))
    truth.meshes = [replace(m, flanks=({}, {})) for m in truth.meshes]
    turns = 2.0 * math.pi / own.z[0] * np.arange(0.125, own.z[0], 0.25)  # corners of tips out of reach
    gears = PlaneGears(own, errors)
    expected = np.array([gears.way_to_go(t, mesh == 1, 5) for t in turns])
    found = touch(truth, mesh, turns, 5)
    expected -= own.backlash if mesh == 1 else 0.0
    assert np.ptp(found) > 25e-6
    assert found == pytest.approx(expected, abs=5e-8)


@pytest.mark.parametrize("side", [0, 1], ids=["pinion", "wheel"])
def test_a_profile_slope_stands_out_at_the_tip(side):
    """f_Halpha of ISO 1328-1 counts plus where the tip has metal beyond the design, of the case and of one tooth."""
    tree, slope = read_case(CASES / "loop_1to1" / "case.toml"), 8e-6
    plain = LoopTruth(tree).meshes[0]
    path = plain.grid(0.0)
    flanks = tuple({"profile_slope": slope} if index == side else {} for index in (0, 1))
    bare = replace(plain, flanks=({}, {}))
    closer = path_gaps(bare, margin=0.0)[0] - path_gaps(replace(plain, flanks=flanks), margin=0.0)[0]
    tip, root = (-1, 0) if side == 0 else (0, -1)
    assert [closer[tip], closer[root]] == pytest.approx([0.5 * slope, -0.5 * slope])
    truth = LoopTruth(
        tree, LoopConstants(errors={plain.gears[side]: ToothErrors(slope=(slope,) * plain.z[side])})
    )
    circuit = read_circuit(tree, truth.meshes, 1.0, 100.0, {})
    tables = truth._tables(circuit, 1.0, 1e-4, Point(speed=1.0, torque=100.0), [0.0, 0.0])
    numbers, courses, _, *teeth = tables
    own = [-kernel.pair_at(0, place, 0, numbers, courses, *teeth)[-1] for place in path]
    assert own == pytest.approx(closer, abs=1e-12)


@pytest.mark.parametrize("case", ["loop_1to1", "loop_hunting", "uhcf_prototype"])
@pytest.mark.parametrize("at_end", [False, True], ids=["wheel_tip", "pinion_tip"])
def test_tip_corners_part_as_the_outlines_do(case, at_end):
    """The gap beyond the path of contact, for gears with the pitch point far outside it too."""
    mesh = read_teeth(read_case(CASES / case / "case.toml"), "test", "main")
    mesh = replace(mesh, flanks=({}, {}))
    gears = PlaneGears(mesh, [ToothErrors(), ToothErrors()])
    lowest = max(mesh.tip_radii[1] - 1.2 * (mesh.end - mesh.start), 1.0002 * mesh.base_radii[1])
    gears.radii = np.linspace(lowest, mesh.tip_radii[1], 100001)
    centres = [np.zeros(2), np.array([gears.distance, 0.0])]
    for beyond, near in ((0.01, 0.03), (0.05, 0.1)):  # of the base pitch; leading order
        s = mesh.end + beyond * mesh.base_pitch if at_end else mesh.start - beyond * mesh.base_pitch
        turn = s / mesh.base_radii[0]
        wheel = turn * mesh.z[0] / mesh.z[1] + gears.wheel_half
        expected = gears._clear(turn - gears.front_half, wheel, centres, False)
        found = corner_gap(mesh, 0 if at_end else 1) * (beyond * mesh.base_pitch) ** 2
        assert found == pytest.approx(expected, rel=near)
