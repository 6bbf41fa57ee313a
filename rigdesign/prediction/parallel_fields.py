"""Works on fields of one mesh on all cores, while its products are too small for threads of their own."""

from collections.abc import Callable, Sequence
from typing import TypeVar

from rigdesign.base.parallel import BackgroundTasks
from thermal.fe.kernels import THREADED

T = TypeVar("T")


def fields_in_parallel(nodes: int, works: Sequence[Callable[[], T]]) -> list[T]:
    """Results of works on fields of so many nodes, in their order; the same bits on any number of cores."""
    if nodes >= THREADED:
        return [work() for work in works]
    with BackgroundTasks(works) as tasks:
        return tasks.results()
