"""What is being computed, on stderr: a clock that ticks, the step, and how long it still takes."""

import json
import sys
import time
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from types import TracebackType
from typing import Any

from rich.live import Live
from rich.progress_bar import ProgressBar
from rich.table import Table
from rich.text import Text

from rigdesign.base.errors import OutputError
from rigdesign.base.output_folder import write_whole
from rigdesign.cli.terminal.console import new_console, verbosity
from thermal.fe.kernel_cache import cache_folder

# How long a run still takes: from the steps of the last run of the same case, or from the points that are done.
#
# The times of the last runs stand in ``step_times.json`` of the cache folder, by case hash, fidelity and options.

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


TICKS = 4
"""Times a second the clock is drawn in a terminal."""
FIRST_RUN = "first run of this case: no estimate"


class Progress:
    """Says what is being computed: a line whose clock ticks in a terminal, plain lines elsewhere.

    times : of this run's steps against those of the last one, for the estimate; none where left out
    parallel : how many points are computed at once: the first of each also starts a worker and solves what all share,
        so that the estimate counts from the last of these
    """

    def __init__(self, times: StepTimes | None = None, *, parallel: int = 1) -> None:
        self._parallel = parallel
        self._console = new_console(stderr=True)
        self._times = times or StepTimes()
        self._started = time.perf_counter()
        self._step, self._step_began = "", 0.0
        self._counted: _Counted | None = None
        self._verbose, self._quiet = verbosity.get() == "verbose", self._console.quiet
        self._live = None
        if self._console.is_terminal and not self._quiet:
            self._live = Live(
                get_renderable=self._line, console=self._console, refresh_per_second=TICKS, transient=True
            )

    def __enter__(self) -> "Progress":
        if self._live is not None:
            self._live.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._report_step()
        if self._live is not None:
            self._live.stop()
        if error is None:
            self._times.keep(self._elapsed())

    def __call__(self, message: str) -> None:
        """Begin the step ``message``."""
        self._report_step()
        elapsed = self._elapsed()
        first = not self._step
        self._step, self._step_began, self._counted = message, elapsed, None
        self._times.begin(message, elapsed)
        rest = self._remaining_text()
        self._say(message, "" if rest == FIRST_RUN and not first else rest)

    def count(self, done: int, whole: int, last: str) -> None:
        """Show how many of many are done as a bar; a line for every tenth where the output is no terminal."""
        now = self._elapsed()
        first = self._counted is None or done <= self._parallel
        begun, since = (
            (done, now) if first or self._counted is None else (self._counted.begun, self._counted.since)
        )
        self._counted = _Counted(done, whole, last, begun, since, now)
        if self._verbose or done == whole or 10 * done // whole > 10 * (done - 1) // whole:
            self._say(f"{done} of {whole}{last and f', last {last}'}", self._remaining_text())

    def note(self, message: str) -> None:
        """Show ``message`` so that it stays."""
        self._console.print(Text("note: ", "yellow") + Text(message), soft_wrap=True)

    def _elapsed(self) -> float:
        return time.perf_counter() - self._started

    def _say(self, message: str, rest: str) -> None:
        """A plain line where no line is drawn anew, with what is left."""
        if self._live is None and not self._quiet:
            text = f"{self._elapsed():6.1f} s  {message}{f' ({rest})' if rest else ''}"
            print(text, file=sys.stderr, flush=True)

    def _report_step(self) -> None:
        """With ``--verbose``: the step that ends, with its time."""
        if self._verbose and self._step:
            seconds = self._elapsed() - self._step_began
            self._console.print(Text(f"{seconds:8.2f} s  {self._step}", "dim"), soft_wrap=True)

    def _remaining_text(self) -> str:
        """What is left, in words; empty where nothing tells."""
        elapsed = self._elapsed()
        if self._counted is not None:
            left = self._counted.remaining(elapsed)
            return "" if left is None else f"about {duration_text(left)} left"
        if self._times.first_run:
            return FIRST_RUN if self._times.key else ""
        remaining = self._times.remaining(elapsed)
        if remaining is None:
            return ""
        return f"about {duration_text(remaining)} left" if remaining else "longer than last time"

    def _line(self) -> Table:
        """The line of a terminal, drawn anew at every tick."""
        row = Table.grid(padding=(0, 1))
        head = [Text(f"{self._elapsed():6.1f} s"), Text(self._remaining_text(), "dim")]
        if self._counted is None:
            row.add_row(*head, _cut(self._step or "starting"))
        else:
            counted = self._counted
            bar = ProgressBar(counted.whole, counted.done, width=20)
            row.add_row(*head, bar, Text(f"{counted.done} of {counted.whole}"), _cut(counted.last))
        return row


def _cut(text: str) -> Text:
    """A text that ends with the line."""
    return Text(text, overflow="ellipsis", no_wrap=True)


@dataclass(frozen=True)
class _Counted:
    """How many of many are done, and when this was counted [s]; ``begun`` were when the estimate began, ``since``."""

    done: int
    whole: int
    last: str
    begun: int
    since: float
    at: float

    def remaining(self, elapsed: float) -> float | None:
        """Seconds for the others, each at the mean of those since the estimate began; None with none done or left."""
        if not self.begun < self.done < self.whole:
            return None
        left = remaining_points(self.done - self.begun, self.whole - self.begun, self.at - self.since)
        return max(0.0, left - (elapsed - self.at))
