"""Clearances and alignment of a warm gearbox: seals, shafts, meshes, bearings, bores, axes, couplings."""

import math
from collections.abc import Iterable, Iterator

from dynamics.rotor.rolling_state import RollingState, rolling_state
from rigdesign.coupling.alignment import (
    axial_closing,
    axis_deviation,
    clearance_share,
    coupled_ends,
    coupling_places,
    held_clearance,
)
from rigdesign.coupling.expansion import axes_of, bearing_expansion
from rigdesign.coupling.loop import PointResult
from rigdesign.results.lateral import RollingBearingRecord
from rigdesign.results.units import HOUR
from rigdesign.results.warm_gearbox import (
    AxisAlignment,
    BearingClearance,
    BoreAlignment,
    CouplingAlignment,
    MeshClearance,
    SealClearance,
    ShaftOffset,
    WarmGearbox,
    WarmShaft,
)
from rigdesign.rig.model import Rig
from thermal.expansion.alignment import ShaftPair
from thermal.expansion.expansion import Expansion


def warm_gearbox(rig: Rig, result: PointResult, name: str) -> WarmGearbox:
    """Gearbox ``name`` with its expanded housing at one held stage."""
    shape = result.last.expansion[name].deformed
    return WarmGearbox(
        gearbox=name,
        stage=result.point.stage,
        seals=tuple(_seals(rig, name, shape)),
        shafts=tuple(_shafts(rig, name, shape)),
        meshes=tuple(_meshes(rig, result, name, shape)),
        bearings=tuple(_bearings(rig, result, name, shape)),
        bores=tuple(bore_alignments(rig, result, name, shape)),
        axes=tuple(axis_alignments(rig, name, shape)),
        couplings=tuple(coupling_alignments(rig, result, name)),
    )


def _seals(rig: Rig, name: str, shape: Expansion) -> Iterator[SealClearance]:
    shafts = {station.name: station.shaft for station in rig.models[name].seals}
    for seal in shape.seals.values():
        yield SealClearance(
            name=seal.name,
            shaft=shafts[seal.name],
            as_drawn=seal.undeformed_gap,
            minimum=seal.minimum,
            mean=seal.mean,
            angle_of_minimum=seal.angle_of_minimum,
            by_hand=seal.gap_by_hand,
            axial_shift=seal.axial_shift,
            angles=tuple(map(float, seal.angles)),
            gaps=tuple(map(float, seal.gap)),
        )


def _shafts(rig: Rig, name: str, shape: Expansion) -> Iterator[WarmShaft]:
    bearings = rig.case.gearboxes[name].bearings.values()
    for shaft in shape.shafts.values():
        play = next((b.axial_play for b in bearings if b.shaft == shaft.name and b.locating), 0.0)
        yield WarmShaft(
            name=shaft.name,
            front=shaft.start,
            rear=shaft.end,
            free=shaft.start_by_hand + shaft.end_by_hand,
            play_as_drawn=play,
            play=play - shaft.axial_play_change,
        )


def _meshes(rig: Rig, result: PointResult, name: str, shape: Expansion) -> Iterator[MeshClearance]:
    box, temperature = rig.case.gearboxes[name], result.last.coupling_state.gear_temperature
    for model in result.last.models:
        if model.name.gearbox != name:
            continue
        entry = box.meshes[model.name.part]
        drawn, warm = rig.pairs[model.name], model.pair
        axes = axes_of(rig, name, shape, (box.gears[entry.pinion].shaft, box.gears[entry.wheel].shaft))
        pinion, wheel = rig.mesh_gears(model.name)
        yield MeshClearance(
            name=model.name,
            centre_distance_as_drawn=drawn.centre_distance,
            centre_distance=warm.centre_distance,
            backlash_as_drawn=drawn.transverse_backlash,
            backlash=warm.transverse_backlash,
            tip_clearance_as_drawn=min(drawn.tip_clearances),
            tip_clearance=min(warm.tip_clearances),
            inclination=axes.inclination,
            skew=axes.skew,
            bulk_temperatures=(temperature[pinion], temperature[wheel]),
        )


def _bearings(rig: Rig, result: PointResult, name: str, shape: Expansion) -> Iterator[BearingClearance]:
    for part, entry in rig.case.gearboxes[name].bearings.items():
        full = f"{name}.{part}"
        film = result.last.bearings[full]
        yield BearingClearance(
            name=full,
            clearance_as_drawn=entry.drawn_clearance,
            clearance=result.last.coupling_state.bearing_clearance[full],
            bore_ovality=bearing_expansion(rig, name, shape, entry).bore_ovality,
            minimum_film=film.minimum_film,
            film_temperature=film.film_temperature,
            specific_load=film.specific_load,
            transition_speed=film.transition_speed,
        )


def bore_alignments(rig: Rig, result: PointResult, name: str, shape: Expansion) -> Iterator[BoreAlignment]:
    """Tilt of every shaft in its bores and how far these are out of round."""
    for part, entry in rig.case.gearboxes[name].bearings.items():
        full = f"{name}.{part}"
        expansion = bearing_expansion(rig, name, shape, entry)
        found = expansion.bore_roundness
        clearance = held_clearance(entry, result.last.coupling_state.bearing_clearance[full])
        yield BoreAlignment(
            bearing=full,
            tilt=expansion.tilt,
            tilt_lateral=expansion.misalignment[0],
            tilt_vertical=expansion.misalignment[1],
            width=entry.width,
            out_of_round=found.peak_to_valley,
            second_harmonic=found.second_harmonic,
            long_axis=found.long_axis,
            out_of_round_share=clearance_share(found.peak_to_valley, clearance),
        )


def axis_alignments(rig: Rig, name: str, shape: Expansion) -> Iterator[AxisAlignment]:
    """Deviation of the axes of every mesh over its face width, with what is recommended for its gears."""
    box = rig.case.gearboxes[name]
    for own, mesh in box.meshes.items():
        found = axis_deviation(rig, name, own, shape)
        axes = axes_of(rig, name, shape, (box.gears[mesh.pinion].shaft, box.gears[mesh.wheel].shaft))
        yield AxisAlignment(
            mesh=f"{name}.{own}",
            centre_distance_change=axes.change,
            face_width=found.face_width,
            inclination=found.inclination,
            recommended_inclination=found.recommended_inclination,
            skew=found.skew,
            recommended_skew=found.recommended_skew,
        )


def coupling_alignments(rig: Rig, result: PointResult, name: str) -> Iterator[CouplingAlignment]:
    """Alignment of every coupling that gearbox ``name`` answers for, as set and warm."""
    shapes = {box: expansion.deformed for box, expansion in result.last.expansion.items()}
    axes = {box: shape.axes for box, shape in shapes.items()}
    for place in (place for place in coupling_places(rig) if place.gearbox == name):
        yield CouplingAlignment(
            coupling=place.name,
            first=place.first.shaft,
            second=place.second.shaft,
            housed=(place.first.gearbox is not None, place.second.gearbox is not None),
            as_set=_offset(coupled_ends(place, {})),
            warm=_offset(coupled_ends(place, axes)),
            ends_nearer=axial_closing(place, shapes),
        )


def _offset(ends: ShaftPair) -> ShaftOffset:
    lateral, vertical = ends.offset
    return ShaftOffset(lateral=lateral, vertical=vertical, radial_offset=ends.radial_offset, angle=ends.bend)


# Records of the rolling bearings of solved points.


def rolling_states(points: Iterable[PointResult]) -> Iterator[tuple[PointResult, str, RollingState]]:
    """(point, bearing, state) of every rolling bearing at every held stage."""
    for point in points:
        for name, bearing in point.last.bearings.items():
            state = rolling_state(bearing)
            if state is not None:
                yield point, name, state


def rolling_bearings(rig: Rig, points: Iterable[PointResult]) -> Iterator[RollingBearingRecord]:
    """Every rolling bearing at every held stage."""
    for point, name, state in rolling_states(points):
        friction, life = state.friction, state.life
        yield RollingBearingRecord(
            bearing=name,
            stage=point.point.stage,
            designation=rig.bearing(name).label,
            radial_load=state.load,
            axial_load=state.axial_load,
            speed=state.omega,
            rolling_torque=friction.rolling,
            sliding_torque=friction.sliding,
            seal_torque=friction.seals,
            drag_torque=friction.drag,
            friction=state.power,
            temperature=state.film_temperature,
            inner_ring=state.inner_ring_temperature,
            outer_ring=state.outer_ring_temperature,
            heat_to_shaft=state.heat_to_shaft,
            heat_to_housing=state.heat_to_housing,
            operating_clearance=point.last.coupling_state.bearing_clearance[name],
            basic_life=_finite(HOUR * life.basic_life),
            modified_life=_finite(HOUR * life.modified_life),
            static_safety=_finite(life.static_safety),
            viscosity_ratio=life.viscosity_ratio,
            speed_utilisation=state.speed_utilisation,
            minimum_load=state.minimum_load,
            radial_stiffness=state.stiffness.radial,
            axial_stiffness=state.stiffness.axial,
            tilting_stiffness=state.stiffness.tilting,
        )


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
