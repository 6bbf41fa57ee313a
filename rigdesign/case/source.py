"""From a path on disk to one tree: reads TOML, follows ``extends``, merges."""

import tomllib
from pathlib import Path
from typing import Any

from rigdesign.base.errors import CaseError, shortened
from rigdesign.base.files import RefusedFileError, check_regular, foreign, read_regular
from rigdesign.case.fields import changes_kind
from rigdesign.case.provenance import is_marked
from rigdesign.case.shipped import shipped_cases

CASE_FILE = "case.toml"
LARGEST_CASE = 5_000_000
"""Bytes of a case file; one with a row of numbers for each of 2000 teeth has a tenth."""

DEEPEST = 30
"""Tables within tables; a case has ten."""


def case_file(path: Path) -> Path:
    """The case file of a folder, or the file itself; a plain name that is neither may be that of a shipped case.

    Raises CaseError when there is none, and for a device, a pipe or a file of more than LARGEST_CASE bytes.
    """
    remedy = f"give a case folder or its {CASE_FILE}"
    try:
        if path.parts == (path.name,) and not path.suffix and not path.exists():
            shipped = shipped_cases()
            path = shipped.get(path.name, path)
            remedy += f", or the name of a shipped case: {', '.join(shipped)}"
        file = path / CASE_FILE if path.is_dir() else path
        check_regular(file, LARGEST_CASE)
    except RefusedFileError as error:
        raise CaseError(f"is {error.strerror}; {remedy}", str(file)) from None
    except (OSError, ValueError) as error:
        if isinstance(error, FileNotFoundError) and path.is_dir():
            raise CaseError(f"no {CASE_FILE} in this folder; {remedy}", str(path)) from None
        reason = getattr(error, "strerror", None) or str(error)
        raise CaseError(f"no such file or folder ({reason}); {remedy}", str(path)) from None
    return file


def read_tree(file: Path) -> dict[str, Any]:
    """The content of a case file merged over what it extends, marks included.

    Raises CaseError for a file that cannot be read or decoded, is truncated, or extends itself.
    """
    chain: list[dict[str, Any]] = []
    seen: list[Path] = []
    current: Path | None = file.resolve()
    while current is not None:
        if current in seen:
            trail = " -> ".join(link.name for link in [*seen, current])
            raise CaseError(f"extends itself: {trail}; remove one 'extends'", str(file))
        seen.append(current)
        content = _read(current)
        chain.append(content)
        current = _base(content.pop("extends", None), current)
    tree = chain.pop()
    while chain:
        try:
            tree = merge(tree, chain.pop())
        except CaseError as error:
            raise CaseError(str(error), str(file)) from None
    return tree


def merge(base: dict[str, Any], over: dict[str, Any]) -> dict[str, Any]:
    """``over`` laid on ``base``: tables key by key, lists of named tables item by item, all else replaced.

    ``remove = ["key", …]`` in a table of ``over`` leaves out inherited keys. A table of another kind
    (`kinds.USUAL`) takes the place of the inherited one.
    """
    dropped = over.get("remove", [])
    if not isinstance(dropped, list) or not all(isinstance(key, str) and key in base for key in dropped):
        raise CaseError(
            f"remove = {shortened(repr(dropped))}: not a list of inherited keys; inherited here: {', '.join(base)}"
        )
    merged = {key: value for key, value in base.items() if key not in dropped}
    for key, value in over.items():
        if key != "remove":
            merged[key] = _merge_value(merged[key], value) if key in merged else value
    return merged


def _merge_value(base: Any, over: Any) -> Any:
    if isinstance(base, dict) and isinstance(over, dict) and not (is_marked(base) or is_marked(over)):
        return over if changes_kind(base, over) else merge(base, over)
    if _named(base) and _named(over):
        items = {item["name"]: item for item in base}
        for item in over:
            items[item["name"]] = merge(items[item["name"]], item) if item["name"] in items else item
        return list(items.values())
    return over


def _named(value: object) -> bool:
    return (
        isinstance(value, list)
        and bool(value)
        and all(isinstance(item, dict) and isinstance(item.get("name"), str) for item in value)
    )


def _base(extends: object, file: Path) -> Path | None:
    if extends is None:
        return None
    if not isinstance(extends, str):
        given = shortened(repr(extends))
        raise CaseError(f"extends = {given}: not a text; write the path of a case file", str(file))
    try:
        return case_file((file.parent / extends).resolve())
    except (CaseError, OSError, ValueError, RuntimeError) as error:
        raise CaseError(
            f"extends = {shortened(repr(extends))}: {error}; correct the path", str(file)
        ) from None


def _read(file: Path) -> dict[str, Any]:
    try:
        content = read_regular(file, LARGEST_CASE)
    except OSError as error:
        raise CaseError(
            f"cannot be read: {error.strerror}; check the path and its rights", str(file)
        ) from None
    if (what := foreign(content)) is not None:
        raise CaseError(f"is {what}; a case is a TOML text, write it as one", str(file))
    try:
        tree: dict[str, Any] | None = tomllib.loads(content.decode("utf-8-sig"))
    except UnicodeDecodeError as error:
        raise CaseError(f"is not UTF-8 text (byte {error.start}); save it as UTF-8", str(file)) from None
    except tomllib.TOMLDecodeError as error:
        raise CaseError(f"is not valid TOML or was cut off: {error}; correct it there", str(file)) from None
    except ValueError:
        raise CaseError("holds a whole number of too many digits to be read; correct it", str(file)) from None
    except RecursionError:
        tree = None
    if tree is None or _is_deep(tree):
        raise CaseError(f"is nested more than {DEEPEST} tables deep; flatten its tables", str(file))
    return tree


def _is_deep(tree: dict[str, Any]) -> bool:
    level: list[Any] = [tree]
    for _ in range(DEEPEST):
        tables = (node.values() if isinstance(node, dict) else node for node in level)
        level = [node for table in tables for node in table if isinstance(node, dict | list)]
    return bool(level)
