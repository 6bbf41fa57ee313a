"""What the constants mean that healthy sets of a rig may replace, as the text below each of them says."""

import ast
from collections.abc import Mapping, Sequence
from functools import cache
from importlib.util import find_spec
from pathlib import Path

from rigdesign.diagnosis.residual.baseline import Drift
from rigdesign.diagnosis.statistics.amplitudes import Amplitudes


@cache
def meanings() -> Mapping[str, str]:
    """Name -> meaning of what a rig's own sets may replace: ``amplitudes.link``, ``drift.shaft``."""
    fields = (("amplitudes", Amplitudes), ("drift", Drift))
    return {f"{group}.{name}": text for group, cls in fields for name, text in field_texts(cls).items()}


@cache
def module_tree(name: str) -> ast.Module:
    """The source of a module, parsed."""
    spec = find_spec(name)
    assert spec is not None and spec.origin is not None
    return ast.parse(Path(spec.origin).read_text(encoding="utf-8"))


def assigned_texts(body: Sequence[ast.stmt]) -> dict[str, str]:
    """Names assigned in a block -> the text below, empty where there is none."""
    texts: dict[str, str] = {}
    for place, statement in enumerate(body):
        match statement:
            case ast.Assign(targets=targets):
                names = [
                    part.id for target in targets for part in ast.walk(target) if isinstance(part, ast.Name)
                ]
            case ast.AnnAssign(target=ast.Name(id=name)):
                names = [name]
            case _:
                continue
        below = body[place + 1] if place + 1 < len(body) else None
        texts |= dict.fromkeys(names, _text(below))
    return texts


def _text(statement: ast.stmt | None) -> str:
    """Of a bare string, on one line; its first paragraph."""
    match statement:
        case ast.Expr(value=ast.Constant(value=str() as text)):
            return " ".join(text.split("\n\n")[0].split())
    return ""


def field_texts(cls: type) -> Mapping[str, str]:
    """Field of a record -> its meaning, from the text below it or from the list in the text of the record."""
    [block] = [
        node
        for node in module_tree(cls.__module__).body
        if isinstance(node, ast.ClassDef) and node.name == cls.__name__
    ]
    listed = _listed(ast.get_docstring(block) or "")
    annotated = {
        node.target.id
        for node in block.body
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name)
    }
    return {
        name: text or listed.get(name, "")
        for name, text in assigned_texts(block.body).items()
        if name in annotated
    }


def _listed(docstring: str) -> dict[str, str]:
    """Names -> texts of a list ``name, name : text; name : text``."""
    texts: dict[str, str] = {}
    for entry in " ".join(docstring.partition("\n\n")[2].split()).split("; "):
        names, colon, text = entry.partition(" : ")
        if colon:
            texts |= dict.fromkeys((name.strip() for name in names.split(",")), text)
    return texts
