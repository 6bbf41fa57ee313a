"""Unmodelled causes in the words of a test engineer: a heat source, a heat path, an order nobody stated."""

import re

from rigdesign.diagnosis.residual.unmodelled_cause import UNKNOWN

LAWS = {
    "constant": "the same at all operating points",
    "~n": "growing with the speed",
    "~n2": "growing with the square of the speed",
    "~T": "growing with the torque",
    "~T n": "growing with torque and speed",
    "~T above ambient": "growing with the temperature above ambient",
}
"""Law of a cause as `rigdesign.diagnosis.residual.unmodelled_cause` writes it -> in words."""

PLACES = {
    "body": "in {0}",
    "rim": "in gear {0}",
    "bore": "in the bore of bearing {0}",
    "film": "in the oil film of bearing {0}",
    "oil": "in the oil {0}",
}
"""Kind of a place of heat -> in words."""

_HEAT = re.compile(r"(heat|heat unpaid) at (\w+):(.+?) (constant|~T n|~n2|~n)$")
_NEAR = re.compile(r"heat near (.+?) (constant|~T above ambient)$")
_PIPE = re.compile(r"heat in the (supply|drain) of (.+?) constant$")
_ORDER = re.compile(r"order (\S+) of (.+?) (constant|~n2|~T)$")


def in_words(cause: str, size: float = 0.0) -> str:
    """``heat unpaid at body:test.n2 ~n2`` -> what an engineer would call it; as it is where it is of no known kind.

    size : fitted amount, by its sign heat or cooling; 0 where it is not known
    """
    more, less = size > 0.0, size < 0.0
    if found := _HEAT.match(cause):
        kind, place, where, law = found.groups()
        source = f"{'cooling' if less else 'heat'} from outside the drive"
        if kind == "heat":
            source = "less power loss than modelled" if less else "power loss"
        return f"{source} {PLACES.get(place, 'at {0}').format(where)}, {LAWS[law]}"
    if found := _NEAR.match(cause):
        source = "heat source" if more else "draught" if less else "heat source or draught"
        return f"{source} near thermocouple {found[1]}, {LAWS[found[2]]}"
    if found := _PIPE.match(cause):
        return f"{'cooling' if less else 'heat'} in the {found[1]} line of {found[2]}"
    if found := _ORDER.match(cause):
        return f"order {found[1]} of {found[2]} without a known source, {LAWS[found[3]]}"
    if cause.startswith("conductance "):
        compared = "better than" if more else "worse than" if less else "other than"
        return f"heat path {compared} modelled: {_path(cause.removeprefix('conductance '))}"
    return cause


def place_of(cause: str) -> str:
    """Where a cause is, whatever its law: heat whether the motor pays for it or not, an order of a channel."""
    bare = cause.removeprefix(UNKNOWN)
    if found := _HEAT.match(bare):
        return f"{UNKNOWN}heat at {found[2]}:{found[3]}"
    if found := _NEAR.match(bare):
        return f"{UNKNOWN}heat near {found[1]}"
    if found := _ORDER.match(bare):
        return f"{UNKNOWN}order {found[1]} of {found[2]}"
    return cause


def _path(link: str) -> str:
    """``film:test.outer_warm`` -> film at test.outer_warm; ``contact:test.a|b`` -> contact from test.a to b."""
    kind, _, place = link.partition(":")
    first, _, second = place.partition("|")
    kind = kind.replace("_", " ")
    return f"{kind} from {first} to {second}" if second else f"{kind} at {first}"
