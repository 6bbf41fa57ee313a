"""Mutants of a case: one number times 0.1 to 10, one choice or one reference changed; for property tests."""

import random
import re
from collections.abc import Iterator, Mapping

from rigdesign.case import Case
from rigdesign.case.provenance import item_name, take_off

QUANTITY = re.compile(r"([-+]?[\d.]+(?:e[-+]?\d+)?)\s*(.*)")


def leaves(node: object, path: str = "") -> Iterator[tuple[str, object]]:
    if isinstance(node, dict):
        for key, item in node.items():
            yield from leaves(item, f"{path}.{key}" if path else key)
    elif isinstance(node, tuple):
        for index, item in enumerate(node):
            yield from leaves(item, f"{path}.{item_name(item, index)}")
    else:
        yield path, node


def kind_of(path: str) -> str:
    """What a text is: the last key of its path, numbers of list items left out."""
    return next(key for key in reversed(path.split(".")) if not key.isdigit())


def exchanged(path: str, value: str, texts: Mapping[str, list[str]], choice: random.Random) -> str:
    """Another text of the same kind, a wrong choice or reference that can be meant; any text if there is none."""
    alike = [text for text in texts[kind_of(path)] if text != value]
    return choice.choice(alike or [text for of_kind in texts.values() for text in of_kind])


def mutated(path: str, value: object, texts: Mapping[str, list[str]], choice: random.Random) -> object:
    factor = 10.0 ** choice.uniform(-1.0, 1.0)
    if isinstance(value, bool):
        return not value
    if isinstance(value, int):
        return round(value * factor)
    if isinstance(value, float):
        return value * factor
    match = QUANTITY.fullmatch(str(value))
    return (
        f"{float(match[1]) * factor:.6g} {match[2]}" if match else exchanged(path, str(value), texts, choice)
    )


def mutations(case: Case, seed: int) -> Iterator[tuple[str, object]]:
    """Endless (path, new value) of one seed."""
    plain, _, _ = take_off(dict(case.origin.tree))
    found = list(leaves(plain))
    texts: dict[str, list[str]] = {}
    for path, value in found:
        if isinstance(value, str) and not QUANTITY.fullmatch(value):
            texts.setdefault(kind_of(path), []).append(value)
    choice = random.Random(seed)
    while True:
        path, value = choice.choice(found)
        yield path, mutated(path, value, texts, choice)
