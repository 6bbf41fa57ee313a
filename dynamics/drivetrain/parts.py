"""Parts of a drivetrain: gear bodies, couplings, bearings, meshes, motor."""

from dataclasses import dataclass
from typing import Literal

from dynamics.drivetrain.periodic_load import LoadOrder
from dynamics.drivetrain.shaft import DrivetrainError, tilting_inertia

End = Literal["left", "right"]


@dataclass(frozen=True, kw_only=True)
class JointStiffness:
    """What a joint of two parts of one axis resists besides torsion; the torsional model does not read it.

    axial, lateral : between its middle sections, the same in all lateral directions [N/m]; angular : against tilting
    of one part against the other [N m/rad]; the dampers likewise [N s/m], [N m s/rad], turning with the shaft.

    Raises DrivetrainError for a negative value.
    """

    axial: float = 0.0
    lateral: float = 0.0
    angular: float = 0.0
    axial_damping: float = 0.0
    lateral_damping: float = 0.0
    angular_damping: float = 0.0

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if not value >= 0.0:
                raise DrivetrainError(f"joint: {name} = {value}: must not be negative; correct the sign")


@dataclass(frozen=True, kw_only=True)
class GearBody:
    """Rigid gear on a shaft, joined by a spline or key.

    position : on the shaft [m]; inertia [kg m2]; stiffness [N m/rad]; damping [N m s/rad]; loss_factor [-] : instead of
    a damping, friction whose damper depends on the speed (`dynamics.drivetrain.loss_factor`).

    Of the elastic rig alone: mass [kg]; diametral_inertia [kg m2], that of a cylinder if not given; width [m];
    offset : of the centre of the gear from its position, towards the right end of the shaft [m]; seat : None is rigid
    with the shaft in every direction but torsion.
    """

    name: str
    shaft: str
    position: float
    inertia: float
    stiffness: float
    damping: float = 0.0
    mass: float = 0.0
    diametral_inertia: float | None = None
    width: float = 0.0
    offset: float = 0.0
    seat: JointStiffness | None = None
    loss_factor: float = 0.0

    @property
    def tilting_inertia(self) -> float:
        """Inertia about a diameter [kg m2]: as given, else that of a cylinder, I_p / 2 + m b^2 / 12."""
        return tilting_inertia(f"gear body {self.name!r}", self)


@dataclass(frozen=True, kw_only=True)
class Coupling:
    """Massless spring and damper between two shaft ends: stiffness [N m/rad], damping [N m s/rad].

    Flange masses (a torque flange, say) are discs on the shafts. ``excitation`` acts between its ends, positive where
    it draws the first shaft ahead, and counts the turns of the first shaft. ``flexibility`` is what it resists besides
    torsion: nothing unless given.
    """

    name: str
    shafts: tuple[str, str]
    ends: tuple[End, End] = ("right", "left")
    stiffness: float
    damping: float = 0.0
    excitation: tuple[LoadOrder, ...] = ()
    flexibility: JointStiffness = JointStiffness()


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
    """Gear mesh between two gear bodies: base radii [m], tooth numbers, working centre distance [m].

    base_helix_angle : [rad], positive for a right-hand pinion, of a double-helical one for its half towards the front
    (lower x); of the elastic rig alone.
    """

    name: str
    pinion: str
    wheel: str
    base_radii: tuple[float, float]
    teeth: tuple[int, int]
    centre_distance: float
    base_helix_angle: float = 0.0


@dataclass(frozen=True, kw_only=True)
class Motor:
    """Drive on a shaft: torque acts at ``position`` [m], on a rotor of its own if ``stiffness`` is given.

    inertia : rotor [kg m2], added to the station when there is no stiffness. ripple : of its torque about the mean.
    mass [kg], width [m] and diametral_inertia [kg m2] : of the elastic rig alone, for a rotor that the shaft carries,
    rigid with the station. Without a diametral inertia bearings of its own carry it, and only its torsion counts.
    """

    shaft: str
    position: float
    inertia: float = 0.0
    stiffness: float | None = None
    damping: float = 0.0
    ripple: tuple[LoadOrder, ...] = ()
    mass: float = 0.0
    diametral_inertia: float | None = None
    width: float = 0.0

    @property
    def tilting_inertia(self) -> float:
        """Inertia about a diameter [kg m2]: as given, else that of a cylinder."""
        return tilting_inertia("motor", self)
