"""What is being computed, on stderr."""

import sys
import time
from types import TracebackType

from rich.progress_bar import ProgressBar
from rich.table import Table
from rich.text import Text

from rigdesign.cli.terminal.console import new_console


class Progress:
    """Says what is being computed: a spinner in a terminal, plain lines elsewhere."""

    def __init__(self) -> None:
        self._console = new_console(stderr=True)
        self._status = self._console.status("starting") if self._console.is_terminal else None
        self._started = time.perf_counter()

    def __enter__(self) -> "Progress":
        if self._status is not None:
            self._status.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        if self._status is not None:
            self._status.stop()

    def count(self, done: int, whole: int, last: str) -> None:
        """Show how many of many are done as a bar; a line for every tenth where the output is no terminal."""
        if self._status is not None:
            row = Table.grid(padding=(0, 1))
            row.add_row(self._elapsed(), ProgressBar(whole, done, width=30), f"{done} of {whole}", Text(last))
            self._status.update(row)
        elif done == whole or 10 * done // whole > 10 * (done - 1) // whole:
            self(f"{done} of {whole}, last {last}")

    def _elapsed(self) -> str:
        return f"{time.perf_counter() - self._started:6.1f} s"

    def note(self, message: str) -> None:
        """Show ``message`` so that it stays."""
        self._console.print(Text("note: ", "yellow") + Text(message), soft_wrap=True)

    def __call__(self, message: str) -> None:
        """Show ``message`` with the seconds since the start."""
        text = f"{self._elapsed()}  {message}"
        if self._status is not None:
            self._status.update(Text(text))
        else:
            print(text, file=sys.stderr, flush=True)
