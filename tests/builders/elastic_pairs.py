"""Influence numbers of small finite-element models for tests, each gear once in a session."""

from dataclasses import replace
from functools import lru_cache
from math import cos, radians

from dynamics.gear.pair import GearPair
from dynamics.tooth.compliance import InterpolatedCompliance
from dynamics.tooth.elastic_segment import GearModel
from dynamics.tooth.influence_model import influence_numbers
from dynamics.tooth.influence_numbers import InfluenceNumbers, SectionDivision
from dynamics.tooth.loaded_mesh import LoadedMesh
from dynamics.tooth.points import FaceGrid, FlankGap, no_gap
from rigdesign.rig.tooth_influence import gear_model

COARSE = SectionDivision(profile=5, thickness=2, fillet=4, depth=2)
"""Deflections within 1 %."""


@lru_cache
def numbers_of(model: GearModel) -> InfluenceNumbers:
    """Influence numbers of a gear, of one position for a slice in plane strain."""
    numbers = influence_numbers(model)
    return numbers.even() if model.plane_strain else numbers


def plane_gears(pair: GearPair) -> tuple[InterpolatedCompliance, InterpolatedCompliance]:
    """Compliance of a spur pair in plane strain over the common face width, 2 s a gear."""
    first, second = (
        InterpolatedCompliance.of(
            numbers_of(replace(gear_model(pair, index), plane_strain=True, face_width=pair.face_width))
        )
        for index in (0, 1)
    )
    return first, second


def equal_helical_pair() -> GearPair:
    """Two equal gears of one hand each: one set of influence numbers serves both."""
    pair = GearPair.from_centre_distance(
        normal_module=3e-3,
        teeth=(30, 30),
        centre_distance=90e-3 / cos(radians(15.0)),
        helix_angle=radians(15.0),
        face_widths=(30e-3, 30e-3),
        profile_shift_1=0.0,
    )
    return replace(pair, profile_shifts=(0.0, 0.0))


def coarse_gears(pair: GearPair) -> tuple[InterpolatedCompliance, InterpolatedCompliance]:
    """Compliance of a pair in space, five positions over the face, some seconds a gear."""
    pinion, wheel = (
        numbers_of(replace(gear_model(pair, index), n_face=5, division=COARSE)) for index in (0, 1)
    )
    slant = pair.base_helix_angle
    return InterpolatedCompliance.of(pinion.reversed_face(), slant), InterpolatedCompliance.of(wheel, slant)


def loaded(
    pair: GearPair,
    gears: tuple[InterpolatedCompliance, InterpolatedCompliance],
    gap: FlankGap = no_gap,
    n_face: int = 1,
) -> LoadedMesh:
    """Loaded mesh on influence numbers."""
    return LoadedMesh(
        pair=pair, gears=gears, grid=FaceGrid.over(pair.face_width, n_face), gap=gap, n_positions=32
    )
