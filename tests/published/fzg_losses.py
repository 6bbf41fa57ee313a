"""Rows of mesh losses of FZG efficiency gears against a public calculation, and of the journal film against a table.

Found by these rows: the printed loss of C14 is transmitted power times friction times the loss factor under elastic
load sharing, 0.1946, not times 0.1986. For H501 its friction counts the load on all contact lines without the floor of
150 N/mm that ISO/TR 14179-2 sets. For H951 it lets the tip circles alone bound the path, where the root of the mating
gear, cut by a standard rack, ends the flank earlier.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

from dynamics.gear.pair import GearPair
from dynamics.gear.pair_geometry import TipShortening
from dynamics.rotor.journal_film import characteristic
from dynamics.tooth.friction import (
    Schlenk,
    ToothPath,
    friction_coefficient,
    ohlendorf_factor,
    tooth_loss_factor,
)
from dynamics.tooth.mesh_laws import pair_stiffness
from tests.published.rows import Gate, Goal, PublishedQuantity, ValidationRow, compare

GEARPIE = "GEARpie (C. Fernandes, University of Porto), printed report"
RPM = math.pi / 30.0


@dataclass(frozen=True, kw_only=True)
class LossTest:
    """A gear pair on a = 91.5 mm at one operating point, as its report states it; SI units.

    tip_radii : printed; oil_viscosity : dynamic, at the printed oil temperature; sharing : how pairs share the load
    printed : loss factor, friction coefficient, loss [W]
    """

    name: str
    teeth: tuple[int, int]
    module: float
    helix: float
    width: float
    shifts: tuple[float, float]
    tip_radii: tuple[float, float]
    torque: float
    speed: float
    roughness: float
    oil_viscosity: float
    lubricant_factor: float
    sharing: str
    printed: tuple[float, float, float]
    note: str = ""

    @property
    def pair(self) -> GearPair:
        """With the tips cut to the printed radii."""
        reference = [0.5 * self.module * z / math.cos(self.helix) for z in self.teeth]
        full = [radius + self.module * (1.0 + x) for radius, x in zip(reference, self.shifts, strict=True)]
        first, second = (max(0.0, tip - own) for tip, own in zip(full, self.tip_radii, strict=True))
        return GearPair.from_centre_distance(
            normal_module=self.module,
            teeth=self.teeth,
            centre_distance=91.5e-3,
            face_widths=(self.width, self.width),
            profile_shift_1=self.shifts[0],
            helix_angle=self.helix,
            tips=TipShortening(shortening=(first, second)),
        )


TESTS = (
    LossTest(
        name="C14", teeth=(16, 24), module=4.5e-3, helix=0.0, width=14e-3, shifts=(0.1817, 0.1715),
        tip_radii=(41.318e-3, 59.272e-3), torque=200.0, speed=1500.0, roughness=0.355e-6, oil_viscosity=13.28e-3,
        lubricant_factor=0.85, sharing="elastic", printed=(0.1946, 0.0449, 274.37),
    ),
    LossTest(
        name="C40", teeth=(16, 24), module=4.5e-3, helix=0.0, width=40e-3, shifts=(0.1817, 0.1715),
        tip_radii=(41.318e-3, 59.272e-3), torque=215.5, speed=1800.0, roughness=0.355e-6, oil_viscosity=49.85e-3,
        lubricant_factor=0.65, sharing="rigid", printed=(0.1984, 0.0256, 206.31),
    ),
    LossTest(
        name="H501", teeth=(20, 30), module=3.5e-3, helix=math.radians(15.0), width=23e-3, shifts=(0.1809, 0.0891),
        tip_radii=(40.336e-3, 58.132e-3), torque=100.0, speed=1000.0, roughness=0.6e-6, oil_viscosity=32.67e-3,
        lubricant_factor=0.85, sharing="rigid", printed=(0.1869, 0.0420, 82.20),
        note="printed friction without the floor of 150 N/mm of line load: 3 % lower",
    ),
    LossTest(
        name="H951", teeth=(38, 57), module=1.75e-3, helix=math.radians(15.0), width=21.2418e-3,
        shifts=(1.6915, 2.0003), tip_radii=(38.115e-3, 55.867e-3), torque=200.0, speed=1000.0, roughness=0.6e-6,
        oil_viscosity=32.67e-3, lubricant_factor=0.85, sharing="tips", printed=(0.0688, 0.0458, 65.97),
        note="path between the tip circles as printed; with the form circles of a standard rack 0.0660",
    ),
)  # fmt: skip


def fzg_loss_rows() -> Iterator[ValidationRow]:
    """Loss factor, friction and loss of four gears; Ohlendorf's factor of the first; one journal bearing."""
    first = ToothPath.of_pair(TESTS[0].pair)
    yield compare(
        PublishedQuantity(
            id="GEARpie-C14-HV", text="Ohlendorf's loss factor, C14", source=GEARPIE, value=0.1986, unit="1"
        ),
        ohlendorf_factor(first, TESTS[0].teeth[0]),
        "verification",
        Gate(0.001),
    )
    for test in TESTS:
        yield from _loss(test)
    yield from _journal()


def _loss(test: LossTest) -> Iterator[ValidationRow]:
    pair = test.pair
    path = ToothPath.of_pair(pair)
    contact = path.contact(
        test.torque,
        test.speed * RPM,
        reference_diameter_1=2.0 * pair.reference_radii[0],
        roughness=test.roughness,
        viscosity=test.oil_viscosity,
    )
    friction = friction_coefficient(contact, Schlenk(lubricant_factor=test.lubricant_factor)).value
    if test.sharing == "tips":
        path = replace(path, start=pair.path.tip_start, end=pair.path.tip_end)
    shape = pair_stiffness(pair, contact.line_load).at if test.sharing == "elastic" else None
    factor = tooth_loss_factor(path, shape)
    found = (factor, friction, test.torque * test.speed * RPM * factor * friction)
    names = (
        ("HVL", "loss factor", "1"),
        ("friction", "friction coefficient, Schlenk", "1"),
        ("loss", "mesh loss", "W"),
    )
    for (key, words, unit), printed, computed in zip(names, test.printed, found, strict=True):
        yield compare(
            PublishedQuantity(
                id=f"GEARpie-{test.name}-{key}",
                text=f"{words}, {test.name}, {test.torque:g} N m, {test.speed:g} rpm",
                source=GEARPIE,
                value=printed,
                unit=unit,
            ),
            computed,
            "verification",
            Goal(0.02),
            assumptions=test.note,
        )


def _journal() -> Iterator[ValidationRow]:
    """Lund and Thomsen's S = eta N D L / W (R/c)^2 = 1 / (2 pi So)."""
    curve = characteristic(0.5)
    eccentricity = curve.eccentricity(1.0 / (2.0 * math.pi * 0.580))
    attitude = math.degrees(curve.attitude_angle(eccentricity))
    source = "Lund and Thomsen 1978, L/D = 0.5, S = 0.580"
    note = "the table is for a bearing with two axial grooves in the split, this film is fed without one"
    for key, words, value, unit, computed in (
        ("eccentricity", "relative eccentricity of a journal bearing", 0.477, "1", eccentricity),
        ("attitude", "attitude angle of a journal bearing", 51.0, "deg", attitude),
    ):
        yield compare(
            PublishedQuantity(id=f"Lund-Thomsen-{key}", text=words, source=source, value=value, unit=unit),
            computed,
            "verification",
            Goal(0.02),
            assumptions=note,
        )
