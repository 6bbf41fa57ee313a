"""Synthetic recordings of the root gauges of P1's rig: the curves of the model through bridge, noise and logger."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rigdesign.case import load_case
from rigdesign.case.model import Case
from rigdesign.prediction import Channel, OperatingCondition
from rigdesign.prediction.model import GAUGES_AGAINST
from rigdesign.prediction.predict import Predictor
from rigdesign.prediction.readings import StrainCurve, strain_curve
from rigdesign.rig.model import Rig
from tests.builders.paths import CASES
from tests.builders.strain_logger import Amplifier

CASE = CASES / "strain_gauge_rig"
GAUGES = ("i", "ii", "iv", "v")
"""Of Figure 9 of P1: III was defective."""
RPM = np.pi / 30.0
GEAR = "test.pinion"
TURN = 2.0 * np.pi
HEAD = """schema_version = 1
title = "{title}"
[data]
table = "points.csv"
{recordings}
[settings.speed]
quantity = "speed"
unit = "rpm"
uncertainty = "0.5 rpm"
[settings.torque]
quantity = "torque"
unit = "N m"
uncertainty = "0.3 N m"
scale_uncertainty = 0.005
"""
CHANNEL = """[channels.gauge_{name}]
quantity = "root_strain"
place = "test.pinion.{name}"
unit = "um/m"
uncertainty = "2 um/m"
scale_uncertainty = 0.01
offset_uncertainty = "50 um/m"
"""


def conditions(points: Sequence[tuple[float, float]]) -> tuple[OperatingCondition, ...]:
    """Operating points of (speed [rpm], torque [N m])."""
    return tuple(
        OperatingCondition(name=f"P{number}", speed=speed * RPM, torque=torque)
        for number, (speed, torque) in enumerate(points, 1)
    )


def curves(case: Case, points: Sequence[OperatingCondition]) -> list[dict[str, StrainCurve]]:
    """Indicated strain at every gauge, by point, as the model has it."""
    channels = [Channel(name=name, quantity="root_strain", place=f"{GEAR}.{name}") for name in GAUGES]
    predictor = Predictor(case, points, channels, circuit=GAUGES_AGAINST)
    return [
        {name: strain_curve(one.problem.rig, one.last, f"{GEAR}.{name}") for name in GAUGES}
        for one in predictor._points
    ]


@dataclass(frozen=True, kw_only=True)
class Chain:
    """What lies between the strain in the root and the file.

    scale : gauge -> true over stated gauge factor; zero, noise : of all gauges [V/V]; turns : recorded at each point
    index : rolling angle at which a recording begins [rad]
    """

    scale: Mapping[str, float]
    zero: float = 3e-5
    noise: float = 2e-6
    turns: float = 12.4
    index: float = 1.0
    rate: float = 4000.0


def write_recordings(
    folder: Path,
    rig: Rig,
    points: Sequence[OperatingCondition],
    strains: Sequence[Mapping[str, StrainCurve]],
    chain: Chain,
) -> Path:
    """A measurement set of raw recordings, in mV/V over time."""
    entries, rows = [], ["point,repeat,speed,torque", ",,rpm,N m"]
    for number, (point, by_gauge) in enumerate(zip(points, strains)):
        duration = chain.turns * TURN / point.speed
        amplifier = Amplifier(
            sample_rate=chain.rate * point.speed / (100.0 * RPM),
            converter_noise=chain.noise,
            offset=chain.zero,
        )
        columns, time = [], np.zeros(0)
        for place, name in enumerate(GAUGES):
            bridge = rig.strain_gauges[f"{GEAR}.{name}"].point.bridge
            curve, scale = by_gauge[name], chain.scale[name]

            def output(
                at: np.ndarray, curve=curve, scale=scale, bridge=bridge, speed=point.speed
            ) -> np.ndarray:
                angle = np.mod(chain.index + speed * at + np.pi, TURN) - np.pi
                return bridge.ratio(scale * np.interp(angle, curve.angle, curve.strain, left=0.0, right=0.0))

            record = amplifier.record(output, duration, seed=100 * number + place)
            time = record.time
            columns.append(1e3 * record.ratio)
        table = np.column_stack([time, *columns])
        names = ",".join(["time", *(f"gauge_{name}" for name in GAUGES)])
        units = ",".join(["s", *("mV/V" for _ in GAUGES)])
        np.savetxt(
            folder / f"{point.name}.csv", table, delimiter=",", fmt="%.7g", comments="",
            header=f"{names}\n{units}",
        )  # fmt: skip
        entries.append(f'[[data.recordings]]\npoint = "{point.name}"\nfile = "{point.name}.csv"\n')
        rows.append(f"{point.name},1,{point.speed / RPM:.6g},{point.torque:.6g}")
    text = HEAD.format(title="synthetic recordings of root gauges", recordings="".join(entries))
    text += "".join(CHANNEL.format(name=name) for name in GAUGES)
    (folder / "measurement.toml").write_text(text, encoding="utf-8")
    (folder / "points.csv").write_text("\n".join(rows) + "\n", encoding="utf-8")
    return folder


def without_misalignment() -> Case:
    """P1's rig as it would be modelled before anybody looked at the pattern: f_Hbeta = 0."""
    return load_case(CASE).with_values({"gearboxes.test.gears.pinion.flank.helix_slope": "0 um"})
