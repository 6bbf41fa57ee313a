"""Design rules held against a result."""

from dataclasses import dataclass
from difflib import get_close_matches
from typing import TYPE_CHECKING, Literal, SupportsIndex, overload

from rigdesign.results.verdict import Verdict

if TYPE_CHECKING:
    pass


Role = Literal["specimen", "rig"]


@dataclass(frozen=True, kw_only=True)
class Check:
    """One design rule held against the result.

    ``margin`` is the distance to the limit in the unit of the value, positive when held; ``utilisation`` is
    the share of the limit used up, 1 at the limit. Both are None when the rule is not applicable.
    """

    id: str
    title: str
    value: float | None
    limit: float | None
    unit: str
    comparison: Literal["<=", ">=", "within"]
    margin: float | None
    utilisation: float | None
    verdict: Verdict
    source: str
    role: Role
    reason: str = ""
    group: str = ""
    """Section of the report, as the rule of the check states it."""
    upper_limit: float | None = None
    """Second limit of a window (comparison ``within``)."""
    assumptions: tuple[str, ...] = ()
    """Case paths of the assumptions the value depends on."""
    by_definition: bool = False
    """Value and limit are both stated by the case: the check shows that it agrees with itself and predicts nothing."""
    left_out: tuple[str, ...] = ()
    """Known contributors that the value does not count: the check is at best a warning, unless they are small."""
    discretisation_error: float | None = None
    """How far the value may be from that of an infinitely fine housing mesh, in its unit; None where no housing
    mesh enters, or where there is no coarser one to tell."""


class Checks(list[Check]):
    """The checks of a run in the order of the report, by number or by id: ``checks["oil.room"]``."""

    @overload
    def __getitem__(self, key: SupportsIndex) -> Check: ...
    @overload
    def __getitem__(self, key: slice) -> list[Check]: ...
    @overload
    def __getitem__(self, key: str) -> Check: ...
    def __getitem__(self, key: SupportsIndex | slice | str) -> Check | list[Check]:
        """A check; KeyError names the nearest ids for one that is none."""
        if not isinstance(key, str):
            return super().__getitem__(key)
        found = next((check for check in self if check.id == key), None)
        if found is None:
            near = get_close_matches(key, [check.id for check in self], n=3, cutoff=0.4)
            raise KeyError(f"no check {key!r}; the nearest are {', '.join(near) or 'none'}")
        return found
