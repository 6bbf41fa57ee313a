import math
from dataclasses import replace

import numpy as np
import pytest

from dynamics.rotor.torsional_modes import (
    damping_audit,
    damping_record,
    loop_modes,
    sampling_audit,
)
from tests.builders.rig import SHAFTS, TABLE_2, prototype, prototype_laws
from tests.published.shafts import order_crossings, shaft_frequencies

RPM = math.pi / 30.0


def test_isolated_shafts_have_the_frequencies_of_table_2() -> None:
    """P2, Table 2 within 2 %; the sections were fitted to it, the shipped element length keeps 0.3 %."""
    found = shaft_frequencies(prototype())
    assert list(found) == list(SHAFTS)
    for name, expected in TABLE_2.items():
        assert found[name] == pytest.approx(expected, rel=3e-3)


def test_rigid_rotation_comes_first_then_rising_frequencies() -> None:
    modes = loop_modes(prototype(), prototype_laws(), 10e3)
    assert modes[0].frequency == 0.0
    assert modes[0].name == "rigid rotation"
    frequencies = [mode.frequency for mode in modes[1:]]
    assert frequencies == sorted(frequencies)
    assert frequencies[0] > 100.0
    assert frequencies[-1] <= 10e3


def test_shape_names_what_holds_the_strain_energy() -> None:
    modes = loop_modes(prototype(), prototype_laws(), 10e3)
    for mode in modes[1:]:
        assert sum(mode.energy.values()) == pytest.approx(1.0)
        leader, share = next(iter(mode.energy.items()))
        assert share == max(mode.energy.values())
        assert mode.name.startswith(f"{leader} {share:.0%}".replace("%", " %"))
    strongest = max(modes[1:], key=lambda mode: mode.mesh_gain[0])
    assert strongest.energy["mesh test"] > 0.4


def test_softer_mesh_lowers_the_mesh_mode() -> None:
    laws = prototype_laws()
    softer = (laws[0]._replace(mean_stiffness=0.8 * laws[0].mean_stiffness), laws[1])

    def mesh_mode(pair: tuple) -> float:  # type: ignore[type-arg]
        return max(loop_modes(prototype(), pair, 10e3)[1:], key=lambda m: m.mesh_gain[0]).frequency

    ratio = mesh_mode(softer) / mesh_mode(laws)
    assert math.sqrt(0.8) < ratio < 1.0


def test_damping_of_the_joints_of_p2() -> None:
    """Splines 159 Hz and zeta about 22, couplings 77 and 73 Hz (from P2, Table 1)."""
    records = {record.name: record for record in damping_audit(prototype(), prototype_laws())}
    spline = records["test_pinion_gear"]
    assert spline.corner_frequency == pytest.approx(159.15, rel=1e-4)
    assert spline.damping_ratio == pytest.approx(22.0, rel=0.02)
    assert spline.own_frequency == pytest.approx(7036.0, rel=0.02)
    assert records["wheel side"].corner_frequency == pytest.approx(76.9, abs=0.1)
    assert records["pinion side"].corner_frequency == pytest.approx(73.2, abs=0.1)
    assert {name for name, record in records.items() if record.warning} == {
        *(f"{name}_gear" for name in SHAFTS),
        "wheel side",
        "pinion side",
    }
    assert "damping ratio = 22.3, limit 0.3" in spline.warning


@pytest.mark.parametrize(("stiffness", "mass", "expected"), [(1.14e8, 0.122, 0.134), (7.09e8, 0.70, 0.0225)])
def test_mesh_damping_ratios_of_the_sheet(stiffness: float, mass: float, expected: float) -> None:
    record = damping_record("m", "mesh", stiffness, 1e3, mass)
    assert record.damping_ratio == pytest.approx(expected, rel=5e-3)
    assert record.warning == ""


def test_undamped_joint_has_no_corner() -> None:
    assert damping_record("k", "spline", 1e6, 0.0, 1e-3).corner_frequency == math.inf


def test_crossings_of_p2() -> None:
    """60 f / (99 h) from the frequencies of P2, Table 2, rounded to whole rpm."""
    table = {name: np.array(values) for name, values in TABLE_2.items()}
    found = order_crossings(prototype(), table, 12000.0 * RPM)
    speeds = {(c.mesh, c.shaft, c.mode, c.harmonic): round(c.speed / RPM) for c in found}
    expected = {
        ("test", "test_pinion", 1, 1): 2438,
        ("test", "test_pinion", 1, 2): 1219,
        ("test", "test_wheel", 1, 1): 3592,
        ("test", "test_wheel", 1, 2): 1796,
        ("test", "test_wheel", 2, 1): 5747,
        ("test", "test_wheel", 3, 1): 7776,
        ("test", "test_pinion", 3, 1): 4713,
        ("reference", "reference_pinion", 1, 1): 2962,
        ("reference", "reference_pinion", 2, 1): 4705,
        ("reference", "reference_pinion", 3, 1): 5847,
        ("reference", "reference_pinion", 1, 2): 1481,
        ("reference", "reference_pinion", 2, 2): 2353,
        ("reference", "reference_pinion", 3, 2): 2923,
        ("reference", "reference_pinion", 1, 3): 987,
        ("reference", "reference_pinion", 2, 3): 1568,
        ("reference", "reference_pinion", 3, 3): 1949,
        ("reference", "reference_wheel", 1, 1): 2160,
        ("reference", "reference_wheel", 2, 1): 3086,
        ("reference", "reference_wheel", 3, 1): 4179,
        ("reference", "reference_wheel", 2, 2): 1543,
    }
    assert {key: speeds.get(key) for key in expected} == expected
    assert len(found) == 4 * 3 * 3
    assert [c.speed for c in found if c.mesh == "test"] == sorted(c.speed for c in found if c.mesh == "test")


def test_crossings_stop_at_the_highest_speed() -> None:
    table = {name: np.array(values) for name, values in TABLE_2.items()}
    assert all(c.speed <= 3000.0 * RPM for c in order_crossings(prototype(), table, 3000.0 * RPM))


def test_sampling_of_p2_is_two_samples_per_mesh() -> None:
    wheel_speed = 12000.0 * RPM * 99 / 102
    audit = sampling_audit(prototype(), wheel_speed, 40e3)
    assert [a.samples_per_mesh for a in audit] == pytest.approx([2.0202, 2.0202], rel=1e-4)
    assert audit[0].harmonics == 1
    assert "samples per mesh = 2.02, limit 10" in audit[0].warning
    assert sampling_audit(prototype(), wheel_speed, 640e3)[0].warning == ""


def test_motor_joint_is_audited() -> None:
    rig = prototype()
    rig = replace(rig, motor=replace(rig.motor, stiffness=5e3, damping=2.0))
    record = next(r for r in damping_audit(rig, prototype_laws()) if r.kind == "motor joint")
    assert record.damping_ratio == pytest.approx(2.0 / (2.0 * math.sqrt(5e3 * 0.01)))
