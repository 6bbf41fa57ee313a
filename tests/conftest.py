"""Fixtures for all tests."""

from tests.builders.commands import rigdesign, write

__all__ = ["rigdesign", "write"]
