"""`rigdesign study`: a case over values of its inputs."""

from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

from rigdesign.base.fidelity import Fidelity
from rigdesign.cli.application import OutFolder, Several, app, loaded_case

Switch = Parameter(negative=())


@app.command
def study(
    case: Path,
    /,
    *,
    vary: Annotated[list[str], Several],
    out: OutFolder,
    sample: str | None = None,
    seed: int = 0,
    indices: Annotated[bool, Switch] = False,
    tornado: Annotated[bool, Switch] = False,
    boundary: Annotated[bool, Switch] = False,
    tolerance: str | None = None,
    checks: Annotated[list[str] | None, Several] = None,
    fidelity: Fidelity = "standard",
    workers: int | str | None = None,
    shard: str | None = None,
    table: Annotated[list[Literal["parquet", "xlsx"]] | None, Several] = None,
    retry: Annotated[bool, Switch] = False,
) -> int:
    """Run a case over values of its inputs; resumes where it stopped.

    Parameters
    ----------
    case
        Case folder or its case.toml.
    vary
        Grid: 'PATH=START:STOP:STEP' or 'PATH=v1,v2', a unit at every value or at the last. All other designs:
        'PATH=LOW:HIGH', or 'assumed' for every assumed input with a range. Once per parameter. `*` in PATH stands
        for any name: `gearboxes.*.oil.inlet_temperature` for all gearboxes, `gearboxes.test.bearings.*.width` for all
        bearings of one.
    out
        Folder of the study: ledger, results.csv, study.html.
    sample
        Points spread over the ranges: 'lhs:N' Latin hypercube, 'sobol:N' Sobol sequence (N a power of two). Gives the
        probability that each check holds.
    seed
        Of the sample.
    indices
        Sobol indices: what share of the spread of a check each input causes. N x (inputs + 2) points, with
        --sample sobol:N.
    tornado
        Every input at both ends of its range, one at a time.
    boundary
        The values of one input at which checks change from held to broken, by bisection.
    tolerance
        Of these values, such as '0.5 K'; default 1/200 of the range.
    checks
        Patterns on the ids of the checks to look at: `temperature.*` takes, `!specimen.root_stress*` leaves out.
    fidelity
        Size of the models.
    workers
        Number of worker processes (default one per core), or the dask scheduler of a cluster, 'tcp://host:8786'.
    shard
        Compute share i of n of the points, 'i/n', for the jobs of an array; the last one writes the files.
    table
        Write results.parquet or results.xlsx as well.
    retry
        Run points again that failed before.
    """
    loaded = loaded_case(case)
    from rigdesign import api
    from rigdesign.base.parallel import granted_cores
    from rigdesign.cli.terminal.progress import Progress
    from rigdesign.cli.terminal.study import print_study
    from rigdesign.studies.design import StudyDesign
    from rigdesign.studies.ledger import parse_shard
    from rigdesign.studies.run import Execution

    design = StudyDesign(
        vary=tuple(vary),
        sample=sample,
        seed=seed,
        indices=indices,
        tornado=tornado,
        boundary=boundary,
        tolerance=tolerance,
        checks=tuple(checks or ()),
    )
    parallel = granted_cores() if workers is None else workers if isinstance(workers, int) else 1
    with Progress(parallel=parallel) as progress:
        execution = Execution(
            workers=workers,
            shard=None if shard is None else parse_shard(shard),
            retry=retry,
            progress=progress,
            count=progress.count,
            note=progress.note,
        )
        outcome = api.study(loaded, design, out, fidelity=fidelity, execution=execution, tables=table or ())
        if outcome.missing:
            progress.note(
                f"{outcome.completed} points computed, {outcome.reused} found done, {outcome.missing} left to other "
                f"shards; the last one writes {out / 'results.csv'}"
            )
            return 0
    print_study(outcome, out)
    return 0
