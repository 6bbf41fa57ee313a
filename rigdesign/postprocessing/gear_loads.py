"""Loads and cycles of the gear ratings: the one place that gives ISO 6336 its K factors.

K_Hbeta and K_Halpha are those of the loaded contact where it is computed. Elsewhere, of analytic teeth, they follow
from the case (`face_load_factor`) and ISO 6336-1. Root stress, pitting, scuffing and film take them alike.
"""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from dynamics.gear.pair import GearPair
from dynamics.rating import iso_rating
from dynamics.rating.flank_contact import (
    ContactFactors,
    FlankLoad,
    face_load_factor,
    root_face_load_factor,
    transverse_limits,
    transverse_load_factor,
)
from dynamics.standards.iso6336_1_2006 import DynamicFactor
from dynamics.standards.iso6336_3_2006 import LoadFactors
from rigdesign.coupling.loop import PointResult
from rigdesign.postprocessing.curves import iso_factor
from rigdesign.postprocessing.loaded_contact import HeldContact, held_contact
from rigdesign.rig.model import Rig

COMPUTED = "load factors of the loaded contact"
STATED = "load factors of face_load_factor and ISO 6336-1"


@dataclass(frozen=True, kw_only=True)
class RatedLoad:
    """Load of one mesh at a held stage, as the ratings take it; torque, on one half of a double-helical gear, and speed
    of its pinion."""

    stage: str
    torque: float
    """Mean [N m]."""
    speed: float
    """[rad/s]"""
    root: LoadFactors
    """K_A, simulated K_V, K_Fbeta, K_Falpha."""
    contact: ContactFactors
    """K_A, simulated K_V, K_Hbeta, K_Halpha."""
    sharing_basis: str
    """Where K_Hbeta, K_Halpha and those of the root come from, in words."""
    standard: DynamicFactor
    """K_V of ISO 6336-1 with the tooth stiffness behind it."""


@dataclass(frozen=True, kw_only=True)
class SharingFactors:
    """How uneven a load lies over face width and tooth pairs, of root and flank, and where the factors come from."""

    K_Fbeta: float
    K_Falpha: float
    K_Hbeta: float
    K_Halpha: float
    basis: str


def application_factor(rig: Rig, mesh: int) -> float:
    """K_A of a mesh, by its number."""
    box, own = rig.mesh(rig.mesh_names[mesh])
    return box.meshes[own].application_factor


def rated_loads(rig: Rig, points: Iterable[PointResult], mesh: int) -> Iterator[RatedLoad]:
    """Loads of a mesh, by its number, at every held stage; ISO 6336-1 with the simulated K_V and gears as drawn."""
    name = rig.mesh_names[mesh]
    box, own = rig.mesh(name)
    entry, application = box.meshes[own], application_factor(rig, mesh)
    for point in points:
        response = point.last.response
        if response is None:
            continue
        torque, factor = float(response.mean[mesh]) / entry.sharing, float(response.dynamic_factor[mesh])
        speed = rig.shaft_speed(rig.mesh_gear(mesh, 0).shaft, point.point.speed)
        standard = iso_factor(rig, name, float(response.mean[mesh]), speed)
        contact = held_contact(rig, point, mesh)
        sharing = (
            stated_factors(rig.pairs[name], standard, dynamic=factor, face_load=entry.face_load_factor)
            if contact is None
            else contact_factors(rig.pairs[name], standard, contact)
        )
        yield RatedLoad(
            stage=point.point.stage,
            torque=torque,
            speed=speed,
            root=LoadFactors(
                K_A=application,
                K_V=factor,
                K_Fbeta=sharing.K_Fbeta,
                K_Falpha=sharing.K_Falpha,
            ),
            contact=ContactFactors(
                application=application,
                dynamic=factor,
                face_load=sharing.K_Hbeta,
                transverse=sharing.K_Halpha,
            ),
            sharing_basis=sharing.basis,
            standard=standard,
        )


def stated_factors(
    pair: GearPair, standard: DynamicFactor, *, dynamic: float, face_load: float
) -> SharingFactors:
    """Of the K_Fbeta of the case, ``face_load``, and of ISO 6336-1 with the K_V ``dynamic``.

    K_Fbeta in place of the larger K_Hbeta in the determinant load is on the safe side: a smaller load shares worse.
    """
    return SharingFactors(
        K_Fbeta=face_load,
        K_Falpha=iso_rating.transverse_load_factor(pair, standard, dynamic=dynamic, face_load=face_load),
        K_Hbeta=face_load_factor(pair, face_load),
        K_Halpha=transverse_load_factor(pair, standard, dynamic=dynamic, face_load=face_load),
        basis=STATED,
    )


def contact_factors(pair: GearPair, standard: DynamicFactor, contact: HeldContact) -> SharingFactors:
    """Of the loaded contact: K_Hbeta of its line load, K_Halpha with the base pitch deviation of the quality grade.

    K_Fbeta follows by ISO 6336-1:2006, 7.3; K_Falpha is K_Halpha (clause 8.3.2), each within the limit at which one
    pair carries the whole load.
    """
    over_face = contact.cycle.face_load_factor
    over_pairs = contact.transverse_load_factor(1e-6 * standard.f_pb_eff)
    flank_limit, root_limit = transverse_limits(pair)
    return SharingFactors(
        K_Fbeta=root_face_load_factor(pair, over_face),
        K_Falpha=min(over_pairs, root_limit),
        K_Hbeta=over_face,
        K_Halpha=min(over_pairs, flank_limit),
        basis=COMPUTED,
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
