"""Every key of the case file says what it is."""

from collections.abc import Iterator

from rigdesign.case.fields import Part
from rigdesign.case.schema import json_schema


def parts(of: type[Part] = Part) -> Iterator[type[Part]]:
    for part in of.__subclasses__():
        yield part
        yield from parts(part)


def test_no_key_is_without_a_description() -> None:
    bare = [
        f"{part.__name__}.{key}"
        for part in parts()
        for key, field in part.model_fields.items()
        if part.__module__.startswith("rigdesign.case.") and not field.description
    ]
    assert bare == []


def test_the_schema_for_editors_carries_them() -> None:
    schema = json_schema()
    tables = [schema, *schema["$defs"].values()]
    bare = [
        f"{table['title']}.{key}"
        for table in tables
        for key, entry in table.get("properties", {}).items()
        if not (entry.get("description") or schema["$defs"][entry["$ref"].rpartition("/")[2]]["description"])
    ]
    assert bare == []
    assert sum(len(table.get("properties", {})) for table in tables) > 400


def test_a_description_is_a_sentence() -> None:
    """A capital or a symbol first, a full stop at the end, no blank line inside."""
    odd = [
        f"{part.__name__}.{key}: {field.description}"
        for part in set(parts())
        for key, field in part.model_fields.items()
        if part.__module__.startswith("rigdesign.case.")
        and not ((field.description or "").rstrip().endswith(".") and "\n\n" not in (field.description or ""))
    ]
    assert odd == []
