"""A diagnosis of the loop with equal gears whose model is a handful of formulas: quick, and its answer known.

The library holds the answers of these formulas where the real one holds runs of the model; case, catalogue, measurement
set and workflow are the real ones.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from math import log
from pathlib import Path
from tempfile import mkdtemp

import numpy as np

from rigdesign.case import load_case
from rigdesign.diagnosis.catalogue import effects_of
from rigdesign.diagnosis.decision.cross_validation import Problem
from rigdesign.diagnosis.decision.defaults import DRIFT, Calibration, Thresholds
from rigdesign.diagnosis.decision.workflow import diagnose
from rigdesign.diagnosis.library.library import Library, Response
from rigdesign.diagnosis.residual.residual_problem import compare
from rigdesign.diagnosis.run import Result, mesh_orders, stated_settings, teeth_a_turn
from rigdesign.diagnosis.statistics.amplitudes import Amplitudes
from rigdesign.measurement import features, load_measurement
from rigdesign.prediction.model import Feature, OperatingCondition, features_of
from tests.builders.paths import CASES

CASE = CASES / "loop_1to1"
RPM = np.pi / 30.0
SPEEDS = (800.0, 1800.0, 3500.0)
TORQUES = (80.0, 200.0, 350.0)
MODES = 2.0 * np.pi * np.array([480.0, 900.0])
"""Natural frequencies [rad/s]."""
ORDERS = (0.0, 1.0, 2.0, 27.0, 28.0, 29.0)
HEAD = """
schema_version = 1
title = "{title}"
{baseline}
[data]
orders = "orders.csv"
[settings.n]
quantity = "speed"
unit = "rpm"
uncertainty = "0.5 rpm"
[settings.M]
quantity = "torque"
unit = "N m"
uncertainty = "0.1 N m"
[settings.T_in]
quantity = "inlet_temperature"
place = "test.gear_oil"
unit = "degC"
uncertainty = "0.05 K"
[channels.M_wheel]
quantity = "torque"
place = "wheel_side"
unit = "N m"
uncertainty = "0.05 N m"
offset_uncertainty = "0.2 N m"
orders = [0, 1, 2, 27, 28, 29]
[channels.P]
quantity = "motor_power"
unit = "W"
uncertainty = "4 W"
scale_uncertainty = 0.003
[channels.T_gear]
quantity = "oil_outlet_temperature"
place = "test.gear_oil"
unit = "degC"
uncertainty = "0.05 K"
offset_uncertainty = "0.1 K"
[channels.T_bearing]
quantity = "oil_outlet_temperature"
place = "test.bearing_oil"
unit = "degC"
uncertainty = "0.05 K"
offset_uncertainty = "0.1 K"
"""
NOISE = {"M_wheel": 0.05, "P": 4.0, "T_gear": 0.05, "T_bearing": 0.05}


@dataclass(frozen=True)
class Rig:
    """What is hidden in the readings: effect -> coordinates; ``spoil`` changes the table of readings by feature."""

    hidden: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    points: int = 9
    repeats: int = 2
    seed: int = 1


@cache
def the_case():
    return load_case(CASE)


def settings(count: int) -> tuple[OperatingCondition, ...]:
    pairs = [(speed, torque) for speed in SPEEDS for torque in TORQUES][:count]
    return tuple(
        OperatingCondition(
            name=f"P{number:02d}",
            speed=speed * RPM,
            torque=torque,
            inlet_temperature={"test.gear_oil": 333.15 + 10.0 * (number % 3)},
        )
        for number, (speed, torque) in enumerate(pairs, start=1)
    )


def mesh_loss(run: OperatingCondition) -> float:
    """No law that an unmodelled source has [W]."""
    return 0.12 * run.speed**0.6 * run.torque**1.15


def base(feature: Feature, run: OperatingCondition) -> float:
    """The rig as its model has it [SI]."""
    mesh, bearing = mesh_loss(run), 0.006 * run.speed**2
    inlet = run.inlet_temperature["test.gear_oil"]
    match feature.channel:
        case "P":
            return 60.0 + mesh + bearing
        case "T_gear":
            return inlet + mesh / 60.0
        case "T_bearing":
            return 333.15 + bearing / 45.0
    if feature.order == 0.0:
        return run.torque
    size = {1.0: 0.3, 2.0: 0.1}.get(
        feature.order, 0.02 * run.torque * (1.0 if feature.order == 28.0 else 0.1)
    )
    return size * (0.8 if feature.part == "real" else 0.6)


def answer(effect: str, at: Sequence[float], feature: Feature, run: OperatingCondition) -> float:
    """Change that an effect makes [SI]."""
    mesh, bearing = mesh_loss(run), 0.006 * run.speed**2
    if effect.startswith("run_out") and feature.order in (1.0, 27.0, 29.0):
        share = {"run_out:test.pinion": 1.0, "run_out:test.wheel": 1.0}.get(effect, 0.8)
        gain = 2e5 * share * {1.0: 1.0, 27.0: 0.1 * run.torque / 200.0, 29.0: -0.1}[feature.order]
        turn = run.speed / 1000.0 if "reference" in effect else 0.0
        value = complex(at[0], -at[1]) * np.exp(1j * turn)
        return gain * (value.real if feature.part == "real" else value.imag)
    if effect.startswith("single_pitch") and feature.order:
        gain = 2e4 * at[0] * (1.0 + run.torque / 400.0 * feature.order / 28.0)
        value = gain * np.exp(-2j * np.pi * feature.order * int(effect.partition("/")[2] or 0) / 28.0)
        return float(value.real if feature.part == "real" else value.imag)
    if effect == "angle_zero" and feature.order:
        still = complex(*(base(replace(feature, part=part), run) for part in ("real", "imaginary")))
        moved = still * np.exp(1j * feature.order * at[0]) - still
        return float(moved.real if feature.part == "real" else moved.imag)
    grown = np.expm1(at[0])
    if effect == "mesh_loss:test":
        return grown * {"P": mesh, "T_gear": mesh / 60.0}.get(feature.channel, 0.0)
    if effect == "bearing_loss:test":
        return grown * {"P": bearing, "T_bearing": bearing / 45.0}.get(feature.channel, 0.0)
    if effect == "oil_heat_capacity:test":
        rise = {"T_gear": mesh / 60.0, "T_bearing": bearing / 45.0}.get(feature.channel, 0.0)
        return np.expm1(-at[0]) * rise
    if effect == "coupling_stiffness:wheel_side" and feature.order:
        return grown * base(feature, run) * (run.speed / 400.0) ** 2
    return 0.0


MODELLED = (
    "run_out:test.pinion", "run_out:test.wheel", "run_out:reference.pinion", "single_pitch:test.pinion",
    "mesh_loss:test", "bearing_loss:test", "oil_heat_capacity:test", "coupling_stiffness:wheel_side",
)  # fmt: skip


def library(runs: Sequence[OperatingCondition], channels, *, without: Sequence[str] = ()) -> Library:
    names = features_of(runs, channels)
    by_name = {run.name: run for run in runs}

    def column(value) -> np.ndarray:
        return np.array([value(feature, by_name[feature.setting]) for feature in names])

    effects = {effect.name: effect for effect in effects_of(the_case())}
    responses = {}
    for name in MODELLED:
        if name in without:
            continue
        effect = effects[name]
        if len(effect.parameters) == 2:
            step = 1e-5
            places = [np.zeros(2), np.array([step, 0.0]), np.array([0.0, step])]
        elif effect.linear:
            places = [np.zeros(1), np.array([1e-5])]
        else:
            low, high = effect.parameters[0].bounds
            places = [
                np.zeros(1),
                *(np.array([s * (high if s > 0 else -low)]) for s in (-1, -0.4, -0.1, 0.1, 0.4, 1)),
            ]
        rows = [column(lambda f, run, at=tuple(at), name=name: answer(name, at, f, run)) for at in places]
        responses[name] = Response(coordinates=np.array(places), answers=np.array(rows))
    heat = {
        "body:gear": column(lambda f, run: {"P": 1.0, "T_gear": 1 / 60.0}.get(f.channel, 0.0)),
        "film:bearing": column(lambda f, run: {"P": 1.0, "T_bearing": 1 / 45.0}.get(f.channel, 0.0)),
    }
    dry = {name: np.where([f.channel == "P" for f in names], 0.0, values) for name, values in heat.items()}
    inputs = {
        ("inlet_temperature", "test.gear_oil", run.name): column(
            lambda f, at, run=run: float(f.channel == "T_gear" and at is run)
        )
        for run in runs
    }
    return Library(
        channels=tuple(channels), settings=tuple(runs), features=names, base=column(base), inputs=inputs,
        responses=responses, links={}, sources=heat, dry_sources=dry,
        powers={run.name: 60.0 + mesh_loss(run) + 0.006 * run.speed**2 for run in runs}, modes=MODES, error=0.0,
    )  # fmt: skip


def write_set(folder: Path, rig: Rig, *, title: str = "trial", baseline: str = "", spoil=None) -> Path:
    """Readings of the formulas with what is hidden, and noise; ``spoil(channel, point, value)`` after that."""
    folder.mkdir(parents=True, exist_ok=True)
    above = f'baseline = "{baseline}"' if baseline else ""
    (folder / "measurement.toml").write_text(HEAD.format(title=title, baseline=above), encoding="utf-8")
    rng = np.random.default_rng(rig.seed)
    rows = ["point,repeat,n,M,T_in,M_wheel,P,T_gear,T_bearing", ",,rpm,N m,degC,N m,W,degC,degC"]
    orders = ["point,repeat,channel,order,real,imaginary"]
    shift = {"P": 0.0, "T_gear": 273.15, "T_bearing": 273.15, "M_wheel": 0.0}

    def read(channel: str, run: OperatingCondition, order: float = 0.0, part: str = "value") -> float:
        feature = Feature(channel, run.name, order, part)
        value = base(feature, run) + sum(answer(name, at, feature, run) for name, at in rig.hidden.items())
        return value - shift[channel] + NOISE[channel] * rng.normal()

    for run in settings(rig.points):
        for repeat in range(1, rig.repeats + 1):
            values = {name: read(name, run) for name in ("M_wheel", "P", "T_gear", "T_bearing")}
            if spoil is not None:
                values = spoil(run.name, values)
            head = f"{run.speed / RPM:.4f},{run.torque:.4f},{run.inlet_temperature['test.gear_oil'] - 273.15:.4f}"
            rows.append(
                f"{run.name},{repeat},{head}," + ",".join(f"{value:.6f}" for value in values.values())
            )
            for order in ORDERS[1:]:
                parts = [read("M_wheel", run, order, part) for part in ("real", "imaginary")]
                orders.append(f"{run.name},{repeat},M_wheel,{order:g},{parts[0]:.6f},{parts[1]:.6f}")
    (folder / "data.csv").write_text("\n".join(rows) + "\n", encoding="utf-8")
    (folder / "orders.csv").write_text("\n".join(orders) + "\n", encoding="utf-8")
    return folder


DESIGN = Calibration(
    amplitudes=Amplitudes(), inflation={}, plain=Thresholds(named=0.9), given_baseline=Thresholds(named=0.9),
    drift=replace(DRIFT, sensors=0.0, constants=0.0),
)  # fmt: skip
"""Numbers of the design: what is frozen for real rigs must not change these stories, of a rig the same every day."""


def result_of(folder: Path, *, without: Sequence[str] = (), calibration: Calibration | None = None) -> Result:
    """``diagnose_measurement`` with the formulas as the model."""
    case, calibration = the_case(), calibration or DESIGN
    effects = effects_of(case)
    measurement = load_measurement(folder, case)
    healthy = None if measurement.baseline is None else load_measurement(measurement.baseline, case)

    def compared(one):
        data = features(one)
        made = library(data.settings, [entry.channel for entry in one.channels.values()], without=without)
        return data, compare(data, made, effects, stated_settings(one), mesh_orders(case), teeth_a_turn(case))

    data, residuals = compared(measurement)
    before = None if healthy is None else compared(healthy)[1]
    problem = Problem(
        residuals=residuals, baseline=before, seed=measurement.hash,
        repeated=data.strength == "proven",
    )  # fmt: skip
    return Result(
        case=case, measurement=measurement, data=data, baseline=healthy, problem=problem, effects=effects,
        diagnosis=diagnose(problem, calibration, rerun(data.settings)), calibration=calibration,
    )  # fmt: skip


def rerun(runs: Sequence[OperatingCondition]):
    """The formulas with effects in them, as `rigdesign.diagnosis.decision.cross_validation.FullRun` runs the model."""
    by_name = {run.name: run for run in runs}

    def again(some: Sequence[Feature], sizes: Mapping[str, tuple[float, ...]]) -> np.ndarray:
        return np.array(
            [sum(answer(name, at, f, by_name[f.setting]) for name, at in sizes.items()) for f in some]
        )

    return again


FRETTING = 120.0
"""Heat of the story of that name [W]."""


@cache
def story(name: str) -> Result:
    """Diagnoses that several tests look at; made once."""
    folder = Path(mkdtemp(prefix="diagnosis-"))
    match name:
        case "mesh loss":  # against a healthy set of the same rig
            write_set(folder / "healthy", Rig(seed=7), title="as new")
            rig = Rig({"mesh_loss:test": (log(1.2),)})
            return result_of(write_set(folder / "set", rig, baseline="../healthy"))
        case "run-out":
            return result_of(write_set(folder, Rig({"run_out:reference.pinion": (25e-6, -10e-6)})))
        case "tooth":
            return result_of(write_set(folder, Rig({"single_pitch:test.pinion/5": (30e-6,)})))
        case "alias":
            return result_of(write_set(folder, Rig({"run_out:test.pinion": (15e-6, -8e-6)})))
        case "exchanged":

            def exchange(point, values):
                return {**values, "T_gear": values["T_bearing"], "T_bearing": values["T_gear"]}

            return result_of(write_set(folder, Rig(), spoil=exchange))
        case "angle":
            return result_of(write_set(folder, Rig({"angle_zero": (0.02,)})))
        case "one point":
            return result_of(write_set(folder, Rig(points=1, repeats=1)))
        case "fretting" | "no fretting":  # heat in the gear that no effect of the catalogue gives, or takes
            heat = FRETTING if name == "fretting" else -FRETTING

            def fret(point, values):
                return {**values, "P": values["P"] + heat, "T_gear": values["T_gear"] + heat / 60.0}

            write_set(folder / "healthy", Rig(seed=7), title="as new")
            return result_of(write_set(folder / "set", Rig(), baseline="../healthy", spoil=fret))
        case "healthy":
            return result_of(write_set(folder, Rig()))
    raise KeyError(name)
