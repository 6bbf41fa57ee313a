"""Loads and cycles of the gear ratings: the one place that gives ISO 6336 its K factors.

K_Hbeta and K_Falpha follow from the case (`face_load_factor`) and ISO 6336-1; a loaded tooth contact is to give them
here, and root stress, pitting, scuffing and film take them alike.
"""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from dynamics.rating import iso_rating, pitting
from dynamics.rating.flank_contact import ContactFactors, FlankLoad
from dynamics.standards.iso6336_1_2006 import DynamicFactor
from dynamics.standards.iso6336_3_2006 import LoadFactors
from rigdesign.coupling.loop import PointResult
from rigdesign.records.curves import iso_factor
from rigdesign.rig.model import Rig


@dataclass(frozen=True, kw_only=True)
class RatedLoad:
    """Load of one mesh at a held stage, as the ratings take it; torque and speed of its pinion."""

    stage: str
    torque: float
    """Mean [N m]."""
    speed: float
    """[rad/s]"""
    root: LoadFactors
    """K_A, simulated K_V, K_Fbeta, K_Falpha."""
    contact: ContactFactors
    """K_A, simulated K_V, K_Hbeta, K_Halpha."""
    standard: DynamicFactor
    """K_V of ISO 6336-1 with the tooth stiffness behind it."""


def rated_loads(rig: Rig, points: Iterable[PointResult], mesh: int) -> Iterator[RatedLoad]:
    """Loads of a mesh, by its number, at every held stage; ISO 6336-1 with the simulated K_V and gears as drawn."""
    name = rig.mesh_names[mesh]
    pair = rig.pairs[name]
    box, own = rig.mesh(name)
    entry = box.meshes[own]
    face_load = pitting.face_load_factor(pair, entry.face_load_factor)
    for point in points:
        response = point.last.response
        if response is None:
            continue
        torque, factor = float(response.mean[mesh]), float(response.dynamic_factor[mesh])
        speed = rig.shaft_speed(rig.mesh_gear(mesh, 0).shaft, point.point.speed)
        standard = iso_factor(rig, name, torque, speed)
        yield RatedLoad(
            stage=point.point.stage,
            torque=torque,
            speed=speed,
            root=LoadFactors(
                K_A=entry.application_factor,
                K_V=factor,
                K_Fbeta=entry.face_load_factor,
                # the smaller K_Fbeta in place of K_Hbeta is on the safe side
                K_Falpha=iso_rating.transverse_load_factor(
                    pair, standard, dynamic=factor, face_load=entry.face_load_factor
                ),
            ),
            contact=ContactFactors(
                application=entry.application_factor,
                dynamic=factor,
                face_load=face_load,
                transverse=pitting.transverse_load_factor(
                    pair, standard, dynamic=factor, face_load=entry.face_load_factor
                ),
            ),
            standard=standard,
        )


def flank_load(rig: Rig, mesh: int, load: RatedLoad, *, pinion_drives: bool) -> FlankLoad:
    """The load as the flanks see it, with their tip relief; profile crowning counts as relief where there is none.

    C_eff is the deflection under load, F_t K_A / b over c' of spur and c_gamma of helical gears (ISO/TS 6336-22).
    """
    pair = rig.pairs[rig.mesh_names[mesh]]
    gears = [rig.mesh_gear(mesh, index) for index in (0, 1)]
    pinion, wheel = (gear.flank.tip_relief or gear.flank.profile_crowning for gear in gears)
    stiffness = load.standard.stiffness
    return FlankLoad(
        torque=abs(load.torque),
        speed=load.speed,
        pinion_drives=pinion_drives,
        factors=load.contact,
        grade=max(gear.quality_grade for gear in gears),
        tip_reliefs=(pinion, wheel),
        optimum=1e-6
        * load.standard.specific_load
        / (stiffness.c_gamma_alpha if pair.helix_angle else stiffness.c_prime),
    )


def load_cycles(rig: Rig, shaft: str) -> float:
    """Turns of a shaft in the planned time at test speed.

    A tooth is loaded once a turn; an idler's two meshes load opposite flanks, one cycle of reversed bending.
    """
    speed = rig.shaft_speed(shaft, rig.case.schedule.test_speed)
    return rig.case.test_plan.time * speed / (2.0 * math.pi)


def rated_cycles(rig: Rig, mesh: int, index: int) -> float:
    """Load cycles that a gear has to endure: of one test as a specimen, of all specimens as a gear of the rig."""
    tests = 1 if rig.mesh(rig.mesh_names[mesh])[0].role == "specimen" else rig.case.test_plan.specimens
    return load_cycles(rig, rig.mesh_gear(mesh, index).shaft) * tests
