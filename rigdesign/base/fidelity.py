"""How fine the models of a run are."""

from typing import Literal

Fidelity = Literal["quick", "standard", "reference"]
