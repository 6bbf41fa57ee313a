"""Fixtures for all tests, and the folder in which the processes of a test run share what takes long."""

import os

from rigdesign.base.parallel import one_blas_thread

os.environ.update(one_blas_thread())  # before numpy loads

import pytest

from tests.builders.commands import rigdesign, write
from tests.builders.file_order import longest_first
from tests.builders.shared_runs import close_folder, open_folder

__all__ = ["rigdesign", "write"]


def pytest_configure(config: pytest.Config) -> None:
    if not hasattr(config, "workerinput"):
        open_folder()


def pytest_unconfigure(config: pytest.Config) -> None:
    if not hasattr(config, "workerinput"):
        close_folder()


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """In a process of pytest-xdist, which takes files as they come (`--no-loadscope-reorder`)."""
    if hasattr(config, "workerinput"):
        longest_first(items)
