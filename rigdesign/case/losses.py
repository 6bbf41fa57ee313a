"""How power losses are found: computed, or given by place."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Literal, Protocol, TypeAlias

from pydantic import Field

from rigdesign.case.fields import OF_HEAT, Effect, MistDensity, Name, Part, Positive, Power, Usual


@dataclass(frozen=True, kw_only=True)
class LossKind:
    """A kind of loss: which parts of a gearbox have it, and where its heat and its torque go."""

    name: str
    """As results and ``losses.given`` name it."""
    parts: Literal["meshes", "gears", "bearings", "seals"]
    """Parts of a gearbox that lose so."""
    needs: Literal["sump", "jets"] | None = None
    """What the gearbox has to have for it."""
    factor: str = ""
    """Its key among `LossFactors`; its name when left out."""
    given: bool = True
    """Whether a case may give it."""
    awaited: bool = True
    """Whether a case that gives its losses leaves something out where it gives none."""
    of_teeth: bool = False
    """Friction of teeth: the mesh law brakes with it, holds its factor and its limits."""
    at_bearings: bool = False
    """Friction of bearings, whose state holds its factor; what enters the oil enters that of the bearings."""
    ends_with_oil: bool = False
    """Whether it ends where no oil is fed."""
    heats: Literal["gear", "seal", "seats"] | None = None
    """Bodies that take their part of it; of a mesh its split says so."""
    body_shares: tuple[str, ...] = ()
    """Keys of ``heat_split`` whose sum enters these bodies."""

    def parts_of(self, box: "Losing") -> list[str]:
        """Names of the parts of a gearbox that lose so."""
        if self.needs is not None and getattr(box, self.needs) is None:
            return []
        return list(getattr(box, self.parts))

    def braked(self, box: "Losing", part: str) -> str:
        """Place of the gearbox at which its torque brakes a shaft: the pinion of a mesh, else the part itself."""
        if self.parts == "meshes":
            return box.meshes[part].pinion
        return f"seals.{part}" if self.parts == "seals" else part


class _Mesh(Protocol):
    @property
    def pinion(self) -> str: ...


class Losing(Protocol):
    """What a kind of loss asks of a gearbox."""

    @property
    def meshes(self) -> Mapping[str, _Mesh]:
        """By name."""


LOSS_KINDS = {
    kind.name: kind
    for kind in (
        LossKind(name="mesh", parts="meshes", of_teeth=True),
        LossKind(name="bearing", parts="bearings", at_bearings=True, heats="seats"),
        LossKind(name="windage", parts="gears", heats="gear", body_shares=("windage_into_gears",)),
        LossKind(name="churning", parts="gears", needs="sump", awaited=False),
        LossKind(
            name="seal", parts="seals", heats="seal", body_shares=("seal_into_shaft", "seal_into_housing")
        ),
        LossKind(name="oil_acceleration", parts="meshes", needs="jets", factor="jet", ends_with_oil=True),
        LossKind(name="squeeze", parts="meshes", awaited=False, ends_with_oil=True),
        LossKind(name="mesh_damping", parts="meshes", awaited=False, given=False),
    )
}
"""Kinds of losses by name; a further kind joins here."""
if TYPE_CHECKING:
    GivenLossKind: TypeAlias = str
else:
    GivenLossKind = Literal[tuple(kind.name for kind in LOSS_KINDS.values() if kind.given)]

LossFactor = Annotated[float, Field(ge=0.0, le=10.0), Usual(0.15, 7.0)]
"""Multiplies a loss: what it really is, over what its law or the case says."""


class LossFactors(Part):
    """Losses of one gearbox over what their laws, or the case, say: heat in the box and torque on its shafts alike."""

    mesh: LossFactor = 1.0
    """Multiplies the friction coefficient of the teeth."""
    bearing: LossFactor = 1.0
    """Multiplies the friction of the bearing films, or their constant drag."""
    windage: LossFactor = 1.0
    """Multiplies the windage of the gears."""
    churning: LossFactor = 1.0
    """Multiplies the churning of gears that dip."""
    seal: LossFactor = 1.0
    """Multiplies the losses of the seals."""
    jet: LossFactor = 1.0
    """Multiplies the power that brings the oil of the jets up to speed."""
    squeeze: LossFactor = 1.0
    """Multiplies squeezing, a share of the mesh loss: follows ``mesh`` as well."""

    def of(self, kind: str) -> float:
        """Factor of a kind of loss as results name it."""
        factor: float = getattr(self, LOSS_KINDS[kind].factor or kind)
        return factor


class GivenLoss(Part):
    """A power loss prescribed or measured at one place; with basis ``computed`` it overrides that place."""

    gearbox: Name
    """Gearbox in which it arises."""
    kind: GivenLossKind
    """Kind of the loss."""
    part: Name
    """Mesh, bearing, seal or gear (windage) of that gearbox."""
    power: Annotated[Power, Usual(5e-5, 0.02, "circulating power")]
    """The loss as a power."""
    stages: tuple[Name, ...] = ()
    """Stages it holds for; all when empty."""


class DoleschelConstants(Part):
    """Constants of one oil from its FZG efficiency test (Doleschel, TU Munich 2003)."""

    solid: Positive
    """Friction coefficient of solid contact at 1000 N/mm2 and 0.2 m/s."""
    solid_pressure_exponent: float
    """Of the solid coefficient over p_H / 1000 N/mm2."""
    solid_speed_exponent: float
    """Of the solid coefficient over the sum speed / 0.2 m/s."""
    fluid: Positive
    """Friction coefficient of the full film at 1000 N/mm2, 8.3 m/s and 20 mPa s."""
    fluid_pressure_exponent: float
    """Of the film coefficient over p_H / 1000 N/mm2."""
    fluid_speed_exponent: float
    """Of the film coefficient over the sum speed / 8.3 m/s."""
    fluid_viscosity_exponent: float
    """Of the film coefficient over the dynamic viscosity / 20 mPa s."""


class ToothFriction(Part):
    """Friction coefficient of the tooth contact, used in the torque loop and for the loss."""

    law: Literal["schlenk", "michaelis", "doleschel", "constant"] = "schlenk"
    """Which law gives the mean friction coefficient: Schlenk (ISO/TR 14179-2), Michaelis, Doleschel with the
    constants of an oil test, or a constant."""
    lubricant_factor: float | None = Field(default=None, gt=0.1, le=2.0)
    """X_L; that of the oil when left out."""
    coefficient: Annotated[float, Usual(0.01, 0.15)] | None = Field(default=None, ge=0.0, le=0.5)
    """Friction coefficient when the law is ``constant``."""
    doleschel: DoleschelConstants | None = None
    """Oil constants when the law is ``doleschel``."""


OF_LOSS = Effect(solved=("coupling",), through_heat=True)


class Losses(Part):
    """Basis and inputs of the losses."""

    basis: Literal["computed", "input"]
    """computed: every loss by its law; input: only those under ``given``."""
    given: Annotated[Mapping[Name, GivenLoss], OF_HEAT] = {}
    """Losses prescribed or measured, by name."""
    friction: Annotated[ToothFriction, OF_LOSS] = ToothFriction()
    """Friction of the teeth."""
    chamber_density: Annotated[MistDensity, OF_LOSS] | None = None
    """Density of the oil-air mist round the gears, for windage."""
    squeeze_share: Annotated[float, Usual(0.01, 0.1), OF_LOSS] = Field(default=0.0, ge=0.0, le=0.10)
    """Squeezing of oil out of the mesh, as a share of the mesh loss."""
    mesh_damping_heats_oil: Annotated[bool, OF_HEAT] = False
    """Whether the work of the mesh dampers is heat of the gear oil. Left out, the motor pays it and it stands among the
    losses, but heats nothing: such a damper stands for all that damps the vibration of a loop, tooth friction and
    films having their own heat."""
    bearing_drag: Literal["film", "constant"] = "film"
    """film: from the bearing solution; constant: ``torsional_damping`` of each bearing, and
    nothing else brakes the shafts or loses power, teeth aside (P2's simulation)."""
