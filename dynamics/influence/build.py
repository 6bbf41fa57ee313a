"""Influence numbers of a gear from a finite-element model of its body with three teeth.

Normal forces on hat functions over the face load the flank of the middle tooth, profile position by profile position;
one factor of the stiffness serves them all. Displacements are read on the tooth axis under the points of the flank:
what lies between is the local approach, which the contact adds analytically (Weber, and `local_part`).
Source: gears.md e; Weber, Banaschek, Formaenderung und Profilruecknahme, 1953; hat functions as in Vedmar 1981.
"""

import numpy as np

from dynamics.influence.elastic_segment import solve_segment
from dynamics.influence.gear_body import TEETH
from dynamics.influence.gear_model import GearModel
from dynamics.influence.local_part import local_excess
from dynamics.influence.numbers import InfluenceNumbers
from dynamics.influence.reading import SegmentReading
from dynamics.influence.section import gear_section
from dynamics.influence.segment import GearSegment
from dynamics.influence.strips import rows

SIDES = (1, -1)
OFFSETS = range(-3, 4)
"""Teeth whose displacement is read; those beyond the neighbours are carried by the body."""


def influence_numbers(model: GearModel) -> InfluenceNumbers:
    """Influence numbers of a gear whose face at positive z comes into mesh last as a driven gear on its right flank.

    Those of a driving gear are `InfluenceNumbers.reversed_face`.

    Raises DynamicsInputError for a body that leaves nothing under the teeth; OSError or ImportError without gmsh.
    """
    section = gear_section(model.form, model.body, model.division)
    segment = GearSegment.of(section, model.face, model.lead, model.body)
    reading = SegmentReading(model, segment)
    size = 3 * len(segment.points)
    moved = solve_segment(segment, model.material, rows(reading.loads(), size), model.plane_strain)
    raw = {k: rows(reading.axis(k) if k in TEETH else reading.carried(k), size) @ moved for k in OFFSETS}
    deflection = {k: 0.5 * (raw[k] + raw[-k].T) for k in OFFSETS}
    scale = float(np.abs(raw[0]).max())
    young, poisson = model.material.young, model.material.poisson
    return InfluenceNumbers(
        profile=reading.rolls,
        face=model.face,
        axis_depth=model.form.axis_depth(reading.rolls),
        local_excess=local_excess(model, reading.rolls),
        deflection=deflection,
        body=rows(reading.carried(0), size) @ moved,
        fillet=reading.fillet,
        stress={
            (k, side): young / (1.0 - poisson**2) * (rows(reading.root(k, side), size) @ moved)
            for k in TEETH
            for side in SIDES
        },
        asymmetry=max(float(np.abs(raw[k] - raw[-k].T).max()) for k in OFFSETS) / scale,
        n_nodes=len(segment.points),
    )
