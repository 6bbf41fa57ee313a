"""The case: everything a user states about a rig, in SI, with what the file said about its sources."""

import hashlib
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, PrivateAttr, model_validator

from rigdesign.case.assumptions import AssumptionRecord, implied_assumptions
from rigdesign.case.drivetrain import NO_DRIVETRAIN, DrivetrainInput
from rigdesign.case.elastic_shafts import elastic_assumptions
from rigdesign.case.events import Event
from rigdesign.case.fields import OF_HEAT, Effect, Name, Part, Text, Title
from rigdesign.case.gearbox import Gearbox
from rigdesign.case.housing import Housing
from rigdesign.case.limits import Limits
from rigdesign.case.losses import Losses
from rigdesign.case.lubrication import OilCircuit, with_setpoints
from rigdesign.case.paths import places
from rigdesign.case.provenance import InputRow, Mark, MeasuredInput, input_rows, take_off
from rigdesign.case.rig_heat import RigHeatInput
from rigdesign.case.schedule import Numerics, ScheduleInput, TestPlan, Transient
from rigdesign.case.substances import Ambient, CustomMaterial, CustomOil

# Who answers for a report: nothing of it enters a result.


class Document(Part):
    """What the first page of the report prints above the lines for the signatures."""

    project: Text | None = None
    """Project or customer the check belongs to."""
    number: Text | None = None
    """Number of the document in the reader's own filing."""
    author: Text | None = None
    """Who prepared the check."""
    checked_by: Text | None = None
    """Who checks it."""
    approved_by: Text | None = None
    """Who releases the rig on it."""


InputKind = Literal["number", "whole number", "other"]
"""A number with or without a unit; a whole number; a name, a choice, true or false, a table."""


@dataclass(frozen=True)
class Origin:
    """Where a case came from: file, resolved tree (marks still in it), marks by path."""

    path: Path
    stated: Mapping[str, Any]
    """The tree as the file states it, without defaults."""
    tree: Mapping[str, Any]
    """The same with what the defaults fill in."""
    marks: tuple[Mark, ...]
    change: Callable[["Case", Mapping[str, object]], "Case"]
    """Reads the case again with values replaced by path."""
    copies_of: Callable[[str], tuple[str, ...]]
    """Paths that follow the value of a path, of parts that the file writes once for several places."""

    @cached_property
    def mark_of(self) -> Mapping[str, Mark]:
        """Mark of a value by its path."""
        return {mark.path: mark for mark in self.marks}

    @cached_property
    def inputs(self) -> tuple[InputRow, ...]:
        """Every value the tree states, in the order of the file."""
        return input_rows(self.tree)

    @cached_property
    def value_of(self) -> Mapping[str, str]:
        """Value of an input as the file writes it, by its path."""
        return {row.path: row.value for row in self.inputs}


class Case(Part):
    """A rig, what it is to do, and the limits it is held against.

    Every quantity is a float in SI units (kelvin for temperatures); a share or factor is a bare number. Made
    by ``load_case``; ``with_value`` gives a changed copy.
    """

    schema_version: Literal[1]
    """Version of the case file format."""
    name: Name
    """Short name of the case, for files and tables."""
    title: Title
    """Title of the report."""
    ambient: Annotated[Ambient, OF_HEAT]
    """Room in which the rig stands."""
    oils: Annotated[Mapping[Name, CustomOil], OF_HEAT] = {}
    """Oils of the case by name, in addition to the built-in ones."""
    materials: Mapping[Name, CustomMaterial] = {}
    """Materials of the case by name, in addition to the built-in ones."""
    gearboxes: Mapping[Name, Gearbox] = Field(min_length=1)
    """Gearboxes of the rig by name."""
    oil_circuits: Mapping[Name, OilCircuit] = {}
    """Oil circuits by name; what no circuit feeds has the inlet temperature its gearbox states."""
    rig_heat: Annotated[
        RigHeatInput,
        Effect(checks=("rig heat",), where=("dry",), solved=("coupling",), through_heat=True),
    ] = RigHeatInput()
    """Machines, couplings and room: heat of the rig outside of its gearboxes."""
    drivetrain: DrivetrainInput | None = None
    """Left out when the losses are given: the dynamic checks are then not applicable."""
    losses: Losses
    """How the losses are found."""
    schedule: ScheduleInput
    """Stages of speed and torque."""
    test_plan: Annotated[TestPlan, Effect(checks=("test time",), solved=())]
    """Planned test."""
    limits: Annotated[Limits, Effect(checks=(), solved=())] = Limits()
    """Limits of the checks."""
    numerics: Numerics
    """Tolerances and sizes of the models."""
    transient: Annotated[Transient, Effect(checks=("thermal history",))] = Transient()
    """Warm-up, dwell and stops that ``check --transient`` follows."""
    events: Annotated[Mapping[Name, Event], Effect(checks=("events",))] = {}
    """Events by name: loss of teeth, emergency stop, overspeed."""
    document: Document = Document()
    """Who answers for the report; moves no result and is left out of the hash."""

    _origin: Origin = PrivateAttr()

    @model_validator(mode="before")
    @classmethod
    def _inlet_temperatures(cls, tree: object) -> object:
        """Inlet temperatures that the file leaves to the setpoints of oil circuits."""
        return with_setpoints(tree)

    @property
    def origin(self) -> Origin:
        """File, tree and marks of this case."""
        return self._origin

    @property
    def path(self) -> Path:
        """The case file."""
        return self._origin.path

    @property
    def power_circuit(self) -> DrivetrainInput:
        """The drivetrain; of a case that leaves it out an absent one, without shafts and couplings."""
        return self.drivetrain or NO_DRIVETRAIN

    @property
    def housings(self) -> dict[str, Housing]:
        """Housings of the gearboxes that have one."""
        return {name: box.housing for name, box in self.gearboxes.items() if box.housing is not None}

    @property
    def assumptions(self) -> tuple[AssumptionRecord, ...]:
        """Inputs marked as assumed, in the order of the file; then those the case assumes by leaving them out."""
        marked = (
            AssumptionRecord(path=mark.path, value=mark.shown, reason=mark.assumed, range=mark.range)
            for mark in self._origin.marks
            if mark.assumed is not None
        )
        heat = self.rig_heat.assumptions(self.ambient.temperature)
        shafts = elastic_assumptions(self.drivetrain, self.gearboxes)
        return (*marked, *shafts, *implied_assumptions(self.gearboxes), *heat)

    @property
    def inputs(self) -> tuple[InputRow, ...]:
        """Every value the case states, in the order of the file."""
        return self._origin.inputs

    @property
    def overrides(self) -> tuple[MeasuredInput, ...]:
        """Inputs replaced by a measured value."""
        return tuple(
            MeasuredInput(path=mark.path, value=mark.shown, measured=mark.measured)
            for mark in self._origin.marks
            if mark.measured is not None
        )

    def provenance(self, path: str) -> str:
        """Where the value at a path comes from: measured, printed or assumed; an input that says nothing is that."""
        mark = self._origin.mark_of.get(path)
        return (mark.basis if mark is not None else "") or "input of the case"

    @property
    def hash(self) -> str:
        """SHA-256 of the resolved content: values in SI and marks, not file name, spelling of units or ``document``."""
        marks = [mark for mark in self._origin.marks if not mark.path.startswith("document.")]
        content = {
            "values": _rounded(self.model_dump(mode="json", exclude={"document"})),
            "marks": [mark.as_record() for mark in sorted(marks, key=lambda mark: mark.path)],
        }
        for name, box in self.gearboxes.items():
            if box.housing is not None and box.housing.part_file is not None:
                file = self.path.parent / box.housing.part_file
                content[f"mesh_file.{name}"] = (
                    hashlib.sha256(file.read_bytes()).hexdigest() if file.is_file() else ""
                )
            for gear_name, gear in box.gears.items():
                for key in ("topography", "back_topography"):
                    if (measured := getattr(gear.flank, key)) is not None:
                        file = self.path.parent / measured
                        content[f"{key}.{name}.{gear_name}"] = (
                            hashlib.sha256(file.read_bytes()).hexdigest() if file.is_file() else ""
                        )
        text = json.dumps(content, sort_keys=True, ensure_ascii=False, allow_nan=False)
        return hashlib.sha256(text.encode()).hexdigest()

    def with_value(self, path: str, value: object) -> "Case":
        """A copy with one value changed, as if the file had said so.

        Parameters
        ----------
        path : dotted path, e.g. ``gearboxes.test.oil.inlet_temperature``; list items by name or number; ``*``
            stands for every name, ``gearboxes.test.bearings.*.diametral_clearance``
        value : what the file would hold (``"120 degC"``, ``0.4``); a text is read as number or true/false
            where the key holds one

        Raises
        ------
        CaseError
            The path does not exist (the nearest ones are named), or the changed case has faults.
        """
        return self.with_values({path: value})

    def with_values(self, values: Mapping[str, object]) -> "Case":
        """A copy with several values changed by path and validated once, as they may have to agree.

        Raises
        ------
        CaseError
            As :meth:`with_value`.
        """
        return self._origin.change(self, values)

    def copies_of(self, path: str) -> tuple[str, ...]:
        """Paths of gearboxes that the file makes ``like`` that of ``path``: :meth:`with_value` leaves them alone."""
        return self._origin.copies_of(path)

    def input_kind(self, path: str) -> InputKind | None:
        """What a path (or the first that fits one with ``*``) holds; None where there is no such path."""
        plain, _, _ = take_off(dict(self._origin.tree))
        slot = next(iter(places(Case, path, plain).values()), None)
        if slot is None:
            return None
        if slot.quantity is not None or float in slot.plain_types:
            return "number"
        return "whole number" if int in slot.plain_types else "other"


def _rounded(content: Any) -> Any:
    """Floats to 12 digits, so that ``40 mm`` and ``0.04 m`` are the same case."""
    if isinstance(content, float):
        return float(f"{content:.12g}")
    if isinstance(content, dict):
        return {key: _rounded(value) for key, value in content.items()}
    if isinstance(content, list | tuple):
        return [_rounded(value) for value in content]
    return content
