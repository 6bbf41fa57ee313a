"""Error estimates from two and three meshes: exact for powers of the element size, honest elsewhere."""

import pytest

from rigdesign.discretisation import EDGE_ORDER, richardson

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
