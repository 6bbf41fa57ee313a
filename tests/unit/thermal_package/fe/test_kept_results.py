"""Results kept in memory: the same object again, within a number of bytes however many there are."""

from dataclasses import dataclass, field

import numpy as np
import pytest

from thermal.fe import kept_results
from thermal.fe.kept_results import kept
from thermal.fe.kernels import cells_of_nodes

MEGABYTE = 1_000_000


@pytest.fixture(autouse=True)
def nothing_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kept_results, "LIMIT", 10 * MEGABYTE)
    monkeypatch.setattr(kept_results, "_results", type(kept_results._results)())


@dataclass(frozen=True)
class Made:
    """Holds an array, and later more of them."""

    values: np.ndarray
    later: dict[str, np.ndarray] = field(default_factory=dict)


def held_bytes() -> int:
    return kept_results._bytes([kept_results._results], set())


def counted(megabytes: float):
    """A function whose results hold so much, and its calls."""
    calls: list[int] = []

    @kept
    def make(number: int) -> Made:
        calls.append(number)
        return Made(np.zeros((round(megabytes * MEGABYTE) // 8,)))

    return make, calls


def test_what_is_kept_is_bounded_in_bytes_and_what_was_used_last_stays() -> None:
    make, calls = counted(2.0)
    first = make(0)
    for number in range(1, 40):
        make(number)
        assert make(0) is first
        assert held_bytes() <= 10 * MEGABYTE
    assert calls == list(range(40))
    make(39), make(1)
    assert calls[40:] == [1]


def test_many_small_results_are_kept() -> None:
    make, calls = counted(0.01)
    for _ in range(2):
        for number in range(200):
            make(number)
    assert calls == list(range(200))


def test_a_result_above_the_limit_stays_alone() -> None:
    large, calls = counted(30.0)
    small, _ = counted(1.0)
    small(1)
    assert large(1) is large(1) and calls == [1]
    small(2)
    assert held_bytes() < 2 * MEGABYTE


def test_what_two_results_share_counts_once_and_what_grew_later_counts() -> None:
    shared = np.zeros((6 * MEGABYTE // 8,))
    half = kept(lambda number: Made(shared[number:]))
    first, second = half(0), half(1)
    assert 6 * MEGABYTE < held_bytes() < 7 * MEGABYTE
    assert half(0) is first and half(1) is second
    first.later["more"] = np.zeros((9 * MEGABYTE // 8,))
    half(2)
    assert held_bytes() < 7 * MEGABYTE and half(1) is second


def test_memory_of_compiled_functions_counts() -> None:
    """numba hands out arrays that do not own theirs."""
    count = MEGABYTE // 16
    points, cells = np.zeros((3, count)), np.arange(4 * count).reshape(4, -1) % count
    assert cells_of_nodes(cells, points.shape[1])[1].base is not None
    kept(lambda: cells_of_nodes(cells, count))()
    assert held_bytes() > cells.nbytes // 2
