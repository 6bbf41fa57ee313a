"""How finely the loop is divided: slices of the teeth, elements of the shafts, and the modes that are followed.

The rules follow what excites the loop. A shaft element takes a sixteenth of the torsional wave of the highest
frequency that counts, the fourth mesh harmonic at the highest speed or 20 kHz: lumped inertia makes a mode there low by
(2 pi / 16)^2 / 24 = 0.6 % (``dynamics.rotor.shaft.Shaft``). Modes above 2.5 times that frequency, six elements a
wave, are not followed. Of shafts that bend the modes above 1.25 times that frequency and above 20 kHz keep their static
effect at bearings, gears and couplings alone: it moves K_V by 1.6e-3 on the prototype, 2.6e-4 on the main rig
(``tests/verification/test_elastic_resolution``). Slices are the rule of ``dynamics.tooth.mesh_laws.default_slices``.
The case may state element length and slices; what either leaves open stands with the checks
(`rigdesign.run.mesh_convergence`).
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

from dynamics.rotor import parts
from dynamics.rotor.graph import Drivetrain
from dynamics.rotor.shaft import Shaft
from dynamics.vibration.modal_model import DEFAULT_CUTOFF
from rigdesign.base.errors import CaseError, Fault
from rigdesign.base.units import show
from rigdesign.case.model import Case
from rigdesign.case.rules.gathered import MOST_SHAFT_ELEMENTS
from rigdesign.rig_heat.component import Machine

COUNTED_HARMONIC = 4
"""Harmonics of the mesh frequency that the shafts must follow at the highest speed."""
HIGHEST_COUNTED = 20e3
"""Frequency [Hz] beyond which the inertia of the gears keeps the excitation out of the shafts."""
ELEMENTS_PER_WAVE = 16
FOLLOWED = 2.5
"""Highest mode that is followed, per counted frequency."""
BENDING_FOLLOWED = 1.25
"""The same for the modes of bending shafts; above it they are replaced by the static shapes of all ports."""


class Coarsening(NamedTuple):
    """How many times coarser than the rules, or the case, the loop is divided: for estimates of their errors.

    modes : factor by which the highest bending mode kept is lowered
    """

    slices: int = 1
    elements: int = 1
    modes: int = 1


AS_RULED = Coarsening()


def counted_frequency(case: Case, drivetrain: Drivetrain) -> float:
    """Highest frequency [Hz] that counts for the shafts."""
    fastest = max(case.numerics.curve_speed_end, *(stage.speed_end for stage in case.schedule.resolved()))
    ratios = speed_ratios(case, drivetrain)
    mesh = max(
        mesh.teeth[0] * ratios[drivetrain.gear(mesh.pinion).shaft] * fastest / (2.0 * math.pi)
        for mesh in drivetrain.meshes
    )
    return min(COUNTED_HARMONIC * mesh, HIGHEST_COUNTED)


def highest_mode(frequency: float) -> float:
    """Frequency [Hz] up to which modes of the loop are followed."""
    return min(FOLLOWED * frequency, DEFAULT_CUTOFF)


def highest_bending_mode(frequency: float) -> float:
    """Frequency [Hz] up to which shafts that bend keep their modes; slow rigs keep as many as cost nothing."""
    return min(max(BENDING_FOLLOWED * frequency, HIGHEST_COUNTED), DEFAULT_CUTOFF)


def with_elements(case: Case, drivetrain: Drivetrain, times: int = 1) -> Drivetrain:
    """The drivetrain with the element length of the case, or of the rule where it states none, ``times`` as long."""
    stated = case.numerics.shaft_element_length
    least = math.fsum(shaft.length for shaft in drivetrain.shafts) / MOST_SHAFT_ELEMENTS
    frequency = counted_frequency(case, drivetrain)
    return replace(
        drivetrain,
        shafts=tuple(
            replace(shaft, element_length=times * (stated or max(_element_length(shaft, frequency), least)))
            for shaft in drivetrain.shafts
        ),
    )


def _element_length(shaft: Shaft, frequency: float) -> float:
    """Element length [m] of the rule; two digits, so that a small change of a material leaves the elements alone."""
    length = shaft.wave_speed / frequency / ELEMENTS_PER_WAVE
    return float(f"{length:.1e}")


# Speeds of shafts, relative to the gear at which test speed and torque are counted, and of the driving machines.


def speed_ratios(case: Case, drivetrain: Drivetrain) -> dict[str, float]:
    """Shaft -> speed ratio to the gear ``drivetrain.torque_at``; magnitude only, every shaft runs forward.

    Without a drivetrain the pinion of the first mesh of each gearbox runs at the test speed.
    """
    if case.drivetrain is None:
        return _by_gearbox(case)
    ratios = parts.speed_ratios(drivetrain)
    reference = ratios[drivetrain.gear(case.power_circuit.torque_at).shaft]
    return {shaft: ratio / reference for shaft, ratio in ratios.items()}


def _by_gearbox(case: Case) -> dict[str, float]:
    """Ratios along the meshes of each gearbox for itself."""
    ratios: dict[str, float] = {}
    for box in case.gearboxes.values():
        meshes = list(box.meshes.values())
        ratios[box.gears[meshes[0].pinion].shaft] = 1.0
        for _ in meshes:
            for mesh in meshes:
                pinion, wheel = box.gears[mesh.pinion], box.gears[mesh.wheel]
                ratio = pinion.teeth / wheel.teeth
                if pinion.shaft in ratios:
                    ratios.setdefault(wheel.shaft, ratios[pinion.shaft] * ratio)
                elif wheel.shaft in ratios:
                    ratios[pinion.shaft] = ratios[wheel.shaft] / ratio
    return ratios


def refuse_uncovered_speeds(machines: Sequence[Machine], speeds: Mapping[str, float], source: str) -> None:
    """Raise CaseError where the loss map of a machine does not hold a speed; its torque follows from the losses.

    machines : from the rig to the mains; speeds : stage -> speed of the shaft that is driven [rad/s]
    source : case file
    """
    faults = [fault for stage, speed in speeds.items() for fault in _uncovered(machines, stage, speed)]
    if faults:
        raise CaseError(faults, source)


def _uncovered(machines: Sequence[Machine], stage: str, speed: float) -> Iterator[Fault]:
    for machine in machines:
        missed = machine.loss.missed_speeds(speed) if speed else None
        if missed is not None:
            low, high = (show(end, "speed") for end in missed)
            yield Fault(
                f"rig_heat.machines.{machine.name}.loss_map", show(speed, "speed"),
                f"is the speed of its output at stage {stage}, outside of the map, {low} to {high}",
                "extend the map to this speed, it is not extrapolated; or correct speed_ratio of the machines between "
                "it and the rig",
            )  # fmt: skip
        speed *= machine.speed_ratio
