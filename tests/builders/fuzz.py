"""Broken case files for the fuzz runs: texts cut, flipped and filled with what no rig has; cases shortened to run."""

import random
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from rigdesign.case import Case, load_case
from rigdesign.case.provenance import take_off
from tests.builders.mutant import QUANTITY, leaves
from tests.builders.paths import CASES

FILES = tuple(sorted(path for path in CASES.glob("*/*.toml")))
NASTY = (
    "nan", "inf", "-inf", "0", "-1", "1e300", "1e-300", "1e999", "-0.0", "true", "1979-05-27",
    '""', '" "', '"mm"', '"1"', '"1 parsec"', '"nan mm"', '"1e400 mm"', '"-5 degC"', '"1 mm 2 mm"',
    '"\u0661\u0662 mm"', '"1_0 mm"', '"0x10 mm"', '"\\u0000"', '"[bold]x[/bold]"', '"../../etc/passwd"',
    "[]", "{}", "[[[[]]]]", "{ value = 1 }", '"' + "x" * 5000 + '"',
)  # fmt: skip
STRETCH = 0.1
"""Stages of the shortened cases last so much of their time, with a motor to match."""


def broken_texts(seed: int) -> Iterator[tuple[str, Path, str]]:
    """Endless (what was done, file, its broken text)."""
    choice = random.Random(seed)
    while True:
        file = choice.choice(FILES)
        text = file.read_text(encoding="utf-8")
        kind = choice.choice(("value", "value", "value", "key", "line", "double", "cut", "flip"))
        yield kind, file, _broken(kind, text, choice)


def _broken(kind: str, text: str, choice: random.Random) -> str:
    lines = text.splitlines()
    assigned = [i for i, line in enumerate(lines) if "=" in line and not line.lstrip().startswith("#")]
    at = choice.choice(assigned)
    key, _, _ = lines[at].partition("=")
    match kind:
        case "value":
            lines[at] = f"{key}= {choice.choice(NASTY)}"
        case "key":
            lines[at] = lines[at].replace(
                key.strip(), choice.choice(("", key.strip()[:-1], "x y", '"[/]"')), 1
            )
        case "line":
            del lines[at]
        case "double":
            lines.insert(at, lines[choice.choice(assigned)])
        case "cut":
            return text[: choice.randrange(len(text))]
        case "flip":
            place = choice.randrange(len(text))
            return text[:place] + chr(choice.randrange(1, 0x2FF)) + text[place + 1 :]
    return "\n".join(lines)


@cache
def shortened(name: str) -> Case:
    """A shipped case with a fast schedule, few speeds of the curve and a loop of a tenth of its sharpness."""
    case = load_case(CASES / name)
    plain, _, _ = take_off(dict(case.origin.tree))
    values: dict[str, object] = {
        "numerics.curve_speeds": 5,
        "numerics.temperature_tolerance": "0.5 K",
        "numerics.growth_tolerance": "5 um",
        "numerics.torque_tolerance": 0.01,
    }
    for path, value in leaves(plain):
        found = QUANTITY.fullmatch(str(value))
        if found is None:
            continue
        if path.startswith("schedule.stages.") and path.endswith(".duration"):
            values[path] = f"{float(found[1]) * STRETCH:g} {found[2]}"
        elif path == "drivetrain.motor.torque_limit":
            values[path] = f"{float(found[1]) / STRETCH:g} {found[2]}"
    for path, value in values.items():
        case = case.with_value(path, value)
    return case
