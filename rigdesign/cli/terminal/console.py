"""The console of all commands."""

from rich.console import Console


def new_console(*, stderr: bool = False, wrap: bool = False, width: int | None = None) -> Console:
    """A console that prints every text as it is: brackets and colons of a title are no markup."""
    return Console(stderr=stderr, markup=False, emoji=False, highlight=False, soft_wrap=not wrap, width=width)
