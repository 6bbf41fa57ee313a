"""Teeth that differ from each other, and the period over which a periodic response is sought.

A response over one mesh cannot tell one tooth from another, one over a turn of the pinion can tell those of the
wheel only if it ends the turn on the same tooth. Gears whose differences the period cannot hold are taken with
the mean of their teeth; the run in time and a response over the hunting cycle have them all.
"""

from collections.abc import Sequence

import numpy as np

from dynamics.mesh.flank import alike_teeth
from dynamics.mesh.law import MeshLaw
from dynamics.mesh.tables import has_individual_teeth
from rigdesign.rig.model import Rig


def periodic_laws(rig: Rig, laws: Sequence[MeshLaw]) -> list[MeshLaw]:
    """Mesh laws with alike teeth on every gear that does not end the period of the response where it began."""
    return [
        alike_teeth(law, *(not whole for whole in back)) if has_individual_teeth(law) else law
        for law, back in zip(laws, _whole_turns(rig, laws))
    ]


def averaged_gears(rig: Rig, laws: Sequence[MeshLaw]) -> list[str]:
    """Gears ``gearbox.gear`` whose teeth differ and are taken with their mean in the periodic response."""
    found = []
    for name, law, back in zip(rig.mesh_names, laws, _whole_turns(rig, laws)):
        for gear, own, whole in zip(rig.mesh_gears(name), _differ(law), back):
            if own and not whole:
                found.append(gear)
    return list(dict.fromkeys(found))


def _differ(law: MeshLaw) -> tuple[bool, bool]:
    """Whether the teeth of pinion and wheel differ from each other."""
    return (
        bool(np.ptp(law.deviation_1, axis=0).any() or np.ptp(law.scale_1)),
        bool(np.ptp(law.deviation_2, axis=0).any() or np.ptp(law.scale_2)),
    )


def _whole_turns(rig: Rig, laws: Sequence[MeshLaw]) -> list[tuple[bool, bool]]:
    """Whether pinion and wheel of each mesh make whole turns in the period of the response."""
    kind = rig.case.numerics.response_period
    if kind != "revolution":
        return [(kind == "hunting_cycle",) * 2] * len(laws)
    speeds = [rig.shaft_speed(_pinion_shaft(rig, name), 1.0) for name in rig.mesh_names]
    turns = [speed / speeds[0] for speed in speeds]
    return [(_whole(own), _whole(own * law.teeth_1 / law.teeth_2)) for own, law in zip(turns, laws)]


def _pinion_shaft(rig: Rig, name: str) -> str:
    box, mesh = rig.mesh(name)
    return box.gears[box.meshes[mesh].pinion].shaft


def _whole(turns: float) -> bool:
    return abs(turns - round(turns)) < 1e-6
