"""What a parametric gearbox is made of: chambers, walls, parallel shafts, bearings, seals and gears.

The housing is a closed box on a clamping field. Along x it has, from front to rear: end wall with bearings,
cold section, partition with contactless seals, warm chamber with gears, partition, cold section, end wall.

    x ->      0                                                                     length
              | end |  cold front  | part. |   warm chamber   | part. | cold rear | end |
    z = height -----------------------------------------------------------------------------
    z = shaft_height  ==[J]========[S]=========[ gear ]=========[S]===========[J]====== shaft
    z = 0      -----------------------------------------------------------------------------
              ################################ clamping field ################################

Without partitions it is one chamber between two end walls, which carry the bearings and stand in it:

    x ->      0                                                                     length
              | end |                         chamber                           | end |
    z = shaft_height  ==[J]==================[ gear ]========================[J]====== shaft

x runs along the shafts, y across, z up; y = 0 is the middle of the housing and of the field. All lengths in
metres, as drawn. A bearing sits at the inner side of its end wall, the end seal (or, at a blind shaft end, the
cover) outside of it; a bearing wider than the wall leaves room for protrudes into the housing on a boss.
"""

from dataclasses import dataclass, fields
from itertools import combinations

from thermal.errors import ThermalInputError
from thermal.housing.shaft_geometry import (
    MINIMUM_LAND,
    SIDES,
    EndBearing,
    GeometryError,
    ShaftGeometry,
    Side,
    require_positive,
)

PARTITIONS = ("cold_length_front", "cold_length_rear", "partition_thickness")
"""Measures that a housing has all of, or none of."""
SMALLEST_STEP = 1e-6
"""Protrusion [m] below which a bearing counts as flush with its wall."""


@dataclass(frozen=True, kw_only=True)
class ClampingField:
    """Plate under the housing, centred on it."""

    length: float
    """Along the shafts (x) [m]."""
    width: float
    """Across the shafts (y) [m]."""
    thickness: float

    def __post_init__(self) -> None:
        require_positive(self, "length", "width", "thickness")


@dataclass(frozen=True, kw_only=True)
class HousingGeometry:
    """A gearbox with any number of parallel shafts in one horizontal plane; see the module's drawing. Metres.

    Raises GeometryError (a ValueError) naming quantity, value, limit and remedy for a geometry that cannot be
    built: negative or non-finite lengths, walls without room between them, bores that leave the housing or
    run into each other, gears that do not fit their chamber, a field smaller than the foot.
    """

    chamber_length: float
    """Clear length of the warm chamber; without partitions from end wall to end wall."""
    cold_length_front: float = 0.0
    """Clear length of the front cold section, between end wall and partition; 0 without partitions."""
    cold_length_rear: float = 0.0
    partition_thickness: float = 0.0
    """0 with both cold lengths 0: one chamber without partitions."""
    height: float
    """Outer height of the housing above the field."""
    width: float
    """Outer width of the housing."""
    wall_thickness: float
    floor_thickness: float
    top_thickness: float
    end_wall_thickness: float
    shaft_height: float
    """Height of all shaft axes above the field."""
    shafts: tuple[ShaftGeometry, ...]
    end_seal_width: float = 6e-3
    """Least length of the end seal (blind end: thickness of the cover) outside of each bearing."""
    boss_wall: float = 12e-3
    """Radial wall of the boss around a bearing that protrudes into the housing."""
    field: ClampingField | None = None
    foot_joint: bool = False
    """True: foot and field are bodies of their own that touch. False: they share their nodes (perfect contact)."""

    def __post_init__(self) -> None:
        if self.foot_joint and self.field is None:
            raise GeometryError("a joint of the foot without a field; give the field the housing stands on")
        optional = {"shafts", "field", "foot_joint", *PARTITIONS}
        require_positive(self, *(f.name for f in fields(self) if f.name not in optional))
        if any(getattr(self, name) != 0.0 for name in PARTITIONS):
            require_positive(self, *PARTITIONS)
        self._check_walls()
        if not self.shafts:
            raise GeometryError("shafts is empty; a gearbox needs at least one shaft")
        names = [shaft.name for shaft in self.shafts]
        for name in names:
            if names.count(name) > 1:
                raise GeometryError(
                    f"shaft name {name!r} is given {names.count(name)} times; names must differ"
                )
        for shaft in self.shafts:
            self._check_shaft(shaft)
        for first, second in combinations(self.shafts, 2):
            self._check_neighbours(first, second)

    # ------------------------------------------------------------------ stations along x

    @property
    def one_chamber(self) -> bool:
        """Whether there are no partitions and no cold sections."""
        return self.partition_thickness == 0.0

    @property
    def length(self) -> float:
        """Outer length of the housing [m]."""
        return self.partition_rear[1] + self.cold_length_rear + self.end_wall_thickness

    @property
    def partition_front(self) -> tuple[float, float]:
        """x of the two faces of the front partition [m]."""
        start = self.end_wall_thickness + self.cold_length_front
        return start, start + self.partition_thickness

    @property
    def partition_rear(self) -> tuple[float, float]:
        """x of the two faces of the rear partition [m]."""
        start = self.partition_front[1] + self.chamber_length
        return start, start + self.partition_thickness

    @property
    def warm_limits(self) -> tuple[float, float]:
        """x of the two warm/cold lines on the outside [m]: the mid-planes of the partitions, or the end faces."""
        if self.one_chamber:
            return 0.0, self.length
        return sum(self.partition_front) / 2.0, sum(self.partition_rear) / 2.0

    @property
    def inner_half_width(self) -> float:
        """Half the clear width [m]."""
        return self.width / 2.0 - self.wall_thickness

    @property
    def inner_height(self) -> float:
        """Clear height [m]."""
        return self.height - self.floor_thickness - self.top_thickness

    def cold_length(self, side: Side) -> float:
        """Clear length of the cold section of one side [m]."""
        return self.cold_length_front if side == "front" else self.cold_length_rear

    def mirrored(self, side: Side, depth: float) -> float:
        """x of a plane ``depth`` metres inside the outer end face of one side."""
        return depth if side == "front" else self.length - depth

    def bearing_depths(self, bearing: EndBearing) -> tuple[float, float]:
        """Outer and inner edge of a bearing, measured inwards from the outer end face [m]."""
        needed = self.end_seal_width + bearing.width
        flush = needed <= self.end_wall_thickness + SMALLEST_STEP
        inner = self.end_wall_thickness if flush else needed
        return inner - bearing.width, inner

    def protrusion(self, bearing: EndBearing) -> float:
        """Length of the boss that carries the bearing into the housing [m]; 0 without a boss."""
        return self.bearing_depths(bearing)[1] - self.end_wall_thickness

    @property
    def gear_room(self) -> tuple[float, float]:
        """x between which gears have room [m]: partitions, or the bosses of the bearings and the end walls."""
        if not self.one_chamber:
            return self.partition_front[1], self.partition_rear[0]
        front, rear = (
            max(self.bearing_depths(shaft.bearing(side))[1] for shaft in self.shafts) for side in SIDES
        )
        return front, self.length - rear

    def gear_limits(self, shaft: ShaftGeometry) -> tuple[float, float]:
        """x of the two sides of the gear of ``shaft`` [m]; ValueError for a shaft without a gear."""
        if shaft.gear is None:
            raise ThermalInputError(f"shaft {shaft.name} carries no gear")
        middle = (self.partition_front[1] + self.partition_rear[0]) / 2.0 + shaft.gear.offset
        return middle - shaft.gear.width / 2.0, middle + shaft.gear.width / 2.0

    def boss_radius(self, bearing: EndBearing) -> float:
        """Outer radius of the boss of a bearing [m]."""
        return bearing.bore_radius + self.boss_wall

    def seal_radius(self, shaft: ShaftGeometry) -> float:
        """Radius of the seal bores in the partitions [m]."""
        return shaft.seal_diameter / 2.0 + shaft.seal_gap

    def end_seal_radius(self, shaft: ShaftGeometry) -> float:
        """Radius of the seal bores in the end walls [m]."""
        return shaft.overhang_diameter / 2.0 + shaft.seal_gap

    # ------------------------------------------------------------------ can it be built?

    def _check_walls(self) -> None:
        for name, clear, remedy in (
            ("width", 2.0 * self.inner_half_width, "widen the housing or thin its walls"),
            ("height", self.inner_height, "raise the housing or thin floor and top"),
        ):
            if clear < 10.0 * MINIMUM_LAND:
                raise GeometryError(
                    f"{name} = {getattr(self, name):g} m leaves {clear:g} m between the walls, less than "
                    f"{10.0 * MINIMUM_LAND:g} m; {remedy}"
                )
        if self.field is None:
            return
        for name, size, foot in (
            ("length", self.field.length, self.length), ("width", self.field.width, self.width)
        ):  # fmt: skip
            if size < foot + 10.0 * MINIMUM_LAND:
                raise GeometryError(
                    f"field {name} = {size:g} m must exceed the housing's {foot:g} m by "
                    f"{10.0 * MINIMUM_LAND:g} m; enlarge the clamping field"
                )

    def _check_shaft(self, shaft: ShaftGeometry) -> None:
        room = {
            "side wall": self.inner_half_width - abs(shaft.y),
            "floor": self.shaft_height - self.floor_thickness,
            "top": self.height - self.top_thickness - self.shaft_height,
        }
        radii = {part: radius for side in SIDES for part, radius in self._radii(shaft, side).items()}
        for part, radius in radii.items():
            for wall, distance in room.items():
                if radius + MINIMUM_LAND > distance:
                    raise GeometryError(
                        f"shaft {shaft.name}: radius {radius:g} m of its {part} does not fit the "
                        f"{distance:g} m between axis and {wall}; move the axis or enlarge the housing"
                    )
        if self.one_chamber != (shaft.seal_diameter == 0.0):
            wanted = "0 in a housing without partitions" if self.one_chamber else "greater than 0"
            raise GeometryError(
                f"shaft {shaft.name}: seal_diameter = {shaft.seal_diameter:g} m must be {wanted}; it is the diameter "
                "in the seals of the partitions"
            )
        bosses = [self.protrusion(shaft.bearing(side)) for side in SIDES]
        if self.one_chamber and sum(bosses) + MINIMUM_LAND > self.chamber_length:
            raise GeometryError(
                f"shaft {shaft.name}: bearings of width {shaft.front.width:g} m and {shaft.rear.width:g} m protrude "
                f"{bosses[0]:g} m and {bosses[1]:g} m from their end walls, the clear length "
                f"{self.chamber_length:g} m of the chamber leaves no room between; narrow the bearings or "
                "thicken the end wall"
            )
        for side, boss in zip(SIDES, bosses, strict=True):
            if not self.one_chamber and boss + MINIMUM_LAND > self.cold_length(side):
                raise GeometryError(
                    f"shaft {shaft.name}: {side} bearing of width {shaft.bearing(side).width:g} m protrudes "
                    f"{boss:g} m from the end wall, more than cold_length_{side} = "
                    f"{self.cold_length(side):g} m allows; narrow the bearing or thicken the end wall"
                )
            if 0.0 < shaft.overhang(side) < MINIMUM_LAND:
                raise GeometryError(
                    f"shaft {shaft.name}: overhang_{side} = {shaft.overhang(side):g} m is below "
                    f"{MINIMUM_LAND:g} m; give 0 for a shaft that ends at its bearing"
                )
        if shaft.gear is not None:
            start, end = self.gear_limits(shaft)
            low, high = self.gear_room
            if start < low + MINIMUM_LAND or end > high - MINIMUM_LAND:
                raise GeometryError(
                    f"shaft {shaft.name}: gear of width {shaft.gear.width:g} m at offset "
                    f"{shaft.gear.offset:g} m does not fit the clear length {self.chamber_length:g} m of the chamber, "
                    f"of which {high - low:g} m are free; lengthen the chamber"
                )

    def _radii(self, shaft: ShaftGeometry, side: Side) -> dict[str, float]:
        """Radius of everything that turns in, or is cut into, the half of the housing on one side around one axis."""
        bearing = shaft.bearing(side)
        boss = self.protrusion(bearing) > 0.0
        radii = {
            "seat": shaft.seat_diameter / 2.0,
            f"{side} bearing": self.boss_radius(bearing) if boss else bearing.bore_radius,
        }
        if not self.one_chamber:
            radii["partition seal bore"] = self.seal_radius(shaft)
        if shaft.overhang_front or shaft.overhang_rear:
            radii["end seal bore"] = self.end_seal_radius(shaft)
        if shaft.gear is not None:
            radii["gear"] = shaft.gear.outer_diameter / 2.0
        return radii

    def _check_neighbours(self, first: ShaftGeometry, second: ShaftGeometry) -> None:
        distance = abs(first.y - second.y)
        needed = max(
            sum(
                max(radius for part, radius in self._radii(shaft, side).items() if part != "gear")
                for shaft in (first, second)
            )
            for side in SIDES
        )
        if needed + MINIMUM_LAND > distance:
            raise GeometryError(
                f"shafts {first.name} and {second.name}: distance {distance:g} m is less than the "
                f"{needed:g} m their bores, bosses and seats need; move the axes apart or "
                "make bearings or seals smaller"
            )
