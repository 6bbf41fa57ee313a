"""What holds for a REXS model in XML and JSON alike: a version that is read, unique ids, references to something."""

from collections import Counter
from collections.abc import Iterable

from rigdesign.rexs.faults import EXPORT_AGAIN, FaultList
from rigdesign.rexs.model import Component, RexsModel
from rigdesign.rexs.versions import is_read

MOST_STATES = 2_000_000
"""Load cases times shafts and loads, each of which has a state in each case."""


def check_version(version: str, place: str, faults: FaultList) -> None:
    """Stop at a version that is not read, before the rest of the file is misunderstood.

    Raises
    ------
    RexsError
        The version is none of 1.0 to 1.7 and 2.0.
    """
    if not is_read(version):
        faults.stop(f"{place}, version", version, "not one of REXS 1.0 to 1.7 and 2.0", EXPORT_AGAIN)


def check_model(model: RexsModel, faults: FaultList) -> RexsModel:
    """``model``, if it holds together.

    Raises
    ------
    RexsError
        No components, an id that occurs twice, or a relation or load case that names a component that is not there,
        load cases without end; with all faults collected before.
    """
    if not model.components:
        faults.add("model, components", None, "a model without components", EXPORT_AGAIN)
    _check_unique("component", (component.id for component in model.components), faults)
    _check_unique("relation", (relation.id for relation in model.relations), faults)
    for relation in model.relations:
        for item in relation.references:
            _check_known(model, f"relation {relation.id}, role {item.role!r}", item.component, faults)
    _check_unique("load_spectrum", (spectrum.id for spectrum in model.load_spectra), faults)
    for spectrum in model.load_spectra:
        _check_unique(
            f"load_spectrum {spectrum.id}: load_case", (case.id for case in spectrum.load_cases), faults
        )
        for case in spectrum.load_cases:
            _check_parts(model, f"load_case {case.id}", case.components, faults)
        _check_parts(model, "accumulation", spectrum.accumulation, faults)
    cases = sum(len(spectrum.load_cases) for spectrum in model.load_spectra)
    carriers = len(model.of_type("shaft", "external_load"))
    if cases * carriers > MOST_STATES:
        problem = (
            f"{cases} load cases of {carriers} shafts and loads, above the limit of {MOST_STATES} states"
        )
        faults.add("load_spectrum", None, problem, "export a classified load spectrum")
    faults.raise_if_any()
    return model


def _check_parts(model: RexsModel, place: str, components: tuple[Component, ...], faults: FaultList) -> None:
    _check_unique(f"{place}, component", (component.id for component in components), faults)
    for component in components:
        _check_known(model, f"{place}, component", component.id, faults)


def _check_unique(what: str, numbers: Iterable[int], faults: FaultList) -> None:
    for number, count in Counter(numbers).items():
        if count > 1:
            faults.add(f"{what} {number}", None, f"the id occurs {count} times", "give each an id of its own")


def _check_known(model: RexsModel, place: str, number: int, faults: FaultList) -> None:
    if not model.has(number):
        faults.add(place, number, "no component has this id", f"add the component, or {EXPORT_AGAIN}")
