"""Verdict of a check and of a run."""

from typing import Literal

Verdict = Literal["pass", "warn", "fail", "not applicable"]
