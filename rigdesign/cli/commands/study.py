"""`rigdesign study`: a case over values of its inputs."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from rigdesign.base.fidelity import Fidelity
from rigdesign.cli.application import app, loaded_case


@app.command
def study(
    case: Path,
    *,
    vary: Annotated[list[str], Parameter(negative=())],
    out: Path,
    fidelity: Fidelity = "standard",
    workers: int | None = None,
    retry: bool = False,
) -> int:
    """Run a case over a grid of parameter values; resumes where it stopped.

    Parameters
    ----------
    case
        Case folder or its case.toml.
    vary
        'PATH=START:STOP:STEP' or 'PATH=v1,v2', once per parameter; several make a grid.
    out
        Folder of the study: ledger, results.csv, plot of margins.
    fidelity
        Size of the models.
    workers
        Number of worker processes; default one per core.
    retry
        Run points again that failed before.
    """
    loaded = loaded_case(case)
    from rigdesign.cli.terminal.progress import Progress
    from rigdesign.cli.terminal.study import print_study
    from rigdesign.report.pages.study import write_study
    from rigdesign.studies.run import Execution, parse_variation, run_study

    variations = [parse_variation(text) for text in vary]
    with Progress() as progress:
        execution = Execution(workers=workers, retry=retry, progress=progress, note=progress.note)
        outcome = run_study(
            loaded, variations, out, write=write_study, fidelity=fidelity, execution=execution
        )
    print_study(outcome, out)
    return 0
