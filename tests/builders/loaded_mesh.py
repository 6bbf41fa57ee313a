"""Gear pairs and loaded meshes for the tests of the contact under load."""

import numpy as np

from dynamics.gear.flank import AxisMisalignment
from dynamics.gear.microgeometry import Microgeometry
from dynamics.gear.pair import GearPair
from dynamics.tooth.compliance import InterpolatedCompliance
from dynamics.tooth.loaded_mesh import LoadedMesh
from dynamics.tooth.pair_gap import PairGap
from dynamics.tooth.points import FaceGrid, FlankGap, flank_gap
from dynamics.tooth.slice_compliance import SliceCompliance


def equal_gears(module: float = 3e-3, teeth: int = 50, width: float = 20e-3) -> GearPair:
    """Two equal spur gears without shift."""
    return GearPair.from_centre_distance(
        normal_module=module,
        teeth=(teeth, teeth),
        centre_distance=module * teeth,
        face_widths=(width, width),
        profile_shift_1=0.0,
    )


def fzg_c() -> GearPair:
    """Type C of DIN ISO 14635, without tip corrections."""
    return GearPair.from_centre_distance(
        normal_module=4.5e-3,
        teeth=(16, 24),
        centre_distance=91.5e-3,
        face_widths=(14e-3, 14e-3),
        profile_shift_1=0.1817,
    )


def exchanged_fzg_c() -> GearPair:
    """The same two gears, the wheel called pinion."""
    pair = fzg_c()
    return GearPair(
        normal_module=pair.normal_module,
        teeth=(24, 16),
        centre_distance=pair.centre_distance,
        face_widths=pair.face_widths,
        profile_shifts=pair.profile_shifts[::-1],
        tip_diameters=pair.tip_diameters[::-1],
    )


def sliced_mesh(pair: GearPair, n_face: int = 11, coupling: float = 0.0, **fields: object) -> LoadedMesh:
    """Loaded mesh on the analytic compliance; ``coupling`` in normal modules."""
    grid = FaceGrid.over(pair.face_width, n_face)
    first, second = (
        SliceCompliance(pair=pair, index=i, grid=grid, coupling_length=coupling * pair.normal_module)
        for i in (0, 1)
    )
    return LoadedMesh(pair=pair, gears=(first, second), grid=grid, **fields)  # type: ignore[arg-type]


def influence_of(
    pair: GearPair, index: int, n_profile: int = 8, n_face: int = 11, neighbour: float = 0.08
) -> InterpolatedCompliance:
    """Influence numbers as a finite-element model would give them, from the analytic compliance.

    neighbour : deflection of the teeth next to the loaded one, against its own; uneven to both sides
    """
    grid = FaceGrid.over(pair.face_width, n_face)
    finer = grid if n_face == 1 else FaceGrid.over(pair.face_width, 12 * (n_face - 1) + 1)
    slices = SliceCompliance(pair=pair, index=index, grid=finer, coupling_length=1.5 * pair.normal_module)
    gear = pair.gears[index]
    profile = np.linspace(gear.roll_length(gear.form_radius), slices.tip_roll, n_profile)
    roll = np.repeat(profile, n_face)
    # means under hats, as loads and displacements of finite elements are
    hats = np.stack([np.interp(finer.position, grid.position, one) for one in np.eye(n_face)]) * finer.width
    hats /= hats.sum(axis=1, keepdims=True)
    zero = np.zeros(len(finer.position), dtype=np.int64)
    over_face = hats @ slices.matrix(np.full(zero.size, profile[0]), finer.position, zero) @ hats.T
    of_profile = slices.matrix(profile, np.zeros(n_profile), np.zeros(n_profile, dtype=np.int64))
    scale = np.sqrt(np.diag(of_profile) / of_profile[0, 0])
    own = np.kron(np.outer(scale, scale), over_face)
    next_one = neighbour * own * (1.0 + 0.3 * (roll / roll.max())[:, None])
    return InterpolatedCompliance(
        profile=profile,
        face=grid.position,
        deflection={0: own, 1: next_one, -1: next_one.T},
        axis_depth=slices.depth(profile),
        local_excess=np.zeros(n_profile),
        edge_counted=False,
    )


def gap_of(pair: GearPair, micro: tuple[Microgeometry, Microgeometry], misalignment: float = 0.0) -> FlankGap:
    """Gap of modified flanks on axes out of line by ``misalignment`` along the line of action."""
    axes = AxisMisalignment.of_gap(pair, misalignment, misalignment)
    return flank_gap(PairGap.of_pair(pair, micro, axes))
