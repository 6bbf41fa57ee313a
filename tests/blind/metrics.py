"""Numbers of the blind score, each with its count and Wilson interval."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import isnan, nan, sqrt
from statistics import median
from typing import Any

Row = dict[str, Any]
"""One scored set: its answer and what was diagnosed."""

EASY = frozenset({
    "run_out", "cumulative_pitch", "single_pitch", "motor_ripple", "coupling_order_2",
    "mesh_loss", "bearing_loss", "windage_loss", "seal_loss", "jet_loss", "squeeze_loss",
    "leak_warm_cold", "bypass", "short_circuit", "blocked_jet", "one_bearing_loss", "leak_one_side",
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
    return _sorted(f"{kind}:{place}" if place else kind)


def _sorted(name: str) -> str:
    """An exchange of two with both in the order of their names."""
    kind, _, place = name.partition(":")
    return f"{kind}:{','.join(sorted(place.split(',')))}" if kind.startswith("swapped") else name


def reported(row: Row) -> list[str]:
    """What was named, suspected or grouped."""
    return [_sorted(name) for name in row["named"]]


def named(row: Row) -> list[str]:
    """What was named outright."""
    return reported(row) if row["verdict"] in ("named", "input_error_suspected") else []


def right(row: Row) -> bool:
    """The hidden effect alone was named, or is in the alias group."""
    hidden = set(truths(row))
    given = set(reported(row))
    if row["verdict"] == "alias_group":
        return bool(hidden & given)
    return bool(named(row)) and given == hidden


def wrong(row: Row) -> bool:
    """A name that is not hidden was given."""
    return bool(set(named(row)) - set(truths(row))) or (
        row["verdict"] == "alias_group" and not set(reported(row)) & set(truths(row))
    )


SIZES = {"measured": "detectable_sizes", "declared": "detectable_sizes_declared"}
"""Floor (`tests.virtual_rig.detect.FLOORS`) -> key of an effect."""


def size_of(row: Row, floor: str = "declared") -> float:
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


@dataclass(frozen=True)
class Line:
    """One line of the score: what is counted, its target with a baseline and for the model alone, what was measured."""

    name: str
    baseline: str
    alone: str
    measured: str


def table(rows: Sequence[Row], floor: str = "declared") -> list[Line]:
    """The score of one mode, detectable sizes over one of two floors."""
    kinds = {kind: [row for row in rows if row["kind"] == kind] for kind in
             ("none", "single", "pair", "out", "small", "input")}  # fmt: skip
    return [
        *_without_effect(kinds),
        *_singles(kinds["single"], floor),
        *_pairs(kinds["pair"]),
        Line("small: within noise or too small", "-", "-", str(rate(kinds["small"], silent))),
        *_data(rows, kinds["input"]),
        *_sizes(kinds["single"]),
        *_gaps(rows),
        Line("median time of a diagnosis", "<= 15 s", "<= 15 s", f"{_median([r['seconds'] for r in rows]):.1f} s"),
    ]  # fmt: skip


def compared(rows: Sequence[Row], comparator: str, floor: str = "declared") -> list[tuple[str, str]]:
    """What a simpler method names on the same sets."""
    own: list[Row] = [{**row, "verdict": "named", "named": row["comparators"][comparator]} for row in rows]
    none, single, out = ([row for row in own if row["kind"] == kind] for kind in ("none", "single", "out"))
    large = [row for row in single if size_of(row, floor) >= 2.0]
    return [
        ("named without an effect", str(rate(none, spoke))),
        ("named outside the catalogue", str(rate(out, spoke))),
        ("wrong or extra name on singles", str(rate(single, wrong))),
        ("excitation, loss, flow of 2 sizes or more: right", str(rate(filter(easy, large), right))),
        ("parameter of 2 sizes or more: right", str(rate((row for row in large if not easy(row)), right))),
    ]


def _without_effect(kinds: Mapping[str, Sequence[Row]]) -> list[Line]:
    """What is said of healthy rigs, and of effects that the catalogue does not hold."""
    return [
        Line("named without an effect", "<= 1 %", "<= 1 %", str(rate(kinds["none"], spoke))),
        Line("false alarm of any kind", "<= 5 %", "<= 5 %", str(rate(kinds["none"], alarmed))),
        Line("named outside the catalogue", "<= 2 %", "<= 2 %", str(rate(kinds["out"], spoke))),
        Line("suspected outside the catalogue", "-", "-", str(rate(kinds["out"], suspects))),
        Line("outside the catalogue: located", "-", "-", str(rate(kinds["out"], located))),
    ]


def _singles(rows: Sequence[Row], floor: str) -> list[Line]:
    large = [row for row in rows if size_of(row, floor) >= 2.0]
    between = [row for row in rows if 1.0 <= size_of(row, floor) < 2.0]
    excitations, parameters = [row for row in large if easy(row)], [row for row in large if not easy(row)]
    return [
        Line("wrong or extra name on singles", "<= 2 %", "<= 2 %", str(rate(rows, wrong))),
        Line("wrong suspicion on singles", "-", "-", str(rate(rows, wrongly_suspected))),
        Line("excitation, loss, flow: name or group", ">= 85 %", ">= 40 %", str(rate(excitations, right))),
        Line(
            "excitation, loss, flow: among three", ">= 97 %", ">= 70 %", str(rate(excitations, among_three))
        ),
        Line("parameter: name or group", ">= 75 %", ">= 30 %", str(rate(parameters, right))),
        Line("parameter: among three", ">= 95 %", ">= 60 %", str(rate(parameters, among_three))),
        Line(">= 2 sizes: named, group or suspected", "-", "-", str(rate(large, found))),
        Line("1 to 2 sizes: name or group", "-", "-", str(rate(between, right))),
    ]


def _pairs(rows: Sequence[Row]) -> list[Line]:
    return [
        Line("pairs: at least one named or suspected", ">= 85 %", "-", str(rate(rows, one_is_in))),
        Line("pairs: both", ">= 40 %", "-", str(rate(rows, lambda r: set(truths(r)) <= set(reported(r))))),
        Line("pairs: invented", "0", "-", str(rate(rows, wrong))),
    ]


def _data(rows: Sequence[Row], inputs: Sequence[Row]) -> list[Line]:
    of_data = [row for row in rows if row["kind"] != "input"]
    return [
        Line("input errors found", ">= 90 %", ">= 60 %", str(rate(inputs, one_is_in))),
        Line("false exchanges", "0", "0", str(rate(rows, exchanged_falsely))),
        Line("data suspected where none are wrong", "-", "-", str(rate(of_data, suspects_data))),
    ]


def _sizes(rows: Sequence[Row]) -> list[Line]:
    """Of single effects that were named rightly."""
    sized = [row for row in rows if right(row) and row["covered"] is not None]
    return [
        Line("95 % intervals that hold the true size", "90-98 %", "90-98 %", str(rate(sized, lambda r: r["covered"]))),
        Line("median size error", "<= 10 %", "-", _share(_median([row["size_error"] for row in sized]))),
    ]  # fmt: skip


def _gaps(rows: Sequence[Row]) -> list[Line]:
    """Of all sets in which something was named, on the points held out, with the patched case run in full."""
    named_ones = [row for row in rows if row.get("gap")]
    shrinks = [shrink for row in named_ones if (shrink := raw_shrink(row)) is not None]
    return [
        Line("raw gap of the moved channels shrinks", ">= 80 %", "-", _share(_median(shrinks))),
        Line("raw gap grows", "0", "0", str(rate(named_ones, lambda r: r["gap"][3] > r["gap"][2]))),
        Line("whitened gap grows", "0", "0", str(rate(named_ones, lambda r: r["gap_worse"]))),
    ]


def _median(values: Sequence[float]) -> float:
    return median(values) if values else nan


def _share(value: float) -> str:
    return "none" if isnan(value) else f"{value:.0%}"


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
    """Anything is said to be present or wrong, with a name or without."""
    return not silent(row)


def located(row: Row) -> bool:
    """An effect is said to be present, without a name."""
    return bool(row["verdict"] == "unknown_located")


def suspects(row: Row) -> bool:
    """An effect is suspected."""
    return bool(row["verdict"] == "suspected")


def wrongly_suspected(row: Row) -> bool:
    """An effect is suspected that is not hidden."""
    return suspects(row) and not one_is_in(row)


def found(row: Row) -> bool:
    """The hidden effect is named, in the group, or suspected."""
    return right(row) or (suspects(row) and one_is_in(row))


def suspects_data(row: Row) -> bool:
    """The data are said to be wrong."""
    return bool(row["verdict"] == "input_error_suspected")


def exchanged_falsely(row: Row) -> bool:
    """Channels or points are said to be exchanged that are not."""
    exchanged = {name for name in named(row) if name.startswith("swapped")}
    return bool(exchanged - set(truths(row)))


def one_is_in(row: Row) -> bool:
    """Something hidden is among what was named; a wrong unit by its channel."""
    return bool(set(truths(row)) & {name.split(" ")[0] for name in reported(row)})


def silent(row: Row) -> bool:
    """Nothing is claimed."""
    return row["verdict"] in ("within_noise", "too_small", "data_insufficient")
