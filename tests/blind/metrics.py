"""Numbers of the blind score, each with its count and Wilson interval."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from math import sqrt
from statistics import median
from typing import Any

Row = dict[str, Any]
"""One scored set: its answer and what was diagnosed."""

EASY = frozenset({
    "run_out", "cumulative_pitch", "single_pitch", "motor_ripple", "coupling_order_2",
    "mesh_loss", "bearing_loss", "windage_loss", "seal_loss", "jet_loss", "squeeze_loss",
    "leak_warm_cold", "bypass", "short_circuit", "blocked_jet",
})  # fmt: skip
"""Kinds that are excitations, losses, flows or leaks; the rest are parameters."""


WHOLE_RIG = frozenset({"not_steady", "ambient"})
"""Kinds that the catalogue counts for all gearboxes together."""


LOCAL = {
    "one_bearing": ("one_bearing_loss", "wheel_rear"),
    "leak_one_side": ("leak_one_side", "front"),
    "x_cell_lag": ("torque_lag", ""),
}
"""Kind of the virtual rig at one place of a gearbox -> kind and part of the catalogue. A draught on the right-hand wall
has none: the catalogue's walls are the surfaces of the housing, which run round it."""


@dataclass(frozen=True)
class Rate:
    """A share with its 95 % interval (Wilson, J. Am. Stat. Assoc. 22, 1927, 209)."""

    hits: int
    of: int

    def __str__(self) -> str:
        if not self.of:
            return "none"
        low, high = self.interval
        return f"{self.hits}/{self.of} = {self.hits / self.of:.1%} [{low:.1%}, {high:.1%}]"

    @property
    def interval(self) -> tuple[float, float]:
        """95 % interval."""
        z, n = 1.96, self.of
        p = self.hits / n
        middle = (p + z * z / (2 * n)) / (1 + z * z / n)
        half = z * sqrt(p * (1 - p) / n + z * z / (4 * n * n)) / (1 + z * z / n)
        return max(middle - half, 0.0), min(middle + half, 1.0)


def rate(rows: Iterable[Row], hit: Callable[[Row], bool]) -> Rate:
    """Share of rows that hit."""
    rows = list(rows)
    return Rate(sum(1 for row in rows if hit(row)), len(rows))


def truths(row: Row) -> list[str]:
    """Names of what was hidden, places as the catalogue has them."""
    return [canonical(effect["effect"], row["rig"]) for effect in row["effects"]]


def canonical(name: str, rig: str) -> str:
    """A name of the virtual rig as the catalogue writes it: losses of a mesh count by gearbox."""
    kind, _, place = name.partition(":")
    if kind in LOCAL:
        kind, part = LOCAL[kind]
        place = f"{place}.{part}" if part else place
    if kind in ("mesh_loss", "squeeze_loss"):
        place = place.split(".")[0]
    if kind in WHOLE_RIG:
        place = ""
    if kind.startswith("swapped"):
        place = ",".join(sorted(place.split(",")))
    return f"{kind}:{place}" if place else kind


def named(row: Row) -> list[str]:
    """What was named outright."""
    return list(row["named"]) if row["verdict"] in ("named", "input_error_suspected") else []


def right(row: Row) -> bool:
    """The hidden effect alone was named, or is in the alias group."""
    hidden = set(truths(row))
    found = set(row["named"])
    if row["verdict"] == "alias_group":
        return bool(hidden & found)
    return bool(named(row)) and found == hidden


def wrong(row: Row) -> bool:
    """A name that is not hidden was given."""
    return bool(set(named(row)) - set(truths(row))) or (
        row["verdict"] == "alias_group" and not set(row["named"]) & set(truths(row))
    )


SIZES = {"measured": "detectable_sizes", "declared": "detectable_sizes_declared"}
"""Floor (`tests.virtual_rig.detect.FLOORS`) -> key of an effect."""


def size_of(row: Row, floor: str = "measured") -> float:
    """Detectable sizes of a single effect by the truth, over one of two floors.

    Raises KeyError for an answer that does not hold them; `tests.blind.score generate` adds them.
    """
    return float(row["effects"][0][SIZES[floor]] or 0.0)


def easy(row: Row) -> bool:
    """Excitation, loss, flow or leak."""
    return truths(row)[0].split(":")[0] in EASY


def among_three(row: Row) -> bool:
    """The hidden effect is named, in the group, or among the three likeliest explanations."""
    return right(row) or bool(set(truths(row)) & {part for one in row["top"][:3] for part in one})


def table(rows: Sequence[Row], floor: str = "measured") -> list[tuple[str, str, str]]:
    """(metric, target, measured) of one mode, detectable sizes over one of two floors."""
    kinds = {kind: [row for row in rows if row["kind"] == kind] for kind in
             ("none", "single", "pair", "out", "small", "input")}  # fmt: skip
    large = [row for row in kinds["single"] if size_of(row, floor) >= 2.0]
    between = [row for row in kinds["single"] if 1.0 <= size_of(row, floor) < 2.0]
    of_data = [row for row in rows if row["kind"] != "input"]
    anything = [
        row for row in (*kinds["single"], *kinds["pair"]) if named(row) or row["verdict"] == "alias_group"
    ]
    sizes = [row for row in kinds["single"] if right(row) and row["covered"] is not None]
    errors = [row["size_error"] for row in sizes]
    gaps = [row["gap_shrink"] for row in kinds["single"] if right(row) and row["gap_shrink"] is not None]
    raw = [shrink for row in kinds["single"] if right(row) and (shrink := raw_shrink(row)) is not None]
    worse = [row for row in rows if row["gap_worse"] is not None]
    plain = [one for one in large if not easy(one)]
    return [
        ("named without effect", "<= 2 %", str(rate(kinds["none"], spoke))),
        ("alarm without effect: present, not identified", "-", str(rate(kinds["none"], alarmed))),
        ("alarm without effect: data suspected", "-", str(rate(kinds["none"], suspected))),
        ("data suspected where none are wrong", "-", str(rate(of_data, suspected))),
        ("exchange told where there is none", "-", str(rate(rows, exchanged_falsely))),
        ("named out of catalogue", "<= 5 %", str(rate(kinds["out"], spoke))),
        (
            "out of catalogue flagged",
            "-",
            str(rate(kinds["out"], lambda r: r["verdict"] == "unknown_located")),
        ),
        ("single >= 2 MDE right, excitation/loss/flow", ">= 90 %", str(rate(filter(easy, large), right))),
        ("single >= 2 MDE right, parameter", ">= 70 %", str(rate(plain, right))),
        ("single >= 2 MDE, parameter among three", ">= 95 %", str(rate(plain, among_three))),
        ("single 1-2 MDE right", "-", str(rate(between, right))),
        ("wrong or extra name on singles", "<= 2 %", str(rate(kinds["single"], wrong))),
        ("true one in what is named", ">= 97 %", str(rate(anything, one_is_in))),
        ("pairs: both", ">= 75 %", str(rate(kinds["pair"], lambda r: set(truths(r)) <= set(r["named"])))),
        ("pairs: at least one", ">= 95 %", str(rate(kinds["pair"], one_is_in))),
        ("pairs: invented", "0", str(rate(kinds["pair"], wrong))),
        ("small: within noise or too small", ">= 95 %", str(rate(kinds["small"], silent))),
        ("input errors: right", "-", str(rate(kinds["input"], one_is_in))),
        ("95 % intervals cover", "90-98 %", str(rate(sizes, lambda r: r["covered"]))),
        ("median size error", "<= 10 % / 5 %", f"{median(errors):.1%}" if errors else "none"),
        ("median shrink of the gap above its floor", ">= 80 %", f"{median(gaps):.0%}" if gaps else "none"),
        (
            "median shrink of the raw gap, own channels",
            ">= 80 % base",
            f"{median(raw):.0%}" if raw else "none",
        ),
        ("gap never worse", ">= 97 %", str(rate(worse, lambda r: not r["gap_worse"]))),
        ("median time of a diagnosis", "<= 15 s", f"{median([r['seconds'] for r in rows] or [0.0]):.1f} s"),
    ]


def raw_shrink(row: Row) -> float | None:
    """How much of the raw gap on the held-out points went, of what was above the noise; None where none was."""
    if not row.get("gap"):
        return None
    _, _, before, after, floor = row["gap"]
    above = before - floor
    return None if above <= 0.5 * floor else 1.0 - max(after - floor, 0.0) / above


def spoke(row: Row) -> bool:
    """Something was named, or a group."""
    return bool(named(row)) or row["verdict"] == "alias_group"


def alarmed(row: Row) -> bool:
    """An effect is said to be present, without a name."""
    return bool(row["verdict"] == "unknown_located")


def suspected(row: Row) -> bool:
    """The data are said to be wrong."""
    return bool(row["verdict"] == "input_error_suspected")


def exchanged_falsely(row: Row) -> bool:
    """Channels or points are said to be exchanged that are not."""
    told = {name for name in named(row) if name.startswith("swapped")}
    return bool(told - set(truths(row)))


def one_is_in(row: Row) -> bool:
    """Something hidden is among what was named; a wrong unit by its channel."""
    return bool(set(truths(row)) & {name.split(" ")[0] for name in row["named"]})


def silent(row: Row) -> bool:
    """Nothing is claimed."""
    return row["verdict"] in ("within_noise", "too_small")
