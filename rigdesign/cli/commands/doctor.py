"""`rigdesign doctor`: what the machine lacks."""

from rigdesign.cli.application import app


@app.command
def doctor() -> int:
    """Look for missing system libraries and compile the kernels once."""
    from rigdesign.base.system import diagnose
    from rigdesign.cli.terminal.machine import print_findings

    findings = diagnose()
    print_findings(findings)
    return 0 if all(finding.ok for finding in findings) else 4
