"""What the value of a check leaves out although the case or the run knows of it: one table for all checks.

A held check with an omission is at best a warning that names it, unless the size of the omission is known and below
the margin (`rules.with_omissions`). What stands here depends on the case: a part that it states and no model follows,
an effect that another part of the run computes and the value does not count, a search with gaps. Simplifications that
all rigs share are listed in the report (`run.warnings.not_modelled`); contributions that could only add to the
margin, as the heat that a housing would take from the cooler, are none.
"""

import math
from collections.abc import Callable, Iterator
from fnmatch import fnmatchcase

import numpy as np

from rigdesign.base.units import show
from rigdesign.case.gearbox import Gearbox
from rigdesign.checks.assumptions import key_of
from rigdesign.checks.dynamics import near_crossings
from rigdesign.checks.rules import Omission
from rigdesign.coupling.loads import laws_of
from rigdesign.coupling.shaft_torques import torques_left_out
from rigdesign.coupling.time_run import schedule_of
from rigdesign.coupling.tooth_deviations import averaged_gears
from rigdesign.records.curves import resolved
from rigdesign.records.resonances import NEAR
from rigdesign.records.solved_rig import SolvedRig
from rigdesign.results.result import Check
from rigdesign.rig.oil_supply import injected_flow

Found = Iterator[Omission]
Finder = Callable[[SolvedRig, Check], Found]
RPM = 30.0 / math.pi


def omissions(solved: SolvedRig, check: Check) -> tuple[Omission, ...]:
    """What the value of a check leaves out, in the order of the table."""
    if check.margin is None:
        return ()
    key = key_of(solved.case, check)
    found = (
        omission
        for patterns, finder in OMISSIONS
        if any(fnmatchcase(key, pattern) for pattern in patterns)
        for omission in finder(solved, check)
    )
    return tuple(dict.fromkeys(found))


def _of_boxes(text: str, applies: Callable[[SolvedRig, str, Gearbox], bool]) -> Finder:
    """One omission for every gearbox to which it applies; ``text`` holds ``{box}``, and ``{why}`` its housing is not
    expanded."""

    def finder(solved: SolvedRig, check: Check) -> Found:
        for name, box in solved.case.gearboxes.items():
            if applies(solved, name, box):
                yield Omission(text.format(box=name, why=solved.why_unexpanded(name)))

    return finder


def _bare(solved: SolvedRig, name: str, box: Gearbox) -> bool:
    """A gearbox without a housing: no temperature field."""
    return box.housing is None


def _warm(solved: SolvedRig, name: str, box: Gearbox) -> bool:
    """A gearbox without a housing whose oil is warmer than the room."""
    warmest = max(box.oil.inlet_temperature, box.bearing_oil.inlet_temperature)
    return box.housing is None and warmest > solved.case.ambient.temperature


def _exchanges(solved: SolvedRig, name: str, box: Gearbox) -> bool:
    """A gearbox without a housing that is fed oil of two temperatures."""
    return box.housing is None and box.oil.inlet_temperature != box.bearing_oil.inlet_temperature


def _unexpanded(solved: SolvedRig, name: str, box: Gearbox) -> bool:
    return name in solved.unexpanded


def _tempered(solved: SolvedRig, name: str, box: Gearbox) -> bool:
    return _bare(solved, name, box) and any(
        solved.rig.materials[gear.material].tempering_temperature is not None for gear in box.gears.values()
    )


def _teeth_at_bulk(solved: SolvedRig, name: str, box: Gearbox) -> bool:
    """A gearbox with a temperature field whose teeth have no temperature of their own."""
    return box.housing is not None and box.heat_split.rule == "assumed"


def _thrust(solved: SolvedRig, name: str, box: Gearbox) -> bool:
    """A gearbox whose gears push axially: their tilting moment loads bearings that take their load from the teeth."""
    helical = any(mesh.helix_angle and not mesh.double_helical for mesh in box.meshes.values())
    return helical and any(bearing.radial_load is None for bearing in box.bearings.values())


def _sealed(solved: SolvedRig, name: str, box: Gearbox) -> bool:
    return _unexpanded(solved, name, box) and any(seals.kind == "contactless" for seals in box.seals.values())


def _with_play(solved: SolvedRig, name: str, box: Gearbox) -> bool:
    return _unexpanded(solved, name, box) and any(b.axial_play > 0.0 for b in box.bearings.values())


def _untempered(solved: SolvedRig, check: Check) -> Found:
    """Gears whose material states no tempering temperature."""
    gears = [
        f"{name}.{gear}"
        for name, box in solved.case.gearboxes.items()
        for gear, entry in box.gears.items()
        if solved.rig.materials[entry.material].tempering_temperature is None
    ]
    if gears:
        yield Omission(f"{', '.join(gears)}: the material states no tempering_temperature")


def _coupled(solved: SolvedRig, check: Check) -> Found:
    """Ends of a coupling that stay at their cold place."""
    power = solved.case.drivetrain
    if power is None:
        return
    housed = {
        gear.shaft
        for name, box in solved.case.gearboxes.items()
        if name not in solved.unexpanded
        for gear in box.gears.values()
    }
    for shaft in power.couplings[check.id.split(".", 2)[2]].shafts:
        if shaft not in housed:
            yield Omission(f"thermal expansion behind shaft {shaft}: it stays at its cold place")


def _warming(solved: SolvedRig, check: Check) -> Found:
    """A rig that still warms up."""
    time = solved.case.ambient.warming_time
    if time is not None:
        yield Omission(f"the rest of the warm-up after ambient.warming_time = {show(time, 'time')}")


def _constant_drag(solved: SolvedRig, check: Check) -> Found:
    """With the constant drag of the bearings nothing but them and the teeth loses power."""
    if solved.case.drivetrain is not None and solved.case.losses.bearing_drag == "constant":
        yield Omission("windage, seals, oil acceleration and squeezing (losses.bearing_drag = constant)")


def _given_losses(solved: SolvedRig, check: Check) -> Found:
    """Kinds of loss of a gearbox of which the case gives none, where it gives the losses."""
    if solved.case.losses.basis != "input":
        return
    for name, box in solved.case.gearboxes.items():
        wanted = ["mesh", "bearing", "windage"]
        wanted += ["seal"] if box.seals else []
        wanted += ["oil_acceleration"] if injected_flow(box) > 0.0 else []
        given = {entry.kind for entry in solved.case.losses.given.values() if entry.gearbox == name}
        missing = [kind for kind in wanted if kind not in given]
        if missing:
            yield Omission(f"{', '.join(missing)} losses of gearbox {name}: losses.given holds none")


def _long_periods(solved: SolvedRig, check: Check) -> Found:
    """Single teeth and swinging torques that do not fit into the period of the response."""
    rig = solved.rig
    if rig.drivetrain is None or rig.system is None or not solved.points:
        return
    laws = laws_of(solved.points[-1].last.models)
    missing = [f"differences between the teeth of {gear}" for gear in averaged_gears(rig, laws)]
    missing += [f"torque swing of {name}" for name in torques_left_out(rig, laws)]
    for what in missing:
        yield Omission(f"{what} (numerics.response_period = {rig.case.numerics.response_period})")


def _gaps(solved: SolvedRig, check: Check) -> Found:
    """Resonances at speeds without a solution, and modes of the closed loop between the speeds of a coarse curve.

    A mode counts if the mesh excites it and an order meets it nearer to a held speed than the limit and what loaded
    teeth may shift it.
    """
    if solved.run is None or solved.dynamics is None:
        return
    label = check.id.split(".", 2)[2]
    if not resolved(solved.rig):
        step = np.diff(solved.run.curves.response.speeds).max() * RPM
        mesh = next(i for i in range(len(solved.rig.mesh_names)) if solved.label(i) == label)
        near = near_crossings(solved, mesh, (check.limit or 0.0) + NEAR)
        modes = ", ".join(dict.fromkeys(str(row["mode"]) for _, row in near))
        if near:
            yield Omission(
                f"narrow resonances of the loop's modes {modes} between speeds {step:.0f} rpm apart"
            )
    holes = len(solved.dynamics.gearboxes[label].unsolved)
    if holes:
        yield Omission(f"resonances at speeds without solution ({holes})")


def _tilted(solved: SolvedRig, check: Check) -> Found:
    """The tilt of a shaft in its bore, which the expansion knows and the film does not."""
    rows = [row for expansion in solved.expansion for row in expansion.bores]
    if rows:
        worst = max(rows, key=lambda row: float(row["tilt_over_width_um"]))
        size = 0.5 * float(worst["tilt_over_width_um"])
        yield Omission(
            f"tilt of the shaft in bearing {worst['bearing']}, {size:.2g} um at the edges of the film", size
        )


def _thrust_load(solved: SolvedRig, check: Check) -> Found:
    """Tilting moment of the axial force of helical gears, T tan(beta), on the two bearings of a shaft [MPa]."""
    sizes = [
        (
            abs(point.last.coupling_state.mesh_torque[full]) * math.tan(abs(mesh.helix_angle)) * ratio,
            name,
            bearing,
        )
        for point in solved.points
        for name, box in solved.case.gearboxes.items()
        if _thrust(solved, name, box)
        for own, mesh in box.meshes.items()
        if not mesh.double_helical
        for full in (f"{name}.{own}",)
        for gear, ratio in ((mesh.pinion, 1.0), (mesh.wheel, _wheel_ratio(solved, full)))
        for bearing in box.bearings.values()
        if bearing.shaft == box.gears[gear].shaft and bearing.radial_load is None
    ]
    found = [
        1e-6 * moment / (span * bearing.diameter * bearing.width)
        for moment, name, bearing in sizes
        for span in (_span(solved, name, bearing.shaft),)
        if span
    ]
    if sizes and len(found) == len(sizes):
        size = max(found)
        yield Omission(f"tilting moment of the axial force of helical gears, {size:.2g} MPa", size)
    elif sizes:
        yield Omission("tilting moment of the axial force of helical gears")


def _wheel_ratio(solved: SolvedRig, mesh: str) -> float:
    """Torque of the wheel over that of the pinion."""
    teeth = solved.rig.pairs[mesh].teeth
    return teeth[1] / teeth[0]


def _span(solved: SolvedRig, name: str, shaft: str) -> float:
    """Distance of the two bearings of a shaft [m]; zero where it is not stated."""
    bearings = solved.case.gearboxes[name].bearings.values()
    places = [b.position for b in bearings if b.shaft == shaft and b.position is not None]
    return max(places) - min(places) if len(places) > 1 else 0.0


def _saturated(solved: SolvedRig, check: Check) -> Found:
    """What the speed control asked of the motor beyond its limit: the torque of the run is less than that."""
    run, power = solved.run, solved.case.drivetrain
    if run is None or power is None:
        return
    controlled = np.array([stage.drive_torque is None for stage in solved.case.schedule.resolved()])
    stage = schedule_of(solved.rig).at(run.ramp.time).stage
    full = np.abs(run.ramp.drive_torque) >= (1.0 - 1e-9) * power.motor.torque_limit
    share = float(np.mean(full & controlled[stage]))
    if share:
        yield Omission(
            f"what the speed control asked for beyond drivetrain.motor.torque_limit, {100.0 * share:.1f} % of the run: "
            "the motor stands at its limit; raise it to see how much"
        )


EXPANSION = "thermal expansion of gearbox {box}: {why}"

OMISSIONS: tuple[tuple[tuple[str, ...], Finder], ...] = (
    (("oil.room",), _of_boxes("heat that gearbox {box} gives to the room: it has no housing", _bare)),
    (("oil.heater",), _of_boxes("heat that warm oil gives to the walls of gearbox {box}: it has no housing", _warm)),
    (
        ("oil.cooler", "temperature.oil_outlet"),
        _of_boxes("heat from the warmer oil of gearbox {box} to its colder one: it has no housing", _exchanges),
    ),
    (
        ("temperature.housing", "transient.housing_temperature"),
        _of_boxes("walls of gearbox {box}: it has no housing", _bare),
    ),
    (
        ("temperature.gear_bulk",),
        _of_boxes("friction heat in the gears of gearbox {box} above their oil outlet: it has no housing", _tempered),
    ),
    (
        ("temperature.gear_bulk",),
        _of_boxes("teeth of gearbox {box} above the mean of their gear: heat_split.mesh = assumed", _teeth_at_bulk),
    ),
    (("temperature.gear_bulk",), _untempered),
    (
        ("temperature.bearing_film", "bearing.minimum_film", "bearing.transition_speed"),
        _of_boxes("heat of shafts and shells into the films of gearbox {box}: it has no housing", _bare),
    ),
    (
        ("temperature.bearing_film", "bearing.minimum_film", "bearing.transition_speed"),
        _of_boxes("tilting moment of the axial force of the gears of gearbox {box}", _thrust),
    ),
    (("bearing.specific_load",), _thrust_load),
    (("bearing.minimum_film",), _tilted),
    (("clearance.seal_gap", "transient.seal_gap"), _of_boxes(EXPANSION, _sealed)),
    (("clearance.axial_play", "transient.axial_play"), _of_boxes(EXPANSION, _with_play)),
    (
        (
            *(f"*.{key}" for key in ("backlash", "tip_clearance", "bearing_clearance")),
            *(f"*.{key}" for key in ("bearing_tilt", "bore_out_of_round", "axis_inclination", "axis_skew")),
        ),
        _of_boxes(EXPANSION, _unexpanded),
    ),
    (("alignment.coupling_*", "transient.coupling_*"), _coupled),
    (("temperature.*", "clearance.*", "alignment.*", "bearing.*", "oil.heater", "oil.cooler", "oil.room"), _warming),
    (("temperature.*", "clearance.*", "alignment.*", "oil.cooler", "oil.room", "transient.*"), _constant_drag),
    (("temperature.*", "clearance.*", "alignment.*", "oil.cooler", "oil.room", "transient.*"), _given_losses),
    (("bought_part.temperature_maximum", "bought_part.shaft_growth"), _warming),
    (("bought_part.temperature_maximum", "bought_part.shaft_growth"), _constant_drag),
    (("bought_part.drive_torque", "bought_part.drive_power"), _constant_drag),
    (("bought_part.drive_torque", "bought_part.drive_power"), _saturated),
    (
        ("dynamics.dynamic_factor.*", "dynamics.resonance_distance.*", "specimen.root_*", "strength.root_*"),
        _long_periods,
    ),
    (("dynamics.resonance_distance.*",), _gaps),
)  # fmt: skip
"""Patterns of ids (bought parts by their quantity) -> what finds the omissions."""
