"""Fidelity of the models of a run."""

from typing import Literal

Fidelity = Literal["quick", "standard", "reference"]
