"""JSON Schema of the case file for editors: every value may also stand in a table with its marks."""

from typing import Any

from rigdesign.case.defaults.fill import relaxed
from rigdesign.case.model import Case

_MARK_PROPERTIES: dict[str, Any] = {
    "assumed": {"type": "string", "description": "reason of an assumption"},
    "range": {
        "type": "array",
        "minItems": 2,
        "maxItems": 2,
        "description": "lowest and highest plausible value",
    },
    "source": {"type": "string", "description": "where the value is printed"},
    "measured": {
        "type": "string",
        "description": "the measurement that replaces a computed or printed value",
    },
    "confirmed": {"type": "string", "description": "why a value outside of its usual range is right"},
}


LEFT_TO_CIRCUITS = ("JetOil", "FedOil")
"""Tables whose inlet temperature may be left to the setpoint of an oil circuit."""


def json_schema() -> dict[str, Any]:
    """Schema of a case file (draft 2020-12): patterns for quantities, choices, names, descriptions.

    A key is required only if the tool knows no default for it.
    """
    schema = Case.model_json_schema()
    relaxed(schema)
    for table in [schema, *schema.get("$defs", {}).values()]:
        properties = table.get("properties", {})
        for name, entry in properties.items():
            properties[name] = _with_marks(entry) if _is_value(entry) else entry
    for name in LEFT_TO_CIRCUITS:
        schema["$defs"][name]["required"].remove("inlet_temperature")
    schema["properties"]["extends"] = {
        "type": "string",
        "description": "case file this one is laid over; required keys may then be left out",
    }
    schema["$defs"] |= {f"mark_{name}": entry for name, entry in _MARK_PROPERTIES.items()}
    schema["$schema"] = "https://json-schema.org/draft/2020-12/schema"
    return schema


def _is_value(entry: dict[str, Any]) -> bool:
    """A single value or a list, and not a table of parts."""
    if "anyOf" in entry:
        return any(_is_value(choice) for choice in entry["anyOf"] if choice.get("type") != "null")
    return entry.get("type") in ("string", "number", "integer", "boolean", "array") or "enum" in entry


def _with_marks(entry: dict[str, Any]) -> dict[str, Any]:
    value = {key: item for key, item in entry.items() if key not in ("title", "description", "default")}
    marked = {
        "type": "object",
        "properties": {
            "value": value,
            **{name: {"$ref": f"#/$defs/mark_{name}"} for name in _MARK_PROPERTIES},
        },
        "required": ["value"],
        "additionalProperties": False,
    }
    outer = {key: item for key, item in entry.items() if key in ("title", "description", "default")}
    return {**outer, "anyOf": [value, marked]}
