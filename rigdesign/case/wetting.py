"""Which surfaces of a housing a fluid wets."""

from collections.abc import Iterable

from rigdesign.case.geometry import conditions_of
from rigdesign.case.housing import Housing
from rigdesign.case.matching import matched


def wetted_surfaces(housing: Housing, names: Iterable[str], fluid: str) -> tuple[str, ...]:
    """Surfaces with a film to ``fluid`` in the order of ``boundary``, among surfaces with ``names``."""
    rows = conditions_of(housing, names)
    return tuple(surface for entry, surface, _ in rows if housing.boundary[entry].wetted_by == fluid)


def stream_surfaces(housing: Housing, names: Iterable[str], stream: str) -> tuple[str, ...]:
    """Surfaces of a stream of the housing in the order in which it passes them."""
    known = tuple(names)
    order = housing.streams[stream].surfaces
    return tuple(matched(order, known)) if order else wetted_surfaces(housing, known, stream)
