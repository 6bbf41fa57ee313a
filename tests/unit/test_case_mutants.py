"""Mutants of the shipped case: one number times 0.1 to 10, one choice or one reference changed.

Whatever is changed, loading ends in a case or in a CaseError that names a path; most mutants stay computable.
"""

import random
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from rigdesign.case import Case, load_case
from rigdesign.case.marks import item_name, take_off
from rigdesign.errors import CaseError

PROTOTYPE = Path(__file__).parents[2] / "cases" / "uhcf_prototype"
QUANTITY = re.compile(r"([-+]?[\d.]+(?:e[-+]?\d+)?)\s*(.*)")
MUTANTS = 150


def leaves(node: object, path: str = "") -> Iterator[tuple[str, object]]:
    if isinstance(node, dict):
        for key, item in node.items():
            yield from leaves(item, f"{path}.{key}" if path else key)
    elif isinstance(node, tuple):
        for index, item in enumerate(node):
            yield from leaves(item, f"{path}.{item_name(item, index)}")
    else:
        yield path, node


def mutated(value: object, texts: list[str], choice: random.Random) -> object:
    factor = 10.0 ** choice.uniform(-1.0, 1.0)
    if isinstance(value, bool):
        return not value
    if isinstance(value, int):
        return round(value * factor)
    if isinstance(value, float):
        return value * factor
    match = QUANTITY.fullmatch(str(value))
    return f"{float(match[1]) * factor:.6g} {match[2]}" if match else choice.choice(texts)


@pytest.mark.parametrize("seed", [1, 2])
def test_mutants_load_or_say_what_is_wrong(seed: int) -> None:
    case: Case = load_case(PROTOTYPE)
    plain, _, _ = take_off(dict(case.origin.tree))
    found = list(leaves(plain))
    texts = [value for _, value in found if isinstance(value, str) and not QUANTITY.fullmatch(value)]
    choice = random.Random(seed)
    loaded = 0
    for _ in range(MUTANTS):
        path, value = choice.choice(found)
        try:
            mutant = case.with_value(path, mutated(value, texts, choice))
        except CaseError as error:
            assert error.faults, path
            assert all(fault.problem and fault.remedy for fault in error.faults), path
        else:
            assert len(mutant.hash) == 64
            loaded += 1
    assert loaded >= MUTANTS / 2
