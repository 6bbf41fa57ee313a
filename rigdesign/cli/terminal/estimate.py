"""How long a run still takes: from the steps of the last run of the same case, or from the points that are done.

The times of the last runs stand in ``step_times.json`` of the cache folder, by case hash, fidelity and options.
"""

import json
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from rigdesign.base.errors import OutputError
from rigdesign.base.output_folder import write_whole
from thermal.fe.kernel_cache import cache_folder

MOST_RUNS = 40
"""Runs whose times are kept."""
SETTLED = 2.0
"""Seconds of the last run from which this run counts as faster or slower than it was."""
PACE = (0.25, 4.0)
"""Between which the pace of a run against the last one is believed."""


@dataclass
class StepTimes:
    """Steps of this run, and of the last one of the same kind.

    key : what makes two runs the same: case hash, fidelity, options; empty: nothing is known or kept
    """

    key: str = ""
    last: Mapping[str, float] = field(default_factory=dict)
    """Seconds from the start to each step, by its message; ``END`` for the whole."""
    _now: dict[str, float] = field(default_factory=dict)
    _step: str = ""

    @property
    def first_run(self) -> bool:
        """Nothing is known of a run like this."""
        return not self.last

    def begin(self, message: str, elapsed: float) -> None:
        """A step begins ``elapsed`` seconds after the start."""
        self._now.setdefault(message, elapsed)
        if message in self.last:
            self._step = message

    def remaining(self, elapsed: float) -> float | None:
        """Seconds to the end of the run, at the pace it had so far; None where nothing tells, 0 when overdue."""
        whole = self.last.get(END)
        if whole is None or not self._step:
            return None
        then, now = self.last[self._step], self._now[self._step]
        pace = min(max(now / then, PACE[0]), PACE[1]) if then > SETTLED else 1.0
        return max(0.0, pace * (whole - then) - (elapsed - now))

    def keep(self, elapsed: float) -> None:
        """Store the steps of this run for the next one; a folder that cannot be written is left alone."""
        if not self.key or not self._now:
            return
        kept = {key: steps for key, steps in _stored().items() if key != self.key}
        steps = {message: round(time, 2) for message, time in self._now.items()} | {END: round(elapsed, 2)}
        runs = dict([*kept.items(), (self.key, steps)][-MOST_RUNS:])
        with suppress(OSError, OutputError):
            _file().parent.mkdir(parents=True, exist_ok=True)
            write_whole(_file(), json.dumps(runs, ensure_ascii=False))


END = "end"
"""Key of the length of a whole run among its steps."""


def step_times(key: str) -> StepTimes:
    """Of a run with this key, with those of the last one if they are known."""
    return StepTimes(key=key, last=_stored().get(key, {}))


def remaining_points(done: int, whole: int, seconds: float) -> float:
    """Seconds that the other points take if each takes the mean of those done in ``seconds``, however many at once."""
    return seconds / done * (whole - done) if done else 0.0


def duration_text(seconds: float) -> str:
    """A length of time that is an estimate, of a second at least: 8 s, 40 s, 3 min, 2.5 h."""
    if seconds < 10.0:
        return f"{max(1.0, seconds):.0f} s"
    if seconds < 90.0:
        return f"{round(seconds, -1):.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 5400.0 else f"{seconds / 3600.0:.1f} h"


def _file() -> Path:
    return cache_folder() / "step_times.json"


def _stored() -> dict[str, dict[str, float]]:
    """Steps by key; empty where there are none or the file is damaged."""
    try:
        runs: Any = json.loads(_file().read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    if not isinstance(runs, dict):
        return {}
    return {
        key: steps
        for key, steps in runs.items()
        if isinstance(steps, dict) and all(isinstance(time, int | float) for time in steps.values())
    }
