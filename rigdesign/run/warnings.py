"""Warnings of the run: what left its range, what an audit says, each once."""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import accumulate, pairwise

import numpy as np
from numpy.typing import NDArray

from dynamics.rotor.torsional_modes import modes_above_samples, sampling_audit
from dynamics.tooth.mesh_laws import reach_beyond
from dynamics.vibration.march_inputs import FADE
from dynamics.vibration.response_curve import CurvePoint
from rigdesign.base.units import show
from rigdesign.case.model import Case
from rigdesign.case.rules.elastic_shafts import sideways_keys
from rigdesign.case.usual import stated_numbers
from rigdesign.checks.assumptions import depends, influences_of
from rigdesign.checks.law_ranges import out_of_range
from rigdesign.checks.omissions import thrust
from rigdesign.coupling.flank_heat import film_of_oil, rim_surfaces
from rigdesign.coupling.housing_context import GEAR_OIL
from rigdesign.coupling.located_loss import PlacedLoss
from rigdesign.coupling.loop_over_speed import band_limits
from rigdesign.coupling.mesh_models import laws_of
from rigdesign.coupling.preloaded_loop import averaged_gears, lines_left_out, loads_left_out
from rigdesign.coupling.temperatures import HousingField, printed_films
from rigdesign.postprocessing.curves import iso_factor, own_ratio, resolved
from rigdesign.postprocessing.nearest_resonance import LIGHTLY, REMEDY, light_dwells
from rigdesign.postprocessing.solved_rig import SolvedRig
from rigdesign.results.check import Check, Finding
from rigdesign.results.units import RPM
from rigdesign.rig.model import Rig
from rigdesign.rig.oil_supply import ChamberOil, bearing_oil, gear_oil
from rigdesign.run.mesh_convergence import missing_load_errors
from thermal.conditions.boundary import Film, Radiation
from thermal.conduction.setup import assumed_difference, audit_conditions, radiation_too_small

LOOSE_RESIDUAL = 1e-4
"""Relative residual of a harmonic balance from which the point is named."""


def warnings_of(solved: SolvedRig, losses: Mapping[str, Sequence[PlacedLoss]]) -> list[Finding]:
    """All warnings of the run in a fixed order; ``losses`` by stage."""
    found = [
        *(Finding(id="gear", text=text) for text in _gears(solved)),
        *(Finding(id="iso_6336_1", text=text) for text in _iso(solved)),
        *(Finding(id="shaft", text=t.finding) for t in solved.rig.shaft_torsions if t.finding),
        *(Finding(id="fidelity", text=text) for text in _only_for_bending(solved)),
        *(Finding(id="response", text=text) for text in _response(solved)),
        *(Finding(id="damping", text=text) for text in _light_dwells(solved)),
        *(Finding(id="tooth_deviations", text=text) for text in _deviating_teeth(solved)),
        *(Finding(id="time_run", text=text) for text in _time_run(solved)),
        *(Finding(id="time_run", text=text) for text in fast_ramps(solved)),
        *out_of_range(solved, losses),
        *(Finding(id="rival_law", text=text) for text in _rival_laws(solved)),
        *(Finding(id="oil_circuit", text=text) for text in _circuits(solved)),
        *(Finding(id="rig_heat", text=text) for text in _rig_heat(solved)),
        *(Finding(id="damping", text=text) for text in _damping(solved)),
        *(Finding(id="sampling", text=text) for text in _sampling(solved)),
        *(Finding(id="load_error", text=text) for text in _load_errors(solved)),
        *(Finding(id="not_steady", text=text) for text in _warming(solved)),
        *(Finding(id="heat_audit", text=text) for text in heat_audits(solved)),
    ]
    return list(dict.fromkeys(found))


def without_effect(case: Case, checks: Sequence[Check]) -> list[Finding]:
    """Numbers that the case states and no check depends on, those of like parts together."""
    idle: dict[str, None] = {}
    for path in stated_numbers(case):
        if influences_of(case, path) == () and not any(depends(case, check, path) for check in checks):
            idle[re.sub(r"^(gearboxes\.\w+\.\w+)\.\w+(?=\.)", r"\1.*", path)] = None
    text = f"no check of this case depends on {', '.join(idle)}"
    return [Finding(id="without_effect", text=text)] if idle else []


def _gears(solved: SolvedRig) -> Iterator[str]:
    for point in solved.points:
        for model in point.last.models:
            for text in solved.rig.pairs[model.name].warnings:
                yield f"{model.name}, as drawn: {text}"
            for text in model.pair.warnings:
                yield f"{model.name}, hot, stage {point.point.stage}: {text}"
            for text in model.stiffness.warnings:
                yield f"{model.name}: {text}"
        if point.last.response is not None:
            wave = point.last.response.wave
            for model, approach, torque in zip(point.last.models, wave.approach, wave.torque):
                by_body = model.whole.body_compliance / model.law.base_radius_1 * torque
                if text := reach_beyond(model.law, approach - by_body):
                    yield f"{model.name}, stage {point.point.stage}: {text}"


def _iso(solved: SolvedRig) -> Iterator[str]:
    for point in solved.points:
        for model in point.last.models:
            box, mesh = solved.rig.mesh(model.name)
            speed = solved.rig.shaft_speed(box.gears[box.meshes[mesh].pinion].shaft, point.point.speed)
            torque = point.last.coupling_state.mesh_torque[model.name]
            for text in iso_factor(solved.rig, model.name, torque, speed).warnings:
                yield f"{model.name}: {text}"


def _response(solved: SolvedRig) -> Iterator[str]:
    """Speeds without a periodic response, states that converged loosely, curves too coarse for resonances."""
    if solved.run is None or solved.loads is None:
        return
    for found in next(iter(solved.loads.meshes.values())).unsolved:
        yield (
            f"curve {found.curve}: no periodic response at {found.speed * RPM:.0f} rpm ({found.reason}): a "
            "resonance or loss of contact there is not seen; look at the time run at this speed"
        )
    for where, points in _states(solved).items():
        loose = [p for p in points if p.method == "harmonic_balance" and p.residual > LOOSE_RESIDUAL]
        if loose:
            worst = max(loose, key=lambda point: point.residual)
            yield (
                f"{where}: {len(loose)} of {len(points)} periodic states converged to more than {LOOSE_RESIDUAL:.0e}, "
                f"the worst to {worst.residual:.1e} at {worst.speed * RPM:.0f} rpm: compare with the time run there"
            )
    if not resolved(solved.rig):
        speeds = solved.run.curves.response.speeds
        yield (
            f"K_V over speed: {len(speeds)} speeds, {np.diff(speeds).max() * RPM:.0f} rpm apart, do not resolve "
            "narrow resonances; use standard fidelity and response_period = mesh before a verdict depends on them"
        )


def _deviating_teeth(solved: SolvedRig) -> Iterator[str]:
    """What single teeth and alternating torques add beyond the period of the periodic response."""
    rig = solved.rig
    if rig.case.drivetrain is None or not solved.points:
        return
    laws = laws_of(solved.points[-1].last.models)
    missing = [f"{gear}: its teeth differ" for gear in averaged_gears(rig, laws)]
    missing += [
        f"{name}: its torque alternates" for name in loads_left_out(rig, laws, solved.points[-1].last.system)
    ]
    for what in missing:
        yield (
            f"{what}, which a response over response_period = {rig.case.numerics.response_period} does not show: "
            "K_V and root stress leave it out, the time run has it; write response_period = hunting_cycle"
        )


def _states(solved: SolvedRig) -> dict[str, list[CurvePoint]]:
    """Periodic states by where they belong: a curve or a held stage."""
    assert solved.run is not None
    curves = solved.run.curves
    found = {f"curve {name}": list(curve.points) for name, (_, curve) in curves.named.items()}
    for point in solved.points:
        if point.last.response is not None:
            found[f"stage {point.point.stage}"] = [point.last.response]
    return found


def _time_run(solved: SolvedRig) -> Iterator[str]:
    if solved.run is not None:
        yield from solved.run.ramp.warnings


def _circuits(solved: SolvedRig) -> Iterator[str]:
    """Oil circuits with a heater or cooler at its limit, or oil outside of its data, at the held stages."""
    said: dict[str, str] = {}
    for balance in solved.balances:
        for found in balance.circuits.values():
            for text in found.warnings:
                said.setdefault(text, f"stage {balance.cooling.stage}: {text}")
    yield from said.values()


def _rig_heat(solved: SolvedRig) -> Iterator[str]:
    """Couplings outside of the range of their law, a room not as warm as the case states, at the held stages."""
    for balance in solved.balances:
        yield from (f"stage {balance.heat.stage}: {text}" for text in balance.heat.warnings)


def oil_at_room_temperature(rig: Rig) -> Iterator[str]:
    """Every oil as the rig starts: at the temperature of the room."""
    room = rig.case.ambient.temperature
    for name in rig.case.gearboxes:
        for kind, oil in (("gear_oil", gear_oil(rig, name)), ("bearing_oil", bearing_oil(rig, name))):
            yield from (
                f"{name}.{kind}, start at the temperature of the room: {text}" for text in oil.warnings(room)
            )


def _warming(solved: SolvedRig) -> Iterator[str]:
    time = solved.case.ambient.warming_time
    if time is not None:
        yield (
            f"ambient.warming_time = {show(time, 'time')}: temperatures and clearances are those of a rig that still "
            "warms up; leave it out for the steady state that the limits are meant for"
        )


def _damping(solved: SolvedRig) -> Iterator[str]:
    if solved.loads is not None:
        yield from (record.warning for record in solved.loads.damping if record.warning)


def _load_errors(solved: SolvedRig) -> Iterator[str]:
    missing = missing_load_errors(solved)
    if missing:
        yield (
            f"{', '.join(missing)}: the error of slices and shaft elements is not known, since a rig with half of them "
            "finds no periodic response there; state more slices or shorter elements and compare"
        )


def _sampling(solved: SolvedRig) -> Iterator[str]:
    if solved.case.drivetrain is not None:
        speed = solved.rig.drive_speed(solved.test.point.speed)
        audits = sampling_audit(solved.rig.drivetrain, speed, solved.case.numerics.sample_rate)
        yield from (audit.warning for audit in audits if audit.warning)
        modes = () if solved.loads is None else solved.loads.modes
        yield from (
            f"mode of {mode.frequency:.0f} Hz ({mode.name}): damping ratio = {mode.damping_ratio:.3g}, limit 0: it is "
            f"unstable at stage {solved.test.point.stage}, the shaft whirls; load its bearings more or change them"
            for mode in modes
            if mode.damping_ratio < -1e-6
        )
        yield from modes_above_samples(modes, solved.case.numerics.sample_rate)


def _left_out_of_the_shafts(solved: SolvedRig) -> Iterator[str]:
    if solved.rig.shaft_model == "torsional":
        yield "bending and tilting of shafts: they only twist, journal stiffness does not enter the loads"
        yield "static position of the journals in their films: axes run through the middle of the hot bores"
        return
    yield from _left_out_once_a_turn(solved)
    yield (
        "moments of a load that wanders over the face in motion: the dynamic tooth force acts at mid-face along the "
        "line of action; the mean tilt of the axes is in the gap of the flanks"
    )


def _rival_laws(solved: SolvedRig) -> Iterator[str]:
    """Losses whose laws differ, with the check of temperature that moves most."""
    for spread in solved.law_spreads:
        kelvin = {id_: change for id_, change in spread.changes.items() if id_.startswith("temperature.")}
        most = max(kelvin, key=lambda id_: kelvin[id_], default=None)
        moved = "no temperature: the oil is held"
        if most is not None and kelvin[most] >= 0.05:
            moved = f"{most} by {kelvin[most]:.2g} K, in the error of that check and of others"
        yield f"{spread.cause} moves {moved}; measure the no-load torque"


def _only_for_bending(solved: SolvedRig) -> Iterator[str]:
    """Keys of the case that shafts which only twist do not read."""
    keys = sideways_keys(solved.case) if solved.rig.shaft_model == "torsional" else []
    if keys:
        yield f"{', '.join(keys)}: without effect in this run, whose shafts only twist"


def _light_dwells(solved: SolvedRig) -> Iterator[str]:
    """Dwells on resonances whose damping no rig of steel has."""
    if solved.loads is not None:
        for found in light_dwells(solved.rig, solved.loads.loop_crossings, LIGHTLY):
            yield f"{found.text(LIGHTLY)}, typical of steel shafts with joints: {REMEDY}"


def _left_out_once_a_turn(solved: SolvedRig) -> Iterator[str]:
    """Once-per-revolution loads of bending shafts that are not in every result."""
    if solved.run is not None:
        last = solved.points[-1].last
        lines = lines_left_out(solved.rig, laws_of(last.models), last.system)
        if lines:
            yield (
                f"unbalance, bow and run-out of {', '.join(lines)} in the periodic response (K_V over speed, dynamic "
                "torques and root stress, contact loss): it has the period of the mesh; the time run, the events "
                'and the lateral vibration include them; write numerics.response_period = "revolution" to include them'
            )
    if solved.rig.elastic.rig.misalignments:
        yield (
            "alternating forces of misaligned couplings: their constant force is in the bearing loads; alternating "
            "orders are those of couplings.*.excitation and of cross joints"
        )


def not_modelled(solved: SolvedRig) -> list[str]:
    """Effects not modelled."""
    items = [
        *_left_out_of_the_shafts(solved),
        "helix slope deviations of manufacture in tooth contact and K_Hbeta"
        if solved.rig.mesh_stiffness == "influence_numbers"
        else "gear body and web flexibility beyond the tooth, coupling of neighbouring tooth slices",
        "temperature over time: steady states at the held stages only",
        "oil flow distribution and aeration: films are given by surface, those of a bath by its level at rest",
        "roughness of the tooth roots: Y_RrelT is 1, as for the test gears behind sigma_FE",
    ]
    without = [name for name, box in solved.case.gearboxes.items() if box.housing is None]
    if without:
        items.append(
            f"housing of {', '.join(without)}: gears at the temperature of their oil outlet, all losses into the oil"
        )
    if not solved.case.rig_heat.machines:
        items.append(
            "heat and input power of motor, drive and transmission gearbox: rig_heat.machines names none"
        )
    if solved.run is None:
        items.append("dynamic loads: the losses are given")
    elif len(solved.rig.pairs) > 1:
        items.append(
            "angle at which the gears are put on their shafts: the meshes start in the phase that "
            "gearboxes.*.meshes.*.phase states; K_V near resonances in which both gearboxes take part depends on it"
        )
    for name, box in solved.case.gearboxes.items():
        if any(mesh.double_helical and mesh.sharing == 1 for mesh in box.meshes.values()):
            bodies = [gear for gear, part in box.gears.items() if part.inertia is None]
            whole = f"; inertia and weight of {', '.join(bodies)} are those of one half" if bodies else ""
            items.append(
                f"{name}: one half of the double-helical gears carries the whole torque in the model, as in P2{whole}"
            )
        elif any(mesh.double_helical for mesh in box.meshes.values()):
            items.append(
                f"{name}: unequal shares of the halves of the double-helical gears: each carries half"
            )
        single = [name for name, mesh in box.meshes.items() if mesh.helix_angle and not mesh.double_helical]
        if single:
            journals = [
                part for part, bearing in box.bearings.items() if bearing.has_film and bearing.locating
            ]
            if thrust(solved, name, box):
                items.append(
                    f"{name}: axial force of {', '.join(single)} and its tilting moment on the bearings"
                )
            elif journals:
                faces = ", ".join(journals)
                items.append(f"{name}: axial force of {', '.join(single)} on the thrust faces of {faces}")
    return items


# Ramps that pass a resonance faster than the time run updates the bearing positions.
#
# From one speed band to the next the time run changes the mean position of the gears in their bearings, hence the
# approach of their flanks, over the time `FADE` (`dynamics.vibration.march_inputs`). A band that is passed in less is
# left before the change is complete.

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class PassedBand:
    """A band of speed that was entered at one end and left at the other.

    low, high : speeds of the first pinion [rad/s]; start, duration : in the run [s]
    """

    low: float
    high: float
    start: float
    duration: float


def fast_ramps(solved: SolvedRig) -> Iterator[str]:
    """Of every stage the band with a resonance that it passes fastest, where that takes less than `FADE`."""
    if solved.run is None or solved.loads is None:
        return
    rig, ramp = solved.rig, solved.run.ramp
    stages = rig.case.schedule.resolved()
    limits = band_limits(rig, (0.0, max(stage.speed_end for stage in stages)))
    resonances = [
        (one.speed / own_ratio(rig, mesh), rig.mesh_labels[name])
        for mesh, name in enumerate(rig.mesh_names)
        for one in solved.loads.meshes[rig.mesh_labels[name]].resonances
    ]
    ends = list(accumulate(stage.duration for stage in stages))
    worst: dict[int, tuple[PassedBand, float, str]] = {}
    for band in passed_bands(ramp.time, ramp.speed, limits):
        inside = [one for one in resonances if band.low < one[0] < band.high]
        if inside and band.duration < FADE:
            at = min(int(np.searchsorted(ends, band.start, "right")), len(stages) - 1)
            if at not in worst or band.duration < worst[at][0].duration:
                worst[at] = band, *min(inside)
    for number, (band, speed, mesh) in worst.items():
        stage = stages[number]
        longer = stage.duration * FADE / band.duration
        yield (
            f"stage {stage.name}: time in the band of {band.low * RPM:.0f} to {band.high * RPM:.0f} rpm with the "
            f"resonance of {mesh} at {speed * RPM:.0f} rpm = {band.duration:.3g} s, limit {FADE:g} s, in which the "
            "time run updates the bearing positions: its torques there lie between those of two bands; give the stage "
            f"{longer:.2g} s or more, or use the periodic response"
        )


def passed_bands(time: Array, speed: Array, limits: Sequence[float]) -> Iterator[PassedBand]:
    """Bands between two limits [rad/s] that a run passes from end to end, in the order in which it does.

    time, speed : (n,) of the samples [s], [rad/s]
    """
    band = np.searchsorted(limits, speed)
    first = np.flatnonzero(np.diff(band, prepend=-1))
    for here, after in pairwise(first[1:]):
        number = int(band[here])
        if 0 < number < len(limits) and (band[here - 1] - number) * (band[after] - number) < 0:
            yield PassedBand(
                low=limits[number - 1],
                high=limits[number],
                start=float(time[here]),
                duration=float(time[after] - time[here]),
            )


# Audits of the temperature fields: heat that cannot be, films taken at another difference, radiation counted twice.

FILM_FACTOR = 3.0
"""Between a given film on the rim of a gear and the one its oil makes, from which it is named."""


def heat_audits(solved: SolvedRig) -> Iterator[str]:
    """Heat that cannot be, films taken at another temperature difference, radiation counted twice."""
    for field in _fields(solved):
        found = (
            *audit_conditions(field.conditions),
            *_radiation_bound(field),
            *_assumed_differences(solved, field),
            *thin_rim_films(solved, field),
        )
        yield from (f"{field.gearbox}: {text}" for text in found)


def _radiation_bound(field: HousingField) -> Iterator[str]:
    rows = {(row.surface, row.kind): row for row in field.solution.balance.rows}
    films = {c.surface: c for c in field.conditions if isinstance(c, Film)}
    for condition in field.conditions:
        if not isinstance(condition, Radiation) or condition.surface not in films:
            continue
        film, own = films[condition.surface], rows[(condition.surface, condition.kind)]
        convection = rows[(film.surface, film.kind)]
        if convection.coefficient is None or condition.surroundings_temperature != film.fluid_temperature:
            continue
        text = radiation_too_small(
            condition.surface,
            convection=-convection.power,
            radiation=-own.power,
            emissivity=condition.emissivity,
            film=convection.coefficient.value,
            ambient=film.fluid_temperature,
        )
        if text is not None:
            yield text


def _assumed_differences(solved: SolvedRig, field: HousingField) -> Iterator[str]:
    rows = {(row.surface, row.kind): row for row in field.solution.balance.rows}
    films = {c.surface: c for c in field.conditions if isinstance(c, Film)}
    for surface, taken in printed_films(solved.rig, field.gearbox):
        film = films[surface]
        text = assumed_difference(
            surface,
            assumed=taken.temperature_difference,
            solved=rows[(surface, film.kind)].mean_temperature - film.fluid_temperature,
            law=taken.film_law(),
            fluid_temperature=film.fluid_temperature,
        )
        if text is not None:
            yield text


def thin_rim_films(solved: SolvedRig, field: HousingField) -> Iterator[str]:
    """Gears whose friction heat is split by assumption under a given film far from the one their jets make."""
    name, rig = field.gearbox, solved.rig
    box = rig.case.gearboxes[name]
    result = next(p for p in solved.points if p.last.fields.get(name) is field)
    point, state = result.point, result.last.coupling_state
    chamber = ChamberOil.of(name, state.oil_outlet, state.oil_supply)
    if box.heat_split.rule != "assumed" or point.speed == 0.0:
        return
    rows = {row.surface: row for row in field.solution.balance.rows if row.kind == GEAR_OIL}
    for gear, rim in rim_surfaces(box).items():
        row = rows.get(rim)
        if row is None or row.coefficient is None:
            continue
        given = row.coefficient.value
        made = film_of_oil(rig, name, gear, point, wall=row.mean_temperature, chamber=chamber)
        if not given * FILM_FACTOR >= made >= given / FILM_FACTOR:
            yield (
                f"{gear}: film on its rim = {given:.0f} W/(m2 K) with mesh_into_gears = "
                f"{box.heat_split.mesh_into_gears:g}, its oil makes {made:.0f} W/(m2 K) (fling-off): its bulk "
                f'temperature depends on the assumption; write law = "flank_film" and give no share, or ranges'
            )


def _fields(solved: SolvedRig) -> Iterable[HousingField]:
    for point in solved.points:
        yield from point.last.fields.values()
