"""The curves of a result as columns: what curves/*.csv holds and `RunResult.curves` gives as arrays."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from rigdesign.base.output_folder import file_stem
from rigdesign.results.dynamics import DynamicsResult, GearboxDynamics, RampHistory
from rigdesign.results.lateral import LateralVibration
from rigdesign.results.loads import EventRecord
from rigdesign.results.quantity import value_in_unit
from rigdesign.results.thermal import ExpansionResult, OilPowerCurve, TransientCurve, TransientResult
from rigdesign.results.vibration import Waterfall

Columns = dict[str, list[Any]]
"""Values of one length by ``quantity [unit]``."""
SHARES = {
    "rolling angle of the pinion [deg]": "angle",
    "share [1]": "share",
    "share quasi-static [1]": "static_share",
    "force over mean [1]": "force",
}
LINE_LOADS = {
    "position from mid-face [mm]": "face",
    "line load [N/mm]": "line_load",
    "line load quasi-static [N/mm]": "static_line_load",
}


def curves_of(
    expansion: Sequence[ExpansionResult], dynamics: DynamicsResult | None, transient: TransientResult | None
) -> dict[str, Columns]:
    """Every curve of a run by the stem of its file, in a fixed order."""
    found: dict[str, Columns] = {}
    if expansion:
        found["seal_gaps"] = _seal_gaps(expansion)
    if dynamics is not None:
        found.update(_dynamics(dynamics))
    if transient is not None:
        found.update(transient_curves(transient))
    return found


def transient_curves(result: TransientResult) -> Iterator[tuple[str, Columns]]:
    """Temperatures and clearances, heaters and cooler over the schedule and its events."""
    for curve in result.curves:
        yield file_stem("transient", curve.gearbox, curve.branch), _thermal_history(curve)
    for power in result.oil_power:
        yield file_stem("transient", "oil_power", power.branch), _oil_power(power)


def _columns(header: Iterable[str], rows: Iterable[Iterable[Any]]) -> Columns:
    names = list(header)
    columns: Columns = {name: [] for name in names}
    for row in rows:
        for name, value in zip(names, row, strict=True):
            columns[name].append(value)
    return columns


def _seal_gaps(expansion: Sequence[ExpansionResult]) -> Columns:
    header = ("gearbox", "stage", "seal", "angle [deg]", "cold gap [mm]", "hot gap [mm]")
    return _columns(
        header,
        (
            (item.gearbox, item.stage, seal["seal"], angle, seal["cold_mm"], gap)
            for item in expansion
            for seal in item.seal_gaps
            for angle, gap in zip(seal.get("angle_deg", ()), seal.get("hot_mm", ()), strict=True)
        ),
    )


def _dynamics(dynamics: DynamicsResult) -> Iterator[tuple[str, Columns]]:
    for name, gearbox in dynamics.gearboxes.items():
        yield file_stem("dynamic_factor", name), _dynamic_factor(gearbox)
        for history in gearbox.root_stress:
            yield (
                file_stem("root_stress", name, history.gear),
                {
                    "rolling angle [deg]": history.rolling_angle_deg,
                    "dynamic [N/mm2]": history.dynamic_MPa,
                    "quasi-static [N/mm2]": history.quasi_static_MPa,
                },
            )
        if gearbox.loaded_contact is not None:
            yield file_stem("contact_pattern", name), _contact_pattern(gearbox.loaded_contact["pattern"])
    for turn in dynamics.tooth_histories:
        yield (
            file_stem("tooth_history", turn.gear),
            {
                "rotation [deg]": turn.rotation_deg,
                "leading flank [N/mm2]": turn.leading_MPa,
                "trailing flank [N/mm2]": turn.trailing_MPa,
            },
        )
    if dynamics.ramp is not None:
        yield "ramp", _ramp(dynamics.ramp)
    if dynamics.campbell is not None:
        yield "campbell", _campbell(dynamics.campbell)
    for spectrum in dynamics.spectra:
        if spectrum.order:
            yield (
                file_stem("spectrum", spectrum.mesh, spectrum.stage),
                _of(spectrum, {"order of the pinion [1]": "order", "amplitude [Nm]": "amplitude"}),
            )
    for shared in dynamics.pair_shares:
        yield file_stem("pair_share", shared.mesh, shared.stage), _of(shared, SHARES)
        if shared.face:
            yield file_stem("line_load", shared.mesh, shared.stage), _of(shared, LINE_LOADS)
    for waterfall in dynamics.waterfalls:
        yield file_stem("waterfall", waterfall.mesh, waterfall.stage), _waterfall(waterfall)
    if dynamics.dynamic_root is not None and dynamics.dynamic_root["curves"]:
        yield "dynamic_root_stress", _dynamic_root(dynamics.dynamic_root["curves"])
    if dynamics.section_torques is not None:
        yield "section_torques", _section_torques(dynamics.section_torques["over_speed"])


def _dynamic_factor(gearbox: GearboxDynamics) -> Columns:
    """K_V(n): the curves of all torques below each other, distinguished by their column."""
    header = (
        "speed [rpm]", "max/mean [1]", "half peak-to-peak [1]", "ISO 6336-1 method B [1]", "method", "torque", "motion",
        "other branch [1]",
    )  # fmt: skip
    curves = {gearbox.torque: gearbox.dynamic_factor, **gearbox.dynamic_factor_at}
    return _columns(
        header,
        (
            (
                point.speed_rpm, point.simulated, point.simulated_half_peak_to_peak,
                point.iso_6336_1_method_b, point.method, torque, point.motion, point.other_branch,
            )
            for torque, points in curves.items()
            for point in points
        ),
    )  # fmt: skip


def _contact_pattern(pattern: Mapping[str, Any]) -> Columns:
    """Pressure on the flank of the pinion, a row for every point."""
    face, angles = pattern["face_mm"], pattern["rolling_angle_deg"]
    return {
        "rolling angle [deg]": [angle for row in angles for angle in row],
        "position from mid-face [mm]": [place for _ in angles for place in face],
        "pressure [N/mm2]": [pressure for row in pattern["pressure_MPa"] for pressure in row],
        "at a tip edge": [edge for row in pattern["edge"] for edge in row],
    }


def _ramp(ramp: RampHistory) -> Columns:
    return {
        "time [s]": ramp.time_s,
        "stage": list(ramp.stage),
        "speed [rpm]": ramp.speed_rpm,
        "target torque [Nm]": ramp.target_torque_Nm,
        "drive torque [Nm]": ramp.drive_torque_Nm,
        **{
            f"{name} {bound} [Nm]": values
            for name, envelopes in ramp.torque.items()
            for bound, values in envelopes.items()
        },
    }


def _campbell(campbell: Mapping[str, Any]) -> Columns:
    """A mode that is damped out at a speed has no value there."""
    columns: Columns = {"speed [rpm]": list(campbell["speed_rpm"])}
    for mode in campbell["modes"]:
        columns[f"mode {mode['mode']} frequency [Hz]"] = list(mode["frequency_Hz"])
        columns[f"mode {mode['mode']} damping ratio [1]"] = list(mode["damping_ratio"])
        if any(whirl is not None for whirl in mode["whirl"]):
            columns[f"mode {mode['mode']} whirl [1]"] = list(mode["whirl"])
    return columns


def _of(record: object, names: Mapping[str, str]) -> Columns:
    """Columns of a record whose values are lists: name by header."""
    return {header: list(value_in_unit(record, name)) for header, name in names.items()}


def _waterfall(waterfall: Waterfall) -> Columns:
    """A column for every frequency, a row for every speed."""
    columns = _of(waterfall, {"pinion speed [rpm]": "speed"})
    amplitudes = zip(*value_in_unit(waterfall, "amplitude"), strict=True)
    for frequency, values in zip(waterfall.frequency, amplitudes, strict=True):
        columns[f"amplitude at {frequency:.1f} Hz [Nm]"] = list(values)
    return columns


def _dynamic_root(curves: Sequence[Mapping[str, Any]]) -> Columns:
    """All curves below each other, distinguished by the first columns."""
    header = (
        "gearbox", "gear", "gauge", "stage", "pinion speed [rpm]", "rolling angle [deg]", "dynamic [N/mm2]",
        "quasi-static [N/mm2]", "strain [um/m]", "strain rate [1/s]",
    )  # fmt: skip
    keys = ("rolling_angle_deg", "dynamic_MPa", "quasi_static_MPa", "strain_um_m", "strain_rate_per_s")
    return _columns(
        header,
        (
            (
                curve["gearbox"],
                curve["gear"],
                curve["gauge"],
                curve["stage"],
                curve["pinion_speed_rpm"],
                *values,
            )
            for curve in curves
            for values in zip(*(curve[key] for key in keys), strict=True)
        ),
    )


def _section_torques(over_speed: Mapping[str, Any]) -> Columns:
    columns: Columns = {"speed [rpm]": list(over_speed["speed_rpm"])}
    for place in over_speed["places"]:
        for key, words in (("mean", "mean"), ("half_peak_to_peak", "half peak-to-peak"), ("peak", "peak")):
            columns[f"{place['place']} {words} [Nm]"] = list(place[f"{key}_Nm"])
    return columns


def _oil_power(power: OilPowerCurve) -> Columns:
    return {
        "time [s]": power.time_s,
        "phase": list(power.phase),
        "heater [W]": power.heater_W,
        "cooler [W]": power.cooler_W,
        **{f"heat into {name} [W]": values for name, values in power.streams_W.items()},
    }


def _thermal_history(curve: TransientCurve) -> Columns:
    return {
        "time [s]": curve.time_s,
        "phase": list(curve.phase),
        "speed [rpm]": curve.speed_rpm,
        **{f"{place} [degC]": values for place, values in curve.temperatures_degC.items()},
        **{
            f"{quantity} {place} [mm]": values
            for quantity, places in curve.clearances_mm.items()
            for place, values in places.items()
        },
        **{
            f"{quantity} {place} [{unit}]": values
            for key, places in curve.alignment.items()
            for quantity, unit in (_quantity_and_unit(key),)
            for place, values in places.items()
        },
    }


def _quantity_and_unit(key: str) -> tuple[str, str]:
    """Quantity and unit of a key of the alignment: ``bearing_tilt_mrad``, ``bore_out_of_round``."""
    quantity, _, unit = key.rpartition("_")
    return (quantity, unit) if unit in ("mrad", "um", "mm") else (key, "1")


def event_curves(events: Iterable[EventRecord]) -> dict[str, Columns]:
    """Torques of every event in envelope windows."""
    return {
        file_stem("event", event.name): {
            "time [s]": event.time,
            **{
                f"{curve.place} {curve.quantity} {bound} [Nm]": values
                for curve in event.curves
                for bound, values in (("least", curve.least), ("greatest", curve.greatest))
            },
        }
        for event in events
        if event.time
    }


def lateral_curves(lateral: LateralVibration | None) -> dict[str, Columns]:
    """Orbit of every bearing over speed, by header; nothing for shafts that only twist."""
    if lateral is None:
        return {}
    columns: Columns = {"speed [rpm]": list(value_in_unit(lateral.curve, "speed"))}
    for bearing in lateral.curve.bearings:
        columns[f"orbit {bearing.bearing} [um]"] = list(value_in_unit(bearing, "orbit"))
    return {"whirl": columns}
