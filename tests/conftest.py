"""Fixtures for all tests, and the folder in which the processes of a test run share what takes long."""

import pytest

from tests.builders.commands import rigdesign, write
from tests.builders.shared_runs import close_folder, open_folder

__all__ = ["rigdesign", "write"]


def pytest_configure(config: pytest.Config) -> None:
    if not hasattr(config, "workerinput"):
        open_folder()


def pytest_unconfigure(config: pytest.Config) -> None:
    if not hasattr(config, "workerinput"):
        close_folder()
