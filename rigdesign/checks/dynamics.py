"""Checks of the dynamic loads: K_V, resonances, contact, strength, the window of the specimens."""

import math
from collections.abc import Iterator

from dynamics.iso_rating import root_stress
from rigdesign.checks.subject import NO_LIMIT, NO_LOADS, Subject, worst
from rigdesign.results import Check, GearboxDynamics
from rigdesign.rules import Rule, hold, not_applicable

ISO_ROOT = "ISO 6336-3:2006 method B with the simulated K_V"
LOCAL_ROOT = "sigma_F over the path from the dynamic tooth forces, local lever"


def checks(subject: Subject) -> list[Check]:
    """All of them, gearbox by gearbox."""
    found: list[Check] = []
    for name in subject.case.gearboxes:
        found += [
            _dynamic_factor(subject, name),
            _resonance(subject, name),
            _lift_off(subject, name),
            *_strength(subject, name),
        ]
    return [*found, _load_cycles(subject)]


def _box(subject: Subject, name: str) -> GearboxDynamics:
    assert subject.dynamics is not None
    return subject.dynamics.gearboxes[name]


def _mesh(subject: Subject, name: str) -> int:
    return next(i for i, mesh in enumerate(subject.rig.mesh_names) if mesh.split(".")[0] == name)


def _dynamic_factor(subject: Subject, name: str) -> Check:
    limit = subject.case.limits.dynamics.dynamic_factor_maximum
    rule = Rule(
        id=f"dynamics.dynamic_factor.{name}", title=f"K_V of the {name} gearbox at the held stages", unit="-",
        source="limits.dynamics.dynamic_factor_maximum; max/mean, P2 Formula 1", group="dynamics",
        role=subject.case.gearboxes[name].role, limit=limit,
    )  # fmt: skip
    if subject.run is None or limit is None:
        return not_applicable(rule, NO_LOADS if subject.run is None else NO_LIMIT)
    mesh = _mesh(subject, name)
    value, stage = worst(
        (float(point.last.response.dynamic_factor[mesh]), point.point.stage)
        for point in subject.points
        if point.last.response is not None
    )
    resting = subject.assumed(f"gearboxes.{name}.meshes", f"gearboxes.{name}.gears", "drivetrain")
    return hold(rule, value, f"stage {stage}", resting)


def _resonance(subject: Subject, name: str) -> Check:
    limit = subject.case.limits.dynamics.resonance_distance_minimum
    rule = Rule(
        id=f"dynamics.resonance_distance.{name}",
        title=f"distance of held speeds from dangerous resonances, {name} gearbox", unit="-",
        source="limits.dynamics.resonance_distance_minimum; resonances by strength", group="dynamics",
        role=subject.case.gearboxes[name].role, limit=limit, comparison=">=",
    )  # fmt: skip
    if subject.run is None or limit is None:
        return not_applicable(rule, NO_LOADS if subject.run is None else NO_LIMIT)
    dangerous = [row for row in _box(subject, name).resonances if row["dangerous"]]
    held = [point.point.speed * 30.0 / math.pi for point in subject.points]
    if not dangerous:
        return hold(rule, 1.0, "no resonance of the calculated speed range is dangerous")
    value, where = worst(
        (
            (
                abs(row["speed_rpm"] - speed) / speed,
                f"{row['speed_rpm']:.0f} rpm ({row['mode']}), held {speed:.0f} rpm",
            )
            for row in dangerous
            for speed in held
            if speed > 0.0
        ),
        smallest=True,
    )
    resting = subject.assumed("drivetrain", f"gearboxes.{name}.meshes", "limits.dynamics")
    return hold(rule, value, f"nearest: {where}", resting)


def _lift_off(subject: Subject, name: str) -> Check:
    limit = subject.case.limits.dynamics.lift_off_share_maximum
    rule = Rule(
        id=f"dynamics.lift_off.{name}", title=f"time without tooth contact in loaded stages, {name} gearbox",
        unit="-", source="limits.dynamics.lift_off_share_maximum; time run over the schedule", group="dynamics",
        role=subject.case.gearboxes[name].role, limit=limit,
    )  # fmt: skip
    if subject.run is None or limit is None:
        return not_applicable(rule, NO_LOADS if subject.run is None else NO_LIMIT)
    rows = _box(subject, name).lift_off
    loaded = _loaded_stages(subject)
    value, stage = worst(
        [(float(row["share"]), row["stage"]) for row in rows if row["stage"] in loaded] or [(0.0, "")]
    )
    reason = f"stage {stage}" if stage else "the flanks never part in a loaded stage"
    return hold(rule, value, reason, subject.assumed("drivetrain", f"gearboxes.{name}.meshes"))


def _loaded_stages(subject: Subject) -> set[str]:
    """Stages that carry more than the start torque while they turn."""
    light = subject.case.limits.bearing.start_torque_limit or 0.0
    return {
        stage.name
        for stage in subject.case.schedule.resolved()
        if min(stage.torque_start, stage.torque_end) > light and max(stage.speed_start, stage.speed_end) > 0.0
    }


def _strength(subject: Subject, name: str) -> Iterator[Check]:
    """Root stress of every gear: a window for specimens, a safety for the rig's own."""
    box = subject.case.gearboxes[name]
    mesh = _mesh(subject, name)
    own = subject.rig.mesh_names[mesh].split(".")[1]
    gears = (box.meshes[own].pinion, box.meshes[own].wheel)
    for index, gear in enumerate(gears):
        for kind in ("iso", "path"):
            if box.role == "specimen":
                yield _window(subject, name, gear, index, kind)
            else:
                yield _safety(subject, name, gear, index, kind)


def _stress(subject: Subject, name: str, index: int, kind: str) -> tuple[float, str]:
    """Root stress [Pa] of one gear at the test point and how it came about."""
    mesh = _mesh(subject, name)
    full = subject.rig.mesh_names[mesh]
    box, own = subject.rig.mesh(full)
    entry = box.meshes[own]
    response = subject.test.last.response
    assert response is not None
    if kind == "path":
        history = _box(subject, name).root_stress[index]
        dynamic, static = max(history.dynamic_MPa), max(history.quasi_static_MPa)
        return (
            1e6 * dynamic,
            f"peak of sigma_F over the path, {dynamic / static:.3f} times the quasi-static one",
        )
    factor = float(response.dynamic_factor[mesh])
    gear = box.gears[(entry.pinion, entry.wheel)[index]]
    stress = root_stress(
        subject.rig.pairs[full],
        float(response.mean[mesh]),
        index,
        grade=gear.quality_grade,
        application_factor=entry.application_factor,
        dynamic=factor,
        face_load=entry.face_load_factor,
    )
    return 1e6 * stress.sigma_F, f"nominal {stress.sigma_F0:.0f} MPa, simulated K_V {factor:.3f}"


def _window(subject: Subject, name: str, gear: str, index: int, kind: str) -> Check:
    window = subject.case.limits.specimen
    low, high = window.root_stress_minimum, window.root_stress_maximum
    rule = Rule(
        id=f"specimen.root_stress_{kind}.{name}.{gear}",
        title=f"root stress of specimen {name} {gear}, {'ISO 6336-3' if kind == 'iso' else 'over the path'}",
        unit="MPa", source=ISO_ROOT if kind == "iso" else LOCAL_ROOT, group="specimen", role="specimen",
        limit=None if low is None else 1e-6 * low, upper_limit=None if high is None else 1e-6 * high,
        comparison="within",
    )  # fmt: skip
    if subject.run is None or low is None:
        return not_applicable(rule, NO_LOADS if subject.run is None else NO_LIMIT)
    stress, reason = _stress(subject, name, index, kind)
    resting = subject.assumed(f"gearboxes.{name}.gears", f"gearboxes.{name}.meshes", "limits.specimen")
    return hold(rule, 1e-6 * stress, reason, resting)


def _safety(subject: Subject, name: str, gear: str, index: int, kind: str) -> Check:
    limit = subject.case.limits.strength.root_safety_minimum
    rule = Rule(
        id=f"strength.root_safety_{kind}.{name}.{gear}",
        title=f"root safety of {name} {gear}, {'ISO 6336-3' if kind == 'iso' else 'over the path'}", unit="-",
        source=f"{ISO_ROOT if kind == 'iso' else LOCAL_ROOT}; sigma_FE of the material", group="dynamics",
        limit=limit, comparison=">=",
    )  # fmt: skip
    material = subject.rig.materials[subject.case.gearboxes[name].gears[gear].material]
    if subject.run is None or limit is None:
        return not_applicable(rule, NO_LOADS if subject.run is None else NO_LIMIT)
    if material.root_strength is None:
        return not_applicable(rule, f"material {material.title} has no root strength")
    stress, reason = _stress(subject, name, index, kind)
    reason = f"{reason}; sigma_F {1e-6 * stress:.0f} MPa of sigma_FE {1e-6 * material.root_strength:.0f} MPa"
    resting = subject.assumed(f"gearboxes.{name}.gears", f"gearboxes.{name}.meshes", "limits.strength")
    return hold(rule, material.root_strength / stress, reason, resting)


def _load_cycles(subject: Subject) -> Check:
    limit = subject.case.limits.specimen.load_cycles_minimum
    plan, schedule = subject.case.test_plan, subject.case.schedule
    rule = Rule(
        id="specimen.load_cycles", title="load cycles of a specimen tooth in the planned time", unit="-",
        source="test_plan.time at test speed", group="specimen", role="specimen", limit=limit, comparison=">=",
    )  # fmt: skip
    if limit is None:
        return not_applicable(rule, NO_LIMIT)
    cycles = plan.time * schedule.test_speed / (2.0 * math.pi)
    return hold(rule, cycles, f"{plan.time / 3600.0:.0f} h at {schedule.test_speed * 30 / math.pi:.0f} rpm")
