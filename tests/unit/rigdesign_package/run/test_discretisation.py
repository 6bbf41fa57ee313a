"""Error estimates from two and three meshes: exact for powers of the element size, honest elsewhere."""

from dataclasses import replace
from typing import cast

import pytest

from rigdesign.checks.rules import with_error
from rigdesign.results.check import Check, Verdict
from rigdesign.run.mesh_convergence import EDGE_ORDER, richardson

NODES = (1_000, 3_000, 24_000)


def values(order: float, wrong: float = 5.0, limit: float = 80.0) -> list[float]:
    """What meshes of NODES give if the error is ``wrong`` at the first and falls with h^order."""
    return [limit + wrong * (n / NODES[0]) ** (-order / 3.0) for n in NODES]


@pytest.mark.parametrize("order", [1.0, 2.0, 3.5])
def test_three_meshes_without_a_constant_ratio_give_order_and_error(order: float) -> None:
    found = values(order)
    error, observed, how = richardson(NODES, found)
    assert observed == pytest.approx(order, rel=1e-4)
    assert error == pytest.approx(abs(found[-1] - 80.0), rel=1e-4)
    assert how == f"Richardson with the observed order {order:.2f}"


def test_two_meshes_assume_the_order_of_re_entrant_edges() -> None:
    found = values(EDGE_ORDER)[1:]
    error, order, how = richardson(NODES[1:], found)
    assert error == pytest.approx(abs(found[-1] - 80.0))
    assert order == EDGE_ORDER
    assert "assumed" in how


@pytest.mark.parametrize(
    ("found", "how"),
    [
        ((1.0, 1.4, 1.3), "not monotone"),
        ((1.0, 1.1, 1.5), "no order between"),
        ((1.0, 1.0, 1.0), "not monotone"),
    ],
)
def test_without_an_order_the_largest_change_is_the_error(
    found: tuple[float, float, float], how: str
) -> None:
    error, order, said = richardson(NODES, found)
    assert error == pytest.approx(max(abs(found[2] - found[1]), abs(found[1] - found[0])))
    assert order is None
    assert said.startswith(how)


def check(margin: float, verdict: str = "pass", reason: str = "") -> Check:
    return Check(
        id="clearance.seal_gap", title="gap", value=0.3 + margin, limit=0.3, unit="mm", comparison=">=",
        margin=margin, distance=0.1, verdict=cast("Verdict", verdict), source="limits", role="rig", reason=reason,
    )  # fmt: skip


def test_a_margin_within_the_error_warns_and_says_so() -> None:
    found = with_error(check(0.01, reason="front at 90 deg"), 0.02)
    assert found.verdict == "open"
    assert found.error == 0.02
    assert found.reason == "front at 90 deg; the discretisation leaves 0.02 mm open, more than the margin"


@pytest.mark.parametrize(("margin", "verdict"), [(0.05, "pass"), (0.05, "open"), (-0.05, "fail")])
def test_a_margin_beyond_the_error_keeps_its_verdict(margin: float, verdict: str) -> None:
    found = with_error(check(margin, verdict), 0.02)
    assert found == replace(check(margin, verdict), error=0.02)


def test_a_missed_limit_within_the_error_is_open_too() -> None:
    found = with_error(check(-0.01, "fail"), 0.02)
    assert found.verdict == "open" and "more than the margin" in found.reason


def test_without_an_error_nothing_is_said() -> None:
    assert with_error(check(0.01), None) == check(0.01)
