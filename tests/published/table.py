"""Every row of `rigdesign validate`, topic by topic: what the package ships as data is computed here.

``rows`` says how a published number and ours become a row, ``prototype`` and ``speed_sweeps`` hold what several topics
share; every other module holds the rows of one topic and names in its docstring what they say about the publication.
"""

from collections.abc import Callable, Iterable
from functools import cache

from rigdesign.results.result import RunResult
from rigdesign.validation import ValidationRow
from tests.builders.paths import CASES
from tests.published.benchmarks import benchmark_rows
from tests.published.decomposition import decomposition_rows
from tests.published.films import film_rows
from tests.published.fzg_losses import fzg_loss_rows
from tests.published.gears import gear_rows
from tests.published.iso_example import iso_example_rows
from tests.published.losses import loss_rows
from tests.published.main_rig import main_rig_rows
from tests.published.main_rig_oil import oil_balance_rows
from tests.published.mechanics import mechanics_rows
from tests.published.mesh_stiffness import mesh_stiffness_rows
from tests.published.p1 import p1_rows
from tests.published.prototype import Prototype
from tests.published.ramp import ramp_rows
from tests.published.response import response_rows
from tests.published.run_rows import run_rows
from tests.published.shafts import shaft_rows

Run = Callable[[str], RunResult]
"""Result of a shipped case or of one of its files, ``uhcf_main/fitted.toml``, at its default fidelity."""


@cache
def prototype() -> Prototype:
    """The shipped prototype, its readings computed once."""
    return Prototype(CASES / "uhcf_prototype")


def topics(run: Run) -> dict[str, Callable[[], Iterable[ValidationRow]]]:
    """What gives the rows of each topic, in the order of the table."""
    return {
        "ISO ratings of the prototype's gears": lambda: gear_rows(prototype()),
        "shafts, crossings, damping": lambda: shaft_rows(prototype()),
        "dynamic factor over speed": lambda: response_rows(prototype()),
        "dynamic factor by its causes": lambda: decomposition_rows(prototype()),
        "ramp": lambda: ramp_rows(prototype()),
        "film coefficients and oil": film_rows,
        "thermal model of the main rig": lambda: main_rig_rows(
            lambda reading: run(f"uhcf_main/{reading}.toml")
        ),
        "oil heats of the main rig": oil_balance_rows,
        "tooth-loss factors": lambda: loss_rows(prototype()),
        "FZG gears and a journal film": fzg_loss_rows,
        "ISO/TR 6336-30 example 1": iso_example_rows,
        "mesh stiffness": mesh_stiffness_rows,
        "conduction benchmarks": benchmark_rows,
        "oscillator, energy and closure": lambda: mechanics_rows(prototype()),
        "strain-gauge paper": p1_rows,
        "run of the prototype": lambda: run_rows(run("uhcf_prototype")),
    }
