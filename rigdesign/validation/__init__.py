"""`rigdesign validate`: published numbers against ours, each with the assumption it depends on.

``rows`` says what a row is, ``document`` what becomes of the rows, ``prototype`` and ``speed_sweeps`` what
several of them share; every other module holds the rows of one topic and names in its docstring what they
found out about the publication.
"""

from collections.abc import Callable, Iterable
from functools import partial

from rigdesign.validation.document import headline, validation_csv, validation_document, validation_json
from rigdesign.validation.rows import ValidationRow

__all__ = [
    "ValidationRow",
    "headline",
    "validation_csv",
    "validation_document",
    "validation_json",
    "validation_rows",
]

Topic = tuple[str, Callable[[], Iterable[ValidationRow]]]


def validation_rows(
    with_run: bool = True, progress: Callable[[str], None] | None = None
) -> tuple[ValidationRow, ...]:
    """Compute every row of the table.

    Parameters
    ----------
    with_run : run the shipped prototype at quick fidelity for the rows that need it, standard influence numbers; else
        coarse ones
    progress : called with the topic that is being computed

    Raises
    ------
    UsageError
        The shipped case is not found.
    CaseError, NotConvergedError, MissingLibraryError
        Of the run.
    """
    from threadpoolctl import threadpool_limits

    say = progress or (lambda message: None)
    rows: list[ValidationRow] = []
    with threadpool_limits(limits=1):
        for text, compute in _topics(with_run, say):
            say(text)
            rows.extend(compute())
    return tuple(rows)


def _topics(with_run: bool, say: Callable[[str], None]) -> list[Topic]:
    from rigdesign.case.shipped import case_folder
    from rigdesign.validation import (
        benchmarks,
        decomposition,
        films,
        fzg_losses,
        gears,
        iso_example,
        losses,
        main_rig_oil,
        mechanics,
        mesh_stiffness,
        p1,
        ramp,
        response,
        shafts,
    )
    from rigdesign.validation.prototype import Prototype

    prototype = Prototype(case_folder())
    topics: list[Topic] = [
        ("ISO ratings of the prototype's gears", partial(gears.gear_rows, prototype)),
        ("shafts, crossings, damping", partial(shafts.shaft_rows, prototype)),
        ("dynamic factor over speed", partial(response.response_rows, prototype)),
        ("dynamic factor by its causes", partial(decomposition.decomposition_rows, prototype)),
        ("ramp", partial(ramp.ramp_rows, prototype)),
        ("film coefficients and oil", films.film_rows),
        ("thermal model of the main rig", partial(_main_rig, with_run)),
        ("oil heats of the main rig", main_rig_oil.oil_balance_rows),
        ("tooth-loss factors", partial(losses.loss_rows, prototype)),
        ("FZG gears and a journal film", fzg_losses.fzg_loss_rows),
        ("ISO/TR 6336-30 example 1", iso_example.iso_example_rows),
        ("mesh stiffness", mesh_stiffness.mesh_stiffness_rows),
        ("conduction benchmarks", benchmarks.benchmark_rows),
        ("oscillator, energy and closure", partial(mechanics.mechanics_rows, prototype)),
        ("strain-gauge paper", partial(p1.p1_rows, quick=not with_run)),
    ]
    if with_run:
        topics.append(("run of the prototype", partial(_run, prototype, say)))
    return topics


def _main_rig(with_run: bool) -> Iterable[ValidationRow]:
    from rigdesign.case import load_case
    from rigdesign.case.shipped import case_folder
    from rigdesign.run.main import run_case
    from rigdesign.validation.main_rig import main_rig_rows, rows_without_run

    if not with_run:
        return rows_without_run()
    folder = case_folder("uhcf_main")
    return main_rig_rows(lambda reading: run_case(load_case(folder / f"{reading}.toml"), fidelity="quick"))


def _run(prototype: object, say: Callable[[str], None]) -> Iterable[ValidationRow]:
    from rigdesign.run.main import run_case
    from rigdesign.validation.prototype import Prototype
    from rigdesign.validation.run_rows import run_rows

    assert isinstance(prototype, Prototype)
    return run_rows(run_case(prototype.rig.case, fidelity="quick", progress=say))
