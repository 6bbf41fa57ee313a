"""Limits of bought parts: a result at the part itself, or a given value, against what its maker allows."""

from collections.abc import Callable, Iterator

from rigdesign.base.quantity_kinds import KINDS
from rigdesign.base.units import display
from rigdesign.case.component_limits import shafts_of
from rigdesign.case.limits import BoughtPart, ResultQuantity
from rigdesign.checks.rules import Rule, exact, hold, not_applicable
from rigdesign.records.solved_rig import NO_HOUSING, NO_LOADS, SolvedRig, worst
from rigdesign.results.result import Check
from rigdesign.rig.shaft_seals import shaft_seals

Found = tuple[float | None, str]
"""A result [SI] and where it occurs; None with the reason where there is none."""
EXACT = ("speed", "torque_mean", "oil_flow")
"""Inputs of the case: at the limit they are not near it but on it."""


def bought_parts(solved: SolvedRig) -> Iterator[Check]:
    """One check for each bought part of the case."""
    for name, part in solved.case.limits.bought_parts.items():
        yield _check(solved, name, part)


def _check(solved: SolvedRig, name: str, part: BoughtPart) -> Check:
    rule = Rule(
        id=f"bought_part.{name}", title=f"{part.title} ({part.part})", unit=KINDS[part.kind].display_unit,
        source=part.source, group="bought parts", limit=display(part.limit_si, part.kind),
    )  # fmt: skip
    value: float | None
    value, reason = part.given_si, "given in the case"
    if value is None:
        value, reason = RESULTS[part.quantity](solved, part.part)
    if value is None:
        return not_applicable(rule, reason)
    check = hold(rule, display(value, part.kind), reason)
    return exact(check) if part.quantity in EXACT else check


def _speed(solved: SolvedRig, part: str) -> Found:
    top = max(solved.case.schedule.resolved(), key=lambda stage: stage.speed_end)
    return worst(
        (solved.rig.shaft_speed(shaft, top.speed_end), f"shaft {shaft}, stage {top.name}")
        for shaft in shafts_of(solved.case, part)
    )


def _torque_mean(solved: SolvedRig, part: str) -> Found:
    rig = solved.rig
    top = max(solved.case.schedule.resolved(), key=lambda stage: abs(stage.torque_end))
    force = rig.torque_ratio * abs(top.torque_end) / rig.pairs[rig.control_mesh].base_radii[0]
    return worst(
        (abs(rig.mesh_forces[mesh]) * force * radius, f"{gear}, stage {top.name}")
        for mesh, gear, radius in _gears_at(solved, part)
    )


def _torque_peak(solved: SolvedRig, part: str) -> Found:
    """Highest dynamic torque of the meshes at the part, referred to the gear on its shaft."""
    if solved.dynamics is None:
        return None, NO_LOADS
    rig, found = solved.rig, solved.dynamics.gearboxes
    return worst(
        (
            found[rig.mesh_labels[mesh]].dynamic_torque_peak_Nm * radius / rig.pairs[mesh].base_radii[0],
            f"tooth force at {gear}",
        )
        for mesh, gear, radius in _gears_at(solved, part)
    )


def _gears_at(solved: SolvedRig, part: str) -> Iterator[tuple[str, str, float]]:
    """(mesh, gear, base radius) of every gear that loads a part: of a gearbox or mesh the pinions, as torques count;
    of a coupling or shaft the gears of its line."""
    rig = solved.rig
    names = part.split(".")
    whole = names[0] == "gearboxes" and (len(names) == 2 or names[2] == "meshes")
    lines = {} if rig.drivetrain is None else rig.drivetrain.lines()
    own = {lines.get(shaft) for shaft in shafts_of(solved.case, part)}
    for mesh in rig.mesh_names:
        box = rig.mesh(mesh)[0]
        if names[0] == "gearboxes" and (
            mesh.split(".")[0] != names[1] or names[2:] not in _naming(solved, mesh)
        ):
            continue
        gears = rig.mesh_gears(mesh)
        for index, gear in enumerate(gears[:1] if whole else gears):
            if (
                whole
                or part.endswith(f".gears.{gear.split('.')[1]}")
                or (names[0] == "drivetrain" and lines[box.gears[gear.split(".")[1]].shaft] in own)
            ):
                yield mesh, gear, rig.pairs[mesh].base_radii[index]


def _naming(solved: SolvedRig, mesh: str) -> list[list[str]]:
    """Ends of the paths that mean a mesh: its gearbox, itself, its two gears."""
    gears = (gear.split(".")[1] for gear in solved.rig.mesh_gears(mesh))
    return [[], ["meshes", mesh.split(".")[1]], *(["gears", gear] for gear in gears)]


def _drive_torque(solved: SolvedRig, part: str) -> Found:
    if solved.run is None:
        return None, NO_LOADS
    return float(abs(solved.run.ramp.drive_torque).max()), "time run over the schedule"


def _drive_power(solved: SolvedRig, part: str) -> Found:
    """At the speed of the motor; that of the time run is the first pinion's."""
    if solved.run is None:
        return None, NO_LOADS
    ramp, rig = solved.run.ramp, solved.rig
    ratio = rig.drive_speed(1.0) / rig.pinion_speed(1.0)
    return float(abs(ramp.drive_torque * ramp.speed * ratio).max()), "time run over the schedule"


def _actuator_force(solved: SolvedRig, part: str) -> Found:
    power = solved.case.drivetrain
    if solved.dynamics is None or power is None:
        return None, NO_LOADS
    if power.bracing.mode == "twist_held" or power.bracing.shifted_gear is None:
        return None, "the loop is braced by a twist: no gear is shifted"
    return worst(
        (row["actuator_force_N"] + row["spline_friction_N"], f"stage {row['stage']}")
        for row in solved.dynamics.bracing
    )


def _circulating_power(solved: SolvedRig, part: str) -> Found:
    """Torque times speed: the same at every place of one loop."""
    return worst(
        (abs(stage.torque_end) * stage.speed_end, f"stage {stage.name}")
        for stage in solved.case.schedule.resolved()
    )


NO_SEAL = "no shaft of the part has such a seal: none leaves its gearbox or passes a wall of its chamber"


def _seal_velocity(solved: SolvedRig, part: str) -> Found:
    """Surface speed in the largest seal of every shaft; the gap in a wall of the chamber is no lip."""
    box, top = part.split(".")[1], max(stage.speed_end for stage in solved.case.schedule.resolved())
    lips = {one.shaft for one in solved.case.gearboxes[box].seals.values() if one.kind == "radial_lip"}
    speeds = [
        (0.5 * seal.diameter * solved.rig.shaft_speed(shaft, top), shaft)
        for shaft in shafts_of(solved.case, part)
        for seal in shaft_seals(solved.rig, box, shaft)
        if seal.leaves or shaft not in lips
    ]
    return worst(speeds) if speeds else (None, NO_SEAL)


def _shaft_expansion(solved: SolvedRig, part: str) -> Found:
    box, shafts = part.split(".")[1], shafts_of(solved.case, part)
    rows = [row for result in solved.expansion if result.gearbox == box for row in result.shafts]
    if not rows:
        return None, NO_HOUSING
    return worst((1e-3 * row["growth_mm"], row["shaft"]) for row in rows if row["shaft"] in shafts)


def _oil_flow(solved: SolvedRig, part: str) -> Found:
    """Flow of one circuit, of both of a gearbox, or of the rig."""
    _, _, rest = part.partition(".")
    box_name, _, circuit = rest.partition(".")
    flow = 0.0
    for name, box in solved.case.gearboxes.items():
        if box_name in ("", name):
            flow += box.oil.flow * len(box.meshes) if circuit in ("", "oil") else 0.0
            flow += box.bearing_oil.flow * len(box.bearings) if circuit in ("", "bearing_oil") else 0.0
    return flow, part


def _temperature(solved: SolvedRig, part: str) -> Found:
    box = part.split(".")[1]
    found = [result for result in solved.thermal if result.gearbox == box]
    if not found:
        return None, NO_HOUSING
    return worst((result.max_temperature_degC + 273.15, result.max_temperature_body) for result in found)


RESULTS: dict[ResultQuantity, Callable[[SolvedRig, str], Found]] = {
    "torque_peak": _torque_peak,
    "torque_mean": _torque_mean,
    "speed": _speed,
    "drive_torque": _drive_torque,
    "drive_power": _drive_power,
    "actuator_force": _actuator_force,
    "circulating_power": _circulating_power,
    "seal_surface_velocity": _seal_velocity,
    "shaft_growth": _shaft_expansion,
    "oil_flow": _oil_flow,
    "temperature_maximum": _temperature,
}
"""How each quantity is found at a part."""
