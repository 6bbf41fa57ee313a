"""Root stress at the strain gauges of a mesh, from its loaded contact and the influence numbers of its gears.

A gauge is reported in the first mesh of its gear. What a second mesh of the same gear does to it, at another rolling
angle, is not in the curve.
"""

from typing import Literal, NamedTuple

from dynamics.contact.compliance import InterpolatedCompliance
from dynamics.contact.flank_gap import face_sense
from dynamics.contact.mesh_cycle import MeshCycle
from dynamics.contact.root_course import root_course
from dynamics.flank.field import Flank
from dynamics.gear.normal_arc import normal_arc
from dynamics.gear.pair import GearPair
from dynamics.influence.numbers import InfluenceNumbers
from rigdesign.results.teeth import GaugeStress
from rigdesign.rig.model import Rig
from rigdesign.rig.strain_gauges import RootGauge
from rigdesign.strain_gauge.gauge_curve import GaugeCurve, gauge_curve

GEARS = ("pinion", "wheel")


class ElasticGear(NamedTuple):
    """Influence numbers of a gear and the compliance made of them, on the face positions of the contact."""

    numbers: InfluenceNumbers
    compliance: InterpolatedCompliance


def gauge_stresses(
    rig: Rig,
    mesh: str,
    cycle: MeshCycle,
    gears: tuple[ElasticGear, ElasticGear],
    flank: Flank = "front",
) -> tuple[GaugeStress, ...]:
    """Stress at the gauges of pinion and wheel of a mesh, ``gearbox.mesh``, under the torque of a cycle.

    flank : that carries
    """
    box, own = rig.mesh(mesh)
    found = []
    for name, gauge in rig.strain_gauges.items():
        first, side = box.first_meshes().get(gauge.gear.split(".")[1], ("", 0))
        if gauge.gear == rig.mesh_gears(mesh)[side] and first == own:
            found.append(
                GaugeStress(
                    name=name.split(".")[2],
                    gear=GEARS[side],
                    tooth=gauge.tooth,
                    front=gauge.front,
                    point=gauge.point,
                    curve=stress_at(gauge, cycle, gears[side], rig.pairs[mesh], 1 if side else 0, flank),
                )
            )
    return tuple(found)


def stress_at(
    gauge: RootGauge,
    cycle: MeshCycle,
    gear: ElasticGear,
    pair: GearPair,
    index: Literal[0, 1],
    flank: Flank = "front",
) -> GaugeCurve:
    """Curve of one gauge on the pinion (0) or wheel (1) of a pair, which is the cold one; ``flank`` carries."""
    under_load = gauge.front == (flank == "front")
    course = root_course(cycle, gear.numbers, gear.compliance, index, 1 if under_load else -1)
    if face_sense(flank) < 0.0:
        course = course.turned()
    fillet = gear.numbers.fillet
    places = normal_arc(pair.gears[index], fillet.point, fillet.arc)
    sense = -1.0 if index else 1.0
    return gauge_curve(course, places, gauge.point, sense / pair.base_radii[index])
