"""Root stress over the path of contact: local lever by ISO 6336-3 factors, history from tooth forces.

The load of a tooth pair bends the tooth at whatever height it acts. Form and stress correction factor are
therefore taken at the load point of each path position instead of the one point that ISO 6336-3 rates, which
turns the mesh force history of one tooth into the stress history at its 30 degree tangent. No face spreading
and no share of neighbouring teeth: the line load at the root is that at the contact.
"""

from dataclasses import dataclass
from math import cos

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dynamics.errors import DynamicsInputError
from dynamics.gear.pair import GearPair
from dynamics.rating.iso_rating import MM, root_width, tooth_root
from dynamics.standards import iso6336_3_2006

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class RootInfluence:
    """Stress at the 30 degree tangent of one gear per transverse line load at a path position.

    path : (n,) positions on the path from the pitch point, rising [m]
    value : (n,) stress per line load [Pa per N/m]
    width : face width of the root that carries the load [m]
    """

    path: Array
    value: Array
    width: float

    def at(self, path: ArrayLike) -> Array:
        """Influence at ``path`` positions [m], same shape [Pa per N/m]; held beyond the active path."""
        return np.asarray(np.interp(np.asarray(path, dtype=float), self.path, self.value))


def root_influence(pair: GearPair, index: int, *, n_path: int = 161) -> RootInfluence:
    """Local-lever root influence of gear ``index`` (0 pinion, 1 wheel) over the active path.

    sigma = F_bt/b cos(alpha_t)/m_n Y_F(s) Y_S(s) Y_beta (ISO 6336-3:2006, 5.2 with the load point moved); at
    the outer point of single contact this is the nominal stress of method B. Below the 30 degree section the
    value of the lowest load point above it is kept.
    """
    limits = pair.path
    root = tooth_root(pair, index)
    path = np.linspace(limits.start, limits.end, n_path)
    from_tip = limits.tip_end - path if index == 0 else path - limits.tip_start
    tip_roll = 0.5 * (root.d_an**2 - root.d_bn**2) ** 0.5
    roll = tip_roll - from_tip * MM / cos(pair.base_helix_angle)
    diameters = 2.0 * np.hypot(roll, 0.5 * root.d_bn)
    loaded = iso6336_3_2006.loaded_root(root, iso6336_3_2006.root_section(root), diameters)
    above = np.flatnonzero((loaded.h_Fe > 0.0) & (roll > 0.0))
    if not len(above):
        raise DynamicsInputError(
            f"gear {index}: no load point lies above its 30 degree section, so it has no bending lever; "
            "check addendum and root of both gears"
        )
    factors = np.zeros(n_path)
    factors[above] = loaded.Y_F[above] * loaded.Y_S[above]
    # the lowest load point of the pinion is at the start of the path, that of the wheel at its end
    factors[: above[0]] = factors[above[0]]
    factors[above[-1] + 1 :] = factors[above[-1]]
    helix = iso6336_3_2006.Y_beta(pair.overlap_ratio, root.beta)
    scale = cos(pair.transverse_pressure_angle) * helix / pair.gears[index].normal_module
    return RootInfluence(path=path, value=scale * factors, width=root_width(pair, index))


def root_stress_over_face(
    influence: RootInfluence, slice_forces: ArrayLike, path: ArrayLike, slice_shift: ArrayLike, width: float
) -> Array:
    """Root stress of one followed tooth by face slice [Pa], shape (n, n_slices).

    slice_forces : (n, n_slices) force of each slice [N]
    path : (n,) path position of the contact at mid-face [m]
    slice_shift : (n_slices,) lag of each slice on the path [m], as in ``MeshLaw``
    width : common face width [m]
    """
    loads = np.asarray(slice_forces, dtype=float)
    shift = np.asarray(slice_shift, dtype=float)
    if loads.ndim != 2 or loads.shape != (len(np.atleast_1d(path)), len(shift)):
        raise DynamicsInputError(
            f"slice_forces {loads.shape} must have a row for each of the {len(np.atleast_1d(path))} path "
            f"positions and a column for each of the {len(shift)} slices"
        )
    places = np.asarray(path, dtype=float)[:, None] - shift[None, :]
    return np.asarray(loads / (width / len(shift)) * influence.at(places))
