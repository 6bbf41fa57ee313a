"""Tables that come in kinds: the key that says which one it is, and the kind of a table that does not say.

    GearOil = Annotated[Annotated[JetOil, Tag("jet")] | Annotated[DipOil, Tag("dip")], kind_from("lubrication", "jet")]

Every kind states its own name as the only choice of that key; the usual kind has it as default.
"""

import typing
from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any

from pydantic import BaseModel, Discriminator

USUAL = {"law": (), "lubrication": ("jet", "fed"), "type": ("journal",)}
"""Keys by which kinds of tables differ -> what a table is that does not state the key."""


def changes_kind(base: Mapping[str, Any], over: Mapping[str, Any]) -> bool:
    """Whether a table ``over`` another one states a kind that this one is not."""
    return any(
        key in over and over[key] != base.get(key) and not (key not in base and over[key] in usual)
        for key, usual in USUAL.items()
    )


def kind_from(key: str, usual: str) -> Discriminator:
    """Chooses the kind of a table by ``key``; ``usual`` where the table does not state it."""

    def kind(given: object) -> object:
        if isinstance(given, Mapping):
            return given.get(key, usual)
        return getattr(given, key, None)

    return Discriminator(kind)


def kind_key(models: Sequence[type[BaseModel]]) -> str:
    """The key by which tables differ: in each of them it has one choice, its own. Empty where there is none."""
    return _kind_key(tuple(models))


def kind_of(model: type[BaseModel], key: str) -> str:
    """The kind a table is, by the only choice of its key."""
    return str(typing.get_args(model.model_fields[key].annotation)[0])


def variant_of(model: type[BaseModel], models: Sequence[type[BaseModel]]) -> str:
    """How a case states that a table is this one of several kinds: ``law = radiation``."""
    key = kind_key(models)
    return f"{key} = {kind_of(model, key)}"


def of_kind(models: Sequence[type[BaseModel]], table: Mapping[str, Any]) -> list[type[BaseModel]]:
    """Of several kinds those that a table may be: the one it states, or the usual one; all where it names none."""
    key = kind_key(models)
    if len(models) < 2 or not key:
        return list(models)
    if key in table:
        return [model for model in models if kind_of(model, key) == table[key]] or list(models)
    return [model for model in models if not model.model_fields[key].is_required()] or list(models)


@cache
def _kind_key(models: tuple[type[BaseModel], ...]) -> str:
    for key in models[0].model_fields if models else ():
        fields = [model.model_fields.get(key) for model in models]
        choices = [() if field is None else _choices(field.annotation) for field in fields]
        if all(len(own) == 1 for own in choices) and len(set(choices)) == len(models):
            return key
    return ""


def _choices(annotation: Any) -> tuple[Any, ...]:
    return typing.get_args(annotation) if typing.get_origin(annotation) is typing.Literal else ()
