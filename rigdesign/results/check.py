"""Design rules held against a result: verdicts, flags, and the checks of a run."""

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from fnmatch import fnmatchcase
from typing import Literal, SupportsIndex, get_args, overload

Verdict = Literal["pass", "open", "fail", "not applicable"]
"""``open``: the rule could not be judged; the reason says why."""
Flag = Literal["advisory", "close", "doubt"]
"""Beside a verdict: a missed limit that does not bind; little margin left; a cause to doubt the value."""
Status = Literal["fail", "open", "advisory", "pass", "not applicable"]
"""Under which a check is counted and sorted, the gravest first: its verdict, or ``advisory`` for a missed limit that
does not bind."""
STATUSES: tuple[Status, ...] = get_args(Status)
Role = Literal["specimen", "rig"]
NO_LOADS = "losses are given (losses.basis = input): there are no dynamic loads"
NO_LIMIT = "the case states no limit"
NO_HOUSING = "no gearbox has a housing: there are no temperatures and clearances"
"""Why a check has no value."""
NOT_WITHIN = "not within"
"""How the reason of a check begins whose value is the time followed without the event it waits for: a lower bound."""
SEAT_FRICTION = 0.12
"""Coefficient of a steel seat against slip along the circumference, joined with oil (DIN 7190-1, table of values)."""


@dataclass(frozen=True, kw_only=True)
class Check:
    """One design rule held against the result.

    margin : to the limit in the unit of the value, positive when held
    distance : margin as a share of the limit (`rigdesign.checks.rules`): 0 at the limit, 0.2 with a fifth of it left,
        -0.2 where it is missed by a fifth of it
    error : how far the value may be from that of an infinitely fine model, or of the law beside it, in its unit; None
        where nothing tells

    Margin and distance are None when the rule has no value.
    """

    id: str
    title: str
    value: float | None
    limit: float | None
    unit: str
    comparison: Literal["<=", ">=", "within"]
    margin: float | None
    distance: float | None
    verdict: Verdict
    flags: tuple[Flag, ...] = ()
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
    """Known contributors that the value does not count: a held rule is open, unless they are small."""
    error: float | None = None

    @property
    def status(self) -> Status:
        """Under which the check is counted."""
        return status(self.verdict, self.flags)

    @property
    def missed(self) -> bool:
        """Whether the value misses the limit, whatever the verdict."""
        return self.margin is not None and self.margin < 0.0

    def is_one_of(self, patterns: Iterable[str]) -> bool:
        """Whether its id fits one of the patterns, ``temperature.*`` say."""
        return any(fnmatchcase(self.id, pattern) for pattern in patterns)


def status(verdict: Verdict, flags: Collection[str]) -> Status:
    """Under which a check with this verdict and these flags is counted."""
    return "advisory" if verdict == "fail" and "advisory" in flags else verdict


def overall(checks: Sequence[Check]) -> Literal["pass", "open", "fail"]:
    """Verdict of a run: fail before open before pass; advisory limits and rules that do not apply do not count."""
    statuses = {check.status for check in checks}
    return "fail" if "fail" in statuses else "open" if "open" in statuses else "pass"


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


@dataclass(frozen=True, kw_only=True)
class HandCalculation:
    """A number that an engineer can redo on paper, in its unit beside the computed one."""

    quantity: str
    computed: float
    by_hand: float
    unit: str
    formula: str


@dataclass(frozen=True, kw_only=True)
class Finding:
    """A warning of the tool's own: a result, never a Python warning."""

    id: str
    text: str
    checks: tuple[str, ...] = ()
    """Ids of the checks that rest on what is outside of the range of its law; ``*`` stands for any characters."""
