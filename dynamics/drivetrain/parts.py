"""Parts of a drivetrain: gear bodies, couplings, bearings, meshes, motor."""

from dataclasses import dataclass
from typing import Literal

from dynamics.drivetrain.shaft_torque import ShaftTorque

End = Literal["left", "right"]


@dataclass(frozen=True, kw_only=True)
class GearBody:
    """Rigid gear on a shaft, joined by a spline or key.

    position : on the shaft [m]; inertia [kg m2]; stiffness [N m/rad]; damping [N m s/rad].
    """

    name: str
    shaft: str
    position: float
    inertia: float
    stiffness: float
    damping: float = 0.0


@dataclass(frozen=True, kw_only=True)
class Coupling:
    """Massless spring and damper between two shaft ends: stiffness [N m/rad], damping [N m s/rad].

    Flange masses (a torque flange, say) are discs on the shafts. ``excitation`` acts between its ends, positive where
    it draws the first shaft ahead, and counts the turns of the first shaft.
    """

    name: str
    shafts: tuple[str, str]
    ends: tuple[End, End] = ("right", "left")
    stiffness: float
    damping: float = 0.0
    excitation: tuple[ShaftTorque, ...] = ()


@dataclass(frozen=True, kw_only=True)
class BearingPlace:
    """Bearing of a shaft as a place that brakes.

    ``linear_drag`` [N m s/rad] enters the damping matrix (P2, Table 1: 0.0007). Leave it 0 when the drag
    torque comes from a loss model: it is then applied through the drag load of the same name.
    """

    name: str
    shaft: str
    position: float
    linear_drag: float = 0.0


@dataclass(frozen=True, kw_only=True)
class DragPlace:
    """Any other place of a shaft that brakes (seal, windage of a disc): a named drag load."""

    name: str
    shaft: str
    position: float


@dataclass(frozen=True, kw_only=True)
class MeshConnection:
    """Gear mesh between two gear bodies: base radii [m], tooth numbers, working centre distance [m]."""

    name: str
    pinion: str
    wheel: str
    base_radii: tuple[float, float]
    teeth: tuple[int, int]
    centre_distance: float


@dataclass(frozen=True, kw_only=True)
class Motor:
    """Drive on a shaft: torque acts at ``position`` [m], on a rotor of its own if ``stiffness`` is given.

    inertia : rotor [kg m2], added to the station when there is no stiffness. ripple : of its torque about the mean.
    """

    shaft: str
    position: float
    inertia: float = 0.0
    stiffness: float | None = None
    damping: float = 0.0
    ripple: tuple[ShaftTorque, ...] = ()
