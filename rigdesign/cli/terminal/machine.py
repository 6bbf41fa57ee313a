"""What a machine has, and the meshes that were written."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rich.text import Text

from rigdesign.cli.terminal.console import new_console

if TYPE_CHECKING:
    from rigdesign.base.system import MachineFinding
    from rigdesign.cli.mesh_export import ExportedFile


def print_findings(findings: Sequence["MachineFinding"]) -> None:
    """The lines of `rigdesign doctor`."""
    console = new_console()
    for finding in findings:
        mark = Text("ok      ", "green") if finding.ok else Text("missing ", "bold red")
        console.print(mark + Text(f"{finding.subject:12s} {finding.text}"))


def print_meshes(written: Sequence["ExportedFile"]) -> None:
    """Every file that was written, and what to do with it."""
    console = new_console()
    for done in written:
        console.print(f"{done.file}: {done.remark}")
