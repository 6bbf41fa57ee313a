"""Vibration channels, diagnosed from files with a healthy set of the same rig: what turns with a shaft is found.

The rig of the sets is the model itself with unbalances and bows that a healthy rig has; the catalogue is cut to what
turns with a shaft, for time.
"""

import math
from collections.abc import Iterable
from itertools import product
from pathlib import Path

import numpy as np
import pytest

import rigdesign.diagnosis.run as diagnosis
from rigdesign.case import Case
from rigdesign.diagnosis.catalogue import effects_of
from rigdesign.diagnosis.catalogue.effects import Effect
from rigdesign.prediction.model import OWN_MODEL, Channel, Feature, OperatingCondition, changed_case
from rigdesign.prediction.predict import predict
from tests.builders.order import shipped

SPEEDS, TORQUES = (1000.0, 2500.0, 3800.0), (100.0, 300.0)
POINTS = {f"P{i:02d}": pair for i, pair in enumerate(product(SPEEDS, TORQUES), start=1)}
PROBES = {
    "tp_y": ("test.pinion_front", "y"),
    "tp_z": ("test.pinion_rear", "z"),
    "tw_y": ("test.wheel_rear", "y"),
    "tw_z": ("test.wheel_front", "z"),
    "rw_z": ("reference.wheel_front", "z"),
}
AXES = {"y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
ORDERS = (1.0, 28.0)
NOISE = 5e-8
"""[m]"""
REPEATS = (1, 2, 3)
CHANNELS = tuple(
    Channel(name=name, quantity="shaft_displacement", place=place, direction=AXES[axis], orders=ORDERS)
    for name, (place, axis) in PROBES.items()
)
SETTINGS = tuple(
    OperatingCondition(name=name, speed=rpm * math.pi / 30.0, torque=torque)
    for name, (rpm, torque) in POINTS.items()
)
HEAD = """\
schema_version = 1
title = "probes"
BASELINE
[data]
orders = "orders.csv"
[settings.n]
quantity = "speed"
unit = "rpm"
uncertainty = "1 rpm"
[settings.M]
quantity = "torque"
unit = "N m"
uncertainty = "0.5 N m"
"""
PROBE = """\
[channels.{name}]
quantity = "shaft_displacement"
place = "{place}"
direction = "{axis}"
unit = "um"
uncertainty = "0.05 um"
orders = [1, 28]
"""


def turning(case: Case, **_: object) -> tuple[Effect, ...]:
    """Entries of what turns with a shaft."""
    return tuple(one for one in effects_of(case, channels=CHANNELS) if one.bends and one.oscillates)


def with_effects(case: Case, sizes: Iterable[tuple[str, tuple[float, float]]]) -> Case:
    for name, size in sizes:
        (effect,) = (one for one in turning(case) if one.name == name)
        case = changed_case(case, effect.changes(case, size))
    return case


def write(folder: Path, case: Case, seed: int, baseline: str = "") -> Path:
    """Three repeats of all points, in noise."""
    folder.mkdir(parents=True)
    found = predict(case, SETTINGS, CHANNELS, circuit=OWN_MODEL)
    values = dict(zip(found.features, found.values.tolist()))
    random = np.random.default_rng(seed)
    orders, rows = ["point,repeat,channel,order,real,imaginary"], ["point,repeat,n,M", ",,rpm,N m"]
    for repeat in REPEATS:
        for point, (rpm, torque) in POINTS.items():
            rows.append(f"{point},{repeat},{rpm:g},{torque:g}")
            for name in PROBES:
                for order in ORDERS:
                    parts = [
                        1e6 * (values[Feature(name, point, order, part)] + NOISE * random.standard_normal())
                        for part in ("real", "imaginary")
                    ]
                    orders.append(f"{point},{repeat},{name},{order:g},{parts[0]:.6g},{parts[1]:.6g}")
    probes = "".join(
        PROBE.format(name=name, place=place, axis=axis) for name, (place, axis) in PROBES.items()
    )
    texts = {
        "measurement.toml": HEAD.replace("BASELINE", baseline) + probes,
        "data.csv": "\n".join(rows) + "\n",
        "orders.csv": "\n".join(orders) + "\n",
    }
    for file, text in texts.items():
        (folder / file).write_text(text, encoding="utf-8")
    return folder


@pytest.mark.slow
def test_unbalance_and_bow_are_found_against_a_healthy_set(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("RIGDESIGN_CACHE_DIR", str(tmp_path / "cache"))
    monkeypatch.setattr(diagnosis, "effects_of", turning)
    case, random = shipped("loop_1to1"), np.random.default_rng(3)
    healthy = with_effects(
        case, [(one.name, tuple(one.healthy * random.standard_normal(2))) for one in turning(case)]
    )
    write(tmp_path / "set_0", healthy, 1)
    for number, (name, size) in enumerate(
        [("unbalance:test_wheel", (1e-3, 5e-4)), ("shaft_bow:test_pinion", (2e-5, 1e-5))], start=1
    ):
        changed = with_effects(healthy, [(name, size)])
        folder = write(tmp_path / f"set_{number}", changed, 1 + number, 'baseline = "../set_0"')
        found = diagnosis.diagnose_measurement(case, folder).diagnosis
        # bow and flanges of one line are a group for few probes
        assert name in found.decision.named
        assert found.decision.verdict in ("named", "suspected", "alias_group")
        if found.decision.verdict != "named":
            continue
        assert found.fit is not None
        for one, true in zip(found.fit.sizes, size):
            assert one.coordinate == pytest.approx(true, rel=0.25)
            assert one.interval[0] < true < one.interval[1]
    again = write(tmp_path / "set_3", healthy, 9, 'baseline = "../set_0"')
    assert diagnosis.diagnose_measurement(case, again).diagnosis.decision.verdict == "within_noise"
