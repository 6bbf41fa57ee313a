"""Catalogue of what strain gauges in the tooth roots show: load over the face, relief, friction, and the gauges.

Only gearboxes with gauges have these entries. The axes of a mesh and the helix slopes of its gears move one sum, the
gap over the face: one entry a mesh holds all of them, written at its pinion, as a test engineer takes misaligned axes
as f_Hbeta. Crowning, twist and relief are written at the gear of the mesh that has more of them. Bounds are starting
values of rig practice (design of the workflow, section 4); what a healthy gear has follows from its tolerance class
(ISO 1328-1).
"""

from collections.abc import Iterator
from dataclasses import dataclass
from math import cos, pi, sqrt

from dynamics.standards.iso1328_1_2013 import Tolerances, tolerances
from rigdesign.case.gearbox import Gearbox
from rigdesign.diagnosis.catalogue.effects import (
    CHAIN,
    FACE,
    GAUGE_PLACE,
    PRACTICE,
    Added,
    Effect,
    GearboxPart,
    Parameter,
    UncertainValue,
    of_gearbox,
)

MICROMETRE = 1e-6
"""In metres."""
AXES = 2.5 * MICROMETRE
"""Misalignment of the axes of a healthy rig over the face [m], one standard deviation, on top of the helix slopes:
bores parallel within 10 um over 100 mm, on a face of 25 mm."""
MODIFICATION = 0.1
"""Spread of a modification of the flanks over its size: as grinding keeps it and an inspection finds it."""
LEAST_MODIFICATION = 1.5 * MICROMETRE
"""The same of a small one [m]."""
PLACE = 2e-4
"""Spread of the place of a gauge, along the face and along the fillet [m]: as it is applied by hand in a root."""
LEAST_LAG = 2e-6
"""Time constant of a measuring chain that matters [s]: a low-pass of 80 kHz."""
LONGEST_LAG = 1.0 / (2.0 * pi * 500.0)
"""Of a slip ring with an amplifier that passes 500 Hz [s]."""


@dataclass(frozen=True, kw_only=True)
class _Modified:
    """A modification of the flanks.

    key : of ``flank``; bounds : of what is added [um]; always : whether gears that have none may deviate
    """

    key: str
    title: str
    bounds: tuple[float, float]
    signature: str
    always: bool = False


MODIFIED = (
    _Modified(
        key="lead_crowning", title="lead crowning", bounds=(-30.0, 30.0), always=True,
        signature="gauges in the middle of the face against those at its ends, fading with torque",
    ),
    _Modified(
        key="twist", title="twist of the flanks", bounds=(-160.0, 160.0), always=True,
        signature="gauge tilt that changes from entry to exit, fading with torque",
    ),
    _Modified(
        key="profile_crowning", title="profile crowning", bounds=(-25.0, 25.0), always=True,
        signature="entry and exit against the maximum at all gauges, fading with torque",
    ),
    _Modified(
        key="tip_relief_length", title="length of the tip relief", bounds=(-1000.0, 1000.0),
        signature="entry or exit against the maximum at all gauges",
    ),
    _Modified(
        key="root_relief", title="root relief", bounds=(-25.0, 25.0),
        signature="entry or exit against the maximum at all gauges",
    ),
)  # fmt: skip


@of_gearbox(drivetrain=True)
def face_load(part: GearboxPart) -> Iterator[Effect]:
    """Misalignment, modifications and friction of every mesh with gauges."""
    for name, mesh in part.box.meshes.items():
        gears = (mesh.pinion, mesh.wheel)
        if not any(part.box.gears[gear].strain_gauges for gear in gears):
            continue
        label, path = f"{part.name}.{name}", f"{part.path}.gears"
        slope = part.box.gears[mesh.pinion].flank.helix_slope
        yield Effect(
            name=f"misalignment:{label}",
            title=f"misaligned axes or helix slope f_Hbeta of the mesh {label}",
            family=FACE,
            signature="gauge tilt at all speeds, fading with torque",
            parameters=(_micrometres("slope", (-50.0, 50.0)),),
            change=Added(f"{path}.{mesh.pinion}.flank.helix_slope", slope),
            healthy=sqrt(AXES**2 + sum(_helix_slope(part.box, name, gear) ** 2 for gear in gears)),
        )
        for entry in MODIFIED:
            yield from _modified(part, name, entry)
        friction = UncertainValue(
            path=f"{part.path}.meshes.{name}.friction_factor",
            now=mesh.friction_factor,
            bounds=(0.3, 3.0),
            healthy=0.25,
        )
        yield friction.effect(
            f"tooth_friction:{label}", f"friction of the teeth in the mesh force of {label}", FACE,
            "entry against exit at all gauges, reversed with the direction",
        )  # fmt: skip


def _modified(part: GearboxPart, mesh_name: str, entry: _Modified) -> Iterator[Effect]:
    """A modification, at the gear of the mesh that has more of it."""
    mesh = part.box.meshes[mesh_name]
    sizes = {gear: getattr(part.box.gears[gear].flank, entry.key) for gear in (mesh.wheel, mesh.pinion)}
    gear = max(sizes, key=lambda name: abs(sizes[name]))
    stated = sizes[gear]
    if not stated and not entry.always:
        return
    low, high = entry.bounds
    if entry.key != "twist":
        low = max(low, -stated / MICROMETRE)
    yield Effect(
        name=f"{entry.key}:{part.name}.{mesh_name}",
        title=f"{entry.title} of the mesh {part.name}.{mesh_name}",
        family=FACE,
        signature=entry.signature,
        parameters=(_micrometres("deviation", (low, high)),),
        change=Added(f"{part.path}.gears.{gear}.flank.{entry.key}", stated),
        healthy=max(MODIFICATION * abs(stated), LEAST_MODIFICATION),
    )


@of_gearbox(drivetrain=True)
def gauges(part: GearboxPart) -> Iterator[Effect]:
    """Place and measuring chain of every gauge."""
    for gear, entry in part.box.gears.items():
        for name, gauge in entry.strain_gauges.items():
            path, label = f"{part.path}.gears.{gear}.strain_gauges.{name}", f"{part.name}.{gear}.{name}"
            places = {"face_position": gauge.face_position}
            if gauge.tangent_angle is None and gauge.root_diameter is None:
                places["fillet_position"] = gauge.fillet_position or 0.0
            for key, position in places.items():
                yield Effect(
                    name=f"gauge_{key}:{label}",
                    title=f"place of the gauge {label} along the {key.partition('_')[0]}",
                    family=GAUGE_PLACE,
                    signature="one gauge alone, in proportion to its strain",
                    parameters=(_micrometres("offset", (-1000.0, 1000.0)),),
                    change=Added(f"{path}.{key}", position),
                    healthy=PLACE,
                    linear=True,
                )
            yield Effect(
                name=f"gauge_lag:{label}",
                title=f"low-pass of slip ring and amplifier of the gauge {label}",
                family=CHAIN,
                signature="the maximum falls and entry and exit rise with speed, one gauge alone",
                parameters=(
                    Parameter(name="time constant", unit="s", low=0.0, high=LONGEST_LAG, source=PRACTICE),
                ),
                change=Added(f"{path}.response_time", gauge.response_time),
                matters=LEAST_LAG,
            )


def _micrometres(name: str, bounds: tuple[float, float]) -> Parameter:
    """A length between bounds in micrometres; its coordinate is in metres."""
    low, high = (bound * MICROMETRE for bound in bounds)
    return Parameter(name=name, unit="m", low=low, high=high, source=PRACTICE)


def _helix_slope(box: Gearbox, mesh_name: str, name: str) -> float:
    """Spread of the helix slope of a gear [m]: half of its tolerance as two standard deviations."""
    return 0.25 * _tolerances(box, mesh_name, name).f_HbetaT * MICROMETRE


def _tolerances(box: Gearbox, mesh_name: str, name: str) -> Tolerances:
    mesh, gear = box.meshes[mesh_name], box.gears[name]
    module = 1e3 * mesh.normal_module
    diameter = gear.teeth * module / cos(mesh.helix_angle)
    width = 1e3 * gear.face_width
    return tolerances(gear.teeth, diameter, module, width, gear.quality_grade, mesh.helix_angle)
