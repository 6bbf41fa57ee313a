"""`rigdesign doctor`: what the machine lacks."""

import sys
from typing import Literal

from rigdesign.cli.application import app


@app.command
def doctor() -> int:
    """Look for missing system libraries and compile the kernels once."""
    from rigdesign.base.system import diagnose
    from rigdesign.cli.terminal.console import print_findings

    findings = diagnose()
    print_findings(findings)
    return 0 if all(finding.ok for finding in findings) else 4


# `rigdesign completion`: commands, options and files completed by the shell.


@app.command
def completion(shell: Literal["bash", "zsh", "fish"], /) -> int:
    """Print the script that completes commands, options, their choices and case folders in a shell.

    bash: rigdesign completion bash > ~/.local/share/bash-completion/completions/rigdesign; zsh: as _rigdesign in a
    folder of fpath; fish: ~/.config/fish/completions/rigdesign.fish.

    Parameters
    ----------
    shell
        bash, zsh or fish.
    """
    sys.stdout.write(app.meta.generate_completion(prog_name="rigdesign", shell=shell))
    return 0
