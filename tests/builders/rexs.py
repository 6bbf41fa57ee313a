"""REXS files of the tests: a gear unit like that of an FZG rig (16/24, m_n 4.5, a 91.5), and changed copies of it."""

import io
import zipfile
from pathlib import Path

from rigdesign.rexs.gear_unit_import import GearUnitImport, import_gear_unit
from rigdesign.rexs.reader import parse_rexs

DATA = Path(__file__).parents[1] / "unit/rigdesign_package/rexs/data"
SUFFIXES = ("rexs", "rexsj", "rexsz")


def rexs_file(version: str = "2.0", suffix: str = "rexs") -> Path:
    """Path of the unit in a version (1.0, 2.0) and encoding."""
    return DATA / f"fzg_{version}.{suffix}"


def changed(*changes: tuple[str, str], version: str = "2.0", suffix: str = "rexs") -> bytes:
    """Its text with replacements, each of which has to hit."""
    text = rexs_file(version, suffix).read_text("utf-8")
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new)
    return text.encode()


def imported(*changes: tuple[str, str], version: str = "2.0", suffix: str = "rexs") -> GearUnitImport:
    """The unit as imported from a changed text."""
    return import_gear_unit(parse_rexs(changed(*changes, version=version, suffix=suffix), "unit.rexs"))


def archive_of(entries: dict[str, bytes]) -> bytes:
    """A zip archive of named entries."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as file:
        for name, content in entries.items():
            file.writestr(name, content)
    return buffer.getvalue()


UNITS = {
    "length": "mm", "outer_diameter_begin": "mm", "inner_diameter": "mm", "normal_module": "mm", "face_width": "mm",
    "u_coordinate_on_shaft": "mm", "u_coordinate_on_shaft_inner_side": "mm", "center_distance": "mm",
    "helix_angle_reference_diameter": "deg", "normal_pressure_angle": "deg", "torque_around_u_axis": "N m",
    "rotational_speed": "1 / min", "viscosity_at_40_degree_celsius": "mm^2 / s",
    "viscosity_at_100_degree_celsius": "mm^2 / s",
}  # fmt: skip


class UnitText:
    """A gear unit of REXS 1.4 part by part: 31/62 teeth, module 3, shafts of 60 mm in NU and NJ 212, unless stated."""

    def __init__(self) -> None:
        self._parts = ['<component id="1" type="gear_unit"/>', '<component id="2" type="gear_casing"/>']
        self._relations: list[str] = []
        self.add(60, "lubricant", viscosity_at_40_degree_celsius=220, viscosity_at_100_degree_celsius=19)
        self._relate("reference", (2, "origin"), (60, "referenced"))

    def add(self, number: int, kind: str, **attributes: object) -> None:
        """A component with its attributes."""
        inside = "".join(
            f'<attribute id="{key}" unit="{UNITS.get(key, "none")}">{value}</attribute>'
            for key, value in attributes.items()
        )
        self._parts.append(
            f'<component id="{number}" type="{kind}" name="{kind} {number}">{inside}</component>'
        )

    def _relate(self, kind: str, *ends: tuple[int, str]) -> None:
        inside = "".join(f'<ref id="{number}" role="{role}"/>' for number, role in ends)
        self._relations.append(f'<relation id="{len(self._relations) + 1}" type="{kind}">{inside}</relation>')

    def shaft(self, number: int, *sections: tuple[float, float, float], **attributes: object) -> None:
        """A shaft of sections (start, length, diameter) [mm]."""
        self.add(number, "shaft", **attributes)
        for index, (start, length, diameter) in enumerate(sections or ((0, 300, 60),)):
            part = 1000 * number + index
            self.add(
                part,
                "shaft_section",
                u_coordinate_on_shaft=start,
                length=length,
                outer_diameter_begin=diameter,
            )
            self._relate("assembly", (number, "assembly"), (part, "part"))

    def bearing(
        self, number: int, shaft: int, place: float, name: str = "NJ 212 ECP", outer: int = 2, **more: object
    ) -> None:
        """A rolling bearing between a shaft and the casing, or ``outer``."""
        self.add(
            number, "rolling_bearing_with_catalog_geometry", catalogue_designation=name, inner_diameter=60,
            bearing_type="radial_roller_bearing", u_coordinate_on_shaft_inner_side=place,
            axial_force_absorption="both_directions" if name.startswith("NJ") else "no_direction", **more,
        )  # fmt: skip
        self._relate("side", (number, "assembly"), (shaft, "inner_part"), (outer, "outer_part"))

    def gear(self, number: int, shaft: int, place: float, teeth: int = 31, helix: float = 0.0) -> None:
        """A gear on a shaft."""
        self.add(
            number, "cylindrical_gear", number_of_teeth=teeth, normal_module=3, face_width=50,
            helix_angle_reference_diameter=helix, u_coordinate_on_shaft=place, normal_pressure_angle=20,
            addendum_modification_coefficient=0,
        )  # fmt: skip
        self._relate("assembly", (shaft, "assembly"), (number, "part"))

    def stage(self, number: int, pinion: int, wheel: int, distance: float = 139.5) -> None:
        """Two gears that mesh."""
        self.add(number, "cylindrical_stage", center_distance=distance)
        self._relate("stage", (number, "stage"), (pinion, "gear_1"), (wheel, "gear_2"))

    def load(self, number: int, shaft: int, torque: float | None = None) -> None:
        """A load on a shaft [N m]."""
        self.add(number, "external_load", **({} if torque is None else {"torque_around_u_axis": torque}))
        self._relate("assembly", (shaft, "assembly"), (number, "part"))

    def pair(self, place: float = 150, sections: tuple[tuple[float, float, float], ...] = ()) -> "UnitText":
        """Shafts 10 and 20 with bearings 12, 13, 22, 23, gears 30 and 31, stage 40, 1000 N m on shaft 10."""
        self.shaft(10, *sections, rotational_speed=1500)
        self.shaft(20)
        for shaft in (10, 20):
            self.bearing(shaft + 2, shaft, 20, "NU 212 ECP")
            self.bearing(shaft + 3, shaft, 280)
        self.gear(30, 10, place)
        self.gear(31, 20, 150, teeth=62)
        self.stage(40, 30, 31)
        self.load(50, 10, 1000)
        self.load(51, 20)
        return self

    def text(self) -> str:
        """As a file has it."""
        return (
            '<?xml version="1.0" encoding="UTF-8"?><model applicationId="test" version="1.4"><relations>'
            f"{''.join(self._relations)}</relations><components>{''.join(self._parts)}</components></model>"
        )
