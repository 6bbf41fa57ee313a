"""The thermal course of a schedule: what heats the housings over time, their temperatures, their clearances."""

from rigdesign.transient.course import Branch, TransientRun, run_transient

__all__ = ["Branch", "TransientRun", "run_transient"]
