"""What differs from rig to rig and what is hidden in it: constants of a loop, drawn and changed by effects."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from tests.virtual_rig.teeth import Teeth, ToothErrors, tolerances


@dataclass(frozen=True, kw_only=True)
class HarmonicTorque:
    """Torque on the motor, on a gear, or between the sides of a coupling; amplitude [N m] with its phase.

    order : per turn of the shaft it acts on; frequency [Hz] instead for what the mains or an inverter make
    torque_power, speed_power : growth with the bracing torque over ``torque_reference`` and speed over 209 rad/s
    """

    place: str
    order: float
    amplitude: complex
    frequency: float | None = None
    torque_power: float = 0.0
    speed_power: float = 0.0
    torque_reference: float = 200.0

    def at(self, speed: float, torque: float) -> complex:
        size = (torque / self.torque_reference) ** self.torque_power * (speed / 209.4) ** self.speed_power
        if self.frequency is not None:
            size *= float(np.sinc(20.0 * (self.free_order(speed) - self.locked_order(speed))))
        return self.amplitude * size

    def free_order(self, speed: float) -> float:
        return 2.0 * math.pi * (self.frequency or 0.0) / speed

    def locked_order(self, speed: float) -> float:
        """Nearest order of an average over twenty turns, into which a fixed frequency leaks."""
        return max(1.0, round(self.free_order(speed)))


@dataclass(frozen=True, kw_only=True)
class LoopConstants:
    """All that one built rig has of its own. ``scale``: factors by name (see `loop_model.read_circuit`), and
    mesh_stiffness:<mesh>, mesh_damping:<mesh>, backlash:<mesh>."""

    scale: Mapping[str, float] = field(default_factory=dict)
    errors: Mapping[str, ToothErrors] = field(default_factory=dict)
    curvature: float = 0.42
    """Loss of pair stiffness at the ends of the path."""
    hertz: float = 0.14
    relief: float = 1.0
    """Factor of crownings and reliefs."""
    lock: float = 1.0
    drift: float = 0.0
    """Relative change of the locked twist per kelvin of oil."""
    torques: tuple[HarmonicTorque, ...] = ()
    stiffening: float = 0.0
    """Out of catalogue: relative change of the mesh stiffness from no torque to 400 N m."""


SPREADS: Mapping[str, float] = {
    "shaft_stiffness": 0.05, "coupling_stiffness": 0.08, "coupling_damping": 0.25, "spline_stiffness": 0.10,
    "spline_damping": 0.25, "inertia": 0.04, "mesh_stiffness": 0.08, "mesh_damping": 0.25, "journal_stiffness": 0.20,
    "journal_damping": 0.30, "shaft_bending": 0.10, "shaft_damping": 0.30, "flange_inertia": 0.04, "backlash": 0.08,
    "curvature": 0.15, "hertz": 0.30, "relief": 0.12, "lock": 0.01,
}  # fmt: skip
"""Relative standard deviations of the constants."""
RUN_OUT_SHARE = 0.25
"""Standard deviation of each part of the eccentricity, share of F_p (F_r = 0.9 F_p at most, twice the eccentricity)."""
WAVE_SHARE = {2: 0.06, 3: 0.04, 4: 0.03}
SINGLE_SHARE = 0.35
SLOPE_SHARE = 0.25


def constant_names(tree: Mapping[str, Any], meshes: Sequence[Teeth]) -> dict[str, float]:
    """Every scalar constant of a loop and its relative spread."""
    power = tree["drivetrain"]
    places = {
        "shaft_stiffness": list(power["shafts"]),
        "coupling_stiffness": list(power["couplings"]),
        "coupling_damping": list(power["couplings"]),
        "spline_stiffness": [g for m in meshes for g in m.gears],
        "spline_damping": [g for m in meshes for g in m.gears],
        "inertia": [*(g for m in meshes for g in m.gears), "motor"],
        "mesh_stiffness": [m.name for m in meshes],
        "mesh_damping": [m.name for m in meshes],
        "backlash": [m.name for m in meshes],
    }
    found: dict[str, float] = {}
    for kind, spread in SPREADS.items():
        if kind in places:
            found.update({f"{kind}:{place}": spread for place in dict.fromkeys(places[kind])})
        else:
            found[kind] = spread
    return found


def error_names(meshes: Sequence[Teeth]) -> dict[str, float]:
    """Healthy tooth errors that count as uncertain constants, standard deviation of each part [m]."""
    found = {}
    for mesh in meshes:
        for index, gear in enumerate(mesh.gears):
            total = tolerances(mesh, index)[1]
            for part in ("cos", "sin"):
                found[f"run_out:{gear}:{part}"] = RUN_OUT_SHARE * total
                for order, share in WAVE_SHARE.items():
                    found[f"wave_{order}:{gear}:{part}"] = share * total
    return found


def draw_constants(
    rng: np.random.Generator, tree: Mapping[str, Any], meshes: Sequence[Teeth], *, shift: bool = False
) -> LoopConstants:
    """A rig as built: constants and healthy tooth errors. ``shift``: half as much wider again, softer journals."""
    wide = 1.5 if shift else 1.0
    values = {
        name: wide * spread * rng.standard_normal() for name, spread in constant_names(tree, meshes).items()
    }
    if shift:
        values["journal_stiffness"] -= 0.4
        values["curvature"] += 0.25
    errors = {}
    for mesh in meshes:
        for index, gear in enumerate(mesh.gears):
            single, _, slope = tolerances(mesh, index)
            z = mesh.z[index]
            steps = wide * SINGLE_SHARE * single * rng.standard_normal(z)
            parts = {name: wide * size * rng.standard_normal() for name, size in error_names([mesh]).items()}
            errors[gear] = ToothErrors(
                run_out=complex(parts[f"run_out:{gear}:cos"], parts[f"run_out:{gear}:sin"]),
                place=tuple(_closed(steps) * 0.5),
                slope=tuple(
                    wide * SLOPE_SHARE * slope * (rng.standard_normal() + 0.4 * rng.standard_normal(z))
                ),
                waves={
                    k: complex(parts[f"wave_{k}:{gear}:cos"], parts[f"wave_{k}:{gear}:sin"])
                    for k in WAVE_SHARE
                },
            )
    return with_constants(LoopConstants(errors=errors), values)


def with_constants(base: LoopConstants, values: Mapping[str, float]) -> LoopConstants:
    """Constants changed relatively: ``{"mesh_stiffness:test.main": 0.05}``; tooth errors by `error_names` in metres."""
    scale = dict(base.scale)
    errors = dict(base.errors)
    plain: dict[str, float] = {}
    for name, value in values.items():
        if name.startswith(("run_out:", "wave_")):
            kind, gear, part = name.split(":")
            errors[gear] = _with_wave(
                errors.get(gear, ToothErrors()), kind, value * (1.0 if part == "cos" else 1j)
            )
        elif name in ("curvature", "hertz", "relief", "lock"):
            plain[name] = getattr(base, name) * (1.0 + value)
        else:
            scale[name] = scale.get(name, 1.0) * math.exp(value)
    return replace(base, scale=scale, errors=errors, **plain)


def _with_wave(error: ToothErrors, kind: str, value: complex) -> ToothErrors:
    if kind == "run_out":
        return replace(error, run_out=error.run_out + value)
    order = int(kind.removeprefix("wave_"))
    return replace(error, waves={**error.waves, order: error.waves.get(order, 0j) + value})


def _closed(steps: np.ndarray) -> np.ndarray:
    """Cumulative places of single pitch deviations, closed over the turn and with mean zero."""
    places = np.cumsum(steps - steps.mean())
    return places - places.mean()


# ---------------------------------------------------------------------------- effects


def changed(
    base: LoopConstants, effects: Sequence[Mapping[str, Any]], meshes: Sequence[Teeth]
) -> LoopConstants:
    """Constants with hidden effects: entries ``{"effect": "run_out:test.pinion", "size": 12e-6, "phase": 0.4}``.

    Effects of losses, oil and sensors are not of the loop and pass through. KeyError: unknown gear or mesh.
    """
    for effect in effects:
        kind, _, place = effect["effect"].partition(":")
        change = CHANGES.get(kind)
        if change is not None:
            base = change(base, place, effect, meshes)
    return base


def _wave(effect: Mapping[str, Any]) -> complex:
    phase = effect.get("phase", 0.0)
    return complex(effect["size"] * math.cos(phase), effect["size"] * math.sin(phase))


def _edit(base: LoopConstants, gear: str, **parts: Any) -> LoopConstants:
    return replace(base, errors={**base.errors, gear: replace(base.errors.get(gear, ToothErrors()), **parts)})


def _teeth_of(meshes: Sequence[Teeth], gear: str) -> int:
    return next(mesh.z[mesh.gears.index(gear)] for mesh in meshes if gear in mesh.gears)


def _own(base: LoopConstants, gear: str) -> ToothErrors:
    return base.errors.get(gear, ToothErrors())


def _run_out(base, place, effect, meshes):  # type: ignore[no-untyped-def]
    return _edit(base, place, run_out=_own(base, place).run_out + _wave(effect))


def _cumulative(base, place, effect, meshes):  # type: ignore[no-untyped-def]
    waves, order = _own(base, place).waves, int(effect["order"])
    return _edit(base, place, waves={**waves, order: waves.get(order, 0j) + _wave(effect)})


def _single(base, place, effect, meshes):  # type: ignore[no-untyped-def]
    """One tooth out of its place: its pitch longer, the next one shorter."""
    z = _teeth_of(meshes, place)
    steps = np.zeros(z)
    steps[int(effect["tooth"])] = effect["size"]
    steps[(int(effect["tooth"]) + 1) % z] -= effect["size"]
    return _edit(base, place, place=tuple(np.array(_own(base, place).place or (0.0,) * z) + _closed(steps)))


def _weak(base, place, effect, meshes):  # type: ignore[no-untyped-def]
    stiffness = np.array(_own(base, place).stiffness or (1.0,) * _teeth_of(meshes, place))
    stiffness[int(effect["tooth"])] *= 1.0 - effect["size"]
    return _edit(base, place, stiffness=tuple(stiffness))


def _slope(base, place, effect, meshes):  # type: ignore[no-untyped-def]
    own = np.array(_own(base, place).slope or (0.0,) * _teeth_of(meshes, place))
    return _edit(base, place, slope=tuple(own + effect["size"]))


def _relief(base, place, effect, meshes):  # type: ignore[no-untyped-def]
    return _edit(base, place, tip_relief=_own(base, place).tip_relief + effect["size"])


def _factor(kind: str):  # type: ignore[no-untyped-def]
    def change(base, place, effect, meshes):  # type: ignore[no-untyped-def]
        name = f"{kind}:{place}"
        return replace(base, scale={**base.scale, name: base.scale.get(name, 1.0) * (1.0 + effect["size"])})

    return change


def _torque(**fixed: Any):  # type: ignore[no-untyped-def]
    def change(base, place, effect, meshes):  # type: ignore[no-untyped-def]
        own = HarmonicTorque(
            place=place or "motor",
            amplitude=_wave(effect),
            **{"order": float(effect.get("order", 1.0)), **fixed},
        )
        return replace(base, torques=(*base.torques, own))

    return change


def _alternate(base, place, effect, meshes):  # type: ignore[no-untyped-def]
    z = _teeth_of(meshes, place)
    pattern = 0.5 * effect["size"] * (-1.0) ** np.arange(z)
    return _edit(
        base, place, place=tuple(np.array(_own(base, place).place or (0.0,) * z) + pattern - pattern.mean())
    )


def _rub(base, place, effect, meshes):  # type: ignore[no-untyped-def]
    """A touch once a turn: the same torque at orders 1 to 6, growing with speed."""
    for order in range(1, 7):
        part = {**effect, "order": order, "phase": order * effect.get("phase", 0.0)}
        base = _torque(speed_power=1.0)(base, place, part, meshes)
    return base


def _absorber(base, place, effect, meshes):  # type: ignore[no-untyped-def]
    return replace(base, scale={**base.scale, f"absorber:{place}": effect["size"]})


CHANGES = {
    "run_out": _run_out,
    "cumulative_pitch": _cumulative,
    "single_pitch": _single,
    "weak_tooth": _weak,
    "profile_slope": _slope,
    "tip_relief": _relief,
    "motor_ripple": _torque(),
    "coupling_order_2": _torque(order=2.0),
    "coupling_stiffness": _factor("coupling_stiffness"),
    "coupling_damping": _factor("coupling_damping"),
    "spline_stiffness": _factor("spline_stiffness"),
    "mesh_stiffness": _factor("mesh_stiffness"),
    "mesh_damping": _factor("mesh_damping"),
    "inertia": _factor("inertia"),
    "bracing_drift": lambda base, place, effect, meshes: replace(base, drift=base.drift + effect["size"]),
    # out of catalogue
    "x_torque_squared": _torque(order=3.0, torque_power=2.0),
    "x_mains": _torque(frequency=100.0, order=1.0),
    "x_alternate_teeth": _alternate,
    "x_rub": _rub,
    "x_absorber": _absorber,
    "x_stiffening": lambda base, place, effect, meshes: replace(base, stiffening=effect["size"]),
    "x_speed_ripple": _torque(order=4.0, speed_power=2.0),
}  # fmt: skip
