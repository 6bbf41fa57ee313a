"""Components that stand in another REXS file, named by ``data_source`` and ``referenced_component_id``.

What the file refers to is put into the model with it: sections and material of a shaft, rows of a bearing. Attributes
of the component itself come first. Only files in the folder of the model, or below it, are opened.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import count
from pathlib import Path

from rigdesign.rexs.model import (
    EXPORT_AGAIN,
    Attribute,
    AttributeValueError,
    Component,
    FaultList,
    Relation,
    RexsModel,
    RoleReference,
)

DATA_SOURCE, REFERENCED = "data_source", "referenced_component_id"
MOST_COMPONENTS = 100_000
MOST_PARTS = 1000
"""Components that stand in other files, over all files."""
MOST_LEVELS = 5
"""Files that refer to files that refer to files."""
_FRAME = "reference_component_for_position"
_OWNER_ROLES = {
    "assembly": "assembly", "ordered_assembly": "assembly", "reference": "origin", "ordered_reference": "origin",
    "flank": "gear", "manufacturing_step": "workpiece",
}  # fmt: skip
"""Relation -> role of the component that the others belong to."""

ReadModel = Callable[[Path], RexsModel]


def with_external_parts(model: RexsModel, folder: Path, read: ReadModel) -> RexsModel:
    """The model with the components of other files put in.

    Parameters
    ----------
    model : as read
    folder : of its file
    read : reader of one file

    Returns
    -------
    model : references to files that are not there stay as they are

    Raises
    ------
    RexsError
        A file outside the folder or that refers in circles, one that is no REXS, a component that is not in it or is
        of another type, more than 1000 such parts or 100,000 components.
    """
    return _Merger(read).merged(model, folder, level=0)


class _Merger:
    """Reads and completes each file once."""

    def __init__(self, read: ReadModel) -> None:
        self._read = read
        self._complete: dict[Path, RexsModel] = {}
        self._parts = 0

    def merged(self, model: RexsModel, folder: Path, level: int) -> RexsModel:
        """The model with its external parts; ``level`` files led to it."""
        faults = FaultList(model.source)
        for component in model.components:
            path = _file_of(component, folder, faults)
            if path is None:
                continue
            place = f"component {component.id}, {DATA_SOURCE}"
            if level >= MOST_LEVELS:
                problem = f"files that refer to each other over more than {MOST_LEVELS} levels"
                faults.stop(place, path.name, problem, EXPORT_AGAIN)
            if path not in self._complete:
                self._complete[path] = self.merged(self._read(path), path.parent, level + 1)
            model = _with_part(model, component, self._complete[path], faults)
            self._parts += 1
            if self._parts > MOST_PARTS or len(model.components) > MOST_COMPONENTS:
                problem = (
                    f"more than {MOST_PARTS} parts in other files or {MOST_COMPONENTS} components in all"
                )
                faults.stop(place, path.name, problem, EXPORT_AGAIN)
        faults.raise_if_any()
        return model


def _file_of(component: Component, folder: Path, faults: FaultList) -> Path | None:
    """File that a component stands in; None for a component of the model itself and a file that is not there."""
    given = component.attribute(DATA_SOURCE)
    if given is None or component.attribute(REFERENCED) is None:
        return None
    try:
        path = (folder / given.text()).resolve()
        inside = path.is_relative_to(folder.resolve())
        there = inside and path.is_file()
    except (AttributeValueError, OSError, ValueError, RuntimeError):
        return None
    if not inside:
        remedy = "put the file into the folder of the model and name it there"
        faults.add(
            f"component {component.id}, {DATA_SOURCE}", given.written(), "a file outside the folder", remedy
        )
        return None
    return path if there else None


def _with_part(model: RexsModel, component: Component, source: RexsModel, faults: FaultList) -> RexsModel:
    """Put the referenced component, and all that belongs to it, into the model."""
    place = f"component {component.id}, {REFERENCED}"
    given = component.attribute(REFERENCED)
    try:
        number = given.whole_number() if given else -1
    except AttributeValueError as error:
        faults.add(place, None, str(error), EXPORT_AGAIN)
        return model
    found = source.component(number) if source.has(number) else None
    if found is None or found.type != component.type:
        problem = f"a {found.type} there" if found else "no such component"
        faults.add(
            place, number, f"{problem} in {source.source}", f"refer to a {component.type} of that file"
        )
        return model
    relations = list(_owned(source, number))
    members = dict.fromkeys(item.component for relation in relations for item in relation.references)
    free = count(max(part.id for part in model.components) + 1)
    numbers = {member: next(free) for member in members if member != number} | {number: component.id}
    added = [_moved(source.component(member), numbers) for member in members if member != number]
    merged = _merged(component, _moved(found, numbers))
    first = max((relation.id for relation in model.relations), default=0) + 1
    moved = [_moved_relation(relation, first + index, numbers) for index, relation in enumerate(relations)]
    kept = [merged if part.id == component.id else part for part in model.components]
    return replace(model, components=(*kept, *added), relations=(*model.relations, *moved))


def _owned(source: RexsModel, number: int) -> Iterator[Relation]:
    """Relations of a component with what belongs to it, and of that in turn."""
    waiting, seen = [number], {number}
    while waiting:
        owner = waiting.pop()
        for kind, role in _OWNER_ROLES.items():
            for relation in source.relations_of(kind, role, owner):
                yield relation
                fresh = {item.component for item in relation.references} - seen
                seen |= fresh
                waiting += sorted(fresh)


def _merged(component: Component, referenced: Component) -> Component:
    own = tuple(item for item in component.attributes if item.id not in (DATA_SOURCE, REFERENCED))
    stated = {item.id for item in own}
    return replace(
        component, attributes=own + tuple(item for item in referenced.attributes if item.id not in stated)
    )


def _moved(component: Component, numbers: dict[int, int]) -> Component:
    """A component under its new id; a place in a frame that stays behind is left out."""
    attributes = [
        moved for item in component.attributes if (moved := _moved_attribute(item, numbers)) is not None
    ]
    return replace(component, id=numbers[component.id], attributes=tuple(attributes))


def _moved_attribute(attribute: Attribute, numbers: dict[int, int]) -> Attribute | None:
    if attribute.id != _FRAME:
        return attribute
    try:
        number = numbers.get(attribute.whole_number())
    except AttributeValueError:
        return None
    return None if number is None else replace(attribute, value=number)


def _moved_relation(relation: Relation, number: int, numbers: dict[int, int]) -> Relation:
    references = tuple(RoleReference(numbers[item.component], item.role) for item in relation.references)
    return replace(relation, id=number, references=references)
