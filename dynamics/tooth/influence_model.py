"""Influence numbers of a gear from a finite-element model of its body with three teeth.

Normal forces on hat functions over the face load the flank of the middle tooth, profile position by profile position;
one factor of the stiffness serves them all. Displacements are read on the tooth axis under the points of the flank:
what lies between is the local approach, which the contact adds analytically (Weber, and `local_excess`).
Source: gears.md e; Weber, Banaschek, Formaenderung und Profilruecknahme, 1953; hat functions as in Vedmar 1981.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from dynamics.tooth.elastic_segment import Elastic, GearModel, solve_segment
from dynamics.tooth.influence_numbers import TEETH, InfluenceNumbers, SectionDivision
from dynamics.tooth.segment import GearSegment, gear_section
from dynamics.tooth.segment_loads import SegmentReading, rows

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


# What a tooth gives under a contact beyond the half space: its local part on a fine slice.
#
# Between the flank and the tooth axis a tooth is softer than a half space: its other flank is free, it tapers, its tip
# is near. The addition to Weber's logarithm is read as the difference of the displacements of flank and axis, at a
# distance from a line load that is small against the depth and spans some elements, less the same difference of the
# half space (Flamant). It is about 0.6, 3 to 4 % of the approach of a pair, and grows towards a tip edge. Source of the
# half space: Johnson, Contact Mechanics, 2.2; addition: loaded contact in CalculiX agrees with it.

Array = NDArray[np.float64]

FINE = SectionDivision(profile=40, thickness=10, fillet=12, depth=2, grading=0.85, neighbours=(2, 2, 4))
APART = 2
"""Elements between load and reading."""


def local_excess(model: GearModel, rolls: Array) -> Array:
    """Addition to 2 ln(2 h / a) - nu / (1 - nu) of a flank at roll lengths (n,) [-].

    h : distance to the tooth axis, a : half width of the contact; the local approach is (1 - nu^2) F' / (pi E) times it
    """
    nu = model.material.poisson
    fine = replace(
        model, material=Elastic(young=1.0, poisson=nu), face_width=1.0, division=FINE, plane_strain=True
    )
    segment = GearSegment.of(gear_section(fine.form, fine.body, fine.division), fine.face)
    reading = SegmentReading(fine, segment)
    size = 3 * len(segment.points)
    loads = rows(reading.loads(), size)
    moved = solve_segment(segment, fine.material, loads, plane_strain=True)
    local = _even(loads @ moved) - _even(rows(reading.axis(0), size) @ moved)
    points, depth = fine.form.flank_point(reading.rolls), fine.form.axis_depth(reading.rolls)
    n = len(reading.rolls)
    found = np.zeros(n)
    for load in range(n):
        places = [place for place in (load - APART, load + APART) if 0 <= place < n]
        apart = [
            np.pi / (1.0 - nu**2) * local[place, load]
            - _half_space(float(np.hypot(*(points[place] - points[load]))), float(depth[place]), nu)
            for place in places
        ]
        found[load] = np.mean(apart)
    return np.asarray(np.interp(rolls, reading.rolls, found))


def _even(block: Array) -> Array:
    """Mean over the two faces of the slice under a load on both."""
    n = len(block) // 2
    return np.asarray(np.asarray(block).reshape(n, 2, n, 2).mean(axis=(1, 3)))


def _half_space(distance: float, depth: float, nu: float) -> float:
    """Displacement at a distance from a line load less that at a depth below, over (1 - nu^2) F' / (pi E)."""
    squared = distance**2 + depth**2
    surface = -2.0 * np.log(distance) - 1.0 / (1.0 - nu)
    below = -np.log(squared) - (1.0 - depth**2 / squared) / (1.0 - nu)
    return float(surface - below)
