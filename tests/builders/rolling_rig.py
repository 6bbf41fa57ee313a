"""FZG rigs on NU 406 and NJ 406: dip, splash, grease or fed oil, some bearings plain or of another size."""

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType

from tests.builders.fzg_case import fzg_case

SPLASH = 'bearing_oil = { lubrication = "splash" }\n'
GREASE = 'bearing_oil = { lubrication = "grease", oil = "FVA 3" }\n'
FED = 'bearing_oil = { oil = "FVA 3", inlet_temperature = "90 degC", flow = "0.5 l/min" }\n'
DIP = 'oil = { lubrication = "dip", oil = "FVA 3", level = "0 mm", volume = "1.25 l", sump_temperature = "90 degC" }\n'
JOURNAL = 'diameter = "30 mm"\nwidth = "23 mm"\ndiametral_clearance = "50 um"\n'


def rolling_case(
    folder: Path,
    *,
    test_oil: str = SPLASH,
    slave_oil: str = SPLASH,
    dip: bool = True,
    plain: Sequence[str] = (),
    others: Mapping[str, str] = MappingProxyType({}),
    law: str = "iso_tr_14179_2",
) -> Path:
    """Write the case.

    plain : bearings ``gearbox.bearing`` that stay plain ones with their given losses
    others : designation of the bearings that are neither NU 406 nor NJ 406
    """
    parts = re.split(r"(?=^\[)", fzg_case(folder).read_text(), flags=re.MULTILINE)
    kept = (_part(part, plain, others, law) for part in parts if not _given_bearing(part, plain))
    text = "".join(
        part for part in kept if not (dip and part.startswith("[losses.given") and "windage" in part)
    )
    oils = iter((test_oil, slave_oil))
    text = re.sub(r"^bearing_oil = \{.*\n", lambda _: next(oils), text, flags=re.MULTILINE)
    if dip:
        text = re.sub(r"^oil = \{ oil.*\n", DIP, text, flags=re.MULTILINE)
    path = folder / "case.toml"
    path.write_text(text)
    return path


def _given_bearing(part: str, plain: Sequence[str]) -> bool:
    """A given loss of a bearing that is a rolling bearing here."""
    return 'kind = "bearing"' in part and not any(
        f'"{box}"' in part and f'part = "{own}"' in part
        for box, _, own in (bearing.partition(".") for bearing in plain)
    )


def _part(part: str, plain: Sequence[str], others: Mapping[str, str], law: str) -> str:
    table = part.split("]")[0].removeprefix("[gearboxes.")
    name = table.replace(".bearings.", ".")
    if ".bearings." not in table or name in plain:
        return part
    designation = others.get(name, "NJ 406" if "locating = true" in part else "NU 406")
    return part.replace(JOURNAL, f'type = "rolling"\ndesignation = "{designation}"\nfriction_law = "{law}"\n')
