"""Rows of the torques in shafts and joints of the elastic rig, on the freedoms of its linear system."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from dynamics.drivetrain.shaft import Shaft
from dynamics.drivetrain.twist_rows import (
    SectionKind,
    TorqueSection,
    TwistRows,
    TwistSpring,
    section_of_elements,
    twist_rows,
)
from dynamics.elastic_rig.assembly import ElasticModel
from dynamics.elastic_rig.beam import DIRECTIONS
from dynamics.elastic_rig.seen_system import SeenRig

JOINTS: tuple[SectionKind, ...] = ("spline", "coupling", "motor")
TURN = DIRECTIONS.index("turn")


def elastic_twist_rows(seen: SeenRig) -> TwistRows:
    """Rows on the freedoms of the systems of ``seen``; they are the same for all its running states."""
    model = seen.reduced.model
    springs = [replace(spring, row=seen.on_freedoms(spring.row)) for spring in _springs(model)]
    return twist_rows(springs, model.rig.drivetrain.bracing_coupling)


def _springs(model: ElasticModel) -> Iterator[TwistSpring]:
    """With rows on all freedoms of the model."""
    for shaft in model.rig.drivetrain.shafts:
        yield from _elements(model, shaft)
    for joint in model.joints:
        for kind in JOINTS:
            if joint.kind == kind and "turn" in joint.directions:
                at = joint.directions.index("turn")
                yield TwistSpring(
                    TorqueSection(kind=kind, part=joint.name),
                    joint.row("turn"),
                    float(joint.stiffness[at, at]),
                    float(joint.damping[at, at]),
                )


def _elements(model: ElasticModel, shaft: Shaft) -> Iterator[TwistSpring]:
    nodes = model.freedoms.nodes[shaft.name]
    lengths = np.diff(nodes.positions)
    for i, section in enumerate(section_of_elements(shaft, nodes.positions)):
        assert section.section is not None
        row = np.zeros(model.size)
        first = nodes.first + 6 * i + TURN
        row[first], row[first + 6] = 1.0, -1.0
        stiffness = shaft.shear_modulus * section.section.polar_moment / float(lengths[i])
        yield TwistSpring(section, row, stiffness, shaft.damping_time * stiffness)
