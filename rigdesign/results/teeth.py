"""Contact, flanks and root stress of the teeth: SI records."""

from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray

from dynamics.gear.flank import AxisMisalignment, Flank
from dynamics.rating.flank_contact import ContactFactors, Pitting
from dynamics.rating.micropitting import FilmRatios
from dynamics.rating.root_stress import MeanRootStress, mean_stress_factor
from dynamics.rating.scuffing import ContactTemperature
from dynamics.tooth.mesh_cycle import MeshCycle
from dynamics.tooth.points import face_sense
from dynamics.tooth.root_field import Fillet, RootCourse, ToothTurn
from rigdesign.results.quantity import Quantity
from rigdesign.strain_gauge.measuring_point import GaugeCurve, MeasuringPoint

Array = NDArray[np.float64]
Row = tuple[float, ...]
StressSource = Literal["finite-element influence numbers", "ISO 6336-3 form and stress correction factors"]
FROM_INFLUENCE: StressSource = "finite-element influence numbers"
FROM_FACTORS: StressSource = "ISO 6336-3 form and stress correction factors"
"""Where the root stress per tooth force comes from."""


@dataclass(frozen=True, kw_only=True, eq=False)
class GaugeStress:
    """Quasi-static, of one tooth on its way through the mesh."""

    name: str
    gear: str
    """``pinion`` or ``wheel`` of the mesh."""
    tooth: int
    front: bool
    """Under the front flank, else under the back flank; the first is pulled where the mesh runs on its front flanks."""
    point: MeasuringPoint
    curve: GaugeCurve

    @cached_property
    def output(self) -> Array:
        """(n,) output of the bridge over its supply, balanced without load, at the angles of the curve [V/V]."""
        return np.asarray(self.point.ratio(self.curve.stress) - self.point.ratio(0.0))


@dataclass(frozen=True, kw_only=True)
class LoadedContact:
    """Contact of the warm teeth over one mesh cycle, and the root stress it gives."""

    stage: str
    torque: float
    """Mean, at the pinion, positive on either flank [N m]."""
    flank: Flank
    """Which flanks carry."""
    axes: AxisMisalignment
    """As made and of the warm housing, over z of the face."""
    cycle: MeshCycle
    unloaded_contact_ratio: float
    """In the limit of no load, modifications included [-]."""
    roots: tuple[RootCourse, RootCourse]
    """Under the loaded flanks of pinion and wheel.

    Face positions of cycle and roots are those of the contact, z times `face_sense`.
    """

    at_tangent: tuple[Array, Array] | None = None
    """Highest stress at the 30 deg tangent over the face positions of ``roots`` [Pa]."""
    gauges: tuple[GaugeStress, ...] = ()
    """Of both gears, in the order of the case."""

    @property
    def face_sense(self) -> float:
        """Face position z, positive at the end that comes into mesh last, per face position of the contact."""
        return face_sense(self.flank)

    @cached_property
    def edges(self) -> "EdgeContact":
        """Contact at the tip edges and at the ends of the face."""
        return EdgeContact.of(self.cycle, self.flank)


@dataclass(frozen=True, kw_only=True)
class EdgeContact:
    """Contact where a flank ends; pressures [Pa], 0 without contact.

    tip_pressures : at the tip edges of pinion and wheel; tip_share : largest share of both in the mesh force
    end_pressures : on the flank at both ends of the face, negative z first, away from tip edges; None where the face
        is one position
    middle_pressure : the same at mid-face
    """

    tip_pressures: tuple[float, float]
    tip_share: float
    end_pressures: tuple[float, float] | None
    middle_pressure: float

    @classmethod
    def of(cls, cycle: MeshCycle, flank: Flank) -> "EdgeContact":
        """Over a mesh cycle on the flanks that carry."""
        on_edge, pressure = cycle.edge_contact, cycle.pressure
        carried = (cycle.points.weight * cycle.force * on_edge).sum(axis=(1, 2)) / cycle.mesh_force
        limits = cycle.points.pair.path
        ahead = cycle.points.path < 0.5 * (limits.start + limits.end)
        of_wheel, of_pinion = (
            float(np.where(on_edge & where, pressure, 0.0).max()) for where in (ahead, ~ahead)
        )
        free = np.where(on_edge, 0.0, pressure)
        over_face = free.max(axis=(0, 1))[:: int(face_sense(flank))]
        return cls(
            tip_pressures=(of_pinion, of_wheel),
            tip_share=float(carried.max()),
            end_pressures=(float(over_face[0]), float(over_face[-1])) if len(over_face) > 1 else None,
            middle_pressure=float(over_face[len(over_face) // 2]),
        )

    @property
    def tip_pressure(self) -> float:
        """Higher of both tip edges."""
        return max(self.tip_pressures)

    @property
    def where(self) -> str:
        """Tip edges that carry, in words."""
        named = [gear for gear, one in zip(("pinion", "wheel"), self.tip_pressures, strict=True) if one > 0.0]
        return f"tip edge of {' and '.join(named)}" if named else "no tip edge carries"

    @property
    def end_ratio(self) -> float | None:
        """Higher of both face ends over mid-face [-]; None without ends or without contact in the middle."""
        if self.end_pressures is None or self.middle_pressure == 0.0:
            return None
        return max(self.end_pressures) / self.middle_pressure


@dataclass(frozen=True, kw_only=True)
class PairShare:
    """Force on one tooth pair over the way through the mesh at a held stage."""

    mesh: str
    stage: str
    angle: Annotated[Row, Quantity("deg")]
    """(n,) rolling angle of the pinion, zero at the pitch point."""
    share: Row
    """(n,) of the force of the mesh at that moment, in motion [-]."""
    static_share: Row
    """(n,) at rest [-]"""
    force: Row
    """(n,) over the mean force of the mesh, in motion [-]."""
    most_loaded: Annotated[float, Quantity("deg")]
    """Rolling angle at which a pair carries most, in motion."""
    face: Annotated[Row, Quantity("mm")]
    """(m,) position of the slices from mid-face; empty for a mesh of one slice, as the line loads."""
    line_load: Annotated[Row, Quantity("N/mm")]
    """(m,) force in the transverse line of action per face width there, in motion."""
    static_line_load: Annotated[Row, Quantity("N/mm")]
    """(m,) at rest, at the same place on the path."""


@dataclass(frozen=True, kw_only=True)
class FlankRating:
    """Pitting of both gears, contact temperature and film of their mesh at one held stage."""

    stage: str
    factors: ContactFactors
    sharing_basis: str
    """Where K_Hbeta and K_Halpha come from, in words."""
    oil_temperature: float
    """As it reaches the mesh, or of the sump [K]."""
    bulk_temperature: float
    """Of the teeth, mean of both gears [K]."""
    bulk_basis: str
    """Where that comes from, in words."""
    pitting: tuple[Pitting, Pitting] | None = None
    no_pitting: str = ""
    """Why it is not rated."""
    contact: ContactTemperature | None = None
    films: FilmRatios | None = None
    no_contact: str = ""
    """Why the contact is not followed over the path."""
    scuffing_temperature: float | None = None
    """Of the oil on these flanks [K]."""
    scuffing_safety: float | None = None
    """S_B [-]."""
    no_scuffing: str = ""
    """Why it is not rated."""


@dataclass(frozen=True)
class FilletStress:
    """Highest and lowest stress of one fillet over a turn, with that at rest [Pa]."""

    highest: float
    lowest: float

    @property
    def ratio(self) -> float:
        """R, lowest over highest stress [-]."""
        return self.lowest / self.highest


@dataclass(frozen=True, kw_only=True)
class ToothHistory:
    """Both root fillets of a tooth at the held stage that speaks for the rig."""

    gear: str
    """``gearbox.gear``"""
    stage: str
    meshes: tuple[str, ...]
    """Labels of the meshes that load it, in which it is rated."""
    turn: ToothTurn
    """Stress of the tooth forces times K_A of their mesh."""
    mean: MeanRootStress
    """Held all the time, on top."""
    sensitivity: float
    """M of ISO 6336-3, Annex B [-]."""
    source: StressSource

    @property
    def fillet(self) -> Fillet:
        """The fillet that is stressed most: ``leading`` or ``trailing`` flank."""
        return "leading" if self.turn.leading.max() >= self.turn.trailing.max() else "trailing"

    def of(self, fillet: Fillet) -> FilletStress:
        """Stress of one fillet."""
        stress = self.turn.leading if fillet == "leading" else self.turn.trailing
        return FilletStress(float(np.max(stress)) + self.mean.total, float(np.min(stress)) + self.mean.total)

    @property
    def highest(self) -> float:
        """Highest stress with that at rest [Pa]."""
        return self.of(self.fillet).highest

    @property
    def lowest(self) -> float:
        """Lowest stress of the same fillet with that at rest [Pa]."""
        return self.of(self.fillet).lowest

    @property
    def stress_ratio(self) -> float:
        """R of this fillet [-]."""
        return self.of(self.fillet).ratio

    @property
    def mean_stress_factor(self) -> float:
        """Y_M of ISO 6336-3 at this stress ratio [-]."""
        return mean_stress_factor(self.stress_ratio, self.sensitivity)


@dataclass(frozen=True, kw_only=True)
class DynamicRootCurve:
    """Stress at one place of a root at one speed, dynamic and quasi-static, over the way through the mesh."""

    mesh: str
    """Its label."""
    gear: str
    """``pinion`` or ``wheel``."""
    gauge: str
    """Name of the strain gauge; empty for the point of fillet and face that is stressed most."""
    stage: str
    """Held stage; empty for a speed that the case asks for."""
    in_motion: bool
    """False where no periodic response was found at an asked speed: the dynamic stress is then the quasi-static one."""
    speed: float
    """Of the gear [rad/s]."""
    pinion_speed: float
    """Of the pinion of the mesh [rad/s]."""
    angle: Row
    """(n,) rolling angle of the gear, zero at the pitch point, growing towards its tip [rad]."""
    dynamic: Row
    """(n,) [Pa]"""
    quasi_static: Row
    """(n,) [Pa]"""
    strain: Row
    """(n,) of the dynamic stress [-]"""
    strain_rate: Row
    """(n,) [1/s]"""
    source: StressSource

    @property
    def ratio(self) -> float:
        """Highest dynamic over highest quasi-static stress [-]."""
        return max(self.dynamic) / max(self.quasi_static)

    @property
    def highest_rate(self) -> float:
        """Largest strain rate, whichever its sign [1/s]."""
        return max(self.strain_rate, key=abs)


@dataclass(frozen=True, kw_only=True)
class MissingRootSpeed:
    """A speed asked for at which no periodic response was found; its curves are quasi-static."""

    speed: float
    """Stated [rad/s]."""
    reason: str


@dataclass(frozen=True, kw_only=True)
class DynamicRootRecord:
    """All curves, and the speeds that are missing."""

    curves: tuple[DynamicRootCurve, ...]
    missing: tuple[MissingRootSpeed, ...]
