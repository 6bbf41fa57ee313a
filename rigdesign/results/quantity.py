"""One declaration of a number of a result: unit and heading; JSON, tables and data frames follow from it.

    @dataclass(frozen=True, kw_only=True)
    class Bearing:
        speed: Annotated[float, Quantity("rpm")]

A record holds SI, ``bearing.speed`` is in rad/s. It is shown in its unit: ``speed_rpm`` in results.json and as the
column of a data frame, ``speed [rpm]`` at the head of a table. What is shown of a record are its fields, and its
properties whose type states a quantity.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields, is_dataclass
from functools import cache, cached_property
from typing import TYPE_CHECKING, Annotated, Any, TypeVar, get_args, get_origin, get_type_hints

from rigdesign.base.errors import MissingLibraryError
from rigdesign.results.units import UNITS, DisplayUnit

if TYPE_CHECKING:
    import pandas

T = TypeVar("T")


@dataclass(frozen=True)
class Quantity:
    """Unit in which a number is shown, and the words of its heading, those of its name when left out."""

    unit: str = "-"
    label: str = ""

    def __post_init__(self) -> None:
        if self.unit not in UNITS:
            raise KeyError(f"no unit {self.unit!r}; there are {', '.join(UNITS)}")

    @property
    def display(self) -> DisplayUnit:
        """The unit with its conversion."""
        return UNITS[self.unit]


@dataclass(frozen=True)
class Shown:
    """A field or property of a record as it is shown.

    kind : type without its quantity; derived : a property, computed from the fields
    """

    name: str
    kind: Any
    quantity: Quantity
    derived: bool

    @property
    def key(self) -> str:
        """In results.json and data frames."""
        return self.name + self.quantity.display.suffix

    @property
    def column(self) -> str:
        """In a table of the report, which makes a heading of it."""
        return (self.quantity.label.replace(" ", "_") or self.name) + self.quantity.display.suffix

    def of(self, record: Any) -> Any:
        """Its value of a record in its unit."""
        return _converted(getattr(record, self.name), self.quantity.display.shown)

    def stored(self, value: Any) -> Any:
        """A value in its unit in SI."""
        return _converted(value, self.quantity.display.stored)


def _converted(value: Any, convert: Any) -> Any:
    if isinstance(value, float):
        return convert(value)
    if isinstance(value, Mapping):
        return {key: _converted(item, convert) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return type(value)(_converted(item, convert) for item in value)
    return value


NONE = Quantity()

Degrees = Annotated[float, Quantity("degC")]
Hertz = Annotated[float, Quantity("Hz")]
Megapascals = Annotated[float, Quantity("MPa")]
NewtonMetres = Annotated[float, Quantity("N m")]
Newtons = Annotated[float, Quantity("N")]
Revolutions = Annotated[float, Quantity("rpm")]
Seconds = Annotated[float, Quantity("s")]
Watts = Annotated[float, Quantity("W")]
"""The commonest, in K, Hz, Pa, N m, N, rad/s, s and W as fields hold them."""


@cache
def _solver_records() -> Mapping[str, type]:
    """What records of the solvers are called where results name them in annotations alone: loaded at the first one."""
    from dynamics.rotor.damped_modes import RigMode
    from rigdesign.transient.soak import Soak
    from thermal.fe.mesh import NamedMesh

    return {record.__name__: record for record in (NamedMesh, RigMode, Soak)}


_OF_SOLVERS: Mapping[str, Mapping[str, Quantity]] = {
    "RigMode": {"frequency": Quantity("Hz")},
    "HeatFlow": {
        "power": Quantity("W"),
        "area": Quantity("m2"),
        "mean_temperature": Quantity("degC"),
    },
}
"""Quantities of fields of solver records, which know nothing of results."""


def _hints(described: Any) -> dict[str, Any]:
    return get_type_hints(described, localns=dict(_solver_records()), include_extras=True)


@cache
def shown(kind: type) -> Mapping[str, Shown]:
    """What is shown of records of a class, by name."""
    hints = _hints(kind)
    hints |= {
        name: Annotated[hints[name], quantity]
        for name, quantity in _OF_SOLVERS.get(kind.__name__, {}).items()
    }
    items = {item.name: _shown(item.name, hints[item.name], derived=False) for item in fields(kind)}
    for base in reversed(kind.__mro__):
        for name, member in vars(base).items():
            function = getattr(member, "fget", None) or (
                member.func if isinstance(member, cached_property) else None
            )
            hint = _hints(function).get("return") if function else None
            if _quantity(hint) is not None:
                items[name] = _shown(name, hint, derived=True)
    return items


def _shown(name: str, hint: Any, *, derived: bool) -> Shown:
    quantity = _quantity(hint)
    kind = get_args(hint)[0] if quantity is not None else hint
    return Shown(name=name, kind=kind, quantity=quantity or NONE, derived=derived)


def _quantity(hint: Any) -> Quantity | None:
    if get_origin(hint) is not Annotated:
        return None
    return next((extra for extra in get_args(hint)[1:] if isinstance(extra, Quantity)), None)


def value_in_unit(record: Any, name: str) -> Any:
    """A value of a record in the unit in which it is shown."""
    return shown(record.__class__)[name].of(record)


def row(record: Any, *names: str) -> dict[str, Any]:
    """Values of a record in their units by column; some of them, in that order, or all that are no records."""
    declared = shown(record.__class__)
    chosen = [declared[name] for name in names] if names else declared.values()
    values = {item.column: item.of(record) for item in chosen}
    return values if names else {key: value for key, value in values.items() if not _is_nested(value)}


def _is_nested(value: Any) -> bool:
    return is_dataclass(value) or (
        isinstance(value, list | tuple) and any(is_dataclass(item) for item in value)
    )


class Records(list[T]):
    """Records of one class in the order of the report."""

    def to_dataframe(self) -> "pandas.DataFrame":
        """One row each, a column for every value that is no record itself, in its unit.

        Raises
        ------
        MissingLibraryError
            pandas is not installed.
        """
        return to_dataframe(self)


def to_dataframe(records: Iterable[Any]) -> "pandas.DataFrame":
    """As `Records.to_dataframe`, of any records."""
    try:
        import pandas
    except ImportError as error:
        raise MissingLibraryError("to_dataframe needs pandas; run: pip install pandas") from error
    rows = []
    for record in records:
        values = {item.key: item.of(record) for item in shown(record.__class__).values()}
        rows.append({key: value for key, value in values.items() if not _is_nested(value)})
    return pandas.DataFrame(rows)
