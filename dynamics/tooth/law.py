"""The law of one gear mesh: what every tooth pair does at every place on the path of contact.

A mesh couples the rotations ``theta_1`` (pinion) and ``theta_2`` (wheel), both counted positive in the
running direction of their own shaft. The approach along the transverse line of action is

    x = r_b1 theta_1 - r_b2 theta_2 + offset                                                        [m]

Tooth pair ``p`` (any integer) touches on the front flank at the path position

    s_p = phase + r_b1 theta_1 - p base_pitch ,   s = 0 at the pitch point, growing to the pinion tip [m]

and on the back flank at the mirrored position ``back_phase - r_b1 theta_1 + p base_pitch``. Slice ``i`` of
the face width sees ``s_p - slice_shift[i]`` in front and, the helix being mirrored with the flank, the back
position plus ``slice_shift[i]``. Pair ``p`` joins pinion tooth p in front with wheel tooth p + tooth_offset_2,
on the back with the one that follows it, since the pinion tooth stands between the two. A tooth that stands ahead
narrows the gap in front and widens it on the back, a thick one narrows both: each flank has deviations of its own.
The gear bodies under the teeth are shared by all pairs: under the elastic force P, front less back, they give by
c_b P, and the teeth see the approach y = x - c_b P. A loaded tooth so carries its neighbours along, and a pair that
comes in is met late. The penetration is ``y - gap`` in front and ``-y - backlash - gap`` on the back, and all forces
and torques follow from the one potential

    W = (x - y)^2 / (2 c_b) + sum over flanks, pairs and slices of  k(s) max(0, penetration)^2 / 2    [J]

which is least over y, so that its derivatives are those of the sum at a fixed y, and an angle-dependent stiffness
neither creates nor destroys energy (ASME JMD 2005, Oh/Grosh/Barber). With c_b = 0, y is x.
Damping acts in contact only and grows over the first micrometre of it, each contact force is clipped at
zero, friction follows the sliding direction.

The damper of a contact acts on the relative rotation, the approach rate r_b1 omega_1 - r_b2 omega_2, as a damper
parallel to the mesh spring does (Kahraman and Singh, J. Sound Vib. 142, 1990, 49); or on the closing rate of the
contact itself, to which the gap of a tip corner that comes in adds its slope times the path speed. The latter takes
power from flanks that pass under steady load: as much as friction does where teeth meet early at 12,000 rpm. In both
it spans teeth and bodies: its rate is that of x, and the bodies give to the elastic force alone.
"""

from typing import Literal, NamedTuple, get_args

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError

Array = NDArray[np.float64]
DampedRate = Literal["relative_rotation", "contact_closing_rate"]


class MeshLaw(NamedTuple):
    """Tables of one gear mesh on a uniform grid over the path of contact; plain numbers for the kernels."""

    base_radius_1: float
    """Base radius of the pinion [m]."""
    base_radius_2: float
    """Base radius of the wheel [m]."""
    base_pitch: float
    """Transverse base pitch [m]."""
    teeth_1: int
    teeth_2: int
    tooth_offset_2: int
    """Wheel tooth that meets pinion tooth 0 in pair 0: pair p joins p mod z1 with (p + offset) mod z2 in front and
    with (p + 1 + offset) mod z2 on the back."""
    path_start: float
    """Path position of the first grid point [m]; the grid reaches beyond the active path on both sides."""
    path_step: float
    """Grid step [m]."""
    stiffness: Array
    """Stiffness of one tooth pair in one slice, shape (n_slices, n_path) [N/m]."""
    gap: Array
    """Gap of an ideal-pitch tooth pair in one slice, shape (n_slices, n_path) [m]: flank modifications inside
    the active path, growing separation (tip corner contact) outside it."""
    slice_shift: Array
    """Lag of each slice on the path, shape (n_slices,) [m]: z tan(base helix angle)."""
    deviation_1: Array
    """Gap added by each pinion tooth in front, shape (teeth_1, n_path), or (1, n_path) if all teeth are equal [m]."""
    deviation_2: Array
    """The same for the wheel, shape (teeth_2, n_path) or (1, n_path) [m]."""
    scale_1: Array
    """Stiffness scale of each pinion tooth, shape (teeth_1,) or (1,) [-]."""
    scale_2: Array
    """Stiffness scale of each wheel tooth, shape (teeth_2,) or (1,) [-]."""
    backlash: float
    """Play between front and back flank along the line of action [m]."""
    offset: float
    """Approach imposed by shifting a helical gear axially [m]."""
    phase: float
    """Front-flank path position of pair 0 at theta_1 = 0 [m]."""
    back_phase: float
    """Back-flank path position of pair 0 at theta_1 = 0 [m]."""
    damping: float
    """Damping of the mesh at its mean stiffness [N s/m]; a contact takes the share of its k in that of all pairs."""
    mean_stiffness: float
    """Mean stiffness of the mesh over one base pitch, teeth and shared bodies in series [N/m]."""
    friction: float
    """Friction coefficient of the tooth contact [-]."""
    rolling_radius_1: float
    """Distance of the pitch point from the pinion's base tangent point, T1C [m]."""
    rolling_radius_2: float
    """The same for the wheel, T2C [m]."""
    friction_reversal_speed: float
    """Sliding speed over which friction changes sign at the pitch point [m/s]."""
    damping_depth: float = 1e-6
    """Penetration over which the damping of a contact grows to its full value [m], so that a tooth that
    touches with some speed starts at zero force (Hunt and Crossley, ASME J. Appl. Mech. 42, 1975)."""
    back_deviation_1: Array | None = None
    """Gap added by each pinion tooth on its back flank, shape as ``deviation_1`` [m]; None: the same as in front."""
    back_deviation_2: Array | None = None
    """The same for the wheel, shape as ``deviation_2`` [m]."""
    damping_acts_on: DampedRate = "relative_rotation"
    """Rate that the damper of a contact answers to."""
    body_compliance: float = 0.0
    """Compliance of both gear bodies that all tooth pairs share [m/N]; 0: every pair deflects alone."""
    slice_face: Array | None = None
    """Face position of each slice from mid-face, shape (n_slices,) [m]; None where tilt does not matter."""
    turning_deviation: Array | None = None
    """Part of the deviations that turns with its gear, an eccentricity, so that all slices of a tooth see it at one
    rotation: shape (2, teeth_1 + teeth_2, n_path), in front and on the back [m]; None: none."""


def back_deviations(law: MeshLaw) -> tuple[Array, Array]:
    """Return the gaps that the teeth of pinion and wheel add on their back flanks, shapes as in front [m]."""
    return (
        law.deviation_1 if law.back_deviation_1 is None else law.back_deviation_1,
        law.deviation_2 if law.back_deviation_2 is None else law.back_deviation_2,
    )


def in_parallel(law: MeshLaw, count: int) -> MeshLaw:
    """The law of ``count`` equal meshes side by side on one pair of axes, their flanks in line: the halves of a
    double-helical gear where both carry, whose axial forces cancel."""
    if count == 1:
        return law
    return law._replace(
        stiffness=count * law.stiffness,
        mean_stiffness=count * law.mean_stiffness,
        damping=count * law.damping,
        body_compliance=law.body_compliance / count,
    )


def law_content(law: MeshLaw) -> tuple[object, ...]:
    """All numbers of a law, hashable: what results that follow from it are kept by."""
    return tuple((value.shape, value.tobytes()) if isinstance(value, np.ndarray) else value for value in law)


def check_mesh_law(law: MeshLaw) -> None:
    """Raise ``ValueError`` naming value, limit and remedy if the tables do not describe a possible mesh."""
    n_slices, n_path = law.stiffness.shape
    positive = {
        "base_radius_1": law.base_radius_1,
        "base_radius_2": law.base_radius_2,
        "base_pitch": law.base_pitch,
        "path_step": law.path_step,
        "mean_stiffness": law.mean_stiffness,
        "damping_depth": law.damping_depth,
        "teeth_1": law.teeth_1,
        "teeth_2": law.teeth_2,
    }
    for name, value in positive.items():
        if not (value > 0.0 and np.isfinite(value)):
            raise DynamicsInputError(f"mesh law: {name} = {value} must be positive and finite")
    not_negative = {
        "backlash": law.backlash,
        "body_compliance": law.body_compliance,
        "damping": law.damping,
        "friction": law.friction,
        "friction_reversal_speed": law.friction_reversal_speed,
        "least stiffness": float(np.min(law.stiffness)),
        "least scale_1": float(np.min(law.scale_1)),
        "least scale_2": float(np.min(law.scale_2)),
    }
    for name, value in not_negative.items():
        if not (value >= 0.0 and np.isfinite(value)):
            raise DynamicsInputError(f"mesh law: {name} = {value} must not be negative")
    if law.body_compliance * law.mean_stiffness >= 1.0:
        raise DynamicsInputError(
            f"mesh law: body_compliance = {law.body_compliance:.3g} m/N must be below the compliance of the mesh, "
            f"{1.0 / law.mean_stiffness:.3g} m/N; the mean stiffness is that of teeth and bodies together"
        )
    if law.damping_acts_on not in get_args(DampedRate):
        raise DynamicsInputError(
            f"mesh law: damping_acts_on = {law.damping_acts_on!r} must be {' or '.join(get_args(DampedRate))}"
        )
    back_1, back_2 = back_deviations(law)
    shapes: dict[str, tuple[tuple[int, ...], tuple[tuple[int, ...], ...]]] = {
        "gap": (law.gap.shape, ((n_slices, n_path),)),
        "slice_shift": (law.slice_shift.shape, ((n_slices,),)),
        "slice_face": (
            law.slice_shift.shape if law.slice_face is None else law.slice_face.shape,
            ((n_slices,),),
        ),
        "deviation_1": (law.deviation_1.shape, ((law.teeth_1, n_path), (1, n_path))),
        "deviation_2": (law.deviation_2.shape, ((law.teeth_2, n_path), (1, n_path))),
        "back_deviation_1": (back_1.shape, (law.deviation_1.shape,)),
        "back_deviation_2": (back_2.shape, (law.deviation_2.shape,)),
        "turning_deviation": (
            (0,) if law.turning_deviation is None else law.turning_deviation.shape,
            ((0,), (2, law.teeth_1 + law.teeth_2, n_path)),
        ),
        "scale_1": (law.scale_1.shape, ((law.teeth_1,), (1,))),
        "scale_2": (law.scale_2.shape, ((law.teeth_2,), (1,))),
    }
    for name, (shape, allowed) in shapes.items():
        if shape not in allowed:
            raise ValueError(f"mesh law: {name} has shape {shape}, expected {' or '.join(map(str, allowed))}")
    if n_slices < 1 or n_path < 2:
        raise ValueError(
            f"mesh law: stiffness has shape {law.stiffness.shape}; one slice and two path points are needed"
        )
    if not all(
        np.all(np.isfinite(table)) for table in (law.gap, law.deviation_1, law.deviation_2, back_1, back_2)
    ):
        raise DynamicsInputError(
            "mesh law: gap and deviations must be finite; let the gap grow outside the active path"
        )
