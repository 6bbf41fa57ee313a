"""A gearbox of two materials for thermal expansion."""

from thermal.housing.gearbox import ClampingField, EndBearing, GearDisc, HousingGeometry, ShaftGeometry

COLD = 293.15
STEEL, IRON = (210e9, 0.3, 11.5e-6), (120e9, 0.26, 10.5e-6)


GAP = 0.5e-3


def geometry() -> HousingGeometry:
    bearing = EndBearing(journal_diameter=0.04, width=0.03, clearance=20e-6)

    def shaft(name: str, y: float, width: float) -> ShaftGeometry:
        return ShaftGeometry(
            name=name, y=y, front=bearing, rear=bearing, seal_diameter=0.042, seat_diameter=0.044,
            overhang_diameter=0.038, seal_gap=GAP, locating="rear",
            overhang_rear=0.04, gear=GearDisc(outer_diameter=0.099, width=width),
        )  # fmt: skip

    return HousingGeometry(
        chamber_length=0.08, cold_length_front=0.05, cold_length_rear=0.06, height=0.28, width=0.32,
        wall_thickness=0.015, floor_thickness=0.02, top_thickness=0.015, partition_thickness=0.015,
        end_wall_thickness=0.036, shaft_height=0.14,
        shafts=(shaft("pinion", -0.05, 0.01), shaft("wheel", 0.05, 0.015)),
        field=ClampingField(length=0.6, width=0.6, thickness=0.1),
    )  # fmt: skip
