"""What a machine has, and the meshes that were written."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from rich.text import Text

from rigdesign.cli.terminal.console import new_console

if TYPE_CHECKING:
    from rigdesign.base.system import MachineFinding


def print_findings(findings: Sequence["MachineFinding"]) -> None:
    """The lines of `rigdesign doctor`."""
    console = new_console()
    for finding in findings:
        mark = Text("ok      ", "green") if finding.ok else Text("missing ", "bold red")
        console.print(mark + Text(f"{finding.subject:12s} {finding.text}"))


def print_meshes(written: Sequence[tuple[str, Path, int]]) -> None:
    """Every mesh that was written, and the lines that make a case read it."""
    console = new_console()
    for name, file, nodes in written:
        console.print(f'{file}: {nodes} nodes; [gearboxes.{name}.housing] mesh_file = "{file.name}" reads it')
