"""Loads and cycles of the gear ratings: the one place that gives ISO 6336 its K factors.

K_Hbeta and K_Halpha are those of the loaded contact where it is computed. Elsewhere, of analytic teeth, they follow
from the case (`face_load_factor`) and ISO 6336-1. Root stress, pitting, scuffing and film take them alike.
"""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from dynamics.errors import DynamicsInputError
from dynamics.gear.pair import GearPair
from dynamics.rating import iso_rating
from dynamics.rating.flank_contact import (
    ContactFactors,
    FlankContact,
    FlankLoad,
    FlankMaterials,
    Pitting,
    face_load_factor,
    pitting,
    root_face_load_factor,
    thermal_contact,
    transverse_limits,
    transverse_load_factor,
)
from dynamics.rating.micropitting import FilmRatios, Lubricant, film_ratios
from dynamics.rating.scuffing import (
    ContactTemperature,
    FlankFilmState,
    contact_temperature,
    scuffing_safety,
    scuffing_temperature,
)
from dynamics.standards import iso_ts_6336_22_2018
from dynamics.standards.iso6336_1_2006 import DynamicFactor
from dynamics.standards.iso6336_3_2006 import LoadFactors
from rigdesign.base.part_name import MeshName
from rigdesign.base.units import ZERO_CELSIUS
from rigdesign.coupling.loop import PointResult
from rigdesign.postprocessing.curves import iso_factor
from rigdesign.postprocessing.housing import split_as_solved
from rigdesign.postprocessing.loaded_contact import HeldContact, held_contact
from rigdesign.properties.materials import Material
from rigdesign.properties.oil import Oil
from rigdesign.results.teeth import FlankRating
from rigdesign.rig.model import Rig
from rigdesign.rig.oil_supply import OilFeed, gear_feed

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


# Load capacity of the flanks at the held stages: pitting, scuffing, film over roughness, at our own temperatures.

COEFFICIENT_AT = ZERO_CELSIUS + 80.0
"""At which the pressure-viscosity coefficient of an oil is stated [K]."""
TEST_OIL = ZERO_CELSIUS + 90.0
"""Of the FZG test A/8.3/90 [K]."""
LABELLED = ZERO_CELSIUS + 40.0
"""At which ISO 6336-2 takes the viscosity [K]."""


def flank_ratings(rig: Rig, points: Sequence[PointResult], mesh: int) -> Iterator[FlankRating]:
    """Ratings of a mesh, by its number, at every held stage that turns under load."""
    by_stage = {point.point.stage: point for point in points}
    for load in rated_loads(rig, points, mesh):
        if load.torque and load.speed > 0.0:
            point = by_stage[load.stage]
            drives = point.last.coupling_state.mesh_torque[rig.mesh_names[mesh]] > 0.0
            rated = flank_load(rig, mesh, load, pinion_drives=drives)
            yield _rating(rig, point, mesh, rated, load.sharing_basis)


def _rating(rig: Rig, point: PointResult, mesh: int, load: FlankLoad, sharing_basis: str) -> FlankRating:
    name = rig.mesh_names[mesh]
    feed, (bulk, basis) = _feed(rig, point, name), bulk_temperature(rig, point, mesh)
    state = _film_state(rig, mesh, feed, bulk)
    rated, no_pitting = _pitting(rig, mesh, load, feed.oil)
    contact, films, no_contact = _over_path(FlankContact(rig.pairs[name], load), state, feed.oil)
    limit = _scuffing_limit(rig, mesh, feed.oil, state)
    safety = None if limit is None or contact is None else scuffing_safety(contact, state, limit)
    no_scuffing = no_contact
    if limit is None:
        no_scuffing = f"oil {feed.oil.name} states neither scuffing_load_stage nor scuffing_temperature"
    return FlankRating(
        stage=point.point.stage,
        factors=load.factors,
        sharing_basis=sharing_basis,
        oil_temperature=feed.inlet,
        bulk_temperature=bulk,
        bulk_basis=basis,
        pitting=rated,
        no_pitting=no_pitting,
        contact=contact,
        films=films,
        no_contact=no_contact,
        scuffing_temperature=limit,
        scuffing_safety=safety,
        no_scuffing=no_scuffing,
    )


def _materials(rig: Rig, mesh: int) -> tuple[Material, Material]:
    return rig.materials[rig.mesh_gear(mesh, 0).material], rig.materials[rig.mesh_gear(mesh, 1).material]


def _feed(rig: Rig, point: PointResult, mesh: MeshName) -> OilFeed:
    box, state = mesh.gearbox, point.last.coupling_state
    return gear_feed(rig, box, state.oil_outlet[f"{box}.gear_oil"], state.oil_supply)


def _scuffing_limit(rig: Rig, mesh: int, oil: Oil, state: FlankFilmState) -> float | None:
    """Scuffing temperature [K], as stated or from the load stage; None where neither is known."""
    stated = rig.mesh(rig.mesh_names[mesh])[0].oil
    if stated.scuffing_temperature is not None:
        return stated.scuffing_temperature
    stage = oil.scuffing_load_stage if stated.scuffing_load_stage is None else stated.scuffing_load_stage
    if stage is None:
        return None
    factor = min(material.scuffing_factor for material in _materials(rig, mesh))
    return scuffing_temperature(stage, state.oil_factor, oil.dynamic_viscosity(TEST_OIL), factor)


def bulk_temperature(rig: Rig, point: PointResult, mesh: int) -> tuple[float, str]:
    """Temperature of the teeth of a mesh, mean of both gears [K], and its basis in words.

    From the temperature field of the housing: of the teeth where a flank film gives it, else of the gear bodies.
    Without a housing nothing is solved: ISO/TS 6336-22, from the loss of the mesh.
    """
    name = rig.mesh_names[mesh]
    state, field = point.last.coupling_state, point.last.fields.get(name.gearbox)
    if field is None:
        return _standard_bulk(rig, point, name), "ISO/TS 6336-22, no housing"
    splits = split_as_solved(rig, point, field)
    found = []
    of_teeth = True
    for gear in rig.mesh_gears(name):
        split = splits.get(gear.part)
        tooth = None if split is None else split.tooth
        of_teeth &= tooth is not None
        found.append(state.gear_temperature[gear] if tooth is None else tooth)
    return math.fsum(
        found
    ) / 2.0, "teeth of the temperature field" if of_teeth else "gears of the temperature field"


def _standard_bulk(rig: Rig, point: PointResult, name: MeshName) -> float:
    box, pair = rig.case.gearboxes[name.gearbox], rig.pairs[name]
    loss = math.fsum(
        placed.loss.power
        for placed in point.last.losses
        if (placed.gearbox, placed.part, placed.loss.kind) == (name.gearbox, name.part, "mesh")
    )
    width = box.meshes[name.part].sharing * pair.face_width
    inlet = _feed(rig, point, name).inlet
    supply = box.oil.scuffing_supply
    warm = iso_ts_6336_22_2018.theta_M(
        inlet - ZERO_CELSIUS, 1e-3 * loss, 1e6 * pair.centre_distance * width, supply
    )
    return warm + ZERO_CELSIUS


def _film_state(rig: Rig, mesh: int, feed: OilFeed, bulk: float) -> FlankFilmState:
    factor = rig.case.losses.friction.lubricant_factor
    first, second = (
        thermal_contact(material.conductivity, material.density, material.heat_capacity)
        for material in _materials(rig, mesh)
    )
    return FlankFilmState(
        oil_temperature=feed.inlet,
        bulk_temperature=bulk,
        viscosity=feed.oil.dynamic_viscosity(feed.inlet),
        oil_factor=feed.oil.lubricant_factor if factor is None else factor,
        roughness=0.5 * math.fsum(rig.mesh_gear(mesh, index).flank_roughness for index in (0, 1)),
        thermal_contact=(first, second),
    )


def _pitting(rig: Rig, mesh: int, load: FlankLoad, oil: Oil) -> tuple[tuple[Pitting, Pitting] | None, str]:
    """Pitting of both gears, or why there is none."""
    first, second = _materials(rig, mesh)
    if first.flank_strength is None or second.flank_strength is None:
        soft = first if first.flank_strength is None else second
        return None, f"material {soft.title} has no flank strength"
    materials = FlankMaterials(
        strengths=(first.flank_strength, second.flank_strength),
        treatments=(first.treatment, second.treatment),
        cycles=(rated_cycles(rig, mesh, 0), rated_cycles(rig, mesh, 1)),
        roughness=(rig.mesh_gear(mesh, 0).flank_roughness, rig.mesh_gear(mesh, 1).flank_roughness),
    )
    return pitting(rig.pairs[rig.mesh_names[mesh]], load, materials, oil.kinematic_viscosity(LABELLED)), ""


def _over_path(
    contact: FlankContact, state: FlankFilmState, oil: Oil
) -> tuple[ContactTemperature | None, FilmRatios | None, str]:
    """Contact temperature and film, or why the document does not give them."""
    lubricant = Lubricant.known_at(oil.dynamic_viscosity, oil.pressure_viscosity, COEFFICIENT_AT)
    try:
        return contact_temperature(contact, state), film_ratios(contact, state, lubricant), ""
    except DynamicsInputError as error:
        return None, None, str(error)
