"""`rigdesign check`: the main job."""

from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

from rigdesign.base.errors import UsageError
from rigdesign.base.fidelity import Fidelity
from rigdesign.cli.application import OptionalOutFolder, Several, app, loaded_case, print_json
from rigdesign.cli.exit_status import NOTHING_KEPT, failure_kept, interrupted
from rigdesign.cli.terminal.console import verbosity


@app.command
def check(
    case: Path,
    /,
    *,
    out: OptionalOutFolder = None,
    fidelity: Fidelity = "standard",
    transient: Annotated[bool, Parameter(negative=())] = False,
    ranges: Annotated[bool, Parameter(negative=())] = False,
    checks: Annotated[list[str] | None, Several] = None,
    everything: Annotated[bool, Parameter(name="--all", negative=())] = False,
    pdf: Annotated[bool, Parameter(negative=())] = False,
    author: str | None = None,
    json: bool = False,
    fail_on: Literal["advisory", "close"] | None = None,
) -> int:
    """Compute loads, losses, temperatures and clearances of a rig and hold them against its limits.

    Parameters
    ----------
    case
        Case folder or its case.toml.
    out
        Folder for results.json, report.html, junit.xml, fields and curves.
    fidelity
        Size of the models: quick, standard or reference.
    transient
        Follow temperatures and clearances over warm-up, schedule, stops and soak-back as well.
    ranges
        Move every assumed input to both ends of its range, one at a time: a check passes only if it holds there too.
    checks
        Patterns on the ids of the checks to judge: `temperature.*` takes, `!specimen.root_stress*` leaves out. What is
        not selected does not count for the verdict.
    everything
        Print every check and every note, not only what decides.
    pdf
        Write the report as report.pdf to the folder of --out too (extra pdf: WeasyPrint).
    author
        Who prepares the report, in place of document.author of the case.
    json
        Print results.json on stdout; everything else goes to stderr.
    fail_on
        Exit status 1 for a missed advisory limit too; with close also for a check with less than 5 % of its limit left.
    """
    if everything and verbosity.get() == "quiet":
        raise UsageError(
            "--all prints every check and --quiet nothing but the verdict; leave one of them out"
        )
    loaded = loaded_case(case)
    from rigdesign.base.output_folder import prepare_output
    from rigdesign.cli.terminal.checks import print_checks
    from rigdesign.cli.terminal.console import print_run
    from rigdesign.cli.terminal.progress import Progress, step_times
    from rigdesign.report.input_sheets import Issue
    from rigdesign.report.results_json import results_document
    from rigdesign.report.writing import write_results
    from rigdesign.run.main import run_case
    from rigdesign.studies.result import CheckSelection
    from rigdesign.studies.verdict_sensitivity import with_flips

    selection = CheckSelection(checks or ())
    selection.require(loaded, transient=transient)
    if out is not None:
        prepare_output(out)
    elif pdf or author is not None:
        option = "--pdf" if pdf else "--author"
        raise UsageError(f"{option} needs the folder of the report; add --out DIR")
    if pdf:
        from rigdesign.report.pdf import require_pdf

        require_pdf()
    options = "".join(f" {name}" for name, on in (("transient", transient), ("ranges", ranges)) if on)
    times = step_times(f"check {loaded.hash[:16]} {fidelity}{options}")
    with Progress(times) as progress, interrupted(NOTHING_KEPT), failure_kept(out):
        result = run_case(
            loaded,
            fidelity=fidelity,
            progress=progress,
            transient=transient,
            follow_ups={"checks": selection.applied, "flips": with_flips},
            count=progress.count,
        )
        if ranges:
            from rigdesign.studies.assumed_ranges import with_ranges

            result = with_ranges(loaded, result, progress=progress, count=progress.count)
        if out is not None:
            progress("writing report")
            write_results(result, out, Issue(author=author or ""), pdf=pdf)
    print_run(result)
    if json:
        print_json(results_document(result))
    else:
        print_checks(result, out, everything=everything)
    flags = {None: (), "advisory": ("advisory",), "close": ("advisory", "close")}[fail_on]
    flagged = any(flag in check.flags for check in result.checks for flag in flags)
    return 1 if result.verdict != "pass" or flagged else 0


# `rigdesign report`: a finished check printed again; nothing is solved.


@app.command
def report(
    result: Path,
    /,
    *,
    html: Annotated[bool, Parameter(negative=())] = False,
    pdf: Annotated[bool, Parameter(negative=())] = False,
    out: OptionalOutFolder = None,
    author: str | None = None,
    everything: Annotated[bool, Parameter(name="--all", negative=())] = False,
) -> int:
    """Print a finished check again and write its report; nothing is solved, the verdict is that of the run.

    The report is made from results.json, with pictures of temperatures as far as its fields/*.vtu stand beside it. The
    exit status is 0 whatever the verdict.

    Parameters
    ----------
    result
        Folder of `rigdesign check --out`, or its results.json.
    html
        Write report.html.
    pdf
        Write report.pdf (extra pdf: WeasyPrint).
    out
        Folder for them, that of the result where left out.
    author
        Who prepares the report, in place of document.author of the case.
    everything
        Print every check and every note, not only what decides.
    """
    from rigdesign.cli.terminal.checks import print_checks
    from rigdesign.report.input_sheets import Issue
    from rigdesign.report.results_json import read_result
    from rigdesign.report.writing import write_report

    if not (html or pdf) and (out is not None or author is not None):
        option = "--out" if out is not None else "--author"
        raise UsageError(f"{option} says nothing without a report to write; add --html or --pdf")
    if pdf:
        from rigdesign.report.pdf import require_pdf

        require_pdf()
    found, file = read_result(result)
    print_checks(found, None, everything=everything)
    if html or pdf:
        for path in write_report(found, out or file.parent, Issue(author=author or ""), html=html, pdf=pdf):
            print(f"report: {path}")
    return 0
