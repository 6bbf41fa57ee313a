"""Catalogue of the power circuit: teeth, joints, inertias, excitation from motor and couplings, bracing.

Excitations are written by their parts along cosine and sine, so that an unknown phase costs nothing. Bounds are
starting values of rig practice (design of the workflow, section 4); what a healthy gear has follows from its quality
grade (ISO 1328-1). Of what a healthy rig does not have the entry says which size matters: a pitch deviation beyond the
tolerance of its grade, a tooth softer by more than the teeth of one gear differ anyway, harmonic torques of half a per
cent of their bound, a bracing torque that drifts by half a per cent over 50 K.
"""

from collections.abc import Iterator, Mapping
from math import atan2, cos, hypot, pi, sin

from dynamics.standards.iso1328_1_2013 import tolerances
from rigdesign.base.part_name import GearName
from rigdesign.case.drivetrain import HarmonicTorqueInput
from rigdesign.case.gearbox import Gearbox
from rigdesign.case.model import Case
from rigdesign.diagnosis.catalogue.effects import (
    DAMPING,
    EXCITATION,
    INERTIA,
    PRACTICE,
    STATE,
    STIFFNESS,
    TOOTH,
    Added,
    Changes,
    Effect,
    GearboxPart,
    Parameter,
    UncertainValue,
    of_gearbox,
    of_rig,
)

MICROMETRE = 1e-6
"""In metres."""

LEAST_TORQUE = 0.01
"""Amplitude of a harmonic torque that is named [N m]: a tenth of the one to two per cent that the torque of a motor of
tens of newton metres ripples anyway; a torque cell that is averaged over revolutions resolves it."""

LEAST_SOFTENING = 0.02
"""Share of its stiffness that a tooth must have lost to matter: less than a crack through a tenth of the root takes."""


@of_gearbox(drivetrain=True)
def teeth(part: GearboxPart) -> Iterator[Effect]:
    """Deviations and weak teeth of every gear."""
    for name in part.box.gears:
        yield from _teeth(part.name, part.box, name)


def _teeth(box_name: str, box: Gearbox, name: str) -> Iterator[Effect]:
    gear, path, label = box.gears[name], f"gearboxes.{box_name}.gears.{name}.flank", GearName(box_name, name)
    spread = _healthy_teeth(box, name)
    yield Effect(
        name=f"run_out:{label}",
        title=f"run-out of {label} (eccentricity)",
        family=EXCITATION,
        signature="order 1 of its shaft from low speed on, sidebands of the mesh orders",
        parameters=_amplitudes("eccentricity", 50.0 * MICROMETRE),
        change=_RunOut(label, path),
        healthy=spread["run_out"],
        linear=True,
        doubled="run-out F_r",
    )
    for order in (2, 3, 4):
        yield Effect(
            name=f"cumulative_pitch:{label}/{order}",
            title=f"cumulative pitch deviation of {label}, {order} waves per revolution",
            family=EXCITATION,
            signature=f"order {order} of its shaft, sidebands of the mesh orders at that distance",
            parameters=_amplitudes("amplitude", 40.0 * MICROMETRE),
            change=_PitchWave(label, path, order),
            healthy=spread["pitch_wave"],
            linear=True,
        )
    yield Effect(
        name=f"single_pitch:{label}",
        title=f"single pitch deviation of {label}",
        family=EXCITATION,
        signature="all orders of its shaft alike, larger at low torque",
        parameters=(_length("deviation", -60.0, 60.0),),
        change=_SinglePitch(label, path, gear.teeth),
        any_tooth=gear.teeth,
        linear=True,
        matters=spread["pitch_tolerance"],
    )
    yield Effect(
        name=f"weak_tooth:{label}",
        title=f"reduced stiffness of one tooth of {label}",
        family=TOOTH,
        signature="all orders of its shaft, growing with torque",
        parameters=(Parameter(name="softening", unit="", low=0.0, high=0.8, source=PRACTICE),),
        change=_WeakTooth(path),
        any_tooth=gear.teeth,
        matters=LEAST_SOFTENING,
    )
    yield Effect(
        name=f"profile_slope:{label}",
        title=f"profile slope of {label}",
        family=TOOTH,
        signature="mesh orders only, changing with torque",
        parameters=(_length("slope", -25.0, 25.0),),
        change=Added(f"{path}.profile_slope", gear.flank.profile_slope),
        healthy=spread["slope"],
    )
    if gear.flank.tip_relief_length > 0.0:
        yield Effect(
            name=f"tip_relief:{label}",
            title=f"tip relief of {label}",
            family=TOOTH,
            signature="mesh orders only, changing with torque",
            parameters=(_length("relief", -1e6 * gear.flank.tip_relief, 25.0),),
            change=Added(f"{path}.tip_relief", gear.flank.tip_relief),
            healthy=3.0 * MICROMETRE,
        )


def _healthy_teeth(box: Gearbox, name: str) -> Mapping[str, float]:
    """Spreads of one part of run-out, of a pitch wave, and of the profile slope, and the tolerance of a pitch [m].

    Gears are made to lie within the tolerance of their grade; half of it is taken as two standard deviations of the
    whole, a wave of the cumulative pitch as a third of the run-out.
    """
    mesh = box.meshes[box.first_meshes()[name][0]]
    gear = box.gears[name]
    normal = 1e3 * mesh.normal_module
    limits = tolerances(
        gear.teeth, gear.teeth * normal / cos(mesh.helix_angle), normal, 1e3 * gear.face_width, gear.quality_grade,
        mesh.helix_angle,
    )  # fmt: skip
    run_out = 0.25 * 0.5 * 0.9 * limits.F_pT * MICROMETRE
    return {
        "run_out": run_out,
        "pitch_wave": run_out / 3.0,
        "slope": 0.25 * limits.f_HalphaT * MICROMETRE,
        "pitch_tolerance": limits.f_pT * MICROMETRE,
    }


def _length(name: str, low: float, high: float) -> Parameter:
    """A length between bounds in micrometres; its coordinate is in metres."""
    return Parameter(name=name, unit="m", low=low * MICROMETRE, high=high * MICROMETRE, source=PRACTICE)


def _amplitudes(name: str, most: float, unit: str = "m") -> tuple[Parameter, Parameter]:
    first, second = (
        Parameter(name=f"{name} along {part}", unit=unit, low=-most, high=most, source=PRACTICE)
        for part in ("cosine", "sine")
    )
    return first, second


def _joined(harmonic: tuple[float, float], more: tuple[float, float]) -> tuple[float, float]:
    """Amplitude and phase of a harmonic (amplitude, phase) with parts along cosine and sine added."""
    along, across = harmonic[0] * cos(harmonic[1]) + more[0], harmonic[0] * sin(harmonic[1]) + more[1]
    return hypot(along, across), atan2(across, along) % (2.0 * pi)


class _RunOut:
    def __init__(self, gear: GearName, path: str) -> None:
        self._gear, self._path = gear, path

    def __call__(self, case: Case, values: tuple[float, ...]) -> Changes:
        flank = case.gearboxes[self._gear.gearbox].gears[self._gear.part].flank
        size, phase = _joined((0.5 * flank.run_out, flank.run_out_phase), (values[0], values[1]))
        return {f"{self._path}.run_out": 2.0 * size, f"{self._path}.run_out_phase": phase}


class _PitchWave:
    def __init__(self, gear: GearName, path: str, order: int) -> None:
        self._gear, self._path, self._order = gear, path, order

    def __call__(self, case: Case, values: tuple[float, ...]) -> Changes:
        waves = [
            {"order": wave.order, "amplitude": _metres(wave.amplitude), "phase": _radians(wave.phase)}
            for wave in case.gearboxes[self._gear.gearbox].gears[self._gear.part].flank.pitch_waves
        ]
        size, phase = _joined((0.0, 0.0), (values[0], values[1]))
        more = {"order": self._order, "amplitude": _metres(size), "phase": _radians(phase)}
        return {f"{self._path}.pitch_waves": [*waves, more]}


def _metres(value: float) -> str:
    return f"{value!r} m"


def _radians(value: float) -> str:
    return f"{value!r} rad"


class _SinglePitch:
    """One tooth stands ahead: its pitch is long, the next one short."""

    def __init__(self, gear: GearName, path: str, teeth: int) -> None:
        self._gear, self._path, self._teeth = gear, path, teeth

    def __call__(self, case: Case, values: tuple[float, ...]) -> Changes:
        stated = (
            case.gearboxes[self._gear.gearbox].gears[self._gear.part].flank.single_pitch
            or (0.0,) * self._teeth
        )
        tooth = int(values[1]) if len(values) > 1 else 0
        pitch = list(stated)
        pitch[tooth] += values[0]
        pitch[(tooth + 1) % self._teeth] -= values[0]
        return {f"{self._path}.single_pitch": [_metres(value) for value in pitch]}


class _WeakTooth:
    def __init__(self, path: str) -> None:
        self._path = path

    def __call__(self, case: Case, values: tuple[float, ...]) -> Changes:
        tooth = int(values[1]) if len(values) > 1 else 0
        return {
            f"{self._path}.weak_tooth.tooth": tooth,
            f"{self._path}.weak_tooth.stiffness": 1.0 - values[0],
        }


@of_gearbox(drivetrain=True)
def mesh_compliance(part: GearboxPart) -> Iterator[Effect]:
    """Stiffness and damping of every mesh."""
    for name, mesh in part.box.meshes.items():
        path, label = f"{part.path}.meshes.{name}", f"{part.name}.{name}"
        stiffness = UncertainValue(
            path=f"{path}.stiffness_factor", now=mesh.stiffness_factor, bounds=(0.6, 1.5), healthy=0.07
        )
        yield stiffness.effect(
            f"mesh_stiffness:{label}", f"stiffness of the mesh {label}", STIFFNESS,
            "mesh orders, resonance speeds of the mesh",
        )  # fmt: skip
        key = "damping" if mesh.damping is not None else "damping_ratio"
        damping = UncertainValue(
            path=f"{path}.{key}", now=getattr(mesh, key), bounds=(0.2, 5.0), healthy=0.25
        )
        yield damping.effect(
            f"mesh_damping:{label}", f"damping of the mesh {label}", DAMPING,
            "height of mesh orders near resonance",
        )  # fmt: skip


@of_gearbox(drivetrain=True)
def gear_bodies(part: GearboxPart) -> Iterator[Effect]:
    """Inertia of every gear, stiffness of its spline."""
    for name, gear in part.box.gears.items():
        path, label = f"{part.path}.gears.{name}", f"{part.name}.{name}"
        inertia = UncertainValue(
            path=f"{path}.inertia_factor", now=gear.inertia_factor, bounds=(0.7, 1.4), healthy=0.04
        )
        yield inertia.effect(
            f"inertia:{label}", f"inertia of {label}", INERTIA, "torsional modes that move this gear"
        )
        if gear.spline is not None:
            spline = UncertainValue(
                path=f"{path}.spline.torsional_stiffness", now=gear.spline.torsional_stiffness,
                bounds=(0.1, 5.0), healthy=0.10,
            )  # fmt: skip
            yield spline.effect(
                f"spline_stiffness:{label}", f"stiffness of the spline of {label}", STIFFNESS,
                "torsional modes that twist this spline",
            )  # fmt: skip


@of_rig(drivetrain=True)
def couplings(case: Case) -> Iterator[Effect]:
    """Stiffness, damping and misalignment of every coupling."""
    for name, coupling in case.power_circuit.couplings.items():
        path = f"drivetrain.couplings.{name}"
        stiffness = UncertainValue(
            path=f"{path}.torsional_stiffness",
            now=coupling.torsional_stiffness,
            bounds=(0.2, 5.0),
            healthy=0.08,
        )
        yield stiffness.effect(
            f"coupling_stiffness:{name}", f"stiffness of the coupling {name}", STIFFNESS,
            "low torsional modes and the torque caused by run-out",
        )  # fmt: skip
        damping = UncertainValue(
            path=f"{path}.torsional_damping", now=coupling.torsional_damping, bounds=(0.2, 5.0), healthy=0.25
        )
        yield damping.effect(
            f"coupling_damping:{name}", f"damping of the coupling {name}", DAMPING,
            "height of the low torsional modes",
        )  # fmt: skip
        yield Effect(
            name=f"coupling_order_2:{name}",
            title=f"misalignment at the coupling {name}",
            family=EXCITATION,
            signature="order 2 of its shaft, the same at any torque",
            parameters=_amplitudes("torque", 20.0, "N m"),
            change=_Harmonic(f"{path}.excitation", coupling.excitation, 2.0),
            linear=True,
            matters=LEAST_TORQUE,
        )


class _Harmonic:
    """Adds a harmonic torque to a list of them."""

    def __init__(self, path: str, stated: tuple[HarmonicTorqueInput, ...], order: float) -> None:
        self._path, self._stated, self._order = path, stated, order

    def __call__(self, case: Case, values: tuple[float, ...]) -> Changes:
        size, phase = _joined((0.0, 0.0), (values[0], values[1]))
        rows = [(harmonic.order, harmonic.torque, harmonic.phase) for harmonic in self._stated]
        return {
            self._path: [
                {"order": order, "torque": f"{torque!r} N m", "phase": _radians(angle)}
                for order, torque, angle in (*rows, (self._order, size, phase))
            ]
        }


@of_rig(drivetrain=True)
def drive(case: Case) -> Iterator[Effect]:
    """Ripple and inertia of the motor, drift of the bracing."""
    motor, bracing = case.power_circuit.motor, case.power_circuit.bracing
    for order in (1, 2, 3, 4, 6):
        yield Effect(
            name=f"motor_ripple/{order}",
            title=f"torque ripple of the motor, order {order}",
            family=EXCITATION,
            signature=f"order {order} of the motor, the same at any torque",
            parameters=_amplitudes("torque", 20.0, "N m"),
            change=_Harmonic("drivetrain.motor.ripple", motor.ripple, float(order)),
            linear=True,
            matters=LEAST_TORQUE,
        )
    if motor.inertia > 0.0:
        inertia = UncertainValue(
            path="drivetrain.motor.inertia", now=motor.inertia, bounds=(0.5, 2.0), healthy=0.05
        )
        yield inertia.effect("inertia:motor", "inertia of the motor", INERTIA, "the lowest torsional modes")
    yield Effect(
        name="bracing_drift",
        title="drift of the bracing torque with the oil temperature",
        family=STATE,
        signature="mean torque and what depends on it change with the oil temperature",
        parameters=(Parameter(name="drift", unit="1/K", low=-0.003, high=0.003, source=PRACTICE),),
        change=Added("drivetrain.bracing.temperature_drift", bracing.temperature_drift),
        linear=True,
        matters=1e-4,
    )
