"""Seals of shafts as the case states them, and what seals a shaft where it leaves its gearbox.

What seals there is a kind of its own, registered under its name: whether it touches, its loss, and what a case without
its measures assumes.
"""

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Annotated, ClassVar, Literal, TypeAlias

from dynamics.losses.loss import Loss
from dynamics.losses.seal_loss import SealGap, gap_seal_loss, lip_seal_loss
from dynamics.losses.windage import Mist
from rigdesign.case.fields import Clearance, Effect, Name, Part, Torque, Usual


class EndSeal(ABC):
    """What seals a shaft where it leaves its gearbox."""

    name: ClassVar[str]
    """As a case writes it."""
    touches: ClassVar[bool]
    """A lip on the shaft; else a gap that must stay open."""
    usual_travel: ClassVar[tuple[str, str, str, str]]
    """Axial movement it takes where a case states none, its reason, least and most."""

    @abstractmethod
    def loss(self, place: str, diameter: float, omega: float, gap: SealGap | None, mist: Mist) -> Loss | None:
        """Power lost on a shaft of a diameter [m] at a speed [rad/s]; None where nothing is known of it.

        gap : between shaft and wall; None where no wall is stated
        mist : what the shaft turns in
        """


class ContactlessSeal(EndSeal):
    """Gap or labyrinth."""

    name = "contactless"
    touches = False
    usual_travel = ("1 mm", "axial gap of a labyrinth", "0.5 mm", "1.5 mm")

    def loss(self, place: str, diameter: float, omega: float, gap: SealGap | None, mist: Mist) -> Loss | None:
        """That of the gap."""
        return None if gap is None else gap_seal_loss(place, gap, omega, mist.density, mist.viscosity)


class RadialLip(EndSeal):
    """Radial lip of rubber."""

    name = "radial_lip"
    touches = True
    usual_travel = ("3 mm", "a lip slides along its shaft", "1 mm", "5 mm")

    def loss(self, place: str, diameter: float, omega: float, gap: SealGap | None, mist: Mist) -> Loss | None:
        """That of the lip, whatever wall it sits in."""
        return lip_seal_loss(place, diameter, omega)


WALL = ContactlessSeal()
"""A shaft passes a wall of its chamber in a gap."""
END_SEALS: dict[str, EndSeal] = {kind.name: kind for kind in (WALL, RadialLip())}
"""Kinds by name; a further kind joins here."""
if TYPE_CHECKING:
    EndSealName: TypeAlias = str
else:
    EndSealName = Literal[tuple(END_SEALS)]


class Seals(Part):
    """Seals of one shaft: where it passes the walls of the chamber, and where it leaves the gearbox.

    A wall of the chamber always is a gap of ``radial_gap``; ``kind`` says what seals the shaft where it leaves, one
    seal a side. A gearbox without a housing has no walls: its shafts leave it towards couplings, motor and parts of
    other gearboxes.
    """

    shaft: Name
    """Shaft that they seal."""
    kind: EndSealName = "contactless"
    """What seals the shaft where it leaves the gearbox: a gap without contact, or a radial lip."""
    radial_gap: Annotated[
        Clearance, Usual(1.5e-3, 0.03, "shaft diameter"), Effect(checks=(), where=("bare", "torsional"))
    ]
    """Half the difference of bore and shaft diameter as drawn; thermal expansion changes it."""
    axial_travel: Annotated[Clearance, Usual("0.35 mm", "8 mm"), Effect(checks=(), solved=())]
    """Axial movement of the shaft the seals take without touching."""
    rubbing_torque: Annotated[Torque, Usual(1e-5, 0.03, "test torque")] = 0.0
    """Friction torque of seals that touch, of all seals of the shaft together, on top of what ``kind`` loses."""

    @property
    def end(self) -> EndSeal:
        """What seals the shaft where it leaves."""
        return END_SEALS[self.kind]
