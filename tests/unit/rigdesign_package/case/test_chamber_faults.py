"""Enclosures, volumes, streams and links that cannot be computed: key, value, limit and remedy."""

import re
from pathlib import Path

import pytest

from rigdesign import load_case
from rigdesign.base.errors import CaseError
from tests.builders.warm_chambers import TABLES, warm_chambers_case

AT = "gearboxes.test.housing"


@pytest.fixture
def refused(tmp_path: Path):
    def message(old: str, new: str) -> str:
        assert old in TABLES or not old
        path = warm_chambers_case(tmp_path, tables=TABLES.replace(old, new) if old else TABLES + new)
        with pytest.raises(CaseError) as caught:
            load_case(path)
        return str(caught.value)

    return message


CASES = {
    "unknown surface": (
        'surfaces = ["gear_*"]', 'surfaces = ["geer_*"]',
        rf"{AT}.enclosures.warm.parts.dry.surfaces = \"geer_\*\": no such surface",
    ),
    "surface of two parts": (
        'surfaces = ["chamber_floor"]', 'surfaces = ["chamber_floor", "gear_test_pinion_rim"]',
        r'parts.floor.surfaces = "gear_test_pinion_rim": is in the part dry already; name it once',
    ),
    "one surface": (
        'parts.walls = { surfaces = ["cold_floor_rear", "cold_wall_rear"]',
        'parts.walls = { surfaces = ["cold_floor_rear"]',
        rf"{AT}.enclosures.ends: needs two surfaces that radiate at each other, has cold_floor_rear",
    ),
    "two enclosures": (
        'surfaces = ["cold_floor_rear", "cold_wall_rear"]', 'surfaces = ["cold_*_rear", "chamber_top"]',
        rf"{AT}.enclosures.ends = \"chamber_top\": is a surface of the enclosure warm already",
    ),
    "nothing radiates": (
        "emissivity = 0.6", "emissivity = 0.0", "ends: every emissivity is 0, nothing radiates; write one above 0",
    ),
    "emissivity": (
        "emissivity = 0.6", "emissivity = 1.2", r"ends.parts.walls.emissivity = 1.2: .*1",
    ),
    "rows above one": (
        "cold_wall_rear = 0.5", "cold_wall_rear = 0.7, cold_floor_rear = 0.4",
        "ends.view_factors: view factors of cold_floor_rear add up to 1.1 and cannot close: the limit is 1",
    ),
    "rows that do not close": (
        'opening_temperature = "25 degC", ', "",
        "ends.view_factors: view factors of cold_wall_rear add up to 0.0.* cannot close.*give an opening_temperature",
    ),
    "no reciprocity": (
        "{ cold_wall_rear = 0.5 }", "{ cold_wall_rear = 0.5 }, cold_wall_rear = { cold_floor_rear = 0.5 }",
        "cold_floor_rear and cold_wall_rear: A F = .* one way and .* the other",
    ),
    "view factor of a stranger": (
        "{ cold_wall_rear = 0.5 }", "{ cold_wall_rear = 0.5, chamber_top = 0.1 }",
        'view_factors = "chamber_top": is no surface of this enclosure; its surfaces: cold_',
    ),
    "nothing named": (
        "", "[gearboxes.test.housing.enclosures.none]\n", 'enclosures.none: has no surfaces; add chamber = "warm"',
    ),
    "radiation twice": (
        "", '[gearboxes.test.housing.boundary.hot]\nsurfaces = ["chamber_top"]\nlaw = "radiation"\nemissivity = 0.5\n',
        r'enclosures.warm = "chamber_top": radiates to its surroundings by boundary.hot already',
    ),
    "stream without flow": ('flow = "1.5 l/min"\n', "", rf"{AT}.streams.jacket.flow: a required key is missing"),
    "no flow": ('flow = "1.5 l/min"', 'flow = "0 l/min"', r'jacket.flow = "0 l/min": is below 0.001 l/min'),
    "unknown medium": (
        'medium = "Water"', 'medium = "Watter"', r'jacket.medium = "Watter": .*name an oil of the case, or a fluid',
    ),
    "order without a film": (
        '"outer_cold_front", "outer_warm"]', '"outer_cold_front", "outer_warm", "chamber_top"]',
        r'jacket.surfaces = "chamber_top": has no film to jacket',
    ),
    "film without a place": (
        '"outer_cold_front", "outer_warm"]', '"outer_warm"]',
        r'jacket.surfaces = "outer_cold_front": has a film to the stream and no place in its order',
    ),
    "unknown fluid": (
        "streams.jacket]", "streams.jackets]",
        rf'{AT}.boundary.jacket.fluid = "jacket": no such fluid; did you mean "jackets"',
    ),
    "dry stream": ("streams.jacket]", "streams.jackets]", rf"{AT}.streams.jackets: wets no surface"),
    "lonely volume": (
        "", "[gearboxes.test.housing.volumes.lonely]\n", "volumes.lonely: no film and no link reaches it",
    ),
    "name of an oil": (
        "", "[gearboxes.test.housing.volumes.gear_oil]\n", "volumes.gear_oil: is the name of a fluid, surface or body",
    ),
    "link without a volume": (
        '["gear_oil", "cold_air"]', '["gear_oil", "ambient"]', "drain.between = .* needs a volume and another place",
    ),
    "link to nowhere": (
        '["gear_oil", "cold_air"]', '["oil_gear", "cold_air"]', r'links.drain.between = "oil_gear": no such volume',
    ),
    "link to a stream": (
        '["gear_oil", "cold_air"]', '["jacket", "cold_air"]', r'"jacket": is a stream; only volumes have links',
    ),
    "linked twice": (
        '["gear_oil", "cold_air"]', '["ambient", "cold_air"]', "drain.between = .* is linked by breather already",
    ),
    "flow and conductance": (
        'conductance = "3 W/K"', 'conductance = "3 W/K", flow = "1 l/min"', "needs either a conductance or a flow",
    ),
    "flow of nothing": (', medium = "Air"', "", "flow and medium go together"),
}  # fmt: skip


@pytest.mark.parametrize(("old", "new", "expected"), CASES.values(), ids=list(CASES))
def test_faults(refused, old: str, new: str, expected: str) -> None:
    assert re.search(expected, refused(old, new), re.DOTALL)


def test_a_film_to_a_volume_has_no_temperature_of_its_own(tmp_path: Path) -> None:
    path = warm_chambers_case(tmp_path)
    text = path.read_text().replace('fluid = "cold_air"', 'fluid = "cold_air", fluid_temperature = "40 degC"')
    path.write_text(text)
    with pytest.raises(
        CaseError, match=r"boundary.cold.fluid_temperature = 40 .*found with the field; remove it"
    ):
        load_case(path)


def test_the_usual_emissivity_is_an_assumption(tmp_path: Path) -> None:
    case = load_case(warm_chambers_case(tmp_path))
    found = {one.path: one for one in case.assumptions}
    record = found[f"{AT}.enclosures.warm.emissivity"]
    assert (record.value, record.range) == ("0.82", ("0.5", "0.95"))
    assert f"{AT}.enclosures.ends.emissivity" not in found
